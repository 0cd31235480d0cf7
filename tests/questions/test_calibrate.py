"""fecolumn calibrate: recovers what is known, says plainly what is not, refuses what cannot be."""

import csv
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.profile import THRESHOLD, effective_number, profiled_fit
from fecolumn.statistics.rocking_test import RockingTest, read_rocking_test
from fecolumn.study.questions.calibration import RockingCalibration, usual_ranges

BLOCK = "[block]\nwidth_m = 0.25\nheight_m = 1.0\n[integration]\ndt_s = 0.005\n"
RESTITUTION, TILT, NOISE = 0.925, 0.12, 0.002


@pytest.fixture(scope="module")
def test_of_block(tmp_path_factory):
    """A folder with a block, and a test of it with noise: restitution and first tilt are known."""
    folder = tmp_path_factory.mktemp("calibrate")
    (folder / "block.toml").write_text(BLOCK)
    (folder / "true.toml").write_text(
        'extends = "block.toml"\n[block]\nrestitution = 0.925\n[initial]\ntilt_rad = 0.12\n'
        "[integration]\nduration_s = 3.0\n"
    )
    assert main(["run", str(folder / "true.toml"), "-o", str(folder / "true"), "-q"]) == 0
    rows, times = read_history(folder / "true" / "history.h5"), np.arange(0, 3, 0.025)
    tilt = np.interp(times, rows["time"], np.abs(rows["tilt"]))
    tilt += np.random.default_rng(7).normal(0, NOISE, times.size)
    (folder / "free.csv").write_text(
        "time_s,tilt_deg\n" + "".join(f"{t:.4f},{np.degrees(y):.6f}\n" for t, y in zip(times, tilt))
    )
    return folder


def calibrate(folder, out, *fits):
    options = [word for fit in fits for word in ("--fit", *fit)]
    case, test = str(folder / "block.toml"), str(folder / "free.csv")
    return main(["calibrate", case, "--test", test, *options, "-o", str(folder / out)])


def rows(file):
    with open(file) as text:
        return list(csv.DictReader(text))


@pytest.mark.long
def test_known_restitution_and_first_tilt_are_recovered_from_noise(test_of_block, capsys):
    fits = (("block.restitution", "0.8:1"), ("initial.tilt_rad", "0.11:0.13"))
    assert calibrate(test_of_block, "both", *fits) == 0
    restitution, tilt = rows(test_of_block / "both" / "calibrate.csv")
    for row, known in ((restitution, RESTITUTION), (tilt, TILT)):
        low, value, high = (float(row[name]) for name in ("low", "value", "high"))
        assert low < value < high and row["identified"] == "1"
        # twice the interval: one in 20 intervals misses, and the two hang together
        assert abs(value - known) < high - low
    assert float(restitution["high"]) - float(restitution["low"]) < 0.01
    fitted = tomllib.loads((test_of_block / "both" / "fitted.toml").read_text())
    assert fitted["block"]["restitution"] == pytest.approx(float(restitution["value"]), rel=1e-5)
    said = capsys.readouterr().out
    assert "block.restitution = 0.92" in said and "mrad rms" in said
    assert (test_of_block / "both" / "calibrate.png").stat().st_size > 5000


@pytest.mark.long
def test_key_that_the_test_does_not_feel_is_said_not_to_be_identified(test_of_block, capsys):
    assert calibrate(test_of_block, "free", ("block.friction_coefficient", "0.3:0.9")) == 0
    (row,) = rows(test_of_block / "free" / "calibrate.csv")
    assert (row["low"], row["high"], row["identified"]) == ("", "", "0")
    said = capsys.readouterr().out
    assert "block.friction_coefficient is not identified" in said
    assert "It does not describe the test" in said  # Housner's own restitution is not 0.925


@pytest.mark.long
def test_what_was_killed_goes_on_from_its_runs(test_of_block):
    command = [
        *(sys.executable, "-m", "fecolumn.cli", "calibrate", str(test_of_block / "block.toml")),
        *("--test", str(test_of_block / "free.csv"), "--fit", "block.restitution", "0.8:1"),
    ]
    killed, whole = ("-o", str(test_of_block / "killed")), ("-o", str(test_of_block / "whole"))
    runs = test_of_block / "killed" / "runs"
    with subprocess.Popen([*command, *killed], stderr=subprocess.DEVNULL) as work:
        while work.poll() is None and not (runs.is_dir() and len(list(runs.iterdir())) > 5):
            time.sleep(0.05)
        os.kill(work.pid, signal.SIGKILL)
    # all but that in hand
    old = {file: file.stat().st_mtime_ns for file in runs.glob("*/summary.json")}
    assert len(old) >= 4
    for out in (killed, whole):
        assert subprocess.run([*command, *out], capture_output=True).returncode == 0
    answers = [
        (test_of_block / name / "calibrate.csv").read_bytes() for name in ("killed", "whole")
    ]
    assert answers[0] == answers[1]
    # what was done is not made again
    assert all(file.stat().st_mtime_ns == at for file, at in old.items())


