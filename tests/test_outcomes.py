"""What becomes of a column, and what is said of it: rigid marble drum, 0.5 m x 1.6 m, critical tilt
0.303 rad.
"""

import json
import math
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest

from fecolumn import simulation
from fecolumn.case.case import case_from_tables, load_case
from fecolumn.cli import main
from fecolumn.engines.ending import ending_text
from fecolumn.engines.summary_entries import energy_closure
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge, read_toml

DRUM = {
    "column": {"outer_diameter_m": 0.5, "height_m": 1.6, "wall_m": 0.25, "fine_height_m": 0.1},
    "base": {
        "length_m": 1.0,
        "width_m": 1.0,
        "thickness_m": 0.1,
        "youngs_modulus_pa": 50e9,
        "density_kg_m3": 2700,
    },
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700},
    "contact": {"friction_coefficient": 0.8},
    "mesh": {"fine_size_m": 0.09, "coarse_size_m": 0.098, "base_size_m": 0.3},
    "integration": {"engine": "rigid"},
}


def drum(**sections):
    return case_from_tables(merge(DRUM, sections), "drum.toml")


def released(tilt, folder, seconds=0.5):
    return simulation.run(
        drum(initial={"tilt_rad": tilt}, integration={"duration_s": seconds}), folder, quiet=True
    )


def pulse(path, acceleration, start, end, seconds):
    """A motion along x, constant from start to end, every 5 ms."""
    times = 0.005 * np.arange(round(seconds / 0.005) + 1)
    path.write_text(
        "time [s],ax [m/s2]\n"
        + "".join(f"{t:.3f},{acceleration if start <= t < end else 0.0}\n" for t in times)
    )
    return str(path)


def test_column_released_short_of_its_critical_tilt_comes_back(tmp_path):
    summary = released(0.2, tmp_path / "out")
    assert (
        not summary["overturned"]
        and summary["steps"] == 500
        and summary["outcome"] == "still rocking"
    )
    assert summary["ended_by"].startswith("end of the analysed time")
    # released at rest with less energy than it takes: m g R (cos(alpha - tilt) - cos alpha)
    weight, arm, alpha = (
        2700 * math.pi * 0.25**2 * 1.6 * 9.80665,
        math.hypot(0.25, 0.8),
        math.atan2(0.25, 0.8),
    )
    # a coarse polygon is lighter
    assert summary["energy_to_overturn_j"] == pytest.approx(
        weight * arm * (1 - math.cos(alpha)), rel=0.06
    )
    assert 0.3 < summary["energy_left_j"] / summary["energy_to_overturn_j"] < 1


def test_column_released_beyond_its_critical_tilt_overturns(tmp_path):
    summary = released(0.32, tmp_path / "out", seconds=3.0)
    assert (
        summary["overturned"] and summary["outcome"] == "overturned" and summary["u_max_censored"]
    )
    assert (
        summary["ended_by"].startswith('point of no return: "column" has tilted by 0.32')
        and "critical 0.303 rad" in summary["ended_by"]
    )
    assert summary["critical_tilt_rad"] == pytest.approx(math.atan2(0.25, 0.8), abs=1e-3)
    assert summary["u_critical_m"] == pytest.approx(
        0.25 * (1 - math.cos(0.3029)) + 1.6 * math.sin(0.3029), rel=1e-3
    )
    assert summary["duration_s"] < 0.1  # nothing is to come: no time is spent on the fall


def test_pulse_that_brings_a_column_back_from_beyond_its_critical_tilt_is_no_overturning(tmp_path):
    """From 1.65 alpha, growing, 6 m/s2 towards the lean for 0.2 s: by the equation of rocking it is
    back upright at rest almost.
    """
    motion = {
        "source": pulse(tmp_path / "pulse.csv", 6.0, 0.05, 0.25, 0.5),
        "free_vibration_s": 1.0,
    }
    summary = simulation.run(
        drum(initial={"tilt_rad": 0.5}, motion=motion), tmp_path / "out", quiet=True
    )
    assert not summary["overturned"] and summary["tilt_max_rad"] > 0.5
    with h5py.File(tmp_path / "out" / "history.h5") as history:
        assert history["tilt"][-1] < 0.3


