"""Memory of a worker between its analyses."""

import gc
import os
from pathlib import Path

from fecolumn.study.outcome import Task
from fecolumn.study.worker import streams_kept, work_off


def own_memory_mb():
    """Memory of this process that it shares with none [MB]."""
    resident, shared = Path("/proc/self/statm").read_text().split()[1:3]
    return (int(resident) - int(shared)) * os.sysconf("SC_PAGE_SIZE") / 1e6


def test_a_worker_gives_back_what_an_analysis_freed_between_pieces_that_stay(tmp_path):
    kept, held = [], []

    def run(case, folder, **options):
        pieces = [bytearray(4000) for _ in range(100_000)]
        kept.extend(pieces[::500])  # the last one above all that is freed
        kept.append(pieces[-1])
        del pieces
        gc.collect()
        held.append(own_memory_mb())

    before = own_memory_mb()
    with streams_kept():
        list(work_off([Task("one", None, tmp_path / "one", tmp_path / "one.log")], run, "study.toml"))
    assert held[0] - before > 200, "freed memory was kept"
    assert own_memory_mb() - before < 50