BODY = """
[bodies.block]
kind = "block"
length_m = {size}
width_m = {size}
height_m = {height}
mass_kg = 200
element_size_m = 0.1
{body}
[joints.foot]
between = ["block", "ground"]
friction_coefficient = 0.8
[contact]
interior_points = 4
[integration]
engine = "rigid"
dt_s = 1e-3
{more}
"""
PAD = '[grounds.ground]\nkind = "pad"\nstiffness_n_m3 = 1e8\n'
# Key, its true value and range, tilt at the release, the block, and how far the interval reaches
RECOVERED = [
    # stocky enough to slide while it rocks
    pytest.param(
        ("joints.foot.friction_coefficient", 0.35, "0.1:0.9", 0.3),
        dict(size=0.4, height=0.5, body="rigid = true", more=""),
        id="friction",
    ),
    pytest.param(
        ("bodies.block.edge_radius_m", 0.02, "0:0.04", 0.1),
        dict(size=0.3, height=0.9, body="edge_radius_m = 0.01", more=""),
        id="edge radius",
        marks=pytest.mark.slow,
    ),
]


def recovered(tmp_path, known, block, lasts=0.6):
    """Low end, value and high end of a key, fitted to tilts each 10 ms of a run with its true
    value, with a scatter of 0.5 mrad.
    """
    key, true, allowed, tilt = known
    (tmp_path / "case.toml").write_text(BODY.format(**block))
    (tmp_path / "true.toml").write_text(
        f'extends = "case.toml"\n{key} = {true}\n[initial.block]\ntilt_rad = {tilt}\n'
        f"[integration]\nduration_s = {lasts}\n"
    )
    assert main(["run", str(tmp_path / "true.toml"), "-o", str(tmp_path / "true"), "-q"]) == 0
    found, times = read_history(tmp_path / "true" / "history.h5"), np.arange(0, lasts, 0.01)
    angle = np.interp(times, found["time"], np.abs(found["tilt"]))
    angle += np.random.default_rng(7).normal(0, 5e-4, times.size)
    (tmp_path / "free.csv").write_text(
        "time_s,tilt_rad\n" + "".join(f"{t:.4f},{y:.7f}\n" for t, y in zip(times, angle))
    )
    fit = ["calibrate", str(tmp_path / "case.toml"), "--test", str(tmp_path / "free.csv")]
    assert main([*fit, "--fit", key, allowed, "-o", str(tmp_path / "fit")]) == 0
    (row,) = rows(tmp_path / "fit" / "calibrate.csv")
    assert row["identified"] == "1"
    return tuple(float(row[name]) for name in ("low", "value", "high"))


@pytest.mark.long
@pytest.mark.parametrize("known, block", RECOVERED)
def test_a_known_value_is_found_in_the_record_of_a_run_with_it(tmp_path, capsys, known, block):
    low, value, high = recovered(tmp_path, known, block)
    assert low < value < high
    assert abs(value - known[1]) < high - low < 0.05 * known[1]
    assert "The fit leaves 0.4" in capsys.readouterr().out  # mrad: the scatter, less what is fitted


@pytest.mark.slow
def test_the_stiffness_of_a_pad_is_found_among_many_minima(tmp_path, capsys):
    """After impacts on a pad the tilt depends on the phase of its bounces. In 0.6 s of this record
    2.5e8 N/m3 fits better than the true value; in 1.2 s the true one fits best, and 4.02e8 N/m3
    fits nearly as well (deviance below 3.8), which the answer says.
    """
    known = ("grounds.ground.stiffness_n_m3", 4e8, "1e7:1e9", 0.1)
    block = dict(size=0.3, height=0.9, body="rigid = true", more=PAD)
    low, value, high = recovered(tmp_path, known, block, 1.2)
    assert value == pytest.approx(4e8, rel=0.01) and 2.7e8 < low < 4e8 < high < 4.1e8
    said = capsys.readouterr().out
    assert "The interval has gaps: values near 4.02" in said and "a longer test" in said


