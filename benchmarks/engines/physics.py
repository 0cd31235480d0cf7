"""The reduced engine against the full-order one, step by step on the specimen's own mesh."""

from __future__ import annotations

import sys
import time

import numpy as np
from mpi4py import MPI

from benchmarks.engines.motions import strong_shaking
from benchmarks.engines.pair import case_of, column, engine
from fecolumn.engines.full_system import FullSystem, full_system
from fecolumn.verification.models import system_of
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.rocking import leaning_start, rocked_trial, uplift_accelerations
from fecolumn.verification.sliding import slipped
from fecolumn.verification.trial import RigidRocking, Trial

MOTIONS, IMPACTS, MOST = 10, 3, 1000
# beside the default: up to 11 kHz
MODES = 100
# of a motion's Arias intensity, when the column begins to stand
BEGIN = 0.05
# of a velocity [m/s], when the column begins to rock: while it stands, friction takes it back
DISTURBANCE, AFTER = 1e-6, 100
ENGINES = ("corotated", "reduced")


def physics():
    """Thresholds, quarter period, restitution, then ten motions until the third main impact."""
    yield from thresholds()
    yield from rocking()
    yield from motions()


def thresholds():
    """Slow ramps of the ground acceleration: uplift at mu 0.8, sliding at mu 0.02, where so slender
    a column does not lift before.
    """
    for name, friction, found in (
        ("uplift, mu 0.8", 0.8, lambda trial: uplift_accelerations(trial)[1]),
        ("sliding, mu 0.02", 0.02, lambda trial: slipped(trial, 0.02)),
    ):
        system = system_of(
            case_of(
                contact={"friction_coefficient": friction},
                integration={"dt_s": 4e-3, "alpha_hht": 0.0},
            )
        )
        full, reduced = (found(begin_trial(one, system)) for one in ENGINES)
        yield f"{name}: ground acceleration [m/s2]", full, reduced, abs(reduced / full - 1) <= 0.005


def rocking():
    """Release at 0.4 of the critical tilt."""
    system = system_of(case_of(contact={"friction_coefficient": 0.8}))
    rigid = RigidRocking(system)
    initial = rigid.energy(0.4 * rigid.slenderness)
    full, reduced = (
        rocked_trial(begin_trial(one, system, leaning_start(0.4)), 0.4) for one in ENGINES
    )
    rebounds = [np.sqrt(1 - lost / initial) for _, lost in (full, reduced)]
    yield (
        "free rocking from 0.4 alpha: quarter period [s]",
        full[0],
        reduced[0],
        abs(reduced[0] / full[0] - 1) <= 0.005,
    )
    yield (
        "free rocking from 0.4 alpha: restitution, release included, both engines [-]",
        *rebounds,
        abs(rebounds[1] / rebounds[0] - 1) <= 0.005,
    )
    # no judgement: the loss of an elastic column depends on the step, see `impact`
    yield (
        "free rocking from 0.4 alpha: restitution, beside a rigid block's (Housner) [-]",
        rigid.restitution,
        rebounds[1],
        None,
    )


def motions(count: int = MOTIONS, most: int = MOST):
    """Largest difference of u_top, over its peak, from the strong shaking's begin to the third main
    impact, with the default's modes and with MODES; and what a disturbance of 1 um/s changes in the
    reduced engine alone, which no two programs can be asked to come closer than.
    """
    case, richer = case_of(), case_of(integration={"n_modes": MODES})
    made, found, steps = full_system(case, MPI.COMM_SELF, "specimen"), [], 0
    for number in range(1, count + 1):
        shaking = strong_shaking(number, BEGIN).acceleration[1 : most + 1]
        began = time.perf_counter()
        path, impacts = full_order(made, shaking)
        shaking = shaking[: len(path)]
        reduced = reduced_order(case, shaking)
        off, peak = difference(path, reduced)
        more = difference(path, reduced_order(richer, shaking))[0]
        scatter = max(
            difference(
                reduced,
                reduced_order(
                    case, shaking, DISTURBANCE * np.array([np.cos(angle), np.sin(angle)])
                ),
            )[0]
            for angle in np.arange(8) * np.pi / 4
        )
        print(
            f"motion {number}: {len(path)} steps, main impacts at {impacts}, peak "
            f"{peak:.4f} m, off {off:.2e}, with {MODES} modes {more:.2e}, "
            f"disturbed {scatter:.2e}, {time.perf_counter() - began:.0f} s",
            file=sys.stderr,
            flush=True,
        )
        found.append((off, more, scatter))
        steps += len(path)
    offs, mores, scatters = np.transpose(found)
    for modes, values in ((case.integration.n_modes, offs), (MODES, mores)):
        text = f"{count} motions, {steps} steps, {modes} modes: u_top off / peak"
        yield f"{text}, worst [-]", 0.0, values.max(), values.max() <= 0.01
        yield f"{text}, median [-]", 0.0, np.median(values), np.median(values) <= 0.01
    yield (
        f"the same, {case.integration.n_modes} modes disturbed by 1 um/s, worst [-]",
        0.0,
        scatters.max(),
        None,
    )
    yield (
        f"the same, {case.integration.n_modes} modes disturbed by 1 um/s, median [-]",
        0.0,
        np.median(scatters),
        None,
    )


def reduced_order(case, shaking, disturbance=(0.0, 0.0)) -> np.ndarray:
    """Displacements (n, 2) [m] of the top in the reduced engine, its velocity changed by
    `disturbance` (2,) [m/s] after AFTER steps.
    """
    one = engine(case)
    rows = one.advance(shaking[:AFTER])[0]
    one.motion.frames["velocity"][0, :2] += disturbance
    return column(np.vstack([rows, one.advance(shaking[AFTER:])[0]]), "u_top")[:, :2]


def full_order(made: FullSystem, shaking) -> tuple[np.ndarray, list[int]]:
    """Displacements (n, 2) [m] of the top to the third main impact, and the steps of these.

    A main impact takes more than a five-thousandth of the energy that tips the column over; a tenth
    of a second belongs to it.
    """
    system, (column,) = made.system, made.meshed
    trial, rigid, path, impacts, seen = Trial(system), RigidRocking(system), [], [], 0.0
    main = 2e-4 * rigid.energy(rigid.slenderness)
    for step, ground in enumerate(shaking):
        state = trial.step(ground)
        path.append(column.shares @ (state.x[column.top] - system.body.X[column.top])[:, :2])
        if seen - trial.ledger.work["impact"] > main:
            seen = trial.ledger.work["impact"]
            if not impacts or (step - impacts[-1]) * system.hht.dt > 0.1:
                impacts.append(step)
                if len(impacts) == IMPACTS:
                    break
    return np.array(path), impacts


def difference(path: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """Largest horizontal distance over the peak of `path` (n, 2), and this peak [m]."""
    peak = np.linalg.norm(path, axis=1).max()
    return float(np.linalg.norm(other[: len(path), :2] - path, axis=1).max() / peak), float(peak)
