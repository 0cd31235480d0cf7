"""What pictures are made of: instants of a motion, and lines over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Fields:
    """Displacement (n_points, 3) [m], von Mises stress (n_cells,) [Pa] and contact pressure
    (n_points,) [Pa] of all pieces of a scene; and the centre (n_contacts, 2) [m] of that in the
    plan of each face, None where only the points tell it.
    """

    displacement: np.ndarray
    stress: np.ndarray
    pressure: np.ndarray
    centres: np.ndarray | None = None


@dataclass(frozen=True, slots=True)
class Thrust:
    """What is drawn of the forces in n joints, where they are; no length where a joint carries
    nothing.

    Attributes
    ----------
    centers
        (n, 3) [m] of pressure.
    resultants
        (n, 3) [N] on the slaves; 0 where nothing is carried.
    lines
        (n, 2, 2, 3) [m] parts of the thrust line from each centre into slave and master.
    hinges
        (n,) whether the joint is a hinge.
    """

    centers: np.ndarray
    resultants: np.ndarray
    lines: np.ndarray
    hinges: np.ndarray


@dataclass(frozen=True, slots=True)
class Frame:
    """An instant.

    Attributes
    ----------
    time
        [s].
    points
        (n, 3) [m] of the scene, as drawn.
    colour, base_colour
        of the faces of its surfaces (stress [Pa], nan of bodies that have none), or of the bodies'
        points (displacement [m]) and None.
    links
        (n, 2, 3) [m] their ends, both the same of a broken one; None where there are none.
    struts
        (n, 2, 3) [m] from floor to floor at the corners of buildings; None where there are none.
    faces
        of each contact (n_faces, k, 3) [m] corners of the slave's faces, true.
    pressures
        of each contact (n_faces,) [Pa] on them, or where it is not known their gaps [m].
    centres
        (n_contacts, 2) [m] of the pressure: in the plan of the face, of a body alone in that of the
        ground; nan of an open one, and where it is not known.
    thrust
        forces in the joints; None where they are not drawn.
    """

    time: float
    points: np.ndarray
    colour: np.ndarray
    base_colour: np.ndarray | None
    links: np.ndarray | None
    struts: np.ndarray | None
    faces: list[np.ndarray]
    pressures: list[np.ndarray]
    centres: np.ndarray
    thrust: Thrust | None = None


@dataclass(frozen=True, slots=True)
class Strip:
    """Lines over time.

    Attributes
    ----------
    title, label
        above, and of the axis with its unit.
    time
        (n,) [s].
    lines
        (values (n,) in the label's unit, name) of each.
    """

    title: str
    label: str
    time: np.ndarray
    lines: tuple[tuple[np.ndarray, str], ...]
