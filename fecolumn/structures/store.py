"""Reduced bodies and layouts on disk: made once, opened in milliseconds by every analysis of the
same structure.

A body is a folder named after the content it was made from, so that nothing has to be invalidated:
body.npz and, of finite elements, fields.npy with the mode shapes (m, n_nodes, 3) all over it and
nodes.npy with the nodes (n_nodes, 3) [m] from the centre of mass. A layout is a JSON file that
names the bodies and their contacts. Each is checked by its digest before it is used, and what does
not fit is made anew.
"""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import json
import os
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, NotRequired, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.foundation._compiled import cache_folder
from fecolumn.foundation.atomic import write_json
from fecolumn.foundation.digests import digest_of_json, intact, note, remove_damaged
from fecolumn.foundation.lock import alone
from fecolumn.foundation.sources import digest_of, files_of
from fecolumn.structures.model import BodyModel, HullOutline, StoreyDrifts, Surface

#: Sources that bodies, layouts and grounds are made from, whole folders where most of them are.
SOURCES = (
    "case/arch.py",
    "case/bodies.py",
    "case/body_keys.py",
    "case/check_bodies.py",
    "case/column_keys.py",
    "case/ground.py",
    "case/joint.py",
    "case/mesh_file_keys.py",
    "case/outline_keys.py",
    "case/polygon.py",
    "case/sections.py",
    "case/short_form.py",
    "case/ground_sizes.py",
    "case/sizes.py",
    "fem",
    "mesh",
    "structures",
    "contact/ball.py",
    "contact/base_plate.py",
    "contact/base_top.py",
    "contact/convex.py",
    "contact/footprint.py",
    "contact/known_base.py",
    "contact/layer.py",
    "contact/rim.py",
    "contact/tolerances.py",
    "contact/unbounded_base.py",
    "foundation/_dolfinx.py",
)
#: Modes that a body keeps at least, so that analyses with fewer share it.
KEPT_MODES = 30
#: A reduced body; and nodes (n_nodes, 3) [m] and modes (m, n_nodes, 3) of one of finite elements.
MadeBody = tuple[BodyModel, tuple[NDArray[Any], NDArray[Any]] | None]
# Nodes by which the shape at a point between them is found, and how near a node a point is it, over
# the body's size
_NEAREST, _AT_NODE = 12, 1e-9


def key_of(what: object) -> str:
    """Name of what is made from `what`, anything that JSON takes, and from the present code."""
    return hashlib.sha256(json.dumps([what, _code()], sort_keys=True).encode()).hexdigest()[:16]


@functools.cache
def _code() -> list[str]:
    try:
        version = importlib.metadata.version("fenics-dolfinx")
    except importlib.metadata.PackageNotFoundError:
        import dolfinx

        version = dolfinx.__version__
    return [digest_of(files_of(SOURCES)), f"dolfinx {version}"]


def body_folder(key: str) -> Path:
    """Where a reduced body is kept."""
    return cache_folder() / f"body-{key}"


def keep_body(key: str, make: Callable[[], MadeBody]) -> None:
    """Have a reduced body on disk; `make` returns the model and its fields, or None for these,
    where there is none yet, or it is damaged.
    """
    folder = body_folder(key)
    if intact(folder):
        return
    with alone(folder):  # of the workers of a study that start at once, one makes it
        if intact(folder):
            return
        if folder.is_dir():
            remove_damaged(folder)
            kept_body.cache_clear()
        model, fields_of_all = make()
        partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
        partial.chmod(0o755)
        try:
            with open(partial / "body.npz", "wb") as file:
                np.savez(file, **_arrays(model))
            if fields_of_all is not None:
                np.save(partial / "nodes.npy", fields_of_all[0])
                np.save(partial / "fields.npy", fields_of_all[1])
            note(partial, *sorted(file.name for file in partial.iterdir()))
            os.replace(partial, folder)
        finally:
            shutil.rmtree(partial, ignore_errors=True)


