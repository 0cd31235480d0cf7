"""Feet that are not flat, and edges below a face: bodies that roll on a dome or on a rounded edge,
and one that rocks on what is narrower than its foot.

Requirement: a body on a spherical foot swings, rests and overturns as a rigid body that rolls
without slip, and loses nothing; beyond the edge of the dome it goes on over that; pushed, it slides
by Coulomb's law. A foot with a rounded edge rolls on it. A block on a narrower one rocks about the
edge of that.

With e = rho - h the depth of the centre of mass below the centre of the sphere, a body that has
rolled to the tilt q has the kinetic energy (I + m (rho^2 + e^2 - 2 rho e cos q)) q'^2 / 2 and the
potential m g (rho - e cos q): small swings have w^2 = m g (rho - h) / (I + m h^2), and for h > rho
it falls. On a foot of half width b the edge of radius r turns about the centre of the edge: height
r + (h - r) cos q + (b - r) sin q. Times are integrals of 1 / q'.

On a plate and on soil the same holds, as what presses stays below the centre of the sphere. Soil
that gives across by 1 / k shears under the force m h w^2 q: its energy, over that of the weight, is
s = (m h w^2)^2 / (k m g (rho - h)), by half of which periods grow and tilts fall.

Tolerances. Times and tilts on a dome: 1e-4, ten times what the give of the contact changes in the
swing. Energy between two passages: 1e-5 of that of the swing; what the give of the foot stores more
away from its middle is given back. What is let go falls by what it is pressed together at rest
before it turns: 2e-3. Sliding: the first steps of the contact's spring, 1e-3. Loss at the narrow
block: as in `several_bodies`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.integrate import quad

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.observe import ENERGY, WIDTH
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.model import BodyModel
from fecolumn.structures.structure import structure_model
from fecolumn.verification.result import CaseRows, Row

MARBLE = dict(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
GLASS = dict(youngs_modulus_pa=70e9, poissons_ratio=0.22, density_kg_m3=2500.0)
BLOCK = dict(kind="block", length_m=0.4, width_m=0.4, height_m=1.2, element_size_m=0.1) | MARBLE
DRUM = dict(kind="cylinder", outer_diameter_m=0.5, height_m=1.6, element_size_m=0.125) | MARBLE
TUBE = (
    dict(kind="tube", outer_diameter_m=0.02, wall_m=0.0015, height_m=0.15, element_size_m=0.005)
    | GLASS
)
#: Grounds that give
PLATE = dict(kind="plate", thickness_m=0.1, youngs_modulus_pa=210e9, poissons_ratio=0.3)
SOIL = dict(kind="pad", stiffness_n_m3=1e9)
#: Closure of the energy balance over the energy moved
CLOSED = 1e-10


def run(engine: str, long: bool = False) -> CaseRows:
    """The rows; engine: reduced or rigid."""
    rows = [
        *_swings("marble block", BLOCK | dict(foot_radius_m=0.9), engine),
        *_swings("marble block on a plate,", BLOCK | dict(foot_radius_m=0.9), engine, ground=PLATE),
        *_swings("marble block on soil,", BLOCK | dict(foot_radius_m=0.9), engine, ground=SOIL),
        *_overturns(engine),
        *_over_the_edge(engine),
        *_slides(engine),
        *_rounded(engine),
        *_narrower(engine),
    ]
    if long:
        rows += [
            *_swings("marble drum", DRUM | dict(foot_radius_m=1.2), engine),
            *_swings("glass tube", TUBE | dict(foot_radius_m=0.1), engine, 1e-4),
        ]
    return CaseRows([*rows, *_rests(engine)])


class Rolling:
    """A rigid body on a dome, rolling in a plane without slip; its energy without motion is 0
    upright.

    Parameters
    ----------
    model
        BodyModel.
    radius
        of the sphere, half: radius of the dome's edge [m].
    """

    def __init__(self, model: BodyModel, radius: float, half: float = math.inf) -> None:
        self.mass, self.inertia, self.height, self.radius, self.half = (
            model.mass,
            float(model.inertia[1, 1]),
            float(model.center[2]),
            radius,
            half,
        )
        self.depth = radius - self.height

    @property
    def rate(self) -> float:
        """Circular frequency of small swings [rad/s]; of growth where the centre of mass is above
        that of the sphere.
        """
        return math.sqrt(
            self.mass * GRAVITY * abs(self.depth) / (self.inertia + self.mass * self.height**2)
        )

    def moving(self, tilt: float) -> float:
        """Inertia [kg m2] about the place of contact on the dome."""
        return self.inertia + self.mass * (
            self.radius**2 + self.depth**2 - 2 * self.radius * self.depth * math.cos(tilt)
        )

    def potential(self, tilt: float) -> float:
        """Energy of the weight [J], beyond the edge of the dome on that."""
        if math.sin(tilt) * self.radius <= self.half:
            return self.mass * GRAVITY * self.depth * (1 - math.cos(tilt))
        rise = self.radius - math.sqrt(self.radius**2 - self.half**2)
        return (
            self.mass
            * GRAVITY
            * (self.half * math.sin(tilt) + (self.height - rise) * math.cos(tilt) - self.height)
        )

    def spin(self, energy: float) -> float:
        """Rate of the tilt [rad/s] upright at an energy [J]."""
        return math.sqrt(2 * energy / self.moving(0.0))

    def quarter(self, amplitude: float) -> float:
        """Time [s] from upright to the largest tilt."""
        energy = self.potential(amplitude)

        def slowness(
            angle: float,
        ) -> float:  # tilt = amplitude sin(angle): without the singular end
            tilt = amplitude * math.sin(angle)
            left = max(2 * (energy - self.potential(tilt)) / self.moving(tilt), 1e-300)
            return amplitude * math.cos(angle) / math.sqrt(left)

        return quad(slowness, 0.0, math.pi / 2 - 1e-7, epsrel=1e-9)[0]

    def reaches(self, tilt: float, spin: float) -> float:
        """Time [s] to a tilt from upright with a spin [rad/s]."""
        energy = self.moving(0.0) * spin**2 / 2
        return quad(
            lambda angle: 1 / math.sqrt(2 * (energy - self.potential(angle)) / self.moving(angle)),
            0.0,
            tilt,
            epsrel=1e-10,
        )[0]


def case_of(
    bodies: dict,
    joints: dict,
    engine: str,
    dt: float,
    initial: dict | None = None,
    friction: float = 0.7,
    ground: dict | None = None,
) -> Case:
    """Case of a structure that nothing shakes; ground: its keys, None of a rigid one."""
    return case_from_tables(
        dict(
            grounds=dict(ground=ground) if ground else {},
            bodies=bodies,
            joints=joints,
            initial=initial or {},
            contact=dict(friction_coefficient=friction, interior_points=4),
            integration=dict(dt_s=dt, duration_s=100.0, engine=engine)
            | (dict(n_modes=6) if engine == "reduced" else {}),
        ),
        "feet",
    )


def alone_on_ground(
    body: dict,
    engine: str,
    dt: float,
    friction: float = 0.7,
    ground: dict | None = None,
    **initial: Any,
) -> Case:
    """Case of a body by itself on the ground."""
    return case_of(
        dict(body=body),
        dict(foot=dict(between=["body", "ground"])),
        engine,
        dt,
        dict(body=initial) if initial else None,
        friction,
        ground,
    )


def columns_and_rows(
    case: Case, seconds: float, ground: np.ndarray | None = None
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Columns of the history, and the rows."""
    made = engine_of(case, structure_model(case), "case")
    if ground is None:
        ground = np.zeros((round(seconds / float(case.integration.dt_s)), 3))
    rows, _ = made.advance(ground)
    return columns_of(rows, made.model), rows


