"""What is kept of bodies, plates and layouts is checked before it is used: a damaged file is made
anew, and said so.
"""

import shutil
import warnings

import numpy as np
import pytest
from small_structures import BLOCK, FOOT, structure

from fecolumn.foundation import digests
from fecolumn.structures.made_layout import kept_keys
from fecolumn.structures.store import kept_body
from fecolumn.structures.structure import structure_model

CASE = structure(
    bodies=dict(block=BLOCK | dict(height_m=0.4)),
    joints=dict(foot=FOOT),
    grounds=dict(ground=dict(kind="plate", element_size_m=0.05)),
)


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """A cache with a block and the plate below it, all of which is known."""
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FECOLUMN_CACHE", str(folder))
        base = structure_model(CASE).base
        base.need(np.arange(len(base.grid.points)))
    return folder


@pytest.fixture
def cache(filled, tmp_path, monkeypatch):
    """A copy of it, which this process uses."""
    shutil.copytree(filled, tmp_path / "cache")
    monkeypatch.setenv("FECOLUMN_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def _made():
    """What an analysis takes, as a process without any memory finds it."""
    kept_body.cache_clear()
    structure = structure_model(CASE)
    model, base = structure.parts[0].model, structure.base
    return model.flexibility, model.shapes, np.array(base.compliance), base.grid.points


def _flip(file, share: float) -> None:
    content = bytearray(file.read_bytes())
    content[int(share * (len(content) - 1))] ^= 0x10
    file.write_bytes(content)


def test_whole_files_are_used_without_a_word(cache):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _made()
    kept = [file for file in cache.rglob("*") if file.name == digests.DIGESTS]
    assert len(kept) == 2


_FILES = ("body.npz", "base.npz", "compliance-0.npy", "known-0.npy", "*.json")


@pytest.mark.parametrize(
    "name, share",
    [(name, share) for name in _FILES for share in (0.0, 0.03, 0.7, None)]
    + [("digests.json", 0.0), ("digests.json", None)],
)
def test_a_damaged_file_is_made_anew_with_a_line(cache, name, share):
    before = _made()
    folder = cache / "layouts" if name == "*.json" else cache
    for file in folder.rglob(name):
        if share is None:
            file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
        else:
            _flip(file, share)
        with pytest.warns(UserWarning, match="is damaged, and made anew") as told:
            after = _made()
        assert not any("\n" in str(one.message) for one in told)
        for old, new in zip(before, after):
            np.testing.assert_allclose(new, old, rtol=1e-9, atol=1e-9 * np.abs(old).max())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _made()


def test_modes_all_over_a_body_are_checked_where_they_are_needed(cache):
    (file,) = cache.rglob("fields.npy")
    before = np.load(file)
    _flip(file, 0.7)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _made()
    with pytest.warns(UserWarning, match="is damaged, and made anew"):
        kept_keys(CASE)
    np.testing.assert_allclose(np.load(file), before, rtol=1e-6, atol=1e-9 * np.abs(before).max())


def test_a_reach_of_a_plate_that_is_damaged_is_found_again(cache):
    base = structure_model(CASE).base
    everything = np.arange(len(base.grid.points))
    base.need(everything)
    before = np.array(base.compliance)
    file = max(cache.rglob("compliance-*.npy"), key=lambda one: one.stat().st_size)
    assert file.name != "compliance-0.npy"
    _flip(file, 0.5)
    other = structure_model(CASE).base
    with pytest.warns(UserWarning, match=f"{file.name} is damaged, and made anew"):
        other.need(everything)
    np.testing.assert_allclose(other.compliance, before, rtol=1e-9, atol=1e-20)
