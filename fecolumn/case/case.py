"""The case: everything one analysis needs, tables by name, validated, hashable by content.

[bodies.column]         [joints.feet]                      [initial.column]
kind = "cylinder"       between = ["column", "ground"]     tilt_rad = 0.05
"""

from __future__ import annotations

import dataclasses
import hashlib
import html
import json
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from fecolumn.case.arch import own_keys, voussoirs, with_voussoirs, without_voussoirs
from fecolumn.case.bodies import (
    GROUND,
    KINDS,
    Arch,
    Ground,
    Interface,
    LinkKeys,
    MeshLimits,
    Placed,
    Storeys,
)
from fecolumn.case.case_text import case_text, toml_of
from fecolumn.case.check_found import check_found
from fecolumn.case.check_grounds import check_grounds
from fecolumn.case.given import NUMBERED, as_of_file, by_two_bodies, check_name, with_files
from fecolumn.case.sections import (
    DEFAULT,
    FULL_ORDER_KEYS,
    MODEL_ENGINES,
    MOST_STEPS,
    Contact,
    Initial,
    Integration,
    Material,
    Motion,
    Output,
    Overturn,
    located,
    section_table,
)
from fecolumn.case.short_form import ALIKE, ShortForm, full_tables, in_short_form, short_form
from fecolumn.foundation.content import content
from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.foundation.paths import OF_BODIES as FILES
from fecolumn.foundation.schema import (
    InputError,
    Section,
    a_section,
    build,
    meant,
    merge,
    nested,
    read_toml,
    stated,
    table_of,
)

