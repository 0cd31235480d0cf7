"""What a case must leave out where its engine is a rocking model of rigid bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from fecolumn.case.checked import Refuse
from fecolumn.case.column_keys import Base
from fecolumn.case.sections import Initial, Integration

OF_COLUMN = ("housner", "wobbling")  # models that a case's column makes
#: Sections and keys that no rocking model of rigid bodies knows, whatever form its case has
UNKNOWN_KEYS = (
    ("contact", "restitution"),
    ("contact", "rolling_resistance"),
    ("output", "fields_every_s"),
)


class _OnBase(Protocol):
    """What is asked of a ShortForm, which imports its checks."""

    @property
    def integration(self) -> Integration: ...

    @property
    def initial(self) -> Initial: ...

    @property
    def base(self) -> Base: ...


def check_model(case: _OnBase, models: Sequence[str], refuse: Refuse) -> None:
    """Keys that a rocking model of rigid bodies, an engine of `models`, knows nothing of."""
    engine, substeps = case.integration.engine, case.integration.substeps
    if engine not in models:
        return
    if substeps != "rolling":
        told = f"has no effect where integration.engine = {engine!r}: leave it out"
        refuse("integration.substeps", substeps, told)
    if engine not in OF_COLUMN:
        refuse(
            "integration.engine",
            engine,
            f"needs a table of its own, [{engine.removeprefix('rocking_')}]; of a "
            f"[column] there are {' and '.join(OF_COLUMN)}",
        )
    for section, key in UNKNOWN_KEYS:
        if value := getattr(getattr(case, section), key):
            refuse(
                f"{section}.{key}",
                value,
                f"must be 0 where integration.engine = {engine!r}: a rigid model with "
                "an impact law of its own",
            )
    if case.base.kind == "pad":
        refuse(
            "base.kind",
            "pad",
            f"must be plate or unbounded where integration.engine = {engine!r}: it "
            "stands on rigid ground",
        )
    if case.initial.moves:
        key = "velocity_m_s" if any(case.initial.velocity_m_s) else "spin_rad_s"
        refuse(
            f"initial.{key}",
            list(getattr(case.initial, key)),
            f"must be 0 where integration.engine = {engine!r}; it starts from initial.tilt_rad",
        )
