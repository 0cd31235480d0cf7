"""How a key of the case and its value are written in a figure."""

from __future__ import annotations

import dataclasses
import typing

from fecolumn.case import Case

_SYMBOLS = {"integration.dt_s": r"$\Delta t$", "integration.alpha_hht": r"$\alpha$", "contact.friction_coefficient": r"$\mu$"}


def axis_text(key: str, value) -> str:
    """Text such as "$\\Delta t$ = 0.001 s" for the dotted key `integration.dt_s`."""
    if isinstance(value, dict):
        return ", ".join(axis_text(f"{key}.{inner}", item) for inner, item in value.items())
    number = f"{value:g}".replace("-", "\N{MINUS SIGN}") if isinstance(value, (int, float)) and not isinstance(value, bool) else str(value)
    unit = axis_unit(key)
    name = _SYMBOLS.get(key, key.split(".")[-1].removesuffix(f"_{unit}").replace("_", " "))
    return f"{name} = {number}" + (f" {unit}" if unit != "-" else "")


def axis_unit(key: str) -> str:
    """Unit of a key, from the case's own declaration; "-" where it has none."""
    section, _, name = key.partition(".")
    kind = typing.get_type_hints(Case)[section]
    owner = next((k for k in (kind, *typing.get_args(kind)) if dataclasses.is_dataclass(k)), Case)
    return next((f.metadata["unit"] for f in dataclasses.fields(owner) if f.name == name and "unit" in f.metadata), "-")
