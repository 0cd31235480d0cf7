"""What the glued joints of an ensemble of structures reach: quantiles over its runs."""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.study.link_peaks import peak_quantiles

#: Columns of a table of them, after those of the ensemble: runs, those in which the joint began to
#: fail and failed altogether, largest stresses [Pa], share of the area that failed and energy [J].
BOND_COLUMNS = (
    "joint",
    "n",
    "began",
    "failed",
    *(f"{name}_{share}_pa" for name in ("tension", "shear") for share in ("50", "84", "max")),
    *(f"failed_share_{share}" for share in ("50", "84", "max")),
    "work_50_j",
)
_PEAKS = ("tension_max_pa", "shear_max_pa", "failed_share")


def peaks_of_bonds(summaries: list[dict[str, Any]]) -> list[list[Any]]:
    """Rows of BOND_COLUMNS, one for each glued joint of the summaries in their order, lost runs
    too, of which peaks are those until the end.
    """
    found: dict[str, list[dict[str, Any]]] = {}
    for summary in summaries:
        for name, bond in (summary.get("bonds") or {}).items():
            found.setdefault(name, []).append(bond)
    return [
        [
            name,
            len(bonds),
            sum(bond["first_failed_at_s"] is not None for bond in bonds),
            sum(bond["all_failed_at_s"] is not None for bond in bonds),
            *(value for peak in _PEAKS for value in peak_quantiles([bond[peak] for bond in bonds])),
            float(np.median([bond["work_j"] for bond in bonds])),
        ]
        for name, bonds in found.items()
    ]
