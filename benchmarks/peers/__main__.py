"""Free rocking in this project's engines and in its peers: one Markdown table a case, and the
figures as JSON.

    ./containers/run python -m benchmarks.peers [--install] [--long] [--limit S] [-o DIR] [NAME ...]

Names are of peers and of cases; none means all. Finite-element peers end at the limit of CPU time,
300 s a case.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from benchmarks.peers.case import CASES, release
from benchmarks.peers.install import install
from benchmarks.peers.peer import CPU_LIMIT_S, PEERS, record, run_peer
from benchmarks.peers.table import ratios, table
from fecolumn.foundation.atomic import write_json


def main(arguments=None) -> int:
    names = [peer.name for peer in PEERS]
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.peers", description=__doc__.split("\n\n")[0]
    )
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"of {', '.join(names)}; of {', '.join(CASES)}"
    )
    parser.add_argument(
        "--install",
        action="store_true",
        help="install the peers (Debian packages, and MuJoCo apart) and end",
    )
    parser.add_argument(
        "--long",
        action="store_true",
        help="finite-element peers go on towards ten impacts, an hour each",
    )
    parser.add_argument(
        "--limit",
        type=float,
        default=CPU_LIMIT_S,
        help="CPU seconds of a peer on a case (%(default)g)",
    )
    parser.add_argument(
        "-o", "--output", type=Path, default=Path("results/peers"), help="folder (%(default)s)"
    )
    given = parser.parse_args(arguments)
    unknown = [name for name in given.names if name not in (*names, *CASES)]
    if unknown:
        parser.error(f"{', '.join(unknown)}: must be of {', '.join((*names, *CASES))}")
    if given.install:
        install()
        return 0
    chosen = [peer for peer in PEERS if peer.name in given.names] or list(PEERS)
    folder, records = given.output.resolve(), []
    for name in [case for case in CASES if case in given.names] or CASES:
        case, found = release(name), []
        for peer in chosen:
            began = time.perf_counter()
            found.append(record(run_peer(peer, case, folder, given.long, given.limit)))
            print(
                f"{name}, {peer.label}: {time.perf_counter() - began:.0f} s",
                file=sys.stderr,
                flush=True,
            )
        times = ", ".join(f"{time:.4f}" for time in case.impacts[:4])
        print(
            f"\n{case.case.title}: released at {case.tilt:.4g} rad; impacts by theory "
            f"(Housner 1963) at {times} s ...\n"
        )
        print("\n".join([table(found), "", *ratios(found)]), flush=True)
        records += found
        write_json(folder / "peers.json", records)
    return 0


if __name__ == "__main__":
    sys.exit(main())
