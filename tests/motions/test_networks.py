"""Records of COSMOS, CSMIP, SMC, GeoNet and AFAD: the motion they hold, and damage found out."""

import re
import warnings

import numpy as np
import pytest

from benchmarks.fuzz.network_files import (
    DT,
    EAST,
    NORTH,
    UP,
    all_files,
    cosmos,
    csmip,
    geonet,
    smc,
)
from fecolumn.case.sections import Motion
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.motions.load import read_motion
from fecolumn.motions.spike import spike_in

FILES = all_files()
#: Rounding of each format [m/s2]: half a digit of a number of four decimals [cm/s2], and others.
ROUNDING = {"a.V1": 5e-6 * 9.81, "a.smc": 5e-6, "a.V2A": 5e-5, "a.V1A": 5e-5}


def read(folder, text, name="a.txt", **keys):
    (folder / name).write_text(text)
    return read_motion(Motion(str(folder / name), **keys), "case.toml")


@pytest.mark.parametrize("name", FILES)
def test_every_format_holds_the_same_motion(tmp_path, name):
    found = read(tmp_path, FILES[name], name)
    wanted = np.column_stack([EAST, NORTH, UP]) / 100
    if name in ("a.V1", "a.smc", "a.V1A"):  # one component, its axis left to the case
        wanted[:, 1:] = 0
    assert found.dt == pytest.approx(DT, rel=1e-12)
    assert np.abs(found.acceleration - wanted).max() <= ROUNDING.get(name, 1e-12) * 1.01


@pytest.mark.parametrize("word", ["velocity", "acceleration"])
def test_velocities_and_displacements_of_cosmos_are_passed_over(tmp_path, word):
    """The head of their samples says what they are, or only the integer header does."""
    moved = cosmos([(90, 0.1 * EAST)], unit=5, parameter=2).replace(
        "acceleration pts", f"{word} pts"
    ) + cosmos([(90, 0.01 * EAST)], unit=6, parameter=3)
    found = read(tmp_path, cosmos([(90, EAST)]) + moved + cosmos([(0, NORTH)]))
    wanted = np.column_stack([EAST, NORTH]) / 100
    assert found.acceleration[:, :2] == pytest.approx(wanted, abs=1e-12)
    with pytest.raises(InputError, match="holds no accelerations as COSMOS"):
        read(tmp_path, moved)


def test_a_peak_is_told_in_the_unit_of_the_file(tmp_path):
    text = cosmos([(90, EAST)], unit=7)
    first, peak, rest = text.partition(f"{EAST[np.abs(EAST).argmax()]:15.6f}")
    with pytest.raises(InputError, match=r"its largest value is [\d.]+ in/s2 but .* in/s2"):
        read(tmp_path, first + f"{2 * float(peak):15.6f}" + rest)


def test_horizontal_components_of_any_direction_are_turned_to_east_and_north(tmp_path):
    """Sensors at N28W and S62W, one pointing down: projections of the same motion."""
    a, b = np.radians(-28), np.radians(242)
    along = [np.sin(angle) * EAST + np.cos(angle) * NORTH for angle in (a, b)]
    text = geonet([("N28W", 10 * along[0]), ("S62W", 10 * along[1]), ("Down", -10 * UP)])
    found = read(tmp_path, text)
    wanted = np.column_stack([EAST, NORTH, UP]) / 100
    assert np.abs(found.acceleration - wanted).max() < 1e-4  # a tenth of mm/s2, twice


@pytest.mark.parametrize(
    "text, said",
    [
        (cosmos([(90, EAST), (120, NORTH)]), "must be perpendicular"),
        (cosmos([(90, EAST), (2000, NORTH)]), "directions 90 deg, .*write the ones to use as CSV"),
        (cosmos([(a, EAST) for a in (90, 0, 400, 90)]), "holds 4 channels"),
        (cosmos([(90, EAST)], unit=50), "unit 50 .* is not known"),
        (cosmos([(90, EAST)], parameter=2), "holds no accelerations"),
        (cosmos([(90, EAST)], first="Raw acceleration counts"), "raw counts; take the file of V1"),
        (cosmos([(90, EAST)]).replace("Format=(8F10.4)", "Format=(0F99)"), "format of numbers"),
        (cosmos([(90, EAST)]) + "7.5\n", "'7.5' follows the last value"),
        (csmip([("90 Deg", EAST)], points="veloc"), "stands before accelerations"),
        (csmip([("90 Deg", EAST)], unit="furlongs"), "units of 'furlongs' are not known"),
        (csmip([("90 Deg", EAST)]).replace("points of accel", "spots of accel"), "no line tells"),
        (smc(EAST) + " 1.0000E+0\n", "more follows than 203 samples"),
        (geonet([("Lower", 10 * EAST), ("N00E", 10 * EAST)]), "directions Lower, N00E"),
        (FILES["a.nsmn"].replace(": 203", ": 204"), "NUMBER OF DATA = 204 but 203 rows"),
        (FILES["a.nsmn"].replace("       N-S ", "       N-N "), "no line names the columns"),
    ],
)
def test_what_is_no_sound_record_is_refused_in_words(tmp_path, text, said):
    with pytest.raises(InputError, match=said) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["a.v2c", "a.V2", "a.V1", "a.smc", "a.V2A"])
