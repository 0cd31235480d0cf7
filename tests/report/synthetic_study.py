"""Study folders with results drawn at random: peaks of a motion scatter over the settings as chaos
does, plus the effects a test asks for.
"""

from __future__ import annotations

import json
import math
import random
from pathlib import Path

from fecolumn.study.outcome import FAILED, TaskOutcome, finished_outcome
from fecolumn.study.plan import read_plan
from fecolumn.study.store import Store

SPECIMEN = Path(__file__).parents[2] / "meshes" / "stout.toml"
DT, ALPHA = "integration.dt_s", "integration.alpha_hht"
LIMIT_M = 0.25


def write_synthetic(
    folder: Path,
    axes: dict,
    motions: int,
    *,
    effect=lambda values: 1.0,
    scatter=0.5,
    fails=(),
    unfinished=(),
    cost=None,
    title="Synthetic study",
    sources=None,
    also=lambda values, summary: {},
    case=SPECIMEN,
    zipped="",
) -> Path:
    """A study folder.

    Parameters
    ----------
    folder
        made here; the study is in folder/out.
    axes
        levels by key, motions excluded.
    motions
        how many.
    effect
        factor on the peaks at the values of a setting.
    scatter
        ln-sd of the peaks of one motion over the settings.
    fails, unfinished
        places of analyses that failed, that were not run.
    sources
        of the motions, files with their numbers; without them the motions are names of nothing.
    cost
        wall time of a step [s] at the values of a setting; default 2e-4.
    also
        what else a summary has, from the values of all axes and the summary itself.
    case
        file of the case that all analyses share.
    zipped
        lines of a table [[zip]].
    """
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f'"{key}" = {list(values)}' for key, values in axes.items()]
    named = ", ".join(
        f'"{source}"' for source in sources or [f"pulse:{number}" for number in range(motions)]
    )
    (folder / "study.toml").write_text(
        f'title = "{title}"\ncase = "{case}"\n[axes]\n'
        + "\n".join(lines)
        + f'\n"motion.source" = [{named}]\n{"[[zip]]" if zipped else ""}\n{zipped}'
    )
    plan = read_plan(folder / "study.toml")
    with Store(folder / "out", plan, "synthetic:run") as store:
        for place, analysis in enumerate(plan.analyses):
            if place in unfinished:
                continue
            if place in fails:
                store.end(
                    TaskOutcome(
                        analysis.id, FAILED, "StepFailed: <no convergence> at t = 1.2 s", 1.0
                    )
                )
                continue
            result = store.result_folder(analysis.id)
            result.mkdir(parents=True, exist_ok=True)
            (result / "case.json").write_text(json.dumps({"case": analysis.case.as_stated()}))
            summary = _summary(analysis, effect, scatter, cost)
            (result / "summary.json").write_text(
                json.dumps(summary | also(analysis.values, summary))
            )
            store.end(finished_outcome(analysis.id, result))
    return folder / "out"


def _summary(analysis, effect, scatter, cost) -> dict:
    values, motion = analysis.combination, analysis.values["motion.source"]
    name = str(motion).rpartition("/")[2]  # a folder of the tests has another name every time
    common, own = random.Random(name), random.Random(f"{name} {sorted(values.items(), key=str)}")
    peak = 0.15 * math.exp(common.gauss(0, 0.9) + own.gauss(0, scatter)) * effect(values)
    fallen, dt = peak > LIMIT_M, values.get(DT, 1e-3)
    end = common.uniform(2, 5) if fallen else 12.0
    steps = round(end / dt)
    s_per_step = (cost(values) if cost else 2e-4) * math.exp(own.gauss(0, 0.05))
    return {
        "case_id": analysis.id,
        "version": "0.1.0",
        "engine": "reduced",
        "kinematics": "corotated",
        "dofs": 20964,
        "steps": steps,
        "dt_s": dt,
        "alpha_hht": values.get(ALPHA, -0.2),
        "motion": motion,
        "duration_s": end,
        "u_max_m": min(peak, LIMIT_M),
        "overturned": fallen,
        "overturn_time_s": end if fallen else None,
        "residual_slide_m": 0.001,
        "penetration_max_m": 1e-12,
        "ranks": 1,
        "wall_s": s_per_step * steps + 0.2,
        "s_per_step": s_per_step,
        "iterations": 2 * steps,
        "contact_iterations": 8 * steps,
        "impacts": 250,
        "cuts": 3,
        "energy_closure_rel": 1e-12 * math.exp(own.gauss(0, 1)),
        "energy_j": {
            "kinetic": 0.0,
            "strain": 0.0,
            "gravity": 0.0,
            "base_work": 0.2,
            "friction": -0.1,
            "impact": -0.05,
            "contact": -0.02,
            "algorithmic": -0.01,
            "closure": 1e-13,
        },
    }
