"""The doctor names what is installed, and tells a trap from a fit machine without ever falling into
it.
"""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from fecolumn import doctor


def run_doctor(folder, *arguments):
    """Doctor as a program of its own, with modules of `folder` in place of the installed ones."""
    command = [sys.executable, "-P", doctor.__file__, *arguments]
    environment = {"PATH": "/usr/bin:/bin", "PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1"}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def findings():
    return {
        finding.component: finding
        for finding in doctor.look_at_machine() + doctor.look_at_libraries()
    }


def test_this_machine_is_fit_to_run(findings):
    assert [finding.warning for finding in findings.values() if not finding.fit] == []


def test_versions_are_those_of_the_imported_libraries(findings):
    import dolfinx
    import numpy

    assert findings["dolfinx"].version == dolfinx.__version__
    assert findings["numpy"].version == numpy.__version__


def test_h5py_is_debians_and_not_a_wheel(findings):
    assert doctor.origin("h5py") == "Debian"
    assert findings["h5py"].note.startswith("Debian")


def test_blas_is_not_the_reference_one(findings):
    assert findings["BLAS"].version != "blas"


def test_missing_library_is_a_line_of_the_table(tmp_path):
    (tmp_path / "dolfinx.py").write_text("raise ModuleNotFoundError(\"No module named 'dolfinx'\")")
    report = run_doctor(tmp_path)
    assert report.returncode == 1
    assert "ERROR: dolfinx: No module named 'dolfinx'" in report.stdout
    assert "Traceback" not in report.stdout + report.stderr


def test_library_that_crashes_does_not_end_the_table(tmp_path):
    (tmp_path / "gmsh.py").write_text("import os, signal; os.kill(os.getpid(), signal.SIGKILL)")
    report = run_doctor(tmp_path)
    assert report.returncode == 1
    assert "ERROR: Gmsh: ends the process with exit code -9" in report.stdout
    assert "python -c 'import gmsh'" in report.stdout
    assert any(line.split()[:2] == ["meshio", "5.3.5"] for line in report.stdout.splitlines())


def test_h5py_wheel_is_named_and_not_imported(tmp_path):
    package = tmp_path / "h5py"
    package.mkdir()
    (package / "__init__.py").write_text("raise SystemExit('imported')")
    report = run_doctor(tmp_path)
    assert report.returncode == 1
    assert f"ERROR: h5py: a wheel in {tmp_path}" in report.stdout
    assert "pip uninstall h5py" in report.stdout


def test_numpy_wheel_is_warned_of(tmp_path):
    wheel = Path(doctor.importlib.util.find_spec("numpy").origin).parent
    (tmp_path / "numpy").symlink_to(wheel)
    report = run_doctor(tmp_path)
    assert "warning: numpy: petsc4py was built for Debian's numpy" in report.stdout


def test_what_explains_a_crash_is_a_module():
    for name in doctor.LIBRARIES:
        module = doctor.MODULES.get(name, name)
        assert importlib.util.find_spec(module.partition(".")[0]), module


def test_a_system_without_its_release_is_unknown(tmp_path, monkeypatch):
    monkeypatch.setattr(doctor, "OS_RELEASE", tmp_path / "none")
    assert doctor.look_at_machine()[0].version == "unknown"
