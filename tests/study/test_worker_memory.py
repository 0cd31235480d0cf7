"""Memory of a worker between its analyses."""

import subprocess
import sys

# in a process of its own: what one that has done much else frees may find room in what it holds
# already
WORKER = """
import gc, os, sys
from pathlib import Path
from fecolumn.study.outcome import Task
from fecolumn.study.worker import streams_kept, work_off


def own_memory_mb():
    resident, shared = Path("/proc/self/statm").read_text().split()[1:3]
    return (int(resident) - int(shared)) * os.sysconf("SC_PAGE_SIZE") / 1e6


def run(case, folder, **options):
    pieces = [bytearray(4000) for _ in range(100_000)]
    kept.extend(pieces[::500])
    kept.append(pieces[-1])  # above all that is freed
    del pieces
    gc.collect()
    held.append(own_memory_mb())


kept, held, folder = [], [], Path(sys.argv[1])
before = own_memory_mb()
with streams_kept():
    list(work_off([Task("one", None, folder / "one", folder / "one.log")], run, "study.toml"))
print(held[0] - before, own_memory_mb() - before)
"""


def test_a_worker_gives_back_what_an_analysis_freed_between_pieces_that_stay(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", WORKER, str(tmp_path)], capture_output=True, text=True, check=True
    )
    held, after = map(float, done.stdout.split())
    assert held > 200, "what was freed is to be held at first"
    assert after < 50
