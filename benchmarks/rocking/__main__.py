"""Processor time of a million planar blocks.

    ./containers/run python -m benchmarks.rocking [-n N]

Blocks of alpha 0.08 to 0.35 and p 1 to 6 rad/s in the motions of the Lick ensemble, cut to 10 s, at
factors 0.5 to 2.5: free and held by a spring and a tendon.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from benchmarks.beside import markdown
from fecolumn.case.sections import Motion
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.swing import rock_all
from fecolumn.engines.rocking.swing_equations import FASTEST, HELD, SPRING, TENDON, row_of_block
from fecolumn.engines.rocking.swing_motion import IMPACT_COUNT, PEAK_TILT
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
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.rocking",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "-n", type=int, default=100_000, help="analyses of each kind (default: %(default)s)"
    )
    args = parser.parse_args()
    grounds, step = motions(40)
    rng = np.random.default_rng(2)
    rock_all(grounds, step, [0], 1.0, blocks(1, True))
    lines, overturned = [], []
    for name, held in (("free", False), ("held by a spring and a tendon", True)):
        rows = blocks(args.n, held)
        which, scales = rng.integers(0, len(grounds), args.n), rng.uniform(0.5, 2.5, args.n)
        began = time.process_time()
        found = rock_all(grounds, step, which, scales, rows)
        spent = (time.process_time() - began) / args.n
        impacts = found[:, IMPACT_COUNT].mean()
        lines.append((name, f"{1e3 * spent:.2f}", f"{1e6 * spent / 3600:.2f}", f"{impacts:.0f}"))
        overturned.append(f"{np.isinf(found[:, PEAK_TILT]).mean():.1%}")
    print(
        f"{args.n} analyses of each kind, motions sampled at {step:g} s; of them overturn "
        f"{' and '.join(overturned)}"
    )
    print(
        markdown(
            (
                "planar rocking block",
                f"CPU of a motion of {SECONDS:g} s [ms]",
                "hours of one core for a million",
                "impacts a motion",
            ),
            lines,
        )
    )


if __name__ == "__main__":
    main()
