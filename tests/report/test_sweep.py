"""What a report reads from a study."""

import csv

import numpy as np
from synthetic_study import DT, LIMIT_M, write_synthetic

from fecolumn.cli import main
from fecolumn.study.report.pair import read_pairs
from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.sample import read_sample
from fecolumn.study.setting_pairs import SAMPLED


def test_displacement_at_which_an_overturned_run_stopped_is_no_peak(tmp_path):
    """Without a cap in the case nothing is known of what overturned but that it went further than
    all that stood.
    """
    folder = write_synthetic(tmp_path, {DT: [1e-3]}, 40)
    sweep, sample = read_sweep(folder), read_sample(str(folder))
    u, overturned = sweep.done[0].peaks()
    assert 0 < overturned.sum() < 40
    np.testing.assert_array_equal(np.isnan(u), overturned)
    np.testing.assert_array_equal(np.isnan(sample.u_max), sample.lost)
    assert sweep.limit_m == np.nanmax(u) < LIMIT_M


HEIGHT, WIDTH = "column.height_m", "column.outer_diameter_m"


def test_settings_of_one_zip_are_compared_once_with_all_of_its_axes(tmp_path):
    folder = write_synthetic(
        tmp_path,
        {DT: [1e-3, 1e-4]},
        30,
        effect=lambda values: 3 * values[HEIGHT],
        zipped=f'"{HEIGHT}" = [1.0, 1.5]\n"{WIDTH}" = [0.1, 0.12]\n',
    )
    sweep = read_sweep(folder)
    assert sweep.varied == [DT, HEIGHT, WIDTH] and sweep.leading == [DT, HEIGHT]
    pairs = read_pairs(sweep)
    assert [pair.axis for pair in pairs] == [DT] * 2 + [HEIGHT] * 2
    assert pairs[0].partners == {} and pairs[2].partners == {WIDTH: (0.1, 0.12)}
    assert set(pairs[2].others) == {DT}
    assert main(["report", str(folder)]) == 0
    with open(folder / "report" / "tables" / "comparisons.csv") as file:
        rows = list(csv.DictReader(file))
    assert [row["with"] for row in rows][:2] == ["", ""] and "0.12" in rows[2]["with"]
    page = (folder / "report" / "index.html").read_text()
    assert page.count("cdf_by_height_m") and "cdf_by_outer_diameter_m" not in page


def test_sampled_axes_are_no_zip(tmp_path):
    """Random samples have another value of each axis in every setting."""
    many = [round(1 + 0.1 * number, 2) for number in range(SAMPLED + 1)]
    zipped = f'"{HEIGHT}" = {many}\n"{WIDTH}" = {[one / 20 for one in many]}\n'
    sweep = read_sweep(write_synthetic(tmp_path, {DT: [1e-3]}, 6, zipped=zipped))
    assert sweep.together(HEIGHT) == (HEIGHT,) and sweep.leading == [HEIGHT, WIDTH]
    assert sweep.lines(HEIGHT) == []
