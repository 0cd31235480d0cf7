"""Motions for a target spectrum: factors and sets with closed forms, the command, refusals."""

import csv

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.motions.ensemble_file import read_ensemble
from fecolumn.motions.spectra import horizontal_spectrum
from fecolumn.motions.spectral_match import (
    TargetSpectrum,
    distance_of_set,
    misfits,
    read_target_spectrum,
    scale_factors,
    select_motions,
)

PERIODS = np.geomspace(0.1, 2.0, 20)
TARGET = "period_s,sa_g,sigma_ln\n0.05,0.6,0.3\n0.1,1,0.3\n0.2,1,0.3\n0.5,0.3,0.4\n1,0.1,0.5\n"


def test_a_spectrum_of_the_targets_shape_is_scaled_to_it_exactly():
    target = 3.0 / PERIODS
    spectra = np.array([0.5 * target, 4.0 * target])
    factors = scale_factors(spectra, target)
    np.testing.assert_allclose(factors, [2.0, 0.25], rtol=1e-14)
    np.testing.assert_allclose(misfits(spectra * factors[:, None], target), 0.0, atol=1e-14)


def test_no_other_factor_fits_better_by_least_squares_of_logarithms():
    rng = np.random.default_rng(1)
    target, spectra = 3.0 / PERIODS, rng.uniform(0.5, 5.0, (3, 20))
    factors = scale_factors(spectra, target)
    best = misfits(spectra * factors[:, None], target)
    for other in (0.99, 1.01):
        assert (misfits(other * spectra * factors[:, None], target) > best).all()


def test_the_set_that_has_mean_and_dispersion_is_found_among_others():
    """Eight spectra whose logarithms have the target's mean and standard deviation exactly, hidden
    among 60 that are far.
    """
    rng = np.random.default_rng(2)
    sigma, median = 0.4, 3.0 / PERIODS
    normal = rng.normal(size=8)
    normal = (normal - normal.mean()) / normal.std(ddof=1)
    hidden = median * np.exp(sigma * normal[:, None])
    others = median * np.exp(1.5 + 0.2 * rng.normal(size=(60, 1)))
    spectra, target = (
        np.vstack([others, hidden]),
        TargetSpectrum(PERIODS, median, np.full(20, sigma)),
    )
    chosen = select_motions(spectra, target, 8)
    assert chosen == list(range(60, 68))
    assert distance_of_set(np.log(spectra[chosen]), target) < 1e-25


def test_exchanges_bring_the_set_nearer_than_taking_one_after_another():
    rng = np.random.default_rng(3)
    median = 3.0 / PERIODS
    spectra = median * np.exp(0.5 * rng.normal(size=(40, 1)) + 0.3 * rng.normal(size=(40, 20)))
    target = TargetSpectrum(PERIODS, median, np.full(20, 0.5))
    logs = np.log(spectra)
    greedy = []
    for _ in range(10):
        left = [row for row in range(40) if row not in greedy]
        greedy.append(min(left, key=lambda row: distance_of_set(logs[[*greedy, row]], target)))
    chosen = select_motions(spectra, target, 10)
    found = distance_of_set(logs[chosen], target)
    assert found <= distance_of_set(logs[greedy], target)
    # no single exchange is left that would
    for place in range(10):
        for row in set(range(40)) - set(chosen):
            other = [*chosen[:place], row, *chosen[place + 1 :]]
            assert distance_of_set(logs[other], target) >= found


def test_a_target_is_interpolated_in_logarithms(tmp_path):
    (tmp_path / "t.csv").write_text("period_s,sa_g,sigma_ln\n0.1,2,0.3\n1,0.2,0.5\n")
    target = read_target_spectrum(tmp_path / "t.csv").within(0.1, 1.0, 3)
    np.testing.assert_allclose(target.periods, [0.1, np.sqrt(0.1), 1.0])
    np.testing.assert_allclose(target.sa / GRAVITY, [2.0, 2 * np.sqrt(0.1), 0.2])
    np.testing.assert_allclose(target.sigma, [0.3, 0.4, 0.5])


