"""A study: its analyses as a table, the distributions of its settings, its figures and its
report.
"""

from __future__ import annotations

import functools
import html
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.engines.ending import lost
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.ecdf import Ecdf, ecdf
from fecolumn.study.plan import record_of, setting_of
from fecolumn.study.results.analysis import AnalysisResult
from fecolumn.study.results.picture import Picture
from fecolumn.study.sample import same_value
from fecolumn.study.store import DONE, FAILED, Study, read_study

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, slots=True)
class Member:
    """An analysis of a study in the ledger, as `study.table` asks for it: its id, and the values
    that name its ensemble.
    """

    id: str
    combination: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Members:
    """Title and analyses of a study that is read from its folder, in the place of its
    `study.plan.Plan`.
    """

    title: str
    analyses: tuple[Member, ...]


class StudyResult:
    """What is in the folder of a study, of `run_study` or `fecolumn study`, finished or not, when
    it is first asked for; `fecolumn.load` it again for what has been done since.

    Attributes
    ----------
    folder
        Path.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)

    @functools.cached_property
    def _study(self) -> Study:
        return read_study(self.folder)

    @property
    def title(self) -> str:
        """Of the study file."""
        return self._study.title

    @property
    def axes(self) -> dict[str, list[Any]]:
        """Values of each axis by its dotted key."""
        return self._study.axes

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dict an analysis in the order of the study file.

        Keys: id; axes (value by dotted key); state ("planned", "running", "done", "failed"); reason
        (why it failed); wall_s [s]; version; summary (as of summary.json, None until it is done);
        motion (digest of what it holds); machine; started [s since 1970]; log (file with what a
        failed one said, relative to the folder).
        """
        return self._study.rows

    @property
    def done(self) -> int:
        """Number of analyses that are done, of len(rows)."""
        return sum(row["state"] == DONE for row in self.rows)

    @property
    def failed(self) -> int:
        """Number of analyses that ended with an error, of len(rows); `rows` have their reasons."""
        return sum(row["state"] == FAILED for row in self.rows)

    @property
    def finished(self) -> bool:
        """Whether nothing is left to be done: each analysis is done or has failed."""
        return self.done + self.failed == self._study.analyses

    def chosen(self, choice: dict[str, Any] | None = None) -> list[dict[str, Any]]:
        """Those of `rows` that are done and have the values of `choice`, by the dotted keys of
        axes, such as {"integration.dt_s": 1e-3}.

        Raises
        ------
        InputError
            an axis or a value that the study does not have.
        """
        rows = [row for row in self.rows if row["state"] == DONE]
        for key, value in (choice or {}).items():
            if key not in self.axes:
                raise InputError(
                    self.folder,
                    key,
                    value,
                    f"is no axis of this study; its axes: {', '.join(self.axes)}",
                )
            if not any(same_value(one, value) for one in self.axes[key]):
                raise InputError(
                    self.folder,
                    key,
                    value,
                    f"is no value of this axis; it has {', '.join(map(str, self.axes[key][:8]))}",
                )
            rows = [row for row in rows if same_value(row["axes"][key], value)]
        return rows

    def ecdf(self, choice: dict[str, Any] | None = None) -> Ecdf:
        """Empirical distribution of the largest displacement of the top [m]; what was lost counts
        as larger than all. Warns where `choice` leaves analyses of several settings in it.

        Raises
        ------
        InputError
            as of `chosen`, or nothing of it is done.
        """
        rows = self.chosen(choice)
        summaries = [row["summary"] for row in rows]
        if not summaries:
            raise InputError(self.folder, "", None, "none of these analyses is done")
        varied = [
            key
            for key in setting_of(self.axes)
            if not all(same_value(row["axes"][key], rows[0]["axes"][key]) for row in rows)
        ]
        if varied:
            warnings.warn(
                f"{self.folder}: one distribution of all values of {', '.join(varied)}: "
                "choose a value of each for the distribution of one setting",
                stacklevel=2,
            )
        return ecdf(
            [summary["u_max_m"] for summary in summaries],
            [lost(summary) for summary in summaries],
            records=[record_of(row["axes"]) for row in rows],
        )

    def analyses(self, choice: dict[str, Any] | None = None) -> list[AnalysisResult]:
        """The results of single analyses, where the study has kept their folders."""
        folders = (self.folder / "analyses" / row["id"] for row in self.chosen(choice))
        return [AnalysisResult(folder) for folder in folders if folder.is_dir()]

    @property
    def data(self) -> pandas.DataFrame:
        """The analyses as a pandas.DataFrame, as of `to_pandas`: `study.data.groupby(...)`."""
        return self.to_pandas()

    def columns(self) -> dict[str, list[Any]]:
        """One list an axis, then state, outcome and peak; the peak of what was lost is nan, its
        displacement is where the analysis stopped.
        """
        table = {key: [row["axes"][key] for row in self.rows] for key in self.axes}
        summaries = [row["summary"] or {} for row in self.rows]
        table["state"] = [row["state"] for row in self.rows]
        table["outcome"] = [summary.get("outcome", "") for summary in summaries]
        table["lost"] = [bool(summary) and lost(summary) for summary in summaries]
        table["u_max_m"] = [
            summary["u_max_m"] if summary and not lost(summary) else np.nan for summary in summaries
        ]
        table["steps"] = [summary.get("steps", 0) for summary in summaries]
        return table

    def to_pandas(self) -> pandas.DataFrame:
        """DataFrame of `columns`, an analysis a row, its id the index."""
        import pandas

        return pandas.DataFrame(
            self.columns(), index=pandas.Index([row["id"] for row in self.rows], name="id")
        )

    @property
    def plot(self) -> StudyPlots:
        """Figures: `plot.cdf()`."""
        return StudyPlots(self)

    def report(self, output: str | Path | None = None) -> Path:
        """Write the report as of `fecolumn report`; its page."""
        from fecolumn.study.report.page import write_report

        return write_report(self.folder, output)

    def __repr__(self) -> str:
        return f"StudyResult({str(self.folder)!r}: {self._counts()})"

    def _repr_html_(self) -> str:
        from fecolumn.study.table import table_text

        text = table_text(self._members(), self.rows) if self.done else "nothing is done yet"
        return f"<p>{html.escape(self.title)}: {self._counts()}</p><pre>{html.escape(text)}</pre>"

    def _counts(self) -> str:
        failed = f", {self.failed} failed" if self.failed else ""
        return f"{self.done} of {len(self.rows)} analyses done{failed}"

    def _members(self) -> Members:
        return Members(
            self.title, tuple(Member(row["id"], setting_of(row["axes"])) for row in self.rows)
        )


class StudyPlots:
    """Figures of a study, each a Picture."""

    def __init__(self, result: StudyResult) -> None:
        self.result = result

    def cdf(self) -> Picture:
        """Distributions of the largest displacement, with bands: a line a setting, as of `fecolumn
        study`.
        """
        from fecolumn.study.table import write_figure

        if not self.result.done:
            raise InputError(
                self.result.folder, "", None, "none of its analyses is done; nothing to draw yet"
            )
        return Picture(
            lambda path: write_figure(self.result._members(), self.result.rows, path.parent)
        )
