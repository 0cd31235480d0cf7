"""Motions that are one record in several directions count as that record, wherever a study says how
sure something is.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.conclusion import conclusion, records_of, settings_of
from fecolumn.study.plan import read_plan, record_of
from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.results.study import StudyResult
from fecolumn.study.sample import read_sample
from fecolumn.study.sequential import Rule, judge, progress_text, stage_analyses, stages
from fecolumn.study.setting_pairs import pairs_of
from fecolumn.study.store import read_study
from fecolumn.study.table import table_text, write_tables

CASE = Path(__file__).parents[2] / "meshes" / "stout.toml"
DT = "integration.dt_s"
DIRECTIONS = list(range(0, 180, 20))


def turned(folder, records, directions=DIRECTIONS):
    """Plan of a study of so many records, each in several directions, at two time steps."""
    folder.mkdir(exist_ok=True)
    names = ", ".join(f'"pulse:{number}"' for number in range(records))
    (folder / "study.toml").write_text(
        f'title = "turned"\ncase = "{CASE}"\n[axes]\n"{DT}" = [0.001, 0.002]\n'
        f'"motion.source" = [{names}]\n"motion.rotation_deg" = {directions}\n'
    )
    return read_plan(folder / "study.toml")


def rows_of(plan, seed=0):
    """A round column's results: they know nothing of the direction."""
    rng = np.random.default_rng(seed)
    found = {}
    for analysis in plan.analyses:
        key = analysis.values[DT], analysis.values["motion.source"]
        if key not in found:
            found[key] = float(np.exp(rng.normal()))
    rows = []
    for analysis in plan.analyses:
        peak = found[analysis.values[DT], analysis.values["motion.source"]]
        summary = {
            "u_max_m": peak,
            "overturned": peak > 1.5,
            "energy_closure_rel": 0.0,
            "s_per_step": 1e-3,
            "wall_s": 1.0,
            "steps": 10,
            "residual_slide_m": 0.0,
        }
        rows.append(
            {"id": analysis.id, "state": "done", "axes": analysis.values, "summary": summary}
        )
    return rows


@pytest.mark.parametrize(
    "values, record",
    [
        ({"motion.source": "lick:1", "motion.rotation_deg": 20, DT: 1e-3}, "lick:1||"),
        ({"motion.source": "x.csv", "motion.source_y": "y.csv", "motion.scale": 2}, "x.csv|y.csv|"),
        ({"motion": {"source": "lick:2", "rotation_deg": 5}}, "lick:2||"),
        ({"motion.rotation_deg": 20}, "||"),
    ],
)
def test_record_is_the_files_whatever_is_done_to_them(values, record):
    assert record_of(values) == record


def test_conclusion_of_records_turned_is_that_of_the_records(tmp_path):
    many, one = turned(tmp_path / "many", 8), turned(tmp_path / "one", 8, [0])
    said, alone = conclusion(many, rows_of(many)), conclusion(one, rows_of(one))
    assert "The 72 runs are of 8 records" in said and "records" not in alone
    assert "With 8 records a KS distance below" in said and "With 8 motions a KS" in alone
    pairs = [
        pairs_of(settings_of(plan, rows_of(plan)), records_of(plan))[0] for plan in (many, one)
    ]
    assert (pairs[0].n, pairs[0].records, pairs[1].n, pairs[1].records) == (72, 8, 8, 8)
    assert pairs[0].p == pairs[1].p
    assert pairs[0].bound == pytest.approx(pairs[1].bound, rel=1e-9)
    # the shares with their intervals are the same but for the counts
    shares = [text.split(" at ")[0] for text in (said, alone)]
    assert shares[0] == shares[1] and "[" in shares[0]


def test_four_records_in_many_directions_are_too_few_for_a_conclusion(tmp_path):
    plan = turned(tmp_path, 4)
    assert conclusion(plan, rows_of(plan)) == ""


