"""The process that uses mutants: python -m benchmarks.fuzz.worker SUBJECT SEED HANDLE NUMBER...

Writes a line of JSON an end to the open file HANDLE.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import shutil
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path

import numpy as np

from benchmarks.fuzz.damage import hostile_names
from fecolumn.foundation.schema import InputError
from fecolumn.motions.record import UnusableRecord
from fecolumn.study.team import StudyError

_MEMORY = 6_000_000_000  # [bytes]: whoever asks for more fails
_LONGEST_LINE = 3000


def main() -> None:
    """Use the mutants that the command line names."""
    subject, seed, handle, *numbers = sys.argv[1:]
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    warnings.simplefilter("ignore")
    module = importlib.import_module(f"benchmarks.fuzz.{subject}")
    with tempfile.TemporaryDirectory() as home, open(int(handle), "w", buffering=1) as out:
        os.environ["FECOLUMN_CACHE"] = f"{home}/cache"
        sound = Path(home) / "sound"
        sound.mkdir()
        module.prepare(sound)
        module.use(module.sound(sound))  # what is refused undamaged tells nothing
        for number in map(int, numbers):
            folder = Path(home) / "mutant"
            shutil.copytree(sound, folder, symlinks=True)
            hostile_names(folder)
            began = time.perf_counter()
            verdict, told = _use(module, np.random.default_rng([int(seed), number]), folder)
            out.write(
                json.dumps(
                    dict(
                        number=number,
                        verdict=verdict,
                        told=told,
                        wall_s=time.perf_counter() - began,
                    )
                )
                + "\n"
            )
            shutil.rmtree(folder)


def _use(module, rng, folder: Path) -> tuple[str, str]:
    """Verdict, and what was said."""
    mutant = module.mutate(rng, folder)
    try:
        module.use(mutant)
    except (InputError, UnusableRecord, StudyError) as error:
        lines = str(error).split("\n")
        problems = len(getattr(error, "all", (error,)))
        if len(lines) != problems or not all(
            line.isprintable() and 0 < len(line) < _LONGEST_LINE for line in lines
        ):
            return "traceback", f"not one line a problem: {str(error)[:_LONGEST_LINE]!r}"
        return "refused", str(error)
    except OSError as error:
        if error.filename is None or not error.strerror:
            return "traceback", traceback.format_exc()
        return "refused", f"{error.filename}: {error.strerror}"
    except BaseException:
        return "traceback", traceback.format_exc()
    return "used", ""


if __name__ == "__main__":
    main()
