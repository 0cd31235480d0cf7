"""Patch tests: uniform pressure through the contact, uniform stress through a tie.

Requirement: a block that stands on a block of the same section passes a uniform pressure on, to
1e-6 where the grids match; where they do not, the error is known and the base's displacement
converges. A tie passes rigid motions and linear displacements exactly, and stresses as well as its
grids allow.

Derivation. With Poisson's ratio 0 nothing varies across a block under its own weight: its nodes
press with weight / area times the integral A_i of their basis functions, and so they do under
vertical shaking, at any instant. A dead load on top makes the strain uniform besides, which
distorted bricks must reproduce (Irons' patch test). The base is in uniaxial stress, u_z = -p (z -
z_bottom) / E. The filter of the contact is exact in statics for loads in proportion to mass, as
gravity and base motion are; the dead load is none, so that its contact is taken without filter.

Node to surface: node i of the foot gives its force to the nodes j of the base by their bilinear
weights N_j(x_i). A uniform pressure p arrives as sum_i N_j(x_i) p A_i where p A_j is due, wrong by
the imbalance

    e_j = sum_i N_j(x_i) A_i / A_j - 1,

nil where every line of the base's grid is one of the foot's, because the foot's basis then
integrates N_j exactly, and without regard to h otherwise: up to 0.23 where 3 bricks of the foot
meet 2 of the base, 1.25 for 2 on 3. Resultants are exact. So the pressure at single nodes does not
converge; but a facet of side h under the pressure e p sinks by 1.12 e p h / E only (centre of a
loaded square on a half-space), so that displacements converge with order 1, and what is left at a
depth z is that of the last bricks along the rim, line dipoles e p h^2: at most (2 / pi) (e p / E)
h^2 / z (plane half-space). Hence the rule: the foot is the finer side, its grid nested in the
base's where that can be had. Ties hand forces from slaves to masters by the same weights.

Source: Irons and Razzaque (1972) for the patch test; Taylor and Papadopoulos (1991) for node to
surface; Love (1929) and Flamant (1892) for the half-spaces, both in Johnson, Contact Mechanics
(1985), chapters 2 and 3.

Tolerances. Matching and nested: the requirement's 1e-6, where the solver's residual of 1e-9 of the
weight is 6e-7 of what the corner node of the smallest brick carries. Not matching: pressure off by
e at most, for both blocks' compliance can only even it out; displacements by the forms above. Ties:
rounding of positions over the size of a brick, 1e-12 at most; strain measures differ by 1.5 times
the strain of 1e-7. Where tubes meet as polygons of different corners, their mid-surfaces are d
apart along an arc: bending by the moment d per force adds 12 <d^2> / t^2 to the strain of a wall t
over the length pi sqrt(R t) where bending of a tube dies out, and the section of the last layer
lies between the polygons'.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import Material
from fecolumn.contact.projection import nodes_under
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import System
from fecolumn.mesh.bricks import LOWER, UPPER, BrickMesh
from fecolumn.mesh.column import divisions, round_section
from fecolumn.mesh.gmsh_section import swept_grid
from fecolumn.mesh.upright import Upright
from fecolumn.verification.models import block_system, column_case
from fecolumn.verification.result import CaseRows, Row, order_of
from fecolumn.verification.tied import STRETCH, column_of, end_areas, tied_blocks
from fecolumn.verification.trial import Trial, contact_nodes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_SIDE, _HEIGHT = 1.0, 0.5  # [m] of each block
# Soft, so that displacements of 5 um stand clear of the contact's 1e-12 m
SOFT = Material(youngs_modulus_pa=1e9, poissons_ratio=0.0, density_kg_m3=2000.0)
GRADED = _SIDE * np.array([0.0, 0.08, 0.2, 0.4, 0.55, 0.8, 1.0])
SQUARE = 1.12  # displacement of a loaded square's centre, times E / (pressure side)
# of bricks of the foot on bricks of the base
_COLOURS = {
    (3, 2): ("#0072B2", "o"),
    (2, 3): ("#D55E00", "s"),
}


def run(engine: str, long: bool) -> CaseRows:
    """Rows of a block on a base, with bricks that match and bricks that do not."""
    counts = (2, 4, 6, 8) if long else (2, 4, 6)
    result = CaseRows([*matching_rows(engine), shaken(engine)], size=(7.2, 2.8))
    pairs = {
        pair: [stand(engine, even(pair[0] * n), even(pair[1] * n)) for n in counts]
        for pair in _COLOURS
    }
    for (foot, base), series in pairs.items():
        result.rows += unmatched_rows(f"{foot} foot bricks on {base}", series)
    sizes = _SIDE / _HEIGHT / (2 * np.array(counts))
    tied = [pulled_blocks(engine, 3 * n, 2 * n) for n in counts]
    allowed = SQUARE * pairs[3, 2][-1].imbalance * sizes[-1]
    result.rows += [
        Row(
            "tied blocks, nested 2 to 1: error of displacement under tension [-]",
            0.0,
            pulled_blocks(engine, 8, 4),
            1e-6,
        ),
        Row(
            "tied blocks, 3 to 2: error of displacement under tension [-]",
            0.0,
            tied[-1],
            allowed,
            order=order_of(sizes, tied),
        ),
    ]
    result.rows += tie_rows(engine)

    def draw(figure: Figure) -> None:
        left, right = figure.subfigures(1, 2, width_ratios=(1.25, 1))
        maps, errors = left.subplots(1, 2), right.subplots()
        for axes, (foot, base) in zip(maps, pairs):
            one = pairs[foot, base][0]
            shade = axes.pcolormesh(
                one.place[0, 0],
                one.place[1, :, 0],
                one.pressures,
                shading="nearest",
                vmin=0.6,
                vmax=1.4,
                cmap="RdBu_r",
            )
            axes.plot(*one.place.reshape(2, -1), "k.", markersize=3, clip_on=False)
            for line in even(base * counts[0]):
                axes.axhline(line, color="k", linewidth=0.5)
                axes.axvline(line, color="k", linewidth=0.5)
            axes.set(
                aspect="equal",
                title=f"{foot} foot bricks (dots) on {base}",
                xticks=(),
                yticks=(),
                xlim=(0, _SIDE),
                ylim=(0, _SIDE),
            )
            axes.grid(False)
        left.colorbar(
            shade,
            ax=maps,
            orientation="horizontal",
            label="pressure / (weight / area)",
            shrink=0.6,
            aspect=30,
            pad=0.02,
        )
        for (foot, base), series in pairs.items():
            (colour, marker), size = _COLOURS[foot, base], [one.size for one in series]
            style = {"color": colour, "marker": marker, "markersize": 3.5}
            errors.loglog(
                size,
                [one.pressure for one in series],
                ":",
                label=f"pressure, {foot} on {base}",
                **style,
            )
            errors.loglog(
                size,
                [one.sinking for one in series],
                "-",
                label=f"base's top, {foot} on {base}",
                **style,
            )
        errors.loglog(sizes, tied, "^--", color="#009E73", markersize=3.5, label="tie, 3 to 2")
        errors.loglog(sizes, 0.6 * tied[0] * sizes / sizes[0], "k-", linewidth=0.8, label="order 1")
        errors.set(
            xlabel="coarser brick / height of a block",
            ylabel="largest error / exact",
            ylim=(None, 2.5),
        )
        errors.set_xticks((0.1, 0.2, 0.4), ("0.1", "0.2", "0.4"))
        errors.set_xticks((), minor=True)
        errors.legend(fontsize=6.5, ncols=2, loc="upper center")

    result.draw = draw
    return result


def even(n: int) -> np.ndarray:
    """Grid lines (n + 1,) [m] of equal bricks."""
    return np.linspace(0, _SIDE, n + 1)


def block_on_block(
    engine: str, foot: np.ndarray, base: np.ndarray, distortion: float = 0.0
) -> System:
    """System of a block with grid lines `foot` [m] along x, mirrored along y, on one with lines
    `base`.

    With a distortion, the points inside both are moved by up to that share of the smallest brick
    and the block's weight acts on its top.
    """
    random = np.random.default_rng(1)

    def block(lines: np.ndarray, bottom: float) -> BrickMesh:
        z = bottom + np.linspace(0, _HEIGHT, 2 * max(1, round((len(lines) - 1) / 4)) + 1)
        mesh = swept_grid(lines, lines[0] + lines[-1] - lines[::-1], z, LOWER)
        inside = np.all(
            (mesh.points > mesh.points.min(axis=0)) & (mesh.points < mesh.points.max(axis=0)),
            axis=1,
        )
        reach = distortion * min(np.diff(lines).min(), np.diff(z).min())
        return replace(
            mesh,
            points=mesh.points + inside[:, None] * random.uniform(-reach, reach, mesh.points.shape),
        )

    # wider by a hair: no point of the rim may leave the plate as the block strains
    nested = set(np.round(base, 9)) <= set(np.round(foot, 9))
    wider = _SIDE / 2 + (base - _SIDE / 2) * (1 + (1e-8 if nested else 1e-6))
    mesh = block(foot, 0.0)
    system = block_system(
        engine,
        mesh,
        block(wider, -_HEIGHT),
        HHT(1e-3, -0.05),
        material=SOFT,
        filtered=not distortion,
    )
    if distortion:
        column, loads = system.body, np.zeros_like(system.bodies.unit_loads)
        loads[2, :, 2] = column.total_mass / _SIDE**2 * end_areas(column, mesh, _HEIGHT)
        system.bodies.unit_loads = loads
    return system


@dataclass(frozen=True, slots=True)
class StandingBlock:
    """A block at rest on its base; largest errors, relative to the exact.

    Attributes
    ----------
    size
        base brick / height [-].
    pressure
        at the foot's nodes.
    sinking
        displacement of the base's top.
    deep
        the same halfway down the base, relative to the top's.
    imbalance
        largest e_j.
    place
        (2, n, n) [m] of the foot's nodes.
    pressures
        (n, n) relative to the exact.
    """

    size: float
    pressure: float
    sinking: float
    deep: float
    imbalance: float
    place: np.ndarray
    pressures: np.ndarray


def stand(
    engine: str, foot: np.ndarray, base: np.ndarray, distortion: float = 0.0
) -> StandingBlock:
    """Gravity equilibrium of `block_on_block`."""
    system = block_on_block(engine, foot, base, distortion)
    state, plate, points = standing(system), system.base, system.interface.reference
    exact = system.weight / _SIDE**2
    areas = contact_nodes(system)[1]
    pressure = state.forces[:, 2] / (exact * areas)
    nodes, weights = nodes_under(plate.grid, points)
    moved = plate.displacement(nodes, weights, -state.forces)[:, 2]
    above = plate.body.X[:, 2] + _HEIGHT
    wrong = np.abs(moved * SOFT.youngs_modulus_pa / exact + above) / _HEIGHT
    arrived, due = np.zeros((2, len(plate.nodes)))
    np.add.at(arrived, nodes, weights * areas[:, None])
    due[plate.grid.number] = np.outer(
        *(np.convolve(np.diff(lines), (0.5, 0.5)) for lines in (plate.grid.x, plate.grid.y))
    )
    order = np.lexsort(np.round(points[:, :2].T, 9)).reshape(len(foot), len(foot))
    return StandingBlock(
        np.diff(base).max() / _HEIGHT,
        np.abs(pressure - 1).max(),
        wrong.max(),
        wrong[np.abs(above - _HEIGHT / 2) < 1e-9].max(initial=0.0),
        np.abs(arrived / due - 1).max(),
        points[order, :2].transpose(2, 0, 1),
        pressure[order],
    )


def matching_rows(engine: str) -> list[Row]:
    """Grids that pass a uniform pressure."""
    rows = []
    for label, base, foot, distortion in (
        ("equal bricks", even(6), even(6), 0.0),
        ("graded bricks", GRADED, GRADED, 0.0),
        ("distorted bricks, dead load", GRADED, GRADED, 0.2),
        ("graded, nested 2 on 1", GRADED[::2], GRADED, 0.0),
    ):
        found = stand(engine, foot, base, distortion)
        rows += [
            Row(f"pressure: error, {label} [-]", 0.0, found.pressure, 1e-6),
            Row(f"base's displacement: error, {label} [-]", 0.0, found.sinking, 1e-6),
        ]
    return rows


def shaken(engine: str) -> Row:
    """Spread of the pressure while the base shakes vertically with half a g at 50 Hz."""
    trial, worst = Trial(block_on_block(engine, GRADED, GRADED)), 0.0
    trial.stepper.tolerance, areas = 1e-9, contact_nodes(trial.system)[1]
    for step in range(1, 21):
        forces = trial.step(
            (0.0, 0.0, 4.9 * np.sin(2 * np.pi * 50 * step * trial.system.hht.dt))
        ).forces[:, 2]
        worst = max(worst, np.ptp(forces / areas) * _SIDE**2 / forces.sum())
    return Row("pressure: spread under vertical shaking, graded bricks [-]", 0.0, worst, 1e-6)


def unmatched_rows(label: str, series: list[StandingBlock]) -> list[Row]:
    """Errors of the finest of a series of grids that do not match, and their orders."""
    finest, sizes = series[-1], [one.size for one in series]
    order = order_of(sizes, [one.sinking for one in series])
    deep = 2 / np.pi * finest.imbalance * finest.size**2 / 0.5
    return [
        Row(
            f"pressure: error of the worst node, {label} [-]",
            0.0,
            finest.pressure,
            finest.imbalance,
            order=order_of(sizes, [one.pressure for one in series]),
        ),
        Row(
            f"base's displacement, top: error, {label} [-]",
            0.0,
            finest.sinking,
            SQUARE * finest.imbalance * finest.size,
            order=order,
        ),
        Row(f"base's displacement, top: order in h, {label}", 1.0, order, 0.1),
        Row(f"base's displacement, halfway down: error, {label} [-]", 0.0, finest.deep, deep),
    ]


def pulled_blocks(engine: str, lower: int, upper: int) -> float:
    """Largest error of the displacement of tied blocks under tension, relative to the stretch of
    one of them.
    """
    blocks = tied_blocks(engine, even(lower), even(upper), _HEIGHT)
    wrong = blocks.pulled()[0] - blocks.uniaxial()
    return float(np.abs(wrong - wrong.mean(axis=0)).max() / (STRETCH * _HEIGHT))


def tie_rows(engine: str) -> list[Row]:
    """Rigid and linear fields through the ties of blocks and of the coarse specimen, and the bare
    column's elongation.
    """
    case, rows = column_case(engine), []
    specimen = column_of(case)
    for label, one in (
        ("tied blocks, 3 to 2", tied_blocks(engine, even(6), even(4), _HEIGHT)),
        ("coarse specimen with cap", specimen),
    ):
        rows += [
            Row(f"{label}: strain of a rigid turn by 1 rad [-]", 0.0, one.turned(), 1e-12),
            Row(f"{label}: error of a linear displacement [-]", 0.0, one.sheared(), 1e-12),
            Row(
                f"{label}: energy / that of a uniform stretch [-]",
                1.0,
                one.stretched(),
                1.5 * STRETCH,
            ),
        ]
    moved, lower, upper = column_of(column_case(engine, cap=False)).pulled()
    assert case.short is not None
    short: Upright = case.short
    column, fine = short.column, short.column.fine_height_m
    ratio = lower.sum() / upper.sum()
    found = moved[:, 2] @ (upper / upper.sum() - lower / lower.sum())
    half = np.pi / round_section(short, UPPER).n_around
    apart = short.mean_radius_m * (1 - np.cos(half) / np.cos(np.linspace(-half, half, 101)))
    bent = (
        12
        * np.mean(apart**2)
        / column.wall_m**2
        * np.pi
        * np.sqrt(short.mean_radius_m * column.wall_m)
    )
    layer = fine / divisions(fine, short.mesh.fine_size_m) * abs(ratio - 1)
    rows.append(
        Row(
            "coarse specimen without cap: elongation under tension [m]",
            STRETCH * (fine + (column.height_m - fine) * ratio),
            found,
            (bent + layer) / column.height_m,
        )
    )
    return rows
