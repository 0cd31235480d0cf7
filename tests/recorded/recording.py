"""Cases whose histories are recorded: running one, what of its history is kept, and how far another
history is off it.

A history is kept until its third impact, as impacts multiply what two histories differ by; or until
rounding errors alone have moved it by a fifth of what later code may differ by, where that is
before. Of its rows as many are kept as make a few thousand numbers, evenly spread, the last one
among them: what goes wrong earlier is seen later as well.
"""

from __future__ import annotations

import json
import platform
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
CASES = tuple(HERE / f"{name}.toml" for name in ("bases", "columns", "structures"))
RECORD, ABOUT = HERE / "histories.npz", HERE / "about.json"
#: How far a column may be off, over its peak; and how far rounding errors may have moved it where
#: it is kept.
TOLERANCE, BY_ROUNDING = 1e-9, 2e-10
#: As TOLERANCE, where another processor or other libraries than the record's round otherwise:
#: kernels of OpenBLAS for another processor move a rigid frame that is shaken by 1.6e-8.
ELSEWHERE = 1e-6
# Impacts until which a history is kept, and what one takes at least, over the change of the
# potential of the weight
IMPACTS, LEAST_LOSS = 3, 1e-3
# Numbers that are kept of a case, about; and rows until which no rounding error may have moved it
NUMBERS, FEWEST = 2000, 10
# A column whose peak is below this share of the largest of its unit is judged by that share: it is
# a small difference of large numbers, such as the energy that the scheme takes, or what symmetry
# makes 0
SMALL = 1e-2
# By how much densities and Young's moduli are larger where rounding errors are asked for, one run
# each: the motion is the same, no number is. One run alone may happen to stay near: of a frame that
# is shaken three of them are up to nine times farther apart than one
ROUNDINGS = (1e-14, -1e-14, 3e-14)
# Columns that are kept; of bodies, links and storeys by the last word of their names; and all terms
# of the energy but the error of the balance
KEPT = ("time", "u_top", "tilt", "twist", "slide", "model/theta_x", "model/theta_y")
KEPT_OF_PARTS = {"body": ("displacement", "tilt"), "link": ("tension",), "storey": ("drift",)}
UNITS = {
    "rad": ("tilt", "twist", "theta_x", "theta_y"),
    "m": ("u_top", "slide", "displacement", "drift"),
    "N": ("tension",),
}
# Ranks give way to one another while they wait
MPIRUN = ("mpirun", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1")
ONE_RANK = """import json, sys
from recording import analyse
analyse(json.loads(sys.argv[1]), sys.argv[2])"""


@dataclass(frozen=True)
class Recorded:
    """A case of CASES: its tables, the features that it covers, ranks of MPI, and whether it is one
    of the quick ones.
    """

    name: str
    tables: dict
    covers: tuple[str, ...]
    ranks: int
    quick: bool


def cases() -> dict[str, Recorded]:
    """All cases by name."""
    from fecolumn.foundation.toml_file import merge

    text = {}
    for file in CASES:
        text = merge(text, tomllib.loads(file.read_text(encoding="utf-8")))

    def whole(table: dict) -> dict:
        """A table above those that it is of."""
        own, below = dict(table), {}
        of = own.pop("of", [])
        for name in [of] if isinstance(of, str) else of:
            below = merge(below, whole(text["of"][name]))
        return merge(below, own)

    found = {}
    for name, table in text["case"].items():
        tables = whole(table)
        covers, ranks = tuple(tables.pop("covers")), tables.pop("ranks", 1)
        quick = tables.pop("quick", False)
        found[name] = Recorded(name, tables | {"title": name}, covers, ranks, quick)
    return found


def analyse(tables: dict, folder) -> None:
    """Run a case into a folder, on all ranks of this process's MPI."""
    import warnings

    from fecolumn.case.case import case_from_tables
    from fecolumn.simulation import run

    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*cuts the motion short")
        run(case_from_tables(tables, CASES[0]), Path(folder), quiet=True)


def history(case: Recorded, rounding: float = 0.0) -> dict[str, np.ndarray]:
    """Columns of a case by name, in full length.

    Parameters
    ----------
    rounding
        share by which densities and Young's moduli are larger.
    """
    from fecolumn.engines.dynamics.history import read_history
    from fecolumn.foundation._mpi import launch_environment

    tables = _rounded(case.tables, 1.0 + rounding)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        if case.ranks == 1:
            analyse(tables, out)
        else:
            environment = launch_environment()
            paths = [str(HERE), str(HERE.parents[1]), environment.get("PYTHONPATH", "")]
            environment["PYTHONPATH"] = ":".join(paths)
            command = [sys.executable, "-c", ONE_RANK, json.dumps(tables), str(out)]
            subprocess.run([*MPIRUN, "-n", str(case.ranks), *command], env=environment, check=True)
        rows = read_history(out / "history.h5")
    return {name: np.asarray(values, float) for name, values in rows.items()}


def _rounded(tables: dict, factor: float) -> dict:
    """Tables with other densities and Young's moduli."""
    found = {}
    for key, value in tables.items():
        if isinstance(value, dict):
            value = _rounded(value, factor)
        elif key in ("density_kg_m3", "youngs_modulus_pa"):
            value = value * factor
        found[key] = value
    return found


def third_impact(rows: dict) -> int:
    """Number of rows before the step of the third impact; all where there are fewer."""
    least = LEAST_LOSS * np.ptp(rows["energy/gravity"])
    hits = np.flatnonzero(np.diff(rows["energy/impact"]) < -least)
    return int(hits[IMPACTS - 1]) + 1 if len(hits) >= IMPACTS else len(rows["time"])


def kept(rows: dict, last: int) -> dict[str, np.ndarray]:
    """What is kept of the first `last` rows of a history, all of them; no columns of zeros."""
    found = {name: values[:last] for name, values in rows.items() if _is_kept(name)}
    return {name: values for name, values in found.items() if values.any() or name == "time"}


def _is_kept(name: str) -> bool:
    first, _, last = name.partition("/")
    if first == "energy":
        return last != "closure"
    return name in KEPT or name.rpartition("/")[2] in KEPT_OF_PARTS.get(first, ())


def thinned(rows: dict) -> dict[str, np.ndarray]:
    """A history with fewer rows, evenly spread from the first to the last."""
    n, width = len(rows["time"]), sum(values[0].size for values in rows.values())
    chosen = np.unique(np.linspace(0, n - 1, min(n, max(10, NUMBERS // width))).round().astype(int))
    return {name: values[chosen] for name, values in rows.items()}


def peaks(rows: dict) -> dict[str, float]:
    """What differences of each column are divided by: its peak, of a vector's length, or SMALL of
    the largest of its unit.
    """
    own, most = {}, {}
    for name, values in rows.items():
        own[name] = float(np.linalg.norm(values.reshape(len(values), -1), axis=1).max())
    for name, value in own.items():
        most[_unit(name)] = max(most.get(_unit(name), 0.0), value)
    return {name: max(value, SMALL * most[_unit(name)]) or 1.0 for name, value in own.items()}


def _unit(name: str) -> str:
    if name.startswith("energy/"):
        return "J"
    return next((unit for unit, words in UNITS.items() if name.rpartition("/")[2] in words), name)


def differences(recorded: dict, rows: dict) -> dict[str, np.ndarray]:
    """How far each recorded column is off a history at each recorded time, over its peak; inf where
    the history has no such column, or has ended.
    """
    time, found = recorded["time"], {}
    places = np.searchsorted(rows["time"], time - 1e-9 * time[-1])
    for name, peak in peaks(recorded).items():
        values, off = rows.get(name), np.full(len(time), np.inf)
        if values is not None and values.shape[1:] == recorded[name].shape[1:]:
            there = places < len(values)
            apart = np.abs(values[places[there]] - recorded[name][there])
            off[there] = apart.reshape(there.sum(), -1).max(axis=1) / peak
        found[name] = off
    return found


def here() -> dict[str, str]:
    """Processor, Python, numpy and numba of this run."""
    import numba
    from llvmlite.binding import get_host_cpu_name

    return {
        "processor": get_host_cpu_name(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
    }


def tolerance_here(about: dict) -> float:
    """How far a history of this run may be off one of which `about` tells where it was made."""
    return TOLERANCE if here().items() <= about.items() else ELSEWHERE


def told(name: str, recorded: dict, rows: dict, tolerance: float = TOLERANCE) -> list[str]:
    """A line for each column that is off by more than tolerance: case, column, how far and when."""
    lines = []
    for column, off in differences(recorded, rows).items():
        if not off.max() <= tolerance:
            first = recorded["time"][np.flatnonzero(~(off <= tolerance))[0]]
            lines.append(
                f"{name}: {column} is off by {off.max():.1e} of its peak, "
                f"{peaks(recorded)[column]:.4g}; by more than {tolerance:.0e} of it "
                f"from {first:.4g} s on"
            )
    return lines


def write(histories: dict[str, dict], about: dict) -> None:
    """Write thinned histories by case, one array each, and what is said of them."""
    arrays, lines = {}, []
    for name, rows in histories.items():
        columns = [values.reshape(len(values), -1) for values in rows.values()]
        arrays[name] = np.concatenate(columns, axis=1)
        widths = {name: one[0].size if one.ndim > 1 else 0 for name, one in rows.items()}
        lines.append(f"{json.dumps(name)}: {json.dumps(about[name] | {'columns': widths})}")
    np.savez_compressed(RECORD, **arrays)
    ABOUT.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def read() -> tuple[dict[str, dict[str, np.ndarray]], dict]:
    """Recorded histories by case, and what is said of them."""
    about, found = json.loads(ABOUT.read_text(encoding="utf-8")), {}
    with np.load(RECORD) as file:
        for name in file.files:
            values, place, found[name] = file[name], 0, {}
            for column, width in about[name]["columns"].items():
                found[name][column] = (
                    values[:, place : place + width] if width else values[:, place]
                )
                place += width or 1
    return found, about
