"""Keys that would say nothing, and parts that do not fit, are refused in both forms of a case."""

import pytest
from small_structures import BLOCK, FOOT, structure

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.schema import InputError

DRUM = dict(kind="cylinder", outer_diameter_m=0.4, height_m=0.6)
WIDE = dict(length_m=0.6, width_m=0.6, thickness_m=0.1)
PAD = dict(kind="pad", stiffness_n_m3=1e8)
COLUMN = dict(shape="block", length_m=0.2, width_m=0.3, height_m=1.0)
STOREYS = dict(kind="storeys", length_m=1.0, width_m=1.0, thickness_m=0.2, floors=3)
STOREYS |= dict(floor_masses_kg=[1.0], storey_heights_m=[1.0], period_s=1.0)
SHAKEN = dict(source="lick:1")


def one(body=None, **tables):
    joints = dict(foot=FOOT | tables.pop("joint", {}))
    return structure(bodies=dict(block=BLOCK | (body or {})), joints=joints, **tables)


def short(**tables):
    return case_from_tables(dict(column=COLUMN, integration=dict(duration_s=0.1)) | tables)


def on_pad(**tables):
    return one(grounds=dict(ground=PAD), **tables)


@pytest.mark.parametrize(
    "made, told",
    [
        (
            lambda: one(grounds=dict(ground=dict(youngs_modulus_pa=3e10))),
            r"grounds.ground.youngs_modulus_pa = 3.*is of a ground of kind plate or unbounded or",
        ),
        (lambda: short(base=dict(stiffness_n_m3=1e8)), r"is of a pad; base.kind = 'plate'"),
        (lambda: one(contact=dict(rolling_resistance=1e-3)), "contact.rolling_resistance = 0.001"),
        (
            lambda: one(joint=dict(rolling_resistance=1e-3)),
            "joints.foot.rolling_resistance = 0.001: must be 0 for a block",
        ),
        (
            lambda: on_pad(integration=dict(substeps="impacts")),
            "integration.substeps = 'impacts': must be rolling or none on a pad",
        ),
        (
            lambda: on_pad(integration=dict(engine="full"), contact=dict(impact="none")),
            "contact.impact = 'none': must be plastic on a pad",
        ),
        (
            lambda: one(dict(fine_height_m=5.0)),
            r"bodies.block.fine_height_m = 5.0: must lie in \[0, height_m = 1.2\] m",
        ),
        (
            lambda: one(dict(cap=WIDE | dict(length_m=0.3))),
            "bodies.block.cap.length_m = 0.3: must be at least length_m = 0.4 m",
        ),
        (
            lambda: one(dict(flange=dict(outer_diameter_m=0.4, thickness_m=0.1))),
            "bodies.block.flange.outer_diameter_m = 0.4: must be at least the diagonal",
        ),
        (
            lambda: one(
                dict(flange=dict(outer_diameter_m=0.6, thickness_m=0.1, inner_diameter_m=0.3))
            ),
            "bodies.block.flange.inner_diameter_m = 0.3: must be 0 below a body without a bore",
        ),
        (
            lambda: structure(
                bodies=dict(block=DRUM | dict(cap=WIDE | dict(width_m=0.3))),
                joints=dict(foot=FOOT),
            ),
            "bodies.block.cap.width_m = 0.3: must be at least outer_diameter_m = 0.4 m",
        ),
        (
            lambda: one(motion=SHAKEN | dict(rest_ceiling_s=5.0)),
            "motion.rest_ceiling_s = 5.0: says nothing without motion.free_vibration_s",
        ),
        (
            lambda: structure(
                bodies=dict(block=STOREYS | dict(damping="modal", rayleigh_modes=[1, 3])),
                joints=dict(foot=FOOT),
            ),
            "bodies.block.rayleigh_modes = .1, 3.: says nothing without bodies.block.damping",
        ),
    ],
)
def test_what_says_nothing_or_does_not_fit_is_refused_by_its_key(made, told):
    with pytest.raises(InputError, match=told):
        made()


def test_what_has_an_effect_is_taken():
    round_foot = dict(flange=dict(outer_diameter_m=0.6, thickness_m=0.1))
    assert one(round_foot, contact=dict(rolling_resistance=1e-3)).contact.rolling_resistance
    layer = dict(kind="unbounded", youngs_modulus_pa=3e10, thickness_m=0.1)
    assert one(grounds=dict(ground=layer)).grounds["ground"].youngs_modulus_pa == 3e10
    own = dict(law="penalty")
    assert one(contact=dict(penalty_factor=5.0), joint=own).contact.penalty_factor == 5.0
    until_rest = SHAKEN | dict(rest_ceiling_s=5.0, free_vibration_s="rest")
    assert one(motion=until_rest, integration=dict(duration_s=0.0)).motion.rest_ceiling_s == 5.0
    motion = SHAKEN | dict(free_vibration_s=1.0)
    assert one(motion=SHAKEN, grounds=dict(ground=dict(motion=motion))).motions


def test_a_study_of_the_laws_of_contact_may_state_the_stiffness_of_one():
    for law in ("augmented_lagrange", "penalty"):
        assert one(contact=dict(penalty_factor=5.0, law=law)).contact.law == law
