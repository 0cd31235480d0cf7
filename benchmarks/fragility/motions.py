"""Near-fault motions whose magnitude, distance and peak velocity are drawn: a pulse, of a period
that the magnitude sets, on a stochastic part (`fecolumn.motions.near_fault`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.foundation.version import __version__
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import read_ensemble, write_ensemble
from fecolumn.motions.near_fault import SOURCE, Scenario, near_fault_motions
from fecolumn.motions.processing import integrate, scale, strong_part
from fecolumn.motions.record import GroundMotion

#: Of the draws, each evenly: moment magnitude; distance [km]; PGV [m/s] in the logarithm, the
#: largest horizontal velocity of both components together.
MAGNITUDE, DISTANCE, PGV = (5.5, 7.5), (5.0, 20.0), (0.15, 2.5)
#: Shares of the Arias intensity between which a motion is analysed, and its step [s].
STRONG, STEP = (0.005, 0.995), 0.01
SEED = 1


def drawn_motion(number: int, seed: int = SEED) -> tuple[GroundMotion, dict[str, float]]:
    """Motion of a number, from 1 on, the fault-normal component with the pulse along x; and what
    was drawn. It depends on seed and number alone.
    """
    random = np.random.default_rng([seed, number])
    magnitude, distance = random.uniform(*MAGNITUDE), random.uniform(*DISTANCE)
    wanted = float(np.exp(random.uniform(*np.log(PGV))))
    scenario = Scenario(magnitude, distance)
    whole = near_fault_motions(scenario, [random], STEP, fault_parallel=True)[0]
    motion = strong_part(whole, STRONG)
    motion = scale(motion, wanted / peak_velocity(motion))
    named = GroundMotion(motion.acceleration, motion.dt, f"drawn {number}", SOURCE)
    return named, {
        "magnitude": magnitude,
        "distance_km": distance,
        "pulse_period_s": scenario.pulse.period,
        "pgv_m_s": wanted,
        "pga_m_s2": float(np.hypot(*motion.acceleration[:, :2].T).max()),
    }


def peak_velocity(motion: GroundMotion) -> float:
    """Largest horizontal velocity of both components together [m/s]."""
    return float(np.hypot(*integrate(motion)[0][:, :2].T).max())


def ensemble_file(folder: Path, count: int, seed: int = SEED) -> Path:
    """File of the motions 1 ... count in a folder, made unless it is there."""
    file = (folder / f"motions-{seed}-{count}.h5").resolve()
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        made = [drawn_motion(number, seed) for number in range(1, count + 1)]
        write_ensemble(
            Ensemble(
                "near-fault motions of drawn peak velocity",
                tuple(motion for motion, _ in made),
                {name: np.array([drawn[name] for _, drawn in made]) for name in made[0][1]},
                {"model": SOURCE, "version": __version__, "seed": seed},
            ),
            file,
        )
    return file


def parameters(file: Path) -> dict[str, np.ndarray]:
    """What was drawn for each motion of a file, (n,) by name."""
    return read_ensemble(file).parameters