#: Tables of tables by name, and the class of each.
NAMED = {
    "bodies": Placed,
    "materials": Material,
    "grounds": Ground,
    "joints": Interface,
    "links": LinkKeys,
    "initial": Initial,
}
#: Sections that a structure's case has in common with a column's.
COMMON = {
    "contact": Contact,
    "integration": Integration,
    "motion": Motion,
    "overturn": Overturn,
    "output": Output,
    "mesh": MeshLimits,
}
# of which no number depends
_IDLE = ("output", "mesh")
# Displacement [m] that no body has overturned at: any moves by more
_LEAST_WAY = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Case:
    """One analysis: what a TOML file of it says, by the names of its tables.

        fecolumn.Case(
            bodies={"drum": fecolumn.Cylinder(outer_diameter_m=0.5, height_m=1.6)},
            joints={"foot": fecolumn.Joint(between=("drum", "ground"))},
            motion=fecolumn.Motion("lick:1"),
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
        Tendon, Spring, Restrainer, Strut, Stop, Dashpot, FrictionDamper by name.
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
        the form of a column on its base in which the case was stated, see ShortForm.
    arches
        the arches whose voussoirs are among bodies.

    Raises
    ------
    InputError
        names key, value and range, or the parts that do not fit.
    """

    bodies: Mapping[str, Placed] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    joints: Mapping[str, Interface] = field(default_factory=dict)
    links: Mapping[str, LinkKeys] = field(default_factory=dict)
    initial: Mapping[str, Initial] = field(default_factory=dict)
    contact: Contact = Contact()
    integration: Integration = Integration()
    overturn: Overturn = Overturn()
    output: Output = Output()
    title: str = ""
    observed: str = ""
    motion: Motion | None = None
    mesh: MeshLimits = MeshLimits()
    grounds: Mapping[str, Ground] = field(default_factory=lambda: {GROUND: Ground()})
    own: Mapping[str, Section] = field(default_factory=dict)
    short: ShortForm | None = field(default=None, compare=False)
    arches: Mapping[str, Arch] = field(default_factory=dict, compare=False)

    def __post_init__(self):
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
        if self.short and any(getattr(self, name) != getattr(self.short, name) for name in ALIKE):
            object.__setattr__(self, "short", None)
        for name, sections in as_of_file(self, NAMED).items():
            object.__setattr__(self, name, sections)
        check(self, "case")

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

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name everything but title and output cadence; motions and
        meshes count by content.
        """
        tables = {
            name: {key: identity(section) for key, section in getattr(self, name).items()}
            for name in NAMED
        }
        tables |= {
            name: section_table(name, getattr(self, name)) for name in COMMON if name not in _IDLE
        }
        if self.grounds == {GROUND: Ground()}:
            # as of cases that are older than grounds
            del tables["grounds"]
        if self.own:
            tables["own"] = {key: section_table("", one) for key, one in self.own.items()}
        text = json.dumps(tables | {"observed": self.observed}, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:12]

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

    def copies_of(self, name: str) -> tuple[tuple[str, int], ...]:
        """As `meant_by`, body and number of each copy; of "arch" those of all its voussoirs."""
        bodies = (name not in self.bodies and self._numbered(name)) or (name,)
        meant = (self.meant_by(body) for body in bodies)
        return tuple((body, number) for body, numbers in meant for number in numbers)

    def replace(self, changes: dict | None = None, **sections) -> Case:
        """The case with other values, checked as a file's would be; sizes that followed a column
        follow the new one.

        Parameters
        ----------
        changes
            values by dotted key, such as {"contact.friction_coefficient": 0.5}, of the short form
            where the case was stated in it; None removes a section that may be absent.
        sections
            the same by section, such as contact={"friction_coefficient": 0.5}; title="...".

        Raises
        ------
        InputError
            unknown key, value out of range, parts that do not fit.
        """
        changes = {
            _of_this_version(key): one for key, one in {**(changes or {}), **sections}.items()
        }
        full = self.short is None or any(_is_full(key, value) for key, value in changes.items())
        tables = self.tables() if full else self.short.tables(opened=True)
        for key, value in changes.items():
            if value is None:
                tables.pop(key, None)
            else:
                tables = merge(tables, nested(key, value))
        return case_from_tables(stated(tables), "case")

    def tables(self, defaults: bool = True, arches: bool = True) -> dict:
        """The case as the tables of its file, in the full form, with keys at their `defaults` or
        without; with `arches` as they were stated, or voussoir by voussoir.
        """
        if self.own:
            return self._tables_of_model(defaults)
        found = {}
        for one in dataclasses.fields(self):
            value = getattr(self, one.name)
            if one.name == "bodies" and arches:
                value = self._with_arches()
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

    def _with_arches(self) -> dict[str, typing.Any]:
        """Bodies with an arch in the place of its voussoirs, where they are still those of it, and
        after it the keys of voussoirs that have some of their own.
        """
        found: dict[str, typing.Any] = dict(self.bodies)
        for name, arch in self.arches.items():
            made = voussoirs(name, arch)
            own = {key: own_keys(found.get(key), body) for key, body in made.items()}
            if None not in own.values():
                own = {key: table for key, table in own.items() if table}
                first, before, found = next(iter(made)), found, {}
                for key, body in before.items():
                    if key == first:
                        found |= {name: arch} | own
                    elif key not in made:
                        found[key] = body
        return found

    def _tables_of_model(self, defaults: bool) -> dict:
        """As `tables`, of a case with a rocking model's own table."""
        ((name, section),) = self.own.items()
        start = self.initial[name]
        found = {
            name: section,
            "integration": self.integration,
            "overturn": self.overturn,
            "output": self.output,
        } | ({"motion": self.motion} if self.motion else {})
        found = {key: table_of(one, defaults) for key, one in found.items()}
        tilt = {"tilt_rad": start.tilt_rad, "direction_deg": start.direction_deg}
        found["initial"] = {key: value for key, value in tilt.items() if value or defaults}
        return found | ({"title": self.title} if self.title else {})

    def to_toml(self, full: bool = False, defaults: bool = False) -> str:
        """Text of a TOML file of this case, in the form that it was stated in.

        Parameters
        ----------
        full
            body by body, as of `fecolumn show`, where it was stated as a column on its base.
        defaults
            with keys at their defaults.
        """
        return toml_of(self, full, defaults)

    def as_stated(self) -> dict:
        """The case as the tables of its file, in the form that it was stated in."""
        return self.short.tables() if self.short else self.tables()


