"""The table of outcomes: written and read, what it refuses, and the one that comes with the
package.
"""

import h5py
import numpy as np
import pytest

import fecolumn
from benchmarks.outcomes.table import COLUMNS
from fecolumn.study.results.outcomes import PACKAGED, TableColumn, write_outcomes

_WORDS = TableColumn("which", words=("one", "other"))
_THREE = {"which": _WORDS, "length_m": TableColumn("of it", "m"), "count": TableColumn("of them")}


def test_rows_come_back_with_their_dictionary(tmp_path):
    rows = [
        dict(which="other", length_m=1 / 3, count=2),
        dict(which=0, count=None),
        dict(which="one", length_m=-1e-7, count=5),
    ]
    write_outcomes(tmp_path / "few.h5", rows, _THREE, dict(version="1", physics=3))
    table = fecolumn.outcomes(file=tmp_path / "few.h5")
    assert list(table.columns) == ["which", "length_m", "count"]
    assert list(table["which"]) == ["other", "one", "one"]
    assert list(table["count"]) == [2, -1, 5]
    assert table.length_m.to_numpy() == pytest.approx([1 / 3, np.nan, -1e-7], rel=1e-5, nan_ok=True)
    assert table.attrs["columns"]["length_m"] == {"meaning": "of it", "unit": "m"}
    assert table.attrs["made"] == {"version": "1", "physics": "3"}


OTHERS = {
    "no order": (None, {"a": [1.0]}, {}),
    "order without column": ('["b"]', {"a": [1.0]}, {}),
    "order that is none": ("3", {"a": [1.0]}, {}),
    "order that is no JSON": ("a", {"a": [1.0]}, {}),
    "no meaning": ('["a"]', {"a": [1.0]}, {}),
    "one number": ('["a"]', {"a": 1.0}, {"meaning": "x", "unit": "m", "words": "[]"}),
    "words of no places": ('["a"]', {"a": [0.5]}, {"meaning": "x", "unit": "m", "words": '["b"]'}),
    "two lengths": (
        '["a", "b"]',
        {"a": [1.0], "b": [1.0, 2.0]},
        {"meaning": "x", "unit": "m", "words": "[]"},
    ),
}


@pytest.mark.parametrize("order, columns, attributes", OTHERS.values(), ids=OTHERS)
def test_another_file_with_columns_is_refused(tmp_path, order, columns, attributes):
    with h5py.File(tmp_path / "other.h5", "w") as file:
        for name, values in columns.items():
            file.create_dataset(f"columns/{name}", data=values).attrs.update(attributes)
        file.attrs.update({} if order is None else {"order": order})
    with pytest.raises(fecolumn.InputError, match="is no table of outcomes; python -m bench"):
        fecolumn.outcomes(file=tmp_path / "other.h5")


def test_what_is_no_table_is_refused(tmp_path):
    with pytest.raises(fecolumn.InputError, match="is no file; python -m benchmarks.outcomes"):
        fecolumn.outcomes(file=tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("no")
    with pytest.raises(fecolumn.InputError, match="is no HDF5 file"):
        fecolumn.outcomes(file=tmp_path / "text.h5")
    import h5py

    with h5py.File(tmp_path / "empty.h5", "w"):
        pass
    with pytest.raises(fecolumn.InputError, match="no table of outcomes"):
        fecolumn.outcomes(file=tmp_path / "empty.h5")
    with pytest.raises(ValueError, match="width: in no column"):
        write_outcomes(tmp_path / "odd.h5", [dict(width=1.0)], _THREE, {})


def test_the_table_of_the_package_is_small_and_tells_what_it_holds():
    assert PACKAGED.stat().st_size < 20e6
    table = fecolumn.outcomes()
    assert list(table.columns) == list(COLUMNS) == list(table.attrs["columns"])
    assert len(table) == int(table.attrs["made"]["analyses"]) >= 100_000
    assert set(table.model.cat.categories) == set(table.model.unique())
    lost = table.outcome.isin(["overturned", "slid off"])
    assert (table.censored == lost).all()
    # what lost its balance has passed its critical tilt, or slid off
    fell = table[table.outcome == "overturned"]
    assert (fell[fell.model == "planar block"].peak_over_critical == 1).all()
    assert table.friction.isna().equals(table.model.isin(["planar block", "rolling column"]))
    # PGA over g times the slenderness is what lifts a body off: below it nothing rocks
    lifts = table.pga_m_s2 / (9.80665 * table.width_m / table.height_m)
    blocks = table[(table.model == "planar block") & (lifts < 0.99)]
    assert len(blocks) > 10 and (blocks.peak_over_critical == 0).all()


def test_a_fragility_surface_is_fitted_as_the_help_shows():
    import statsmodels.api as sm

    table = fecolumn.outcomes()
    blocks = table[table.model == "planar block"]
    x = sm.add_constant(np.log(blocks[["pgv_m_s", "height_m", "slenderness_rad"]]))
    surface = sm.Probit(blocks.outcome == "overturned", x).fit(disp=False)
    # more velocity overturns, size and breadth save
    assert surface.params["pgv_m_s"] > 0
    assert surface.params["height_m"] < 0 and surface.params["slenderness_rad"] < 0
