"""The figures of the README: each check against its closed form, as one table.

    ./containers/run python -m benchmarks.figures [NAME ...]

Coarse meshes and short windows, minutes in all; `speed` runs on the specimen's own mesh.
"""

from __future__ import annotations

import sys
import time

import numpy as np
from mpi4py import MPI

from fecolumn.case import case_from_tables, read_toml
from fecolumn.dynamics.assembly import build_system
from fecolumn.dynamics.energy import Ledger
from fecolumn.dynamics.gravity import standing, tilted
from fecolumn.dynamics.rotation import tilt_angle
from fecolumn.dynamics.stepper import Stepper
from fecolumn.schema import merge

SPECIMEN = "meshes/specimen.toml"
COARSE = {"column": {"fine_height_m": 0.03}, "base": {"slide_allowance_m": 0.01, "length_m": 0.2, "width_m": 0.2},
          "mesh": {"coarse_size_m": 0.03, "cap_size_m": 0.05, "base_size_m": 0.05}}
STEPS = (0.02, 1e-3, 1e-4)
ALPHAS = (0.0, -0.05, -0.1, -0.2, -0.333)
G = 9.80665


def system_of(tables=None, coarse=True):
    """System of the specimen, on the coarse mesh unless told otherwise."""
    base = merge(read_toml(SPECIMEN), COARSE) if coarse else read_toml(SPECIMEN)
    return build_system(case_from_tables(merge(base, tables or {}), SPECIMEN), MPI.COMM_SELF)


def slenderness(system) -> float:
    """Angle between the axis and the line from the rim to the centre of mass [rad]."""
    return float(np.arctan2(np.linalg.norm(system.interface.reference[:, :2], axis=1).max(), system.column.center[2]))


def standing_still():
    """1,000 steps under gravity at each of the 15 (dt, alpha)."""
    for dt in STEPS:
        for alpha in ALPHAS:
            system = system_of({"integration": {"dt_s": dt, "alpha_hht": alpha}})
            state = start = standing(system)
            ledger = Ledger(system)
            ledger.open(start)
            stepper = Stepper(system, ledger)
            for _ in range(1000):
                state = stepper.step(state, np.zeros(3))
            drift = np.abs(state.x - start.x).max()
            change = abs(sum(ledger.state_terms(state).values()) - ledger.start) / (system.weight * 1.01)
            yield f"standing, dt {dt:g} s, alpha {alpha:g}: drift [m]", 0.0, drift, drift < 1e-7
            yield f"standing, dt {dt:g} s, alpha {alpha:g}: energy / m g H", 0.0, change, change < 1e-6


def _ramp(system, rate, until):
    """Ground acceleration of a slow ramp [m/s2] when `until(state, start)` first holds."""
    state = start = standing(system)
    ledger = Ledger(system)
    ledger.open(start)
    stepper, ground, dt = Stepper(system, ledger), 0.0, system.hht.dt
    while not until(state, start):
        ground += rate * dt
        state = stepper.step(state, np.array([ground, 0.0, 0.0]))
    return ground


def uplift():
    """Uplift of the whole heel side: only the toe is left when the resultant leaves the rim."""
    system = system_of({"contact": {"friction_coefficient": 0.8}})
    exact = G * np.tan(slenderness(system))
    found = _ramp(system, 0.2, lambda state, start: tilt_angle(state.rotation) > 2e-5)
    yield "uplift acceleration, mu 0.8 [m/s2]", exact, found, abs(found / exact - 1) < 0.01


def sliding():
    """Sliding of the whole foot at mu g."""
    system = system_of({"contact": {"friction_coefficient": 0.05}})
    found = _ramp(system, 0.1, lambda state, start: np.abs((state.relative - start.relative)[:, 0]).mean() > 1e-6)
    yield "sliding acceleration, mu 0.05 [m/s2]", 0.05 * G, found, abs(found / (0.05 * G) - 1) < 0.01


CHECKS = {check.__name__: check for check in (standing_still, uplift, sliding)}


def main(names) -> int:
    """Print the table of the named checks, of all without names; 1 where one fails."""
    failed = 0
    print(f"| {'check':<58} | {'exact':>10} | {'computed':>10} | ok |\n|{'-' * 60}|{'-' * 12}|{'-' * 12}|----|")
    for name in names or CHECKS:
        began = time.perf_counter()
        for label, exact, computed, ok in CHECKS[name]():
            failed += not ok
            print(f"| {label:<58} | {exact:>10.4g} | {computed:>10.4g} | {'yes' if ok else 'NO':<3}|", flush=True)
        print(f"{name}: {time.perf_counter() - began:.0f} s", file=sys.stderr)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
