"""Checkpoints: the full state of an analysis, independent of the number of ranks."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.interface import RIM
from fecolumn.contact.points import CONTACT
from fecolumn.contact.pose import GROUND_STATE
from fecolumn.engines.dynamics.links import TIE
from fecolumn.engines.dynamics.system import State
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.files import read_bytes

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.system import System
    from fecolumn.fem.body import Body

_FIELDS = ("x", "v", "a", "contact_a", "internal", "surface_a")
# arrays and fields that need not be finite: the angle of the rim's lowest point, nan while the foot
# touches with its nodes only; of a pair of bodies whose contact is found what is not known yet
_NOT_FINITE = {"angle", "stick.key", "stick.angles", "extra.stick.angles"}
_NOT_FINITE |= {"separation", "turn_then"}
# A file knows no records
_RECORDS = {"contact": CONTACT, "rims": RIM, "ties": TIE, "grounds": GROUND_STATE}
_SHARED = (
    "time",
    "strain",
    "rotation",
    "contact",
    "static",
    "ground",
    "rims",
    "ties",
    "surface_forces",
    "grounds",
)


def node_order(body: Body) -> Array:
    """Node numbers in an order that does not depend on the partition: by part, then by position."""
    size = np.ptp(body.all_X, axis=0).max()
    keys = np.round(body.all_X / size * 1e9).astype(np.int64)
    return np.lexsort((keys[:, 0], keys[:, 1], keys[:, 2], body.all_part))


def gather_all(body: Body, values: Array) -> Array | None:
    """Values (n_nodes, ...) of all ranks on rank 0, by node number; None elsewhere."""
    pieces: Any = body.comm.gather(values)
    return np.concatenate(pieces) if body.comm.rank == 0 else None


def write_checkpoint(path: Path, system: System, state: State, extra: dict) -> None:
    """Write state and `extra` arrays atomically on rank 0; called on every rank."""
    bodies = system.bodies
    orders = {part: node_order(part) for part in set(bodies.parts)}
    known = [name for name in _FIELDS + _SHARED if getattr(state, name) is not None]
    arrays = {name: getattr(state, name) for name in _SHARED if name in known}
    for name in filter(known.__contains__, _FIELDS):
        values: list[Any] = [
            gather_all(part, getattr(state, name)[rows])
            for part, rows in zip(bodies.parts, bodies.rows)
        ]
        if bodies.comm.rank == 0:
            arrays[name] = np.concatenate(
                [one[orders[part]] for part, one in zip(bodies.parts, values)]
            )
    if bodies.comm.rank == 0:
        content = io.BytesIO()
        np.savez(content, **arrays, **{f"extra.{name}": value for name, value in extra.items()})
        write_bytes(path, content.getvalue())


def read_arrays(path: Path) -> dict[str, Array]:
    """Arrays of a checkpoint by name.

    Raises
    ------
    Exception
        of the many kinds a damaged archive leads to.
    """
    with np.load(io.BytesIO(read_bytes(path))) as file:
        arrays = {name: file[name] for name in file.files}
    for name, values in arrays.items():
        parts = (
            {part: values[part] for part in values.dtype.names}
            if values.dtype.names
            else {name: values}
        )
        for part, numbers in parts.items():
            if (
                numbers.dtype.kind == "f"
                and not np.isfinite(numbers).all()
                and part not in _NOT_FINITE
            ):
                raise ValueError(f"{name} is not finite")
    return arrays


def read_state(arrays: dict[str, Array], system: System) -> tuple[State, dict]:
    """State on this rank and the `extra` arrays of a checkpoint of the full-order engine."""
    parts = system.bodies.parts
    orders = {part: node_order(part) for part in set(parts)}
    values: dict[str, Any] = {
        name: float(arrays[name]) if arrays[name].ndim == 0 else arrays[name]
        for name in _SHARED
        if name in arrays
    }
    values |= {name: values[name].astype(kind) for name, kind in _RECORDS.items()}
    ends = np.cumsum([part.n_nodes for part in parts])
    for name in filter(arrays.__contains__, _FIELDS):
        mine = []
        for part, kept in zip(parts, np.split(arrays[name], ends[:-1]), strict=True):
            by_node = np.empty((part.n_nodes, *kept.shape[1:]))
            by_node[orders[part]] = kept
            mine.append(by_node[part.first : part.first + part.n_owned])
        values[name] = np.concatenate(mine)
    return State(**values), {
        name[6:]: value for name, value in arrays.items() if name.startswith("extra.")
    }


def read_checkpoint(path: Path, system: System) -> tuple[State, dict]:
    """State on this rank and the `extra` arrays that `write_checkpoint` wrote."""
    return read_state(read_arrays(path), system)
