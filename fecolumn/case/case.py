"""The case: everything one analysis needs, tables by name, validated, hashable by content.

[bodies.column]         [joints.feet]                      [initial.column]
kind = "cylinder"       between = ["column", "ground"]     tilt_rad = 0.05
"""

from __future__ import annotations

import dataclasses
import hashlib
import html
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fecolumn.case.arch import with_arches
from fecolumn.case.bodies import Arch
from fecolumn.case.body_keys import Placed
from fecolumn.case.case_tables import COMMON, NAMED
from fecolumn.case.case_text import case_text, toml_of
from fecolumn.case.changes import changed_tables
from fecolumn.case.check_case import check
from fecolumn.case.given import NUMBERED, as_of_file
from fecolumn.case.ground import GROUND_NAME, Ground
from fecolumn.case.joint import Joint
from fecolumn.case.link import Link
from fecolumn.case.mesh_limits import MeshLimits
from fecolumn.case.order import chosen_by_order
from fecolumn.case.reading import fields_of_tables, told_of
from fecolumn.case.sections import (
    Contact,
    Initial,
    Integration,
    Material,
    Motion,
    Output,
    Overturn,
    section_table,
)
from fecolumn.case.short_form import SECTIONS_ALIKE, ShortForm
from fecolumn.foundation.content import content
from fecolumn.foundation.paths import OF_BODIES as FILES
from fecolumn.foundation.schema import InputError, Section, a_section, table_of
from fecolumn.foundation.toml_file import read_toml, stated

