"""The grounds of a structure: how their tops give under all feet that stand on them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.check_thin import Dimension, refuse_thin
from fecolumn.case.checked import refuse_in
from fecolumn.case.ground import Ground
from fecolumn.case.ground_sizes import least_side, open_allowance, open_side, open_thickness
from fecolumn.contact.points import GROUND
from fecolumn.contact.unbounded_base import UnboundedBase, rigid_base, unbounded_base, window
from fecolumn.foundation._compiled import cache_folder
from fecolumn.foundation.digests import remove_damaged
from fecolumn.foundation.lock import alone
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.base_plate import depths, plate_line
from fecolumn.structures.feet import edge_points
from fecolumn.structures.model import BodyModel, JointModel, Part
from fecolumn.structures.standing import Standing
from fecolumn.structures.store import key_of

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.contact.known_base import KnownBase
    from fecolumn.fem.body import Body
    from fecolumn.mesh.bricks import BrickMesh

# Fine elements along the side of a foot, by its area and at least; coarse ones are so much larger
_ALONG, _LEAST, _COARSE = 12, 4, 6


@dataclasses.dataclass(frozen=True)
class Sized:
    """A plate or a layer with all its sizes, each [m]: grid lines x, y of a plate's top and levels
    z of the nodes, falling from 0; fine size of the elements; allowance of sliding.
    """

    x: NDArray[Any]
    y: NDArray[Any]
    z: NDArray[Any]
    fine: float
    allowance: float


def bases_of(
    case: Case,
    standing: Sequence[Standing],
    joints: Sequence[JointModel],
    reach: NDArray[Any],
    file: Path | str,
    say: Callable[[str], None] = lambda text: None,
) -> tuple[KnownBase | UnboundedBase, ...]:
    """What each ground of a case is to those that stand on it: a `contact.base_plate.BasePlate` or
    what answers as it does.

    Parameters
    ----------
    standing, joints
        parts as they stand, and their joints.
    reach
        (n, 3) places of the structure [m].
    say
        told what takes long.
    """
    return tuple(
        _base(case, name, feet_on(standing, joints, place), reach, file, say)
        for place, name in enumerate(case.grounds)
    )


def feet_on(
    standing: Sequence[Standing | Part], joints: Iterable[JointModel], ground: int
) -> list[NDArray[Any]]:
    """Places (n, 3) [m] of the nodes of each foot on a ground; of a dome middle and edge."""
    return [
        standing[joint.slave].center + _foot_arms(standing[joint.slave].model, joint)
        for joint in joints
        if joint.master == GROUND and joint.ground == ground
    ]


def _foot_arms(model: BodyModel, joint: JointModel) -> NDArray[Any]:
    """Arms (n, 3) [m] of the nodes of a foot; of a dome those of its middle and of its edge."""
    arms: NDArray[Any] = model.arms[model.surfaces[joint.slave_surface].nodes]
    if joint.ball is None or not joint.on_dome:
        return arms
    return np.concatenate([arms, arms[0] + edge_points(joint.ball)])


def _base(
    case: Case,
    name: str,
    feet: list[NDArray[Any]],
    reach: NDArray[Any],
    file: Path | str,
    say: Callable[[str], None],
) -> KnownBase | UnboundedBase:
    """As `bases_of`, of one ground below feet, each (n, 3) [m]."""
    ground = case.grounds[name]
    if ground.kind in ("rigid", "pad") or not feet:
        return rigid_base(reach)
    sized = sized_ground(name, ground, feet, file)
    everything = np.concatenate(feet)
    if ground.kind == "unbounded":
        travel = sized.allowance if len(feet) > 1 else 0.0
        try:
            return unbounded_base(sized.fine, sized.z, ground, everything, len(feet), travel)
        except ValueError as error:
            raise InputError(
                file,
                f"grounds.{name}.thickness_m",
                ground.thickness_m,
                f"{error}; its feet span {2 * window(sized.fine, everything)} of them",
            ) from None
    return _plate(case, name, ground, sized, feet, file, say)


def thickness_of(ground: Ground, shorter: float) -> float:
    """Thickness [m] of a plate or layer, where it is left open by the smaller side [m] of the
    smallest foot on it.
    """
    return open_thickness(shorter) if ground.thickness_m is None else ground.thickness_m


def sized_ground(name: str, ground: Ground, feet: list[NDArray[Any]], file: Path | str) -> Sized:
    """A ground with the sizes that it leaves open, from the feet (n, 3) [m] on it.

    Raises
    ------
    InputError
        a plate too small for its feet, or too thin to be meshed.
    """
    sides = np.array([np.ptp(foot[:, :2], axis=0) for foot in feet])
    smallest = sides[np.argmin(sides.min(axis=1))]
    shorter, longer = sides.min(), sides.max()

    def stated(key: str, value: float) -> float:
        given: float | None = getattr(ground, key)
        return value if given is None else given

    fine = stated(
        "element_size_m", min(math.sqrt(smallest.prod()) / _ALONG, smallest.min() / _LEAST)
    )
    largest = max(stated("coarse_size_m", _COARSE * fine), fine)
    everything = np.concatenate(feet)[:, :2]
    low, high = everything.min(axis=0), everything.max(axis=0)
    lengths = ground.length_m, ground.width_m
    room = [(length - own) / 2 for length, own in zip(lengths, high - low) if length is not None]
    allowance = stated("slide_allowance_m", open_allowance(shorter, room))
    lines = []
    for axis, length in enumerate(lengths):
        own = high[axis] - low[axis]
        length = open_side(own, longer, allowance) if length is None else length
        least = least_side(own, allowance)
        if length < least * (1 - 1e-9) and ground.kind == "plate":
            raise InputError(
                file,
                f"grounds.{name}.{('length_m', 'width_m')[axis]}",
                length,
                f"must be at least the feet and twice slide_allowance_m, {least:g} m",
            )
        middle = (low[axis] + high[axis]) / 2
        spans = _joined(
            [(foot[:, axis].min() - allowance, foot[:, axis].max() + allowance) for foot in feet],
            fine,
        )
        lines.append(plate_line(spans, middle - length / 2, middle + length / 2, fine, largest))
    thickness = thickness_of(ground, shorter)
    if ground.kind == "plate":
        sides_of_plate = (
            ("length_m", float(np.ptp(lines[0]))),
            ("width_m", float(np.ptp(lines[1]))),
            ("thickness_m", thickness),
        )
        refuse_thin(
            [Dimension(f"grounds.{name}.{key}", side, side) for key, side in sides_of_plate],
            refuse_in(file),
        )
    levels = depths(thickness, fine, largest)
    return Sized(lines[0], lines[1], levels, fine, allowance)


def _joined(spans: Iterable[tuple[float, float]], fine: float) -> list[tuple[float, float]]:
    """Spans (start, end) [m] one after another; those less than two fine elements apart are one."""
    found: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if found and start < found[-1][1] + 2 * fine:
            found[-1] = found[-1][0], max(found[-1][1], end)
        else:
            found.append((start, end))
    return found


def _plate(
    case: Case,
    name: str,
    ground: Ground,
    sized: Sized,
    feet: list[NDArray[Any]],
    file: Path | str,
    say: Callable[[str], None],
) -> KnownBase:
    """The plate as it is kept, its compliance found if it is not on disk, or damaged."""
    from fecolumn.contact.known_base import LEAST_REACH, under
    from fecolumn.structures.kept_plate import KeptPlate, keep_plate, plate_is_kept

    count = 3 * len(sized.x) * len(sized.y) * len(sized.z)
    if count > case.mesh.limit_dofs:
        raise InputError(
            file,
            f"grounds.{name}.element_size_m",
            ground.element_size_m,
            f"makes a plate of {count:,} degrees of freedom with elements of {sized.fine:.3g} m; "
            f"mesh.limit_dofs allows {case.mesh.limit_dofs:,}",
        )
    material = {
        key: getattr(ground, key)
        for key in ("youngs_modulus_pa", "poissons_ratio", "density_kg_m3")
    }
    lines = [line.tolist() for line in (sized.x, sized.y, sized.z)]
    key = key_of([lines, material, sized.allowance, [foot[:, :2].tolist() for foot in feet]])
    folder = cache_folder() / f"ground-{key}"

    def make() -> BasePlate:
        return plate_of(sized, ground)

    if not plate_is_kept(folder):
        with alone(folder):
            if not plate_is_kept(folder):
                if folder.is_dir():
                    remove_damaged(folder)
                say(f'finding how the plate "{name}" gives below its feet (once)')
                plate = make()
                widest = max(np.ptp(foot[:, :2], axis=0).max() for foot in feet)
                allowance = max(sized.allowance, LEAST_REACH * widest)
                plate.need(under(plate.grid.points, feet, allowance))
                base = dict(
                    points=plate.grid.points,
                    frequency=plate.frequency,
                    dofs=plate.dofs,
                    foot=np.concatenate(feet),
                    firsts=np.cumsum([0] + [len(foot) for foot in feet[:-1]]),
                    allowance=allowance,
                )
                keep_plate(folder, base, plate)
    return KeptPlate(folder, make)


def plate_mesh(sized: Sized) -> BrickMesh:
    """Mesh of a plate of these sizes, its top at z = 0."""
    from fecolumn.mesh.bricks import BASE
    from fecolumn.mesh.gmsh_section import swept_grid

    return swept_grid(sized.x, sized.y, sized.z[::-1], BASE)


def plate_of(sized: Sized, ground: Ground) -> BasePlate:
    """The BasePlate of a ground of these sizes, its top at z = 0."""
    from mpi4py import MPI

    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.fem.body import Body

    def held(body: Body) -> tuple[dict[int, tuple[NDArray[Any], NDArray[Any]]], NDArray[Any]]:
        bottom = body.all_X[:, 2].min()
        return {}, np.flatnonzero(body.all_X[:, 2] < bottom - 1e-9 * sized.z[-1])

    body = Body(MPI.COMM_SELF, plate_mesh(sized), ground, 1, held)
    return BasePlate(body)
