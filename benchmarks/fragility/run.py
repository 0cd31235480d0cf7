"""The analyses of a structure in drawn motions, as a study: what is done is kept."""

from __future__ import annotations

from pathlib import Path

from benchmarks.fragility.motions import ensemble_file, parameters
from benchmarks.fragility.structures import case_of
from benchmarks.soak.analysis import ENTRY
from fecolumn.engines.ending import SLID_OFF
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
#: place on another: it is lost.
_LEFT = "left the part of the face below it"
_KEYS = ("motion.source",)


def plan_of(name: str, file: Path, count: int, dt: float) -> Plan:
    """The study of a structure in the motions 1 ... count of a file, with steps of dt [s]."""
    sources = tuple(f"{file}#{number}" for number in range(1, count + 1))
    analyses = []
    for source in sources:
        case = case_of(
            name,
            dict(
                title=name,
                motion=dict(source=source, free_vibration_s="rest", rest_ceiling_s=REST_S),
                integration=dict(dt_s=dt, duration_s=0.0),
                output=dict(history_every_s=0.05, states_every_s=0.0),
            ),
        )
        analyses.append(PlannedAnalysis(case, case.id, _KEYS, (source,)))
    return Plan(Path("benchmarks.fragility"), name, {_KEYS[0]: sources}, tuple(analyses), {})


def rows_of(name: str, folder: Path, made: int, count: int, dt: float, workers: int) -> list[dict]:
    """Rows of COLUMNS of a structure in the first `count` of `made` motions; those that the folder
    does not hold are computed.
    """
    file = ensemble_file(folder, made)
    drawn = parameters(file)
    ledger = complete_study(
        plan_of(name, file, count, dt),
        folder / f"{name.replace(' ', '-')}-{count}-{dt:g}",
        workers=max(workers, 1),
        entry=ENTRY,
        only=None if workers else set(),
    )
    rows = []
    for place, entry in enumerate(ledger):
        summary = entry["summary"] if entry["state"] == DONE else None
        if summary is None and entry["state"] != FAILED:
            continue
        rows.append(
            {
                "structure": name,
                "motion": place + 1,
                **{key: float(values[place]) for key, values in drawn.items()},
                **(_outcome(summary) if summary else dict.fromkeys(COLUMNS[8:], float("nan"))),
                "outcome": summary["outcome"] if summary else _fate(entry["reason"]),
            }
        )
    return rows


def _fate(reason: str) -> str:
    return SLID_OFF if _LEFT in reason else FAILED


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
