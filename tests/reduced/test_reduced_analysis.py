"""Analyses with the reduced engine from case to result folder."""

import io
import json
import shutil
import time

import h5py
import numpy as np
import pytest

import fecolumn.engines.reduced_analysis  # noqa: F401  (compiled functions belong in the user's cache)
from fecolumn import simulation
from fecolumn.case.case import case_from_tables
from fecolumn.contact.known_base import KnownBase
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.structures.bodies import Drawing

SPECIMEN = "meshes/stout.toml"


@pytest.fixture(autouse=True, scope="module")
def cache(tmp_path_factory):
    """Models of this module only; compiled functions stay where they are."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FECOLUMN_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


def case_of(**sections):
    tables = merge(
        read_toml(SPECIMEN),
        {
            "column": {"fine_height_m": 0.01},
            "base": {"slide_allowance_m": 0.01, "length_m": 0.3, "width_m": 0.3},
            "mesh": {"coarse_size_m": 0.03, "cap_size_m": 0.05, "base_size_m": 0.05},
            "integration": {"engine": "reduced", "duration_s": 1.2, "dt_s": 1e-3},
            "initial": {"tilt_rad": 0.03},
        },
    )
    return case_from_tables(merge(tables, sections), SPECIMEN)


def history(folder):
    with h5py.File(folder / "history.h5") as file:
        return {
            name: file[name][()]
            for name in (
                "time",
                "u_top",
                "tilt",
                "active_nodes",
                "energy/kinetic",
                "energy/closure",
            )
        }


@pytest.mark.long
def test_interrupted_analysis_goes_on_to_the_last_digit(tmp_path, monkeypatch):
    # looks do not hang on the clock
    monkeypatch.setattr("fecolumn.engines.pace.Pace.chunk", lambda pace, most: most)
    # asked each time that a state is kept, every 40 steps
    asked = iter([False] * 24 + [True])
    with pytest.raises(KeyboardInterrupt):
        simulation.run(case_of(), tmp_path / "two", quiet=True, stop=lambda: next(asked))
    assert (tmp_path / "two" / "checkpoint.npz").is_file()
    assert len(history(tmp_path / "two")["time"]) == 1001
    resumed = simulation.run(case_of(), tmp_path / "two", quiet=True)
    summary = simulation.run(case_of(), tmp_path / "one", quiet=True)
    assert resumed["rigid_loss_share"] == summary["rigid_loss_share"] > 0.5
    one, two = history(tmp_path / "one"), history(tmp_path / "two")
    assert len(one["time"]) == 1201 and summary["impacts"] > 0
    assert summary["contact_iterations"] > 0 and summary["impact_iterations"] > 0
    for name in one:
        np.testing.assert_array_equal(one[name], two[name])
    assert not (tmp_path / "two" / "checkpoint.npz").exists()


@pytest.mark.parametrize("asked", [0, 1, 2])
def test_analysis_interrupted_while_it_slides_on_a_plate_goes_on_to_the_last_digit(
    tmp_path, slid, asked
):
    """Sums over the nodes of an elastic plate are taken in the order in which the foot came to
    them, which a checkpoint keeps.
    """
    times = iter([False] * asked + [True])
    with pytest.raises(KeyboardInterrupt):
        simulation.run(sliding(), tmp_path / "two", quiet=True, stop=lambda: next(times))
    simulation.run(sliding(), tmp_path / "two", quiet=True)
    again = history(tmp_path / "two")
    for name, values in slid.items():
        np.testing.assert_array_equal(values, again[name])


def sliding():
    """The case of a column that slides and turns, with all of its foot."""
    return case_of(
        initial={"tilt_rad": 0.0, "velocity_m_s": [-0.2, 0.05, 0.0], "spin_rad_s": [0.0, 0.0, 0.5]},
        contact={"friction_coefficient": 0.03},
        base={"kind": "plate"},
        integration={"duration_s": 0.16},
    )


@pytest.fixture(scope="module")
def slid(tmp_path_factory):
    """Its history without interruption."""
    folder = tmp_path_factory.mktemp("slid")
    simulation.run(sliding(), folder, quiet=True)
    return history(folder)


def test_rigid_is_the_reduced_engine_without_modes(tmp_path):
    rigid = simulation.run(case_of(integration={"engine": "rigid"}), tmp_path / "rigid", quiet=True)
    bare = simulation.run(case_of(integration={"n_modes": 0}), tmp_path / "bare", quiet=True)
    assert rigid["u_max_m"] == bare["u_max_m"] and rigid["engine"] == "rigid"


def test_result_has_what_a_full_order_one_has(tmp_path):
    short = {"duration_s": 0.02}
    simulation.run(case_of(integration=short), tmp_path / "reduced", quiet=True)
    simulation.run(case_of(integration=short | {"engine": "full"}), tmp_path / "full", quiet=True)
    names = []
    for engine in ("full", "reduced"):
        with h5py.File(tmp_path / engine / "history.h5") as file:
            found = {}
            file.visititems(
                lambda name, item, found=found: (
                    found.update({name: (item.shape, item.attrs["unit"])})
                    if hasattr(item, "shape")
                    else None
                )
            )
        names.append((found, sorted(json.loads((tmp_path / engine / "summary.json").read_text()))))
    assert names[0] == names[1]


@pytest.mark.long
def test_slide_beyond_the_allowance_extends_the_base_and_off_the_plate_is_an_outcome(tmp_path):
    """mu = 0.02 on a base pushed by 2 m/s2 slides until its foot leaves a plate 14 mm wider than it
    to each side.
    """
    sections = dict(
        contact={"friction_coefficient": 0.02},
        initial={"tilt_rad": 0.0},
        base={"slide_allowance_m": 0.0, "length_m": 0.13, "width_m": 0.13},
    )
    (tmp_path / "push.csv").write_text(
        "time [s],ax [m/s2]\n"
        + "".join(f"{0.01 * k:.2f},{-2.0 if 0 < k else 0.0}\n" for k in range(60))
    )
    sections["motion"] = {"source": str(tmp_path / "push.csv"), "free_vibration_s": 0.0}
    sections["integration"] = {"duration_s": 0.5, "dt_s": 2e-3}
    summary = simulation.run(case_of(**sections), tmp_path / "out", quiet=True)
    slid = history(tmp_path / "out")
    assert np.abs(slid["u_top"][-1, 0]) > 0.012
    assert (
        summary["outcome"] == "slid off"
        and summary["slid_off"]
        and not summary["overturned"]
        and summary["u_max_censored"]
    )
    assert summary["slid_off_at_s"] == summary["slid_off_time_s"] == slid["time"][-1] and summary[
        "slid_off_direction_deg"
    ] == pytest.approx(0.0, abs=1e-3)
    assert (
        "edge of the base plate" in summary["ended_by"]
        and summary["u_max_m"] == np.abs(slid["u_top"][:, 0]).max()
    )
    sections["base"]["kind"] = "unbounded"
    goes_on = simulation.run(case_of(**sections), tmp_path / "unbounded", quiet=True)
    assert goes_on["outcome"] != "slid off" and goes_on["residual_slide_m"] > 0.1


def test_literal_hht_is_refused():
    with pytest.raises(InputError, match="contact.impact"):
        case_of(contact={"impact": "none"})


@pytest.mark.long
def test_what_is_made_once_is_no_cost_of_the_analysis_that_makes_it(tmp_path, monkeypatch):
    real, slow = Drawing.model, 1.5

    def make(*args):
        time.sleep(slow)
        return real(*args)

    monkeypatch.setattr(Drawing, "model", make)
    began = time.perf_counter()
    summary = simulation.run(
        case_of(mesh={"coarse_size_m": 0.028}, integration={"duration_s": 0.01}),
        tmp_path,
        quiet=True,
    )
    assert (
        summary["wall_s"] < time.perf_counter() - began - slow
        and summary["s_per_step"] * summary["steps"] < summary["wall_s"]
    )


@pytest.mark.long
def test_a_base_that_is_extended_is_no_cost_of_the_analysis_that_needs_it(tmp_path, monkeypatch):
    real, slow = KnownBase._extend, 1.5

    def extend(base, reach):
        began = time.process_time()
        while time.process_time() < began + slow:
            pass
        real(base, reach)

    monkeypatch.setattr(KnownBase, "_extend", extend)
    sections = dict(
        contact={"friction_coefficient": 0.02},
        initial={"tilt_rad": 0.0, "velocity_m_s": [0.3, 0.0, 0.0]},
        integration={"duration_s": 0.05, "dt_s": 2e-3},
        base={"slide_allowance_m": 0.0, "length_m": 0.131, "width_m": 0.131},
    )
    summary = simulation.run(case_of(**sections), tmp_path, quiet=True)
    assert summary["residual_slide_m"] > 0.01 and summary["cpu_s"] < slow


@pytest.mark.long
def test_a_thrown_column_with_damping_restitution_and_rolling_moves_the_same_in_both_engines(
    tmp_path,
):
    """Keys reach the engines: 20 ms from a tilt with a spin that makes it wobble, and a push that
    makes it slip.
    """
    sections = dict(
        initial={"tilt_rad": 0.03, "velocity_m_s": [0.02, 0.0, 0.0], "spin_rad_s": [0.5, 0.0, 0.1]},
        material={"damping_ratio": 0.05},
        contact={"restitution": 0.5, "rolling_resistance": 2e-3},
    )
    rows, sums = {}, {}
    for engine in ("full", "reduced"):
        case = case_of(**sections, integration={"duration_s": 0.02, "engine": engine})
        sums[engine] = simulation.run(case, tmp_path / engine, quiet=True)["energy_j"]
        rows[engine] = history(tmp_path / engine)
    full, reduced = rows["full"], rows["reduced"]
    assert full["energy/kinetic"][0] > 0
    assert reduced["energy/kinetic"][0] == pytest.approx(full["energy/kinetic"][0], rel=1e-6)
    assert (
        np.abs(reduced["u_top"] - full["u_top"]).max()
        < 1e-4 * np.abs(full["u_top"][:, :2] - full["u_top"][0, :2]).max()
    )
    for term in ("rolling", "friction"):
        assert sums["full"][term] < 0 and sums["reduced"][term] == pytest.approx(
            sums["full"][term], rel=0.01
        )
    assert sums["full"]["damping"] < 0 and sums["reduced"]["damping"] < 0
    assert np.abs(reduced["energy/closure"]).max() < 1e-9 * full["energy/kinetic"][0]


@pytest.fixture(scope="module")
def interrupted(tmp_path_factory):
    """A case, its folder with a checkpoint in the middle, and the summary of the same analysis done
    at once.
    """
    case, folder = (
        case_of(integration={"engine": "rigid", "duration_s": 0.6}),
        tmp_path_factory.mktemp("interrupted"),
    )
    with pytest.raises(KeyboardInterrupt):
        simulation.run(case, folder / "a", quiet=True, stop=lambda: True)
    return case, folder / "a", simulation.run(case, folder / "whole", quiet=True)


def _rewritten(**changes):
    def damage(data):
        with np.load(io.BytesIO(data)) as file:
            arrays = {name: file[name] for name in file.files}
        content = io.BytesIO()
        np.savez(
            content, **arrays | {name: change(arrays[name]) for name, change in changes.items()}
        )
        return content.getvalue()

    return damage


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"garbage",
        lambda data: b"",
        lambda data: data[: len(data) // 2],
        lambda data: data[:3000] + b"\xff" * 500 + data[3500:],
        _rewritten(step=lambda step: step + 1),
        _rewritten(case_id=lambda name: "000000000000"),
        _rewritten(ledger=lambda values: values * np.nan),
        _rewritten(ledger=lambda values: values[1:]),
        _rewritten(**{"motion.rotation": lambda values: values.astype(str)}),
    ],
)
def test_checkpoint_that_cannot_be_used_is_told_and_the_analysis_starts_afresh(
    interrupted, tmp_path, damage
):
    case, folder, whole = interrupted
    shutil.copytree(folder, tmp_path / "a")
    checkpoint = tmp_path / "a" / "checkpoint.npz"
    checkpoint.write_bytes(damage(checkpoint.read_bytes()))
    with pytest.warns(
        UserWarning, match="checkpoint.npz cannot be used .*; the analysis starts afresh"
    ):
        summary = simulation.run(case, tmp_path / "a", quiet=True)
    assert (
        summary["u_max_m"] == whole["u_max_m"]
        and summary["steps"] == whole["steps"]
        and not checkpoint.exists()
    )


@pytest.mark.parametrize(
    "wrong", ["{", "[]", {"u_max_m": -1.0}, {"u_max_m": 0.5}, {"case_id": "000000000000"}]
)
def test_summary_that_is_none_is_told_and_the_analysis_made_again(interrupted, tmp_path, wrong):
    case, folder, whole = interrupted
    shutil.copytree(folder, tmp_path / "a")
    (tmp_path / "a" / "summary.json").write_text(
        wrong if isinstance(wrong, str) else json.dumps(whole | wrong)
    )
    with pytest.warns(UserWarning, match="summary.json is damaged: .*; the analysis is made again"):
        summary = simulation.run(case, tmp_path / "a", quiet=True)
    assert summary["u_max_m"] == whole["u_max_m"]


def test_a_slender_block_on_a_wide_thin_flange_stands(tmp_path):
    # the flange sags and pushes outward; these forces once turned the block further in each
    # iteration to equilibrium than its small inertia about the vertical held
    case = case_from_tables(
        dict(
            column=dict(
                shape="block", length_m=0.095, width_m=0.095, height_m=1.07, fine_height_m=0.0095
            ),
            flange=dict(outer_diameter_m=0.195, thickness_m=0.0076),
            cap=False,
            base=dict(kind="unbounded", youngs_modulus_pa=24.5e9),
            material=dict(youngs_modulus_pa=5.57e9, density_kg_m3=2580.0),
            mesh=dict(fine_size_m=0.0158, coarse_size_m=0.0317, base_size_m=0.19),
            contact=dict(friction_coefficient=1.6, interior_points=0),
            integration=dict(engine="reduced", n_modes=10, dt_s=4e-4, duration_s=0.02),
        ),
        "flange",
    )
    summary = simulation.run(case, tmp_path / "flange", quiet=True)
    assert summary["outcome"] == "at rest" and summary["tilt_max_rad"] < 1e-9
