"""The map of P(overturn) and the column chosen from it."""

from benchmarks.calibration.__main__ import DIAMETER, HEIGHT, cells, draw, nearest, table


def row(diameter, height, overturned, state="done"):
    return {
        "state": state,
        "axes": {DIAMETER: diameter, HEIGHT: height},
        "summary": {"overturned": overturned} if state == "done" else None,
    }


ROWS = [
    *(row(0.0603, 1.0, k < 6) for k in range(10)),
    *(row(0.0761, 1.5, k < 4) for k in range(10)),
    row(0.0761, 1.5, None, "failed"),
    *(row(0.0889, 1.0, False) for _ in range(10)),
]


def test_column_nearest_to_the_target_is_chosen_and_failures_do_not_count():
    found = cells(ROWS)
    assert found == {(0.0603, 1.0): (6, 10), (0.0761, 1.5): (4, 10), (0.0889, 1.0): (0, 10)}
    assert nearest(found) == (0.0761, 1.5)


def test_map_is_drawn_and_tabulated_with_intervals(tmp_path):
    found = cells(ROWS)
    assert all(file.stat().st_size > 1000 for file in draw(found, tmp_path / "map"))
    # Wilson's interval of 4 in 10
    assert table(found).splitlines()[2].startswith("0.0761,1.5,10,4,0.4000,0.1682,0.6873")
