"""Wax, putty and mortar in joints: failed ones are plain, moving masters, energy, refusals;
closed forms are rows of `fecolumn verify -k devices`.
"""

import csv

import numpy as np
import pytest
from small_structures import block, stack, structure

from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.dynamics.link_law import damage_of
from fecolumn.engines.dynamics.links import LINK
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.pictures.figures.history_figures import history_figures
from fecolumn.simulation import check_analysis, run
from fecolumn.structures.structure import structure_model
from fecolumn.study.device_peaks import BOND_COLUMNS, peaks_of_bonds
from fecolumn.verification.structures_feet import columns_and_rows

WAX = dict(bond_tension_pa=3e4, bond_cohesion_pa=2.5e4, bond_stiffness_n_m3=5e7)
RIGID = dict(integration=dict(engine="rigid", dt_s=2e-4), contact=dict(interior_points=9))


def waxed(joint=None, **tables):
    """A rocking block on the ground on wax of these keys."""
    rocking = dict(
        joints=dict(foot=WAX | (joint or {})),
        initial=dict(block=dict(spin_rad_s=[0, 0.35, 0])),
    )
    return structure(**merge(merge(merge(block(), RIGID), rocking), tables))


def point(tension=3.0, cohesion=2.0, mu=0.5, energy=0.0):
    """Links of a point of area 1 with stiffnesses of 10 across and 4 along."""
    rows = np.zeros(2, LINK)
    rows["stiffness"], strength = [10.0, 4.0], np.array([tension, cohesion])
    rows["breaks"], rows["rubs"] = strength / rows["stiffness"], mu
    rows["fails"] = np.maximum(rows["breaks"], 2 * energy / strength)
    return rows.view(np.recarray)


@pytest.mark.parametrize(
    "opened, slipped, fails",
    [
        (0.299, 0.0, False),
        (0.301, 0.0, True),
        (0.0, 0.499, False),
        (0.0, 0.501, True),
        # 0.5 * 2 N of tension leave 1 N of shear
        (0.2, 0.249, False),
        (0.2, 0.251, True),
    ],
)
def test_a_brittle_point_fails_by_coulombs_criterion_with_a_tension_cut_off(opened, slipped, fails):
    normal, shear = point()
    assert interpreted(damage_of)(normal, shear, opened, slipped) == float(fails)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_point_that_softens_takes_its_fracture_energy_either_way(axis):
    energy, strength, stiffness = 2.0, (3.0, 2.0)[axis], (10.0, 4.0)[axis]
    normal, shear = point(energy=energy)
    ways = np.linspace(0, 1.05 * 2 * energy / strength, 20001)
    kept = 1 - np.array([interpreted(damage_of)(normal, shear, *np.eye(2)[axis] * w) for w in ways])
    stress = kept * stiffness * ways
    assert stress.max() == pytest.approx(strength, rel=1e-3)
    assert stress[-1] == 0.0 and ways[np.argmax(kept <= 0)] == pytest.approx(
        2 * energy / strength, rel=1e-3
    )
    taken = ((stress[1:] + stress[:-1]) * np.diff(ways) / 2).sum()
    assert taken == pytest.approx(energy, rel=1e-4)


