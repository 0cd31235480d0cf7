"""Structures in full order beside the reduced engine, until the third impact: the same finite
elements, contact points and driver, another set of unknowns.

The structures are those of the examples, with elements so large that a row takes seconds. Two
marble blocks, a trilith, a bridge frame on two piers, a slab on four round columns with tendons, a
column of drums. Tolerances: what the modes leave out that the reduced engine has no inertia of.
Where it has all of them the engines differ by the steps' unbalanced forces.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import run as analyse
from fecolumn.verification.result import CaseRows, Row

_STONE = dict(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
_ON = dict(between=["column", "ground"])
# Impacts until which motions are compared: later ones multiply what they differ by
_IMPACTS = 3


def _block(length: float, width: float, height: float, size: float, **keys: Any) -> dict:
    return (
        dict(
            kind="block",
            length_m=length,
            width_m=width,
            height_m=height,
            element_size_m=size,
            coarse_size_m=height / 2,
        )
        | _STONE
        | keys
    )


def _slab(length: float, width: float, thickness: float, size: float, **keys: Any) -> dict:
    return (
        dict(
            kind="slab",
            length_m=length,
            width_m=width,
            thickness_m=thickness,
            element_size_m=size,
            element_order=1,
        )
        | _STONE
        | keys
    )


def _structure(bodies: dict, joints: dict, initial: dict, seconds: float, **tables: Any) -> dict:
    return merge(
        dict(
            bodies=bodies,
            joints=joints,
            initial=initial,
            contact=dict(friction_coefficient=0.7, interior_points=0),
            integration=dict(dt_s=1e-3, duration_s=seconds),
        ),
        tables,
    )


def structures() -> dict[str, tuple[dict, int]]:
    """Tables of a case and modes of a body in the reduced engine, by name."""
    frame = dict(feet=_ON, heads=dict(between=["column", "slab"]))
    return {
        "stack of two blocks": (
            _structure(
                dict(
                    lower=_block(0.6, 0.6, 0.6, 0.3),
                    upper=_block(0.3, 0.3, 0.9, 0.15, at_m=[0, 0, 0.6]),
                ),
                dict(
                    foot=dict(between=["lower", "ground"]), joint=dict(between=["upper", "lower"])
                ),
                dict(upper=dict(tilt_rad=0.05)),
                0.5,
            ),
            1000,
        ),
        "trilith": (
            _structure(
                dict(
                    column=_block(
                        0.22,
                        0.65,
                        0.8,
                        0.11,
                        coarse_size_m=0.4,
                        copies_m=[[-0.4, 0, 0], [0.4, 0, 0]],
                    ),
                    slab=_slab(1.1, 0.65, 0.14, 0.11, at_m=[0, 0, 0.8]),
                ),
                frame,
                dict(column=dict(tilt_rad=0.02)),
                0.25,
            ),
            1000,
        ),
        "frame on two piers": (
            _structure(
                dict(
                    column=_block(1.6, 1.6, 9.6, 0.8, copies_m=[[-8.0, 0, 0], [8.0, 0, 0]]),
                    slab=_slab(20.0, 4.0, 2.5, 0.8, at_m=[0, 0, 9.6]),
                ),
                frame,
                dict(column=dict(tilt_rad=0.005)),
                1.5,
            ),
            1000,
        ),
        "slab on four round columns with tendons": (
            _structure(
                dict(
                    column=dict(
                        kind="cylinder",
                        outer_diameter_m=0.2,
                        height_m=1.45,
                        mass_kg=124.4,
                        element_size_m=0.05,
                        coarse_size_m=0.5,
                        copies_m=[[1.0, 1.0, 0], [-1.0, 1.0, 0], [-1.0, -1.0, 0], [1.0, -1.0, 0]],
                    )
                    | {key: _STONE[key] for key in ("youngs_modulus_pa", "poissons_ratio")},
                    slab=_slab(3.0, 3.0, 0.43, 0.1, coarse_size_m=0.5, at_m=[0, 0, 1.45]),
                ),
                frame,
                dict(column=dict(tilt_rad=0.01)),
                0.6,
                links=dict(
                    tendon=dict(
                        kind="tendon",
                        body="column",
                        to="slab",
                        to_point_m=[0, 0, 1.45],
                        stiffness_n_m=1.72e6,
                    )
                ),
            ),
            150,
        ),
        "column of three drums": (
            _structure(
                dict(
                    column=dict(
                        kind="cylinder",
                        outer_diameter_m=0.5,
                        height_m=0.6,
                        element_size_m=0.13,
                        coarse_size_m=0.3,
                        copies_m=[[0, 0, 0.6 * k] for k in range(3)],
                    )
                    | _STONE
                ),
                dict(foot=_ON, joint=dict(between=["column", "column"])),
                {"column 3": dict(tilt_rad=0.02)},
                0.5,
            ),
            1000,
        ),
    }


def histories(tables: dict, modes: int) -> tuple[dict, dict, dict]:
    """Summary of the full order, and histories of the full order and the reduced engine, until the
    third impact of one of them.
    """
    found = {}
    for engine, own in (("full", {}), ("reduced", dict(n_modes=modes))):
        with tempfile.TemporaryDirectory() as folder:
            summary = analyse(
                case_from_tables(
                    merge(tables, dict(integration=dict(engine=engine) | own)), "case"
                ),
                Path(folder) / engine,
                quiet=True,
            )
            found[engine] = summary, read_history(Path(folder) / engine / "history.h5")
    last = min(_third_impact(rows) for _, rows in found.values())
    full, reduced = (
        {name: values[:last] for name, values in found[engine][1].items()}
        for engine in ("full", "reduced")
    )
    return found["full"][0], full, reduced


def _third_impact(rows: dict) -> int:
    """Rows until impacts have taken energy in three steps; all where they have not."""
    hits = np.flatnonzero(np.diff(rows["energy/impact"]) < -1e-6 * np.ptp(rows["energy/gravity"]))
    return int(hits[_IMPACTS - 1]) + 2 if len(hits) >= _IMPACTS else len(rows["time"])


def run(engine: str, long: bool = False) -> CaseRows:
    """The rows; engine: corotated."""
    return CaseRows([row for name, one in structures().items() for row in _rows(name, *one)])


def _rows(name: str, tables: dict, modes: int) -> Iterator[Row]:
    summary, full, reduced = histories(tables, modes)
    tilts = [key for key in full if key.startswith("body/") and key.endswith("/tilt")]
    peak = max(np.abs(full[key]).max() for key in tilts)
    hits = int(np.sum(np.diff(full["energy/impact"]) < -1e-6 * np.ptp(full["energy/gravity"])))
    yield Row(
        f"{name}, {len(full['time'])} steps, {hits} impacts: tilts off reduced / largest",
        0.0,
        max(np.abs(full[key] - reduced[key]).max() for key in tilts) / peak,
        1e-4,
    )
    top = (
        np.linalg.norm(full["u_top"] - reduced["u_top"], axis=1).max()
        / np.linalg.norm(full["u_top"], axis=1).max()
    )
    yield Row(f"{name}: top off reduced / largest displacement", 0.0, top, 1e-4)
    yield Row(
        f"{name}: error of the energy balance over the energy moved",
        0.0,
        summary["energy_closure_rel"],
        1e-9,
    )
