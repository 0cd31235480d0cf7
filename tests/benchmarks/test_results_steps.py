"""Numbers of RESULTS.md on time steps and alpha that follow from several cells of tables: each is
computed from them.
"""

import re

import numpy as np
from results_page import PAGE, ROOT, column, pairs, verdicts

from benchmarks import tables
from benchmarks.tables.runs import read_runs
from fecolumn.statistics.holm import holm

ROLLING_D2 = "rolling substeps, d2"


def test_fixed_steps_are_told_apart_as_the_text_says():
    short, shortest = (
        pairs("paper_steps", f"fixed step, 0.02 and {dt} s").values() for dt in ("0.001", "0.0001")
    )
    largest = [max(one[k] for one in found) for found in (short, shortest) for k in (1, 2)]
    assert largest[1] < 0.03 and largest[2] <= 0.001
    told = f"(p at most {largest[0]:.3f}) and 1e-4 s (p < 0.001), and fewer columns fall"
    assert f"{told} (McNemar's p at most {largest[1]:.3f} and {largest[3]:.3f})" in PAGE
    fine = pairs("paper_steps", "fixed step, 0.001 and 0.0001 s").values()
    assert min(p for one in fine for p in one[1:]) > 0.05


def test_claims_of_the_paper_with_fixed_steps():
    here = verdicts("paper_claims")
    supported = {claim for claim, verdict in here.items() if verdict == "supported"}
    assert supported == {"a1", "a2, α", "b1", "d1", "d2"} and "five are supported:" in PAGE
    assert "d2, by times that are no finding" in PAGE
    assert here["a2, Δt"] == "not supported" and {here["b2"], here["c"]} == {"undecided"}
    least = min(float(p) for p in column("paper_alphas", "least p").values())
    assert f"the least p is {least:.3f}" in PAGE and 30 * least > 0.05


def test_steps_with_rolling_substeps_are_told_apart_as_the_text_says():
    short, shortest, fine = (
        pairs("paper_parts_steps", f"rolling substeps, {steps} s")
        for steps in ("0.02 and 0.001", "0.02 and 0.0001", "0.001 and 0.0001")
    )
    told = {alpha for alpha, one in short.items() if one[1] < 0.05}
    others = [one[1] for alpha, one in short.items() if alpha not in told]
    assert told == {"-0.333"}
    assert f"(-0.333: p < 0.001, else {min(others):.2f} to {max(others):.2f})" in PAGE
    told = {alpha: one[1] for alpha, one in shortest.items() if one[1] < 0.05}
    assert list(told) == ["-0.05", "-0.1", "-0.333"]
    assert (
        "(-0.05, -0.1 and -0.333: 0.016, 0.004 and < 0.001), by Holm's rule for these ten" in PAGE
    )
    ten = [*short.values(), *shortest.values()]
    corrected = holm([one[1] for one in ten])
    told = [alpha for alpha, p in zip([*short, *shortest], corrected) if p < 0.05]
    assert told == ["-0.333", "-0.1", "-0.333"]
    assert "for these ten pairs at the last two" in PAGE
    least = sorted(one[1] for one in fine.values())[:2]
    told = f"1e-3 and 1e-4 s at two ({least[0]} and {least[1]}), by Holm's rule for five at none"
    assert told in PAGE and min(holm([one[1] for one in fine.values()])) > 0.05
    flips = [one[2] for one in ten]
    assert min(holm(flips)) > 0.05 and f"(least McNemar's p {min(flips):.3f})" in PAGE


def test_about_half_of_the_difference_is_gone_with_rolling_substeps():
    def fallen(table, row):
        names = tables.read(table)
        (cells,) = [one for one in names.rows if one[0] == row]
        return sum(int(cell.partition(" of ")[0]) for cell in cells[1:])

    found = {
        (reading, dt): fallen(table, f"{reading}, {dt} s")
        for table, reading in (
            ("paper_overturned", "fixed step"),
            ("paper_parts_overturned", "rolling substeps"),
        )
        for dt in ("0.02", "0.001", "0.0001")
    }
    fewer = {
        (reading, dt): found[reading, dt] - found[reading, "0.02"]
        for reading, dt in found
        if dt != "0.02"
    }
    fixed = [fewer["fixed step", dt] for dt in ("0.001", "0.0001")]
    told = f"with fixed steps {fixed[0]} fewer columns fall at 0.02 s than at 1e-3 s and {fixed[1]}"
    assert f"{told} fewer than at 1e-4 s" in PAGE
    more = [fewer["rolling substeps", dt] for dt in ("0.001", "0.0001")]
    assert f"with rolling substeps {more[0]} fewer (p" in PAGE
    assert f"and {more[1]} fewer (p" in PAGE
    assert 0.4 < more[1] / fewer["fixed step", "0.0001"] < 0.6


