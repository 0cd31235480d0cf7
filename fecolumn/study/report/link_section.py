"""Section: what the links of a structure reach."""

from __future__ import annotations

from fecolumn.study.link_peaks import LINK_COLUMNS, peaks_of_links
from fecolumn.study.report.distributions import axis_columns
from fecolumn.study.report.document import PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.notation import count, number
from fecolumn.study.report.sweep import Sweep

_FOLD = 40
# Of the peaks: words and unit, and how many of it are one of the summary's unit
_SHOWN = (
    ("tension [kN]", 1e-3),
    ("compression [kN]", 1e-3),
    ("elongation [mm]", 1e3),
    ("shortening [mm]", 1e3),
)


def link_section(sweep: Sweep) -> PageSection | None:
    """The section; None where no structure has links."""
    rows = [
        (*(setting.values[axis] for axis in sweep.varied), *link.row)
        for setting in sweep.done
        for link in peaks_of_links(list(setting.runs.values()))
    ]
    if not rows:
        return None
    first = len(sweep.varied)
    columns = (
        *axis_columns(sweep.varied),
        PageColumn("link", "link", text=True),
        PageColumn("n", "n"),
        PageColumn("yielded", "yielded"),
        PageColumn("broke", "broke"),
        *(
            PageColumn(" ".join(LINK_COLUMNS[place : place + 3]), words, _three(unit))
            for place, (words, unit) in zip(range(4, len(LINK_COLUMNS), 3), _SHOWN)
        ),
        PageColumn("work_50_j", "taken [kJ]", lambda value: number(1e-3 * value)),
    )
    broke = sum(row[first + 3] for row in rows)
    runs = sum(row[first + 1] for row in rows)
    text = f"{broke or 'None'} of the {count(runs, 'link')} of all runs broke."
    return PageSection(
        "Links",
        [
            Paragraph(text),
            PageTable(
                "links",
                columns,
                rows,
                "Peaks of each link over the motions: median, 84 % and largest; runs in which it "
                "yielded (a friction damper: slipped) and broke; energy that it took, in the "
                "median. Of a run that was lost those until it ended.",
                folded=len(rows) > _FOLD,
            ),
        ],
    )


def _three(unit: float):
    def written(*values) -> str:
        return ", ".join(number(unit * value) for value in values)

    return written
