"""Hertz contact: a cylinder and a sphere pressed on a flat, both elastic.

Requirement: contact radius, peak pressure and approach of Hertz's solution to second order in h,
the pressure at single nodes to first order, at any load.

Derivation. With 1/E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2, a surface r^2 / 2R pressed on a flat
without friction touches within a,

    cylinder of b m   P = pi a^2 E* b / 4R,  p0 = a E* / 2R,     approach/P = c - 2 ln(a) / pi E* b,
    sphere            P = 4 a^3 E* / 3R,     p0 = 2 a E* / pi R, approach/P = c + 3 / (4 E* a),

under the pressure p0 (1 - r^2 / a^2)^(1/2). The weight of a block with a curved bottom is P; the
base is a block of the same size, held below. The cylinder is a slice of one brick along y, with nu
= 0 in plane strain exactly. Its contact is filtered, as the impact law needs it, the sphere's is
not. Materials differ, friction is 0; of equal materials both surfaces stretch alike, so that
friction changes nothing. Three things differ from half-spaces:

Compliance of the blocks. Bending, compression and the support far below add a settlement in
proportion to P, the same at any a. It is c above (for the half-plane infinite), and goes out of
approach(P) - s approach(P / s). Their size L. The smooth part of their compliance also bends the
surfaces under the contact, by a share (a / L)^d of r^2 / 2R with d = 2 for the cylinder, 3 for the
sphere (P / E L^d beside 1 / R). Half the size shows 2^d times the effect: if it changes the radius
by no more than (2^d - 1) (a / L)^d, then (a / L)^d bounds what is left. Bricks. A node's force is a
pressure weighted by the node's basis function; where it acts is known up to the second moment h^2 /
6 of that function along each axis. The radius is found from the second moment of the forces, a^2 /
4 for the cylinder, 2 a^2 / 5 for the sphere; it is off by e = (h / a)^2 / 3 and 5 (h / a)^2 / 12 at
most, as the contact's edge comes to lie anywhere in a brick. Several loads on one mesh show this;
the worst of them counts, and orders scatter with them, the more the fewer the bricks.

Source. Hertz (1882); Johnson, Contact Mechanics (1985), chapter 4 and, for the approach of
cylinders, section 5.6.

Tolerances. Radius: e + (a / L)^d + a / R for finite strains. Peak pressure: d - 1 times that, for
p0 a^(d-1) is P. Approach: that of its second term, a known to the same share at either load.
Pressures: weighted by its basis function, p at a node on the edge is (2/3 - 2/5) (2 h / a)^(1/2) p0
instead of 0, and these nodes have the share (d - 1) h / a of the area: (4 / 15) (2 d - 2)^(1/2) h /
a in the mean square. Equal materials: weight and support stretch the two blocks differently by a
share a / L of p0 / E, which friction resists.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import Material
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import System
from fecolumn.pictures.figures.style import LINES
from fecolumn.verification.models import block_system, box
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.trial import TrialState, contact_nodes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


LARGEST, CURVATURE = 0.01, 100.0  # a under full load and R [m]
_LENGTH = LARGEST / 8  # of the slice of the cylinder [m]
_MODULI, _DENSITY = (70e9, 210e9), 7850.0  # of block and base [Pa, kg/m3]
_RIM, DEPTH = 1.2, 0.5  # half-width and depth of the equal bricks over a
_GROWTH = (
    5  # of the bricks beyond, over as many of them as lie along a: a finer mesh is finer everywhere
)
_QUANTITIES = {"radius": "o-", "peak": "s:", "spread": "^--"}  # errors of Pressed


@dataclass(frozen=True, slots=True)
class Hertz:
    """Exact solution.

    Attributes
    ----------
    axes
        along which the surface is curved.
    poisson
        of both.
    moduli
        of block and base [Pa].
    size
        L / a.
    """

    axes: int
    poisson: float
    size: float
    moduli: tuple[float, float] = _MODULI

    @property
    def name(self) -> str:
        """Shape of the curved body: cylinder or sphere."""
        return ("cylinder", "sphere")[self.axes - 1]

    @property
    def modulus(self) -> float:
        """E* [Pa]."""
        return 1 / ((1 - self.poisson**2) * sum(1 / modulus for modulus in self.moduli))

    @property
    def moment(self) -> float:
        """Second moment of the pressure over P a^2."""
        return (1 / 4, 2 / 5)[self.axes - 1]

    def load(self, a: float) -> float:
        """P [N]."""
        return (np.pi / 4 * a**2 * _LENGTH, 4 / 3 * a**3)[self.axes - 1] * self.modulus / CURVATURE

    def peak(self, a: float) -> float:
        """p0 [Pa]."""
        return (1 / 2, 2 / np.pi)[self.axes - 1] * a * self.modulus / CURVATURE

    def softness(self, a: float) -> float:
        """Approach / P without the blocks' own compliance [m/N]."""
        return (-2 * np.log(a) / (np.pi * _LENGTH), 3 / 4 / a)[self.axes - 1] / self.modulus

    def steepness(self, a: float) -> float:
        """|a d softness / da| [m/N]."""
        return (2 / (np.pi * _LENGTH), 3 / 4 / a)[self.axes - 1] / self.modulus

    def left(self, a: float) -> float:
        """What size and strains may change in the radius, relative."""
        return (a / (self.size * LARGEST)) ** (self.axes + 1) + a / CURVATURE

    def allowed(self, a: float, h: float) -> float:
        """Tolerance of the radius."""
        return self.axes * h**2 / (12 * self.moment * a**2) + self.left(a)