# of which no number depends
_IDLE = ("output", "mesh")


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Case:
    """One analysis: what a TOML file of it says, by the names of its tables.

        fecolumn.Case(
            bodies={"drum": fecolumn.Cylinder(outer_diameter_m=0.5, height_m=1.6)},
            joints={"foot": fecolumn.Joint(between=("drum", "ground"))},
            motion=fecolumn.Motion("lick:1")
        )

    It is checked as a whole where it is made, as a file is. Relative paths are taken from the
    current folder.

    Parameters
    ----------
    bodies
        what moves: Block, Cylinder, Tube, Cone, Plate, Prism, Arch, MeshBody, Storeys, Matrices, by
        names of one's own. A table of keys, {"fixed": True}, says what differs of one voussoir
        "NAME 3" of an Arch "NAME".
    joints
        Joint by name: what stands on what.
    links
        Tendon, Spring, Restrainer, Strut, GapStop, Dashpot, FrictionDamper by name.
    grounds
        Ground by name; left out: "ground", a rigid flat at z = 0.
    materials
        Material by the name that bodies call it by; left out: steel.
    initial
        Initial by the name of a body that leans or moves at the start.
    contact, integration, overturn, output, mesh
        Contact, Integration, Overturn, Output, MeshLimits; left out: their defaults.
    motion
        Motion of the ground, or None for a ground at rest.
    title, observed
        title of figures; body whose top is the analysis' displacement.
    own
        table of a rocking model, such as podium, instead of bodies.
    short
        the form of a column on its base in which the case was stated, a ShortForm.
    arches
        the arches whose voussoirs are among bodies.

    Raises
    ------
    InputError
        names key, value and range, or the parts that do not fit.
    """

    bodies: Mapping[str, Placed] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    joints: Mapping[str, Joint] = field(default_factory=dict)
    links: Mapping[str, Link] = field(default_factory=dict)
    initial: Mapping[str, Initial] = field(default_factory=dict)
    contact: Contact = Contact()
    integration: Integration = Integration()
    overturn: Overturn = Overturn()
    output: Output = Output()
    title: str = ""
    observed: str = ""
    motion: Motion | None = None
    mesh: MeshLimits = MeshLimits()
    grounds: Mapping[str, Ground] = field(default_factory=lambda: {GROUND_NAME: Ground()})
    own: Mapping[str, Section] = field(default_factory=dict)
    short: ShortForm | None = field(default=None, compare=False)
    arches: Mapping[str, Arch] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        """Bring sections that a script gives into the form of those of a file, and check all.

        A section that is not that of the short form makes a case of the full one.
        """
        for name, kind in COMMON.items():
            value = getattr(self, name)
            if not isinstance(value, kind) and not (name == "motion" and value is None):
                raise InputError("case", name, value, f"must be {a_section(kind)}")
        for name in ("title", "observed"):
            if not isinstance(getattr(self, name), str):
                raise InputError("case", name, getattr(self, name), "must be text in quotes")
        if self.short and any(
            getattr(self, name) != getattr(self.short, name) for name in SECTIONS_ALIKE
        ):
            object.__setattr__(self, "short", None)
        for name, sections in as_of_file(self, NAMED).items():
            object.__setattr__(self, name, sections)
        check(self, "case")

    def __eq__(self, other: object) -> bool:
        """Whether both say the same, of grounds and bodies also in an order of the same effect."""
        if not isinstance(other, Case):
            return NotImplemented
        compared = (one.name for one in dataclasses.fields(self) if one.compare)
        return all(
            getattr(self, name) == getattr(other, name) for name in compared
        ) and chosen_by_order(self) == chosen_by_order(other)

    __hash__ = None  # type: ignore[assignment]  # tables by name have none

    def __repr__(self) -> str:
        return case_text(self)

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(case_text(self))}</pre>"

    @staticmethod
    def of_column(form: ShortForm) -> Case:
        """The case of one column on its base, with the sizes that are left open.

        Raises
        ------
        InputError
            parts that do not fit.
        """
        return case_from_tables(form.tables())

    @staticmethod
    def of_model(
        model: Section,
        *,
        motion: Motion | None = None,
        integration: Integration | None = None,
        initial: Initial | None = None,
        overturn: Overturn | None = None,
        output: Output | None = None,
        title: str = "",
    ) -> Case:
        """The case of a rocking model of rigid bodies: a BlockModel, FrameModel, WobblingModel,
        WobblingFrameModel or PodiumModel, which gives the engine.

            fecolumn.Case.of_model(
                fecolumn.BlockModel(width_m=0.3, height_m=1.8), motion=fecolumn.Motion("lick:1")
            )

        Raises
        ------
        InputError
            names key, value and range, or the parts that do not fit.
        """
        from fecolumn.case.model_table import tables_of_model

        sections: dict[str, Section | None] = {
            "motion": motion,
            "integration": integration,
            "initial": initial,
            "overturn": overturn,
            "output": output,
        }
        return case_from_tables(tables_of_model(model, sections, title))

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name everything but title and output cadence; motions and
        meshes count by content, the order of tables where a result depends on it.
        """
        tables: dict[str, Any] = {
            name: {key: identity(section) for key, section in getattr(self, name).items()}
            for name in NAMED
        }
        tables |= {
            name: section and section_table(name, section)  # None of a ground at rest
            for name, section in ((name, getattr(self, name)) for name in COMMON)
            if name not in _IDLE
        }
        if self.grounds == {GROUND_NAME: Ground()}:
            # as of cases that are older than grounds
            del tables["grounds"]
        if self.contact.interior_points is None and len(self.bodies) > 1:
            tables["interior_points"] = self.interior_points  # it was another number before 0.11
        if self.own:
            tables["own"] = {key: section_table("", one) for key, one in self.own.items()}
        tables |= chosen_by_order(self) | {"observed": self.observed}
        text = json.dumps(tables, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:12]

    @property
    def interior_points(self) -> int:
        """Contact points inside a foot whose joint does not state them."""
        return self.contact.points_inside(len(self.bodies))

    @property
    def motions(self) -> tuple[Motion, ...]:
        """All ground motions: that of the case, then those that grounds have of their own."""
        own = (ground.motion for ground in self.grounds.values())
        return tuple(motion for motion in (self.motion, *own) if motion)

    @property
    def n_modes(self) -> int:
        """Elastic modes of a body that does not state its own."""
        return 0 if self.integration.engine == "rigid" else self.integration.n_modes

    def modes_of(self, body: str) -> int:
        """Elastic modes of a body that move with inertia."""
        own = self.bodies[body].modes
        return 0 if self.integration.engine == "rigid" else self.n_modes if own is None else own

    @property
    def found(self) -> tuple[tuple[str, int], ...]:
        """Bodies, each with the number of its copy, whose contact is found while they move."""
        chosen = self.contact.between
        names = self.bodies if chosen == "all" else chosen
        return tuple(dict.fromkeys(one for name in names for one in self.copies_of(name)))

    def names_of(self, name: str) -> tuple[str, ...]:
        """Names of the copies of a body, its own where it is one; or of the bodies that have this
        name and a number, such as the voussoirs of an arch.
        """
        if name not in self.bodies:
            return self._numbered(name)
        copies = self.bodies[name].copies_m
        return (
            tuple(f"{name} {number}" for number in range(1, len(copies) + 1)) if copies else (name,)
        )

    def _numbered(self, name: str) -> tuple[str, ...]:
        return tuple(
            body for body in self.bodies if (own := NUMBERED.fullmatch(body)) and own[1] == name
        )

    def meant_by(self, name: str) -> tuple[str, tuple[int, ...]]:
        """Body and copies, counted from 0, that `name` stands for: "column" for all, "column 2" for
        one.

        Raises
        ------
        KeyError
            none of this name.
        """
        if name in self.bodies:
            return name, tuple(range(len(self.bodies[name].places)))
        body, _, number = name.rpartition(" ")
        if body in self.bodies and name in self.names_of(body):
            return body, (int(number) - 1,)
        raise KeyError(name)

    def is_held(self, name: str) -> bool:
        """Whether `name` is a ground, or a body that a ground holds."""
        return name in self.grounds or all(
            getattr(self.bodies[body], "fixed", False) for body, _ in self.copies_of(name)
        )

    @property
    def copies(self) -> tuple[tuple[str, int], ...]:
        """Every body of a structure and the number of its copy, counted from 0, in the order of the
        case.
        """
        return tuple(one for name in self.bodies for one in self.copies_of(name))

    def copies_of(self, name: str) -> tuple[tuple[str, int], ...]:
        """As `meant_by`, body and number of each copy; of "arch" those of all its voussoirs."""
        bodies = (name not in self.bodies and self._numbered(name)) or (name,)
        meant = (self.meant_by(body) for body in bodies)
        return tuple((body, number) for body, numbers in meant for number in numbers)

    def replace(self, changes: dict[str, Any] | None = None, **sections: Any) -> Case:
        """The case with other values, checked as a file's would be; sizes that followed a column
        follow the new one.

        Parameters
        ----------
        changes
            values by dotted key, such as {"contact.friction_coefficient": 0.5}, of the short form
            where the case was stated in it; None removes a key or a section that may be absent.
        sections
            the same by section, such as contact={"friction_coefficient": 0.5}; title="...".

        Raises
        ------
        InputError
            unknown key, value out of range, parts that do not fit.
        """
        tables = changed_tables(self, {**(changes or {}), **sections})
        return case_from_tables(stated(tables), "case")

    def tables(self, *, defaults: bool = True, arches: bool = True) -> dict[str, Any]:
        """The case as the tables of its file, in the full form, with keys at their `defaults` or
        without; with `arches` as they were stated, or voussoir by voussoir.
        """
        if self.own:
            return self._tables_of_model(defaults)
        found: dict[str, Any] = {}
        for one in dataclasses.fields(self):
            value = getattr(self, one.name)
            if one.name == "bodies" and arches:
                value = with_arches(self.bodies, self.arches)
            if one.name in NAMED:
                value = {
                    key: section if isinstance(section, dict) else table_of(section, defaults)
                    for key, section in value.items()
                }
            elif dataclasses.is_dataclass(value):
                value = table_of(value, defaults)
            if one.name not in ("own", "short", "arches") and value not in (None, {}, ""):
                found[one.name] = value
        return found

    def _tables_of_model(self, defaults: bool) -> dict[str, Any]:
        """As `tables`, of a case with a rocking model's own table."""
        from fecolumn.case.model_table import Start, tables_of_model

        ((name, model),) = self.own.items()
        at_start = self.initial[name]
        sections: dict[str, Section | None] = {
            "integration": self.integration,
            "overturn": self.overturn,
            "output": self.output,
            "motion": self.motion,
            "initial": Start(tilt_rad=at_start.tilt_rad, direction_deg=at_start.direction_deg),
        }
        return tables_of_model(model, sections, self.title, defaults)

    def to_toml(self, *, full: bool = False, defaults: bool = False) -> str:
        """Text of a TOML file of this case, in the form that it was stated in.

        Parameters
        ----------
        full
            body by body, as of `fecolumn show`, where it was stated as a column on its base.
        defaults
            with keys at their defaults.
        """
        return toml_of(self, full, defaults)

    def as_stated(self) -> dict[str, Any]:
        """The case as the tables of its file, in the form that it was stated in."""
        return self.short.tables() if self.short else self.tables()


