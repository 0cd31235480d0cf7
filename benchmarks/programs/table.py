"""What the programs say of a structure, as rows of one table."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.beside import SHARE_HEAD, cost, markdown, pair_cells, share_cells
from benchmarks.programs.programs import BY_NAME, PROGRAMS, Program
from benchmarks.programs.structures import rigid_bodies
from fecolumn.engines.ending import lost

#: Against what a structure's programs are measured unless told otherwise
REFERENCES = dict(tube="rigid-fine", block="judge", drums="judge", trilith="judge")
HEAD = (
    "structure and program",
    "step [s]",
    *SHARE_HEAD,
    "D",
    "p",
    "overturn here alone",
    "in the reference alone",
    "McNemar p",
    "peaks off, median",
    "energy fed in, median [%]",
    "most [%]",
    "energy balance, error [%]",
    "steps unsolved",
    "CPU of a motion [s]",
)
#: Heads of `pairs`
PAIRS_HEAD = (
    "structure and programs",
    "motions",
    "overturned in the first",
    "in the second",
    "D",
    "p",
    "in the first alone",
    "in the second alone",
    "McNemar p",
)


def fed_in_of_history(file: Path, barrier: float) -> float:
    """Largest rise of the mechanical energy less the work of the ground, over the energy that
    overturns [J], of an analysis of the package; nan where it left no history.
    """
    import h5py

    if not file.exists():
        return np.nan
    with h5py.File(file) as history:
        energy = history["energy"]
        balance = sum(energy[term][:] for term in ("kinetic", "strain", "gravity"))
        balance = balance - energy["base_work"][:]
    return float((balance - np.minimum.accumulate(balance)).max() / barrier)


def cells(
    structure: str,
    program: Program,
    runs: dict[int, dict[str, Any]],
    reference: dict[int, dict[str, Any]],
) -> tuple[str, ...]:
    """A row: runs by motion; against the reference where it is another one."""
    each = list(runs.values())
    beside = ("-",) * 6 if runs is reference else against(runs, reference)
    risen = np.array([run["fed_in"] for run in each])
    closure = np.median([run["energy_closure_rel"] for run in each])
    return (
        f"{structure}: {program.label}",
        f"{program.dt:g}",
        *share_cells(runs),
        *beside,
        *(
            ("-", "-", "-")
            if program.name == "housner"
            else (
                f"{100 * np.median(risen):.2g}",
                f"{100 * risen.max():.2g}",
                f"{100 * closure:.1g}",
            )
        ),
        str(sum(run["unsolved"] for run in each)),
        cost(each),
    )


def pairs(found: dict[str, dict[str, dict]]) -> list[tuple[str, ...]]:
    """Each two programs on the same structure, as `pair_cells`, with how many overturn of the
    motions that both have.
    """
    rows = []
    for structure, programs in found.items():
        for (one, first), (other, second) in combinations(programs.items(), 2):
            common = first.keys() & second.keys()
            if not common:
                continue
            rows.append(
                (
                    f"{structure}: {BY_NAME[one].label} and {BY_NAME[other].label}",
                    str(len(common)),
                    *(str(sum(runs[n]["overturned"] for n in common)) for runs in (first, second)),
                    *pair_cells(first, second),
                )
            )
    return rows


def against(runs: dict, reference: dict) -> tuple[str, ...]:
    """D, p, motions that overturn in one alone, McNemar's p, and by how much the peaks of what
    stands in both are off, of the motions in both.
    """
    common = [one for one in runs if one in reference]
    stood = [one for one in common if not (lost(runs[one]) or lost(reference[one]))]
    off = [abs(_peak(runs[one]) / _peak(reference[one]) - 1) for one in stood]
    return *pair_cells(runs, reference), f"{np.median(off):.2g}" if off else "-"


def _peak(run: dict) -> float:
    return float(run["u_max_m"])


def tables(
    found: dict[str, dict[str, dict]], references: dict[str, str], versions: dict[str, str]
) -> str:
    """All tables: of results by structure and program, of the programs' settings, and of the
    programs beside each other.

    found: runs by motion by program's name by structure.
    """
    rows = []
    for structure, programs in found.items():
        reference = programs.get(references[structure], {})
        rows += [
            cells(structure, BY_NAME[name], runs, reference)
            for name, runs in programs.items()
            if runs
        ]
    there = {name for programs in found.values() for name in programs}
    settings = [
        (one.label, versions.get(one.name, ""), f"{one.dt:g}", one.said, one.reason)
        for one in PROGRAMS
        if one.name in there
    ]
    named = "; ".join(f"{structure}: {BY_NAME[references[structure]].label}" for structure in found)
    return "\n\n".join(
        [
            markdown(HEAD, rows),
            f"Reference of D, p and McNemar's p: {named}.",
            markdown(("program", "version", "step [s]", "settings", "because"), settings),
            markdown(PAIRS_HEAD, pairs(found)),
        ]
    )


#: What is told of a run
_MEASURED = "overturned", "slid_off", "u_max_m", "fed_in", "energy_closure_rel", "unsolved", "cpu_s"


def measured(structure: str, summary: dict, folder: Path) -> dict[str, Any]:
    """What is told of an analysis, of the package's with what contact has fed in."""
    said = dict(slid_off=False, unsolved=0) | summary
    if "fed_in" not in summary:
        barrier = rigid_bodies(structure).barrier
        said["fed_in"] = fed_in_of_history(folder / "history.h5", barrier)
    return {key: said[key] for key in _MEASURED}
