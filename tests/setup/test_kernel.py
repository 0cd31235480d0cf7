import os
import subprocess
import sys

TWICE = """
from fecolumn.foundation._compiled import njit

@njit(alone=True)
def twice(value):
    return value + value
"""

# Saving takes long: what another process saves in between must not be lost
SLOW = """
import sys, time
from numba.core.caching import IndexDataCacheFile
from twice import twice
saved = IndexDataCacheFile._save_index
IndexDataCacheFile._save_index = lambda self, overloads: (time.sleep(1.0), saved(self, overloads))
print(eval("twice(" + sys.argv[1] + ")"))
"""


def test_processes_that_compile_a_function_for_other_types_at_once_keep_all_forms(tmp_path):
    (tmp_path / "twice.py").write_text(TWICE)
    environment = os.environ | {
        "FECOLUMN_CACHE": str(tmp_path / "cache"),
        "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]),
    }

    def started(value, code=SLOW):
        return subprocess.Popen(
            [sys.executable, "-c", code, value], env=environment, text=True, stdout=subprocess.PIPE
        )

    def answers(processes):
        return [process.communicate(timeout=120)[0].strip() for process in processes]

    assert answers([started("1")]) == ["2"]
    assert answers([started("1.5"), started("1j")]) == ["3.0", "2j"]
    kept = (
        "from twice import twice; print(twice(1), twice(1.5), twice(1j), "
        "sum(twice.stats.cache_hits.values()))"
    )
    assert answers([started("", kept)]) == ["2 3.0 2j 3"]