def test_a_peak_that_is_not_the_stated_one_is_refused(tmp_path, name):
    """The largest sample is halved, so that nothing but the header tells."""
    values = EAST / 980.665 if name == "a.V1" else EAST
    peak = values[np.abs(values).argmax()]
    words = {"a.smc": "{:.4E}", "a.V1": "{:9.6f}", "a.V2A": "{:8.1f}"}
    write = words.get(name, "{:10.4f}").format
    if name == "a.V2A":
        peak *= 10
    old, new = write(peak), write(peak / 2)
    if name == "a.smc":
        old, new = (re.sub(r"E([+-])0", r"E\1", word) for word in (old, new))
    *before, last = FILES[name].partition(old) if name != "a.V2A" else _behind_header(old)
    text = "".join(before).replace(old, new) + last
    if name in ("a.v2c", "a.V2"):  # the header has it first, in another width
        assert text.count(old) < FILES[name].count(old)
    with pytest.raises(InputError, match="its header states a peak of"):
        read(tmp_path, text, name)


def _behind_header(old):
    """Text of GeoNet up to the first sample, that sample, and the rest."""
    head, mark, rest = FILES["a.V2A"].partition(old)
    more, again, rest = rest.partition(old)
    return head + mark + more, again, rest


@pytest.mark.parametrize("name", FILES)
def test_a_file_cut_anywhere_is_refused_or_whole(tmp_path, name):
    """Whole: nothing but the end of its last line, or the mark of its end, is missing."""
    text, read_through = FILES[name], 0
    wanted = read(tmp_path, text, name).acceleration
    for length in [*range(0, len(text), 97), *range(len(text) - 90, len(text))]:
        try:
            found = read(tmp_path, text[:length], name).acceleration
        except InputError as error:
            assert "\n" not in str(error)
            continue
        read_through += 1
        whole = _components(text) > _components(text[:length])
        if not whole:
            assert np.array_equal(found, wanted), length
    assert read_through <= 95


def _components(text):
    """Channels of which the text has the samples, by their first lines."""
    return len(re.findall(r"(?im)^\s*corrected accel\S*\s", text))


@pytest.mark.parametrize("name", FILES)
def test_letters_replaced_are_refused_or_leave_a_motion_of_the_same_size(tmp_path, name):
    """300 files of one to three letters replaced: no traceback, nothing beyond ten times the
    peak without a warning.
    """
    rng, text = np.random.default_rng(7), FILES[name]
    letters = "0123456789.-+eED |:,()N\n"
    wanted = read(tmp_path, text, name)
    for _ in range(300):
        changed = list(text)
        for place in rng.integers(len(text), size=int(rng.integers(1, 4))):
            changed[place] = letters[int(rng.integers(len(letters)))]
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                found = read(tmp_path, "".join(changed), name)
            except InputError as error:
                assert "\n" not in str(error)
                continue
        assert found.pga.max() < 10 * wanted.pga.max() or said


def test_a_spike_is_warned_of_and_a_sharp_pulse_is_none(tmp_path, capsys):
    text = FILES["a.nsmn"]
    line = text.splitlines()[60]
    damaged = text.replace(line, f"{900.0:12.6f}" + line[12:])
    (tmp_path / "a.txt").write_text(damaged)
    with pytest.warns(UserWarning, match="has a spike .* t = 1.02 s"):
        read(tmp_path, damaged)
    assert main(["motions", "info", str(tmp_path / "a.txt")]) == 0
    assert "a spike:" in capsys.readouterr().out
    half_sine = np.r_[np.zeros(30), np.sin(np.linspace(0, np.pi, 9)), np.zeros(30)]
    step = np.r_[np.zeros(30), np.ones(30), -np.ones(30), np.zeros(30)]
    noise = np.random.default_rng(0).standard_normal(3000)
    assert [spike_in(one) for one in (half_sine, step, noise, EAST)] == [None] * 4


def test_info_names_format_station_and_directions(tmp_path, capsys):
    for name, kind in (("a.v2c", "COSMOS"), ("a.V2", "CSMIP"), ("a.V2A", "GeoNet")):
        (tmp_path / name).write_text(FILES[name])
        assert main(["motions", "info", str(tmp_path / name)]) == 0
        said = capsys.readouterr().out
        assert f"{name}: {kind}, 203 samples, dt 0.02 s" in said
        assert "3 (ax, ay, az)" in said and re.search(r"source: .*(90 deg|90 Deg|N90E)", said)
