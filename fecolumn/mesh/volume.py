"""Elements made by Gmsh inside a closed surface, of a CAD body, or by a script of the user's.

It is run as a program of its own, `python -m fecolumn.mesh.volume JOB.json RESULT`, since what
others drew may bring Gmsh down or keep it busy for ever.
"""

from __future__ import annotations

import functools
import json
import math
import operator
import re
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.mesh.bricks import UPPER, brick_mesh
from fecolumn.mesh.closed_surface import (
    ClosedSurface,
    closed_surface,
    flat_foot,
)
from fecolumn.mesh.curved import curved_properties
from fecolumn.mesh.gmsh_section import end_session
from fecolumn.mesh.mass import MassProperties, enclosed, mass_properties
from fecolumn.mesh.mesh_file import MeshFile, UnusableShape

if TYPE_CHECKING:
    import pyvista


# Elements through the cube root of the volume, where no size is asked for
_THROUGH = 8
# of which a thin body has at most this many times as many
_FINEST = 2.5
# Elements above which a mesh is not begun, and those of a cube of side 1 over size^-3
_MOST, _PER_CUBE = 3_000_000, 9.0
# Edges that a mesh keeps: angle [deg] between triangles
_EDGES = 40.0
# Steps of Taubin's smoothing, which keeps the volume, of a surface too rough to be divided
_SMOOTHING = 30
# Sides of triangles of a thinned surface over the element size that are divided
_LONG = 1.4
#: Ways to fill a surface: smoothed or not, triangles over those that the element size needs (None:
#: as they are), and whether Gmsh divides the surface anew.
WAYS = (
    (False, None, True),
    (False, 2.0, True),
    (False, 1.0, True),
    (True, 2.0, True),
    (False, 2.0, False),
    (True, 2.0, False),
    (True, 1.0, False),
)
_HEXAHEDRON, _TETRAHEDRON = 5, 4
# Of the volume: what flat faces may lack of a script's curved ones without a word
_FLAT_FACES = 0.01
_NAMES = {6: "wedge", 7: "pyramid", 11: "tetrahedron of second order", 12: "brick of second order"}


def main(job: str, result: str) -> None:
    """Write as .npz what a job asks for, or as JSON why there is none.

    A job has `file`, the fields of a MeshFile; of a surface first `way` None, which reads it, then
    `way` one of WAYS and `surface`, the result of the first.
    """
    asked = json.loads(Path(job).read_text())
    file, way = MeshFile(**asked["file"]), asked["way"]
    try:
        if file.kind != "surface":
            made = _meshed(file)
        elif way is None:
            made = _surface(file)
        else:
            with np.load(asked["surface"]) as known:
                surface = ClosedSurface(known["points"], known["triangles"], ())
            made = _filled_so(surface, tuple(way), asked["file"]["size"])
    except UnusableShape as error:
        Path(result).write_text(json.dumps([error.value, error.allowed]))
        return
    with open(result, "wb") as out:
        np.savez(out, **made)


def _surface(file: MeshFile) -> dict:
    found = closed_surface(Path(file.path), file.metres, file.cut_foot)
    file.check_size(np.ptp(found.points, axis=0))
    exact = enclosed(found.corners)
    size = file.size or size_of_elements(exact.volume, found.area)
    _check_count(exact.volume, size)
    return dict(
        points=found.points,
        triangles=found.triangles,
        notes=np.array(found.notes, str),
        size=size,
        **_known(exact),
    )


def _known(exact: MassProperties) -> dict:
    return dict(volume=exact.volume, centre=exact.centre, inertia=exact.inertia)


def _meshed(file: MeshFile) -> dict:
    import gmsh

    with _Gmsh(gmsh):
        points, cells, exact = (_of_cad if file.kind == "CAD" else _of_script)(gmsh, file)
    made = dict(points=points, cells=cells)
    if exact is None:
        return made
    notes = []
    missing = 1 - _volume(points, cells) / exact.volume
    if file.kind == "script" and missing > _FLAT_FACES:
        notes.append(
            f"flat faces of its elements lack {missing:.1%} of the volume that its curved faces "
            "enclose; mass, centre and inertia are those of the curved body; a smaller "
            "mesh_size_m draws it closer"
        )
    return made | _known(exact) | dict(notes=np.array(notes, str))


def _volume(points: np.ndarray, cells: np.ndarray) -> float:
    """Volume [m3] of elements."""
    return mass_properties(brick_mesh(points, cells, UPPER), 1.0).volume


