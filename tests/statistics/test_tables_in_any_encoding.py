"""Tables of text are read as programs for tables write them, whatever their encoding."""

import numpy as np
import pytest

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.intensity_table import read_intensity_table

TABLE = "# Größe in m/s²\npgv,overturned,Nº\n0.25,no,1\n0.75,yes,2\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1", "cp1252"])
def test_a_table_is_the_same_in_each_encoding(encoding, tmp_path):
    path = tmp_path / "runs.csv"
    path.write_bytes(TABLE.encode(encoding))
    table = read_intensity_table(path, ("pgv",))
    assert np.array_equal(table.measures["pgv"], [0.25, 0.75])
    assert np.array_equal(table.overturned, [False, True])


@pytest.mark.parametrize("data", [b"pgv,overturned\n\x00\x01", b"\xff\xfep", b"PK\x03\x04\x14\x00"])
def test_what_is_no_text_is_refused(data, tmp_path):
    path = tmp_path / "runs.csv"
    path.write_bytes(data)
    with pytest.raises(InputError, match="runs.csv.*not a text file"):
        read_intensity_table(path)
