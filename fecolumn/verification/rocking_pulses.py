"""Pulses that overturn a rocking block: rows of `rocking_models`, whose head has sources and
tolerances.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.critical_input import critical_motion, least_impulse, tilt_velocities
from fecolumn.engines.rocking.impact import (
    housner_restitution,
)
from fecolumn.engines.rocking.overturning import (
    critical_tilt_rate,
    half_sine_overturning,
    half_sine_phase,
    linear_overturning,
    overturning_bands,
    pulse_outcomes,
    rectangular_slenderness,
    slenderness_factor,
)
from fecolumn.engines.rocking.swing import rock_one
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.engines.rocking.swing_motion import PEAK_TILT
from fecolumn.verification.result import Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


TEN = math.radians(10)
#: Least a_p/(g tan alpha) that overturns a block of alpha = 10 degrees, and the impacts before, by
#: pulse and w_p/p [D].
LOWEST = {
    "one_sine": {
        0.5: (1.044, 5),
        1.0: (1.099, 3),
        2.0: (1.219, 1),
        3.0: (1.383, 1),
        4.0: (1.706, 1),
        5.0: (2.481, 1),
        6.0: (3.932, 1),
        6.25: (4.358, 1),
        7.0: (5.788, 1),
        8.0: (8.079, 1),
    },
    "symmetric_ricker": {
        0.5: (1.109, 1),
        1.0: (1.221, 1),
        2.0: (1.590, 1),
        3.0: (2.692, 1),
        4.0: (3.206, 1),
        5.0: (4.240, 1),
        6.0: (6.580, 1),
        6.25: (7.667, 1),
    },
    "antisymmetric_ricker": {
        0.5: (1.045, 5),
        1.0: (1.095, 4),
        2.0: (1.270, 1),
        3.0: (1.621, 1),
        4.0: (4.574, 1),
        5.0: (5.658, 1),
        6.0: (7.948, 1),
        6.25: (8.922, 1),
    },
    "one_cosine": {
        0.5: (1.061, 9),
        1.0: (1.101, 6),
        2.0: (1.258, 2),
        3.0: (1.802, 1),
        4.0: (2.864, 1),
    },
}
#: Safe gaps of the one-sine pulse below overturning without impact, by w_p/p: from, to [D].
GAPS = {5.0: (6.96, 7.25), 6.0: (9.04, 9.56), 7.0: (11.36, 12.21)}
#: psi [rad] and a_p/(g tan alpha) of the half-sine by w_p/p [D from Eq. 25 of M].
HALF_SINE = {
    0.25: (1.3265, 1.0306),
    1.0: (0.85749, 1.3224),
    2.0: (0.588762, 1.80072),
    4.0: (0.366468, 2.7908),
    6.0: (0.267147, 3.78816),
    10.0: (0.173687, 5.78652),
}
_BOUNDARY = 0.005
MOST = 16


def overturning_rows() -> Iterator[Row]:
    """Rows of pulses that overturn a block, in the order of their table."""
    yield from _closed_forms()
    yield from _boundaries()
    yield from _several_impacts()
    yield from _gaps()
    yield from _worst_impulses()


def _closed_forms() -> Iterator[Row]:
    for ratio, (psi, amplitude) in HALF_SINE.items():
        yield Row(
            f"half-sine, w_p/p {ratio:g}: psi [rad] (D of M, Eq. 25)",
            psi,
            half_sine_phase(ratio),
            5e-6,
            scale=1.0,
        )
        yield Row(
            f"half-sine, w_p/p {ratio:g}: a_p/(g tan alpha) (D of M, Eq. 25)",
            amplitude,
            half_sine_overturning(ratio),
            1e-4,
        )
    yield Row(
        "velocity that reaches the verge over p alpha, alpha 0.01 [-] (M, Eq. 39)",
        1.0,
        critical_tilt_rate(0.01) / 0.01,
        1e-5,
    )
    for ratio, low, below in ((1.0, 1.167, -6), (2.0, 1.333, -9), (3.0, 1.5, -8)):
        yield Row(
            f"line of Makris and Roussos, one-sine, w_p/p {ratio:g} [-] (M, Eq. 27)",
            low,
            float(linear_overturning("one_sine", ratio)),
            5e-4,
        )
        least = lowest_overturning("one_sine", ratio, LOWEST["one_sine"][ratio][0])[0]
        yield Row(
            f"least one-sine beside that line, w_p/p {ratio:g} [-] (M, Eq. 27)", low, least, 0.1
        )
        beside = least / float(linear_overturning("one_sine", ratio)) - 1
        yield Row(
            f"least one-sine off that line, w_p/p {ratio:g} [%] (D of M, Eq. 27)",
            below,
            100 * beside,
            0.5,
            scale=1.0,
        )
    for pulse, beta in (("one_sine", 1 / 6), ("type_c", 1 / 6), ("one_cosine", 1 / 4)):
        yield Row(
            f"line of Makris and Roussos, {pulse}: beta [-] (M, Eq. 27)",
            beta,
            float(linear_overturning(pulse, 1.0)) - 1,
            1e-12,
        )
    for pulse, gamma in (
        ("rectangular", 1.0),
        ("one_sine", math.pi / 3),
        ("one_cosine", math.pi / 2),
    ):
        yield Row(
            f"slenderness factor at p T_p = gamma, {pulse} [-] (M, Eq. 37)",
            0.5,
            float(slenderness_factor(gamma, pulse)),
            1e-12,
        )
    # the block is slender and starts at the pulse's begin
    for duration in (0.5, 1.0, 2.0, 4.0):
        yield Row(
            f"rectangular pulse, p T_p {duration:g}: least a_p/(g tan alpha) that overturns [-] "
            "(Housner 1963)",
            1 / float(rectangular_slenderness(duration)),
            _least_rectangular(duration),
            1e-4,
        )


def _least_rectangular(duration: float) -> float:
    """Least a_p/(g tan alpha) of a rectangular pulse that overturns a slender block, p T_p =
    `duration`, by bisection of its analyses.
    """
    alpha, count = 1e-3, 400
    # the acceleration falls to 0 within the last step, which counts half
    step = duration / (count + 0.5)
    pulse = np.zeros((count + 2, 2))
    pulse[:-1, 0] = GRAVITY * math.tan(alpha)
    row = row_of_block(alpha, 1.0, housner_restitution(alpha))

    def stands(amplitude: float) -> bool:
        results = rock_one(amplitude * pulse, step, row, free_s=20.0)[2]
        return not math.isinf(results[PEAK_TILT])

    low, high = 1.0, 10.0
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if stands(middle) else (low, middle)
    return low


def _boundaries() -> Iterator[Row]:
    for shape, lowest in LOWEST.items():
        for ratio, (amplitude, impacts) in lowest.items():
            found, before = lowest_overturning(shape, ratio, amplitude)
            yield Row(
                f"{shape}, w_p/p {ratio:g}: least a_p/(g tan alpha) (D)",
                amplitude,
                found,
                _BOUNDARY,
            )
            if impacts == 1:
                yield Row(
                    f"{shape}, w_p/p {ratio:g}: impacts before overturning (D)", 1, before, 0.0
                )
    # by scipy's solve_ivp with events, rtol 1e-10
    for shape, ratio, amplitude in (
        ("one_sine", 3.0, 1.3829),
        ("one_sine", 6.0, 3.9324),
        ("one_cosine", 3.0, 1.8012),
    ):
        band = overturning_bands(
            shape, ratio, TEN, lowest=0.98 * amplitude, highest=1.02 * amplitude, points=9
        )[0]
        yield Row(
            f"{shape}, w_p/p {ratio:g}: least a_p/(g tan alpha), adaptive solver (D)",
            amplitude,
            band.low,
            5e-4,
        )
    for shape, ratios in (
        ("one_cosine", (5, 6, 6.25, 7, 8)),
        ("symmetric_ricker", (7, 8)),
        ("antisymmetric_ricker", (7, 8)),
    ):
        for ratio in ratios:
            yield Row(
                f"{shape}, w_p/p {ratio:g}: overturned by up to 14 g tan(alpha) [-] (D)",
                0,
                float((pulse_outcomes(shape, ratio, np.linspace(1, 14, 261), TEN) >= 0).mean()),
                0.0,
            )
    yield Row(
        "one_sine, w_p/p 6.28: least a_p/(g tan alpha) (D)",
        4.4,
        lowest_overturning("one_sine", 6.28, 4.4)[0],
        0.05,
        scale=1.0,
    )
    # the text of M to Fig. 11: both Ricker wavelets need more than 6 g tan(alpha) at w_p/p = 6.28
    for shape in ("symmetric_ricker", "antisymmetric_ricker"):
        yield Row(
            f"{shape}, w_p/p 6.28: overturned by less than 6 g tan(alpha) [-] (M, 9)",
            0,
            float((pulse_outcomes(shape, 6.28, np.linspace(1, 6, 251), TEN) >= 0).mean()),
            0.0,
        )


def _several_impacts() -> Iterator[Row]:
    """Overturning after two impacts or more up to 14 g tan(alpha): Fig. 7 of M has it for both
    Rickers, and none for the one-sine.
    """
    grid = np.linspace(1, 14, 521)
    for ratio in (2, 3, 4, 5, 6, 7, 8):
        yield Row(
            f"one_sine, w_p/p {ratio}: overturned after several impacts [-] (M, Fig. 7)",
            0,
            float((pulse_outcomes("one_sine", ratio, grid, TEN) >= 2).mean()),
            0.0,
        )
    for shape in ("symmetric_ricker", "antisymmetric_ricker"):
        yield Row(
            f"{shape}, w_p/p 2: whether any amplitude overturns after several impacts "
            "[-] (M, Fig. 7)",
            1,
            float((pulse_outcomes(shape, 2.0, grid, TEN) >= 2).any()),
            0.0,
        )


def _worst_impulses() -> Iterator[Row]:
    """Impulses at every impact after Casapulla, Jossa and Maione (2010): the last of them
    overturns, 0.2 % less does not.
    """
    p, kept = 2.0, housner_restitution(TEN)
    for number in (1, 2, 4):
        for share, falls in ((0.998, 0), (1.002, 1)):
            motion = critical_motion(
                TEN, p, kept, share * least_impulse(TEN, p, kept, number), number, 1e-4
            )
            found = rock_one(
                motion.acceleration[:, [0, 2]], motion.dt, row_of_block(TEN, p, kept), free_s=20.0
            )[2]
            yield Row(
                f"impulses of {share:g} of the least that overturns with number "
                f"{number}: overturned [-] (D)",
                falls,
                float(np.isinf(found[PEAK_TILT])),
                0.0,
            )
    limit = least_impulse(TEN, p, kept)
    speeds = tilt_velocities(TEN, p, kept, limit, 4000)
    yield Row(
        "least impulse of all: tilt velocity after many over that which reaches the verge [-] (D)",
        1.0,
        float(speeds[-1]) / (p * critical_tilt_rate(TEN)),
        1e-12,
    )


def lowest_overturning(shape: str, frequency: float, expected: float) -> tuple[float, int]:
    """Least amplitude that overturns and the impacts before, looked for below and around an
    expected one; nan where there is none.
    """
    grid = np.concatenate(
        [
            np.linspace(1.0, 0.99 * expected, 60),
            np.linspace(0.99 * expected, 1.01 * expected, 81)[1:],
        ]
    )
    found = pulse_outcomes(shape, frequency, grid, TEN)
    fallen = np.flatnonzero((found >= 0) & (found <= MOST))
    return (float(grid[fallen[0]]), int(found[fallen[0]])) if len(fallen) else (math.nan, -1)


def _gaps() -> Iterator[Row]:
    for ratio, (low, high) in GAPS.items():
        bands = overturning_bands(
            "one_sine", ratio, TEN, lowest=0.8 * low, highest=1.2 * high, points=121
        )
        ends = (
            [band for band in bands if band.impacts == 1][-1].high,
            [band for band in bands if band.impacts == 0][0].low,
        )
        yield Row(
            f"one_sine, w_p/p {ratio:g}: end of overturning with one impact (D)",
            low,
            ends[0],
            _BOUNDARY,
        )
        yield Row(
            f"one_sine, w_p/p {ratio:g}: begin of overturning without (D)", high, ends[1], _BOUNDARY
        )


def draw_overturning(figure: Figure) -> None:
    """Least amplitudes that overturn, computed and of the reference."""
    axes = figure.subplots()
    for number, (shape, lowest) in enumerate(LOWEST.items()):
        ratios = list(lowest)
        axes.plot(
            ratios,
            [lowest[ratio][0] for ratio in ratios],
            "osD^"[number],
            fillstyle="none",
            color=f"C{number}",
            label=f"{shape.replace('_', ' ')}, reference",
        )
        axes.plot(
            ratios,
            [lowest_overturning(shape, ratio, lowest[ratio][0])[0] for ratio in ratios],
            "-",
            color=f"C{number}",
            label="computed",
        )
    line = np.linspace(0, math.pi)
    axes.plot(line, linear_overturning("one_sine", line), "k--", label=r"$1 + \omega_p/(6p)$")
    axes.set(
        xlabel=r"$\omega_p/p$", ylabel=r"least $a_p/(g\tan\alpha)$, $\alpha$ = 10°", yscale="log"
    )
    axes.legend(ncols=2)
