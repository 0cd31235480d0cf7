"""Elastic bar against a rigid wall: what the treatment of impacts costs an elastic body.

Requirement: contact force, contact time and rebound of the wave solution, for any alpha, with the
plastic impact law and without (literal HHT); what impact law and contact take vanishes with the
mesh, to first order.

Derivation. A bar (length L, section A, density rho, Young's modulus E, nu = 0) lands at v: the foot
stops and a wave of c = (E / rho)^(1/2) runs up and back. Contact force F = rho c A v through T = 2
L / c, then the whole bar moves off at v: the kinetic energy is back. Bricks along the bar of h = L
/ n and dt = h / c do to this:

Front. With the frequency error -kappa W^2, W = k c dt = k h (HHT's, less 1/24 of bricks with
consistent mass), and the damping ratio d W^3, a jump has spread over D1 = (3 kappa h^2 2 L)^(1/3)
and D2 = (d h^3 2 L)^(1/4) when it comes back (stationary phase; width of exp(-d h^3 k^4 x)): the
force falls off over D / 2 L of the contact time, D = D1 + D2, where it should fall at once. What is
left in the bar as vibration is missing in the rebound, so that the rebound converges with h^(2/3)
to h^(3/4) only. Landing. The plastic law stops the mass m_e = 1 / (U^T M^-1 U) that the filtered
foot moves with, 0.56 to 0.61 rho A h here, and takes m_e v^2 / 2: exactly that if the foot arrives
at the end of the step. Where in a step contact closes and opens is unknown to the scheme: F v dt /
2 = rho A h v^2 / 2 more. Both are of first order. Damping. The modes (2 j - 1) pi / 2 L of the
standing bar hold the shares 8 / (pi (2 j - 1))^2 of the energy; each loses 1 - |lambda|^(2 T / dt)
by the amplification matrix, together of an order that tends to 3/4 (the jump's spectrum beyond 1 /
D2).

Source. Timoshenko and Goodier (1970), Theory of Elasticity, longitudinal impact of bars; the
numbers are those of Abaqus' example; Deuflhard, Krause and Ertel (2008) on losses at contact;
Hilber, Hughes and Taylor (1977).

Tolerances. Contact time, mean force over the middle half, rebound: width of the front and a step at
either end, D / 2 L + 1 / n. Force: at most the overshoot of a dispersed jump, 27 % (integral of the
Airy function); literal HHT rings beyond that. Loss in contact: (m_e + rho A h) v^2 / 2; without
impact law rho A h v^2 / 2. Loss of HHT: what is lost at landing, m_e v^2 / 2 or rho A h v^2 / 2,
comes out of the highest frequencies and is spared to HHT. Slope of the contact's loss: opening adds
a share that moves with D / 2 L: 0.05. Landing at the end of a step: the impact problem is softened
by 1e-3; as an energy minimum the loss changes by the square of that: 1e-5. Closure: 1e-6; the
ledger's trapezoidal work of a St. Venant-Kirchhoff bar is off by a share v / c = 3e-4, its strain,
where a front passes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import Material
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import System
from fecolumn.pictures.figures.style import LINES
from fecolumn.verification import FULL
from fecolumn.verification.hht_scheme import amplification, principal
from fecolumn.verification.models import block_system, box
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.trial import afloat

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_LENGTH, AREA, MODULUS, _DENSITY, SPEED = 2.0, 0.2, 200e9, 7800.0, 1.5
_WAVE = np.sqrt(MODULUS / _DENSITY)
FORCE, _TIME, _MASS = (
    _DENSITY * _WAVE * AREA * SPEED,
    2 * _LENGTH / _WAVE,
    _DENSITY * AREA * _LENGTH,
)
_ENERGY = _MASS * SPEED**2 / 2
_ALPHAS = (0.0, -0.1, -0.333)
_IMPACTS = ("plastic", "none")
BRICKS = (16, 32, 64, 128)


@dataclass(frozen=True, slots=True)
class Strike:
    """One impact, over 1.25 contact times.

    Attributes
    ----------
    time, force
        (m,) from the moment of contact [s], and [N].
    rebound
        velocity of the centre of mass [m/s].
    contact, damping
        energy that contact and impact law, and HHT took [J].
    landing
        the first of these in the first step of contact.
    foot
        mass m_e of the filtered foot [kg], 0 without the impact law.
    closure
        of the ledger [J].
    """

    time: np.ndarray
    force: np.ndarray
    rebound: float
    contact: float
    damping: float
    landing: float
    foot: float
    closure: float

    @property
    def duration(self) -> float:
        """Time [s] between rise and fall of the force through half of F."""
        above = np.flatnonzero(self.force > FORCE / 2)
        first, last = above[0], above[-1]
        rise = np.interp(
            FORCE / 2, self.force[first - 1 : first + 1], self.time[first - 1 : first + 1]
        )
        return float(
            np.interp(-FORCE / 2, -self.force[last : last + 2], self.time[last : last + 2]) - rise
        )

    @property
    def mean(self) -> float:
        """Force [N] over the middle half of the contact."""
        return float(self.force[np.abs(self.time / _TIME - 0.5) < 0.25].mean())


def strike(engine: str, bricks: int, alpha: float, impact: str, arrival: float = 0.5) -> Strike:
    """Impact of a bar of `bricks` that touches `arrival` of a step after the start."""
    dt, half = _LENGTH / bricks / _WAVE, np.sqrt(AREA) / 2
    bar = Material(youngs_modulus_pa=MODULUS, poissons_ratio=0.0, density_kg_m3=_DENSITY)
    wall = Material(youngs_modulus_pa=1e15, poissons_ratio=0.0, density_kg_m3=_DENSITY)
    system = block_system(
        engine,
        box([-half, half], [-half, half], np.linspace(0, _LENGTH, bricks + 1)),
        box([-1, 1], [-1, 1], [-0.1, 0]),
        HHT(dt, alpha),
        material=bar,
        base_material=wall,
        gravity=(0, 0, -1e-6),
        filtered=impact == "plastic",
    )
    still = np.zeros_like(system.body.X)
    falling = still + [0, 0, -SPEED], still + system.gravity
    trial = begin_trial(
        engine,
        system,
        lambda system: afloat(system, still, *falling, height=arrival * SPEED * dt),
        impact,
        n_modes=3 * system.body.n_nodes,
    )
    time, force, taken = [-arrival * dt], [0.0], []
    while time[-1] < 1.25 * _TIME:
        state = trial.step()
        ledger = trial.energy()
        time.append(time[-1] + dt)
        force.append(state.forces[:, 2].sum())
        taken.append(-ledger["contact"] - ledger["impact"])
    landing = taken[np.flatnonzero(force)[0] - 1]
    momentum = system.body.node_mass @ state.v[:, 2]
    return Strike(
        np.array(time),
        np.array(force),
        momentum / system.body.total_mass,
        taken[-1],
        -ledger["algorithmic"],
        landing,
        foot_mass(system) if impact == "plastic" else 0.0,
        ledger["closure"],
    )


def foot_mass(system: System) -> float:
    """Mass [kg] with which the filtered foot resists a common vertical velocity of its points."""
    assert system.interface.foot.mobility is not None
    mobility = system.interface.foot.mobility[0][:, :, 2, 2]
    return float(np.linalg.solve(mobility, np.ones(len(mobility))).sum())


def front(bricks: int, alpha: float) -> float:
    """Width of a jump after the path 2 L, over 2 L [-]."""
    angle = 0.1
    damping, turned = principal(np.linalg.eigvals(amplification(alpha, angle)))
    dispersion, damping = (angle - turned) / angle**3 - 1 / 24, max(damping, 0.0) / angle**3
    step = 1 / (2 * bricks)
    return (3 * dispersion * step**2) ** (1 / 3) + (damping * step**3) ** (1 / 4)


def damped(bricks: int, alpha: float) -> float:
    """Energy [J] that HHT takes from the modes of the bar of `bricks` with its foot at rest, in the
    contact time.
    """
    odd = 2 * np.arange(1, bricks + 1) - 1
    sine = np.sin(odd * np.pi / (4 * bricks))
    angles = 2 * sine / np.sqrt(1 - 2 / 3 * sine**2)  # w dt of bricks with consistent mass
    radii = np.array(
        [np.abs(np.linalg.eigvals(amplification(alpha, angle))).max() for angle in angles]
    )
    return (
        float(_ENERGY * np.sum(8 / (np.pi * odd) ** 2 * (1 - radii ** (4 * bricks))))
        if alpha
        else 0.0
    )


def run(engine: str, long: bool) -> CaseRows:
    """16 to 128 bricks; 256 as well if `long`.

    The reduced engine with all modes that the bar has; it knows the plastic law only.
    """
    bricks = BRICKS + (256,) if long else BRICKS
    impacts = _IMPACTS if engine in FULL else _IMPACTS[:1]
    strikes = {
        (impact, alpha): {n: strike(engine, n, alpha, impact) for n in bricks}
        for impact in impacts
        for alpha in _ALPHAS
    }
    result = CaseRows(size=(7.2, 5.2))
    for (impact, alpha), series in strikes.items():
        result.rows += bar_rows(
            impact, alpha, series, closure=1e-6 if engine != "total_lagrangian" else SPEED / _WAVE
        )
    for alpha in _ALPHAS:
        last = strike(engine, bricks[-1], alpha, "plastic", arrival=1 - 1e-6)
        result.rows.append(
            Row(
                f"plastic, alpha {alpha:g}: taken by a landing at the end of a step [J]",
                last.foot * SPEED**2 / 2,
                last.landing,
                1e-5,
            )
        )
    result.draw = lambda figure: draw_bar(figure, strikes)
    return result


def order(series: dict[int, Strike], error: Callable[[Strike], float]) -> float:
    """Least-squares order in h of error(strike)."""
    return float(
        -np.polyfit(np.log(list(series)), np.log([abs(error(one)) for one in series.values()]), 1)[
            0
        ]
    )


def bar_rows(impact: str, alpha: float, series: dict[int, Strike], closure: float) -> list[Row]:
    """What the finest mesh finds, with orders over all meshes; `closure` is the tolerance of the
    ledger's.
    """
    bricks, name = max(series), f"{impact}, alpha {alpha:g}"
    last = series[bricks]
    width, sliver = front(bricks, alpha), _ENERGY / bricks
    landing = last.foot / _MASS * _ENERGY
    slope = order(series, lambda one: one.contact)
    found = [
        Row(f"{name}, {bricks} bricks: contact time [s]", _TIME, last.duration, width + 1 / bricks),
        Row(
            f"{name}: contact force, mean of the middle half [N]",
            FORCE,
            last.mean,
            width + 1 / bricks,
        ),
        Row(
            f"{name}: rebound velocity [m/s]",
            SPEED,
            last.rebound,
            width + 1 / bricks,
            order=order(series, lambda one: one.rebound - SPEED),
        ),
        Row(
            f"{name}: taken by contact and impact law [J]",
            0.0,
            last.contact,
            landing + sliver,
            order=slope,
        ),
        Row(
            f"{name}: taken by HHT [J]",
            damped(bricks, alpha),
            last.damping,
            (landing or sliver) if alpha else 1e-6 * _ENERGY,
            scale=1.0,
            order=order(series, lambda one: one.damping) if alpha else None,
        ),
        Row(f"{name}: ledger closure / energy [-]", 0.0, last.closure / _ENERGY, closure),
    ]
    if impact == "plastic":
        found += [
            Row(
                f"{name}: order in h of what contact and impact law take [-]",
                1.0,
                slope,
                0.05,
                order=slope,
            ),
            Row(
                f"{name}: largest force [N]",
                FORCE,
                max(one.force.max() for one in series.values()),
                0.2743,
            ),
        ]
    return found


def draw_bar(figure: Figure, strikes: Mapping[tuple[str, float], Mapping[int, Strike]]) -> None:
    """Contact force against time for meshes and alphas, and the convergence."""
    ((meshes, alphas), (literal, orders)) = figure.subplots(2, 2)
    some = strikes["plastic", 0.0]
    for n, (colour, dashes) in zip((min(some), sorted(some)[1], max(some)), LINES):
        meshes.plot(
            1e3 * some[n].time,
            some[n].force / 1e6,
            color=colour,
            linestyle=dashes,
            label=f"{n} bricks",
        )
    for axes, impact in ((alphas, "plastic"), (literal, "none")):
        for alpha, (colour, dashes) in zip(_ALPHAS if (impact, 0.0) in strikes else (), LINES):
            one = strikes[impact, alpha][64]
            axes.plot(
                1e3 * one.time,
                one.force / 1e6,
                color=colour,
                linestyle=dashes,
                label=rf"$\alpha$ = {alpha:g}",
            )
    titles = (
        r"plastic impact law, $\alpha$ = 0",
        "plastic impact law, 64 bricks",
        "literal HHT, 64 bricks",
    )
    for axes, title in zip((meshes, alphas, literal), titles):
        axes.plot(
            1e3 * np.array([-0.05, 0, 0, 1, 1, 1.25]) * [1, 1, 1, _TIME, _TIME, _TIME],
            FORCE / 1e6 * np.array([0, 0, 1, 1, 0, 0]),
            "k-",
            linewidth=0.7,
            label="exact",
            zorder=1.5,
        )
        axes.set(
            title=title,
            xlabel="time since contact [ms]",
            ylabel="contact force [MN]",
            xlim=(-0.05, 1.25e3 * _TIME),
            ylim=(-0.5, 20),
        )
        axes.legend(loc="upper right")
    if ("none", 0.0) not in strikes:
        literal.remove()
    for alpha, mark, (colour, _) in zip(_ALPHAS, "os^", LINES):
        series = strikes["plastic", alpha]
        lost = np.array(
            [
                (1 - one.rebound / SPEED, one.contact / _ENERGY, one.damping / _ENERGY)
                for one in series.values()
            ]
        ).T
        for values, dashes in zip(lost if alpha else lost[:2], ("-", "--", ":")):
            orders.loglog(
                list(series), values, color=colour, linestyle=dashes, marker=mark, markersize=3
            )
        orders.plot(
            [],
            [],
            color=colour,
            linestyle="none",
            marker=mark,
            markersize=3,
            label=rf"$\alpha$ = {alpha:g}",
        )
    for dashes, label in (
        ("-", "rebound velocity"),
        ("--", "energy, contact"),
        (":", "energy, HHT"),
    ):
        orders.plot([], [], "k", linestyle=dashes, label=label)
    orders.set_xticks(list(series), [str(n) for n in series])
    orders.set_xticks([], minor=True)
    orders.set(
        title="plastic impact law",
        xlabel="bricks along the bar",
        ylabel="lost / initial",
        ylim=(1e-3, 0.1),
    )
    orders.legend(ncols=2, loc="lower left")
