"""The short form of a case: one column on its base, and how it becomes bodies, grounds and joints.

    [column]  [flange]  [cap]  [mesh]  ->  [bodies.column]
    [material]                         ->  [materials.column]
    [base]                             ->  [grounds.ground]
    [initial]                          ->  [initial.column]

`fecolumn show CASE.toml` prints the full form, which runs to the same digits.
"""

from __future__ import annotations

import dataclasses
import re
import warnings
from pathlib import Path
from typing import Any, ClassVar

from fecolumn.case import sizes
from fecolumn.case.check_grounds import OF_KINDS, SIZES
from fecolumn.case.check_thin import check_thin_column
from fecolumn.case.checked import refuse_in
from fecolumn.case.column_keys import Base, Column, ColumnSections, MeshSizes
from fecolumn.case.model_keys import check_model
from fecolumn.case.sections import (
    MODEL_ENGINES,
    Cap,
    Contact,
    Flange,
    Initial,
    Integration,
    Material,
    Motion,
    Output,
    Overturn,
    located,
)
from fecolumn.foundation.paths import OF_SECTIONS as FILES
from fecolumn.foundation.schema import InputError, build, parameter
from fecolumn.foundation.section_class import section_class
from fecolumn.foundation.toml_file import merge, nested, stated
from fecolumn.mesh.outline import is_solid


@section_class()
class ShortForm(ColumnSections):
    """A case of one column on its base: a file with a table [column].

    fecolumn.Case.of_column(
        fecolumn.ShortForm(
            column=fecolumn.Column(shape="solid", outer_diameter_m=0.5, height_m=1.6),
            motion=fecolumn.Motion("lick:1"),
        )
    )
    """

    column: Column
    base: Base = Base()
    material: Material = Material()
    mesh: MeshSizes = MeshSizes()
    contact: Contact = Contact()
    integration: Integration = Integration()
    initial: Initial = Initial()
    overturn: Overturn = Overturn()
    output: Output = Output()
    title: str = parameter("", doc="title of figures")
    cap: Cap | None = None
    motion: Motion | None = None
    flange: Flange | None = None

    SECTION: ClassVar[str] = ""  # messages name the sections in it

    def tables(self, *, opened: bool = False) -> dict[str, Any]:
        """The tables of its file; `opened`: without those sizes that it would be given anyway, so
        that another column gets its own.
        """
        return stated(dataclasses.asdict(sizes.opened(self) if opened else self))


def short_form(tables: dict[str, Any], file: Path | str) -> ShortForm:
    """The short form of TOML tables with [column], all sizes known; relative paths are taken from
    the folder of `file`.

    Raises
    ------
    InputError
        unknown or missing key, wrong type, value out of range, parts that do not fit.
    """
    for name in _OF_FULL_FORM:
        if tables.get(name, False) is not False:
            told = "is of the full form, in which fecolumn show writes this case: state it there"
            raise InputError(file, name, None, told)
    form: ShortForm = build(ShortForm, tables, file)
    return finished(
        dataclasses.replace(
            form, **{name: located(name, getattr(form, name), file) for name in FILES}
        ),
        file,
    )


# Tables of the full form alone
_OF_FULL_FORM = "materials", "grounds", "joints", "links"


def finished(case: ShortForm, file: Path | str) -> ShortForm:
    """The case with the sizes that it leaves open, checked as a whole.

    Raises
    ------
    InputError
        as of `load_case`.
    """
    sizes.check_shape(case, file)
    check_thin_column(case, refuse_in(file))
    case = sizes.with_sizes(case)
    _tell_of_idle(case, file)
    sizes.check_sizes(case, file)
    check_model(case, MODEL_ENGINES, refuse_in(file))
    return case


# Keys of which nothing may depend where column.mesh_file gives the column
_IDLE = {"column": ("wall_m", "fine_height_m"), "mesh": ("coarse_size_m", "cap_size_m")}