def test_a_range_of_decades_is_searched_in_logarithm(test_of_block):
    ranges = {"grounds.ground.stiffness_n_m3": (1e6, 1e10), "bodies.a.edge_radius_m": (0.0, 0.1)}
    test = read_rocking_test(test_of_block / "free.csv")
    question = RockingCalibration({}, "case.toml", ranges, test, test_of_block / "none")
    found = question.values(np.array([0.5, 0.5]))
    assert found == {"grounds.ground.stiffness_n_m3": 1e8, "bodies.a.edge_radius_m": 0.05}


def line(x, y):
    """Residuals of y = 4 (u0 - 1/2) + 4 (u1 - 1/2) x."""
    return lambda u: y - 4 * (u[0] - 0.5) - 4 * (u[1] - 0.5) * x


def test_profile_of_a_straight_line_is_that_of_linear_regression():
    rng, x = np.random.default_rng(1), np.linspace(-1, 2, 80)
    y = 0.3 + 0.8 * x + rng.normal(0, 0.1, x.size)
    fit = profiled_fit(line(x, y), 2)
    design = np.column_stack([np.ones_like(x), x])
    exact, left, *_ = np.linalg.lstsq(design, y, rcond=None)
    assert 4 * (fit.best - 0.5) == pytest.approx(exact, abs=2e-3)
    number = fit.independent
    covariance = np.linalg.inv(design.T @ design)
    for one, value, spread in zip(fit.parameters, exact, np.sqrt(np.diag(covariance))):
        # n ln(1 + d^2 / (spread^2 S)) = 3.84
        reach = spread * np.sqrt(left[0] * np.expm1(THRESHOLD / number))
        found = 4 * (np.array([one.low, one.high]) - 0.5)
        assert found == pytest.approx([value - reach, value + reach], abs=0.08 * reach)


@pytest.mark.long
def test_intervals_hold_the_truth_as_often_as_they_say():
    rng, x, inside = np.random.default_rng(4), np.linspace(-1, 2, 60), 0
    for _ in range(60):
        y = 0.8 * x + rng.normal(0, 0.1, x.size)
        (one,) = profiled_fit(lambda u, y=y: y - 2 * u[0] * x, 1).parameters
        inside += one.low <= 0.4 <= one.high
    assert inside >= 52


def test_parameters_that_only_their_sum_matters_are_not_identified():
    x = np.linspace(0, 1, 40)
    y = 0.9 * x + np.random.default_rng(2).normal(0, 0.01, x.size)
    fit = profiled_fit(lambda u: y - (u[0] + u[1]) * x, 2)
    assert all(not one.identified for one in fit.parameters)
    assert fit.trades() == [(0, 1)]
    test = RockingTest(x, np.full(x.size, 0.1))
    ranges = {"block.tendon_n_m": (0.0, 1e5), "block.spring_n_m": (0.0, 1e5)}
    started = {"initial": {"tilt_rad": 0.1}}
    *_, told, _ = RockingCalibration(started, "case.toml", ranges, test, Path()).sentences(fit)
    found = re.fullmatch(
        r"block.tendon_n_m and block.spring_n_m trade: block.tendon_n_m = (\S+) N/m with "
        r"block.spring_n_m = (\S+) N/m fits as well as block.tendon_n_m = (\S+) N/m with "
        r"block.spring_n_m = (\S+) N/m; state one of them in the case to find the other.",
        told,
    )
    a, b, c, d = map(float, found.groups())
    assert a + b == pytest.approx(9e4, rel=0.02) and c + d == pytest.approx(9e4, rel=0.02)
    assert c - a > 7e4


def test_parameters_told_apart_by_the_test_do_not_trade():
    x = np.linspace(-1, 1, 40)
    y = 0.3 + 0.6 * x + np.random.default_rng(2).normal(0, 0.01, x.size)
    assert profiled_fit(lambda u: y - u[0] - u[1] * x, 2).trades() == []


def waves(at, noise=0.02):
    """Residuals of one parameter with ten minima, the least of them at `at`."""
    scatter = scatter_of(noise)

    def residuals(u):
        away = u[0] - at
        return scatter + 0.5 * np.sin(10 * np.pi * away) + 0.3 * away * np.resize([1, -1], 50)

    return residuals


