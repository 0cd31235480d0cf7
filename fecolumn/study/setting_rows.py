"""A study setting by setting: the rows of its ledger that belong together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fecolumn.study.plan import record_of
from fecolumn.study.planned import PlannedStudy
from fecolumn.study.store import DONE, FAILED


@dataclass(frozen=True, slots=True)
class SettingRows:
    """A setting: its axis values, and a row of the ledger for each analysis that is planned."""

    values: dict[str, Any]
    rows: list[dict[str, Any]]

    @property
    def done(self) -> list[dict[str, Any]]:
        """Rows of the analyses that are done."""
        return [row for row in self.rows if row["state"] == DONE]

    @property
    def summaries(self) -> list[dict[str, Any]]:
        """Of what is done."""
        return [row["summary"] for row in self.done]

    @property
    def records(self) -> list[str]:
        """Record of each of the summaries, see `plan.record_of`."""
        return [record_of(row["axes"]) for row in self.done]

    @property
    def failed(self) -> list[dict[str, Any]]:
        """Rows of the analyses that failed."""
        return failed_of(self.rows)


def rows_by_setting(plan: PlannedStudy, rows: Sequence[dict[str, Any]]) -> list[SettingRows]:
    """The settings of a study in the order of its file.

    Parameters
    ----------
    plan
        the study.
    rows
        its ledger, as `complete_study` returns it.
    """
    known = {row["id"]: row for row in rows}
    groups: dict[tuple[Any, ...], SettingRows] = {}
    for analysis in plan.analyses:
        key = tuple(map(repr, analysis.combination.values()))
        setting = groups.setdefault(key, SettingRows(analysis.combination, []))
        setting.rows.append(known.get(analysis.id, {"state": ""}))
    return list(groups.values())


def failed_of(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of the ledger of analyses that failed."""
    return [row for row in rows if row["state"] == FAILED]
