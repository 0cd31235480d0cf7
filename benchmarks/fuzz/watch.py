"""Mutants used in a process that may hang or die, and another that watches it."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

VERDICTS = ("used", "refused", "traceback", "hang", "death")
BAD = VERDICTS[2:]
PATIENCE_S = 60.0  # of a mutant; the first of a process waits for imports, too


@dataclass(frozen=True, slots=True)
class End:
    """What became of a mutant: one of VERDICTS, what was said, and the time it took [s]."""

    subject: str
    number: int
    verdict: str
    told: str
    wall_s: float


def watched(
    subject: str, numbers: list[int], seed: int, patience_s: float = PATIENCE_S
) -> Iterator[End]:
    """Use the mutants of these numbers one by one; after a hang or a death a new process does the
    rest.
    """
    left = list(numbers)
    while left:
        ours, theirs = os.pipe()
        worker = subprocess.Popen(
            [
                sys.executable,
                "-m",
                "benchmarks.fuzz.worker",
                subject,
                str(seed),
                str(theirs),
                *map(str, left),
            ],
            pass_fds=[theirs],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        os.close(theirs)
        with open(ours, "rb", buffering=0) as told:
            for end in _listen(subject, worker, told, left, patience_s):
                left.remove(end.number)
                yield end
        worker.wait()


def _listen(subject: str, worker, told, left: list[int], patience_s: float) -> Iterator[End]:
    """Ends of a worker's mutants, the last one a hang or a death where it does not do all."""
    rest, missing, began = b"", list(left), time.perf_counter()
    while missing:
        ready = select.select([told], [], [], patience_s)[0]
        piece = os.read(told.fileno(), 65536) if ready else b""
        if not piece:
            if not ready:
                os.killpg(worker.pid, signal.SIGKILL)
            worker.wait()
            how = (
                f"ended by {signal.Signals(-worker.returncode).name}"
                if worker.returncode < 0
                else f"exit code {worker.returncode}"
            )
            yield End(
                subject,
                missing[0],
                "death" if ready else "hang",
                how if ready else f"nothing for {patience_s:g} s",
                time.perf_counter() - began,
            )
            return
        *lines, rest = (rest + piece).split(b"\n")
        for line in lines:
            end = End(subject, **json.loads(line))
            missing.remove(end.number)
            began = time.perf_counter()
            yield end
