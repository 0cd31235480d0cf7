"""Steps that are hard to make: bars that tumble, thin rings that stand, nodes that other nodes
carry; and energy that does not close is told.
"""

import warnings

import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.summary_entries import CLOSES, unclosed_text
from fecolumn.fem.effective import unit_loads
from fecolumn.fem.free_body import FreeBody
from fecolumn.simulation import run
from fecolumn.structures.layout import layout_of
from fecolumn.structures.reduction import body_of


def test_a_slender_bar_that_tumbles_too_fast_for_its_step_is_made_in_halves(tmp_path):
    """Its turn of two radians in a step is not found; with unconverged turns it gained energy."""
    bar = dict(kind="block", length_m=0.02, width_m=0.02, height_m=0.4, element_size_m=0.02)
    case = structure(
        bodies=dict(bar=bar | dict(at_m=[0.0, 0.0, 5.0]) | STONE),
        initial=dict(bar=dict(spin_rad_s=[30.0, 100.0, 20.0])),
        contact=dict(between="all", friction_coefficient=0.6),
        integration=dict(engine="rigid", start="drawn", dt_s=0.02, duration_s=0.1),
    )
    with pytest.warns(UserWarning, match="times its thickness in a step"):
        summary = run(case, tmp_path, quiet=True)
    assert summary["cuts"] > 0 and summary["energy_closure_rel"] < 1e-10
    # those of a halved step are counted, too
    made = read_history(tmp_path / "history.h5")["iterations"]
    assert (made[1:] > 0).all() and made.sum() == summary["iterations"]


@pytest.mark.long
@pytest.mark.parametrize("engine", ["reduced", "full"])
def test_a_thin_glass_tube_stands_while_it_is_shaken(tmp_path, engine):
    """Points of a thin ring depend on one another: Newton on their slips goes round and round."""
    time = np.arange(0.0, 2.0, 0.01)
    motion = tmp_path / "sine.csv"
    ground = 0.7 * 3 * np.sin(3 * np.pi * time) * np.sin(np.pi * time / 2)
    motion.write_text(
        "time [s],ax [m/s2]\n" + "".join(f"{t:g},{a:.6g}\n" for t, a in zip(time, ground))
    )
    glass = dict(youngs_modulus_pa=70e9, poissons_ratio=0.2, density_kg_m3=2500.0)
    case = structure(
        bodies=dict(
            tube=dict(kind="tube", outer_diameter_m=0.06, wall_m=0.001, height_m=0.25) | glass
        ),
        joints=dict(foot=dict(between=["tube", "ground"])),
        contact=dict(friction_coefficient=0.5),
        motion=dict(source=str(motion), free_vibration_s=0.0),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=0.8),
    )
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "integration.duration_s")
        warnings.filterwarnings("ignore", ".*cuts the motion short")
        summary = run(case, tmp_path / engine, quiet=True)
    assert summary["steps"] == 800 and summary["cuts"] == 0
    assert summary["u_max_m"] < 1e-4 and summary["energy_closure_rel"] < 1e-9


def test_forces_on_nodes_that_others_carry_are_theirs():
    """On the border of a finer mesh nodes are tied: forces on them go on, and bend the body."""
    block = dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.8, element_size_m=0.2)
    finer = dict(element_size_m=0.1, fine_height_m=0.4, coarse_size_m=0.2)
    case = structure(
        bodies=dict(a=block | finer | STONE, b=block | dict(at_m=[0.4, 0.0, 0.0]) | STONE),
        joints=dict(
            feet=dict(between=["a", "ground"]),
            other=dict(between=["b", "ground"]),
            side=dict(between=["a", "b"]),
        ),
    )
    layout = layout_of(case, "small.toml")
    drawing = layout.drawings["a"]
    body = body_of(drawing.shape, drawing.material)
    nodes = np.unique(
        np.concatenate(
            [body.find_nodes(one.positions, one.part) for one in layout.patches["a"].values()]
        )
    )
    tied = np.isin(nodes, body.constraint.nodes)
    assert 0 < tied.sum() < len(nodes)
    loads = unit_loads(body, nodes)
    sums = loads.reshape(-1, 3, loads.shape[1]).sum(axis=0)
    assert sums == pytest.approx(np.tile(np.eye(3), len(nodes)), abs=1e-12)
    forces = np.random.default_rng(1).normal(size=(len(nodes), 3))
    assert body.spread(nodes, forces).reshape(-1) == pytest.approx(loads @ forces.reshape(-1))
    moved = FreeBody(body).response(loads).reshape(body.n_owned, 3, -1)[nodes]
    flexibility = moved.reshape(3 * len(nodes), -1)
    assert np.abs(flexibility - flexibility.T).max() < 1e-9 * flexibility.max()
    assert np.linalg.eigvalsh(flexibility)[0] > -1e-9 * flexibility.max()


def test_energy_that_does_not_close_is_told(tmp_path, monkeypatch):
    assert unclosed_text(CLOSES) == "" and "0.25 of the largest" in unclosed_text(0.25)
    assert unclosed_text(float("nan"))
    case = structure(
        bodies=dict(block=dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.8) | STONE),
        joints=dict(foot=dict(between=["block", "ground"])),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.01),
    )
    monkeypatch.setattr("fecolumn.engines.analysis.energy_closure", lambda rows: 0.5)
    with pytest.warns(UserWarning, match="the energy balance does not close"):
        assert run(case, tmp_path, quiet=True)["energy_closure_rel"] == 0.5
