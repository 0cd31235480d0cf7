"""The wobbling model beside bodies with contact, bin by bin: the study of `elements` as a table."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.beside import compared, markdown, told
from benchmarks.wobbling.bins import LEVELS
from benchmarks.wobbling.elements import ENGINES, write_study
from fecolumn.engines.ending import lost
from fecolumn.motions.ensemble_file import file_and_number
from fecolumn.statistics.ecdf import percentile
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study

HEAD = (
    "bin",
    "motions",
    "overturned, bodies",
    "model",
    "median peak, bodies [mm]",
    "model [mm]",
    "e50",
    "D",
    "p",
    "same outcome [%]",
    "model over bodies",
)
#: Of the medians of what moves, peaks below it [m] are of a frame that stands
_STANDS = 1e-4


def runs_of(motions, folder: Path, jobs: int, most: int) -> dict[str, dict]:
    """Summaries by motion, "FF low 3", by engine, of the first motions of each bin; makes what is
    missing.
    """
    plan = read_plan(write_study(motions, folder))
    chosen = {one.id: _name_of(one.values["motion.source"]) for one in plan.analyses}
    only = {one for one, name in chosen.items() if int(name.split()[-1]) <= most}
    rows = complete_study(plan, folder / "results", workers=jobs, retry_failed=True, only=only)
    found: dict[str, dict] = {}
    for values, runs in settings_of(plan, rows):
        # a member's key is the text of its source
        named = {_name_of(member[0].strip("'\"")): run for member, run in runs.items()}
        found[values["integration.engine"]] = named
    return found


def _name_of(source: str) -> str:
    file, number = file_and_number(source)
    return f"{Path(file).stem.replace('_', ' ')} {number}"


def table(found: dict[str, dict]) -> str:
    """A line for each bin, for each level and for all."""
    bodies, model = (found[engine] for engine in ENGINES)
    motions = [one for one in bodies if one in model]
    groups: dict[str, list[str]] = {}
    for one in motions:
        groups.setdefault(one.rpartition(" ")[0], []).append(one)
    for level in LEVELS:
        groups[f"{level}, all"] = [one for one in motions if one.split()[1] == level]
    groups["all"] = motions
    lines = [
        _line(name, [[side[one] for one in some] for side in (bodies, model)])
        for name, some in groups.items()
        if some
    ]
    return markdown(HEAD, lines)


def _line(name: str, sides: list[list[dict]]) -> tuple[str, ...]:
    u, off = (np.array([[read(run) for run in side] for side in sides]) for read in (_peak, lost))
    fell = np.array([[bool(run["overturned"]) for run in side] for side in sides])
    medians = [percentile(*one, fraction=0.5) for one in zip(u, off)]
    distance, p, *_ = compared(*(dict(enumerate(side)) for side in sides))
    moves = ~off.any(axis=0) & (u > _STANDS).all(axis=0)
    ratio = f"{np.median(u[1, moves] / u[0, moves]):.2f}" if moves.any() else "-"
    return (
        name,
        str(len(sides[0])),
        *(str(one.sum()) for one in fell),
        *(f"{1e3 * one:.0f}" if np.isfinite(one) else "overturn" for one in medians),
        f"{abs(medians[1] - medians[0]) / medians[0]:.2f}" if np.isfinite(medians).all() else "-",
        f"{distance:.2f}",
        told(p),
        f"{100 * (fell[0] == fell[1]).mean():.0f}",
        ratio,
    )


def _peak(run: dict) -> float:
    return float(run["u_max_m"])
