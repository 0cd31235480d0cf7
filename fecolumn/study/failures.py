"""Analyses that failed: why, what to do about it, and what a reader has to know of the others."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from fecolumn.engines.dynamics.cuts import Stop
from fecolumn.engines.left_part import OVER_EDGE

#: What runs analyses again whose failure may have been one of the machine.
RETRY = "add --retry-failed to run what failed again"
# Of failures by the response itself: the same case fails at the same instant again
_SAME = "the same case would fail again, so that --retry-failed does not help"
_KEY = re.compile(r"joints\.(\S+?)\.allowance_m")
_TIME = re.compile(r"^t = \S+ s: ")
_LISTED = 6  # settings
_OF_CASE = ("AnalysisFailed: ", "InputError: ")  # nothing of the machine


def may_be_biased(failed: Sequence[tuple[str, int, int]]) -> str:
    """What a reader of statements on settings has to know where analyses failed; "" of none.

    failed: of each setting with failed analyses what it is called, such as "at dt_s = 0.02" ("" of
    the only one), how many failed, and of how many.
    """
    if not failed:
        return ""
    told = [f"{many} of {planned} analyses {where}".rstrip() for where, many, planned in failed]
    if len(told) > _LISTED:
        most = max(range(len(told)), key=lambda place: failed[place][1] / failed[place][2])
        told = [f"analyses of {len(told)} settings", f"most {told[most]}"]
    return (
        f"Failed are {', '.join(told)}: shares, percentiles and distributions are of the analyses "
        "that are done, and may be biased, as analyses may fail by their response."
    )


def what_to_do(rows: Sequence[dict[str, Any]]) -> str:
    """What helps analyses that failed, by their reasons; rows: theirs of the ledger.

    Running them again helps those that a machine stopped. What fails by its response fails again:
    a body that left what was prepared for contact needs a larger allowance, a step that did not
    converge a shorter step, and what else a reason names.
    """
    told: dict[str, None] = {}
    keys: dict[str, None] = {}
    for reason in (row.get("reason") or "" for row in rows):
        if not reason.startswith(_OF_CASE):
            told[RETRY] = None
        elif Stop.OFF_PATCH.value in reason or OVER_EDGE in reason:
            keys |= dict.fromkeys(f"joints.{name}.allowance_m" for name in _KEY.findall(reason))
            told["patch"] = None
        elif reason.startswith("AnalysisFailed"):
            told[
                f"change what the reason names, mostly to a shorter integration.dt_s, and use "
                f"another folder; {_SAME}"
            ] = None
        else:
            told[f"change what the reason names and use another folder; {_SAME}"] = None
    patch = (
        f"give {' and '.join(keys) or 'joints.NAME.allowance_m'} a value larger than the slides, "
        f"and use another folder; {_SAME}"
    )
    return "; ".join(patch if one == "patch" else one for one in told)


def why_failed(rows: Sequence[dict[str, Any]]) -> str:
    """Why analyses failed, such as "2 killed ..." of one reason alone, and what to do.

    A sentence or two with their number, the commonest reason and what helps; "" of no rows.
    """
    if not rows:
        return ""
    reason, many = _commonest(rows)
    mostly = "" if many == len(rows) else f" ({many} of them)"
    return f"Reason of the failures{mostly}: {reason}. What to do: {what_to_do(rows)}."


def _commonest(rows: Sequence[dict[str, Any]]) -> tuple[str, int]:
    """The commonest reason, and how many analyses have it."""
    counts = Counter(_plain(row.get("reason") or "no reason recorded") for row in rows)
    return counts.most_common(1)[0]


def _plain(reason: str) -> str:
    """A reason without the kind of its error, its instant, and what follows its first clause."""
    for kind in _OF_CASE:
        reason = reason.removeprefix(kind)
    return _TIME.sub("", reason).split("; ")[0].split(" (step cut")[0].rstrip(".")
