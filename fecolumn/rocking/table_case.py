"""The case of a rocking model by its own table, such as [podium]: one analysis of `fecolumn run`,
or of a study.

    [podium]                   [motion]               [integration]
    column_mass_kg = 2500      source = "lick:12"     dt_s = 0.005    # the table gives the engine
    ...

The same file may describe the structure in [bodies], too. integration.engine then says which of
both is analysed: the name of a model, or an engine of bodies.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
from dataclasses import dataclass

from fecolumn.case import Integration, Motion, Output, Overturn, located, section_table
from fecolumn.rocking.model import TABLES, Model, model_class, model_engine_of
from fecolumn.schema import InputError, Section, build, merge, nested, parameter, stated

#: Tables of a structure of [bodies] that a model of the same file passes over
OF_BODIES = ("bodies", "materials", "interfaces", "links", "contact", "observed", "mesh")


@dataclass(frozen=True, slots=True)
class Start(Section):
    """State at t = 0."""

    tilt_rad: float = parameter(0.0, doc="tilt; 0 starts upright", unit="rad", low=0, high=1.5)
    direction_deg: float = parameter(
        0.0,
        doc="direction towards which the top leans, from x to y",
        unit="deg",
        low=-360,
        high=360,
    )


#: Sections beside the model's own table
COMMON = {
    "integration": Integration,
    "initial": Start,
    "overturn": Overturn,
    "output": Output,
    "motion": Motion,
}


@dataclass(frozen=True, slots=True)
class TableCase:
    """One analysis of a rocking model.

    Of the models' tables one is there, that of integration.engine.
    """

    integration: Integration
    initial: Start
    overturn: Overturn
    output: Output
    title: str = ""
    motion: Motion | None = None
    block: Section | None = None
    frame: Section | None = None
    wobbling: Section | None = None
    wobbling_frame: Section | None = None
    podium: Section | None = None

    @property
    def table(self) -> str:
        """Name of the model's table."""
        return next(name for name in TABLES if getattr(self, name) is not None)

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name everything but title and output cadence; motions
        count by content.
        """
        names = (self.table, *(name for name in COMMON if name != "output"))
        return hashlib.sha256(
            json.dumps(
                {name: section_table(name, getattr(self, name)) for name in names}, sort_keys=True
            ).encode()
        ).hexdigest()[:12]

    def model(self, file) -> Model:
        """The model of the table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        return model_class(self.integration.engine).of_section(getattr(self, self.table), file)

    def replace(self, changes: dict | None = None, **sections) -> TableCase:
        """Case with other values by dotted key, such as {"podium.impact": "CAV"}, checked as a
        file's would be; see `Case.replace`.
        """
        tables = stated(dataclasses.asdict(self))
        for key, value in {**(changes or {}), **sections}.items():
            tables = merge(tables, nested(key, value))
        return table_case(stated(tables), "case")


def table_case(tables: dict, file, engine: str | None = None) -> TableCase:
    """Case from TOML tables that have a model's own; relative paths are taken from the folder of
    `file`.

    Parameters
    ----------
    engine
        name of the model; left out: as `model.model_engine_of` says.

    Raises
    ------
    InputError
        unknown key, value out of range, parts that do not fit.
    """
    engine = engine or model_engine_of(tables, file)
    table = next(name for name, model in TABLES.items() if model == engine)
    structure = "bodies" in tables
    tables = {
        key: value
        for key, value in tables.items()
        if not (structure and key in OF_BODIES or key in TABLES and key != table)
        and value is not False
    }
    # tables by the names of bodies stand beside the model's own keys
    if structure and isinstance(tables.get("initial"), dict):
        tables["initial"] = {
            key: value
            for key, value in tables["initial"].items()
            if value is not False and not isinstance(value, dict)
        }
    section = model_class(engine).SECTION
    for key in tables:
        if key not in COMMON and key not in (table, "title"):
            raise InputError(
                file,
                key,
                None,
                f"unknown key; a case of the model {engine} has title, "
                f"{', '.join([table, *COMMON])}, or is a case of fecolumn run with "
                "[column]",
            )
    if not isinstance(tables.get("title", ""), str):
        raise InputError(file, "title", tables["title"], "must be text in quotes")
    tables["integration"] = {**tables.get("integration", {}), "engine": engine}
    found = {
        name: located(name, build(kind, tables.get(name, {}), file, f"{name}."), file)
        for name, kind in COMMON.items()
        if name != "motion" or "motion" in tables
    }
    if found["output"].fields_every_s:
        raise InputError(
            file,
            "output.fields_every_s",
            found["output"].fields_every_s,
            f"must be 0 where integration.engine = {engine!r}: a rigid model has no fields",
        )
    case = TableCase(
        **found,
        **{table: build(section, tables[table], file, f"{table}.")},
        title=tables.get("title", ""),
    )
    case.model(file)
    return case


def model_key_type(key: str):
    """Type of a dotted key of a model's table, such as podium.storeys, or None."""
    import typing

    table, _, name = key.partition(".")
    kind = (
        typing.get_type_hints(model_class(TABLES[table]).SECTION).get(name)
        if table in TABLES
        else None
    )
    return next((one for one in (kind, *typing.get_args(kind)) if one in (int, float)), kind)
