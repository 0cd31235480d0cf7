"""The four structures: as cases of the package, as rigid bodies for the other programs, and their
motions.

tube: the specimen of `benchmarks/coarse_specimen.toml` on a rigid ground, shaken along x and y by
the Lick ensemble as it is. block, drums, trilith: rectangles of `benchmarks.planar` that are shaken
in their plane, along x, by x of the same motions as `planar.ensembles` scales them, so that the
planar program can judge.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.planar import ensembles, package, structures, theory
from benchmarks.planar.bodies import GRAVITY
from benchmarks.planar.shaken import Shaken

#: Motions of the ensemble
MOTIONS = 115
NAMES = ("tube", "block", "drums", "trilith")
#: Width and height of the block [m]
MONOLITH = (0.4, 1.2)
#: Tilt at which a body has overturned [rad]
OVERTURNED = math.pi / 4
#: Free vibration after a motion of the tube [s]; the others have that of `benchmarks.planar`
_REST_OF_TUBE = 0.5
SPECIMEN = Path(__file__).parents[1] / "coarse_specimen.toml"
#: Elements across a face of elastic bodies, Young's modulus [Pa] of granite
_ACROSS, _GRANITE = 4, 50e9
#: Sampling of the motions [s], joined by lines whatever the step: of the plane, of the tube
_SAMPLED, _SAMPLED_TUBE = 0.01, 2e-3


@dataclass(frozen=True)
class RigidBodies:
    """Bodies that do not deform, standing on the plane z = 0, as a program of rigid bodies has
    them.

    Attributes
    ----------
    kinds
        of each: "box" or "cylinder".
    sizes
        (nb, 3) half sides, or radius, half height and 0 [m].
    mass, inertia
        (nb,) [kg], (nb, 3) about the axes through the centre of mass [kg m2].
    place
        (nb, 3) of the centres of mass [m].
    middle
        (nb, 3) of the middle of box or cylinder from the centre of mass [m].
    observed, top
        number of the body whose top is watched, and that point from its centre of mass (3,) [m].
    friction
        coefficient of all joints.
    barrier
        energy that overturns the whole slowly [J].
    critical
        tilt of a body from which it does not come back without a push [rad].
    """

    kinds: tuple[str, ...]
    sizes: np.ndarray
    mass: np.ndarray
    inertia: np.ndarray
    place: np.ndarray
    middle: np.ndarray
    observed: int
    top: np.ndarray
    friction: float
    barrier: float
    critical: float


@functools.cache
def planar_of(name: str) -> Shaken:
    """A structure of the plane, and how strongly it is shaken."""
    width, height = MONOLITH
    if name == "block":
        return Shaken(
            structures.stack([MONOLITH]),
            GRAVITY * width / height,
            3.5,
            1,
            MOTIONS,
            theory.displaced_block(width, height),
        )
    return ensembles.shaken()[{"drums": "five drums"}.get(name, name)]


def rest_of(name: str) -> float:
    """Free vibration after a motion [s]."""
    return _REST_OF_TUBE if name == "tube" else ensembles.REST


def case_tables(name: str, engine: str, dt: float) -> dict:
    """Tables of the case of a structure, without its motion.

    engine: "rigid": bodies that do not deform and touch at their corners, the tube at the nodes of
    its rim; others: elastic bodies on meshes of their own.
    """
    if name == "tube":
        return _tube(engine, dt)
    tables = package.tables(planar_of(name).structure, dt)
    tables["integration"] = dict(engine=engine, dt_s=dt)
    if engine != "rigid":
        for body in tables["bodies"].values():
            body["youngs_modulus_pa"] = _GRANITE
            body["element_size_m"] = body["width_m"] / _ACROSS
            del body["rigid"]
    return tables | dict(title=name)


def _tube(engine: str, dt: float) -> dict:
    from fecolumn.case.case import load_case

    tables = load_case(SPECIMEN).tables()
    tables["integration"] |= dict(engine=engine, dt_s=dt)
    tables["output"] |= dict(history_every_s=0.005, states_every_s=0.0)
    return tables | dict(title="tube", grounds=dict(ground=dict(kind="rigid")))


def motion_table(name: str, folder: Path) -> tuple[dict, str]:
    """The [motion] of a structure without its number, and the source of the ensemble up to the
    number; the ensemble of the plane is written below `folder` where it is not there.
    """
    rest = dict(free_vibration_s=rest_of(name))
    if name == "tube":
        return rest | dict(resample_s=_SAMPLED_TUBE), "lick:"
    file = folder / f"{name}.h5"
    if not file.exists():
        _write_motions(planar_of(name), name, file)
    return rest | dict(resample_s=_SAMPLED), f"{file}#"


def _write_motions(shaken: Shaken, name: str, file: Path) -> None:
    from fecolumn.motions.ensemble import Ensemble
    from fecolumn.motions.ensemble_file import write_ensemble
    from fecolumn.motions.record import GroundMotion

    made = []
    for number in range(1, MOTIONS + 1):
        a = ensembles.motion(shaken, number, _SAMPLED)[: -round(ensembles.REST / _SAMPLED)]
        path = np.outer(a, [1.0, 0.0, 0.0])
        made.append(GroundMotion(path, _SAMPLED, f"lick {number}", f"lick:{number}, scaled"))
    file.parent.mkdir(parents=True, exist_ok=True)
    write_ensemble(Ensemble(name, tuple(made), {}, {}), file)


def ground_of(case, file) -> np.ndarray:
    """Accelerations (n + 1, 3) [m/s2] of a case's motion and the rest after it, at its steps."""
    from fecolumn.motions.load import load_motion

    dt = float(case.integration.dt_s)
    a = load_motion(case.motion, dt, file).acceleration
    return np.concatenate([a, np.zeros((round(rest_of(case.title) / dt), 3))])


