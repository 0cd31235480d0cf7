"""A notebook in text, run cell by cell as Jupyter does: the value of a cell's last line is shown by
its own HTML or PNG.

    python cells.py NOTEBOOK.py OUTPUT

What a cell prints is written to OUTPUT/NUMBER.out, what it shows to OUTPUT/NUMBER.html, NUMBER.png
or NUMBER.txt; cells are counted from 0, and those of text are not counted.
"""

from __future__ import annotations

import ast
import contextlib
import io
import sys
from pathlib import Path


def cells(text: str) -> list[tuple[str, str]]:
    """Kind, "markdown" or "code", and text of each cell in jupytext's percent format; the text of
    a Markdown cell without its comment signs.
    """
    found = []
    for cell in text.split("\n# %%")[1:]:
        title, _, body = cell.partition("\n")
        if title.strip() == "[markdown]":
            lines = [line.removeprefix("#").removeprefix(" ") for line in body.splitlines()]
            found.append(("markdown", "\n".join(lines).strip()))
        else:
            found.append(("code", body))
    return found


def code_cells(text: str) -> list[str]:
    """Code of the cells, without the text ones."""
    return [body for kind, body in cells(text) if kind == "code"]


def run(code: list[str], output: Path) -> None:
    """Run the cells in one namespace and write what they print and show."""
    names = {"__name__": "__main__"}
    for number, cell in enumerate(code):
        tree, last = ast.parse(cell), None
        if tree.body and isinstance(tree.body[-1], ast.Expr):
            last = ast.Expression(tree.body.pop().value)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(tree, f"cell {number}", "exec"), names)
            value = eval(compile(last, f"cell {number}", "eval"), names) if last else None
        if printed.getvalue():
            (output / f"{number}.out").write_text(printed.getvalue(), encoding="utf-8")
        if value is not None:
            show(value, output / str(number))


def show(value, place: Path) -> None:
    """Write a value as a notebook shows it."""
    if hasattr(value, "_repr_html_"):
        place.with_suffix(".html").write_text(value._repr_html_(), encoding="utf-8")
    elif hasattr(value, "_repr_png_"):
        place.with_suffix(".png").write_bytes(value._repr_png_())
    else:
        place.with_suffix(".txt").write_text(repr(value), encoding="utf-8")


if __name__ == "__main__":
    Path(sys.argv[2]).mkdir(parents=True, exist_ok=True)
    run(code_cells(Path(sys.argv[1]).read_text(encoding="utf-8")), Path(sys.argv[2]))
