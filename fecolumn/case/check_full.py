"""What a structure must not state where all degrees of freedom of its bodies move."""

from __future__ import annotations

from fecolumn.case.bodies import Storeys
from fecolumn.case.body_keys import WithMaterial
from fecolumn.case.check_bodies import material_of
from fecolumn.case.checked import CheckedCase, Refuse


def check_full(case: CheckedCase, refuse: Refuse) -> None:
    """Refuse keys that a case with integration.engine = "full" cannot have."""
    for name, body in case.bodies.items():
        if isinstance(body, Storeys) or not isinstance(body, WithMaterial):  # none of elements
            continue
        for key in ("foot_radius_m", "edge_radius_m"):
            if value := getattr(body, key, None):
                refuse(
                    f"bodies.{name}.{key}",
                    value,
                    'must be left out with integration.engine = "full": a ball touches beside '
                    "the nodes that carry it, where elements say nothing of how much they give; "
                    "the reduced and the rigid engine compute it",
                )
        ratio, where = body.damping_ratio, f"bodies.{name}"
        if ratio is None:
            ratio = material_of(body, case.materials).damping_ratio
            where = f"materials.{body.material}"
        if ratio and case.integration.kinematics != "corotated":
            refuse(
                f"{where}.damping_ratio",
                ratio,
                "must be 0 where integration.kinematics is not 'corotated': modes are those of "
                "the unstrained body",
            )
    for name, joint in case.joints.items():
        if joint.bond_tension_pa:
            refuse(
                f"joints.{name}.bond_tension_pa",
                joint.bond_tension_pa,
                'must be left out with integration.engine = "full", whose contact pushes but '
                'never pulls: integration.engine = "reduced" or "rigid" computes wax and mortar',
            )
    if case.contact.impact == "none":
        _check_no_impacts(case, refuse)


def _check_no_impacts(case: CheckedCase, refuse: Refuse) -> None:
    """Refuse what belongs to an impact where contact is that of the literal HHT scheme."""
    told = "must be 0 where contact.impact = 'none'"
    for key in ("restitution", "rolling_resistance"):
        if value := getattr(case.contact, key):
            refuse(f"contact.{key}", value, told)
        for name, interface in case.joints.items():
            if value := getattr(interface, key, None):
                refuse(f"joints.{name}.{key}", value, told)
    if case.integration.substeps == "impacts":
        refuse(
            "integration.substeps",
            case.integration.substeps,
            "must be rolling or none where contact.impact = 'none': there are no impacts to "
            "find in a step",
        )