@dataclass(frozen=True, slots=True)
class Pressed:
    """A block on bricks of side h [m] under one load.

    Attributes
    ----------
    a
        exact radius [m].
    place
        (n,) r of the foot's nodes over a.
    pressures
        (n,) over p0.
    radius, peak
        relative errors.
    spread
        of the pressures, root of the mean square over the contact.
    approach
        settlement of the block [m].
    friction
        largest share of p0.
    """

    h: float
    a: float
    place: np.ndarray
    pressures: np.ndarray
    radius: float
    peak: float
    spread: float
    approach: float
    friction: float


def graded_lines(h: float, fine: float, far: float, growth: float) -> np.ndarray:
    """Grid lines [m] from 0 to `far`: equal bricks of side h until `fine`, then growing."""
    equal = h * np.arange(np.ceil(fine / h - 1e-9) + 1)
    steps = h * growth ** np.arange(
        1, np.ceil(np.log((far - equal[-1]) / h * (growth - 1) / growth + 1) / np.log(growth)) + 1
    )
    return np.concatenate([equal, equal[-1] + np.cumsum(steps) * (far - equal[-1]) / steps.sum()])


def press(
    engine: str, exact: Hertz, bricks: int, radii: Iterable[float], friction: float = 0.0
) -> list[Pressed]:
    """A block with `bricks` along the largest radius at rest under the loads that belong to `radii`
    [m].
    """
    h, far, growth = LARGEST / bricks, exact.size * LARGEST, _GROWTH ** (1 / bricks)
    half, up = (
        graded_lines(h, _RIM * LARGEST, far / 2, growth),
        graded_lines(h, DEPTH * LARGEST, far, growth),
    )
    x = np.concatenate([-half[:0:-1], half])
    # a slice of the base is longer by a hair: no point may leave it
    y, under = (
        (x, x)
        if exact.axes == 2
        else (_LENGTH * np.array([-0.5, 0.5]), _LENGTH * np.array([-0.5, 0.5]) * (1 + 1e-8))
    )
    mesh = box(x, y, up)
    mesh = replace(
        mesh,
        points=mesh.points
        + np.outer((mesh.points[:, : exact.axes] ** 2).sum(axis=1) / (2 * CURVATURE), [0, 0, 1]),
    )
    block, base = (
        Material(youngs_modulus_pa=modulus, poissons_ratio=exact.poisson, density_kg_m3=_DENSITY)
        for modulus in exact.moduli
    )
    system = block_system(
        engine,
        mesh,
        box(x, under, -up[::-1]),
        HHT(1e-3, -0.05),
        material=block,
        base_material=base,
        friction=friction,
        filtered=exact.axes == 1,
        foot_height=(_RIM * LARGEST + h) ** 2 / (2 * CURVATURE),
    )
    found = []
    for a in radii:
        # at rest gravity and mass are one: of a material that there is, a small block needs more
        # than the Earth's
        system.weight = exact.load(a)
        system.gravity = np.array([0.0, 0.0, -system.weight / system.body.total_mass])
        found.append(measured_contact(exact, system, begin_trial(engine, system).start, a, h))
    return found


