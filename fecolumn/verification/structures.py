"""Structures of many bodies beside the rocking models of their papers: the restrained wobbling
frame and the rocking podium.

Requirement: a slab on four round columns with tendons is held by the force of virtual work, an
impact in a plane takes what angular momentum says, and a frame that is set rolling goes the way of
the wobbling model. The podium's impact is that of `podium_bodies`.

Sources: [W] the statistical validation of a wobbling model by tests on a restrained frame; [P] the
paper on impact modelling of multi-storey podium structures. Bodies are rigid but for points that
give 3,000 to 10,000 times less than concrete, for both papers speak of rigid columns.

Tolerances. Force: that of virtual work within 0.5 %, by which the points give in the first 60 ms;
the numbers printed for slender columns leave out alpha^2 / 3 = 0.6 % at uplift and 2 % of the
slope. Impact: the step in which it falls, g dt^2 / 2 of fall and a share of dt in its time. Path:
one step's turn at the release.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.model_sections import CRV, WobblingFrameModel
from fecolumn.engines.rocking import wobbling_equations as equations
from fecolumn.engines.rocking.podium_impact import podium_restitution
from fecolumn.engines.rocking.wobbling_frame import WobblingFrame
from fecolumn.foundation._compiled import interpreted
from fecolumn.motions.record import GroundMotion
from fecolumn.verification.podium_bodies import podium_rows
from fecolumn.verification.podium_structure import (
    STIFF,
    let_go,
)
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.wobbling_models import SPECIMEN

#: Of [P]: half diagonal [m] and slenderness of a column, mass of the slab over that of the columns
_TILTS = (0.01, 0.03, 0.06)  # [rad]
# between these times [s] after the release the slab's acceleration is taken
_SETTLED = (5e-3, 0.06)


def run(engine: str, long: bool = False) -> CaseRows:
    """The rows; engine: reduced."""
    return CaseRows([*_forces(), *_impact(), *_path(4.0 if long else 1.0), *podium_rows()])


def frame_model(**keys: Any) -> WobblingFrame:
    """The tested frame [W] as the model with two degrees of freedom."""
    return WobblingFrame.of_section(WobblingFrameModel(**SPECIMEN | keys), "specimen")


def rolling_start(frame: WobblingFrame, tilt: float, turn: float = 0.0) -> dict:
    """[initial] of a case: columns that lean by `tilt` [rad] towards x and roll on with `turn`
    [rad/s] of the azimuth, their slab along with them.
    """
    spin = [-turn * math.sin(tilt), 0.0, turn * (1 - math.cos(tilt))]
    return dict(
        column=dict(tilt_rad=tilt, spin_rad_s=spin),
        slab=dict(velocity_m_s=[0.0, turn * float(frame.moved(tilt)[0]), 0.0]),
    )


def frame_case(frame: WobblingFrame, initial: dict, dt: float) -> Case:
    """The same frame of bodies that are rigid but for their contact points."""
    radius, _, height, mass, slab, *_, stiffness, _, _ = frame.body
    body = dict(rigid=True, youngs_modulus_pa=STIFF, poissons_ratio=0.2)
    tendon = dict(
        kind="tendon",
        body="column",
        to="slab",
        to_point_m=[0.0, 0.0, height],
        stiffness_n_m=stiffness,
    )
    return case_from_tables(
        dict(
            bodies=dict(
                column=dict(
                    kind="cylinder",
                    outer_diameter_m=2 * radius,
                    height_m=height,
                    mass_kg=mass,
                    element_size_m=radius / 2,
                    copies_m=[
                        [1.0, 1.0, 0.0],
                        [-1.0, 1.0, 0.0],
                        [-1.0, -1.0, 0.0],
                        [1.0, -1.0, 0.0],
                    ],
                )
                | body,
                slab=dict(
                    kind="slab",
                    length_m=3.0,
                    width_m=3.0,
                    thickness_m=0.43,
                    mass_kg=frame.columns * slab,
                    at_m=[0.0, 0.0, height],
                )
                | body,
            ),
            joints=dict(
                feet=dict(between=["column", "ground"]), heads=dict(between=["column", "slab"])
            ),
            links=dict(tendon=tendon) if stiffness else {},
            contact=dict(friction_coefficient=0.7, interior_points=0),
            initial=initial,
            integration=dict(dt_s=dt, duration_s=60.0),
        ),
        "frame",
    )


def restoring_force(
    frame: WobblingFrame, rows: dict, tilt: float, settled: tuple[float, float] = _SETTLED
) -> float:
    """Horizontal force [N] that rights a frame let go at a tilt: inertia of the mechanism times the
    slab's first acceleration.
    """
    time, moved = rows["time"], rows["body/slab/displacement"][:, 0]
    within = (time > settled[0]) & (time <= settled[1])
    acceleration = 2 * np.polyfit(time[within], moved[within], 2)[0]
    reach = (frame.moved(tilt + 1e-6)[0] - frame.moved(tilt - 1e-6)[0]) / 2e-6
    return float(
        -acceleration
        * frame.columns
        * interpreted(equations.inertia)(frame.body, tilt)[0]
        / reach**2
    )


def _forces() -> Iterator[Row]:
    frame, found = frame_model(), []
    for tilt in _TILTS:
        displacement, exact = frame.pushover(tilt)
        found.append(
            (
                displacement,
                restoring_force(
                    frame,
                    let_go(frame_case(frame, rolling_start(frame, tilt), 1e-3), _SETTLED[1]),
                    tilt,
                ),
            )
        )
        yield Row(
            f"restrained frame let go at {tilt:g} rad: restoring force [N]",
            exact,
            found[-1][1],
            5e-3,
        )
    ways, forces = np.array(found).T
    slope, force = np.polyfit(ways, forces, 1)
    yield Row("the same: force at uplift [kN] (D of W)", 13.15, force / 1e3, 0.01)
    yield Row("the same: slope after uplift [kN/m] (D of W)", -34.8, slope / 1e3, 0.03)
    yield Row("the same: displacement capacity [m] (D of W)", 0.378, -force / slope, 0.03)


def energy_at(frame: WobblingFrame, tilt: float) -> float:
    """Strain and gravity energy of one column with its share of the slab [J]."""
    return sum(interpreted(equations.potential)(frame.body, tilt))


def planar_restitution(frame: WobblingFrame) -> float:
    """Rate of the tilt after over before an impact in a plane: angular momentum about the new rims,
    the slab translating (eta = 0 of the podium's).
    """
    radius, centre, _, mass, _, across, *_ = frame.body
    return podium_restitution(
        CRV, frame.slenderness, frame.mass_ratio, 0.0, 1 + across / (mass * (radius**2 + centre**2))
    )


def _impact() -> Iterator[Row]:
    """The frame without tendons: falls upright and rises on the other side."""
    frame, tilt = frame_model(tendon_n_m=0.0), 0.03
    rows = let_go(frame_case(frame, rolling_start(frame, tilt), 5e-4), 0.75)
    moved = rows["body/slab/displacement"][:, 0]
    passed = int(np.argmax(moved < 0))
    kept = energy_at(frame, rows["body/column 1/tilt"][passed + 20 :].max()) / energy_at(
        frame, tilt
    )
    quiet = frame.respond(_still(1.0), tilt=tilt)
    yield Row(
        "frame without tendons: time of the first impact [s]",
        float(quiet.impact_times[0]),
        float(rows["time"][passed]),
        5e-3,
    )
    yield Row(
        "the same: share of the energy after the impact", planar_restitution(frame) ** 2, kept, 0.01
    )


def _still(seconds: float, dt: float = 2e-3) -> GroundMotion:
    from fecolumn.motions.record import GroundMotion

    return GroundMotion(np.zeros((round(seconds / dt) + 1, 3)), dt, "at rest", "")


def slab_path(frame: WobblingFrame, tilt: float, turn: float, time: np.ndarray) -> np.ndarray:
    """Displacement (n, 2) [m] of the slab at times by the model, as of
    `rolling_start`.
    """
    from fecolumn.verification.wobbling_models import free

    rows, *_ = free(frame, tilt, turn, time[-1] + 0.01)
    along = np.interp(time, rows[:, 0], frame.moved(rows[:, 1])[0])
    azimuth = np.interp(time, rows[:, 0], rows[:, 2])
    return along[:, None] * np.column_stack([np.cos(azimuth), np.sin(azimuth)])


def _path(seconds: float) -> Iterator[Row]:
    frame, tilt, turn = frame_model(), 0.05, 1.5
    rows = let_go(frame_case(frame, rolling_start(frame, tilt, turn), 1e-3), seconds)
    exact = slab_path(frame, tilt, turn, rows["time"])
    off = np.linalg.norm(rows["body/slab/displacement"][:, :2] - exact, axis=1).max()
    yield Row(
        f"restrained frame that rolls round: slab off the model's way in {seconds:g} s "
        "over its reach",
        0.0,
        off / np.abs(exact).max(),
        0.02,
    )