def case_from_tables(tables: dict[str, Any], file: Path | str = "case") -> Case:
    """Case from TOML tables; relative paths are taken from the folder of `file`, which messages
    name, or from the current one.

    Parameters
    ----------
    tables
        keys and values by table, as `tomllib` reads them; units are those of the manual's page
        keys. Tables with [column] are a short form, as of ShortForm.
    file
        by which messages name the case.

    Returns
    -------
    Case, checked.

    Raises
    ------
    InputError
        unknown key, wrong type, value out of range, or parts that do not fit.
    """
    from fecolumn.case.model_names import TABLES, model_engine_of

    if not isinstance(tables, dict):
        raise InputError(file, "", None, f"must be tables of keys, not {type(tables).__name__}")
    if model_engine_of(tables, file):
        return case_of_table(tables, file)
    if not TABLES.keys().isdisjoint(tables):
        from fecolumn.case.model_table import check_others

        check_others(tables, file)
    found, named = fields_of_tables(
        {key: table for key, table in tables.items() if key not in TABLES}, file
    )
    return told_of(file, lambda: Case(**found), named)


def case_of_table(tables: dict[str, Any], file: Path | str, engine: str | None = None) -> Case:
    """Case of the rocking model of a table of its own, such as [podium]; engine: its name, unless
    the table says it.

    Raises
    ------
    InputError
        unknown key, value out of range, parts that do not fit.
    """
    from fecolumn.case.model_table import fields_of_table

    return Case(**fields_of_table(tables, file, engine))


def load_case(path: Path | str) -> Case:
    """Case of a TOML file.

    Raises
    ------
    InputError
        missing file, bad TOML, unknown key, value out of range, parts that do not fit.
    """
    if not isinstance(path, (str, os.PathLike)):
        told = "must be the path of a TOML file; case_from_tables makes a Case of tables"
        raise InputError("load_case", "path", path, told)
    return case_from_tables(read_toml(path), path)


def identity(section: Section) -> dict[str, Any]:
    """What of a section tells one analysis from another, files by content."""
    table = section_table("", section)
    for key in FILES.get(table.get("kind", ""), ()):
        table[key] = content(table[key])
    if motion := getattr(section, "motion", None):  # of a ground
        table["motion"] = section_table("motion", motion)
    if between := table.pop("between", None):  # of a joint: by the names of earlier versions
        table |= {"slave": between[0], "on": between[1]}
    return table
