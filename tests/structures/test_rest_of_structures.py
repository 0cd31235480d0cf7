"""When a structure is at rest, what is left to overturn it, and what has fallen past the ground."""

import math

import numpy as np
import pytest
from small_structures import STONE, block, stack, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.ending import AT_REST, STILL_ROCKING
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import run
from fecolumn.structures.barrier import least_barrier, stances
from fecolumn.structures.structure import standing_of, structure_model

SPINS = dict(spin_rad_s=[0.0, 0.5, 0.0])
# a mesh of a few elements, for the full order
COARSE = dict(element_size_m=0.2, coarse_size_m=0.4)


def _rested(folder):
    """A motion of no acceleration."""
    (folder / "none.csv").write_text("time [s],ax [m/s2]\n0,0\n0.05,0\n0.1,0\n")
    return dict(source=str(folder / "none.csv"), free_vibration_s="rest")


@pytest.mark.parametrize(
    "engine, keys",
    [
        ("rigid", {}),
        ("reduced", {}),
        ("full", dict(element_size_m=0.2, coarse_size_m=0.4, length_m=0.4, width_m=0.2)),
    ],
)
def test_a_block_that_starts_with_a_spin_has_that_energy_left(engine, keys, tmp_path):
    case = structure(
        **block(**keys),
        initial=dict(block=SPINS),
        integration=dict(
            engine=engine, dt_s=1e-3, n_modes=2, duration_s=0.03 if engine == "full" else 0.15
        ),
    )
    summary, begun = (
        run(case, tmp_path, quiet=True),
        read_history(tmp_path / "history.h5")["energy/kinetic"][0],
    )
    assert 0.2 * summary["energy_to_overturn_j"] < begun < 0.95 * summary["energy_to_overturn_j"]
    assert summary["outcome"] == "still rocking" and summary["energy_left_j"] == pytest.approx(
        begun, rel=0.05
    )


def test_free_vibration_of_a_stack_that_starts_moving_ends_at_rest_and_not_before(tmp_path):
    tables = merge(
        stack(),
        dict(
            initial=dict(upper=dict(spin_rad_s=[0.0, 2.0, 0.0])),
            integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.0),
        ),
    )
    summary = run(structure(**tables, motion=_rested(tmp_path)), tmp_path / "rest", quiet=True)
    assert (
        summary["outcome"] == "at rest"
        and summary["bodies"]["upper"]["tilt_max_rad"] > 0.05
        and summary["energy_left_j"] <= 1e-3 * summary["energy_to_overturn_j"]
    )
    longer = run(
        structure(
            **tables, motion=_rested(tmp_path) | dict(free_vibration_s=summary["duration_s"] + 0.5)
        ),
        tmp_path / "long",
        quiet=True,
    )
    assert (longer["u_max_m"], longer["bodies"]) == (summary["u_max_m"], summary["bodies"])


def test_a_block_in_free_flight_is_not_at_rest(tmp_path):
    case = structure(
        **block(rigid=True),
        initial=dict(block=dict(velocity_m_s=[0.0, 0.0, 3.0])),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.2),
    )
    summary = run(case, tmp_path, quiet=True)
    assert summary["outcome"] == "still rocking" and summary["energy_left_j"] == pytest.approx(
        2700 * 0.4 * 0.2 * 1.2 * 4.5, rel=1e-3
    )


@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_a_block_thrown_beside_the_other_falls_past_the_ground_and_ends_the_analysis_by_name(
    engine, tmp_path
):
    """It flies off the lower block, of which alone it has an interface: its centre, 1.1 m high, is
    at the ground after sqrt(2.2 m / g).
    """
    wide = dict(length_m=0.6, width_m=0.6, height_m=0.8, rigid=engine == "rigid") | COARSE
    tables = merge(
        stack(),
        dict(
            bodies=dict(lower=wide, upper=dict(rigid=engine == "rigid") | COARSE),
            initial=dict(upper=dict(velocity_m_s=[8.0, 0.0, 0.0])),
            contact=dict(friction_coefficient=0.1, interior_points=0),
            joints=dict(joint=dict(allowance_m=0.6)),
            integration=dict(
                engine=engine, dt_s=1e-3 if engine == "rigid" else 4e-3, duration_s=3.0
            ),
        ),
    )
    summary = run(structure(**tables, motion=_rested(tmp_path)), tmp_path / "out", quiet=True)
    assert (
        summary["outcome"] == "slid off"
        and summary["slid_off"]
        and not summary["overturned"]
        and summary["u_max_censored"]
    )
    assert summary["ended_by"].startswith('"upper" has fallen past the ground, z = 0, at ')
    assert summary["slid_off_direction_deg"] == pytest.approx(0.0, abs=1e-3)
    # it leaves the edge with its centre, after 0.3 m and more
    assert math.sqrt(2.2 / GRAVITY) < summary["slid_off_time_s"] < math.sqrt(2.2 / GRAVITY) + 0.15


