"""How numbers, probabilities and settings are written in the report."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from fecolumn.pictures.figures.axis_text import axis_unit, axis_words, level_number

if TYPE_CHECKING:
    from markupsafe import Markup

ALL_ANALYSES = "all analyses"  # where nothing tells settings apart
MINUS, DASH, THIN = "\N{MINUS SIGN}", "\N{EM DASH}", "\N{NARROW NO-BREAK SPACE}"
_SYMBOLS = {
    "integration.dt_s": "\N{GREEK CAPITAL LETTER DELTA}t",
    "integration.alpha_hht": "\N{GREEK SMALL LETTER ALPHA}",
    "contact.friction_coefficient": "\N{GREEK SMALL LETTER MU}",
    "material.youngs_modulus_pa": "E",
}
_TYPESET = [
    (re.compile(pattern), replacement)
    for pattern, replacement in (
        (r"\bu_max\b", "<i>u</i><sub>max</sub>"),
        (r"\bu([₀-₉]{2})", r"<i>u</i>\1"),
        (r"\be([₀-₉]{2})", r"<i>e</i>\1"),
        (r"\bP\(", "<i>P</i>("),
        (r"Δt\b", "Δ<i>t</i>"),
        (r"([αμτ])", r"<i>\1</i>"),
        (r"\b([pnRD])(?=[\s\u202f]?(?:=|&lt;)|\Z)", r"<i>\1</i>"),
    )
]
_PERCENT = re.compile(r"(\d) %")
_SUPERSCRIPTS = str.maketrans("-0123456789", "\N{SUPERSCRIPT MINUS}⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value: float | None, digits: int = 3) -> str:
    """Number to significant digits, such as "0.0273", "1.2 × 10⁻⁷"; a dash where there is none."""
    if value is None or isinstance(value, float) and math.isnan(value):
        return DASH
    if isinstance(value, float) and math.isinf(value):
        return "\N{INFINITY}" if value > 0 else MINUS + "\N{INFINITY}"
    if value and not 1e-4 <= abs(value) < 1e6:
        mantissa, exponent = f"{value:.{max(digits - 2, 0)}e}".split("e")
        power = str(int(exponent)).translate(_SUPERSCRIPTS)
        return f"{mantissa.replace('-', MINUS)}{THIN}×{THIN}10{power}"
    text = f"{value:.{digits}g}" if abs(value) < 10**digits else f"{value:.0f}"
    return text.replace("-", MINUS)


def fixed(value: float | None, decimals: int = 2) -> str:
    """Number to a fixed count of decimals, so that a column lines up; a dash where there is
    none.
    """
    if value is None or not math.isfinite(value):
        return number(value)
    # + 0.0: what rounds to nothing has no sign
    return f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", MINUS)


def percent(share: float | None) -> str:
    """0.435 as "43.5 %"."""
    return DASH if share is None or math.isnan(share) else f"{fixed(100 * share, 1)}{THIN}%"


def millimetres(metres: float | None) -> str:
    """Displacement [m] in mm; "overturn" where that share of the runs does not stand."""
    if metres is None or math.isnan(metres):
        return DASH
    return "overturn" if math.isinf(metres) else number(1e3 * metres)


def p_value(p: float | None) -> str:
    """Probability of a test."""
    return DASH if p is None or math.isnan(p) else f"<{THIN}0.001" if p < 0.001 else f"{p:.3f}"


def p_clause(p: float) -> str:
    """A p-value in words, "p = 0.03" or "p < 0.001"."""
    return f"p{THIN}{p_value(p)}" if p < 0.001 else f"p{THIN}={THIN}{p_value(p)}"


def interval(
    low: float | None, high: float | None, form: Callable[[float | None], str] = fixed
) -> str:
    """An interval as "[low, high]"."""
    return f"[{form(low)}, {form(high)}]"


def percent_interval(low: float | None, high: float | None) -> str:
    """Interval of two shares [-] in per cent, such as "[34.8, 52.6]"."""
    if low is None or high is None:
        return DASH
    return interval(100 * low, 100 * high, lambda value: fixed(value, 1))


def typeset(text: str) -> Markup:
    """Plain text as HTML: escaped, symbols in italics, true apostrophes."""
    from markupsafe import Markup, escape

    html = str(
        escape(
            _PERCENT.sub(
                "\\1\N{NO-BREAK SPACE}%", text.replace("'", "\N{RIGHT SINGLE QUOTATION MARK}")
            )
        )
    )
    for pattern, replacement in _TYPESET:
        html = pattern.sub(replacement, html)
    return Markup(html)


def count(n: int, noun: str) -> str:
    """A number with its noun, such as "1 motion" or "3 analyses"."""
    plural = {"analysis": "analyses", "history": "histories"}.get(noun, noun + "s")
    return f"{n} {noun if n == 1 else plural}"


def axis_name(key: str) -> str:
    """Symbol of an axis, or the last word of its key."""
    return _SYMBOLS.get(key) or axis_words(key)


def level_text(key: str, value: object) -> str:
    """Value of an axis with its unit, such as "0.001 s"."""
    if isinstance(value, dict):
        return ", ".join(setting_text({f"{key}.{inner}": item}) for inner, item in value.items())
    unit = axis_unit(key)
    plain = isinstance(value, (int, float)) and not isinstance(value, bool)
    return plain_level(value) + (f"\N{NO-BREAK SPACE}{unit}" if plain and unit != "-" else "")


def plain_level(value: object) -> str:
    """Value of an axis without its unit, powers of ten written as such."""
    text = level_number(value)
    if not isinstance(value, float) or "e" not in text:
        return text
    mantissa, _, exponent = text.partition("e")
    power = f"10{str(int(exponent.replace(MINUS, '-'))).translate(_SUPERSCRIPTS)}"
    return power if mantissa == "1" else f"{mantissa}{THIN}×{THIN}{power}"


def sentence(words: str) -> str:
    """Words with a capital at their beginning alone."""
    return words[:1].upper() + words[1:]


def setting_text(values: dict[str, Any]) -> str:
    """Values of all axes, such as "Δt = 0.001 s, α = −0.2"."""
    if not values:
        return ALL_ANALYSES
    equals = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"
    return ", ".join(
        level_text(key, value)
        if isinstance(value, dict)
        else f"{axis_name(key)}{equals}{level_text(key, value)}"
        for key, value in values.items()
    )
