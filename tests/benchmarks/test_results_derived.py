"""Other numbers of RESULTS.md that follow from several cells: each is computed from them."""

import re

import numpy as np
import pytest
from results_page import PAGE, ROOT, column, manual
from scipy.stats import binomtest

from benchmarks import tables
from benchmarks.fragility.report import beside, lost
from benchmarks.fragility.run import kept_name
from benchmarks.fragility.structures import COLUMN, DRUMS
from benchmarks.impact.kept_map import kept_cells
from benchmarks.tables.runs import read_runs
from fecolumn.case.sections import GRAVITY
from fecolumn.statistics.holm import holm
from fecolumn.verification.multi_drum import OUTCOMES


def pairs_of_programs(structure, *labels):
    """Cells of the pairs of these programs on a structure, by head."""
    table = tables.read("programs_pairs")
    wanted = {f"{structure}: {a} and {b}" for a in labels for b in labels}
    return [dict(zip(table.columns, row)) for row in table.rows if row[0] in wanted]


def test_programs_that_are_not_told_apart():
    best = "MuJoCo, best", "Siconos, best of the tube", "fecolumn, rigid, short steps"
    found = [float(pair["p"]) for pair in pairs_of_programs("tube", *best)]
    assert len(found) == 3 and min(found) > 0.71 and "not told apart (p at least 0.71)" in PAGE
    peers = "MuJoCo, best", "MuJoCo, defaults", "Siconos, best", "Siconos, defaults"
    p = {name: float(column("programs", "p")[f"trilith: {name}"]) for name in peers}
    assert min(p.values()) == p["Siconos, defaults"] > 0.05
    assert max(p.values()) == p["MuJoCo, defaults"]


def test_shake_table_draws():
    p = column("shake_table_pairs", "p (McNemar)").values()
    assert sum(float(one) < 0.05 for one in p) == 3 and "three are told from it" in PAGE
    few = tables.read("shake_table_reliability").rows[0]
    assert (
        f"of the {few[1]} tests to which they give at most 0.05, {100 * float(few[3]):.1f} %"
        in PAGE
    )
    brier = float(column("shake_table_brier", "Brier's score")["one draw, mean"])
    assert f"One draw is right in {1 - brier:.3f} in the mean" in PAGE
    table = tables.read("shake_table")
    ours, best = (
        next(row for row in table.rows if row[0] == name)
        for name in ("fecolumn", "discrete elements, KN=10 KS=1")
    )
    misses, alarms = (
        table.columns.index(head) for head in ("predicted to stand", "stood: predicted to overturn")
    )
    fell = int(ours[misses - 1]) + int(ours[misses])
    told = f"it misses more falls ({ours[misses]} of {fell}; theirs {best[misses]}) and has fewer"
    assert f"{told} false alarms ({ours[alarms]}; theirs {best[alarms]})" in PAGE
    low = tables.read("shake_table_reliability").rows[:5]
    assert all(float(row[3]) > float(row[2]) for row in low) and low[-1][0].endswith("to 0.8")
    assert f"of the {low[0][1]} tests to which they give at most 0.05" in PAGE
    assert f"{100 * float(low[0][3]):.1f} % did" in PAGE


def test_elastic_monoliths_that_walk_before_rigid_ones_lift():
    width, height = COLUMN
    weak = [
        run
        for run in read_runs("fragility/elastic-monolith").values()
        if run["pga_m_s2"] < GRAVITY * width / height
    ]
    told = f"In {sum(run['shift_m'] > 1e-3 for run in weak)} of {len(weak)} motions too weak"
    assert told in PAGE


