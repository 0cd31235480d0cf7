"""The tutorials are notebooks in text that run as they are."""

import os
import subprocess
import sys

import pytest
from documents import ROOT

TUTORIALS = sorted((ROOT / "tutorials").glob("*.py"))


@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda path: path.stem)
def test_tutorial_is_cells_of_python(tutorial):
    text = tutorial.read_text(encoding="utf-8")
    compile(text, str(tutorial), "exec")
    assert text.startswith("# ---\n# jupyter:") and text.count("\n# %%") > 5


@pytest.mark.manual
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda path: path.stem)
def test_tutorial_runs(tutorial, tmp_path):
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run([sys.executable, str(tutorial)], cwd=tmp_path, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    assert list(tmp_path.rglob("cdf.png"))
