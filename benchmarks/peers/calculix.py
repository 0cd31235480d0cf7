"""CalculiX 2.20 (Debian calculix-ccx): NLGEOM, C3D8, surface-to-surface penalty contact, HHT with
alpha = -0.05.

Settings. Penalty E / (100 brick sizes), the same for stick, on a floor of one fixed brick: with ten
times that, as in GetFEM's run, Newton cycles between two sets of contact springs after 7 steps of
the pipe. Ties as *EQUATION. ccx rejects increments of *DYNAMIC with contact whose energy changes by
more than a built-in share of the model's: a free block that flies far away with 500 J enlarges the
reference and takes no part otherwise. DIRECT keeps the increment: without it, impact rules cut it
eightfold.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.peers.child import Outcome, run_child
from benchmarks.peers.track import write_rows
from fecolumn.mesh.bricks import FACES

ALPHA = -0.05
PENALTY = 0.01
GHOST_J = 500.0
# Corners of the unit cube in the order of VTK and of C3D8
CUBE = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float
)


def _lines(values, form="{}"):
    """Rows of at most eight comma-separated values."""
    values = [form.format(value) for value in values]
    return "\n".join(", ".join(values[k : k + 8]) for k in range(0, len(values), 8))


def _numbered(first, rows, form="{:.11e}"):
    # ccx reads twenty characters of a number
    return "\n".join(
        f"{first + k}, " + ", ".join(form.format(value) for value in row)
        for k, row in enumerate(rows)
    )


def deck(job) -> str:
    """Input of ccx for a job as `Release.write` makes it."""
    points, cells = job["start"], job["cells"]
    n, m = len(points), len(cells)
    floor = (CUBE - [0.5, 0.5, 1.0]) * [0.5, 0.5, 0.1]
    ghost = CUBE * 0.5 + [0.0, 100.0, 100.0]
    density, young = float(job["density"]), float(job["youngs_modulus"])
    flight = np.sqrt(2 * GHOST_J / (density * 0.125))
    is_foot = np.zeros(n, bool)
    is_foot[job["foot"]] = True
    brick, side = np.nonzero(is_foot[cells[:, FACES]].all(axis=2))
    ties = []
    for slave, masters, weights in zip(job["slaves"], job["masters"], job["weights"]):
        kept = np.abs(weights) > 1e-12
        for axis in (1, 2, 3):
            terms = [f"{slave + 1}, {axis}, 1."] + [
                f"{node + 1}, {axis}, {-weight:.11e}"
                for node, weight in zip(masters[kept], weights[kept])
            ]
            # four terms a line
            ties.append(
                f"*EQUATION\n{len(terms)}\n"
                + "\n".join(", ".join(terms[k : k + 4]) for k in range(0, len(terms), 4))
            )
    stiffness = PENALTY * young / float(job["brick"])
    watched = np.unique(np.concatenate([job["toes"], job["top"], job["foot"]])) + 1
    dt, steps = float(job["dt"]), int(job["steps"])
    return "\n".join(
        [
            "*NODE, NSET=BODY",
            _numbered(1, points),
            "*NODE, NSET=FLOOR",
            _numbered(n + 1, floor),
            "*NODE, NSET=GHOST",
            _numbered(n + 9, ghost),
            "*ELEMENT, TYPE=C3D8, ELSET=COLUMN",
            _numbered(1, cells + 1, "{}"),
            "*ELEMENT, TYPE=C3D8, ELSET=SLAB",
            _numbered(m + 1, [np.arange(n + 1, n + 9)], "{}"),
            "*ELEMENT, TYPE=C3D8, ELSET=FLYING",
            _numbered(m + 2, [np.arange(n + 9, n + 17)], "{}"),
            "*NSET, NSET=WATCHED",
            _lines(watched),
            "*MATERIAL, NAME=STEEL",
            f"*ELASTIC\n{young:.16g}, {float(job['poissons_ratio']):.16g}",
            f"*DENSITY\n{density:.16g}",
            *(
                f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL"
                for name in ("COLUMN", "SLAB", "FLYING")
            ),
            *ties,
            "*BOUNDARY\nFLOOR, 1, 3",
            "*SURFACE, NAME=BELOW, TYPE=ELEMENT",
            "\n".join(f"{b + 1}, S{s + 1}" for b, s in zip(brick, side)),
            f"*SURFACE, NAME=GROUND, TYPE=ELEMENT\n{m + 1}, S2",
            "*SURFACE INTERACTION, NAME=RIM",
            f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness:.16g}",
            f"*FRICTION\n{float(job['friction']):.16g}, {stiffness:.16g}",
            "*CONTACT PAIR, INTERACTION=RIM, TYPE=SURFACE TO SURFACE\nBELOW, GROUND",
            f"*INITIAL CONDITIONS, TYPE=VELOCITY\nGHOST, 2, {flight:.16g}",
            "*STEP, NLGEOM, INC=1000000",
            f"*DYNAMIC, DIRECT, ALPHA={ALPHA}",
            f"{dt}, {steps * dt}, {dt / 1024}, {dt}",
            "*DLOAD",
            f"COLUMN, GRAV, {float(job['gravity']):.16g}, 0., 0., -1.",
            "*NODE PRINT, NSET=WATCHED, FREQUENCY=1\nU",
            "*END STEP",
            "",
        ]
    )


def displacements(text: str) -> list[tuple[float, dict[int, np.ndarray]]]:
    """(time [s], {point number: displacement (3,) [m]}) of each increment in the .dat file's text;
    an unfinished one is left out.
    """
    found = []
    for block in text.split(" displacements ")[1:]:
        head, _, body = block.partition("\n")
        rows = [line.split() for line in body.splitlines() if line.strip()]
        if all(len(row) == 4 for row in rows):
            found.append(
                (
                    float(head.split()[-1]),
                    {int(row[0]) - 1: np.array(row[1:], float) for row in rows},
                )
            )
    return found if len(found) < 2 or len(found[-1][1]) == len(found[0][1]) else found[:-1]


def increments(text: str) -> list[int]:
    """Iterations of each accepted increment in the .sta file's text."""
    rows = [line.split() for line in text.splitlines()]
    return [int(row[3]) for row in rows if len(row) == 7 and row[0].isdigit() and row[2].isdigit()]


