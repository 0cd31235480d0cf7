"""A study that is killed again and again, and a disk that is full: the tables are those of an
uninterrupted run.
"""

import contextlib
import io
import os
import random
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.study.outcome import finished_outcome
from fecolumn.study.plan import read_plan
from fecolumn.study.run import StudyError, complete_study
from fecolumn.study.store import read_study
from fecolumn.study.table import write_tables

HERE = Path(__file__).parent
TABLES = ("table.csv", "analyses.csv")


def _driver(study, folder, *options, sleep_s=0.0, **more) -> subprocess.Popen:
    paths = os.pathsep.join([str(HERE.parents[1]), str(HERE)])
    command = [
        sys.executable,
        "-m",
        "fecolumn.cli",
        "study",
        study,
        "-o",
        folder,
        "-j",
        "2",
        "--entry",
        ENTRY,
        *options,
    ]
    return subprocess.Popen(
        list(map(str, command)),
        env={**os.environ, "PYTHONPATH": paths, "ROCKING_BLOCK_SLEEP_S": str(sleep_s)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        **more,
    )


def _children(pid) -> list[int]:
    with contextlib.suppress(OSError):
        return [
            int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        ]
    return []


def _workers(pid) -> list[int]:
    """Children of the driver that do analyses: multiprocessing has one of its own."""
    found = []
    for child in _children(pid):
        with contextlib.suppress(OSError):
            if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes():
                found.append(child)
    return found


def _wait_for_results(driver, folder, count) -> None:
    end = time.monotonic() + 30
    while (
        driver.poll() is None
        and time.monotonic() < end
        and len(list(folder.glob("analyses/*/summary.json"))) < count
    ):
        time.sleep(0.01)


def _kill(what: str, driver, draw) -> None:
    with contextlib.suppress(ProcessLookupError):
        if what == "driver":
            os.kill(driver.pid, signal.SIGKILL)
        elif what == "everything":
            os.killpg(driver.pid, signal.SIGKILL)
        elif workers := _workers(driver.pid):
            os.kill(draw.choice(workers), signal.SIGKILL)


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_killed_at_random_moments_a_study_gives_the_bytes_of_an_uninterrupted_one(tmp_path, seed):
    study = write_study(tmp_path, pulses=[*range(60), "diverges"])
    plan, draw = read_plan(study), random.Random(seed)
    write_tables(
        plan,
        complete_study(plan, tmp_path / "whole", workers=2, entry=ENTRY, stream=io.StringIO()),
        tmp_path / "whole",
    )

    out, kept, kills = tmp_path / "out", {}, 0
    # two workers at 0.2 s an analysis are too slow to be done before the last turn
    for turn in range(8):
        driver = _driver(study, out, "--retry-failed", sleep_s=0.2)
        if turn % 3:  # in the middle of the work, however fast the machine is; else while it starts
            _wait_for_results(driver, out, len(kept) + draw.randint(1, 12))
        time.sleep(draw.uniform(0.0, 0.2 if turn % 3 else 2.0))
        if driver.poll() is None:
            _kill(draw.choice(["driver", "everything", "worker"]), driver, draw)
            kills += 1
        with contextlib.suppress(subprocess.TimeoutExpired):
            driver.wait(draw.uniform(0.1, 1.0))
        with contextlib.suppress(ProcessLookupError):
            driver.kill()
        # workers left alone go too, and so does their end of the pipe
        driver.communicate(timeout=60)
        for name, content in kept.items():  # nothing finished is lost or done again
            assert (out / "analyses" / name / "summary.json").read_bytes() == content
        for file in out.glob("analyses/*/summary.json"):
            assert finished_outcome(file.parent.name, file.parent), "half a summary"
            kept[file.parent.name] = file.read_bytes()
        if (out / "study.json").exists():
            assert {row["id"] for row in read_study(out).rows if row["state"] == "done"} <= set(
                kept
            )
    assert 0 < len(kept) and kills == 8
    _, err = (driver := _driver(study, out, "--retry-failed")).communicate(timeout=60)
    assert driver.returncode == 1 and "4 failed" in err, err  # those that diverge, and no other
    for table in TABLES:
        assert (out / table).read_bytes() == (tmp_path / "whole" / table).read_bytes()
    calls = {
        file.parent.name: len(file.read_text().splitlines())
        for file in out.glob("analyses/*/calls")
    }
    # what diverges is tried again each time, else only what was in hand
    assert sum(calls.values()) - len(calls) <= 4 * 9 + 2 * 8 * 3


def _limit_file_size():
    resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))


