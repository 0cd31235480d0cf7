"""A rocking model's own table in runs and studies: integration.engine = "podium" and its like,
alone or beside bodies.
"""

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import h5py
import pytest

from fecolumn.case.case import case_from_tables, load_case
from fecolumn.case.model_names import TABLES
from fecolumn.case.model_sections import SECTIONS
from fecolumn.cli import main
from fecolumn.engines.ending import AT_REST, STILL_ROCKING
from fecolumn.engines.rocking.case import read_model_case
from fecolumn.engines.rocking.models import ROCKING_MODELS
from fecolumn.engines.rocking.podium import Podium
from fecolumn.foundation import _compiled
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import read_folder_case, run
from fecolumn.study.plan import read_plan
from fecolumn.study.results.load import load
from fecolumn.verification import rocking_tables

PODIUM = """podium.column_mass_kg = 2500
podium.floor_mass_kg = 1e5
podium.slenderness_rad = 0.14889
podium.half_diagonal_m = 1.5
integration.dt_s = 0.005
"""
PULSE = 'motion.source = "pulse.csv"\nmotion.units = "g"\n'
FRAME = Path(__file__).parents[2] / "meshes" / "wobbling_frame.toml"
MODEL = {
    "wobbling_frame": dict(
        slenderness_rad=0.1359, half_diagonal_m=0.7315, column_mass_kg=124.4, slab_mass_kg=9621.0
    )
}


@pytest.fixture
def folder(tmp_path):
    """A folder with podium.toml and a pulse that rocks it."""
    (tmp_path / "pulse.csv").write_text(
        "t,x\n"
        + "\n".join(f"{0.02 * i:.2f},{0.2 * (1 if i < 10 else -1) * (i < 20)}" for i in range(60))
    )
    (tmp_path / "podium.toml").write_text(PODIUM + PULSE)
    return tmp_path


def test_an_analysis_of_less_than_a_step_is_refused(folder):
    case = load_case(folder / "podium.toml")
    with pytest.raises(InputError, match=r"duration_s = 0.004: must be at least integration.dt_s"):
        case.replace({"integration.duration_s": 0.004})
    assert case.replace({"integration.duration_s": 0.005}).integration.duration_s == 0.005


def test_tables_are_those_of_the_models():
    assert {one.TABLE: name for name, one in ROCKING_MODELS.items()} == TABLES
    assert set(SECTIONS) == set(TABLES)


def test_a_podium_runs_as_any_case_and_gives_what_the_rocking_command_gives(folder, capsys):
    assert main(["run", str(folder / "podium.toml"), "-o", str(folder / "run"), "-q"]) == 0
    summary = json.loads((folder / "run" / "summary.json").read_text())
    assert (
        summary["engine"] == "podium"
        and summary["impacts"] > 0
        and summary["energy_closure_rel"] < 1e-5
    )
    one = read_model_case("podium", folder / "podium.toml")
    _, response = one.response(one.sources[0])
    assert response.u_max == pytest.approx(summary["u_max_m"]) and response.peaks == pytest.approx(
        summary["peaks"]
    )
    assert response.time[-1] == pytest.approx(summary["duration_s"])
    for command, said in (
        (["mesh", str(folder / "podium.toml"), "-o", str(folder / "mesh")], "has no mesh"),
        (["render", str(folder / "run")], "is the table of a rocking model"),
    ):
        assert main(command) == 2 and said in capsys.readouterr().err
    again, _ = read_folder_case(folder / "run")
    assert again.id == summary["case_id"] and again.own["podium"].storeys == 3


def test_the_rocking_command_goes_on_until_rest_as_a_run_does(folder):
    file = folder / "block.toml"
    file.write_text(
        "block.width_m = 0.3\nblock.height_m = 1.8\ninitial.tilt_rad = 0.1\n"
        'motion.free_vibration_s = "rest"\n' + PULSE.replace('"g"', '"mm/s2"')
    )
    summary = run(load_case(file), folder / "run", quiet=True)
    one = read_model_case("housner", file)
    _, response = one.response(one.sources[0])
    assert response.outcome(one.model.energy_to_overturn) == summary["outcome"] == AT_REST
    assert response.time[-1] == pytest.approx(summary["duration_s"]) and response.time[-1] > 3
    assert len(response.impact_times) == summary["impacts"]


def test_a_model_that_is_not_at_rest_by_then_ends_with_its_ceiling(folder):
    file = folder / "block.toml"
    file.write_text(
        "block.width_m = 0.3\nblock.height_m = 1.8\ninitial.tilt_rad = 0.1\n"
        'motion.free_vibration_s = "rest"\nmotion.rest_ceiling_s = 0.1\n'
        + PULSE.replace('"g"', '"mm/s2"')
    )
    summary = run(load_case(file), folder / "run", quiet=True)
    assert summary["outcome"] == STILL_ROCKING
    assert summary["ended_by"].startswith("motion.rest_ceiling_s = 0.1 s after the motion's end")


