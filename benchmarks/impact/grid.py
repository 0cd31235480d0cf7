"""The map of impacts: its cells, their releases and steps, and rows kept in a file each."""

from __future__ import annotations

import itertools
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from benchmarks.impact.loss import StoodStill, impact_of
from benchmarks.impact.sections import SHAPES, Body, let_go, releases, rigid_block
from benchmarks.kept import complete, found

RATIOS = (2.0, 3.0, 4.5, 7.0, 10.0)
GROUPS = (1e3, 1e4, 1e5, 1e6, 1e7, 1e8)
FRICTIONS = (0.3, 0.8)
#: Tilt of release over the critical one; releases beside each other; steps at the impact over the
#: time in which a wave crosses the width, the last is the row of the map.
SHARE, BESIDE, STEPS = 0.3, 8, (1 / 4, 1 / 16)
#: Cells in which more is tried, to know the error that is left: finer elements, more modes, a step
#: that is shorter again, another tilt of release.
CHECKED = tuple(
    Body(shape, ratio, group)
    for shape, ratio, group in (
        ("block", 3.0, 1e5),
        ("block", 7.0, 1e6),
        ("solid", 4.5, 1e5),
        ("solid", 10.0, 1e7),
        ("tube", 3.0, 1e7),
        ("tube", 7.0, 1e5),
    )
)
MAP = "map"
COLUMNS = (
    "check",
    "shape",
    "ratio",
    "group",
    "friction",
    "elements",
    "modes",
    "share",
    "step",
    "release",
    "rocking",
    "contact",
    "restitution",
    "housner",
    "seconds",
    "said",
)


def jobs(folder: Path, cells: list[Body]) -> dict[Path, tuple]:
    """Arguments of `cell` by file: the cells of the map, and the checks of those of them that are
    in CHECKED.
    """
    made = [(MAP, body, SHARE, STEPS) for body in cells]
    for body in CHECKED:
        if body in cells:
            made += [
                ("elements", replace(body, elements=12), SHARE, STEPS[-1:]),
                ("modes", replace(body, modes=300), SHARE, STEPS[-1:]),
                ("step", body, SHARE, (STEPS[-1] / 4,)),
                ("share", body, 0.15, STEPS[-1:]),
            ]
    return {
        folder
        / "cells"
        / f"{check}-{one.shape}-{one.ratio:g}-{one.group:g}-{one.friction:g}.json": (
            check,
            one,
            share,
            steps,
            BESIDE,
        )
        for check, one, share, steps in made
    }


def cells(ratios=RATIOS, groups=GROUPS, shapes=SHAPES, frictions=FRICTIONS) -> list[Body]:
    """Of the map."""
    return [Body(*one) for one in itertools.product(shapes, ratios, groups, frictions)]


def cell(check: str, body: Body, share: float, steps, beside: int) -> list[dict]:
    """Rows of COLUMNS of a cell, by step and release; "said" tells why there is no loss."""
    block, frequency = rigid_block(body)
    rows = []
    for step, release in itertools.product(steps, releases(block, frequency, share, beside)):
        dt = step * body.crossing
        row = {
            "check": check,
            **asdict(body),
            "share": share,
            "step": step,
            "release": release,
            "said": "",
        }
        try:
            loss = asdict(impact_of(let_go(body, block, release, dt), block, release, dt))
        except StoodStill as error:
            loss, row["said"] = dict.fromkeys(COLUMNS[10:15], float("nan")), str(error)
        rows.append({key: (row | loss)[key] for key in COLUMNS})
    return rows


def rows_of(folder: Path, wanted: list[Body], workers: int) -> list[dict]:
    """Rows of COLUMNS of the cells, those that the folder has not are computed; 0 workers compute
    none.
    """
    all_of_them = jobs(folder, wanted)
    if workers:
        complete(cell, all_of_them, workers, "cells")
    return [row for rows in found(all_of_them) for row in rows]


def by_cell(rows: list[dict], check: str = MAP) -> list[dict]:
    """Of each cell the loss at the shortest step, mean of the releases with the half width of its
    95 % interval, their least and most, how many there are; and the change of the mean from the
    step before, nan where there is one step.
    """
    keys = ("shape", "ratio", "group", "friction")
    grouped: dict[tuple, list[dict]] = {}
    for row in rows:
        if row["check"] == check:
            grouped.setdefault(tuple(row[key] for key in keys), []).append(row)
    return [dict(zip(keys, names)) | _limit(own) for names, own in sorted(grouped.items())]


def _limit(rows: list[dict]) -> dict:
    """As of `by_cell`, of one cell."""
    from scipy.stats import t

    by_step = {}
    for row in rows:
        if np.isfinite(row["rocking"]):
            by_step.setdefault(row["step"], []).append(row["rocking"])
    told = {step: np.array(values) for step, values in by_step.items()}
    if not told:
        return dict(loss=np.nan, half_width=np.nan, least=np.nan, most=np.nan, releases=0) | dict(
            change=np.nan, contact=np.nan, housner=rows[0]["housner"]
        )
    steps = sorted(told)
    values = told[steps[0]]
    n = len(values)
    return {
        "loss": float(values.mean()),
        "half_width": float(t.ppf(0.975, n - 1) * values.std(ddof=1) / np.sqrt(n))
        if n > 1
        else np.nan,
        "least": float(values.min()),
        "most": float(values.max()),
        "releases": n,
        "change": float(values.mean() - told[steps[1]].mean()) if len(steps) > 1 else np.nan,
        "contact": float(np.nanmean([row["contact"] for row in rows if row["step"] == steps[0]])),
        "housner": float(np.nanmax([row["housner"] for row in rows])),
    }
