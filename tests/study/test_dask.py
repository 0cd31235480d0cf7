"""A study on the workers of a scheduler of dask.distributed: the tables of local processes,
whatever workers die.
"""

import contextlib
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.study import dask
from fecolumn.study.plan import read_plan
from fecolumn.study.run import StudyError, complete_study
from fecolumn.study.store import read_study
from fecolumn.study.table import write_tables

pytest.importorskip(
    "distributed", reason="dask.distributed is not installed: pip install distributed"
)
# a scheduler and workers of their own in every test but one, two minutes in all
pytestmark = pytest.mark.slow

HERE = Path(__file__).parent
TABLES = ("table.csv", "analyses.csv")


def _start(*command, cwd=None, **more) -> subprocess.Popen:
    paths = os.pathsep.join(
        [str(HERE.parents[1]), str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])]
    )
    return subprocess.Popen(
        [sys.executable, "-m", *map(str, command)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": paths, **more},
    )


class Cluster:
    """A scheduler on the loopback device and its workers, processes of their own."""

    def __init__(self, **more):
        self.scheduler = _start(
            "distributed.cli.dask_scheduler",
            "--host",
            "127.0.0.1",
            "--port",
            0,
            "--no-dashboard",
            "--no-show",
            **more,
        )
        self.workers = []
        for line in self.scheduler.stdout:
            if found := re.search(r"tcp://127\.0\.0\.1:\d+", line):
                self.address = found[0]
                break

    def worker(self, threads=1, cwd=None, **more) -> subprocess.Popen:
        self.workers.append(
            _start(
                "distributed.cli.dask_worker",
                self.address,
                "--nthreads",
                threads,
                "--no-nanny",
                "--no-dashboard",
                cwd=cwd,
                **more,
            )
        )
        return self.workers[-1]

    def end(self) -> None:
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.communicate()


@pytest.fixture
def cluster():
    """Makes a cluster of so many workers, and ends it with the test."""
    with contextlib.ExitStack() as ends:

        def make(workers=2, scheduler=None, **more) -> Cluster:
            made = Cluster(**(scheduler or {}))
            ends.callback(made.end)
            for _ in range(workers):
                made.worker(**more)
            return made

        yield make


def _study_on(cluster, study, out) -> subprocess.Popen:
    return _start(
        "fecolumn.cli", "study", study, "-o", out, "--entry", ENTRY, "--scheduler", cluster.address
    )


def _calls(folder) -> dict[str, list[str]]:
    return {
        file.parent.name: file.read_text().split()[::2] for file in folder.glob("analyses/*/calls")
    }


def _tables(folder) -> list[bytes]:
    return [(folder / name).read_bytes() for name in TABLES]


def _wait_for(condition, process) -> None:
    end = time.monotonic() + 60
    while not condition():
        assert process.poll() is None and time.monotonic() < end, process.communicate()[0]
        time.sleep(0.02)


def _local(tmp_path, study) -> list[bytes]:
    plan = read_plan(study)
    write_tables(
        plan,
        complete_study(plan, tmp_path / "local", workers=2, entry=ENTRY, stream=io.StringIO()),
        tmp_path / "local",
    )
    return _tables(tmp_path / "local")


def test_whatever_is_killed_the_tables_are_those_of_local_processes(tmp_path, cluster):
    study, out = write_study(tmp_path, pulses=[*range(6), "diverges"]), tmp_path / "out"
    three = cluster(3, ROCKING_BLOCK_SLEEP_S="0.1")
    driver = _study_on(three, study, out)
    _wait_for(lambda: len(list(out.glob("analyses/*/summary.json"))) >= 4, driver)
    driver.send_signal(signal.SIGKILL)
    driver.communicate()
    driver = _study_on(three, study, out)
    _wait_for(lambda: len(list(out.glob("analyses/*/summary.json"))) >= 12, driver)
    finished = {file: file.stat().st_mtime_ns for file in out.glob("analyses/*/summary.json")}
    three.workers[0].kill()
    said, _ = driver.communicate(timeout=120)
    assert (
        driver.returncode == 1
        and said.count("step 17 did not converge") == 4
        and "Traceback" not in said
    ), said
    assert {
        file: file.stat().st_mtime_ns for file in finished
    } == finished  # nothing finished is lost or made again
    calls = _calls(out)
    assert {pid for pids in calls.values() for pid in pids} == {
        str(worker.pid) for worker in three.workers
    }
    # else only what was in hand, and what diverges
    assert sum(map(len, calls.values())) <= 28 + 2 * 4 + 2 + 4
    assert _tables(out) == _local(tmp_path, study)


def test_what_kills_its_worker_is_made_again_elsewhere(tmp_path, cluster):
    study, out = (
        write_study(tmp_path, dt=[1e-3], alpha=[0], pulses=["killed", 1, 2]),
        tmp_path / "out",
    )
    said, _ = (driver := _study_on(cluster(), study, out)).communicate(timeout=120)
    assert driver.returncode == 0, said
    assert sorted(map(len, _calls(out).values())) == [1, 1, 2]


BLOCK = """
[case]
column = {shape = "block", length_m = 0.4, width_m = 0.4, height_m = 1.2}
mesh = {fine_size_m = 0.1, coarse_size_m = 0.2}
initial = {tilt_rad = 0.1}
integration = {duration_s = 0.05}
[axes]
"contact.friction_coefficient" = [0.3, 0.8]
"""


def test_finite_elements_work_in_the_threads_of_a_dask_worker(tmp_path, cluster):
    (study := tmp_path / "study.toml").write_text(BLOCK)
    one = cluster(workers=1)
    driver = _start(
        "fecolumn.cli", "study", study, "-o", tmp_path / "out", "--scheduler", one.address
    )
    said, _ = driver.communicate(timeout=400)
    assert driver.returncode == 0 and "2 of 2 analyses done" in said, said


def test_what_kills_as_many_workers_as_the_scheduler_allows_has_failed_alone(tmp_path, cluster):
    study, out = (
        write_study(tmp_path, dt=[1e-3], alpha=[0], pulses=[1, "killed", 2, 3]),
        tmp_path / "out",
    )
    strict = cluster(scheduler={"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"})
    said, _ = (driver := _study_on(strict, study, out)).communicate(timeout=120)
    assert driver.returncode == 1, said
    failed = {
        row["axes"]["motion.source"]: row["reason"]
        for row in read_study(out).rows
        if row["state"] != "done"
    }
    assert failed == {"pulse:killed": "1 workers died of it (out of memory?)"}


def test_a_scheduler_that_ends_stops_the_study_in_one_line(tmp_path, cluster):
    study, out = write_study(tmp_path), tmp_path / "out"
    one = cluster(workers=1, ROCKING_BLOCK_SLEEP_S="0.3")
    driver = _study_on(one, study, out)
    _wait_for(lambda: list(out.glob("analyses/*/summary.json")), driver)
    one.scheduler.kill()
    said, _ = driver.communicate(timeout=60)
    assert driver.returncode == 1 and "Traceback" not in said, said
    assert (
        f"the scheduler {one.address} is out of reach; nothing done is lost, the same "
        "command does the rest\n" in said
    )


@pytest.fixture(scope="module")
def other_code(tmp_path_factory):
    """A copy of the package in which one source differs, and a folder in which it is in the way of
    the right one.
    """
    folder = tmp_path_factory.mktemp("other")
    os.makedirs(folder / "old")
    shutil.copytree(HERE.parents[1] / "fecolumn", folder / "old" / "fecolumn")
    with open(folder / "old" / "fecolumn" / "case" / "sections.py", "a") as file:
        file.write("# another\n")
    (folder / "none" / "fecolumn").mkdir(parents=True)
    (folder / "none" / "fecolumn" / "__init__.py").write_text(
        "raise ImportError('no fecolumn here')\n"
    )
    return folder


@pytest.mark.parametrize(
    "there, threads, words",
    [
        (
            "old",
            1,
            r"has fecolumn \S+ \(sources \w{16}\), the driver fecolumn \S+ \(sources "
            r"\w{16}\): install the same on both",
        ),
        ("none", 1, "has no fecolumn that could work for .*no fecolumn here"),
        ("", 3, "has 3 threads, but an analysis needs a process of its own"),
    ],
)
def test_a_worker_that_cannot_do_analyses_is_refused_in_one_line(
    tmp_path, cluster, other_code, capsys, there, threads, words
):
    one = cluster(workers=0)
    paths = [str(other_code / there)] * bool(there) + list(
        filter(None, [str(HERE.parents[1]), os.environ.get("PYTHONPATH")])
    )
    one.worker(threads=threads, cwd=other_code / there, PYTHONPATH=os.pathsep.join(paths))
    assert (
        main(
            [
                "study",
                str(write_study(tmp_path)),
                "-o",
                str(tmp_path / "out"),
                "--scheduler",
                one.address,
            ]
        )
        == 2
    )
    said = capsys.readouterr().err
    assert re.fullmatch(
        rf"fecolumn: fecolumn study: --scheduler = '{one.address}': the worker tcp://\S+ "
        rf"{words}.*\n",
        said,
    ), said
    assert not (tmp_path / "out").exists()


def test_a_scheduler_out_of_reach_or_without_workers_is_refused_in_one_line(monkeypatch, cluster):
    monkeypatch.setattr(dask, "_ALONE_S", 0.5)
    monkeypatch.setattr(dask, "_REACH_S", 2.0)
    for address, words in [
        ("tcp://127.0.0.1:9", "no scheduler is found there"),
        ("nonsense://x", "no scheduler is found there"),
        (
            cluster(workers=0).address,
            "the scheduler has no workers; some are started by: dask worker",
        ),
    ]:
        with (
            pytest.raises(InputError, match=f"--scheduler = '{address}': {words}"),
            dask.connected(address),
        ):
            pass


def test_workers_that_all_leave_stop_the_study(tmp_path, cluster, monkeypatch):
    one = cluster(workers=1, ROCKING_BLOCK_SLEEP_S="5")
    plan = read_plan(write_study(tmp_path))
    with dask.connected(one.address) as client:
        monkeypatch.setattr(dask, "_ALONE_S", 2.0)
        team = dask.DaskTeam(client, ENTRY, tmp_path / "out", None, plan.file)
        one.workers[0].kill()
        with pytest.raises(StudyError, match="has had no workers for 2 s"):
            complete_study(plan, tmp_path / "out", entry=ENTRY, stream=io.StringIO(), workers=team)


@pytest.mark.parametrize(
    "options, environment, words",
    [
        (["-j", "2"], {}, "-j = 2: is for one machine; here the scheduler's workers say how many"),
        ([], {"PMI_SIZE": "4"}, "--scheduler = 'tcp://x:1': goes without mpirun"),
    ],
)
def test_options_that_do_not_go_with_a_scheduler_are_refused(
    tmp_path, monkeypatch, capsys, options, environment, words
):
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert (
        main(
            [
                "study",
                str(write_study(tmp_path)),
                "-o",
                str(tmp_path / "out"),
                "--scheduler",
                "tcp://x:1",
                *options,
            ]
        )
        == 2
    )
    assert words in capsys.readouterr().err
