"""Equations of the manual's pages as HTML: no script and no font has to be loaded to read them.

In the pages an equation is an indented block in Unicode, so that `fecolumn help` prints it in a
terminal. Here symbols become italic, `r_n` and `x₁` get lowered indices, and columns of the block,
which three spaces or more separate, become columns of a table.
"""

from __future__ import annotations

import html
import re

# What only an equation has; a sum in words has " + "
SIGNS = "²₀₁ᵀ⁻·−∂√ΣΔΘΩΦαβγηκλμρσςτφϑθϱ"
# Words and functions of two letters; longer ones are upright, too
UPRIGHT = {"as", "at", "by", "in", "is", "no", "of", "on", "or", "to", "tr"}
RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ᵀᵃ", "0123456789+−Ta"))
LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋", "0123456789+−"))
TOKEN = re.compile(
    rf"(?P<constant>[A-Z]{{2,}}(?:_[A-Z]+)+)|(?P<up>[{''.join(RAISED)}]+)|(?P<down>[{''.join(LOWERED)}]+)"
    rf"|_\((?P<lows>[^)]*)\)|_(?P<low>[^\W_{''.join([*RAISED, *LOWERED])}]+)"
    r"|\^\((?P<highs>[^)]*)\)|\^(?P<high>[\w.]+)"
    rf"|(?P<word>(?:[^\W\d_{''.join([*RAISED, *LOWERED])}½⅓¼][\u0300-\u036f]?)+)|(?P<rest>.)",
    re.DOTALL,
)


def is_equation(block: str) -> bool:
    """Whether an indented block is an equation, and not what a command prints or is."""
    return bool(set(block) & set(SIGNS)) or " + " in block


def typeset(text: str) -> str:
    """One line of an equation as HTML."""
    parts = []
    for found in TOKEN.finditer(text):
        kind, value = found.lastgroup, html.escape(found[found.lastgroup])
        if kind == "up":
            parts.append(f"<sup>{''.join(RAISED[sign] for sign in value)}</sup>")
        elif kind == "down":
            parts.append(f"<sub>{''.join(LOWERED[sign] for sign in value)}</sub>")
        elif kind in ("low", "lows"):
            parts.append(f"<sub>{value}</sub>")
        elif kind in ("high", "highs"):
            parts.append(f"<sup>{value}</sup>")
        elif kind == "word" and (len(value) < 3 or value.startswith("Δ")) and value not in UPRIGHT:
            parts.append(f"<i>{value}</i>")
        else:
            parts.append(value)
    return "".join(parts)


def table(block: str) -> str:
    """An equation's block as an HTML table: a row a line; a number such as (1) at the right."""
    lines = [line.removeprefix("    ") for line in block.strip("\n").splitlines() if line.strip()]
    rows = []
    # one line of two equations makes no columns
    columns = sum(len(re.findall(r"\S {3,}[^ (]", line)) > 0 for line in lines) > 1
    for line in lines:
        number = re.search(r" {3,}(\(\d+\))$", line)
        line = line[: number.start()] if number else line
        indent = len(line) - len(line.lstrip())
        cells = [typeset(cell) for cell in re.split(r" {3,}", line.strip())]
        cells = cells if columns else ["&emsp;&emsp;".join(cells)]
        first = f' style="padding-left: {indent / 2}em"' if indent else ""
        row = f"<td{first}>{cells[0]}</td>" + "".join(f"<td>{cell}</td>" for cell in cells[1:])
        rows.append(f"<tr>{row}<td class='number'>{number[1] if number else ''}</td></tr>")
    width = max(row.count("<td") for row in rows)
    for at, row in enumerate(rows):
        if (missing := width - row.count("<td")) > 0:
            head, _, tail = row.rpartition("<td class")
            rows[at] = f"{head}{'<td></td>' * missing}<td class{tail}"
    return f"<div class='equation'><table class='formula'>{''.join(rows)}</table></div>"


def with_equations(markdown: str) -> str:
    """A page with its equations as HTML; fenced blocks and other indented ones stay."""
    out, block, fenced, blank = [], [], False, True
    for line in [*markdown.split("\n"), "\0"]:
        if not fenced and line.startswith("    ") and (block or blank):
            block.append(line)
            continue
        if block:
            text = "\n".join(block)
            out.append(table(text) if is_equation(text) else text)
            block = []
        fenced ^= line.startswith("```")
        blank = not line.strip()
        out.append(line)
    return "\n".join(out[:-1])
