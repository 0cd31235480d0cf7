"""The ledger of a study: one SQLite row an analysis."""

from __future__ import annotations

import json
import os
import sqlite3
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from fecolumn.engines.summary import fault_of
from fecolumn.foundation.files import is_file
from fecolumn.foundation.schema import shown
from fecolumn.study.outcome import DONE, FAILED, TaskOutcome

PLANNED, RUNNING = "planned", "running"

# Changes are written together, so that cheap analyses do not wait for the ledger; what a crash
# loses of it the results tell again
_COMMIT_S = 0.5

_SCHEMA = """
CREATE TABLE IF NOT EXISTS analysis (
    id      TEXT PRIMARY KEY,   -- case id, the name of the result folder
    place   INTEGER NOT NULL,   -- order in the study file
    axes    TEXT NOT NULL,      -- JSON: value of each axis
    motion  TEXT,               -- digest of the motion's files, or its name where it is no file
    state   TEXT NOT NULL CHECK (state IN ('planned', 'running', 'done', 'failed')),
    reason  TEXT,               -- why it failed
    log     TEXT,               -- traceback of a failure: file, relative to the study's folder
    wall_s  REAL,               -- wall time of the worker
    started REAL,               -- seconds since the epoch
    machine TEXT,               -- name and processor of the machine it was done on
    version TEXT,               -- version of fecolumn that wrote the summary
    summary TEXT                -- JSON: summary.json of an analysis that is done
)"""
_TOLD = ("state", "reason", "log", "wall_s", "started", "machine", "version", "summary")
_ROW = (
    "id",
    "axes",
    "state",
    "reason",
    "wall_s",
    "version",
    "summary",
    "motion",
    "machine",
    "started",
    "log",
)
_ORDER = {DONE: 0, RUNNING: 1, FAILED: 2, PLANNED: 3}


