"""The displacement at which a run that overturned or slid off stopped is no peak: no reader of
results may take it for one.

Two studies are alike but for that displacement, of millimetres in one and 17 m in the other.
Whatever is read from them must be the same.
"""

import csv
import io
import re

import numpy as np
import pytest
from synthetic_study import ALPHA, DT, SPECIMEN, write_synthetic

from fecolumn.cli import main
from fecolumn.statistics.correlation import correlation
from fecolumn.statistics.displacement_fragility import displacement
from fecolumn.statistics.ecdf import censored, ecdf, largest_peak, percentile
from fecolumn.statistics.ensemble import summarize
from fecolumn.statistics.equivalence import distance_bound
from fecolumn.statistics.sensitivity import sensitivity
from fecolumn.statistics.trend import trend
from fecolumn.study.conclusion import conclusion
from fecolumn.study.plan import read_plan
from fecolumn.study.report.incremental import incremental_curves
from fecolumn.study.report.page import write_report
from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.sample import read_sample
from fecolumn.study.store import read_study
from fecolumn.study.table import table_text, write_tables

AXES, MOTIONS = {DT: [0.02, 1e-3], ALPHA: [0, -0.2]}, 30


def stopped_at(u_max_m):
    """What is lost stopped here; every second of it did not overturn but slid off."""

    def also(values, summary):
        if not summary["overturned"]:
            return {}
        slid = int(values["motion.source"].rpartition(":")[2]) % 2 == 0
        return {"u_max_m": u_max_m, "overturned": not slid, "slid_off": slid} | (
            {"overturn_time_s": None} if slid else {}
        )

    return also


@pytest.fixture(scope="module")
def studies(tmp_path_factory):
    # in folders of one name: a page states it
    return [
        write_synthetic(
            tmp_path_factory.mktemp("lost") / "study", AXES, MOTIONS, also=stopped_at(u)
        )
        for u in (1e-3, 17.0)
    ]


def alike(studies, read):
    one, other = (read(folder) for folder in studies)
    assert one == other
    return one


def test_fixture_has_what_overturned_and_what_slid_off(studies):
    runs = [row["summary"] for row in read_study(studies[1]).rows]
    assert (
        sum(run["overturned"] for run in runs) > 3
        and sum(bool(run.get("slid_off")) for run in runs) > 3
    )
    assert max(run["u_max_m"] for run in runs) == 17.0


def test_tables_of_a_study_do_not_read_it(studies, tmp_path):
    def read(folder):
        plan, rows = read_plan(folder.parent / "study.toml"), read_study(folder).rows
        write_tables(plan, rows, tmp_path)
        return [(tmp_path / name).read_text() for name in ("table.csv", "analyses.csv")] + [
            table_text(plan, rows)
        ]

    *_, text = alike(studies, read)
    assert "slid off" in text and "17000" not in text


def test_the_conclusion_of_a_study_does_not_read_it(studies):
    assert "P(overturn)" in alike(
        studies,
        lambda folder: conclusion(read_plan(folder.parent / "study.toml"), read_study(folder).rows),
    )


def test_compare_does_not_read_it_and_parts_what_overturned_from_what_slid_off(
    studies, tmp_path, capsys
):
    def read(folder):
        a, b = (f"{folder}@{DT}={dt},{ALPHA}=0" for dt in (0.02, 1e-3))
        assert main(["compare", a, b, "-o", str(tmp_path / folder.parents[1].name)]) == 0
        written = tmp_path / folder.parents[1].name
        said = capsys.readouterr().out.split("(reference)")[1].partition("wrote")[0]
        return [said, *((written / name).read_text() for name in ("comparison.csv", "pairs.csv"))]

    said, quantities, pairs = alike(studies, read)
    values, rows = (
        dict(csv.reader(io.StringIO(quantities))),
        list(csv.DictReader(io.StringIO(pairs))),
    )
    fell, slid = (
        sum(row[f"{name}_a"] == "1" for row in rows) / len(rows)
        for name in ("overturned", "slid_off")
    )
    assert 0 < fell and 0 < slid
    assert float(values["p_overturn_a"]) == pytest.approx(fell) and float(
        values["p_lost_a"]
    ) == pytest.approx(fell + slid)
    assert f"{100 * fell:.1f} %" in said.partition("P(lost")[0]
    assert "P(lost: overturned or slid off)" in said and f"{100 * (fell + slid):.1f} %" in said


def test_samples_of_a_study_hold_no_peak_of_what_is_lost(studies):
    for folder in studies:
        sample = read_sample(f"{folder}@{DT}=0.02,{ALPHA}=0")
        assert 0 < sample.slid_off.sum() < sample.lost.sum()
        np.testing.assert_array_equal(np.isnan(sample.u_max), sample.lost)