def test_map_of_impacts():
    soft = [
        100 * one["half_width"] / one["loss"]
        for one in kept_cells()
        if one["group"] == 1e3 and one["ratio"] in (7, 10)
    ]
    told = f"the means of H/B 7 and 10 are uncertain by {min(soft):.0f} to {max(soft):.0f} %"
    assert told in PAGE
    stiff = [one for one in kept_cells() if one["group"] >= 1e6]
    low, high = np.quantile([one["loss"] for one in stiff], [0.25, 0.75])
    most = max(one["loss"] for one in stiff if one["ratio"] <= 3)
    told = f"the middle half of the cells loses {low:.2f} to {high:.2f} of Housner's loss"
    assert f"{told}, and those of H/B 2 and 3 up to {most:.1f} times" in PAGE
    assert f"of 180 cells {len(kept_cells())} have a value" in PAGE
    means = [
        np.mean([one["loss"] for one in stiff if one["group"] == group])
        for group in (1e6, 1e7, 1e8)
    ]
    told = "means of {:.2f}, {:.2f} and {:.2f} of it at 1e6, 1e7 and 1e8".format(*means)
    assert told in PAGE and max(means) < 0.8


def test_cost_of_shaken_structures():
    rigid, elastic, soft, stiff = (
        np.array([float(cell) for cell in column("shaken", head).values()])
        for head in ("rigid [us]", "ten modes [us]", "MuJoCo [us]", "MuJoCo, stiff [us]")
    )
    cheaper = int((rigid < soft).sum())
    assert cheaper == 5 and "in five of eight rows" in PAGE
    drums = list(column("shaken", "rigid [us]")).index("drums of 8, shaken by 1.5 of uplift")
    assert round(rigid[drums] / soft[drums]) == 10 and round(rigid[drums] / stiff[drums]) == 3
    assert "ten times as much, three times what MuJoCo takes at these stiff settings" in PAGE
    released = list(column("shaken", "rigid [us]")).index("drums of 8, let go")
    assert f"let go cost {rigid[released] / soft[released]:.1f} times as much" in PAGE
    frame = list(column("shaken", "rigid [us]")).index("frame of 4, shaken by 1.5 of uplift")
    assert f"frame shaken by 1.5 of uplift {rigid[frame] / soft[frame]:.1f} times." in PAGE
    best = np.array([float(cell) for cell in column("shaken", "MuJoCo, best [us]").values()])
    stands = [
        row.endswith(("0.1 of uplift", "0.5 of uplift"))
        for row in column("shaken", "closure, rigid")
    ]
    dearer = (best / rigid)[stands]
    assert f"at {dearer.min():.0f} to {dearer.max():.0f} times their cost" in PAGE
    still = np.array([float(cell) for cell in column("shaken", "peak, MuJoCo, best [m]").values()])
    ours = np.array([float(cell) for cell in column("shaken", "peak, rigid [m]").values()])
    assert (still[stands] < 2 * ours[stands]).all()
    weak = [shaken.endswith("0.1 of uplift") for shaken in column("shaken", "rigid [us]")]
    ratio = elastic / rigid
    assert 2 <= ratio[weak].min() and ratio[weak].max() <= 3
    standing = list(column("shaken", "rigid [us]")).index("drums of 8, shaken by 0.5 of uplift")
    rest = np.delete(ratio, [*np.flatnonzero(weak), standing])
    assert round(rest.min()) == 8 and round(rest.max()) == 27
    assert "eight to twenty-seven times where feet open, slip, lift and land" in PAGE
    moved = [
        1e3 * float(cell)
        for row, cell in column("shaken", "peak, MuJoCo [m]").items()
        if row.endswith(("0.1 of uplift", "0.5 of uplift"))
    ]
    assert f"should stand by {min(moved):.1f} to {max(moved):.1f} mm" in PAGE


def test_models_agree_more_often_than_by_chance():
    share = {name: float(p) / 100 for name, p in column("models_beside", "P [%]").items()}
    (full,) = [name for name in share if "(full)" in name]
    chance = [
        100 * (share[full] * p + (1 - share[full]) * (1 - p))
        for name, p in share.items()
        if name != full
    ]
    assert f"would agree on {min(chance):.0f} to {max(chance):.0f} %" in PAGE
    agree = [
        float(one) for one in column("models_beside", "same outcome [%]").values() if one != "-"
    ]
    assert f"on more than {max(agree):.0f} % of the outcomes" in PAGE
    motions = int(column("models_beside", "motions")[full])
    here, other = (
        [int(cell) for cell in column("models_beside", head).values() if cell != "-"]
        for head in ("overturn in it alone", "in the other alone")
    )
    flips = [binomtest(a, a + b).pvalue for a, b in zip(here, other, strict=True)]
    assert len(flips) == 4 and f"by Holm's rule for four pairs {min(holm(flips)):.3f})" in PAGE
    for same, by_chance in zip(agree, chance, strict=True):
        same_outcomes = round(same * motions / 100)
        assert binomtest(same_outcomes, motions, by_chance / 100, "greater").pvalue < 0.05


