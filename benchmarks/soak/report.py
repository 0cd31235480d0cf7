"""What has come of a soak: nothing lost, why what failed has failed, what grew, how far the energy
closes, and the worst cases.
"""

from __future__ import annotations

import collections
import csv
import json
import re
from pathlib import Path

import numpy as np

from benchmarks.soak.cases import case_of, is_hard
from benchmarks.soak.drive import block_folder
from benchmarks.soak.specimens import specimens as all_specimens
from benchmarks.soak.watch import NAME
from fecolumn.study.store import DONE, FAILED, read_study

_WORST = 10
_MEASURES = {
    "energy closure [-]": "energy_closure_rel",
    "share of cut steps [-]": "cut_share",
    "wall time [s]": "wall_s",
}
_EDGES = {
    "penetration_max_m": (0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, np.inf),
    "energy_closure_rel": (0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, np.inf),
    "cut_share": (0, 1e-12, 1e-4, 1e-3, 1e-2, 1e-1, np.inf),
}
# Analyses of a process before which its memory still takes up models and compiled code
_WARM = 50


def report(folder: Path, seed: int, specimens: int) -> int:
    """Print it, and write the cases of the worst and of the failed into `worst` and `failed`; 0
    where none failed or was lost.
    """
    (rows, planned), columns = rows_of(folder), all_specimens(specimens)
    states = collections.Counter(row["state"] for row in rows)
    done, failed = ([row for row in rows if row["state"] == state] for state in (DONE, FAILED))
    print(
        f"{planned} planned, {len(rows)} in ledgers: "
        f"{', '.join(f'{count} {state}' for state, count in states.items())}; "
        f"{planned - len(rows)} lost"
    )
    for row in done:
        row["summary"]["cut_share"] = row["summary"]["cuts"] / max(row["summary"]["steps"], 1)
    outcomes = collections.Counter(row["summary"]["outcome"] for row in done)
    print("outcomes: " + ", ".join(f"{count} {name}" for name, count in outcomes.most_common()))
    steps = sum(row["summary"]["steps"] for row in done)
    cut = sum(row["summary"]["cuts"] for row in done)
    print(
        f"{steps} steps, {cut} cuts ({cut / max(steps, 1):.2e}) in "
        f"{sum(row['summary']['cuts'] > 0 for row in done)} analyses"
    )
    for key, edges in _EDGES.items():
        counted = (
            done
            if key != "penetration_max_m"
            else [row for row in done if is_hard(row["axes"]["number"], seed, columns)]
        )
        print(f"\n{key}\n" + histogram([row["summary"][key] for row in counted], edges))
    _print_growth(folder, done)
    reasons = collections.defaultdict(list)
    for row in failed:
        reasons[re.sub(r"-?\d[\d.]*(e[-+]?\d+)?", "#", row["reason"])].append(row)
    for of_it in sorted(reasons.values(), key=len, reverse=True):
        numbers = [row["axes"]["number"] for row in of_it]
        print(
            f"\n{len(of_it)} failed: {of_it[0]['reason']}\n    numbers "
            f"{', '.join(map(str, numbers[:12]))}{' ...' if len(numbers) > 12 else ''}"
        )
        _write(folder / "failed", numbers[:3], folder, seed, specimens)
    for name, key in _MEASURES.items():
        print(f"\nworst by {name}")
        worst = sorted(done, key=lambda row: -row["summary"][key])[:_WORST]
        for row in worst:
            one = row["summary"]
            motion = row["axes"]["motion.source"].rpartition("/")[2] or "no motion"
            print(
                f"    {row['axes']['number']:>7} {one[key]:9.2e}  specimen "
                f"{row['axes']['specimen']}, {one['engine']}, dt {one['dt_s']:.2e} s, "
                f"{one['steps']} steps, {one['cuts']} cuts, "
                f"{1e3 * one['s_per_step']:.2f} ms/step, {one['outcome']}; {motion}"
            )
        _write(folder / "worst", [row["axes"]["number"] for row in worst], folder, seed, specimens)
    print(
        f"\ntheir cases: {folder / 'worst'}, {folder / 'failed'}; python -m "
        f"benchmarks.soak -o {folder} --only NUMBER runs one again"
    )
    return 1 if failed or planned > len(rows) else 0


