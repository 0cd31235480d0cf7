"""The folder of a study: study.json says which study it holds, study.sqlite how far it is,
analyses/<id>/ the results, logs/<id>.log what an analysis said. Tasks of a job array keep ledgers
of their own, study-I-of-N.sqlite, until a driver of the whole study takes them into its own.

The results are the truth: an analysis is done when its summary.json exists and carries its id. The
ledger is brought in line with them whenever a driver opens the folder, so killing anything at any
time loses only what was in flight.
"""

from __future__ import annotations

import json
import os
import re
import sqlite3
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from fecolumn.case.sections import Motion
from fecolumn.foundation.atomic import UNFINISHED, write_json
from fecolumn.foundation.content import content
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.version import __version__
from fecolumn.study.ledger import (
    PLANNED,
    RUNNING,
    StudyLedger,
    can_be_opened,
    ledger_files,
    ledger_rows,
    open_to_read,
)
from fecolumn.study.lock import FolderLock, stem
from fecolumn.study.outcome import DONE, FAILED, Task, TaskOutcome, finished_outcome
from fecolumn.study.plan import Plan, PlannedAnalysis

# Files of a driver that was stopped before it had written study.json
_OWN = re.compile(
    rf"study(-\d+-of-\d+)?(\.workers\.lock|\.lock|\.sqlite.*)|{re.escape(UNFINISHED)}.*"
)

__all__ = ["DONE", "FAILED", "PLANNED", "RUNNING", "Store", "Study", "read_study"]


class Store:
    """Folder and ledger of a study, held by one driver at a time.

    Parameters
    ----------
    folder
        of the study; made if it is not there.
    plan
        the study.
    entry
        its analysis function, "module:function".
    share
        (index, size) where this is a task of a job array, which has every size-th of the analyses,
        longest first.

    Attributes
    ----------
    analyses
        those this driver has to do.

    Raises
    ------
    InputError
        the folder holds another study or something else, or another driver works in it.
    """

    def __init__(
        self, folder: Path | str, plan: Plan, entry: str, share: tuple[int, int] | None = None
    ) -> None:
        self.folder = Path(folder)
        self.entry = entry
        identity = {"study": plan.id, "analyses": len(plan.analyses), "entry": entry}
        _refuse_foreign(self.folder, identity)
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = FolderLock(self.folder, share)
        try:
            known = _refuse_foreign(self.folder, identity)  # another driver may have been first
            told = json.loads(
                json.dumps({"title": plan.title, "axes": plan.axes, "case": plan.case})
            )
            # another title, or an axis of one value that the case states now, are the same study
            if known is None or share is None and told != {key: known.get(key) for key in told}:
                made_by = __version__ if known is None else known.get("version", __version__)
                write_json(self.folder / "study.json", {**identity, **told, "version": made_by})
            self.analyses = _share(plan, share)
            self.ledger = StudyLedger(
                self.folder / f"{stem(share)}.sqlite", many_readers=share is None
            )
        except BaseException:
            self._lock.close()
            raise
        if self.ledger.put_aside:
            warnings.warn(
                f"{self.folder / f'{stem(share)}.sqlite'} was damaged and is made anew "
                "from the results; "
                f"what is left of it is in {self.ledger.put_aside.name}, and what had "
                "failed is run again",
                stacklevel=3,
            )
        try:
            self._reconcile(share)
        except BaseException:
            self.close()
            raise

    def _reconcile(self, share: tuple[int, int] | None) -> None:
        found: dict[int, str] = {}

        def content_of(motion: Motion) -> str:
            if id(motion) not in found:  # sections of the plan are shared
                sources = (motion.source, motion.source_y, motion.source_z)
                found[id(motion)] = " ".join(content(source) for source in sources if source)
            return found[id(motion)]

        self.ledger.plan(
            (
                a.id,
                place,
                json.dumps(a.values),
                " ".join(map(content_of, a.case.motions)) or None,
            )
            for place, a in self.analyses
        )
        others = [file for file in _ledgers(self.folder) if file.stem != stem(share)]
        if share is None or self.ledger.is_new:
            for other in filter(can_be_opened, others):
                self.ledger.adopt(other, recover=share is None)
        there = (
            {entry.name for entry in os.scandir(self.folder / "analyses")}
            if (self.folder / "analyses").is_dir()
            else set()
        )
        for case_id, state in self.ledger.states().items():
            outcome = (
                finished_outcome(case_id, self.result_folder(case_id)) if case_id in there else None
            )
            # not done yet by the ledger, or it says something else
            if outcome and not self.ledger.agrees(outcome):
                self.ledger.end(outcome)
            elif not outcome and state == DONE:
                self.ledger.plan_again(case_id)
        self.ledger.commit()
        for name in ("analyses", "logs"):
            try:
                (self.folder / name).mkdir(exist_ok=True)
            except FileExistsError:
                raise InputError(
                    self.folder / name,
                    "",
                    None,
                    "is no folder; move it away, the same command does what is missing then",
                ) from None
        if share is None:
            for other in others:
                for file in ledger_files(other):
                    file.unlink(missing_ok=True)

    def missing(self, workers: int = 1) -> list[PlannedAnalysis]:
        """What is planned: in the order of the study file for one worker, so that a study which is
        stopped has what stands first there; for several the longest first, so that no straggler is
        left at the end.
        """
        states = self.ledger.states()
        planned = [a for _, a in self.analyses if states[a.id] == PLANNED]
        return planned if workers == 1 else sorted(planned, key=lambda a: -a.effort)

    def rows(self) -> list[dict[str, Any]]:
        """As `Study.rows`."""
        return self.ledger.rows()

    def result_folder(self, case_id: str) -> Path:
        """Folder of the results of one analysis."""
        return self.folder / "analyses" / case_id

    def log_file(self, case_id: str) -> Path:
        """File with the output and traceback of one analysis."""
        return self.folder / "logs" / f"{case_id}.log"

    def task(self, analysis: PlannedAnalysis) -> Task:
        """An analysis as a worker takes it."""
        return Task(
            analysis.id, analysis.case, self.result_folder(analysis.id), self.log_file(analysis.id)
        )

    def end(self, outcome: TaskOutcome) -> None:
        """Record the end of an analysis."""
        self.ledger.end(outcome, f"logs/{outcome.id}.log")

    def close(self) -> None:
        """Close the ledger and release the study's lock."""
        self.ledger.close()
        self._lock.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


