"""The manual as a site: the configuration lists every page, equations and links are right, and it
builds without a warning.
"""

import os
import re
import subprocess
import sys

import pytest
from chromium import chromium, open_page
from documents import ROOT

import fecolumn
from containers.docs import api
from containers.docs.cells import cells
from containers.docs.equations import is_equation, typeset, with_equations
from containers.docs.links import broken_links
from fecolumn.case.manual import MANUAL_FOLDER, TOPICS

DOCS = ROOT / "containers" / "docs"
GENERATED = {"index.md", "gallery.md", "results.md", "api.md", "tutorials/index.md"}


def _listed() -> list[str]:
    """Pages of the navigation."""
    text = (DOCS / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:\n")[2]
    return re.findall(r"- (\S+\.md)$", text, re.MULTILINE)


def test_every_page_of_the_manual_is_listed_once():
    tutorials = {f"tutorials/{path.stem}.md" for path in (MANUAL_FOLDER / "tutorials").glob("*.py")}
    pages = {path.name for path in MANUAL_FOLDER.glob("*.md")}
    assert pages == {f"{name}.md" for name in TOPICS}
    assert sorted(_listed()) == sorted(pages | tutorials | GENERATED)


def test_every_public_name_stands_below_one_heading_of_the_page_of_names():
    assert api.page().count("::: fecolumn.") == len(fecolumn.__all__)


def test_equations_of_the_manual_are_known_and_what_commands_print_is_left():
    page = (MANUAL_FOLDER / "theory.md").read_text(encoding="utf-8")
    made = with_equations(page)
    assert made.count("class='equation'") == 6 and "    fecolumn verify -o DIR" in made
    assert "<td class='number'>(3)</td>" in made and "\n    s = W r" not in made
    fenced = "```toml\n\n    a = 1 + 2\n```"
    assert with_equations(fenced) == fenced
    jobs = (MANUAL_FOLDER / "jobs.md").read_text(encoding="utf-8")
    assert with_equations(jobs) == jobs
    assert is_equation("    τ + μ σ = c") and not is_equation("    unit: g")


@pytest.mark.parametrize(
    "text, there",
    [
        ("x₁ = M⁻¹ r_n", "<i>x</i><sub>1</sub> = <i>M</i><sup>−1</sup> <i>r</i><sub>n</sub>"),
        ("sin²(θ/2) < a_g0", "sin<sup>2</sup>(<i>θ</i>/2) &lt; <i>a</i><sub>g0</sub>"),
        ("IMPACT_GIVES_j", "IMPACT_GIVES<sub>j</sub>"),
        ("w_k² q", "<i>w</i><sub>k</sub><sup>2</sup> <i>q</i>"),
        ("p^(j−1) of F", "<i>p</i><sup>j−1</sup> of <i>F</i>"),
    ],
)
def test_symbols_are_italic_and_indices_lowered(text, there):
    assert typeset(text) == there


def test_cells_of_a_notebook_are_text_and_code_in_their_order():
    found = cells("# ---\n\n# %% [markdown]\n# # Title\n#\n# Words.\n\n# %%\nx = 1\n")
    assert found == [("markdown", "# Title\n\nWords."), ("code", "x = 1\n")]


def test_links_that_lead_nowhere_are_found(tmp_path):
    (tmp_path / "a.html").write_text(
        '<h1 id="top"></h1><a href="b.html#there">x</a><a href="b.html#gone">x</a>'
        '<a href="c.html">x</a><a href="#top">x</a><a href="https://example.org">x</a>'
        '<script src="https://example.org/x.js"></script>'
    )
    (tmp_path / "b.html").write_text('<h2 id="there"></h2><img src="none.png">')
    assert broken_links(tmp_path) == [
        "a.html: loads https://example.org/x.js",
        "a.html: b.html#gone",
        "a.html: c.html",
        "b.html: none.png",
    ]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder of the site, and what its builder said: tutorials without their outputs, as what they
    print and show is tested in test_tutorials.
    """
    pytest.importorskip("mkdocstrings")
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, str(DOCS / "build.py"), "--tutorials", "none", "-o", str(folder)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return folder / "site", done.stderr


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_site_is_built_without_a_warning_and_has_every_public_name(site):
    folder, said = site
    assert "WARNING" not in said, said[-3000:]
    from fecolumn import __all__ as names

    written = (folder / "api.html").read_text(encoding="utf-8")
    assert all(f">{name}<" in written for name in names)
    assert "must be greater than 0 and at most" in written  # the help of keys
    assert "unpkg.com" not in written


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("width", [1200, 400])
def test_every_page_fits_a_screen_and_a_phone(site, width):
    """Wide tables and code scroll within the page; nothing is asked of a network."""
    with chromium() as window:
        for page in sorted(site[0].rglob("*.html")):
            open_page(window, page.as_uri(), width, 800)
            script = window.execute_script
            assert script("return document.documentElement.scrollWidth") <= width, page.name
            sent = script("return performance.getEntriesByType('resource').map((one) => one.name)")
            assert not [one for one in sent if one.startswith("http")], page.name
