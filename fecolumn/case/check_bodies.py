"""What keys of a body say together."""

from __future__ import annotations

import math
from collections.abc import Mapping

from fecolumn.case.bodies import (
    Arch,
    Block,
    Cone,
    Cylinder,
    Footed,
    MeshBody,
    Plate,
    Prism,
    Storeys,
    Tube,
    half_sides,
    rise,
)
from fecolumn.case.body_keys import Placed, Solid, WithMaterial
from fecolumn.case.check_plates import OwnSize, check_fine_height, check_plates
from fecolumn.case.check_thin import check_thin
from fecolumn.case.checked import Refuse
from fecolumn.case.polygon import crossing, signed_area
from fecolumn.case.sections import Material
from fecolumn.foundation.schema import meant, parameter_of

# Modes of Rayleigh's damping that are left out
_MODES = parameter_of(Storeys, "rayleigh_modes").default
# Of the square of a polygon's longest side: less area is none
_FLAT = 1e-9


def material_of(body: WithMaterial, materials: Mapping[str, Material]) -> Material:
    """Material of a body: that of its name, steel without one, with the keys that the body states
    itself.
    """
    named = materials[body.material] if body.material else Material()
    own = {
        key: getattr(body, key)
        for key in ("youngs_modulus_pa", "poissons_ratio", "density_kg_m3", "damping_ratio")
    }
    return Material(
        **{key: getattr(named, key) if value is None else value for key, value in own.items()}
    )


def check_body(key: str, body: Placed, materials: Mapping[str, Material], refuse: Refuse) -> None:
    """Refuse places, materials and dimensions that cannot be."""
    if body.at_m is not None and len(body.at_m) != 3:
        refuse(f"{key}.at_m", list(body.at_m), "must be three numbers: x, y, z")
    if body.copies_m and any(body.at_m or ()):
        refuse(
            f"{key}.copies_m",
            [list(place) for place in body.copies_m],
            "must stand without at_m: it has the place of each copy",
        )
    for place in body.copies_m:
        if len(place) != 3:
            refuse(f"{key}.copies_m", list(place), "must be three numbers for each copy: x, y, z")
    if len(set(body.copies_m)) < len(body.copies_m):
        refuse(
            f"{key}.copies_m", [list(place) for place in body.copies_m], "must be different places"
        )
    if not isinstance(body, WithMaterial):  # matrices have none
        return
    if body.material and body.material not in materials:
        refuse(
            f"{key}.material",
            body.material,
            f"no such table of [materials]{meant(body.material, materials)}; known: "
            f"{', '.join(materials) or f'none: state one as [materials.{body.material}]'}",
        )
    if body.mass_kg is not None and body.density_kg_m3 is not None:
        refuse(
            f"{key}.mass_kg",
            body.mass_kg,
            "must stand without density_kg_m3, which follows from it",
        )
    if isinstance(body, Tube) and body.wall_m >= body.outer_diameter_m / 2:
        refuse(
            f"{key}.wall_m",
            body.wall_m,
            f"must be less than the outer radius, {body.outer_diameter_m / 2:g} m; a "
            'solid one is kind = "cylinder"',
        )
    if isinstance(body, Solid):
        _check_solid(key, body, refuse)
    if isinstance(body, Storeys):
        _check_storeys(key, body, refuse)
    check_thin(key, body, refuse)


