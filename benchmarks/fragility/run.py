"""The analyses of a structure in drawn motions, as a study: what is done is kept."""

from __future__ import annotations

from pathlib import Path

from benchmarks.fragility.motions import ensemble_file, parameters
from benchmarks.fragility.structures import case_of
from benchmarks.soak.analysis import ENTRY
from benchmarks.tables.runs import MOTION, read_runs, write_runs
from fecolumn.engines.dynamics.cuts import Stop
from fecolumn.engines.ending import SLID_OFF
from fecolumn.engines.left_part import OVER_EDGE
from fecolumn.study.plan import Plan, PlannedAnalysis
from fecolumn.study.run import complete_study
from fecolumn.study.store import DONE, FAILED

#: Columns of a row. outcome: a word of summary.json, or FAILED. shift_m: largest residual slide of
#: a joint; slide_m: of the observed foot.
COLUMNS = (
    "structure",
    "motion",
    "magnitude",
    "distance_km",
    "pulse_period_s",
    "pgv_m_s",
    "pga_m_s2",
    "outcome",
    "tilt_max_over_critical",
    "shift_m",
    "u_max_m",
    "cpu_s",
)
#: Longest time followed after the motion, unless all is at rest before [s].
REST_S = 2.0
#: What an analysis says that ends because a body slid or walked by `structures.SLIDES` from its
#: place on another, or because columns of a frame fell against each other: it is lost.
_LOST = (
    Stop.OFF_PATCH.value,
    OVER_EDGE,
    "came through each other",
)
_KEYS = ("motion.source",)
#: Steps [s] of the analyses whose rows come with the repository
STEP_S = 2e-3


def plan_of(name: str, file: Path, count: int, dt: float, rest_s: float = REST_S) -> Plan:
    """The study of a structure in the motions 1 ... count of a file, with steps of dt [s], followed
    until all is at rest or for rest_s [s] after the motion.
    """
    sources = tuple(f"{file}#{number}" for number in range(1, count + 1))
    analyses = []
    for source in sources:
        case = case_of(
            name,
            dict(
                title=name,
                motion=dict(source=source, free_vibration_s="rest", rest_ceiling_s=rest_s),
                # one of 11,000 needs more than the four that a case has unless it says so
                integration=dict(dt_s=dt, duration_s=0.0, max_cuts=8),
                output=dict(history_every_s=0.05, states_every_s=0.0),
            ),
        )
        analyses.append(PlannedAnalysis(case, case.id, _KEYS, (source,)))
    return Plan(Path("benchmarks.fragility"), name, {_KEYS[0]: sources}, tuple(analyses), {})


def kept_name(name: str) -> str:
    """Of the rows of a structure in benchmarks/tables."""
    return f"fragility/{name.replace(' ', '-')}"


def keep(name: str, rows: list[dict]) -> None:
    """Have the rows of a structure come with the repository."""
    runs = {row[MOTION]: {key: row[key] for key in COLUMNS[2:]} for row in rows}
    title = f"{name}: outcomes in drawn near-fault motions, steps of {STEP_S:g} s"
    write_runs(kept_name(name), runs, title, f'python -m benchmarks.fragility "{name}" --keep')


def rows_of(
    name: str, folder: Path, count: int, dt: float, workers: int, rest_s: float = REST_S
) -> list[dict]:
    """Rows of COLUMNS of a structure in so many motions; those that neither the repository nor the
    folder holds are computed, by no workers none. rest_s: as of `plan_of`.
    """
    kept = read_runs(kept_name(name)) if (dt, rest_s) == (STEP_S, REST_S) else {}
    rows = {number: dict(structure=name, motion=number, **row) for number, row in kept.items()}
    whole = range(1, count + 1)
    if rows.keys() >= set(whole):
        return [rows[number] for number in whole]
    file = ensemble_file(folder, count)
    plan = plan_of(name, file, count, dt, rest_s)
    missing = {one.id for number, one in enumerate(plan.analyses, 1) if number not in rows}
    drawn = parameters(file)
    longer = "" if rest_s == REST_S else f"-{rest_s:g}"
    into = folder / f"{name.replace(' ', '-')}-{count}-{dt:g}{longer}"
    only = missing if workers else set()
    ledger = complete_study(plan, into, workers=max(workers, 1), entry=ENTRY, only=only)
    for number, entry in enumerate(ledger, 1):
        summary = entry["summary"] if entry["state"] == DONE else None
        if number in rows or summary is None and entry["state"] != FAILED:
            continue
        rows[number] = {
            "structure": name,
            "motion": number,
            **{key: float(values[number - 1]) for key, values in drawn.items()},
            **(_outcome(summary) if summary else dict.fromkeys(COLUMNS[8:], float("nan"))),
            "outcome": summary["outcome"] if summary else _fate(entry["reason"]),
        }
    return [rows[number] for number in whole if number in rows]


def _fate(reason: str) -> str:
    return SLID_OFF if any(words in reason for words in _LOST) else FAILED


def _outcome(summary: dict) -> dict[str, float]:
    joints = summary.get("interfaces") or {}
    return {
        "tilt_max_over_critical": summary["tilt_max_rad"] / summary["critical_tilt_rad"],
        "shift_m": max(
            (one["residual_slide_m"] for one in joints.values()),
            default=summary["residual_slide_m"],
        ),
        "u_max_m": summary["u_max_m"],
        "cpu_s": summary["cpu_s"] or summary["wall_s"],
    }