def test_the_alpha_at_which_steps_differ_even_with_substeps():
    table = tables.read("paper_parts_overturned")
    place = table.columns.index("alpha -0.333")
    fallen = [
        next(row[place] for row in table.rows if row[0] == f"rolling substeps, {dt} s")
        for dt in ("0.02", "0.001")
    ]
    counts = [cell.partition(" of ")[0] for cell in fallen]
    p = pairs("paper_parts_steps", "rolling substeps, 0.02 and 0.001 s")["-0.333"][1]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    told = "At alpha -0.333 the two steps differ even with substeps"
    assert f"{told} ({counts[0]} and {counts[1]} fall, p < 0.001)" in readme and p <= 0.001


def swapped_p(differences):
    """Two-sided p of a sum of differences whose signs are as likely one way as the other, exact."""
    sizes = np.abs(differences)
    total = int(sizes.sum())
    chances = np.zeros(2 * total + 1)
    chances[total] = 1.0
    for size in sizes[sizes > 0]:
        chances = (np.roll(chances, size) + np.roll(chances, -size)) / 2
    sums = np.abs(np.arange(-total, total + 1))
    return chances[sums >= abs(int(np.sum(differences)))].sum()


def fewer_at_a_long_step(study, dt, alphas, motions):
    """Of each motion, columns of all alphas that fall at dt and not at 0.02 s, less the others."""
    found = np.zeros(len(motions), int)
    for alpha in alphas:
        long, short = (read_runs(f"{study}-{step}-{alpha}") for step in ("0.02", dt))
        found += [int(short[n]["overturned"]) - int(long[n]["overturned"]) for n in motions]
    return found


def test_fewer_falls_at_a_long_step_are_not_confirmed_by_more_motions():
    alphas, motions = ("0", "-0.05", "-0.1", "-0.2", "-0.333"), range(1, 116)
    p = {
        (study, dt): swapped_p(fewer_at_a_long_step(f"paper/{study}", dt, alphas, motions))
        for study in ("paper_study", "paper_parts")
        for dt in ("0.001", "0.0001")
    }
    assert max(p["paper_study", dt] for dt in ("0.001", "0.0001")) < 0.001
    told = [f"{p['paper_parts', dt]:.3f}" for dt in ("0.001", "0.0001")]
    assert "than at 1e-4 s (both p < 0.001); with rolling substeps" in PAGE
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    fell = [
        fewer_at_a_long_step(f"paper/{study}", "0.001", alphas, motions).sum()
        for study in ("paper_study", "paper_parts")
    ]
    fewer = f"{fell[0]} fewer of the {5 * len(motions)} columns fall at 0.02 s than at 1e-3 s (p <"
    assert fewer in readme and f"then {fell[1]} fewer fall (p {told[0]})" in readme
    assert f"fewer (p {told[0]}) and" in PAGE and f"fewer (p {told[1]}). This p swaps" in PAGE
    each = [
        fewer_at_a_long_step("decided/own_mesh", dt, ("0", "-0.2"), range(1, 1001))
        for dt in ("0.001", "0.0001")
    ]
    first, rest = (
        [int(part.sum()) for part in one] for one in zip(*((a[:115], a[115:]) for a in each))
    )
    told = f"in the first 115 motions {first[0]} fewer columns fall at 0.02 s than at 1e-3 s and"
    assert f"{told} {first[1]} fewer than at 1e-4 s" in PAGE
    assert f"in the other 885 motions {-rest[0]} and {-rest[1]} more fall" in PAGE
    assert "significant (p {:.2f} and {:.2f})".format(*map(swapped_p, each)) in PAGE


def test_substeps_take_a_part_of_the_effect_of_a_long_step_away():
    alphas, motions = ("0", "-0.05", "-0.1", "-0.2", "-0.333"), range(1, 116)
    drawn = np.random.default_rng(1).integers(0, len(motions), (20_000, len(motions)))
    p, share, ends = [], [], []
    for dt in ("0.001", "0.0001"):
        fixed, rolling = (
            fewer_at_a_long_step(f"paper/{study}", dt, alphas, motions)
            for study in ("paper_study", "paper_parts")
        )
        p.append(swapped_p(fixed - rolling))
        share.append(rolling.sum() / fixed.sum())
        left = rolling[drawn].sum(axis=1) / fixed[drawn].sum(axis=1)
        ends.append(np.percentile(left, (2.5, 97.5)))
    assert "a part of the effect away (p {:.3f} and {:.3f})".format(*p) in PAGE
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"The two ways differ significantly (p {p[0]:.3f})" in readme
    first, second = (f"{abs(low):.1f} to {high:.1f}" for low, high in np.round(ends, 1))
    told = f"leave is {share[0]:.2f} (95 % interval {first}, by drawing motions again)"
    assert f"{told} and {share[1]:.2f} ({second})" in PAGE


