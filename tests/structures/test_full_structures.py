"""Structures in full order from case to result files: the same columns and motion as the reduced
engine, closed energy, fields, interrupted runs, studies.
"""

import json
import warnings

import h5py
import numpy as np
import pytest
from mpi4py import MPI
from small_structures import STONE, structure

from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.dynamics.stay import StickOperatorCache
from fecolumn.engines.elements import structure_of_elements
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import read_folder_case, run

# As in tests/dynamics: by which the engines may part with all modes, displacement [m] and tilt
# [rad]
AGREES = 2e-7
BRICKS = dict(kind="block", element_size_m=0.2, coarse_size_m=0.4) | STONE
# a light block that leans on a heavy one, and comes to lean the other way by an impact
LEANING = dict(
    bodies=dict(
        lower=BRICKS | dict(length_m=0.6, width_m=0.6, height_m=0.5),
        upper=BRICKS
        | dict(length_m=0.3, width_m=0.3, height_m=0.9, element_size_m=0.15, at_m=[0, 0, 0.5]),
    ),
    joints=dict(foot=dict(between=["lower", "ground"]), joint=dict(between=["upper", "lower"])),
    initial=dict(upper=dict(tilt_rad=0.06)),
    contact=dict(friction_coefficient=0.7, interior_points=0),
    integration=dict(engine="full", dt_s=1e-3, duration_s=0.3),
    output=dict(fields_every_s=0.15),
)
QUIET = dict(output=dict(fields_every_s=0.0))


