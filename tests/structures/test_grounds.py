"""Grounds below structures: elastic ones under several feet, several grounds at their heights with
motions of their own, and sliding off.
"""

import warnings
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from small_grounds import (
    BLOCK,
    HEIGHT,
    MASS,
    SETTLED,
    SIDE,
    SUBGRADE,
    WEIGHT,
    analysed,
    bridge,
    wave,
)
from small_structures import structure

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import InputError
from fecolumn.simulation import read_folder_case, run, started_analysis
from fecolumn.structures.shaking import motions_of
from fecolumn.structures.structure import structure_model

SOFT = dict(youngs_modulus_pa=5e7, poissons_ratio=0.3, thickness_m=0.6, element_size_m=0.1)
DEEP = SOFT | dict(thickness_m=2.4)


def on_elastic(places, ground):
    """Tables of blocks at places x [m] on an elastic ground."""
    names = [f"block{k}" for k in range(len(places))]
    return dict(
        bodies={name: BLOCK | dict(at_m=[x, 0, 0]) for name, x in zip(names, places)},
        joints={f"foot{k}": dict(between=[name, "soil"]) for k, name in enumerate(names)},
        grounds=dict(soil=ground),
        integration=dict(duration_s=1e-3, dt_s=1e-3),
    )


def settlements(folder, places, ground):
    """Rise [m] at rest of blocks at places x [m]."""
    _, rows = analysed(folder, **on_elastic(places, ground))
    return [rows[f"interface/foot{k}: block{k} on soil/rise"][0] for k in range(len(places))]


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:.*resolves the ground's own vibration")
@pytest.mark.parametrize("kind", ["unbounded", "plate"])
def test_each_of_two_blocks_settles_as_alone_and_by_what_the_other_one_adds(tmp_path, kind):
    """What the other one adds is that of its weight on the nodes below it, up to the square of size
    over distance.
    """
    ground = DEEP | dict(kind=kind)
    if kind == "plate":
        ground |= dict(length_m=4.8, width_m=2.4, coarse_size_m=0.3)
    (alone,) = settlements(tmp_path / "alone", [0.0], ground)
    near = settlements(tmp_path / "near", [-0.6, 0.6], ground)
    model = structure_model(structure(**on_elastic([-0.6, 0.6], ground)))
    half = np.array([BLOCK["length_m"], BLOCK["width_m"]]) / 2
    below = [
        np.flatnonzero((np.abs(model.base.grid.points[:, :2] - [x, 0]) <= half + 1e-6).all(axis=1))
        for x in (-0.6, 0.6)
    ]
    model.base.need(np.concatenate(below))
    one, other = (model.base.slot[nodes] for nodes in below)
    added = -WEIGHT * model.base.compliance[np.ix_(one, other)][..., 2, 2].mean()
    assert near[0] == pytest.approx(near[1], rel=1e-3)
    assert abs(added) > 0.05 * abs(alone)
    assert near[0] - alone == pytest.approx(added, rel=0.15)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:.*resolves the ground's own vibration")
@pytest.mark.parametrize("kind", ["unbounded", "plate"])
def test_blocks_far_apart_settle_as_alone(tmp_path, kind):
    ground = SOFT | dict(kind=kind)
    if kind == "plate":
        ground |= dict(length_m=8.0, width_m=3.0, coarse_size_m=0.3)
    (alone,) = settlements(tmp_path / "alone", [0.0], ground)
    far = settlements(tmp_path / "far", [-2.5, 2.5], ground)
    assert far == pytest.approx([alone, alone], rel=0.01)


def test_two_blocks_on_one_pad_settle_each_by_its_own_weight(tmp_path):
    low = BLOCK | dict(height_m=HEIGHT / 3, at_m=[1.0, 0, 0])
    _, rows = analysed(
        tmp_path / "run",
        bodies=dict(high=BLOCK, low=low),
        joints={name: dict(between=[name, "soil"]) for name in ("high", "low")},
        grounds=dict(soil=dict(kind="pad", stiffness_n_m3=SUBGRADE)),
        integration=dict(duration_s=1e-3),
    )
    assert rows["interface/high: high on soil/rise"][0] == pytest.approx(-SETTLED, rel=1e-6)
    assert rows["interface/low: low on soil/rise"][0] == pytest.approx(-SETTLED / 3, rel=1e-6)


