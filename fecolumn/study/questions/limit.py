"""Limit states in words, such as "P(overturn) < 0.1" or "P(slide > 5 mm) < 10 %", and whether a run
reached them, by its summary.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fecolumn.case.sections import GRAVITY, MODEL_ENGINES
from fecolumn.engines.ending import lost
from fecolumn.foundation.schema import InputError, meant
from fecolumn.statistics.csv_table import number_of

if TYPE_CHECKING:
    from fecolumn.case.case import Case

#: Factor to metres by the word of the unit.
METRES_OF = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
_ANGLES = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180}
_ACCELERATIONS = {"g": GRAVITY, "m/s2": 1.0, "cm/s2": 1e-2}
_FORCES = {"N": 1.0, "kN": 1e3, "MN": 1e6}

_EVENT = re.compile(r"([A-Za-z][A-Za-z_ ]*?)\s*(?:\[([^\]]+)\])?\s*>=?\s*(\S+)\s*(\S*)")
_LIMIT = re.compile(r"\s*P\s*\((.+)\)\s*(<=?)\s*([^\s%]+)\s*(%?)\s*")


@dataclass(frozen=True, slots=True)
class PeakQuantity:
    """A largest value that summaries hold.

    Attributes
    ----------
    units
        factor to SI by the word of the unit.
    whole
        entry of the summary for the observed body; "" where only parts have it.
    table, entry
        the summary's table of parts by name, and the entry of each.
    """

    units: dict[str, float]
    whole: str
    table: str
    entry: str


_QUANTITIES = {
    "top": PeakQuantity(METRES_OF, "u_max_m", "", ""),
    "tilt": PeakQuantity(_ANGLES, "tilt_max_rad", "bodies", "tilt_max_rad"),
    "acceleration": PeakQuantity(_ACCELERATIONS, "", "bodies", "acceleration_max_m_s2"),
    "slide": PeakQuantity(METRES_OF, "", "interfaces", "slide_max_m"),
    "residual slide": PeakQuantity(METRES_OF, "", "interfaces", "residual_slide_m"),
    "rise": PeakQuantity(METRES_OF, "", "interfaces", "rise_max_m"),
    "force": PeakQuantity(_FORCES, "", "interfaces", "force_max_n"),
    "tension": PeakQuantity(_FORCES, "", "links", "tension_max_n"),
    "compression": PeakQuantity(_FORCES, "", "links", "compression_max_n"),
    "elongation": PeakQuantity(METRES_OF, "", "links", "elongation_max_m"),
    "shortening": PeakQuantity(METRES_OF, "", "links", "shortening_max_m"),
    "drift": PeakQuantity(METRES_OF, "", "storeys", "drift_max_m"),
    "shear": PeakQuantity(_FORCES, "", "storeys", "shear_max_n"),
}
_ENDINGS: dict[str, Callable[[dict[str, Any]], bool]] = {
    "overturn": lambda summary: bool(summary["overturned"]),
    "slide off": lambda summary: bool(summary.get("slid_off")),
    "lost": lost,
}
_KNOWN = (
    "overturn, slide off, lost (either), or one of "
    f"{', '.join(_QUANTITIES)} with a value and its unit, such as top > 50 mm, tilt > 2 deg, "
    "slide[foot] > 5 mm, acceleration > 0.5 g, tension[tendon] > 20 kN"
)


@dataclass(frozen=True, slots=True)
class LimitEvent:
    """What may happen in a run.

    Attributes
    ----------
    text
        in the user's words.
    quantity
        name in _QUANTITIES, or of how an analysis ends.
    part
        name of the joint, body, link or storey, or its first words, such as "foot" for "foot:
        column on ground"; "" for any of them.
    threshold
        beyond which the event has happened, in SI units; 0 of an ending.
    option
        of the command line in which it stands, for messages.
    """

    text: str
    quantity: str
    part: str = ""
    threshold: float = 0.0
    option: str = "--event"

    def happened(self, summary: dict[str, Any]) -> bool:
        """Whether a run reached it.

        What overturned or slid off is beyond every limit: its peaks are only where the analysis
        stopped.

        Raises
        ------
        InputError
            the summary does not hold the quantity, or the part.
        """
        if self.quantity in _ENDINGS:
            return _ENDINGS[self.quantity](summary)
        peak = self.peak(summary)
        return lost(summary) or peak > self.threshold

    def peak(self, summary: dict[str, Any]) -> float:
        """Largest value of the quantity in a run, in SI units; InputError as of `happened`."""
        kind = _QUANTITIES[self.quantity]
        if kind.whole and not self.part:
            return float(summary[kind.whole])
        parts = summary.get(kind.table) or {}
        found = [
            part[kind.entry]
            for name, part in parts.items()
            # summaries of earlier versions do not have every entry
            if is_named(name, self.part) and part.get(kind.entry) is not None
        ]
        if not found:
            engine = summary.get("engine", "")
            there = f"; there are {', '.join(parts)}" if parts else f" of engine {engine!r}"
            raise InputError(
                "summary.json",
                self.option,
                self.text,
                f"holds no {self.quantity}{f'[{self.part}]' if self.part else ''}{there}",
            )
        return float(max(found))


@dataclass(frozen=True, slots=True)
class ShareLimit:
    """P(event) below a share of all motions; `strict`: at it does not do."""

    event: LimitEvent
    share: float
    strict: bool = True

    @property
    def text(self) -> str:
        """Such as "P(overturn) < 0.1"."""
        return f"P({self.event.text}) {'<' if self.strict else '<='} {self.share:g}"


def is_named(name: str, part: str) -> bool:
    """Whether `part` is a name, or its first words, or "" for any: of "tendon 12" "tendon", not
    "tendon 1".
    """
    ends = name[len(part) : len(part) + 1] in ("", " ", ":", ",")
    return not part or name.startswith(part) and ends


def read_event(
    text: str, command: str, engine: str | None = None, option: str = "--event"
) -> LimitEvent:
    """The event of a text such as "overturn" or "slide[foot] > 5 mm".

    Parameters
    ----------
    command
        for messages, such as "fecolumn design".
    engine
        of the analyses: rocking models know no joints.
    option
        in which the text stands, for messages.

    Raises
    ------
    InputError
        unknown quantity, unit or value.
    """

    def refuse(allowed: str) -> InputError:
        return InputError(command, option, text, allowed)

    plain = " ".join(text.replace("_", " ").split())
    if plain in _ENDINGS:
        return LimitEvent(plain, plain, option=option)
    found = _EVENT.fullmatch(text.strip())
    name = " ".join((found[1] if found else plain).replace("_", " ").split())
    name = name.removeprefix("peak ")
    if found is None or name not in _QUANTITIES:
        raise refuse(f"must be {_KNOWN}{meant(name, [*_QUANTITIES, *_ENDINGS])}")
    kind, (_, part, value, unit) = _QUANTITIES[name], found.groups()
    words = ", ".join(kind.units)
    if unit not in kind.units:
        what = f"{unit!r} is no unit of {name}" if unit else f"{name} has no unit here"
        raise refuse(f"{what}; must be one of {words}, such as {name} > 5 {next(iter(kind.units))}")
    if "," in value:
        raise refuse(f"{value!r} needs a decimal point: {value.replace(',', '.')}")
    number = number_of(value)
    if not 0 < number < math.inf:
        raise refuse(f"{value!r} must be a number greater than 0 [{unit}]")
    inner = f"[{part}]" if part else ""
    event = LimitEvent(
        f"{name}{inner} > {number:g} {unit}", name, part or "", number * kind.units[unit], option
    )
    _check_engine(event, engine, command)
    return event


def check_event(event: LimitEvent, case: Case, command: str) -> None:
    """Refuse an event that no analysis of a case can tell of.

    Raises
    ------
    InputError
        its engine, which the case need not state, is a rocking model without such parts, or it has
        no links, or none of this name.
    """
    _check_engine(event, case.integration.engine, command)
    kind = _QUANTITIES.get(event.quantity)
    if kind is None or kind.table != "links":
        return
    if not any(is_named(name, event.part) or is_named(event.part, name) for name in case.links):
        there = f"there are {', '.join(case.links)}" if case.links else "the case has no [links]"
        raise InputError(command, event.option, event.text, f"is of links: {there}")


def _check_engine(event: LimitEvent, engine: str | None, command: str) -> None:
    kind = _QUANTITIES.get(event.quantity)
    if kind and engine in MODEL_ENGINES and not (kind.whole and not event.part):
        raise InputError(
            command,
            event.option,
            event.text,
            f"rocking models have no joints, links and storeys: choose integration.engine = "
            f"'rigid' or 'reduced' instead of {engine!r}, or a limit of overturn, top or tilt",
        )


def read_limit(text: str, command: str, engine: str | None = None) -> ShareLimit:
    """The limit state of a text such as "P(overturn) < 0.1".

    Raises
    ------
    InputError
        the text is none, or its event or its probability cannot be used.
    """
    found = _LIMIT.fullmatch(text)
    if found is None:
        raise InputError(
            command,
            "--limit",
            text,
            'must be "P(EVENT) < SHARE", such as "P(overturn) < 0.1"; EVENT: ' + _KNOWN,
        )
    event, less, value, percent = found.groups()
    if "," in value:
        raise InputError(
            command, "--limit", text, f"{value!r} needs a decimal point: {value.replace(',', '.')}"
        )
    share = number_of(value) / (100 if percent else 1)
    if not 0 < share < 1:
        raise InputError(
            command, "--limit", text, "its probability must lie between 0 and 1 (0 and 100 %)"
        )
    return ShareLimit(read_event(event, command, engine, "--limit"), share, less == "<")