@pytest.mark.parametrize(
    "text, said",
    [
        ("period_s,sa\n0.1,1\n1,1\n", "sa_g or sa_m_s2"),
        ("period_s,sa_g,sa_m_s2\n0.1,1,1\n1,1,1\n", "sa_g or sa_m_s2"),
        ("period_s,sa_g\n1,1\n0.1,1\n", "line 3, period_s.*greater than the line before"),
        ("period_s,sa_g\n0.1,-1\n1,1\n", "line 2, sa_g.*greater than 0"),
        ("period_s,sa_g\n0.1,nan\n1,1\n", "line 2, sa_g"),
        ("period_s,sa_g\n0.1,1_0\n1,1\n", "line 2, sa_g"),
        ("period_s,sa_g\n0,1\n1,1\n", "line 2, period_s"),
        ("period_s,sa_g\n0.1,981\n1,200\n", "is 981 g: must be at most 100 g"),
        ("period_s,sa_g,sigma_ln\n0.1,1,-1\n1,1,1\n", "line 2, sigma_ln"),
        ("period_s,sa_g\n0.1,1\n", "two periods"),
        ("period_s,sa_g\n", "holds no line"),
        ("period_s,sa_g\n0.1,1,3\n1,1\n", "line 2"),
        (TARGET[:-3], "line 6: ends inside a number, '0' after '0.4', .* is cut off"),
        (TARGET[:-2], r"line 6: ends inside a number, '0\.' after '0.4'"),
        (TARGET.replace("sigma", "sjgma"), "'sjgma_ln': is not known; must be one of period_s, sa"),
        (TARGET.replace("sigma", "sjgma"), "did you mean sigma_ln"),
        (TARGET.replace("sigma_ln", "sa_m_s2"), "must have columns period_s, sa_g or sa_m_s2"),
    ],
)
def test_a_wrong_target_is_refused_in_a_line(tmp_path, text, said):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(InputError, match=said) as caught:
        read_target_spectrum(tmp_path / "t.csv")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        TARGET.replace(",", ";").replace(".", ","),
        TARGET.replace(",", "\t").replace(".", ","),
        "\n".join(
            ",".join(f'"{cell}"' for cell in line.replace(",", ";").replace(".", ",").split(";"))
            for line in TARGET.split()
        ),
        TARGET[:-1],
    ],
    ids=["semicolons", "tabs", "quotes", "no end of line"],
)
def test_a_target_is_read_as_tables_are_written(tmp_path, text):
    (tmp_path / "t.csv").write_text(text)
    target = read_target_spectrum(tmp_path / "t.csv")
    assert target.sa == pytest.approx(GRAVITY * np.array([0.6, 1, 1, 0.3, 0.1]))
    assert target.sigma is not None and target.sigma.tolist() == [0.3, 0.3, 0.3, 0.4, 0.5]
    assert target.periods.tolist() == [0.05, 0.1, 0.2, 0.5, 1.0]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("match")
    lines = [f"{t:.6f},{0.5 / max(t, 0.3):.6f},0.3" for t in np.geomspace(0.05, 3.0, 20)]
    (folder / "t.csv").write_text("period_s,sa_g,sigma_ln\n" + "\n".join(lines) + "\n")
    return folder


def test_scaled_motions_fit_the_target_in_the_mean_of_logarithms(files, capsys):
    made = ["motions", "scale", "lick:1-3", "--to-spectrum", str(files / "t.csv")]
    assert main([*made, "--periods", "0.1", "1", "-o", str(files / "scaled.h5")]) == 0
    assert "3 of 3 motions: their mean is within" in capsys.readouterr().out
    ensemble = read_ensemble(files / "scaled.h5")
    target = read_target_spectrum(files / "t.csv").within(0.1, 1.0)
    for motion in ensemble.motions:
        off = np.log(horizontal_spectrum(motion, target.periods) / target.sa)
        assert abs(off.mean()) < 1e-12
    with open(files / "scaled.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert all(
        float(row["parameter_scale_factor"]) > 0 and row["parameter_misfit_ln"] for row in rows
    )
    assert (files / "scaled.png").read_bytes().startswith(b"\x89PNG")


def test_selected_motions_are_those_of_the_set(files, capsys):
    made = ["motions", "select", "lick:1-12", "--to-spectrum", str(files / "t.csv"), "-n", "5"]
    assert main([*made, "-o", str(files / "set.h5")]) == 0
    assert "5 of 12 motions" in capsys.readouterr().out
    ensemble = read_ensemble(files / "set.h5")
    assert len(ensemble.motions) == 5 == len({motion.name for motion in ensemble.motions})
    np.testing.assert_array_equal(ensemble.parameters["scale_factor"], 1.0)


@pytest.mark.parametrize(
    "action, more, said",
    [
        ("select", ["-n", "0"], "-n = 0: must be a number from 1 to 2"),
        ("select", ["-n", "3"], "-n = 3: must be a number from 1 to 2"),
        ("scale", ["--periods", "1", "0.1"], "--periods"),
        ("scale", ["--periods", "0.01", "1"], "within those of the target, 0.05 to 3 s"),
        ("scale", ["--most-factor", "0.5"], "--most-factor"),
        ("scale", ["--most-factor", "1.0001"], "leaves 0 of 2 motions; the factors are"),
    ],
)
def test_wrong_wishes_are_refused_in_a_line(files, capsys, action, more, said):
    made = ["motions", action, "lick:1-2", "--to-spectrum", str(files / "t.csv")]
    assert main([*made, *more, "-o", str(files / "no.h5")]) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1
    assert not (files / "no.h5").exists()
