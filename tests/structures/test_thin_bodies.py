"""Bodies too thin for Gmsh are refused by file, key, value and least value, and thicker ones are
meshed.
"""

import pytest
from small_structures import structure

from fecolumn.case import check_thin
from fecolumn.case.case import case_from_tables
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.jacobian import corner_jacobians
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures.shapes import shape_of
from fecolumn.structures.structure import structure_model

TUBE = dict(kind="tube", outer_diameter_m=0.3, wall_m=0.02, height_m=0.3)
BLOCK = dict(kind="block", length_m=0.3, width_m=0.3, height_m=0.3)
PLATE = dict(kind="plate", length_m=0.3, width_m=0.3, thickness_m=0.3)
CONE = dict(kind="cone", bottom_diameter_m=0.3, top_diameter_m=0.3, height_m=0.3)
PRISM = dict(kind="prism", outline_m=[[0, 0], [0.3, 0], [0.1, 0.3]], width_m=0.3)
ARCH = dict(kind="arch", mean_radius_m=0.3, thickness_m=0.1, width_m=0.1, voussoirs=5)
FLANGE = dict(outer_diameter_m=0.3, thickness_m=0.02)
CAP = dict(length_m=0.3, width_m=0.3, thickness_m=0.02)
# of bodies of 0.3 m; the share of the largest dimension is 1e-5
TOO_THIN, LEAST, THICK = 1e-9, 3e-6, 4e-6


def _with(body, key, value):
    return body | {key: value}


def _of(value):
    """Bodies with a dimension of `value` [m], by the key that is refused where it is too small."""
    return {
        "wall_m": _with(TUBE, "wall_m", value),
        "height_m": _with(BLOCK, "height_m", value),
        "width_m": _with(BLOCK, "width_m", value),
        "thickness_m": _with(PLATE, "thickness_m", value),
        "top_diameter_m": _with(CONE, "top_diameter_m", value),
        "bottom_diameter_m": _with(CONE, "bottom_diameter_m", value),
        "flange.thickness_m": _with(TUBE, "flange", _with(FLANGE, "thickness_m", value)),
        "flange.inner_diameter_m": _with(TUBE, "flange", _with(FLANGE, "inner_diameter_m", value)),
        "cap.thickness_m": _with(TUBE, "cap", _with(CAP, "thickness_m", value)),
    }


def _alone(body, **tables):
    return structure(
        bodies=dict(b=body),
        joints=dict(foot=dict(between=["b", "ground"])),
        **tables,
    )


@pytest.mark.parametrize("value", [1e-12, TOO_THIN, 1e-6])
@pytest.mark.parametrize("key", _of(0.0))
def test_too_small_a_dimension_is_refused_with_the_least(key, value):
    with pytest.raises(InputError) as caught:
        _alone(_of(value)[key])
    error = caught.value
    assert (error.key, error.value) == (f"bodies.b.{key}", value)
    assert f"must be at least {LEAST:g} m" in error.allowed


@pytest.mark.parametrize("key", [key for key in _of(0.0) if key != "width_m"])
def test_what_is_thicker_than_the_least_is_meshed(key):
    body = _alone(_of(THICK)[key] | dict(coarse_size_m=0.3)).bodies["b"]
    mesh = shape_of("bodies.b", body, "small.toml").mesh
    assert mass_properties(mesh, 1.0).volume > 0 and corner_jacobians(mesh).min() > 0


@pytest.mark.parametrize(
    "body, key, said",
    [
        (_with(TUBE, "wall_m", 0.15 - TOO_THIN / 2), "wall_m", "leaves a bore of 1e-09 m"),
        (_with(PRISM, "width_m", TOO_THIN), "width_m", "must be at least 3e-06 m"),
        (
            _with(PRISM, "outline_m", [[0, 0], [0.3, 0], [0.3, TOO_THIN]]),
            "outline_m",
            "has a mean thickness of 5e-10 m",
        ),
        (
            _with(PRISM, "outline_m", [[0, 0], [0.3, 0], [TOO_THIN, 0.3], [0, 0.3]]),
            "outline_m",
            "has a side of 1e-09 m",
        ),
        (_with(ARCH, "width_m", TOO_THIN), "width_m", "must be at least 3e-06 m"),
        (_with(ARCH, "thickness_m", 0.6 - TOO_THIN), "thickness_m", "leaves an inner radius of"),
    ],
)
def test_what_a_key_leaves_too_thin_is_refused(body, key, said):
    with pytest.raises(InputError) as caught:
        _alone(body)
    assert caught.value.key == f"bodies.b.{key}" and said in caught.value.allowed


@pytest.mark.parametrize(
    "tables, key",
    [
        (dict(column=dict(shape="tube", outer_diameter_m=0.3, wall_m=TOO_THIN)), "column.wall_m"),
        (
            dict(column=dict(shape="block", length_m=TOO_THIN, width_m=0.3)),
            "column.length_m",
        ),
        (
            dict(
                column=dict(shape="solid", outer_diameter_m=0.3),
                cap=dict(length_m=0.4, width_m=0.4, thickness_m=TOO_THIN),
            ),
            "cap.thickness_m",
        ),
        (
            dict(
                column=dict(shape="solid", outer_diameter_m=0.3),
                flange=dict(outer_diameter_m=0.4, thickness_m=TOO_THIN),
            ),
            "flange.thickness_m",
        ),
    ],
)
def test_the_short_form_names_its_own_keys(tables, key):
    tables["column"]["height_m"] = 1.0
    with pytest.raises(InputError) as caught:
        case_from_tables(tables)
    assert (caught.value.key, caught.value.value) == (key, TOO_THIN)
    assert "must be at least 1e-05 m" in caught.value.allowed


def test_too_thin_a_plate_below_feet_is_refused():
    case = _alone(
        BLOCK | dict(rigid=True), grounds=dict(ground=dict(kind="plate", thickness_m=1e-9))
    )
    with pytest.raises(InputError, match="grounds.ground.thickness_m = 1e-09: must be at least 1"):
        structure_model(case, "small.toml")


def test_what_gmsh_cannot_mesh_is_told_of_the_body_in_one_line(monkeypatch):
    monkeypatch.setattr(check_thin, "THINNEST", 0.0)
    body = _alone(_with(BLOCK, "height_m", TOO_THIN)).bodies["b"]
    with pytest.raises(InputError, match="^small.toml: bodies.b: cannot be meshed: Gmsh") as caught:
        shape_of("bodies.b", body, "small.toml")
    assert "\n" not in str(caught.value)