@pytest.mark.long
def test_results_that_find_no_room_stop_the_study_cleanly(tmp_path):
    study = write_study(tmp_path, pulses=[*range(3), "full", *range(3, 8)])
    out = tmp_path / "out"
    _, err = (driver := _driver(study, out)).communicate(timeout=60)
    assert (
        driver.returncode == 1
        and "the disk is full" in err
        and "the same command does the rest" in err
        and "Traceback" not in err
    )
    states = [row["state"] for row in read_study(out).rows]
    assert "failed" not in states and "running" not in states and "planned" in states
    (out / "room").touch()
    _, err = (driver := _driver(study, out)).communicate(timeout=60)
    assert driver.returncode == 0, err
    assert {row["state"] for row in read_study(out).rows} == {"done"}


@pytest.mark.long
def test_ledger_that_finds_no_room_stops_the_study_cleanly(tmp_path):
    study, out = write_study(tmp_path, pulses=range(60)), tmp_path / "out"
    _, err = (driver := _driver(study, out, preexec_fn=_limit_file_size)).communicate(timeout=60)
    assert driver.returncode == 1 and "the disk is full" in err and "Traceback" not in err, err
    _, err = (driver := _driver(study, out)).communicate(timeout=60)
    assert driver.returncode == 0 and len(list(out.glob("analyses/*/summary.json"))) == 240, err


@pytest.mark.long
@pytest.mark.skipif(os.geteuid() != 0, reason="only root may mount a small disk")
def test_small_disk_stops_the_study_cleanly_and_more_room_lets_it_go_on(tmp_path):
    study, disk = write_study(tmp_path, pulses=range(100)), tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=600k", "tmpfs", disk], capture_output=True
    ).returncode:
        pytest.skip("nothing can be mounted here")
    try:
        _, err = (driver := _driver(study, disk / "out")).communicate(timeout=60)
        assert driver.returncode == 1 and "the disk is full" in err and "Traceback" not in err, err
        before = {file: file.read_bytes() for file in disk.glob("out/analyses/*/summary.json")}
        assert (
            all(finished_outcome(file.parent.name, file.parent) for file in before)
            and len(before) < 400
        )
        subprocess.run(["mount", "-o", "remount,size=60m", disk], check=True)
        _, err = (driver := _driver(study, disk / "out")).communicate(timeout=60)
        assert driver.returncode == 0, err
        assert all(file.read_bytes() == content for file, content in before.items())
    finally:
        subprocess.run(["umount", "-l", disk], check=True)


@pytest.mark.parametrize(
    "said, name, told",
    [
        ("database or disk is full", "SQLITE_FULL", "^the disk is full; free room$"),
        ("disk I/O error", "SQLITE_IOERR_WRITE", r"is at fault \(the ledger of .*disk I/O error"),
        ("disk I/O error", "SQLITE_IOERR_FSYNC", r"^the ledger of .* cannot be written \(disk I/O"),
    ],
)
def test_fault_of_a_disk_is_told_and_not_called_a_full_one(tmp_path, monkeypatch, said, name, told):
    error = sqlite3.OperationalError(said)
    error.sqlite_errorname = name

    def drive(*_):
        raise error

    monkeypatch.setattr("fecolumn.study.run.drive", drive)
    with pytest.raises(StudyError, match=told):
        complete_study(read_plan(write_study(tmp_path, pulses=[1])), tmp_path / "out", entry=ENTRY)


def test_full_disk_is_told_to_a_caller(tmp_path):
    plan = read_plan(write_study(tmp_path, pulses=["full"]))
    with pytest.raises(StudyError, match="disk is full.*No space left"):
        complete_study(plan, tmp_path / "out", entry=ENTRY, stream=io.StringIO())
