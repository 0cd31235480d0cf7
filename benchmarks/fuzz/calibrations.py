"""Calibrations: a measured test, the keys to fit and the case, each damaged."""

from __future__ import annotations

import argparse
import csv
import math
import tomllib

import numpy as np

from benchmarks.fuzz.damage import BYTES, VALUES, cut, displaced, toml
from fecolumn.case.case import load_case
from fecolumn.statistics import profile
from fecolumn.study.questions import calibrate_command

_CASE = """title = "granite block"
[block]
width_m = 0.25
height_m = 1.0
[integration]
dt_s = 0.01
"""
_FIT = ["--fit", "block.restitution", "0.8:1"]
_HEADERS = (
    "time_ms,tilt_rad",
    "time_s,tilt_deg",
    "time_s,tilt_mrad",
    "time_ms,tilt_mrad",
    "time_s,tilt",
    "t,tilt_rad",
    "time_s,tilt_rad,tilt_deg",
    "time_s;tilt_rad",
    "tilt_rad,time_s",
    "time_s,time_s",
)
_KEYS = (
    "block.width_m",
    "block.height_m",
    "block.density_kg_m3",
    "block.sides",
    "block.spring_n_m",
    "block.bed_to_m",
    "block.tendon_n_m",
    "block.friction_coefficient",
    "block.restitution.x",
    "block",
    "block.",
    ".restitution",
    "",
    "restitution",
    "bodies.block.edge_radius_m",
    "contact.restitution",
    "grounds.ground.stiffness_n_m3",
    "joints.foot.friction_coefficient",
    "initial.tilt_rad",
    "initial.direction_deg",
    "initial.block.tilt_rad",
    "integration.dt_s",
    "integration.duration_s",
    "integration.engine",
    "integration.max_iterations",
    "output.history_every_s",
    "overturn.displacement_m",
    "motion.scale",
    "title",
)
_RANGES = (
    "0.5:0.9",
    "1:1e9",
    "0:1e308",
    "0:1",
    "1:0",
    "1",
    ":",
    "0:nan",
    "0:inf",
    "1_0:20",
    "0.1:0.1",
    "1e-320:1e-300",
    "0.001:1000",
    "a:b",
    "0:1:2",
    "1e3:1e4",
)


def _measured() -> tuple[np.ndarray, np.ndarray]:
    """Times (30,) [s] and a tilt (30,) [rad] that rocks as the block does, about."""
    time = np.arange(30) * 0.04
    return time, np.abs(0.12 * np.exp(-0.4 * time) * np.cos(2 * np.pi * time / 1.45)) + 1e-4


def _written(header: str, time, tilt) -> str:
    return f"{header}\n" + "".join(f"{t:.4f},{y:.6f}\n" for t, y in zip(time, tilt))


def prepare(folder) -> None:
    """A block's case and a test of it; the fit goes its whole way by a few runs."""
    profile._TRIALS, profile._DOUBLINGS, profile._STARTS = 4, 1, 1
    profile._MOST_STARTS, profile._DESCENT, profile._REACH, profile._BISECTIONS = 1, 6, 3, 1
    (folder / "block.toml").write_text(_CASE)
    (folder / "test.csv").write_text(_written("time_s,tilt_rad", *_measured()))


def sound(folder):
    """The command as it is meant."""
    return folder, _FIT


def mutate(rng, folder):
    """One of the three changed: mostly the test, by its bytes, cells, columns or units."""
    path, fit = folder / "test.csv", list(_FIT)
    kind = int(rng.integers(10))
    if kind < 2:
        path.write_bytes(
            (cut if kind else BYTES[int(rng.integers(len(BYTES)))])(rng, path.read_bytes())
        )
    elif kind == 2:
        path.write_text(_of_other_units(rng))
    elif kind < 5:
        path.write_text(_of_other_cells(rng, path.read_text()))
    elif kind == 5 and rng.random() < 0.3:
        displaced(rng, path)
    elif kind == 6:
        case = folder / "block.toml"
        case.write_bytes(toml(rng, case.read_text()))
    else:
        key, span = str(rng.choice(_KEYS)), str(rng.choice(_RANGES))
        fit = [*(fit if rng.random() < 0.3 else []), "--fit", key, span]
        if rng.random() < 0.2:
            fit = ["--fit", "block.restitution", span]
        if rng.random() < 0.1:
            fit = fit * 3
    return folder, fit


def _of_other_units(rng) -> str:
    """The test with another header, or in another unit than its header says."""
    time, tilt = _measured()
    scales = [1e-6, 1e-3, 1.0, 57.3, 1e3, 1e6]
    header = str(rng.choice(_HEADERS)) if rng.random() < 0.5 else "time_s,tilt_rad"
    return _written(header, time * rng.choice(scales), tilt * rng.choice(scales))


def _of_other_cells(rng, text: str) -> str:
    """The test with a few cells, columns or lines of another kind."""
    rows = [line.split(",") for line in text.splitlines()]
    for _ in range(int(rng.integers(1, 4))):
        place = int(rng.integers(len(rows)))
        kind = int(rng.integers(5))
        if kind == 0:
            rows[place][int(rng.integers(len(rows[place])))] = str(rng.choice(VALUES)).strip('"')
        elif kind == 1:
            rows[place].append(str(rng.choice(["", "0.1", "nan", "x"])))
        elif kind == 2:
            del rows[place][int(rng.integers(len(rows[place]))) :]
        elif kind == 3:
            rows.insert(int(rng.integers(len(rows))), rows[place])
        else:
            scale = float(rng.choice([0.0, -1.0, 10.0, 1e6]))
            try:
                rows[place] = [str(scale * float(cell)) for cell in rows[place]]
            except ValueError:
                continue
    return "\n".join(",".join(row) for row in rows) + "\n"


def use(mutant) -> None:
    """Calibrate, and look at the answer."""
    folder, fit = mutant
    parser = argparse.ArgumentParser()
    calibrate_command.add_arguments(parser)
    words = [str(folder / "block.toml"), "--test", str(folder / "test.csv"), "-o"]
    args = parser.parse_args([*words, str(folder / "fit"), *fit])
    assert calibrate_command.main(args) == 0
    with open(folder / "fit" / "calibrate.csv") as file:
        rows = list(csv.DictReader(file))
    spans = {
        key: [float(one) for one in span.split(":")] for key, span in zip(fit[1::3], fit[2::3])
    }
    assert [row["key"] for row in rows] == list(spans)
    for row in rows:
        low, high = spans[row["key"]]
        value = float(row["value"])
        inner = [float(row[name]) if row[name] else value for name in ("low", "high")]
        assert math.isfinite(value) and low <= value * (1 + 1e-5) and value <= high * (1 + 1e-5)
        assert inner[0] <= value <= inner[1]
    fitted = tomllib.loads((folder / "fit" / "fitted.toml").read_text())
    assert fitted["extends"] and load_case(folder / "fit" / "fitted.toml").own
