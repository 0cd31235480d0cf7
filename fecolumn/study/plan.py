"""The plan of a study: a study file expanded into its analyses, all checked before the first one
runs.

    title = "Time step and numerical damping"
    case = "../meshes/specimen.toml"     # or a table [case] with `extends` and keys of its own
    [axes]                               # and [[zip]], [latin_hypercube]: see study.axes
    "integration.dt_s" = [0.02, 1e-3]

Paths are relative to the file that states them. What neither case nor axes state is as in `fecolumn
run`, except that a study takes output.history_every_s = 0.005 and output.states_every_s = 0.
"""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import math
import typing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.check_step import check_stated
from fecolumn.case.sections import Motion
from fecolumn.case.short_form import ShortForm
from fecolumn.foundation.files import is_file
from fecolumn.foundation.paths import names_record, taken_over
from fecolumn.foundation.schema import InputError, shown
from fecolumn.foundation.toml_file import merge, nested, read_toml
from fecolumn.motions.ensemble_file import file_and_number
from fecolumn.simulation import check_analysis
from fecolumn.study.axes import AxisFactor, hint, read_factors
from fecolumn.study.keys import StudyKeys

# Axes that make the members of an ensemble; every other axis tells one ensemble from another.
ENSEMBLE_AXES = (
    "motion",
    "motion.source",
    "motion.source_y",
    "motion.source_z",
    "motion.rotation_deg",
)
# What a study takes where neither its case nor its axes say otherwise: a column rocks at a few
# hertz, and of thousands of analyses nobody looks at the states
DEFAULTS = {
    "output": {"history_every_s": 0.005, "states_every_s": 0.0},
}
# What names the record of a motion, whatever its direction, scale and time
_RECORD_KEYS = ("source", "source_y", "source_z")
_KEYS = tuple(field.name for field in dataclasses.fields(StudyKeys))
# As many fit into memory and into a ledger
_MOST = 1_000_000
# Cost of a step, relative: only the order and the share of the work left are judged by it
_COST = {"full": 500.0, "reduced": 1.0, "rigid": 0.5}
_COST_OF_MODEL = 0.01
# Sections of a case's short form: false says that there is none
_SECTIONS = set(typing.get_type_hints(ShortForm)) - {"title"}


def setting_of(values: dict[str, Any]) -> dict[str, Any]:
    """Of an analysis' values by axis, those that name the ensemble it belongs to."""
    return {key: value for key, value in values.items() if key not in ENSEMBLE_AXES}


def member_of(values: dict[str, Any]) -> tuple[str, ...]:
    """Of an analysis' values by axis, those that tell the members of its ensemble apart, as
    text.
    """
    return tuple(repr(value) for key, value in values.items() if key in ENSEMBLE_AXES)


def record_of(values: dict[str, Any]) -> str:
    """Of an analysis' values by axis, its record: the files of its motion, whatever their
    direction, scale and time. Analyses of one setting and one record are one cluster, see
    `statistics.records`.
    """
    motion: dict[str, Any] = {}
    for key, value in values.items():
        if key == "motion":
            motion |= value if isinstance(value, dict) else {"source": value}
        motion[key.removeprefix("motion.")] = value
    return "|".join(str(motion.get(key, "")) for key in _RECORD_KEYS)


class PlannedAnalysis:
    """One analysis of the study.

    Attributes
    ----------
    case
        what is analysed.
    id
        of the case.
    keys, levels
        axes, by their dotted keys in the order of the study file, and their values.
    duration_s
        analysed time [s] as far as known: a second where only the motion can tell, and nobody has
        asked it.
    """

    __slots__ = ("case", "id", "keys", "levels", "duration_s")

    def __init__(
        self, case: Case, case_id: str, keys: tuple[str, ...], levels: tuple[Any, ...]
    ) -> None:
        self.case, self.id, self.keys, self.levels = case, case_id, keys, levels
        self.duration_s = case.integration.duration_s or 1.0

    @property
    def values(self) -> dict[str, typing.Any]:
        """Value of each axis."""
        return dict(zip(self.keys, self.levels))

    @property
    def combination(self) -> dict[str, Any]:
        """The values that name the ensemble this analysis belongs to."""
        return setting_of(self.values)

    @property
    def effort(self) -> float:
        """Expected work in steps of the reduced engine; only ratios count.

        Landings and slips cost the same whatever the step: a second of them, as much as a thousand
        steps between them.
        """
        plan = self.case.integration
        return (
            self.duration_s * (1 / plan.shortest_s + 1000) * _COST.get(plan.engine, _COST_OF_MODEL)
        )


