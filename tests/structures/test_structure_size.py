"""What meshes of a structure will have is known before they are built, and those too large are
refused by name.
"""

import time

import pytest
from small_structures import BLOCK, STONE, block, frame, stack, structure

from fecolumn.case.case import case_from_tables, load_case
from fecolumn.foundation.schema import InputError
from fecolumn.structures import layout
from fecolumn.structures.bodies import drawing
from fecolumn.structures.shapes import shape_of
from fecolumn.structures.size import expected, size_of
from fecolumn.structures.structure import structure_model

TUBE = dict(kind="tube", outer_diameter_m=0.4, wall_m=0.05, height_m=2.0)
BODIES = {
    "block": BLOCK,
    "short block": BLOCK | dict(height_m=0.25),
    "quadratic block": BLOCK | dict(element_order=2, coarse_size_m=0.13),
    "cylinder": dict(kind="cylinder", outer_diameter_m=0.5, height_m=1.3),
    "coin": dict(kind="cylinder", outer_diameter_m=0.5, height_m=0.05),
    "tube": TUBE,
    "tube on a flange": TUBE
    | dict(flange=dict(outer_diameter_m=0.6, thickness_m=0.07, inner_diameter_m=0.2)),
    "tube with all": TUBE
    | dict(
        flange=dict(outer_diameter_m=0.6, thickness_m=0.03),
        cap=dict(length_m=0.7, width_m=0.5, thickness_m=0.1),
        element_order=2,
    ),
    "plate": dict(kind="plate", length_m=3.0, width_m=2.0, thickness_m=0.2),
    "fine plate": dict(
        kind="plate", length_m=3.0, width_m=2.0, thickness_m=0.2, element_size_m=0.11
    ),
    "storeys": dict(
        kind="storeys",
        length_m=3.0,
        width_m=2.0,
        thickness_m=0.2,
        floors=2,
        floor_masses_kg=[10.0],
        storey_heights_m=[1.0],
        period_s=1.0,
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_estimate_counts_what_is_built(body):
    from fecolumn.case.check_bodies import material_of
    from fecolumn.structures.reduction import body_of

    case = structure(
        bodies=dict(
            body=body | {key: value for key, value in STONE.items() if key != "poissons_ratio"}
        ),
        joints=dict(foot=dict(between=["body", "ground"])),
    )
    shape = shape_of("bodies.body", case.bodies["body"], "small.toml")
    found = size_of(case, "small.toml")
    assert found.bricks == {"body": len(shape.mesh.cells)}
    assert found.dofs == {"body": 3 * body_of(shape, material_of(case.bodies["body"], {})).n_nodes}


@pytest.mark.parametrize(
    "places", [[(-0.9, 0.3), (0.9, -0.3)], [(-1.39, 0.0), (-1.0, 0.1), (0.2, 0.6)], [(0.0, 0.0)]]
)
def test_estimate_counts_plates_where_others_meet_them(places):
    tables = frame(column=dict(copies_m=[[x, y, 0.0] for x, y in places]), slab=dict(rigid=False))
    case = structure(**tables)
    drawings = {name: drawing(case, name, "small.toml") for name in case.bodies}
    spots = layout._spots(
        case,
        drawings,
        layout.meetings_of(case, {name: one.faces for name, one in drawings.items()}, "small.toml"),
    )
    shape = shape_of("bodies.slab", case.bodies["slab"], "small.toml", spots["slab"])
    assert (
        size_of(case, "small.toml", spots).bricks["slab"]
        == len(shape.mesh.cells)
        > size_of(case, "small.toml").bricks["slab"]
    )


@pytest.mark.parametrize("size", [1e-3, 1e-5, 1e-9])
@pytest.mark.parametrize(
    "kind, keys", [("block", {}), ("cylinder", {}), ("tube", dict(wall_m=0.02)), ("plate", {})]
)
def test_elements_that_would_not_fit_are_refused_at_once_with_a_size_that_fits(kind, keys, size):
    sides = (
        dict(outer_diameter_m=0.3, height_m=0.5)
        if kind in ("cylinder", "tube")
        else dict(length_m=0.3, width_m=0.2)
        | {"thickness_m" if kind == "plate" else "height_m": 0.1}
    )

    def case(value):
        return structure(
            bodies=dict(
                piece=dict(kind=kind, element_size_m=value)
                | sides
                | keys
                | (dict(coarse_size_m=value) if kind == "plate" else {})
            ),
            joints=dict(foot=dict(between=["piece", "ground"])),
        )

    began = time.perf_counter()
    with pytest.raises(
        InputError, match="mesh.limit_dofs allows 500,000; .* m would fit"
    ) as caught:
        structure_model(case(size), "small.toml")
    assert time.perf_counter() - began < 1.0
    message = str(caught.value)
    wanted = size_of(case(size), "small.toml")
    assert message.startswith(f"small.toml: {caught.value.key} = {size}: ") and "\n" not in message
    assert (
        f"{wanted.dofs['piece']:,} degrees of freedom" in message
        and f"{wanted.bricks['piece']:,} elements" in message
    )
    fits = float(message.split(" m would fit")[0].split()[-1])
    assert (
        size_of(case(fits), "small.toml").dofs["piece"]
        <= 500_000
        < size_of(case(0.9 * fits), "small.toml").dofs["piece"]
    )


@pytest.mark.parametrize(
    "outline, width, key",
    [
        ([[0, 0], [300, 0], [300, 900], [0, 900]], 300.0, "outline_m"),
        ([[0, 0], [20, 0], [20, 20], [0, 20]], 900.0, "width_m"),
    ],
)
def test_a_prism_drawn_in_millimetres_is_told_so(outline, width, key):
    body = dict(kind="prism", outline_m=outline, width_m=width, element_size_m=1.0)
    case = structure(bodies=dict(a=body), joints=dict(foot=dict(between=["a", "ground"])))
    with pytest.raises(InputError, match="of 900 m, which looks like millimetres") as caught:
        structure_model(case, "small.toml")
    assert caught.value.key == f"bodies.a.{key}" and "\n" not in str(caught.value)
    coarse = dict(a=body | dict(element_size_m=100.0, rigid=True))
    foot, drawn = dict(foot=dict(between=["a", "ground"])), dict(start="drawn")
    case = structure(bodies=coarse, joints=foot, integration=drawn)
    with pytest.warns(UserWarning, match='bodies.a: "a" is 900 m large, which looks like millim'):
        structure_model(case, "small.toml")


def test_coarse_size_alone_is_named_where_it_is_the_cause():
    with pytest.raises(InputError, match="mesh.limit_dofs") as caught:
        structure_model(
            structure(
                **block(
                    element_size_m=0.1, coarse_size_m=0.1, length_m=20.0, width_m=20.0, height_m=2.0
                )
            ),
            "small.toml",
        )
    assert caught.value.key == "bodies.block.element_size_m"
    plate = dict(kind="plate", length_m=3.0, width_m=2.0, thickness_m=0.3, coarse_size_m=0.002)
    with pytest.raises(InputError, match="m would fit") as caught:
        structure_model(
            structure(
                bodies=dict(plate=plate), joints=dict(foot=dict(between=["plate", "ground"]))
            ),
            "small.toml",
        )
    assert caught.value.key == "bodies.plate.coarse_size_m"


def test_limit_is_a_key_that_makes_no_other_case(tmp_path):
    with pytest.raises(InputError, match="mesh.limit_dofs allows 100;"):
        # of no test before, whose meshes are kept
        structure_model(
            structure(**block(height_m=1.2345), mesh=dict(limit_dofs=100)), "small.toml"
        )
    assert structure(**stack(), mesh=dict(limit_dofs=10**6)).id == structure(**stack()).id
    (tmp_path / "case.toml").write_text(
        '[bodies.block]\nkind = "block"\nlength_m = 0.4\nwidth_m = 0.4\nheight_m = '
        '1.0\n[joints.foot]\nslave = "block"\non = "ground"\n'
        "[mesh]\nfine_size_m = 0.1\n"
    )
    with pytest.raises(
        InputError, match="mesh.fine_size_m = 0.1: unknown key; known keys: limit_dofs"
    ):
        load_case(tmp_path / "case.toml")


def test_every_copy_counts_in_full_order():
    one, full = (
        size_of(
            structure(
                **frame(column=dict(rigid=False), slab=dict(rigid=False)),
                integration=dict(engine=engine),
            ),
            "small.toml",
        )
        for engine in ("reduced", "full")
    )
    assert full.dofs["column"] == 4 * one.dofs["column"] and full.dofs["slab"] == one.dofs["slab"]


ELASTIC = dict(rigid=False)


@pytest.mark.parametrize(
    "tables, said",
    [
        (
            stack(bodies=dict(upper=ELASTIC | dict(element_size_m=0.01, coarse_size_m=0.01))),
            "(a larger bodies.upper.element_size_m or bodies.upper.rigid = true makes it shorter)",
        ),
        (
            stack(
                bodies=dict(upper=ELASTIC | dict(element_size_m=0.01, coarse_size_m=0.01)),
                integration=dict(engine="rigid"),
            ),
            "(a larger bodies.upper.element_size_m or bodies.upper.rigid = true makes it shorter)",
        ),
        (stack(bodies=dict(upper=ELASTIC)), None),
    ],
)
def test_a_long_start_names_the_key_that_makes_it_shorter(tables, said):
    found = expected(structure(**tables), "small.toml")
    assert (found.setup > 60) == (said is not None)
    assert said is None and "shorter" not in str(found) or f"to start {said} and" in str(found)


def test_a_long_start_of_the_short_form_names_its_key():
    column = dict(shape="block", length_m=0.4, width_m=0.4, height_m=1.2)
    case = case_from_tables(
        dict(column=column, mesh=dict(fine_size_m=0.015, coarse_size_m=0.015, base_size_m=0.1))
    )
    assert "to start (a larger mesh.fine_size_m makes it shorter) and" in str(
        expected(case, "small.toml")
    )