def temple(*heads):
    return structure(
        bodies=dict(
            column=dict(
                kind="cylinder",
                outer_diameter_m=0.8,
                height_m=4.0,
                copies_m=[[-1.5, 0, 0], [1.5, 0, 0]],
                rigid=True,
            )
            | STONE,
            architrave=dict(
                kind="block", length_m=3.8, width_m=0.8, height_m=0.9, at_m=[0, 0, 4.0], rigid=True
            )
            | STONE,
        ),
        joints=dict(feet=dict(between=["column", "ground"]), heads=dict(between=heads)),
        contact=dict(interior_points=0),
        observed="architrave",
        integration=dict(engine="rigid", duration_s=0.01),
    )


@pytest.mark.parametrize("roles", [("column", "architrave"), ("architrave", "column")])
def test_an_architrave_stands_over_the_heads_of_both_columns(roles, tmp_path):
    case = temple(*roles)
    model = structure_model(case)
    found = {
        model.parts[place].name: stance
        for place, stance in stances(model, standing_of(case, model)).items()
    }
    assert set(found) == {"column 1", "column 2", "architrave"}
    assert found["column 1"].critical == pytest.approx(math.atan2(0.4, 2.0), rel=0.02)
    # across, over the heads
    assert found["architrave"].critical == pytest.approx(math.atan2(0.4, 0.45), rel=0.02)
    # the columns lean together and lift the architrave twice as far as themselves
    column, architrave = model.parts[0].model.mass, model.parts[2].model.mass
    lift = math.hypot(0.4, 2.0) - 2.0
    assert least_barrier(model, standing_of(case, model)) == pytest.approx(
        GRAVITY * (2 * column + 2 * architrave) * lift, rel=0.02
    )
    summary = run(case, tmp_path, quiet=True)
    assert (
        summary["critical_tilt_rad"] == pytest.approx(math.atan2(0.4, 2.0), rel=0.02)
        and summary["energy_to_overturn_j"] > 5e3
    )
    assert summary["outcome"] == "at rest"


def test_the_least_energy_of_a_stack_is_that_of_the_part_that_falls_first():
    """A heavy wide block on a slender pedestal: both lean as one long before the block leans by
    itself, or the pedestal below an upright block.
    """
    slender = dict(kind="block", length_m=0.3, width_m=0.3, height_m=1.2, rigid=True) | STONE
    case = structure(
        bodies=dict(
            pedestal=slender,
            block=slender | dict(length_m=0.9, width_m=0.9, height_m=0.3, at_m=[0, 0, 1.2]),
        ),
        joints=dict(
            foot=dict(between=["pedestal", "ground"]), joint=dict(between=["pedestal", "block"])
        ),
    )
    model = structure_model(case)
    masses = np.array([part.model.mass for part in model.parts])
    height = masses @ [0.6, 1.35] / masses.sum()
    assert least_barrier(model, standing_of(case, model)) == pytest.approx(
        GRAVITY * masses.sum() * (math.hypot(0.15, height) - height), rel=1e-9
    )