class StudyLedger:
    """A ledger open for its one writer.

    Parameters
    ----------
    file
        made if it is not there; one that an earlier version wrote is made anew, and so is a damaged
        one, which is put aside.
    many_readers
        whether others may read while it is written (WAL); not over network file systems.

    Attributes
    ----------
    is_new
        whether it was made just now.
    put_aside
        where a damaged one is now, None where there was none.
    """

    def __init__(self, file: Path, many_readers: bool) -> None:
        self._committed, self._many_readers, self.put_aside = time.monotonic(), many_readers, None
        try:
            if not can_be_opened(file):
                raise sqlite3.DatabaseError("no file")
            self._open(file)
        except sqlite3.DatabaseError as error:
            # cannot be opened, or the disk is full: it may be as good as ever
            if isinstance(error, sqlite3.OperationalError):
                raise
            self.put_aside = file.with_name(f"{file.name}.damaged")
            for name in ledger_files(file):
                if os.path.lexists(name):
                    os.replace(name, f"{name}.damaged")
            self._open(file)

    def _open(self, file: Path) -> None:
        self.is_new = not file.exists()
        self._connection = sqlite3.connect(file, timeout=30.0)
        try:
            run = self._connection.execute
            run(f"PRAGMA journal_mode = {'WAL' if self._many_readers else 'TRUNCATE'}")
            run("PRAGMA synchronous = NORMAL")
            if (fault := run("PRAGMA integrity_check(1)").fetchone()[0]) != "ok":
                raise sqlite3.DatabaseError(fault)
            columns = {row[1] for row in run("PRAGMA table_info(analysis)")}
            if columns and columns != {"place", *_ROW}:
                run("DROP TABLE analysis")
                self.is_new = True
            run(_SCHEMA)
        except BaseException:
            self._connection.close()
            raise

    def plan(self, rows: Iterable[tuple[str, int, str, str | None]]) -> None:
        """Take analyses (id, place, axes as JSON, motion) into the ledger as planned.

        Analyses that the ledger knows keep their state. Those that ran when the last writer ended,
        or have no valid state, are planned again. Rows of other analyses are deleted.
        """
        run = self._connection.execute
        run("CREATE TEMP TABLE wanted (id TEXT PRIMARY KEY, place, axes, motion)")
        self._connection.executemany("INSERT INTO wanted VALUES (?, ?, ?, ?)", rows)
        run("DELETE FROM analysis WHERE typeof(id) != 'text' OR id NOT IN (SELECT id FROM wanted)")
        run(
            "INSERT INTO analysis (id, place, axes, motion, state) SELECT id, place, "
            "axes, motion, 'planned' FROM wanted WHERE true "
            "ON CONFLICT (id) DO UPDATE SET place = excluded.place, axes = "
            "excluded.axes, motion = excluded.motion "
            "WHERE (analysis.place, analysis.axes, analysis.motion) IS NOT "
            "(excluded.place, excluded.axes, excluded.motion)"
        )
        run("DROP TABLE wanted")
        run(
            "UPDATE analysis SET state = 'planned' WHERE state NOT IN ('planned', 'done', 'failed')"
        )

    def agrees(self, outcome: TaskOutcome) -> bool:
        """Whether an analysis is recorded as done with this very summary."""
        return (
            self._connection.execute(
                "SELECT 1 FROM analysis WHERE id = ? AND state = 'done' AND summary = ?",
                (outcome.id, outcome.summary),
            ).fetchone()
            is not None
        )

    def adopt(self, other: Path, recover: bool) -> None:
        """Take over what another ledger knows of the end of analyses that are only planned here.

        Parameters
        ----------
        recover
            whether nobody else can have it open, so that what a killed writer left half done may be
            undone.
        """
        try:
            found = sqlite3.connect(other) if recover else open_to_read(other)
        except sqlite3.Error:
            found = None
        if found is None:
            return  # damaged, of an earlier version or empty: the results tell
        names = ", ".join(_TOLD)
        try:
            self._connection.executemany(
                f"UPDATE analysis SET {', '.join(f'{name} = ?' for name in _TOLD)} "
                "WHERE id = ? AND state = 'planned'",
                found.execute(
                    f"SELECT {names}, id FROM analysis WHERE state IN ('done', 'failed')"
                ),
            )
        except sqlite3.Error:
            return
        finally:
            found.close()

    def states(self) -> dict[str, str]:
        """State of every analysis by its id, in the order of the study file."""
        return dict(self._connection.execute("SELECT id, state FROM analysis ORDER BY place"))

    def counts(self) -> dict[str, int]:
        """Number of analyses by state, and of those "overturned" and "slid_off"."""
        counts = dict(
            self._connection.execute("SELECT state, count(*) FROM analysis GROUP BY state")
        )
        for outcome in ("overturned", "slid_off"):
            (counts[outcome],) = self._connection.execute(
                "SELECT count(*) FROM analysis WHERE state = 'done' AND "
                f"json_extract(summary, '$.{outcome}')"
            ).fetchone()
        return counts

    def rows(self) -> list[dict[str, Any]]:
        """As `Study.rows`."""
        return ledger_rows(self._connection)

    def begin(self, case_ids: Iterable[str]) -> None:
        """Record that analyses were handed out."""
        now = time.time()
        self._connection.executemany(
            "UPDATE analysis SET state = 'running', started = ? WHERE id = ?",
            [(now, name) for name in case_ids],
        )

    def plan_again(self, *case_ids: str) -> None:
        """Put analyses back among the planned."""
        self._connection.executemany(
            "UPDATE analysis SET state = 'planned', reason = NULL, log = NULL, summary "
            "= NULL, version = NULL WHERE id = ?",
            [(case_id,) for case_id in case_ids],
        )

    def in_state(self, state: str) -> list[str]:
        """Ids of the analyses of a state."""
        return [case_id for case_id, found in self.states().items() if found == state]

    def end(self, outcome: TaskOutcome, log: str | None = None) -> None:
        """Record the end of an analysis, DONE or FAILED."""
        failed = outcome.word == FAILED
        self._connection.execute(
            "UPDATE analysis SET state = ?, reason = ?, log = ?, wall_s = coalesce(?, "
            "wall_s), started = coalesce(?, started), "
            "machine = coalesce(?, machine), version = ?, summary = ? WHERE id = ?",
            (
                outcome.word,
                outcome.reason if failed else None,
                log if failed else None,
                outcome.wall_s,
                outcome.started,
                outcome.machine,
                outcome.version,
                outcome.summary,
                outcome.id,
            ),
        )
        if failed:
            self.commit()  # no result tells of a failure

    def commit(self, at_most_every_s: float = 0.0) -> None:
        """Write what was recorded, unless that was done a moment ago."""
        now = time.monotonic()
        if now - self._committed >= at_most_every_s:
            self._connection.commit()
            self._committed = now

    def commit_now_and_then(self) -> None:
        """Write what was recorded, twice a second at most."""
        self.commit(_COMMIT_S)

    def close(self) -> None:
        """Write all and leave a single plain file, which can be read from a folder that may not be
        written.
        """
        try:
            self._connection.commit()
            if self._many_readers:
                self._connection.execute("PRAGMA journal_mode = DELETE")
        except sqlite3.OperationalError:
            pass  # a reader is in it, or the disk is full: the next writer tidies up
        self._connection.close()


