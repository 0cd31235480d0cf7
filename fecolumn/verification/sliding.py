"""Sliding of a squat block and of the column: Coulomb's law between stick and slip, in one and two
directions.

Requirement: what sticks does not creep, what slips obeys Coulomb's law in size and direction, and
the ledger's friction is force times path.

Derivation. A rigid block of mass m that does not tip, relative displacement u on a base with
acceleration a_g, slope b, obeys

    u'' = g sin(b) e_x - a_g - mu g cos(b) u' / |u'|    while it slides,
    |g sin(b) e_x - a_g| <= mu g cos(b)                 while it sticks.

Slope: rest for mu > tan b; else s = a t^2 / 2, a = g (sin b - mu cos b), friction takes mu m g
cos(b) s. Ramp a_g = k t: slip starts at mu g; at a slip d since then the ground has reached mu g +
(6 d k^2)^(1/3). One-sine pulse A sin(w t), A = 2 mu g: slip one way, at once back, past the end of
the pulse (Newmark 1965); closed form. Two directions: a_g = A (cos w t, sin w t), A = 2 mu g, never
lets the slip stop; integrated to 1e-12. Both in `coulomb_block`.

Source: Coulomb 1785; Newmark 1965 (Geotechnique 15).

Tolerances. A block in equilibrium moves by rounding alone: the requirement's 1e-9 m. When glued
points let go, a slack of d = rho g H^2 / G = 4e-10 m is run through before all of them slip. That
gives a velocity of sqrt(2 a d) < 4e-5 m/s at most, after 0.3 s 1e-4 of g sin(b) t^2 / 2. The column
on the ramp sways in its first mode by what the ramp's corner excites, 1.9 m/s3 over 2 pi f = 300
1/s, above the threshold for half a period at most: 1 %. The step sees the mean of a_g at its ends
and one friction force:

- Each kink of the acceleration (slip starts) shifts the velocity by A w dt^2 / 8. The trapezoidal
  rule shifts it by A w dt^2 / 12 in each of four quarter waves. So a displacement after T is off by
  (1/8 + 1/3) A w T dt^2. Each end of slip inside a step leaves mu g dt^2 / 2 besides.
- In two directions acceleration and friction turn by w dt, which makes
  (A / 12 + mu g / 24) (w dt)^2 T^2 / 2. The one friction force of a step is w dt / 2 off the slip's
  direction at most.

A block that slid comes to rest on a level base and needs no friction then. The friction of its
sway, 1e-3 mu m g, is left.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import State, System
from fecolumn.verification.coulomb_block import NewmarkBlock, TurningBlock
from fecolumn.verification.models import block_system, box, column_system
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.rocking import ramp
from fecolumn.verification.trial import Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure


SLOPE, FRICTION = 0.3, 0.3
RESISTANCE = FRICTION * GRAVITY
_AMPLITUDE = 2 * RESISTANCE
_FREQUENCY = 4 * np.pi  # of pulse and turning ground [rad/s]
_STEPS = (8e-3, 4e-3, 2e-3, 1e-3)
SHIFTS = (0.0, 0.3, 0.7)  # of the pulse [dt]: where in a step its events fall must not matter
# Drawn step sizes: every so manieth step, and how
MARKS = {
    8e-3: (
        3,
        {"color": "#D55E00", "marker": "s", "linestyle": "", "markersize": 3, "fillstyle": "none"},
    ),
    2e-3: (
        8,
        {"color": "#0072B2", "marker": "o", "linestyle": "", "markersize": 3, "fillstyle": "none"},
    ),
}


#: Exact block, times [s], slip [m] at them, friction energy over mu m g [m] of a pulse.
SinePulse = tuple[NewmarkBlock, np.ndarray, np.ndarray, float]
#: Error of the slip [m], path (n, 2) [m], exact path, largest angle between friction and -velocity
#: [rad] on ground that turns.
TurningSlide = tuple[float, np.ndarray, np.ndarray, float]


def run(engine: str, long: bool) -> CaseRows:
    """All but total Lagrangian, which is slow: it leaves out the column on the ramp unless
    `long`.
    """
    result = CaseRows(size=(7.2, 2.5))
    result.rows += [
        creep(engine),
        *(row for share in (0.5, 0.9) for row in slope_slide(engine, share)),
    ]
    if long or engine != "total_lagrangian":
        result.rows.append(threshold(engine))
    pulses = {dt: [one_sine(engine, dt, shift) for shift in SHIFTS] for dt in _STEPS}
    turns = {dt: two_directions(engine, dt) for dt in _STEPS}
    result.rows += pulse_rows(pulses) + turn_rows(turns) + [rest(engine)]

    def draw(figure: Figure) -> None:
        left, middle, right = figure.subplots(1, 3)
        fine = np.linspace(0, 0.7, 300)
        left.plot(
            fine,
            1e3 * NewmarkBlock(_AMPLITUDE, _FREQUENCY, RESISTANCE).displacement(fine),
            "k-",
            label="Newmark (1965)",
        )
        for dt in MARKS:
            (_, time, path, _), every, marker = pulses[dt][0], *MARKS[dt]
            left.plot(time[::every], 1e3 * path[::every], **marker, label=f"dt = {1e3 * dt:g} ms")
        left.set(
            xlabel="time [s]", ylabel="slip, one-sine pulse [mm]", xlim=(0, 0.7), ylim=(None, 28)
        )
        left.legend(loc="upper right")
        middle.plot(*1e3 * turns[1e-3][2].T, "k-", label="rigid block")
        for dt in MARKS:
            every, marker = MARKS[dt]
            middle.plot(*1e3 * turns[dt][1][::every].T, **marker, label=f"dt = {1e3 * dt:g} ms")
        middle.set(xlabel="$u_x$ [mm]", ylabel="$u_y$ [mm]")
        middle.set_aspect("equal", "datalim")
        middle.legend()
        steps = 1e3 * np.array(_STEPS)
        for errors, label, style in (
            (mean_errors(pulses), "one-sine, mean of 3", "o-"),
            ([turns[dt][0] for dt in _STEPS], "two directions", "s--"),
        ):
            right.loglog(
                steps,
                errors,
                style,
                markersize=3,
                color="#0072B2" if "o" in style else "#D55E00",
                label=label,
            )
        right.loglog(steps, 1.5e-6 * steps**2, "k:", label="order 2")
        right.set_xticks(steps, [f"{step:g}" for step in steps])
        right.minorticks_off()
        right.set(xlabel="dt [ms]", ylabel="error of the slip [m]")
        right.legend()

    result.draw = draw
    return result


def block(
    engine: str,
    dt: float,
    friction: float = FRICTION,
    gravity: Sequence[float] | np.ndarray = (0.0, 0.0, -GRAVITY),
) -> System:
    """0.2 x 0.2 x 0.06 m of steel on a wide plate of steel."""
    sides, wide = np.linspace(-0.1, 0.1, 3), np.linspace(-0.6, 0.6, 3)
    return block_system(
        engine,
        box(sides, sides, [0, 0.06]),
        box(wide, wide, [-0.02, 0]),
        HHT(dt, 0.0),
        friction=friction,
        gravity=gravity,
    )


def glued(system: System) -> State:
    """Equilibrium of a block that does not slip, to be let go."""
    points = system.interface.points
    friction, points["friction"] = points["friction"].copy(), 100.0
    state = standing(system)
    points["friction"] = friction
    return state


def centre(trial: Trial) -> np.ndarray:
    """Position (3,) of the centre of mass [m]."""
    column = trial.system.body
    return column.node_mass @ trial.state.x / column.total_mass


def on_slope(engine: str, share: float, start: Callable[[System], State] = glued) -> Trial:
    """A block on the slope with friction `share` tan(slope)."""
    return begin_trial(
        engine,
        block(
            engine,
            1e-3,
            share * np.tan(SLOPE),
            GRAVITY * np.array([np.sin(SLOPE), 0.0, -np.cos(SLOPE)]),
        ),
        start,
    )


def creep(engine: str) -> Row:
    """Largest displacement of any node in 1000 steps, one per cent above the friction needed."""
    trial = on_slope(engine, 1.01, start=standing)
    for _ in range(1000):
        trial.step()
    return Row(
        "creep on a slope in 1000 steps, mu = 1.01 tan b [m]",
        0.0,
        np.abs(trial.state.x - trial.start.x).max(),
        1e-9,
    )


def slope_slide(engine: str, share: float) -> list[Row]:
    """Distance and friction energy of a block let go for 0.3 s."""
    trial = on_slope(engine, share)
    start = centre(trial)
    for _ in range(300):
        trial.step()
    slid, drive = (centre(trial) - start)[0], GRAVITY * np.sin(SLOPE) * trial.state.time**2 / 2
    taken = trial.system.weight * share * np.sin(SLOPE)  # mu m g cos b
    return [
        Row(
            f"slid in 0.3 s, mu = {share:g} tan b; of g sin(b) t^2/2 [m]",
            drive * (1 - share),
            slid,
            1e-4,
            scale=drive,
        ),
        Row(
            f"friction energy, mu = {share:g} tan b, force x path [J]",
            -taken * slid,
            trial.energy()["friction"],
            1e-4,
        ),
    ]


def slipped(trial: Trial, friction: float, slip: float = 1e-6) -> float:
    """Ground acceleration [m/s2] at which a trial's foot has slipped by `slip` [m], on a slow
    ramp.
    """
    return ramp(
        trial,
        friction * GRAVITY,
        lambda trial: bool(
            np.linalg.norm((trial.state.anchors - trial.start.anchors).mean(axis=0)) > slip
        ),
    )


def threshold(engine: str) -> Row:
    """Ground acceleration of a slow ramp at which the column has slipped by 1e-6 m."""
    friction, slip = 0.05, 1e-6
    trial = begin_trial(
        engine,
        column_system(
            engine, contact={"friction_coefficient": friction}, integration={"dt_s": 4e-3}
        ),
    )
    found = slipped(trial, friction, slip)
    return Row(
        "ramp that slips the column by 1e-6 m, mu 0.05 [m/s2]",
        friction * GRAVITY + np.cbrt(6 * slip * 0.1**2),
        found,
        0.01,
    )


def one_sine(engine: str, dt: float, shift: float) -> SinePulse:
    """(exact block, times [s], slip [m] at them, friction energy / mu m g [m]) under a pulse that
    starts `shift` dt late.
    """
    exact, trial = (
        NewmarkBlock(_AMPLITUDE, _FREQUENCY, RESISTANCE),
        begin_trial(engine, block(engine, dt)),
    )
    start, path = centre(trial), [0.0]
    while trial.state.time < 0.7:
        time = trial.state.time + (1 - shift) * dt
        trial.step(
            (
                _AMPLITUDE * np.sin(exact.frequency * time)
                if 0 < time < 2 * np.pi / exact.frequency
                else 0.0,
                0.0,
                0.0,
            )
        )
        path.append((centre(trial) - start)[0])
    return (
        exact,
        dt * (np.arange(len(path)) - shift),
        np.array(path),
        trial.energy()["friction"] / (FRICTION * trial.system.weight),
    )


def mean_errors(pulses: Mapping[float, list[SinePulse]]) -> list[float]:
    """Error of the distance [m] by step size, mean over the shifts."""
    return [
        float(np.mean([abs(path[-1] - exact.distance) for exact, _, path, _ in runs]))
        for runs in pulses.values()
    ]


def pulse_rows(pulses: Mapping[float, list[SinePulse]]) -> list[Row]:
    """Distance of the worst shift and friction energy, with the order in dt of the mean error."""
    order, rows = np.polyfit(np.log(_STEPS), np.log(mean_errors(pulses)), 1)[0], []
    for dt, runs in pulses.items():
        exact, _, path, taken = max(runs, key=lambda one: abs(one[2][-1] - one[0].distance))
        allowed = (11 / 24 * _AMPLITUDE * exact.frequency * exact.stop + 2 * RESISTANCE / 2) * dt**2
        rows.append(
            Row(
                f"slip after one sine, A = 2 mu g, dt {dt:g} s, worst of 3; of the path [m]",
                exact.distance,
                path[-1],
                allowed / exact.path,
                scale=exact.path,
                order=order,
            )
        )
    rows.append(
        Row(
            f"friction energy of it / mu m g, dt {dt:g} s: the path [m]",
            -exact.path,
            taken,
            2 * allowed / exact.path,
        )
    )
    return rows


def two_directions(engine: str, dt: float, seconds: float = 0.6) -> TurningSlide:
    """(error of the slip [m], path (n, 2) [m], exact path, largest angle between friction and
    -velocity [rad]).
    """
    exact = TurningBlock(_AMPLITUDE, _FREQUENCY, RESISTANCE, seconds)

    def moving(system: System) -> State:
        state = standing(system)  # at rest, the base's acceleration just begun
        state.ground[:2] = exact.ground(0.0)
        state.a -= state.ground
        return state

    trial = begin_trial(engine, block(engine, dt), moving)
    start, path, angles = centre(trial), [np.zeros(2)], []
    for _ in range(round(seconds / dt)):
        trial.step((*exact.ground(trial.state.time + dt), 0.0))
        path.append((centre(trial) - start)[:2])
        force, velocity = (
            trial.state.forces[:, :2].sum(axis=0),
            exact.velocity(trial.state.time - dt / 2),
        )
        angles.append(
            abs(np.arctan2(force[1] * velocity[0] - force[0] * velocity[1], -force @ velocity))
        )
    ode = np.array([exact.displacement(dt * k) for k in range(len(path))])
    return float(np.linalg.norm(path[-1] - ode[-1])), np.array(path), ode, float(max(angles))


def turn_rows(turns: Mapping[float, TurningSlide]) -> list[Row]:
    """Slip after the ground has turned, and the direction of friction, with their orders in dt."""
    w, T, rows = _FREQUENCY, 0.6, []
    order, direction = (
        np.polyfit(np.log(_STEPS), np.log(values), 1)[0]
        for values in ([turn[0] for turn in turns.values()], [turn[3] for turn in turns.values()])
    )
    for dt, (error, _, ode, _) in turns.items():
        size = float(np.linalg.norm(ode[-1]))
        rows.append(
            Row(
                f"slip under turning ground, dt {dt:g} s, distance to exact [m]",
                0.0,
                error,
                (_AMPLITUDE / 12 + RESISTANCE / 24) * (w * dt) ** 2 * T**2 / 2 / size,
                scale=size,
                order=order,
            )
        )
    rows.append(
        Row(
            f"angle of friction to -velocity, dt {dt:g} s, largest [rad]",
            0.0,
            turns[dt][3],
            w * dt / 2,
            order=direction,
        )
    )
    return rows


def rest(engine: str) -> Row:
    """Friction on a block at rest on a level base 50 steps after its slide ended in the middle of a
    step.
    """
    dt = 1e-3

    def pushed(system: System) -> State:
        state = standing(system)
        state.v[:, 0] = 16.5 * RESISTANCE * dt
        return state

    trial = begin_trial(engine, block(engine, dt), pushed)
    for _ in range(67):
        trial.step()
    return Row(
        "friction at rest after a slide that ended inside a step / mu m g [-]",
        0.0,
        np.linalg.norm(trial.state.forces[:, :2].sum(axis=0)) / (FRICTION * trial.system.weight),
        1e-3,
    )
