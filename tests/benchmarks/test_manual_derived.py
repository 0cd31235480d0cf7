"""Numbers of the manual that follow from several cells of tables, or from a part of one: each is
computed from them.
"""

import numpy as np
from results_page import ROOT, column, manual, pairs

from benchmarks import tables
from benchmarks.impact.kept_map import kept_cells


def first(cell):
    """The number before a parenthesis, as in "0.89 (0.41)", or before " of ", as in "52 of 115"."""
    return cell.replace(" of ", " ").split()[0]


def test_shortest_steps_with_rolling_substeps_in_theory():
    fallen = [
        first(column("paper_parts_overturned", "alpha -0.2")[f"rolling substeps, {dt} s"])
        for dt in ("0.02", "0.0001")
    ]
    found = pairs("paper_parts_steps", "rolling substeps, 0.02 and 0.0001 s")
    told = f"({fallen[0]} and {fallen[1]} overturn, {found['-0.2'][0]:.2f}, p = "
    assert f"{told}{found['-0.2'][1]:.2f})" in manual("theory")
    differ = [alpha for alpha, one in found.items() if one[1] < 0.05]
    assert f"at three other alphas ({', '.join(differ)}) they can" in manual("theory")
    assert len(differ) == 3


def test_what_an_impact_takes_in_theory():
    table = tables.read("impact_means")
    losses = {
        row[0]: {head: float(first(cell)) for head, cell in zip(table.columns[2:], row[2:]) if cell}
        for row in table.rows
    }
    reduced, full = losses["reduced engine"], losses["full order"]
    assert abs(reduced["0.0001 s"] / full["0.0001 s"] - 1) <= 0.011
    assert "lose the same within 1 % at 1e-4 s" in manual("theory")
    more = [
        round(losses[name]["1e-05 s"] / full["1e-05 s"] - 1, 2)
        for name in ("reduced, 30 modes", "reduced engine", "reduced, 300 modes")
    ]
    assert 0.22 <= more[0] <= 0.29 and 0.14 <= more[1] <= 0.19 and more[2] == 0.05
    assert "30 modes lose a quarter more than full order, 100 modes a sixth more, 300" in manual(
        "theory"
    )
    told = f"from {reduced['1e-05 s']} to {reduced['2e-06 s']} of the loss of Housner's rigid block"
    assert told in manual("theory")


def test_overturnings_that_are_missed_in_theory():
    missed, seen = (
        int(column("shake_table", head)["fecolumn"])
        for head in ("predicted to stand", "overturned: predicted")
    )
    assert f"it misses {missed} of {missed + seen} overturnings" in manual("theory")


def test_alphas_at_which_rolling_substeps_leave_a_difference_in_cases():
    short, shortest = (
        [
            alpha
            for alpha, one in pairs("paper_parts_steps", f"rolling substeps, {steps} s").items()
            if one[1] < 0.05
        ]
        for steps in ("0.02 and 0.001", "0.02 and 0.0001")
    )
    assert short == ["-0.333"] and shortest == ["-0.05", "-0.1", "-0.333"]
    assert "differ significantly at -0.333 alone, those at 0.02 s and 1e-4 s at -0.05" in manual(
        "cases"
    )


def test_outcomes_on_which_model_and_bodies_of_the_wobbling_frame_agree():
    bins = [name for name in column("wobbling_frame", "motions") if name.startswith(("N", "F"))]
    motions, shares = (column("wobbling_frame", head) for head in ("motions", "same outcome [%]"))
    same = sum(round(float(shares[name]) / 100 * int(motions[name])) for name in bins)
    told = f"agree on {same} of {sum(int(motions[name]) for name in bins)} outcomes"
    assert len(bins) == 6 and told in manual("rocking-structures")


def test_smaller_tilts_and_a_higher_column_lose_more_over_housner_in_the_mean():
    table = tables.read("impact_means")
    losses = {row[0]: row for row in table.rows}
    for step in ("0.001 s", "1e-05 s", "4e-06 s"):
        place = table.columns.index(step)
        usual, tilt, high = (
            float(first(losses[name][place]))
            for name in ("reduced engine", "reduced, from 0.05", "reduced, column of 3 m")
        )
        assert min(tilt, high) > usual
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "From 0.05 of the critical tilt, and of a column twice as high, the ratio is" in readme


def test_losses_of_stiff_bodies_and_measured_ones_in_theory():
    stiff = [one for one in kept_cells() if one["group"] >= 1e6]
    most = max(one["loss"] for one in stiff if one["ratio"] == 3)
    middle = np.quantile([one["loss"] for one in stiff], [0.15, 0.85])
    told = "lose {:.1f} to {:.1f} of Housner's loss, some of H/B 3 up to {:.1f} times"
    assert told.format(*middle, most) in manual("theory")
    measured = [
        np.mean([float(end) for end in cell.split(" to ")])
        for cell in column("impact_measured", "loss over Housner's").values()
    ]
    told = f"from {min(measured):.1f} of Housner's to {max(measured):.0f} times"
    assert told in manual("theory")