def test_table_counts_runs_and_records(tmp_path):
    many, one = turned(tmp_path / "many", 8), turned(tmp_path / "one", 8, [0])
    text = table_text(many, rows_of(many))
    assert text.splitlines()[0].split()[:3] == ["dt_s", "n", "records"]
    assert text.splitlines()[1].split()[1:3] == ["72/72", "8"]
    assert "records" not in table_text(one, rows_of(one))
    for plan, place in ((many, tmp_path / "many"), (one, tmp_path / "one")):
        write_tables(plan, rows_of(plan), place)
    of_many, of_one = (
        list(csv.DictReader((tmp_path / name / "table.csv").open())) for name in ("many", "one")
    )
    for row, other in zip(of_many, of_one, strict=True):
        assert (row["n"], row["records"]) == ("72", "8") and other["records"] == other["n"] == "8"
        for key in ("p_overturn", "wilson_low", "wilson_high", "exact_low", "exact_high"):
            assert float(row[key]) == pytest.approx(float(other[key]), abs=2e-6), key


def test_stages_are_of_whole_records(tmp_path):
    plan = turned(tmp_path, 50, [0, 90])
    assert stages(plan, Rule()) == [40, 50]
    first = stage_analyses(plan, 40, [])
    assert len(first) == 40 * 2 * 2
    verdicts = judge(plan, rows_of(plan), Rule(), [40, 50], 50, [])
    assert verdicts[0].text(Rule()).endswith("N = 100 of 50 records")
    assert progress_text(50, verdicts).startswith("50 records: ")
    with pytest.raises(InputError, match="has 40 motions of 2 records; deciding begins with 40 re"):
        stages(turned(tmp_path / "two", 2, list(range(0, 180, 9))), Rule())


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Wobbling columns, round: eight motions in three directions at two scales."""
    place = tmp_path_factory.mktemp("turned")
    (place / "study.toml").write_text(
        """title = "turned"
[case.column]
shape = "solid"
outer_diameter_m = 0.22
height_m = 2.0
[case.integration]
engine = "wobbling"
[axes]
"motion.source" = ["lick:1-8"]
"motion.rotation_deg" = [0, 40, 80]
"motion.scale" = [2.2, 2.6, 3.0]
"""
    )
    out = place / "out"
    assert main(["study", str(place / "study.toml"), "-o", str(out), "-q", "-j", "1"]) == 0
    return out


def test_compare_swaps_whole_records(folder, tmp_path, capsys):
    a, b = f"{folder}@motion.scale=2.2", f"{folder}@motion.scale=3"
    assert main(["compare", a, b, "-o", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "24 motions of 8 records in both" in said and "all p count records" in said
    assert read_sample(a).records[:2] == ("lick:1||", "lick:1||")
    first = f"{folder}@motion.scale=2.2,motion.rotation_deg=0"
    other = f"{folder}@motion.scale=3,motion.rotation_deg=0"
    assert main(["compare", first, other, "-o", str(tmp_path / "one")]) == 0
    assert "records" not in capsys.readouterr().out
    many, one = (
        dict(csv.reader((tmp_path / name / "comparison.csv").open())) for name in ("out", "one")
    )
    assert (many["n_a"], many["records_a"], one["records_a"]) == ("24", "8", "8")
    assert float(many["paired_p"]) == float(one["paired_p"])
    assert float(many["mcnemar_p"]) == pytest.approx(float(one["mcnemar_p"]))
    assert float(many["ks_p"]) == pytest.approx(float(one["ks_p"]), abs=0.03)


def test_distribution_of_a_result_has_the_band_of_its_records(folder):
    found = StudyResult(folder).ecdf({"motion.scale": 3.0})
    assert (found.n, found.records) == (24, 8)
    assert found.lost_interval == pytest.approx(proportion_interval(found.lost // 3, 8))


@pytest.mark.long
def test_report_counts_records(folder):
    sweep = read_sweep(folder)
    assert len(sweep.motions) == 24 and len(set(sweep.records)) == 8
    assert len(read_study(folder).rows) == 72
    page = StudyResult(folder).report()
    text = page.read_text()
    assert "24 ground motions of 8 records were run" in text
    assert "each of 24 motions of 8 records scaled to 3 levels" in text
    row = next(csv.DictReader((page.parent / "tables" / "first_overturnings.csv").open()))
    assert (row["motions"], row["records"]) == ("24", "8")
    # what eight motions in one direction give
    low, high = float(row["median_low"]), float(row["median_high"])
    assert (low, high) == pytest.approx((0.230, 0.336), abs=1e-3)
