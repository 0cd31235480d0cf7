import io
import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.foundation import _compiled
from fecolumn.foundation.lock import alone
from fecolumn.foundation.schema import InputError
from fecolumn.study.outcome import TaskOutcome
from fecolumn.study.plan import read_plan
from fecolumn.study.preparation import COMPILING, MODELLING, preparation
from fecolumn.study.progress import StudyProgress
from fecolumn.study.run import StudyError, _foresee, complete_study
from fecolumn.study.store import Store
from fecolumn.study.table import table_text, write_tables

HERE = Path(__file__).parent
DRIVER = """
import sys
from fecolumn.cli import main
if __name__ == "__main__":
    sys.exit(main(["study", *sys.argv[1:]]))
"""


def _run(study, folder, workers=2, **options):
    return complete_study(
        read_plan(study), folder, workers=workers, entry=ENTRY, stream=io.StringIO(), **options
    )


def _calls(folder) -> dict[str, int]:
    """How often each analysis was begun."""
    return {
        file.parent.name: len(file.read_text().splitlines())
        for file in Path(folder).glob("analyses/*/calls")
    }


def _driver(tmp_path, study, folder, *options, sleep_s=0.0) -> subprocess.Popen:
    script = tmp_path / "driver.py"
    script.write_text(DRIVER)
    paths = os.pathsep.join([str(HERE.parents[1]), str(HERE)])
    return subprocess.Popen(
        [sys.executable, script, study, "-o", folder, "-j", "2", "--entry", ENTRY, *options],
        env={**os.environ, "PYTHONPATH": paths, "ROCKING_BLOCK_SLEEP_S": str(sleep_s)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # where the tests run in the background of a shell, interrupts are ignored, and children
        # would inherit that
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def _wait_for(condition, timeout_s=20.0):
    end = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


def _first_worker(folder) -> int:
    """Process id of a worker that has begun an analysis."""
    _wait_for(
        lambda: any(file.read_text().endswith("\n") for file in folder.glob("analyses/*/calls"))
    )
    return next(
        int(text.split()[0])
        for file in folder.glob("analyses/*/calls")
        if (text := file.read_text())
    )


def _snapshot(folder) -> dict:
    return {file: file.read_bytes() for file in Path(folder).rglob("*") if file.is_file()}


def test_study_runs_every_analysis_once_with_one_thread_and_its_own_log(tmp_path):
    rows = _run(write_study(tmp_path), tmp_path / "out")
    assert [row["state"] for row in rows] == ["done"] * 16
    assert set(_calls(tmp_path / "out").values()) == {1}
    analysis = tmp_path / "out" / "analyses" / rows[0]["id"]
    assert (analysis / "calls").read_text().split()[1] == "1"
    assert (tmp_path / "out" / "logs" / f"{rows[0]['id']}.log").read_text() == "rocking 0\n"
    assert {
        (file.read_text().split()[0]) for file in tmp_path.glob("out/analyses/*/calls")
    }.isdisjoint({str(os.getpid())})


def test_finished_study_is_not_run_again(tmp_path):
    study = write_study(tmp_path)
    first, second = _run(study, tmp_path / "out"), _run(study, tmp_path / "out")
    assert second == first and set(_calls(tmp_path / "out").values()) == {1}


@pytest.mark.long
def test_only_a_lost_result_is_done_again(tmp_path):
    study = write_study(tmp_path)
    rows = _run(study, tmp_path / "out")
    lost, foreign = (tmp_path / "out" / "analyses" / rows[k]["id"] for k in (3, 5))
    (lost / "summary.json").unlink()
    (foreign / "summary.json").write_text(
        (lost.parent / rows[0]["id"] / "summary.json").read_text()
    )
    assert [row["state"] for row in _run(study, tmp_path / "out")] == ["done"] * 16
    assert {name for name, count in _calls(tmp_path / "out").items() if count == 2} == {
        lost.name,
        foreign.name,
    }


@pytest.mark.long
def test_failures_are_recorded_with_reason_and_the_rest_goes_on(tmp_path):
    study = write_study(
        tmp_path, dt=[1e-3], alpha=[0], pulses=["diverges", 1, "killed", 2, "silent", 3]
    )
    rows = {row["axes"]["motion.source"]: row for row in _run(study, tmp_path / "out", workers=1)}
    assert rows["pulse:diverges"]["reason"] == "ArithmeticError: step 17 did not converge"
    assert rows["pulse:killed"]["reason"] == "worker killed by SIGKILL (out of memory?)"
    assert rows["pulse:silent"]["reason"] == "ended without a summary.json of its own"
    assert all(rows[f"pulse:{pulse}"]["state"] == "done" for pulse in (1, 2, 3))
    log = tmp_path / "out" / "logs" / f"{rows['pulse:diverges']['id']}.log"
    assert "after 4 cuts" in log.read_text()  # the whole traceback is kept

    calls = _calls(tmp_path / "out")
    _run(study, tmp_path / "out")
    assert _calls(tmp_path / "out") == calls  # failures are not tried again unasked
    again = {
        row["axes"]["motion.source"]: row["state"]
        for row in _run(study, tmp_path / "out", retry_failed=True)
    }
    assert (again["pulse:killed"], again["pulse:diverges"]) == ("done", "failed")
    assert sum(_calls(tmp_path / "out").values()) == sum(calls.values()) + 3


@pytest.mark.long
def test_killed_driver_takes_its_workers_along_and_the_next_one_does_the_rest(tmp_path):
    study, folder = write_study(tmp_path, dt=[1e-3], alpha=[0, -0.1, -0.2]), tmp_path / "out"
    driver = _driver(tmp_path, study, folder, sleep_s=0.3)
    _wait_for(lambda: len(list(folder.glob("analyses/*/summary.json"))) >= 3)
    workers = Path(f"/proc/{driver.pid}/task/{driver.pid}/children").read_text().split()
    driver.kill()
    driver.communicate()
    _wait_for(lambda: not any(_alive(pid) for pid in workers))
    finished = {file.parent.name for file in folder.glob("analyses/*/summary.json")}
    assert 3 <= len(finished) < 12
    before = {name: (folder / "analyses" / name / "summary.json").read_bytes() for name in finished}

    out, err = (driver := _driver(tmp_path, study, folder)).communicate(timeout=30)
    assert driver.returncode == 0, err
    assert len(list(folder.glob("analyses/*/summary.json"))) == 12
    assert all(
        (folder / "analyses" / name / "summary.json").read_bytes() == content
        for name, content in before.items()
    )
    assert "12 of 12 analyses done" in out and (folder / "cdf.png").stat().st_size > 10_000

    _run(study, tmp_path / "whole")
    write_tables(plan := read_plan(study), _run(study, tmp_path / "whole"), tmp_path / "whole")
    for table in ("table.csv", "analyses.csv"):  # interrupted and uninterrupted give the same bytes
        assert (folder / table).read_bytes() == (tmp_path / "whole" / table).read_bytes()
    assert len(plan.analyses) == 12


def _alive(pid) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.long
def test_worker_killed_from_outside_costs_one_analysis(tmp_path):
    study, folder = write_study(tmp_path, dt=[1e-3], alpha=[0, -0.1]), tmp_path / "out"
    driver = _driver(tmp_path, study, folder, sleep_s=1.0)
    os.kill(_first_worker(folder), signal.SIGKILL)
    _, err = driver.communicate(timeout=30)
    assert driver.returncode == 1 and "worker killed by SIGKILL" in err and "--retry-failed" in err
    ledger = sqlite3.connect(folder / "study.sqlite")
    assert dict(ledger.execute("SELECT state, count(*) FROM analysis GROUP BY state")) == {
        "done": 7,
        "failed": 1,
    }
    assert (driver := _driver(tmp_path, study, folder, "--retry-failed")).wait(30) == 0
    driver.communicate()


@pytest.mark.long
@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_stop_says_how_to_resume(tmp_path, stop):
    study, folder = write_study(tmp_path), tmp_path / "out"
    driver = _driver(tmp_path, study, folder, sleep_s=0.5)
    _wait_for(lambda: list(folder.glob("analyses/*/calls")))
    if stop == signal.SIGINT:
        os.killpg(driver.pid, stop)  # as a terminal does: to the workers too
    else:
        driver.send_signal(stop)
    _, err = driver.communicate(timeout=10)
    assert (
        driver.returncode == 130
        and "the same command does the rest" in err
        and "Traceback" not in err
    )
    assert not any("Traceback" in log.read_text() for log in folder.glob("logs/*.log"))


@pytest.mark.long
def test_workers_ignore_the_terminals_interrupt(tmp_path):
    study, folder = write_study(tmp_path, pulses=[0]), tmp_path / "out"
    driver = _driver(tmp_path, study, folder, sleep_s=0.5)
    os.kill(_first_worker(folder), signal.SIGINT)
    _, err = driver.communicate(timeout=20)
    assert driver.returncode == 0, err


def test_workers_do_not_outlive_a_killed_driver(tmp_path):
    study, folder = write_study(tmp_path), tmp_path / "out"
    driver = _driver(tmp_path, study, folder, sleep_s=60)
    _wait_for(lambda: _count(folder, "running") == 2)
    workers = Path(f"/proc/{driver.pid}/task/{driver.pid}/children").read_text().split()
    driver.kill()
    driver.wait()
    _wait_for(lambda: len(workers) >= 2 and not any(_alive(pid) for pid in workers), timeout_s=5)


def _count(folder, state) -> int:
    try:
        with sqlite3.connect(f"file:{folder / 'study.sqlite'}?mode=ro", uri=True) as ledger:
            return ledger.execute(
                "SELECT count(*) FROM analysis WHERE state = ?", (state,)
            ).fetchone()[0]
    except sqlite3.OperationalError:  # not there yet
        return 0


def test_folder_of_another_study_is_refused_and_left_alone(tmp_path):
    _run(write_study(tmp_path / "a"), tmp_path / "out")
    before = _snapshot(tmp_path / "out")
    with pytest.raises(InputError, match="holds another study"):
        _run(write_study(tmp_path / "b", alpha=[0, -0.1]), tmp_path / "out")
    with pytest.raises(InputError, match="run by rocking_block:run"):
        complete_study(
            read_plan(write_study(tmp_path / "a")),
            tmp_path / "out",
            entry="other:run",
            stream=io.StringIO(),
        )
    assert _snapshot(tmp_path / "out") == before


def test_folder_with_other_things_is_refused_and_left_alone(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("dear")
    with pytest.raises(InputError, match="holds no study"):
        _run(write_study(tmp_path), tmp_path / "out")
    assert [file.name for file in _snapshot(tmp_path / "out")] == ["thesis.tex"]


@pytest.mark.long
def test_second_driver_on_one_folder_is_refused(tmp_path):
    study = write_study(tmp_path)
    with Store(tmp_path / "out", read_plan(study), ENTRY):
        driver = _driver(tmp_path, study, tmp_path / "out")
        _, err = driver.communicate(timeout=20)
        assert (
            driver.returncode == 2
            and f"another driver works on this study (process {os.getpid()} on" in err
        )
    assert all(row["state"] == "done" for row in _run(study, tmp_path / "out"))


def test_study_stops_when_no_worker_can_start(tmp_path):
    study = write_study(tmp_path)
    with pytest.raises(StudyError, match="no_such_module"):
        complete_study(
            read_plan(study), tmp_path / "out", entry="no_such_module:run", stream=io.StringIO()
        )
    ledger = sqlite3.connect(tmp_path / "out" / "study.sqlite")
    assert dict(ledger.execute("SELECT state, count(*) FROM analysis GROUP BY state")) == {
        "planned": 16
    }


def test_tables_count_what_failed_and_what_overturned(tmp_path):
    study = write_study(tmp_path, dt=[1e-3], alpha=[0, -0.2], pulses=[*range(8), "diverges"])
    plan, rows = read_plan(study), _run(study, tmp_path / "out")
    write_tables(plan, rows, tmp_path / "out")
    header, first, _ = [
        line.split(",") for line in (tmp_path / "out" / "table.csv").read_text().splitlines()
    ]
    row = dict(zip(header, first))
    done = [
        r["summary"]
        for r in rows
        if r["axes"]["integration.alpha_hht"] == 0 and r["state"] == "done"
    ]
    overturned = sum(summary["overturned"] for summary in done)
    assert 0 < overturned < 8  # the pulses were chosen so
    assert (row["planned"], row["n"], row["overturned"]) == ("9", "8", str(overturned))
    assert float(row["p_overturn"]) == pytest.approx(overturned / 8)
    header, *lines = [
        line.split(",") for line in (tmp_path / "out" / "analyses.csv").read_text().splitlines()
    ]
    analyses = [dict(zip(header, line)) for line in lines]
    censored = [one["u_max_censored"] for one in analyses]
    assert censored == [one["overturned"] for one in analyses]  # empty where it failed
    # what overturned, or failed, has no peak
    assert all((one["u_max_m"] == "") == (one["overturned"] != "0") for one in analyses)
    assert (
        "wall" not in ",".join(header) and "wall_s" in (tmp_path / "out" / "timing.csv").read_text()
    )
    assert "8/9" in table_text(plan, rows)


def test_nothing_done_still_makes_a_table(tmp_path):
    study = write_study(tmp_path, dt=[1e-3], alpha=[0], pulses=["diverges"])
    plan, rows = read_plan(study), _run(study, tmp_path / "out")
    write_tables(plan, rows, tmp_path / "out")
    assert "0/1" in table_text(plan, rows)


def test_progress_judges_the_rest_by_its_effort(tmp_path):
    plan = read_plan(write_study(tmp_path, dt=[0.02, 1e-3], alpha=[0], pulses=[1]))
    progress = StudyProgress({"planned": 2}, sum(a.effort for a in plan.analyses), 2, io.StringIO())
    long = plan.analyses[1]
    # 2000 of 3050
    progress.count(
        TaskOutcome(long.id, "done", wall_s=90.0, started=1.0, overturned=True), long.effort
    )
    assert (
        progress.line(100.0)
        == "1/2 analyses, 0.6 a minute, 52 s to go, 1 overturned, 0 failed, workers 45 % busy"
    )


def test_progress_is_foreseen_from_the_pace_of_an_analysis_at_work(tmp_path):
    plan = read_plan(write_study(tmp_path, dt=[0.02, 1e-3], alpha=[0], pulses=[1]))
    stream, effort = io.StringIO(), sum(a.effort for a in plan.analyses)
    progress = StudyProgress({"planned": 2}, effort, 2, stream)
    long = plan.analyses[1]
    for _ in range(2):
        progress.foresee(200.0, long.effort, "7 contact points")
    # 3050 of 2000, by two workers, told once
    assert stream.getvalue() == (
        "one analysis takes about 3 min 20 s, all that are missing 2 min 32 s; 7 contact points\n"
    )
    assert progress.line(32.0) == "0/2 analyses, about 2 min 00 s to go, 0 overturned, 0 failed"
    # what has ended is known better
    progress.count(TaskOutcome(long.id, "done", wall_s=90.0, started=1.0), long.effort)
    assert "52 s to go" in progress.line(100.0)
    quick = StudyProgress({"planned": 2}, effort, 2, io.StringIO())
    quick.foresee(5.0, long.effort, "7 contact points")
    assert not quick._stream.getvalue()


def test_a_driver_reads_the_pace_of_an_analysis_at_work(tmp_path):
    plan = read_plan(write_study(tmp_path, dt=[0.02, 1e-3], alpha=[0], pulses=[1]))
    progress = StudyProgress({"planned": 2}, sum(a.effort for a in plan.analyses), 1, io.StringIO())
    store = SimpleNamespace(result_folder=lambda case_id: tmp_path / case_id)
    for analysis, text in zip(plan.analyses, ("{cut", '{"whole_s": 40.0, "cheaper": "words"}')):
        (tmp_path / analysis.id).mkdir()
        (tmp_path / analysis.id / "pace.json").write_text(text)
    _foresee(store, plan.analyses[:1], progress)
    assert "to go" not in progress.line(1.0)
    _foresee(store, plan.analyses, progress)
    assert "about 1 min 00 s to go" in progress.line(1.0)  # 61 s of 3050


def test_time_in_which_the_engine_is_compiled_is_told_and_no_analysis_pays_for_it(tmp_path):
    plan = read_plan(write_study(tmp_path, dt=[0.02, 1e-3], alpha=[0], pulses=[1]))
    progress = StudyProgress({"planned": 2}, sum(a.effort for a in plan.analyses), 2, io.StringIO())
    progress.prepare(MODELLING, 10.0)
    progress.prepare(COMPILING, 20.0)
    progress.prepare(COMPILING, 60.0)
    assert progress.line(60.0) == f"0/2 analyses, {COMPILING} ... 40 s, 0 overturned, 0 failed"
    progress.prepare("", 61.0)
    long = plan.analyses[1]
    said = json.dumps({"wall_s": 90.0})  # of 160 s of its worker's
    progress.count(
        TaskOutcome(long.id, "done", wall_s=160.0, started=1.0, summary=said, overturned=True),
        long.effort,
    )
    assert (
        progress.line(160.0)
        == "1/2 analyses, 0.6 a minute, 52 s to go, 1 overturned, 0 failed, workers 45 % busy"
    )


@pytest.mark.parametrize(
    "engine, files, words",
    [
        ("reduced", (), COMPILING),
        ("rigid", (), COMPILING),
        ("full", (), ""),
        ("reduced", (".model-1f.lock",), COMPILING),
        ("reduced", ("{code}/reduced_1/run.advance-27.py311.1.nbi",), ""),
    ],
)
def test_what_a_new_machine_makes_first_is_seen_in_its_cache(
    tmp_path, monkeypatch, engine, files, words
):
    monkeypatch.setenv("FECOLUMN_CACHE", str(tmp_path / "cache"))
    _compiled.compiled_folder.cache_clear()
    try:
        for name in files:
            file = tmp_path / "cache" / name.format(code=Path(_compiled.compiled_folder()).name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.touch()
        plan = read_plan(
            write_study(
                tmp_path,
                dt=[1e-3],
                alpha=[0],
                pulses=[1],
                extra=f'"integration.engine" = ["{engine}"]\n',
            )
        )
        assert preparation(plan.analyses) == words
    finally:
        _compiled.compiled_folder.cache_clear()


def test_a_model_is_being_made_while_a_process_holds_its_lock_and_not_after_that_was_killed(
    tmp_path, monkeypatch
):
    monkeypatch.setenv("FECOLUMN_CACHE", str(tmp_path))
    plan = read_plan(
        write_study(
            tmp_path, dt=[1e-3], alpha=[0], pulses=[1], extra='"integration.engine" = ["reduced"]\n'
        )
    )
    with alone(tmp_path / "model-1f"):
        assert preparation(plan.analyses) == MODELLING
    (tmp_path / ".model-1f.lock").touch()
    assert preparation(plan.analyses) != MODELLING


def test_log_file_gets_few_plain_lines(tmp_path):
    stream = io.StringIO()
    complete_study(
        read_plan(write_study(tmp_path)), tmp_path / "out", workers=2, entry=ENTRY, stream=stream
    )
    lines = stream.getvalue().splitlines()
    assert (
        len(lines) == 2 and lines[-1].startswith("16/16 analyses") and "\r" not in stream.getvalue()
    )


def test_summaries_of_the_ledger_are_those_of_the_folders(tmp_path):
    for row in _run(write_study(tmp_path), tmp_path / "out"):
        assert row["summary"] == json.loads(
            (tmp_path / "out" / "analyses" / row["id"] / "summary.json").read_text()
        )
        assert row["version"] == "0" and row["wall_s"] > 0


def test_columns_that_slide_off_are_counted_as_such_and_not_as_failures(tmp_path):
    plan = read_plan(
        write_study(tmp_path, dt=[1e-3], alpha=[0], pulses=["slides 1", "slides 2", *range(6)])
    )
    stream = io.StringIO()
    rows = complete_study(plan, tmp_path / "out", workers=1, entry=ENTRY, stream=stream)
    assert [row["state"] for row in rows] == ["done"] * 8
    assert "2 slid off, 0 failed" in stream.getvalue().splitlines()[-1]
    write_tables(plan, rows, tmp_path)
    header, line = (text.split(",") for text in (tmp_path / "table.csv").read_text().splitlines())
    found = dict(zip(header, line))
    fallen = sum(row["summary"]["overturned"] for row in rows)
    assert (found["n"], found["overturned"], found["slid_off"]) == ("8", str(fallen), "2")
    assert float(found["p_overturn"]) == pytest.approx(fallen / 8, abs=1e-6)
    # beyond every column that stood, like one that overturned
    standing = sorted(
        row["summary"]["u_max_m"]
        for row in rows
        if not row["summary"]["overturned"] and not row["summary"].get("slid_off")
    )
    assert float(found["u_max_16_m"]) == pytest.approx(standing[1], rel=1e-6)
    analyses = [
        dict(zip(*pair))
        for text in [(tmp_path / "analyses.csv").read_text().splitlines()]
        for pair in [(text[0].split(","), one.split(",")) for one in text[1:]]
    ]
    off = [one for one in analyses if one["slid_off"] == "1"]
    assert [(one["u_max_m"], one["u_max_censored"]) for one in off] == [("", "1")] * 2
    assert "slid off" in table_text(plan, rows)
    stored = (
        sqlite3.connect(tmp_path / "out" / "study.sqlite")
        .execute("SELECT count(*) FROM analysis WHERE json_extract(summary, '$.slid_off')")
        .fetchone()
    )
    assert stored == (2,)
