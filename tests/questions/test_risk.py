"""fecolumn risk: the closed form of a lognormal fragility and a power law, what is carried through,
and what cannot be used.
"""

import csv
import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.special import ndtr

from fecolumn.cli import main
from fecolumn.statistics.fragility import DegenerateData, lognormal
from fecolumn.statistics.hazard import (
    HazardCurve,
    annual_frequency,
    lognormal_probabilities,
    probability_in_years,
    probit_probabilities,
    stated_region,
)
from fecolumn.statistics.hazard_table import read_hazard

K0, K = 2e-4, 2.5


def power_law(low, high, points):
    im = np.geomspace(low, high, points)
    return HazardCurve("pga_m_s2", im, K0 * im**-K)


@pytest.mark.parametrize("beta", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("points", [2, 40])
def test_lognormal_fragility_and_power_law_have_the_closed_form(beta, points):
    median = 3.0
    found = annual_frequency(power_law(1e-4, 1e5, points), lognormal_probabilities(median, beta))
    exact = K0 * median**-K * math.exp(0.5 * (K * beta) ** 2)
    assert found.value == pytest.approx(exact, rel=1e-7)
    assert found.parts.sum() == pytest.approx(exact, rel=1e-7)
    assert found.below < 1e-3 and found.beyond < 1e-9 * exact


def test_deaggregation_is_the_lognormal_of_the_closed_form():
    """P(x) |dL| is, in ln x, a normal density integrated by parts: the share of failures above x
    has a closed form, too.
    """
    median, beta, curve = 3.0, 0.4, power_law(1e-3, 1e3, 3)
    found = annual_frequency(curve, lognormal_probabilities(median, beta))
    x = found.edges[1:-1]
    # integral from x to infinity, by parts: P(x) L(x) + integral of L dP
    z = np.log(x / median) / beta
    exact = K0 * median**-K * math.exp(0.5 * (K * beta) ** 2)
    above = ndtr(z) * K0 * x**-K + exact * ndtr(-(z + K * beta))
    # bins take whole points of the quadrature
    assert found.parts[0][::-1].cumsum()[::-1][1:] == pytest.approx(above, rel=0.08)


def test_step_fragility_gives_the_hazard_at_the_step():
    curve = power_law(0.5, 50, 5)  # the step is at one of its points
    found = annual_frequency(curve, lambda im: (np.asarray(im) > 5.0).astype(float))
    assert found.value[0] == pytest.approx(float(curve.at(5.0)), rel=1e-8)
    assert probability_in_years(0.01, 50) == pytest.approx(1 - math.exp(-0.5))


def hazard_file(folder, text, name="hazard.csv"):
    (folder / name).write_text(text)
    return folder / name


def runs_file(folder, n=200, median=3.0, beta=0.5):
    rng = np.random.default_rng(5)
    im = np.exp(rng.normal(math.log(3.0), 0.8, n))
    fallen = rng.random(n) < ndtr(np.log(im / median) / beta)
    rows = "".join(f"{a:.8g},{int(over)}\n" for a, over in zip(im, fallen))
    (folder / "runs.csv").write_text("pga_m_s2,overturned\n" + rows)
    return folder / "runs.csv", np.array([float(f"{a:.8g}") for a in im]), fallen


def rows(file):
    with open(file) as text:
        return list(csv.DictReader(text))


POWER = "pga_g,annual_frequency\n" + "".join(
    f"{im:.10g},{K0 * (im * 9.80665) ** -K:.10g}\n" for im in np.geomspace(1e-3, 100, 30)
)


def test_runs_give_the_frequency_and_the_ends_over_the_region_of_their_curve(tmp_path, capsys):
    runs, im, fallen = runs_file(tmp_path)
    hazard = hazard_file(tmp_path, "# of a test\n" + POWER)
    out = tmp_path / "out"
    assert main(["risk", str(runs), "--hazard", str(hazard), "-o", str(out)]) == 0
    (row,) = rows(out / "risk.csv")
    fit = lognormal(im, fallen)

    def exact(median, beta):
        return K0 * median**-K * np.exp(0.5 * (K * beta) ** 2)

    assert float(row["annual_frequency"]) == pytest.approx(exact(fit.median, fit.beta), rel=1e-4)
    a, b = fit.region().T
    ends = np.quantile(exact(np.exp(-a / b), 1 / b), (0.0, 1.0))
    assert [
        float(row["annual_frequency_low"]),
        float(row["annual_frequency_high"]),
    ] == pytest.approx(ends, rel=1e-3)
    assert row["years"] == "50" and float(row["probability"]) == pytest.approx(
        1 - math.exp(-50 * float(row["annual_frequency"])), rel=1e-4
    )
    parts = rows(out / "deaggregation.csv")
    assert sum(float(one["share"]) for one in parts) == pytest.approx(1, abs=1e-4)
    assert all(one["pga_m_s2_to"] == later["pga_m_s2_from"] for one, later in pairwise(parts))
    assert "% [" in capsys.readouterr().out
    assert (out / "risk.png").stat().st_size > 5000


def test_what_fragility_wrote_will_do(tmp_path):
    runs, *_ = runs_file(tmp_path)
    hazard = hazard_file(tmp_path, POWER)
    assert main(["fragility", str(runs), "--im", "pga_m_s2", "-o", str(tmp_path / "f")]) == 0
    for source, out in ((runs, "a"), (tmp_path / "f" / "fragility.csv", "b")):
        out = str(tmp_path / out)
        assert main(["risk", str(source), "--hazard", str(hazard), "-o", out]) == 0
    (a,), (b,) = rows(tmp_path / "a" / "risk.csv"), rows(tmp_path / "b" / "risk.csv")
    assert float(a["annual_frequency"]) == pytest.approx(float(b["annual_frequency"]), rel=1e-3)
    for end in ("annual_frequency_low", "annual_frequency_high"):
        assert float(a[end]) == pytest.approx(float(b[end]), rel=0.25)


FRAGILITY = (
    "setting,n,records,overturned,median_pga_m_s2,median_low,median_high,beta,beta_low,beta_high\n"
    "all,120,40,37,7.8,6.9,8.9,0.41,0.28,0.60\n"
)


def test_a_fragility_of_an_earlier_version_gives_the_same_risk(tmp_path):
    """Its columns low and high are median_low and median_high."""
    hazard, found = hazard_file(tmp_path, POWER), []
    older = FRAGILITY.replace("median_low,median_high", "low,high")
    for name, text in (("now", FRAGILITY), ("older", older)):
        file = hazard_file(tmp_path, text, f"{name}.csv")
        out = tmp_path / name
        assert main(["risk", str(file), "--hazard", str(hazard), "-o", str(out)]) == 0
        found.append((out / "risk.csv").read_text())
    assert older != FRAGILITY and found[0] == found[1]


@pytest.mark.parametrize("event, said", [("slide > 5 mm", "must be overturn with"), ("banana", "")])
def test_a_fragility_of_overturning_answers_no_other_event(tmp_path, capsys, event, said):
    hazard, file = hazard_file(tmp_path, POWER), hazard_file(tmp_path, FRAGILITY, "fragility.csv")
    words = ["risk", str(file), "--hazard", str(hazard), "-o", str(tmp_path / "out")]
    assert main([*words, "--event", event]) == 2
    error = capsys.readouterr().err
    assert f"--event = {event!r}: {said}" in error and error.count("\n") == 1


@pytest.mark.long
@pytest.mark.parametrize(
    "old, new, said",
    [
        (",37,", ",121,", "line 2, overturned = '121': must be at most n = 120"),
        (",40,", ",140,", "line 2, records = '140': must be at most n = 120"),
        (
            ",37,",
            ",0,",
            "line 2, overturned = '0': must be at least 1: none that overturned bounds",
        ),
        (",37,", ",3.7,", "line 2, overturned = '3.7': must be a whole number of at least 0"),
        ("all,120", "all,-120", "line 2, n = '-120': must be a whole number"),
    ],
)
def test_fragility_table_of_impossible_counts_is_refused(tmp_path, capsys, old, new, said):
    hazard, out = hazard_file(tmp_path, POWER), str(tmp_path / "out")
    file = hazard_file(tmp_path, FRAGILITY, "whole.csv")
    assert main(["risk", str(file), "--hazard", str(hazard), "-o", out]) == 0
    file = hazard_file(tmp_path, FRAGILITY.replace(old, new), "fragility.csv")
    capsys.readouterr()
    assert main(["risk", str(file), "--hazard", str(hazard), "-o", out]) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1


@pytest.mark.long
@pytest.mark.parametrize("n, median, beta", [(40, 3.0, 0.5), (150, 3.0, 0.5), (115, 8.0, 0.5)])
def test_interval_holds_the_true_frequency_as_often_as_it_says(n, median, beta):
    """A bootstrap of whole runs held it in 82 of 100 ensembles of 40 runs."""
    rng, curve, inside = np.random.default_rng(2), power_law(0.05, 100, 20), []
    truth = annual_frequency(curve, lognormal_probabilities(median, beta)).value[0]
    while len(inside) < 300:
        im = np.exp(rng.normal(math.log(3.0), 0.7, n))
        fallen = rng.random(n) < ndtr(np.log(im / median) / beta)
        try:
            fit = lognormal(im, fallen)
        except DegenerateData:
            continue
        found = annual_frequency(curve, probit_probabilities(fit.region())).value
        best = annual_frequency(curve, lognormal_probabilities(fit.median, fit.beta)).value[0]
        assert found.min() < best < found.max()
        inside.append(found.min() <= truth <= found.max())
    assert np.mean(inside) >= 0.95 - 3 * math.sqrt(0.05 * 0.95 / 300)


def test_stated_region_has_the_stated_ends_and_holds_its_value():
    lines = stated_region((7.8, 6.9, 8.9), (0.41, 0.28, 0.60), 3601)
    a, b = lines.T
    assert np.exp(-a / b).min() == pytest.approx(6.9, rel=1e-5)
    assert np.exp(-a / b).max() == pytest.approx(8.9, rel=1e-5)
    assert (1 / b).min() == pytest.approx(0.28, rel=1e-5)
    assert (1 / b).max() == pytest.approx(0.60, rel=1e-5)


def test_interval_of_a_median_that_is_not_bounded_is_not_drawn_from(tmp_path, capsys):
    hazard, out = hazard_file(tmp_path, POWER), str(tmp_path / "out")
    file = hazard_file(tmp_path, FRAGILITY.replace(",8.9,", ",inf,"), "fragility.csv")
    assert main(["risk", str(file), "--hazard", str(hazard), "-o", out]) == 2
    told = capsys.readouterr().err
    assert "median_high = 'inf': must be a number above 0" in told and "table of runs" in told


def test_runs_whose_median_is_not_bounded_have_a_fragility_and_a_risk(tmp_path, capsys):
    """Eight of 115 overturn, hardly more often at strong motions: exp of the error of ln median
    was beyond any number, and the estimate outside of the interval of the frequency.
    """
    rng = np.random.default_rng(3)
    im = np.sort(np.exp(rng.normal(math.log(3.0), 0.5, 115)))
    fallen = np.isin(np.arange(115), (5, 21, 44, 62, 75, 83, 98, 112))
    lines = "".join(f"{a:.8g},{int(over)}\n" for a, over in zip(im, fallen))
    (tmp_path / "runs.csv").write_text("pga_m_s2,overturned\n" + lines)
    runs, out = str(tmp_path / "runs.csv"), tmp_path / "f"
    assert main(["fragility", runs, "--im", "pga_m_s2", "-o", str(out)]) == 0
    (row,) = rows(out / "fragility.csv")
    assert row["median_high"] == row["beta_high"] == "inf"
    assert 0 < float(row["median_low"]) < float(row["median_pga_m_s2"]) < math.inf
    hazard = hazard_file(tmp_path, POWER)
    assert main(["risk", runs, "--hazard", str(hazard), "-o", str(tmp_path / "r")]) == 0
    (row,) = rows(tmp_path / "r" / "risk.csv")
    low, best, high = (float(row[f"annual_frequency{end}"]) for end in ("_low", "", "_high"))
    assert 0 < low < best < high < math.inf


def test_units_and_kinds_of_hazard_are_one_curve(tmp_path):
    frequency = -math.log(1 - 0.1) / 50
    texts = (
        f"pga_g,annual_frequency\n0.1,{frequency!r}\n0.5,1e-5\n",
        f"pga_cm_s2,return_period_years\n98.0665,{1 / frequency!r}\n490.3325,100000\n",
        f"probability_50_years,pga_m_s2\n0.1,0.980665\n{-math.expm1(-5e-4)!r},4.903325\n",
    )
    texts += (
        texts[0].replace(",", ";").replace(".", ","),
        texts[0].replace(",", "\t").replace(".", ","),
        f'"pga_g","annual_frequency"\n"0,1","{frequency!r}"\n"0,5","1e-5"\n',
    )
    for text in texts:
        curve = read_hazard(hazard_file(tmp_path, text))
        assert curve.measure == "pga_m_s2"
        assert curve.im == pytest.approx([0.980665, 4.903325])
        assert curve.frequency == pytest.approx([frequency, 1e-5])


OPENQUAKE = (
    "#,,,,,\"generated_by='OpenQuake engine 3.16.3', start_date='2026-01-01', checksum=1, "
    "kind='mean', investigation_time=50.0, imt='PGA'\"\n"
    "lon,lat,depth,poe-0.0050000,poe-0.0500000,poe-0.5000000,poe-2.0000000\n"
    "8.5,47.3,0.0,1.0,4.0E-01,5.0E-03,0.0\n9.0,47.3,0.0,9.0E-01,3.0E-01,4.0E-03,1.0E-07\n"
)


def test_export_of_openquake_is_read(tmp_path):
    file = hazard_file(tmp_path, OPENQUAKE)
    first, second = read_hazard(file), read_hazard(file, 2)
    assert first.im == pytest.approx(9.80665 * np.array([0.05, 0.5]))
    assert first.frequency == pytest.approx(-np.log1p(-np.array([0.4, 5e-3])) / 50)
    assert second.im.size == 4
    # what comes less often than anybody knows is never, as 0 is
    file = hazard_file(tmp_path, OPENQUAKE.replace("1.0E-07", "1.0E-12"))
    assert read_hazard(file, 2).im.size == 3


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_export_of_openquake_is_read_as_other_programs_save_it(tmp_path, encoding):
    text = OPENQUAKE.replace("kind='mean'", "kind='mean', of='Zürich'").replace("=50.0", "=5.0e+1")
    (tmp_path / "hazard.csv").write_bytes(text.encode(encoding))
    curve = read_hazard(tmp_path / "hazard.csv")
    assert curve.frequency == pytest.approx(-np.log1p(-np.array([0.4, 5e-3])) / 50)


def test_time_of_openquake_may_have_a_negative_exponent(tmp_path):
    curve = read_hazard(hazard_file(tmp_path, OPENQUAKE.replace("=50.0", "=5000.0e-2")))
    assert curve.frequency == pytest.approx(-np.log1p(-np.array([0.4, 5e-3])) / 50)


@pytest.mark.parametrize(
    "text, said",
    [
        (None, "absent.csv: no such file"),
        ("", "holds no line below its header"),
        ("pga_g,rate\n0.1,1e-2\n", "must be a column of the intensity"),
        ("pga,annual_frequency\n0.1,1e-2\n0.2,1e-3\n", "header = 'pga': must end in its unit"),
        ("pga_kg,annual_frequency\n0.1,1e-2\n0.2,1e-3\n", "must end in its unit"),
        ("pga_g,annual_frequency\n0.2,1e-3\n0.1,1e-2\n", "line 3, pga_g = 0.1: must be larger"),
        ("pga_g,annual_frequency\n0.1,1e-3\n0.2,1e-2\n", "line 3, annual_frequency = '1e-2'"),
        ("pga_g,annual_frequency\n0.1,-1e-3\n0.2,1e-4\n", "line 2, annual_frequency = '-1e-3'"),
        ("pga_g,annual_frequency\n-0.1,1e-3\n0.2,1e-4\n", "line 2, pga_g = '-0.1': must be a num"),
        ("pga_g,annual_frequency\n0.1,nan\n0.2,1e-4\n", "line 2, annual_frequency = 'nan'"),
        ("pga_g,annual_frequency\n0.1,1_0\n0.2,1e-4\n", "line 2, annual_frequency = '1_0'"),
        ("pga_g,annual_frequency\n0.1,1e-3\n", "has 1 intensities"),
        ("pga_g,annual_frequency\n0.1,1e-3,4\n", "has 3 columns where the header has 2"),
        ("pga_g,probability_50_years\n0.1,10\n0.2,2\n", "a share, not percent"),
        ("pga_g,probability_0_years\n0.1,0.1\n0.2,0.02\n", "more than 0 years"),
        (OPENQUAKE.replace("'PGA'", "'SA(0.5)'"), "imt = 'SA(0.5)': must be one of PGA, PGV"),
        (OPENQUAKE.replace("#,", "x,"), "has 7 columns where the header has 6"),
        (OPENQUAKE.replace("poe-2.0", "poe-300.0"), "= 'poe-300.0000000': must be at most 100: is"),
        (
            OPENQUAKE.replace("PGA", "PGV").replace("poe-2.0", "poe-20000.0"),
            "= 'poe-20000.0000000': must be at most 1e+04: is",
        ),
        (OPENQUAKE.replace("4.0E-01", "1.4"), "poe-0.0500000 = '1.4': must be at most 1"),
        ("sa1_g,annual_frequency\n0.1,1e-2\n0.2,1e-3\n", "must have one column sa1_m_s2"),
        (
            "pga_g,annual_frequency\n0.1,1e-2\n981,1e-3\n",
            "line 3, pga_g = '981': must be at most 1",
        ),
        (
            "pga_gal,annual_frequency\n0.1,1e-2\n99000,1e-3\n",
            "pga_gal = '99000': must be at most 9",
        ),
        (
            "pga_g,annual_frequency\n0.1,475\n0.2,1e-3\n",
            "= '475': must lie in [1e-12, 100] a year;",
        ),
        ("pga_g,annual_frequency\n0.1,1\n0.2,1e-13\n", "line 3, annual_frequency = '1e-13': must"),
        ("pga_g,return_period_years\n0.1,1e-3\n0.2,9\n", "must lie in [0.01, 1e+12] years"),
        ("pga_g,probability_50_years\n0.1,0.1\n0.2,1e-12\n", "is 2e-14 a year, which must lie in"),
    ],
)
def test_hazard_that_cannot_be_used_is_refused_in_a_line(tmp_path, capsys, text, said):
    runs, *_ = runs_file(tmp_path, 60)
    file = tmp_path / "absent.csv" if text is None else hazard_file(tmp_path, text)
    assert main(["risk", str(runs), "--hazard", str(file), "-o", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "options, said",
    [
        (["--years", "-1"], "--years = -1.0: must be greater than 0"),
        (["--site", "2"], "--site = 2: is for a file of OpenQuake"),
        (["--event", "top > 5 mm"], "tells of overturning alone"),
        (["--event", "top > 5 lb"], "'lb' is no unit of top"),
    ],
)
def test_options_that_cannot_be_used_are_refused_in_a_line(tmp_path, capsys, options, said):
    runs, *_ = runs_file(tmp_path, 60)
    hazard, out = hazard_file(tmp_path, POWER), str(tmp_path / "out")
    assert main(["risk", str(runs), "--hazard", str(hazard), *options, "-o", out]) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1


def test_runs_that_bound_no_curve_are_refused(tmp_path, capsys):
    (tmp_path / "runs.csv").write_text("pga_m_s2,overturned\n1,0\n2,0\n3,1\n4,1\n")
    hazard, out = hazard_file(tmp_path, POWER), str(tmp_path / "out")
    assert main(["risk", str(tmp_path / "runs.csv"), "--hazard", str(hazard), "-o", out]) == 2
    assert "bound no fragility over pga_m_s2" in capsys.readouterr().err


def test_frequency_of_nothing_has_no_middle_half(tmp_path, capsys):
    hazard, out = hazard_file(tmp_path, POWER), str(tmp_path / "out")
    far = FRAGILITY.replace("7.8,6.9,8.9", "7.8e20,6.9e20,8.9e20").replace(
        "0.41,0.28,0.60", "0.2,0.1,0.3"
    )
    file = hazard_file(tmp_path, far, "fragility.csv")
    assert main(["risk", str(file), "--hazard", str(hazard), "-o", out]) == 0
    said = capsys.readouterr().out
    assert "frequency of 0 [0, 0] a year" in said and "half of it" not in said
    assert "in 50 years (95 % intervals).\n" in said


def test_curve_that_ends_too_soon_or_begins_too_late_is_told(tmp_path, capsys):
    runs, *_ = runs_file(tmp_path)
    lines = POWER.splitlines()
    for part, said in (
        (lines[1:15], "above the hazard curve's last"),
        (lines[16:], "the hazard curve begins at"),
    ):
        hazard = hazard_file(tmp_path, "\n".join([lines[0], *part]) + "\n")
        assert main(["risk", str(runs), "--hazard", str(hazard), "-o", str(tmp_path / "out")]) == 0
        assert said in capsys.readouterr().err


def test_frequency_from_intensities_that_no_run_had_is_told(tmp_path, capsys):
    runs, im, _ = runs_file(tmp_path, median=3.0)
    lines = [line for line in runs.read_text().splitlines()[1:] if float(line.split(",")[0]) > 2.5]
    runs.write_text("\n".join(["pga_m_s2,overturned", *lines]) + "\n")
    hazard = hazard_file(tmp_path, POWER)
    assert main(["risk", str(runs), "--hazard", str(hazard), "-o", str(tmp_path / "out")]) == 0
    assert "comes from intensities that no run had" in capsys.readouterr().err
    (row,) = rows(tmp_path / "out" / "risk.csv")
    assert float(row["outside_runs_share"]) > 0.1


@pytest.mark.long
def test_folder_of_a_study_is_asked_for_any_limit_state(tmp_path, capsys):
    """Runs of pulses of two periods: the fragility and the frequency of the folder are those of
    its own runs.
    """
    amplitudes = [f"{one:g}" for one in np.linspace(1.5, 9.0, 16)]
    pulses = tmp_path / "p.h5"
    arguments = ["--amplitudes", *amplitudes, "--periods", "0.5", "1.0", "-o", str(pulses)]
    assert main(["motions", "make", "pulses", "symmetric_ricker", *arguments]) == 0
    (tmp_path / "study.toml").write_text(
        "[case.block]\nwidth_m = 0.4\nheight_m = 2.0\n[case.integration]\ndt_s = 0.005\n"
        f'[axes]\n"motion.source" = ["{pulses}#*"]\n'
    )
    out = tmp_path / "study"
    assert main(["study", str(tmp_path / "study.toml"), "-o", str(out), "-j", "1"]) == 0
    hazard = hazard_file(tmp_path, POWER)
    found = {}
    for limit in ("top > 100 mm", "top > 250 mm"):
        folder = tmp_path / limit.split()[2]
        options = ["--hazard", str(hazard), "--event", limit, "-o", str(folder)]
        assert main(["risk", str(out), *options]) == 0
        (row,) = rows(folder / "risk.csv")
        found[limit] = float(row["annual_frequency"])
        assert (
            float(row["annual_frequency_low"])
            <= found[limit]
            <= float(row["annual_frequency_high"])
        )
    assert found["top > 100 mm"] > found["top > 250 mm"] > 0
    assert main(["risk", str(out), "--hazard", str(hazard), "--event", "slide > 5 mm", "-o", "x"])
    assert "holds no slide of engine 'housner'" in capsys.readouterr().err
