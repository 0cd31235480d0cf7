"""Records as spreadsheets, pandas and recorders write them: quotes, decimal commas, channel codes,
columns beside the acceleration, units in any place, arrays in HDF5.
"""

import h5py
import numpy as np
import pytest
from record_files import write_text

from fecolumn.case.sections import GRAVITY, Motion
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.motions.columns import read_columns
from fecolumn.motions.load import read_motion
from fecolumn.motions.record import UnusableRecord

TIMES = (0.0, 0.01, 0.02)
X, Y, Z = (0.1, -0.2, 0.3), (0.4, 0.5, -0.6), (0.7, 0.8, 0.9)


def table(header, *columns, between=",", comma=False, quotes=False):
    lines = [
        between.join(
            f'"{text}"' if quotes else text
            for text in (f"{value:g}".replace(".", "," if comma else ".") for value in row)
        )
        for row in zip(*columns)
    ]
    return "\n".join([header, *lines]) + "\n"


def read(folder, text):
    return read_columns(write_text(folder / "a.csv", text), 0.0)


@pytest.mark.parametrize(
    "text",
    [
        table('"time_s","ax_g"', TIMES, X, quotes=True, comma=True),
        table('"time_s","ax_g"', TIMES, X, quotes=True),
        table('"time_s";"ax_g"', TIMES, X, quotes=True, comma=True, between=";"),
        table("time_s\tax_g", TIMES, X, comma=True, between="\t"),
        table(",time_s,ax_g", (0, 1, 2), TIMES, X),
        table("\ttime_s\tax_g", (0, 1, 2), TIMES, X, between="\t"),
        table("Unnamed: 0,time_s,ax_g", (0, 1, 2), TIMES, X),
        table(",ax_g", TIMES, X),
        table("Station 1\nTime,X\n(s),(g)", TIMES, X),
        table("Time;X\ns;g", TIMES, X, between=";", comma=True),
        table("Time X\n[s] [g]", TIMES, X, between="  "),
        table("time_s;ax_g;;", TIMES, X, between=";").replace("\n", ";;\n") + ";;;\n;;;\n",
    ],
    ids=[
        "quoted commas",
        "quoted points",
        "quoted semicolons",
        "tabs",
        "index",
        "index of tabs",
        "index named twice",
        "time as index",
        "units below",
        "bare units below",
        "units below by blanks",
        "empty cells",
    ],
)
def test_one_component_in_many_dialects(tmp_path, text):
    found = read(tmp_path, text)
    assert found.values[:, 0] == pytest.approx(X)
    assert (found.axes, found.units, found.dt) == (("x",), "g", pytest.approx(0.01))


@pytest.mark.parametrize(
    "header",
    [
        "Time [s],HNE [g],HNN [g],HNZ [g]",
        "time_s,bne_g,bnn_g,bnz_g",
        "t,IU.ANMO.20.HN2 [g],IU.ANMO.20.HN1 [g],IU.ANMO.20.HN3 [g]",
        "Time,X,Y,Z\n(s),(g),(g),(g)",
    ],
)
def test_channels_of_accelerographs_are_east_north_up(tmp_path, header):
    found = read(tmp_path, table(header, TIMES, X, Y, Z))
    assert found.axes == ("x", "y", "z") and found.units == "g"
    assert found.values.T.tolist() == [list(X), list(Y), list(Z)]


@pytest.mark.parametrize(
    "name, axis",
    [
        ("Acceleration Y [m/s/s]", "y"),
        ("acc. vertical [gal]", "z"),
        ("acceleration vertical [gal]", "z"),
        ("Ground acceleration in north direction (m s-2)", "y"),
        ("Accel. East (m s^-2)", "x"),
        ("Acceleration [g]", ""),
        ("ground acceleration e-w component [g]", "x"),
    ],
)
def test_an_axis_that_is_written_out_is_that_axis(tmp_path, name, axis):
    found = read(tmp_path, table(f"Time (sec);{name}", TIMES, X).replace(",", ";"))
    assert found.axes == (axis,) and found.values[:, 0].tolist() == list(X)


def test_info_tells_the_unit_of_the_file_where_it_is_not_ours(tmp_path, capsys):
    read(tmp_path, table("time [s],acc_ft_s2", TIMES, X))
    assert main(["motions", "info", str(tmp_path / "a.csv")]) == 0
    assert "(in ft/s2, 0.3048 m/s2)" in capsys.readouterr().out


def test_an_empty_cell_is_named(tmp_path):
    text = table("time [s],acc [g]", (*TIMES, 0.03), (*X, 0.4)).replace("0.02,0.3", "0.02,")
    with pytest.raises(UnusableRecord, match="line 4: 1 columns where 2 are usual: column 2 is em"):
        read(tmp_path, text)


def test_velocities_and_displacements_beside_accelerations_are_passed_over(tmp_path, capsys):
    for header in (
        "time_s,acc_m_s2,vel_m_s,disp_m",
        "t [s],a [m/s2],v [cm/s],d [cm]",
        "time [s],HNE [m/s2],HHE,ground [mm]",
    ):
        found = read(tmp_path, table(header, TIMES, X, Y, Z))
        assert found.values[:, 0].tolist() == list(X) and found.units == "m/s2"
    assert main(["motions", "info", str(tmp_path / "a.csv")]) == 0
    assert "(passed over: hhe, ground)" in capsys.readouterr().out