def test_a_joint_that_has_failed_is_a_plain_one():
    """Bit for bit: what is broken pulls nothing."""
    drawn = dict(integration=dict(start="drawn"))
    none = dict.fromkeys(WAX, 0.0) | dict(bond_cohesion_pa=None)
    glued, plain = waxed(**drawn), waxed(none, **drawn)
    engines = [engine_of(case, structure_model(case), "small.toml") for case in (glued, plain)]
    engines[0].motion.ties["broken"], engines[0].motion.ties["damage"] = True, 1.0
    rows = [engine.advance(np.zeros((1500, 3)))[0] for engine in engines]
    width = rows[1].shape[1]
    np.testing.assert_array_equal(rows[0][:, :width], rows[1])
    assert np.ptp(rows[1][:, 0]) > 0.29


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
@pytest.mark.parametrize("energy", [0.0, 60.0])
def test_a_block_breaks_off_a_moving_block_and_the_energy_closes(engine, energy):
    more = dict(
        integration=dict(engine=engine, dt_s=2e-4, start="drawn"),
        contact=dict(interior_points=9),
        initial=dict(lower=dict(velocity_m_s=[0.4, 0, 0]), upper=dict(spin_rad_s=[0, 1.2, 0])),
    )
    tables = merge(stack(joints=dict(joint=WAX | dict(bond_fracture_energy_j_m2=energy))), more)
    columns, rows = columns_and_rows(structure(**tables), 0.3)
    (name,) = {one.split("/")[1] for one in columns if one.startswith("bond/")}
    failed, closure = columns[f"bond/{name}/failed"], columns["energy/closure"]
    assert (np.diff(failed) >= -1e-12).all() and failed[0] < failed[-1]
    moved = np.ptp(columns["energy/kinetic"])
    assert np.abs(closure - closure[0]).max() < 1e-12 * moved
    assert columns[f"bond/{name}/work"][-1] == pytest.approx(-columns["energy/links"][-1], rel=1e-9)
    assert columns[f"bond/{name}/work"][-1] > 0.01


def test_glue_holds_what_hangs_until_its_weight_is_too_much():
    def hanging(tension):
        return structure(
            bodies=dict(
                shelf=dict(kind="block", length_m=0.6, width_m=0.6, height_m=0.1, at_m=[0, 0, 1.0])
                | dict(fixed=True),
                lamp=dict(kind="block", length_m=0.2, width_m=0.2, height_m=0.3, at_m=[0, 0, 0.7])
                | dict(mass_kg=20.0, rigid=True),
            ),
            joints=dict(
                plate=dict(
                    between=["lamp", "shelf"], bond_tension_pa=tension, bond_stiffness_n_m3=5e7
                )
            ),
            **RIGID,
        )

    weight = 20.0 * 9.80665 / 0.04
    columns, _ = columns_and_rows(hanging(1.2 * weight), 0.02)
    stress = next(values for name, values in columns.items() if name.endswith("/stress"))
    assert stress.max() == pytest.approx(weight, rel=1e-6)
    sunk = -columns["body/lamp/displacement"][:, 2]
    np.testing.assert_allclose(sunk, weight / 5e7, rtol=1e-6)
    with pytest.raises(InputError, match="cannot rest.*bond_tension_pa"):
        structure_model(hanging(0.8 * weight))


@pytest.mark.long
def test_summary_history_figure_and_tables_tell_of_it(tmp_path):
    summary = run(waxed(), tmp_path / "run", quiet=True)
    ((name, bond),) = summary["bonds"].items()
    rows = read_history(tmp_path / "run" / "history.h5")
    assert name.startswith("foot") and 0 < bond["failed_share"] <= 1
    assert bond["tension_max_pa"] == rows[f"bond/{name}/stress"].max() <= 3e4
    assert bond["work_j"] == rows[f"bond/{name}/work"][-1] > 0
    first = rows["time"][np.argmax(rows[f"bond/{name}/failed"] > 0)]
    assert bond["first_failed_at_s"] == first > 0
    assert tmp_path / "run" / "bonds.png" in history_figures(tmp_path / "run")
    assert (tmp_path / "run" / "bonds.png").read_bytes().startswith(b"\x89PNG")
    ((row),) = peaks_of_bonds([summary, summary])
    told = dict(zip(BOND_COLUMNS, row))
    assert told["n"] == told["began"] == 2 and told["failed_share_50"] == bond["failed_share"]


