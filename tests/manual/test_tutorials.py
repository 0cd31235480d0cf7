"""The tutorials are notebooks in text that run as they are."""

import os
import re
import subprocess
import sys

import pytest
from documents import ROOT

from containers.docs.cells import code_cells

TUTORIALS = sorted((ROOT / "fecolumn" / "case" / "manual" / "tutorials").glob("*.py"))


@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda path: path.stem)
def test_tutorial_is_cells_of_python(tutorial):
    text = tutorial.read_text(encoding="utf-8")
    compile(text, str(tutorial), "exec")
    assert (
        text.startswith("# ---\n# jupyter:")
        and text.count("\n# %%") > 5
        and len(code_cells(text)) > 5
    )
    # the text of a cell begins on its second line, or Jupyter takes it for the cell's title
    assert re.findall(r"^# %%.*$", text, re.M).count("# %% [markdown]") == text.count("[markdown]")


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda path: path.stem)
def test_tutorial_runs_cell_by_cell_and_shows_tables_and_figures(tutorial, tmp_path):
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, str(ROOT / "containers" / "docs" / "cells.py"), str(tutorial), "shown"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert "Traceback" not in done.stderr and list((tmp_path / "results").rglob("summary.json"))
    pages, figures = (
        list((tmp_path / "shown").glob("*.html")),
        list((tmp_path / "shown").glob("*.png")),
    )
    assert pages and all("<table" in page or "<pre" in page for page in map(_text, pages))
    assert any("<table" in page or "analyses done" in page for page in map(_text, pages))
    assert figures and all(
        file.read_bytes().startswith(b"\x89PNG") and file.stat().st_size > 10_000
        for file in figures
    )


def _text(file):
    return file.read_text(encoding="utf-8")
