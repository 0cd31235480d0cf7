"""Elastic deformation of bodies and pressure between them on the page, where fields or states are
known.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.page.parts import RigidPart
from fecolumn.pictures.render.pose import nearest_rigid
from fecolumn.pictures.render.result import Result

# Instants at which fields are read: each takes what a picture of a movie takes
_MOST_INSTANTS = 250
# Shapes by which a body deforms, at most, and numbers of all of them: some 2 MB
_MOST_SHAPES, _MOST_NUMBERS = 16, 700_000
# What the shapes leave of the largest deformation [-]
_LEFT = 0.01
# Faces with a pressure at all instants: some 1 MB
_MOST_FACES = 700_000
# Share of the pressures [-] that colours range over, and how many decades: as of movies
_RANGE, _DECADES = 99.8, 3
# Colours of pressure: 0 none, 1 the least to 255 the largest
_COLOURS = 255


@dataclass(frozen=True, slots=True)
class Deformation:
    """How one part deforms, in its own axes: a sum of shapes.

    Attributes
    ----------
    shapes
        (r, n, 3) [m] at the part's points.
    shares
        (t, r) of each at the instants, up to 1 in magnitude.
    """

    shapes: np.ndarray
    shares: np.ndarray


@dataclass(frozen=True, slots=True)
class PressedFace:
    """The slave's face of a joint.

    Attributes
    ----------
    body
        number of the slave.
    corners
        (m, k, 3) [m] of its elements' faces from the slave's place.
    levels
        (t, m) colour of the pressure on each, from 0, none, to 255.
    """

    body: int
    corners: np.ndarray
    levels: np.ndarray


@dataclass(frozen=True, slots=True)
class Flexure:
    """What fields or states add to the motion.

    Attributes
    ----------
    times
        (t,) [s] of the instants.
    deformations
        of each part, None of one that stays rigid.
    largest
        deformation [m].
    faces
        under pressure.
    pressures
        [Pa] of the least and of the largest colour.
    """

    times: np.ndarray
    deformations: tuple[Deformation | None, ...]
    largest: float
    faces: tuple[PressedFace, ...]
    pressures: tuple[float, float]


def flexure_of(result: Result, parts: list[RigidPart], times: np.ndarray) -> Flexure | None:
    """Deformation and pressure between the first and the last of `times` [s]; None where neither
    fields nor states are known at two instants of these, or nothing deforms.
    """
    try:
        return _flexure(result, parts, times)
    except InputError as error:  # states of a model that has been made anew with other modes
        warnings.warn(f"{error}; bodies are drawn rigid", stacklevel=2)
        return None


def _flexure(result: Result, parts: list[RigidPart], times: np.ndarray) -> Flexure | None:
    series, scene = result.frames, result.scene
    inside = np.flatnonzero((series.time >= times[0] - 1e-9) & (series.time <= times[-1] + 1e-9))
    if len(inside) < 2 or not scene.has_stress:
        return None
    shown = [k for k, one in enumerate(scene.contacts) if not one.domed]  # both sides of a joint
    count = sum(len(scene.contacts[k].faces) for k in shown)
    most = max(2, min(_MOST_INSTANTS, _MOST_FACES // max(count, 1)))
    chosen = inside[np.unique(np.linspace(0, len(inside) - 1, most).astype(int))]
    rows = _rows_of(result, parts)
    bent = [np.zeros((len(chosen), 0 if row is None else len(row), 3)) for row in rows]
    pressed = [np.zeros((len(chosen), len(scene.contacts[k].faces))) for k in shown]
    for place, number in enumerate(chosen):
        fields = series.read(number)
        moved = scene.points + fields.displacement
        for body in {part.body for part in parts if scene.bodies[part.body].stressed}:
            own = scene.own(body)
            rotation, shift = nearest_rigid(scene.points[own], moved[own])
            local = (moved[own] - shift) @ rotation - scene.points[own]
            for k, part in enumerate(parts):
                if part.body == body and rows[k] is not None:
                    bent[k][place] = local[rows[k]]
        for one, k in zip(pressed, shown):
            one[place] = fields.pressure[scene.contacts[k].faces].mean(axis=1)
    room = _MOST_NUMBERS // max(1, 3 * sum(one.shape[1] for one in bent))
    deformations = tuple(_shapes(one, min(_MOST_SHAPES, max(room, 2))) for one in bent)
    largest = max((float(np.linalg.norm(one, axis=2).max()) for one in bent if one.size), default=0)
    faces, pressures = _faces(result, shown, pressed)
    return Flexure(series.time[chosen], deformations, largest, faces, pressures)


def _rows_of(result: Result, parts: list[RigidPart]) -> list[np.ndarray | None]:
    """Of each part the point of its body nearest to each of its points; None of a rigid one."""
    found: list[np.ndarray | None] = []
    for part in parts:
        piece = result.scene.bodies[part.body]
        if not piece.stressed:
            found.append(None)
            continue
        found.append(cKDTree(piece.upright).query(part.points + part.rest)[1])
    return found


def _shapes(bent: np.ndarray, most: int) -> Deformation | None:
    """The few shapes that make a deformation (t, n, 3) [m], by its singular values."""
    flat = bent.reshape(len(bent), -1)
    if not flat.size or not np.abs(flat).max() > 0:
        return None
    shares, sizes, shapes = np.linalg.svd(flat, full_matrices=False)
    # what is left out is no more than this share of all in the mean square
    left = np.sqrt(np.append(np.cumsum(sizes[::-1] ** 2)[::-1], 0.0)) / np.linalg.norm(sizes)
    count = min(int(np.argmax(left <= _LEFT)), most, len(sizes))
    reach = np.abs(shares[:, :count]).max(axis=0)
    scaled = shapes[:count] * (sizes[:count] * reach)[:, None]
    return Deformation(scaled.reshape(count, -1, 3), shares[:, :count] / reach)


def _faces(result: Result, shown: list[int], pressed: list[np.ndarray]) -> tuple:
    """Faces under pressure and the range of their colours [Pa]."""
    every = np.concatenate([one.ravel() for one in pressed]) if pressed else np.zeros(0)
    if not every.size or not every.max() > 0:
        return (), (0.0, 0.0)
    most = float(np.percentile(every, _RANGE)) or float(every.max())
    least = most / 10**_DECADES
    found = []
    for k, one in zip(shown, pressed):
        contact = result.scene.contacts[k]
        with np.errstate(divide="ignore"):
            share = np.log10(one / least) / _DECADES
        levels = np.where(one > 0, np.clip(1 + share * (_COLOURS - 1), 1, _COLOURS), 0)
        corners = result.scene.points[contact.faces] - result.poses[contact.piece].origin
        found.append(PressedFace(contact.piece, corners, np.rint(levels).astype(np.uint8)))
    return tuple(found), (least, most)