def test_what_rolling_leaves_of_finding_b_at_one_alpha():
    fewer = [
        fewer_at_a_long_step(f"paper/{study}", "0.0001", ("-0.2",), range(1, 116)).sum()
        for study in ("paper_study", "paper_parts")
    ]
    told = f"({fewer[0]} columns fewer with fixed steps, {fewer[1]} with rolling substeps)"
    assert told in PAGE and fewer[1] > fewer[0] / 2
    found = {
        steps: (
            pairs("paper_steps", f"fixed step, 0.02 and {steps} s")["-0.2"],
            pairs("paper_parts_steps", f"rolling substeps, 0.02 and {steps} s")["-0.2"],
        )
        for steps in ("0.001", "0.0001")
    }
    for fixed, rolling in found.values():
        assert f"{fixed[0]:.2f} with fixed steps, {rolling[0]:.2f} with rolling substeps)" in PAGE
    left = found["0.0001"][1]
    assert f"is not significant at this alpha (p {left[1]:.3f})" in PAGE and min(left[1:]) > 0.05


def test_claims_of_a_thousand_motions():
    here = verdicts("own_mesh_claims")
    assert here["b2"] == here["c"] == "supported" and here["b1"] == "not supported"
    assert "support claims b2 and c of the paper and do not support b1" in PAGE


def test_claims_of_more_motions_with_fixed_steps():
    found = verdicts("own_mesh_fixed_claims")
    assert found["b1"] == found["b2"] == "supported" and found["c"] == "not supported"
    assert "at alpha 0 and -0.2 alone [b2 is supported and c is not]" in PAGE
    table = tables.read("own_mesh_fixed")
    rows = {row[0]: dict(zip(table.columns, row)) for row in table.rows}
    short, shortest = (
        rows[f"dt_s = {dt}, alpha_hht = 0 and dt_s = {dt}, alpha_hht = -0.2"]
        for dt in ("0.001", "0.0001")
    )
    two = holm([float(one["p"]) for one in (short, shortest)])
    assert f"by Holm's rule for the two pairs of c {two[0]:.3f})" in PAGE and two[0] < 0.05
    assert short["overturned at the first"] == short["at the second"]
    assert f"as {short['at the second']} columns fall at either" in PAGE
    steps = [
        rows[f"dt_s = 0.001, alpha_hht = {a} and dt_s = 0.0001, alpha_hht = {a}"]
        for a in ("0", "-0.2")
    ]
    assert f"above {max(one['at most'] for one in steps)} is excluded" in PAGE
    long = [row for name, row in rows.items() if name.count("0.02,") == 1]
    assert len(long) == 4 and {row["verdict"] for row in long} == {"differ"}
    others = {row["verdict"] for row in rows.values() if row not in long}
    assert len(rows) == 9 and others == {"alike within 0.1"}


def test_alphas_with_rolling_substeps():
    least, flips = (
        min(float(p) for p in column("paper_parts_alphas", head).values())
        for head in ("least p", "least McNemar p")
    )
    assert f"(least p {least:.3f}, least McNemar's p {flips:.3f};" in PAGE
    assert min(30 * least, 30 * flips) > 0.05


def test_claims_of_the_paper_with_rolling_substeps():
    here = verdicts("paper_parts_claims")
    supported = {claim for claim, verdict in here.items() if verdict == "supported"}
    assert supported == {"a1", "a2, Δt", "a2, α", "b1", "d1"}
    assert here["d2"] == "not supported" and {here["b2"], here["c"]} == {"undecided"}
    found = {
        row.partition(", ")[2]: cell
        for row, cell in column("paper_parts_claims", "what was found").items()
    }
    assert "3 of 10 pairs differ" in found["b1"] and "b1 is supported by 3 of 10 pairs" in PAGE


def test_what_less_damping_costs():
    times = [
        float(re.search(r"changes by a factor of ([\d.]+)", column(name, "what was found")[row])[1])
        for name, row in (("paper_claims", "fixed step, d2"), ("paper_parts_claims", ROLLING_D2))
    ]
    told = "{} times as much at alpha 0 as at -0.333 with fixed steps, {} times with rolling"
    assert told.format(*times) in PAGE

    def iterations(study, dt, alpha):
        runs = read_runs(f"paper/{study}-{dt}-{alpha}").values()
        return np.mean([run["iterations"] / run["duration_s"] for run in runs])

    more = [
        100 * (iterations(study, dt, "0") / iterations(study, dt, "-0.333") - 1)
        for study in ("paper_study", "paper_parts")
        for dt in ("0.02", "0.001", "0.0001")
    ]
    assert f"differ by {min(more):.0f} to {max(more):+.0f} %" in PAGE


def test_steps_and_alphas_that_1000_motions_show_alike():
    verdicts = column("own_mesh", "verdict").values()
    assert set(verdicts) == {"alike within 0.1"} and len(verdicts) == 9
    bounds = [float(cell) for cell in column("own_mesh", "at most").values()]
    assert (
        f"in each a distance above {max(bounds):.3f} is excluded" in PAGE
        and "four of them with 640" in PAGE
    )
    assert sorted(column("own_mesh", "motions").values()) == ["1000"] * 5 + ["640"] * 4
    p = [float(cell) for cell in column("own_mesh", "p").values()]
    assert f"p = {min(p):.3f}, by Holm's rule for nine pairs {min(holm(p)):.2f}" in PAGE
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "With substeps and alpha 0 and -0.2, 640 to 1,000 motions exclude that any two" in readme
