"""The reduced engine against the full-order one, as one table.

    ./containers/run python -m benchmarks.engines [NAME ...]

physics      specimen: thresholds, quarter period, restitution; ten seeded motions to the third main impact (about ten minutes)
convergence  n_modes 0 to 200 (three minutes)
ensemble     24 seeded motions on the coarse mesh in both engines (half an hour; goes on where it stopped; ENGINES_JOBS=2 for two processes)
standing     a minute at every (dt, alpha) (five minutes)
speed        a step, a motion, memory: on a machine that does nothing else
motions115   115 motions on two cores
paper        1,725 analyses on two cores; only when named
"""

from __future__ import annotations

import sys
import time

from benchmarks.engines.convergence import convergence
from benchmarks.engines.ensemble import ensemble
from benchmarks.engines.physics import physics
from benchmarks.engines.speed import motions115, paper, speed
from benchmarks.engines.standing import standing

GROUPS = {group.__name__: group for group in (physics, convergence, ensemble, standing, speed, motions115, paper)}
# rows without a limit say how it is
_WORDS = {True: "yes", False: "NO", None: ""}


def main(names) -> int:
    """Print the table of the named groups, of all but `paper` without names; 1 where a row fails, 2 for an unknown name."""
    unknown, failed = set(names) - set(GROUPS), 0
    if unknown:
        print(f"engines: {', '.join(sorted(unknown))}: must be of {', '.join(GROUPS)}", file=sys.stderr)
        return 2
    print(f"| {'check':<78} | {'reference':>10} | {'reduced':>10} | ok  |\n|{'-' * 80}|{'-' * 11}:|{'-' * 11}:|-----|")
    for name in names or [name for name in GROUPS if name != "paper"]:
        began = time.perf_counter()
        for label, reference, computed, ok in GROUPS[name]():
            ok = None if ok is None else bool(ok)
            failed += ok is False
            print(f"| {label:<78} | {reference:>10.4g} | {computed:>10.4g} | {_WORDS[ok]:<3} |", flush=True)
        print(f"{name}: {time.perf_counter() - began:.0f} s", file=sys.stderr)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
