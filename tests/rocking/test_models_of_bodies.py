"""Rocking models of rigid bodies from a structure's case: one more value of integration.engine."""

import math

import h5py
import numpy as np
import pytest

from fecolumn.case.case import case_from_tables, case_of_table, load_case
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.of_bodies import model_of, start_of
from fecolumn.foundation.schema import InputError
from fecolumn.simulation import check_analysis, run

BLOCK = dict(kind="block", length_m=0.4, width_m=0.6, height_m=1.6, density_kg_m3=2700.0)
DRUM = dict(kind="cylinder", outer_diameter_m=0.4, height_m=1.6, density_kg_m3=2700.0)
PLACES = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
PIER = dict(kind="block", length_m=0.2, width_m=0.3, height_m=1.6, mass_kg=250.0, copies_m=PLACES)
AROUND = [[x, y, 0.0] for x in (-1.0, 1.0) for y in (-0.2, 0.2)]
POST = dict(kind="tube", outer_diameter_m=0.2, wall_m=0.02, height_m=1.6, mass_kg=100.0)
POST["copies_m"] = AROUND
SLAB = dict(kind="slab", length_m=3.0, width_m=0.6, thickness_m=0.2, mass_kg=900.0)
STOREYS = SLAB | dict(kind="storeys", floors=3, floor_masses_kg=[900.0], storey_heights_m=[3.0])
FOOT = dict(foot=dict(between=["body", "ground"]))
FRAME = FOOT | dict(head=dict(between=["body", "slab"]))


def case(engine, bodies, joints, **tables):
    plan = dict(engine=engine, dt_s=1e-3, duration_s=1.0)
    return case_from_tables(
        dict(bodies=bodies, joints=joints, integration=plan) | tables, "case.toml"
    )


def frame(engine, column, slab, **tables):
    column = dict(copies_m=PLACES) | column
    return case(engine, dict(body=column, slab=slab | dict(at_m=[0, 0, 1.6])), FRAME, **tables)


def own(**tables):
    """The model of a table of its own."""
    return model_of(case_of_table(tables, "case.toml"), "case.toml")


@pytest.mark.parametrize(
    "made, stated",
    [
        (
            case("housner", dict(body=BLOCK), FOOT),
            dict(block=dict(width_m=0.4, depth_m=0.6, height_m=1.6, density_kg_m3=2700.0)),
        ),
        (
            case("wobbling", dict(body=DRUM), FOOT),
            dict(wobbling=dict(outer_diameter_m=0.4, height_m=1.6, density_kg_m3=2700.0)),
        ),
        (
            frame("rocking_frame", PIER, SLAB),
            dict(frame=dict(column_mass_kg=250.0, beam_mass_kg=900.0, width_m=0.2, height_m=1.6)),
        ),
        (
            frame("wobbling_frame", POST, SLAB),
            dict(
                wobbling_frame=dict(
                    columns=4,
                    column_mass_kg=100.0,
                    slab_mass_kg=900.0,
                    outer_diameter_m=0.2,
                    wall_m=0.02,
                    height_m=1.6,
                )
            ),
        ),
        (
            frame(
                "podium",
                PIER,
                STOREYS | dict(period_s=0.3, profile="shear", damping="rayleigh"),
                materials=dict(steel=dict(damping_ratio=0.05)),
            ).replace({"bodies.slab.material": "steel"}),
            dict(
                podium=dict(
                    columns=2,
                    column_mass_kg=250.0,
                    floor_mass_kg=900.0,
                    width_m=0.2,
                    height_m=1.6,
                    storeys=3,
                    period_s=0.3,
                    profile="shear",
                )
            ),
        ),
    ],
    ids=lambda one: "" if isinstance(one, dict) else one.integration.engine,
)
def test_a_model_of_is_that_of_its_own_table(made, stated):
    found, exact = model_of(made, "case.toml").describe(), own(**stated).describe()
    assert set(found) == set(exact)
    for name, (value, unit) in exact.items():
        assert found[name] == (pytest.approx(value, rel=1e-12), unit)


