"""What the driver asks of those who do the work, on this machine or on many."""

from __future__ import annotations

from typing import Protocol

from fecolumn.study.outcome import Task, TaskOutcome


class StudyError(RuntimeError):
    """The study as a whole cannot go on, for example because no worker can start or the disk is
    full.
    """


class Team(Protocol):
    """Workers that take batches of tasks and tell what became of each.

    Attributes
    ----------
    size
        number of workers.
    at_work
        whether some task's outcome has not been collected yet.
    """

    size: int

    @property
    def at_work(self) -> bool:
        """Whether some task's outcome has not been collected yet."""

    def wants(self, depth: int) -> bool:
        """Whether another batch may be given when every worker may have `depth` of them."""

    def give(self, batch: list[Task]) -> None:
        """Hand out a batch; its tasks are done in order."""

    def collect(self, timeout_s: float) -> list[TaskOutcome]:
        """What has ended, waiting for something at most `timeout_s` [s].

        Raises
        ------
        StudyError
            no worker can start.
        """

    def stop(self) -> None:
        """End the workers; what they have in hand is lost."""