def test_cap_of_a_case_ends_the_analysis_sooner_and_says_so(tmp_path):
    summary = simulation.run(
        drum(
            initial={"tilt_rad": 0.2},
            overturn={"displacement_m": 0.25},
            integration={"duration_s": 0.5},
        ),
        tmp_path / "out",
        quiet=True,
    )
    assert summary["overturned"] and "overturn.displacement_m = 0.25 m" in summary["ended_by"]


def test_free_vibration_goes_on_until_rest(tmp_path):
    """The drum rocks for seconds after its pulse; the same to the last digit where it was
    interrupted in its free vibration.
    """
    motion = {
        "source": pulse(tmp_path / "pulse.csv", 3.6, 0.0, 0.18, 0.2),
        "free_vibration_s": "rest",
    }
    case = drum(motion=motion, integration={"alpha_hht": -0.2})
    whole = simulation.run(case, tmp_path / "whole", quiet=True)
    assert (
        whole["outcome"] == "at rest"
        and "after the motion's end" in whole["ended_by"]
        and whole["tilt_max_rad"] > 1e-3
    )
    assert (
        0 <= whole["energy_left_j"] <= 1e-3 * whole["energy_to_overturn_j"]
        and 0.3 < whole["duration_s"] < 60
    )
    asked = iter([False, True])
    with pytest.raises(KeyboardInterrupt):
        simulation.run(case, tmp_path / "two", quiet=True, stop=lambda: next(asked))
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # it goes on, and does not start afresh
        warnings.filterwarnings("ignore", ".*between its rows")  # the pulse has few rows
        two = simulation.run(case, tmp_path / "two", quiet=True)
    assert (two["steps"], two["u_max_m"], two["ended_by"]) == (
        whole["steps"],
        whole["u_max_m"],
        whole["ended_by"],
    )
    with h5py.File(tmp_path / "two" / "history.h5") as history:
        assert len(history["time"]) == two["steps"] + 1


def test_ceiling_ends_a_free_vibration_that_goes_on_and_on(tmp_path):
    motion = {
        "source": pulse(tmp_path / "pulse.csv", 3.6, 0.0, 0.1, 0.2),
        "free_vibration_s": "rest",
        "rest_ceiling_s": 0.25,
    }
    summary = simulation.run(drum(motion=motion), tmp_path / "out", quiet=True)
    assert (
        summary["outcome"] == "still rocking"
        and "motion.rest_ceiling_s = 0.25 s" in summary["ended_by"]
    )
    assert summary["duration_s"] == pytest.approx(0.45, abs=0.002) and summary["energy_left_j"] > 0


def test_a_column_that_starts_with_a_spin_is_not_at_rest_and_its_energy_is_left(tmp_path):
    """Pushed over its edge with half the energy that overturns it: so much is left on the way up,
    whatever becomes kinetic, strain and potential energy.
    """
    spinning = drum(initial={"spin_rad_s": [0.0, 0.55, 0.0]}, integration={"duration_s": 0.3})
    summary = simulation.run(spinning, tmp_path / "out", quiet=True)
    with h5py.File(tmp_path / "out" / "history.h5") as history:
        begun = history["energy/kinetic"][0]
    assert 0.3 * summary["energy_to_overturn_j"] < begun < 0.7 * summary["energy_to_overturn_j"]
    assert summary["outcome"] == "still rocking" and summary["tilt_max_rad"] > 0.05
    assert summary["energy_left_j"] == pytest.approx(begun, rel=0.02)


@pytest.mark.parametrize(
    "start, flight_s",
    [({"spin_rad_s": [0.0, 0.55, 0.0]}, 0.5), ({"velocity_m_s": [0.0, 0.0, 1.0]}, 2 / 9.80665)],
    ids=["spin", "thrown up"],
)
def test_free_vibration_of_a_column_that_starts_moving_ends_at_rest_and_not_before(
    start, flight_s, tmp_path
):
    motion = {"source": pulse(tmp_path / "none.csv", 0.0, 0.0, 0.0, 0.1)}
    summary = simulation.run(
        drum(motion=motion | {"free_vibration_s": "rest"}, initial=start),
        tmp_path / "rest",
        quiet=True,
    )
    assert summary["outcome"] == "at rest" and summary["duration_s"] > flight_s - 1e-3
    assert 0 <= summary["energy_left_j"] <= 1e-3 * summary["energy_to_overturn_j"]
    longer = simulation.run(
        drum(motion=motion | {"free_vibration_s": summary["duration_s"] + 1.0}, initial=start),
        tmp_path / "long",
        quiet=True,
    )
    assert longer["u_max_m"] == pytest.approx(summary["u_max_m"], abs=1e-9) and longer[
        "tilt_max_rad"
    ] == pytest.approx(summary["tilt_max_rad"], abs=1e-9)