@pytest.mark.long
def test_one_file_runs_with_every_engine(tmp_path):
    """A block let go from 0.05 rad: its tilt until it lands, and how much later it lands again."""
    (tmp_path / "block.toml").write_text(
        """
[bodies.block]
kind = "block"
length_m = 0.4
width_m = 0.6
height_m = 1.6
density_kg_m3 = 2700
youngs_modulus_pa = 5e11
element_size_m = 0.2
[joints.foot]
between = ["block", "ground"]
[initial.block]
tilt_rad = 0.05
[contact]
friction_coefficient = 0.8
[integration]
dt_s = 1e-3
duration_s = 0.35
n_modes = 10
"""
    )
    stated, tilts = load_case(tmp_path / "block.toml"), {}
    for engine in ("full", "reduced", "rigid", "housner"):
        changes = {"integration.engine": engine}
        folder = tmp_path / engine
        summary = run(stated.replace(changes), folder, quiet=True)
        assert summary["engine"] == engine and not summary["overturned"]
        assert summary["critical_tilt_rad"] == pytest.approx(math.atan2(0.4, 1.6), rel=1e-9)
        with h5py.File(folder / "history.h5") as file:
            tilts[engine] = file["tilt"][()]
    exact = tilts["housner"]
    assert exact[0] == 0.05 and exact[150] < 0.04 and exact.min() < 2e-3
    for engine, off in (("full", 5e-4), ("reduced", 5e-4), ("rigid", 1e-4)):
        assert np.abs(tilts[engine][:150] - exact[:150]).max() < off, engine
        assert np.argmin(tilts[engine][:300]) == pytest.approx(np.argmin(exact[:300]), abs=4)


@pytest.mark.parametrize(
    "made, told",
    [
        (frame("housner", PIER, SLAB), "is of one body on the ground; there are 3"),
        (case("wobbling", dict(body=BLOCK), FOOT), "needs a round foot"),
        (
            case("podium", dict(body=BLOCK), FOOT),
            "is of equal columns on the ground, one body with",
        ),
        (frame("rocking_frame", POST, SLAB), '"body" is a tube: wobbling_frame is the model'),
        (frame("rocking_frame", PIER | dict(length_m=0.4), SLAB), "must be no longer than wide"),
        (
            frame("wobbling_frame", PIER | dict(copies_m=AROUND), SLAB),
            "needs round columns without flange and cap",
        ),
        (frame("podium", PIER, SLAB), 'needs storeys on the columns; "slab" is a slab'),
        (
            frame("rocking_frame", PIER | dict(copies_m=[[0.3, 0, 0], [0.9, 0, 0]]), SLAB),
            "both sides",
        ),
        (frame("rocking_frame", PIER | dict(copies_m=[[0, 0, 0]]), SLAB), "both sides"),
        (frame("wobbling_frame", POST | dict(copies_m=AROUND[::2]), SLAB), "not in a line"),
        (
            frame("wobbling_frame", POST | dict(copies_m=[*AROUND[:2], [-0.2, 0, 0]]), SLAB),
            "outside of",
        ),
        (
            case("housner", dict(body=BLOCK | dict(foot_radius_m=2.0)), FOOT),
            "bodies.body.foot_radius_m = 2.0: must be left out",
        ),
        (
            case("housner", dict(body=BLOCK), FOOT, contact=dict(restitution=0.5)),
            "contact.restitution = 0.5: must be left out",
        ),
    ],
)
def test_bodies_of_another_geometry_are_refused_with_the_reason(made, told):
    for read in (
        lambda: model_of(made, "case.toml"),
        lambda: check_analysis(case_from_tables(made.tables(), "case.toml"), "case.toml"),
    ):
        with pytest.raises(InputError, match="integration.engine|foot_radius|restitution") as one:
            read()
        assert told in str(one.value)


@pytest.mark.parametrize(
    "tables, told",
    [
        (dict(grounds=dict(ground=dict(kind="pad", stiffness_n_m3=1e7))), "grounds.ground.kind"),
        (
            dict(
                grounds=dict(ground=dict(motion=dict(source="lick:2"))),
                motion=dict(source="lick:1"),
            ),
            "grounds.ground.motion.source",
        ),
        (dict(joints=dict(foot=FOOT["foot"] | dict(stiffness_n_m3=1e7))), "joints.foot.stiff"),
    ],
)
def test_grounds_and_pads_that_a_model_does_not_know_are_refused(tables, told):
    with pytest.raises(InputError, match=told):
        made = dict(bodies=dict(body=BLOCK), joints=FOOT) | tables
        model_of(case("housner", **made), "case.toml")


