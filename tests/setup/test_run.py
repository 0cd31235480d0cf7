"""containers/run hands its command through unaltered, and keeps its own words off stdout."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
RUN = ROOT / "containers" / "run"
SCRIPTS = [RUN, ROOT / "containers" / "check-bare-debian", ROOT / ".ci" / "run"]


@pytest.fixture(scope="module", autouse=True)
def environment_of_the_tests(tmp_path_factory):
    """A view of the environment that runs the tests, with a stamp of its own: `run` would renew
    another one below their feet.
    """
    folder = tmp_path_factory.mktemp("environment")
    for entry in Path(sys.prefix).iterdir():
        if entry.name != "stamp":
            (folder / entry.name).symlink_to(entry)
    name = next(line for line in RUN.read_text().splitlines() if line.startswith("fingerprint()"))
    report = subprocess.run(
        ["bash", "-c", f"{name}; here={RUN.parent} root={ROOT}; fingerprint"],
        capture_output=True,
        text=True,
        check=True,
    )
    (folder / "stamp").write_text(report.stdout)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FECOLUMN_VENV", str(folder))
        yield folder


def run(*command, **options):
    return subprocess.run([RUN, *command], capture_output=True, text=True, check=False, **options)


def test_the_environment_that_runs_the_tests_is_left_alone(environment_of_the_tests):
    assert run("printenv", "VIRTUAL_ENV").stdout == f"{environment_of_the_tests}\n"


def test_exit_code_is_the_commands():
    assert run("sh", "-c", "exit 7").returncode == 7


def test_arguments_pass_unaltered():
    arguments = ["", "two words", "*", "a\nb", "--help", "'\"$HOME"]
    assert run("printf", "%s|", *arguments).stdout == "".join(
        f"{argument}|" for argument in arguments
    )


def test_stdin_reaches_the_command():
    assert run("cat", input="a column\n").stdout == "a column\n"


def test_no_command_prints_the_usage():
    report = run()
    assert report.returncode == 2
    assert report.stdout == ""
    assert "usage: ./containers/run COMMAND" in report.stderr


def test_second_call_takes_less_than_a_second():
    start = time.perf_counter()
    run("true")
    assert time.perf_counter() - start < 1.0


def test_works_from_another_folder_and_through_a_link(tmp_path):
    link = tmp_path / "run"
    link.symlink_to(RUN)
    report = subprocess.run(
        [link, "pwd"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert report.stdout.strip() == str(tmp_path)


def test_one_thread_unless_told_otherwise():
    bare = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    assert run("printenv", "OMP_NUM_THREADS", env=bare).stdout == "1\n"
    assert run("printenv", "OMP_NUM_THREADS", env=bare | {"OMP_NUM_THREADS": "2"}).stdout == "2\n"


def test_python_is_the_environments_on_the_systems():
    report = run(
        "python", "-c", "import sys; print(sys.base_prefix, sys.prefix != sys.base_prefix)"
    )
    assert report.stdout == "/usr True\n"


def test_pip_refuses_the_h5py_wheel():
    report = run(
        "python", "-m", "pip", "install", "--dry-run", "--no-index", "--ignore-installed", "h5py"
    )
    assert report.returncode != 0
    assert "h5py<0" in report.stdout + report.stderr


def test_the_browser_of_the_tests_is_asked_for_by_pytest_alone(tmp_path):
    asked = tmp_path / "asked"
    (tmp_path / "dpkg-query").write_text(
        f'#!/bin/sh\necho "$@" >>{asked}\nexec /usr/bin/dpkg-query "$@"\n'
    )
    (tmp_path / "dpkg-query").chmod(0o755)
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    assert run("true", env=environment).returncode == 0
    assert "python3-dolfinx" in asked.read_text() and "chromium" not in asked.read_text()
    assert run("pytest", "--version", env=environment).returncode == 0
    assert "chromium-driver" in asked.read_text()


@pytest.mark.parametrize(
    "chosen, code, last",
    [
        (["tests/fem/test_step_kernels.py", "-k", "nearest or mirrored"], 0, "4 passed, 0 failed"),
        (["tests/no_such_test.py"], 1, "0 passed, 1 failed"),
    ],
)
def test_the_test_command_of_every_change_ends_with_a_count(chosen, code, last):
    report = subprocess.run(
        [ROOT / ".ci" / "run", "-n", "0", "-p", "no:cacheprovider", *chosen],
        capture_output=True,
        text=True,
        check=False,
    )
    assert report.returncode == code and report.stdout.splitlines()[-1] == last


@pytest.mark.skipif(not shutil.which("shellcheck"), reason="shellcheck is not installed")
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_scripts_pass_shellcheck(script):
    report = subprocess.run(["shellcheck", script], capture_output=True, text=True, check=False)
    assert report.stdout == ""
