"""How well outcomes were told: confusion, accuracy, and whether two that tell differ by more than
chance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest

from fecolumn.statistics.ecdf import proportion_interval


@dataclass(frozen=True)
class Confusion:
    """Counts of tests: overturned as predicted, overturned and predicted to stand, stood and
    predicted to overturn, stood as predicted.
    """

    hit: int
    missed: int
    false: int
    stood: int

    @property
    def n(self) -> int:
        return self.hit + self.missed + self.false + self.stood

    @property
    def accuracy(self) -> float:
        """Share of tests told right."""
        return (self.hit + self.stood) / self.n

    @property
    def interval(self) -> tuple[float, float]:
        """Of the accuracy, 95 %, Wilson."""
        return proportion_interval(self.hit + self.stood, self.n)


def confusion(measured, told) -> Confusion:
    """Confusion of outcomes (n,) and what was told of them (n,), both bool."""
    measured, told = np.asarray(measured, bool), np.asarray(told, bool)
    return Confusion(*(int((a & b).sum()) for a in (measured, ~measured) for b in (told, ~told)))


def told_alone(measured, told, other) -> tuple[int, int]:
    """Of outcomes (n,), in how many tests only `told` is right, and in how many only `other`."""
    right, better = (
        np.asarray(told) == np.asarray(measured),
        np.asarray(other) == np.asarray(measured),
    )
    return int((right & ~better).sum()), int((~right & better).sum())


def chance(measured, told, other) -> float:
    """Probability that two equally good ones differ as much in the tests that only one tells right
    (exact test of McNemar 1947).
    """
    only, others = told_alone(measured, told, other)
    return binomtest(only, only + others).pvalue if only + others else 1.0


def pairs(name: str, measured, told, others: dict[str, list]) -> str:
    """Table of Markdown: outcomes that `told` (n,), called `name`, and each of `others` tell of the
    same tests, beside what was `measured`.
    """
    lines = [
        f"| beside {name} | this one right | {name} alone right | this one alone right | "
        "p (McNemar) |",
        "|---|--:|--:|--:|--:|",
    ]
    for other, values in others.items():
        only, theirs = told_alone(measured, told, values)
        lines.append(
            f"| {other} | {confusion(measured, values).accuracy:.3f} | {only} | {theirs} | "
            f"{chance(measured, told, values):.2g} |"
        )
    return "\n".join(lines)


def table(scores: dict[str, Confusion]) -> str:
    """Table of Markdown, a line for each that tells, as `benchmarks/tables` keeps it."""
    lines = [
        "| predicted by | right | 95 % interval | overturned: predicted | predicted to stand | "
        "stood: predicted to overturn | predicted |",
        "|---|--:|---|--:|--:|--:|--:|",
    ]
    for name, c in scores.items():
        low, high = c.interval
        lines.append(
            f"| {name} | {c.accuracy:.3f} | {low:.3f} to {high:.3f} | {c.hit} | "
            f"{c.missed} | {c.false} | {c.stood} |"
        )
    return "\n".join(lines)
