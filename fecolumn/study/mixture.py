"""Analyses of one study that different code has made: told, and never mixed unseen."""

from __future__ import annotations

from collections import Counter
from typing import Any

from fecolumn.foundation.sources import code, code_text
from fecolumn.study.outcome import DONE


def codes(rows: list[dict[str, Any]]) -> Counter[str]:
    """Number of analyses that are done by the code that made them, in words; most first where it is
    listed.

    Parameters
    ----------
    rows
        of a ledger, see `store.Study.rows`.
    """
    return Counter(
        code_text(row["summary"].get("version"), row["summary"].get("sources"))
        for row in rows
        if row["state"] == DONE
    )


def listed(found: Counter[str]) -> str:
    """Such as "30 of fecolumn 0.2.0 (sources 3f0c9a1b2d4e5f60), 12 of fecolumn 0.1.0 (sources not
    recorded)".
    """
    return ", ".join(f"{count} of {name}" for name, count in found.most_common())


def other_code(rows: list[dict[str, Any]]) -> str:
    """What a driver of `fecolumn.simulation:run` says of analyses that other code has done; empty
    where there are none.
    """
    present = code_text(**code())
    others = Counter({name: count for name, count in codes(rows).items() if name != present})
    if not others:
        return ""
    return (
        f"{others.total()} of {len(rows)} analyses were done by other code and are kept: "
        f"{listed(others)}; this is {present}; a new folder takes all anew"
    )
