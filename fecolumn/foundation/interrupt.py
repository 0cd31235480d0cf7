"""Ctrl-C and termination between two steps, not within one, so that what is saved is whole."""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from types import FrameType


@contextlib.contextmanager
def termination_as_interrupt() -> Iterator[None]:
    """SIGTERM, by which batch systems stop a command, raises KeyboardInterrupt as Ctrl-C does.

    In the main thread alone, as Python handles signals there; in another nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    earlier = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, earlier)


def forget_interrupt() -> None:
    """Let a command that has caught its interrupt end with an exit code of its own.

    CPython (3.11 to 3.13) remembers a KeyboardInterrupt that left an `exec` of text, as modules do
    while they are imported, even where it is caught later: `python -m` then ends by SIGINT and no
    exit code. The next `exec` of text forgets it (Python/pythonrun.c, run_eval_code_obj).
    """
    exec("")  # noqa: S102


@contextlib.contextmanager
def held_interrupts() -> Iterator[Callable[[], bool]]:
    """Function that tells whether SIGINT or SIGTERM has come; a second SIGINT interrupts at once.

    Only in the main thread, as Python handles signals there.
    """
    came: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        if came and number == signal.SIGINT:
            raise KeyboardInterrupt
        came.append(number)

    earlier = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: bool(came)
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def ended_at_a_stop(pool: ProcessPoolExecutor) -> Iterator[None]:
    """End the processes of a pool at once where an interrupt or an error leaves the block; they
    would do all that was handed in first.
    """
    others = set(multiprocessing.active_children())
    try:
        yield
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in set(multiprocessing.active_children()) - others:
            process.kill()
            process.join()
        raise
