"""Bodies that stand on one another, as the compiled engine takes them: from the plain numbers of a `structures.model.StructureModel`."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.bodies import FACET, Bodies, joined, node_matrix, one_body
from fecolumn.contact.interface import interface_of
from fecolumn.contact.points import BASE, node_points
from fecolumn.contact.rim import Rim
from fecolumn.dynamics.overturning import Stance
from fecolumn.reduced.links import LINK
from fecolumn.reduced.model import Structure, modal_sum
from fecolumn.reduced.observe import MARK, View
from fecolumn.reduced.pose import poses_of

# Tilt of a body at which it is lost [rad]: far beyond what any structure that still stands reaches
LOST = np.pi / 4
# Share of the change of a link's force that the motion within a step may answer at once: beyond it the step is too long for the link
STIFFEST = 0.5


def structure_of(model, hht, gravity) -> tuple[Structure, np.ndarray]:
    """Structure as steps of `hht` see it, and its points (P,) of POINT.

    Args:
        model: StructureModel, each part with the modes that are to move.
    Raises:
        ValueError: a link is too stiff for the step; names it and the longest step.
    """
    parts, modes = model.parts, max(len(part.model.frequencies) for part in model.parts)
    squares, damping, pushes, bodies = np.zeros((len(parts), modes)), np.zeros((len(parts), modes)), [], []
    for b, part in enumerate(parts):
        body, m = part.model, len(part.model.frequencies)
        squares[b, :m], ratio = body.frequencies**2, part.damping_ratio if body.damping is None else body.damping
        damping[b, :m] = 2 * ratio * body.frequencies
        shrink = 1 / (1 + squares[b, :m] * hht.stiffness_factor / hht.mass_factor)
        own = body.shapes * (2 * shrink - shrink**2)
        static = node_matrix(body.flexibility) - modal_sum(own, 1 / squares[b, :m])
        bodies.append(one_body(body.arms, static, modal_sum(own, np.ones(m)), float(body.mass), body.inertia))
        pushes.append(np.pad(own, ((0, 0), (0, 0), (0, modes - m))))
    whole, first = joined(bodies), np.cumsum([0] + [len(part.model.arms) for part in parts])
    reach = np.concatenate([np.sqrt((own[..., :len(part.model.frequencies)] ** 2 / part.model.frequencies**2).sum(axis=(1, 2))) for own, part in zip(pushes, parts)])
    facets, found = np.zeros(0, FACET), {}
    points, interfaces, rims = [], [], []
    for k, joint in enumerate(model.joints):
        slave, n_points = parts[joint.slave].model, sum(map(len, points))
        nodes = slave.surfaces[joint.slave_surface].nodes
        arms = slave.arms[nodes]
        rim = Rim.find(arms) if joint.round else None
        interface = interface_of(arms, rim, joint.restitution, slave=joint.slave, master=joint.master)
        interface["width"] = np.ptp(arms @ slave.surfaces[joint.slave_surface].axes[:, :2], axis=0).max()
        interface["rim_first"] = sum(map(len, rims))
        rims.append(n_points + np.asarray(rim.nodes if rim else [], np.int64))
        if joint.master != BASE:
            surface = parts[joint.master].model.surfaces[joint.master_surface]
            key = joint.master, joint.master_surface
            if key not in found:
                found[key] = len(facets)
                facets = np.concatenate([facets, facets_of(surface, parts[joint.master].model.arms, first[joint.master])])
            interface["facet_first"], interface["facet_count"] = found[key], len(surface.triangles)
            interface["origin"], interface["axes"] = surface.origin, surface.axes
            interface["reach"] = reach[first[joint.master] + surface.nodes].max()
        own = node_points(arms, joint.friction, joint.law, slave=joint.slave, master=joint.master, interface=k)
        own["node"] = first[joint.slave] + nodes
        own["carriers"] = own["node"][:, None]
        points.append(own)
        interfaces.append(interface)
    structure = Structure(Bodies(*whole[:4], facets), np.ascontiguousarray(np.concatenate(pushes)), squares, damping, reach, np.concatenate(interfaces),
                          np.concatenate(rims), links_of(model, hht), np.array(gravity, float))
    return structure, np.concatenate(points)


def facets_of(surface, arms: np.ndarray, first: int) -> np.ndarray:
    """Triangles (t,) of FACET of a Surface of a body with nodes at `arms` (n, 3), in rows from `first` on."""
    facets, sides = np.zeros(len(surface.triangles), FACET), {}
    facets["nodes"] = first + surface.nodes[surface.triangles]
    facets["corners"] = ((arms[surface.nodes] - surface.origin) @ surface.axes[:, :2])[surface.triangles]
    facets["neighbours"] = -1
    for number, triangle in enumerate(surface.triangles):
        for q in range(3):
            side = frozenset((triangle[(q + 1) % 3], triangle[(q + 2) % 3]))
            if side in sides:
                other, place = sides.pop(side)
                facets["neighbours"][number, q], facets["neighbours"][other, place] = other, number
            else:
                sides[side] = number, q
    return facets


def links_of(model, hht) -> np.ndarray:
    """Links (nl,) of LINK."""
    links = np.zeros(len(model.links), LINK)
    for row, link in zip(links, model.links):
        sides = [(model.parts[b] if b != BASE else None, np.asarray(arm, float)) for b, arm in ((link.a, link.arm_a), (link.b, link.arm_b))]
        ends = [arm if part is None else part.center + part.rotation @ arm for part, arm in sides]
        length = np.linalg.norm(ends[1] - ends[0])
        along = (ends[1] - ends[0]) / length
        # how far a force along the link moves its ends apart: by which the fixed point of a step contracts
        turns = [(part, np.cross(arm, part.rotation.T @ along)) for part, arm in sides if part is not None]
        gives = sum(1 / part.model.mass + turn @ np.linalg.solve(part.model.inertia, turn) for part, turn in turns)
        if link.stiffness * gives * hht.dt**2 / 2 > STIFFEST:
            longest = np.sqrt(2 * STIFFEST / (link.stiffness * gives))
            raise ValueError(f"links.{link.name}: a stiffness of {link.stiffness:g} N/m between such light bodies needs steps of at most {longest:.2g} s")
        held = link.slack + link.prestress / link.stiffness if link.prestress else 0.0
        row["a"], row["b"], row["arm_a"], row["arm_b"] = link.a, link.b, link.arm_a, link.arm_b
        row["length"], row["play"], row["stiffness"], row["damping"] = length - held, link.slack, link.stiffness, link.damping
        row["pulls"], row["pushes"], row["yields"], row["breaks"] = link.pulls, link.pushes, link.yield_n, link.breaking_n
    return links


def view_of(model, structure, weight: float, cap: float = 0.0, lost: float = LOST) -> View:
    """What is watched of a StructureModel.

    Args:
        weight: of all bodies [N]. cap: horizontal displacement of the observed mark that counts as overturned [m], 0 for none. lost: tilt of any body that does [rad].
    """
    centers, rotations = np.array([part.center for part in model.parts]), np.tile(np.eye(3), (len(model.parts), 1, 1))
    modes, (body, name) = structure.squares.shape[1], model.observed
    names = [(b, mark) for b, part in enumerate(model.parts) for mark in part.model.marks]
    marks, shapes = np.zeros(len(names), MARK), np.zeros((len(names), 3, modes))
    for n, (b, mark) in enumerate(names):
        arm, shape = model.parts[b].model.marks[mark]
        marks[n]["body"], marks[n]["arm"], shapes[n, :, :shape.shape[1]] = b, arm, shape
    place = names.index((body, name))
    feet = [joint for joint in model.joints if joint.slave == body]
    foot = model.parts[body].model.arms[model.parts[body].model.surfaces[feet[0].slave_surface].nodes].mean(axis=0) if feet else np.zeros(3)
    stance = Stance(np.zeros((1, 2)), 1.0, np.inf, np.ascontiguousarray(model.parts[body].model.inertia, float), float(weight), 0.0, float(cap) if cap > 0 else np.inf)
    return View(centers, body, np.array(marks[place]["arm"]), np.ascontiguousarray(shapes[place]), foot, np.zeros((3, modes)), stance,
                np.full(len(centers), float(lost)), np.array(poses_of(structure.interfaces, centers, rotations)["foot"]), marks, shapes)
