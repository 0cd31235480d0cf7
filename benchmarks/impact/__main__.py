"""What an impact takes when everything is converged: loss of one impact over Housner's by time
step, engine, modes, tilt, slenderness, bricks, damping.

    ./containers/run python -m benchmarks.impact [SERIES ...] [-o DIR]
    ./containers/run python -m benchmarks.impact map --help
    ./containers/run python -m benchmarks.impact formula

Each impact is one line of DIR/impact.csv (results/impact unless given); those there are not made
again. Ends with two tables, and DIR/impact.png. SERIES are names of `SERIES`, all unless named. All
but bricks-2.5 take half an hour on one core, and bricks-2.5 longer. benchmarks/impact/impact.csv is
the table behind the manual's figure, which `python -m benchmarks.gallery impact` draws; copy a new
one there. It has no bricks-2.5.
"""

from __future__ import annotations

import argparse
import csv
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np

from benchmarks.impact import kept_map
from benchmarks.impact import map as impact_map
from benchmarks.impact.figure import draw
from benchmarks.impact.loss import first_impact

STEPS = (1e-3, 2.5e-4, 1e-4, 2.5e-5, 1e-5, 4e-6, 2e-6)
# The column vibrates after its release, and the loss depends on where in a vibration it lands: from
# one of these releases to the next by an eighth of one (column of 1.5 m, 0.3 of the critical tilt).
BESIDE = tuple(1 + 0.005 * k for k in range(8))
# of what is compared with the main series; of what is slow: by a quarter of a vibration
FEW_STEPS, EVERY_OTHER = (1e-3, 1e-4, 1e-5, 4e-6), BESIDE[::2]


def _series(kind: str, beside=BESIDE, steps=STEPS, share: float = 0.3, **settings):
    return [
        dict(kind=kind, share=round(share * more, 6), dt=dt, **settings)
        for dt in steps
        for more in beside
    ]


SERIES = {
    "reduced": _series("reduced"),
    "rigid": _series("reduced", modes=0),
    "full": _series("full", EVERY_OTHER, (1e-3, 2.5e-4, 1e-4, 1e-5)),
    "modes-300": _series("reduced", EVERY_OTHER, (1e-3, 1e-4, 1e-5), modes=300),
    **{
        f"share-{share:g}": _series("reduced", EVERY_OTHER, FEW_STEPS, share)
        for share in (0.05, 0.1, 0.6)
    },
    "modes-30": _series("reduced", EVERY_OTHER, FEW_STEPS, modes=30),
    "alpha-0.2": _series("reduced", EVERY_OTHER, FEW_STEPS, alpha=-0.2),
    "damping-0.02": _series("reduced", EVERY_OTHER, FEW_STEPS, damping=0.02),
    "height-0.5": _series("reduced", EVERY_OTHER, FEW_STEPS, height=0.5),
    # whose loss falls for longer
    "height-3": _series("reduced", EVERY_OTHER, (*FEW_STEPS, 2e-6, 1e-6), height=3.0),
    "bricks-2.5": _series("full", (1.0,), STEPS[:4], size=0.0025),
}
#: Names of the series for a reader; 0.3 of the critical tilt and 100 modes where nothing is said
LABELS = {
    "reduced": "reduced engine",
    "rigid": "rigid body on its elastic foot",
    "full": "full order",
    **{f"share-{share:g}": f"reduced, from {share:g}" for share in (0.05, 0.1, 0.6)},
    "modes-30": "reduced, 30 modes",
    "modes-300": "reduced, 300 modes",
    "alpha-0.2": "reduced, alpha -0.2",
    "damping-0.02": "reduced, modal damping 2 %",
    "height-0.5": "reduced, column of 0.5 m",
    "height-3": "reduced, column of 3 m",
    "bricks-2.5": "full order, bricks of 2.5 mm",
}
FIELDS = (
    "series",
    "kind",
    "share",
    "dt",
    "modes",
    "alpha",
    "damping",
    "height",
    "size",
    "away",
    "contact",
    "rocking",
    "restitution",
    "housner",
    "seconds",
)


def main(argv) -> int:
    if argv[:1] == ["map"]:
        return impact_map.main(argv[1:])
    if argv == ["formula"]:
        return kept_map.main()
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.impact",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("series", nargs="*", metavar="SERIES", help=", ".join(SERIES))
    parser.add_argument("-o", "--out", type=Path, default=Path("results/impact"))
    options = parser.parse_args(argv)
    if unknown := set(options.series) - set(SERIES):
        parser.error(f"{', '.join(sorted(unknown))}: must be of {', '.join(SERIES)}")
    table = options.out / "impact.csv"
    options.out.mkdir(parents=True, exist_ok=True)
    if not table.exists():
        table.write_text(",".join(FIELDS) + "\n")
    made = {tuple(row[name] for name in FIELDS[:10]) for row in read(table)}
    for name in options.series or SERIES:
        for settings in SERIES[name]:
            key = tuple(
                str(settings.get(field, "")) if field != "series" else name for field in FIELDS[:10]
            )
            if key in made:
                continue
            loss = asdict(first_impact(**settings))
            with table.open("a", newline="") as file:
                csv.writer(file).writerow([*key, *(f"{loss[field]:.6g}" for field in FIELDS[10:])])
            print(
                f"{name}, share {settings['share']:g}, dt {settings['dt']:g} s: rocking "
                f"{loss['rocking']:.3f}, contact {loss['contact']:.3f} of Housner's",
                file=sys.stderr,
                flush=True,
            )
    rows = read(table)
    print_tables(rows)
    draw(rows, options.out / "impact")
    return 0


def read(table: Path) -> list[dict]:
    """Rows of the table as text."""
    with table.open(newline="") as file:
        return list(csv.DictReader(file))


def print_tables(rows) -> None:
    """Markdown: what rocking loses over Housner's, and in parentheses what contact has taken of it,
    means over the releases; and the least and most of what rocking loses.
    """
    for cell in (means, extremes):
        steps = sorted({float(row["dt"]) for row in rows}, reverse=True)
        heads = ["series", "Housner's restitution", *(f"{dt:g} s" for dt in steps)]
        print(f"| {' | '.join(heads)} |\n|---{'|---:' * (len(heads) - 1)}|")
        for name in SERIES:
            own = [row for row in rows if row["series"] == name]
            if own:
                cells = [cell([row for row in own if float(row["dt"]) == dt]) for dt in steps]
                housner = f"{float(own[0]['housner']):.4f}"
                print(f"| {' | '.join([LABELS[name], housner, *cells])} |")
        print()


def means(rows) -> str:
    found = [(float(row["rocking"]), float(row["contact"])) for row in rows]
    return "{:.2f} ({:.2f})".format(*np.mean(found, axis=0)) if found else ""


def extremes(rows) -> str:
    found = [float(row["rocking"]) for row in rows]
    return " to ".join(f"{loss:.2f}" for loss in sorted(found)[:: len(found) - 1 or 1])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
