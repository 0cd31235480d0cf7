"""States of a reduced analysis, few numbers each, from which deformation, stress and contact
pressure of the whole mesh are made again.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import poses_of
from fecolumn.engines.reduced.elastic import COORDINATE
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.atomic import write_hdf5
from fecolumn.foundation.summed import summed_at

if TYPE_CHECKING:
    from fecolumn.engines.reduced.engine import Engine
    from fecolumn.structures.model import BodyModel

#: File of the states in a result folder
STATES_FILE = "states.h5"
#: Most that the states of an analysis take [bytes]; before they would, every other one is dropped.
#: Half a minute at 25 a second takes a tenth of it.
_MOST_BYTES = 24_000_000
# What is kept of each state, and of each contact point that carries force: name, type, shape, unit
# and meaning. Of a structure of many bodies center, rotation and modal have an axis of bodies after
# that of states.
_OF_STATE = {
    "time": ("f8", (), "s", "time from the motion's begin"),
    "center": ("f8", (3,), "m", "centre of mass in the table's frame"),
    "rotation": ("f8", (3, 3), "-", "of the column's frame to the table's"),
    "points": ("i4", (), "-", "contact points that carry force"),
}
_OF_POINT = {
    "position": ("f8", (3,), "m", "of a contact point in the table's frame"),
    "force": ("f4", (3,), "N", "of the base on it"),
    "carriers": ("i4", (4,), "-", "nodes of the foot that carry it"),
    "weights": ("f4", (4,), "-", "their shares of it"),
}
# Of structures besides
_OF_PAIR = {
    "interface": ("i4", (), "-", "to which a contact point belongs"),
    "below": ("i4", (4,), "-", "nodes of the body below that take the force on a point"),
    "shares": ("f4", (4,), "-", "their shares of it, none of the ground"),
}
_BROKEN = ("i1", (), "-", "whether a link is broken")
_MODAL = ("f4", "m kg^(1/2)", "modal coordinates less their static part under the contact forces")


class Snapshot(NamedTuple):
    """An instant of a reduced column, or of a structure of nb bodies whose nodes come one after
    another.

    time [s]; center: (nb, 3) [m] and rotation: (nb, 3, 3) of their frames; modal: (nb, m) [m
    kg^1/2] coordinates of unit modal mass less their static part under the contact forces;
    position: (k, 3) [m] and force: (k, 3) [N] in the table's frame on the contact points that carry
    force, carriers: (k, 4) their nodes with weights (k, 4), below: (k, 4) nodes of moving masters
    with shares (k, 4); interface: (k,); broken: (nl,) links.
    """

    time: float
    center: Array
    rotation: Array
    modal: Array
    position: Array
    force: Array
    carriers: Array
    weights: Array
    interface: Array
    below: Array
    shares: Array
    broken: Array

    def at_nodes(self, count: int) -> Array:
        """Contact forces (count, 3) [N] on the nodes of all bodies, in the table's frame."""
        each = np.asarray(self.force, float)[:, None]
        shares = self.weights[:, :, None] * each, -self.shares[:, :, None] * each
        rows = np.concatenate([self.carriers, self.below])
        return summed_at(rows, np.concatenate(shares), count)