def complaint(text: str) -> str:
    """Last *ERROR of ccx's output, in one line; empty without."""
    _, found, rest = text.rpartition("*ERROR")
    paragraph = rest.split("\n\n")[0]
    return " ".join((found + paragraph).split())[:120] if found else ""


def run(job_file: Path, folder: Path, limit: float) -> Outcome:
    """Run ccx on a job; writes track.csv as all peers do, from what ccx has printed so far if it
    stops early.
    """
    job = np.load(job_file)
    for earlier in folder.glob("column.*"):
        earlier.unlink()
    (folder / "column.inp").write_text(deck(job))
    status, spent = folder / "column.sta", []

    def look(cpu):
        # the file appears when the input has been read; one entry for that and one for each
        # increment
        done = 1 + len(increments(status.read_text())) if status.is_file() else 0
        spent.extend([cpu] * (done - len(spent)))

    outcome = run_child(["ccx", "column"], folder, limit, look)
    look(outcome.cpu)
    iterations = [0, *increments(status.read_text())] if status.is_file() else []
    printed = (
        displacements((folder / "column.dat").read_text())
        if (folder / "column.dat").is_file()
        else []
    )
    printed.insert(
        0, (0.0, {int(node): np.zeros(3) for key in ("toes", "top", "foot") for node in job[key]})
    )
    rows = []
    for (time, moved), cpu, count in zip(printed, spent, iterations):

        def mean(nodes, moved=moved):
            return np.mean([job["start"][node] + moved[node] for node in nodes], axis=0)

        axis = mean(job["top"]) - mean(job["foot"])
        toes = [job["start"][toe, 0] + moved[toe][0] - job["points"][toe, 0] for toe in job["toes"]]
        rows.append((time, np.arctan2(axis[0], axis[2]), *toes, np.nan, cpu, count, 1))
    write_rows(folder / "track.csv", rows)
    return replace(
        outcome, words=complaint((folder / "log.txt").read_text(errors="replace")) or outcome.words
    )