def closure_over_kinetic(rows: np.ndarray) -> float:
    """Largest error of the energy balance over the kinetic energy reached."""
    return float(np.abs(rows[:, WIDTH - 1] - rows[0, WIDTH - 1]).max() / np.ptp(rows[:, ENERGY]))


def passages(rows: dict, body: str = "body") -> np.ndarray:
    """Times [s] at which a body that swings along x passes upright."""
    moved, time = rows[f"body/{body}/displacement"][:, 0], rows["time"]
    before = np.flatnonzero(moved[:-1] * moved[1:] < 0)
    return time[before] - moved[before] * (time[before + 1] - time[before]) / (
        moved[before + 1] - moved[before]
    )


def kept(rows: dict, columns: np.ndarray, dt: float) -> float:
    """Share of the mechanical energy of the first passage upright that is left at the last."""
    energy = (
        columns[:, ENERGY : ENERGY + 3].sum(axis=1)
        - columns[:, ENERGY + 1 : ENERGY + 3].sum(axis=1).min()
    )
    first, last = (int(round(time / dt)) for time in passages(rows)[[0, -1]])
    return float(energy[last] / energy[first])


def _swings(
    name: str,
    body: dict,
    engine: str,
    dt: float = 1e-3,
    amplitude: float = 0.05,
    ground: dict | None = None,
) -> Iterator[Row]:
    structure = structure_model(alone_on_ground(body, engine, dt, ground=ground))
    rolling = Rolling(structure.parts[0].model, body["foot_radius_m"])
    period, sheared = 2 * math.pi / rolling.rate, 0.0
    if pad := structure.joints[0].pad:
        force = rolling.mass * rolling.height * rolling.rate**2
        sheared = force**2 / (pad.stiffness[0, 0] * rolling.mass * GRAVITY * rolling.depth)
    spin = [0.0, rolling.spin(rolling.potential(amplitude)), 0.0]
    rows, columns = columns_and_rows(
        alone_on_ground(body, engine, dt, ground=ground, spin_rad_s=spin), 5.6 * period
    )
    found = passages(rows)
    yield Row(
        f"{name} on a dome: period of a swing of {amplitude:g} rad [s]",
        4 * rolling.quarter(amplitude) * (1 + sheared / 2),
        float((found[9] - found[1]) / 4),
        1e-4,
    )
    leaned = float(rows["body/body/tilt"].max())
    yield Row("the same: largest tilt [rad]", amplitude * (1 - sheared / 2), leaned, 1e-4)
    yield Row(
        "the same: share of the energy left after 5 periods", 1.0, kept(rows, columns, dt), 1e-5
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(columns), CLOSED)


