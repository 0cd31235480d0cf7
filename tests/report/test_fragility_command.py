"""fecolumn fragility: of a table, of a study, over one measure and two."""

import csv

import numpy as np
import pytest
from scipy.special import ndtr
from synthetic_study import write_synthetic

from fecolumn.cli import main
from fecolumn.statistics.fragility import logit, lognormal
from fecolumn.statistics.intensity_table import IntensityTable
from fecolumn.study.report.fragility_command import _write


def rows(file):
    with open(file) as text:
        return list(csv.DictReader(text))


@pytest.fixture
def table(tmp_path):
    """120 runs of 30 records at four scales, whose chance to fall rises with pgv and falls with
    pga.
    """
    rng = np.random.default_rng(3)
    record = np.repeat(np.arange(30), 4)
    pgv = np.tile([0.2, 0.4, 0.8, 1.6], 30) * rng.lognormal(0, 0.2, 30)[record]
    pga = pgv * 10 * rng.lognormal(0, 0.5, 120)
    fallen = rng.random(120) < 1 / (1 + np.exp(-(2.0 + 3.0 * np.log(pgv) - 1.0 * np.log(pga / 10))))
    file = tmp_path / "runs.csv"
    file.write_text(
        "# of a test\nrecord,pgv_m_s,pga_m_s2,overturned,u_max_mm\n"
        + "".join(
            f"r{r},{v:.8g},{a:.8g},{int(over)},10\n"
            for r, v, a, over in zip(record, pgv, pga, fallen)
        )
    )
    return file, np.round(pgv, 8), np.round(pga, 8), fallen, record


def test_one_measure_gives_the_lognormal_curve_with_intervals_that_count_records(
    tmp_path, table, capsys
):
    file, pgv, _, fallen, record = table
    assert main(["fragility", str(file), "--im", "pgv_m_s", "-o", str(tmp_path / "out")]) == 0
    (row,) = rows(tmp_path / "out" / "fragility.csv")
    fit, naive = lognormal(pgv, fallen, record), lognormal(pgv, fallen)
    assert (
        float(row["median_pgv_m_s"]) == pytest.approx(fit.median, rel=1e-4)
        and row["records"] == "30"
        and row["n"] == "120"
    )
    ends = [float(row["median_low"]), float(row["median_high"])]
    assert ends == pytest.approx(fit.median_interval(), rel=1e-4)
    assert fit.median_interval() != pytest.approx(naive.median_interval(), rel=1e-3)
    low, high = fit.median_interval()
    told = f"reach the limit at pgv_m_s = {fit.median:.3g}, 95 % interval {low:.3g} to {high:.3g}"
    assert told in capsys.readouterr().out
    assert (tmp_path / "out" / "fragility.png").stat().st_size > 5000


def test_two_measures_give_coefficients_and_contours(tmp_path, table):
    file, pgv, pga, fallen, record = table
    assert (
        main(
            [
                "fragility",
                str(file),
                "--im",
                "pgv_m_s",
                "--im",
                "pga_m_s2",
                "-o",
                str(tmp_path / "out"),
            ]
        )
        == 0
    )
    (row,) = rows(tmp_path / "out" / "fragility.csv")
    fit = logit(np.column_stack([pgv, pga]), fallen, record)
    assert [float(row[name]) for name in ("c0", "c_pgv_m_s", "c_pga_m_s2")] == pytest.approx(
        fit.coefficients, rel=1e-3
    )
    assert fit.coefficients[1] > 0 > fit.coefficients[2] and float(row["p_pgv_m_s"]) < 1e-6
    assert (tmp_path / "out" / "fragility.png").stat().st_size > 5000


def test_band_over_two_measures_is_wider_where_records_repeat_alike(table):
    _, pgv, pga, fallen, _ = table
    im, twice = np.column_stack([pgv, pga]), np.tile(np.arange(120), 2)
    one = logit(im, fallen, np.arange(120))
    doubled = logit(np.tile(im, (2, 1)), np.tile(fallen, 2), twice)
    assert doubled.coefficients == pytest.approx(one.coefficients, rel=1e-6)
    # every run twice tells nothing more
    assert doubled.covariance == pytest.approx(one.covariance, rel=1e-6)
    assert doubled.probability([[0.5, 5.0]]).upper == pytest.approx(
        one.probability([[0.5, 5.0]]).upper, rel=1e-6
    )


@pytest.mark.long
def test_study_gives_a_curve_for_each_setting(tmp_path, capsys):
    peaks = np.linspace(0.5, 5.0, 30)
    pulses = tmp_path / "p30.h5"
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
                str(pulses),
            ]
        )
        == 0
    )
    out = write_synthetic(
        tmp_path / "s",
        {"motion.scale": [0.5, 1.0, 2.0], "contact.friction_coefficient": [0.3, 0.8]},
        0,
        sources=[f"{pulses}#{number}" for number in range(1, 31)],
        effect=lambda values: values["motion.scale"],
    )
    assert main(["fragility", str(out), "--im", "pga_m_s2", "-o", str(tmp_path / "out")]) == 0
    found = rows(tmp_path / "out" / "fragility.csv")
    assert len(found) == 2 and all(row["n"] == "90" and row["records"] == "30" for row in found)
    assert {"0.3", "0.8"} == {row["setting"].split()[-1] for row in found}