@functools.cache
def rigid_bodies(name: str) -> RigidBodies:
    """A structure as rigid bodies."""
    return _rigid_tube() if name == "tube" else _boxes(name)


def _boxes(name: str) -> RigidBodies:
    shaken = planar_of(name)
    depth = min(np.ptp(one.outline[:, 0]) for one in shaken.structure.bodies if not one.fixed)
    bodies = [one for one in shaken.structure.bodies if not one.fixed]
    sizes = np.array([[*np.ptp(one.outline, axis=0), depth] for one in bodies])[:, [0, 2, 1]]
    mass = np.array([one.density for one in bodies]) * sizes.prod(axis=1)
    squares = sizes**2
    inertia = mass[:, None] * (squares.sum(axis=1, keepdims=True) - squares) / 12
    place = np.array([[one.outline[:, 0].mean(), 0.0, one.outline[:, 1].mean()] for one in bodies])
    # all as one block: the columns of a frame carry its beam, which rises twice as much as they
    if name == "trilith":
        rise = _rise(*sizes[0, [0, 2]])
        barrier = GRAVITY * rise * (mass[:2].sum() + 2 * mass[2])
    else:
        barrier = GRAVITY * mass.sum() * _rise(sizes[0, 0], sizes[:, 2].sum())
    observed = shaken.observed - 1
    top = np.array([0.0, 0.0, sizes[observed, 2] / 2])
    friction = float(shaken.structure.friction[0])
    kinds, middle = ("box",) * len(bodies), np.zeros_like(place)
    return RigidBodies(
        kinds,
        sizes / 2,
        mass,
        inertia,
        place,
        middle,
        observed,
        top,
        friction,
        barrier,
        min(math.atan2(*sizes[0, [0, 2]]), OVERTURNED),
    )


def _rise(width: float, height: float) -> float:
    """By how much the middle of a block rises until it stands over its edge [m]."""
    return (math.hypot(width, height) - height) / 2


def _rigid_tube() -> RigidBodies:
    from fecolumn.case.case import load_case
    from fecolumn.mesh.mass import mass_properties
    from fecolumn.mesh.specimen import specimen_mesh

    case = load_case(SPECIMEN).short
    mesh = specimen_mesh(case)
    body = mass_properties(mesh.body, case.material.density_kg_m3)
    radius, height = case.column.outer_diameter_m / 2, case.column.height_m
    centre = float(body.centre[2])
    return RigidBodies(
        ("cylinder",),
        np.array([[radius, height / 2, 0.0]]),
        np.array([body.mass]),
        np.diag(body.inertia)[None].copy(),
        np.array([[0.0, 0.0, centre]]),
        np.array([[0.0, 0.0, height / 2 - centre]]),
        0,
        np.array([0.0, 0.0, height + case.cap.thickness_m - centre]),
        case.contact.friction_coefficient,
        body.mass * GRAVITY * (math.hypot(radius, centre) - centre),
        math.atan2(radius, centre),
    )