def _check_solid(key: str, body: Solid, refuse: Refuse) -> None:
    if body.moves_with and not body.fixed:
        refuse(f"{key}.moves_with", body.moves_with, f"is of a body with {key}.fixed = true")
    if body.contact_stiffness_n_m3 is not None and body.deforms:
        refuse(
            f"{key}.contact_stiffness_n_m3",
            body.contact_stiffness_n_m3,
            "is of a body with rigid = true or fixed = true; this one deforms",
        )
    if len(body.centre_m) not in (0, 3):
        refuse(f"{key}.centre_m", list(body.centre_m), "must be three numbers: x, y, z")
    if body.inertia_kg_m2:
        _check_inertia(f"{key}.inertia_kg_m2", body.inertia_kg_m2, refuse)
    if isinstance(body, (Footed, MeshBody)) and (size := body.cap_size_m) is not None:
        if body.cap is None:
            refuse(f"{key}.cap_size_m", size, "must be left out of a body without a cap")
        if isinstance(body, (Tube, Cylinder)) and body.fine_height_m is None:
            told = "has no effect: the elements of this cap are those of the body; state "
            refuse(f"{key}.cap_size_m", size, told + "fine_height_m to mesh the cap by itself")
    if isinstance(body, MeshBody):
        if body.coarse_size_m is not None:
            refuse(
                f"{key}.coarse_size_m",
                body.coarse_size_m,
                'says nothing of a body of kind = "mesh", whose elements are in its file',
            )
        if unfit := body.drawn.unfit():
            refuse(f"{key}.{unfit[0]}", *unfit[1:])
        return
    if isinstance(body, Prism):
        _check_prism(key, body, refuse)
        return
    if body.coarse_size_m is not None and body.coarse_size_m < (body.element_size_m or 0.0):
        refuse(
            f"{key}.coarse_size_m",
            body.coarse_size_m,
            f"must be at least element_size_m = {body.element_size_m:g} m",
        )
    if isinstance(body, (Tube, Cylinder, Block)):
        _check_foot(key, body, refuse)
        check_fine_height(f"{key}.fine_height_m", body.fine_height_m, body.height_m, refuse)
        check_plates(f"{key}.", _own_size(body), body.flange, body.cap, refuse)
    if isinstance(body, (Block, Plate)):
        shorter = min(body.length_m, body.width_m)
        if (size := body.element_size_m) is not None and size > shorter:
            refuse(
                f"{key}.element_size_m", size, f"must be at most the shorter side, {shorter:g} m"
            )
        return
    if isinstance(body, (Tube, Cylinder, Cone)):
        _check_round(key, body, refuse)


def _own_size(body: Tube | Cylinder | Block) -> OwnSize:
    if isinstance(body, Block):
        return OwnSize((body.length_m, body.width_m), ("length_m", "width_m"), 0.0)
    bore = body.outer_diameter_m - 2 * body.wall_m if isinstance(body, Tube) else 0.0
    return OwnSize((body.outer_diameter_m,) * 2, ("outer_diameter_m",) * 2, bore)


def _check_round(key: str, body: Tube | Cylinder | Cone, refuse: Refuse) -> None:
    """Refuse elements that do not make a body round."""
    around = math.pi * body.outer_diameter_m
    if (size := body.element_size_m) is not None and size > around / 12:
        refuse(
            f"{key}.element_size_m",
            size,
            f"must be at most {around / 12:.4g} m: fewer than 12 elements around do not "
            "make a round body",
        )


def _check_inertia(key: str, values: tuple[float, ...], refuse: Refuse) -> None:
    """Refuse a tensor that is none of a body."""
    told = list(values)
    if len(values) not in (3, 6):
        refuse(key, told, "must be three numbers, xx, yy, zz, or six with xy, xz, yz")
    if min(values[:3]) <= 0:
        refuse(key, told, "must have xx, yy and zz greater than 0 kg m2")
    for axis in range(3):
        if values[axis] >= sum(values[:3]) - values[axis]:
            refuse(
                key,
                told,
                f"is that of no body: {'xyz'[axis] * 2} must be less than the other two together",
            )


def _check_prism(key: str, body: Prism, refuse: Refuse) -> None:
    if body.coarse_size_m is not None:
        refuse(
            f"{key}.coarse_size_m",
            body.coarse_size_m,
            "says nothing of a prism, whose elements are of element_size_m throughout",
        )
    outline, plane = body.outline_m, "x, z" if body.along == "y" else "x, y"
    for corner in outline:
        if len(corner) != 2:
            refuse(
                f"{key}.outline_m",
                list(corner),
                f"must be two numbers [m] for each corner: {plane}",
            )
    told = [list(corner) for corner in outline]
    if len(outline) < 3:
        refuse(f"{key}.outline_m", told, "must be at least three corners [m]")
    for number, corner in enumerate(outline):
        if (first := outline.index(corner)) < number:
            refuse(
                f"{key}.outline_m",
                told,
                f"must be different corners: {first + 1} and {number + 1} are both "
                f"[{corner[0]:g}, {corner[1]:g}] m",
            )
    longest = max(math.dist(*sides) for sides in zip(outline, outline[1:] + outline[:1]))
    if all(
        abs(signed_area([one, other, third])) <= _FLAT * longest**2
        for one, other, third in zip(outline, outline[1:], outline[2:])
    ):
        refuse(f"{key}.outline_m", told, "must enclose an area: its corners lie on a line")
    if sides := crossing(outline):
        one, other = (
            f"from corner {side + 1} to {(side + 1) % len(outline) + 1}" for side in sides
        )
        refuse(
            f"{key}.outline_m",
            told,
            f"must not cross or touch itself: the side {one} meets that {other}",
        )


