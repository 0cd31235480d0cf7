"""The podium study: nine buildings on a rocking storey, laws CRV and CAV, near-fault motions of 5
magnitudes x 7 distances.

    ./containers/run python -m benchmarks.podium [-n 100] [-j N] [--study] [-o DIR]

Source: Bantilas, Kavvadias and Vasiliadis, "The effect of impact modeling on the seismic response
of multi-storey podium structures" (COMPDYN). -n 100 motions a scenario are the paper's 3500; a
quarter of an hour of processor time. What is done is kept: the same command goes on, and one with a
larger n makes only what is missing. Writes tilt.png, shear.png (and .pdf) and buildings.csv into
DIR, and prints each claim with what it is here. --study writes, instead, files for fecolumn study,
whose report has the same; of some motions a scenario, for each analysis has a folder.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

from benchmarks.beside import markdown
from benchmarks.kept import complete, found
from benchmarks.podium.ensemble import (
    SCENARIOS,
    batches,
    file_of,
    gathered,
    responses,
    write_study,
)
from fecolumn.foundation.atomic import write_csv
from fecolumn.foundation.cores import usable_cores
from fecolumn.pictures.figures.podium_figure import podium_figure
from fecolumn.study.report.podium_claims import compared, podium_claims


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "-n", type=int, default=100, help="motions of each scenario (default: %(default)s)"
    )
    parser.add_argument(
        "-j",
        "--jobs",
        type=int,
        default=usable_cores(),
        help="scenarios at a time (default: %(default)s)",
    )
    parser.add_argument("--seed", type=int, default=1, help="of the motions (default: %(default)s)")
    parser.add_argument("-o", "--output", metavar="DIR", default="results/podium")
    parser.add_argument(
        "--study",
        action="store_true",
        help="write the same study for fecolumn study and fecolumn report, and stop",
    )
    args = parser.parse_args()
    if args.study:
        file = write_study(args.n, args.seed, Path(args.output))
        print(
            f"fecolumn study {file} -o {file.parent / 'results'} && fecolumn report "
            f"{file.parent / 'results'}"
        )
        return
    folder = Path(args.output)
    jobs = {
        file_of(scenario, batch, args.seed, folder / "scenarios"): (scenario, batch, args.seed)
        for batch in batches(args.n)
        for scenario in SCENARIOS
    }
    complete(responses, jobs, args.jobs, "parts")
    responses_found = gathered(found(jobs))
    buildings = compared(responses_found)
    names = [field.name for field in dataclasses.fields(buildings[0]) if field.name != "drawn"]
    write_csv(
        folder / "buildings.csv",
        [names, *([getattr(one, name) for name in names] for one in buildings)],
    )
    podium_figure(responses_found, "tilt", r"$\theta_{\max}/\alpha$", (0.0, 1.05), folder / "tilt")
    podium_figure(responses_found, "shear", r"$V_{\max}/V_{st}$", (1.0, 4.0), folder / "shear")
    print(f"{args.n * len(SCENARIOS)} motions, {len(buildings)} buildings\n")
    head = "claim", "in the paper", "here", "verdict", "rule"
    claims = podium_claims(buildings)
    print(markdown(head, [(one.key, one.paper, one.ours, one.verdict, one.rule) for one in claims]))
    print(f"\nwrote {folder}")


if __name__ == "__main__":
    main()
