"""How the multi-drum column of HybriDFEM's benchmark falls, computed by the package's rigid engine and drawn as a row of pictures."""

from __future__ import annotations

import tempfile
from pathlib import Path

import meshio
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap

from benchmarks.planar.structures import FRICTION, TAPERING
from fecolumn.case import GRAVITY, case_from_tables
from fecolumn.post.style import BLACK, GREY, PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.structures.engine import engine_of
from fecolumn.structures.structure import structure_model

_DT = 1e-3
# Times that are drawn [s]: the end of the first half of the pulse, that of the pulse, and the fall
_DRAWN = (0.34, 1.02, 2.3, 3.3, 3.8, 4.12)
# Between two pictures, above them and below the ground [m]
_GAP, _ABOVE, _BELOW = 0.85, 0.7, 0.6
# Strips of a drum's shade, and its colours from the rim to the side from which light falls
_STRIPS = 60
_STONE = LinearSegmentedColormap.from_list("stone", ["#8C8170", "#F4EFE4"])


def pulse(a: float, tp: float, rest: float, dt: float = _DT) -> np.ndarray:
    """Ground accelerations (n, 3) [m/s2] at the ends of steps: a [g] along x for tp [s], -a/2 for twice as long, then rest [s]."""
    time = dt * np.arange(1, round((3 * tp + rest) / dt) + 1)
    return np.outer(a * GRAVITY * np.where(time <= tp + 1e-9, 1.0, np.where(time <= 3 * tp + 1e-9, -0.5, 0.0)), [1.0, 0.0, 0.0])


def _drums() -> list[np.ndarray]:
    """Outlines (4, 2) [m] of the seven drums and the capital as they stand: foot from left to right, head from left to right."""
    heights, (wide, narrow) = np.array(TAPERING["heights"]), TAPERING["widths"]
    levels = np.concatenate([[0.0], np.cumsum(heights)])
    half = (wide + (narrow - wide) * levels / levels[-1]) / 2
    return [np.array([[-a, low], [a, low], [-b, high], [b, high]]) for a, b, low, high in zip(half, half[1:], levels, levels[1:])]


def column_case(folder: Path):
    """Case of the column; the drums are mesh files in the folder, 1 m deep."""
    bodies, joints = {}, {}
    for k, ((a, low), (b, high)) in enumerate(drum[[1, 3]] for drum in _drums()):
        file = folder / f"drum{k}.vtk"
        corners = [[x * half, y / 2, z] for z, half in ((0.0, a), (high - low, b)) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        meshio.Mesh(np.array(corners), [("hexahedron", [list(range(8))])]).write(file)
        bodies[f"d{k}"] = dict(kind="mesh", mesh_file=str(file), density_kg_m3=TAPERING["density"], at_m=[0.0, 0.0, float(low)])
        joints[f"j{k}"] = dict(between=[f"d{k}", f"d{k - 1}" if k else "ground"])
    return case_from_tables(dict(bodies=bodies, interfaces=joints, contact=dict(friction_coefficient=FRICTION, interior_points=0),
                                 integration=dict(engine="rigid", dt_s=_DT, duration_s=20.0)), "drums.toml")


def _fall(a: float, tp: float) -> list[list[np.ndarray]]:
    """Drums (4, 2) [m] at each time that is drawn."""
    with tempfile.TemporaryDirectory() as folder:
        case = column_case(Path(folder))
        engine = engine_of(case, structure_model(case), "drums.toml")
    ground, drums, drawn = pulse(a, tp, _DRAWN[-1]), _drums(), []
    centers = engine.motion.frames["center"].copy()
    for step in range(round(_DRAWN[-1] / _DT)):
        engine.advance(ground[step:step + 1])  # step by step, for past its point of no return it would end
        if len(drawn) < len(_DRAWN) and step + 1 == round(_DRAWN[len(drawn)] / _DT):
            places = zip(drums, centers[:, ::2], engine.motion.frames["center"][:, ::2], engine.motion.rotation[:, ::2, ::2])
            drawn.append([(drum - center) @ turned.T + place for drum, center, place, turned in places])
    return drawn


def collapse(target: Path, a: float = 0.5, tp: float = 0.34) -> str:
    """Draw the fall under a pulse of a [g] and tp [s]; what is drawn, in words."""
    drawn, standing = _fall(a, tp), _drums()
    shifts, right = [], 0.0
    for drums in drawn:
        every = np.concatenate([*drums, standing[0]])
        shifts.append(right + _GAP - every[:, 0].min())
        right = shifts[-1] + every[:, 0].max()
    width, top = right + _GAP, standing[-1][3, 1] + _ABOVE
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, PAGE_WIDTH_IN * (top + _BELOW) / width)
        figure.set_layout_engine("none")
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.axis("off")
        axes.set(xlim=(0.0, width), ylim=(-_BELOW, top))
        axes.fill_between([0.25, width - 0.25], -0.12, 0.0, facecolor="#DDDDDD", edgecolor="none")
        axes.plot([0.25, width - 0.25], [0.0, 0.0], color=BLACK, linewidth=0.8)
        for letter, time, drums, shift in zip("abcdef", _DRAWN, drawn, shifts):
            outline = np.concatenate([[drum[0] for drum in standing], [standing[-1][2], standing[-1][3]], [drum[1] for drum in standing[::-1]]])
            axes.plot(*(outline + [shift, 0.0]).T, color=GREY, linewidth=0.6, linestyle=(0, (4, 3)), zorder=1)
            for drum in drums:
                _draw_drum(axes, drum + [shift, 0.0])
            axes.text(shift, -0.2, f"({letter})  {time:.2f} s", ha="center", va="top")
        axes.plot([0.45, 1.45], [top - 0.2] * 2, color=BLACK, linewidth=1.6, solid_capstyle="butt")
        axes.text(0.95, top - 0.26, "1 m", ha="center", va="top", fontsize=8)
        save(figure, target.with_suffix(""), formats=("png",))
    return f"the package's rigid engine, a = {a:g} g, tp = {tp:g} s"


def _draw_drum(axes, drum) -> None:
    """A drum (4, 2) [m], bright where light from the left meets its round."""
    across = np.linspace(0.0, 1.0, _STRIPS + 1)[:, None]
    foot, head = drum[0] + across * (drum[1] - drum[0]), drum[2] + across * (drum[3] - drum[2])
    strips = np.stack([foot[:-1], foot[1:], head[1:], head[:-1]], axis=1)
    angle = np.arcsin(2 * (across[:-1, 0] + 0.5 / _STRIPS) - 1)
    light = np.clip(np.cos(angle + 0.6), 0.0, 1.0) ** 0.9
    axes.add_collection(PolyCollection(strips, facecolors=_STONE(light), edgecolors="face", linewidths=0.3, zorder=2))
    axes.fill(*drum[[0, 1, 3, 2]].T, facecolor="none", edgecolor=BLACK, linewidth=0.7, joinstyle="round", zorder=3)
