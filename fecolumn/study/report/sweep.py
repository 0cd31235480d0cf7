"""A study as its report sees it: settings (ensembles) crossed with motions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.ending import P_LOST, P_OVERTURN, cut_short
from fecolumn.foundation.files import read_json
from fecolumn.statistics.ecdf import Ecdf, ecdf, largest_peak, share_interval
from fecolumn.study.alpha import ALPHA_KEY, alpha_note
from fecolumn.study.plan import ENSEMBLE_AXES, record_of
from fecolumn.study.report.notation import ALL_ANALYSES, setting_text
from fecolumn.study.report.subject import Subject, subject_of
from fecolumn.study.setting_pairs import SAMPLED, axes_together
from fecolumn.study.store import DONE, FAILED, read_study

DT_KEY, ENGINE_KEY = "integration.dt_s", "integration.engine"
FINE_DT_S = 1e-3 * (1 + 1e-9)  # what the paper calls small enough
PAPER_CHOICE = {DT_KEY: 1e-3, ALPHA_KEY: -0.2}


@dataclass(frozen=True, slots=True)
class Setting:
    """One combination of parameters and its runs.

    Attributes
    ----------
    values
        value of each axis that is not the motion, by dotted key.
    planned, failed
        analyses.
    runs
        summary of each analysis that is done, by motion.
    records
        record of each motion, see `plan.record_of`; a motion that is not in it has its own.
    """

    values: dict[str, Any]
    planned: int
    failed: int
    runs: dict[str, dict[str, Any]]
    records: dict[str, str] = field(default_factory=dict)

    def records_of(self, motions: Sequence[str] | None = None) -> list[str]:
        """Record of each run, one a motion."""
        return [
            self.records.get(motion, motion)
            for motion in (self.runs if motions is None else motions)
        ]

    def distribution(self, motions: Sequence[str] | None = None) -> Ecdf:
        """Of u_max [m]."""
        return ecdf(*self.peaks(motions), records=self.records_of(motions))

    def overturning(
        self, motions: Sequence[str] | None = None, method: str = "wilson"
    ) -> tuple[float, float]:
        """95 % interval of P(overturn)."""
        fallen = self.column("overturned", motions).astype(bool)
        return share_interval(fallen, self.records_of(motions), method=method)

    def column(self, name: str, motions: Sequence[str] | None = None) -> NDArray[Any]:
        """A number of the summaries, one a motion (nan where it is not stated)."""
        runs = self.runs if motions is None else {motion: self.runs[motion] for motion in motions}
        return np.array(
            [np.nan if run.get(name) is None else run[name] for run in runs.values()], float
        )

    def peaks(self, motions: Sequence[str] | None = None) -> tuple[NDArray[Any], NDArray[Any]]:
        """u_max [m], nan where the column overturned or slid off its base, and whether it did, one
        a motion.
        """
        lost = self.column("overturned", motions).astype(bool) | (
            self.column("slid_off", motions) == 1
        )
        return np.where(lost, np.nan, self.column("u_max_m", motions)), lost


@dataclass(frozen=True, slots=True)
class Line:
    """Settings along one axis, all else equal; `settings` in rising order of the axis' levels, each
    with runs.
    """

    axis: str
    others: dict[str, Any]
    settings: tuple[Setting, ...]

    def motions(self) -> list[str]:
        """Motions done in every setting."""
        return common_motions(self.settings)

    def records(self) -> list[str]:
        """Record of each of them."""
        return self.settings[0].records_of(self.motions())

    def peaks(self) -> tuple[NDArray[Any], NDArray[Any]]:
        """u_max [m] and overturned, (levels, n) of the common motions."""
        return common_peaks(self.settings, self.motions())

    @property
    def levels(self) -> list[Any]:
        """Values of the axis, one for each setting."""
        return [setting.values[self.axis] for setting in self.settings]


@dataclass(frozen=True)
class Sweep:
    """A study read for its report.

    Attributes
    ----------
    folder
        of the study.
    title
        of it.
    axes
        levels of each axis that is not the motion, numbers rising, others as they stand in the
        study.
    settings
        in the order of the study; those without a finished run included.
    rows
        the ledger.
    analyses
        number of all analyses; of a job array at work the ledger has not all of them yet.
    limit_m
        displacement that every overturned column exceeded [m]: the cap of the study, or the largest
        peak of those that stood.
    case
        tables of one case of the study, {} where no result folder has one.
    """

    folder: Path
    title: str
    axes: dict[str, list[Any]]
    settings: tuple[Setting, ...]
    rows: list[dict[str, Any]]
    analyses: int
    limit_m: float
    case: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def done(self) -> tuple[Setting, ...]:
        """Settings with at least one run."""
        return tuple(setting for setting in self.settings if setting.runs)

    @cached_property
    def motions(self) -> list[str]:
        """Names of all motions, each once, in the order of the settings."""
        return list(dict.fromkeys(motion for setting in self.settings for motion in setting.runs))

    @cached_property
    def records(self) -> list[str]:
        """Record of each of them."""
        known = {motion: record for one in self.settings for motion, record in one.records.items()}
        return [known.get(motion, motion) for motion in self.motions]

    @cached_property
    def cut(self) -> str:
        """What is said of analyses that cut their motion short; "" where none does."""
        return cut_short(run for setting in self.settings for run in setting.runs.values())

    @cached_property
    def slides(self) -> bool:
        """Whether any column slid off its base: what is lost is then more than what overturned."""
        return any(
            run.get("slid_off") for setting in self.settings for run in setting.runs.values()
        )

    @property
    def lost(self) -> str:
        """What runs did that are lost."""
        return "overturned or slid off" if self.slides else "overturned"

    @cached_property
    def subject(self) -> Subject:
        """What overturns, in words."""
        return subject_of(self.case)

    @property
    def alpha_note(self) -> str:
        """What goes beside every statement on the effect of alpha, see `study.alpha`."""
        return alpha_note(self.case, self.axes)

    @property
    def p_lost(self) -> str:
        """Name of the share of columns that are lost, where no figure parts what overturned from
        what slid off.
        """
        return P_LOST if self.slides else P_OVERTURN

    @property
    def varied(self) -> list[str]:
        """Axes with more than one level."""
        return [axis for axis, levels in self.axes.items() if len(levels) > 1]

    @cached_property
    def reference(self) -> Setting:
        """The paper's choice where the study has it, else the setting with most runs, the middle
        one of equals.
        """
        chosen = [
            s
            for s in self.done
            if all(s.values.get(axis) == value for axis, value in PAPER_CHOICE.items())
        ]
        most = max(len(s.runs) for s in self.done)
        equals = chosen or [s for s in self.done if len(s.runs) == most]
        return equals[0] if chosen else equals[len(equals) // 2]

    def at(self, values: dict[str, Any]) -> str:
        """Words such as "at Δt = 0.001 s"."""
        words = self.words(values)
        return f"in {ALL_ANALYSES}" if words == ALL_ANALYSES else f"at {words}"

    def words(self, values: dict[str, Any]) -> str:
        """Values of the axes that vary, such as "Δt = 0.001 s, α = −0.2"; those of one value alone
        are told once, at the top.
        """
        return setting_text({axis: values[axis] for axis in self.varied if axis in values})

    def together(self, axis: str) -> tuple[str, ...]:
        """The axis and those whose values go with its own, as of one `[[zip]]`; the axis alone
        where it is sampled.
        """
        return next((group for group in self._together if axis in group), (axis,))

    @cached_property
    def _together(self) -> list[tuple[str, ...]]:
        few = [axis for axis in self.varied if len(self.axes[axis]) <= SAMPLED]
        return axes_together([{axis: one.values[axis] for axis in few} for one in self.settings])

    @property
    def leading(self) -> list[str]:
        """Axes with more than one level, of those that go together the first."""
        return [axis for axis in self.varied if self.together(axis)[0] == axis]

    def groups(self, axis: str) -> list[tuple[dict[str, Any], tuple[Setting, ...]]]:
        """Values of the other axes, but for those that go with this one, and the settings with runs
        that have them, in rising order of the axis' levels.
        """
        groups: dict[str, list[Setting]] = {}
        keys = [key for key in self.varied if key not in self.together(axis)]
        for setting in self.done:
            others = {key: setting.values[key] for key in keys}
            groups.setdefault(repr(others), []).append(setting)
        order = {repr(level): place for place, level in enumerate(self.axes[axis])}
        return [
            (
                {key: group[0].values[key] for key in keys},
                tuple(sorted(group, key=lambda s: order[repr(s.values[axis])])),
            )
            for group in groups.values()
        ]

    def pairs(self, axis: str, low: object, high: object) -> list[tuple[Setting, Setting]]:
        """Settings at two levels of an axis of each of its lines that has both."""
        found = []
        for line in self.lines(axis):
            at = {repr(setting.values[axis]): setting for setting in line.settings}
            if repr(low) in at and repr(high) in at:
                found.append((at[repr(low)], at[repr(high)]))
        return found

    def lines(self, axis: str) -> list[Line]:
        """Every line along an axis with at least two levels that have runs of common motions."""
        lines = [Line(axis, others, settings) for others, settings in self.groups(axis)]
        return [line for line in lines if len(line.settings) > 1 and line.motions()]


def common_peaks(
    settings: Iterable[Setting], motions: list[str]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """u_max [m] and whether lost, (settings, motions) each."""
    pairs = [setting.peaks(motions) for setting in settings]
    return np.array([u for u, _ in pairs]), np.array([over for _, over in pairs])


def common_motions(settings: Sequence[Setting]) -> list[str]:
    """Motions done in all of the settings, in the order of the first."""
    return [
        motion
        for motion in settings[0].runs
        if all(motion in setting.runs for setting in settings[1:])
    ]


def read_sweep(folder: Path | str) -> Sweep:
    """The study in a folder, finished or not.

    Raises
    ------
    InputError
        the folder holds no study.
    """
    folder, study = Path(folder), read_study(folder)
    groups: dict[str, list[dict[str, Any]]] = {}
    for row in study.rows:
        groups.setdefault(
            repr([item for item in row["axes"].items() if item[0] not in ENSEMBLE_AXES]), []
        ).append(row)
    settings = tuple(_setting(rows) for rows in groups.values())
    axes: dict[str, dict[str, Any]] = {}
    for setting in settings:
        for key, value in setting.values.items():
            axes.setdefault(key, {})[repr(value)] = value
    case = next(
        filter(
            None,
            (_case(folder / "analyses" / row["id"]) for row in study.rows if row["state"] == DONE),
        ),
        {},
    )
    return Sweep(
        folder,
        study.title,
        {key: _ordered(list(levels.values())) for key, levels in axes.items()},
        settings,
        study.rows,
        study.analyses,
        float(case.get("overturn", {}).get("displacement_m", 0.0)) or _largest_peak(settings),
        case,
    )


def _largest_peak(settings: Iterable[Setting]) -> float:
    found = largest_peak(*(setting.peaks() for setting in settings if setting.runs))
    return found if found > 0 else 1.0


def _setting(rows: list[dict[str, Any]]) -> Setting:
    done = {
        repr([value for key, value in row["axes"].items() if key in ENSEMBLE_AXES]): row
        for row in rows
        if row["state"] == DONE and row["summary"]
    }
    runs = {motion: row["summary"] for motion, row in done.items()}
    records = {motion: record_of(row["axes"]) for motion, row in done.items()}
    values = {key: value for key, value in rows[0]["axes"].items() if key not in ENSEMBLE_AXES}
    return Setting(values, len(rows), sum(row["state"] == FAILED for row in rows), runs, records)


def _ordered(levels: list[Any]) -> list[Any]:
    numbers = all(
        isinstance(level, (int, float)) and not isinstance(level, bool) for level in levels
    )
    return sorted(levels) if numbers else levels


def read_tables(folder: Path) -> dict[str, Any]:
    """Tables of the case an analysis was run with."""
    tables: dict[str, Any] = read_json(folder / "case.json")["case"]
    return tables


def _case(folder: Path) -> dict[str, Any]:
    try:
        tables = read_tables(folder)
        float(tables.get("overturn", {}).get("displacement_m", 0.25))
        return (
            tables
            if all(isinstance(table, (dict, str, type(None))) for table in tables.values())
            else {}
        )
    except (ValueError, KeyError, TypeError, AttributeError):
        return {}
