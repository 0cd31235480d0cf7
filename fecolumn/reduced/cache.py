"""Reduced models on disk: made once for a specimen's mesh and material, opened in milliseconds by every analysis of it.

A model is a folder named after the content it was made from, so that nothing has to be invalidated:

    column.npz      ColumnModel    base.npz    top of the base, which of its nodes are known
    compliance.npy  (k, 3, k, 3) of these nodes, read through the operating system's page cache, which all workers share
    fields.npy      (m, n_nodes, 3) mode shapes of the whole column, for pictures

"""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import hashlib
import json
import os
import shutil
import tempfile
from pathlib import Path

import numpy as np

from fecolumn._compiled import cache_folder
from fecolumn.case import Case, content
from fecolumn.contact.base_top import BaseTop
from fecolumn.reduced.model import ColumnModel

# A new number makes all models afresh
FORMAT = 1
# Elastic modes that a model keeps at least, so that analyses with fewer share it
KEPT_MODES = 40


class KnownBase:
    """The base plate as far as its compliance is known; more of it is found by the finite-element model when asked for.

    Attributes as of `contact.base_plate.BasePlate`: grid, slot, compliance (blocks), frequency. dofs: of its mesh.
    """

    def __init__(self, points, known, compliance, frequency: float, dofs: int, make):
        self.grid, self.compliance, self.frequency, self.dofs = BaseTop(points), compliance, float(frequency), int(dofs)
        self.known, self._make = known, make
        self.slot = np.full(len(points), -1, np.int64)
        self.slot[known] = np.arange(len(known))

    def need(self, wanted: np.ndarray) -> None:
        """Make sure that the compliance holds the top nodes `wanted`; beyond the slide allowance this takes seconds."""
        if (self.slot[wanted] >= 0).all():
            return
        plate = self._make()
        if not np.allclose(plate.grid.points, self.grid.points):
            raise RuntimeError("the cached base has other nodes than the mesh made now: delete the model cache")
        plate.adopt(self.known, self.compliance)
        plate.need(wanted)
        self.known, self.compliance, self.slot = plate.known, plate.compliance, plate.slot


def model_key(case: Case) -> str:
    """Name of the model of a case: what of the case its mesh and operators are made from."""
    tables = {name: dataclasses.asdict(section) if (section := getattr(case, name)) else None
              for name in ("column", "cap", "base", "material", "mesh")}
    tables["column"]["mesh_file"] = content(case.column.mesh_file)
    tables |= dict(modes=max(case.n_modes, KEPT_MODES), format=FORMAT)
    return hashlib.sha256(json.dumps(tables, sort_keys=True).encode()).hexdigest()[:16]


def load_model(case: Case, say=lambda text: None) -> tuple[ColumnModel, KnownBase, Path]:
    """Column and base of a case, and the folder of their model; made and kept if there is none yet.

    Args:
        say: told when a model has to be made, which takes up to a minute.
    """
    folder = cache_folder() / f"model-{model_key(case)}"
    if not folder.is_dir():
        with _alone(folder):  # of the workers of a study that start at once, one makes it
            if not folder.is_dir():
                say("making the reduced model of the specimen (once)")
                _make(case, folder)
    with np.load(folder / "column.npz") as file:
        values = {name: file[name] if file[name].ndim else file[name].item() for name in file.files}
    with np.load(folder / "base.npz") as file:
        points, known, frequency, dofs = (file[name] for name in ("points", "known", "frequency", "dofs"))
    # copy on write: compiled code wants arrays that may be written to
    compliance = np.load(folder / "compliance.npy", mmap_mode="c").view(np.ndarray).transpose(0, 2, 1, 3)
    base = KnownBase(points, known, compliance, frequency, dofs, lambda: make_bodies(case)[1])
    return ColumnModel(**values).with_modes(case.n_modes), base, folder


@contextlib.contextmanager
def _alone(folder: Path):
    """Hold the right to make a model; who comes second waits. It ends with the process that has it."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    file = folder.parent / f".{folder.name}.lock"
    with open(file, "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
        file.unlink(missing_ok=True)


def make_bodies(case: Case):
    """The column's Body and the BasePlate of a case, and the specimen's mesh."""
    from mpi4py import MPI

    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.dynamics.assembly import base_body, column_body
    from fecolumn.mesh.specimen import specimen_mesh

    specimen = specimen_mesh(case)
    return column_body(case, specimen, MPI.COMM_SELF), BasePlate(base_body(case, specimen, MPI.COMM_SELF)), specimen


def _make(case: Case, folder: Path) -> None:
    from fecolumn.dynamics.assembly import foot_of
    from fecolumn.dynamics.observer import top_of
    from fecolumn.reduced.build import column_model

    body, plate, specimen = make_bodies(case)
    foot, areas = foot_of(case, specimen, body)
    model, fields = column_model(body, foot, areas, *top_of(body, specimen), max(case.n_modes, KEPT_MODES))
    plate.need(_under(plate.grid.points, model.reference, case.base.slide_allowance_m))
    folder.parent.mkdir(parents=True, exist_ok=True)
    partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    partial.chmod(0o755)
    try:
        for name, values in (("column", {field.name: getattr(model, field.name) for field in dataclasses.fields(model)}),
                             ("base", dict(points=plate.grid.points, known=plate.known, frequency=plate.frequency, dofs=3 * plate.body.n_nodes))):
            with open(partial / f"{name}.npz", "wb") as file:
                np.savez(file, **values)
        np.save(partial / "compliance.npy", np.ascontiguousarray(plate.compliance.transpose(0, 2, 1, 3)))
        np.save(partial / "fields.npy", fields)
        os.replace(partial, folder)
    except OSError:
        # another worker made it in the meantime
        if not folder.is_dir():
            raise
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _under(points, foot, allowance: float) -> np.ndarray:
    """Top nodes (k,) that a foot at (n, 3) [m] may press when it slides by `allowance` [m] to any side."""
    x, y = (np.unique(np.round(points[:, axis], 12)) for axis in (0, 1))
    cell = max(np.diff(lines[np.abs(lines) <= np.abs(foot[:, :2]).max() + allowance]).max() for lines in (x, y))
    radius = np.linalg.norm(foot[:, :2], axis=1)
    distance, reach = np.linalg.norm(points[:, :2], axis=1), allowance + 1.5 * cell
    return np.flatnonzero((distance <= radius.max() + reach) & (distance >= radius.min() - reach))
