"""No documented command compiles anything: the set-up did (`fecolumn prepare`).

Each page is walked at small size in a process of its own, in which numba and the compiler of
finite-element forms refuse to compile.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_commands import RUNNING

WALK = """
import sys
from pathlib import Path

import numba.core.compiler
import pytest

sys.path.insert(0, {folder!r})
refused = []


def refuse(typingctx, targetctx, function, *rest, **more):
    refused.append(function.__qualname__)
    raise RuntimeError("compiles " + function.__qualname__)


numba.core.compiler.compile_extra = refuse
from test_commands import walk

with pytest.MonkeyPatch.context() as patch:
    try:
        walk({page!r}, Path({here!r}), patch, small=True)
    finally:
        print("REFUSED", *refused, file=sys.stderr)
"""


@pytest.fixture(scope="module")
def prepared():
    """Everything that the set-up compiles."""
    from fecolumn.prepare import prepare

    prepare(print)


@pytest.mark.parametrize(
    "page",
    [page if page == "README" else pytest.param(page, marks=pytest.mark.slow) for page in RUNNING],
)
def test_no_command_of_a_page_compiles(page, prepared, tmp_path):
    text = WALK.format(folder=str(Path(__file__).parent), page=page, here=str(tmp_path))
    done = subprocess.run(
        [sys.executable, "-c", text],
        capture_output=True,
        text=True,
        env=os.environ | dict(CC="/bin/false", CXX="/bin/false"),
    )
    assert done.returncode == 0, done.stderr[-3000:]