def _overturns(engine: str, dt: float = 1e-4) -> Iterator[Row]:
    """A test tube, whose bottom is half a sphere: its centre of mass is above that of the
    sphere.
    """
    body, spin, tilt = TUBE | dict(foot_radius_m=0.01), 0.5, 0.6
    rolling = Rolling(structure_model(alone_on_ground(body, engine, dt)).parts[0].model, 0.01)
    rows, columns = columns_and_rows(
        alone_on_ground(body, engine, dt, spin_rad_s=[0.0, spin, 0.0]), 0.5
    )
    leaned = rows["body/body/tilt"]
    passed = int(np.argmax(leaned > tilt)) + 1
    found = float(np.interp(tilt, leaned[:passed], rows["time"][:passed]))
    yield Row(
        f"glass tube on a half sphere: overturns, time to {tilt:g} rad [s]",
        rolling.reaches(tilt, spin),
        found,
        1e-4,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(columns), CLOSED)


def _over_the_edge(engine: str, dt: float = 1e-3) -> Iterator[Row]:
    """A drum thrown so far that it goes over the edge of its dome and comes back."""
    body = DRUM | dict(foot_radius_m=1.2)
    rolling = Rolling(structure_model(alone_on_ground(body, engine, dt)).parts[0].model, 1.2, 0.25)
    tilt = math.asin(0.25 / 1.2) + 0.04
    rows, columns = columns_and_rows(
        alone_on_ground(
            body, engine, dt, spin_rad_s=[0.0, rolling.spin(rolling.potential(tilt)), 0.0]
        ),
        5.0,
    )
    yield Row(
        "marble drum thrown over the edge of its dome: largest tilt [rad]",
        tilt,
        float(rows["body/body/tilt"].max()),
        1e-4,
    )
    yield Row(
        "the same: share of the energy left after the edges of both sides",
        1.0,
        kept(rows, columns, dt),
        1e-5,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(columns), CLOSED)


def _slides(engine: str, dt: float = 1e-4) -> Iterator[Row]:
    friction, speed = 0.1, 1.0
    rows, columns = columns_and_rows(
        alone_on_ground(
            DRUM | dict(foot_radius_m=1.2), engine, dt, friction, velocity_m_s=[speed, 0.0, 0.0]
        ),
        0.02,
    )
    braked = speed * rows["time"][-1] - rows["body/body/displacement"][-1, 0]
    yield Row(
        "marble drum pushed on its dome: way lost to friction in 0.02 s [m]",
        friction * GRAVITY * rows["time"][-1] ** 2 / 2,
        float(braked),
        1e-3,
    )