def made(folder, **changes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of a checkpoint that cannot be used, for example
        return run(structure(**merge(LEANING, changes)), folder, quiet=True), read_history(
            folder / "history.h5"
        )


@pytest.fixture(scope="module")
def leaning(tmp_path_factory):
    folder = tmp_path_factory.mktemp("leaning") / "run"
    return folder, *made(folder)


def test_full_order_writes_the_columns_and_the_summary_of_the_reduced_engine(leaning, tmp_path):
    _, summary, rows = leaning
    other, others = made(
        tmp_path / "reduced", integration=dict(engine="reduced", n_modes=1000), **QUIET
    )
    assert set(rows) == set(others) and {name: values.shape for name, values in rows.items()} == {
        name: values.shape for name, values in others.items()
    }
    assert set(summary) == set(other) and set(summary["interfaces"]) == set(other["interfaces"])
    assert rows["tilt"][0] == pytest.approx(0.06, rel=1e-6) and rows["tilt"].min() < 5e-3
    for name in (
        "u_top",
        "tilt",
        "body/upper/displacement",
        "body/lower/tilt",
        "interface/joint: upper on lower/tilt",
        "interface/joint: upper on lower/rise",
    ):
        np.testing.assert_allclose(rows[name], others[name], rtol=0, atol=AGREES, err_msg=name)
    # what a landing point carries within one step is 1e-2 of what it has carried
    np.testing.assert_allclose(
        rows["interface/foot: lower on ground/force"][:100],
        others["interface/foot: lower on ground/force"][:100],
        rtol=1e-3,
    )
    assert summary["bodies"]["upper"]["tilt_max_rad"] == pytest.approx(
        other["bodies"]["upper"]["tilt_max_rad"], abs=AGREES
    )
    assert summary["energy_left_j"] == pytest.approx(other["energy_left_j"], rel=1e-3)


def test_total_lagrangian_bodies_move_as_corotated_ones(leaning, tmp_path):
    """The strain of marble is 1e-6."""
    _, _, rows = leaning
    end = dict(integration=dict(kinematics="total_lagrangian", duration_s=0.1))
    _, other = made(tmp_path / "run", **merge(end, QUIET))
    for name in ("u_top", "tilt", "body/lower/tilt"):
        np.testing.assert_allclose(other[name], rows[name][:101], rtol=0, atol=2e-6, err_msg=name)


def test_literal_hht_of_a_case_has_no_impacts(tmp_path):
    plan = dict(duration_s=0.05, substeps="none", alpha_hht=-0.1)
    summary, rows = made(tmp_path / "run", contact=dict(impact="none"), integration=plan, **QUIET)
    assert summary["impacts"] == 0 and rows["tilt"][-1] < rows["tilt"][0]
    size = np.ptp(rows["energy/gravity"])
    assert np.abs(rows["energy/closure"]).max() < 1e-5 * size


def test_energy_of_a_structure_in_full_order_is_accounted_for(leaning):
    _, summary, rows = leaning
    assert summary["impacts"] > 0 and summary["energy_closure_rel"] < 1e-9
    assert summary["contact_iterations"] > 0 and summary["impact_iterations"] > 0
    assert rows["energy/impact"][-1] < 0


def test_dofs_of_all_bodies_are_counted_and_copies_are_factored_once():
    places = [[-1.0, 0, 0], [1.0, 0, 0]]
    case = structure(
        bodies=dict(column=BRICKS | dict(length_m=0.3, width_m=0.3, height_m=0.9, copies_m=places)),
        joints=dict(feet=dict(between=["column", "ground"])),
        integration=dict(engine="full"),
    )
    model, meshed = structure_of_elements(case, MPI.COMM_SELF, "case")
    assert (
        len(model.parts) == 2
        and meshed[0] is meshed[1]
        and model.parts[0].model is model.parts[1].model
    )


def test_fields_show_all_bodies_and_where_they_press(leaning):
    folder, _, rows = leaning
    text = (folder / "fields" / "fields.xdmf").read_text()
    assert text.count("<Time") == 3 and 'Name="body"' in text
    with (
        h5py.File(folder / "fields" / "mesh.h5") as mesh,
        h5py.File(folder / "fields" / "frame_000000150000.h5") as frame,
    ):
        points, cells, body = mesh["points"][:], mesh["cells"][:], mesh["body"][:]
        moved, stress, pressure = (
            frame[name][:] for name in ("displacement", "von_mises", "pressure")
        )
    assert (
        set(body) == {1, 2}
        and len(stress) == len(cells)
        and len(moved) == len(points) == len(pressure)
    )
    upper = np.unique(cells[body == 2])
    top = upper[points[upper, 2] > points[:, 2].max() - 1e-9]
    # the mean over the face weighs corners less: they agree where it is plane
    middle = top[np.argmin(np.linalg.norm(points[top, :2], axis=1))]
    np.testing.assert_allclose(moved[middle], rows["u_top"][150], atol=1e-6)
    assert (
        set(np.flatnonzero(pressure > 0))
        <= set(np.flatnonzero(np.isclose(points[:, 2], 0.0) | np.isclose(points[:, 2], 0.5)))
        and pressure.max() > 1e4
    )
    assert 1e4 < stress.max() < 1e8


@pytest.mark.parametrize("aside", [0.0, 0.05, 0.1])
def test_pressure_between_equal_faces_carries_the_weight(aside, tmp_path):
    """Two equal blocks, one on the other or beyond its edge by up to a quarter, touch at points
    that are nodes of neither face, too: they come to rest, and the pressure at the nodes carries
    the weight.
    """
    same = BRICKS | dict(length_m=0.4, width_m=0.4, height_m=0.4)
    changes = dict(
        bodies=dict(lower=same, upper=same | dict(at_m=[aside, 0.0, 0.4])),
        contact=dict(interior_points=100),
        integration=dict(duration_s=0.002),
        output=dict(fields_every_s=0.002),
    )
    tables = {name: table for name, table in LEANING.items() if name != "initial"}
    run(structure(**merge(tables, changes)), tmp_path / "run", quiet=True)
    (*_, last) = sorted((tmp_path / "run" / "fields").glob("frame_*.h5"))
    with h5py.File(tmp_path / "run" / "fields" / "mesh.h5") as mesh, h5py.File(last) as frame:
        points, pressure = mesh["points"][:], frame["pressure"][:]
        cells, body = mesh["cells"][:], mesh["body"][:]
    force = 0.0
    for number, middle in ((1, 0.0), (2, aside)):
        own = np.unique(cells[body == number])
        face = own[np.isclose(points[own, 2], 0.4)]
        # a node stands for all of a face of the 0.2 x 0.2 m bricks, for a half, or for a quarter
        at_edge = np.isclose(np.abs(points[face, :2] - [middle, 0.0]), 0.2).sum(axis=1)
        force += pressure[face] @ (0.04 / 2.0**at_edge)
    weight = STONE["density_kg_m3"] * 0.4**3 * 9.80665
    assert force == pytest.approx(weight, rel=1e-3)


def test_interrupted_analysis_goes_on_to_the_same_motion(leaning, tmp_path):
    _, _, whole = leaning
    asked = []

    def stop():
        asked.append(0)
        return len(asked) == 120

    case = structure(**merge(LEANING, QUIET))
    with pytest.raises(KeyboardInterrupt):
        run(case, tmp_path / "run", quiet=True, stop=stop)
    again, file = read_folder_case(tmp_path / "run")
    assert again.id == case.id
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run(again, tmp_path / "run", file=file, quiet=True)
    rows = read_history(tmp_path / "run" / "history.h5")
    for name in ("u_top", "tilt", "body/lower/displacement"):
        np.testing.assert_allclose(rows[name], whole[name], rtol=0, atol=1e-10)
    assert len(rows["time"]) == 301


def test_standing_structure_keeps_its_stick_operator_through_an_interruption(tmp_path, monkeypatch):
    standing = merge(
        {name: table for name, table in LEANING.items() if name != "initial"},
        merge(
            QUIET,
            dict(
                initial=dict(upper=dict(velocity_m_s=[2e-3, 1e-3, 0.0])),
                integration=dict(duration_s=0.06),
            ),
        ),
    )
    asked = []

    def rows(name, **how):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run(structure(**standing), tmp_path / name, quiet=True, **how)
        return read_history(tmp_path / name / "history.h5")

    whole = rows("whole")
    with pytest.raises(KeyboardInterrupt):
        rows("broken", stop=lambda: asked.append(0) or len(asked) == 30)
    with np.load(tmp_path / "broken" / "checkpoint.npz") as kept:
        assert (
            kept["extra.stick.key"][1] == 1.0
            and np.abs(kept["extra.stick.factor.values"]).max() > 0
        )
    again = rows("broken")
    # found anew in each step instead
    monkeypatch.setattr(StickOperatorCache, "note", lambda self, poses, rims: None)
    without = rows("without")
    assert np.abs(whole["u_top"]).max() > 1e-6
    for name in ("u_top", "body/lower/displacement", "energy/strain"):
        np.testing.assert_array_equal(again[name], whole[name])
        np.testing.assert_allclose(
            without[name], whole[name], rtol=0, atol=1e-5 * np.abs(whole[name]).max()
        )


def test_block_that_is_tilted_too_far_overturns(tmp_path):
    summary, _ = made(
        tmp_path / "run",
        initial=dict(upper=dict(tilt_rad=0.5)),
        integration=dict(dt_s=5e-3, duration_s=2.0),
        **QUIET,
    )
    assert summary["outcome"] == "overturned" and '"upper" has tilted by' in summary["ended_by"]


@pytest.mark.parametrize(
    "body, key, told",
    [
        (dict(rigid=True), "bodies.upper.rigid", "must be false .* whose bodies deform"),
        (
            dict(fixed=True),
            "bodies.upper.fixed",
            "must be false .* a ground, a plate or rigid plane",
        ),
        (
            dict(
                kind="storeys",
                length_m=0.5,
                width_m=0.5,
                thickness_m=0.2,
                floors=1,
                floor_masses_kg=[10.0],
                storey_heights_m=[0.3],
                period_s=0.1,
                at_m=[0, 0, 0.5],
            ),
            "bodies.upper.kind",
            "has no elements",
        ),
    ],
)
def test_bodies_without_elements_are_refused_by_name_in_full_order(tmp_path, body, key, told):
    tables = merge(LEANING, QUIET)
    tables["bodies"] = dict(
        lower=LEANING["bodies"]["lower"],
        upper=body if "kind" in body else LEANING["bodies"]["upper"] | body,
    )
    if "fixed" in body:
        del tables["initial"]
    with pytest.raises(InputError, match=told) as refused:
        run(structure(**tables), tmp_path / "run", quiet=True)
    assert refused.value.key == key and "engine" in str(refused.value)


@pytest.mark.long
def test_engine_is_an_axis_of_a_study_of_structures(tmp_path):
    from fecolumn.cli import main

    tables = merge(LEANING, dict(integration=dict(duration_s=0.02), **QUIET))
    lines = [
        f"bodies.{name}.{key} = {json.dumps(value)}"
        for name, body in tables["bodies"].items()
        for key, value in body.items()
    ]
    lines += [
        f"joints.{name}.{key} = {json.dumps(value)}"
        for name, one in tables["joints"].items()
        for key, value in one.items()
    ]
    lines += [
        "initial.upper.tilt_rad = 0.06",
        "contact.friction_coefficient = 0.7",
        "contact.interior_points = 0",
        "integration.dt_s = 1e-3",
        "integration.duration_s = 0.02",
    ]
    (tmp_path / "case.toml").write_text("\n".join(lines) + "\n")
    (tmp_path / "study.toml").write_text(
        '[case]\nextends = "case.toml"\n[axes]\n"integration.engine" = ["full", "reduced"]\n'
    )
    assert main(["study", str(tmp_path / "study.toml"), "-o", str(tmp_path / "out")]) in (0, None)
    summaries = [json.loads(file.read_text()) for file in (tmp_path / "out").rglob("summary.json")]
    assert {one["engine"] for one in summaries} == {"full", "reduced"}
    assert summaries[0]["u_max_m"] == pytest.approx(summaries[1]["u_max_m"], abs=AGREES)


@pytest.mark.parametrize("displaced, tilt", [(1e-4, 0.0), (1e-3, 0.0), (-3e-3, 0.0), (1e-3, 0.05)])
def test_equal_blocks_whose_faces_end_at_different_places_stand_and_rock(displaced, tilt, tmp_path):
    """Half of each force acted on nodes that were below the points before they were laid: no
    equilibrium was found. Corners beyond the other face counted as penetration: 5e-5 m.
    """
    block = dict(kind="block", element_size_m=0.13, length_m=0.52, width_m=0.37, height_m=0.91)
    case = structure(
        bodies=dict(lower=block | STONE, upper=block | STONE | dict(at_m=[displaced, 0, 0.91])),
        joints=dict(foot=dict(between=["lower", "ground"]), joint=dict(between=["upper", "lower"])),
        contact=dict(interior_points=0),
        integration=dict(engine="full", dt_s=1e-3, duration_s=0.03),
        output=dict(fields_every_s=0.0),
        **(dict(initial=dict(upper=dict(tilt_rad=tilt))) if tilt else {}),
    )
    summary = run(case, tmp_path / "run", quiet=True)
    assert summary["penetration_max_m"] < 1e-10
    assert tilt or summary["u_max_m"] < 2e-6
