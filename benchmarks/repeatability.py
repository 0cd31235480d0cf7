"""Horizon of predictability from a finished study of perturbed runs: python -m
benchmarks.repeatability DIR

The study is benchmarks/repeatability.toml or one like it: for each motion, runs that differ by a
relative perturbation of contact.friction_coefficient and a motion.delay_s. A run's perturbation is
the larger of the two, the delay counted in steps.
"""

from __future__ import annotations

import argparse
import collections
import math
from pathlib import Path

from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.ending import lost
from fecolumn.statistics.repeatability import aligned, horizon, spread, time_gained
from fecolumn.study.store import DONE, read_study

_SHARE = 0.1


def main(folder) -> None:
    """Print, for each motion and size of perturbation, the horizon, the rate of growth, and what
    became of the runs.
    """
    motions: dict[str, dict[float, list]] = collections.defaultdict(
        lambda: collections.defaultdict(list)
    )
    for row in read_study(folder).rows:
        if row["state"] == DONE:
            axes = row["axes"]
            size = max(
                abs(axes["contact.friction_coefficient"] / 0.3 - 1),
                axes["motion.delay_s"] / row["summary"]["dt_s"],
            )
            motions[axes["motion.source"]][float(f"{size:.0e}")].append(
                (Path(folder) / "analyses" / row["id"] / "history.h5", row["summary"])
            )
    print(
        f"{'motion':34} {'perturbed by':>12} {'runs':>4} {'lost':>10} "
        f"{'u_max [mm]':>10} {'apart by':>9} {'spread/peak':>11} {'end [s]':>7} "
        f"{'horizon [s]':>11} {'rate [1/s]':>10}  95 % interval"
    )
    names, sizes, horizons = [], [], []
    for motion, groups in motions.items():
        for size in sorted(size for size in groups if size):
            runs = groups[0.0] + groups[size]
            if len(runs) < 3:
                continue
            histories = [read_history(file) for file, _ in runs]
            times, paths = aligned(
                [(history["time"], history["u_top"][:, :2]) for history in histories]
            )
            # the last row, at the fall, may come a step earlier or later
            if all(lost(summary) for _, summary in runs):
                kept = times < min(history["time"][-1] for history in histories) - 1e-9
                times, paths = times[kept], paths[:, kept]
            grown = spread(paths, times, _SHARE, size)
            names.append(motion)
            sizes.append(size)
            horizons.append(horizon(grown.spread, times, grown.peak, _SHARE))
            peaks = sorted(1e3 * summary["u_max_m"] for _, summary in runs if not lost(summary))
            extent = (
                f"{peaks[0]:10.3f} {peaks[-1] / peaks[0] - 1:9.1e}"
                if peaks
                else f"{'-':>10} {'-':>9}"
            )
            end = f"{horizons[-1]:11.3f}" if math.isfinite(horizons[-1]) else f"{'beyond':>11}"
            rate = f"{grown.rate:10.2f}" if math.isfinite(grown.rate) else f"{'-':>10}"
            if math.isfinite(grown.interval[0]):
                rate += f"  [{grown.interval[0]:.2f}, {grown.interval[1]:.2f}]"
            print(
                f"{motion:34} {size:12.0e} {len(runs):4} "
                f"{sum(lost(summary) for _, summary in runs):10} {extent} "
                f"{grown.spread.max() / grown.peak:11.1e} {times[-1]:7.2f} {end} {rate}"
            )
    for motion in dict.fromkeys(names):
        of_motion = [
            place
            for place, name in enumerate(names)
            if name == motion and math.isfinite(horizons[place])
        ]
        if len(of_motion) >= 3:
            gain, low, high = time_gained(
                [sizes[place] for place in of_motion], [horizons[place] for place in of_motion]
            )
            print(
                f"{motion:34} a tenfold smaller perturbation gains {gain:.3f} s "
                f"[{low:.3f}, {high:.3f}]"
            )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="DIR")
    main(parser.parse_args().folder)