def state_of(engine: Engine) -> Snapshot:
    """The state of an engine's bodies now.

    Modal coordinates are kept without their static part F f / w^2: f are the modal forces of the
    contact, F is the filter of the step. That part follows the contact forces at once.
    """
    motion, structure = engine.motion, engine.structure
    center, rotation, coordinates = (
        motion.frames["center"].copy(),
        motion.rotation.copy(),
        motion.modal[:, COORDINATE],
    )
    loaded = np.flatnonzero(np.any(motion.forces != 0, axis=1))
    points, body = engine.work.points[loaded], structure.bodies.body
    poses = poses_of(structure.interfaces, center, rotation, motion.grounds)
    frames = poses["frame"][points["interface"]]
    moved = np.concatenate(
        [
            structure.bodies.pushes[one["first"] : one["first"] + one["count"]] @ own
            for one, own in zip(body, coordinates)
        ]
    )
    local = points["arm"] + np.einsum("pq,pqa->pa", points["weights"], moved[points["carriers"]])
    positions = (
        center[points["slave"]]
        + np.einsum("pab,pb->pa", rotation[points["slave"]], local)
        + points["lift"][:, None] * frames[:, :, 2]
    )
    forces = np.einsum("pab,pb->pa", frames, motion.forces[loaded])
    moving = points["master"] != GROUND
    state = Snapshot(
        motion.time,
        center,
        rotation,
        coordinates.copy(),
        positions,
        forces,
        points["carriers"].copy(),
        points["weights"].copy(),
        points["interface"].copy(),
        np.where(moving[:, None], points["below"], 0),
        np.where(moving[:, None], points["shares"], 0.0),
        motion.ties["broken"][: engine.view.links].copy(),
    )
    at_nodes = state.at_nodes(len(structure.bodies.pushes))
    for one, R, modal, squares in zip(body, rotation, state.modal, structure.squares):
        nodes, own = slice(one["first"], one["first"] + one["count"]), squares > 0
        modal[own] -= (
            np.einsum("iam,ia->m", structure.bodies.pushes[nodes][..., own], at_nodes[nodes] @ R)
            / squares[own]
        )
    return state


class States:
    """The states of an analysis, every so many steps, thinned out before they take more than
    _MOST_BYTES.

    Attributes
    ----------
    every
        steps between two of them.

    Parameters
    ----------
    models
        of each body, ColumnModel or BodyModel with the modes that move.
    names
        of a structure's bodies; none of a single column.
    """

    def __init__(self, every: int, models: list[BodyModel], names: Sequence[str] = ()) -> None:
        self.every, self.models, self.names = every, models, tuple(names)
        self._states: list[Any] = []
        self._bytes = 0

    def add(self, engine: Engine, last: bool = False) -> None:
        """Keep the state of the engine now; last: of the analysis, which is kept whatever its
        step.
        """
        state = state_of(engine)
        if self._states and state.time <= self._states[-1].time:
            return
        self._states.append(state)
        self._bytes += _size(state)
        if self._bytes > _MOST_BYTES and not last:
            self.every *= 2
            self._states = self._states[::2]
            self._bytes = sum(map(_size, self._states))

    def arrays(self) -> dict[str, Array]:
        """One array a quantity: of n states, or of the points of all of them one after the
        other.
        """
        states, bodies = self._states, (len(self.names),) if self.names else ()
        arrays = {
            name: np.array([getattr(state, name) for state in states], kind).reshape(
                len(states), *(bodies if shape else ()), *shape
            )
            for name, (kind, shape, *_) in _OF_STATE.items()
            if name != "points"
        }
        arrays["points"] = np.array([len(state.force) for state in states], "i4")
        arrays["modal"] = np.array([state.modal for state in states], _MODAL[0]).reshape(
            len(states), *bodies, -1 if states else 0
        )
        for name, (kind, shape, *_) in (_OF_POINT | (_OF_PAIR if self.names else {})).items():
            arrays[name] = np.concatenate(
                [getattr(state, name) for state in states] or [np.empty((0, *shape))]
            ).astype(kind)
        if self.names:
            arrays["broken"] = np.array([state.broken for state in states], _BROKEN[0])
        return arrays

    def to_resume(self) -> dict[str, Array]:
        """Arrays of a checkpoint that `resumed` takes."""
        return {
            f"states.{name}": values
            for name, values in (self.arrays() | {"every": np.array(self.every)}).items()
        }

    def resumed(self, saved: dict) -> None:
        """Take over what an earlier run had, from the arrays of its checkpoint; nothing of one that
        kept none.
        """
        arrays = {name[7:]: values for name, values in saved.items() if name.startswith("states.")}
        if arrays:
            self.every = max(self.every, int(arrays["every"]))
            self._states = [state_at(arrays, k) for k in range(len(arrays["time"]))]
            self._bytes = sum(map(_size, self._states))

    def write(self, folder: Path, attributes: dict) -> None:
        """Write the file."""

        def fill(file: Any) -> None:
            file.attrs.update(attributes)
            if self.names:
                file.attrs["bodies"] = list(self.names)
            of_modes = {
                "frequencies": [model.frequencies for model in self.models],
                "signature": [signature(model) for model in self.models],
            }
            arrays = self.arrays() | {
                name: modes_of(each) if self.names else each[0] for name, each in of_modes.items()
            }
            told = {
                **_OF_STATE,
                **_OF_POINT,
                **_OF_PAIR,
                "broken": _BROKEN,
                "modal": (*_MODAL[:1], (), *_MODAL[1:]),
                "frequencies": ("", (), "rad/s", "of the modes"),
                "signature": (
                    "",
                    (),
                    "kg^(-1/2)",
                    "of the modes' shapes, which tells whether a model has the same",
                ),
            }
            for name, values in arrays.items():
                dataset = file.create_dataset(
                    name,
                    data=values,
                    **(dict(compression="gzip", shuffle=True) if values.size > 1000 else {}),
                )
                dataset.attrs["unit"], dataset.attrs["meaning"] = told[name][2:]

        write_hdf5(folder / STATES_FILE, fill)