@pytest.mark.filterwarnings("ignore:.*resolves the ground's own vibration")
def test_a_block_that_slides_over_the_edge_of_its_plate_is_told_by_name(tmp_path):
    summary, _ = analysed(
        tmp_path / "run",
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "slab"])),
        grounds=dict(slab=SOFT | dict(kind="plate", length_m=1.0, width_m=1.0)),
        initial=dict(block=dict(velocity_m_s=[1.0, 0, 0])),
        contact=dict(friction_coefficient=0.05),
        integration=dict(duration_s=0.4),
    )
    assert summary["slid_off"] and '"block"' in summary["ended_by"]
    # 0.2 m of room, at 1 m/s and a deceleration of mu g
    way = 1.0 / (0.05 * GRAVITY) * (1 - np.sqrt(1 - 2 * 0.05 * GRAVITY * 0.2))
    assert summary["duration_s"] == pytest.approx(way, abs=0.02)


@pytest.fixture(scope="module")
def shaken(tmp_path_factory):
    return wave(tmp_path_factory.mktemp("motion"))


def test_a_bridge_on_unlike_supports_is_stretched_by_their_relative_displacement(tmp_path, shaken):
    """Two piers that stick to their grounds, 0.5 m apart in height, one moved against the other:
    the force of the spring between them is its stiffness times how far the grounds move apart.
    """
    file, times, displacement = shaken
    stiffness = 1e5
    summary, rows = analysed(tmp_path / "run", **bridge(file, BLOCK, stiffness))
    apart = np.interp(rows["time"], times, -1.5 * displacement)
    for link in ("deck", "anchor"):
        assert rows[f"link/{link}/tension"] == pytest.approx(
            stiffness * apart, abs=2e-3 * stiffness * np.abs(apart).max()
        )
    # relative to the first ground, all of the right pier goes along with its own
    assert rows["body/right/displacement"][:, 0] == pytest.approx(apart, abs=2e-6)
    assert np.abs(rows["interface/right: right on hill/slide"]).max() < 2e-6
    assert np.abs(rows["body/left/displacement"][:, 0]).max() < 2e-6
    assert summary["energy_closure_rel"] < 1e-8
    assert abs(summary["energy_j"]["contact"]) < 1e-3 * MASS * 1e-4


def test_a_block_slides_on_a_ground_that_moves_by_itself_as_by_the_motion_of_all(tmp_path, shaken):
    """On the second ground, the first at rest, it does what it does on the only one."""
    file = shaken[0]
    motion = dict(source=str(file), units="m/s2", free_vibration_s=0.1, scale=15.0)
    sliding = dict(contact=dict(friction_coefficient=0.1), integration=dict(duration_s=0.0))
    _, alone = analysed(
        tmp_path / "alone",
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "ground"])),
        motion=motion,
        **sliding,
    )
    summary, rows = analysed(
        tmp_path / "two",
        bodies=dict(still=BLOCK | dict(at_m=[3.0, 0, 0]), block=BLOCK | dict(at_m=[0, 0, 0.5])),
        joints=dict(rest=dict(between=["still", "rock"]), foot=dict(between=["block", "table"])),
        grounds=dict(rock={}, table=dict(level_m=0.5, motion=motion)),
        motion=motion | dict(scale=0.0),
        **sliding,
    )
    slide = rows["interface/foot: block on table/slide"][:, 0]
    exact = alone["interface/foot: block on ground/slide"][:, 0]
    assert np.abs(exact).max() > 1e-3
    assert slide == pytest.approx(exact, abs=1e-3 * np.abs(exact).max())
    assert summary["energy_closure_rel"] < 1e-8
    assert rows["energy/friction"][-1] == pytest.approx(alone["energy/friction"][-1], rel=2e-3)


@pytest.mark.long
@pytest.mark.parametrize("substeps", ["rolling", "impacts"])
def test_an_analysis_on_two_grounds_that_was_stopped_goes_on_to_the_last_digit(
    tmp_path, shaken, substeps
):
    """Blocks that jump on yielding soil and on a plate which moves by itself."""
    motion = dict(source=str(shaken[0]), units="m/s2", free_vibration_s=0.1, scale=10.0)
    case = structure(
        bodies=dict(left=BLOCK, right=BLOCK | dict(at_m=[3.0, 0, 0.5])),
        joints=dict(
            left=dict(between=["left", "soil"]),
            right=dict(between=["right", "slab"], restitution=0.3),
        ),
        grounds=dict(
            soil=dict(kind="pad", stiffness_n_m3=SUBGRADE, yield_pa=1.5 * WEIGHT / SIDE**2),
            slab=SOFT | dict(kind="plate", level_m=0.5, motion=motion | dict(scale=-5.0)),
        ),
        initial=dict(left=dict(velocity_m_s=[0, 0, -0.3]), right=dict(velocity_m_s=[0.1, 0, 0.2])),
        motion=motion,
        contact=dict(friction_coefficient=0.2, interior_points=0),
        integration=dict(
            engine="rigid", dt_s=2e-3, alpha_hht=0.0, duration_s=1.5, substeps=substeps
        ),
    )
    asked = iter([True] + [False] * 1000)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*resolves the ground's own vibration")
        with pytest.raises(KeyboardInterrupt):
            run(case, tmp_path / "run", quiet=True, stop=lambda: next(asked))
        again, file = read_folder_case(tmp_path / "run")
        assert again.id == case.id
        warnings.filterwarnings("error", message=".*cannot be used")
        summary = run(again, tmp_path / "run", file=file, quiet=True)
        run(case, tmp_path / "whole", quiet=True)
    stopped, whole = (read_history(tmp_path / name / "history.h5") for name in ("run", "whole"))
    for name in ("body/left/displacement", "body/right/displacement"):
        assert np.array_equal(stopped[name], whole[name])
    assert summary["energy_closure_rel"] < 1e-8
    # bounced, and settled
    rise = whole["interface/right: right on slab/rise"]
    assert rise.max() - rise[0] == pytest.approx(0.2**2 / 2 / GRAVITY, rel=0.02)
    assert whole["interface/left: left on soil/rise"][-1] < -1.2 * SETTLED


