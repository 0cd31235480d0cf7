"""The manual as a site: `./containers/run docs [-o DIR] [--tutorials run|none]`.

Runs the tutorials whose outputs are not there yet, builds the site with MkDocs, which ends with an
error at its first warning, and checks every link and anchor of what was built.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))

import links  # noqa: E402
import tutorials  # noqa: E402


def main(argv: list[str] | None = None) -> int:
    """Build the site; 0, or 1 where something is wrong."""
    parser = argparse.ArgumentParser(prog="containers/run docs", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=Path("results/docs"), metavar="DIR")
    parser.add_argument(
        "--tutorials",
        choices=("run", "none"),
        default="run",
        help="run them, two minutes, or show their code alone (default: %(default)s)",
    )
    args = parser.parse_args(argv)
    output = args.output.resolve()
    os.environ.pop(tutorials.FOLDER, None)
    if args.tutorials == "run":
        os.environ[tutorials.FOLDER] = str(output / "tutorials")
        for name in tutorials.names():
            print(tutorials.run(name), flush=True)
    return build(output / "site")


def build(site: Path) -> int:
    """Build the pages and check their links; 0, or 1 where something is wrong."""
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--clean"]
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [*command, "--config-file", str(HERE / "mkdocs.yml"), "--site-dir", str(site)],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": path, "NO_MKDOCS_2_WARNING": "1"},
    )
    if done.returncode:
        return 1
    if broken := links.broken_links(site):
        print("Links that lead nowhere:", *broken, sep="\n", file=sys.stderr)
        return 1
    pages = len(list(site.rglob("*.html")))
    print(f"{pages} pages, links checked; open {site / 'index.html'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
