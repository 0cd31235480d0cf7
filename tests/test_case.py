"""A case's id names what is computed: content, not place."""

import dataclasses
import shutil
import warnings
from pathlib import Path

import pytest

from fecolumn.case.case import case_from_tables, load_case
from fecolumn.case.case_tables import type_of
from fecolumn.case.joint import Joint
from fecolumn.case.order import chosen_by_order
from fecolumn.case.sections import DEFAULT
from fecolumn.case.short_form import finished
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.specimen import specimen_mesh

SPECIMEN = Path("meshes/stout.toml").resolve()
YOUNGER = {
    ("material", "damping_ratio"): 0.02,
    ("contact", "restitution"): 0.5,
    ("contact", "rolling_resistance"): 1e-3,
    ("initial", "velocity_m_s"): [0.1, 0.0, 0.0],
    ("initial", "spin_rad_s"): [0.0, 0.0, 1.0],
}


def _folder(path, acceleration="0.1"):
    path.mkdir()
    (path / "motion.csv").write_text(f"time [s],ax [g]\n0,0\n0.01,{acceleration}\n0.02,0\n")
    (path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n[motion]\nsource = "motion.csv"\n')
    return path


def test_id_outlives_a_move_and_sees_a_changed_motion(tmp_path):
    here = _folder(tmp_path / "here")
    first = load_case(here / "case.toml").id
    shutil.copytree(here, tmp_path / "there")
    assert load_case(tmp_path / "there" / "case.toml").id == first
    assert load_case(_folder(tmp_path / "changed", "0.2") / "case.toml").id != first


def test_id_ignores_title_and_output_but_no_number(tmp_path):
    folder = _folder(tmp_path / "case")
    file = folder / "case.toml"
    first, text = load_case(file).id, file.read_text()
    file.write_text('title = "other"\n' + text + "[output]\nhistory_every_s = 0.1\n")
    assert load_case(file).id == first
    file.write_text(text + "[contact]\nfriction_coefficient = 0.31\n")
    assert load_case(file).id != first


def test_ids_of_the_specimens_stay():
    """Sizes that are stated are taken as stated; keys that came later say nothing at their
    default.
    """
    assert [load_case(SPECIMEN.with_name(name)).id for name in ("specimen.toml", "stout.toml")] == [
        "25ab2f2f1c54",
        "0e77740b1867",
    ]


@pytest.mark.parametrize("name", ["specimen", "stout", "trilith", "two_blocks", "temple_column"])
def test_the_full_form_is_the_same_case(tmp_path, capsys, name):
    """`fecolumn show` prints a file that has the same id, with keys at their defaults and without;
    both forms take the same changes.
    """
    file = SPECIMEN.with_name(f"{name}.toml")
    case = load_case(file)
    for options in ([], ["--all"]):
        assert main(["show", str(file), *options]) == 0
        (tmp_path / "full.toml").write_text(capsys.readouterr().out)
        full = load_case(tmp_path / "full.toml")
        assert full == case and full.id == case.id and full.short is None
    change = {"contact.friction_coefficient": 0.41}
    assert full.replace(change) == case.replace(change)


def test_joints_of_earlier_versions_are_read_by_their_name_then():
    tables = load_case(SPECIMEN.with_name("two_blocks.toml")).tables()
    older = {("interfaces" if name == "joints" else name): one for name, one in tables.items()}
    case = case_from_tables(older, "case.toml")
    assert case == case_from_tables(tables, "case.toml")
    name = next(iter(case.joints))
    changed = case.replace({f"interfaces.{name}.friction_coefficient": 0.4})
    assert changed.joints[name].friction_coefficient == 0.4
    older["interfaces"] = {name: {"between": ["absent", "ground"]}}
    with pytest.raises(InputError, match=f"interfaces.{name}.*no such body"):
        case_from_tables(older, "case.toml")


def test_an_older_name_is_said_once_with_the_one_to_write(tmp_path, capsys):
    tables = load_case(SPECIMEN.with_name("two_blocks.toml")).tables()
    case = case_from_tables(tables, tmp_path / "older.toml")
    text = case.to_toml().replace("[joints", "[interfaces")
    (tmp_path / "older.toml").write_text(text)
    told = f"{tmp_path / 'older.toml'}: [interfaces] is an older name of [joints]"
    with pytest.warns(DeprecationWarning) as caught:
        assert load_case(tmp_path / "older.toml") == case
        assert load_case(tmp_path / "older.toml") == case
    assert [str(one.message).startswith(told) for one in caught] == [True]
    with pytest.warns(DeprecationWarning, match="case: interfaces.x.law .* write joints.x.law"):
        type_of("interfaces.x.law")
    (tmp_path / "another.toml").write_text(text)
    assert main(["show", str(tmp_path / "another.toml")]) == 0
    assert capsys.readouterr().err.count("is an older name of [joints]") == 1


def test_bodies_of_a_joint_by_their_names_of_earlier_versions(tmp_path):
    case = load_case(SPECIMEN.with_name("two_blocks.toml"))
    text = case.to_toml()
    for joint in case.joints.values():
        newer = f'between = [\n    "{joint.slave}",\n    "{joint.on}",\n]'
        assert newer in text
        text = text.replace(newer, f'slave = "{joint.slave}"\non = "{joint.on}"')
    (tmp_path / "older.toml").write_text(text)
    told = "older.toml: slave with on is an older name of between, read until 2.0"
    with pytest.warns(DeprecationWarning, match=told):
        older = load_case(tmp_path / "older.toml")
    assert older == case and older.id == case.id
    with pytest.warns(DeprecationWarning, match="script: slave with on"):
        joint = Joint(slave="drum", on="ground")
    assert joint == Joint(between=("drum", "ground")) and "slave" not in repr(joint)
    with pytest.raises(InputError, match="Joint.on: missing; or give Joint.between"):
        Joint(slave="drum")


def test_a_result_of_an_earlier_version_is_read_without_a_word_on_its_names(tmp_path):
    case = load_case(SPECIMEN.with_name("two_blocks.toml"))
    tables = case.tables()
    for table in tables["joints"].values():
        table["slave"], table["on"] = table.pop("between")
        table["between"] = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert case_from_tables(tables, tmp_path / "case.json").id == case.id


def test_a_case_of_the_short_form_takes_keys_of_both():
    case = load_case(SPECIMEN)
    taller = case.replace({"column.height_m": 1.2})
    assert taller.bodies["column"].height_m == 1.2 and taller.short
    full = case.replace({"bodies.column.height_m": 1.2})
    assert full == taller and not full.short
    tilted = case.replace({"initial.tilt_rad": 0.01})
    assert tilted == case.replace({"initial.column.tilt_rad": 0.01})
    other = dataclasses.replace(case, contact=dataclasses.replace(case.contact, law="penalty"))
    assert other.short is None and read_back(other) == other


def read_back(case):
    return case_from_tables(case.as_stated(), "case.json")


def test_messages_of_the_short_form_name_its_own_keys(tmp_path):
    """Those of what no single key can know, too."""
    (tmp_path / "case.toml").write_text(
        f'extends = "{SPECIMEN}"\n[mesh]\nlimit_dofs = 1000\n[flange]\nouter_diameter_m = 0.05\n'
        "thickness_m = 0.01\n"
    )
    with pytest.raises(InputError) as refusal:
        load_case(tmp_path / "case.toml")
    assert refusal.value.key == "flange.outer_diameter_m"


@pytest.mark.parametrize(
    "lines, words",
    [
        ("stiffness_n_m3 = 1e8", ["base.stiffness_n_m3 = 100000000.0", "is of a pad", "'plate'"]),
        (
            'damping_ratio = 0.1\nkind = "unbounded"',
            ["base.damping_ratio = 0.1", "is of a pad", "'unbounded'"],
        ),
        ('kind = "pad"', ["base.stiffness_n_m3", "must be greater than 0 N/m3"]),
        ('kind = "spring"', ["base.kind", "one of plate, unbounded, pad"]),
    ],
)
def test_keys_of_a_pad_belong_to_a_pad_and_a_pad_needs_its_stiffness(tmp_path, lines, words):
    file = _folder(tmp_path / "case") / "case.toml"
    file.write_text(file.read_text() + f"[base]\n{lines}\n")
    with pytest.raises(InputError) as refusal:
        load_case(file)
    assert all(word in str(refusal.value) for word in words)


def test_unbounded_base_needs_no_room_for_the_foot(tmp_path):
    file = _folder(tmp_path / "case") / "case.toml"
    text = file.read_text() + "[base]\nlength_m = 0.05\n"
    file.write_text(text)
    with pytest.raises(InputError, match="base.length_m"):
        load_case(file)
    file.write_text(text + 'kind = "unbounded"\n')
    assert len(specimen_mesh(load_case(file).short).base.cells) == 0


@pytest.mark.parametrize("section, key", YOUNGER)
def test_a_key_younger_than_the_first_studies_makes_another_case_where_it_is_set(
    tmp_path, section, key
):
    first = load_case(SPECIMEN).id
    value = YOUNGER[section, key]
    (tmp_path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n[{section}]\n{key} = {value}\n')
    assert load_case(tmp_path / "case.toml").id != first
    nothing = [0.0] * 3 if isinstance(value, list) else 0.0
    (tmp_path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n[{section}]\n{key} = {nothing}\n')
    assert load_case(tmp_path / "case.toml").id == first


@pytest.mark.parametrize(
    "text, key",
    [
        ("[contact]\nrestitution = 1.1", "contact.restitution"),
        ("[material]\ndamping_ratio = -0.1", "material.damping_ratio"),
        ("[contact]\nrolling_resistance = 0.5", "contact.rolling_resistance"),
        ("[initial]\nspin_rad_s = [0, 1]", "initial.spin_rad_s"),
        ("[initial]\nvelocity_m_s = 1", "initial.velocity_m_s"),
        (
            '[contact]\nimpact = "none"\nrestitution = 0.5\n[integration]\nengine = "full"',
            "contact.restitution",
        ),
        (
            '[integration]\nengine = "full"\nkinematics = '
            '"total_lagrangian"\n[material]\ndamping_ratio = 0.02',
            "material.damping_ratio",
        ),
    ],
)
def test_losses_and_starts_that_cannot_be_are_refused_by_name(tmp_path, text, key):
    (tmp_path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n{text}\n')
    with pytest.raises(InputError, match=key):
        load_case(tmp_path / "case.toml")


@pytest.mark.parametrize("engine", ["reduced", "rigid"])
@pytest.mark.parametrize("key, value", [("tolerance", 1e-9), ("max_iterations", 40)])
def test_keys_that_an_engine_would_ignore_are_refused_with_what_to_do(tmp_path, engine, key, value):
    def case(text):
        (tmp_path / "case.toml").write_text(
            f'extends = "{SPECIMEN}"\n[integration]\nengine = "{engine}"\n{text}\n'
        )
        return load_case(tmp_path / "case.toml")

    with pytest.raises(
        InputError,
        match=rf"case.toml: integration.{key} = {value}: has no effect where "
        rf"integration.engine = '{engine}'.*leave it out",
    ):
        case(f"{key} = {value}")
    assert case(f"{key} = {DEFAULT[key]}").id == case("").id


def test_a_block_has_no_rim_to_resist_rolling(tmp_path):
    block = Path("fecolumn/case/templates/block.toml").resolve()
    (tmp_path / "case.toml").write_text(
        f'extends = "{block}"\n[contact]\nrolling_resistance = 1e-3\n'
    )
    with pytest.raises(InputError, match="contact.rolling_resistance.*only a round foot rolls"):
        load_case(tmp_path / "case.toml")


@pytest.mark.parametrize(
    "column",
    [
        'shape = "solid"\nouter_diameter_m = 0.5\nheight_m = 1.6',
        'shape = "block"\nlength_m = 0.4\nwidth_m = 0.3\nheight_m = 1.2',
        "outer_diameter_m = 0.02\nwall_m = 0.0015\nheight_m = 0.15",
    ],
)
def test_finishing_a_finished_case_changes_nothing(tmp_path, column):
    (tmp_path / "case.toml").write_text(f"[column]\n{column}\n")
    case = load_case(tmp_path / "case.toml")
    assert finished(case.short, "case.toml") == case.short


def _two_blocks(names, heights=(0.6, 0.6), **others):
    bodies = {
        "a": dict(kind="block", length_m=0.2, width_m=0.2, height_m=heights[0]),
        "b": dict(kind="block", length_m=0.2, width_m=0.2, height_m=heights[1], at_m=[2.0, 0, 0]),
    }
    joints = {f"under_{name}": dict(between=[name, others.get(name, "ground")]) for name in names}
    tables = dict(bodies={name: bodies[name] for name in names}, joints=joints)
    tables |= {key: value for key, value in others.items() if key not in bodies}
    return case_from_tables(tables | {"motion": dict(source="lick:1")})


def test_an_id_knows_which_of_equally_high_bodies_is_observed():
    first, other = _two_blocks("ab"), _two_blocks("ba")
    assert first.id != other.id and first != other
    assert chosen_by_order(first) == {}  # ids of earlier versions stay
    named = _two_blocks("ab", observed="b"), _two_blocks("ba", observed="b")
    assert named[0].id == named[1].id and named[0] == named[1]
    apart = _two_blocks("ab", (0.6, 0.7)), _two_blocks("ba", (0.6, 0.7))
    assert apart[0].id == apart[1].id and apart[0] == apart[1]


def test_an_id_knows_the_ground_to_which_displacements_are_relative():
    grounds = {"east": {}, "west": dict(motion=dict(source="lick:2"))}
    made = [
        _two_blocks("ab", (0.6, 0.7), a="east", b="west", grounds={one: grounds[one] for one in on})
        for on in (("east", "west"), ("west", "east"))
    ]
    assert made[0].id != made[1].id and made[0] != made[1]
    assert chosen_by_order(made[0]) == {}
    assert chosen_by_order(made[1]) == {"first ground": "west"}


def test_none_removes_a_key_or_a_section_of_a_body():
    case = _two_blocks("ab").replace(
        {"bodies.a.cap": dict(length_m=0.3, width_m=0.3, thickness_m=0.1)}
    )
    assert case.replace({"bodies.a.cap": None}) == _two_blocks("ab")
    assert case.replace({"bodies.b.cap": None}) == case  # has none
    assert case.replace({"bodies.b.at_m": None, "motion.source": "lick:2"}).bodies["b"].at_m == (
        0.0,
        0.0,
        0.0,
    )
    for key in ("bodies.a.hat", "bodies.c.cap", "hat"):
        with pytest.raises(InputError, match=f"{key}.*no such key"):
            case.replace({key: None})
    column = load_case(SPECIMEN)
    assert column.short.cap and column.replace({"cap": None}).short.cap is None
    assert column.replace({"flange": None, "mesh.cap_size_m": None}).short.flange is None
