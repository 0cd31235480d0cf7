"""Motion of each body in the response of a rocking model of a case's bodies: what pictures and
figures ask of the history of any analysis.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.case.bodies import Storeys
from fecolumn.case.case import Case
from fecolumn.engines.rocking.column import RigidColumn, rigid_body
from fecolumn.engines.rocking.model import ModelResponse, moved_about_edge
from fecolumn.engines.rocking.of_bodies import rocking_bodies
from fecolumn.foundation.arrays import Array
from fecolumn.structures.storeys import building_of


def body_motion(case: Case, response: ModelResponse, file: Path | str) -> dict[str, Array]:
    """Columns (n, ...) of the history by name: displacement [m] of the centre of mass, rotation
    vector [rad] and tilt [rad] of each body, displacement [m] of its top, drift [m] and shear [N]
    of its storeys; of a single body also what the ground does to it, as of an interface. Nothing of
    a model of its own table, which has no bodies.
    """
    if case.own:
        return {}
    name, slab = rocking_bodies(case, file)
    own, lean, wobbles = (
        rigid_body(case, name, file),
        _lean(response),
        "phi" in response.coordinates,
    )
    rotation = np.column_stack([-lean[:, 1], lean[:, 0], np.zeros(len(lean))])
    center = _moved(lean, wobbles, own.height, own.half_foot, own.offset)
    top = _moved(lean, wobbles, own.top, own.half_foot)
    found: dict[str, Array] = {}
    for column in case.names_of(name):
        found |= {
            f"body/{column}/displacement": center,
            f"body/{column}/rotation": rotation,
            f"body/{column}/tilt": response.tilt,
            f"mark/{column}.top/displacement": top,
        }
    if not slab:
        return found | _at_foot(case, name, own, lean, response)
    # it lies on the edges across, and stays level
    width = (2 * own.half_foot[0], 2 * own.half_foot[1])
    moved = _moved(lean, wobbles, own.top, width)
    still = np.zeros(len(moved))
    found |= {
        f"body/{slab}/displacement": moved,
        f"body/{slab}/rotation": np.zeros_like(moved),
        f"body/{slab}/tilt": still,
        f"mark/{slab}.top/displacement": moved,
    }
    body, below = case.bodies[slab], moved[:, 0]
    if not isinstance(body, Storeys):
        return found
    for number, (floor, stiffness) in enumerate(
        zip(response.floors.T, building_of(body).stiffness[:, 0]), 1
    ):
        drift, below = np.column_stack([floor - below, still]), floor
        found |= {
            f"mark/{slab}.floor {number}/displacement": np.column_stack(
                [floor, still, moved[:, 2]]
            ),
            f"storey/{slab} {number}/drift": drift,
            f"storey/{slab} {number}/shear": stiffness * drift,
        }
    return found


def _at_foot(
    case: Case, name: str, own: RigidColumn, lean: Array, response: ModelResponse
) -> dict[str, Array]:
    """Columns of the joint of a single body with the ground, by name: as of any interface. A body
    that leans by `lean` (n, 2) [rad] stands on the middle of an edge, or on a place of its rim; one
    that stands, where the resultant of weight and inertia meets its foot.
    """
    joint, keys = next(
        (one, keys) for one, keys in case.joints.items() if name in (keys.slave, keys.on)
    )
    ground = keys.on if keys.slave == name else keys.slave
    force, half = response.base_force, np.array(own.half_foot)
    with np.errstate(divide="ignore", invalid="ignore"):
        away = own.offset - own.height * np.nan_to_num(force[:, :2] / force[:, 2:])
    tilt = np.hypot(lean[:, 0], lean[:, 1])[:, None]
    towards = np.divide(lean, tilt, out=np.zeros_like(lean), where=tilt > 0)
    wobbles = "phi" in response.coordinates
    edge = half * (towards if wobbles else np.sign(lean))
    leans = tilt > 0 if wobbles else lean != 0
    pressed = np.where(leans, edge, np.clip(away, -half, half))
    foot = np.array(case.bodies[name].places[0]) + np.pad(pressed, [(0, 0), (0, 1)])
    middle = _moved(lean, wobbles, 0.0, own.half_foot)
    whole = f"interface/{joint}: {name} on {ground}"
    return {
        f"{whole}/tilt": response.tilt,
        f"{whole}/rise": middle[:, 2],
        f"{whole}/slide": np.zeros((len(lean), 2)),
        f"{whole}/force": force[:, 2],
        f"{whole}/resultant": force,
        f"{whole}/center": foot,
    }


def _lean(response: ModelResponse) -> Array:
    """Angles (n, 2) [rad] by which columns lean towards x and y."""
    known = response.coordinates
    if "phi" in known:
        towards = np.column_stack([np.cos(known["phi"]), np.sin(known["phi"])])
        leant: Array = known["theta"][:, None] * towards
        return leant
    still = np.zeros(len(response.time))
    along = known.get("theta_x", known.get("theta", still))
    return np.column_stack([along, known.get("theta_y", still)])


def _moved(
    lean: Array,
    wobbles: bool,
    height: float,
    half: tuple[float, float],
    aside: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """Displacement (n, 3) [m] of a point of a column that leans by `lean` (n, 2) [rad].

    A round column that wobbles turns about the place of its rim to which it leans; another one
    about its edges, in the planes of x and y as if the other did not move.

    Parameters
    ----------
    height
        of the point above the foot [m].
    half
        half the foot's extent along x and y (2,) [m].
    aside
        of the point from the middle of the foot (2,) [m], where it does not wobble.
    """
    moved = np.zeros((len(lean), 3))
    if wobbles:
        tilt = np.hypot(lean[:, 0], lean[:, 1])
        towards = np.divide(lean, tilt[:, None], out=np.zeros_like(lean), where=tilt[:, None] > 0)
        along, moved[:, 2] = moved_about_edge(tilt, height, half[0])
        moved[:, :2] = along[:, None] * towards
        return moved
    for axis in range(2):
        side = np.where(lean[:, axis] < 0, -1.0, 1.0)
        along, up = moved_about_edge(np.abs(lean[:, axis]), height, half[axis] - side * aside[axis])
        moved[:, axis] = side * along
        moved[:, 2] += up
    return moved
