"""Where bodies meet: points, interfaces, rims and facets, from the plain numbers of a
`structures.model.StructureModel` or of one foot on the base.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from fecolumn.contact.bodies import FACET, GOES_ON
from fecolumn.contact.interface import INTERFACE, interface_of
from fecolumn.contact.outlines import OverlapBuilder
from fecolumn.contact.overlap import Overlaps, no_overlaps
from fecolumn.contact.points import GROUND, POINT, UNPREPARED, node_points
from fecolumn.contact.rim import Rim
from fecolumn.contact.tolerances import SAME_PLACE
from fecolumn.foundation.arrays import Array


class Joints(NamedTuple):
    """points: (P,) of POINT; interfaces: (ni,) of INTERFACE; rim: points on the circles of all of
    them; facets: of FACET; names: of the interfaces, none of a single foot; overlaps: the joints of
    two sides.
    """

    points: Array
    interfaces: Array
    rim: Array
    facets: Array
    names: tuple[str, ...] = ()
    overlaps: Overlaps = no_overlaps()


def left_faces(names: Sequence[str], points: Array) -> tuple[str, ...]:
    """Of `names` of interfaces those of which some of the points (P,) of POINT have left the face
    that is prepared for them.
    """
    return tuple(sorted({names[k] for k in points["interface"][points["beyond"] == UNPREPARED]}))


def joints_of(
    parts: list[Any] | tuple[Any, ...],
    joints: list[Any] | tuple[Any, ...],
    replaced: frozenset[int] = frozenset(),
) -> Joints:
    """Points and interfaces of the joints (`structures.model.JointModel`) of parts
    (`structures.model.Part`), whose nodes come one after another.

    replaced: numbers of joints that have no points, as contact between their bodies is found
    anywhere.
    """
    first, facets, found = (
        np.cumsum([0] + [len(part.model.arms) for part in parts]),
        np.zeros(0, FACET),
        {},
    )
    points: list[Array] = []
    interfaces: list[Array] = []
    rims: list[Array] = []
    overlaps = OverlapBuilder()
    for k, joint in enumerate(joints):
        slave = parts[joint.slave].model
        touching = slave.surfaces[joint.slave_surface]
        arms = slave.arms[touching.nodes]
        rim = Rim.find(arms) if joint.round and k not in replaced else None
        interface = interface_of(
            arms, rim, joint.restitution, joint.rolling, joint.pad, joint.slave, joint.master
        )
        interface["ground"] = joint.ground
        interface["width"] = np.ptp(arms @ touching.axes[:, :2], axis=0).max()
        if joint.ball is not None:
            outward = touching.axes[:, 2]
            interface["ball"], interface["edge"] = joint.ball.radius, joint.ball.edge
            interface["foot"] += joint.ball.radius * outward
            interface["width"] = max(interface["width"][0], 2 * max(joint.ball.edge))
        interface["rim_first"] = sum(len(one) for one in rims)
        rims.append(np.asarray(rim.nodes if rim else [], np.int64))
        if joint.master != GROUND:
            surface = parts[joint.master].model.surfaces[joint.master_surface]
            key = joint.master, joint.master_surface
            if key not in found:
                found[key] = len(facets)
                facets = np.concatenate(
                    [
                        facets,
                        facets_of(surface, parts[joint.master].model.arms, first[joint.master]),
                    ]
                )
            interface["facet_first"], interface["facet_count"] = found[key], len(surface.triangles)
            interface["convex"] = is_convex(
                facets[found[key] : found[key] + len(surface.triangles)]
            )
            interface["origin"], interface["axes"] = surface.origin, surface.axes
            around = Rim.find(surface.plane(parts[joint.master].model.arms[surface.nodes]))
            # a rim that rolls on it stands on the circle, too
            interface["bulge"] = around.radius * (1 - np.cos(around.sector / 2)) if around else 0.0
        own = node_points(
            arms,
            joint.friction,
            joint.law,
            joint.pad,
            slave=joint.slave,
            master=joint.master,
            interface=k,
        )
        own["ground"] = joint.ground
        own["node"] = first[joint.slave] + touching.nodes
        own["carriers"] = own["node"][:, None]
        if joint.ball is not None:
            own["arm"] += joint.ball.radius * outward
        points.append(own[:0] if k in replaced else own)
        interfaces.append(interface)
    for k, joint in enumerate(joints):
        if joint.pair >= 0 and k not in replaced:
            points[joint.pair], points[k] = overlaps.add(
                _side_of(parts, joints, joint.pair, joint.outlines[1], interfaces, points),
                _side_of(parts, joints, k, joint.outlines[0], interfaces, points),
                [np.linalg.norm(ends, axis=2).max() for ends in joint.outlines[::-1]],
            )
    firsts = np.cumsum([0] + [len(own) for own in points])
    rim = np.concatenate([np.zeros(0, np.int64), *(own + at for own, at in zip(rims, firsts))])
    return Joints(
        np.concatenate([np.zeros(0, POINT), *points]).astype(POINT),
        np.concatenate([np.zeros(0, INTERFACE), *interfaces]).astype(INTERFACE),
        rim,
        facets,
        tuple(joint.name for joint in joints),
        overlaps.finish(firsts),
    )


def _side_of(
    parts: Sequence[Any],
    joints: Sequence[Any],
    k: int,
    outline: Array,
    interfaces: list[Array],
    points: list[Array],
) -> tuple:
    """Interface k as `OverlapBuilder.add` takes it; outline: (n, 2, 3) [m] ends of the sides of its
    slave's face from the centre of mass.
    """
    body = parts[joints[k].slave].model
    surface = body.surfaces[joints[k].slave_surface]
    places = surface.plane(body.arms[surface.nodes])[:, :2]
    circle = None
    if interfaces[k]["rim_count"]:
        away = np.linalg.norm(places - places.mean(axis=0), axis=1)
        rim = places[away > away.max() * (1 - 1e-6)]
        circle = rim.mean(axis=0), float(np.linalg.norm(rim - rim.mean(axis=0), axis=1).mean())
    return k, points[k], places, surface.plane(outline)[..., :2], circle


def facets_of(surface: Any, arms: Array, first: int) -> Array:
    """Triangles (t,) of FACET of a Surface of a body with nodes at `arms` (n, 3), in rows from
    `first` on.
    """
    facets = np.zeros(len(surface.triangles), FACET)
    sides: dict[frozenset[Any], tuple[int, int]] = {}
    facets["nodes"] = first + surface.nodes[surface.triangles]
    facets["corners"] = ((arms[surface.nodes] - surface.origin) @ surface.axes[:, :2])[
        surface.triangles
    ]
    facets["neighbours"] = -1
    for number, triangle in enumerate(surface.triangles):
        for q in range(3):
            side = frozenset((triangle[(q + 1) % 3], triangle[(q + 2) % 3]))
            if side in sides:
                other, place = sides.pop(side)
                facets["neighbours"][number, q], facets["neighbours"][other, place] = other, number
            else:
                sides[side] = number, q
    for side, (number, q) in sides.items():
        if not surface.outlines[list(side)].all():
            facets["neighbours"][number, q] = GOES_ON
    return facets


def is_convex(facets: Array) -> bool:
    """Whether all of the outline of triangles (t,) of FACET is known and convex: what is beyond one
    side of it is beyond the surface. Inside it nodes may lack.
    """
    corners = facets["corners"]
    number, q = np.nonzero(facets["neighbours"] == -1)
    ends = np.stack([facets["nodes"][number, (q + 1) % 3], facets["nodes"][number, (q + 2) % 3]])
    if len(number) == 0 or not np.array_equal(np.sort(ends[0]), np.sort(ends[1])):
        # each node of a closed outline ends one side and begins another
        return False
    start, own = corners[number, (q + 1) % 3], corners[number, q]
    side = corners[number, (q + 2) % 3] - start
    normal = np.stack([-side[:, 1], side[:, 0]], axis=1)
    # towards the triangle
    normal *= np.sign(np.einsum("ia,ia->i", normal, own - start))[:, None]
    inside = np.einsum("ia,ika->ik", normal, corners.reshape(1, -1, 2) - start[:, None])
    return bool(
        (
            inside
            >= -SAME_PLACE
            * np.ptp(corners.reshape(-1, 2), axis=0).max()
            * np.linalg.norm(side, axis=1)[:, None]
        ).all()
    )