def check_arch(key: str, arch: Arch, refuse: Refuse) -> None:
    """Refuse rings that cannot be; what else is wrong is so of its voussoirs."""
    if arch.copies_m:
        refuse(
            f"{key}.copies_m",
            [list(place) for place in arch.copies_m],
            "must be left out: give each arch a name of its own",
        )
    for name in ("centre_m", "inertia_kg_m2"):
        if value := getattr(arch, name):
            refuse(f"{key}.{name}", list(value), "is of one body; an arch is several voussoirs")
    if arch.thickness_m >= 2 * arch.mean_radius_m:
        refuse(
            f"{key}.thickness_m",
            arch.thickness_m,
            f"must be less than twice mean_radius_m, {2 * arch.mean_radius_m:g} m",
        )
    span = arch.to_deg - arch.from_deg
    if not 0 < span < 360:
        refuse(
            f"{key}.to_deg",
            arch.to_deg,
            f"must be greater than from_deg = {arch.from_deg:g} deg, by less than 360 deg",
        )
    if span / arch.voussoirs / arch.arc_sides >= 90:
        refuse(
            f"{key}.voussoirs",
            arch.voussoirs,
            f"must be more, or arc_sides: a straight side spans {span / arch.voussoirs:g} deg "
            "here, less than 90 deg make an arc",
        )
    check_thin(key, arch, refuse)


def _check_foot(key: str, body: Tube | Cylinder | Block, refuse: Refuse) -> None:
    """Refuse spheres and edges that the foot has no room for."""
    halves = half_sides(body)
    if (radius := body.foot_radius_m) is not None:
        if body.edge_radius_m:
            refuse(
                f"{key}.edge_radius_m",
                body.edge_radius_m,
                "must be 0 where foot_radius_m makes the foot a dome",
            )
        if getattr(body, "flange", None):
            refuse(
                f"{key}.foot_radius_m",
                radius,
                "must stand without a flange: the foot of a flange is flat, or has an "
                "edge_radius_m",
            )
        if radius < (least := math.hypot(*halves)) * (1 - 1e-9):
            refuse(
                f"{key}.foot_radius_m",
                radius,
                f"must be at least {least:.6g} m, the "
                f"{'half diagonal' if halves[1] else 'radius'} of the foot",
            )
        if rise(body) >= body.height_m:
            refuse(
                f"{key}.foot_radius_m",
                radius,
                f"makes a dome {rise(body):.4g} m high, which must be less than "
                f"height_m = {body.height_m:g} m",
            )
    if body.edge_radius_m >= (least := min(half for half in halves if half)):
        refuse(
            f"{key}.edge_radius_m",
            body.edge_radius_m,
            f"must be less than {least:g} m, half the smaller side of the foot",
        )


def _check_storeys(key: str, body: Storeys, refuse: Refuse) -> None:
    for name, fewest in (
        ("floor_masses_kg", 1),
        ("storey_heights_m", 1),
        ("stiffness_x_n_m", 0),
        ("stiffness_y_n_m", 0),
    ):
        if len(values := getattr(body, name)) not in (fewest, 1, body.floors):
            refuse(
                f"{key}.{name}",
                list(values),
                f"must be one number, or floors = {body.floors} numbers",
            )
    if bool(body.stiffness_x_n_m) == (body.period_s is not None):
        refuse(
            f"{key}.period_s",
            body.period_s,
            "must stand where stiffness_x_n_m does not: the building needs one of them",
        )
    if body.stiffness_y_n_m and not body.stiffness_x_n_m:
        refuse(
            f"{key}.stiffness_y_n_m", list(body.stiffness_y_n_m), "must stand with stiffness_x_n_m"
        )
    if body.profile != "uniform" and body.period_s is None:
        refuse(f"{key}.profile", body.profile, "says nothing without period_s")
    if body.damping != "rayleigh" and body.rayleigh_modes != _MODES:
        refuse(
            f"{key}.rayleigh_modes",
            list(body.rayleigh_modes),
            f'says nothing without {key}.damping = "rayleigh"',
        )
    if body.damping == "rayleigh" and body.floors > 1:
        modes = body.rayleigh_modes
        if len(modes) != 2 or not modes[0] < modes[1] <= body.floors:
            refuse(
                f"{key}.rayleigh_modes",
                list(modes),
                f"must be two rising numbers up to floors = {body.floors}",
            )
