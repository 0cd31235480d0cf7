"""AT2 files: every dialect of header and number is read, and what is broken is refused with where
and why.
"""

import numpy as np
import pytest
from record_files import ACCELERATION, write_at2

from fecolumn.motions.at2 import read_at2
from fecolumn.motions.record import UnusableRecord


@pytest.mark.parametrize(
    "npts_line",
    [
        "NPTS=      8, DT=   .0100 SEC",
        "NPTS=  8, DT= .01000 SEC,",
        "    8    0.0100   NPTS, DT",
        "NPTS= 8, DT= 1.0D-02 SEC",
    ],
)
def test_both_generations_of_header_state_number_and_step(tmp_path, npts_line):
    recording = read_at2(write_at2(tmp_path / "a.AT2", npts_line=npts_line))
    assert recording.dt == 0.01 and recording.units == "g" and recording.axes == ("",)
    assert recording.values[:, 0] == pytest.approx(ACCELERATION, rel=1e-6)


def test_fortran_numbers_are_understood(tmp_path):
    file = write_at2(tmp_path / "a.AT2", [1.0, 1.0])
    file.write_text(file.read_text().rsplit("\n", 2)[0] + "\n -.1234E-02\t.1D+01\n")
    assert read_at2(file).values[:, 0].tolist() == [-0.001234, 1.0]


def test_dos_line_and_file_ends_byte_order_mark_blank_lines_and_accents_do_not_matter(tmp_path):
    file = write_at2(tmp_path / "a.AT2", end="\r\n\r\n")
    plain = read_at2(file)
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes() + b"\x1a")
    assert np.array_equal(read_at2(file).values, plain.values) and plain.values.shape == (8, 1)
    file.write_bytes(file.read_bytes()[3:].replace(b"Somewhere", b"D\xfczce"))
    assert "Düzce" in read_at2(file).source


@pytest.mark.parametrize(
    "units, expected",
    [
        ("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.2 Hz LP=15.0 Hz", "g"),
        ("ACCELERATION IN UNITS OF CM/SEC**2", "cm/s2"),
        ("ACCELERATION IN UNITS OF M/S^2", "m/s2"),
        ("ACCELERATION TIME SERIES", ""),
    ],
)
def test_units_are_those_of_the_header(tmp_path, units, expected):
    assert read_at2(write_at2(tmp_path / "a.AT2", units=units)).units == expected


@pytest.mark.parametrize(
    "arguments, said",
    [
        (dict(points=9), "NPTS = 9 but 8 values"),
        (dict(npts_line="8 values follow"), "four header lines"),
        (dict(npts_line="NPTS= many, DT= .01"), "line 4"),
        (dict(npts_line="NPTS= 8, DT= .0000 SEC"), "greater than 0"),
        (dict(npts_line="NPTS= 8, DT= 1E400 SEC"), "DT = inf s must be finite"),
        (dict(units="VELOCITY TIME SERIES IN UNITS OF CM/S"), "no accelerations"),
        (dict(units="ACCELERATION IN UNITS OF FURLONGS"), "'FURLONGS'"),
    ],
)
def test_broken_header_is_refused(tmp_path, arguments, said):
    with pytest.raises(UnusableRecord, match=said):
        read_at2(write_at2(tmp_path / "a.AT2", **arguments))


@pytest.mark.parametrize(
    "word, said",
    [
        ("NaN", r"line 5: sample 2 is NaN"),
        ("******", "'\\*\\*\\*\\*\\*\\*' is not a number"),
        ("1E999", "finite"),
    ],
)
def test_value_that_is_no_finite_number_is_refused_with_its_line(tmp_path, word, said):
    file = write_at2(tmp_path / "a.AT2")
    file.write_text(file.read_text().replace("-.2000000E-02", word))
    with pytest.raises(UnusableRecord, match=said):
        read_at2(file)


@pytest.mark.parametrize(
    "content, said",
    [
        (b"", "is empty"),
        (b"\n \r\n", "is empty"),
        (b"\x00\x89\xff", "not a text file"),
        (b"\x89\xff\x01", "not a text file"),
        (b"\xfe\xed\xfa\n" * 9, "four header"),
    ],
)
def test_what_is_no_record_is_refused(tmp_path, content, said):
    (tmp_path / "a.AT2").write_bytes(content)
    with pytest.raises(UnusableRecord, match=said):
        read_at2(tmp_path / "a.AT2")
