"""Names of the rocking models, and of their tables in a case file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fecolumn.foundation.schema import InputError

#: Name of a model's own table in a case file: name of the model.
TABLES = {
    "block": "housner",
    "frame": "rocking_frame",
    "wobbling": "wobbling",
    "wobbling_frame": "wobbling_frame",
    "podium": "podium",
}


def model_engine_of(tables: Mapping[str, object], file: Path | str) -> str | None:
    """Name of the model that a case's tables ask for by a table of its own; None where an engine of
    finite elements is asked for, or no model's table is there.

    Raises
    ------
    InputError
        integration.engine is not that of the model's table, or several tables and no engine.
    """
    there = {TABLES[name]: name for name in TABLES if isinstance(tables.get(name), dict)}
    if not there or "column" in tables:
        return None
    plan = tables.get("integration")
    engine = plan.get("engine") if isinstance(plan, dict) else None
    if isinstance(engine, str) and engine in there:
        return engine
    if "bodies" in tables:
        return None
    if engine is None and len(there) == 1:
        return next(iter(there))
    raise InputError(
        file,
        "integration.engine",
        engine,
        f"must be {' or '.join(there)}, as the case has "
        f"{' and '.join(f'[{name}]' for name in there.values())}",
    )
