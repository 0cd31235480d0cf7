"""How the table of outcomes is made: draws, models and the measures of what shook them."""

import numpy as np
import pytest

from benchmarks.outcomes import bodies, models
from benchmarks.outcomes.draws import drawn
from benchmarks.outcomes.motions import along_x, measures, motions, motions_file, stored
from fecolumn.case.model_sections import BlockModel
from fecolumn.engines.rocking.block import RockingBlock
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.motions.intensity import intensity_measures
from fecolumn.motions.processing import scale


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return motions_file(tmp_path_factory.mktemp("outcomes"), 4)


def test_measures_go_with_the_power_of_the_factor(file):
    ensemble = stored(file)
    assert len(ensemble.motions) == len(motions(4)) == 4 + 3 + 4
    doubled = scale(ensemble.motions[5], 2.0)
    assert measures(ensemble, 5, 2.0, False) == pytest.approx(intensity_measures(doubled))
    assert measures(ensemble, 5, 2.0, True) == pytest.approx(intensity_measures(along_x(doubled)))


@pytest.mark.long
def test_a_row_of_a_planar_block_is_that_block_s_response(file):
    ensemble = stored(file)
    rows = models.planar_blocks(file, 0, 12)
    for row, one in zip(rows, drawn(models.BLOCK, 0, 12, ensemble, True)):
        section = BlockModel(
            width_m=row["width_m"],
            height_m=row["height_m"],
            restitution=min(one.restitution * housner_restitution(one.slenderness), 1.0),
        )
        motion = scale(along_x(ensemble.motions[one.motion]), one.scale)
        response = RockingBlock.of_section(section, "test").respond(motion, free_s=20.0)
        assert row["outcome"] == ("overturned" if response.overturned else "safe")
        assert row["censored"] == response.overturned
        if not response.overturned:
            # the response is sampled each 0.01 s, between which a peak may lie
            for seen, peak in (
                (response.tilt.max() / one.slenderness, row["peak_over_critical"]),
                (response.u_max, row["peak_displacement_m"]),
            ):
                assert seen <= peak * (1 + 1e-9) and peak <= 1.05 * seen


def test_a_rolling_column_has_its_own_frequency(file):
    rows = models.rolling_columns(file, 0, 3)
    for row in rows:
        square = (row["width_m"] ** 2 + row["height_m"] ** 2) / 4
        inertia = (0.75 * row["width_m"] ** 2 + row["height_m"] ** 2) / 12 + square
        p = np.sqrt(9.80665 * np.sqrt(square) / inertia)
        assert row["p_rad_s"] == pytest.approx(p, rel=1e-6) and row["shape"] == "cylinder"


def test_bodies_with_contact_are_of_few_models_each_as_strongly_shaken_as_drawn(file):
    draws = bodies.draws_of(bodies.ELASTIC, 250, file)
    ensemble = stored(file)
    assert len({(one.width, one.height, one.youngs) for one in draws}) == 3
    for one, own in zip(draws, drawn(bodies.ELASTIC, 0, 250, ensemble, False)):
        peaks = [
            measures(ensemble, body.motion, body.scale, False)["pga_m_s2"]
            * body.height
            / body.width
            for body in (one, own)
        ]
        assert peaks[0] == pytest.approx(peaks[1])
    case = bodies.case_of(bodies.RIGID, draws[0], file)
    assert case.integration.engine == "rigid"
    assert case.motion.source.endswith(f"#{draws[0].motion + 1}")
