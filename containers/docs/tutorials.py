"""The tutorials of the manual as pages, with what they print and show.

A tutorial is run cell by cell (cells.py) into a folder named after its text, the package's version
and its `PHYSICS`: what has not changed is not run again.
"""

from __future__ import annotations

import hashlib
import html
import os
import re
import subprocess
import sys
from pathlib import Path

from cells import cells

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "fecolumn" / "case" / "manual" / "tutorials"
#: environment variable: folder of the outputs; without it pages have none, and say so
FOLDER = "FECOLUMN_TUTORIALS"
WITHOUT = """!!! note
    This copy of the page was built where dolfinx is not installed, so that it has the code without
    its outputs. `./containers/run docs` makes the page with them.
"""


def names() -> list[str]:
    """Names of the tutorials."""
    return sorted(path.stem for path in SOURCES.glob("*.py"))


def text(name: str) -> str:
    """Source of a tutorial."""
    return (SOURCES / f"{name}.py").read_text(encoding="utf-8")


def folder(name: str) -> Path | None:
    """Where the outputs of a tutorial are or will be; None where outputs are not wanted."""
    from fecolumn import __version__
    from fecolumn.foundation.sources import PHYSICS

    if not os.environ.get(FOLDER):
        return None
    key = f"{text(name)}\n{__version__}\n{PHYSICS}"
    return Path(os.environ[FOLDER]) / f"{name}-{hashlib.sha256(key.encode()).hexdigest()[:12]}"


def run(name: str) -> str:
    """Run a tutorial unless its outputs are there; what was done, in words.

    Raises
    ------
    RuntimeError
        a cell ends with an error.
    """
    where = folder(name)
    assert where is not None
    if (where / "done").exists():
        return f"{name}: kept from before"
    (where / "shown").mkdir(parents=True, exist_ok=True)
    script = Path(__file__).with_name("cells.py")
    done = subprocess.run(
        [sys.executable, str(script), str(SOURCES / f"{name}.py"), "shown"],
        cwd=where,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path[1:]])},
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise RuntimeError(f"tutorial {name}: {done.stderr[-2000:]}")
    (where / "done").touch()
    return f"{name}: run"


def page(name: str) -> str:
    """Markdown of a tutorial with places for its outputs, which `with_outputs` fills."""
    where, parts, number = folder(name), [], 0
    for kind, body in cells(text(name)):
        if kind == "markdown":
            parts.append(body)
            continue
        parts.append(f"```python\n{body.strip()}\n```")
        if where:
            if (where / "shown" / f"{number}.png").exists():
                parts.append(f"![Figure that the cell shows]({name}-{number}.png)")
            parts.append(f"<p>output of {name} {number}</p>")
        number += 1
    if not where:
        parts.insert(1, WITHOUT)
    parts.append(
        f"The page is the notebook `fecolumn/case/manual/tutorials/{name}.py`, run when the site "
        "was built."
    )
    return "\n\n".join(parts) + "\n"


def index() -> str:
    """Page of all tutorials: the title and the first words of each."""
    lines = ["# Tutorials", "", "Notebooks in text, with what they print and show.", ""]
    for name in names():
        title, _, words = cells(text(name))[0][1].partition("\n")
        lines += [f"## [{title.removeprefix('# ')}]({name}.md)", "", words.strip(), ""]
    return "\n".join(lines)


def pictures(name: str) -> dict[str, Path]:
    """Place on the site and file of each picture of a tutorial."""
    where = folder(name)
    return {
        f"tutorials/{name}-{path.stem}.png": path
        for path in sorted((where / "shown").glob("*.png") if where else [])
    }


def with_outputs(page_html: str) -> str:
    """HTML of a page with what its cells printed and showed."""

    def output(found) -> str:
        where, parts = folder(found[1]), []
        stem = where / "shown" / found[2] if where else Path("none")
        if (printed := stem.with_suffix(".out")).exists():
            parts.append(_lines(printed.read_text(encoding="utf-8")))
        if (shown := stem.with_suffix(".html")).exists():
            own = shown.read_text(encoding="utf-8")
            parts.append(re.sub(r"<style.*?</style>", "", own, flags=re.DOTALL))
        elif (shown := stem.with_suffix(".txt")).exists():
            parts.append(_lines(shown.read_text(encoding="utf-8")))
        return f"<div class='output'>{''.join(parts)}</div>" if parts else ""

    return re.sub(r"<p>output of (\w+) (\d+)</p>", output, page_html)


def _lines(printed: str) -> str:
    return f"<pre>{html.escape(printed.rstrip())}</pre>"