def test_the_weakest_edge_of_a_triangular_support_decides():
    """A slab on three columns tips over the edge between two of them, which runs askew."""
    column = (
        dict(
            kind="block",
            length_m=0.2,
            width_m=0.2,
            height_m=0.5,
            copies_m=[[-1.0, -1.0, 0], [1.0, -1.0, 0], [-1.0, 1.0, 0]],
            rigid=True,
        )
        | STONE
    )
    case = structure(
        bodies=dict(
            column=column,
            slab=dict(
                kind="slab",
                length_m=3.0,
                width_m=3.0,
                thickness_m=0.2,
                at_m=[-0.3, -0.3, 0.5],
                rigid=True,
            )
            | STONE,
        ),
        joints=dict(
            feet=dict(between=["column", "ground"]), heads=dict(between=["column", "slab"])
        ),
    )
    model = structure_model(case)
    slab = stances(model, standing_of(case, model))[3]
    # the edge from (1.1, -0.9) to (-0.9, 1.1) passes the slab's centre (-0.3, -0.3) at 0.8 /
    # sqrt(2)
    assert slab.critical == pytest.approx(math.atan2(0.8 / math.sqrt(2), 0.1), rel=1e-9)


@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_force_that_friction_locks_into_a_spring_is_no_motion(engine, tmp_path):
    """A block slides against a spring until friction holds it there."""
    spring = dict(kind="spring", body="block", stiffness_n_m=1e5)
    spring |= dict(point_m=[0.0, 0.0, 0.05], to_point_m=[-1.0, 0.0, 0.05])
    stout = dict(kind="block", length_m=0.5, width_m=0.9, height_m=0.8, mass_kg=300)
    stout |= dict(element_size_m=0.4, youngs_modulus_pa=50e9)
    case = structure(
        bodies=dict(block=stout),
        joints=dict(foot=dict(between=["block", "ground"])),
        links=dict(spring=spring),
        initial=dict(block=dict(velocity_m_s=[0.3, 0.0, 0.0])),
        contact=dict(friction_coefficient=0.3, interior_points=0),
        integration=dict(engine=engine, dt_s=2e-3, duration_s=1.6),
    )
    summary = run(case, tmp_path / "run", quiet=True)
    history = read_history(tmp_path / "run" / "history.h5", names=["energy/strain"])
    locked = history["energy/strain"][-1]
    assert summary["outcome"] == AT_REST and 2.0 < locked < 4.0
    model = structure_model(case)
    assert locked > 1e-3 * least_barrier(model, standing_of(case, model))
    # of a block without its spring, so that the summary does not have it
    assert summary["energy_to_overturn_j"] is None
    short = run(case.replace({"integration.duration_s": 0.3}), tmp_path / "short", quiet=True)
    assert short["outcome"] == STILL_ROCKING


def test_what_turns_back_below_its_place_at_the_start_is_not_at_rest(tmp_path):
    """Two blocks fall by 20 mm and slide: kinetic energy is least, and not small, in between."""
    block = dict(kind="block", length_m=0.2, width_m=0.4, height_m=0.6, mass_kg=40)
    block |= dict(element_size_m=0.2)
    case = structure(
        bodies=dict(
            a=block | dict(at_m=[0.0, 0.0, 0.02]),
            b=block | dict(at_m=[0.0, 0.0, 0.62]),
        ),
        joints=dict(foot=dict(between=["a", "ground"]), joint=dict(between=["b", "a"])),
        initial=dict(b=dict(velocity_m_s=[0.2, 0.0, 0.0])),
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.0),
        motion=_rested(tmp_path),
    )
    summary = run(case, tmp_path / "run", quiet=True)
    history = read_history(tmp_path / "run" / "history.h5")
    kinetic, end = history["energy/kinetic"], history["time"][-1]
    assert summary["outcome"] == AT_REST and end < 30
    bound = 1e-3 * summary["energy_to_overturn_j"]
    assert (kinetic[history["time"] > end - 0.5] <= bound).all()


def test_energy_that_overturns_is_not_told_where_links_hold(tmp_path):
    held = structure(
        **block(),
        links=dict(
            tendon=dict(
                kind="tendon",
                body="block",
                point_m=[0, 0, 1.0],
                to="ground",
                to_point_m=[0, 0, 0],
                stiffness_n_m=1e6,
            )
        ),
        integration=dict(engine="rigid"),
    )
    assert run(held, tmp_path, quiet=True)["energy_to_overturn_j"] is None