def _of_this_version(key: str) -> str:
    """A dotted key of earlier versions by its name in this one."""
    first, dot, rest = key.partition(".")
    if first != "interfaces":
        return key
    newer = f"joints{dot}{rest}"
    warn_of_older_name("case", key, newer)
    return newer


def _is_full(key: str, value) -> bool:
    """Whether a dotted key, or a table of this name, is of the full form alone."""
    first, _, rest = key.partition(".")
    if first == "initial":
        return (
            "." in rest
            or isinstance(value, dict)
            and any(isinstance(v, dict) for v in value.values())
        )
    return first in NAMED or first == "observed"


def case_from_tables(tables: dict, file="case") -> Case:
    """Case from TOML tables; relative paths are taken from the folder of `file`, which messages
    name, or from the current one.

    Tables with [column] are a short form, see `fecolumn.case.short_form`.
    """
    from fecolumn.case.model_names import TABLES, model_engine_of

    if not isinstance(tables, dict):
        raise InputError(file, "", None, f"must be tables of keys, not {type(tables).__name__}")
    if model_engine_of(tables, file):
        return case_of_table(tables, file)
    case = structure_from_tables(
        {key: table for key, table in tables.items() if key not in TABLES}, file
    )
    if case.integration.engine in MODEL_ENGINES and not case.short:
        from fecolumn.engines.rocking.of_bodies import model_of, start_of

        model_of(case, file)
        start_of(case, file)
    return case


def case_of_table(tables: dict, file, engine: str | None = None) -> Case:
    """Case of the rocking model of a table of its own, such as [podium]; engine: its name, unless
    the table says it.

    Raises
    ------
    InputError
        unknown key, value out of range, parts that do not fit.
    """
    from fecolumn.case.model_table import fields_of_table

    return Case(**fields_of_table(tables, file, engine))


def read_case(path) -> Case:
    """Case of a TOML file.

    Raises
    ------
    InputError
        missing file, bad TOML, unknown key, value out of range, parts that do not fit.
    """
    return case_from_tables(read_toml(path), path)


def check_duration(case: Case, file) -> None:
    """Refuse to analyse a case that does not say for how long; its mesh may still be looked at."""
    if case.motion is None and case.integration.duration_s == 0:
        raise InputError(
            file,
            "integration.duration_s",
            0,
            "must be greater than 0 s where the case has no motion",
        )


def identity(section) -> dict:
    """What of a section tells one analysis from another, files by content."""
    table = section_table("", section)
    for key in FILES.get(table.get("kind", ""), ()):
        table[key] = content(table[key])
    table.pop("between", None)  # a joint is told by slave and on, whichever way it was written
    return table


