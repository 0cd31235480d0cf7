"""Ground motions of these benchmarks: `fecolumn motions make seeded`, made once."""

from __future__ import annotations

import functools
from pathlib import Path

from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import write_ensemble
from fecolumn.motions.seeded import LICK, read_model, seeded_ensemble

RESULTS = Path(__file__).parents[2] / "results" / "engines"
# of the ensemble on the coarse mesh; at test scale, as the specimen is a quarter of its prototype
N, SEED, TIME_SCALE = 24, 1, 0.5


@functools.cache
def seeded(n: int = N) -> Ensemble:
    """The first n motions of the Lick ensemble at test scale."""
    return seeded_ensemble(read_model(LICK), n, SEED, time_scale=TIME_SCALE)


def seeded_file() -> Path:
    """An HDF5 file of them, made if there is none."""
    path = RESULTS / "seeded.h5"
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_ensemble(seeded(), path)
    return path