def test_a_models_own_coordinates_have_the_units_that_the_model_states(folder, monkeypatch):
    """In the file and for who reads it; without a unit nothing is written."""
    case = load_case(folder / "podium.toml")
    run(case, folder / "run", quiet=True)
    own = {"model/theta": "rad", "model/beam": "m", "model/base_shear": "N"}
    with h5py.File(folder / "run" / "history.h5") as file:
        assert {f"model/{name}": one.attrs["unit"] for name, one in file["model"].items()} == own
    result = load(folder / "run")
    assert {name: result.units[name] for name in result.history if name in own} == own
    assert result.units["energy/strain"] == "J" and "model/base_shear [N]" in result.columns()
    assert result.to_xarray()["model_base_shear"].attrs["units"] == "N"
    peaks = ["tilt_over_alpha", "base_shear_n", "base_shear_over_v_st"]
    assert list(result.summary["peaks"]) == peaks + [f"storey_{n}_shear_n" for n in (1, 2, 3)]
    respond = Podium.respond

    def sways(*of, **more):
        response = respond(*of, **more)
        return replace(response, coordinates={"sway": response.tilt})

    monkeypatch.setattr(Podium, "respond", sways)
    with pytest.raises(KeyError, match="model/sway"):
        run(case, folder / "without", quiet=True)


def test_case_id_knows_the_building_and_neither_title_nor_output(folder):
    case = load_case(folder / "podium.toml")
    assert (
        case.replace({"podium.impact": "CAV"}).id
        != case.id
        != case.replace({"podium.storeys": 4}).id
    )
    assert case.replace({"title": "another", "output.history_every_s": 0.1}).id == case.id


def test_studies_vary_the_keys_of_a_models_table(folder):
    (folder / "study.toml").write_text(
        'case = "podium.toml"\n[axes]\n"podium.impact" = ["CRV", '
        '"CAV"]\n"podium.period_s" = [0.3, 0.6]\n"motion.scale" = [0.7, 1.0]\n'
    )
    plan = read_plan(folder / "study.toml")
    assert {one.case.integration.engine for one in plan.analyses} == {"podium"} and len(
        plan.analyses
    ) == 8
    assert [one.case.own["podium"].impact for one in plan.analyses] == 4 * ["CRV"] + 4 * ["CAV"]


@pytest.mark.parametrize(
    "text, said",
    [
        (
            'integration.engine = "reduced"\n',
            "integration.engine = 'reduced': must be podium, as the case has [podium]",
        ),
        (
            "contact.friction_coefficient = 0.3\n",
            "contact: unknown key; a case of the model podium has title, podium, integration",
        ),
        ("output.fields_every_s = 0.1\n", "output.fields_every_s = 0.1: must be 0"),
        (
            "initial.spin_rad_s = [0, 0, 1]\n",
            "initial.spin_rad_s = [0, 0, 1]: unknown key; known keys: tilt_rad, direction_deg",
        ),
        ("podium.storeys = 0\n", "podium.storeys = 0: must lie in [1, 200]"),
        (
            "block.width_m = 0.5\n",
            "integration.engine: must be housner or podium, as the case has [block] and [podium]",
        ),
    ],
)
def test_what_does_not_fit_is_told_in_a_line(folder, text, said):
    (folder / "podium.toml").write_text(PODIUM + PULSE + text)
    with pytest.raises(InputError) as told:
        load_case(folder / "podium.toml")
    assert said in str(told.value) and "\n" not in str(told.value)


def test_a_column_has_no_building():
    with pytest.raises(
        InputError,
        match=r"integration.engine = 'podium': needs a table of its own, \[podium\]; of a "
        r"\[column\] there are housner and wobbling",
    ):
        case_from_tables(
            dict(
                column=dict(outer_diameter_m=0.1, wall_m=0.005, height_m=1.0),
                integration=dict(engine="podium"),
            ),
            "case.toml",
        )


def test_the_same_frame_in_bodies_and_as_a_model_is_told_apart_by_the_engine(tmp_path):
    tables = tomllib.loads(FRAME.read_text())
    bodies = case_from_tables(tables, FRAME)
    both = merge(tables, MODEL)
    # the model's table changes nothing of the bodies
    assert case_from_tables(both, FRAME).id == bodies.id
    model = case_from_tables(
        merge(both, {"integration": {"engine": "wobbling_frame"}, "initial": {"tilt_rad": 0.03}}),
        FRAME,
    )
    # joints by their older name
    older = {"interfaces" if name == "joints" else name: table for name, table in both.items()}
    older = merge(older, {"integration": {"engine": "wobbling_frame"}})
    assert case_from_tables(older, FRAME).integration.engine == "wobbling_frame"
    summary = run(model, tmp_path / "run", quiet=True)
    assert summary["engine"] == "wobbling_frame" and summary["u_max_m"] == pytest.approx(
        0.043, rel=0.05
    )