class _Gmsh:
    """Gmsh begun and ended, without a word to the console."""

    def __init__(self, gmsh: ModuleType) -> None:
        self.gmsh = gmsh

    def __enter__(self) -> None:
        end_session(self.gmsh)
        self.gmsh.initialize()
        for name, value in (
            ("General.Terminal", 0),
            ("General.AbortOnError", 0),
            ("Mesh.MeshSizeExtendFromBoundary", 1),
            ("Mesh.MeshSizeFromPoints", 0),
            ("Mesh.MeshSizeFromCurvature", 0),
            ("Mesh.ElementOrder", 1),
            ("Mesh.Algorithm3D", 1),
            ("Mesh.Optimize", 1),
        ):
            self.gmsh.option.setNumber(name, value)

    def __exit__(self, *_: object) -> None:
        self.gmsh.finalize()


def size_of_elements(volume: float, area: float) -> float:
    """Element size [m] where none is asked for: an eighth of the cube root of the volume, less of a
    thin body, whose thickness is about 2 V / A.
    """
    cube = volume ** (1 / 3) / _THROUGH
    return min(cube, max(2 * volume / area, cube / _FINEST))


def _check_count(volume: float, size: float) -> None:
    count = _PER_CUBE * volume / size**3
    if count > _MOST:
        raise UnusableShape(
            f"mesh_size_m = {size:.3g} m",
            f"makes about {count:.1e} elements; at most {_MOST:.0e} are made: take at least "
            f"{(_PER_CUBE * volume / _MOST) ** (1 / 3):.2g} m",
        )


def _filled_so(surface: ClosedSurface, way: tuple, size: float) -> dict:
    """Points and tetrahedra of `size` [m] inside a surface, one of WAYS."""
    import gmsh

    smooth, thinned, anew = way
    if smooth:
        surface = _smoothed(surface)
    if thinned is not None:
        count = int(thinned * 2 * surface.area / (math.sqrt(3) / 2 * size**2))
        surface = _thinned(surface, count, _LONG * size / math.sqrt(thinned), anew)
    with _Gmsh(gmsh):
        try:
            points, cells = _filled(gmsh, surface, anew, size)
        except Exception as error:  # Gmsh raises plain exceptions
            said = " ".join(str(error).split()) or type(error).__name__
            raise UnusableShape(None, said) from None
    return dict(points=points, cells=cells)


def _thinned(surface: ClosedSurface, count: int, longest: float, anew: bool) -> ClosedSurface:
    """A surface of about `count` triangles; flat feet stay. Sides longer than `longest` [m] are
    divided where the triangles are to stay, or there are few of them.
    """
    found = _poly(surface)
    if many := count < found.n_cells:
        found = found.decimate(1 - count / found.n_cells, volume_preservation=True)
    if not (anew and many):
        found = found.subdivide_adaptive(max_edge_len=longest).clean()
    triangles = np.array(found.faces.reshape(-1, 4)[:, 1:], np.int64)
    points = flat_foot(np.array(found.points, float), triangles)[0]
    return ClosedSurface(points, triangles, surface.notes)


def _poly(surface: ClosedSurface) -> pyvista.PolyData:
    import pyvista

    return pyvista.PolyData(surface.points, np.insert(surface.triangles, 0, 3, axis=1).ravel())


def _filled(
    gmsh: ModuleType, surface: ClosedSurface, anew: bool, size: float
) -> tuple[np.ndarray, np.ndarray]:
    with tempfile.NamedTemporaryFile(suffix=".stl") as draft:
        _write_stl(surface, draft.name)
        gmsh.merge(draft.name)
    gmsh.model.mesh.removeDuplicateNodes()
    if anew:
        gmsh.model.mesh.classifySurfaces(math.radians(_EDGES), True, True, math.radians(180))
        gmsh.model.mesh.createGeometry()
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop(faces)])
    gmsh.model.geo.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(3)
    return _elements(gmsh)


def _write_stl(surface: ClosedSurface, path: str) -> None:
    """ASCII with all digits: binary STL would round to single precision."""
    with open(path, "w") as out:
        out.write("solid surface\n")
        for corners in surface.corners:
            out.write("facet normal 0 0 0\nouter loop\n")
            for x, y, z in corners:
                out.write(f"vertex {x:.17g} {y:.17g} {z:.17g}\n")
            out.write("endloop\nendfacet\n")
        out.write("endsolid surface\n")


def _smoothed(surface: ClosedSurface) -> ClosedSurface:
    """The surface without a scanner's noise; its foot stays."""
    smooth = _poly(surface).smooth_taubin(n_iter=_SMOOTHING, pass_band=0.05)
    low, tall = surface.points[:, 2].min(), np.ptp(surface.points[:, 2])
    points = np.array(smooth.points, float)
    foot = surface.points[:, 2] < low + 1e-9 * tall
    points[foot] = surface.points[foot]
    points[:, 2] = np.maximum(points[:, 2], low)
    return ClosedSurface(points, surface.triangles, surface.notes)