def structure_from_tables(tables: dict, file) -> Case:
    """Case of a structure from TOML tables; relative paths are taken from the folder of `file`.

    Raises
    ------
    InputError
        every unknown or missing key, wrong type and value out of range, told at once; or parts that
        do not fit.
    """
    if "column" in tables and "bodies" in tables:
        raise InputError(
            file,
            "bodies",
            None,
            "stands beside [column], the short form of a case of one body; describe the column in "
            "[bodies], too: fecolumn show writes it so",
        )
    if "column" in tables:
        return _of_short_form(tables, file)
    if "interfaces" in tables:
        return _of_interfaces(tables, file)
    tables, errors, found = stated(tables), [], {}
    if not tables.get("grounds"):
        tables = tables | {"grounds": {GROUND: {}}}
    grounds = set(tables["grounds"]) if isinstance(tables["grounds"], dict) else {GROUND}
    for key in tables:
        if key not in NAMED and key not in COMMON and key not in ("title", "observed"):
            errors.append(
                InputError(
                    file,
                    key,
                    None,
                    f"says nothing of a structure of [bodies]{meant(key, [*NAMED, *COMMON])}; "
                    f"its tables: {', '.join([*NAMED, *COMMON])}",
                )
            )
    bodies, own = without_voussoirs(tables.get("bodies", {}))
    tables = tables | {"bodies": bodies}
    for name, kind in NAMED.items():
        found[name] = _named(name, kind, tables.get(name, {}), grounds, file, errors)
    for name, kind in COMMON.items():
        table = tables.get(name, False)
        try:
            if name != "motion" or table is not False:
                found[name] = located(
                    name, build(kind, {} if table is False else table, file, f"{name}."), file
                )
        except InputError as error:
            errors.append(error)
    for key in ("title", "observed"):
        found[key] = tables.get(key, "")
        if not isinstance(found[key], str):
            errors.append(InputError(file, key, found[key], "must be text in quotes"))
    try:
        found["bodies"], found["arches"] = with_voussoirs(found["bodies"], own, file)
    except InputError as error:
        errors.append(error)
    if errors:
        raise InputError.of_several(errors)
    return _told_of(file, lambda: Case(**found))


def _told_of(file, made: Callable[[], Case], named: Callable[[str], str] = str) -> Case:
    """What `made` returns; its errors are told of `file`, with keys and ranges as `named` says."""
    try:
        return made()
    except InputError as error:
        raise InputError.of_several(
            [InputError(file, named(one.key), one.value, named(one.allowed)) for one in error.all]
        ) from None


def _of_short_form(tables: dict, file) -> Case:
    """Case of TOML tables with [column]; messages name the keys of the short form."""
    form = short_form(tables, file)
    case = _told_of(file, lambda: structure_from_tables(full_tables(form), file), in_short_form)
    return dataclasses.replace(case, short=form)


def _of_interfaces(tables: dict, file) -> Case:
    """Case of TOML tables with [interfaces], the name of [joints] in earlier versions, by which
    messages call them.
    """
    older, joints = tables["interfaces"], tables.get("joints", {})
    if not isinstance(older, dict) or not isinstance(joints, dict):
        raise InputError(file, "joints", joints or older, "must hold tables by name")
    if twice := set(joints) & set(older):
        key = f"joints.{min(twice)}"
        raise InputError(file, key, None, "stands in [interfaces], too: give it once")
    warn_of_older_name(str(file), "[interfaces]", "[joints]")
    others = {name: table for name, table in tables.items() if name != "interfaces"}

    def named(text: str) -> str:
        for name in older:
            text = text.replace(f"joints.{name}", f"interfaces.{name}")
        return text

    return _told_of(
        file, lambda: structure_from_tables(others | {"joints": older | joints}, file), named
    )


def _named(name: str, kind, tables, grounds: set, file, errors: list) -> dict:
    """Sections by name of one table of tables; grounds: names that no body can have."""
    if not isinstance(tables, dict):
        errors.append(
            InputError(file, name, tables, f"must hold tables by name, such as [{name}.NAME]")
        )
        return {}
    found = {}
    for key, table in tables.items():
        if table is False:
            continue
        try:
            if not isinstance(table, dict):
                raise InputError(
                    file, f"{name}.{key}", table, f"must be a table [{name}.NAME] of keys"
                )
            check_name(name, key, tables, grounds, file)
            found[key] = _built(
                _kind_of(name, key, table, kind, file), table, file, f"{name}.{key}."
            )
            if name == "joints":
                found[key] = by_two_bodies(found[key], grounds, file, f"{name}.{key}.")
        except InputError as error:
            errors.append(error)
    return found


def _kind_of(name: str, key: str, table: dict, kind, file):
    """Class of a section: of a body that of its kind."""
    if name != "bodies":
        return kind
    word = table.get("kind")
    if not isinstance(word, str) or word not in KINDS:
        raise InputError(
            file,
            f"{name}.{key}.kind",
            word,
            f"{'missing; ' if word is None else ''}must be one of {', '.join(KINDS)}",
        )
    return KINDS[word]


