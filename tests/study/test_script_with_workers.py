"""A script that runs a study needs no guard: its workers do not run it anew."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import sys
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study

print("the script runs", file=sys.stderr)
rows = complete_study(read_plan("study.toml"), "out", workers=2, entry="rocking_block:run")
print([row["state"] for row in rows])
"""


@pytest.mark.long
def test_script_runs_once(tmp_path):
    case = Path(__file__).parents[2] / "meshes" / "stout.toml"
    (tmp_path / "study.toml").write_text(
        f'case = "{case}"\n[axes]\n"motion.source" = ["pulse:1", "pulse:2"]\n'
    )
    (tmp_path / "script.py").write_text(SCRIPT)
    path = os.pathsep.join(
        [
            str(Path(__file__).parents[2]),
            str(Path(__file__).parent),
            os.environ.get("PYTHONPATH", ""),
        ]
    )
    done = subprocess.run(
        [sys.executable, "script.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert done.stdout.strip() == "['done', 'done']", done.stderr[-1500:]
    assert done.stderr.count("the script runs") == 1
