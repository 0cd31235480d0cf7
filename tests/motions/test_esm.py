"""ESM ASC files: what the header states is used, and what is broken is refused with where and
why.
"""

import numpy as np
import pytest
from record_files import ACCELERATION, write_text

from fecolumn.motions.at2 import looks_like_at2
from fecolumn.motions.esm import looks_like_esm, read_esm
from fecolumn.motions.record import UnusableRecord

HEADER = """EVENT_NAME: CENTRAL_ITALY
EVENT_DATE_YYYYMMDD: 20160824
EVENT_DEPTH_KM: 8.1
HYPOCENTER_REFERENCE:
NETWORK: IT
STATION_CODE: AMT
VS30_M/S: 670
SAMPLING_INTERVAL_S: 0.005000
NDATA: 8
STREAM: HGE
UNITS: cm/s^2
PGA_CM/S^2: -850.803
DATA_TYPE: ACCELERATION
USER1:
"""


def text_of(header=HEADER, values=ACCELERATION, end="\n"):
    return (header + "".join(f"{value: .6e}\n" for value in values)).replace("\n", end)


def test_header_states_step_units_and_origin(tmp_path):
    recording = read_esm(write_text(tmp_path / "a.asc", text_of()))
    assert recording.dt == 0.005 and recording.units == "cm/s2" and recording.axes == ("",)
    assert recording.values[:, 0].tolist() == ACCELERATION.tolist()
    assert recording.source == "ESM: CENTRAL_ITALY 20160824 IT AMT HGE"


def test_dos_line_ends_byte_order_mark_and_fortran_numbers_do_not_matter(tmp_path):
    file = write_text(
        tmp_path / "a.asc", "\ufeff" + text_of(end="\r\n").replace("e-", "D-") + "\x1a"
    )
    assert read_esm(file).values[:, 0] == pytest.approx(ACCELERATION, rel=1e-12)


def test_file_is_told_from_its_first_lines():
    assert looks_like_esm(text_of()) and looks_like_esm(text_of(HEADER.split("\n", 3)[3]))
    assert not looks_like_at2("a.asc", text_of())
    assert not looks_like_esm("time [s], ax [g]\n0, 1\n") and not looks_like_esm(
        "PEER\nx\nUNITS OF G\nNPTS= 8, DT= .01\n"
    )


@pytest.mark.parametrize(
    "old, new, said",
    [
        ("NDATA: 8", "NDATA: 9", "NDATA = 9 but 8 values"),
        ("NDATA: 8", "NDATA: 8.5", "NDATA = 8.5"),
        ("NDATA: 8\n", "", "incomplete: an ESM file states NDATA"),
        ("SAMPLING_INTERVAL_S: 0.005000\n", "", "SAMPLING_INTERVAL_S"),
        ("0.005000", "0", "line 8: SAMPLING_INTERVAL_S = '0'"),
        ("0.005000", "nan", "line 8: SAMPLING_INTERVAL_S = 'nan'"),
        ("0.005000", "", "line 8: SAMPLING_INTERVAL_S = ''"),
        ("TYPE: ACCELERATION", "TYPE: VELOCITY", "line 13: holds no accelerations"),
        ("UNITS: cm/s^2", "UNITS: furlongs", "line 11: units of 'furlongs'"),
        ("-2.000000e-03", "NaN", "line 16: NaN"),
        ("-2.000000e-03", "1E999", "line 16: 1E999"),
        ("-2.000000e-03", "*****", r"line 16: '\*\*\*\*\*'"),
        ("-2.000000e-03", "1 2", "line 16: '1 2' is not a number"),
        ("-2.000000e-03", "USER5: x", "line 16: 'USER5: x'"),
    ],
)
def test_broken_file_is_refused_with_its_place(tmp_path, old, new, said):
    text = text_of()
    assert text.count(old) == 1
    with pytest.raises(UnusableRecord, match=said):
        read_esm(write_text(tmp_path / "a.asc", text.replace(old, new)))


@pytest.mark.parametrize("length", range(0, len(text_of()) - 2, 23))
def test_file_cut_anywhere_is_refused(tmp_path, length):
    with pytest.raises(UnusableRecord):
        read_esm(write_text(tmp_path / "a.asc", text_of()[:length]))


def test_units_not_stated_are_left_to_the_case(tmp_path):
    assert (
        read_esm(write_text(tmp_path / "a.asc", text_of().replace("UNITS: cm/s^2\n", ""))).units
        == ""
    )
    assert np.isfinite(read_esm(write_text(tmp_path / "b.asc", text_of())).values).all()
