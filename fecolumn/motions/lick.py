"""The Lick ensemble by name: lick:1 ... lick:115, made when first asked for and kept.

115 bidirectional motions at test scale with the parameters of the seed motion, as `fecolumn motions
make seeded` makes them.
"""

from __future__ import annotations

import functools
from pathlib import Path

from fecolumn.foundation.paths import LICK_PREFIX

COUNT, SEED, TIME_SCALE = 115, 810, 0.5


def lick_source(source: str) -> str:
    """Source of lick:12 in the ensemble's file, ensemble.h5#12; the file is made if need be, which
    takes seconds.
    """
    from fecolumn.foundation._compiled import cache_folder
    from fecolumn.foundation.lock import alone
    from fecolumn.foundation.sealed import hdf5_fault
    from fecolumn.motions.ensemble_file import write_ensemble
    from fecolumn.motions.seeded import LICK, read_model, seeded_ensemble

    file = cache_folder() / f"lick-{_recipe()}.h5"
    if hdf5_fault(file):  # none yet, or damaged
        with alone(file):  # of the processes of a study that start at once, one makes it
            if hdf5_fault(file):
                write_ensemble(
                    seeded_ensemble(read_model(LICK), COUNT, SEED, "fixed", TIME_SCALE), file
                )
    return f"{file}#{source.removeprefix(LICK_PREFIX)}"


@functools.cache
def _recipe() -> str:
    """Digest of all that makes the motions."""
    from fecolumn.foundation.sources import digest_of
    from fecolumn.motions.seeded import LICK

    return digest_of((*sorted(Path(__file__).parent.glob("*.py")), Path(LICK)))
