"""Every picture of README and manual is made by the gallery, from what is in the repository."""

import re

import numpy as np
import pytest

from benchmarks import tables
from benchmarks.gallery.__main__ import main
from benchmarks.gallery.figures import FIGURES, ROOT, Work, make
from benchmarks.gallery.made import TABLE, digest
from benchmarks.results import RESULTS
from benchmarks.tables.changes import holds

PAGES = [ROOT / "README.md", *sorted((ROOT / "fecolumn" / "case" / "manual").glob("*.md"))]
PLACES = {place for place, _ in FIGURES.values()}


def _shown() -> dict[str, str]:
    """Pictures that README and manual show and RESULTS links, each with the page."""
    return {
        str((page.parent / name).resolve().relative_to(ROOT)): page.name
        for page, link in [*((page, r"!\[[^]]*\]") for page in PAGES), (RESULTS, r"\[figure\]")]
        for name in re.findall(link + r"\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    }


def test_every_picture_shown_is_made_and_every_picture_made_is_shown():
    assert set(_shown()) == PLACES and len(PLACES) == len(FIGURES)


@pytest.mark.parametrize("place", sorted(PLACES))
def test_picture_is_there_and_no_blank(place):
    from PIL import Image

    with Image.open(ROOT / place) as image:
        pixels = np.asarray(image.convert("L"), float)
    assert min(pixels.shape) > 300 and pixels.std() > 10


@pytest.mark.parametrize("place", sorted(PLACES))
def test_picture_was_made_by_code_of_these_motions(place):
    """The file is the one that was noted, and its motions are those of today."""
    rows = {row[0]: row for row in tables.read(TABLE).rows}
    _, noted, _, commit, _, physics = rows[place]
    assert noted == digest(place) and holds(place, physics) and "dirty" not in commit


@pytest.mark.parametrize("name", ["impact", "rolling"])
def test_figure_of_a_table_is_made_in_its_place(name, tmp_path):
    told = make(name, Work(tmp_path), tmp_path)
    assert (tmp_path / FIGURES[name][0]).stat().st_size > 10_000 and told.startswith(
        FIGURES[name][0]
    )


def test_cdf_is_drawn_from_the_study_given_and_says_so(tmp_path):
    import io
    import sys

    sys.path.insert(0, str(ROOT / "tests" / "study"))
    try:
        from rocking_block import ENTRY
        from study_files import write_study

        from fecolumn.study.plan import read_plan
        from fecolumn.study.run import complete_study

        plan = read_plan(write_study(tmp_path, dt=(0.02, 5e-3), pulses=range(6)))
        complete_study(plan, tmp_path / "out", workers=1, entry=ENTRY, stream=io.StringIO())
    finally:
        sys.path.remove(str(ROOT / "tests" / "study"))
    told = make("cdf", Work(tmp_path / "none", study=tmp_path / "out"), tmp_path)
    assert (
        "24 of 24 analyses done (2 of integration.dt_s" in told
        and f"from --study {tmp_path / 'out'}" in told
    )
    assert (tmp_path / "benchmarks" / "cdf.png").is_file() and not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    "arguments, told",
    [
        (["sunset"], "sunset: must be of rocking, cdf, impact, rolling"),
        (["cdf", "--study", "nowhere"], "nowhere: holds no study"),
    ],
)
def test_unknown_figures_and_folders_are_refused(arguments, told, capsys):
    with pytest.raises(SystemExit):
        main(arguments)
    assert told in capsys.readouterr().err
