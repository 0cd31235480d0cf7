"""A case made of classes is the case of its file, and teaches the keys."""

import copy
import dataclasses
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fecolumn
from fecolumn.case.bodies import BODY_KINDS
from fecolumn.case.case import case_from_tables, load_case
from fecolumn.case.case_tables import COMMON, NAMED
from fecolumn.case.short_form import ShortForm
from fecolumn.foundation.schema import InputError, Section
from fecolumn.foundation.toml_file import read_toml

ROOT = Path(__file__).parents[1]
FILES = sorted((ROOT / "meshes").glob("*.toml"))
LINKS = {
    "tendon": fecolumn.Tendon,
    "spring": fecolumn.Spring,
    "restrainer": fecolumn.Restrainer,
    "strut": fecolumn.Strut,
    "stop": fecolumn.GapStop,
    "dashpot": fecolumn.Dashpot,
    "friction": fecolumn.FrictionDamper,
}
SECTIONS = {
    name: getattr(fecolumn, name)
    for name in fecolumn.__all__
    if isinstance(getattr(fecolumn, name), type) and issubclass(getattr(fecolumn, name), Section)
}
DRUM = fecolumn.Cylinder(outer_diameter_m=0.5, height_m=1.6)
FOOT = fecolumn.Joint(between=("drum", "ground"))


def made_of(cls, table):
    """A section as a script makes it of the values of a table."""
    inner = {"flange": fecolumn.Flange, "cap": fecolumn.Cap, "motion": fecolumn.Motion}
    return cls(
        **{
            key: made_of(inner[key], value) if isinstance(value, dict) else value
            for key, value in table.items()
        }
    )


def scripted(tables):
    """The case of a file's tables, each made by its class."""
    found = {key: tables[key] for key in ("title", "observed") if key in tables}
    found |= {key: made_of(COMMON[key], tables[key]) for key in COMMON if key in tables}
    for name, cls in NAMED.items():
        found[name] = {}
        for key, table in tables.get(name, {}).items():
            kind = {"bodies": BODY_KINDS, "links": LINKS}.get(name, {}).get(table.get("kind"), cls)
            voussoir = name == "bodies" and "kind" not in table
            found[name][key] = table if voussoir else made_of(kind, table)
    if not found["grounds"]:
        del found["grounds"]
    return fecolumn.Case(**found)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_case_made_of_classes_is_that_of_its_file(file, monkeypatch):
    monkeypatch.chdir(file.parent)
    tables, case = read_toml(file), load_case(file)
    if "column" in tables:
        sections = {
            key: table if isinstance(table, str) else made_of(_of_short_form(key), table)
            for key, table in tables.items()
        }
        made = fecolumn.Case.of_column(fecolumn.ShortForm(**sections))
        assert made.short == case.short
    else:
        tables = {name: table for name, table in tables.items() if name not in ("podium",)}
        case = case_from_tables(tables, file)
        made = scripted(tables)
    assert made == case and made.id == case.id


def _of_short_form(key):
    field = next(one for one in dataclasses.fields(ShortForm) if one.name == key)
    return SECTIONS.get("MeshSizes" if key == "mesh" else field.type.partition(" ")[0])


@pytest.mark.parametrize("full", [False, True], ids=["as stated", "full"])
@pytest.mark.parametrize("defaults", [False, True], ids=["short", "with defaults"])
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_toml_of_a_case_is_that_case(file, full, defaults, tmp_path):
    case = load_case(file)
    path = tmp_path / "again.toml"
    path.write_text(case.to_toml(full=full, defaults=defaults))
    again = load_case(path)
    assert again == case and again.id == case.id
    assert bool(again.short) == (bool(case.short) and not full)


def test_an_arch_has_its_voussoirs_and_one_of_them_keys_of_its_own():
    ring = fecolumn.Arch(mean_radius_m=5.0, thickness_m=1.0, width_m=1.0, voussoirs=7)
    bodies = {"ring": ring, "ring 1": {"fixed": True}, "ring 7": {"fixed": True}}
    joints = {"ring": fecolumn.Joint(between=("ring", "ring"))}
    case = fecolumn.Case(bodies=bodies, joints=joints)
    assert [body.fixed for body in case.bodies.values()] == [True, *5 * [False], True]
    assert case.tables(defaults=False)["bodies"]["ring 7"] == {"fixed": True}


