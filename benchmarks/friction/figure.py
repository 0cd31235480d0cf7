"""Figure of a comparison of solvers: performance profiles, and violation of the laws against CPU
time.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.pictures.figures.style import LINES, PAGE_WIDTH_IN, new_figure, save, styled

# Times below this share of a second are of the clock; violations below this are rounding
LEAST_S, LEAST = 1e-5, 1e-17
MARKERS = "o^sv"


def profile(times) -> tuple[np.ndarray, np.ndarray]:
    """Performance profiles (Dolan and More 2002): ratios (k,), rising from 1, and for each the
    shares (k, s) of problems that a solver solves in so many times the least time of all solvers.

    times: (p, s) [s] of s solvers on p problems, inf where one does not solve it. Problems that
    none solves count as problems.
    """
    times = np.maximum(times, LEAST_S)
    best = times.min(axis=1, keepdims=True)
    ratio = np.where(np.isfinite(times), times / np.where(np.isfinite(best), best, 1.0), np.inf)
    steps = np.unique(np.concatenate([[1.0], ratio[np.isfinite(ratio)]]))
    return steps, (ratio[:, None, :] <= steps[:, None]).mean(axis=0)


def performance_figure(records, labels: dict[str, str], solved: float, path) -> list[Path]:
    """Write the figure; records: of `compared`; labels: of the solvers by name; solved: violation
    below which a problem counts as solved.
    """
    names = [name for name in labels if any(name in record["solvers"] for record in records)]
    one = {name: [record["solvers"].get(name, {}) for record in records] for name in names}
    seconds = np.array([[found.get("seconds", np.inf) for found in one[name]] for name in names]).T
    violations = np.array(
        [[found.get("violation", np.inf) for found in one[name]] for name in names]
    ).T
    ratios, reached = profile(np.where(violations <= solved, seconds, np.inf))
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 2.9)
        left, right = figure.subplots(1, 2)
        for k, name in enumerate(names):
            color, dash = LINES[k]
            left.step(
                [*ratios, 2 * ratios[-1]],
                [*reached[:, k], reached[-1, k]],
                where="post",
                color=color,
                linestyle=dash,
                label=labels[name],
            )
            right.plot(
                1e3 * np.maximum(seconds[:, k], LEAST_S),
                np.clip(violations[:, k], LEAST, 10.0),
                MARKERS[k % len(MARKERS)],
                color=color,
                markersize=2.5,
                markeredgewidth=0,
                alpha=0.6,
            )
        left.set(
            xscale="log",
            xlabel="CPU time over that of the fastest solver [-]",
            ylabel=f"share of {len(records)} problems solved [-]",
            ylim=(0, 1.02),
            xlim=(1, 2 * ratios[-1]),
        )
        left.legend(loc="lower right")
        right.axhline(solved, color="black", linewidth=0.6)
        right.set(
            xscale="log",
            yscale="log",
            xlabel="CPU time [ms]",
            ylabel="violation of the laws over max $|q|$ [-]",
        )
        return save(figure, path)
