"""Sizes that a case leaves open follow from its column, and no mesh is built that is too large."""

import time

import pytest

from fecolumn.case.case import case_from_tables, load_case
from fecolumn.case.short_form import finished, short_form
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import BASE
from fecolumn.mesh.estimate import estimate
from fecolumn.mesh.specimen import specimen_mesh

COLUMNS = {
    "marble cylinder": {"shape": "solid", "outer_diameter_m": 0.5, "height_m": 1.6},
    "marble block": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 1.2},
    "wall": {"shape": "block", "length_m": 2.0, "width_m": 0.1, "height_m": 1.0},
    "glass tube": {"outer_diameter_m": 0.02, "wall_m": 0.0015, "height_m": 0.15},
    "thin steel pipe": {"outer_diameter_m": 1.0, "wall_m": 0.005, "height_m": 6.0},
    "coin": {"shape": "solid", "outer_diameter_m": 0.1, "height_m": 0.01},
}


def made(column, **tables):
    return short_form({"column": column, "integration": {"duration_s": 1.0}} | tables, "own.toml")


@pytest.mark.parametrize("column", COLUMNS.values(), ids=COLUMNS)
def test_dimensions_alone_make_a_mesh_of_some_thousand_bricks(column):
    case = made(column)
    expected = estimate(case)
    assert 500 < expected.all_bricks < 15_000 and expected.memory < 3e9
    specimen = specimen_mesh(case)
    assert len(specimen.foot_nodes) == expected.foot_points
    assert sum(expected.bricks.values()) == len(specimen.body.cells) + len(specimen.base.cells)
    assert expected.all_dofs == 3 * (len(specimen.body.points) + len(specimen.base.points))


@pytest.mark.parametrize(
    "tables",
    [
        {
            "flange": {"outer_diameter_m": 0.2, "thickness_m": 0.02},
            "cap": {"length_m": 0.3, "width_m": 0.2, "thickness_m": 0.01},
        },
        {
            "mesh": {"fine_size_m": 0.0041, "base_size_m": 0.011},
            "base": {"length_m": 0.37, "thickness_m": 0.033},
        },
        {"base": {"length_m": 0.15, "width_m": 0.15}},
    ],
    ids=["flange and cap", "odd base", "small base"],
)
def test_the_estimate_counts_what_is_built(tables):
    case = made({"outer_diameter_m": 0.1, "wall_m": 0.01, "height_m": 0.5}, **tables)
    expected, specimen = estimate(case), specimen_mesh(case)
    for part, n in expected.bricks.items():
        mesh = specimen.base if part == BASE else specimen.body
        assert n == (mesh.part == part).sum() and expected.dofs[part] == 3 * len(
            mesh.part_nodes(part)
        )


def test_sizes_in_metres_are_taken_as_they_are():
    case = load_case("meshes/specimen.toml").short
    assert (
        case.mesh.fine_size_m,
        case.mesh.coarse_size_m,
        case.mesh.cap_size_m,
        case.mesh.base_size_m,
    ) == (0.005, 0.015, 0.015, 0.03)
    assert (case.base.length_m, case.base.slide_allowance_m, case.column.fine_height_m) == (
        0.3,
        0.02,
        0.05,
    )


