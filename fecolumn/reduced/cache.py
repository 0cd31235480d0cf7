"""Reduced models on disk: made once for a specimen's mesh and material, opened in milliseconds by
every analysis of it.

A model is a folder named after the content it was made from, so that nothing has to be invalidated:

    column.npz        ColumnModel    base.npz    top of the base    fields.npy    (m, n_nodes, 3) mode shapes of the whole column
    known-R.npy       (k,) nodes of the base's top within reach R of the foot
    compliance-R.npy  (k, 3, k, 3) of these nodes, read through the operating system's page cache,
        which all workers share
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import importlib.metadata
import json
import os
import shutil
import tempfile
import time
from pathlib import Path

import numpy as np

from fecolumn._compiled import cache_folder
from fecolumn.case import section_table
from fecolumn.contact.base_top import BaseTop
from fecolumn.contact.unbounded_base import UnboundedBase, rigid_base
from fecolumn.lock import alone
from fecolumn.reduced.model import ColumnModel
from fecolumn.short_form import ShortForm
from fecolumn.sources import digest_of, files_of

# Sources that a model is made from: a change in any of them makes models anew. Not those that only
# read what is made, nor those that fill in a case's sizes: the key has the case as it is when
# finished.
SOURCES = (
    "_dolfinx.py",
    "material",
    "fem/body.py",
    "fem/effective.py",
    "fem/free_body.py",
    "fem/modes.py",
    "fem/rayleigh.py",
    "mesh/base_plate.py",
    "mesh/bricks.py",
    "mesh/cap_plate.py",
    "mesh/column.py",
    "mesh/gmsh_section.py",
    "mesh/imported.py",
    "mesh/jacobian.py",
    "mesh/section.py",
    "mesh/specimen.py",
    "mesh/surface.py",
    "mesh/tie.py",
    "contact/base_plate.py",
    "contact/base_top.py",
    "contact/footprint.py",
    "contact/layer.py",
    "contact/tolerances.py",
    "contact/unbounded_base.py",
    "dynamics/assembly.py",
    "dynamics/observer.py",
    "reduced/build.py",
    "reduced/cache.py",
)
# Elastic modes that a model keeps at least, so that analyses with fewer share it
KEPT_MODES = 100
# Least reach of the first compliance of the base around the foot, over the foot's width
LEAST_REACH = 0.1


class KnownBase:
    """The base plate as far as its compliance is known: under the foot and the slide allowance,
    twice as far around, four times ...

    How far it is known depends on where the column went, its numbers do not: each reach is found
    once as a whole, and kept on disk.

    Attributes as of `contact.base_plate.BasePlate`: grid, slot, compliance (blocks), frequency.
    dofs: of its mesh. made_s, made_cpu_s: wall and processor time spent on reaches that no analysis
    had needed before [s].
    """

    def __init__(self, folder: Path, make):
        self._folder, self._make, self.made_s, self.made_cpu_s = folder, make, 0.0, 0.0
        with np.load(folder / "base.npz") as file:
            self.grid, self.frequency, self.dofs = (
                BaseTop(file["points"]),
                float(file["frequency"]),
                int(file["dofs"]),
            )
            self._allowance = float(file["allowance"])
            # of several feet the first place of each
            self._feet = np.split(
                file["foot"], file["firsts"][1:] if "firsts" in file.files else []
            )
        self._open(0)

    def need(self, wanted: np.ndarray) -> None:
        """Make sure that the compliance holds the top nodes `wanted`; a reach that no analysis
        needed before takes seconds.
        """
        while (self.slot[wanted] < 0).any():
            reach = self._reach + 1
            if not self._file("known", reach).is_file():
                began, cpu_began = time.perf_counter(), time.process_time()
                with alone(self._folder):
                    if not self._file("known", reach).is_file():
                        self._extend(reach)
                self.made_s += time.perf_counter() - began
                self.made_cpu_s += time.process_time() - cpu_began
            self._open(reach)

    def _file(self, name: str, reach: int) -> Path:
        return self._folder / f"{name}-{reach}.npy"

    def _open(self, reach: int) -> None:
        known = np.load(self._file("known", reach))
        # copy on write: compiled code wants arrays that may be written to
        self.compliance = (
            np.load(self._file("compliance", reach), mmap_mode="c")
            .view(np.ndarray)
            .transpose(0, 2, 1, 3)
        )
        self.slot = np.full(len(self.grid.points), -1, np.int64)
        self.slot[known] = np.arange(len(known))
        self._known, self._reach = known, reach

    def _extend(self, reach: int) -> None:
        plate = self._make()
        if not np.allclose(plate.grid.points, self.grid.points):
            raise RuntimeError(
                f"{self._folder}: the base has other nodes than the mesh made now; "
                "delete this folder"
            )
        plate.adopt(self._known, self.compliance)
        plate.need(under(self.grid.points, self._feet, self._allowance * 2**reach))
        keep_base(plate, lambda name: self._file(name, reach))


def keep_base(plate, file) -> None:
    """Write what is known of a plate; `known` comes last and says that all is there."""
    for name, values in (
        ("compliance", np.ascontiguousarray(plate.compliance.transpose(0, 2, 1, 3))),
        ("known", plate.known),
    ):
        with tempfile.NamedTemporaryFile(dir=file(name).parent, delete=False) as partial:
            np.save(partial, values)
        os.chmod(partial.name, 0o644)
        os.replace(partial.name, file(name))


def model_key(case: ShortForm) -> str:
    """Name of the model of a case: what of the case, and which code, its mesh and operators are
    made from.

    Raises
    ------
    FileNotFoundError
        the package has not all SOURCES.
    """
    tables = {
        name: section_table(name, getattr(case, name))
        for name in ("column", "flange", "cap", "base", "material", "mesh")
    }
    # a pad's springs are no part of the model, and a flat has no edges
    if case.base.kind == "pad":
        tables["base"] = "pad"
    elif case.base.kind == "unbounded":
        for key in ("length_m", "width_m", "slide_allowance_m"):
            del tables["base"][key]
    tables["material"].pop("damping_ratio", None)  # no operator has it
    tables |= dict(
        modes=max(case.integration.n_modes, KEPT_MODES),
        interior=case.contact.interior_points,
        code=_code(),
    )
    return hashlib.sha256(json.dumps(tables, sort_keys=True).encode()).hexdigest()[:16]


@functools.cache
def _code() -> list[str]:
    """Digest of SOURCES, what a ColumnModel holds, and the version of dolfinx, which is loaded only
    where its package does not tell it.
    """
    try:
        dolfinx = importlib.metadata.version("fenics-dolfinx")
    except importlib.metadata.PackageNotFoundError:
        from dolfinx import __version__ as dolfinx
    return [
        digest_of(files_of(SOURCES)),
        *(field.name for field in dataclasses.fields(ColumnModel)),
        f"dolfinx {dolfinx}",
    ]


def model_folder(case: ShortForm) -> Path:
    """Where the model of a case is kept, or will be."""
    return cache_folder() / f"model-{model_key(case)}"


def load_model(case: ShortForm, say=lambda text: None) -> tuple[ColumnModel, KnownBase, Path]:
    """Column and base of a case, and the folder of their model; made and kept if there is none yet.

    Parameters
    ----------
    say
        told when a model has to be made, which takes up to a minute.
    """
    folder = model_folder(case)
    if not folder.is_dir():
        with alone(folder):  # of the workers of a study that start at once, one makes it
            if not folder.is_dir():
                say("making the reduced model of the specimen (once)")
                _make(case, folder)
    with np.load(folder / "column.npz") as file:
        values = {name: file[name] if file[name].ndim else file[name].item() for name in file.files}
    model = ColumnModel(**values).with_modes(case.integration.n_modes)
    return model, _open_base(case, folder, model.reference), folder


def _open_base(case: ShortForm, folder: Path, reference):
    """The base of a model: KnownBase or UnboundedBase."""
    if case.base.kind == "plate":
        return KnownBase(folder, lambda: make_bodies(case)[1])
    if case.base.kind == "pad":
        return rigid_base(reference)
    with np.load(folder / "base.npz") as file:
        return UnboundedBase(
            float(file["size"]), file["response"], reference, float(file["frequency"])
        )


def make_bodies(case: ShortForm):
    """The column's Body and the BasePlate of a case, None where the base has no edges; and the
    specimen's mesh.
    """
    from mpi4py import MPI

    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.dynamics.assembly import base_body, column_body
    from fecolumn.mesh.specimen import specimen_mesh

    specimen = specimen_mesh(case)
    plate = (
        BasePlate(base_body(case, specimen, MPI.COMM_SELF)) if case.base.kind == "plate" else None
    )
    return column_body(case, specimen, MPI.COMM_SELF), plate, specimen


def _make(case: ShortForm, folder: Path) -> None:
    from fecolumn.dynamics.assembly import base_of, foot_of
    from fecolumn.dynamics.observer import top_of
    from fecolumn.reduced.build import column_model

    body, plate, specimen = make_bodies(case)
    foot = foot_of(case, specimen, body)
    model, fields = column_model(
        body,
        foot.nodes,
        foot.areas,
        *top_of(body, specimen),
        max(case.integration.n_modes, KEPT_MODES),
    )
    if plate:
        allowance = max(case.base.slide_allowance_m, LEAST_REACH * np.ptp(model.reference[:, 0]))
        plate.need(under(plate.grid.points, [model.reference], allowance))
        base = dict(
            points=plate.grid.points,
            frequency=plate.frequency,
            dofs=plate.dofs,
            foot=model.reference,
            allowance=allowance,
        )
    else:
        flat = base_of(case, model.reference)
        base = dict(size=flat.grid.square, response=flat.response, frequency=flat.frequency)
    folder.parent.mkdir(parents=True, exist_ok=True)
    partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    partial.chmod(0o755)
    try:
        for name, values in (
            (
                "column",
                {field.name: getattr(model, field.name) for field in dataclasses.fields(model)},
            ),
            ("base", base),
        ):
            with open(partial / f"{name}.npz", "wb") as file:
                np.savez(file, **values)
        if plate:
            keep_base(plate, lambda name: partial / f"{name}-0.npy")
        np.save(partial / "fields.npy", fields)
        os.replace(partial, folder)
    except OSError:
        # another worker made it in the meantime
        if not folder.is_dir():
            raise
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def under(points, feet, allowance: float) -> np.ndarray:
    """Top nodes (k,) that feet, each at (n, 3) [m], may press when they slide by `allowance` [m] to
    any side.
    """
    found = np.zeros(len(points), bool)
    for foot in feet:
        middle = (foot[:, :2].min(axis=0) + foot[:, :2].max(axis=0)) / 2
        place, own = points[:, :2] - middle, foot[:, :2] - middle
        cell = max(
            np.diff(lines[np.abs(lines) <= np.abs(own).max() + allowance]).max()
            for lines in (np.unique(np.round(place[:, axis], 12)) for axis in (0, 1))
        )
        radius = np.linalg.norm(own, axis=1)
        distance, reach = np.linalg.norm(place, axis=1), allowance + 1.5 * cell
        found |= (distance <= radius.max() + reach) & (distance >= radius.min() - reach)
    return np.flatnonzero(found)
