"""How many motions the distribution of a setting needs, as a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.convergence import cdf_convergence
from fecolumn.statistics.records import counted_unit, record_count
from fecolumn.study.report.document import PageBlock
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import fixed
from fecolumn.study.report.sweep import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def convergence_blocks(sweep: Sweep, gallery: Gallery) -> list[PageBlock]:
    """How many motions the reference setting's distribution needs."""
    u, over = sweep.reference.peaks()
    records = sweep.reference.records_of()
    total = record_count(records, u.size)
    if total < 10:
        return []
    unit = counted_unit(u.size, total)
    sizes = np.unique(np.round(np.geomspace(3, total, 24)).astype(int))
    found = cdf_convergence(u, over, sizes, records=records)
    curves = [
        Curve("drawn from the ensemble, median", sizes, found.median),
        Curve("drawn from the ensemble, 95 %", sizes, found.upper_95),
        Curve("bound to the true CDF, 95 % (DKW)", sizes, found.dkw_95),
    ]
    panels = [
        CurvePanel(
            f"{unit} $n$",
            r"largest distance of two CDFs",
            curves,
            {"xscale": "log", "ylim": (0, 1)},
            prepare=_plain_ticks,
        )
    ]
    last = float(found.dkw_95[-1])
    return [
        gallery.draw(
            "convergence",
            f"Distance of the CDF of n {unit} from that of all {total}, "
            f"{sweep.at(sweep.reference.values)}. It vanishes at n = {total} by construction; the "
            f"distance to the distribution of all {unit} there could be stays below the DKW bound, "
            f"{fixed(last)} for {total} {unit}, at 95 %.",
            line_figure,
            panels,
        )
    ]


def _plain_ticks(axes: Axes) -> None:
    low, high = axes.get_xlim()
    ticks = [tick for tick in (3, 5, 10, 20, 50, 100, 200, 500, 1000) if low <= tick <= high]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
