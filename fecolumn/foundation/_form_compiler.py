"""dolfinx' form compiler (ffcx 0.5 to 0.9) made safe to kill: what it compiles appears in its cache
whole or not at all.

By itself ffcx takes a file NAME.c for its lock. Where the process that wrote it was killed, every
later one waits ten seconds for it and fails with "JIT compilation timed out", until a user deletes
the file. Here each form is compiled in a folder of its own under a lock of the kernel, which ends
with its process, and then renamed into the cache; a file NAME.c that a killed process left is
written over.
"""

from __future__ import annotations

import contextlib
import importlib.machinery
import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ffcx.codegeneration import jit

from fecolumn.foundation.lock import alone

_compile = jit._compile_objects


def _is_kept(folder: Path, name: str) -> bool:
    """Whether the cache has a compiled module, for this Python."""
    return all(
        (folder / f"{name}{end}").exists()
        for end in (".c.cached", importlib.machinery.EXTENSION_SUFFIXES[0])
    )


def _cached(
    name: str, objects: Sequence[str], folder: Path | str, timeout: float
) -> tuple[Any, Any]:
    """Compiled objects and their module, or None twice where they are not in the cache."""
    return (
        jit._load_objects(Path(folder), name, objects)
        if _is_kept(Path(folder), name)
        else (None, None)
    )


def _compile_apart(
    declarations: str,
    sources: str,
    objects: Sequence[str],
    name: str,
    options: Mapping[str, Any],
    folder: Path | str,
    *how: Any,
    **more: Any,
) -> str:
    """As ffcx' function, in a folder of its own; who comes second waits, and finds it made."""
    folder, code = Path(folder), ""
    try:
        with alone(folder / name):
            if not _is_kept(folder, name):
                own = f".{name}-"
                for left in folder.glob(f"{own}*"):  # of a process that was killed
                    shutil.rmtree(left, ignore_errors=True)
                with tempfile.TemporaryDirectory(
                    prefix=own, dir=folder, ignore_cleanup_errors=True
                ) as apart:
                    code = _compile(
                        declarations, sources, objects, name, options, Path(apart), *how, **more
                    )
                    ready = f"{name}.c.cached"
                    # the sign that all is there comes last
                    for file in sorted(
                        Path(apart).glob(f"{name}*"), key=lambda file: file.name == ready
                    ):
                        os.replace(file, folder / file.name)
    except Exception:
        with contextlib.suppress(OSError):
            (folder / f"{name}.c").touch()  # which ffcx renames before it raises the error
        raise
    return code


jit.get_cached_module, jit._compile_objects = _cached, _compile_apart
