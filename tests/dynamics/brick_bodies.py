"""Structures of bodies of a few bricks, in full order and reduced from the same meshes."""

from dataclasses import replace
from functools import cache, partial

import numpy as np
from mpi4py import MPI

from fecolumn.case.sections import Material
from fecolumn.contact.overturning import Limits
from fecolumn.contact.points import GROUND
from fecolumn.contact.unbounded_base import rigid_base
from fecolumn.engines.dynamics.energy import TERMS, Ledger
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.stepper import Stepper
from fecolumn.engines.dynamics.structure import released, structure_system
from fecolumn.engines.reduced.start import of_parts as reduced_of_parts
from fecolumn.engines.reduced_engine import engine_on
from fecolumn.fem.body import Body
from fecolumn.fem.corotated import Corotated
from fecolumn.fem.effective import blocks, unit_loads
from fecolumn.fem.free_body import FreeBody
from fecolumn.fem.modes import elastic_modes
from fecolumn.structures.model import BodyModel, JointModel, Part, StructureModel, Surface
from fecolumn.verification.models import box

GRAVITY = np.array([0.0, 0.0, -9.81])
MARBLE = Material(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
# as many as the small meshes have
ALL = 10**6


def grid(half, bricks):
    return np.linspace(-half, half, bricks + 1)


@cache
def brick_body(length, width, height, bricks, material=MARBLE):
    """Body of length x width x height [m] in (x, y, z) `bricks`, its foot at z = 0; the same object
    whenever it is asked for.
    """
    mesh = box(
        grid(length / 2, bricks[0]),
        grid(width / 2, bricks[1]),
        np.linspace(0, height, bricks[2] + 1),
    )
    return Body(MPI.COMM_WORLD, mesh, material)


@cache
def model_of(body, modes=0):
    """BodyModel of a brick body with so many modes, and the exact flexibility of the nodes of foot
    and head; 0: neither, as full order needs none.
    """
    X, low, high = body.all_X, body.all_X[:, 2].min(), body.all_X[:, 2].max()
    faces = {
        name: np.flatnonzero(np.abs(X[:, 2] - z) < 1e-9)
        for name, z in (("foot", low), ("head", high))
    }
    # by place, so that ranks do not matter
    faces = {name: face[np.lexsort(np.round(X[face, :2].T, 9))] for name, face in faces.items()}
    nodes = np.concatenate(list(faces.values()))
    surfaces, first = {}, 0
    for name, face in faces.items():
        x, y = (np.unique(np.round(X[face, axis], 9)) for axis in (0, 1))
        number = np.lexsort(np.round(X[face, :2].T, 9)).argsort().reshape(len(y), len(x))
        cells = [
            (number[j, i], number[j, i + 1], number[j + 1, i + 1], number[j + 1, i])
            for i in range(len(x) - 1)
            for j in range(len(y) - 1)
        ]
        triangles = np.array([one for a, b, c, d in cells for one in ((a, b, c), (a, c, d))])
        axes = np.eye(3) if name == "head" else np.array([[1.0, 0, 0], [0, -1.0, 0], [0, 0, -1.0]])
        plane = X[face, :2]
        outline = (np.abs(plane - plane.min(axis=0)) < 1e-9).any(axis=1) | (
            np.abs(plane - plane.max(axis=0)) < 1e-9
        ).any(axis=1)
        surfaces[name] = Surface(
            first + np.arange(len(face)),
            np.array([0.0, 0.0, X[face[0], 2]]) - body.center,
            axes,
            np.full(len(face), np.prod(np.ptp(plane, axis=0)) / len(face)),
            outline,
            triangles if name == "head" else triangles[:, ::-1],
        )
        first += len(face)
    free, n = FreeBody(body), len(nodes)
    frequencies, fields, flexibility = (
        np.zeros(0),
        np.zeros((0, body.n_owned, 3)),
        np.zeros((n, n, 3, 3)),
    )
    if modes:
        frequencies, fields = elastic_modes(body, modes)
        response = free.response(unit_loads(body, nodes))
        flexibility = blocks(
            body.gather(nodes, response.reshape(body.n_owned, 3, -1)).reshape(3 * n, -1)
        )
    top = np.array([0.0, 0.0, high]) - body.center
    shapes = body.gather(nodes, np.ascontiguousarray(fields.transpose(1, 2, 0)))
    return BodyModel(
        float(body.total_mass),
        free.masses[3:, 3:],
        body.center,
        frequencies,
        shapes,
        flexibility,
        X[nodes] - body.center,
        3 * body.n_nodes,
        surfaces,
        {"top": (top, shapes[surfaces["head"].nodes].mean(axis=0))},
    )


class Structure:
    """Bodies and how they stand on one another.

    Parameters
    ----------
    bodies
        (name, Body, (3,) where its drawing stands, further fields of Part).
    joints
        (slave, its surface, master, its surface).
    links
        of LinkModel.
    """

    def __init__(self, bodies, joints, links=(), friction=0.7):
        self.bodies, self.meets, self.links, self.friction = bodies, joints, links, friction

    def model(self, modes=0, observed=None):
        parts = []
        for name, body, at, *further in self.bodies:
            model = model_of(body, modes)
            values = dict(
                rotation=np.eye(3), damping_ratio=0.0, velocity=np.zeros(3), spin=np.zeros(3)
            ) | (further[0] if further else {})
            parts.append(
                Part(name=name, model=model, center=np.asarray(at, float) + model.center, **values)
            )
        joints = []
        for slave, surface, master, other in self.meets:
            law = np.zeros((len(parts[slave].model.surfaces[surface].nodes), 3))
            joints.append(
                JointModel(
                    f"{slave} on {master}",
                    slave,
                    surface,
                    master,
                    other,
                    self.friction,
                    law,
                    False,
                    0.0,
                )
            )
        base = rigid_base(np.concatenate([part.center + part.model.arms for part in parts]))
        return StructureModel(
            tuple(parts),
            tuple(joints),
            tuple(self.links),
            base,
            (len(parts) - 1 if observed is None else observed, "top"),
        )

    def full(
        self, dt=1e-3, alpha=-0.05, stands=True, impact="plastic", kinematics=Corotated, base=None
    ):
        """Further arguments: of Stepper, of each body, and what they stand on, rigid or not."""
        model = self.model()
        model = replace(model, base=base or model.base)
        bodies = [body for _, body, *_ in self.bodies]
        system = structure_system(
            model,
            bodies,
            HHT(dt, alpha),
            GRAVITY,
            filtered=impact == "plastic",
            kinematics=kinematics,
        )
        return FullRun(system, model, stands, impact=impact)

    def reduced(self, dt=1e-3, alpha=-0.05, modes=ALL, stands=True):
        model = self.model(modes)
        begin = partial(reduced_of_parts, parts=model.parts, stands=stands)
        limits = Limits.of_tilt(len(model.parts))
        return engine_on(model, HHT(dt, alpha), begin, gravity=GRAVITY, limits=limits)


class FullRun:
    """Steps of the full-order engine, with what a row of the reduced one says of bodies."""

    def __init__(self, system, model, stands=True, state=None, impact="plastic"):
        self.system, self.model = system, model
        self.state = (
            released(system, model.parts, standing(system) if stands else None)
            if state is None
            else state
        )
        self.ledger = Ledger(system)
        self.ledger.open(self.state)
        self.stepper = Stepper(system, self.ledger, impact)

    def advance(self, grounds):
        """Displacement of the centres of mass and tilt (k, nb, 4) and the ledger (k, terms) after
        steps under ground accelerations (k, 3).
        """
        rows, energies = [], []
        for ground in grounds:
            self.state = self.stepper.step(self.state, np.asarray(ground, float))
            centers, R = self.system.bodies.centers(self.state.x), self.state.rotation
            tilts = np.arctan2(np.hypot(R[:, 0, 2], R[:, 1, 2]), R[:, 2, 2])
            rows.append(
                np.column_stack([centers - [part.center for part in self.model.parts], tilts])
            )
            energies.append(self.ledger.row(self.state))
        return np.array(rows), np.array(energies)


def closure(energies):
    """Largest error of the energy balance over the energy moved."""
    return np.abs(energies[:, -1]).max() / np.ptp(energies[:, TERMS.index("gravity")])


def stack(bricks=(2, 2, 4), **further):
    low, up = brick_body(0.4, 0.4, 0.8, bricks), brick_body(0.3, 0.3, 0.9, bricks)
    return Structure(
        [("low", low, (0, 0, 0)), ("up", up, (0, 0, 0.8), further)],
        [(0, "foot", GROUND, None), (1, "foot", 0, "head")],
    )


def frame(columns=2, order=None, links=()):
    """A slab on two or four columns; order: places of the columns, then of the slab, among the
    bodies.
    """
    column, slab = (
        brick_body(0.2, 0.2, 1.2, (1, 1, 4)),
        brick_body(2.4, 2.4 if columns == 4 else 0.6, 0.3, (12, 12 if columns == 4 else 3, 1)),
    )
    places = (
        [(-1, 0, 0), (1, 0, 0)]
        if columns == 2
        else [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    )
    number, bodies, joints = order or list(range(columns + 1)), [None] * (columns + 1), []
    for i in range(columns):
        bodies[number[i]] = (f"column {i}", column, places[i])
    bodies[number[-1]] = ("slab", slab, (0, 0, 1.2))
    for i in range(columns) if order is None else reversed(range(columns)):
        joints += [(number[i], "foot", GROUND, None), (number[i], "head", number[-1], "foot")]
    return Structure(bodies, joints, links)


def pulse(amplitude, period, steps, dt=1e-3):
    t = np.arange(1, steps + 1) * dt
    return np.column_stack(
        [amplitude * np.sin(2 * np.pi * t / period) * (t < period), np.zeros((steps, 2))]
    )
