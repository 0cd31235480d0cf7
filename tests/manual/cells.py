"""A notebook in text, run cell by cell as Jupyter does: the value of a cell's last line is shown by
its own HTML or PNG.

    python cells.py NOTEBOOK.py OUTPUT

Each cell that shows something is written to OUTPUT/NUMBER.html, NUMBER.png or NUMBER.txt.
"""

from __future__ import annotations

import ast
import sys
from pathlib import Path


def code_cells(text: str) -> list[str]:
    """Code of the cells in jupytext's percent format, without the text ones."""
    cells = text.split("\n# %%")[1:]
    return [cell.partition("\n")[2] for cell in cells if not cell.startswith(" [markdown]")]


def run(cells: list[str], output: Path) -> None:
    """Run the cells in one namespace and write what they show."""
    names = {"__name__": "__main__"}
    for number, cell in enumerate(cells):
        tree, last = ast.parse(cell), None
        if tree.body and isinstance(tree.body[-1], ast.Expr):
            last = ast.Expression(tree.body.pop().value)
        exec(compile(tree, f"cell {number}", "exec"), names)
        value = eval(compile(last, f"cell {number}", "eval"), names) if last else None
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