def ledger_files(file: Path) -> list[Path]:
    """A ledger's file and those in which SQLite keeps its changes."""
    return [file.with_name(file.name + ending) for ending in ("", "-wal", "-shm", "-journal")]


def can_be_opened(file: Path) -> bool:
    """Whether SQLite can open a ledger, or make it, without being held up by a pipe or a device in
    its place.
    """
    return all(is_file(name) or not os.path.lexists(name) for name in ledger_files(file))


def open_to_read(file: Path) -> sqlite3.Connection | None:
    """A ledger, read only, None where it is just being made; where the folder may not be written,
    readers cannot be counted, and need not be.
    """
    for option in ("mode=ro", "mode=ro&immutable=1"):
        ledger = sqlite3.connect(f"{file.resolve().as_uri()}?{option}", uri=True, timeout=30.0)
        try:
            ledger.execute(f"SELECT {', '.join(_ROW)} FROM analysis LIMIT 1")
            return ledger
        except sqlite3.OperationalError as error:
            ledger.close()
            if "no such table" in str(error):
                return None
            if "immutable" in option:
                raise
    return None


def ledger_rows(*ledgers: sqlite3.Connection) -> list[dict[str, Any]]:
    """Every analysis in the order of the study file, its axes and summary as dicts; of several
    ledgers, the one that got farthest counts.

    Raises
    ------
    sqlite3.DatabaseError
        damaged.
    """
    best: dict[str, tuple[Any, ...]] = {}
    for ledger in ledgers:
        for place, *row in ledger.execute(f"SELECT place, {', '.join(_ROW)} FROM analysis"):
            known = best.get(row[0])
            if row[2] not in _ORDER:
                raise sqlite3.DatabaseError(f"the row of analysis {shown(row[0])} is damaged")
            if known is None or _ORDER[row[2]] < _ORDER[known[1][2]]:
                best[row[0]] = place, row
    rows = [dict(zip(_ROW, row)) for _, row in sorted(best.values(), key=lambda found: found[0])]
    try:
        for row in rows:
            row["axes"], row["summary"] = (
                json.loads(row["axes"]),
                json.loads(row["summary"] or "null"),
            )
            if not isinstance(row["axes"], dict) or (
                row["state"] == DONE and fault_of(row["summary"], row["id"])
            ):
                raise ValueError
    except (ValueError, TypeError, RecursionError):
        raise sqlite3.DatabaseError(f"the row of analysis {shown(row['id'])} is damaged") from None
    return rows
