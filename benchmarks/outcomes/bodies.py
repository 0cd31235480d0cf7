"""Analyses of bodies with contact and friction on a flat ground, rigid and elastic, as a study."""

from __future__ import annotations

import math
from pathlib import Path

from benchmarks.outcomes.draws import DENSITY, Drawn, drawn
from benchmarks.outcomes.motions import stored
from benchmarks.soak.analysis import ENTRY
from fecolumn.case.case import Case, case_from_tables
from fecolumn.engines.ending import lost
from fecolumn.study.plan import Plan, PlannedAnalysis
from fecolumn.study.run import complete_study
from fecolumn.study.store import DONE

RIGID, ELASTIC = "rigid body", "elastic body"
#: Step [s], time followed after a motion unless all is at rest before [s]; elastic modes; elements
#: around a cylinder and along the side of a block.
STEP, REST_S, MODES, AROUND, ALONG = 2e-3, 2.0, 10, 12, 3
#: Analyses of each elastic body that is made, one after the other: a body's model takes seconds.
SHAKEN = 100
_ENGINES = {RIGID: "rigid", ELASTIC: "reduced"}
_KEYS = ("number",)


def case_of(kind: str, one: Drawn, file: Path) -> Case:
    """Case of a drawn body and motion."""
    size = 3.14 * one.width / AROUND if one.round else one.width / ALONG
    body = dict(
        height_m=one.height,
        density_kg_m3=DENSITY,
        youngs_modulus_pa=one.youngs,
        poissons_ratio=0.2,
        element_size_m=size,
        rigid=kind == RIGID,
    ) | (
        dict(kind="cylinder", outer_diameter_m=one.width)
        if one.round
        else dict(kind="block", length_m=one.width, width_m=one.width)
    )
    return case_from_tables(
        dict(
            bodies=dict(body=body),
            joints=dict(foot=dict(between=["body", "ground"])),
            contact=dict(friction_coefficient=one.friction, interior_points=0),
            motion=dict(
                source=f"{file}#{one.motion + 1}",
                scale=one.scale,
                free_vibration_s="rest",
                rest_ceiling_s=REST_S,
            ),
            integration=dict(engine=_ENGINES[kind], dt_s=STEP, n_modes=MODES),
            output=dict(history_every_s=0.05, states_every_s=0.0),
        ),
        "benchmarks.outcomes",
    )


def draws_of(kind: str, count: int, file: Path) -> list[Drawn]:
    """So many draws; of elastic ones SHAKEN are of one body, friction and motion their own."""
    ensemble = stored(file)
    made = drawn(kind, 0, count, ensemble, False)
    if kind == RIGID:
        return made
    few = drawn(kind, 1, math.ceil(count / SHAKEN), ensemble, False)
    return [_shaken(one, few[place // SHAKEN]) for place, one in enumerate(made)]


def _shaken(one: Drawn, body: Drawn) -> Drawn:
    """`body` in the motion and on the ground of `one`, as strong for it as for `one`."""
    times = (body.width / body.height) / (one.width / one.height)
    return Drawn(
        body.width,
        body.height,
        one.friction,
        body.youngs,
        body.restitution,
        body.round,
        one.motion,
        one.scale * times,
    )


def plan_of(kind: str, draws: list[Drawn], file: Path) -> Plan:
    """Study of the draws."""
    analyses = []
    for number, one in enumerate(draws):
        case = case_of(kind, one, file)
        analyses.append(PlannedAnalysis(case, case.id, _KEYS, (number,)))
    return Plan(
        Path("benchmarks.outcomes"),
        kind,
        {_KEYS[0]: tuple(range(len(draws)))},
        tuple(analyses),
        {},
    )


def rows_of(kind: str, count: int, file: Path, folder: Path, workers: int) -> list[dict]:
    """Rows of so many analyses; those that the folder has not are computed, by 0 workers none. An
    analysis that failed has no row.
    """
    draws, ensemble = draws_of(kind, count, file), stored(file)
    ledger = complete_study(
        plan_of(kind, draws, file),
        folder / f"{kind.replace(' ', '-')}-{count}",
        workers=max(workers, 1),
        entry=ENTRY,
        only=None if workers else set(),
    )
    return [
        one.columns(ensemble, False) | _response(kind, one, entry["summary"])
        for one, entry in zip(draws, ledger)
        if entry["state"] == DONE
    ]


def _response(kind: str, one: Drawn, summary: dict) -> dict:
    return {
        "model": kind,
        "friction": one.friction,
        **({"youngs_modulus_pa": one.youngs} if kind == ELASTIC else {}),
        "slenderness_rad": one.slenderness,
        "p_rad_s": one.frequency,
        "outcome": summary["outcome"],
        "peak_over_critical": summary["tilt_max_rad"] / summary["critical_tilt_rad"],
        "peak_displacement_m": summary["u_max_m"],
        "residual_slide_m": summary["residual_slide_m"],
        "impacts": summary["impacts"],
        "censored": lost(summary),
    }
