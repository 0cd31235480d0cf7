"""What the first analyses of a study wait for: what is made once on a machine and kept for all
later ones.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

_COMPILED = {"reduced", "rigid"}  # engines of compiled code
COMPILING = "compiling the reduced engine, once on this machine"
MODELLING = "making the reduced model of the specimen, once on this machine"


def preparation(analyses: Iterable[Any]) -> str:
    """What keeps analyses from stepping on this machine, in words; empty where nothing does.

    It looks at the files of the cache alone: the driver of a study loads no engine.

    Parameters
    ----------
    analyses
        `plan.PlannedAnalysis`, those in the hands of workers.
    """
    if not any(analysis.case.integration.engine in _COMPILED for analysis in analyses):
        return ""
    import numba

    from fecolumn.foundation._compiled import cache_folder, compiled_folder
    from fecolumn.foundation.lock import is_held

    if any(
        is_held(lock)
        for name in ("model", "body")
        for lock in cache_folder().glob(f".{name}-*.lock")
    ):
        return MODELLING
    # the one function of the engine that Python calls, see reduced.run
    kept = any(Path(compiled_folder()).glob("*/*.advance-*.nbi"))
    return "" if kept or numba.config.DISABLE_JIT else COMPILING