@pytest.mark.parametrize(
    "text, options, said",
    [
        ("pgv,overturned\n1,0\n2,1\n3,0\n4,1\n5,x\n", [], "line 6, overturned = 'x'"),
        (
            "pgv,overturned\n1,0\n-2,1\n",
            ["--im", "pgv"],
            "line 3, pgv = '-2': must be a number greater than 0",
        ),
        ("pgv,fell\n1,0\n", [], "must have one column overturned"),
        ("a,b,c,overturned\n1,2,3,0\n2,3,5,1\n", [], "choose one or two of a, b, c"),
        ("pgv,overturned\n1,0\n2,0\n3,1\n4,1\n", [], "bound no fragility"),
        (
            "pgv,overturned\n1,0\n2,1\n",
            ["--im", "pgv", "--im", "pgv"],
            "must be one measure, or two different ones",
        ),
    ],
)
def test_table_that_cannot_be_used_is_refused_in_a_line(tmp_path, capsys, text, options, said):
    (tmp_path / "runs.csv").write_text(text)
    assert (
        main(["fragility", str(tmp_path / "runs.csv"), *options, "-o", str(tmp_path / "out")]) == 2
    )
    assert said in capsys.readouterr().err


@pytest.mark.long
@pytest.mark.parametrize("fails", [(), (0, 31)])  # a motion at rest and another
def test_motions_at_scale_0_have_no_intensity_and_are_left_out(tmp_path, capsys, fails):
    pulses, hazard = tmp_path / "p12.h5", tmp_path / "hazard.csv"
    make = ["motions", "make", "pulses", "symmetric_ricker", "--periods", "0.5", "--amplitudes"]
    assert main([*make, *map(str, np.linspace(0.5, 5.0, 12)), "-o", str(pulses)]) == 0
    hazard.write_text("pga_m_s2,annual_frequency\n0.1,0.1\n100,1e-8\n")
    sources, found = [f"{pulses}#{number}" for number in range(1, 13)], []
    for name, scales in (("with", [0.0, 0.5, 1.0, 2.0]), ("without", [0.5, 1.0, 2.0])):
        left = tuple(place - (12 if name == "without" else 0) for place in fails)
        study = write_synthetic(
            tmp_path / name,
            {"motion.scale": scales},
            0,
            sources=sources,
            effect=lambda values: values["motion.scale"],
            fails=[place for place in left if place >= 0],
        )
        for command in (["fragility", "--im", "pga_m_s2"], ["risk", "--hazard", str(hazard)]):
            out = tmp_path / f"{name}_{command[0]}"
            capsys.readouterr()
            assert main([command[0], str(study), *command[1:], "-o", str(out)]) == bool(fails)
            told = "of 48 analyses are left out: their motions have no pga_m_s2 above 0"
            at_rest = 12 - (len(fails) > 0)
            error = capsys.readouterr().err
            if fails:
                told = told.replace("48", "46")
            assert (f"{at_rest} {told}" in error) == (name == "with")
            found.append((out / f"{command[0]}.csv").read_text())
    assert found[:2] == found[2:]


def test_study_of_motions_at_rest_alone_is_refused(tmp_path, capsys):
    pulses = str(tmp_path / "p2.h5")
    make = ["motions", "make", "pulses", "symmetric_ricker", "--periods", "0.5", "--amplitudes"]
    assert main([*make, "1", "2", "-o", pulses]) == 0
    study = write_synthetic(
        tmp_path / "s", {"motion.scale": [0.0]}, 0, sources=[f"{pulses}#1", f"{pulses}#2"]
    )
    assert main(["fragility", str(study), "-o", str(tmp_path / "out")]) == 2
    assert "none of its 2 motions has pgv_m_s above 0" in capsys.readouterr().err


def test_refusal_of_a_risk_names_its_event(tmp_path, capsys):
    pulses, hazard = str(tmp_path / "p6.h5"), tmp_path / "hazard.csv"
    make = ["motions", "make", "pulses", "symmetric_ricker", "--periods", "0.5", "--amplitudes"]
    assert main([*make, *"123456", "-o", pulses]) == 0
    hazard.write_text("pga_m_s2,annual_frequency\n0.1,0.1\n100,1e-8\n")
    sources = [f"{pulses}#{number}" for number in range(1, 7)]
    study = write_synthetic(
        tmp_path / "s", {"motion.scale": [1.0]}, 0, sources=sources, effect=lambda values: 1e-6
    )
    ask = ["risk", str(study), "--hazard", str(hazard), "-o", str(tmp_path / "out"), "--event"]
    for event, said in (
        ("top > 50 mm", "none of 6 runs are beyond the limit: that bounds P(top > 50 mm), but no"),
        ("overturn", "none of 6 runs overturned: that bounds P(overturn), but no curve"),
    ):
        assert main([*ask, event]) == 2
        assert said in capsys.readouterr().err


@pytest.mark.parametrize("levels", [7, 8])
def test_figure_that_has_not_all_settings_says_so(tmp_path, capsys, levels):
    rng = np.random.default_rng(1)
    im = rng.lognormal(0, 1, 40)
    fallen = rng.random(40) < ndtr(np.log(im))
    tables = {f"mu = {k}": IntensityTable({"pga_m_s2": im}, fallen, None) for k in range(levels)}
    _write(tables, tmp_path, "study")
    said = "the figure has 7 of 8 settings; fragility.csv has all"
    assert (said in capsys.readouterr().out) == (levels == 8)
    assert len(rows(tmp_path / "fragility.csv")) == levels
