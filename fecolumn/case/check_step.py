"""Where integration.dt_s may be left to the trials that choose it."""

from __future__ import annotations

from pathlib import Path

from fecolumn.case.checked import CheckedCase, Refuse
from fecolumn.case.sections import AUTO, Integration
from fecolumn.foundation.schema import InputError

_KEY = "integration.dt_s"
#: Engines whose analyses choose their step
CHOOSE = ("reduced", "rigid")


def check_step(plan: Integration, refuse: Refuse) -> None:
    """Refuse a step that is to be chosen where the engine cannot: called as refuse(key, value,
    allowed).
    """
    if plan.step_is_chosen and plan.engine not in CHOOSE:
        refuse(
            _KEY,
            AUTO,
            f"is for engine = {' and '.join(map(repr, CHOOSE))} alone: where integration.engine = "
            f"{plan.engine!r}, state a number such as 0.001",
        )


def check_stated(case: CheckedCase, file: Path | str) -> None:
    """Refuse a step that is to be chosen where many analyses are compared, which must have one.

    Raises
    ------
    InputError
        integration.dt_s is "auto".
    """
    if case.integration.step_is_chosen:
        raise InputError(
            file,
            _KEY,
            AUTO,
            "is for one analysis, and many that are compared have one step: state the number that "
            "fecolumn run says of one of them",
        )
