"""Study folders, their ledgers and results; whatever is wrong, no figure that is not the analyses'
own comes out.
"""

from __future__ import annotations

import functools
import io
import json
import os
from collections import deque
from pathlib import Path

from benchmarks.fuzz import cases
from benchmarks.fuzz.damage import BYTES, displaced, flip, zeroed
from fecolumn.foundation.atomic import write_json
from fecolumn.foundation.schema import InputError
from fecolumn.simulation import read_folder_case
from fecolumn.study.plan import read_plan
from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.run import complete_study
from fecolumn.study.store import read_study
from fecolumn.study.table import write_tables
from fecolumn.study.worker import streams_kept, work_off

_STUDY = """title = "pulses"
case = "specimen.toml"
[axes]
"integration.dt_s" = [0.02, 1e-3]
"motion.source" = ["pulse:1", "pulse:2", "pulse:3"]
"""
ENTRY = "benchmarks.fuzz.folders:analyse"
_FALSE = [
    [],
    1,
    "text",
    None,
    {},
    {"u_max_m": -1.0},
    {"u_max_m": float("nan")},
    {"u_max_m": "0.1"},
    {"u_max_m": True},
    {"overturned": 1},
    {"case_id": "another"},
    {"energy_closure_rel": 10**400},
    {"steps": [1]},
    {"wall_s": None},
    {"s_per_step": 1e999},
    {"energy_j": 3},
]


def analyse(case, folder, *, comm=None, file="", quiet=True) -> dict:
    """An analysis whose figures follow from the case alone."""
    number = int(case.id, 16) % 1000
    summary = {
        "case_id": case.id,
        "version": "0",
        "u_max_m": 1e-3 * number,
        "overturned": number > 700,
        "residual_slide_m": 0.0,
        "steps": number,
        "wall_s": 1.0,
        "s_per_step": 1e-3,
        "energy_closure_rel": 1e-9,
        "energy_j": {"impact": -1.0},
        "overturn_time_s": 1.0,
    }
    write_json(Path(folder) / "summary.json", summary)
    return summary


class OwnTeam:
    """Does the work in this process."""

    size = 1

    def __init__(self):
        self._batches: deque = deque()

    @property
    def at_work(self) -> bool:
        return bool(self._batches)

    def wants(self, depth: int) -> bool:
        return not self._batches

    def give(self, batch) -> None:
        self._batches.append(batch)

    def collect(self, timeout_s: float) -> list:
        with streams_kept():
            return (
                list(work_off(self._batches.popleft(), analyse, "study.toml"))
                if self._batches
                else []
            )

    def stop(self) -> None:
        self._batches.clear()


def _run(folder: Path) -> list[dict]:
    plan = _plan(folder.parent / "study.toml")
    rows = complete_study(
        plan, folder, entry=ENTRY, stream=io.StringIO(), workers=OwnTeam(), retry_failed=True
    )
    write_tables(plan, rows, folder)
    return rows


@functools.cache
def _truth(file) -> dict:
    return {analysis.id: 1e-3 * (int(analysis.id, 16) % 1000) for analysis in _plan(file).analyses}


_plan = functools.cache(read_plan)


def prepare(folder: Path) -> None:
    """A study that is done."""
    cases.prepare(folder)
    (folder / "study.toml").write_text(
        _STUDY.replace("[axes]", '[axes]\n"integration.duration_s" = [1.0]')
    )
    for row in _run(folder / "out"):
        tables = {
            "column": {"outer_diameter_m": 0.1, "height_m": 1.0, "wall_m": 0.01},
            "base": {"length_m": 1.0, "width_m": 1.0, "thickness_m": 0.1},
            "integration": {"duration_s": 1.0},
        }
        write_json(
            folder / "out" / "analyses" / row["id"] / "case.json",
            {"id": row["id"], "file": "case.toml", "case": tables},
        )


def sound(folder: Path) -> Path:
    """The study as it is."""
    return folder / "out"


def mutate(rng, folder: Path) -> Path:
    """Something in the folder changed, once or twice."""
    out = folder / "out"
    for _ in range(int(rng.integers(1, 3))):
        result = out / "analyses" / str(rng.choice(sorted(_truth(folder / "study.toml"))))
        path = [
            out / "study.sqlite",
            out / "study.sqlite",
            out / "study.json",
            result / "summary.json",
            result / "summary.json",
            result / "case.json",
            out / "study.lock",
            out / "analyses",
            out / "logs",
            result,
            out / "table.csv",
            out / "study.sqlite-wal",
            out,
        ][int(rng.integers(13))]
        kind = rng.random()
        if not path.parent.is_dir():
            continue
        if kind < 0.3 or not path.is_file():
            displaced(rng, path)
        elif path.name == "summary.json" and kind < 0.7:
            wrong = _FALSE[int(rng.integers(len(_FALSE)))]
            path.write_text(
                json.dumps(_known(path) | wrong if isinstance(wrong, dict) and wrong else wrong)
            )
        elif path.name == "study.json" and kind < 0.7:
            known = _known(path)
            path.write_text(
                [
                    json.dumps(known | {"axes": []}),
                    "[" * 100_000,
                    "7",
                    json.dumps(known | {"analyses": "6"}),
                    json.dumps(known | {"axes": {}}),
                    "[]",
                    '{"study": 1}',
                    json.dumps({**known, "title": 10**400}),
                ][int(rng.integers(8))]
            )
        else:
            how = (flip, zeroed, *BYTES)[int(rng.integers(2 + len(BYTES)))]
            path.write_bytes(how(rng, path.read_bytes()))
    return out


def _known(path: Path) -> dict:
    """What a JSON file says, {} where it was damaged before."""
    try:
        known = json.loads(path.read_bytes())
    except ValueError:
        known = {}
    return known if isinstance(known, dict) else {}


def use(out: Path) -> None:
    """What `report`, `compare`, `resume` and `study` do with it; the last to be refused is told."""
    for read in (
        read_study,
        read_sweep,
        *(functools.partial(_case_of, name) for name in _truth(out.parent / "study.toml")),
    ):
        try:
            read(out)
        except InputError:
            pass
    rows = _run(out)
    truth = _truth(out.parent / "study.toml")
    assert {row["id"] for row in rows} == set(truth)
    for row in rows:
        assert row["state"] == "failed" or row["summary"]["u_max_m"] == truth[row["id"]], row
    assert read_study(out).rows == rows and os.path.getsize(out / "table.csv")


def _case_of(name: str, out: Path) -> None:
    read_folder_case(out / "analyses" / name)