def measured_contact(
    exact: Hertz, system: System, state: TrialState, a: float, h: float
) -> Pressed:
    """What a state at rest under the load of radius `a` [m] shows."""
    squares, column = (system.interface.reference[:, : exact.axes] ** 2).sum(axis=1), system.body
    forces, p0, areas = state.forces[:, 2], exact.peak(a), contact_nodes(system)[1]
    radius = np.sqrt(forces @ squares / forces.sum() / exact.moment)
    pressures = forces / areas / p0
    wrong = pressures - np.sqrt(np.maximum(1 - squares / a**2, 0))
    contact = 2 * a * _LENGTH if exact.axes == 1 else np.pi * a**2
    sunk = column.node_mass @ (column.X - state.x)[:, 2] / column.total_mass
    rubbed = np.linalg.norm(state.forces[:, :2], axis=1) / areas / p0
    return Pressed(
        h,
        a,
        np.sqrt(squares) / a,
        pressures,
        radius / a - 1,
        pressures[squares.argmin()] - 1,
        np.sqrt(wrong**2 @ areas / contact),
        sunk,
        rubbed.max(),
    )


def run(engine: str, long: bool) -> CaseRows:
    """Cylinder with 4 to 12 bricks along the radius, sphere with 3 to 5; up to 24 and 7 if
    `long`.
    """
    meshes = {
        Hertz(1, 0.0, 64): (4, 6, 8, 12) + (16, 24) * long,
        Hertz(2, 0.3, 8): (3, 4, 5) + (6, 7) * long,
    }
    result, found = CaseRows(size=(7.2, 5.2)), {}
    for exact, bricks in meshes.items():
        radii = LARGEST * np.linspace(1, 0.7, 5 if exact.axes == 1 else 3)
        found[exact] = series = {n: press(engine, exact, n, radii) for n in bricks}
        result.rows += contact_rows(exact, series)
        smaller = press(engine, replace(exact, size=exact.size / 2), bricks[0], radii[:1])[0]
        result.rows.append(
            Row(
                f"{exact.name}: change of the radius in blocks of half the size [-]",
                0.0,
                smaller.radius - series[bricks[0]][0].radius,
                (2 ** (exact.axes + 1) - 1) * exact.left(LARGEST),
            )
        )
    cylinder = next(iter(meshes))
    rough = press(engine, replace(cylinder, moduli=_MODULI[:1] * 2), 8, [LARGEST], friction=0.3)[0]
    result.rows.append(
        Row(
            "cylinder, equal materials, rough: largest friction / peak pressure [-]",
            0.0,
            rough.friction,
            1 / cylinder.size,
        )
    )
    result.draw = lambda figure: draw_contact(figure, found)
    return result


def worst(quantity: str, series: Mapping[int, list[Pressed]]) -> list[float]:
    """Largest error over the loads for each mesh."""
    return [max(abs(getattr(one, quantity)) for one in loads) for loads in series.values()]


def contact_rows(exact: Hertz, series: dict[int, list[Pressed]]) -> list[Row]:
    """What the finest mesh finds at the worst of the loads, with orders over all meshes."""
    bricks, name = max(series), exact.name
    loads = series[bricks]
    full, least, h = loads[0], loads[-1], loads[0].h
    allowed = exact.allowed(least.a, h)
    order = {
        quantity: -np.polyfit(np.log(list(series)), np.log(worst(quantity, series)), 1)[0]
        for quantity in _QUANTITIES
    }
    ratio, spring = (
        exact.load(full.a) / exact.load(least.a),
        exact.softness(full.a) - exact.softness(least.a),
    )
    known = sum(exact.steepness(one.a) * exact.allowed(one.a, h) for one in (full, least)) / abs(
        spring
    )

    def of(quantity: str) -> float:
        return max((getattr(one, quantity) for one in loads), key=abs)

    every = max(
        abs(one.radius) / exact.allowed(one.a, one.h) for some in series.values() for one in some
    )
    return [
        Row(
            f"{name}, {bricks} bricks along the radius: contact radius / exact [-]",
            1.0,
            1 + of("radius"),
            allowed,
            order=order["radius"],
        ),
        Row(
            f"{name}: contact radius, error over that allowed at its h, all meshes [-]",
            0.0,
            every,
            1.0,
        ),
        Row(
            f"{name}: peak pressure / exact [-]",
            1.0,
            1 + of("peak"),
            exact.axes * allowed,
            order=order["peak"],
        ),
        Row(
            f"{name}: pressure at the nodes, rms error / peak [-]",
            0.0,
            of("spread"),
            4 / 15 * np.sqrt(2 * exact.axes) * h / least.a,
            order=order["spread"],
        ),
        Row(
            f"{name}: approach(P) - {ratio:.2f} approach(P / {ratio:.2f}) [m]",
            exact.load(full.a) * spring,
            full.approach - ratio * least.approach,
            known,
        ),
    ]