def test_columns_of_a_model_start_alike():
    leaning = dict(tilt_rad=0.02, direction_deg=180.0)
    start = start_of(frame("rocking_frame", PIER, SLAB, initial=dict(body=leaning)), "")
    assert (start.tilt_rad, start.direction_deg) == (0.02, 180.0)
    for initial, told in (
        ({"body 1": leaning}, "needs one start for all"),
        (dict(slab=leaning), "starts upright"),
        (dict(body=dict(spin_rad_s=[0.0, 0.1, 0.0])), "must be 0 where integration.engine"),
    ):
        with pytest.raises(InputError, match=told):
            start_of(frame("rocking_frame", PIER, SLAB, initial=initial), "")


@pytest.mark.parametrize("between", [["body", "floor"], ["floor", "body"]])
@pytest.mark.parametrize("kind", ["rigid", "plate", "unbounded"])
def test_the_ground_may_have_any_name(between, kind):
    joints = dict(foot=dict(between=between, friction_coefficient=0.3))
    named = case("housner", dict(body=BLOCK), joints, grounds=dict(floor=dict(kind=kind)))
    stands = case("housner", dict(body=BLOCK), FOOT, contact=dict(friction_coefficient=0.3))
    assert repr(model_of(named, "case.toml")) == repr(model_of(stands, "case.toml"))


@pytest.mark.parametrize("of", [dict(bodies=dict(body=BLOCK), joints=FOOT), dict(column={})])
def test_keys_of_a_table_that_is_passed_over_are_checked(of):
    plan = dict(engine="reduced", duration_s=1.0)
    with pytest.raises(InputError, match="block.foo = 1: unknown key"):
        case_from_tables(of | dict(block=dict(foo=1), integration=plan), "case.toml")


@pytest.mark.parametrize(
    "changes, told",
    [
        ({"bodies.slab.at_m": [0.0, 0.0, 2.1]}, "lies on all columns"),
        ({"bodies.slab.at_m": [9.0, 0.0, 1.6]}, 'is beside "slab"'),
        ({"bodies.body.copies_m": [[-1.0, 0.0, 0.4], [1.0, 0.0, 0.4]]}, "the ground is at 0 m"),
        ({"bodies.body.copies_m": [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.4]]}, "the ground is at 0 m"),
    ],
)
def test_a_frame_whose_bodies_do_not_stand_on_one_another_is_refused(changes, told):
    with pytest.raises(InputError, match=told):
        model_of(frame("rocking_frame", PIER, SLAB).replace(changes), "case.toml")


def test_a_block_in_the_air_is_refused():
    made = case("housner", dict(body=BLOCK | dict(at_m=[0.0, 0.0, 0.5])), FOOT)
    with pytest.raises(InputError, match=r"drawn at z = 0.5 m, the ground is at 0 m"):
        model_of(made, "case.toml")


@pytest.mark.parametrize(
    "key, value",
    [
        ("output.fields_every_s", 0.1),
        ("joints.foot.rolling_resistance", 0.02),
    ],
)
@pytest.mark.parametrize("engine", ["housner", "wobbling"])
def test_what_a_rigid_model_does_not_know_is_refused_by_its_key(engine, key, value):
    body = BLOCK if engine == "housner" else DRUM
    made = case(engine, dict(body=body), FOOT)
    with pytest.raises(InputError, match=key.replace(".", r"\.")):
        model_of(made.replace({key: value}), "case.toml")


@pytest.mark.parametrize("engine, slab", [("rocking_frame", SLAB), ("podium", STOREYS)])
@pytest.mark.parametrize(
    "plate",
    [
        dict(cap=dict(length_m=0.4, width_m=0.4, thickness_m=0.5)),
        dict(flange=dict(outer_diameter_m=0.8, thickness_m=0.2)),
    ],
)
def test_columns_of_a_frame_with_plates_are_refused(engine, slab, plate):
    """The model has the height and the foot of a plain block."""
    ((name, one),), on = plate.items(), 1.6
    top = on + one["thickness_m"]
    period = dict(period_s=0.3) if engine == "podium" else {}
    bodies = dict(body=PIER | {name: one}, slab=slab | period | dict(at_m=[0, 0, top]))
    made = case(engine, bodies, FRAME)
    with pytest.raises(InputError, match=rf"bodies.body.{name}.thickness_m .* must be left out"):
        model_of(made, "case.toml")