def shape_at(key: str, arm: NDArray[Any]) -> NDArray[Any] | None:
    """Shape (3, m) [1/sqrt(kg)] of a kept body's modes at a point (3,) [m] from its centre of mass;
    None of a body without finite elements.

    Of the nodes nearest to it that linear field which fits them best, the nearer the better: at a
    node its own shape.
    """
    folder = body_folder(key)
    if not (folder / "fields.npy").is_file():
        return None
    nodes, shapes = (np.load(folder / name, mmap_mode="r") for name in ("nodes.npy", "fields.npy"))
    away = np.linalg.norm(nodes - arm, axis=1)
    near = np.argsort(away, kind="stable")[:_NEAREST]
    if away[near[0]] < _AT_NODE * np.ptp(nodes, axis=0).max():
        return np.array(shapes[:, near[0]]).T
    own = shapes[:, near].transpose(1, 2, 0)
    weights = 1 / away[near]
    linear = np.column_stack([np.ones(len(near)), nodes[near] - arm])
    shares = np.linalg.pinv(linear * weights[:, None])[0] * weights
    shape: NDArray[Any] = np.einsum("n,nam->am", shares, own)
    return shape


@functools.lru_cache(maxsize=32)
def kept_body(key: str) -> BodyModel:
    """The reduced body of a key, all its modes; equal bodies are one object."""
    with np.load(body_folder(key) / "body.npz") as file:
        arrays = {name: file[name] for name in file.files}
    surfaces: dict[str, dict[str, NDArray[Any]]] = {}
    marks: dict[str, dict[str, NDArray[Any]]] = {}
    plain, storeys = {}, {}
    for name, values in arrays.items():
        group, *rest = name.split("/")
        if group == "surfaces":
            surfaces.setdefault(rest[0], {})[rest[1]] = values
        elif group == "marks":
            marks.setdefault(rest[0], {})[rest[1]] = values
        elif group == "storeys":
            storeys[rest[0]] = values
        else:
            plain[name] = values if values.ndim else values.item()
    return BodyModel(
        **plain,
        surfaces={name: Surface(**values) for name, values in surfaces.items()},
        marks={name: (values["arm"], values["shape"]) for name, values in marks.items()},
        storeys=StoreyDrifts(**storeys) if storeys else None,
    )


def _arrays(model: BodyModel) -> dict[str, ArrayLike]:
    """A model as arrays and numbers by names such as "surfaces/foot/areas"."""
    arrays = {
        field.name: getattr(model, field.name)
        for field in fields(model)
        if field.name not in ("surfaces", "marks", "storeys")
    }
    arrays = {name: values for name, values in arrays.items() if values is not None}
    for name, surface in model.surfaces.items():
        arrays |= {
            f"surfaces/{name}/{field.name}": getattr(surface, field.name)
            for field in fields(surface)
        }
    for name, (arm, shape) in model.marks.items():
        arrays |= {f"marks/{name}/arm": arm, f"marks/{name}/shape": shape}
    if model.storeys:
        arrays |= {
            f"storeys/{field.name}": getattr(model.storeys, field.name)
            for field in fields(model.storeys)
        }
    return arrays


class KeptLayout(TypedDict):
    """What is kept of a `layout.Layout`, as JSON has it.

    By the names of bodies: element sizes [m]; lowest and highest place (3,) [m] and outlines, as
    drawn; keys of the reduced models, where these are kept. contacts: each `layout.ContactPair`.
    """

    sizes: dict[str, float]
    extents: dict[str, list[list[float]]]
    outlines: dict[str, HullOutline | None]
    contacts: list[dict[str, Any]]
    models: NotRequired[dict[str, str]]


def layout_file(key: str) -> Path:
    """Where a layout is kept."""
    return cache_folder() / "layouts" / f"{key}.json"


def keep_layout(key: str, what: KeptLayout) -> None:
    """Write a layout."""
    layout_file(key).parent.mkdir(parents=True, exist_ok=True)
    write_json(layout_file(key), {"digest": digest_of_json(what), "layout": what})


def kept_layout(key: str, fields: bool = False) -> KeptLayout | None:
    """The layout of a key, whose bodies are all on disk; None where it has to be made.

    fields: whether the modes all over the bodies are needed, too.
    """
    try:
        kept = json.loads(layout_file(key).read_text())
        found: KeptLayout = kept["layout"]
        fits = kept["digest"] == digest_of_json(found)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        fits = False
    if not fits:
        remove_damaged(layout_file(key))
        return None
    needed = () if fields else ("body.npz",)
    whole = all(intact(body_folder(one), *needed) for one in found["models"].values())
    return found if whole else None
