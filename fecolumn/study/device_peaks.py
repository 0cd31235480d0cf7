"""What the links and the glued joints of an ensemble reach: quantiles of their peaks over its runs,
lost ones too, of which peaks are those until the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

# Entries of summary.json whose median, 84 % quantile and largest value are told
_OF_LINKS = ("tension_max_n", "compression_max_n", "elongation_max_m", "shortening_max_m")
_OF_BONDS = ("tension_max_pa", "shear_max_pa", "failed_share")
_SHARES = ("50", "84", "max")

#: Columns of a table of links, after those of the ensemble: runs, those in which the link yielded
#: or slipped, and broke, peaks and energy taken [J].
LINK_COLUMNS = (
    "link",
    "n",
    "yielded",
    "broke",
    *(f"{name[:-6]}_{share}{name[-2:]}" for name in _OF_LINKS for share in _SHARES),
    "work_50_j",
)
#: The same of glued joints: runs, those in which the joint began to fail and failed altogether,
#: largest stresses [Pa], share of the area that failed and energy taken [J].
BOND_COLUMNS = (
    "joint",
    "n",
    "began",
    "failed",
    *(f"{name}_{share}_pa" for name in ("tension", "shear") for share in _SHARES),
    *(f"failed_share_{share}" for share in _SHARES),
    "work_50_j",
)


def peaks_of_links(summaries: list[dict[str, Any]]) -> list[list[Any]]:
    """Rows of LINK_COLUMNS, one for each link of the summaries in their order."""
    return _rows(summaries, "links", ("yielded_at_s", "broke_at_s"), _OF_LINKS)


def peaks_of_bonds(summaries: list[dict[str, Any]]) -> list[list[Any]]:
    """Rows of BOND_COLUMNS, one for each glued joint of the summaries in their order."""
    return _rows(summaries, "bonds", ("first_failed_at_s", "all_failed_at_s"), _OF_BONDS)


def _rows(
    summaries: list[dict[str, Any]], kind: str, times: tuple[str, ...], peaks: tuple[str, ...]
) -> list[list[Any]]:
    """Rows of what the summaries tell with all of `peaks`; `times`: entries that are None in runs
    that are not counted.
    """
    found: dict[str, list[dict[str, Any]]] = {}
    for summary in summaries:
        for name, told in (summary.get(kind) or {}).items():
            if all(told.get(peak) is not None for peak in peaks):
                found.setdefault(name, []).append(told)
    return [
        [
            name,
            len(runs),
            *(sum(run[time] is not None for run in runs) for time in times),
            *(value for peak in peaks for value in _quantiles([run[peak] for run in runs])),
            float(np.median([run["work_j"] for run in runs])),
        ]
        for name, runs in found.items()
    ]


def _quantiles(values: list[float]) -> tuple[float, float, float]:
    """Median, that which 84 % of the values stay below, and the largest."""
    median, upper = np.quantile(values, [0.5, 0.84])
    return float(median), float(upper), float(max(values))
