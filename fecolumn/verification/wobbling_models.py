"""The wobbling column and frame against the numbers of their paper, limits in closed form, and
their energy.

Requirement: the restrained frame has the numbers that the paper prints, and those that follow from
its equations; its printed p-values have the samples they can have; in a plane it is the rocking
frame without loss; free motion keeps its energy and momentum; passing upright closely turns the
azimuth as a cone's geodesic does.

Sources: [W] the statistical validation of a wobbling model by tests on a restrained frame, by
equation or table; [D] derived here from it. Its equation 1 lacks a factor alpha in the first term:
as printed a force of the whole weight would be needed at once. Its equations 4 to 6 are those
derived in `benchmarks/wobbling_equations.py` to the last digit.

Tolerances. Printed numbers: half of the last digit. Energy: 1e-10 of it, a hundred times what the
steps' tolerance of 1e-12 leaves in forty seconds. Turn past upright: the closed form leaves out
weight and curvature, of the order of the closest tilt over alpha: 1e-3 at 1e-6.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.case.model_sections import WobblingFrameModel
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking import wobbling_equations as equations
from fecolumn.engines.rocking.wobbling_frame import WobblingFrame
from fecolumn.foundation._compiled import interpreted
from fecolumn.statistics.kolmogorov import asymptotic_p, samples_of_p
from fecolumn.verification.result import CaseRows, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


SPECIMEN: dict[str, Any] = dict(
    columns=4,
    slenderness_rad=0.1359,
    half_diagonal_m=1.463 / 2,
    column_mass_kg=1220 / GRAVITY,
    slab_mass_kg=94350 / GRAVITY,
    tendon_n_m=1.72e6,
)
#: Bins of the paper: motions planned, p printed, and the (n, k) that give it [D of W, Table 2]
BINS = {
    "NFP low": (26, 0.06, ((25, 9), (20, 8))),
    "NFP high": (26, 0.86, ((24, 4), (14, 3))),
    "NF low": (26, 0.65, ((25, 5),)),
    "NF high": (26, 0.59, ((23, 5), (15, 4))),
    "FF low": (42, 0.26, ((42, 9), (26, 7))),
    "FF high": (42, 0.15, ((41, 10), (27, 8))),
}
#: Rates of the azimuth [rad/s] of free motions from a tilt of 0.05 rad: planar, past upright within
#: 1e-5 rad, within 3e-3, a steady roll
_TURNS = (0.0, 1e-3, 0.3, 1.5)


def run(engine: str, long: bool = False) -> CaseRows:
    """All rows."""
    frame = WobblingFrame.of_section(WobblingFrameModel(**SPECIMEN), "specimen")
    paths = {turn: free(frame, 0.05, turn) for turn in _TURNS}
    return CaseRows(
        [
            *_statics(frame),
            *_samples(),
            *_energy(frame, paths),
            *_passing(frame),
            *_equations(frame),
        ],
        lambda figure: _draw(figure, paths),
        (7.2, 2.8),
    )


def free(
    frame: WobblingFrame, tilt: float, turn: float, seconds: float = 40.0
) -> tuple[np.ndarray, Any, Any]:
    """Rows of `wobbling_motion.wobble` of a free motion from a tilt [rad], its azimuth turning
    [rad/s].
    """
    from fecolumn.engines.rocking.wobbling import STEP_TOLERANCE
    from fecolumn.engines.rocking.wobbling_motion import wobble

    start = np.array([tilt, 0.0, 0.0, turn * interpreted(equations.inertia)(frame.body, tilt)[1]])
    return wobble(
        frame.body,
        np.zeros((round(seconds / 2e-3) + 1, 3)),
        2e-3,
        start,
        frame.critical_tilt,
        STEP_TOLERANCE,
        1.0,
    )


def _statics(frame: WobblingFrame) -> Iterator[Row]:
    values, radius = frame.describe(), frame.body[0]
    loose = WobblingFrame.of_section(
        WobblingFrameModel(**SPECIMEN | {"tendon_n_m": 0.0}), "specimen"
    ).describe()
    for words, exact, found, digits in (
        ("b [m]", 0.0991, radius, 5e-5),
        ("h [m]", 0.7248, frame.body[1], 5e-5),
        ("gamma [-]", 19.33, frame.mass_ratio, 5e-3),
        ("p_hat (Eq. 6) [rad/s]", 2.600, frame.frequency, 5e-4),
        ("uplift [g]", 0.1367, values["uplift at"][0], 5e-5),
        ("k_crit (Eq. 1) [kN/m]", 3593.0, values["critical stiffness of a tendon"][0] / 1e3, 0.5),
        ("k/k_crit [-]", 0.479, frame.body[7] / values["critical stiffness of a tendon"][0], 5e-4),
        (
            "force at uplift [kN]",
            13.15,
            values["horizontal force at uplift, slender"][0] / 1e3,
            5e-3,
        ),
        (
            "slope after uplift [kN/m]",
            -34.8,
            values["slope of the force after uplift, slender"][0] / 1e3,
            0.05,
        ),
        (
            "displacement capacity, slender [m]",
            0.378,
            values["displacement capacity, slender"][0],
            5e-4,
        ),
        ("the same without tendons [m]", 0.197, loose["displacement capacity, slender"][0], 5e-4),
    ):
        yield Row(f"restrained frame: {words} (D of W)", exact, found, digits, scale=1.0)
    yield Row(
        "restrained frame: height of the columns at prototype [m] (W, 3.1)",
        7.25,
        5 * frame.body[2],
        5e-3,
        scale=1.0,
    )
    for model, prototype in ((16.75, 37.5), (33.5, 75.0)):
        yield Row(
            f"resultant PGV of {model:g} cm/s at prototype, times sqrt(5) [cm/s] (W, 3.3)",
            prototype,
            math.sqrt(5) * model,
            0.1,
            scale=1.0,
        )
    weight = frame.columns * (frame.body[3] / 2 + frame.body[4]) * GRAVITY
    yield Row(
        "force at uplift over (1/2 + gamma) N m_c g is alpha, which Eq. 1 lacks in "
        "print [-] (D of W)",
        0.1359,
        values["horizontal force at uplift, slender"][0] / weight,
        1e-12,
    )
    s, c, gamma = math.sin(0.1359), math.cos(0.1359), frame.mass_ratio
    printed = math.sqrt(
        12 * (2 * gamma + 1) / (48 * gamma + 15 + c**2) * GRAVITY / math.hypot(*frame.body[:2])
    )
    yield Row(
        "p_hat of the derivation beside Eq. 6 as printed [rad/s] (W)",
        printed,
        frame.frequency,
        1e-12,
    )
    # virtual work of k over the lifted axis, 2 b sin(theta/2), against the term k R s tan(alpha)
    # sin(theta) of Eq. 4
    tendon = frame.righting_moment(0.1) - WobblingFrame(
        np.where(np.arange(10) == 7, 0.0, frame.body), 4
    ).righting_moment(0.1)
    yield Row(
        "moment of a tendon at 0.1 rad beside Eq. 4 [N m] (W)",
        1.72e6 * (1.463 / 2) ** 2 * s**2 * math.sin(0.1),
        tendon,
        1e-12,
    )


def _samples() -> Iterator[Row]:
    for name, (planned, p, pairs) in BINS.items():
        found = samples_of_p(p, planned - 17, planned)
        for n, k in pairs:
            yield Row(
                f"{name}: p of n = {n}, D = {k}/{n} [-] (W, Table 2)",
                p,
                asymptotic_p(k / n, n, n),
                5e-3,
                scale=1.0,
            )
            yield Row(
                f"{name}: distance D of the sample of n = {n} [-] (D of W)",
                k / n,
                dict(found).get(n, math.nan) / n,
                1e-12,
            )
        yield Row(
            f"{name}: samples of {planned - 17} to {planned} that have this p (D of W)",
            len(pairs),
            len(found),
            0.0,
        )
    yield Row(
        "tests in the largest samples, of 188 planned (D of W)",
        180,
        sum(pairs[0][0] for _, _, pairs in BINS.values()),
        0.0,
    )


def _energy(
    frame: WobblingFrame, paths: Mapping[float, tuple[np.ndarray, Any, Any]]
) -> Iterator[Row]:
    from fecolumn.engines.rocking.wobbling_motion import WOBBLE_SPIN, WOBBLE_TILT, energies

    for turn, (rows, _, _) in paths.items():
        total, words = (
            energies(frame.body, rows).sum(axis=1),
            f"free motion from 0.05 rad, {turn:g} rad/s",
        )
        yield Row(
            f"{words}: energy over its start, largest change in 40 s [-]",
            0.0,
            float(np.abs(total / total[0] - 1).max()),
            1e-10,
        )
        yield Row(
            f"{words}: momentum of the azimuth, change over I p alpha^2 [-]",
            0.0,
            float(np.abs(np.diff(rows[:, WOBBLE_SPIN])).max() / (frame.frequency * total[0])),
            1e-12,
        )
    heights = paths[0.0][0][:, WOBBLE_TILT].max()
    yield Row("planar motion: highest swing, nothing is lost [rad]", 0.05, float(heights), 1e-6)


def _passing(frame: WobblingFrame) -> Iterator[Row]:
    """A column that comes past upright at a tilt of some 1e-6 rad turns its azimuth by pi
    sqrt(A/B).
    """
    from fecolumn.engines.rocking.wobbling_motion import WOBBLE_AZIMUTH, WOBBLE_RATE

    along, across = interpreted(equations.inertia)(frame.body, 1e-4)
    factor = math.sqrt(along / across) * 1e-4
    for turn in (1e-4, -1e-4):
        rows, _, _ = free(frame, 0.05, turn, 2.4)
        passed = int(np.argmax(np.diff(rows[:, WOBBLE_RATE]) > 0.1))  # the fall turns to a rise
        before, after = rows[passed - 5, WOBBLE_AZIMUTH], rows[passed + 6, WOBBLE_AZIMUTH]
        yield Row(
            f"turn past upright with {turn:g} rad/s at 0.05 rad [rad]",
            math.copysign(math.pi * factor, turn),
            after - before,
            1e-3,
        )


def _equations(frame: WobblingFrame) -> Iterator[Row]:
    """Equations 4 and 5 as printed, at a state taken at random, against the derivation."""
    theta, phi, rate, turn, x, y = 0.07, 0.6, -0.4, 1.1, 1.3, -0.8
    spin = turn * interpreted(equations.inertia)(frame.body, theta)[1]
    _, _, fall, spun, _ = interpreted(equations.rates)(
        frame.body, theta, phi, rate, spin, x, y, 0.0
    )
    a, g, s, c = 0.1359, frame.mass_ratio, math.sin, math.cos
    radius = math.hypot(*frame.body[:2])
    scale = 12 / (48 * g + 15 + c(a) ** 2)
    weight = frame.body[3] * GRAVITY
    held = 1.72e6 * 2 * frame.body[1] / weight / (2 * (2 * g + 1)) * s(a) * math.tan(a) * s(theta)
    fourth = (
        -scale
        * (2 * g + 1)
        * GRAVITY
        / radius
        * (s(a - theta) + c(a - theta) * (x * c(phi) + y * s(phi)) / GRAVITY + held)
    )
    bend = 4 / 3 * c(a) ** 2 - 5 / 4 * s(a) ** 2 + 4 * g * (c(a) ** 2 - s(a) ** 2)
    fourth += (
        turn**2
        * scale
        * (
            s(theta) * s(a) ** 2 * (4 * g + 1.5)
            + c(a) * s(a) * (4 * g + 1) * (1 + c(theta) - 2 * c(theta) ** 2)
            + s(theta) * c(theta) * bend
        )
    )
    yield Row("theta'' of Eq. 4 as printed [rad/s2] (W)", fourth, fall, 1e-11)
    mass = (
        bend * s(theta) ** 2
        + (3 + 8 * g) * (1 - c(theta)) * s(a) ** 2
        + 2 * s(a) * c(a) * s(theta) * (1 + 4 * g) * (1 - c(theta))
    )
    gyro = (
        (3 + 8 * g) * s(a) ** 2 * s(theta)
        + 2 * bend * s(theta) * c(theta)
        + 2 * c(a) * s(a) * (1 + 4 * g) * (2 * s(theta) ** 2 + c(theta) - 1)
    )
    fifth = (
        (2 * g + 1) * (s(a) + s(theta - a)) * (x * s(phi) - y * c(phi)) / radius
        - gyro * turn * rate
    ) / mass
    unit = frame.body[3] * radius**2
    yield Row(
        "phi'' of Eq. 5 as printed [rad/s2] (W)",
        fifth,
        (spun - unit * gyro * rate * turn) / (unit * mass),
        1e-11,
    )


def _draw(figure: Figure, paths: Mapping[float, tuple[np.ndarray, Any, Any]]) -> None:
    from fecolumn.engines.rocking.wobbling_motion import WOBBLE_AZIMUTH, WOBBLE_TILT

    left, right = figure.subplots(1, 2)
    for (turn, (rows, _, _)), dashes in zip(list(paths.items())[1:], ("-", "--", "-.")):
        first = rows[:1500]
        left.plot(
            first[:, WOBBLE_TILT] * np.cos(first[:, WOBBLE_AZIMUTH]),
            first[:, WOBBLE_TILT] * np.sin(first[:, WOBBLE_AZIMUTH]),
            dashes,
            linewidth=0.8,
            label=f"{turn:g} rad/s",
        )
    left.set(
        xlabel=r"$\theta\cos\varphi$ [rad]", ylabel=r"$\theta\sin\varphi$ [rad]", aspect="equal"
    )
    left.legend(title="free motion, azimuth's rate", title_fontsize=7.5)
    for (name, (planned, p, _)), marker in zip(BINS.items(), "osD^vx"):
        n = np.arange(planned - 17, planned + 1)
        right.plot(
            n,
            [min(abs(asymptotic_p(k / m, m, m) - p) for k in range(1, m + 1)) for m in n],
            marker,
            markersize=3,
            label=name,
        )
    right.axhline(0.005, color="k", linewidth=0.8, linestyle=":")
    right.set(
        xlabel="size $n$ of both samples",
        ylabel="nearest p less the printed p",
        yscale="log",
        ylim=(1e-4, 0.5),
    )
    right.legend(ncols=2)