@dataclass(frozen=True, slots=True)
class Study:
    """What a study folder holds.

    Attributes
    ----------
    title
        of the study file.
    axes
        values of each axis by its dotted key, in the order of the study file.
    rows
        one dict an analysis in the order of the study file: id, axes, state ("planned", "running",
        "done", "failed"), reason (why it failed), wall_s [s], version, summary (None until done);
        motion (digest), machine, started [s since the epoch] and log (file with the traceback of a
        failure, relative to the folder).
    analyses
        number of all analyses; while a job array is at work, its tasks that have not begun have no
        rows yet.
    """

    title: str
    axes: dict[str, list[Any]]
    rows: list[dict[str, Any]]
    analyses: int


def read_study(folder: Path | str) -> Study:
    """The study in a folder, read without its study file and without touching it, finished or not.

    Raises
    ------
    InputError
        the folder holds no study, or one that cannot be read.
    """
    folder = Path(folder)
    try:
        identity = _identity(folder)
    except Unreadable as error:
        raise InputError(folder / "study.json", "", None, str(error)) from None
    if identity is None:
        raise InputError(
            folder, "", None, "holds no study (no study.json); a folder of fecolumn study is needed"
        )
    ledgers, files = [], _ledgers(folder)
    try:
        for file in files:
            if not can_be_opened(file):
                raise InputError(
                    file, "", None, "is no file; run fecolumn study on this folder again"
                )
            if ledger := open_to_read(file):
                ledgers.append(ledger)
        rows = ledger_rows(*ledgers)
    except sqlite3.Error as error:
        raise InputError(
            folder,
            "",
            None,
            f"its ledger cannot be read ({error}); run fecolumn study on this folder again",
        ) from None
    finally:
        for ledger in ledgers:
            ledger.close()
    for row in rows:
        if identity["axes"].keys() - row["axes"].keys():
            raise InputError(
                folder,
                "",
                None,
                f"its ledger says nothing of some axes of analysis {row['id']}; run "
                "fecolumn study on this folder again",
            )
    return Study(identity["title"], identity["axes"], rows, identity["analyses"])


def _ledgers(folder: Path) -> list[Path]:
    """Ledgers of all drivers; a user's own copy goes by another name."""
    return sorted(
        file
        for file in folder.glob("study*.sqlite")
        if re.fullmatch(r"study(-\d+-of-\d+)?", file.stem)
    )


def _share(plan: Plan, share: tuple[int, int] | None) -> list[tuple[int, PlannedAnalysis]]:
    """Analyses of a driver with their places; dealt out longest first, so that all tasks of an
    array have about the same work.
    """
    placed = list(enumerate(plan.analyses))
    if share is None:
        return placed
    dealt = sorted(placed, key=lambda item: -item[1].effort)[share[0] :: share[1]]
    return sorted(dealt, key=lambda item: item[0])


def _refuse_foreign(folder: Path, identity: dict[str, Any]) -> dict[str, Any] | None:
    """Refuse what this study must not touch, reading only; what study.json says, None where there
    is none.
    """
    if os.path.lexists(folder) and not folder.is_dir():
        raise InputError(
            folder,
            "",
            None,
            "is a file; a folder is needed"
            if folder.exists()
            else "is a link to nothing; a folder is needed",
        )
    try:
        found = _identity(folder)
    except Unreadable as error:
        raise InputError(folder / "study.json", "", None, f"{error}; give another folder") from None
    if found is None:
        if folder.exists() and not all(_OWN.fullmatch(entry.name) for entry in folder.iterdir()):
            raise InputError(
                folder, "", None, "is not empty and holds no study; give another folder"
            )
        return None
    if found["study"] != identity["study"]:
        raise InputError(
            folder,
            "",
            None,
            f"holds another study, {found['title']!r} with {found['analyses']} analyses "
            f"(this one has {identity['analyses']}, not the same); nothing was changed, "
            "give another folder",
        )
    if found["entry"] != identity["entry"]:
        raise InputError(
            folder,
            "",
            None,
            f"holds this study run by {found['entry']}, not {identity['entry']}; give "
            "another folder",
        )
    return found


def _identity(folder: Path) -> dict[str, Any] | None:
    """What study.json says: study, analyses, entry, title, axes; None where there is no such file.

    Raises
    ------
    Unreadable
        it cannot be read, or is damaged.
    """
    if not os.path.lexists(folder / "study.json"):
        return None
    identity = read_json(folder / "study.json")
    kinds = {"study": str, "analyses": int, "entry": str, "title": str, "axes": dict}
    if (
        not isinstance(identity, dict)
        or not all(isinstance(identity.get(key), kind) for key, kind in kinds.items())
        or not all(isinstance(values, list) for values in identity["axes"].values())
    ):
        raise Unreadable("is damaged: it must state study, analyses, entry, title and axes")
    return identity
