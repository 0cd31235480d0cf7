"""The links of a structure as engines take them, and whether a step can follow them."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import bisect

from fecolumn.contact.points import GROUND
from fecolumn.engines.dynamics.bonds import bond_links, bonded
from fecolumn.engines.dynamics.links import LINK, Linked
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.hht import HHT
    from fecolumn.structures.model import StructureModel

# Share of a change of the links' forces that the motion within a step may answer at once: beyond it
# the step is too long for the links
STIFFEST = 0.5
# Share from which on the motion converges slowly, and steps of glued bodies are often halved
_SLOW = 0.25


class StiffLink(ValueError):
    """A link or a dashpot too stiff for the step; the message begins with its key, such as
    "links.tie", and names the longest step.
    """


def links_of(model: StructureModel, hht: HHT, filters: Array | None = None) -> Linked:
    """The links of a StructureModel, and after them those of its bonded joints.

    filters: (nb, m) of the modes of each body that move; None where links are held by the rigid
    motion.

    Raises
    ------
    StiffLink
        links too stiff, or dashpots too strong, for the step; names the one with most of it.
    """
    own, bonds = _own_links(model), bond_links(model)
    ends = [(link.shape_a, link.shape_b) for link in model.links] + list(bonds.shapes)
    links = np.concatenate([own, bonds.links]).astype(LINK)
    linked = Linked(links, _filtered(links, ends, filters))
    _check_step(model, linked, hht)
    return linked


def _filtered(links: Array, shapes: list[tuple[None, None]], filters: Array | None) -> Array:
    """Shapes (nl, 2, 3, m) of the modes that move at the ends of links; `shapes` of each are those
    of its two ends, (3, k) or None.
    """
    modes = 0 if filters is None else filters.shape[1]
    found = np.zeros((len(links), 2, 3, modes))
    for row, link, both in zip(found, links, shapes):
        for side, (b, shape) in enumerate(zip((link["a"], link["b"]), both)):
            if b != GROUND and shape is not None and modes:
                count = min(shape.shape[1], modes)
                row[side, :, :count] = shape[:, :count] * filters[b, :count]
    return found


def _own_links(model: StructureModel) -> Array:
    """Links (nl,) of LINK that the case names."""
    links = np.zeros(len(model.links), LINK)
    for row, link in zip(links, model.links):
        sides = [
            (model.parts[b] if b != GROUND else None, np.asarray(arm, float))
            for b, arm in ((link.a, link.arm_a), (link.b, link.arm_b))
        ]
        ends = [arm if part is None else part.center + part.rotation @ arm for part, arm in sides]
        length = np.linalg.norm(ends[1] - ends[0])
        held = link.slack + link.prestress / link.stiffness if link.prestress else 0.0
        row["a"], row["b"], row["arm_a"], row["arm_b"] = link.a, link.b, link.arm_a, link.arm_b
        row["length"], row["play"], row["stiffness"], row["damping"] = (
            length - held,
            link.slack,
            link.stiffness,
            link.damping,
        )
        row["pulls"], row["pushes"], row["yields"] = link.pulls, link.pushes, link.yield_n
        row["hardens"] = link.stiffness * link.hardening / (1.0 - link.hardening)
        row["bends"], row["power"], row["slow"] = link.bends, link.power, link.slow
        row["ground"] = link.ground
        row["breaks"] = link.breaking_n / link.stiffness if link.stiffness else np.inf
    return links


def _check_step(model: StructureModel, linked: Linked, hht: HHT) -> None:
    """Refuse links that a step of `hht` cannot follow."""
    links = linked.links
    bodies = [
        (part.model.mass, part.model.inertia, part.center, part.rotation) for part in model.parts
    ]

    steepest = _steepest(links)

    def shrinks(dt: float) -> list[Array]:
        share = (dt / hht.dt) ** 2 * hht.stiffness_factor / hht.mass_factor
        return [1 / (1 + share * part.model.frequencies**2) for part in model.parts]

    def answered(dt: float) -> tuple[float, int]:
        square, place = fastest(linked, links["stiffness"] + steepest / dt, bodies, shrinks(dt))
        return square * dt**2 / 2, place

    def longest(most: float) -> float:
        return bisect(lambda dt: answered(dt)[0] - most, 1e-9 * hht.dt, hht.dt, rtol=1e-3)

    share, place = answered(hht.dt)
    if share > _SLOW and (bond := links["bond"][place]):
        joint = bonded(model)[bond - 1]
        layer = f"joints.{joint.name.partition(':')[0]}: a layer of {joint.bond.stiffness:g} N/m3"
        if share > STIFFEST:
            raise StiffLink(
                f"{layer} under such light bodies needs steps of at most {longest(STIFFEST):.2g} "
                "s, or a softer layer"
            )
        warnings.warn(
            f"{layer} under such light bodies is almost too stiff for steps of {hht.dt:g} s: many "
            f"are halved, and steps of {longest(_SLOW):.2g} s may take less time in all",
            stacklevel=2,
        )
    if share > STIFFEST:
        link = model.links[place]
        much = " and ".join(
            f"{value:g} {unit}"
            for value, unit in (
                (link.stiffness, "N/m"),
                (link.damping, "N s/m" if link.power == 1 else "N at 1 m/s"),
            )
            if value
        )
        slower = ""
        if link.damping and link.power < 1:
            speed = link.slow * (share / STIFFEST) ** (1 / (1 - link.power))
            slower = f", or linear_below_m_s of {speed:.2g} m/s or more"
        raise StiffLink(
            f"links.{link.name}: {much} between such light bodies, with the links "
            f"beside it, needs steps of at most {longest(STIFFEST):.2g} s{slower}"
        )


def _steepest(links: Array) -> Array:
    """Largest change (nl,) of the dashpots' forces per rate [N s/m], up to 1 m/s."""
    power, slow = links["power"], links["slow"]
    below = np.where(power < 1, slow, 1.0) ** (power - 1)
    return links["damping"] * np.maximum(power, 1.0) * below


