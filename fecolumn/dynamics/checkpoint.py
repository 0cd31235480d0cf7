"""Checkpoints: the full state of an analysis, independent of the number of ranks."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from fecolumn.dynamics.system import BodyState, State

_BODY = ("x", "v", "a", "inertia", "internal", "contact_a")
_CONTACT = ("forces", "anchors", "relative", "rotation", "ground")


def node_order(body) -> np.ndarray:
    """Node numbers in an order that does not depend on the partition: by part, then by position."""
    size = np.ptp(body.all_X, axis=0).max()
    keys = np.round(body.all_X / size * 1e9).astype(np.int64)
    return np.lexsort((keys[:, 0], keys[:, 1], keys[:, 2], body.all_part))


def gather_all(body, values: np.ndarray) -> np.ndarray | None:
    """Values (n_nodes, ...) of all ranks on rank 0, by node number; None elsewhere."""
    pieces = body.comm.gather(values)
    return np.concatenate(pieces) if body.comm.rank == 0 else None


def write_checkpoint(path: Path, system, state: State, extra: dict) -> None:
    """Write state and `extra` arrays atomically on rank 0; called on every rank."""
    arrays = {name: getattr(state, name) for name in _CONTACT} | {"time": state.time}
    for label, body, now in zip(("column", "base"), system.bodies, state.bodies):
        order = node_order(body)
        for name in _BODY:
            values = gather_all(body, getattr(now, name))
            if values is not None:
                arrays[f"{label}.{name}"] = values[order]
        arrays[f"{label}.energy"] = now.energy
    if system.column.comm.rank == 0:
        partial = path.with_name(path.name + ".partial")
        with open(partial, "wb") as file:
            np.savez(file, **arrays, **{f"extra.{name}": value for name, value in extra.items()})
            file.flush()
            os.fsync(file.fileno())
        os.replace(partial, path)


def read_checkpoint(path: Path, system) -> tuple[State, dict]:
    """State on this rank and the `extra` arrays of a checkpoint."""
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    bodies = []
    for label, body in zip(("column", "base"), system.bodies):
        order, mine = node_order(body), slice(body.first, body.first + body.n_owned)
        values = []
        for name in _BODY:
            scattered = np.empty_like(arrays[f"{label}.{name}"])
            scattered[order] = arrays[f"{label}.{name}"]
            values.append(scattered[mine].copy())
        bodies.append(BodyState(*values, float(arrays[f"{label}.energy"])))
    state = State(float(arrays["time"]), *bodies, *(arrays[name] for name in _CONTACT))
    return state, {name[6:]: value for name, value in arrays.items() if name.startswith("extra.")}