def test_a_column_in_free_flight_is_not_at_rest_and_one_that_lands_beside_its_base_slides_off(
    tmp_path,
):
    flying = simulation.run(
        drum(initial={"velocity_m_s": [0.0, 0.0, 3.0]}, integration={"duration_s": 0.2}),
        tmp_path / "up",
        quiet=True,
    )
    # N, but for the polygon's edges
    weight = flying["energy_to_overturn_j"] / (math.hypot(0.25, 0.8) - 0.8)
    assert flying["outcome"] == "still rocking" and flying["energy_left_j"] == pytest.approx(
        weight / 9.80665 * 4.5, rel=0.1
    )
    thrown = simulation.run(
        drum(initial={"velocity_m_s": [3.0, 0.0, 4.0]}, integration={"duration_s": 2.0}),
        tmp_path / "away",
        quiet=True,
    )
    assert thrown["outcome"] == "slid off" and thrown["slid_off_time_s"] == pytest.approx(
        2 * 4.0 / 9.80665, abs=2e-3
    )


def test_energy_left_is_told_beside_that_which_overturns():
    rocking = {
        "overturned": False,
        "outcome": "still rocking",
        "duration_s": 1.0,
        "residual_slide_m": 0.0,
        "motion_cut_at_s": None,
    }
    told = [
        ending_text(rocking | {"energy_left_j": left, "energy_to_overturn_j": barrier})
        for left, barrier in ((5.0, 12.0), (3810.0, 1760.0), (7.0, 0.0))
    ]
    assert told == [
        "still rocking at 1.000 s with 5 J of the 12 J to overturn",
        "still rocking at 1.000 s with 3.81e+03 J, more than the 1.76e+03 J that "
        "overturn it slowly",
        "still rocking at 1.000 s with 7 J",
    ]


def test_a_structure_of_which_any_body_rocks_is_said_to_rock():
    still = {
        "overturned": False,
        "outcome": "still rocking",
        "duration_s": 1.0,
        "residual_slide_m": 0.0,
        "motion_cut_at_s": None,
        "energy_left_j": 5.0,
        "energy_to_overturn_j": 12.0,
        "tilt_max_rad": 1e-5,
        "critical_tilt_rad": 0.2,
    }
    assert ending_text(still).startswith("still moving at 1.000 s, never tilted")
    rocks = {"low": {"tilt_max_rad": 0.05}, "tall": {"tilt_max_rad": 1e-5}}
    assert "with 5 J of the 12 J" in ending_text(still | {"bodies": rocks})


def test_free_vibration_is_a_number_or_rest():
    with pytest.raises(InputError, match=r'free_vibration_s = .*forever.*a number or "rest"'):
        drum(motion={"source": "lick:1", "free_vibration_s": "forever"})
    with pytest.raises(InputError, match=r'must lie in \[0, 10000\] \[s\] or "rest"'):
        drum(motion={"source": "lick:1", "free_vibration_s": -1})


def test_failed_start_leaves_its_folder_free(tmp_path):
    missing = drum(motion={"source": str(tmp_path / "missing.csv")})
    for folder in (tmp_path / "new", tmp_path / "empty"):
        if folder.name == "empty":
            folder.mkdir()
        with pytest.raises(InputError, match="no such file"):
            simulation.run(missing, folder, quiet=True)
        assert folder.exists() == (folder.name == "empty")
        assert released(0.05, folder, seconds=0.01)["steps"] == 10
    with pytest.raises(InputError, match="another case"):
        simulation.run(missing, tmp_path / "new", quiet=True)


def test_case_with_a_motion_runs_all_of_it(tmp_path):
    """The specimens of this repository say nothing of a duration, so that the motion does."""
    source = pulse(tmp_path / "pulse.csv", 0.01, 0.0, 0.1, 1.5)
    for specimen in ("specimen", "stout"):
        (tmp_path / f"{specimen}.toml").write_text(
            f'extends = "{Path("meshes").resolve() / specimen}.toml"\n[motion]\nsource '
            f'= "{source}"\n'
        )
        assert load_case(tmp_path / f"{specimen}.toml").integration.duration_s == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", ".*between its rows")
        summary = simulation.run(
            drum(motion={"source": source, "free_vibration_s": 0.0}), tmp_path / "out", quiet=True
        )
    assert (
        summary["duration_s"] == pytest.approx(1.5, abs=0.002)
        and summary["motion_cut_at_s"] is None
    )