def _rests(engine: str, dt: float = 4e-3, share: float = 0.02) -> Iterator[Row]:
    """Pushed slowly by a steady acceleration, a body leans until e sin q g = a (rho - e cos q)."""
    body = BLOCK | dict(foot_radius_m=0.9)
    rolling = Rolling(structure_model(alone_on_ground(body, engine, dt)).parts[0].model, 0.9)
    period, acceleration = 2 * math.pi / rolling.rate, share * GRAVITY
    ramp, hold = round(12 * period / dt), round(2 * period / dt)
    ground = np.zeros((ramp + hold, 3))
    ground[:, 0] = (
        acceleration
        * (1 - np.cos(math.pi * np.minimum(np.arange(1, ramp + hold + 1) / ramp, 1.0)))
        / 2
    )
    rows, _ = columns_and_rows(alone_on_ground(body, engine, dt), 0.0, ground)
    tilt = float(rows["body/body/tilt"][-hold:].mean())
    e, exact = rolling.depth, 0.0
    for _ in range(50):
        exact = math.asin(share * (rolling.radius - e * math.cos(exact)) / e)
    yield Row(f"marble block on a dome: tilt under {share:g} g [rad]", exact, tilt, 1e-4)


def _rounded(
    engine: str, dt: float = 5e-4, radius: float = 0.05, tilt: float = 0.1
) -> Iterator[Row]:
    """A block let go on its rounded edge: time until it is upright."""
    body = BLOCK | dict(edge_radius_m=radius)
    rows, columns = columns_and_rows(alone_on_ground(body, engine, dt, tilt_rad=tilt), 0.45)
    model = structure_model(alone_on_ground(body, engine, dt)).parts[0].model
    exact = falls(model, 0.2 - radius, radius, tilt)
    yield Row(
        f"marble block let go on an edge of radius {radius:g} m: time to upright [s]",
        exact,
        float(passages(rows)[0]),
        2e-3,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(columns), CLOSED)


def falls(model: BodyModel, half: float, radius: float, tilt: float) -> float:
    """Time [s] from rest at a tilt [rad] to upright of a body that rolls on an edge of a radius,
    whose centre is `half` from the middle, both [m].
    """
    up, inertia = float(model.center[2]) - radius, float(model.inertia[1, 1])

    def level(angle: float) -> float:
        return radius + up * math.cos(angle) + half * math.sin(angle)

    def slowness(s: float) -> float:  # angle = tilt (1 - s^2): without the singular beginning
        angle = tilt * (1 - s * s)
        across = half * math.cos(angle) - up * math.sin(angle)
        square = (
            2
            * model.mass
            * GRAVITY
            * (level(tilt) - level(angle))
            / (inertia + model.mass * (across**2 + level(angle) ** 2))
        )
        return 2 * tilt * s / math.sqrt(square)

    return quad(slowness, 1e-6, 1.0, epsrel=1e-9)[0]


def narrower_case(engine: str, dt: float, tilt: float) -> Case:
    """A light block 0.9 m wide, no node of which is over the edges of a heavy one of 0.4 m on which
    it stands.
    """
    stiff = dict(youngs_modulus_pa=1e13, poissons_ratio=0.2, rigid=True, element_size_m=0.2)
    return case_of(
        dict(
            narrow=dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.3, density_kg_m3=5e4)
            | stiff,
            wide=dict(
                kind="block",
                length_m=0.9,
                width_m=0.4,
                height_m=1.2,
                density_kg_m3=50.0,
                at_m=[0.0, 0.0, 0.3],
            )
            | stiff,
        ),
        dict(foot=dict(between=["narrow", "ground"]), joint=dict(between=["wide", "narrow"])),
        engine,
        dt,
        dict(wide=dict(tilt_rad=tilt)),
    )


def _narrower(engine: str, dt: float = 5e-4, tilt: float = 0.05) -> Iterator[Row]:
    """Housner's block with the half width of the narrow one: (I + m (h^2 - b^2)) / (I + m (h^2 +
    b^2)) of the rate is left at an impact.
    """
    case = narrower_case(engine, dt, tilt)
    model, half = structure_model(case).parts[1].model, 0.2
    rows, columns = columns_and_rows(case, 0.45)
    height, inertia = float(model.center[2]), float(model.inertia[1, 1])
    exact = falls(model, half, 0.0, tilt)
    upright = passages(rows, "wide")[0]
    yield Row(
        "block on a narrower one: time to upright over the edge of that [s]",
        exact,
        float(upright),
        2e-3,
    )
    ratio = (inertia + model.mass * (height**2 - half**2)) / (
        inertia + model.mass * (height**2 + half**2)
    )
    again, slope = (
        float(rows["body/wide/tilt"][round(upright / dt) + 5 :].max()),
        math.atan(half / height),
    )
    left = (math.cos(slope - again) - math.cos(slope)) / (math.cos(slope - tilt) - math.cos(slope))
    yield Row("the same: share of the energy after an impact", ratio**2, left, 2e-3)
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(columns), CLOSED)
