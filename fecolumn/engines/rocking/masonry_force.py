"""Force-based multipliers of masonry walls out of plane: the acceleration over g at which a
mechanism of rigid blocks begins to move.

Each is the principle of virtual work for rigid blocks without tension in their joints: what the
loads' horizontal work gains is what weights lose by being lifted, and friction by being overcome
(the review of Casapulla, Giresini and Lourenco 2017, equations 8 to 12).
"""

from __future__ import annotations


def free_wall_multiplier(thickness: float, height: float) -> float:
    """alpha_0 = b/h of a wall that turns about the edge of its foot."""
    _positive(thickness=thickness, height=height)
    return thickness / height


def hinged_wall_multiplier(
    thickness: float,
    height: float,
    overburden: float = 0.0,
    *,
    hinge: float = 0.5,
    load_at: float = 0.0,
) -> float:
    """alpha_0 of a wall held at its top that opens a hinge between.

    The lower part, c of the height, turns by theta about the edge on the side to which the wall
    bulges; the hinge is at the opposite face and is lifted by t theta; the upper part turns back by
    theta c/(1 - c). With W the wall's weight and P the load on its top

        alpha_0 = 2 {t + P/W [t + (t - x) c/(1 - c)]} / (c h).

    Halfway and with the load on the edge, x = 0, where a stiff floor puts it, this is 4 (1 + psi)
    t/h, psi = P/(W/2): the load over the weight above the hinge.

    Parameters
    ----------
    thickness, height
        t, h [m].
    overburden
        psi at mid-height, P/(W/2) [-], whatever the hinge.
    hinge
        c, its height over the wall's, in (0, 1).
    load_at
        x/t, distance of the load from the face to which the wall bulges, in [0, 1].
    """
    _positive(thickness=thickness, height=height)
    if not 0 < hinge < 1 or not 0 <= load_at <= 1 or overburden < 0:
        raise ValueError(
            f"hinge = {hinge:g} must lie in (0, 1), load_at = {load_at:g} in [0, 1], "
            f"overburden = {overburden:g} must not be negative"
        )
    share = overburden / 2
    return (
        2 * thickness * (1 + share * (1 + (1 - load_at) * hinge / (1 - hinge))) / (hinge * height)
    )


def side_wall_friction(
    rows: int,
    unit_weight: float,
    thickness: float,
    block_height: float,
    block_length: float,
    friction: float,
) -> float:
    """F_P [N]: friction of two side walls whose blocks interlock with the facade, fully mobilised
    (equation 10).

    A crack along the corner crosses every second bed joint on half a block's length l_b/2. Below i
    rows it is pressed by their weight, S_i = gamma t h_b i (l_b/2) f; twice the sum over n rows is
    gamma t h_b l_b f n (n + 1)/2.

    Parameters
    ----------
    rows
        n, crossed by the crack.
    unit_weight
        gamma [N/m3].
    thickness
        of a side wall [m].
    block_height, block_length
        [m].
    friction
        coefficient f.
    """
    _positive(
        rows=rows,
        unit_weight=unit_weight,
        thickness=thickness,
        block_height=block_height,
        block_length=block_length,
    )
    return unit_weight * thickness * block_height * block_length * rows * (rows + 1) / 2 * friction


def side_wall_lever(rows: int, block_height: float) -> float:
    """Height [m] of F_P over the hinge at the foot: (n - 1) h_b/3 where the friction of row i acts
    in the joint below it; H/3 for many rows.
    """
    return (rows - 1) * block_height / 3


def floor_friction(load: float, friction: float) -> float:
    """F_Q [N]: friction below beams that may slip out of the wall (equation 11)."""
    return load * friction


def facade_multiplier(
    weight: float,
    height: float,
    thickness: float,
    floor_load: float = 0.0,
    floor: float = 0.0,
    sides: float = 0.0,
    *,
    lever: float | None = None,
) -> float:
    """alpha_0 of a facade about the edge of its foot, held by side walls and by a floor on its top
    (equation 12).

    (P s/2 + 2 Q s/3 + F_Q H + F_P H/3) / (Q H + P H/2): the floor's load acts a third of the
    thickness from the inner face.

    Parameters
    ----------
    weight
        P of the facade [N].
    height
        H [m].
    thickness
        s [m].
    floor_load
        Q on its top [N].
    floor
        F_Q of `floor_friction` [N].
    sides
        F_P of `side_wall_friction` [N].
    lever
        height of F_P [m]; None for H/3.
    """
    _positive(weight=weight, height=height, thickness=thickness)
    righting = (
        weight * thickness / 2
        + floor_load * 2 * thickness / 3
        + floor * height
        + sides * (height / 3 if lever is None else lever)
    )
    return righting / (floor_load * height + weight * height / 2)


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not value > 0:
            raise ValueError(f"{name} = {value:g} must be greater than 0")
