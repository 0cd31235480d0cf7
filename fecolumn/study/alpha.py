"""What alpha_HHT can change at all, which every statement on its effect needs beside it."""

from __future__ import annotations

from typing import Any

ALPHA_KEY, _IMPACT = "integration.alpha_hht", "contact.impact"
_PLASTIC = "plastic"  # a case's default


def alpha_note(tables: dict[str, Any], axes: dict[str, Any]) -> str:
    """That little effect of alpha is built into the scheme, where the analyses use it; "" where all
    are of the literal one.

    Parameters
    ----------
    tables
        of a case that the analyses share, by section; what it leaves open is at its default.
    axes
        levels by dotted key.
    """
    contact = tables.get("contact")
    levels = list(
        axes.get(_IMPACT)
        or [contact.get("impact", _PLASTIC) if isinstance(contact, dict) else _PLASTIC]
    )
    if _PLASTIC not in levels:
        return ""
    where = "" if len(levels) == 1 else f" of the settings with {_IMPACT} = 'plastic'"
    return (
        f"In the scheme{where} alpha is kept from contact and impact, and "
        "damps elastic modes alone, not rigid motion: that it changes little is "
        f"partly built in, and says nothing of the literal scheme ({_IMPACT} = 'none', "
        "integration.engine = 'full'), where alpha decides what an "
        "impact takes."
    )
