"""What ends a command before its end: termination, a failed analysis; and that its processes go
with it.
"""

import argparse
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import pytest

from fecolumn import cli
from fecolumn.engines.analysis import AnalysisFailed
from fecolumn.engines.trial_run import trial
from fecolumn.foundation.interrupt import ended_at_a_stop, termination_as_interrupt


def catches_termination(process) -> bool:
    """Whether a process has a way of its own to end by SIGTERM."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    caught = next(line for line in status.splitlines() if line.startswith("SigCgt:"))
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


@pytest.mark.parametrize(
    "words, said",
    [
        ("motions make near-fault -n 5000 -o many.h5", "stopped; run the same command again"),
        ("doctor", "stopped; run the same command again"),
    ],
)
def test_termination_has_the_exit_code_of_a_stop(tmp_path, words, said):
    process = subprocess.Popen(
        [sys.executable, "-m", "fecolumn.cli", *words.split()],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    while process.poll() is None and not catches_termination(process):
        time.sleep(0.01)
    process.send_signal(signal.SIGTERM)
    _, told = process.communicate(timeout=120)
    assert (process.returncode, told) == (130, f"fecolumn: {said}\n")
    assert not list(tmp_path.iterdir())


def test_an_interrupt_within_text_that_is_executed_has_the_exit_code_of_a_stop(tmp_path):
    # as modules do while they are imported; Python would end by the signal
    (tmp_path / "interrupted.py").write_text(
        "import sys\n"
        "from fecolumn import cli\n"
        "cli._parser = lambda: exec('raise KeyboardInterrupt')\n"
        "sys.exit(cli.main(['keys']))\n"
    )
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    done = subprocess.run(
        [sys.executable, "-m", "interrupted"],
        env=os.environ | {"PYTHONPATH": paths},
        stderr=subprocess.PIPE,
        text=True,
        timeout=120,
    )
    assert (done.returncode, done.stderr) == (
        130,
        "fecolumn: stopped; run the same command again\n",
    )


def test_termination_is_an_interrupt_and_then_what_it_was():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), termination_as_interrupt():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) == before


def test_another_thread_runs_commands_without_signals(capsys):
    codes = []
    thread = threading.Thread(target=lambda: codes.append(cli.main(["keys", "block"])))
    thread.start()
    thread.join()
    assert codes == [0]


def test_stop_ends_the_processes_of_a_pool_at_once():
    began, before = time.monotonic(), set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"))
    with pytest.raises(KeyboardInterrupt), pool, ended_at_a_stop(pool):
        for _ in range(3):
            pool.submit(time.sleep, 300)
        raise KeyboardInterrupt
    assert time.monotonic() - began < 100
    assert set(multiprocessing.active_children()) == before


def test_failed_analysis_is_a_line_and_code_1_of_every_command(capsys):
    def fail(args):
        raise AnalysisFailed("t = 0.1 s: no convergence")

    assert cli._answer(argparse.Namespace(command=fail, stopped="")) == 1
    assert capsys.readouterr().err == "fecolumn: t = 0.1 s: no convergence\n"


def test_failed_trial_names_no_folder_that_is_gone():
    def begin(folder):
        def run(stop):
            raise AnalysisFailed(f"t = 0.1 s: cut; state saved in {folder / 'checkpoint.npz'}")

        return SimpleNamespace(run=run)

    with pytest.raises(AnalysisFailed) as error:
        trial(begin)
    assert str(error.value) == "t = 0.1 s: cut"


@pytest.mark.parametrize("command", ["design", "screen", "calibrate", "study"])
def test_commands_that_keep_what_is_done_say_so_when_stopped(command):
    words = dict(
        design="c --vary k 1:2 --motions m --limit l -o d",
        screen="l --motions m -o d",
        calibrate="c --test t -o d",
        study="s -o d",
    )[command]
    stopped = cli._parser().parse_args([command, *words.split()]).stopped
    assert stopped == "stopped; what is done is kept, the same command does the rest"
