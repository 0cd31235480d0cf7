"""Columns: delimiters, headers and units are understood, and a time column that is not even is
refused where it breaks.
"""

import numpy as np
import pytest
from record_files import write_text

from fecolumn.motions.columns import read_columns
from fecolumn.motions.record import UnusableRecord

BODY = "0.00,0.1,0.4\n0.01,-0.2,0.5\n0.02,0.3,-0.6\n"
VALUES = [[0.1, 0.4], [-0.2, 0.5], [0.3, -0.6]]


def read(tmp_path, text, dt_s=0.0):
    return read_columns(write_text(tmp_path / "a.csv", text), dt_s)


@pytest.mark.parametrize("first", ["40\n", "40\n0.01\n", "# cm/s2\n40.\n"])
def test_a_column_that_begins_with_its_count_is_refused(tmp_path, first):
    values = "".join(f"{0.1 * k % 3:.3f}\n" for k in range(40))
    with pytest.raises(UnusableRecord, match=r"line \d: 40 is the number of samples"):
        read(tmp_path, first + values, 0.01)
    assert len(read(tmp_path, values, 0.01).values) == 40


@pytest.mark.parametrize(
    "text",
    [
        "time [s], ax [g], ay [g]\n" + BODY,
        "\ufeff# from a table\r\n\r\n"
        + ("time [s], ax [g], ay [g]\n" + BODY).replace("\n", "\r\n"),
        "t;ax (g);ay (g)\n" + BODY.replace(",", ";").replace(".", ","),
        "Time [s]\tAx [G]\tAy [G]\n" + BODY.replace(",", "\t"),
        "time [s] ax [g] ay [g]\n" + BODY.replace(",", "  "),
        "# time [s] ax [g] ay [g]\n" + BODY.replace(",", " "),
        "Zeit [s];EW [g];NS [g]\n" + BODY.replace(",", ";").replace(".", ","),
        "t,acc_e-w [g],acc_n-s [g]\n" + BODY,
        '"time [ms]","ay [g]","ax [g]"\n0,.4,.1\n10,.5D0,-.2\n20,-.6,.3\n',
    ],
)
def test_same_record_in_many_dialects(tmp_path, text):
    recording = read(tmp_path, text)
    order = [recording.axes.index(axis) for axis in "xy"]
    assert recording.values[:, order].tolist() == VALUES
    assert recording.dt == pytest.approx(0.01, rel=1e-12) and recording.units == "g"


def test_two_columns_without_header_are_time_and_acceleration(tmp_path):
    recording = read(tmp_path, "# a comment\n1.00 0.1\n1.02 0.2\n1.04 0.3\n")
    assert recording.values.tolist() == [[0.1], [0.2], [0.3]] and recording.axes == ("",)
    assert recording.dt == pytest.approx(0.02) and recording.units == ""


def test_one_column_leaves_the_step_to_the_case(tmp_path):
    recording = read(tmp_path, "0.1\n0.2\n0.3\n")
    assert recording.dt is None and recording.values.shape == (3, 1)


def test_numpy_savetxt_is_read_back_exactly(tmp_path):
    table = np.column_stack([np.arange(50) * 0.005, np.random.default_rng(1).normal(size=(50, 3))])
    np.savetxt(tmp_path / "a.txt", table, header="time [s], ax [m/s2], ay [m/s2], az [m/s2]")
    recording = read_columns(tmp_path / "a.txt", 0.0)
    assert (
        np.array_equal(recording.values, table[:, 1:])
        and recording.axes == ("x", "y", "z")
        and recording.units == "m/s2"
    )


def _times(times):
    return "t [s], ax [g]\n" + "".join(f"{time},0.1\n" for time in times)


@pytest.mark.parametrize(
    "times, said",
    [
        (
            (0, 0.01, 0.02, 0.05, 0.06),
            r"line 5: step of 0.03 s before t = 0.05 s where 0.01 s is usual",
        ),
        ((0, 0.01, 0.03, 0.02), r"line 5: time falls, t = 0.02 s after 0.03 s"),
        ((0, 0.01, 0.01, 0.02), r"line 4: time repeats"),
        ((0, 0.01, 0.02, 0.0312), r"line 5: step of 0.0112 s"),
    ],
)
def test_uneven_time_is_refused_with_row_and_time(tmp_path, times, said):
    with pytest.raises(UnusableRecord, match=said):
        read(tmp_path, _times(times))


def test_one_lost_sample_among_thousands_is_found(tmp_path):
    times = np.delete(np.arange(4000) * 0.01, 1234).round(2)
    with pytest.raises(UnusableRecord, match=r"line 1236: step of 0.02 s before t = 12.35 s"):
        read(tmp_path, _times(times))
    with pytest.raises(UnusableRecord, match="line 1236"):
        read(tmp_path, _times(times), dt_s=0.01)


def test_rounded_times_need_the_step_stated(tmp_path):
    text = _times([f"{i / 256:.3f}" for i in range(1000)])
    with pytest.raises(UnusableRecord, match="state motion.dt_s"):
        read(tmp_path, text)
    assert read(tmp_path, text, dt_s=1 / 256).dt == 1 / 256


def test_step_stated_by_the_case_does_not_excuse_a_gap_made_up_for_later(tmp_path):
    with pytest.raises(UnusableRecord, match="line 4: step of 0.018 s"):
        read(tmp_path, _times((0, 0.01, 0.028, 0.034, 0.04, 0.05, 0.06)), dt_s=0.01)


@pytest.mark.parametrize(
    "text, said",
    [
        ("time [s], ax [g], ay [g]\n" + BODY.replace("-0.2", "nan"), "line 3: nan in column 2"),
        ("time [s], ax [g], ay [g]\n" + BODY.replace("-0.2", "inf"), "finite"),
        (
            "time [s], ax [g], ay [g]\n" + BODY.replace("-0.2", "lots"),
            "line 3: 'lots' is not a number",
        ),
        ("time [s], ax [g], ay [g]\n" + BODY.replace(",-0.2", ""), "line 3: 2 columns where 3"),
        ("time [s], ax [g]\n" + BODY, "names 2 columns but 3 follow"),
        ("time [s], ax [g], vy [g]\n" + BODY, "'vy' is not known"),
        ("time [s], ax [g], ax [g]\n" + BODY, "two of its kind"),
        ("time [s], ax [g], acc [g]\n" + BODY, "axis of each component"),
        ("time [h], ax [g], ay [g]\n" + BODY, "time in 'h'"),
        ("time [s], ax [V], ay [g]\n" + BODY, "'V' of column 'ax'"),
        ("time [s], ax [ft/s2], ay [g]\n" + BODY, r"different units \(ft/s2, g\)"),
        ("time [s], ax [g], ay [m/s2]\n" + BODY, "different units"),
        ("time [s], ax [g], ay\n" + BODY, "different units"),
        (BODY, "3 columns need a header"),
        ("time [s]\n0\n1\n", "no acceleration"),
        ("time [s], ax [g]\n0,1\n", "holds 1 sample;"),
        ("# nothing\n", "holds 0 samples"),
        ("", "is empty"),
    ],
)
def test_what_cannot_be_understood_is_refused(tmp_path, text, said):
    with pytest.raises(UnusableRecord, match=said):
        read(tmp_path, text)
