"""Blocks of a few bricks on a plate, a trial of each in both engines."""

import numpy as np

from fecolumn.engines.dynamics.hht import HHT
from fecolumn.verification.models import block_system, box
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.trial import contact_nodes

ENGINES = ("corotated", "rigid")
G = 9.80665


def block(width, height, dt=1e-3, alpha=0.0, bricks=1, plate=(0.5, 0.5), **options):
    """System of a steel block of square section: `bricks` along its height, one across; plate: half
    lengths of the base [m].
    """
    side, deep = np.array([-width / 2, width / 2]), np.linspace(0, height, bricks + 1)
    x, y = (np.linspace(-half, half, 1 + 2 * max(1, round(half / 0.25))) for half in plate)
    return block_system(
        "corotated", box(side, side, deep), box(x, y, [-0.02, 0]), HHT(dt, alpha), **options
    )


def trial(engine, system, start, n_modes=30):
    return begin_trial(engine, system, start, n_modes=n_modes)


def centre(trial):
    """Centre of mass (3,) [m]."""
    column = trial.system.body
    return column.node_mass @ trial.state.x / column.total_mass


def lowest(trial):
    """Height of the lowest foot node [m]."""
    return trial.state.x[contact_nodes(trial.system)[0], 2].min()
