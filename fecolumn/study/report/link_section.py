"""Sections: what the links and the glued joints of a structure reach."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fecolumn.study.device_peaks import BOND_COLUMNS, LINK_COLUMNS, peaks_of_bonds, peaks_of_links
from fecolumn.study.report.document import PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.notation import count, number
from fecolumn.study.report.setting_columns import axis_columns
from fecolumn.study.report.sweep import Sweep

_FOLD = 40
# Of the peaks: words and unit, and how many of it are one of the summary's unit
_OF_LINKS = (
    ("tension [kN]", 1e-3),
    ("compression [kN]", 1e-3),
    ("elongation [mm]", 1e3),
    ("shortening [mm]", 1e3),
)
_OF_BONDS = (("tension [kPa]", 1e-3), ("shear [kPa]", 1e-3), ("failed share [%]", 1e2))


def link_section(sweep: Sweep) -> PageSection | None:
    """The section; None where no structure has links."""
    columns = (
        PageColumn("link", "link", text=True),
        PageColumn("n", "n"),
        PageColumn("yielded", "yielded"),
        PageColumn("broke", "broke"),
        *_threes(LINK_COLUMNS, _OF_LINKS),
        PageColumn("work_50_j", "taken [kJ]", lambda value: number(1e-3 * value)),
    )
    caption = (
        "Peaks of each link over the motions: median, 84 % and largest; runs in which it "
        "yielded (a friction damper: slipped) and broke; energy that it took, in the "
        "median. Of a run that was lost those until it ended."
    )
    return _section(sweep, "Links", peaks_of_links, columns, ("link", "broke"), caption)


def bond_section(sweep: Sweep) -> PageSection | None:
    """The section of glued joints; None where no structure has any."""
    columns = (
        PageColumn("joint", "joint", text=True),
        PageColumn("n", "n"),
        PageColumn("began", "began to fail"),
        PageColumn("failed", "failed"),
        *_threes(BOND_COLUMNS, _OF_BONDS),
        PageColumn("work_50_j", "taken [J]", number),
    )
    caption = (
        "Wax, putty or mortar over the motions: largest tension and shear of a point and "
        "share of the area that failed, each as median, 84 % and largest; runs in which "
        "it began to fail and failed altogether; energy that it took, in the median."
    )
    words = "glued joint", "failed altogether"
    return _section(sweep, "Glued joints", peaks_of_bonds, columns, words, caption, "bonds")


def _section(
    sweep: Sweep,
    title: str,
    peaks: Callable[[list[dict[str, Any]]], list[list[Any]]],
    columns: tuple[PageColumn, ...],
    words: tuple[str, str],
    caption: str,
    name: str = "links",
) -> PageSection | None:
    """A table of `peaks` of each setting, after a sentence on how many failed; words: what one is
    called, and what those that failed did.
    """
    rows = [
        (*(setting.values[axis] for axis in sweep.varied), *row)
        for setting in sweep.done
        for row in peaks(list(setting.runs.values()))
    ]
    if not rows:
        return None
    first = len(sweep.varied)
    failed = sum(row[first + 3] for row in rows)
    runs = sum(row[first + 1] for row in rows)
    text = f"{failed or 'None'} of the {count(runs, words[0])} of all runs {words[1]}."
    columns = (*axis_columns(sweep.varied), *columns)
    table = PageTable(name, columns, rows, caption, folded=len(rows) > _FOLD)
    return PageSection(title, [Paragraph(text), table])


def _threes(names: tuple[str, ...], shown: tuple[tuple[str, float], ...]) -> list[PageColumn]:
    """Columns of three quantiles each of the peaks."""
    places = range(4, len(names), 3)
    return [
        PageColumn(" ".join(names[place : place + 3]), words, _three(unit))
        for place, (words, unit) in zip(places, shown)
    ]


def _three(unit: float) -> Callable[..., str]:
    def written(*values: float) -> str:
        return ", ".join(number(unit * value) for value in values)

    return written
