"""What the tests make once, column models above all, goes into a cache that lives as long as they
do.

A model that other code made before is so never taken for one of the code under test, and nothing is
left in the user's cache. Compiled functions alone stay in the user's: their folder is named after
all sources, and to compile takes a minute.
"""

import atexit
import os
import shutil
import tempfile
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")


def _cache_of_the_tests() -> str:
    from fecolumn.foundation._compiled import cache_folder, compiled_folder

    # of functions that take code from their own file alone
    os.environ["FECOLUMN_COMPILED"] = str(cache_folder())
    compiled = Path(compiled_folder())
    compiled_folder.cache_clear()
    compiled.mkdir(parents=True, exist_ok=True)
    folder = tempfile.mkdtemp(prefix="fecolumn-tests-")
    (Path(folder) / compiled.name).symlink_to(compiled.resolve(), target_is_directory=True)
    return folder


# workers of pytest-xdist share the cache of the process that started them
if "PYTEST_XDIST_WORKER" not in os.environ:
    os.environ["FECOLUMN_CACHE"] = _cache_of_the_tests()
    atexit.register(shutil.rmtree, os.environ["FECOLUMN_CACHE"], ignore_errors=True)