def test_grounds_that_drift_apart_after_their_motions_are_told(tmp_path):
    """A record that is cut while it moves: 1 m/s2 for 0.1 s leaves 0.1 m/s."""
    (tmp_path / "push.csv").write_text("t,ax,ay\n0.0,1.0,0.0\n0.1,1.0,0.0\n", encoding="utf-8")
    motion = dict(source=str(tmp_path / "push.csv"), units="m/s2", free_vibration_s=0.0)
    with pytest.warns(UserWarning, match=r"grounds.hill goes on .* grounds.valley at 0.1 m/s"):
        analysed(
            tmp_path / "run",
            bodies=dict(left=BLOCK, right=BLOCK | dict(at_m=[3.0, 0, 0])),
            joints=dict(
                left=dict(between=["left", "valley"]), right=dict(between=["right", "hill"])
            ),
            grounds=dict(valley={}, hill=dict(motion=motion)),
            motion=motion | dict(scale=0.0),
            integration=dict(dt_s=1e-3, duration_s=0.0),
        )


def test_a_ground_whose_own_motion_cannot_be_is_named():
    case = structure(
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "table"])),
        grounds=dict(table=dict(motion=dict(source="lick:99999"))),
        motion=dict(source="lick:12"),
    )
    with pytest.raises(InputError, match=r"grounds\.table\.motion\.source.*from 1 to 115"):
        motions_of(case, None, "case.toml")


def two_moving_grounds(folder, peak_g):
    """Case of two blocks on grounds of their own: the first shakes weakly for 2 s, the second for
    1 s by `peak_g`.
    """
    for name, peak, seconds in (("weak", 0.05, 2.0), ("strong", peak_g, 1.0)):
        times = 0.01 * np.arange(round(seconds / 0.01) + 1)
        shaken = GRAVITY * peak * np.sin(2 * np.pi * times)
        rows = "".join(f"{t:.3f},{a:.6f},0.0\n" for t, a in zip(times, shaken))
        (folder / f"{name}.csv").write_text("time_s,ax_m_s2,ay_m_s2\n" + rows)
    own = dict(source=str(folder / "strong.csv"))
    return structure(
        bodies=dict(one=BLOCK, other=BLOCK | dict(at_m=[2.0, 0, 0])),
        joints=dict(foot=dict(between=["one", "ground"]), beside=dict(between=["other", "dock"])),
        grounds=dict(ground=dict(kind="rigid"), dock=dict(kind="rigid", motion=own)),
        motion=dict(source=str(folder / "weak.csv")),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.0),
        contact=dict(interior_points=0),
    )


def test_a_case_counts_the_motions_of_grounds_by_what_their_files_hold(tmp_path):
    made = two_moving_grounds(tmp_path, 0.8)
    assert [Path(motion.source).name for motion in made.motions] == ["weak.csv", "strong.csv"]
    known, moved = made.id, tmp_path / "moved"
    moved.mkdir()
    assert two_moving_grounds(moved, 0.8).id == known
    assert two_moving_grounds(tmp_path, 0.9).id != known


def test_no_return_reckons_with_the_motion_of_every_ground(tmp_path):
    """The shorter motion of the other ground is the stronger one."""
    made = two_moving_grounds(tmp_path, 0.8)
    (tmp_path / "out").mkdir()
    analysis = started_analysis(made, tmp_path / "out", MPI.COMM_SELF, "case.toml", quiet=True)
    steepest = analysis.steepest(range(2000))
    assert steepest[0] == pytest.approx(0.8, rel=1e-3)
    assert steepest[1001:].max() == pytest.approx(0.05, rel=1e-3)