def scatter_of(noise):
    """Random numbers (50,) without what would shift a fit of `waves`."""
    found = np.random.default_rng(5).normal(0, noise, 50)
    for shape in (np.ones(50), np.resize([1, -1], 50)):
        found -= found @ shape / 50 * shape
    return found


def test_the_least_of_many_minima_is_found():
    for at in np.linspace(0.04, 0.97, 12):
        (one,) = profiled_fit(waves(at), 1).parameters
        assert one.low < at < one.high and one.high - one.low < 0.01 and not one.apart


def test_minima_as_good_as_the_best_belong_to_the_interval():
    """Residuals of sin(10 pi u) have zeros a tenth apart: all of them fit alike."""
    scatter = scatter_of(0.02)
    fit = profiled_fit(lambda u: scatter + 0.5 * np.sin(10 * np.pi * (u[0] - 0.05)), 1)
    (one,) = fit.parameters
    assert one.low < 0.05 and one.high > 0.95 and len(one.apart) == 9
    assert one.apart == pytest.approx(
        [at for at in np.linspace(0.05, 0.95, 10) if abs(at - one.best) > 0.05], abs=0.005
    )
    test = RockingTest(np.arange(50.0), np.full(50, 0.1))
    ranges = {"grounds.ground.stiffness_n_m3": (0.0, 1e3)}
    told, _, start = RockingCalibration({}, "case.toml", ranges, test, Path()).sentences(fit)
    assert "--fit initial.tilt_rad 0.095:0.105 fits it, too" in start
    assert "The interval has gaps: values near" in told and "longer test" in told


def test_neighbours_alike_count_for_fewer_samples():
    rng, noise = np.random.default_rng(0), np.zeros(20000)
    for place, draw in enumerate(rng.normal(size=noise.size - 1), 1):
        noise[place] = 0.8 * noise[place - 1] + draw
    assert effective_number(noise) == pytest.approx(noise.size * 0.2 / 1.8, rel=0.05)
    assert effective_number(rng.normal(size=5000)) > 4500


def test_usual_keys_are_those_that_the_case_has():
    assert list(usual_ranges({"block": {}}, "")) == ["block.restitution"]
    tables = {"bodies": {"drum": {"kind": "cylinder", "edge_radius_m": 0.01}}}
    keys = {"contact.friction_coefficient", "bodies.drum.edge_radius_m"}
    assert set(usual_ranges(tables, "")) == keys | {"contact.restitution"}
    tables["grounds"] = {"ground": {"kind": "pad", "stiffness_n_m3": 1e9}}
    assert set(usual_ranges(tables, "")) == keys | {"grounds.ground.stiffness_n_m3"}
    with pytest.raises(InputError, match="--fit"):
        usual_ranges({"frame": {}}, "frame.toml")


def samples(*, unit="tilt_rad", change=None, step=0.1):
    lines = [f"{step * n:g},{0.1 * np.exp(-0.1 * n):.5f}" for n in range(30)]
    for place, text in (change or {}).items():
        lines[place] = text
    return "\n".join([f"time_s,{unit}", *lines]) + "\n"


@pytest.mark.parametrize("tilt", ["tilt [deg]", "tilt[deg]", "tilt_deg"])
def test_a_history_that_fecolumn_wrote_will_do_as_a_test(tmp_path, tilt):
    """Its names have their units in brackets."""
    lines = samples(unit=f"u_x [m],{tilt}").replace("time_s", "time [s]").splitlines()
    lines[1:] = [line.replace(",", ",0.3,") for line in lines[1:]]
    (tmp_path / "history.csv").write_text("\n".join(lines) + "\n")
    found = read_rocking_test(tmp_path / "history.csv")
    assert len(found.time) == 30 and found.time[-1] == pytest.approx(2.9)
    assert found.tilt[0] == pytest.approx(np.radians(0.1))