def fastest(
    linked: Linked, stiffness: Array, bodies: list[tuple], shrinks: list[Array] | None = None
) -> tuple[float, int]:
    """Square of the fastest frequency [1/s2] at which free bodies swing on their links, were these
    as stiff as `stiffness` (nl,) [N/m]; place of the link that does most.

    Parameters
    ----------
    linked
        what has links and ends as Linked has.
    bodies
        mass [kg], inertia (3, 3) [kg m2], centre of mass (3,) [m] and rotation (3, 3) of each.
    shrinks
        of each body, how much less its modes (m,) move in a step than were they free; without
        them bodies are rigid.
    """
    if not len(linked.links):
        return 0.0, 0
    rows, places = rows_of_links(linked, stiffness, bodies, shrinks)
    if len(rows) <= rows.shape[1]:
        squares, shapes = np.linalg.eigh(rows @ rows.T)
        most = shapes[:, -1]
    else:
        squares, shapes = np.linalg.eigh(rows.T @ rows)
        most = rows @ shapes[:, -1]
    return float(squares[-1]), places[int(np.argmax(np.abs(most)))]


def fastest_of_each(
    linked: Any, stiffness: Array, bodies: list[tuple], shrinks: list[Array]
) -> Array:
    """Squares (nb,) of frequencies [1/s2] of which none of the bodies swings faster, were their
    masses times these: with such inertia together they answer their links as strongly as each.

    That of each body while the others stay, at most 2 times as much, as a link has two ends.
    Arguments as of `fastest`.
    """
    rows, _ = rows_of_links(linked, stiffness, bodies, shrinks)
    modes = linked.ends.shape[3]
    owners = np.concatenate([np.repeat(np.arange(len(bodies)), count) for count in (6, modes)])
    alone = np.array([np.linalg.norm(rows[:, owners == b], 2) ** 2 for b in range(len(bodies))])
    scaled = rows / np.sqrt(np.where(alone > 0.0, alone, 1.0))[owners]
    return np.linalg.norm(scaled, 2) ** 2 * alone


def rows_of_links(
    linked: Any,
    stiffness: Array,
    bodies: list[tuple[float, Array, Array, Array]],
    shrinks: list[Array] | None,
) -> tuple[Array, list[int]]:
    """Rows (k, 6 nb + nb m) of which the squares add up to the stiffness of links over the masses,
    first of the bodies' rigid motion, then of their modes; places (k,) of their links; arguments as
    of `fastest`.
    """
    links, ends = linked.links, linked.ends
    modes, rigid = ends.shape[3] if shrinks is not None else 0, 6 * len(bodies)
    pulls, places = [], []
    for place, (link, its) in enumerate(zip(links, stiffness)):
        sides = [(int(link["a"]), link["arm_a"], 1.0), (int(link["b"]), link["arm_b"], -1.0)]
        tips = [arm if b == GROUND else bodies[b][2] + bodies[b][3] @ arm for b, arm, _ in sides]
        length = np.linalg.norm(tips[1] - tips[0])
        # one of no length may come to pull in any direction
        for along in [(tips[1] - tips[0]) / length] if length else np.eye(3):
            row = np.zeros(rigid + modes * len(bodies))
            for side, (b, arm, sign) in enumerate(sides):
                if b != GROUND:
                    mass, inertia, _, rotation = bodies[b]
                    # in the body's frame, over the roots of mass and inertia
                    local = rotation.T @ along
                    row[6 * b : 6 * b + 3] += sign * local / np.sqrt(mass)
                    row[6 * b + 3 : 6 * b + 6] += sign * np.linalg.solve(
                        np.linalg.cholesky(inertia), np.cross(arm, local)
                    )
                    if shrinks is not None and modes:
                        count = len(shrinks[b])
                        at = rigid + modes * b
                        moved = local @ ends[place, side, :, :count]
                        row[at : at + count] += sign * moved * np.sqrt(shrinks[b])
            pulls.append(np.sqrt(its) * row)
            places.append(place)
    return np.array(pulls), places
