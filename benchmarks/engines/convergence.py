"""What the number of modes changes: a fixed short case on the coarse mesh, at a step that resolves modes up to 3 kHz."""

from __future__ import annotations

import numpy as np

from fecolumn.verification.models import column_system, shaking
from fecolumn.verification.rocking import leaning, rocked
from fecolumn.verification.trial import RigidRocking, begin

MODES = (0, 6, 20, 60, 200)
DT, AMPLITUDE, SHAKEN = 1e-4, 0.1, 0.12


def convergence():
    """Restitution of the first impact and largest displacement of the top under two tones, by the number of modes."""
    tables = {"integration": {"dt_s": DT, "alpha_hht": -0.05}, "base": {"length_m": 0.4, "width_m": 0.4}}
    system = column_system("reduced", **tables)
    initial = RigidRocking(system).energy(AMPLITUDE * RigidRocking(system).slenderness)
    grounds = shaking(DT * np.arange(1, round(SHAKEN / DT) + 1))

    def found(engine, modes=0):
        lost = rocked(begin(engine, system, leaning(AMPLITUDE), n_modes=modes), AMPLITUDE)[1]
        path = begin(engine, system, n_modes=modes).shake(grounds)[:, 0, :2]
        return np.sqrt(1 - lost / initial), np.linalg.norm(path, axis=1).max()

    full, last = found("corotated"), None
    for modes in MODES:
        values = found("reduced", modes)
        off = [abs(value / exact - 1) for value, exact in zip(values, full)]
        # more modes may come no closer than the two engines' own rounding and solver tolerance, 1e-4 after a few impacts
        ok = last is None or max(off) <= max(max(last), 1e-4)
        for name, exact, value in zip((f"first impact from {AMPLITUDE:g} alpha: restitution [-]", f"{SHAKEN:g} s of shaking: u_max [m]"), full, values):
            yield f"n_modes {modes}: {name}", exact, value, ok
        last = off