@pytest.mark.parametrize(
    "text, said",
    [
        (None, "test.csv: no such file"),
        ("", "holds no line below its header"),
        (samples(unit="tilt_grad"), "must have one column of time_s, time_ms and one of tilt_rad"),
        (samples(change={5: "0.35,0.05"}), "line 7, time_s = '0.35': must be later than the line"),
        (samples(change={5: "0.5,nan"}), "line 7, tilt_rad = 'nan': must be a finite number"),
        (samples(change={5: "0.5,0_1"}), "line 7, tilt_rad = '0_1': must be a finite number"),
        (samples(change={5: "0.5,7.2"}), "must be below a quarter of a turn: check its unit"),
        (samples(change={0: "0.0,0"}), "line 2, tilt_rad = '0': must not be below 1e-05 rad"),
        (samples(change={5: "0.5"}), "line 7: has 1 columns where the header has 2"),
        (samples(change={5: '0.5,"0.1'}), "cannot be read as CSV"),
        (samples(change={5: "0.5," + "9" * 200_000}), "field larger than field limit"),
        ("time_s,tilt_rad\n0,0.1\n1,0.1\n", "has 2 samples; at least 20 are needed"),
        (samples(step=100), "time_s: half of the samples are 100 s or more apart, which must be"),
        (samples(step=1e-4), "time_s: the test lasts 0.0029 s, which must be 0.05 to 3600 s: ch"),
    ],
)
def test_test_that_cannot_be_used_is_refused_in_a_line(tmp_path, text, said):
    if text is not None:
        (tmp_path / "test.csv").write_text(text)
    with pytest.raises(InputError) as error:
        read_rocking_test(tmp_path / "test.csv")
    assert said in str(error.value) and "\n" not in str(error.value)


@pytest.mark.timeout(30)
def test_a_pipe_or_a_device_in_place_of_a_test_holds_nothing_up(tmp_path):
    os.mkfifo(tmp_path / "test.csv")
    for file in (tmp_path / "test.csv", Path("/dev/zero")):
        with pytest.raises(InputError, match="is a device or a pipe; a file is needed"):
            read_rocking_test(file)


@pytest.mark.parametrize(
    "fits, said",
    [
        ([("block.restitutoin", "0.5:1")], "did you mean block.restitution"),
        ([("block.restitution", "1:0.5")], "did you mean 0.5:1?"),
        ([("block.restitution", "0.5:1.5")], "block.restitution = "),
        ([("block.restitution", "-.5:-0.1")], "block.restitution = -0.3: must lie in [0, 1]"),
        ([("block.restitution", "-0.5:1")] * 2, "--fit = 'block.restitution': stands twice"),
        ([("block.sides", "1:2")], "a number of the object or of its start that varies contin"),
        ([("motion.scale", "1:2")], "a number of the object or of its start"),
        ([("integration.duration_s", "1:2")], "such as block.restitution"),
    ],
)
def test_keys_that_cannot_be_fitted_are_refused_in_a_line(test_of_block, capsys, fits, said):
    assert calibrate(test_of_block, "refused", *fits) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1


DRUM = """[bodies.{name}]
kind = "block"
length_m = 0.4
width_m = 0.4
height_m = 0.5
mass_kg = 200
element_size_m = 0.1
rigid = true
contact_stiffness_n_m3 = 1e10
edge_radius_m = 0.01
[joints.below_{name}]
between = ["{name}", "{below}"]
"""
DRUMS = "".join(
    DRUM.format(name=name, below=below)
    for name, below in (("a", "ground"), ("b", "a"), ("c", "b"), ("d", "c"))
)


@pytest.mark.parametrize(
    "text, said",
    [
        ("bodies = 3\n", "bodies = 3: must hold tables by name"),
        ("grounds = 3\n" + DRUMS, "grounds = 3: must hold tables by name"),
        (DRUMS.replace("mass_kg", "mas_kg", 1), "bodies.a.mas_kg = 200: unknown key"),
        (DRUMS, "has 10 keys to fit, contact.restitution, contact.friction_coefficient, bodies.a"),
        (DRUMS, "; at most 4: name them by --fit"),
    ],
)
def test_case_without_usual_keys_is_refused_in_a_line(tmp_path, capsys, text, said):
    (tmp_path / "block.toml").write_text(text)
    (tmp_path / "free.csv").write_text("time_s,tilt_rad\n0,0.1\n0.5,0.05\n1,0.04\n")
    assert calibrate(tmp_path, "refused") == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1
    assert not (tmp_path / "refused").exists()


@pytest.mark.parametrize("table", ["base", "grounds", "joints"])
def test_what_stands_on_a_pad_is_fitted_by_its_stiffness_and_no_restitution(table):
    pad = dict(kind="pad", stiffness_n_m3=2e8)
    tables = dict(bodies={}) | ({"base": pad} if table == "base" else {table: dict(soil=pad)})
    name = "base" if table == "base" else f"{table}.soil"
    assert usual_ranges(tables, "case.toml") == {
        "contact.friction_coefficient": (0.1, 1.0),
        f"{name}.stiffness_n_m3": pytest.approx((2e7, 2e9)),
    }
