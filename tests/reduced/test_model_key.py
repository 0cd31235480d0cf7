"""A reduced body is taken from the cache only where the code that would make it now is the code
that made it.
"""

import importlib.metadata
import shutil

import pytest
from imported_modules import ROOT, closure

from fecolumn.foundation import sources
from fecolumn.structures import store

# What makes bodies and reads no operator: the case and its keys, which name what is made
_BESIDE_FOLDERS = ("contact", "dynamics", "motions", "reduced")


@pytest.fixture
def key(tmp_path, monkeypatch):
    """Key of anything, as a copy of the package's sources in tmp_path makes it; a function."""
    shutil.copytree(ROOT, tmp_path / "fecolumn", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(sources, "_PACKAGE", tmp_path / "fecolumn")

    def made():
        store._code.cache_clear()
        return store.key_of("a block")

    yield made
    store._code.cache_clear()


@pytest.mark.parametrize(
    "source",
    [
        "mesh/column.py",
        "fem/free_body.py",
        "fem/material/elasticity.py",
        "fem/reduction.py",
        "contact/layer.py",
        "structures/shapes.py",
    ],
)
def test_change_of_code_that_makes_models_makes_them_anew(key, tmp_path, source):
    before = key()
    assert key() == before
    with open(tmp_path / "fecolumn" / source, "a") as file:
        file.write("\n")
    assert key() != before


def test_change_of_other_code_keeps_models(key, tmp_path):
    before = key()
    for source in ("contact/friction.py", "motions/at2.py", "study/run.py"):
        with open(tmp_path / "fecolumn" / source, "a") as file:
            file.write("\n")
    assert key() == before


def test_other_dolfinx_makes_models_anew(key, monkeypatch):
    before = key()
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "0.0")
    assert key() != before


def test_source_of_models_that_is_gone_is_an_error_and_no_silent_old_model(key, tmp_path):
    (tmp_path / "fecolumn" / "contact" / "layer.py").unlink()
    with pytest.raises(FileNotFoundError, match="contact/layer.py"):
        key()


def test_sources_cover_what_bodies_layouts_and_grounds_are_made_from():
    """What is imported besides reads, checks and tells cases, or is of points, which are made by
    each analysis.
    """
    makers = (
        "fem/reduction.py",
        "contact/known_base.py",
        "contact/base_plate.py",
        "structures/layout.py",
        "structures/bodies.py",
        "structures/ground.py",
    )
    covered = {str(path.relative_to(ROOT)) for path in sources.files_of(store.SOURCES)}
    besides = {name for name in closure(*makers) - covered if not name.startswith("foundation/")}
    cases = """case case_tables case_text changes check_bond check_case check_found check_full
        check_grounds check_link check_motion check_plates check_rolling check_step check_thin
        checked given link mesh_limits model_keys model_names model_sections model_table order
        reading"""
    points = "interface pad points record"
    known = {f"case/{name}.py" for name in cases.split()}
    assert besides == known | {f"contact/{name}.py" for name in points.split()}
