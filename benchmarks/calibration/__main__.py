"""Which specimen overturns as often as that of the paper: P(overturn) over diameter and height of
the column.

    ./containers/run python -m benchmarks.calibration [-o DIR] [-j N] [--motions N]

Katsamakas and Vassiliou (COMPDYN) publish neither dimensions nor motions; they found P(overturn) =
43.5 % at dt = 1e-3 s and alpha = -0.2. With the Lick ensemble the column nearest to it is chosen
here. 43.5 % is thus a calibration target of meshes/specimen.toml, never a result. Writes map.csv,
map.png and map.pdf into DIR; half an hour on two cores, resumed where it was stopped.
"""

from __future__ import annotations

import argparse
import csv
import io
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.cores import usable_cores
from fecolumn.pictures.figures.style import PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.store import DONE

TARGET = 0.435
DIAMETER, HEIGHT = "column.outer_diameter_m", "column.height_m"


def cells(rows) -> dict[tuple[float, float], tuple[int, int]]:
    """Overturned and done of every (diameter, height) [m]."""
    found = {}
    for row in rows:
        if row["state"] == DONE:
            key = (row["axes"][DIAMETER], row["axes"][HEIGHT])
            overturned, done = found.get(key, (0, 0))
            found[key] = overturned + row["summary"]["overturned"], done + 1
    return dict(sorted(found.items()))


def nearest(found) -> tuple[float, float]:
    """The column whose P(overturn) is nearest to the target."""
    return min(found, key=lambda key: abs(found[key][0] / found[key][1] - TARGET))


def draw(found, path) -> list[Path]:
    """The map: P(overturn) with its 95 % interval (Wilson) and the number of motions in each
    cell.
    """
    diameters, heights = (np.unique([key[axis] for key in found]) for axis in (0, 1))
    shares = np.full((len(heights), len(diameters)), np.nan)
    with styled():
        figure = new_figure(0.62 * PAGE_WIDTH_IN, 0.62 * PAGE_WIDTH_IN)
        axes = figure.subplots()
        for (diameter, height), (overturned, done) in found.items():
            row, column = np.searchsorted(heights, height), np.searchsorted(diameters, diameter)
            shares[row, column] = 100 * overturned / done
            low, high = proportion_interval(overturned, done)
            text = (
                f"{100 * overturned / done:.1f} %\n[{100 * low:.0f}, {100 * high:.0f}]\n$n$ "
                f"= {done}"
            )
            axes.text(
                column,
                row,
                text,
                ha="center",
                va="center",
                fontsize=7.5,
                color="white" if overturned / done > 0.4 else "black",
            )
        image = axes.imshow(shares, cmap="Blues", vmin=0, vmax=70, origin="lower", aspect="auto")
        row, column = (
            np.searchsorted(lines, value)
            for lines, value in zip((diameters, heights), nearest(found))
        )
        axes.add_patch(_frame(row, column))
        axes.set_xticks(range(len(diameters)), [f"{1e3 * value:g}" for value in diameters])
        axes.set_yticks(range(len(heights)), [f"{value:g}" for value in heights])
        axes.set(
            xlabel="outer diameter [mm], wall 5 mm", ylabel="height [m], with cap 150 x 150 x 10 mm"
        )
        axes.grid(False)
        axes.set_title(f"calibration target: {100 * TARGET:g} %")
        figure.colorbar(image, label=r"$P$(overturn) [%]")
        return save(figure, path)


def _frame(column, row):
    from matplotlib.patches import Rectangle

    return Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor="#c44e52", linewidth=2)


def table(found) -> str:
    """The map as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        [
            "outer_diameter_m",
            "height_m",
            "motions",
            "overturned",
            "p_overturn",
            "wilson_low",
            "wilson_high",
        ]
    )
    for (diameter, height), (overturned, done) in found.items():
        interval = proportion_interval(overturned, done)
        writer.writerow(
            [
                diameter,
                height,
                done,
                overturned,
                *(f"{value:.4f}" for value in (overturned / done, *interval)),
            ]
        )
    return text.getvalue()


def printed(found) -> str:
    """The map as a table of text: P(overturn) with its 95 % interval, a line a height."""
    diameters, heights = (sorted({key[axis] for key in found}) for axis in (0, 1))

    def cell(diameter, height):
        overturned, done = found.get((diameter, height), (0, 0))
        if not done:
            return ""
        low, high = proportion_interval(overturned, done)
        share = f"{100 * overturned / done:.1f} ({100 * low:.1f} to {100 * high:.1f})"
        return f"{share}, n = {done}"

    head = "height [m]", *(f"diameter {1e3 * one:g} mm: P [%]" for one in diameters)
    rows = [(f"{height:g}", *(cell(one, height) for one in diameters)) for height in heights]
    return markdown(head, rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", metavar="DIR", default="results/calibration")
    parser.add_argument(
        "-j",
        "--jobs",
        metavar="N",
        type=int,
        default=usable_cores(),
        help="analyses at a time (default: %(default)s)",
    )
    parser.add_argument("--motions", metavar="N", type=int, default=115, help="the first of them")
    args = parser.parse_args()
    plan = read_plan(Path(__file__).with_name("map.toml"))
    first = {f"lick:{number}" for number in range(1, args.motions + 1)}
    only = {one.id for one in plan.analyses if one.values["motion.source"] in first}
    folder = Path(args.output) / "study"
    found = cells(complete_study(plan, folder, workers=args.jobs, retry_failed=True, only=only))
    write_bytes(Path(args.output) / "map.csv", table(found).encode())
    files = draw(found, Path(args.output) / "map")
    print(printed(found))
    diameter, height = nearest(found)
    print(
        f"nearest to {100 * TARGET:g} %: outer diameter {1e3 * diameter:g} mm, height {height:g} m"
    )
    print("\n".join(f"wrote {file}" for file in files))


if __name__ == "__main__":
    main()
