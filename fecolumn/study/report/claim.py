"""A claim of the paper, what the study finds, and the verdict by rule."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fecolumn.statistics.equivalence import detectable_distance
from fecolumn.study.report.document import PageColumn, PageTable

SUPPORTED, NOT_SUPPORTED, UNDECIDED = "supported", "not supported", "undecided"

#: Katsamakas & Vassiliou's P(overturn). The specimen's free dimensions were chosen to come near it:
#: never a result.
CALIBRATION_TARGET = 50 / 115
#: Motions of the paper's ensemble.
PAPER_MOTIONS = 115
#: Distance that the paper's own ensemble would show. A difference that is excluded beyond it is
#: called marginal.
MARGIN = detectable_distance(PAPER_MOTIONS)


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim.

    Attributes
    ----------
    key
        "a1" and so on.
    paper
        what the paper found.
    ours
        what this study finds, in sentences with its numbers.
    rule
        what decides.
    verdict
        supported, not supported or undecided.
    """

    key: str
    paper: str
    ours: str
    rule: str
    verdict: str


@dataclass(frozen=True, slots=True)
class ClaimList:
    """Claims of a paper's authors as a block of the page."""

    claims: list[Claim]
    authors: str = "Katsamakas and Vassiliou"
    kind: str = "claims"

    def write_csv(self, folder: Path) -> Path:
        """Write claims.csv, the whole of every claim."""
        names = ("key", "paper", "verdict", "ours", "rule")
        rows = [tuple(getattr(claim, name) for name in names) for claim in self.claims]
        return PageTable(
            "claims", tuple(PageColumn(name, name) for name in names), rows, ""
        ).write_csv(folder)
