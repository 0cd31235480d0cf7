"""The two pictures of the README, from analyses of this package: a rocking column, and the CDFs of the quick study.

    ./containers/run python -m benchmarks.pictures [-o DIR] [-j N]

Writes meshes/rocking.png and benchmarks/cdf.png; analyses go to DIR and are resumed there. Five minutes on two cores.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import numpy as np

from fecolumn.case import case_from_tables
from fecolumn.dynamics.history import read_history
from fecolumn.mesh.bricks import BASE, CAP, LOWER, UPPER
from fecolumn.schema import read_toml
from fecolumn.simulation import run
from fecolumn.study.plan import read_plan
from fecolumn.study.run import run_study
from fecolumn.study.table import write_figure

ROOT = Path(__file__).parents[1]
# The stout column in motion 3 of the Lick ensemble, half again as strong
ROCKING = {"mesh": {"coarse_size_m": 0.02, "cap_size_m": 0.025, "base_size_m": 0.03},
           "motion": {"source": "lick:3", "scale": 1.5}, "integration": {"engine": "reduced", "duration_s": 6.0},
           "output": {"fields_every_s": 0.02}}
_COLOURS = {LOWER: "#c67b5c", UPPER: "#9fb2c1", CAP: "#d8c08a", BASE: "#cfd1cc"}
_SIZE = (560, 760)  # [pixels]


def rocking(folder: Path, target: Path) -> None:
    """The column at its largest tilt, its upright position as a shade and the way of its top."""
    import pyvista

    tables = read_toml(ROOT / "meshes" / "stout.toml")
    for section, keys in ROCKING.items():
        tables[section] = tables.get(section, {}) | keys
    run(case_from_tables(tables, ROOT / "meshes" / "stout.toml"), folder)
    history = read_history(folder / "history.h5")
    reader = pyvista.get_reader(str(folder / "fields" / "fields.xdmf"))
    tilts = np.interp(reader.time_values, history["time"], history["tilt"])
    frame = int(np.argmax(tilts))
    reader.set_active_time_value(reader.time_values[frame])
    grid = reader.read()
    upright, moved = grid.copy(), grid.warp_by_vector("displacement [m]")
    parts = np.asarray(grid.cell_data["part"]).round().astype(int)
    plotter = pyvista.Plotter(off_screen=True, window_size=_SIZE)
    plotter.set_background("white")
    for part, colour in _COLOURS.items():
        if not (parts == part).any():
            continue
        plotter.add_mesh(moved.extract_cells(np.flatnonzero(parts == part)).extract_surface(), color=colour, show_edges=True,
                         edge_color="#5a6066", line_width=0.5, ambient=0.35)
        if part != BASE:
            plotter.add_mesh(upright.extract_cells(np.flatnonzero(parts == part)).extract_surface(), color=colour, opacity=0.12)
    height = moved.points[:, 2].max()
    done = history["time"] <= reader.time_values[frame]
    plotter.add_mesh(pyvista.lines_from_points(history["u_top"][done] + [0, 0, height]), color="#D55E00", line_width=2)
    lean = history["u_top"][int(np.argmin(np.abs(history["time"] - reader.time_values[frame])))][:2]
    across = np.array([lean[1], -lean[0]]) / np.hypot(*lean)  # looked at from the side, so that the tilt is seen
    middle = np.array([*(0.3 * lean), 0.47 * height])
    plotter.enable_parallel_projection()
    plotter.camera_position = [tuple(middle + 5 * np.array([*across, 0.35])), tuple(middle), (0, 0, 1)]
    plotter.camera.parallel_scale = 0.58 * height
    image = plotter.screenshot(None, return_img=True)
    plotter.close()
    _save(image, target)
    print(f"tilt {1e3 * tilts[frame]:.0f} mrad at {reader.time_values[frame]:.2f} s; wrote {target}")


def distributions(folder: Path, target: Path, jobs: int) -> None:
    """The figure that `fecolumn study` draws of the quick study."""
    plan = read_plan(ROOT / "benchmarks" / "quick_study.toml")
    write_figure(plan, run_study(plan, folder, workers=jobs), folder)
    (folder / "cdf.png").replace(target)
    print(f"wrote {target}")


def _save(image, target: Path) -> None:
    from PIL import Image

    Image.fromarray(image).quantize(128).save(target, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", metavar="DIR", default="results/pictures")
    parser.add_argument("-j", "--jobs", metavar="N", type=int, default=os.cpu_count() or 1, help="analyses at a time (default: %(default)s)")
    args = parser.parse_args()
    rocking(Path(args.output) / "rocking", ROOT / "meshes" / "rocking.png")
    distributions(Path(args.output) / "quick", ROOT / "benchmarks" / "cdf.png", args.jobs)


if __name__ == "__main__":
    main()
