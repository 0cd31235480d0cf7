"""States of a reduced analysis, few numbers each, from which deformation, stress and contact pressure of the whole mesh are made again."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from fecolumn.atomic import write_hdf5
from fecolumn.reduced.elastic import COORDINATE

#: File of the states in a result folder
NAME = "states.h5"
#: Most that the states of an analysis take [bytes]; before they would, every other one is dropped. Half a minute at 25 a second takes a tenth of it.
MOST_BYTES = 24_000_000
# What is kept of each state, and of each contact point that carries force: name, type, shape, unit and meaning
_OF_STATE = {
    "time": ("f8", (), "s", "time from the motion's begin"), "center": ("f8", (3,), "m", "centre of mass in the table's frame"),
    "rotation": ("f8", (3, 3), "-", "of the column's frame to the table's"), "points": ("i4", (), "-", "contact points that carry force")}
_OF_POINT = {
    "position": ("f8", (3,), "m", "of a contact point in the table's frame"), "force": ("f4", (3,), "N", "of the base on it"),
    "carriers": ("i4", (4,), "-", "nodes of the foot that carry it"), "weights": ("f4", (4,), "-", "their shares of it")}
_MODAL = ("f4", "m kg^(1/2)", "modal coordinates less their static part under the contact forces")


class State(NamedTuple):
    """An instant of a reduced column.

    time [s]; center: (3,) [m] and rotation: (3, 3) of its frame; modal: (m,) [m kg^1/2] coordinates of unit modal mass less their static part under the contact
    forces; position: (k, 3) [m] and force: (k, 3) [N] of the contact points that carry force, carriers: (k, 4) their nodes of the foot with weights (k, 4).
    """

    time: float
    center: np.ndarray
    rotation: np.ndarray
    modal: np.ndarray
    position: np.ndarray
    force: np.ndarray
    carriers: np.ndarray
    weights: np.ndarray

    def at_nodes(self, count: int) -> np.ndarray:
        """Contact forces (count, 3) [N] on the foot's nodes."""
        forces = np.zeros((count, 3))
        np.add.at(forces, self.carriers, self.weights[:, :, None] * np.asarray(self.force, float)[:, None])
        return forces


def state_of(engine) -> State:
    """The state of an engine's first body now.

    What contact forces f do at once has gone into the modes, too: with phi filtered to the step, f as modal forces, that part is F f / w^2.
    """
    motion, structure = engine.motion, engine.structure
    center, rotation, coordinates = motion.frames["center"][0], motion.rotation[0], motion.modal[0, COORDINATE]
    loaded = np.flatnonzero(np.any(motion.forces != 0, axis=1))
    points, forces = engine.work.points[loaded], motion.forces[loaded]
    moved = np.einsum("iam,m->ia", structure.pushes, coordinates)
    positions = center + (points["arm"] + np.einsum("pq,pqa->pa", points["weights"], moved[points["carriers"]])) @ rotation.T
    positions[:, 2] += points["lift"]
    state = State(motion.time, center.copy(), rotation.copy(), coordinates, positions, forces.copy(), points["carriers"].copy(), points["weights"].copy())
    given = np.einsum("iam,ia->m", structure.pushes, state.at_nodes(len(structure.pushes)) @ rotation) / structure.squares[0]
    return state._replace(modal=coordinates - given)


class States:
    """The states of an analysis, every so many steps, thinned out before they take more than MOST_BYTES.

    Attributes:
        every: steps between two of them.
    """

    def __init__(self, every: int):
        self.every, self._states = every, []
        self._bytes = 0

    def add(self, engine, last: bool = False) -> None:
        """Keep the state of the engine now; last: of the analysis, which is kept whatever its step."""
        state = state_of(engine)
        if self._states and state.time <= self._states[-1].time:
            return
        self._states.append(state)
        self._bytes += _size(state)
        if self._bytes > MOST_BYTES and not last:
            self.every *= 2
            self._states = self._states[::2]
            self._bytes = sum(map(_size, self._states))

    def arrays(self) -> dict[str, np.ndarray]:
        """One array a quantity: of n states, or of the points of all of them one after the other."""
        states = self._states
        arrays = {name: np.array([getattr(state, name) for state in states], kind).reshape(-1, *shape)
                  for name, (kind, shape, *_) in _OF_STATE.items() if name != "points"}
        arrays["points"] = np.array([len(state.force) for state in states], "i4")
        arrays["modal"] = np.array([state.modal for state in states], _MODAL[0]).reshape(len(states), -1)
        for name, (kind, shape, *_) in _OF_POINT.items():
            arrays[name] = np.concatenate([getattr(state, name) for state in states] or [np.empty((0, *shape))]).astype(kind)
        return arrays

    def to_resume(self) -> dict[str, np.ndarray]:
        """Arrays of a checkpoint that `resumed` takes."""
        return {f"states.{name}": values for name, values in (self.arrays() | {"every": np.array(self.every)}).items()}

    def resumed(self, saved: dict) -> None:
        """Take over what an earlier run had, from the arrays of its checkpoint; nothing of one that kept none."""
        arrays = {name[7:]: values for name, values in saved.items() if name.startswith("states.")}
        if arrays:
            self.every = max(self.every, int(arrays["every"]))
            self._states = [state_at(arrays, k) for k in range(len(arrays["time"]))]
            self._bytes = sum(map(_size, self._states))

    def write(self, folder: Path, model, attributes: dict) -> None:
        """Write the file; model: ColumnModel whose modes these are."""
        def fill(file):
            file.attrs.update(attributes)
            arrays = self.arrays() | {"frequencies": model.frequencies, "signature": signature(model)}
            told = {**_OF_STATE, **_OF_POINT, "modal": (*_MODAL[:1], (), *_MODAL[1:]), "frequencies": ("", (), "rad/s", "of the modes"),
                    "signature": ("", (), "kg^(-1/2)", "of the modes' shapes, which tells whether a model has the same")}
            for name, values in arrays.items():
                dataset = file.create_dataset(name, data=values, **(dict(compression="gzip", shuffle=True) if values.size > 1000 else {}))
                dataset.attrs["unit"], dataset.attrs["meaning"] = told[name][2:]

        write_hdf5(folder / NAME, fill)


def read_states(file: Path) -> dict[str, np.ndarray]:
    """Arrays of the file by name, as of `States.arrays`, with "frequencies" [rad/s] and `signature` of the modes.

    Raises:
        OSError, KeyError: no such file, or none of states.
    """
    import h5py

    with h5py.File(file) as content:
        return {name: content[name][()] for name in (*_OF_STATE, *_OF_POINT, "modal", "frequencies", "signature")}


def signature(model) -> np.ndarray:
    """(m,) [kg^-1/2] a fixed sum over the shapes at the foot of each mode: other signs, or other modes of a pair of one frequency, make another."""
    count = model.shapes.shape[0] * 3
    return np.einsum("iam,ia->m", model.shapes, np.cos(1.0 + np.arange(count)).reshape(-1, 3))


def state_at(arrays: dict[str, np.ndarray], k: int) -> State:
    """State `k` of the arrays of `States.arrays`."""
    first = int(arrays["points"][:k].sum())
    points = slice(first, first + int(arrays["points"][k]))
    return State(float(arrays["time"][k]), arrays["center"][k], arrays["rotation"][k], np.asarray(arrays["modal"][k], float),
                 *(np.asarray(arrays[name][points], float if name != "carriers" else int) for name in _OF_POINT))


def _size(state: State) -> int:
    """Bytes in the file before it is compressed."""
    return 4 * len(state.modal) + 110 + 68 * len(state.force)
