"""Rolling and wobbling: steady precession of a tilted body on its round rim, and what the corners
of the meshed rim cost.

Requirement: a body set precessing at the rate of the closed form goes on so. Where the rim is taken
as the polygon of its n nodes it loses what a rigid regular polygon loses; where it is taken as the
circle that it is (`fecolumn.contact.rim`, the column's default) it loses nothing.

Derivation. Mass m, inertia I_1 across and I_3 along the axis, rim radius a, centre of mass h above
the foot, tilt th, precession W, spin w_3 = k W along the axis. d points down to the contact, j
along the rim, e along the axis; the rim does not slip:

    w = -W sin th d + k W e,    v = W (h sin th - k a) j,
    force on the rim = m g z - m W v (horizontal part of d),
    W^2 {I_1 sin th cos th - I_3 k sin th + m (h sin th - a k) (a sin th + h cos th)}
        = m g (a cos th - h sin th).

k = cos th - 1: rolling once around without twist, what a column let go in two directions does;
small th: W^2 = m g (a - h th) / (I_h th), I_h = I_1 + m h^2. k = (h / a) sin th: the centre of mass
rests (Euler's disk; I_1 = m a^2 / 4, h = 0: W^2 = 4 g / (a sin th)). On a polygon the body turns
about one corner until the next lands with the velocity u = w x 2 a sin(pi / n) j; plastic impact
takes u . M u / 2, M the inverse of the mobility of the contact point. Without twist and for small
th this is, per revolution (n corners),

    2 pi^2 / n  m_e (a th W)^2,    m_e = m I_h / (I_h + m a^2):
    each corner ~ 1 / n^2, a revolution ~ 1 / n.

`rolling_rim` has both, and the polygon's motion integrated to 1e-10, which is the exact value of
the losses here. The reference column at th = 0.03: n = 60 takes 0.11 % of the energy in a
revolution, a twentieth of the 2.4 % that Housner's impact takes of a planar rocking column at each
of its two impacts per cycle.

Source: Kessler and O'Reilly 2002 (Regul. Chaotic Dyn. 7); Srinivasan and Ruina 2008; Stefanou,
Vardoulakis and Mavraganis 2011.

Tolerances. Loss: bodies and contacts are set at the end of the step in which a corner lands, half a
step of the N of a passage on average: 1 / (2 N). In a passage the body turns by 2 pi / n, which
changes the speed of approach u by the square of it: the moment of impact is off by (2 pi / n)^2 dt
/ (2 N), for which the weight's impulse acts at the wrong corner, m g u each second. An elastic
corner, C its static compliance, gives back nothing of (m g)^2 C / 2 when it lets go within a step.
Rate: the losses quicken the body, so that the polygon's excess over the circle is as uncertain as
the loss. It vanishes as 1 / n: a polynomial in 1 / n through k rims leaves the power k, the product
of the shares of energy lost. On the circle: the start puts the weight suddenly on an elastic foot,
half of the work (m g)^2 C is lost and half stored, and the foot sinks by m g C, a change of tilt by
its share of a th. The step's turn W dt takes a third order of itself of the energy exchanged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import GRAVITY, Material
from fecolumn.engines.dynamics.gravity import tilted
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import State, System
from fecolumn.mesh.bricks import LOWER
from fecolumn.mesh.gmsh_section import extruded
from fecolumn.mesh.section import Annulus
from fecolumn.verification.models import STEEL, block_system, box, column_system, roll_on_corners
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.rolling_rim import RollingRim
from fecolumn.verification.trial import RigidRocking, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure


CORNERS = (24, 48, 96)
PASSAGE = 8  # steps from corner to corner of a short cylinder
_RADIUS = 0.05
CYLINDER, DISK = (0.1, 0.1), (0.02, 0.2)  # height [m], tilt [rad]
COLUMN_TILT, SMALL_TILT, COLUMN_DT = 0.03, 0.003, 1e-3
_STIFF = 2e13


def run(engine: str, long: bool) -> CaseRows:
    """All but total Lagrangian, which is slow: it leaves out the finest rim and the column unless
    `long`.
    """
    whole, result = long or engine != "total_lagrangian", CaseRows(size=(7.2, 2.5))
    found = {n: short_cylinder(engine, n) for n in (CORNERS if whole else CORNERS[:2])}
    disks = {n: short_cylinder(engine, n, DISK, RollingRim.centred) for n in found}
    result.rows += rolling_rows("short cylinder", found) + rolling_rows("Euler's disk", disks)
    polygons = (
        {modulus: wobbling_column(engine, modulus, circle=False) for modulus in (_STIFF, STEEL)}
        if whole
        else {}
    )
    circles = {
        tilt: wobbling_column(engine, STEEL, tilt)
        for tilt in ((COLUMN_TILT, SMALL_TILT) if whole else (COLUMN_TILT,))
    }
    result.rows += column_rows(polygons, circles)

    def draw(figure: Figure) -> None:
        left, middle, right = figure.subplots(1, 3)
        corners = np.array(list(found))
        fine = np.geomspace(corners[0] / 1.2, corners[-1] * 1.2, 20)
        rim, spin = (found[corners[-1]][key] for key in ("rim", "spin"))
        energy = rim.energy(CYLINDER[1], spin)
        left.loglog(
            corners,
            [100 * (one["rate"] / one["steady"] - 1) for one in found.values()],
            "o",
            color="#D55E00",
            label=engine.replace("_", " "),
        )
        left.loglog(
            corners,
            [100 * (one["polygon_rate"] / one["steady"] - 1) for one in found.values()],
            "k+",
            label="rigid polygon",
        )
        left.set(ylabel="mean precession above the circle's [%]")
        middle.loglog(
            corners,
            [100 * one["loss"] for one in found.values()],
            "o",
            color="#D55E00",
            label=engine.replace("_", " "),
        )
        middle.loglog(
            corners,
            [100 * one["polygon_loss"] for one in found.values()],
            "k+",
            label="rigid polygon",
        )
        middle.loglog(
            fine,
            [100 * n * rim.corner_loss(CYLINDER[1], spin, n) / energy for n in fine],
            "k-",
            label="leading order, $1/n$",
        )
        middle.set(ylabel="energy lost in a revolution [%]")
        excess = 100 * (found[corners[-1]]["polygon_rate"] / found[corners[-1]]["steady"] - 1)
        left.loglog(fine, excess * corners[-1] / fine, "k-", label="$1/n$")
        for axes, ticks in ((left, (1, 2, 5)), (middle, (5, 10, 20))):
            axes.set(xlabel="nodes on the rim, short cylinder")
            axes.minorticks_off()
            axes.set_xticks(corners, [str(n) for n in corners])
            axes.set_yticks(ticks, [str(tick) for tick in ticks])
            axes.legend()
        one = circles[COLUMN_TILT]
        shown = [
            (f"polygon, {modulus / 1e9:g} GPa", polygon) for modulus, polygon in polygons.items()
        ] + [("circle, 200 GPa", one)]
        for (label, course), colour, dashes in zip(
            shown[::-1], ("#009E73", "#D55E00", "#0072B2"), ("-", "-", "--")
        ):
            right.plot(
                course["turned"],
                100 * (course["energies"] / course["energies"][0] - 1),
                color=colour,
                linestyle=dashes,
                label=label,
            )
        path = one["polygon"]
        right.plot(
            np.unwrap(path[:, 2]) / (2 * np.pi),
            100 * (path[:, 1] / path[0, 1] - 1),
            "k-",
            label="rigid polygon",
        )
        right.axhline(
            -100 * one["planar"], color="k", linewidth=0.8, linestyle=":", label="one planar impact"
        )
        right.set(
            xlabel="revolutions of the column, 60 nodes",
            ylabel="change of energy [%]",
            xlim=(0, 0.5),
            ylim=(None, 0.2),
        )
        right.legend(loc="lower left", bbox_to_anchor=(0, 0.12))

    result.draw = draw
    return result


def rolling(rim: RollingRim, tilt: float, spin: float) -> Callable[[System], State]:
    """Start of a trial in steady precession on the lowest node, leaning towards +x."""

    def start(system: System) -> State:
        state = tilted(system, tilt, 0.0)
        lowest = state.x[np.argmin(state.x[:, 2])]
        state.v = np.cross(rim.angular_velocity(tilt, spin), state.x - lowest)
        return state

    return start


def azimuth(trial: Trial) -> float:
    """Where the body leans [rad]."""
    return float(np.arctan2(trial.state.rotation[0, 1, 2], trial.state.rotation[0, 0, 2]))


def roll(
    engine: str, system: System, rim: RollingRim, tilt: float, spin: float, corners: int, steps: int
) -> dict:
    """Mean rate [rad/s] and energy lost / energy in `steps`, with those of the rigid polygon, and
    their courses.
    """
    trial, dt = begin_trial(engine, system, rolling(rim, tilt, spin)), system.hht.dt
    energy, azimuths = rim.energy(tilt, spin), [0.0]
    mechanical = [trial.mechanical()]
    for _ in range(steps):
        trial.step()
        azimuths.append(azimuth(trial))
        mechanical.append(trial.mechanical())
    turned = np.unwrap(azimuths)
    # the ledger measures gravity energy from the reference configuration: shifted to that above
    # standing
    energies = np.array(mechanical) - mechanical[0] + energy
    path = rim.polygon(tilt, spin, corners, steps * dt)
    return dict(
        rim=rim,
        spin=spin,
        rate=turned[-1] / (steps * dt),
        turned=turned / (2 * np.pi),
        energies=energies,
        polygon=path,
        loss=1 - energies[-1] / energy,
        polygon_loss=1 - path[-1, 1] / path[0, 1],
        polygon_rate=np.unwrap(path[:, 2])[-1] / (steps * dt),
        steady=rim.rate(tilt, spin),
    )


def short_cylinder(
    engine: str,
    corners: int,
    size: tuple[float, float] = CYLINDER,
    spin: Callable[[RollingRim, float], float] = RollingRim.untwisted,
) -> dict:
    """A revolution of a stiff ring of bricks, inner radius 0.03 m, with PASSAGE steps from corner
    to corner.
    """
    (height, tilt), stiff = (
        size,
        Material(youngs_modulus_pa=2e12, poissons_ratio=0.3, density_kg_m3=7850.0),
    )
    wide = np.linspace(-0.15, 0.15, 4)

    def ring(dt: float) -> System:
        return block_system(
            engine,
            extruded(Annulus(0.03, _RADIUS, corners, 1), 0.0, height, 1, LOWER),
            box(wide, wide, [-0.02, 0]),
            HHT(dt, 0.0),
            material=stiff,
            friction=5.0,
        )

    rim = RollingRim.of(ring(1e-3))
    turning = spin(rim, tilt)
    dt = 2 * np.pi / rim.rate(tilt, turning) / (PASSAGE * corners)
    return dict(
        roll(engine, ring(dt), rim, tilt, turning, corners, PASSAGE * corners),
        tilt=tilt,
        corners=corners,
        dt=dt,
    )


def impact_allowance(one: dict, passage: float, dt: float, compliance: float = 0.0) -> float:
    """Tolerance of the polygon's loss [-], relative, of a body with `compliance` [m/N] at a
    corner.
    """
    rim, weight = one["rim"], one["rim"].mass * GRAVITY
    speed = np.linalg.norm(rim.landing(one["tilt"], one["spin"], one["corners"]))
    lost = rim.corner_loss(one["tilt"], one["spin"], one["corners"])
    moment = (2 * np.pi / one["corners"]) ** 2 * dt / (2 * passage)
    return 1 / (2 * passage) + (weight * speed * moment + weight**2 * compliance / 2) / lost


def rolling_rows(name: str, found: Mapping[int, dict]) -> list[Row]:
    """Rate and loss by the number of rim nodes, with their orders in it, and the rate on the
    circle.
    """
    excess = {n: one["rate"] / one["steady"] - 1 for n, one in found.items()}
    rate, loss = (
        np.polyfit(-np.log(list(found)), np.log(values), 1)[0]
        for values in (list(excess.values()), [one["loss"] for one in found.values()])
    )
    rows = []
    for n, one in found.items():
        allowed = impact_allowance(one, PASSAGE, one["dt"])
        rows += [
            Row(
                f"precession, {name}, {n} nodes, rigid polygon's [rad/s]",
                one["polygon_rate"],
                one["rate"],
                allowed * (one["polygon_rate"] / one["steady"] - 1),
                order=rate,
            ),
            Row(
                f"lost in a revolution / energy, {name}, {n} nodes, polygon's [-]",
                one["polygon_loss"],
                one["loss"],
                allowed,
                order=loss,
            ),
        ]
    # the polynomial in 1 / n through all rims, at 0
    circle = np.polyfit([1 / n for n in found], list(excess.values()), len(found) - 1)[-1]
    steady, rims = found[n]["steady"], ", ".join(str(n) for n in found)
    return rows + [
        Row(
            f"precession, {name}, {rims} nodes to a circle [rad/s]",
            steady,
            steady * (1 + circle),
            float(np.prod([one["loss"] for one in found.values()])),
        )
    ]


def wobbling_column(
    engine: str, modulus: float, tilt: float = COLUMN_TILT, circle: bool = True
) -> dict:
    """Half a revolution of the coarse specimen, whose foot has the reference mesh: two rows of 60
    nodes.
    """
    stiffness = {"material": {"youngs_modulus_pa": modulus}, "base": {"youngs_modulus_pa": modulus}}
    system = column_system(
        engine, integration={"dt_s": COLUMN_DT}, contact={"friction_coefficient": 0.8}, **stiffness
    )
    corners = int(system.interface.interfaces["rim_count"][0])
    if not circle:
        roll_on_corners(system)
    rim = RollingRim.of(system)
    spin = rim.untwisted(tilt)
    steps = round(np.pi / rim.rate(tilt, spin) / COLUMN_DT)
    one = roll(engine, system, rim, tilt, spin, corners, steps)
    compliance = system.interface.static_compliance(np.array([0]))[2, 2]
    return dict(
        one,
        tilt=tilt,
        corners=corners,
        compliance=compliance,
        passage=2 * steps / corners,
        planar=1 - RigidRocking(system).restitution ** 2,
    )


def column_rows(polygons: Mapping[float, dict], circles: Mapping[float, dict]) -> list[Row]:
    """Loss in a revolution of the column at the reference mesh: as a stiff polygon, the polygon's;
    as the circle, none.
    """
    rows = []
    for modulus, one in polygons.items():
        if modulus == _STIFF:
            rows.append(
                Row(
                    "lost in a revolution / energy, column as polygon, "
                    f"{one['corners']} nodes, {modulus / 1e9:g} GPa, polygon's [-]",
                    2 * one["polygon_loss"],
                    2 * one["loss"],
                    impact_allowance(one, one["passage"], COLUMN_DT, one["compliance"]),
                )
            )
    for tilt, one in circles.items():
        rim = one["rim"]
        weight = rim.mass * GRAVITY
        sudden, third = (
            weight**2 * one["compliance"] / rim.energy(tilt, one["spin"]),
            (one["steady"] * COLUMN_DT) ** 3 * len(one["turned"]),
        )
        rows += [
            Row(
                f"lost in half a revolution / energy, column as circle, tilt {tilt:g} [-]",
                0.0,
                one["loss"],
                sudden + third,
            ),
            Row(
                f"precession, column as circle, tilt {tilt:g} [rad/s]",
                one["steady"],
                one["rate"],
                weight * one["compliance"] / (rim.radius * tilt) + third,
            ),
        ]
    return rows
