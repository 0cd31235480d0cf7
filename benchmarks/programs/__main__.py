"""One ensemble, several programs: how often each of four structures overturns under the 115 motions
of the Lick ensemble, and how far the programs' distributions are apart.

    ./containers/run python -m benchmarks.programs [--structure NAME ...] [--program NAME ...]
        [--motions N] [--reference NAME] [-j JOBS] [-o DIR] [--trial]
        [--report] [--keep]

Structures: tube (three dimensions), block, drums and trilith (in their plane). Programs: housner
(closed form of the block), judge (the planar program of this repository, not of the tube), mujoco,
siconos and, of the tube, siconos-tube at their best settings, mujoco-defaults, siconos-defaults,
and fecolumn's engines rigid, rigid-fine (shorter steps, not of the block), reduced and full; full
takes hours, runs only where it is named, and is reported as far as it is done. A program that is
not installed is said and left out: `python -m benchmarks.peers --install` installs them.

All have the same bodies, friction, motions (straight lines between their samples) and rest after
these; no restitution. Bodies that do not deform touch at their corners or on their rim; elastic
ones have meshes of their own. A structure has overturned once a body tilts by more than 45 degrees,
or at the end by more than its critical tilt; fecolumn stops a single body at the point of no
return. u_max is that of the top's middle. Energy fed in: largest rise of the kinetic energy and
that of gravity (and strain) less the work of the ground, which friction and impacts can only take
from, at rows of 5 ms, over the energy that overturns; its error: of our sum of that work, of
fecolumn that of its balance.

Prints three tables: results, settings, and each two programs beside each other. Each analysis is a
file of its own below DIR: what was stopped goes on with the same command. What
benchmarks/tables/programs holds is not computed again (of a peer while its scripts and settings are
the same); --keep writes what is done there, --report computes nothing. --trial prints what the
peers' settings err by, by which the best were chosen (`benchmarks.programs.trial`).
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import re
import sys
from pathlib import Path

from benchmarks.peers import peer as peers
from benchmarks.planar import peer as planar_peer
from benchmarks.programs import analysis, course, structures, table, trial
from benchmarks.programs.programs import BY_NAME, PROGRAMS, Program
from benchmarks.tables import read
from benchmarks.tables.runs import read_runs, write_runs
from fecolumn import __version__
from fecolumn.foundation.sources import PHYSICS, digest_of
from fecolumn.study.plan import Plan, plan_of
from fecolumn.study.run import StudyError, complete_study, stop_code
from fecolumn.study.store import DONE

_HERE = Path(__file__).parent
#: Scripts that decide a peer's results, beside its settings
_SCRIPTS = {
    "mujoco": [_HERE / "mujoco.py"],
    "siconos": [_HERE / "siconos.py", *planar_peer.SOURCES],
    "judge": [
        Path(planar_peer.__file__).with_name(f"{name}.py")
        for name in ("bodies", "contact", "nsgs", "advance")
    ],
    "housner": [Path(planar_peer.__file__).with_name("theory.py")],
}


def folder_of(program: Program, folder: Path) -> Path:
    """Of the program's results: another one for another step, of a peer for other sources or
    settings.
    """
    if program.ours:
        return folder / f"{program.name}-{program.dt:g}"
    own = [Path(module.__file__) for module in (analysis, course, structures)]
    made_by = digest_of([*own, *_SCRIPTS[program.name.partition("-")[0]]])
    said = f"{made_by} {program.dt} {sorted(program.settings.items())}"
    return folder / f"{program.name}-{hashlib.sha256(said.encode()).hexdigest()[:8]}"


def plan(structure: str, program: Program, folder: Path) -> Plan:
    """All motions of a structure in a program."""
    rest, source = structures.motion_table(structure, folder)
    tables = structures.case_tables(structure, program.engine, program.dt)
    if structure == "drums" and program.engine != "rigid":
        # elastic drums slide farther than the quarter of a face that is prepared without being told
        for joint in tables["joints"].values():
            joint["allowance_m"] = tables["bodies"][joint["between"][0]]["length_m"]
    tables["motion"] = rest | dict(source=f"{source}1")
    axes = {"motion.source": [f"{source}{number}" for number in range(1, structures.MOTIONS + 1)]}
    title = f"{structure}, {program.label}"
    return plan_of(dict(title=title, case=tables, axes=axes), Path("benchmarks.programs"))


def kept_name(structure: str, program: Program) -> str:
    """Of a program's runs in benchmarks/tables."""
    return f"programs/{structure}-{folder_of(program, Path()).name}"


