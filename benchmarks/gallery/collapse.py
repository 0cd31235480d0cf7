"""How the multi-drum column of HybriDFEM's benchmark falls, computed by the package's rigid engine
and drawn as a row of pictures.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap

from fecolumn.engines.reduced_engine import engine_of
from fecolumn.pictures.figures.style import BLACK, GREY, PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.structures.structure import structure_model
from fecolumn.verification.multi_drum import DRUMS_DT, drum_case, drum_pulse, drums_of_column

# Times that are drawn [s]: the end of the first half of the pulse, that of the pulse, and the fall
_DRAWN = (0.34, 1.02, 2.3, 3.3, 3.8, 4.12)
# Between two pictures, above them and below the ground [m]
_GAP, _ABOVE, _BELOW = 0.85, 0.7, 0.6
# Strips of a drum's shade, and its colours from the rim to the side from which light falls
_STRIPS = 60
_STONE = LinearSegmentedColormap.from_list("stone", ["#8C8170", "#F4EFE4"])


def _fall(a: float, tp: float) -> list[list[np.ndarray]]:
    """Drums (4, 2) [m] at each time that is drawn."""
    with tempfile.TemporaryDirectory() as folder:
        case = drum_case(Path(folder))
        engine = engine_of(case, structure_model(case), "drums.toml")
    ground, drums, drawn = drum_pulse(a, tp, _DRAWN[-1]), drums_of_column(), []
    centers = engine.motion.frames["center"].copy()
    for step in range(round(_DRAWN[-1] / DRUMS_DT)):
        # step by step, for past its point of no return it would end
        engine.advance(ground[step : step + 1])
        if len(drawn) < len(_DRAWN) and step + 1 == round(_DRAWN[len(drawn)] / DRUMS_DT):
            places = zip(
                drums,
                centers[:, ::2],
                engine.motion.frames["center"][:, ::2],
                engine.motion.rotation[:, ::2, ::2],
            )
            drawn.append(
                [(drum - center) @ turned.T + place for drum, center, place, turned in places]
            )
    return drawn


def collapse(target: Path, a: float = 0.5, tp: float = 0.34) -> str:
    """Draw the fall under a pulse of a [g] and tp [s]; what is drawn, in words."""
    drawn, standing = _fall(a, tp), drums_of_column()
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
            outline = np.concatenate(
                [
                    [drum[0] for drum in standing],
                    [standing[-1][2], standing[-1][3]],
                    [drum[1] for drum in standing[::-1]],
                ]
            )
            axes.plot(
                *(outline + [shift, 0.0]).T,
                color=GREY,
                linewidth=0.6,
                linestyle=(0, (4, 3)),
                zorder=1,
            )
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
    axes.add_collection(
        PolyCollection(
            strips, facecolors=_STONE(light), edgecolors="face", linewidths=0.3, zorder=2
        )
    )
    axes.fill(
        *drum[[0, 1, 3, 2]].T,
        facecolor="none",
        edgecolor=BLACK,
        linewidth=0.7,
        joinstyle="round",
        zorder=3,
    )
