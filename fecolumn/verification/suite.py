"""Runs the verification cases, prints their table and writes it with a figure for each case."""

from __future__ import annotations

import csv
import importlib
import io
import os
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING

from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.interrupt import ended_at_a_stop
from fecolumn.verification import ALL_ENGINES, CASES
from fecolumn.verification.result import Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH = 74
_KILLED = "a process of this command was killed, which ends all cases: was the memory full?"


@dataclass(frozen=True, slots=True)
class Finding:
    """Rows of one case in one engine, its wall time [s], and `failure` where it raised."""

    case: str
    engine: str
    rows: tuple[Row, ...]
    wall_s: float
    failure: str = ""

    @property
    def ok(self) -> bool:
        """Whether the case ran, has rows, and all of them hold."""
        return not self.failure and bool(self.rows) and all(row.ok for row in self.rows)


def tasks(name: str = "", engines: Iterable[str] = ALL_ENGINES) -> list[tuple[str, str]]:
    """(case, engine) pairs of the suite whose case's name contains `name`."""
    return [
        (case, engine)
        for case, able in CASES.items()
        if name in case
        for engine in able
        if engine in engines
    ]


def run_case(case: str, engine: str, folder: Path | None = None, long: bool = False) -> Finding:
    """Run one case in one engine; write its figure into `folder`."""
    module, began = importlib.import_module(f"fecolumn.verification.{case}"), time.perf_counter()
    try:
        result = module.run(engine, long)
        if folder and result.draw:
            _draw(result.draw, result.size, folder / f"{case}_{engine}")
    except Exception as error:  # one case that breaks must not hide the others
        import traceback

        traceback.print_exc()
        return Finding(
            case, engine, (), time.perf_counter() - began, f"{type(error).__name__}: {error}"
        )
    return Finding(case, engine, tuple(result.rows), time.perf_counter() - began)


def _draw(draw: Callable[[Figure], object], size: tuple[float, float], path: Path | str) -> None:
    from fecolumn.pictures.figures.style import new_figure, save, styled

    with styled():
        figure = new_figure(*size)
        draw(figure)
        save(figure, path)


def verify(
    pairs: Sequence[tuple[str, str]],
    folder: Path,
    long: bool = False,
    workers: int = 1,
    show: Callable[[str], object] = print,
) -> list[Finding]:
    """Run (case, engine) pairs in worker processes, show each as it ends, write table.csv and
    figures into `folder`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    show(header())
    found = {}
    pool = ProcessPoolExecutor(max_workers=workers, mp_context=get_context("spawn"))
    with pool, ended_at_a_stop(pool):
        futures = {
            pool.submit(run_case, case, engine, folder, long): (case, engine)
            for case, engine in pairs
        }
        began = time.perf_counter()
        for future in as_completed(futures):
            pair = futures[future]
            try:
                found[pair] = future.result()
            except BrokenExecutor:  # of this process, or of another of the pool
                wall_s = time.perf_counter() - began
                found[pair] = Finding(*pair, (), wall_s, _KILLED)
            show(finding_lines(found[pair]))
    findings = [found[pair] for pair in pairs]
    write_bytes(folder / "table.csv", _csv(findings).encode())
    write_bytes(
        folder / "table.txt", "\n".join([header(), *map(finding_lines, findings), ""]).encode()
    )
    return findings


def header() -> str:
    """Titles of the columns of `finding_lines`."""
    return (
        f"{'case, quantity':<{_WIDTH}}{'exact':>12}{'computed':>12}{'error':>10}"
        f"{'allowed':>10}{'order':>7}  ok"
    )


def finding_lines(finding: Finding) -> str:
    """The rows of a finding as text."""
    text = [f"{finding.case}, {finding.engine} ({finding.wall_s:.0f} s)"]
    for row in finding.rows:
        order = f"{row.order:.2f}" if row.order is not None else ""
        text.append(
            f"  {row.quantity:<{_WIDTH - 2}}{row.exact:>12.5g}{row.computed:>12.5g}"
            f"{row.error:>10.1e}{row.tolerance:>10.1e}{order:>7}  {'yes' if row.ok else 'NO'}"
        )
    if finding.failure:
        text.append(f"  FAILED: {finding.failure}")
    return "\n".join(text)


def verdict(findings: Sequence[Finding]) -> str:
    """How many rows hold and how many cases do not, after the names of what does not hold, one a
    line.
    """
    wrong, rows = (
        [finding for finding in findings if not finding.ok],
        [row for finding in findings for row in finding.rows],
    )
    names = [
        f"{finding.case}, {finding.engine}: {what}" for finding in wrong for what in _wrong(finding)
    ]
    heading = ["does not hold:", *(f"  {name}" for name in names)] if wrong else []
    return "\n".join(
        [
            *heading,
            f"{sum(row.ok for row in rows)} of {len(rows)} rows hold, {len(wrong)} of "
            f"{len(findings)} cases do not",
        ]
    )


def _wrong(finding: Finding) -> list[str]:
    """The quantities of a finding that do not hold, or how it failed."""
    return (
        [(finding.failure or "has no rows").splitlines()[0]]
        if finding.failure or not finding.rows
        else [row.quantity for row in finding.rows if not row.ok]
    )


def _csv(findings: Sequence[Finding]) -> str:
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(
        ["case", "engine", "quantity", "exact", "computed", "error", "tolerance", "order", "ok"]
    )
    for finding in findings:
        for row in finding.rows:
            writer.writerow(
                [
                    finding.case,
                    finding.engine,
                    row.quantity,
                    row.exact,
                    row.computed,
                    row.error,
                    row.tolerance,
                    "" if row.order is None else row.order,
                    row.ok,
                ]
            )
        if finding.failure:
            writer.writerow(
                [finding.case, finding.engine, finding.failure, "", "", "", "", "", False]
            )
    return text.getvalue()
