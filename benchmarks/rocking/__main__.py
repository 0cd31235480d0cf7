"""python -m benchmarks.rocking [-n N] [-o DIR]: processor time of a million planar blocks, and the
overturning spectra of four pulses.

Blocks of alpha 0.08 to 0.35 and p 1 to 6 rad/s in the motions of the Lick ensemble, cut to 10 s, at
factors 0.5 to 2.5: free and held by a spring and a tendon.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from fecolumn.case.sections import Motion
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.swing import (
    FASTEST,
    HELD,
    IMPACT_COUNT,
    PEAK_TILT,
    SPRING,
    TENDON,
    rock_all,
    row_of_block,
)
from fecolumn.motions.load import unsampled

SECONDS = 10.0


def motions(count: int) -> tuple[list[np.ndarray], float]:
    """Motions (n, 2) along x and z of 10 s around their strongest part, and their step."""
    found = []
    for number in range(1, count + 1):
        ground = unsampled(Motion(f"lick:{number}"), "benchmark")
        n = round(SECONDS / ground.dt) + 1
        start = max(
            0,
            min(
                int(np.abs(ground.acceleration[:, 0]).argmax()) - n // 2,
                len(ground.acceleration) - n,
            ),
        )
        found.append(ground.acceleration[start : start + n][:, [0, 2]])
    return found, ground.dt


def blocks(count: int, held: bool) -> np.ndarray:
    """Rows of parameters."""
    rng = np.random.default_rng(1)
    rows = np.array(
        [
            row_of_block(alpha, p, housner_restitution(alpha))
            for alpha, p in rng.uniform([0.08, 1.0], [0.35, 6.0], (count, 2))
        ]
    )
    if held:
        stiff = rows[:, [2]] * rng.uniform(0.2, 2.0, (count, 1))
        rows[:, [SPRING, SPRING + 3]], rows[:, [TENDON, TENDON + 2]], rows[:, HELD] = (
            stiff,
            0.5 * stiff,
            1.0,
        )
        rows[:, FASTEST] = np.sqrt(rows[:, 2] + 1.5 * stiff[:, 0])
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "-n", type=int, default=100_000, help="analyses of each kind (default: %(default)s)"
    )
    args = parser.parse_args()
    grounds, step = motions(40)
    rng = np.random.default_rng(2)
    rock_all(grounds, step, [0], 1.0, blocks(1, True))
    print(f"{args.n} analyses of {SECONDS:g} s, motions sampled at {step:g} s")
    print(
        f"{'blocks':<8}{'CPU ms/analysis':>17}{'h of one core for a million':>30}"
        f"{'overturned':>12}{'impacts':>9}"
    )
    for name, held in (("free", False), ("held", True)):
        rows = blocks(args.n, held)
        which, scales = rng.integers(0, len(grounds), args.n), rng.uniform(0.5, 2.5, args.n)
        began = time.process_time()
        found = rock_all(grounds, step, which, scales, rows)
        spent = time.process_time() - began
        print(
            f"{name:<8}{1e3 * spent / args.n:>17.3f}{1e6 * spent / args.n / 3600:>30.2f}"
            f"{np.isinf(found[:, PEAK_TILT]).mean():>12.1%}{found[:, IMPACT_COUNT].mean():>9.1f}"
        )


if __name__ == "__main__":
    main()