def rows_of(folder: Path) -> tuple[list[dict], int]:
    """Rows of all blocks, and how many analyses they were begun with."""
    rows, planned, number = [], 0, 0
    while (block_folder(folder, number) / "study.json").exists():
        study = read_study(block_folder(folder, number))
        rows += study.rows
        planned += study.analyses
        number += 1
    return rows, planned


def histogram(values, edges) -> str:
    """Counts between edges, a line each, zeros apart."""
    values, lines = np.asarray(values, float), []
    for low, high in zip(edges, edges[1:]):
        count = int(((values >= low) & (values < high)).sum())
        lines.append(
            f"    {low:7.0e} to {high:7.0e} {count:>8}  "
            f"{'#' * round(60 * count / max(len(values), 1))}"
        )
    return "\n".join(lines)


def growth(counts, values) -> float:
    """Rise per count of the lower envelope of values: the smallest of each tenth, fitted by a
    line.
    """
    parts = [part for part in np.array_split(np.argsort(counts), 10) if len(part)]
    counts, values = np.asarray(counts, float), np.asarray(values, float)
    places = [counts[part].mean() for part in parts]
    return (
        float(np.polyfit(places, [values[part].min() for part in parts], 1)[0])
        if len(parts) > 1
        else 0.0
    )


def _print_growth(folder: Path, done) -> None:
    of_process = collections.defaultdict(list)
    for row in done:
        of_process[row["summary"]["process"]["pid"]].append(row["summary"]["process"])
    print(
        "\nprocess     analyses   memory [MB] first, last, most   growth [kB an "
        "analysis]   open files first, last, most"
    )
    for pid, notes in of_process.items():
        notes = sorted(notes, key=lambda note: note["done"])
        warm = [note for note in notes if note["done"] > _WARM]
        memory, files = ([note[key] for note in notes] for key in ("memory_mb", "open_files"))
        slope = "-"
        if len(warm) > _WARM:
            done, used = ([note[key] for note in warm] for key in ("done", "memory_mb"))
            slope = f"{1e3 * growth(done, used):.2f}"
        print(
            f"worker {pid:<8}{len(notes):>5} {memory[0]:>10.0f} {memory[-1]:.0f} "
            f"{max(memory):.0f} {slope:>26} {files[0]:>18} {files[-1]} {max(files)}"
        )
    looks, killed = collections.defaultdict(list), collections.Counter()
    if (folder / NAME).exists():
        with open(folder / NAME, newline="") as table:
            for _, pid, what, memory, files in csv.reader(table):
                if what == "driver":
                    looks[pid].append((float(memory), int(files)))
                else:
                    killed[what] += 1
    for pid, seen in looks.items():
        memory, files = zip(*seen)
        print(
            f"driver {pid:<8}{'':>5} {memory[0]:>10.0f} {memory[-1]:.0f} "
            f"{max(memory):.0f} {'':>26} {files[0]:>18} {files[-1]} {max(files)}"
        )
    print(
        "killed: "
        + (
            ", ".join(f"{count} {what.removesuffix(' killed')}s" for what, count in killed.items())
            or "none"
        )
    )


def _write(place: Path, numbers, folder: Path, seed: int, specimens: int) -> None:
    """Case files of analyses."""
    place.mkdir(exist_ok=True)
    for number in numbers:
        file = place / f"{number}.toml"
        if not file.exists():
            file.write_text(toml(case_of(number, folder, seed, specimens).as_stated()))


def toml(tables: dict) -> str:
    """A case's tables as a file; what is None is left out."""

    def text(value) -> str:
        return json.dumps(list(value) if isinstance(value, tuple) else value)

    plain = [
        f"{key} = {text(value)}"
        for key, value in tables.items()
        if value is not None and not isinstance(value, dict)
    ]
    for name, table in tables.items():
        if isinstance(table, dict):
            plain += [
                f"\n[{name}]",
                *(f"{key} = {text(value)}" for key, value in table.items() if value is not None),
            ]
    return "\n".join(plain) + "\n"