@pytest.mark.long
def test_motion_cut_short_is_said(tmp_path, capsys):
    file, out = tmp_path / "case.toml", tmp_path / "out"
    lines = [
        f"[{name}]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
        for name, keys in DRUM.items()
    ]
    source = pulse(tmp_path / "pulse.csv", 0.01, 0.0, 0.1, 1.5)
    file.write_text("".join(lines) + f'duration_s = 0.02\n[motion]\nsource = "{source}"\n')
    assert main(["run", str(file), "-o", str(out), "-q"]) == 0
    said = capsys.readouterr()
    assert "integration.duration_s = 0.02 s cuts the motion short, which lasts 1.5 s" in said.err
    assert json.loads((out / "summary.json").read_text())["motion_cut_at_s"] == pytest.approx(0.02)
    assert (
        "at rest, residual slide" in said.out
        and "the motion was cut at 0.02 s, by integration.duration_s" in said.out
    )
    assert main(["mesh", str(file), "-o", str(tmp_path / "mesh")]) == 0
    assert (
        "integration.duration_s = 0.02 s cuts the motion short, which lasts 1.5 s"
        in capsys.readouterr().err
    )


def test_a_look_at_the_mesh_says_that_the_motion_cannot_be_used(tmp_path, capsys):
    file = tmp_path / "case.toml"
    lines = [
        f"[{name}]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
        for name, keys in DRUM.items()
    ]
    file.write_text("".join(lines) + '[motion]\nsource = "missing.csv"\n')
    assert main(["mesh", str(file), "-o", str(tmp_path / "mesh")]) == 0
    assert "missing.csv" in capsys.readouterr().err


def test_strong_motion_overturns_in_both_engines_at_the_same_time(tmp_path):
    """A push of 0.35 s leaves the stout tube with a thick wall beyond its critical tilt: lost with
    the push's end, in full order and reduced.
    """
    tables = merge(
        read_toml("meshes/stout.toml"),
        {
            "column": {"wall_m": 0.02, "fine_height_m": 0.02},
            "mesh": {
                "fine_size_m": 0.02,
                "coarse_size_m": 0.03,
                "cap_size_m": 0.05,
                "base_size_m": 0.05,
            },
            "base": {"slide_allowance_m": 0.01},
            "integration": {"dt_s": 4e-3},
            "motion": {
                "source": pulse(tmp_path / "push.csv", 2.8, 0.01, 0.36, 0.4),
                "free_vibration_s": 2.0,
            },
        },
    )
    found = [
        simulation.run(
            case_from_tables(merge(tables, {"integration": {"engine": engine}}), "stout.toml"),
            tmp_path / engine,
            quiet=True,
        )
        for engine in ("full", "reduced")
    ]
    for summary in found:
        assert (
            summary["overturned"]
            and summary["ended_by"].startswith("point of no return")
            and summary["tilt_max_rad"] > summary["critical_tilt_rad"]
        )
    full, reduced = found
    assert reduced["overturn_time_s"] == pytest.approx(full["overturn_time_s"], abs=0.005)
    assert reduced["tilt_max_rad"] == pytest.approx(full["tilt_max_rad"], rel=0.01)
    assert (
        reduced["critical_tilt_rad"],
        reduced["u_critical_m"],
        reduced["energy_to_overturn_j"],
    ) == pytest.approx(
        (full["critical_tilt_rad"], full["u_critical_m"], full["energy_to_overturn_j"]), rel=1e-9
    )


def test_energy_closure_of_what_does_not_move_is_relative_to_the_energy_that_it_holds():
    still, strained = np.zeros(3), np.full(3, 1e-4)
    rows = {
        "energy/kinetic": still,
        "energy/gravity": still - 2e-4,
        "energy/base_work": still,
        "energy/strain": strained,
        "energy/closure": np.array([0.0, 1e-20, -2e-20]),
    }
    assert energy_closure(rows) == pytest.approx(2e-16)
    assert energy_closure(rows | {"energy/kinetic": still + 2.0}) == pytest.approx(1e-20)
