"""The paper's findings put to studies in which they are made to hold, or not."""

import math

import pytest
from synthetic_study import ALPHA, DT, SPECIMEN, write_synthetic

from fecolumn.study.report.claim import NOT_SUPPORTED, SUPPORTED, UNDECIDED
from fecolumn.study.report.families import families, shortfalls
from fecolumn.study.report.page import claims_of
from fecolumn.study.report.pair import read_pairs
from fecolumn.study.report.sweep import read_sweep

AXES = {DT: [0.02, 1e-3, 1e-4], ALPHA: [0, -0.1, -0.333]}


def claims(folder, motions=115, axes=AXES, **options):
    sweep = read_sweep(write_synthetic(folder, axes, motions, **options))
    return {claim.key: claim for claim in claims_of(sweep, read_pairs(sweep))}


@pytest.fixture(scope="module")
def chaotic(tmp_path_factory):
    """Peaks of a motion scatter over the settings, nothing else; a coarse step makes them larger;
    no damping costs a tenth more. Of 115 motions the widest pair of alphas leaves a distance of
    0.184 open, more than the 0.179 that are asked for: 130 exclude it.
    """
    return claims(
        tmp_path_factory.mktemp("claims") / "study",
        130,
        scatter=0.3,
        effect=lambda v: 1.5 if v[DT] > 0.01 else 1.0,
        cost=lambda v: 2e-4 * (1 + 0.3 * (v[ALPHA] + 0.333)),
    )


def test_chaos_without_trend_supports_the_paper(chaotic):
    assert {
        key: chaotic[key].verdict for key in ("a1", "a2, α", "b1", "b2", "c", "d1", "d2")
    } == dict.fromkeys(("a1", "a2, α", "b1", "b2", "c", "d1", "d2"), SUPPORTED)
    assert "Not significant is not equal" in chaotic["c"].ours


def test_a_trend_of_the_coarse_step_alone_is_told_as_such(chaotic):
    assert chaotic["a2, Δt"].verdict == NOT_SUPPORTED
    assert (
        "Here ours disagrees" in chaotic["a2, Δt"].ours
        and "the trend is that of the coarse step" in chaotic["a2, Δt"].ours
    )


@pytest.mark.long
def test_a_strong_effect_of_alpha_is_found(tmp_path):
    found = claims(tmp_path, motions=60, effect=lambda v: 1 + 3 * -v[ALPHA])
    assert found["a2, α"].verdict == found["c"].verdict == NOT_SUPPORTED
    assert found["b2"].verdict != NOT_SUPPORTED
    assert "Here ours disagrees" in found["c"].ours and "P(overturn) goes from" in found["c"].ours


@pytest.mark.long
def test_an_effect_of_small_steps_is_found(tmp_path):
    found = claims(tmp_path, motions=60, effect=lambda v: 2.0 if v[DT] < 5e-4 else 1.0)
    assert found["b2"].verdict == NOT_SUPPORTED and found["c"].verdict != NOT_SUPPORTED


def test_few_motions_leave_the_equality_of_distributions_undecided(tmp_path):
    found = claims(tmp_path, motions=12)
    assert found["b2"].verdict == found["c"].verdict == UNDECIDED
    assert "cannot exclude" in found["c"].ours


@pytest.mark.long
def test_peaks_that_do_not_depend_on_the_setting_contradict_the_paper(tmp_path):
    found = claims(tmp_path, motions=40, scatter=0.0)
    assert found["a1"].verdict == NOT_SUPPORTED and "0 of 40 motions" in found["a1"].ours


def test_more_damping_that_costs_more_contradicts_the_paper_with_the_reason(tmp_path):
    found = claims(tmp_path, motions=20, cost=lambda v: 2e-4 * (1 - 2 * v[ALPHA]))
    assert found["d2"].verdict == NOT_SUPPORTED and "contact iterations" in found["d2"].ours


def test_one_small_step_alone_cannot_tell_whether_steps_matter(tmp_path):
    found = claims(tmp_path, motions=20, axes={DT: [0.02, 1e-3], ALPHA: [0, -0.2]})
    assert found["b2"].verdict == UNDECIDED and "Not to be judged" in found["b2"].ours


def test_claims_on_alpha_say_what_the_scheme_builds_in(chaotic, tmp_path):
    assert all(
        ("alpha is kept from contact" in claim.ours) == (key in ("a2, α", "c"))
        for key, claim in chaotic.items()
    )
    literal = tmp_path / "literal.toml"
    literal.write_text(
        f'extends = "{SPECIMEN}"\n[contact]\nimpact = "none"\n[integration]\nengine = "full"\n'
    )
    assert all(
        "alpha is kept" not in claim.ours
        for claim in claims(tmp_path / "study", motions=12, case=literal).values()
    )


def test_claims_say_how_many_motions_they_need(chaotic, tmp_path):
    """The margin is what two samples of 115 motions show: of these 130 are enough, 40 are not."""
    found = claims(tmp_path, motions=40, scatter=0.6)
    assert (
        "With 40 motions a KS distance below 0.30 cannot be told from 0: the claim of "
        "no difference beyond 0.18 needs about N = 115." in found["c"].ours
    )
    assert "needs about N" not in chaotic["c"].ours


def test_the_report_warns_of_every_question_for_which_its_motions_are_few(tmp_path):
    """Of the least difference claimed among four pairs, and of none beyond 0.10: told from 0 at
    sqrt(ln(2 x 4 / 0.05) / 30) = 0.41 and sqrt(ln 40 / 30) = 0.35.
    """
    axes = {DT: [0.02, 1e-3, 1e-4], "contact.friction_coefficient": [0.3, 0.5]}
    pairs = read_pairs(
        read_sweep(
            write_synthetic(
                tmp_path, axes, 30, scatter=0.1, effect=lambda v: 1.6 if v[DT] > 0.01 else 1.0
            )
        )
    )
    told = [paragraph.text for paragraph in shortfalls(pairs) if paragraph.warning]
    assert any(
        "Δt (with a time step above 1 ms)" in text and "among 4 comparisons" in text
        for text in told
    )
    assert any(
        "μ: with 30 motions a KS distance below 0.35 cannot be told from 0" in text
        and "needs about N = 369" in text
        for text in told
    )
    rows = {(row[0], row[1]): row for row in families(pairs).rows}
    assert rows["contact.friction_coefficient", "all"][-2:] == (
        pytest.approx(math.sqrt(math.log(40 * 3) / 30)),
        369,
    )