def test_podium_claims_and_slenderness():
    words = {2: "two", 3: "three"}
    verdicts = list(column("podium", "verdict").values())
    counts = [words[verdicts.count(one)] for one in ("supported", "not supported", "undecided")]
    told = "podium structures {} are supported here, {} are not and {} stay undecided"
    assert told.format(*counts) in PAGE
    ours = column("podium", "here")["p1"]
    distances = re.findall(r"0\.\d{3}", ours.partition("Distance")[2])
    assert f"at most {max(distances)} apart" in PAGE
    ratios = [
        float(ratio)
        for kind in ("one-sine", "one-cosine")
        for ratio in column("design_slenderness", f"{kind}: formula over computed").values()
    ]
    less = [100 * (1 - ratio) for ratio in ratios if ratio < 1]
    assert len(ratios) == 10 and len(less) == 9 and "in nine of ten places" in PAGE
    assert f"{min(less):.0f} to {max(less):.0f} % less than [the computed block]" in PAGE
    exact = column("design_slenderness", "rectangular: formula over exact").values()
    less = [100 * (1 - float(ratio)) for ratio in exact]
    assert f"{min(less):.0f} to {max(less):.0f} % less than a rectangular pulse needs" in PAGE
    rectangular = column("design_slenderness", "rectangular: exact")
    for kind in ("one-sine", "one-cosine"):
        computed = column("design_slenderness", f"{kind}: computed")
        assert all(float(rectangular[at]) >= float(need) for at, need in computed.items())


def test_lost_structures_that_are_not_told_apart():
    p = {pair: float(cell) for pair, cell in column("fragility_pairs", "p (McNemar)").items()}
    corrected = dict(zip(p, holm(list(p.values()))))
    for pair in [pair for pair in p if "elastic" in pair]:
        assert p[pair] > 0.05
    told = {pair for pair in p if corrected[pair] < 0.05 and "monolith" not in pair}
    many = {f"{few} drums and {more} drums" for few in (2, 3, 4) for more in (7, 8)}
    assert told == many | {"3 drums and 5 drums", "3 drums and 6 drums"}
    assert min(many, key=p.get) == "3 drums and 8 drums"
    assert max(many, key=p.get) == "4 drums and 8 drums"
    assert f"not told apart by Holm's rule for {len(p)} pairs" in PAGE
    beside_drums = [p[f"monolith and {drums} drums"] for drums in DRUMS if drums > 1]
    assert f"(McNemar's p at most {max(beside_drums):.2g})" in PAGE


def test_drums_beside_the_monolith_by_pulse_period():
    runs = {
        name: [run | dict(motion=motion) for motion, run in read_runs(kept_name(name)).items()]
        for name in ("monolith", *(f"{drums} drums" for drums in DRUMS if drums > 1))
    }

    def within(name, low, high):
        return [run for run in runs[name] if low <= run["pulse_period_s"] < high]

    def alone(low, high):
        found = [
            beside(within("monolith", low, high), within(name, low, high))[1:]
            for name in runs
            if name != "monolith" and runs[name]
        ]
        monolith, drums, p = zip(*found)
        return monolith, drums, [float(one) for one in p]

    monolith, drums, p = alone(0, 1)
    short = within("monolith", 0, 1)
    told = f"Of the {len(short)} motions with pulses below 1 s {sum(map(lost, short))} lose the"
    assert told in PAGE and max(monolith) == 1 and max(p) < 0.001
    assert f"{min(drums)} to {max(drums)} lose a column of drums alone, at most one the" in PAGE
    monolith, drums, p = alone(2.5, np.inf)
    assert min(p) > 0.05
    told = f"With pulses of 2.5 s and more, {len(within('monolith', 2.5, np.inf))} motions"
    assert told in PAGE
    told = f"{min(monolith)} to {max(monolith)} lose the monolith alone, {min(drums)} to"
    assert f"{told} {max(drums)} the drums alone" in PAGE