def modes_of(each: list[Array]) -> Array:
    """A row (m,) for each body of what its modes have, zeros where it has fewer modes than another:
    (nb, m).
    """
    rows = np.zeros((len(each), max(map(len, each))))
    for row, values in zip(rows, each):
        row[: len(values)] = values
    return rows


def read_states(file: Path) -> dict[str, Array]:
    """Arrays of the file by name, as of `States.arrays`, with "frequencies" [rad/s] and `signature`
    of the modes, and the names of a structure's "bodies".

    Raises
    ------
    OSError, KeyError
        no such file, or none of states.
    """
    import h5py

    with h5py.File(file) as content:
        bodies = tuple(map(str, content.attrs.get("bodies", ())))
        names = (
            *_OF_STATE,
            *_OF_POINT,
            "modal",
            "frequencies",
            "signature",
            *((*_OF_PAIR, "broken") if bodies else ()),
        )
        return {name: content[name][()] for name in names} | {"bodies": np.array(bodies)}


def signature(model: BodyModel) -> Array:
    """(m,) [kg^-1/2] a fixed sum over the shapes at the foot of each mode: other signs, or other
    modes of a pair of one frequency, make another.
    """
    count = model.shapes.shape[0] * 3
    return np.einsum("iam,ia->m", model.shapes, np.cos(1.0 + np.arange(count)).reshape(-1, 3))


def state_at(arrays: dict[str, Array], k: int) -> Snapshot:
    """Snapshot `k` of the arrays of `States.arrays`."""
    first = int(arrays["points"][:k].sum())
    points, count = slice(first, first + int(arrays["points"][k])), int(arrays["points"][k])
    rotation = np.reshape(arrays["rotation"][k], (-1, 3, 3))
    of_points = [
        np.asarray(arrays[name][points], int if kind.startswith("i") else float)
        if name in arrays
        else np.zeros((count, *shape), int if kind.startswith("i") else float)
        for name, (kind, shape, *_) in (_OF_POINT | _OF_PAIR).items()
    ]
    return Snapshot(  # type: ignore[call-arg]  # of unknown number
        float(arrays["time"][k]),
        np.reshape(arrays["center"][k], (-1, 3)),
        rotation,
        np.reshape(np.asarray(arrays["modal"][k], float), (len(rotation), -1)),
        *of_points,
        np.asarray(arrays["broken"][k], bool) if "broken" in arrays else np.zeros(0, bool),
    )


def _size(state: Snapshot) -> int:
    """Bytes in the file before it is compressed."""
    return (
        4 * state.modal.size
        + 14
        + 96 * len(state.center)
        + 68 * len(state.force)
        + (36 * len(state.force) if len(state.center) > 1 else 0)
    )
