"""Motions and ensembles that are damaged behind the reader's back, ask for gigabytes, or are no
files at all.
"""

import os
import subprocess
import sys

import h5py
import numpy as np
import pytest
from record_files import write_at2

from fecolumn.case.sections import Motion
from fecolumn.foundation import sealed
from fecolumn.foundation.schema import InputError
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import members, read_ensemble, read_member, write_ensemble
from fecolumn.motions.load import load_motion
from fecolumn.motions.record import GroundMotion, UnusableRecord


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Bytes of an ensemble, sealed."""
    rng, file = np.random.default_rng(0), tmp_path_factory.mktemp("whole") / "e.h5"
    write_ensemble(
        Ensemble(
            "noise",
            tuple(GroundMotion(rng.standard_normal((400, 3)), 0.01, str(i), "") for i in range(2)),
            {},
            {},
        ),
        file,
    )
    return file.read_bytes()


def _read_all(path):
    return [read_ensemble(path), *map(read_member, members(f"{path}#*"))]


def test_any_flipped_byte_of_an_ensemble_is_found_out(whole, tmp_path):
    path, rng = tmp_path / "e.h5", np.random.default_rng(1)
    for number, place in enumerate(rng.integers(8, len(whole) - 90, size=200)):
        changed = bytearray(whole)
        changed[place] ^= 1 << rng.integers(8)
        path = tmp_path / f"{number}.h5"
        path.write_bytes(changed)
        with pytest.raises(UnusableRecord, match="not what its checksum says"):
            read_ensemble(path)


def test_hdf5_of_another_program_is_an_ensemble_without_a_seal(whole, tmp_path):
    content = whole[: -len(sealed.sealed(b""))]
    (tmp_path / "e.h5").write_bytes(content)
    assert len(_read_all(tmp_path / "e.h5")) == 3


def test_damaged_hdf5_without_a_seal_never_ends_the_process(whole, tmp_path):
    content, rng = whole[: -len(sealed.sealed(b""))], np.random.default_rng(5)
    refused = 0
    for number in range(6):
        changed = bytearray(content)
        for place in rng.integers(8, 3000, size=6):  # where the structure is
            changed[place] ^= 1 << rng.integers(8)
        path = tmp_path / f"{number}.h5"
        path.write_bytes(changed)
        try:
            _read_all(path)
        except UnusableRecord as error:
            refused += 1
            assert "\n" not in str(error)
    assert refused >= 2


def test_reader_that_crashes_or_hangs_is_told_as_damage(whole, tmp_path, monkeypatch):
    for name, code, said in (
        ("crash", "import os; os.abort()", "ended the reader by SIGABRT"),
        ("hang", "import time; time.sleep(60)", "within 0.3 s"),
    ):
        (tmp_path / f"{name}.h5").write_bytes(whole[: -len(sealed.sealed(b""))])
        monkeypatch.setattr(sealed, "_READER", code)
        monkeypatch.setattr(sealed, "_PATIENCE_S", 60.0 if name == "crash" else 0.3)
        with pytest.raises(UnusableRecord, match=said):
            read_ensemble(tmp_path / f"{name}.h5")


def _foreign(path, shape=(10, 3), dt=0.01, fill=1.0, **links):
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": "fecolumn ensemble 1", "name": "x", "provenance": "{}"})
        stored = file.create_dataset("motions/0001", shape, "f8", fillvalue=fill)
        stored.attrs.update({"dt_s": dt, "name": "x", "source": ""})
        file.create_group("parameters")
        for name, link in links.items():
            file[name] = link


@pytest.mark.parametrize(
    "make, said",
    [
        (lambda path: _foreign(path, (10, 2)), "shape"),
        (lambda path: _foreign(path, (1, 3)), "shape"),
        (lambda path: _foreign(path, (10, 3), dt=0.0), "dt"),
        (lambda path: _foreign(path, (10, 3), dt=np.nan), "dt"),
        (lambda path: _foreign(path, (10, 3), dt=1e9), "sampled at"),
        (lambda path: _foreign(path, fill=np.nan), "acceleration of nan"),
        (lambda path: _foreign(path, fill=1e300), "acceleration of 1e.300"),
        (lambda path: _foreign(path, (10**12, 3)), "2 GB"),
        (lambda path: _foreign(path, there=h5py.ExternalLink("/dev/zero", "/")), "links"),
        (os.mkfifo, "device or a pipe"),
        (lambda path: os.symlink("/dev/zero", path), "device or a pipe"),
        (os.mkdir, "directory"),
    ],
)
@pytest.mark.timeout(60)
def test_foreign_file_that_is_no_ensemble_is_refused(tmp_path, make, said):
    make(tmp_path / "e.h5")
    with pytest.raises(UnusableRecord, match=said):
        _read_all(tmp_path / "e.h5")


def _rows(time):
    return "".join(f"{t!r} {0.1 * np.sin(i):.5f}\n" for i, t in enumerate(time))


STEPS = [0.01 * i for i in range(200)]


@pytest.mark.long
@pytest.mark.parametrize(
    "rows, keys, dt, said",
    [
        (
            _rows([1e12 + 0.01 * i for i in range(200)]),
            {},
            1e-3,
            "do not tell steps of 0.01 s apart",
        ),
        (_rows([*STEPS[:100], *(t + 1e9 for t in STEPS[100:])]), {}, 1e-3, "without gaps"),
        (_rows([0.0, 1e12]), {}, 1e-3, "sampled at 1e.12 s; must be in"),
        (_rows([0.0, 1e-300]), {}, 1e-3, "sampled at 1e-300 s"),
        (_rows([-1e308, 1e308]), {}, 1e-3, "times must be at most"),
        (_rows(STEPS), {}, 1e-12, "integration.dt_s = 1e-12: must be at least"),
        (_rows(STEPS), {"delay_s": 1e3}, 1e-6, "integration.dt_s"),
        (
            _rows([1e-6 * i for i in range(60_000)]),
            {},
            0.05,
            "integration.dt_s = 0.05: must be at most",
        ),
        ("0 1e300\n0.01 2\n0.02 3\n", {}, 1e-3, "must be finite and at most"),
        ("0 " + "9" * 5000 + "\n1 1\n", {}, 1e-3, "finite"),
    ],
)
def test_time_or_values_that_no_motion_has_are_refused_before_memory_is_asked_for(
    tmp_path, rows, keys, dt, said
):
    (tmp_path / "m.txt").write_text(rows)
    with pytest.raises(InputError, match=said) as caught:
        load_motion(Motion(str(tmp_path / "m.txt"), units="g", **keys), dt, "case.toml")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("points", ["999999999999999", "9" * 5000, "0"])
def test_at2_header_of_more_values_than_there_are_is_refused(tmp_path, points):
    path = write_at2(tmp_path / "a.AT2")
    text = path.read_text()
    stated = text.split("NPTS=")[1].split(",")[0]
    path.write_text(text.replace(stated, f" {points}", 1))
    with pytest.raises(InputError, match="the header states NPTS = .* values follow") as caught:
        load_motion(Motion(str(path)), 1e-3, "case.toml")
    assert len(str(caught.value)) < 1000


@pytest.mark.timeout(20)
@pytest.mark.parametrize("make", [os.mkfifo, lambda path: os.symlink("/dev/zero", path)])
def test_motion_that_is_a_device_or_a_pipe_is_refused(tmp_path, make):
    make(tmp_path / "m.txt")
    with pytest.raises(InputError, match="motion.source.*device or a pipe"):
        load_motion(Motion(str(tmp_path / "m.txt")), 1e-3, "case.toml")


_LICK = (
    "from fecolumn.motions.lick import lick_source; from fecolumn.motions.ensemble_file "
    "import read_member; print(len(read_member(lick_source('lick:7')).acceleration))"
)


@pytest.mark.long
def test_processes_that_ask_for_the_lick_ensemble_at_once_all_get_it(tmp_path):
    """As the tasks of a job array on a fresh cache; a damaged file in the cache is made anew."""
    environment = os.environ | {"FECOLUMN_CACHE": str(tmp_path)}
    for _ in range(2):
        tasks = [
            subprocess.Popen(
                [sys.executable, "-c", _LICK],
                env=environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            for _ in range(2)
        ]
        ends = [task.communicate(timeout=300) for task in tasks]
        assert [task.returncode for task in tasks] == [0, 0], ends
        (file,) = tmp_path.iterdir()
        assert file.name.startswith("lick-")
        data = bytearray(file.read_bytes())
        data[len(data) // 2] ^= 1
        file.write_bytes(data)
