"""The Lick ensemble against the figures of its seed record, RSN 810, and its reproducibility."""

import numpy as np
import pytest

from fecolumn.foundation.schema import InputError
from fecolumn.motions.processing import integrate
from fecolumn.motions.seeded import (
    LICK,
    VARIABILITIES,
    read_model,
    seeded_acceleration,
    seeded_ensemble,
    write_model,
)
from fecolumn.motions.target import agreement, time_scaled

# 5 % RotD50 of RSN 810 (NGA-West2 flatfile, PEER): period [s], Sa [g]
ORDINATES = {
    0.05: 0.557,
    0.075: 0.648,
    0.1: 0.869,
    0.12: 1.207,
    0.13: 1.460,
    0.15: 1.787,
    0.16: 1.765,
    0.2: 1.074,
    0.25: 0.936,
    0.29: 1.166,
    0.3: 1.088,
    0.35: 1.107,
    0.4: 0.806,
    0.5: 0.438,
    0.6: 0.260,
    0.75: 0.173,
    1.0: 0.206,
    1.5: 0.081,
    2.0: 0.043,
    3.0: 0.0218,
}


@pytest.mark.long
@pytest.mark.parametrize("variability", VARIABILITIES)
def test_median_of_115_motions_meets_the_figures_of_the_record(variability):
    model = read_model(LICK)
    target = model.target
    fitted_to = dict(zip(target.periods_s, target.sa_g))
    assert {period: fitted_to[period] for period in ORDINATES} == pytest.approx(ORDINATES, rel=0.01)
    assert (target.pga_g, target.pgv_m_s, target.pgd_m, target.ds5_75_s, target.ds5_95_s) == (
        0.456,
        0.2181,
        0.0746,
        6.08,
        9.59,
    )
    motions = seeded_ensemble(model, 115, 810, variability).motions
    missed = [row for row in agreement(motions, target) if not row.within]
    assert not missed
    for motion in motions:
        for history in integrate(motion):
            assert np.abs(history[-1]).max() < 1e-9 * np.abs(history).max()


def test_drawn_motions_vary_more_than_fixed_ones():
    model = read_model(LICK)
    fixed, drawn = (
        np.log([motion.pga[0] for motion in seeded_ensemble(model, 40, 1, kind).motions]).std()
        for kind in VARIABILITIES
    )
    assert fixed < 0.2 and drawn > 2 * fixed


@pytest.mark.parametrize("variability", VARIABILITIES)
def test_a_motion_does_not_depend_on_how_many_there_are(variability):
    model = read_model(LICK)
    few, more = (seeded_ensemble(model, n, 7, variability).motions for n in (2, 5))
    assert np.array_equal(few[1].acceleration, more[1].acceleration)
    assert not np.array_equal(few[0].acceleration[:2000], few[1].acceleration[:2000])
    assert not np.array_equal(
        few[0].acceleration[:2000], seeded_acceleration(model, variability, 8, 0)[:2000]
    )


def test_same_seed_gives_the_same_samples_on_every_machine():
    # to rounding of the transforms; the random numbers are numpy's PCG64, the same from 1.24 on
    first = seeded_acceleration(read_model(LICK), "fixed", 810, 0)
    rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(810, spawn_key=(0,))))
    assert rng.standard_normal(3) == pytest.approx(
        [-0.5269504080322355, 0.5671425057646342, 0.226909532248322], abs=1e-12
    )
    assert first[[800, 2000, 3000], 0] == pytest.approx(
        [0.3574603050085, 1.540508142912, -0.252274872720], rel=1e-9
    )


def test_compressed_ensemble_keeps_accelerations_and_scales_velocity_and_displacement():
    model = read_model(LICK)
    full, compressed = (seeded_ensemble(model, 1, 5, time_scale=factor) for factor in (1.0, 0.5))
    assert np.array_equal(full.motions[0].acceleration, compressed.motions[0].acceleration)
    assert compressed.motions[0].dt == 0.5 * full.motions[0].dt and "time x 0.5" in compressed.name
    half = time_scaled(model.target, 0.5)
    assert (half.pgv_m_s, half.pgd_m, half.periods_s[0]) == pytest.approx(
        (0.10905, 0.01865, 0.5 * model.target.periods_s[0])
    )
    for whole, part in zip(
        agreement(full.motions, model.target), agreement(compressed.motions, half, 0.5)
    ):
        assert part.median / part.target == pytest.approx(whole.median / whole.target, rel=1e-9)


def test_parameter_file_is_read_as_it_was_written(tmp_path):
    model = read_model(LICK)
    write_model(model, tmp_path / "again.toml")
    again = read_model(tmp_path / "again.toml")
    assert again == model


@pytest.mark.parametrize(
    "old, new, key",
    [
        ("damping = [", "damping = [0.1, ", "components.damping"),
        ("damping = [", "damping = [7, ", "components.damping"),
        ("[drawn]", "[drawn]\nsecond = 1", "drawn.second"),
        ("sa_g = [", "sa_g = [0.1, ", "target.sa_g"),
        ("frequencies_hz = [", "frequencies_hz = [90.0, ", "frequencies_hz"),
    ],
)
def test_broken_parameter_files_are_named_with_their_key(tmp_path, old, new, key):
    (tmp_path / "broken.toml").write_text(LICK.read_text().replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        read_model(tmp_path / "broken.toml")
    assert caught.value.key == key and "broken.toml" in str(caught.value)