@pytest.mark.parametrize(
    "key, value",
    [
        ("fine_size_m", 1e-4),
        ("cap_size_m", 4e-5),
        ("base_size_m", 5e-3),
        ("coarse_size_m", 5e-3),
        ("fine_size_m", 1e-7),
    ],
)
def test_a_mesh_that_would_not_fit_is_refused_at_once_with_a_size_that_fits(key, value):
    tables = (
        {"cap": {"length_m": 0.15, "width_m": 0.15, "thickness_m": 0.01}}
        if key == "cap_size_m"
        else {}
    )
    column = (
        {"outer_diameter_m": 2.0, "wall_m": 0.005, "height_m": 6.0}
        if key in ("base_size_m", "coarse_size_m")
        else {"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 1.0}
    )
    sizes = {"fine_size_m": 5e-3} if key in ("base_size_m", "coarse_size_m") else {}
    began = time.perf_counter()
    with pytest.raises(InputError, match="degrees of freedom") as caught:
        made(column, mesh=sizes | {key: value}, **tables)
    assert time.perf_counter() - began < 1
    message = str(caught.value)
    assert message.count("\n") == 0 and "mesh.limit_dofs" in message
    named, fits = (
        caught.value.key.removeprefix("mesh."),
        float(message.split(" m would fit")[0].split()[-1]),
    )
    assert key in ("base_size_m", "coarse_size_m") or named == key
    stated = sizes | {key: value} | {named: fits}
    if named == "fine_size_m":
        stated = {one: max(size, fits) for one, size in stated.items()}
    assert estimate(made(column, mesh=stated, **tables)).all_dofs <= 500_000


def test_a_higher_limit_is_a_key_and_makes_no_other_case():
    column = {"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 1.0}
    with pytest.raises(InputError, match="mesh.limit_dofs allows 1,000"):
        made(column, mesh={"limit_dofs": 1000})
    cases = [
        case_from_tables({"column": column, "mesh": {"limit_dofs": limit}}, "own.toml")
        for limit in (500_000, 10**6)
    ]
    assert cases[0].id == cases[1].id


@pytest.mark.parametrize(
    "column, words",
    [
        ({"outer_diameter_m": 0.1}, ["column.height_m, column.wall_m: missing", 'shape = "tube"']),
        ({"shape": "block", "height_m": 1.0}, ["column.length_m, column.width_m: missing"]),
        ({}, ["column.outer_diameter_m, column.height_m, column.wall_m"]),
        (
            {"shape": "block", "length_m": 0.1, "width_m": 0.1, "height_m": 1.0, "wall_m": 0.1},
            ["column.wall_m = 0.1: says nothing"],
        ),
        (
            {"shape": "solid", "outer_diameter_m": 0.1, "height_m": 1.0, "length_m": 0.1},
            ["column.length_m = 0.1: says nothing"],
        ),
        ({"shape": "cone", "height_m": 1.0}, ["column.shape = 'cone'", "tube, solid, block"]),
    ],
)
def test_a_shape_needs_its_own_dimensions_and_no_others(column, words):
    with pytest.raises(InputError) as caught:
        made(column)
    assert all(word in str(caught.value) for word in words)


@pytest.mark.parametrize(
    "flange, words",
    [
        (
            {"outer_diameter_m": 0.09, "thickness_m": 0.01},
            ["flange.outer_diameter_m = 0.09", "0.1 m"],
        ),
        (
            {"outer_diameter_m": 0.2, "thickness_m": 0.01, "inner_diameter_m": 0.095},
            ["flange.inner_diameter_m", "bore, 0.09 m"],
        ),
        ({"thickness_m": 0.01}, ["flange.outer_diameter_m: missing"]),
    ],
)
def test_a_flange_that_does_not_carry_the_column_is_refused(flange, words):
    with pytest.raises(InputError) as caught:
        made({"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 1.0}, flange=flange)
    assert all(word in str(caught.value) for word in words)


def test_solid_is_a_tube_whose_wall_reaches_the_axis():
    solid, tube = (
        made({"outer_diameter_m": 0.1, "height_m": 1.0} | keys)
        for keys in ({"shape": "solid"}, {"wall_m": 0.05})
    )
    assert solid.mesh == tube.mesh and solid.base == tube.base and solid.column.wall_m == 0.05


def test_open_sizes_of_a_study_follow_each_of_its_columns(tmp_path):
    from fecolumn.study.plan import read_plan

    (tmp_path / "case.toml").write_text(
        "[column]\nouter_diameter_m = 0.1\nwall_m = 0.005\nheight_m = "
        "1.0\n[integration]\nduration_s = 1.0\n"
    )
    (tmp_path / "study.toml").write_text(
        'case = "case.toml"\n[axes]\n"column.outer_diameter_m" = [0.1, 0.2]\n'
    )
    first, second = (analysis for analysis in read_plan(tmp_path / "study.toml").analyses)
    assert second.case.short.mesh.fine_size_m == pytest.approx(
        first.case.short.mesh.fine_size_m * 0.195 / 0.095, rel=1e-3
    )
    assert second.case.short.base.length_m == pytest.approx(
        0.8
    ) and first.case.short.base.length_m == pytest.approx(0.4)
    assert [one.id for one in (first, second)] == [one.case.id for one in (first, second)]


@pytest.mark.parametrize("diameter", [0.1, 0.266843])
def test_a_finished_solid_cylinder_is_finished_again_without_a_change(diameter):
    case = made({"shape": "solid", "outer_diameter_m": diameter, "height_m": 1.0})
    assert finished(case, "own.toml") == case and case.column.wall_m == diameter / 2


def test_sizes_left_out_are_never_beyond_their_own_bounds():
    huge = made(dict(shape="solid", outer_diameter_m=50, height_m=180))
    assert huge.mesh.base_size_m == 10.0 and huge.mesh.fine_size_m < huge.mesh.coarse_size_m < 10
