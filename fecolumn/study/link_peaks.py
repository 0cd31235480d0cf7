"""What the links of an ensemble of structures reach: quantiles of their peaks over its runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

#: Entries of a link in summary.json whose quantiles are told.
PEAKS = ("tension_max_n", "compression_max_n", "elongation_max_m", "shortening_max_m")
#: Columns of a table of them, after those of the ensemble.
LINK_COLUMNS = (
    "link",
    "n",
    "yielded",
    "broke",
    *(f"{name[:-6]}_{share}{name[-2:]}" for name in PEAKS for share in ("50", "84", "max")),
    "work_50_j",
)


@dataclass(frozen=True, slots=True)
class LinkPeaks:
    """A link over the runs of an ensemble, lost ones too, of which peaks are those until the end.

    Attributes
    ----------
    name
        of the link.
    n, yielded, broke
        runs, and those in which it yielded or slipped, and broke.
    quantiles
        of each of PEAKS the median, that which 84 % of the runs stay below, and the
        largest [N, m].
    work
        median of the energy that it took [J].
    """

    name: str
    n: int
    yielded: int
    broke: int
    quantiles: tuple[tuple[float, float, float], ...]
    work: float

    @property
    def row(self) -> list[Any]:
        """Values of LINK_COLUMNS."""
        flat = [value for three in self.quantiles for value in three]
        return [self.name, self.n, self.yielded, self.broke, *flat, self.work]


def peaks_of_links(summaries: list[dict[str, Any]]) -> list[LinkPeaks]:
    """Each link that the summaries tell of with all of PEAKS, in their order; none where there are
    no links.
    """
    found: dict[str, list[dict[str, Any]]] = {}
    for summary in summaries:
        for name, link in (summary.get("links") or {}).items():
            if all(link.get(peak) is not None for peak in PEAKS):
                found.setdefault(name, []).append(link)
    return [
        LinkPeaks(
            name,
            len(links),
            sum(link["yielded_at_s"] is not None for link in links),
            sum(link["broke_at_s"] is not None for link in links),
            tuple(peak_quantiles([link[peak] for link in links]) for peak in PEAKS),
            float(np.median([link["work_j"] for link in links])),
        )
        for name, links in found.items()
    ]


def peak_quantiles(values: list[float]) -> tuple[float, float, float]:
    """Median, that which 84 % of the values stay below, and the largest."""
    median, upper = np.quantile(values, [0.5, 0.84])
    return float(median), float(upper), float(max(values))
