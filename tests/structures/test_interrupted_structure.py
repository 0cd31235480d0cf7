"""A structure that slides, interrupted at any step, goes on to the last digit as if it had not
been.
"""

import h5py
import numpy as np
import pytest
from small_structures import STONE, stack, structure

from fecolumn.engines.analysis import Analysis
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import run


@pytest.fixture(scope="module")
def shake(tmp_path_factory):
    """Motions along x and y, and along x alone."""
    folder, times = tmp_path_factory.mktemp("motions"), np.arange(0.0, 0.6, 0.01)
    for name, aside in (("both", 4.0), ("along", 0.0)):
        rows = (
            f"{t:.2f},{7 * np.sin(25 * t):.6f},{aside * np.sin(17 * t + 1):.6f}\n" for t in times
        )
        (folder / f"{name}.csv").write_text("time [s],ax [m/s2],ay [m/s2]\n" + "".join(rows))
    return folder


def _case(motion, engine, duration_s, **sections):
    """Three equal blocks on one another, which slide: their nodes lie above one another at the
    start, each on a corner of several facets.
    """
    block = dict(kind="block", length_m=0.6, width_m=0.6, height_m=0.6) | STONE
    return structure(
        **merge(
            merge(
                stack(),
                dict(
                    bodies=dict(
                        lower=dict(rigid=False),
                        upper=block | dict(rigid=False),
                        third=block | dict(height_m=0.5, at_m=[0, 0, 1.4]),
                    ),
                    joints=dict(
                        foot=dict(friction_coefficient=0.9), third=dict(between=["third", "upper"])
                    ),
                    contact=dict(friction_coefficient=0.4, interior_points=4),
                    integration=dict(engine=engine, dt_s=1e-3, duration_s=duration_s),
                    motion=dict(source=str(motion)),
                ),
            ),
            sections,
        )
    )


def _history(folder):
    found = {}
    with h5py.File(folder / "history.h5") as file:
        file.visititems(
            lambda name, item: found.update({name: item[()]}) if hasattr(item, "shape") else None
        )
    return found


def _interrupted(case, folder, asked: int):
    """The history of an analysis that is interrupted when it asks for the `asked`-th time whether
    to go on, and taken up again.
    """
    times = iter([False] * asked + [True])
    with pytest.raises(KeyboardInterrupt):
        run(case, folder, quiet=True, stop=lambda: next(times))
    run(case, folder, quiet=True)
    return _history(folder)


def _equal(case, folder, places, slid):
    summary = run(case, folder / "whole", quiet=True)
    assert (
        min(
            summary["interfaces"][name]["slide_max_m"]
            for name in ("joint: upper on lower", "third: third on upper")
        )
        > slid
    )
    whole = _history(folder / "whole")
    for asked in places:
        again = _interrupted(case, folder / str(asked), asked)
        assert all(np.array_equal(values, again[name]) for name, values in whole.items()), asked


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:.*cuts the motion short")
def test_reduced_structure_goes_on_to_the_last_digit(shake, tmp_path):
    # asked each time that a state is kept, every 20 steps
    _equal(
        _case(
            shake / "both.csv",
            "reduced",
            0.3,
            integration=dict(n_modes=3),
            output=dict(states_every_s=0.02),
        ),
        tmp_path,
        (1, 4, 7, 10),
        5e-3,
    )


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:.*cuts the motion short")
def test_full_order_structure_goes_on_to_the_last_digit(shake, tmp_path):
    # asked after each step; sliding along x the nodes stay on the sides of the elements below them
    coarse = dict(element_size_m=0.2, coarse_size_m=0.4)
    bodies = dict(lower=coarse, upper=coarse, third=coarse)
    start = dict(third=dict(velocity_m_s=[1.0, 0.0, 0.0]), upper=dict(velocity_m_s=[0.5, 0.0, 0.0]))
    _equal(
        _case(
            shake / "along.csv",
            "full",
            0.03,
            bodies=bodies,
            initial=start,
            contact=dict(interior_points=0),
        ),
        tmp_path,
        (3, 14, 22),
        5e-3,
    )


@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_an_analysis_that_was_killed_at_its_end_ends_as_if_it_had_not_been(
    engine, tmp_path, monkeypatch
):
    """A block that leans beyond its critical tilt; a checkpoint is due after every look."""
    body = dict(kind="block", length_m=0.2, width_m=0.2, height_m=1.0, element_size_m=0.1) | STONE
    case = structure(
        bodies=dict(block=body),
        joints=dict(foot=dict(between=["block", "ground"])),
        initial=dict(block=dict(tilt_rad=0.205)),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=0.3),
        contact=dict(friction_coefficient=1.0, interior_points=0),
        output=dict(checkpoint_every_s=1e-9),
    )
    whole = run(case, tmp_path / "whole", quiet=True)
    assert whole["overturned"] and whole["duration_s"] < 0.3

    def killed(*of):
        raise RuntimeError("killed")

    with monkeypatch.context() as patched:
        patched.setattr(Analysis, "finish", killed)
        with pytest.raises(RuntimeError, match="killed"):
            run(case, tmp_path / "run", quiet=True)
    again = run(case, tmp_path / "run", quiet=True)
    for key in ("steps", "duration_s", "overturned_at_s", "u_max_m", "ended_by"):
        assert again[key] == whole[key]
