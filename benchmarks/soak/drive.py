"""The process that drives the blocks one by one: python -m benchmarks.soak.drive DIR TOTAL JOBS
SEED SPECIMENS
"""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.soak.analysis import ENTRY
from benchmarks.soak.cases import block, blocks
from benchmarks.soak.motions import write_motions
from benchmarks.soak.specimens import specimens
from fecolumn.study.run import complete_study
from fecolumn.study.worker import die_with_parent

# How the pool says that a worker was killed under its analysis
KILLED = "worker killed by SIGKILL"


def block_folder(folder: Path, number: int) -> Path:
    """Study folder of a block."""
    return folder / f"block-{number:03d}"


def killed(row: dict) -> bool:
    """Whether an analysis failed for no fault of its own."""
    return row["state"] == "failed" and row["reason"].startswith(KILLED)


def main() -> None:
    """Do what is missing; analyses whose worker was killed are done again."""
    die_with_parent()
    folder, total, jobs, seed, count = Path(sys.argv[1]), *map(int, sys.argv[2:])
    columns, sources = specimens(count), write_motions(folder / "motions")
    for number, size in blocks(total):
        plan, rows = block(number, size, sources, seed, columns), None
        while rows is None or any(map(killed, rows)):
            rows = complete_study(
                plan,
                block_folder(folder, number),
                workers=jobs,
                entry=ENTRY,
                retry_failed=rows is not None,
            )


if __name__ == "__main__":
    main()