@pytest.mark.long
def test_the_report_does_not_read_it_in_any_table_figure_or_sentence(studies):
    def read(folder):
        page = write_report(folder, files=())
        files = {
            file.name: re.sub(rb"<dc:date>.*?</dc:date>", b"", file.read_bytes())
            for part in ("tables", "figures")
            for file in (page.parent / part).iterdir()
        }
        return {name: content for name, content in files.items() if name != "provenance.csv"}

    files = alike(studies, read)
    assert {"p_overturn.csv", "motions.csv", "ranking.csv", "trends.csv", "comparisons.csv"} <= set(
        files
    )


@pytest.mark.long
def test_the_report_calls_lost_what_it_counts_as_lost(studies):
    page = (write_report(studies[0], files=()).parent / "index.html").read_text()
    words = re.sub(r"<[^>]+>", "", page)
    assert "a distribution ends at 1 − P(lost: overturned or slid off)" in words
    runs = read_sweep(studies[0]).reference.column("overturned")
    assert (
        f"{100 * runs.mean():.1f}"
        in re.search(r"0\.001\ss, α\s=\s−0\.2\s+it\s+is\s+([0-9.]+)", words)[1]
    )


U, LOST = (
    np.array([0.01, 0.03, 0.02, 0.05, 0.04, 0.09]),
    np.array([False, False, False, False, True, True]),
)
OTHER = np.where(LOST, 17.0, U)
B, B_LOST = U[::-1].copy(), LOST[::-1].copy()
READERS = {
    "ecdf": lambda u: ecdf(u, LOST).x.tolist(),
    "percentile": lambda u: percentile(u, LOST, fraction=0.5),
    "censored": lambda u: censored(u, LOST).tolist(),
    "largest_peak": lambda u: largest_peak((u, LOST)),
    "summarize": lambda u: summarize(u, LOST, np.zeros(6), np.zeros(6)),
    "distance_bound": lambda u: distance_bound(u, LOST, B, B_LOST),
    "correlation": lambda u: correlation(u, LOST, B, B_LOST),
    "trend": lambda u: trend([u, B], [LOST, B_LOST]),
    "sensitivity": lambda u: sensitivity([u], [LOST], [B], [B_LOST], resamples=50),
    "displacement fragility": lambda u: displacement(
        np.arange(1.0, 7.0), u, LOST
    ).coefficients.tolist(),
    "incremental curves": lambda u: [
        curve.u_at([1.5, 2.5]).tolist()
        for curve in incremental_curves(
            np.array(list("aabbcc")), np.array([1, 2, 1, 2, 1, 2.0]), u, LOST
        )
    ],
}


@pytest.mark.parametrize("name", READERS)
def test_statistics_do_not_read_it(name):
    assert repr(READERS[name](U)) == repr(READERS[name](OTHER))


@pytest.mark.long
def test_a_study_that_cuts_its_motions_short_says_so_wherever_it_is_read(tmp_path, capsys):
    folder = write_synthetic(
        tmp_path / "study",
        {DT: [0.02, 1e-3]},
        12,
        also=lambda values, summary: {"motion_cut_at_s": 1.0},
    )
    runs = [row["summary"] for row in read_study(folder).rows]
    said = (
        f"{sum(not run['overturned'] for run in runs)} of 24 analyses cut their motion "
        "short, at 1 s by integration.duration_s"
    )
    words = re.sub(
        r"<[^>]+>", "", (write_report(folder, files=()).parent / "index.html").read_text()
    )
    assert words.count(said) == 2  # at the top, and in the audit
    assert main(["compare", *(f"{folder}@{DT}={dt}" for dt in (0.02, 1e-3))]) == 0
    assert "A: " in (out := capsys.readouterr().out) and "analyses cut their motion short" in out


def test_motions_cut_short_are_said_before_a_study_runs(tmp_path):
    from fecolumn.study.run import check_motions

    times = np.arange(101) * 0.01
    np.savetxt(
        tmp_path / "shake.csv",
        np.column_stack([times, np.sin(9 * times)]),
        delimiter=",",
        comments="",
        header="time [s],ax [m/s2]",
    )
    (tmp_path / "study.toml").write_text(
        f'[case]\nextends = "{SPECIMEN}"\n[axes]\n"integration.duration_s" = [0.4, '
        '3.0]\n"motion.source" = ["shake.csv"]\n'
    )
    with pytest.warns(
        UserWarning,
        match=r"duration_s = 0.4 s cuts the motion short, which lasts 1 s.*\(1 of 2 analyses "
        r"are cut\)",
    ):
        check_motions(read_plan(tmp_path / "study.toml"))
