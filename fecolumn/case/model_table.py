"""The case of a rocking model by its own table, such as [podium]: one analysis of `fecolumn run`,
or of a study.

    [podium]                   [motion]               [integration]
    column_mass_kg = 2500      source = "lick:12"     dt_s = 0.005    # the table gives the engine
    ...

The same file may describe the structure in [bodies], too. integration.engine then says which of
both is analysed: the name of a model, or an engine of bodies.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fecolumn.case.check_step import check_step
from fecolumn.case.checked import refuse_in
from fecolumn.case.model_names import TABLES, model_engine_of
from fecolumn.case.model_sections import SECTIONS
from fecolumn.case.reading import fields_of_tables
from fecolumn.case.sections import Contact, Initial, Integration, Motion, Output, Overturn, located
from fecolumn.foundation.schema import InputError, Section, build, parameter, table_of
from fecolumn.foundation.section_class import section_class

#: Tables of a structure of [bodies] that a model of the same file passes over, [interfaces] as the
#: older name of [joints]
_OF_BODIES = (
    "bodies",
    "materials",
    "grounds",
    "joints",
    "interfaces",
    "links",
    "contact",
    "observed",
    "mesh",
)


@section_class()
class Start(Section):
    """State at t = 0."""

    tilt_rad: float = parameter(0.0, doc="tilt; 0 starts upright", unit="rad", low=0, high=1.5)
    direction_deg: float = parameter(
        0.0,
        doc="direction in which the top leans: angle from x towards y",
        unit="deg",
        low=-360,
        high=360,
    )


#: Sections beside the model's own table
_COMMON = {
    "integration": Integration,
    "initial": Start,
    "overturn": Overturn,
    "output": Output,
    "motion": Motion,
}


def check_others(tables: dict[str, Any], file: Path | str, but: str = "") -> None:
    """Check tables of models that a case passes over: all but the one that it is of.

    Raises
    ------
    InputError
        unknown key, value out of range.
    """
    for name in TABLES:
        if name != but and tables.get(name, False) is not False:
            build(SECTIONS[name], tables[name], file, f"{name}.")


def _check_structure(tables: dict[str, Any], file: Path | str) -> None:
    """As `check_others`, of the tables of a structure that a model passes over."""
    found = {name: tables[name] for name in _OF_BODIES if name in tables}
    start = tables.get("initial")
    if isinstance(start, dict):
        found["initial"] = {name: one for name, one in start.items() if isinstance(one, dict)}
    fields_of_tables(found, file)


def fields_of_table(
    tables: dict[str, Any], file: Path | str, engine: str | None = None
) -> dict[str, Any]:
    """Fields of the Case of TOML tables that have a model's own; relative paths are taken from
    the folder of `file`.

    Parameters
    ----------
    engine
        name of the model; left out: as `model_names.model_engine_of` says.

    Raises
    ------
    InputError
        unknown key, value out of range, parts that do not fit.
    """
    engine = engine or model_engine_of(tables, file)
    table = next(name for name, model in TABLES.items() if model == engine)
    structure = "bodies" in tables
    check_others(tables, file, table)
    if structure:
        _check_structure(tables, file)
    tables = {
        key: value
        for key, value in tables.items()
        if not (structure and key in _OF_BODIES or key in TABLES and key != table)
        and value is not False
    }
    # tables by the names of bodies stand beside the model's own keys
    if structure and isinstance(tables.get("initial"), dict):
        tables["initial"] = {
            key: value
            for key, value in tables["initial"].items()
            if value is not False and not isinstance(value, dict)
        }
    for key in tables:
        if key not in _COMMON and key not in (table, "title"):
            raise InputError(
                file,
                key,
                None,
                f"unknown key; a case of the model {engine} has title, "
                f"{', '.join([table, *_COMMON])}, or is a case of fecolumn run with "
                "[column]",
            )
    if not isinstance(tables.get("title", ""), str):
        raise InputError(file, "title", tables["title"], "must be text in quotes")
    stated = tables.get("integration", {})
    if not isinstance(stated, dict):
        raise InputError(file, "integration", stated, "must be a table")
    tables["integration"] = {**stated, "engine": engine}
    found = {
        name: located(name, build(kind, tables.get(name, {}), file, f"{name}."), file)
        for name, kind in _COMMON.items()
        if name != "motion" or "motion" in tables
    }
    check_step(found["integration"], refuse_in(file))
    if found["output"].fields_every_s:
        raise InputError(
            file,
            "output.fields_every_s",
            found["output"].fields_every_s,
            f"must be 0 where integration.engine = {engine!r}: a rigid model has no fields",
        )
    start = found.pop("initial")
    return dict(
        **found,
        bodies={},
        materials={},
        grounds={},
        joints={},
        links={},
        initial={table: Initial(tilt_rad=start.tilt_rad, direction_deg=start.direction_deg)},
        contact=Contact(),
        title=tables.get("title", ""),
        own={table: build(SECTIONS[table], tables[table], file, f"{table}.")},
    )


def tables_of_model(
    model: Section, sections: dict[str, Section | None], title: str, defaults: bool = False
) -> dict[str, Any]:
    """Tables of the file of a rocking model's case.

    Parameters
    ----------
    model
        the model's own table, such as a FrameModel.
    sections
        by names of _COMMON, None where its defaults are meant.
    defaults
        whether keys at their defaults are stated.

    Raises
    ------
    InputError
        `model` is no table of a model.
    """
    tables = {kind: table for table, kind in SECTIONS.items()}
    if type(model) not in tables:
        raise InputError(
            "case",
            "model",
            model,
            "must be a BlockModel, FrameModel, WobblingModel, WobblingFrameModel or PodiumModel",
        )
    if not isinstance(title, str):
        raise InputError("case", "title", title, "must be text in quotes")
    for name, one in sections.items():
        if one is not None and not isinstance(one, Section):
            raise InputError("case", name, one, f"must be a {name.capitalize()}")
    found = {
        tables[type(model)]: table_of(model, defaults),
        **{name: table_of(one, defaults) for name, one in sections.items() if one is not None},
    }
    return found | ({"title": title} if title else {})


def model_key_type(key: str) -> Any:
    """Type of a dotted key of a model's table, such as podium.storeys, or None."""
    import typing

    table, _, name = key.partition(".")
    kind = typing.get_type_hints(SECTIONS[table]).get(name) if table in SECTIONS else None
    return next((one for one in (kind, *typing.get_args(kind)) if one in (int, float)), kind)