def _built(kind, table, file, prefix):
    """A section with its relative paths taken from the folder of `file`."""
    section = build(kind, table, file, prefix)
    if kind is Ground and section.motion:
        return dataclasses.replace(section, motion=located("motion", section.motion, file))
    return with_files(section, file, prefix)


def check(case: Case, file) -> None:
    """What no single key can know: names that tables use of one another, and keys of which only one
    may stand.
    """
    from fecolumn.case.check_bodies import check_body
    from fecolumn.case.check_bond import check_bond
    from fecolumn.case.check_link import check_link
    from fecolumn.case.check_step import check_step

    def refuse(key, value, allowed):
        raise InputError(file, key, value, allowed)

    if 0 < (cap := case.overturn.displacement_m) < _LEAST_WAY:
        told = f"must be 0 for none, or at least {_LEAST_WAY:g} m: less is no overturning"
        refuse("overturn.displacement_m", cap, told)
    if case.own:  # checked by the model
        return
    check_step(case.integration, refuse)
    if not case.bodies:
        refuse("bodies", None, "missing; a structure needs a table [bodies.NAME] at least")
    for name, body in case.bodies.items():
        check_body(f"bodies.{name}", body, case.materials, refuse)
        ground = getattr(body, "moves_with", "")
        if ground and ground not in case.grounds:
            known = ", ".join(case.grounds)
            refuse(f"bodies.{name}.moves_with", ground, f"no such ground; known: {known}")
    if case.bodies and all(getattr(body, "fixed", False) for body in case.bodies.values()):
        refuse(f"bodies.{name}.fixed", True, "must be false of one body at least: nothing moves")
    if not case.joints and not case.contact.between:
        refuse(
            "joints",
            None,
            "missing; a structure needs a table [joints.NAME] at least, for what "
            "stands on the ground",
        )
    for name, interface in case.joints.items():
        _check_name(case, f"joints.{name}", interface.slave, refuse, ground=False)
        _check_name(case, f"joints.{name}", interface.on, refuse)
        if all(case.is_held(one) for one in (interface.slave, interface.on)):
            told = f'"{interface.slave}" and "{interface.on}" are both fixed'
            refuse(f"joints.{name}", None, f"must name a body that moves: {told}")
        own = interface.friction_coefficient
        friction = case.contact.friction_coefficient if own is None else own
        check_bond(f"joints.{name}", interface, friction, refuse)
    for name, link in case.links.items():
        _check_name(case, f"links.{name}.body", link.body, refuse, ground=False)
        _check_name(case, f"links.{name}.to", link.to, refuse)
        check_link(f"links.{name}", link, refuse)
        if case.is_held(link.body) and case.is_held(link.to):
            told = f'"{link.body}" and "{link.to}" are both fixed'
            refuse(f"links.{name}", None, f"must hold a body that moves: {told}")
        if len({body for body, _ in case.copies_of(link.body)}) > 1:
            refuse(
                f"links.{name}.body",
                link.body,
                f'must be one body, such as "{case.names_of(link.body)[0]}"',
            )
        if link.to not in case.grounds and len(case.copies_of(link.to)) > 1:
            refuse(
                f"links.{name}.to",
                link.to,
                f'must be one of its copies, such as "{case.names_of(link.to)[0]}"',
            )
        if link.to not in case.grounds and case.copies_of(link.to)[0] in case.copies_of(link.body):
            refuse(
                f"links.{name}.to",
                link.to,
                f'must be another body than links.{name}.body = "{link.body}": a link '
                "from a body to itself does nothing",
            )
    for name, start in case.initial.items():
        _check_name(case, f"initial.{name}", name, refuse, ground=False)
        if case.is_held(name):
            refuse(f"initial.{name}", None, f'must be left out: "{name}" is fixed')
        for key in ("velocity_m_s", "spin_rad_s"):
            if len(value := getattr(start, key)) != 3:
                refuse(f"initial.{name}.{key}", list(value), "must be three numbers: x, y, z")
    if case.observed:
        body = case.observed.partition(".")[0]
        _check_name(case, "observed", body, refuse, ground=False)
        if getattr(case.bodies[case.copies_of(body)[0][0]], "fixed", False):
            refuse("observed", case.observed, "must be a body that moves: this one is fixed")
        if len(case.copies_of(body)) > 1:
            refuse(
                "observed",
                case.observed,
                f'must be one of its copies, such as "{case.names_of(body)[0]}"',
            )
    for name, body in case.bodies.items():
        if isinstance(body, Storeys) and not case.modes_of(name):
            key, value = (
                ("integration.engine", "rigid")
                if case.integration.engine == "rigid"
                else (f"bodies.{name}.modes", 0)
            )
            refuse(
                key,
                value,
                f'leaves the storeys of "{name}" their springs and no inertia: choose '
                f'integration.engine = "reduced" with modes, of which {2 * body.floors} '
                "are all",
            )
    check_grounds(case, refuse)
    check_found(case, refuse, lambda key, name: _check_name(case, key, name, refuse, ground=False))
    _check_integration(case, refuse)


