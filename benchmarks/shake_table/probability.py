"""How well probabilities of outcomes were told: Brier's score, and the classes of a reliability
diagram.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.shake_table.scores import confusion, pairs, table
from fecolumn.statistics.ecdf import proportion_interval

#: Edges of the classes of probability of a reliability diagram
EDGES = np.array([0.0, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0])


@dataclass(frozen=True)
class Brier:
    """score: mean square of probability less outcome (Brier 1950), 0 perfect; of_share: that of
    the share that overturned told for each test; skill: 1 - score / of_share.
    """

    score: float
    of_share: float

    @property
    def skill(self) -> float:
        return 1 - self.score / self.of_share if self.of_share else float("nan")


def brier(measured, told) -> Brier:
    """Of outcomes (n,) bool and probabilities (n,)."""
    measured, told = np.asarray(measured, float), np.asarray(told, float)
    return Brier(
        float(np.mean((told - measured) ** 2)), float(np.mean((measured.mean() - measured) ** 2))
    )


@dataclass(frozen=True)
class Class:
    """Tests whose probability lies between two edges: their number, the mean of what was told, the
    share that overturned and its interval (95 %, Wilson).
    """

    low: float
    high: float
    n: int
    told: float
    share: float
    interval: tuple[float, float]


def reliability(measured, told, edges=EDGES) -> list[Class]:
    """Classes that hold tests, of outcomes (n,) bool and probabilities (n,); an edge belongs to
    the upper class, 1 to the last.
    """
    measured, told = np.asarray(measured, bool), np.asarray(told, float)
    place = np.clip(np.searchsorted(edges, told, side="right") - 1, 0, len(edges) - 2)
    found = []
    for k in range(len(edges) - 1):
        within = place == k
        if n := int(within.sum()):
            overturned = int(measured[within].sum())
            found.append(
                Class(
                    float(edges[k]),
                    float(edges[k + 1]),
                    n,
                    float(told[within].mean()),
                    overturned / n,
                    proportion_interval(overturned, n),
                )
            )
    return found


def lines(classes: list[Class]) -> str:
    """Classes as a table of Markdown."""
    rows = [
        "| told P(overturn) | tests | mean told | share that overturned | 95 % interval |",
        "|---|---:|---:|---:|---|",
    ]
    for one in classes:
        low, high = one.interval
        rows.append(
            f"| {one.low:g} to {one.high:g} | {one.n} | {one.told:.3f} | {one.share:.3f} | "
            f"{low:.3f} to {high:.3f} |"
        )
    return "\n".join(rows)


def told_by(draws: dict[int, list[dict]]) -> list[dict]:
    """Of each test its number, PGA [g], PGV/PGA [s], outcome, the draws that were computed and the
    share of them that overturned, from rows of `runs.COLUMNS` by draw; by number.
    """
    by_test: dict[int, list[dict]] = {}
    for rows in draws.values():
        for row in rows:
            if row["failed"] == "":
                by_test.setdefault(row["test"], []).append(row)
    return [
        {
            **{name: rows[0][name] for name in ("test", "pga_g", "pgv_pga_s", "measured")},
            "draws": len(rows),
            "probability": float(np.mean([row["computed"] for row in rows])),
        }
        for _, rows in sorted(by_test.items())
    ]


def ensemble_report(draws: dict[int, list[dict]], told: list[dict], others: dict[str, list]) -> str:
    """Tables of Markdown: accuracy of the likelier outcome and of single draws; Brier's score of
    the ensemble, and the mean of that of single draws; reliability; the likelier outcome beside
    what `others` (n,) say of the tests of `told` (n,), test by test.
    """
    measured, probability = (
        np.array([row[name] for row in told], float) for name in ("measured", "probability")
    )
    whole = brier(measured, probability)
    single = []
    for rows in draws.values():
        kept = [row for row in rows if row["failed"] == ""]
        if kept:
            outcomes = np.array([[row["measured"], row["computed"]] for row in kept], float)
            single.append(float(np.mean(outcomes[:, 0] == outcomes[:, 1])))
    failed = sum(row["failed"] != "" for rows in draws.values() for row in rows)
    made = [row["draws"] for row in told]
    # of an ensemble that was stopped some tests have more draws than others
    each = f"{made[0]}" if min(made) == max(made) else f"{min(made)} to {max(made)}"
    cost = sum(row["cpu_s"] for rows in draws.values() for row in rows)
    score = "\n".join(
        [
            "| told by | N | Brier's score | skill over the share that overturned |",
            "|---|---:|---:|---:|",
            f"| share of {each} draws | {len(told)} | {whole.score:.3f} | {whole.skill:.3f} |",
            f"| one draw, mean | {len(told)} | {1 - np.mean(single):.3f} | "
            f"{1 - (1 - np.mean(single)) / whole.of_share if whole.of_share else np.nan:.3f} |",
        ]
    )
    return "\n\n".join(
        [
            table({f"likelier of {each} draws": confusion(measured == 1, probability > 0.5)}),
            f"single draws tell {min(single):.3f} to {max(single):.3f} right, mean "
            f"{np.mean(single):.3f}; {failed} analyses failed; {cost / 3600:.2f} CPU hours",
            score,
            lines(reliability(measured == 1, probability)),
            *(
                [pairs("likelier of the draws", measured == 1, probability > 0.5, others)]
                if others
                else []
            ),
        ]
    )