WRONG = [
    (lambda: fecolumn.Block(length=1, width_m=1, height_m=1), "did you mean block.length_m?"),
    (lambda: fecolumn.Block(width_m=1, height_m=1), "block.length_m: missing; length along x"),
    (lambda: fecolumn.Block(1.0, 2.0, 3.0), "given by name, such as Block(length_m=...)"),
    (lambda: fecolumn.Block(length_m="1", width_m=1, height_m=1), "'1': must be a number"),
    (lambda: fecolumn.Block(length_m=[1], width_m=1, height_m=1), "[1]: must be a number"),
    (lambda: fecolumn.Block(length_m=-1, width_m=1, height_m=1), "greater than 0 and at most 100"),
    (lambda: dataclasses.replace(DRUM, height_m=-1), "cylinder.height_m = -1"),
    (lambda: fecolumn.Tube(outer_diameter_m=1, wall_m=0.1, height_m=1, cap={}), "a Cap(...)"),
    (lambda: fecolumn.Tendon(body="drum", to_point_m=(0, 0, 3), kind="spring"), "one of tendon"),
    (lambda: fecolumn.Tendon(to_point_m=(0, 0, 3)), "link.body: missing; body at one end, must"),
    (lambda: fecolumn.ShortForm(), "column: missing; must be a Column(...)"),
    (lambda: fecolumn.Case(), "bodies: missing"),
    (lambda: fecolumn.Case(bodies=[DRUM]), 'by name, such as {"NAME": Block(...)}'),
    (lambda: fecolumn.Case(bodies={"drum": FOOT}), "must be a body, such as Block(...)"),
    (lambda: fecolumn.Case(bodies={"drum": DRUM}), "joints: missing"),
    (lambda: fecolumn.Case(bodies={"a b": DRUM}, joints={"foot": FOOT}), "without blanks"),
    (lambda: fecolumn.Case(bodies={1: DRUM}, joints={"foot": FOOT}), "must be text in quotes"),
    (lambda: drum_with(joints={"foot": DRUM}), "must be a Joint(...)"),
    (lambda: drum_with(joints={"foot": fecolumn.Joint()}), "joint.between: missing"),
    (lambda: drum_with(joints={"f": fecolumn.Joint(between=("dum", "ground"))}), "mean drum?"),
    (lambda: drum_with(motion="lick:1"), "motion = 'lick:1': must be a Motion(...)"),
    (lambda: drum_with(integration={"dt_s": 1}), "must be an Integration(...)"),
    (lambda: drum_with(title=3), "title = 3: must be text in quotes"),
    (lambda: drum_with(bodies={"drum": fecolumn.MeshBody(mesh_file="no.stl")}), "no such file"),
    (lambda: drum_with(links={"t": fecolumn.Tendon(body="drum", to_point_m=(0, 0, 3))}), "N/m"),
    (lambda: fecolumn.case_from_tables([1]), "must be tables of keys, not list"),
    (lambda: fecolumn.case_from_tables({"bodies": {"a": {"kind": ["x"]}}}), "must be one of tube"),
]


def drum_with(**sections):
    """A drum on the ground with other sections."""
    return fecolumn.Case(**{"bodies": {"drum": DRUM}, "joints": {"foot": FOOT}} | sections)


@pytest.mark.parametrize("make, words", WRONG, ids=[words for _, words in WRONG])
def test_what_is_wrong_is_told_in_a_line_a_key(make, words):
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == len(caught.value.all)


@pytest.mark.parametrize("name", SECTIONS)
def test_help_tells_every_key_with_unit_and_default(name):
    cls = SECTIONS[name]
    words = cls.__doc__
    for field in dataclasses.fields(cls):
        assert f"\n{field.name} : " in words
        if field.metadata and field.metadata["unit"] != "-":
            entry = " ".join(words.partition(f"\n{field.name} : ")[2].split())
            assert f"[{field.metadata['unit']}]" in entry.partition(" : ")[0], field.name
    assert max(map(len, words.splitlines())) <= 100


def test_every_name_of_the_package_is_there_and_documented():
    for name in fecolumn.__all__:
        assert getattr(fecolumn, name).__doc__, name
    kinds = {name: made(body="a", to_point_m=(0, 0, 1)).kind for name, made in LINKS.items()}
    word = next(one for one in dataclasses.fields(fecolumn.Link) if one.name == "kind")
    assert kinds == {kind: kind for kind in word.metadata["choices"]}


