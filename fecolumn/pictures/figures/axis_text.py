"""How a key of the case and its value are written in a figure."""

from __future__ import annotations

import dataclasses
import typing

from fecolumn.case.bodies import BODY_KINDS
from fecolumn.case.case_tables import NAMED
from fecolumn.case.model_sections import SECTIONS
from fecolumn.case.sections import Cap, Flange
from fecolumn.case.short_form import ShortForm

_SYMBOLS = {
    "integration.dt_s": r"$\Delta t$",
    "integration.alpha_hht": r"$\alpha$",
    "contact.friction_coefficient": r"$\mu$",
    "material.youngs_modulus_pa": "$E$",
}
_NAMED = ("base", "cap")  # parts whose keys other parts have, too
# of keys that are no words for their values
_WORDS = {
    "podium.impact": "law of impact",
    "podium.storeys": "number of storeys",
}


def axis_text(key: str, value: object) -> str:
    r"""Text such as "$\Delta t$ = 0.001 s" for the dotted key `integration.dt_s`."""
    if isinstance(value, dict):
        return ", ".join(axis_text(f"{key}.{inner}", item) for inner, item in value.items())
    unit = axis_unit(key)
    return f"{_SYMBOLS.get(key) or axis_words(key)} = {level_number(value)}" + (
        f" {unit}" if unit != "-" else ""
    )


def axis_words(key: str) -> str:
    """Last word of a key without its unit, after the part it belongs to where others have it,
    too.
    """
    if key in _WORDS:
        return _WORDS[key]
    section, _, last = key.rpartition(".")
    name = last.removesuffix(f"_{axis_unit(key).lower()}").replace("_", " ")
    return f"{section} {name}" if section in _NAMED else name


def level_number(value: object) -> str:
    """Value of an axis: numbers to six digits at most, sampled ones of more to three."""
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return str(value)
    text = f"{value:g}"
    return (
        (text if len(text.lstrip("-")) <= 6 else f"{value:.3g}")
        .replace("-", "\N{MINUS SIGN}")
        .replace("e+", "e")
    )


def axis_unit(key: str) -> str:
    """Unit of a key, from its own declaration in a case of a column, of bodies or of a rocking
    model; "-" where it has none.
    """
    section, _, name = key.partition(".")
    kind = typing.get_type_hints(ShortForm).get(section)
    owners: list[typing.Any] = (
        [one for one in (kind, *typing.get_args(kind)) if dataclasses.is_dataclass(one)]
        if kind
        else [ShortForm]
    )
    if section in SECTIONS:
        owners.append(SECTIONS[section])
    if section in NAMED:  # [bodies.NAME] and the like
        name = name.rpartition(".")[2]
        owners += [*BODY_KINDS.values(), Flange, Cap] if section == "bodies" else [NAMED[section]]
    return next(
        (
            f.metadata["unit"]
            for owner in owners
            for f in dataclasses.fields(owner)
            if f.name == name and "unit" in f.metadata
        ),
        "-",
    )
