"""Extrusion of plane sections to bricks by Gmsh: transfinite, recombined, layered."""

from __future__ import annotations

import contextlib
import inspect
import signal
import threading
from collections.abc import Iterator
from types import ModuleType

import numpy as np

from fecolumn.mesh.bricks import BrickMesh, brick_mesh
from fecolumn.mesh.section import Annulus, Disc, Rectangle

_OPTIONS = {
    "General.Terminal": 0,
    "Mesh.ElementOrder": 1,
    "Mesh.SubdivisionAlgorithm": 0,
    "Mesh.SaveAll": 0,
}


# Sessions of Gmsh that are begun and ended in a process; the one after stays open. Each leaves 20
# bytes times the number of those before it: a gigabyte after ten thousand bodies.
_SESSIONS = 100
_begun = 0


class NotMeshed(RuntimeError):
    """Gmsh has made no mesh, or another one than was asked for."""


@contextlib.contextmanager
def gmsh_model() -> Iterator[ModuleType]:
    """The gmsh module with an empty model, leaving a caller's Gmsh session as it was.

    Gmsh is imported here and not at the top: an analysis of an imported mesh can then run without
    it.

    Raises
    ------
    NotMeshed
        an error of Gmsh.
    """
    # Gmsh 4.8 takes Ctrl-C away from Python on import; a study must stay interruptible.
    in_main_thread = threading.current_thread() is threading.main_thread()
    handler = signal.getsignal(signal.SIGINT)
    guard = contextlib.nullcontext if in_main_thread else _signals_left_alone
    with guard():
        import gmsh

    global _begun
    running = _is_running(gmsh)
    if not running:
        _begun += 1
        interruptible = "interruptible" in inspect.signature(gmsh.initialize).parameters
        gmsh.initialize(
            readConfigFiles=False, **({"interruptible": False} if interruptible else {})
        )
    before = {key: gmsh.option.getNumber(key) for key in _OPTIONS}
    callers_model = gmsh.model.getCurrent()
    try:
        for key, value in _OPTIONS.items():
            gmsh.option.setNumber(key, value)
        gmsh.model.add("fecolumn")
        yield gmsh
    except Exception as error:
        if type(error) is not Exception:
            raise
        # as Gmsh raises its own
        said = " ".join(str(error).split()) or "no word of why"
        raise NotMeshed(f"Gmsh says: {said}") from error
    finally:
        if running or _begun > _SESSIONS:
            gmsh.model.remove()
            for key, value in before.items():
                gmsh.option.setNumber(key, value)
            gmsh.model.setCurrent(callers_model)
        else:
            with guard():
                gmsh.finalize()
        if in_main_thread and handler is not None:
            signal.signal(signal.SIGINT, handler)


def end_session(gmsh: ModuleType) -> None:
    """End the session that `gmsh_model` has left open, if it has."""
    if _begun > _SESSIONS and _is_running(gmsh):
        gmsh.finalize()


@contextlib.contextmanager
def _signals_left_alone() -> Iterator[None]:
    """Keep Gmsh from setting signal handlers: in another thread than the main one, such as a dask
    worker's, Python refuses to.
    """
    setter, signal.signal = signal.signal, lambda signalnum, handler: signal.getsignal(signalnum)
    try:
        yield
    finally:
        signal.signal = setter


def _is_running(gmsh: ModuleType) -> bool:
    """Whether the caller has initialised Gmsh already; Gmsh 4.8 has no question for it."""
    if hasattr(gmsh, "isInitialized"):
        return bool(gmsh.isInitialized())
    try:
        # Before the first session the list is empty, in a session it is not, and after one the
        # question is an error.
        return bool(gmsh.model.list())
    except Exception:  # Gmsh raises no narrower class
        return False


def extruded(
    section: Annulus | Disc | Rectangle, bottom: float, height: float, n_layers: int, part: int
) -> BrickMesh:
    """Bricks of a section extruded upwards in equal layers.

    Parameters
    ----------
    section
        what is extruded.
    bottom
        height of the lowest points [m].
    height
        extruded length [m].
    n_layers
        bricks along the height.
    part
        part of the bricks.
    """
    if isinstance(section, Rectangle):
        return swept_grid(*section.lines, np.linspace(bottom, bottom + height, n_layers + 1), part)
    with gmsh_model() as gmsh:
        geo = gmsh.model.geo
        surfaces = [(2, tag) for tag in section.draw(geo)]
        geo.extrude(surfaces, 0, 0, height, numElements=[n_layers], recombine=True)
        points, cells = generated(gmsh)
    points[:, :2] = section.evened(points[:, :2])
    return brick_mesh(points, cells, part).shifted(bottom)


def swept_grid(x: np.ndarray, y: np.ndarray, z: np.ndarray, part: int) -> BrickMesh:
    """Tensor-product grid: a point swept along x, the line along y, the rectangle along z.

    Parameters
    ----------
    x, y, z
        rising grid lines [m].
    part
        part of the bricks.

    Raises
    ------
    NotMeshed
        an error of Gmsh, or a grid with other points.

    Returns
    -------
    Bricks whose points lie exactly on the lines; point (i, j, k) has the number i + n_x (j +
        n_y k).
    """
    lines = [np.asarray(line, dtype=float) for line in (x, y, z)]
    with gmsh_model() as gmsh:
        geo = gmsh.model.geo
        swept = (0, geo.addPoint(*(line[0] for line in lines)))
        for axis, line in enumerate(lines):
            length = line[-1] - line[0]
            along = np.eye(3)[axis] * length
            # Gmsh returns the far end first, then what was swept.
            swept = geo.extrude(
                [swept],
                *along,
                numElements=[1] * (len(line) - 1),
                heights=list((line[1:] - line[0]) / length),
                recombine=True,
            )[1]
        points, cells = generated(gmsh)
    places = [_nearest(line, points[:, axis]) for axis, line in enumerate(lines)]
    number = places[0] + len(lines[0]) * (places[1] + len(lines[1]) * places[2])
    if len(np.unique(number)) != len(number) or len(number) != np.prod(
        [len(line) for line in lines]
    ):
        raise NotMeshed("Gmsh did not return a tensor-product grid")
    grid = np.empty_like(points)
    grid[number] = np.stack([line[place] for line, place in zip(lines, places)], axis=1)
    return brick_mesh(grid, number[cells], part)


def _nearest(line: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Number of the grid line nearest to each value."""
    return np.searchsorted((line[1:] + line[:-1]) / 2, values)


def generated(gmsh: ModuleType, dimension: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) [m] and bricks (m, 8), their nodes in VTK's order, of the current model; or
    quadrilaterals (m, 4) of a plane one, which has two dimensions.

    Raises
    ------
    NotMeshed
        Gmsh has made other elements.
    """
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(dimension)
    kinds, _, nodes = gmsh.model.mesh.getElements(dimension)
    corners = 2**dimension
    if [gmsh.model.mesh.getElementProperties(kind)[3] for kind in kinds] != [corners]:
        raise NotMeshed(f"Gmsh returned the element types {list(kinds)}, not {corners} corners")
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    used, cells = np.unique(nodes[0], return_inverse=True)
    order = np.argsort(tags)
    points = np.asarray(coordinates).reshape(-1, 3)[order[np.searchsorted(tags[order], used)]]
    return points, cells.reshape(-1, corners)