def runs_of(structure: str, program: Program, args) -> dict[int, dict]:
    """What is measured of each of the first motions, by motion: that which comes with the
    repository, and what is done below `args.output`; makes what is missing unless `args.report`.
    """
    kept = read_runs(kept_name(structure, program))
    found = {number: run for number, run in kept.items() if number <= args.motions}
    if len(found) == args.motions:
        return found
    folder = Path(args.output) / structure
    whole, into = plan(structure, program, folder), folder_of(program, folder)
    todo = dict(enumerate(whole.analyses[: args.motions], 1))
    only = {one.id for number, one in todo.items() if number not in kept}
    rows = complete_study(
        whole,
        into,
        workers=args.jobs,
        entry=program.entry,
        retry_failed=not args.report,
        only=set() if args.report else only,
    )
    for number, row in enumerate(rows, 1):
        if row["id"] in only and row["state"] == DONE:
            place = into / "analyses" / row["id"]
            found[number] = table.measured(structure, row["summary"], place)
        elif row["id"] in only and not args.report:
            print(f"motion {number}: {row['state']}: {row['reason']}", file=sys.stderr)
    return dict(sorted(found.items()))


def keep(structure: str, program: Program, runs: dict[int, dict], version: str) -> None:
    """Have the runs of a program come with the repository."""
    said = program.label if program.ours else f"{program.label}, version {version}"
    title = f"{structure} in {said}, steps of {program.dt:g} s: what became of it in each motion"
    command = f"python -m benchmarks.programs --structure {structure} --program {program.name}"
    physics = PHYSICS if program.ours else "none"
    write_runs(kept_name(structure, program), runs, title, f"{command} --keep", physics=physics)


def kept_version(program: Program) -> str:
    """Version that made the kept runs of a program, "" where there are none."""
    for structure in program.structures:
        with contextlib.suppress(FileNotFoundError):
            title = read(kept_name(structure, program)).about["title"]
            if told := re.search(r", version ([\w.]+),", title):
                return told[1]
    return ""


def versions(names, report: bool = False) -> dict[str, str]:
    """Version of each of the programs that can be run, or whose kept runs are to be reported; the
    others are said.
    """
    found = {}
    for name in names:
        if report and (version := kept_version(BY_NAME[name])):
            found[name] = version
            continue
        peer = name.partition("-")[0]
        try:
            known = peer in ("mujoco", "siconos")
            there = next(one for one in peers.PEERS if one.name == peer) if known else None
            found[name] = peers.version(there) if there else __version__
        except peers.Missing as error:
            print(f"{BY_NAME[name].label} is left out: {error}", file=sys.stderr)
    return found


def arguments(given=None):
    names = [program.name for program in PROGRAMS]
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.programs",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--structure", nargs="+", choices=structures.NAMES, metavar="NAME")
    parser.add_argument("--program", nargs="+", choices=names, metavar="NAME")
    parser.add_argument("--motions", type=int, default=structures.MOTIONS, metavar="N")
    parser.add_argument("--reference", choices=names, metavar="NAME")
    parser.add_argument("-j", "--jobs", type=int, default=1, metavar="N")
    parser.add_argument("-o", "--output", default="results/programs", metavar="DIR")
    parser.add_argument("--trial", action="store_true")
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--keep", action="store_true")
    args = parser.parse_args(given)
    if not 1 <= args.motions <= structures.MOTIONS:
        parser.error(f"--motions {args.motions}: must be in [1, {structures.MOTIONS}]")
    args.program = args.program or [one.name for one in PROGRAMS if args.report or not one.asked]
    args.structure = args.structure or list(structures.NAMES)
    return args


def main(given=None) -> int:
    """Run what is asked for, and print the tables."""
    args = arguments(given)
    there = versions(args.program, args.report)
    if args.trial:
        print(trial.table(there), flush=True)
        return 0
    found: dict[str, dict] = {structure: {} for structure in args.structure}
    todo = [
        (structure, BY_NAME[name])
        for structure in args.structure
        for name in there
        if structure in BY_NAME[name].structures
    ]
    for place, (structure, program) in enumerate(todo, 1):
        print(f"{place} of {len(todo)}: {structure}, {program.label}", file=sys.stderr, flush=True)
        try:
            runs = found[structure][program.name] = runs_of(structure, program, args)
            if args.keep and runs:
                keep(structure, program, runs, there[program.name])
        except (KeyboardInterrupt, StudyError) as error:
            return stop_code(error)
    chosen = {one: args.reference or name for one, name in table.REFERENCES.items()}
    print(table.tables(found, chosen, there))
    return 0


if __name__ == "__main__":
    sys.exit(main())