@pytest.mark.parametrize(
    "unit, read_as, factor",
    [
        ("acc_ft_s2", "m/s2", 0.3048),
        ("acc [ft/s^2]", "m/s2", 0.3048),
        ("acc_%g", "g", 0.01),
        ("acc (%g)", "g", 0.01),
        ("Acc(mg)", "g", 1e-3),
        ("signal [ft/s2]", "m/s2", 0.3048),
    ],
)
def test_units_of_recorders_become_ours(tmp_path, unit, read_as, factor):
    found = read(tmp_path, table(f"time [s],{unit}", TIMES, X))
    assert found.units == read_as
    assert found.values[:, 0] == pytest.approx(factor * np.array(X), rel=1e-12)


@pytest.mark.parametrize(
    "header, said",
    [
        ("time [s],force [kN]", "unit 'kN' of column 'force' is not known as one of an accel"),
        ("time [s],temperature [C]", "unit 'C' of column 'temperature'"),
        ("time_s,force_kn", "unit 'kn' of column 'force'"),
        ("time_s,acc_m", "unit 'm' of column 'acc'"),
        ("time [s],acc [V]", "unit 'V' of column 'acc'"),
        ("Time,Signal\n(s),(V)", "unit 'V' of column 'signal'"),
        ("time_s,vx_m_s", r"column 'vx' is not known as an acceleration: it is a velocity or a di"),
        ("time_s,d_m", r"displacement \[m\]"),
        ("time_s,HHE", "second letter H of a channel stands for a velocity, N for an acceleratio"),
        ("time_min,signal", "time in 'min' is not known"),
        ("index,acc", "'index' is not known"),
        (",sample", "'sample' is not known"),
    ],
)
def test_what_is_no_acceleration_is_refused_with_its_unit(tmp_path, header, said):
    with pytest.raises(UnusableRecord, match=said):
        read(tmp_path, table(header, (0.01, 0.02, 0.03), X))


def test_index_without_a_time_leaves_the_step_to_the_case(tmp_path):
    found = read(tmp_path, table(",ax_g", (0, 1, 2), X))
    assert found.dt is None and found.values.T.tolist() == [list(X)]


def test_columns_that_only_count_are_no_record(tmp_path):
    with pytest.raises(UnusableRecord, match="holds no acceleration"):
        read(tmp_path, table(",sample", (0, 1, 2), (0, 1, 2)))


def test_decimal_commas_and_points_in_one_column_are_refused(tmp_path):
    with pytest.raises(UnusableRecord, match="line 3: '1,234' has a decimal comma where '0.5'"):
        read(tmp_path, 'time_s,ax_g\n0.01,0.5\n0.02,"1,234"\n')


def write_arrays(path, attributes=(), of_array=(), **arrays):
    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[name] = values
        file.attrs.update(dict(attributes))
        for name, value in dict(of_array).items():
            file["acc"].attrs[name] = value
    return str(path)


WAVE = 0.3 * np.sin(np.arange(50))


@pytest.mark.parametrize(
    "content",
    [
        {"acc": WAVE, "time": 0.02 * np.arange(50), "of_array": {"units": "g"}},
        {"acc": WAVE[:, None], "attributes": {"dt": 0.02, "unit": b"g"}},
        {"acc": 100 * WAVE, "dt": 0.02, "of_array": {"units": "%g"}},
        {"acceleration": np.stack([WAVE, WAVE, WAVE], 1), "dt": [0.02], "units": "g"},
    ],
    ids=["times", "attributes", "array of dt", "three components"],
)
def test_arrays_of_hdf5_are_a_record(tmp_path, content, capsys):
    path = write_arrays(tmp_path / "a.h5", **content)
    found = read_motion(Motion(path), "case.toml")
    assert found.dt == pytest.approx(0.02)
    assert found.acceleration[:, 0] == pytest.approx(GRAVITY * WAVE)
    assert main(["motions", "info", path]) == 0
    assert "arrays of HDF5, 50 samples, dt 0.02 s" in capsys.readouterr().out


@pytest.mark.parametrize(
    "content, said",
    [
        ({"displacement": WAVE}, "holds displacement at its top; needs an array acc"),
        ({"acc": WAVE, "dt": 0.02}, "motion.units = '': must be one of g"),
        ({"acc": WAVE, "attributes": {"units": "g"}}, "motion.dt_s = 0.0: must be given"),
        ({"acc": WAVE, "dt": 0.02, "attributes": {"units": "kN"}}, "unit 'kN' is not known"),
        ({"acc": np.ones((3, 50)), "dt": 0.02}, r"shape \(3, 50\); needs an array"),
        ({"acc": WAVE, "time": np.arange(9.0)}, "has 9 times for 50 samples"),
        ({"acc": WAVE, "time": np.r_[0:49, 60.0]}, "sample 50: step of 12 s"),
        ({"acc": WAVE + np.nan, "dt": 0.02}, "every value must be finite"),
        ({"acc": WAVE, "dt": -1.0, "attributes": {"units": "g"}}, "must be one number above 0"),
        ({"acc": [b"a", b"b"], "dt": 0.02}, "is no array of numbers"),
    ],
)
def test_arrays_that_are_no_record_are_refused(tmp_path, content, said):
    path = write_arrays(tmp_path / "a.h5", **content)
    with pytest.raises(InputError, match=said) as caught:
        read_motion(Motion(path), "case.toml")
    assert "\n" not in str(caught.value)


def test_an_ensemble_without_a_number_is_told_how_to_name_a_motion(tmp_path):
    path = write_arrays(tmp_path / "a.h5", {"format": "fecolumn ensemble 1"}, acc=WAVE)
    with pytest.raises(InputError, match="is an ensemble: name a motion of it, as in .*a.h5#1"):
        read_motion(Motion(path), "case.toml")
