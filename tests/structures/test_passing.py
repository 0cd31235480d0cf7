"""Bodies that came through each other, with no joint that lets them meet, end the analysis."""

import pytest
from small_collapses import box, falling, watched
from small_structures import STONE, structure

from fecolumn.engines.analysis import AnalysisFailed
from fecolumn.engines.passing import Passing
from fecolumn.simulation import run

BLOCK = dict(kind="block", length_m=0.3, width_m=0.4, height_m=0.8, element_size_m=0.2) | STONE


def _pushed(folder, joints, engine="rigid"):
    """A block that falls towards another one beside it."""
    case = structure(
        bodies=dict(left=BLOCK, right=BLOCK | dict(at_m=[0.35, 0.0, 0.0])),
        joints=dict(feet=dict(between=["left", "ground"]), other=dict(between=["right", "ground"]))
        | joints,
        initial=dict(left=dict(spin_rad_s=[0.0, 1.5, 0.0])),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=0.5),
    )
    return run(case, folder, quiet=True)


def test_found_contact_that_fails_is_named():
    pairs = dict(low=box(0.3, 0.3, 0.3), high=box(0.3, 0.3, 0.3, at_m=[0.0, 0.0, 2.0]))
    engine, _ = watched(falling(pairs), 0.002)
    passing = Passing(engine.model)
    assert passing.told(engine.motion) == ""
    engine.motion.frames["center"][1, 2] = 0.25
    assert '"low" and "high" came through each other, by 0.2 m' in passing.told(engine.motion)
    engine.motion.frames["center"][1, 2] = 0.449
    assert passing.told(engine.motion) == ""


def test_a_needle_that_spins_is_named_once_with_the_step_that_follows_it():
    pairs = dict(low=box(0.3, 0.3, 0.3), bar=box(0.5, 0.01, 0.01, at_m=[0.0, 0.0, 2.0]))
    engine, _ = watched(falling(pairs), 0.002)
    passing = Passing(engine.model)
    assert passing.fast(engine.motion, 1e-3) == ""
    engine.motion.frames["spin"][1] = [0.0, 0.0, 100.0]
    # half its length at 100 rad/s goes by 25 mm in 1 ms
    told = passing.fast(engine.motion, 1e-3)
    assert '"bar" goes 2.5 times its thickness' in told and "0.0002 s" in told
    assert passing.fast(engine.motion, 1e-3) == ""


@pytest.mark.long
@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_bodies_that_come_through_each_other_are_named(tmp_path, engine):
    with pytest.raises(AnalysisFailed, match='"left" and "right" came through each other'):
        _pushed(tmp_path / "through", {}, engine)


@pytest.mark.filterwarnings("ignore:.*begin 0.05 m apart")
def test_a_joint_across_the_gap_lets_them_meet(tmp_path):
    summary = _pushed(tmp_path / "meet", dict(side=dict(between=["left", "right"])))
    assert summary["bodies"]["left"]["tilt_max_rad"] > 0.05
    assert summary["energy_closure_rel"] < 1e-10
    assert summary["interfaces"]["side: left on right"]["force_max_n"] > 0
