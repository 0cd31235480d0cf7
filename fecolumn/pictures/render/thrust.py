"""What joints carry at an instant: resultants, thrust line and hinges, from the history."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.engines.scene.scene import JointFace, Scene
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.frame import Thrust
from fecolumn.pictures.render.result import Result

if TYPE_CHECKING:
    from fecolumn.pictures.render.pose import Poses


# Columns of an interface that are needed
_COLUMNS = ("force", "resultant", "center", "tilt")
#: Share of the largest force [-] from which on a joint carries
CARRIES = 1e-3
#: A joint that carries is a hinge where its slave has turned from its master by this share [-] of
#: the largest such turn of any joint in the analysis, and by so much [rad], which alone is enough
#: where the thrust is at an edge
TURNED, LEAST_TURN = 0.05, 1e-4
#: The thrust is at an edge where the centre of pressure is this near one of a face, over the face's
#: least extent [-]
ON_EDGE = 0.004
# The forces of a joint go through a body along the straight line from its one joint to its other
# where both are within this cosine of it
_THROUGH = 0.5
# Length of the arrow of a usual largest force, over the scene's size [-]
_ARROW = 0.15
# Instants at which the largest force is looked for
_SAMPLES = 100


def scene_size(scene: Scene) -> float:
    """Size [m] of a scene to which arrows and lines fit."""
    return float(np.sqrt(scene.height * scene.width))


def arrow_length(scene: Scene) -> float:
    """Length [m] of the arrow of a usual largest force."""
    return _ARROW * scene_size(scene)


class JointForces:
    """Forces in the joints of an analysis.

    Attributes
    ----------
    largest
        largest force [N] of the joints at an instant, in the median of instants: not of impacts.
    scale
        length of an arrow [m] of one newton.
    turn
        of slave from master [rad] from which on a joint is a hinge wherever its thrust is.
    """

    def __init__(self, result: Result, interval: float) -> None:
        """Forces in the mean over `interval` [s], so that those of impacts are their impulse over
        it.

        Raises
        ------
        InputError
            the history has no resultants.
        """
        scene, history = result.scene, result.history
        self._scene, self._interval, self._time = scene, interval, result.time
        self._contacts = [scene.contacts[k] for k in scene.shown]
        columns = {}
        for name in _COLUMNS:
            wanted = [f"interface/{one.joint}/{name}" for one in self._contacts]
            if missing := [one for one in wanted if one not in history]:
                raise InputError(
                    result.folder / "history.h5",
                    "",
                    None,
                    f'has no column "{missing[0]}", which --forces draws: it is of a rocking '
                    "model of a frame, which knows no forces of single joints, or of an earlier "
                    "version; run the case with another integration.engine into a new folder",
                )
            columns[name] = np.stack([history[one] for one in wanted], axis=1)
        self._force, self._resultant = columns["force"], columns["resultant"]
        self._center, self._tilt = columns["center"], columns["tilt"]
        samples = np.linspace(self._time[0], self._time[-1], _SAMPLES)
        largest = [np.linalg.norm(self._mean(time)[1], axis=1).max() for time in samples]
        pushed = [force for force in largest if force > 0] or [1.0]
        self.largest = float(np.median(pushed))
        self.scale = arrow_length(scene) / self.largest
        loaded = self._force > CARRIES * self.largest
        self.turn = max(LEAST_TURN, TURNED * float(self._tilt[loaded].max(initial=0.0)))
        outlines = {k: [one] for k, one in enumerate(scene.contacts)}
        for k in scene.other_sides:
            outlines[scene.contacts[k].pair].append(scene.contacts[k])
        self._edges = [
            [(face, _edges(scene, face), _extent(scene, face)) for face in outlines[k]]
            for k in scene.shown
        ]

    def _mean(self, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Normal forces (n,) [N], resultants (n, 3) [N] and centres (n, 3) [m] around a time [s]:
        rows of the history within half an interval, the nearest at least.
        """
        nearest = int(np.abs(self._time - time).argmin())
        first, end = np.searchsorted(self._time, time + self._interval / 2 * np.array([-1.0, 1.0]))
        rows = slice(min(first, nearest), max(end, nearest + 1))
        force = self._force[rows]
        total = force.sum(axis=0)
        weighed = np.einsum("rn,rna->na", force, self._center[rows])
        center = weighed / np.where(total > 0, total, 1.0)[:, None]
        return total / len(force), self._resultant[rows].mean(axis=0), center

    def carried(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Resultants (n, 3) [N] on the slaves at a time [s], 0 of joints that carry nothing, and
        centres of pressure (n, 3) [m].
        """
        force, resultants, centers = self._mean(time)
        return np.where((force > CARRIES * self.largest)[:, None], resultants, 0.0), centers

    def at(self, time: float, poses: Sequence[Poses], k: int) -> Thrust:
        """Forces at a time [s], when each body is at pose `k` of its `poses`."""
        resultants, centers = self.carried(time)
        carries = np.any(resultants != 0.0, axis=1)
        lines = np.broadcast_to(centers[:, None, None], (len(centers), 2, 2, 3)).copy()
        for body, piece in enumerate(self._scene.bodies):
            middle = poses[body].move(piece.center[None], k)[0]
            own = [
                (joint, side)
                for joint, one in enumerate(self._contacts)
                for side, part in enumerate((one.piece, one.master))
                if part == body and carries[joint]
            ]
            forces = [resultants[joint] * (1 - 2 * side) for joint, side in own]
            ends = _inside(middle, centers[[joint for joint, _ in own]], forces)
            for (joint, side), end in zip(own, ends):
                lines[joint, side, 1] = end
        tilts = self._tilt[int(np.abs(self._time - time).argmin())]
        flat = carries & ~np.array([one.domed for one in self._contacts], bool)
        on_edges = [
            flat[joint] and self._on_edge(joint, center, poses, k)
            for joint, center in enumerate(centers)
        ]
        at_edges = np.array(on_edges, bool)
        hinges = flat & (tilts > np.where(at_edges, LEAST_TURN, self.turn))
        return Thrust(centers, resultants, lines, hinges, at_edges & ~hinges)

    def _on_edge(self, joint: int, center: np.ndarray, poses: Sequence[Poses], k: int) -> bool:
        """Whether a centre of pressure (3,) [m] is on an edge of either face of a joint."""
        for face, edges, extent in self._edges[joint]:
            own = poses[face.piece]
            place = own.origin + own.rotation[k].T @ (center - own.foot[k])
            if len(edges) and _distance(face.plan(place), edges) < ON_EDGE * extent:
                return True
        return False


def _edges(scene: Scene, face: JointFace) -> np.ndarray:
    """Edges (n, 2, 2) [m] of a face in its own plan."""
    return face.plan(scene.points[face.outline]) if len(face.outline) else np.empty((0, 2, 2))


def _extent(scene: Scene, face: JointFace) -> float:
    """Least extent [m] of a face in plan."""
    plan = face.plan(scene.points[face.points])
    across = np.linalg.svd(plan - plan.mean(axis=0), full_matrices=False)[2]
    return float(np.ptp(plan @ across.T, axis=0).min())


def _distance(point: np.ndarray, edges: np.ndarray) -> float:
    """Of a point (2,) from the nearest of edges (n, 2, 2)."""
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    share = np.einsum("ea,ea->e", point - start, along) / np.maximum((along**2).sum(axis=1), 1e-300)
    nearest = start + np.clip(share, 0.0, 1.0)[:, None] * along
    return float(np.linalg.norm(nearest - point, axis=1).min())


def _inside(
    middle: np.ndarray, centers: np.ndarray, forces: Sequence[np.ndarray]
) -> list[np.ndarray]:
    """Ends (3,) [m] of the thrust line's parts from centres of pressure (n, 3) [m] into a body with
    its centre of mass in the `middle` (3,) [m].

    Forces that go through the body from joint to joint meet half-way; others are followed along
    their lines to where these are nearest to the centre of mass.
    """
    if len(forces) == 2:
        chord = centers[1] - centers[0]
        long = np.linalg.norm(chord)
        if all(
            side * (force @ chord) > _THROUGH * np.linalg.norm(force) * long
            for side, force in zip((1, -1), forces)
        ):
            return [centers.mean(axis=0)] * 2
    return [
        center + force * (force @ (middle - center)) / (force @ force)
        for center, force in zip(centers, forces)
    ]
