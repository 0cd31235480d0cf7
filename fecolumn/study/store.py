"""The folder of a study: study.json says which study it holds, study.sqlite how far it is, analyses/<id>/ the results,
logs/<id>.log what an analysis said.

The results are the truth: an analysis is done when its summary.json exists and carries its id. The ledger is brought
in line with them whenever a driver opens the folder, so killing anything at any time loses only what was in flight.
"""

from __future__ import annotations

import fcntl
import json
import os
import socket
import sqlite3
import time
from dataclasses import dataclass
from pathlib import Path

from fecolumn.atomic import write_json
from fecolumn.schema import InputError
from fecolumn.study.plan import Plan

PLANNED, RUNNING, DONE, FAILED = "planned", "running", "done", "failed"

_SCHEMA = """
CREATE TABLE IF NOT EXISTS analysis (
    id      TEXT PRIMARY KEY,   -- case id, the name of the result folder
    place   INTEGER NOT NULL,   -- order in the study file
    axes    TEXT NOT NULL,      -- JSON: value of each axis
    state   TEXT NOT NULL CHECK (state IN ('planned', 'running', 'done', 'failed')),
    reason  TEXT,               -- why it failed
    wall_s  REAL,               -- wall time of the worker
    started REAL,               -- seconds since the epoch
    version TEXT,               -- version of fecolumn that wrote the summary
    summary TEXT                -- JSON: summary.json of an analysis that is done
)"""


class Store:
    """Ledger of a study, held by one driver at a time.

    Raises:
        InputError: the folder holds another study or something else, or another driver works in it.
    """

    def __init__(self, folder, plan: Plan, entry: str):
        self.folder = Path(folder)
        identity = {"study": plan.id, "analyses": len(plan.analyses), "entry": entry}
        _refuse_foreign(self.folder, identity)
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = _locked(self.folder)
        _refuse_foreign(self.folder, identity)  # another driver may have been first
        if not (self.folder / "study.json").exists():
            write_json(self.folder / "study.json", {**identity, "title": plan.title, "axes": plan.axes})
        self._ledger = sqlite3.connect(self.folder / "study.sqlite")
        self._ledger.execute("PRAGMA journal_mode = WAL")
        self._ledger.execute("PRAGMA synchronous = NORMAL")
        self._reconcile(plan)

    def _reconcile(self, plan: Plan) -> None:
        with self._ledger:
            self._ledger.execute(_SCHEMA)
            self._ledger.executemany("INSERT OR IGNORE INTO analysis (id, place, axes, state) VALUES (?, ?, ?, 'planned')",
                                     [(a.id, place, json.dumps(a.values)) for place, a in enumerate(plan.analyses)])
            self._ledger.execute("UPDATE analysis SET state = 'planned' WHERE state = 'running'")
            for case_id, state in self.states().items():
                summary = self.summary(case_id)
                if summary and state != DONE:
                    self._set(case_id, DONE, summary=summary)
                elif not summary and state == DONE:
                    self._set(case_id, PLANNED)

    def states(self) -> dict[str, str]:
        """State of every analysis by its id, in the order of the study file."""
        return dict(self._ledger.execute("SELECT id, state FROM analysis ORDER BY place"))

    def rows(self) -> list[dict]:
        """Every analysis in the order of the study file, its axes and summary as dicts (summary None until done)."""
        return _rows(self._ledger)

    def result_folder(self, case_id: str) -> Path:
        return self.folder / "analyses" / case_id

    def log_file(self, case_id: str) -> Path:
        return self.folder / "logs" / f"{case_id}.log"

    def summary(self, case_id: str) -> dict | None:
        """Summary of a finished analysis, None where there is none or it belongs to another case."""
        try:
            summary = json.loads((self.result_folder(case_id) / "summary.json").read_text())
        except (OSError, ValueError):
            return None
        return summary if isinstance(summary, dict) and summary.get("case_id") == case_id else None

    def start(self, case_id: str) -> None:
        """Record the start of an analysis that has no valid summary; an invalid one is cleared away."""
        (self.result_folder(case_id) / "summary.json").unlink(missing_ok=True)
        with self._ledger:
            self._set(case_id, RUNNING, started=time.time())

    def finish(self, case_id: str, wall_s: float) -> str:
        """Record the end of an analysis; returns its state, failed where it left no valid summary."""
        summary = self.summary(case_id)
        if not summary:
            return self.fail(case_id, "ended without a summary.json of its own", wall_s)
        with self._ledger:
            self._set(case_id, DONE, wall_s=wall_s, summary=summary)
        return DONE

    def fail(self, case_id: str, reason: str, wall_s: float) -> str:
        """Record why an analysis has no result; returns its state."""
        with self._ledger:
            self._set(case_id, FAILED, wall_s=wall_s, reason=reason)
        return FAILED

    def plan_again(self, state: str) -> None:
        """Put all analyses of a state back among the planned."""
        with self._ledger:
            self._ledger.execute("UPDATE analysis SET state = 'planned', reason = NULL WHERE state = ?", (state,))

    def _set(self, case_id, state, *, reason=None, wall_s=None, started=None, summary=None) -> None:
        self._ledger.execute(
            "UPDATE analysis SET state = ?, reason = ?, wall_s = coalesce(?, wall_s), started = coalesce(?, started), "
            "version = ?, summary = ? WHERE id = ?",
            (state, reason, wall_s, started, summary and summary.get("version"), summary and json.dumps(summary), case_id))

    def close(self) -> None:
        self._ledger.close()
        self._lock.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


