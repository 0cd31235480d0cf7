"""Incremental dynamic analysis in the report: the same motions at several scales."""

import csv
import re

import numpy as np
import pytest
from synthetic_study import SPECIMEN, write_synthetic
from test_page import report

from fecolumn.cli import main
from fecolumn.statistics.fragility import lognormal
from fecolumn.study.report.incremental import incremental
from fecolumn.study.report.intensity import Intensities
from fecolumn.study.report.sweep import read_sweep

SCALES, FRICTION = [0.25, 0.5, 1.0, 2.0, 4.0], "contact.friction_coefficient"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Twenty pulses at five scales and two coefficients of friction; peaks grow with the scale,
    without scatter of their own.
    """
    folder = tmp_path_factory.mktemp("ida")
    peaks = np.linspace(0.5, 5.0, 20)
    assert (
        main(
            [
                "motions",
                "make",
                "pulses",
                "symmetric_ricker",
                "--amplitudes",
                *map(str, peaks),
                "--periods",
                "0.5",
                "-o",
                str(folder / "p20.h5"),
            ]
        )
        == 0
    )
    sources = [f"{folder / 'p20.h5'}#{number}" for number in range(1, 21)]
    return write_synthetic(
        folder / "study",
        {"motion.scale": SCALES, FRICTION: [0.3, 0.8]},
        0,
        sources=sources,
        scatter=0.0,
        effect=lambda values: values["motion.scale"] * (0.5 + values[FRICTION]),
    )


@pytest.fixture(scope="module")
def page(study):
    return report(study)


def table(study, name):
    with open(study / "report" / "tables" / f"{name}.csv") as file:
        return list(csv.DictReader(file))


def test_section_has_curves_laws_and_tables(study, page):
    assert (
        "Incremental dynamic analysis" in page.text
        and "each of 20 motions scaled to 5 levels" in page.text
    )
    assert "No motion lets the column stand again" in page.text
    assert {
        "figure-ida",
        "figure-first_overturning",
        "table-first_overturnings",
        "table-ida_motions",
    } <= set(page.ids)
    assert all(
        (study / "report" / "figures" / f"ida.{kind}").stat().st_size > 1000
        for kind in ("png", "pdf", "svg")
    )
    assert not re.search(r"\bnan\b|\bNone\b|\binf\b|\[\[|\]\]", page.text)


def test_first_overturning_of_every_motion_is_that_of_its_summaries(study, page):
    runs = [
        (setting.values, motion, run)
        for setting in read_sweep(study).done
        for motion, run in setting.runs.items()
    ]
    rows = table(study, "ida_motions")
    assert len(rows) == 40
    for row in rows:
        own = {
            values["motion.scale"]: run["overturned"]
            for values, motion, run in runs
            if values[FRICTION] == float(row[FRICTION]) and motion.strip("[]'") == row["motion"]
        }
        fallen = [scale for scale, over in own.items() if over]
        if fallen:
            assert float(row["pgv_overturned_m_s"]) / float(row["pgv_stood_m_s"] or "inf") in (
                0.0,
                2.0,
            )
        assert bool(row["pgv_overturned_m_s"]) == bool(fallen)


def test_a_column_that_slips_less_overturns_at_less_and_each_motion_counts_once(study, page):
    rows = table(study, "first_overturnings")
    assert [int(row["motions"]) for row in rows] == [20, 20] and [
        int(row["runs"]) for row in rows
    ] == [100, 100]
    medians = [float(row["median_pgv_m_s"]) for row in rows]
    assert medians[0] / medians[1] == pytest.approx(1.3 / 0.8, rel=0.3)
    for row in rows:
        low, median, high = (
            float(row[name]) for name in ("median_low", "median_pgv_m_s", "median_high")
        )
        assert low < median < high


def test_fragility_over_the_scales_knows_that_its_runs_repeat_twenty_motions(study, page):
    row = table(study, "fragilities")[0]
    sweep = read_sweep(study)
    runs = Intensities(sweep.folder).of_runs(
        [setting for setting in sweep.done if setting.values[FRICTION] == 0.3]
    )
    alone = lognormal(runs.measures[:, 0], runs.overturned).median_interval()
    assert int(row["n"]) == 100 and int(row["records"]) == 20
    assert float(row["median_high"]) / float(row["median_low"]) > 1.15 * alone[1] / alone[0]
    assert "count records and not runs" in page.text


def test_two_scales_are_no_incremental_analysis(tmp_path):
    sweep = read_sweep(write_synthetic(tmp_path, {"motion.scale": [1.0, 2.0]}, 5))
    assert incremental(sweep, None, Intensities(sweep.folder)) is None and SPECIMEN.is_file()


@pytest.fixture(scope="module")
def both_ways(tmp_path_factory, study):
    """The same pulses at scales of both signs, and at rest."""
    pulses = study.parent.parent / "p20.h5"
    return write_synthetic(
        tmp_path_factory.mktemp("both"),
        {"motion.scale": [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0]},
        0,
        sources=[f"{pulses}#{number}" for number in range(1, 21)],
        scatter=0.0,
        effect=lambda values: abs(values["motion.scale"]),
    )


@pytest.mark.long
def test_scales_of_both_signs_are_two_motions_of_a_record(both_ways):
    page = report(both_ways)
    assert "each of 40 motions of 20 records scaled to 3 levels" in page.text
    assert page.text.count("20 runs of motions without intensity, at scale 0, are left out") == 2
    rows = table(both_ways, "ida_motions")
    assert len(rows) == 40 and all(row["scales"] == "3" for row in rows)
    forth = [row for row in rows if not row["motion"].endswith(", reversed")]
    back = {row["motion"]: row for row in rows}
    assert len(forth) == 20
    for row in forth:
        other = back[f"{row['motion']}, reversed"]
        assert other["pgv_overturned_m_s"] == row["pgv_overturned_m_s"]
    (row,) = table(both_ways, "first_overturnings")
    assert (row["motions"], row["records"], row["runs"]) == ("40", "20", "120")
    assert table(both_ways, "fragilities")[0]["n"] == "120"


def test_what_is_wrong_in_a_section_is_no_motion_that_is_not_found(study, monkeypatch):
    """A section is left out where motions are not to be found, and for nothing else."""

    def broken(*_):
        raise ValueError("not of a motion")

    sweep = read_sweep(study)
    monkeypatch.setattr("fecolumn.study.report.incremental.incremental_curves", broken)
    with pytest.raises(ValueError, match="not of a motion"):
        incremental(sweep, None, Intensities(sweep.folder))
