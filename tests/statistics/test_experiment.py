import numpy as np
import pytest

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.experiment import read_maxima


def written(folder, text):
    file = folder / "tests.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_maxima_of_a_campaign(tmp_path):
    found = read_maxima(
        written(
            tmp_path,
            "\ufeff# shake table\nmotion, u_max_mm, overturned, remark\nlick.h5#1, "
            '12.5, 0, "slid, then stood"\n\nlick.h5#2,,YES,\nlick.h5#3,0,false,\n',
        )
    )
    assert found.motions == ("lick.h5#1", "lick.h5#2", "lick.h5#3")
    np.testing.assert_allclose(found.u_max, [0.0125, np.nan, 0.0], rtol=1e-15)
    np.testing.assert_array_equal(found.overturned, [False, True, False])


@pytest.mark.parametrize("between", [";", "\t"])
def test_semicolons_tabs_decimal_commas_and_quotes_are_read(tmp_path, between):
    rows = [["motion", "u_max_mm", "overturned"], ['"a; b"', "1,5", "0"], ["c", '"0,25"', "0"]]
    found = read_maxima(written(tmp_path, "\n".join(map(between.join, rows)) + "\n"))
    assert found.motions == ("a; b", "c")
    assert found.u_max == pytest.approx([1.5e-3, 2.5e-4])


@pytest.mark.parametrize("unit, factor", [("mm", 1e-3), ("cm", 1e-2), ("m", 1)])
def test_unit_is_that_of_the_header(tmp_path, unit, factor):
    assert read_maxima(
        written(tmp_path, f"motion,u_max_{unit},overturned\na,2,0\n")
    ).u_max == pytest.approx([2 * factor])


@pytest.mark.parametrize(
    "text, said",
    [
        ("motion,u_max,overturned\na,1,0\n", "header.*u_max_m, u_max_mm"),
        ("motion:u_max_mm:overturned\na:1:0\n", "parted by commas, semicolons or tabs"),
        ("motion,u_max_mm\na,1\n", "one column overturned"),
        ("motion,u_max_mm,overturned\n", "no line below its header"),
        (
            "motion,u_max_mm,overturned\na,,0\n",
            "line 2, u_max_mm = '': .*blank only where overturned",
        ),
        (
            "motion,u_max_mm,overturned\n# x\na,-1,0\n",
            "line 3, u_max_mm = '-1': must be a number of at least 0",
        ),
        ("motion,u_max_mm,overturned\na,nan,0\n", "line 2, u_max_mm"),
        (
            "motion,u_max_mm,overturned\na,1,maybe\n",
            "line 2, overturned = 'maybe': must be one of 1, true",
        ),
        ("motion,u_max_mm,overturned\na,1,0\na,2,0\n", "line 3, motion = 'a': stands twice"),
        ("motion,u_max_mm,overturned\n,1,0\n", "line 2, motion = '': must be a name"),
        ("motion,u_max_mm,overturned\na,1\n", "line 2: has 2 columns where the header has 3"),
    ],
)
def test_what_cannot_be_used_is_named_by_line_and_column(tmp_path, text, said):
    with pytest.raises(InputError, match=said) as caught:
        read_maxima(written(tmp_path, text))
    assert str(caught.value).startswith(str(tmp_path / "tests.csv"))


def test_missing_file_and_binary_file(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_maxima(tmp_path / "none.csv")
    (tmp_path / "picture.csv").write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR")
    with pytest.raises(InputError, match="picture.csv.*not a text file"):
        read_maxima(tmp_path / "picture.csv")
