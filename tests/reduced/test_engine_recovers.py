"""What stops the reduced engine between two steps, a full disk for example, costs no step; a step
that fails leaves what was before it.
"""

import errno
import os

import numpy as np
import pytest

from fecolumn import simulation
from fecolumn.case.case import case_from_tables
from fecolumn.contact import known_base
from fecolumn.contact.arrays import arrays_of
from fecolumn.contact.problem import CONTACT_FAILED
from fecolumn.engines.dynamics.cuts import StepFailed
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.history import read_history
from fecolumn.structures.structure import structure_model
from fecolumn.verification.models import block_system, box
from fecolumn.verification.reduced_trial import begin_trial

STEPS, DT = 300, 1e-3


def full_disk(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def sliding(engine, max_cuts=4):
    """Engine of a steel block that slides at 1.5 m/s, mu 0.2, over bricks of the base that it does
    not know yet.
    """
    system = block_system(
        "corotated",
        box([-0.1, 0.1], [-0.1, 0.1], [0, 0.06]),
        box(np.linspace(-0.8, 0.8, 33), [-0.3, 0.3], [-0.02, 0]),
        HHT(DT, 0.0),
        friction=0.2,
    )

    def pushed(system):
        state = standing(system)
        state.v[:, 0] = 1.5
        return state

    made = begin_trial(engine, system, pushed, n_modes=6).engine
    made.max_cuts = max_cuts
    return made


def state_of(engine):
    """All that a motion is, and the ledger."""
    parts = [*arrays_of(engine.motion).values(), engine.ledger]
    return [np.ascontiguousarray(part).tobytes() for part in parts]


@pytest.mark.parametrize("name", ["rigid", "reduced"])
def test_a_base_that_cannot_be_extended_costs_no_row_and_no_digit(name, monkeypatch):
    """The rows of the steps made are there, the motion is that after them; once there is room on
    the disk all goes on as if nothing had been.
    """
    grounds, whole, engine = np.zeros((STEPS, 3)), sliding(name), sliding(name)
    undisturbed, _ = whole.advance(grounds)
    done, stops = undisturbed[:0], []
    while len(done) < STEPS:
        with monkeypatch.context() as patch:
            patch.setattr(engine.bases[0], "need", full_disk)
            try:
                engine.advance(grounds[len(done) :])
            except OSError:
                stops.append(len(engine.made))
        done = np.concatenate([done, engine.made])
        assert engine.motion.time == done[-1, 0]
        if len(done) < STEPS:
            # there is room again
            engine.advance(grounds[len(done) : len(done) + 1])
            done = np.concatenate([done, engine.made])
    # motions change places from step to step: after an odd and after an even number of them
    assert {count % 2 for count in stops} == {0, 1}
    np.testing.assert_array_equal(done, undisturbed)
    assert state_of(engine) == state_of(whole)


def test_a_disk_that_is_full_within_the_halves_of_a_step_leaves_what_was_before_it(monkeypatch):
    engine = sliding("reduced")
    with monkeypatch.context() as patch:
        patch.setattr(engine.bases[0], "need", full_disk)
        with pytest.raises(OSError):
            engine.advance(np.zeros((STEPS, 3)))
        before = state_of(engine)
        # its end is on bricks that the base does not know
        with pytest.raises(OSError):
            engine._cut(np.zeros(3), CONTACT_FAILED)
        assert state_of(engine) == before
    engine._cut(np.zeros(3), CONTACT_FAILED)
    assert state_of(engine) != before and engine.motion.time > 0


def test_a_step_that_fails_after_some_of_its_halves_leaves_what_was_before_it():
    """The base jumps up with a million g: a quarter of the step is made, the next one is not."""
    engine, grounds = sliding("reduced", max_cuts=2), np.zeros((20, 3))
    grounds[12, 2] = 1e7
    with pytest.raises(
        StepFailed,
        match="motion and contact forces did not converge .step cut 2 times to 0.00025 s",
    ):
        engine.advance(grounds)
    assert len(engine.made) == 12 and engine.motion.time == engine.made[-1, 0]
    undisturbed = sliding("reduced")
    undisturbed.advance(grounds[:12])
    assert state_of(engine) == state_of(undisturbed)


def case_of(**tables):
    """A steel block thrown along its base, with half a brick of slide allowance."""
    return case_from_tables(
        {
            "column": {"shape": "block", "length_m": 0.2, "width_m": 0.2, "height_m": 0.1},
            "contact": {"friction_coefficient": 0.2},
            "base": {"length_m": 1.0, "width_m": 0.3, "slide_allowance_m": 0.0},
            "mesh": {"fine_size_m": 0.05, "coarse_size_m": 0.05, "base_size_m": 0.05},
            "initial": {"velocity_m_s": [1.0, 0.0, 0.0]},
            "integration": {"engine": "rigid", "duration_s": 0.4, "dt_s": 1e-3},
        }
        | tables,
        "block.toml",
    )


def test_an_analysis_that_a_full_disk_stopped_keeps_its_steps_and_goes_on_to_the_last_digit(
    tmp_path, monkeypatch
):
    """Checkpoint and history hold every step made; the base's next reach is found by the next run,
    none is left out.
    """
    case, folder = case_of(), tmp_path / "stopped"
    with monkeypatch.context() as patch:
        patch.setenv("FECOLUMN_CACHE", str(tmp_path / "cache"))
        structure_model(case)
        with patch.context() as full:
            full.setattr(known_base, "keep_base", full_disk)
            with pytest.raises(OSError):
                simulation.run(case, folder, quiet=True)
        kept = read_history(folder / "history.h5")["time"]
        with np.load(folder / "checkpoint.npz") as saved:
            assert (
                len(kept) == saved["step"] + 1 > 10
                and saved["motion.whole"]["time"][0] == kept[-1] == saved["rows.time"][-1]
            )
        simulation.run(case, folder, quiet=True)
        simulation.run(case, tmp_path / "whole", quiet=True)
    stopped, whole = (read_history(tmp_path / name / "history.h5") for name in ("stopped", "whole"))
    for name, values in whole.items():
        np.testing.assert_array_equal(stopped[name], values)


def test_a_base_whose_next_reach_cannot_be_kept_tries_that_one_again(tmp_path, monkeypatch):
    monkeypatch.setenv("FECOLUMN_CACHE", str(tmp_path))
    base = structure_model(case_of()).base
    folder = base._folder
    wanted = base.grid.around(np.array([[0.25, 0.0, 0.0]]), 1)
    with monkeypatch.context() as patch:
        patch.setattr(known_base, "keep_base", full_disk)
        with pytest.raises(OSError):
            base.need(wanted)
    base.need(wanted)
    reaches = sorted(int(path.stem.split("-")[1]) for path in folder.glob("known-*.npy"))
    assert reaches == list(range(len(reaches))) and len(reaches) > 1
