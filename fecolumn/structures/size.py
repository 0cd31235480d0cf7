"""How large the meshes of a structure will be, told before any is built."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Block, MeshBody, Plate, Prism, Storeys, half_sides
from fecolumn.case.case import Case
from fecolumn.case.short_form import in_short_form
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.estimate import Estimate, Load, refuse_sizes
from fecolumn.mesh.imported import own_mesh
from fecolumn.structures.drawn_pieces import DrawnScene
from fecolumn.structures.ground import sized_ground
from fecolumn.structures.model import BodyModel
from fecolumn.structures.shape import Gridded, Meshable, Spot, element_size
from fecolumn.structures.shapes import counts_of

#: [m]: the largest element size that a key takes, and size of a body from which its lengths are
#: likely not in metres
LARGE = 100.0


def size_of(
    case: Case,
    file: Path | str,
    spots: Mapping[str, Sequence[Spot]] | None = None,
    bodies: Iterable[str] | None = None,
) -> Estimate:
    """Size of the meshes of bodies; those of copies count where each has its own, with engine =
    "full".

    Parameters
    ----------
    spots
        by name of a plate where others meet it, as of `layout_of`; without them plates have no more
        than their own elements.
    bodies
        names; all unless given.
    """
    elements, dofs, loads, full = {}, {}, [], case.integration.engine == "full"
    for name in case.bodies if bodies is None else bodies:
        body, copies = case.bodies[name], len(case.names_of(name))
        if not isinstance(body, Meshable):
            continue
        count, nodes = counts_of(f"bodies.{name}", body, file, (spots or {}).get(name, ()))
        times = copies if full else 1
        elements[name], dofs[name] = times * count, 3 * times * nodes
        rigid = isinstance(body, Storeys) or not body.deforms
        loads.append(Load(0 if rigid else 3 * nodes, _points(case, name, nodes), copies))
    return Estimate(elements, dofs, tuple(loads), case.integration.engine)


def _points(case: Case, name: str, nodes: int) -> int:
    """Contact points of a body of so many nodes, roughly: on the outlines of the faces that touch,
    and as many inside as the case says.
    """
    face = nodes ** (2 / 3)
    touching = [
        one
        for one in case.joints.values()
        if any(
            name in {body for body, _ in case.copies_of(end)}
            for end in (one.slave, one.on)
            if end not in case.grounds
        )
    ]
    inner = [
        case.interior_points if one.interior_points is None else one.interior_points
        for one in touching
    ]
    return sum(round(min(face, 4 * math.sqrt(face) + each)) for each in inner)


def expected(case: Case, file: Path | str) -> Estimate:
    """What the meshes of bodies and elastic grounds, and the analysis, will take."""
    found = size_of(case, file)
    bricks, dofs, loads = dict(found.bricks), dict(found.dofs), list(found.loads)
    for name, ground in case.grounds.items():
        feet = _feet(case, name) if ground.kind == "plate" else []
        if feet:
            sized = sized_ground(name, ground, feet, file)
            counts = [len(line) for line in (sized.x, sized.y, sized.z)]
            bricks[name] = math.prod(count - 1 for count in counts)
            dofs[name] = 3 * math.prod(counts)
            loads.append(Load(dofs[name], max((load.points for load in loads), default=0), 1, True))
    return Estimate(bricks, dofs, tuple(loads), found.engine, _cheaper(case, dofs))


def made_of(case: Case, models: Mapping[str, BodyModel], scene: DrawnScene) -> Estimate:
    """As `expected`, of bodies that are made.

    Parameters
    ----------
    models
        by the names of bodies.
    scene
        `engines.scene.scene.Scene` of the case.
    """
    full = case.integration.engine == "full"
    bricks, dofs, loads = {}, {}, []
    for piece in {piece.kind: piece for piece in scene.pieces}.values():
        name, count = piece.kind, len(piece.elements) - piece.carried // 8
        if piece.held:
            bricks[name], dofs[name] = count, 3 * len(piece.points)
            on = {scene.pieces[one.piece].kind for one in scene.contacts if one.on_ground}
            points = sum(len(models[kind].arms) for kind in on)
            loads.append(Load(dofs[name], points, held=True))
            continue
        model, copies = models[name], len(case.names_of(name))
        times = copies if full else 1
        if model.dofs:
            bricks[name], dofs[name] = times * count, times * model.dofs
        loads.append(Load(model.dofs if piece.stressed else 0, len(model.arms), copies))
    return Estimate(bricks, dofs, tuple(loads), case.integration.engine, _cheaper(case, dofs))


def _cheaper(case: Case, dofs: Mapping[str, int]) -> str:
    """Keys that make the start shorter, of the ground or the body that deforms with the most
    degrees of freedom, as the case was stated.
    """
    deforming = [name for name in dofs if getattr(case.bodies.get(name), "deforms", True)]
    name = max(deforming, key=dofs.__getitem__, default="")
    if not name:
        return ""
    body = case.bodies.get(name)
    table = f"grounds.{name}" if body is None else f"bodies.{name}"
    size = f"{table}.element_size_m"
    if isinstance(body, MeshBody):
        size = f"{table}.mesh_size_m" if body.drawn.kind != "elements" else ""
    if case.short:
        size = "mesh.fine_size_m" if body is None else in_short_form(size)
    rigid = f"{table}.rigid = true"
    if body is None or case.short or isinstance(body, Storeys) or case.integration.engine == "full":
        rigid = ""
    keys = [*([f"a larger {size}"] if size else []), *([rigid] if rigid else [])]
    return f"{' or '.join(keys)} makes it shorter" if keys else ""


def _feet(case: Case, ground: str) -> list[NDArray[Any]]:
    """Corners (4, 3) [m] of the rectangles around the feet on a ground, by the keys of bodies."""
    found = []
    for one in case.joints.values():
        if one.on != ground:
            continue
        for name, number in case.copies_of(one.slave):
            body = case.bodies[name]
            if not isinstance(body, Meshable):
                continue
            low, high = extent_in_plan(body)
            corners = np.array([[x, y, 0.0] for x in (low[0], high[0]) for y in (low[1], high[1])])
            found.append(corners + np.array(body.places[number]))
    return found


def extent_in_plan(body: Meshable) -> tuple[NDArray[Any], NDArray[Any]]:
    """Lowest and highest corner (2,) [m] of the foot of a body that is not of matrices."""
    if isinstance(body, MeshBody):
        own = own_mesh(body.drawn)
        points = own.mesh.points + (own.drawn_at if body.as_drawn else np.zeros(3))
        foot = points[points[:, 2] < points[:, 2].min() + 1e-6 * np.ptp(points[:, 2]), :2]
        return foot.min(axis=0), foot.max(axis=0)
    if isinstance(body, Prism):
        outline, side = np.array(body.outline_m), body.width_m / 2
        if body.along == "z":
            return outline.min(axis=0), outline.max(axis=0)
        foot = outline[outline[:, 1] < outline[:, 1].min() + 1e-6 * np.ptp(outline[:, 1]), 0]
        return np.array([foot.min(), -side]), np.array([foot.max(), side])
    if isinstance(body, (Plate, Storeys)):
        half = np.array([body.length_m, body.width_m]) / 2
    else:
        x, y = half_sides(body)
        half = np.array([x, y or x])
    return -half, half


def expected_of_all(cases: Iterable[Case], file: Path | str) -> str:
    """What a study says of its meshes: how many structures there are, and the estimate of the
    largest.
    """
    found = {str(one): one for one in (expected(case, file) for case in cases)}
    largest = max(found.values(), key=lambda one: one.all_dofs)
    return f"{len(found)} meshes, the largest of {largest}" if len(found) > 1 else str(largest)


def refuse_too_large(
    case: Case, file: Path | str, spots: Mapping[str, Sequence[Spot]] | None = None
) -> None:
    """Refuse meshes of more degrees of freedom than `mesh.limit_dofs`, naming the body and the size
    that makes them so, and one that would fit.
    """
    found, limit = size_of(case, file, spots), case.mesh.limit_dofs
    if (total := sum(found.dofs.values())) <= limit:
        return
    name = max(found.dofs, key=found.dofs.__getitem__)
    body, key = case.bodies[name], f"bodies.{name}"
    too_many = (
        f"the meshes would have {total:,} degrees of freedom "
        f"({sum(found.bricks.values()):,} elements, {found.bricks[name]:,} of them "
        f'of "{name}"), '
        f"mesh.limit_dofs allows {limit:,}"
    )
    if isinstance(body, MeshBody):
        raise InputError(
            file,
            f"{key}.mesh_file",
            body.mesh_file,
            f"{too_many}; take a coarser mesh, or a higher mesh.limit_dofs",
        )
    assert isinstance(body, Gridded)
    if isinstance(body, Prism) and (size := largest_side(body)) > LARGE:
        side = "width_m" if size == body.width_m else "outline_m"
        raise InputError(
            file,
            f"{key}.{side}",
            getattr(body, side),
            f"makes a body of {size:g} m, which looks like millimetres: lengths are in metres; if "
            f"they are metres, make {key}.element_size_m larger: {too_many}",
        )
    coarse, high = getattr(body, "coarse_size_m", None), _largest(body)
    # of two that do as well the first is named
    sizes = ({f"{key}.coarse_size_m": (coarse, high)} if coarse else {}) | {
        # as `check_bodies` has it of blocks and plates
        f"{key}.element_size_m": (
            element_size(body),
            min(body.length_m, body.width_m) if isinstance(body, Plate) else high,
        )
    }

    def dofs_with(changed: str, value: float) -> int:
        other: dict[str, Any] = {changed.rpartition(".")[2]: value}
        if coarse:
            other["coarse_size_m"] = max(coarse, value)
        trial = replace(case, bodies={**case.bodies, name: replace(body, **other)})
        dofs: int = total - found.dofs[name] + size_of(trial, file, spots, [name]).dofs[name]
        return dofs

    refuse_sizes(file, sizes, dofs_with, limit, too_many, "the elements of all bodies")


def largest_side(body: Prism) -> float:
    """The largest extent [m] of a prism, as drawn."""
    return max(body.width_m, float(np.ptp(body.outline_m, axis=0).max()))


def _largest(body: Gridded) -> float:
    """The largest element size [m] that a body takes, as `case.check_bodies.check_body` says."""
    if isinstance(body, Block):
        return min(body.length_m, body.width_m)
    if isinstance(body, Prism):
        return min(largest_side(body), LARGE)
    return (
        max(body.length_m, body.width_m)
        if isinstance(body, (Plate, Storeys))
        else math.pi * body.outer_diameter_m / 12
    )
