"""Another program in a folder of its own, on one thread, with a limit on its CPU time."""

from __future__ import annotations

import os
import resource
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

# Seconds between looks at a running program
LOOK_S = 0.05
ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "CCX_NPROC_EQUATION_SOLVER",
        "CCX_NPROC_RESULTS",
        "NUMBER_OF_CPUS",
    ),
    "1",
)


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a program ended: code as of subprocess; cpu: user and system time [s]; timed_out: by the
    limit; words: its last output.
    """

    code: int
    cpu: float
    timed_out: bool
    words: str


def cpu_of(pid: int) -> float:
    """User and system time [s] of a running process so far."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run_child(
    command: list[str],
    folder: Path,
    limit: float,
    look: Callable[[float], None] = lambda cpu: None,
    extra: dict[str, str] | None = None,
) -> Outcome:
    """Run a program to its end or until it has spent `limit` seconds of CPU time.

    Parameters
    ----------
    command, folder
        what to run, and where; its output goes to log.txt there.
    look
        called with the CPU time so far [s] every LOOK_S.
    extra
        added to the environment.

    Raises
    ------
    FileNotFoundError
        no such program.
    """
    environment = (
        {
            key: value
            for key, value in os.environ.items()
            if key not in ("PYTHONPATH", "VIRTUAL_ENV")
        }
        | ONE_THREAD
        | (extra or {})
    )

    def bounded():
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 5))

    log = folder / "log.txt"
    with open(log, "wb") as output:
        child = subprocess.Popen(
            command,
            cwd=folder,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=environment,
            preexec_fn=bounded,
        )
        cpu = 0.0
        try:
            while True:
                try:
                    child.wait(LOOK_S)
                    break
                except subprocess.TimeoutExpired:
                    cpu = cpu_of(child.pid)
                    look(cpu)
        except BaseException:
            child.kill()
            child.wait()
            raise
    words = [line.strip() for line in log.read_text(errors="replace").splitlines() if line.strip()]
    return Outcome(
        child.returncode,
        cpu,
        child.returncode == -24 or cpu >= limit - 1,
        words[-1] if words else "",
    )
