"""What keys of a ground, and of what stands on it, say together."""

from __future__ import annotations

from fecolumn.case.check_motion import check_strong_part
from fecolumn.case.checked import CheckedCase, Refuse
from fecolumn.case.ground import Ground
from fecolumn.case.joint import Joint

# Sizes of a plate or layer
_SIZES = ("thickness_m", "slide_allowance_m", "element_size_m", "coarse_size_m")
#: Keys that say something of some kinds of ground alone, and these.
OF_KINDS = {
    **dict.fromkeys(("length_m", "width_m"), ("plate",)),
    **dict.fromkeys(_SIZES, ("plate", "unbounded")),
    # of a pad as well, where they say nothing: so that a study may go through the kinds of ground
    **dict.fromkeys(
        ("youngs_modulus_pa", "poissons_ratio", "density_kg_m3"), ("plate", "unbounded", "pad")
    ),
    **dict.fromkeys(
        ("stiffness_n_m3", "shear_stiffness_n_m3", "damping_ratio", "yield_pa"), ("pad",)
    ),
}
#: Those of them that a short form has of its own accord
SIZES = ("length_m", "width_m", *_SIZES)
# Keys of impacts, and why they are 0 on a pad
_OF_IMPACTS = "restitution", "rolling_resistance"
_INSTEAD = "on a pad, whose springs take the place of impacts"
_ON_PAD = f"must be 0 {_INSTEAD}: its damping_ratio takes energy there"


def check_grounds(case: CheckedCase, refuse: Refuse) -> None:
    """Refuse grounds, and joints with them and with pads, that cannot be."""
    for name, ground in case.grounds.items():
        _check_keys(case, f"grounds.{name}", ground, refuse)
        used = [one.on for one in case.joints.values()] + [one.to for one in case.links.values()]
        used += [getattr(body, "moves_with", "") for body in case.bodies.values()]
        if name not in used and ground != Ground():
            refuse(f"grounds.{name}", None, "nothing stands on it, and no link is held by it")
    for name, interface in case.joints.items():
        _check_interface(case, f"joints.{name}", interface, refuse)
    if case.joints and all(_is_on_pad(case, one) for one in case.joints.values()):
        _check_on_pads(case, refuse)


def _check_on_pads(case: CheckedCase, refuse: Refuse) -> None:
    """Refuse keys of impacts in a case of pads alone; bodies that are found while they move meet in
    impacts.
    """
    if case.contact.between:
        return
    for key in _OF_IMPACTS:
        if value := getattr(case.contact, key):
            refuse(f"contact.{key}", value, _ON_PAD)
    if case.contact.impact != "plastic":
        refuse("contact.impact", case.contact.impact, f"must be plastic {_INSTEAD}")
    if (value := case.integration.substeps) == "impacts":
        refuse("integration.substeps", value, f"must be rolling or none {_INSTEAD}")


def _is_on_pad(case: CheckedCase, joint: Joint) -> bool:
    """Whether springs take the place of impacts in a joint."""
    ground = case.grounds.get(joint.on)
    return joint.stiffness_n_m3 is not None or ground is not None and ground.kind == "pad"


def _check_keys(case: CheckedCase, key: str, ground: Ground, refuse: Refuse) -> None:
    plain = Ground()
    for one, kinds in OF_KINDS.items():
        value, left_out = getattr(ground, one), getattr(plain, one)
        if ground.kind not in kinds and value != left_out and (value or left_out):
            meant = "a pad" if kinds == ("pad",) else f"a ground of kind {' or '.join(kinds)}"
            refuse(f"{key}.{one}", value, f"is of {meant}; {key}.kind = {ground.kind!r} has none")
    if ground.kind == "pad" and not ground.stiffness_n_m3:
        refuse(
            f"{key}.stiffness_n_m3",
            ground.stiffness_n_m3,
            f"must be greater than 0 N/m3 where {key}.kind = 'pad'",
        )
    if ground.motion and case.motion is None:
        refuse(f"{key}.motion", None, "needs a table [motion] as well, that of the other grounds")
    if ground.motion:
        check_strong_part(ground.motion, f"{key}.motion", refuse)


def _check_interface(case: CheckedCase, key: str, interface: Joint, refuse: Refuse) -> None:
    on_pad = _is_on_pad(case, interface)
    if interface.stiffness_n_m3 is None:
        for one in ("shear_stiffness_n_m3", "damping_ratio", "yield_pa"):
            if value := getattr(interface, one):
                refuse(f"{key}.{one}", value, f"is of a pad, which needs {key}.stiffness_n_m3")
    for one in _OF_IMPACTS:
        if on_pad and (value := getattr(interface, one)):
            refuse(f"{key}.{one}", value, _ON_PAD)
