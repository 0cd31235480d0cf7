"""Links between points of two bodies, or of a body and the ground: tendons, springs, struts, stops,
restrainers with play, dashpots and friction dampers.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import bisect

from fecolumn.contact.points import BASE
from fecolumn.contact.record import record
from fecolumn.engines.dynamics.link_law import drag_of, follow_elongation, strain_of, stretch_of
from fecolumn.foundation._compiled import njit

#: A link from body a to body b, -1 for a ground; ground: which one then; arm_a, arm_b: (3,) of its
#: ends from the centres of mass in the bodies' frames, of a ground where it is in the table frame
#: at the start [m]; length: unstressed [m];
#: play: way at either side of it without force [m]; stiffness [N/m]; damping [N s/m]; pulls,
#: pushes: whether it can; yields: force at which it flows [N]; hardens: what more it takes per
#: length that has flowed [N/m]; bends: exponent of the curve along which it comes to flow, infinite
#: where it does so at once; power: of the rate of elongation, to which a dashpot's force is
#: proportional, from `slow` [m/s] on; breaks: elongation beyond its play [m] at which it fails;
#: infinite where it does not.
LINK = record(
    ("a", "i8"),
    ("b", "i8"),
    ("ground", "i8"),
    ("arm_a", "f8", 3),
    ("arm_b", "f8", 3),
    ("length", "f8"),
    ("play", "f8"),
    ("stiffness", "f8"),
    ("damping", "f8"),
    ("pulls", "?"),
    ("pushes", "?"),
    ("yields", "f8"),
    ("hardens", "f8"),
    ("bends", "f8"),
    ("power", "f8"),
    ("slow", "f8"),
    ("breaks", "f8"),
)
#: What a link carries from step to step: its length now and the part of it that has flowed [m];
#: force [N], pull > 0, a dashpot's part of it the mean over the step; work: energy that its
#: dashpot, yielding and breaking have taken [J]; whether it is broken.
TIE = record(("length", "f8"), ("flowed", "f8"), ("force", "f8"), ("work", "f8"), ("broken", "?"))
# Share of a change of the links' forces that the motion within a step may answer at once: beyond it
# the step is too long for the links
STIFFEST = 0.5


def links_of(model, hht) -> np.ndarray:
    """Links (nl,) of LINK.

    Raises
    ------
    ValueError
        links too stiff, or dashpots too strong, for the step; names the one with most of it and the
        longest step.
    """
    links = np.zeros(len(model.links), LINK)
    for row, link in zip(links, model.links):
        sides = [
            (model.parts[b] if b != BASE else None, np.asarray(arm, float))
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
    bodies = [
        (part.model.mass, part.model.inertia, part.center, part.rotation) for part in model.parts
    ]

    steepest = _steepest(links)

    def answered(dt):
        square, place = fastest(links, links["stiffness"] + steepest / dt, bodies)
        return square * dt**2 / 2, place

    share, place = answered(hht.dt)
    if share > STIFFEST:
        longest, link = (
            bisect(lambda dt: answered(dt)[0] - STIFFEST, 1e-9 * hht.dt, hht.dt, rtol=1e-3),
            model.links[place],
        )
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
        raise ValueError(
            f"links.{link.name}: {much} between such light bodies, with the links "
            f"beside it, needs steps of at most {longest:.2g} s{slower}"
        )
    return links


def _steepest(links: np.ndarray) -> np.ndarray:
    """Largest change (nl,) of the dashpots' forces per rate [N s/m], up to 1 m/s."""
    power, slow = links["power"], links["slow"]
    below = np.where(power < 1, slow, 1.0) ** (power - 1)
    return links["damping"] * np.maximum(power, 1.0) * below


def fastest(links: np.ndarray, stiffness: np.ndarray, bodies: list[tuple]) -> tuple[float, int]:
    """Square of the fastest frequency [1/s2] at which free rigid bodies swing on their links, were
    these as stiff as `stiffness` (nl,) [N/m]; place of the link that does most.

    bodies: mass [kg], inertia (3, 3) [kg m2], centre of mass (3,) [m] and rotation (3, 3) of each.
    """
    if not len(links):
        return 0.0, 0
    pulls, places = [], []
    for place, (link, its) in enumerate(zip(links, stiffness)):
        sides = [(int(link["a"]), link["arm_a"], 1.0), (int(link["b"]), link["arm_b"], -1.0)]
        ends = [arm if b == BASE else bodies[b][2] + bodies[b][3] @ arm for b, arm, _ in sides]
        length = np.linalg.norm(ends[1] - ends[0])
        # one of no length may come to pull in any direction
        for along in [(ends[1] - ends[0]) / length] if length else np.eye(3):
            row = np.zeros(6 * len(bodies))
            for b, arm, sign in sides:
                if b != BASE:
                    mass, inertia, _, rotation = bodies[b]
                    # in the body's frame, over the roots of mass and inertia
                    local = rotation.T @ along
                    row[6 * b : 6 * b + 3] += sign * local / np.sqrt(mass)
                    row[6 * b + 3 : 6 * b + 6] += sign * np.linalg.solve(
                        np.linalg.cholesky(inertia), np.cross(arm, local)
                    )
            pulls.append(np.sqrt(its) * row)
            places.append(place)
    squares, shapes = np.linalg.eigh(np.array(pulls) @ np.transpose(pulls))
    return float(squares[-1]), places[int(np.argmax(np.abs(shapes[:, -1])))]


