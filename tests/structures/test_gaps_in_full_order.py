"""Joints that begin open, in full order: beside a fall in closed form and the reduced engine."""

import warnings

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import InputError
from fecolumn.simulation import run

STONE = dict(
    kind="block", density_kg_m3=2500.0, youngs_modulus_pa=30e9, poissons_ratio=0.2, width_m=0.3
)
FALLING = dict(
    bodies=dict(
        block=STONE | dict(length_m=0.3, height_m=0.5, element_size_m=0.15, at_m=[0.0, 0.0, 0.01])
    ),
    joints=dict(face=dict(between=["block", "ground"])),
)
BESIDE = dict(
    bodies=dict(
        left=STONE | dict(length_m=0.3, height_m=1.0, element_size_m=0.15, at_m=[-0.15, 0.0, 0.0]),
        right=STONE | dict(length_m=0.4, height_m=1.0, element_size_m=0.2, at_m=[0.205, 0.0, 0.0]),
    ),
    joints=dict(
        one=dict(between=["left", "ground"]),
        other=dict(between=["right", "ground"]),
        side=dict(between=["left", "right"]),
    ),
    initial=dict(left=dict(spin_rad_s=[0.0, 0.3, 0.0])),
)


def _history(folder, tables, engine, steps, start="rest"):
    case = case_from_tables(
        tables
        | dict(
            contact=dict(friction_coefficient=0.7, interior_points=0),
            integration=dict(engine=engine, dt_s=1e-3, duration_s=1e-3 * steps, start=start),
        ),
        "gap.toml",
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        run(case, folder / engine, quiet=True)
    return read_history(folder / engine / "history.h5")


def test_a_block_falls_freely_and_lands(tmp_path):
    rows = _history(tmp_path, FALLING, "full", 120, start="drawn")
    height = rows["body/block/displacement"][:, 2]
    assert height[40] == pytest.approx(-9.80665 * 0.04**2 / 2, rel=1e-6)
    assert height[-1] == pytest.approx(-0.01, abs=1e-6)
    moved = np.ptp(rows["energy/gravity"])
    assert np.abs(rows["energy/closure"]).max() < 1e-10 * moved


def test_what_would_begin_at_rest_in_the_air_is_refused(tmp_path):
    with pytest.raises(InputError, match='start = .rest.: .*nothing holds "block" up.*"drawn"'):
        _history(tmp_path, FALLING, "full", 1)


def test_blocks_pound_as_in_the_reduced_engine(tmp_path):
    """The left one comes to the right one's side, 5 mm away, in the twenty-first step."""
    full, reduced = (_history(tmp_path, BESIDE, engine, 150) for engine in ("full", "reduced"))
    for name in ("left", "right"):
        tilt, other = (rows[f"body/{name}/tilt"] for rows in (full, reduced))
        assert tilt == pytest.approx(other, abs=5e-3 * full["body/left/tilt"].max())
    assert full["body/right/tilt"].max() > 3e-4
    assert np.abs(full["energy/closure"]).max() < 1e-10 * np.ptp(full["energy/kinetic"])