def test_what_a_model_passes_over_has_its_keys_checked():
    block = dict(kind="block", length_m=0.2, width_m=0.2, height_m=1.0)
    tables = dict(
        block=dict(width_m=0.2, height_m=1.0),
        bodies=dict(a=block),
        joints=dict(foot=dict(between=["a", "floor"])),
        grounds=dict(floor=dict(kind="plate")),
        initial=dict(a=dict(tilt_rad=0.1)),
        integration=dict(engine="housner", duration_s=1.0),
    )
    assert case_from_tables(tables).own["block"].width_m == 0.2
    for change, told in (
        ({"bodies": {"a": {"nonsense": 1}}}, "bodies.a.nonsense"),
        ({"grounds": {"floor": {"thickness_m": -1}}}, "grounds.floor.thickness_m"),
        ({"initial": {"a": {"tilt": 1}}}, "initial.a.tilt"),
        ({"joints": 5}, "joints = 5"),
    ):
        with pytest.raises(InputError, match=told):
            case_from_tables(merge(tables, change))


def test_functions_compiled_from_their_own_file_are_kept_for_the_next_tests(tmp_path, monkeypatch):
    """The cache of the tests lives as long as they do; half a minute of compilation of podium,
    block and wobbling column need not.
    """
    monkeypatch.setenv("FECOLUMN_CACHE", str(tmp_path / "own"))
    monkeypatch.setenv("FECOLUMN_COMPILED", str(tmp_path / "kept"))
    _compiled.compiled_folder.cache_clear()
    try:
        assert Path(_compiled.compiled_folder((_compiled.__file__,))).parent == tmp_path / "kept"
        assert Path(_compiled.compiled_folder()).parent == tmp_path / "own"
    finally:
        _compiled.compiled_folder.cache_clear()


def test_tables_of_other_programs_come_out_again():
    assert [row for row in rocking_tables.run("models").rows if not row.ok] == []


@pytest.mark.parametrize(
    "keys, told",
    [
        (dict(integration="reduced"), "integration = 'reduced': must be a table"),
        (dict(motion=dict(source="lick:1", strong_part=[0.9, 0.1])), "motion.strong_part"),
        (dict(integration=dict(tolerance=1e-3)), "integration.tolerance = 0.001: has no effect"),
        (dict(integration=dict(kinematics="total_lagrangian")), "integration.kinematics"),
        (dict(integration=dict(dt_s=1e-12, duration_s=10.0)), "must be at least .* steps in 10 s"),
    ],
)
def test_motion_and_integration_of_a_models_own_table_are_checked_as_of_any_case(keys, told):
    block = dict(block=dict(width_m=0.25, height_m=1.0))
    with pytest.raises(InputError, match=told):
        case_from_tables(block | keys, "case.toml")


@pytest.mark.parametrize(
    "table, direction, told",
    [
        (
            "podium",
            90,
            r"direction_deg = 90.0: must be 0 or 180 deg: \[podium\] rocks in the plane",
        ),
        ("frame", 45, r"direction_deg = 45.0: must be 0 or 180 deg: \[frame\] rocks in the plane"),
        ("block", 90, r"direction_deg = 90.0: must be 0 or 180 deg: \[block\] rocks in the plane"),
        ("one-sided", 180, "direction_deg = 180.0: must be 0 deg where block.sides = 1"),
        ("podium", 180, ""),
        ("frame", -180, ""),
        ("one-sided", 360, ""),
        ("deep", 90, ""),
    ],
)
def test_a_start_that_a_model_cannot_have_is_refused(table, direction, told, tmp_path):
    block = {"width_m": 0.6, "height_m": 3.0}
    tables = {
        "podium": tomllib.loads(PODIUM),
        "frame": {
            "frame": dict(width_m=1.6, height_m=9.6, column_mass_kg=48e3, beam_mass_kg=384e3)
        },
        "block": {"block": block},
        "one-sided": {"block": block | {"sides": 1}},
        "deep": {"block": block | {"depth_m": 0.8}},
    }[table]
    leaning = {"tilt_rad": 0.03, "direction_deg": direction}
    case = case_from_tables(tables | {"initial": leaning, "integration": {"duration_s": 0.5}})
    if told:
        with pytest.raises(InputError, match=told):
            run(case, tmp_path / "out", quiet=True)
    else:
        assert run(case, tmp_path / "out", quiet=True)["u_max_m"] > 0.01
