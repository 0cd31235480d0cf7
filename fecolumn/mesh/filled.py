"""Elements of shapes without any, made once by Gmsh in a process of its own, kept on disk."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fecolumn.foundation._compiled import cache_folder
from fecolumn.foundation.atomic import write_file
from fecolumn.foundation.content import content
from fecolumn.foundation.lock import alone
from fecolumn.foundation.sources import digest_of
from fecolumn.mesh.bricks import UPPER, brick_mesh
from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.mesh.mass import MassProperties
from fecolumn.mesh.mesh_file import MeshFile, UnusableShape
from fecolumn.mesh.volume import WAYS

# Seconds after which a way to make elements is given up
_PATIENCE = 300
# Scaled Jacobian of the worst element: at which a mesh is taken at once, and the least
_GOOD, _LEAST = 0.02, 2e-3
# Of the volume: how far the elements' may be from that of what was drawn
_VOLUME = 0.05
# Of height and width of the foot: how far the elements' may be from the surface's without a word
_SIZE = 0.005
_SOURCES = ("closed_surface.py", "curved.py", "volume.py", "filled.py", "mesh_file.py")


class Filled(NamedTuple):
    """points: (n, 3) [m]; cells: (m, 4 or 8); exact: mass properties at a density of 1 of what was
    drawn, None of a script of which they are not known.
    """

    points: np.ndarray
    cells: np.ndarray
    exact: MassProperties | None


def filled(file: MeshFile) -> Filled:
    """Elements of a surface, a CAD body or a script of Gmsh.

    Raises
    ------
    UnusableShape
        what the file holds cannot be made into elements.

    Warns
    -----
        once, where it is made: what was mended.
    """
    said = dataclasses.asdict(file) | {"path": content(file.path), "kind": file.kind}
    folder = Path(__file__).parent
    key = hashlib.sha256(
        json.dumps([said, digest_of([folder / name for name in _SOURCES])]).encode()
    ).hexdigest()[:16]
    kept = cache_folder() / "meshes" / f"{key}.npz"
    if (found := _opened(kept)) is None:
        with alone(kept):
            if (found := _opened(kept)) is None:
                arrays = _made(file)
                for note in arrays.pop("notes", ()):
                    warnings.warn(f"{file.path}: {note}", stacklevel=2)
                write_file(kept, lambda out: np.savez(out, **arrays))
                found = _of_arrays(arrays)
    return found


def _opened(path: Path) -> Filled | None:
    """What is kept; None where there is nothing, or it is damaged."""
    try:
        with np.load(path) as found:
            return _of_arrays({name: found[name] for name in found.files})
    except Exception:  # whatever a damaged archive makes numpy raise: it is made anew
        return None


def _of_arrays(arrays: dict) -> Filled:
    exact = None
    if "volume" in arrays:
        volume = float(arrays["volume"])
        exact = MassProperties(volume, volume, arrays["centre"], arrays["inertia"])
    return Filled(arrays["points"], arrays["cells"], exact)


def _made(file: MeshFile) -> dict:
    with tempfile.TemporaryDirectory(prefix="fecolumn-mesh-") as folder:
        surface = Path(folder) / "surface.npz"
        first = _run(file, None, surface, surface)
        if file.kind != "surface":
            return first
        file = dataclasses.replace(file, size=float(first["size"]))
        best: tuple[float, dict | None] = (_LEAST, None)
        reasons = []
        for way in WAYS:
            try:
                made = _run(file, way, surface, Path(folder) / "filled.npz")
                best = max(best, (_judged(made, float(first["volume"])), made), key=lambda x: x[0])
            except UnusableShape as error:
                reasons.append(error.allowed)
            if best[0] >= _GOOD:
                break
        if best[1] is None:
            raise UnusableShape(
                f"{len(first['triangles'])} triangles",
                f"cannot be filled with elements of {file.size:.3g} m by Gmsh ({reasons[0]}): take "
                "another mesh_size_m, or smooth and remesh the surface where triangles cross",
            )
        exact = {name: first[name] for name in ("volume", "centre", "inertia")}
        notes = [*first["notes"], *_other_size(best[1]["points"], first["points"])]
        return best[1] | exact | {"notes": np.array(notes, str)}


def _other_size(points: np.ndarray, drawn: np.ndarray) -> list[str]:
    """That elements are lower, or their foot narrower, than the surface; both (n, 3) [m]."""
    made, asked = _height_and_foot(points), _height_and_foot(drawn)
    if not min(asked) or np.allclose(made, asked, rtol=_SIZE, atol=0.0):
        return []  # without a flat foot there is no other to compare
    (h, a, b), (height, length, width) = made, asked
    return [
        f"its elements are {h:.4g} m high on a foot of {a:.4g} x {b:.4g} m, where the surface is "
        f"{height:.4g} m high on {length:.4g} x {width:.4g} m; mass, centre and inertia are those "
        "of the surface; a smaller mesh_size_m follows it closer"
    ]


def _height_and_foot(points: np.ndarray) -> tuple[float, float, float]:
    """Height, and length and width of the lowest points [m]."""
    heights = points[:, 2] - points[:, 2].min()
    length, width = np.ptp(points[heights <= 1e-6 * heights.max(), :2], axis=0)
    return float(heights.max()), float(length), float(width)


def _judged(made: dict, volume: float) -> float:
    """Scaled Jacobian of the worst of the elements.

    Raises
    ------
    UnusableShape
        their volume is not that of the body.
    """
    mesh = brick_mesh(made["points"], made["cells"], UPPER)
    corners = mesh.points[mesh.cells]
    found = np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6
    if abs(found / volume - 1) > _VOLUME:
        raise UnusableShape(None, f"its elements hold {found:.4g} of {volume:.4g} m3")
    quality = float(scaled_jacobian(mesh).min())
    if quality < _LEAST:
        raise UnusableShape(None, f"its worst element has a scaled Jacobian of {quality:.1g}")
    return quality


def _run(
    file: MeshFile, way: tuple[bool, float | None, bool] | None, surface: Path, result: Path
) -> dict:
    """Arrays that `mesh.volume` makes in a process of its own."""
    job = result.with_suffix(".job")
    path = str(Path(file.path).resolve())
    asked = dataclasses.asdict(dataclasses.replace(file, path=path))
    job.write_text(json.dumps({"file": asked, "way": way, "surface": str(surface)}))
    command = [sys.executable, "-W", "ignore", "-m", "fecolumn.mesh.volume", str(job), str(result)]
    package = str(Path(__file__).parents[2])
    paths = [package, *filter(None, [os.environ.get("PYTHONPATH")])]
    # a rank of MPI is not to begin another one
    plain = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_", "PMI_"))}
    try:
        done = subprocess.run(
            command,
            cwd=result.parent,
            env=plain | {"PYTHONPATH": os.pathsep.join(paths)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_PATIENCE,
        )
    except subprocess.TimeoutExpired:
        raise UnusableShape(None, f"Gmsh has not ended after {_PATIENCE} s") from None
    if done.returncode:
        last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
        reason = last[0] if done.returncode > 0 and last else f"signal {-done.returncode}"
        raise UnusableShape(None, f"cannot be read: the reader ended by itself ({reason})")
    if result.read_bytes()[:2] != b"PK":
        raise UnusableShape(*json.loads(result.read_text()))
    with np.load(result) as found:
        return {name: found[name] for name in found.files}
