"""Tables of benchmarks/substeps: which analyses they are of, and what they count."""

import pytest

from benchmarks.beside import compared
from benchmarks.substeps.__main__ import (
    CAUSES,
    FINE,
    FIXED,
    KEYS,
    PAIRS,
    ROLLING,
    SAMPLED,
    Setting,
    tables,
)
from fecolumn.study.plan import read_plan


def _plan(name):
    return read_plan(f"benchmarks/{name}.toml")


@pytest.mark.long
def test_fixed_settings_are_analyses_of_the_paper_study():
    paper = {
        (
            a.values["integration.dt_s"],
            a.values["integration.alpha_hht"],
            a.values["motion.source"],
        ): a.id
        for a in _plan("paper_study").analyses
    }
    shared = [
        a
        for name in ("coarse", "fine", "finest")
        for a in _plan(f"substeps/{name}").analyses
        if a.case.integration.substeps == "none" and not a.case.motion.resample_s
    ]
    assert len(shared) == 5 * 115
    for a in shared:
        assert (
            a.id
            == paper[
                a.values["integration.dt_s"],
                a.values["integration.alpha_hht"],
                a.values["motion.source"],
            ]
        )


@pytest.mark.long
def test_every_setting_of_the_tables_is_in_the_studies():
    made = {
        Setting(*(a.values[key] for key in KEYS))
        for name in ("coarse", "fine", "finest")
        for a in _plan(f"substeps/{name}").analyses
    }
    assert {setting for pair in PAIRS for setting in pair} | set(CAUSES) == made


def _runs(peaks, fallen, parts=0):
    return {
        number: dict(
            u_max_m=peak,
            overturned=number in fallen,
            slid_off=False,
            steps=100,
            parts=parts,
            impacts=7,
            energy_j=dict(impact=-0.1 * number, contact=-0.01, friction=-0.02, algorithmic=-5.0),
        )
        for number, peak in enumerate(peaks)
    }


def test_a_pair_counts_what_overturns_in_one_alone():
    first, second = _runs([0.01] * 12, {0, 1}), _runs([0.01] * 12, {1, 2, 3, 4, 5, 6, 7, 8, 9})
    distance, p, alone, other, flips = compared(first, second)
    assert distance == pytest.approx(7 / 12) and (alone, other) == (1, 8)
    # both tails of a binomial of nine halves: 2 (1 + 9) / 2^9
    assert flips == pytest.approx(20 / 512) and 0 < p < 0.05


def test_tables_say_what_is_done_and_leave_out_what_is_not():
    text = tables(
        {
            FIXED: _runs([0.01, 0.02, 0.03, 0.04], {3}),
            FINE: _runs([0.02] * 4, {2, 3}),
            ROLLING: _runs([0.01] * 4, set(), 9),
        }
    )
    assert (
        "| 0.02 s, alpha -0.2, fixed step | 4 | 1 | 25.0 | 4.6 to 69.9 | 20.0 | 100 | 0 | 7 |"
        in text
    )
    assert "| 0.02 s, alpha -0.2, rolling substeps | 4 | 0 |" in text and " | 100 | 9 | 7 |" in text
    assert (
        "| 0.02 s, alpha -0.2, fixed step; 0.001 s, alpha -0.2, fixed step | 0.250 | " in text
        and "impact substeps" not in text
    )


def test_energy_is_of_the_motions_that_stand_in_all_four():
    """Motions 0 and 1 of four stand in both: 0.03 and 0.13 J."""
    text = tables({FIXED: _runs([0.01] * 4, {3}), SAMPLED: _runs([0.01] * 4, {2})})
    assert "| 0.02 s, alpha -0.2, fixed step | 1 | " in text and text.count(" | 7 | 0.080 |") == 2
