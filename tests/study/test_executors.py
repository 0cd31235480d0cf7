"""The same study by processes of this machine, by MPI ranks and by a job array: the same tables,
each analysis once.
"""

import io
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.cli import main
from fecolumn.foundation._mpi import launch_environment
from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.store import Store, read_study
from fecolumn.study.table import write_tables

HERE = Path(__file__).parent
COMMAND = [sys.executable, "-m", "fecolumn.cli", "study"]
TABLES = ("table.csv", "analyses.csv")


def _environment(**more) -> dict:
    return {
        **launch_environment(),
        "PYTHONPATH": os.pathsep.join([str(HERE.parents[1]), str(HERE)]),
        **more,
    }


def _tables(folder) -> list[bytes]:
    return [(Path(folder) / name).read_bytes() for name in TABLES]


def _calls(folder) -> dict[str, int]:
    return {
        file.parent.name: len(file.read_text().splitlines())
        for file in Path(folder).glob("analyses/*/calls")
    }


@pytest.fixture
def study(tmp_path):
    return write_study(tmp_path, pulses=[*range(6), "diverges"])


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """Tables of the same study by two processes of this machine."""
    folder = tmp_path_factory.mktemp("expected")
    plan = read_plan(write_study(folder, pulses=[*range(6), "diverges"]))
    write_tables(
        plan,
        complete_study(plan, folder / "out", workers=2, entry=ENTRY, stream=io.StringIO()),
        folder / "out",
    )
    return _tables(folder / "out")


@pytest.mark.long
def test_ranks_of_mpirun_give_the_tables_of_local_processes(tmp_path, study, expected):
    command = [
        "mpirun",
        "--oversubscribe",
        "-n",
        "3",
        *COMMAND,
        study,
        "-o",
        tmp_path / "out",
        "--entry",
        ENTRY,
    ]
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, env=_environment(), timeout=120
    )
    # as said of four analyses
    assert done.returncode == 1 and "step 17 did not converge" in done.stderr, done.stderr
    assert _tables(tmp_path / "out") == expected
    workers = {file.read_text().split()[0] for file in tmp_path.glob("out/analyses/*/calls")}
    assert len(workers) == 2 and set(_calls(tmp_path / "out").values()) == {1}


@pytest.mark.long
def test_refusal_ends_all_ranks_of_mpirun(tmp_path):
    command = [
        "mpirun",
        "--oversubscribe",
        "-n",
        "3",
        *COMMAND,
        str(tmp_path / "gone.toml"),
        "-o",
        str(tmp_path / "out"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, env=_environment(), timeout=60)
    assert done.returncode != 0 and done.stderr.count("no such file") == 1


@pytest.mark.long
def test_a_rank_that_dies_ends_the_job_and_the_next_one_does_the_rest(tmp_path, expected):
    study = write_study(tmp_path, pulses=[*range(6), "diverges"])
    command = list(
        map(
            str,
            [
                "mpirun",
                "--oversubscribe",
                "-n",
                "3",
                *COMMAND,
                study,
                "-o",
                tmp_path / "out",
                "--entry",
                ENTRY,
            ],
        )
    )
    job = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=_environment(ROCKING_BLOCK_SLEEP_S="0.3"),
    )
    end = time.monotonic() + 60
    while len(list(tmp_path.glob("out/analyses/*/summary.json"))) < 5:
        assert time.monotonic() < end
        time.sleep(0.02)
    os.kill(int(next(tmp_path.glob("out/analyses/*/calls")).read_text().split()[0]), 9)
    job.communicate(timeout=60)
    assert job.returncode != 0
    finished = {file.parent.name for file in tmp_path.glob("out/analyses/*/summary.json")}
    assert len(finished) < 24
    subprocess.run(command, capture_output=True, env=_environment(), timeout=120)
    assert _tables(tmp_path / "out") == expected
    assert all(count == 1 for name, count in _calls(tmp_path / "out").items() if name in finished)


def test_copies_that_do_not_know_of_each_other_are_refused(tmp_path):
    study = write_study(tmp_path)
    done = subprocess.run(
        list(map(str, [*COMMAND, study, "-o", tmp_path / "out"])),
        capture_output=True,
        text=True,
        env=_environment(PMI_SIZE="4"),
        timeout=60,
    )
    assert (
        done.returncode == 2
        and "do not know of each other" in done.stderr
        and not (tmp_path / "out").exists()
    )


@pytest.mark.long
def test_tasks_of_a_job_array_work_in_one_folder_at_once(tmp_path, study, expected):
    command = [*COMMAND, study, "-o", tmp_path / "out", "--entry", ENTRY]
    tasks = [
        subprocess.Popen(
            list(map(str, [*command, "-j", 1, "--array-index", index, "--array-size", 3])),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=_environment(ROCKING_BLOCK_SLEEP_S="0.1"),
        )
        for index in range(3)
    ]
    said = [task.communicate(timeout=60) for task in tasks]
    # each share holds one that diverges
    assert [task.returncode for task in tasks] == [1, 1, 1], said
    assert "share 1 of 3: 8 of 9 analyses done" in said[1][0]
    assert (
        len(read_study(tmp_path / "out").rows) == 28
        and not (tmp_path / "out" / "table.csv").exists()
    )
    last = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, env=_environment(), timeout=60
    )
    assert last.returncode == 1 and _tables(tmp_path / "out") == expected
    # nothing was run again for the tables, not even what failed
    assert set(_calls(tmp_path / "out").values()) == {1}
    assert [file.name for file in (tmp_path / "out").glob("study*.sqlite*")] == ["study.sqlite"]


def test_shares_of_an_array_have_about_the_same_work(tmp_path):
    plan = read_plan(write_study(tmp_path, dt=[0.02, 1e-3, 1e-4]))
    efforts = []
    for index in range(4):
        with Store(tmp_path / "out", plan, ENTRY, (index, 4)) as store:
            efforts.append(sum(analysis.effort for _, analysis in store.analyses))
    assert max(efforts) == pytest.approx(min(efforts)) and sum(efforts) == pytest.approx(
        sum(a.effort for a in plan.analyses)
    )


@pytest.mark.parametrize(
    "first, second", [(None, (0, 2)), ((0, 2), None), ((0, 2), (0, 2)), ((0, 2), (1, 3))]
)
def test_drivers_that_would_do_the_same_work_are_refused(tmp_path, study, first, second):
    plan = read_plan(study)
    with Store(tmp_path / "out", plan, ENTRY, first):
        with pytest.raises(
            InputError, match=f"another driver works on this study .process {os.getpid()} on"
        ):
            Store(tmp_path / "out", plan, ENTRY, second)
    Store(tmp_path / "out", plan, ENTRY, second).close()


@pytest.mark.parametrize(
    "options, message",
    [
        (["--array-index", "3", "--array-size", "3"], r"--array-index = 3: must lie in \[0, 2\]"),
        (["--array-index", "0"], "--array-size: must be at least 1"),
        (["--array-size", "4"], "--array-index: must lie in"),
        (["-j", "0"], "-j = 0: must be at least 1"),
    ],
)
def test_bad_options_are_refused(tmp_path, study, options, message, capsys):
    assert main(["study", str(study), "-o", str(tmp_path / "out"), *options]) == 2
    assert re.search(message, capsys.readouterr().err)