def test_a_way_that_is_no_overturning_is_refused_as_of_structures():
    """0.1 mm of 1 m: of a block of its own table and of bodies."""
    table = dict(block=dict(width_m=0.4, height_m=1.6), integration=dict(duration_s=1.0))
    for made in (case("housner", dict(body=BLOCK), FOOT), case_from_tables(table)):
        with pytest.raises(InputError, match=r"overturn.displacement_m .* 0.0001 of the height"):
            model_of(made.replace({"overturn.displacement_m": 1.4e-4}), "case.toml")
        model_of(made.replace({"overturn.displacement_m": 2e-4}), "case.toml")


def test_a_fixed_body_of_a_frame_is_refused():
    made = frame("rocking_frame", PIER, SLAB | dict(fixed=True))
    with pytest.raises(InputError, match="bodies.slab.fixed = True: must be false"):
        model_of(made, "case.toml")


def test_columns_that_lean_across_the_plane_of_a_frame_are_refused():
    made = frame("rocking_frame", PIER, SLAB, initial=dict(body=dict(tilt_rad=0.03)))
    start_of(made, "case.toml")
    with pytest.raises(InputError, match="must be 0 or 180"):
        start_of(made.replace({"initial.body.direction_deg": 90.0}), "case.toml")


def test_a_body_that_is_not_alike_about_its_axis_does_not_wobble():
    aside = case("wobbling", dict(body=DRUM | dict(centre_m=[0.05, 0.0, 0.8])), FOOT)
    with pytest.raises(InputError, match="it is 0.05 m beside it"):
        model_of(aside, "case.toml")
    unlike = case("wobbling", dict(body=DRUM | dict(inertia_kg_m2=[90.0, 120.0, 40.0])), FOOT)
    with pytest.raises(InputError, match="alike about its axis"):
        model_of(unlike, "case.toml")


@pytest.mark.parametrize("engine", ["housner", "wobbling", "reduced"])
def test_a_plate_that_gives_is_told_where_a_model_takes_it_as_rigid(engine, recwarn):
    """W h / (E I / t) of a drum 0.4 m wide and 1.6 m high on 30 mm of rubber, by hand."""
    for modulus in (2e9, 2e6):
        plate = dict(kind="plate", thickness_m=0.03, youngs_modulus_pa=modulus)
        found = case_from_tables(
            dict(
                bodies=dict(body=DRUM),
                grounds=dict(shelf=plate),
                joints=dict(foot=dict(between=["body", "shelf"])),
                contact=dict(friction_coefficient=0.4),
                initial=dict(body=dict(tilt_rad=0.05)),
                integration=dict(dt_s=1e-3, duration_s=1.0, engine=engine),
            ),
            "case.toml",
        )
        if engine != "reduced":
            model_of(found, "case.toml")
    told = [str(one.message) for one in recwarn if "takes it as rigid" in str(one.message)]
    if engine == "reduced":
        assert not told
        return
    weight = 2700 * np.pi * 0.2**2 * 1.6 * GRAVITY
    percent = 100 * weight * 0.8 * 0.03 / (2e6 * np.pi * 0.2**4 / 4)
    assert len(told) == 1 and f"{percent:.2g} %" in told[0] and "grounds.shelf" in told[0]


@pytest.mark.parametrize("engine", ["housner", "wobbling"])
@pytest.mark.parametrize("key", ["bodies.body.damping_ratio", "materials.stone.damping_ratio"])
def test_a_rigid_model_passes_over_the_damping_of_elastic_modes(engine, key):
    """As over Young's modulus, so that one file serves all engines."""
    body = (BLOCK if engine == "housner" else DRUM) | dict(material="stone")
    made = case(engine, dict(body=body), FOOT, materials=dict(stone=dict(damping_ratio=0.0)))
    damped = made.replace({key: 0.05})
    found, exact = (model_of(one, "case.toml").describe() for one in (damped, made))
    assert found == exact


@pytest.mark.parametrize("engine, column", [("rocking_frame", PIER), ("wobbling_frame", POST)])
@pytest.mark.parametrize(
    "key, value", [("centre_m", [0.05, 0.0, 0.7]), ("inertia_kg_m2", [60.0, 60.0, 3.0])]
)
def test_frames_refuse_where_the_mass_of_a_column_is(engine, column, key, value):
    """They know the mass alone: a weighed centre would be passed over."""
    weighed = frame(engine, column | {key: value}, SLAB)
    with pytest.raises(InputError, match=f"bodies.body.{key} = .*must be left out"):
        model_of(weighed, "case.toml")
