"""What cannot be of contact that is found is refused in one line that says the way out."""

import pytest
from small_collapses import box, rod

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.structures.structure import structure_model

L_OUTLINE = [[0, 0], [0.6, 0], [0.6, 0.2], [0.2, 0.2], [0.2, 0.8], [0, 0.8]]
MATERIAL = dict(density_kg_m3=2500.0)
STOREYS = dict(
    kind="storeys",
    length_m=1.0,
    width_m=1.0,
    thickness_m=0.2,
    floors=1,
    floor_masses_kg=[1.0],
    storey_heights_m=[1.0],
    period_s=1.0,
)


def tables(**more):
    """A block on the ground, whose contact is found."""
    return merge(
        dict(
            integration=dict(engine="rigid", duration_s=0.1, start="drawn"),
            contact=dict(between="all"),
            bodies=dict(block=box(0.3, 0.4, 1.0)),
            joints=dict(foot=dict(between=["block", "ground"])),
        ),
        more,
    )


def beside(body: dict, **more):
    """The same beside another body."""
    return merge(tables(bodies=dict(other=body)), more)


L_PRISM = dict(kind="prism", outline_m=L_OUTLINE, width_m=0.3, at_m=[2, 0, 0]) | MATERIAL
TUBE = dict(kind="tube", outer_diameter_m=0.4, wall_m=0.05, height_m=0.8, at_m=[2, 0, 0]) | MATERIAL
DOME = box(0.3, 0.3, 0.8, at_m=[2, 0, 0], foot_radius_m=1.0)
WRONG = [
    (tables(integration=dict(engine="full")), "contact.between", 'engine = "reduced" or "rigid"'),
    (tables(integration=dict(engine="housner")), "contact.between", "engine"),
    (tables(contact=dict(between=["nobody"])), "contact.between", "nobody"),
    (tables(contact=dict(between=["ground"])), "contact.between", "ground"),
    (tables(contact=dict(between="some")), "contact.between", "all"),
    (
        beside(box(0.3, 0.3, 0.8, at_m=[2, 0, 0], fixed=True), contact=dict(between=["other"])),
        "contact.between",
        "must name a body that moves",
    ),
    (tables(contact=dict(between=[1])), "contact.between", "all"),
    (beside(L_PRISM), "contact.between", '"other" is not convex, it fills 0.'),
    (beside(TUBE), "contact.between", '"other" is not convex, it fills 0.'),
    (beside(TUBE, contact=dict(between=["block", "other"])), "contact.between", "not convex"),
    (
        beside(
            STOREYS | dict(at_m=[3, 0, 0]),
            joints=dict(slab=dict(between=["other", "ground"])),
            integration=dict(engine="reduced"),
        ),
        "bodies.other.kind",
        "no outline",
    ),
    (beside(DOME), "bodies.other.foot_radius_m", "must be left out beside contact.between"),
    (
        beside(box(0.3, 0.3, 0.8, at_m=[2, 0, 0], edge_radius_m=0.02)),
        "bodies.other.edge_radius_m",
        "must be left out beside contact.between",
    ),
    (
        beside(
            box(0.3, 0.3, 0.8, at_m=[2, 0, 0]),
            joints=dict(foot=dict(between=["block", "rock"]), base=dict(between=["other", "quay"])),
            grounds=dict(rock={}, quay={}),
        ),
        "grounds.quay.level_m",
        "must differ from that of grounds.rock",
    ),
    (
        beside(
            box(0.3, 0.3, 0.8, at_m=[2, 0, -3]),
            joints=dict(foot=dict(between=["block", "rock"]), base=dict(between=["other", "quay"])),
            grounds=dict(rock={}, quay=dict(level_m=-3.0)),
        ),
        "contact.between",
        '"other" begins 3 m below grounds.rock, z = 0',
    ),
    (
        tables(
            joints=dict(foot=dict(between=["block", "soil"])),
            grounds=dict(soil=dict(kind="pad", stiffness_n_m3=1e7)),
        ),
        "grounds.soil.kind",
        "must be rigid",
    ),
    (
        tables(
            joints=dict(foot=dict(between=["block", "soil"])),
            grounds=dict(
                soil=dict(
                    kind="plate",
                    youngs_modulus_pa=1e9,
                    poissons_ratio=0.2,
                    thickness_m=0.5,
                    length_m=2.0,
                    width_m=2.0,
                )
            ),
        ),
        "grounds.soil.kind",
        "must be rigid",
    ),
    (
        tables(
            joints=dict(foot=dict(between=["block", "soil"])),
            grounds=dict(
                soil=dict(
                    kind="unbounded", youngs_modulus_pa=1e9, poissons_ratio=0.2, thickness_m=0.5
                )
            ),
        ),
        "grounds.soil.kind",
        "must be rigid",
    ),
    (
        beside(
            box(0.3, 0.3, 0.3, at_m=[0, 0, 1.0]),
            joints=dict(head=dict(between=["block", "other"], stiffness_n_m3=1e8)),
        ),
        "joints.head.stiffness_n_m3",
        "must be left out where contact.between has both bodies",
    ),
    (
        tables(joints=dict(foot=dict(rolling_resistance=0.01))),
        "joints.foot.rolling_resistance",
        "must be left out",
    ),
    (tables(joints=dict(foot=dict(law="penalty"))), "joints.foot.law", "must be left out"),
    (tables(contact=dict(rolling_resistance=0.01)), "contact.rolling_resistance", "must be 0"),
    (tables(contact=dict(law="penalty")), "contact.law", "must be augmented_lagrange"),
    (beside(box(0.3, 0.4, 1.0, at_m=[0.2, 0.1, 0.3])), "bodies.other", "overlap"),
    # crossed bars, of neither of which a corner is in the other
    (
        beside(
            rod(4, 0.1, 2.0, at_m=[2, 0, 0.5]),
            bodies=dict(third=rod(4, 0.1, 2.0, at_m=[2, 0, 0.6], turned_deg=90)),
        ),
        "bodies.third",
        "overlap",
    ),
    (beside(box(0.3, 0.4, 1.0, at_m=[2, 0, -0.3])), "bodies.other", "below the ground"),
]


@pytest.mark.parametrize("case, key, told", WRONG)
def test_wrong_cases_are_refused_in_one_line(case, key, told):
    with pytest.raises(InputError) as error:
        structure_model(case_from_tables(case, "wrong.toml"), "wrong.toml")
    text = str(error.value)
    assert text.startswith(f"wrong.toml: {key}") and told in text and "\n" not in text, text


def test_an_empty_list_finds_nothing_and_a_body_may_be_named_twice():
    assert structure_model(case_from_tables(tables(contact=dict(between=[])), "case")).found is None
    again = tables(contact=dict(between=["block", "block"]))
    assert structure_model(case_from_tables(again, "case")).found.parts == (0,)
