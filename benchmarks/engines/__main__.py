"""The reduced engine against the full-order one, as one table.

    ./containers/run python -m benchmarks.engines [NAME ...]

physics      specimen: thresholds, quarter period, restitution; ten motions to the
    third main impact, 30 and 100 modes (five minutes)
convergence  n_modes 0 to 200 (three minutes)
impact       loss of the first impact over a rigid block's, and rebound of a flat landing, by
    time step, reduced engine (a minute)
literal      the same of the literal scheme, by alpha_HHT (five minutes)
ensemble     24 motions on a coarse mesh in both engines (an hour; goes on where it stopped;
    ENGINES_JOBS=2 for two processes)
standing     a minute at every (dt, alpha) (five minutes)
speed        a step, a motion, memory: on a machine that does nothing else
motions115   115 motions on two cores
paper        1,725 analyses on two cores; only when named
"""

from __future__ import annotations

import sys

from benchmarks.checks import print_checks
from benchmarks.engines.convergence import convergence
from benchmarks.engines.ensemble import ensemble
from benchmarks.engines.impact import impact
from benchmarks.engines.literal import literal
from benchmarks.engines.physics import physics
from benchmarks.engines.speed import motions115, paper, speed
from benchmarks.engines.standing import standing

GROUPS = {
    group.__name__: group
    for group in (
        physics,
        convergence,
        impact,
        literal,
        ensemble,
        standing,
        speed,
        motions115,
        paper,
    )
}


def main(names) -> int:
    """Print the table of the named groups, of all but `paper` without names; 1 where a row fails, 2
    for an unknown name.
    """
    return print_checks(
        "engines",
        GROUPS,
        names or [name for name in GROUPS if name != "paper"],
        computed="reduced",
        width=78,
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
