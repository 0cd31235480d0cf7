"""What is kept of bodies, plates and layouts is checked before it is used: a damaged file is made
anew, and said so.
"""

import warnings

import numpy as np
import pytest
from small_structures import BLOCK, FOOT, structure

from fecolumn.foundation import digests
from fecolumn.structures.store import kept_body
from fecolumn.structures.structure import kept_keys, structure_model

CASE = structure(
    bodies=dict(block=BLOCK | dict(height_m=0.4)),
    joints=dict(foot=FOOT),
    grounds=dict(ground=dict(kind="plate", element_size_m=0.05)),
)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of its own, with a block and the plate below it."""
    monkeypatch.setenv("FECOLUMN_CACHE", str(tmp_path))
    structure_model(CASE)
    return tmp_path


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


@pytest.mark.parametrize(
    "name",
    ["body.npz", "base.npz", "compliance-0.npy", "known-0.npy", "digests.json", "*.json"],
)
@pytest.mark.parametrize("share", [0.0, 0.03, 0.7, None])
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
    wanted = base.grid.around(np.array([[0.25, 0.0, 0.0]]), 1)
    base.need(wanted)
    before = np.array(base.compliance)
    (file,) = cache.rglob("compliance-1.npy")
    _flip(file, 0.5)
    other = structure_model(CASE).base
    with pytest.warns(UserWarning, match="compliance-1.npy is damaged, and made anew"):
        other.need(wanted)
    np.testing.assert_allclose(other.compliance, before, rtol=1e-9, atol=1e-20)
