"""One analysis from the command line: what it writes, and that it survives interruption."""

import json
import os
import resource
import signal
import subprocess
import sys
import time

import h5py
import numpy as np
import pytest
from small_case import write_case

from fecolumn import simulation
from fecolumn.cli import main
from fecolumn.engines.dynamics.energy import TERMS

KEYS = """engine kinematics dofs steps dt_s alpha_hht duration_s u_max_m overturned
residual_slide_m wall_s s_per_step iterations factorizations
energy_closure_rel version case_id""".split()
UNITS = {
    "time": "s",
    "u_top": "m",
    "tilt": "rad",
    "twist": "rad",
    "slide": "m",
    "contact_force": "N",
    "ground": "m/s2",
}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Case file and result folder of an uninterrupted analysis with fields."""
    folder = tmp_path_factory.mktemp("whole")
    case = write_case(folder, extra="[output]\nfields_every_s = 0.05\n")
    assert main(["run", str(case), "-o", str(folder / "out"), "-q"]) == 0
    return case, folder / "out"


def _tops(folder):
    with h5py.File(folder / "history.h5") as history:
        return history["u_top"][:]


def test_summary_history_and_figures_are_complete(whole):
    _, out = whole
    summary = json.loads((out / "summary.json").read_text())
    assert set(KEYS) <= set(summary)
    assert summary["steps"] == 100 and summary["energy_closure_rel"] < 1e-4
    with h5py.File(out / "history.h5") as history:
        assert {name: history[name].attrs["unit"] for name in UNITS} == UNITS
        assert all(
            history[f"energy/{term}"].attrs["unit"] == "J" and len(history[f"energy/{term}"]) == 101
            for term in TERMS
        )
        assert np.hypot(*history["u_top"][:, :2].T).max() == pytest.approx(
            summary["u_max_m"], rel=1e-12
        )
        assert history["contact_force"][0, 2] == pytest.approx(_weight(out), rel=1e-6)
    assert {"u_top.png", "path.png", "energy.png"} <= {path.name for path in out.iterdir()}
    assert not list(out.glob(".writing-*")) and not (out / "checkpoint.npz").exists()


def _weight(out):
    """Weight [N] from the mesh alone."""
    from fecolumn.case.sections import GRAVITY
    from fecolumn.mesh.mass import mass_properties
    from fecolumn.mesh.specimen import specimen_mesh
    from fecolumn.simulation import read_folder_case

    case, _ = read_folder_case(out)
    return (
        GRAVITY
        * mass_properties(specimen_mesh(case.short).body, case.short.material.density_kg_m3).mass
    )


def test_fields_open_in_pyvista_and_agree_with_the_history(whole):
    import pyvista

    _, out = whole
    reader = pyvista.get_reader(str(out / "fields" / "fields.xdmf"))
    assert reader.time_values == pytest.approx([0, 0.05, 0.1, 0.15, 0.2])
    reader.set_active_time_value(reader.time_values[-1])
    grid = reader.read()
    displacement, pressure = (
        grid.point_data["displacement [m]"],
        grid.point_data["contact pressure [Pa]"],
    )
    top = grid.points[:, 2] > 0.5099
    assert displacement[top].mean(axis=0) == pytest.approx(_tops(out)[-1], abs=1e-4)
    assert pressure.max() > 0 and np.all(pressure[grid.points[:, 2] > 1e-6] == 0)
    assert 1e4 < grid.cell_data["von Mises stress [Pa]"].max() < 1e9


def test_second_run_into_the_folder_gives_the_same_answer_at_once(whole, capsys):
    case, out = whole
    before = {file: file.stat().st_mtime_ns for file in out.iterdir()}
    assert main(["run", str(case), "-o", str(out), "-q"]) == 0
    assert {
        file: file.stat().st_mtime_ns for file in out.iterdir()
    } == before  # no figure is drawn again either
    assert "100 steps" in capsys.readouterr().out


def test_folder_of_another_case_is_refused_and_kept(whole, tmp_path, capsys):
    _, out = whole
    before = (out / "summary.json").read_bytes()
    assert main(["run", str(write_case(tmp_path, duration=0.1)), "-o", str(out), "-q"]) == 2
    assert "another case" in capsys.readouterr().err
    assert (out / "summary.json").read_bytes() == before


@pytest.mark.parametrize(
    "signal_, code",
    [
        (signal.SIGINT, 130),
        pytest.param(signal.SIGTERM, 130, marks=pytest.mark.slow),
        (signal.SIGKILL, -9),
    ],
)
def test_interrupted_and_resumed_equals_uninterrupted(whole, tmp_path, signal_, code):
    case = write_case(
        tmp_path, extra="[output]\nfields_every_s = 0.05\ncheckpoint_every_s = 0.05\n"
    )
    out = tmp_path / "out"
    process = subprocess.Popen(
        [sys.executable, "-m", "fecolumn.cli", "run", str(case), "-o", str(out)],
        stderr=subprocess.DEVNULL,
    )
    while not (out / "checkpoint.npz").exists() and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal_)
    assert process.wait() == code
    assert not (out / "summary.json").exists()
    if signal_ == signal.SIGKILL:
        assert main(["resume", str(out), "-q"]) == 0
    else:  # the same without its figures, which take longer than the analysis
        simulation.run(simulation.read_folder_case(out)[0], out, quiet=True)
    exact = _tops(whole[1])
    np.testing.assert_allclose(_tops(out), exact, rtol=0, atol=1e-10 * np.abs(exact).max())


def test_failed_step_saves_its_state_and_says_why(tmp_path, capsys):
    case = write_case(tmp_path, extra="tolerance = 1e-15\nmax_iterations = 2\nmax_cuts = 1\n")
    text = case.read_text().replace("dt_s = 2e-3", 'dt_s = 0.02\nkinematics = "total_lagrangian"')
    case.write_text(text)
    assert main(["run", str(case), "-o", str(tmp_path / "out"), "-q"]) == 1
    message = capsys.readouterr().err
    assert (
        "t = " in message
        and "step cut 1 times" in message
        and "checkpoint.npz" in message
        and "Traceback" not in message
    )
    assert (tmp_path / "out" / "checkpoint.npz").is_file() and (
        tmp_path / "out" / "history.h5"
    ).is_file()


def test_column_that_slides_off_the_base_says_so_and_is_no_failure(tmp_path, capsys):
    case = write_case(tmp_path, duration=2.0)
    case.write_text(
        case.read_text().replace("length_m = 0.3\nwidth_m = 0.3", "length_m = 0.13\nwidth_m = 0.13")
        + "[contact]\nfriction_coefficient = 0.01\n"
    )
    assert main(["run", str(case), "-o", str(tmp_path / "out"), "-q"]) == 0
    assert "slid off" in capsys.readouterr().out
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert (
        summary["outcome"] == "slid off"
        and summary["slid_off"]
        and summary["u_max_censored"]
        and not summary["overturned"]
    )


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"], ["study", "--help"]])
def test_help_loads_no_library(words):
    """numpy alone takes a tenth of a second, dolfinx two."""
    code = (
        f"import sys; from fecolumn.cli import main\ntry: main({words})\nexcept SystemExit: pass\n"
        "print(sorted({'numpy', 'dolfinx', 'matplotlib', 'mpi4py'} & "
        "set(sys.modules)), file=sys.stderr)"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=os.environ
    )
    assert result.stderr.strip() == "[]", result.stderr
    assert "usage: fecolumn" in result.stdout


def test_full_disk_stops_in_one_line_and_the_same_command_goes_on(whole, tmp_path, capsys):
    """A limit on the size of files is to a program what a full disk is; it lets case.json pass and
    no checkpoint.
    """
    case = write_case(tmp_path, extra="[output]\nfields_every_s = 0.05\ncheckpoint_every_s = 0.2\n")
    out, limits = tmp_path / "out", resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, limits[1]))
    try:
        assert main(["run", str(case), "-o", str(out), "-q"]) == 1
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    message = capsys.readouterr().err
    assert "the disk is full" in message and message.count("\n") == 1
    assert not list(out.rglob(".writing-*"))
    assert main(["run", str(case), "-o", str(out), "-q"]) == 0
    np.testing.assert_array_equal(_tops(out), _tops(whole[1]))