def _check_name(case, key: str, name: str, refuse, ground: bool = True) -> None:
    if ground and name in case.grounds:
        return
    try:
        case.copies_of(name)
    except KeyError:
        known = (
            list(case.grounds) * ground
            + list(case.arches)
            + list(case.bodies)
            + [copy for body in case.bodies for copy in case.names_of(body) if copy != body]
        )
        what = "body or ground" if ground else "body"
        refuse(key, name, f"no such {what}{meant(name, known)}; known: {', '.join(known)}")


def _check_integration(case, refuse) -> None:
    from fecolumn.case.check_full import check_full

    plan = case.integration
    if plan.engine == "full":
        check_full(case, refuse)
    for section, key, needed in (
        ("integration", "kinematics", "corotated"),
        ("contact", "impact", "plastic"),
    ):
        value = getattr(getattr(case, section), key)
        if plan.engine != "full" and value != needed:
            refuse(
                f"{section}.{key}",
                value,
                f"must be {needed} where integration.engine = {plan.engine!r}",
            )
    for key in FULL_ORDER_KEYS if plan.engine != "full" else ():
        if (value := getattr(plan, key)) != DEFAULT[key]:
            refuse(
                f"integration.{key}",
                value,
                f"has no effect where integration.engine = {plan.engine!r}: leave it out",
            )
    time = plan.duration_s or (
        case.motion.delay_s + case.motion.longest_free_vibration_s if case.motion else 0.0
    )
    if time / plan.shortest_s > MOST_STEPS:
        refuse(
            "integration.dt_s",
            plan.dt_s,
            f"must be at least {time / MOST_STEPS:g} s: more than {MOST_STEPS:.0e} "
            f"steps in {time:g} s",
        )
    if case.motion and (len(part := case.motion.strong_part) != 2 or not part[0] < part[1]):
        refuse("motion.strong_part", list(part), "must be two rising fractions in [0, 1]")


def type_of(key: str):
    """Type of a dotted key of a structure's case, whatever its bodies are called, or None:
    "bodies.slab.length_m" is a float.
    """
    head, _, last = _of_this_version(key).rpartition(".")
    name = head.partition(".")[0]
    classes = set(KINDS.values()) if name == "bodies" else {NAMED[name]} if name in NAMED else set()
    hints = {
        field: kind for section in classes for field, kind in typing.get_type_hints(section).items()
    }
    kind = hints.get(last) if head.count(".") == 1 else None
    return next((one for one in (kind, *typing.get_args(kind)) if one in (int, float)), kind)
