"""Rows of a study that come with the repository, one file a setting: a clone goes on from them."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any

from benchmarks.tables.runs import read_runs, write_runs
from fecolumn.study.plan import Plan
from fecolumn.study.run import StudyError, complete_study, stop_code
from fecolumn.study.store import DONE

#: Of a summary, what tells its outcome
OUTCOME = "u_max_m", "overturned", "slid_off"


def kept_name(study: str, values: dict[str, Any]) -> str:
    """Of the rows of a setting in benchmarks/tables; study: such as "decided/own_mesh"."""
    told = (value if isinstance(value, str) else f"{value:g}" for value in values.values())
    return "-".join([study, *told])


def number_of(values: dict[str, Any]) -> int:
    """Of the motion of an analysis, by its axis values."""
    return int(re.split("[#:]", values["motion.source"])[-1])


def kept_rows(study: str, plan: Plan) -> dict[str, dict[str, Any]]:
    """Rows of a ledger, by id, of what comes with the repository."""
    runs: dict[str, dict] = {}
    rows = {}
    for analysis in plan.analyses:
        name = kept_name(study, analysis.combination)
        if name not in runs:
            runs[name] = read_runs(name)
        if summary := runs[name].get(number_of(analysis.values)):
            rows[analysis.id] = {"id": analysis.id, "state": DONE, "summary": summary}
    return rows


def worked_off(
    study: str, plan: Plan, folder: Path, args: argparse.Namespace, command: str, columns: tuple
) -> tuple[list[dict[str, Any]], int]:
    """Do what is missing of the first motions of the Lick ensemble, and does not come with the
    repository; their rows, and the exit code where it was stopped, else 0.

    args: jobs, motions (how many), report (nothing is computed), keep (what is done comes with the
    repository, as of `keep_rows`).
    """
    first = {f"lick:{number}" for number in range(1, args.motions + 1)}
    wanted = {one.id for one in plan.analyses if one.values["motion.source"] in first}
    kept, code = kept_rows(study, plan), 0
    todo = set() if args.report else wanted - kept.keys()
    try:
        complete_study(plan, folder, workers=args.jobs, retry_failed=True, only=todo)
    except (KeyboardInterrupt, StudyError) as error:
        code = stop_code(error)
    rows = [kept.get(row["id"], row) for row in complete_study(plan, folder, only=set())]
    if args.keep:
        keep_rows(study, plan, rows, command, columns)
    return [row for row in rows if row["id"] in wanted], code


def keep_rows(
    study: str,
    plan: Plan,
    rows: list[dict[str, Any]],
    command: str,
    columns: tuple[str, ...] = OUTCOME,
) -> None:
    """Have the rows of a study that are done come with the repository; columns: entries of their
    summaries, nil where a summary has none.
    """
    summaries = {row["id"]: row["summary"] for row in rows if row["state"] == DONE}
    runs: dict[str, dict[int, dict]] = {}
    for analysis in plan.analyses:
        if summary := summaries.get(analysis.id):
            kept = {key: summary.get(key, False) for key in columns}
            into = runs.setdefault(kept_name(study, analysis.combination), {})
            into[number_of(analysis.values)] = kept
    for name, found in runs.items():
        title = f"{plan.title}: {name.partition('/')[2]}, largest displacement [m] and outcome"
        write_runs(name, found, title, command)
