"""Compiled functions, and where they and other things made once are kept."""

from __future__ import annotations

import functools
import os
from pathlib import Path
from typing import Any

import numba
from llvmlite.binding import get_host_cpu_name

from fecolumn.foundation._kernel import Kernel, is_kept, is_tested
from fecolumn.foundation.sources import digest_of

# Folders of which compiled functions take code or constants, and the files that say how they are
# compiled
_SOURCES, _HOW = (
    ("fem", "contact", "engines/dynamics", "engines/reduced"),
    ("foundation/_borrowed.py", "foundation/_compiled.py", "foundation/_kernel.py"),
)


def cache_folder() -> Path:
    """$FECOLUMN_CACHE, or fecolumn in $XDG_CACHE_HOME or ~/.cache.

    It may be deleted at any time.
    """
    if folder := os.environ.get("FECOLUMN_CACHE"):
        return Path(folder)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "fecolumn"


@functools.cache
def compiled_folder(alone: tuple[str, ...] = ()) -> str:
    """Folder of the functions compiled from the present sources by this numba for this processor.

    numba asks only whether a function's own file has changed: code compiled with what another file
    said before would be run.

    Parameters
    ----------
    alone
        files of functions that take code and constants from these alone; () for those of the
        engines. They are kept in $FECOLUMN_COMPILED where that is given: tests, whose cache of
        everything else is their own, need not compile them again.
    """
    package = Path(__file__).parents[1]
    taken = (
        [Path(file) for file in alone]
        if alone
        else [path for name in _SOURCES for path in sorted((package / name).glob("*.py"))]
    )
    sources = digest_of([*taken, *(package / name for name in _HOW)])
    home = Path(alone and os.environ.get("FECOLUMN_COMPILED") or cache_folder())
    return str(home / f"compiled-{sources}-numba-{numba.__version__}-{get_host_cpu_name()}")


def njit(function: Any = None, *, alone: bool | tuple[str, ...] = False, **options: Any) -> Any:
    """numba.njit with a cache on disk that knows all sources; a decorator, with or without options.

    Parameters
    ----------
    alone
        whether the function takes code and constants from its own file alone, or from those beside
        it that are named, too, so that no other file's change compiles it again.
    """
    if function is None:
        return lambda one: njit(one, alone=alone, **options)
    # a division by zero gives what it gives in numpy: to raise Python's error each division would
    # ask first, and each caller after
    options.setdefault("error_model", "numpy")
    own, beside = Path(function.__code__.co_filename), () if alone is True else alone or ()
    files = (str(own), *(str(own.with_name(name)) for name in beside)) if alone else ()
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, compiled_folder(files)
    try:
        if not is_tested() or numba.config.DISABLE_JIT:
            return numba.njit(cache=True, **options)(function)
        kernel = Kernel(function, targetoptions=dict(nopython=True, **options))
        kernel.enable_caching()
        return kernel
    finally:
        numba.config.CACHE_DIR = before


def compiled(function: Any) -> bool:
    """Whether a function of `njit` has been compiled on this machine, by whatever process, or is
    not to be compiled at all.
    """
    return numba.config.DISABLE_JIT or bool(function.signatures) or is_kept(function)


def compile_for(function: Any, arguments: tuple[Any, ...]) -> None:
    """Have a function of `njit` ready for arguments like these, without calling it: so that its
    first call costs what all cost.
    """
    if not numba.config.DISABLE_JIT:
        function.compile(tuple(numba.typeof(argument) for argument in arguments))


def interpreted(function: Any) -> Any:
    """A function of `njit` as plain Python, which calls compiled ones: for a single call it is not
    worth compiling it by itself.
    """
    return getattr(function, "py_func", function)