def _tell_of_idle(case: ShortForm, file: Path | str) -> None:
    """Warn of sizes that a case with a mesh of its own states, perhaps with what it `extends`, and
    that change nothing.
    """
    for name, keys in _IDLE.items() if case.column.mesh_file else ():
        for key in keys:
            section = getattr(case, name)
            left_out = dataclasses.replace(section, **{key: None})
            other = sizes.with_sizes(dataclasses.replace(case, **{name: left_out}))
            value = getattr(section, key)
            if value != getattr(getattr(other, name), key) and full_tables(other) == full_tables(
                case
            ):
                told = (
                    f"{file}: {name}.{key} = {value} says nothing of the mesh in column.mesh_file"
                )
                warnings.warn(f"{told}: leave it out", stacklevel=2)


#: Keys of the short form and where they stand in the full one.
PLACES = {
    "column.outer_diameter_m": "bodies.column.outer_diameter_m",
    "column.height_m": "bodies.column.height_m",
    "column.wall_m": "bodies.column.wall_m",
    "column.fine_height_m": "bodies.column.fine_height_m",
    "column.mesh_file": "bodies.column.mesh_file",
    "column.mesh_unit": "bodies.column.mesh_unit",
    "column.mesh_size_m": "bodies.column.mesh_size_m",
    "column.cut_foot_m": "bodies.column.cut_foot_m",
    "column.length_m": "bodies.column.length_m",
    "column.width_m": "bodies.column.width_m",
    "flange": "bodies.column.flange",
    "cap": "bodies.column.cap",
    "mesh.fine_size_m": "bodies.column.element_size_m",
    "mesh.coarse_size_m": "bodies.column.coarse_size_m",
    "mesh.cap_size_m": "bodies.column.cap_size_m",
    "mesh.element_order": "bodies.column.element_order",
    "mesh.base_size_m": "grounds.ground.coarse_size_m",
    "mesh.limit_dofs": "mesh.limit_dofs",
    "material": "materials.column",
    "base": "grounds.ground",
    "initial": "initial.column",
}
#: Sections that stand in both forms alike
SECTIONS_ALIKE = ("contact", "integration", "overturn", "output", "motion", "title")


def full_tables(form: ShortForm) -> dict[str, Any]:
    """Tables of the full form of a short one: a body, a material, a ground and a joint."""
    short = form.tables()
    column = short["column"]
    own = bool(column.get("mesh_file"))
    solid = not own and form.column.shape != "block" and is_solid(form.column)
    kind = "mesh" if own else "block" if form.column.shape == "block" else "tube"
    kind = "cylinder" if solid else kind
    idle = {
        "mesh": ("outer_diameter_m", "height_m", "wall_m", "fine_height_m"),
        "cylinder": ("wall_m",),
    }
    full = {name: short[name] for name in SECTIONS_ALIKE if name in short}
    for place, other in PLACES.items():
        name, _, key = place.partition(".")
        value = short.get(name) if not key else short.get(name, {}).get(key)
        if value in (None, "") or name == "column" and key in idle.get(kind, ()):
            continue
        if own and place in ("mesh.coarse_size_m",) or place == "mesh.cap_size_m" and not form.cap:
            continue
        full = merge(full, nested(other, value))
    full["bodies"]["column"] |= {"kind": kind, "material": "column"}
    if own:  # its foot at the origin, wherever its file has it
        full["bodies"]["column"]["at_m"] = [0.0, 0.0, 0.0]
    ground = full["grounds"]["ground"] | {"element_size_m": form.mesh.fine_size_m}
    full["grounds"]["ground"] = {
        key: value
        for key, value in ground.items()
        if key not in SIZES or form.base.kind in OF_KINDS[key]
    }
    full["joints"] = {"foot": {"between": ["column", "ground"]}}
    return full


def in_short_form(text: str) -> str:
    """A dotted key of the full form of a column, such as "bodies.column.height_m", or a text with
    some, as the short one says it; keys that stand alike in both stay.
    """
    for place, other in PLACES.items():
        text = re.sub(rf"(?<![\w.]){re.escape(other)}(?!\w)", place, text)
    return text