def test_sections_print_what_was_given_and_travel():
    assert repr(DRUM) == "Cylinder(outer_diameter_m=0.5, height_m=1.6)"
    assert repr(FOOT) == "Joint(between=('drum', 'ground'))"
    assert copy.deepcopy(DRUM) == DRUM == pickle.loads(pickle.dumps(DRUM))
    text = repr(drum_with(motion=fecolumn.Motion("lick:1", scale=1.5)))
    assert "drum (cylinder)" in text and "lick:1 x 1.5" in text and len(text.splitlines()) < 8


TYPED = """import fecolumn

case = fecolumn.Case(
    bodies={"drum": fecolumn.Cylinder(outer_diameter_m=0.5, height_m=1.6)},
    joints={"foot": fecolumn.Joint(between=("drum", "ground"))},
    links={"wire": fecolumn.Tendon(body="drum", to_point_m=(0, 0, 3), stiffness_n_m=1e5)},
    contact=fecolumn.Contact(between="all"),
    integration=fecolumn.Integration(dt_s="auto"),
)
text: str = case.to_toml()
fecolumn.Cylinder(outer_diameter=0.5, height_m=1.6)  # wrong
fecolumn.Cylinder(height_m=1.6)  # wrong
fecolumn.Block(length_m=[1.0], width_m=1, height_m=2)  # wrong
fecolumn.Case(bodies=[1])  # wrong
fecolumn.Case(motion="lick:1")  # wrong
fecolumn.run_study(case, "x", axes=3)  # wrong
fecolumn.design(case, "x", vary="width", motions="lick:1", limit="")  # wrong
"""


def test_a_type_checker_knows_keys_and_types(tmp_path):
    if not np.__version__.startswith("1."):
        pytest.skip("types are checked with the NumPy of Debian 12")
    (tmp_path / "script.py").write_text(TYPED)
    words = "--strict --follow-imports=silent --ignore-missing-imports --no-incremental script.py"
    mypy = Path(sys.executable).with_name("mypy")
    done = subprocess.run(
        [str(mypy), *words.split()],
        cwd=tmp_path,
        env={**os.environ, "MYPYPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    told = {int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line}
    lines = TYPED.splitlines()
    wrong = {number for number, line in enumerate(lines, 1) if line.endswith("# wrong")}
    assert told == wrong, done.stdout + done.stderr


def test_the_file_of_a_rocking_model_states_what_was_stated(tmp_path):
    tables = {"block": {"width_m": 0.3, "height_m": 1.0}, "integration": {"duration_s": 1.0}}
    case = fecolumn.case_from_tables(tables)
    (tmp_path / "block.toml").write_text(case.to_toml())
    assert read_toml(tmp_path / "block.toml").keys() == {"block", "integration"}
    assert load_case(tmp_path / "block.toml") == case
    assert "block: Block" in repr(case)


def test_a_rocking_model_of_a_class_is_the_case_of_its_file():
    made = fecolumn.Case.of_model(
        fecolumn.FrameModel(width_m=0.3, height_m=1.8, column_mass_kg=400, beam_mass_kg=900),
        motion=fecolumn.Motion("lick:1"),
        integration=fecolumn.Integration(dt_s=0.002),
        initial=fecolumn.Initial(tilt_rad=0.01),
        title="bent",
    )
    tables = {
        "title": "bent",
        "frame": {"width_m": 0.3, "height_m": 1.8, "column_mass_kg": 400, "beam_mass_kg": 900},
        "motion": {"source": "lick:1"},
        "integration": {"dt_s": 0.002},
        "initial": {"tilt_rad": 0.01},
    }
    assert made == case_from_tables(tables) and made.id == case_from_tables(tables).id
    assert "column_mass_kg" in fecolumn.FrameModel.__doc__ + str(
        dataclasses.fields(fecolumn.FrameModel)
    )


@pytest.mark.parametrize(
    "make, said",
    [
        (lambda: fecolumn.WobblingFrameModel(height_m=1.0), "wobbling_frame.slab_mass_kg: missing"),
        (lambda: fecolumn.Case.of_model(DRUM), "must be a BlockModel, FrameModel"),
        (
            lambda: fecolumn.Case.of_model(
                fecolumn.BlockModel(width_m=0.3, height_m=1.0), motion="lick:1"
            ),
            "motion = 'lick:1': must be a Motion",
        ),
        (
            lambda: fecolumn.Case.of_model(
                fecolumn.BlockModel(width_m=0.3, height_m=1.0),
                integration=fecolumn.Integration(engine="rigid"),
            ),
            "must be housner",
        ),
    ],
)
def test_what_does_not_fit_a_rocking_model_is_refused_in_words(make, said):
    with pytest.raises(InputError, match=said):
        make()
