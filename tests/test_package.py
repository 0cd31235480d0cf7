"""The package as `pip install` gets it: sdist and wheel, in an environment without the checkout."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

from fecolumn import __version__

ROOT = Path(__file__).parents[1]
#: What the package is made from
SOURCES = ("pyproject.toml", "README.md", "LICENSE", "fecolumn")


def said(*command, cwd) -> str:
    """What a command prints; the test fails where it does."""
    outside = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    done = subprocess.run(command, cwd=cwd, env=outside, capture_output=True, text=True)
    assert done.returncode == 0, f"{command}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
    return done.stdout


def test_every_file_that_states_the_version_states_the_same():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    changelog = ROOT / "fecolumn" / "case" / "manual" / "changelog.md"
    newest = re.search("^## (.*)$", changelog.read_text(encoding="utf-8"), re.MULTILINE)[1]
    assert project["version"] == __version__ == newest.split(" - ")[0]
    assert f"version: {__version__}" in citation


@pytest.mark.long
def test_sdist_and_wheel_hold_every_file_and_run_in_a_fresh_environment(tmp_path):
    """The wheel is built from the sdist. Other libraries are those of this environment, by a .pth
    file that leads to them.
    """
    pytest.importorskip("build")
    source = tmp_path / "source"
    source.mkdir()
    for name in SOURCES:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copy(ROOT / name, source / name)
    for made in [*source.rglob("__pycache__"), *source.rglob("*.egg-info")]:
        shutil.rmtree(made)
    files = {
        str(path.relative_to(source)) for path in (source / "fecolumn").rglob("*") if path.is_file()
    }
    said(
        sys.executable, "-m", "build", "--no-isolation", "--outdir", "dist", "source", cwd=tmp_path
    )
    sdist = tmp_path / "dist" / f"fecolumn-{__version__}.tar.gz"
    (wheel,) = (tmp_path / "dist").glob(f"fecolumn-{__version__}-py3-none-any.whl")
    with tarfile.open(sdist) as packed:
        held = {name.partition("/")[2] for name in packed.getnames()}
    assert files - held == set() and "README.md" in held
    with zipfile.ZipFile(wheel) as packed:
        assert files - set(packed.namelist()) == set()

    fresh = tmp_path / "fresh"
    said(sys.executable, "-m", "venv", "--system-site-packages", str(fresh), cwd=tmp_path)
    python = fresh / "bin" / "python"
    said(python, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", wheel, cwd=tmp_path)
    site = said(
        python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=tmp_path
    )
    (Path(site.strip()) / "other.pth").write_text(sysconfig.get_path("purelib"))
    here = said(python, "-c", "import fecolumn; print(fecolumn.__file__)", cwd=tmp_path)
    assert Path(here.strip()).is_relative_to(fresh)
    program = fresh / "bin" / "fecolumn"
    assert said(program, "--version", cwd=tmp_path).split()[-1] == __version__
    assert "# Commands" in said(program, "help", "commands", cwd=tmp_path)
    rows = said(python, "-c", "import fecolumn; print(len(fecolumn.outcomes()))", cwd=tmp_path)
    assert int(rows) > 100_000
    said(program, "new", "tube", "new", cwd=tmp_path)
    assert "[bodies.column]" in said(program, "show", "new/case.toml", cwd=tmp_path)
