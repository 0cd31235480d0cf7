"""Pairs of settings that answer one question, together: what they show, and whether the motions are
enough for it.
"""

from __future__ import annotations

from fecolumn.statistics.equivalence import (
    SMALL,
    detectable_distance,
    difference_shortfall,
    equality_shortfall,
    motions_needed,
)
from fecolumn.study.report.document import PageColumn, PageTable, Paragraph
from fecolumn.study.report.notation import axis_name, fixed, p_value
from fecolumn.study.report.pair import ComparedPair


def _by_family(pairs: list[ComparedPair]) -> dict[str, list[ComparedPair]]:
    """Pairs that answer one question, by the question."""
    return {
        family: [pair for pair in pairs if pair.family == family]
        for family in dict.fromkeys(pair.family for pair in pairs)
    }


def _needed(own: list[ComparedPair]) -> tuple[float, int]:
    """Distance below which a family's CDFs cannot be told apart, and motions that its claim needs:
    that of a difference where one is found, of least distance, else that of none beyond `SMALL`.
    """
    clear = [pair.distance for pair in own if pair.p_holm < 0.05]
    level = 0.05 / len(own)
    return detectable_distance(
        min(pair.comparison.records_a for pair in own), level
    ), motions_needed(min(clear), level) if clear else motions_needed(SMALL)


def shortfalls(pairs: list[ComparedPair]) -> list[Paragraph]:
    """Warnings where motions are too few for what a family of pairs is said to show."""
    found = []
    for family, own in _by_family(pairs).items():
        axis, clear = family.partition(", ")[0], [pair for pair in own if pair.p_holm < 0.05]
        unit = own[0].comparison.unit
        weakest = min(clear, key=lambda pair: pair.distance, default=None)
        said = (
            difference_shortfall(weakest.comparison.records_a, weakest.distance, len(own), unit)
            if weakest
            else equality_shortfall(
                min(pair.comparison.records_a for pair in own),
                bound=max(pair.bound for pair in own),
                unit=unit,
            )
        )
        if said:
            kind = family.partition(", ")[2]
            found.append(
                Paragraph(
                    "Settings that differ in "
                    f"{axis_name(axis)}{f' ({kind})' if kind else ''}: "
                    f"{said[0].lower()}{said[1:]}",
                    warning=True,
                )
            )
    return found


def families(pairs: list[ComparedPair]) -> PageTable:
    """A row for each question: how many pairs, what they show, what they leave open, and how many
    motions would settle it.
    """
    rows = []
    for family, own in _by_family(pairs).items():
        axis, _, kind = family.partition(", ")
        rows.append(
            (
                axis,
                kind or "all",
                len(own),
                sum(pair.p_holm < 0.05 for pair in own),
                max(pair.distance for pair in own),
                min(pair.comparison.ks_p for pair in own),
                min(p for pair in own if (p := pair.comparison.paired_p) is not None),
                min(pair.p_holm for pair in own),
                max(pair.bound for pair in own),
                *_needed(own),
            )
        )
    columns = (
        PageColumn("axis", "settings that differ in", axis_name, text=True),
        PageColumn("pairs_of", "pairs", text=True),
        PageColumn("pairs", "number"),
        PageColumn("significant", "p (Holm) < 0.05"),
        PageColumn("ks_max", "largest D", fixed),
        PageColumn("ks_p_min", "least p, independent", p_value),
        PageColumn("paired_p_min", "least p, paired", p_value),
        PageColumn("p_holm_min", "least p (Holm)", p_value),
        PageColumn("bound_95_max", "largest D not excluded", fixed),
        PageColumn("distance_told", "D told from 0", fixed),
        PageColumn("motions_needed", "motions needed"),
    )
    return PageTable(
        "families",
        columns,
        rows,
        "Families of pairs: the largest Kolmogorov-Smirnov distance D of two CDFs, the smallest p "
        "values, and the largest distance that the data cannot exclude at 95 % in the "
        "pair where they "
        "say least; the least D that so many motions tell from 0, 5 % over all pairs "
        "of the family; "
        "motions that the family’s claim needs, of its weakest difference or of none beyond "
        f"{fixed(SMALL)}.",
    )
