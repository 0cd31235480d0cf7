"""What a case's meshes and its analysis will take, told before anything is built."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from fecolumn.foundation.schema import InputError
from fecolumn.mesh.base_plate import base_counts
from fecolumn.mesh.bricks import BASE, CAP, FLANGE, LOWER, PART_NAMES, UPPER
from fecolumn.mesh.column import divisions, part_layers, section
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.upright import Upright

# Rough. MUMPS' factors of the reference specimen (13,302 degrees of freedom without base) and of a
# marble drum (5,031) have 6 and 16 n^(4/3) numbers, and the full-order engine then took 0.64 and
# 0.54 GB and 25 to 50 ms a step, on one core of a busy and of a free machine. Numbers of a factor
# of n degrees of freedom, FILL n^(4/3); seconds of its making, FACTOR n^2; of a solve for each
# number of it, SOLVE, and for one of many right-hand sides, MANY.
FILL, FACTOR, SOLVE, MANY = 13.0, 6e-10, 1.7e-9, 0.6e-9
# Bytes of program and libraries
PROGRAM = 300e6
# Size keys, and the parts that they make large
_KEYS = {
    "mesh.fine_size_m": (FLANGE, LOWER, BASE),
    "mesh.coarse_size_m": (UPPER,),
    "mesh.cap_size_m": (CAP,),
    "mesh.base_size_m": (BASE,),
}
# The largest size that a key takes [m]
_HUGE = 10.0


#: Seconds to start from which it is said what makes them fewer
LONG_START = 60.0


@dataclass(frozen=True, slots=True)
class Load:
    """What one mesh asks of an analysis: dofs of one of its copies, 0 of a rigid body; contact
    points; copies; held: whether it is an elastic ground.
    """

    dofs: int
    points: int
    copies: int = 1
    held: bool = False


@dataclass(frozen=True, slots=True)
class Estimate:
    """bricks, dofs: number of elements and of degrees of freedom by body, or by part of a column;
    loads: of each mesh. engine: of the case. cheaper: what makes the start shorter, in words.

    Numbers of elements and degrees of freedom of built bodies are exact; memory and times are
    rough.
    """

    bricks: dict
    dofs: dict
    loads: tuple[Load, ...]
    engine: str
    cheaper: str = ""

    @property
    def all_bricks(self) -> int:
        """Elements of all parts."""
        return sum(self.bricks.values())

    @property
    def all_dofs(self) -> int:
        """Degrees of freedom of all parts."""
        return sum(self.dofs.values())

    @property
    def foot_points(self) -> int:
        """Contact points of all bodies."""
        return sum(load.copies * load.points for load in self.loads if not load.held)

    @property
    def memory(self) -> float:
        """Most memory [bytes] of the analysis, or of the making of its reduced models."""
        return PROGRAM + sum(map(self._memory, self.loads))

    def _memory(self, load: Load) -> float:
        n = load.dofs
        # matrices have 81 numbers a row for bricks, twice (mass, stiffness) and a copy to factor,
        # 12 bytes a number
        operators = 12 * 81 * 3 * n + 8 * FILL * n ** (4 / 3)
        if load.held:
            return operators
        columns = 3 * load.points
        wide = 5 * columns if self.engine == "full" else 4 * 120
        return operators + 8 * n * wide + 8 * 3 * columns**2

    @property
    def setup(self) -> float:
        """Time [s] before the first step; reduced models are made once and kept."""
        factors, passes = (2, 3) if self.engine == "full" else (3, 4)
        return 2 + sum(
            1e-4 * load.dofs
            + factors * FACTOR * load.dofs**2
            + MANY * FILL * 3 * load.points * (1 if load.held else passes) * load.dofs ** (4 / 3)
            for load in self.loads
        )

    @property
    def step(self) -> float:
        """Time [s] of a step, in the mean of a shaken analysis."""
        bodies = [load for load in self.loads if not load.held]
        if self.engine == "rigid":
            # 75 us where 192 points stand, 110 where they are shaken; ten times as much where eight
            # drums rock on one another
            return 1e-5 + 5e-7 * sum(load.copies * load.points for load in bodies)
        if self.engine != "full":
            # 10 us where a column rocks; landings on 32 and on 96 nodes make it 35 and 155. Bodies
            # that rock on one another give together: 0.5 to 6 ms with 240 to 620 points
            return 1e-5 + 1.5e-8 * sum(load.copies * load.points for load in bodies) ** 2
        return sum(
            load.copies * (5 * SOLVE * FILL * load.dofs ** (4 / 3) + 2e-7 * load.dofs)
            for load in bodies
        )

    @property
    def counts(self) -> str:
        """Elements and degrees of freedom, in words."""
        return f"{self.all_bricks:,} elements, {self.all_dofs:,} degrees of freedom"

    def __str__(self) -> str:
        parts = ", ".join(f"{PART_NAMES.get(one, one)} {n:,}" for one, n in self.bricks.items())
        return (
            f"{self.all_bricks:,} elements ({parts}), {self.all_dofs:,} degrees of "
            f"freedom, {self.foot_points:,} contact points; "
            f"about {self.memory / 1e9:.1f} GB, {_span(self.setup)} to start"
            f"{f' ({self.cheaper})' if self.cheaper and self.setup > LONG_START else ''} and "
            f"{1e3 * self.step:.2g} ms a step with the "
            f"{self.engine} engine{self._more}"
        )

    @property
    def _more(self) -> str:
        """What is said of steps that take longer than the mean of a column."""
        moving = sum(load.copies for load in self.loads if not load.held)
        return ", ten times as much and more while bodies rock on one another" if moving > 1 else ""


def _span(seconds: float) -> str:
    return (
        f"{seconds:.0f} s"
        if seconds < 120
        else f"{seconds / 60:.0f} min"
        if seconds < 7200
        else f"{seconds / 3600:.0f} h"
    )


def estimate(case: Upright) -> Estimate:
    """Estimate of a case whose sizes are all known."""
    bricks, nodes, foot = body_counts(case)
    if counts := base_counts(case):
        bricks[BASE], nodes[BASE] = math.prod(counts), math.prod(n + 1 for n in counts)
    dofs = {part: 3 * n for part, n in nodes.items()}
    base = dofs.get(BASE, 0)
    loads = (Load(sum(dofs.values()) - base, foot), Load(base, foot, held=True))
    return Estimate(bricks, dofs, loads, case.integration.engine)


def body_counts(case: Upright) -> tuple[dict[int, int], dict[int, int], int]:
    """Elements and nodes of the parts of a column with flange and cap, and nodes of its foot, told
    without making them.
    """
    order = case.mesh.element_order
    bricks, nodes, foot = {}, {}, 0
    if case.column.mesh_file:
        own = own_mesh(case.column.drawn)
        bricks[UPPER] = len(own.mesh.cells)
        nodes[UPPER], foot = own.counts(order)
    else:
        for place, (part, _, _, layers) in enumerate(part_layers(case)):
            plane = section(case, part)
            bricks[part], nodes[part] = (
                plane.n_cells * layers,
                plane.n_nodes(order) * (order * layers + 1),
            )
            if place == 0:
                foot = plane.n_nodes(order)
    if counts := _cap_counts(case):
        bricks[CAP], nodes[CAP] = math.prod(counts), math.prod(order * n + 1 for n in counts)
    return bricks, nodes, foot


def _cap_counts(case: Upright) -> tuple[int, ...] | None:
    cap, size = case.cap, case.mesh.cap_size_m
    return cap and tuple(
        divisions(side, size) for side in (cap.length_m, cap.width_m, cap.thickness_m)
    )


def refuse_large_column(case: Upright, file: Path | str) -> None:
    """Refuse a case of more degrees of freedom than `mesh.limit_dofs`, naming the size that makes
    it so and one that would fit.
    """
    found, limit = estimate(case), case.mesh.limit_dofs
    if found.all_dofs <= limit:
        return
    too_many = (
        f"the meshes would have {found.all_dofs:,} degrees of freedom ({found.all_bricks:,} "
        f"elements), mesh.limit_dofs allows {limit:,}"
    )
    dofs = {
        key: sum(found.dofs.get(part, 0) for part in parts)
        for key, parts in _KEYS.items()
        if not (case.column.mesh_file and UPPER in parts)
    }
    if case.column.mesh_file and found.dofs[UPPER] > max(dofs.values()):
        raise InputError(
            file,
            "column.mesh_file",
            case.column.mesh_file,
            f"{too_many}; take a coarser mesh, or a higher mesh.limit_dofs",
        )
    sizes = {key: (getattr(case.mesh, key.partition(".")[2]), _HUGE) for key in dofs}
    refuse_sizes(
        file,
        sizes,
        lambda key, value: _with(case, key, value).all_dofs,
        limit,
        too_many,
        "all sizes of [mesh]",
    )


def refuse_sizes(
    file: Path | str,
    sizes: dict[str, tuple[float, float]],
    dofs_with: Callable[[str, float], int],
    limit: int,
    too_many: str,
    others: str,
) -> NoReturn:
    """Refuse a mesh, naming the size that makes it too large and one that would fit.

    Parameters
    ----------
    sizes
        by key the size that is taken and the largest that may be [m].
    dofs_with
        function of a key and its size that returns degrees of freedom.
    too_many
        how many there are, in words.
    others
        what else is to be made larger where no size of one key fits.
    """
    # the key whose elements, made larger, take most away
    key = min(sizes, key=lambda key: dofs_with(key, sizes[key][1]))
    stated, high = sizes[key]
    low = stated
    if dofs_with(key, high) > limit:
        raise InputError(file, key, stated, f"{too_many}; make {others} larger, or mesh.limit_dofs")
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if dofs_with(key, middle) <= limit else (middle, high)
    unit = 10 ** (2 - math.floor(math.log10(high)))
    raise InputError(
        file,
        key,
        stated,
        f"{too_many}; {min(math.ceil(high * unit) / unit, sizes[key][1]):g} m would "
        "fit, or raise mesh.limit_dofs",
    )


def _with(case: Upright, key: str, value: float) -> Estimate:
    name = key.partition(".")[2]
    mesh = case.mesh
    sizes = (
        {one: max(getattr(mesh, one), value) for one in ("coarse_size_m", "base_size_m")}
        if name == "fine_size_m"
        else {}
    )
    return estimate(
        dataclasses.replace(case, mesh=dataclasses.replace(mesh, **sizes | {name: value}))
    )