def test_pushes_of_the_front_page_are_those_that_verify_checks():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    stood = max(a for a, falls in OUTCOMES[0.1].items() if not falls)
    fell = min(a for a, falls in OUTCOMES[0.1].items() if falls)
    assert f"They stand at {stood} g and fall at {fell} g" in text


def falls_at(bands, a):
    """Whether a [g] lies in one of the bands of a cell such as "4.14, 4.24-4.28, from 4.32"."""
    for band in bands.split(", "):
        low, _, high = band.removeprefix("from ").partition("-")
        top = np.inf if band.startswith("from ") else float(high or low)
        if float(low) - 1e-9 <= a <= top + 1e-9:
            return True
    return False


def test_pushes_that_verify_checks_lie_in_the_bands_of_the_scan():
    bands = column("drums_pushed", "fecolumn, falls at [g]")
    for tp, outcomes in OUTCOMES.items():
        for a, falls in outcomes.items():
            assert falls_at(bands[f"{tp:g}"], a) == falls, (tp, a)


def test_drums_of_which_least_and_most_still_rock():
    rocking = {
        name: int(cell) for name, cell in column("fragility", "still rocking at the end").items()
    }
    drums = {name: n for name, n in rocking.items() if name.endswith("drums") and "el" not in name}
    assert min(drums, key=drums.get) == "3 drums" and max(drums, key=drums.get) == "8 drums"


def test_modes_that_an_impact_needs_on_the_page_of_theory():
    mean = {
        series: float(cell.partition(" ")[0])
        for series, cell in column("impact_means", "1e-05 s").items()
        if cell
    }
    names = "reduced, 30 modes", "reduced engine", "reduced, 300 modes"
    more = [mean[name] / mean["full order"] - 1 for name in names]
    assert more == pytest.approx([1 / 4, 1 / 6, 0.05], abs=0.03)
    told = (
        "30 modes lose a quarter more than full order, 100 modes a sixth more, 300 modes 5 % more"
    )
    assert told in manual("theory")


def test_pages_of_the_manual_repeat_numbers_of_results():
    told = re.search(r"(\d+) fewer of 575 analyses .* \((\d+) fewer with", manual("quick-start"))
    fixed, rolling = f"with fixed steps {told[2]} fewer columns", f"substeps {told[1]} fewer (p"
    assert fixed in PAGE and rolling in PAGE
    rigid = column("programs", "p")["trilith: fecolumn, rigid"]
    assert f"from those at 1e-3 s (p = {rigid})" in manual("structures")


def test_no_group_of_stiffness_and_slenderness_describes_all_impacts():
    cells = kept_cells()
    loss, group, ratio = (
        np.array([one[name] for one in cells], float) for name in ("loss", "group", "ratio")
    )
    left = []
    for k in range(9):
        group_k = np.log10(group * ratio ** (1 - k))  # S (B/H)^k of S (B/H)
        curve = np.polyval(np.polyfit(group_k, loss, 3), group_k)
        left.append(np.sqrt(np.mean((curve - loss) ** 2)))
    told = f"misses them by {min(left):.2f} to {max(left):.2f} of Housner's loss (root mean square)"
    assert f"{told}, their mean by {np.std(loss):.2f}." in PAGE


def test_a_term_of_the_stiffness_does_not_help_the_formula_of_impacts():
    cells = [one for one in kept_cells() if one["group"] >= 1e5]
    loss = np.array([one["loss"] for one in cells], float)
    shapes = sorted({one["shape"] for one in cells})
    columns = np.array(
        [[*(one["shape"] == shape for shape in shapes), 1 / one["ratio"]] for one in cells],
        float,
    )
    stiffness = np.log10([[one["group"]] for one in cells])

    def left(columns):
        return np.sqrt(np.mean((columns @ np.linalg.lstsq(columns, loss, None)[0] - loss) ** 2))

    assert left(columns) - left(np.hstack([columns, stiffness])) < 0.001
    assert "a term in the logarithm of the stiffness takes less than 0.001 from this error" in PAGE
