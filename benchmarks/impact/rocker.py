"""A column that rocks over once, in either engine, with time steps of any length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.engines.pair import case_of, column, engine
from fecolumn.engines.dynamics.gravity import tilted
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.fem.rotation import tilt_angle
from fecolumn.verification.models import system_of
from fecolumn.verification.trial import RigidRocking, Trial


class ReducedRocker:
    """A case released with a tilt, in the reduced or the rigid engine.

    Attributes
    ----------
    tilt
        [rad]. lean: displacement of the top along x [m]. mechanical: kinetic, strain and gravity
        energy [J].
    """

    def __init__(self, case):
        self.engine = engine(case)

    def steps(self, dt: float, count: int) -> np.ndarray:
        """So many steps of dt [s]: the tilts (count,) [rad] at their ends."""
        self.engine.hht = replace(self.engine.hht, dt=dt)
        rows = self.engine.advance(np.zeros((count, 3)))[0]
        tilts = column(rows, "tilt")
        self.tilt, self.lean = float(tilts[-1]), float(column(rows, "u_top")[-1, 0])
        self.mechanical = float(
            sum(column(rows, f"energy/{term}")[-1] for term in ("kinetic", "strain", "gravity"))
        )
        return tilts


class FullRocker:
    """The same in the full-order engine; lean: of all its nodes in the mean."""

    def __init__(self, case):
        self.system, self.alpha = (
            system_of(case),
            case.integration.alpha_hht,
        )
        self.trial = Trial(
            self.system, lambda system: tilted(system, case.short.initial.tilt_rad, 0.0)
        )

    def steps(self, dt: float, count: int) -> np.ndarray:
        """As of `ReducedRocker`."""
        trial, tilts, self.system.hht = self.trial, np.empty(count), HHT(dt, self.alpha)
        for k in range(count):
            tilts[k] = tilt_angle(trial.step().rotation[0])
        self.tilt, self.lean = (
            float(tilts[-1]),
            float((trial.state.x - self.system.body.X)[:, 0].mean()),
        )
        self.mechanical = trial.mechanical()
        return tilts


def rigid_block(case) -> RigidRocking:
    """Housner's block of a case's own mesh."""
    return RigidRocking(system_of(case))


def rocker(
    kind: str,
    share: float,
    dt: float,
    modes: int,
    alpha: float,
    damping: float,
    height: float,
    size: float,
):
    """A rocker of the specimen and Housner's block of its mesh.

    Parameters
    ----------
    kind
        "full", "reduced" or "rigid".
    share
        tilt of release over the critical one.
    dt
        of the impact [s]: which modes are too fast for a step, and move its contact points as
        springs without mass, is decided by it for the whole motion.
    alpha
        of HHT.
    damping
        ratio of the elastic modes.
    height
        of the column [m].
    size
        of the bricks at the foot [m].
    """
    tables = {
        "contact": {"friction_coefficient": 0.8},
        "column": {"height_m": height},
        "mesh": {"fine_size_m": size, "coarse_size_m": 3 * size},
        "material": {"damping_ratio": damping},
        "integration": {"dt_s": dt, "alpha_hht": alpha, "n_modes": modes, "engine": kind},
    }
    block = rigid_block(case_of(**tables))
    case = case_of(**tables, initial={"tilt_rad": share * block.slenderness})
    return (FullRocker if kind == "full" else ReducedRocker)(case), block