@dataclass(frozen=True, slots=True)
class Plan:
    """A study: its file, its title, its axes and every analysis, in the order of the file; `case`:
    the tables all analyses share; `sampled`: axes of its `[latin_hypercube]`.
    """

    file: Path
    title: str
    axes: dict[str, tuple[Any, ...]]
    analyses: tuple[PlannedAnalysis, ...]
    case: dict[str, Any]
    sampled: tuple[str, ...] = ()

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name the set of analyses."""
        return hashlib.sha256(json.dumps(sorted(a.id for a in self.analyses)).encode()).hexdigest()[
            :12
        ]


def read_plan(path: Path | str) -> Plan:
    """Plan of a study file.

    Raises
    ------
    InputError
        anything that would keep one of the analyses from starting: unknown key, value out of range,
        missing file, two combinations that are the same analysis.
    """
    return plan_of(read_toml(path), Path(path))


def plan_of(tables: dict[str, Any], path: Path) -> Plan:
    """Plan of the tables of a study; paths in them are relative to the folder of `path`, the file
    that messages name.

    Raises
    ------
    InputError
        as of `read_plan`.
    """
    if not {"case", "axes"} & set(tables) and {"bodies", "column"} & set(tables):
        raise InputError(
            path, "", None, "is a case, not a study, which has [case] and [axes]: fecolumn run"
        )
    for key in tables:
        if key not in _KEYS:
            raise InputError(
                path,
                key,
                None,
                f"unknown key{hint(key, _KEYS)}; a study has title, case and axes, zip, "
                "latin_hypercube",
            )
    if not isinstance(tables.get("title", ""), str):
        raise InputError(path, "title", tables["title"], "must be text in quotes")
    own = {
        key: value
        for key, value in _case_tables(tables.get("case"), path).items()
        if value is not False or key not in _SECTIONS
    }
    common, factors = merge(DEFAULTS, own), read_factors(tables, path)
    if (number := math.prod(len(factor.levels) for factor in factors)) > _MOST:
        raise InputError(path, "axes", None, f"make {shown(number)} analyses; at most {_MOST:,}")
    makers = _Maker(common, factors, path)
    analyses = tuple(
        makers.analysis(places)
        for places in itertools.product(*(range(len(factor.levels)) for factor in factors))
    )
    _refuse_duplicates(analyses, path)
    axes = {
        key: values for factor in factors for key, values in zip(factor.keys, zip(*factor.levels))
    }
    sampled = [key for one in factors if one.table == "latin_hypercube" for key in one.keys]
    title = tables.get("title", "") or path.stem
    return Plan(path, title, axes, analyses, common, tuple(sampled))


def _case_tables(case: object, path: Path) -> dict[str, Any]:
    """Tables of the case all analyses share."""
    if case is None:
        raise InputError(
            path, "case", None, 'missing; a case file, or a table [case] with extends = "case.toml"'
        )
    parent, own = (
        (case, {})
        if isinstance(case, str)
        else (case.get("extends"), case)
        if isinstance(case, dict)
        else (None, None)
    )
    if own is None or not isinstance(parent, (str, type(None))):
        raise InputError(
            path,
            "case" if own is None else "case.extends",
            case if own is None else parent,
            "must be the path of a case file, relative to this file",
        )
    own = {key: value for key, value in own.items() if key != "extends"}
    return (
        merge(taken_over(read_toml(path.parent / parent), path.parent / parent), own)
        if parent
        else own
    )


class _Maker:
    """Makes the analyses of a plan."""

    def __init__(self, common: dict[str, Any], factors: list[AxisFactor], path: Path) -> None:
        self.common, self.factors, self.path = common, factors, path
        self.keys = tuple(key for factor in factors for key in factor.keys)

    def analysis(self, places: tuple[int, ...]) -> PlannedAnalysis:
        """The analysis at a level of each factor; an error names the study file and the key
        there.
        """
        levels = tuple(
            value for factor, place in zip(self.factors, places) for value in factor.levels[place]
        )
        try:
            case = self._case(places)
        except InputError as error:
            self._refuse(error, levels)
        return PlannedAnalysis(case, case.id, self.keys, levels)

    def _case(self, places: tuple[int, ...]) -> Case:
        """The case at a level of each factor."""
        case = case_from_tables(self._tables(places), self.path)
        check_analysis(case, self.path)
        check_stated(case, self.path)
        for motion in case.motions:
            self._refuse_missing(motion)
        return case

    def _tables(self, places: tuple[int, ...]) -> dict[str, Any]:
        tables = self.common
        for factor, place in zip(self.factors, places):
            for key, value in zip(factor.keys, factor.levels[place]):
                tables = merge(tables, nested(key, value))
        return tables

    def _refuse_missing(self, motion: Motion) -> None:
        for key in ("source", "source_y", "source_z"):
            source = getattr(motion, key)
            file = (file_and_number(source) or (source,))[0]
            if source and not names_record(source) and not is_file(file):
                raise InputError(self.path, f"motion.{key}", source, "no such file")

    def _refuse(self, error: InputError, levels: tuple[Any, ...]) -> typing.NoReturn:
        where = ", ".join(f"{key} = {shown(value)}" for key, value in zip(self.keys, levels))
        told = []
        for one in error.all:
            table = next(
                (
                    factor.table
                    for factor in self.factors
                    for key in factor.keys
                    if key in (one.key, one.key.partition(".")[0])
                ),
                None,
            )
            told.append(
                InputError(
                    self.path,
                    f"{table or 'case'}.{one.key}",
                    one.value,
                    one.allowed if table else f"{one.allowed} (with {where})",
                )
            )
        raise InputError.of_several(told) from None


def _refuse_duplicates(analyses: tuple[PlannedAnalysis, ...], path: Path) -> None:
    first: dict[str, PlannedAnalysis] = {}
    for analysis in analyses:
        other = first.setdefault(analysis.id, analysis)
        if other is not analysis:
            differing = [
                f"{key} = {one!r} and {two!r}"
                for key, one, two in zip(other.keys, other.levels, analysis.levels)
                if one != two
            ]
            which = ", ".join(differing) or f"both of {_named(analysis)}"
            raise InputError(
                path,
                "axes",
                None,
                f"two combinations are the same analysis: {which} "
                "(title and output do not make a difference)",
            )


def _named(analysis: PlannedAnalysis) -> str:
    """Values of the axes of an analysis but its motion, in words."""
    values = analysis.combination or analysis.values
    return ", ".join(f"{key} = {shown(value)}" for key, value in values.items())