@njit
def _end_of(b, arm, ground, frames, rotation, target):
    """Target (3,): where an end of a link is; ground: that which holds it, where one does."""
    for a in range(3):
        if b == BASE:
            target[a] = arm[a] + ground.moved[a]
        else:
            R = rotation[b]
            target[a] = frames[b].center[a] + R[a, 0] * arm[0] + R[a, 1] * arm[1] + R[a, 2] * arm[2]


@njit
def span(link, grounds, frames, rotation, target):
    """Target (3,): way from end a to end b [m]; its length."""
    other = np.empty(3)
    ground = grounds[link.ground]
    _end_of(link.a, link.arm_a, ground, frames, rotation, other)
    _end_of(link.b, link.arm_b, ground, frames, rotation, target)
    square = 0.0
    for a in range(3):
        target[a] -= other[a]
        square += target[a] ** 2
    return np.sqrt(square)


@njit
def pull(link, tie, begin, way, length, dt, target):
    """Target (3,): force [N] of a link on its end a within a step, on b the opposite; the elastic
    force and that of the dashpot.

    A discrete gradient (Gonzalez 1996): its work is the loss of strain energy and what yielding
    takes, exactly; the dashpot's its force at the mean rate times l1 - l0.

    Parameters
    ----------
    begin, way
        (3,) from a to b at the start and at the end of the step [m].
    length
        at the end [m]; tie.length is that at the start.
    """
    before, elastic, rate = tie.length, 0.0, (length - tie.length) / dt
    if not tie.broken:
        s0, change = stretch_of(link, before - link.length - tie.flowed), length - before
        s1, flow, lost = follow_elongation(link, tie, length)
        first, last = link.stiffness * s0, link.stiffness * s1
        elastic = (first + last) / 2
        if (flow != 0.0 or s0 * s1 <= 0.0) and abs(change) > 1e-12 * link.length:
            held_back = link.hardens * (tie.flowed + flow / 2) * flow
            elastic = (elastic * (s1 - s0) + lost + held_back) / change
            # a mean of the forces on the way, but for rounding
            elastic = min(max(elastic, min(first, last)), max(first, last))
    total = elastic + (0.0 if tie.broken else drag_of(link, rate))
    for a in range(3):
        # without length at both ends of the step it has no direction, and no force
        target[a] = (
            total * (begin[a] + way[a]) / (before + length) if before + length > 0.0 else 0.0
        )
    return total


@njit
def pull_links(
    links,
    ties,
    grounds,
    frames,
    rotation,
    later_grounds,
    later_frames,
    later_rotation,
    dt,
    pulls,
):
    """Pulls (nl, 3): forces [N] of links with `ties` (nl,) on their ends a, in a step that brings
    grounds and bodies from the first places and rotations to the later ones; the largest change
    over the largest force.
    """
    begin, way, force, change, largest = np.empty(3), np.empty(3), np.empty(3), 0.0, 0.0
    for n in range(len(links)):
        span(links[n], grounds, frames, rotation, begin)
        length = span(links[n], later_grounds, later_frames, later_rotation, way)
        pull(links[n], ties[n], begin, way, length, dt, force)
        for a in range(3):
            change, largest = max(change, abs(force[a] - pulls[n, a])), max(largest, abs(force[a]))
            pulls[n, a] = force[a]
    return change / largest if largest > 0.0 else 0.0


@njit
def strain_of_links(links, ties):
    """Strain energy [J] of links with `ties` (nl,)."""
    energy = 0.0
    for n in range(len(links)):
        if not ties[n].broken:
            over = ties[n].length - links[n].length - ties[n].flowed
            energy += strain_of(links[n], stretch_of(links[n], over), ties[n].flowed)
    return energy


@njit
def end_links(links, grounds, frames, rotation, before, after, dt):
    """Carry ties (nl,) on to the end of a step: strain energy at its end, energy that their
    dashpots, yielding and breaking have taken in it [J].
    """
    kept = taken = 0.0
    way = np.empty(3)
    for n in range(len(links)):
        link, tie, new = links[n], before[n], after[n]
        length = span(link, grounds, frames, rotation, way)
        new.flowed, new.broken, new.length, new.work, new.force = (
            tie.flowed,
            tie.broken,
            length,
            tie.work,
            0.0,
        )
        if tie.broken:
            continue
        trial = stretch_of(link, length - link.length - tie.flowed)
        viscous = drag_of(link, (length - tie.length) / dt)
        stretch, flow, yielding = follow_elongation(link, tie, length)
        new.flowed += flow
        held = strain_of(link, stretch, new.flowed)
        lost = viscous * (length - tie.length) + yielding
        # a link that yields breaks where it would carry the breaking force if it did not yield
        if trial != 0.0 and abs(trial + tie.flowed) > link.breaks:
            new.broken = True
            lost += held
        else:
            new.force = link.stiffness * stretch + viscous
            kept += held
        new.work += lost
        taken += lost
    return kept, taken