@dataclass(frozen=True, slots=True)
class Study:
    """What a study folder holds.

    Attributes:
        title: of the study file.
        axes: values of each axis by its dotted key, in the order of the study file.
        rows: one dict an analysis in the order of the study file: id, axes, state ("planned", "running", "done", "failed"),
            reason (why it failed), wall_s [s], version, summary (None until done).
    """

    title: str
    axes: dict[str, list]
    rows: list[dict]


def read_study(folder) -> Study:
    """The study in a folder, read without its study file and without touching it, finished or not.

    Raises:
        InputError: the folder holds no study, or one that cannot be read.
    """
    folder = Path(folder)
    try:
        identity = json.loads((folder / "study.json").read_text())
        title, axes = identity["title"], identity["axes"]
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(folder, "", None, "holds no study (no study.json); a folder of fecolumn study is needed") from None
    except (ValueError, KeyError, TypeError):
        raise InputError(folder / "study.json", "", None, "is damaged") from None
    try:
        ledger = _opened_to_read(folder / "study.sqlite")
        try:
            rows = _rows(ledger)
        finally:
            ledger.close()
    except sqlite3.Error as error:
        raise InputError(folder / "study.sqlite", "", None, f"cannot be read ({error}); run fecolumn study on this folder again") from None
    return Study(title, axes, rows)


def _opened_to_read(file: Path) -> sqlite3.Connection:
    """The ledger, read only; in a folder that may not be written the journal of readers cannot be made, and is not needed."""
    for option in ("mode=ro", "immutable=1"):
        ledger = sqlite3.connect(f"{file.resolve().as_uri()}?{option}", uri=True)
        try:
            ledger.execute("SELECT count(*) FROM analysis")
            return ledger
        except sqlite3.OperationalError:
            ledger.close()
            if option == "immutable=1":
                raise


def _rows(ledger: sqlite3.Connection) -> list[dict]:
    names = ("id", "axes", "state", "reason", "wall_s", "version", "summary")
    rows = [dict(zip(names, row)) for row in ledger.execute(f"SELECT {', '.join(names)} FROM analysis ORDER BY place")]
    return [{**row, "axes": json.loads(row["axes"]), "summary": json.loads(row["summary"] or "null")} for row in rows]


def _refuse_foreign(folder: Path, identity: dict) -> None:
    """Refuse what this study must not touch, reading only."""
    if folder.exists() and not folder.is_dir():
        raise InputError(folder, "", None, "is a file; a folder is needed")
    try:
        found = json.loads((folder / "study.json").read_text())
    except FileNotFoundError:
        if folder.exists() and {entry.name for entry in folder.iterdir()} - {"study.lock", "study.json.partial"}:
            raise InputError(folder, "", None, "is not empty and holds no study; give another folder") from None
        return
    except ValueError:
        raise InputError(folder / "study.json", "", None, "is damaged; give another folder") from None
    if found.get("study") != identity["study"]:
        raise InputError(folder, "", None, f"holds another study, {found.get('title')!r} with {found.get('analyses')} analyses "
                         f"(this one has {identity['analyses']}, not the same); nothing was changed, give another folder")
    if found.get("entry") != identity["entry"]:
        raise InputError(folder, "", None, f"holds this study run by {found.get('entry')}, not {identity['entry']}; give another folder")


def _locked(folder: Path):
    """The open lock file; the kernel frees it when the process ends, however it ends."""
    lock = open(folder / "study.lock", "a+")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        lock.seek(0)
        owner = lock.read().strip()
        lock.close()
        raise InputError(folder, "", None, f"another driver works on this study ({owner or 'just starting'}); "
                         "wait for it or stop it") from None
    lock.truncate(0)
    lock.write(f"process {os.getpid()} on {socket.gethostname()}")
    lock.flush()
    return lock