@pytest.mark.long
def test_a_study_writes_a_table_and_a_section_of_glued_joints(tmp_path):
    from fecolumn.cli import main

    case, study = tmp_path / "case.toml", tmp_path / "study.toml"
    case.write_text(
        """
[bodies.vase]
kind = "block"
length_m = 0.1
width_m = 0.1
height_m = 0.45
mass_kg = 3.0
[joints.foot]
between = ["vase", "ground"]
bond_tension_pa = 2e4
bond_stiffness_n_m3 = 1e8
[motion]
source = "lick:1"
strong_part = [0.05, 0.3]
[integration]
engine = "rigid"
"""
    )
    study.write_text(
        'title = "wax"\ncase = "case.toml"\n[axes]\n"motion.source" = ["lick:1", "lick:2"]\n'
    )
    assert main(["study", str(study), "-o", str(tmp_path / "out"), "-j", "1"]) == 0
    with open(tmp_path / "out" / "bonds.csv", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert row["n"] == "2" and 0 <= float(row["failed_share_max"]) <= 1
    assert float(row["tension_max_pa"]) > 0
    assert main(["report", str(tmp_path / "out")]) == 0
    page = next((tmp_path / "out").rglob("*.html")).read_text(encoding="utf-8")
    assert "Glued joints" in page and "foot: vase on ground" in page


@pytest.mark.parametrize(
    "joint, said",
    [
        (dict(bond_tension_pa=-1.0), "joints.foot.bond_tension_pa"),
        (dict(bond_tension_pa=0.3), "must be at least 100 Pa.*0.3 MPa is 3e5"),
        (dict(bond_cohesion_pa=0.02), "joints.foot.bond_cohesion_pa.*at least 100 Pa"),
        (dict(bond_stiffness_n_m3=0.0), "greater than 0 N/m3 with bond_tension_pa"),
        (dict(bond_tension_pa=0.0), "says nothing without bond_tension_pa"),
        (
            dict(bond_fracture_energy_j_m2=5.0),
            "must be more than 15.62 J/m2, which the layer stores",
        ),
        (dict(friction_coefficient=0.9), "must be at most bond_cohesion_pa / friction_coefficient"),
        (dict(bond_stiffness_n_m3=1e12), "joints.foot.*needs steps of at most"),
        (dict(bond_stiffness_n_m3=float("nan")), "bond_stiffness_n_m3"),
    ],
)
def test_wrong_glue_is_refused_in_a_line(joint, said):
    with pytest.raises(InputError, match=said) as caught:
        case = waxed(joint)
        engine_of(case, structure_model(case), "small.toml")
    assert "\n" not in str(caught.value) and "small.toml" in str(caught.value)


def test_glue_that_is_almost_too_stiff_is_told_of_with_the_step_that_is_not():
    case = waxed(dict(bond_stiffness_n_m3=3e10))
    with pytest.warns(UserWarning, match="joints.foot: a layer of 3e.10 .* steps of 0.00018 s may"):
        engine_of(case, structure_model(case), "small.toml")


@pytest.mark.parametrize(
    "tables, said",
    [
        (dict(integration=dict(engine="full")), 'joints.foot.bond_tension_pa.*engine = "full"'),
        (dict(integration=dict(engine="housner")), "joints.foot.bond_tension_pa"),
        (
            dict(initial=dict(block=dict(tilt_rad=0.01, spin_rad_s=[0, 0, 0]))),
            "what leans has broken",
        ),
        (dict(bodies=dict(block=dict(foot_radius_m=3.0))), "dome of"),
    ],
)
def test_glue_where_it_cannot_be_is_refused_in_a_line(tables, said):
    with pytest.raises(InputError, match=said) as caught:
        case = waxed(**tables)
        check_analysis(case, "small.toml")
        engine_of(case, structure_model(case), "small.toml")
    assert "\n" not in str(caught.value)


def test_faces_that_begin_apart_are_not_glued():
    tables = stack(joints=dict(joint=WAX), bodies=dict(upper=dict(at_m=[0, 0, 0.81])))
    with pytest.raises(InputError, match="faces are apart"):
        structure_model(structure(**tables))