def draw_contact(figure: Figure, found: Mapping[Hertz, Mapping[int, list[Pressed]]]) -> None:
    """Pressures, the softening of the contact with the load, and the errors."""
    profiles, (softening, errors) = figure.subplots(2, 2)
    r = np.sin(np.linspace(0, np.pi / 2, 100))
    colours = [colour for colour, _ in LINES]
    for axes, (exact, series) in zip(profiles, found.items()):
        axes.plot(r, np.sqrt(1 - r**2), "k-", linewidth=0.8, label="Hertz")
        for n, colour, mark in zip((min(series), max(series)), colours, "o^"):
            one = series[n][0]
            axes.plot(
                one.place,
                one.pressures,
                mark,
                color=colour,
                markersize=3.5,
                fillstyle="none",
                label=f"$a/h$ = {n}",
            )
        axes.set(
            title=f"{exact.name}, full load",
            xlabel="$r/a$",
            ylabel="$p/p_0$",
            xlim=(-0.03, 1.3),
            ylim=(-0.03, 1.1),
        )
        axes.legend()
    for (exact, series), colour in zip(found.items(), colours):
        loads = series[max(series)]
        radii, full = np.linspace(loads[-1].a, LARGEST), loads[0]
        softening.plot(
            radii / LARGEST,
            [
                (exact.softness(a) - exact.softness(LARGEST)) / exact.steepness(LARGEST)
                for a in radii
            ],
            "k-",
            linewidth=0.8,
            label="Hertz" if exact.axes == 1 else None,
        )
        softer = np.array(
            [one.approach / exact.load(one.a) for one in loads]
        ) - full.approach / exact.load(full.a)
        softening.plot(
            [one.a / LARGEST for one in loads],
            softer / exact.steepness(LARGEST),
            "o^"[exact.axes - 1],
            color=colour,
            markersize=4,
            fillstyle="none",
            label=exact.name,
        )
        sizes = 1 / np.array(list(series))
        for quantity, mark in _QUANTITIES.items():
            errors.loglog(
                sizes, worst(quantity, series), mark, color=colour, markersize=3.5, linewidth=0.9
            )
    sizes = np.array([1 / 13, 1 / 2.8])
    for power, factor in ((1, 0.42), (2, 0.7)):
        errors.loglog(sizes, factor * sizes**power, "k-", linewidth=0.6)
        errors.annotate(
            f"order {power}",
            (sizes[0], factor * sizes[0] ** power),
            xytext=(0, 5),
            textcoords="offset points",
            fontsize=7,
        )
    for exact, colour in zip(found, colours):
        errors.plot([], [], "-", color=colour, label=exact.name)
    for label, mark in zip(
        ("contact radius", "peak pressure", "pressure, rms / peak"), _QUANTITIES.values()
    ):
        errors.plot([], [], mark, color="0.4", markersize=3.5, linewidth=0.9, label=label)
    errors.set(
        xlabel="$h/a$, full load",
        ylabel="relative error",
        title="worst of the loads",
        ylim=(2e-4, 1.5),
    )
    errors.set_xticks((1 / 12, 1 / 8, 1 / 6, 1 / 4, 1 / 3), ("1/12", "1/8", "1/6", "1/4", "1/3"))
    errors.set_xticks((), minor=True)
    errors.legend(ncols=2, loc="upper left")
    softening.set(
        xlabel=r"$a$ / $a$ of full load $\hat P$",
        ylabel=r"$(\delta/P - \hat\delta/\hat P)\,/\,|\hat a\,d(\delta/P)/da|$",
        title="approach",
    )
    softening.legend()