def _of_cad(
    gmsh: ModuleType, file: MeshFile
) -> tuple[np.ndarray, np.ndarray, MassProperties | None]:
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    _opened(lambda: gmsh.model.occ.importShapes(file.path), "a STEP or IGES file")
    gmsh.model.occ.synchronize()
    solids = gmsh.model.getEntities(3)
    if not solids and gmsh.model.getEntities(2):  # as IGES has them: faces beside each other
        _opened(lambda: gmsh.model.occ.healShapes(makeSolids=True), "faces that can be sewn")
        gmsh.model.occ.synchronize()
        solids = gmsh.model.getEntities(3)
    if not solids:
        raise UnusableShape(
            f"{len(gmsh.model.getEntities(2))} faces",
            "must hold a solid: sew the faces in the CAD program, and export a solid",
        )
    if len(solids) > 1:  # so that their elements meet
        gmsh.model.occ.removeAllDuplicates()
        gmsh.model.occ.synchronize()
        solids = gmsh.model.getEntities(3)
    exact = functools.reduce(operator.add, (_properties(gmsh, solid) for solid in solids))
    area = sum(gmsh.model.occ.getMass(*face) for face in gmsh.model.getEntities(2))
    if not exact.volume > 0 or not area > 0:
        raise UnusableShape(f"{exact.volume:.3g} m3", "must hold a solid of some volume")
    size = file.size or size_of_elements(exact.volume, area)
    _check_count(exact.volume, size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size / 3)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    gmsh.option.setNumber("Mesh.MinimumElementsPerTwoPi", 16)
    _opened(lambda: gmsh.model.mesh.generate(3), "a solid that can be meshed")
    return *_elements(gmsh), exact


def _properties(gmsh: ModuleType, solid: tuple[int, int]) -> MassProperties:
    """Of a solid as OpenCASCADE knows them, at a density of 1."""
    volume = gmsh.model.occ.getMass(*solid)
    centre = np.array(gmsh.model.occ.getCenterOfMass(*solid))
    inertia = np.array(gmsh.model.occ.getMatrixOfInertia(*solid)).reshape(3, 3)
    return MassProperties(volume, volume, centre, inertia)


def _of_script(
    gmsh: ModuleType, file: MeshFile
) -> tuple[np.ndarray, np.ndarray, MassProperties | None]:
    text = Path(file.path).read_text(errors="replace")
    if found := re.search(r"SystemCall|NonBlockingSystemCall|OnelabRun", text):
        raise UnusableShape(found[0], "must not call other programs")
    gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 1)
    _opened(lambda: gmsh.open(file.path), "a script of Gmsh")
    if file.size:
        size = file.size / file.metres
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    if not gmsh.model.getEntities(3):
        said = " ".join(str(gmsh.logger.getLastError()).split())
        raise UnusableShape("no volume", f"must define a Volume{said and '; Gmsh says: ' + said}")
    _opened(lambda: gmsh.model.mesh.generate(3), "a script whose volume can be meshed")
    points, cells = _elements(gmsh)
    solids = gmsh.model.getEntities(3)
    exact: MassProperties | None
    if gmsh.model.occ.getEntities(3) == solids:
        exact = functools.reduce(operator.add, (_properties(gmsh, solid) for solid in solids))
    else:
        exact = curved_properties(gmsh)
    return points * file.metres, cells, exact and exact.scaled(file.metres)


def _opened(act: Callable[[], object], what: str) -> None:
    try:
        act()
    except Exception as error:  # Gmsh raises plain exceptions
        said = " ".join(str(error).split()) or type(error).__name__
        raise UnusableShape(None, f"must be {what}; Gmsh says: {said}") from None


def _elements(gmsh: ModuleType) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) and elements (m, 4 or 8) of what Gmsh has meshed."""
    kinds, _, nodes = gmsh.model.mesh.getElements(3)
    found = {int(kind): one for kind, one in zip(kinds, nodes)}
    if set(found) not in ({_TETRAHEDRON}, {_HEXAHEDRON}):
        names = ", ".join(
            _NAMES.get(kind, "tetrahedron" if kind == 4 else "brick") for kind in found
        )
        raise UnusableShape(names or "no elements", "must be tetrahedra or 8-node bricks alone")
    ((kind, one),) = found.items()
    tags, places, _ = gmsh.model.mesh.getNodes()
    order = np.zeros(int(tags.max()) + 1, np.int64)
    order[tags.astype(np.int64)] = np.arange(len(tags))
    cells = order[one.astype(np.int64)].reshape(-1, 4 if kind == _TETRAHEDRON else 8)
    return places.reshape(-1, 3), cells


if __name__ == "__main__":
    main(*sys.argv[1:])
