"""What one column costs in each version of this program: a table that goes on.

    ./containers/run python -m benchmarks.versions [COMMIT ...] > printed.txt
    ./containers/run python -m benchmarks.tables printed.txt versions

Checks out each commit, the present one by default, beside this work tree, runs the reference column
by its own program and prints the table `versions` with its rows, those of other versions as they
are kept. What it compiles goes into a folder that is empty at first: the first run has what the
set-up compiles otherwise.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import resource
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from datetime import date
from pathlib import Path

from benchmarks import tables
from benchmarks.beside import markdown

ROOT = Path(__file__).parents[1]
#: Motion of the Lick ensemble at each time step [s]
MOTIONS = {1e-3: 51, 1e-4: 31}
COLUMNS = (
    "version",
    "commit",
    "measured",
    "first run [CPU s]",
    "run again [CPU s]",
    *(f"step of {dt:g} s [us]" for dt in MOTIONS),
)
# Of keys that version 0.6 has, too
_CASE = """
extends = "{specimen}"
motion = {{ source = "lick:{motion}", free_vibration_s = 0.5 }}
integration = {{ dt_s = {dt}, alpha_hht = -0.2, engine = "reduced" }}
overturn = {{ displacement_m = 0.25 }}
"""
_COMMAND = "import sys; from fecolumn.cli import main; sys.exit(main())"


@contextlib.contextmanager
def checked_out(commit: str) -> Iterator[Path]:
    """Work tree of a commit, gone after the block.

    Raises
    ------
    subprocess.CalledProcessError
        there is no such commit.
    """
    with tempfile.TemporaryDirectory() as folder:
        tree, git = Path(folder) / "tree", ["git", "-C", str(ROOT), "worktree"]
        subprocess.run([*git, "add", "--quiet", "--detach", str(tree), commit], check=True)
        try:
            yield tree
        finally:
            subprocess.run([*git, "remove", "--force", str(tree)], check=True)


def timed_run(tree: Path, cache: Path, dt: float) -> tuple[float, dict]:
    """Processor time [s] of one `fecolumn run` of a tree, and its summary.

    Raises
    ------
    subprocess.CalledProcessError
        the run failed.
    """
    case, result = cache / f"{dt:g}.toml", Path(tempfile.mkdtemp(dir=cache)) / "run"
    specimen = tree / "meshes" / "specimen.toml"
    case.write_text(_CASE.format(specimen=specimen, motion=MOTIONS[dt], dt=dt), encoding="utf-8")
    own = {"PYTHONPATH": str(tree), "OMP_NUM_THREADS": "1"}
    for name in ("FECOLUMN_CACHE", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"):
        own[name] = str(cache)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, "-c", _COMMAND, "run", str(case), "-o", str(result)],
        env=os.environ | own,
        cwd=tree,
        stdout=subprocess.DEVNULL,
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return spent, json.loads((result / "summary.json").read_text(encoding="utf-8"))


def row_of(commit: str) -> list[str]:
    """The cells of `COLUMNS` of a commit."""
    with checked_out(commit) as tree, tempfile.TemporaryDirectory() as cache:
        shown = ["git", "-C", str(tree), "rev-parse", "--short", "HEAD"]
        short = subprocess.run(shown, capture_output=True, text=True, check=True).stdout.strip()
        project = tomllib.loads((tree / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        first, _ = timed_run(tree, Path(cache), 1e-3)
        again = {dt: timed_run(tree, Path(cache), dt) for dt in MOTIONS}
    return [
        project["version"],
        short,
        date.today().isoformat(),
        f"{first:.0f}",
        f"{again[1e-3][0]:.1f}",
        *(f"{1e6 * summary['cpu_s'] / summary['steps']:.0f}" for _, summary in again.values()),
    ]


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.versions",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("commits", nargs="*", metavar="COMMIT", default=["HEAD"])
    given = parser.parse_args(arguments)
    kept = (tables.FOLDER / "versions.csv").exists()
    rows = {row[0]: row for row in tables.read("versions").rows} if kept else {}
    failed = 0
    for number, commit in enumerate(given.commits, 1):
        print(f"{commit}, {number} of {len(given.commits)} ...", file=sys.stderr, flush=True)
        try:
            row = row_of(commit)
        except subprocess.CalledProcessError as error:
            print(f"error: {commit} is left out: {error}", file=sys.stderr)
            failed += 1
            continue
        rows[row[0]] = row
        print(", ".join(row), file=sys.stderr, flush=True)
    ordered = sorted(rows.values(), key=lambda row: [int(part) for part in row[0].split(".")])
    print(markdown(COLUMNS, ordered))
    if failed:
        sys.exit(f"{failed} of {len(given.commits)} commits could not be measured")


if __name__ == "__main__":
    main()
