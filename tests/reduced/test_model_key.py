"""A reduced model is taken from the cache only where the code that would make it now is the code
that made it.
"""

import importlib.metadata
import shutil

import pytest
from imported_modules import ROOT, closure

from fecolumn import sources
from fecolumn.case import case_from_tables
from fecolumn.reduced import cache

# What code that makes a model imports from the rest of it: the case, which the key has with all its
# sizes, checks of it, the model's own class, whose fields the key has, and the digest of a file,
# which tells whether it was read before
_BESIDE = {
    "_form_compiler.py",
    "case.py",
    "content.py",
    "schema.py",
    "sizes.py",
    "reduced/model.py",
}


@pytest.fixture
def key(tmp_path, monkeypatch):
    """Key of a block, as a copy of the package's sources in tmp_path makes it; a function."""
    shutil.copytree(ROOT, tmp_path / "fecolumn", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(sources, "_PACKAGE", tmp_path / "fecolumn")
    block = case_from_tables(
        dict(column=dict(shape="block", length_m=0.4, width_m=0.4, height_m=1.2)), "block"
    )

    def made():
        cache._code.cache_clear()
        return cache.model_key(block)

    yield made
    cache._code.cache_clear()


@pytest.mark.parametrize(
    "source",
    [
        "mesh/column.py",
        "fem/free_body.py",
        "material/elasticity.py",
        "reduced/build.py",
        "contact/layer.py",
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
    (tmp_path / "fecolumn" / "fem" / "modes.py").unlink()
    with pytest.raises(FileNotFoundError, match="fem/modes.py"):
        key()


def test_key_covers_all_that_making_a_model_imports():
    # they hold more than what models are made with
    many = {
        "dynamics/assembly.py",
        "dynamics/observer.py",
    }
    found = closure(
        "reduced/build.py",
        "mesh/specimen.py",
        "contact/base_plate.py",
        "contact/footprint.py",
        "contact/unbounded_base.py",
        *many,
        stop={*many, *_BESIDE},
    )
    covered = {str(path.relative_to(ROOT)) for path in sources.files_of(cache.SOURCES)}
    assert found - covered == _BESIDE
