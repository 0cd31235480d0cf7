"""The sentences below a study's table say what its numbers do, and no more."""

import io

import pytest
from rocking_block import ENTRY
from study_files import SPECIMEN, write_study

from fecolumn.study.conclusion import conclusion
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study


def _said(tmp_path, change=None, **axes):
    plan = read_plan(write_study(tmp_path, **axes))
    rows = [
        dict(
            id=analysis.id,
            state="done",
            summary=dict(u_max_m=0.01 * (1 + number % 12), overturned=False),
        )
        for number, analysis in enumerate(plan.analyses)
    ]
    for analysis, row in zip(plan.analyses, rows):
        if change:
            change(analysis.values, row["summary"])
    return conclusion(plan, rows)


def test_settings_with_other_peaks_are_said_to_part(tmp_path):
    def twice(values, summary):
        summary["u_max_m"] *= 1 if values["integration.dt_s"] == 0.02 else 20

    said = _said(tmp_path, twice, alpha=(0,), pulses=range(12))
    assert (
        "0.0 % [0.0, 24.2]" in said
        and "part, by more than chance explains: 1.00 apart for dt_s = 0.02 and dt_s = 0.001"
        in said
        and "p < 0.001" in said
    )


def test_equal_settings_are_not_said_to_be_equal(tmp_path):
    said = _said(tmp_path, alpha=(0,), pulses=range(12))
    assert (
        "cannot be told from chance" in said
        and "p = 1.000" in said
        and "12 motions a distance up to 0." in said
    )


def test_of_two_axes_the_one_that_matters_is_named(tmp_path):
    def fall(values, summary):
        summary["overturned"] = values["integration.alpha_hht"] == 0

    said = _said(tmp_path, fall, pulses=range(12))
    assert (
        "0 of 2 by integration.dt_s, 2 of 2 by integration.alpha_hht" in said
        and "corrected for 4 pairs" in said
    )
    assert (
        "between 0.0 % [0.0, 24.2] at dt_s = 0.02, alpha_hht = -0.2 (0 of 12) and "
        "100.0 % [75.8, 100.0]" in said
    )


@pytest.mark.parametrize("pulses, sentences", [(4, 0), (5, 1)])
def test_few_motions_give_no_verdict(tmp_path, pulses, sentences):
    assert (
        _said(tmp_path, dt=(1e-3,), alpha=(0,), pulses=range(pulses)).count("P(overturn)")
        == sentences
    )


def test_a_real_study_is_concluded(tmp_path):
    plan = read_plan(write_study(tmp_path, alpha=(0,), pulses=range(8)))
    rows = complete_study(plan, tmp_path / "out", workers=1, entry=ENTRY, stream=io.StringIO())
    assert "P(overturn) is the same at every setting, such as" in conclusion(plan, rows)


def test_few_motions_are_said_to_be_few_for_no_difference(tmp_path):
    """sqrt(ln 40 / 40) = 0.30; ln 40 / 0.1^2 = 369."""
    said = _said(tmp_path, alpha=(0,), pulses=range(40))
    assert (
        "With 40 motions a KS distance below 0.30 cannot be told from 0: the claim of "
        "no difference beyond 0.10 needs about N = 369." in said
    )


def test_few_motions_are_said_to_be_few_for_a_small_difference_among_several(tmp_path):
    """Of 40 motions 9 fall at one of three steps: paired p 0.01 of a distance of 0.23, which
    independent ensembles show by chance.
    """

    def fall(values, summary):
        summary["overturned"] = (
            values["integration.dt_s"] == 0.02
            and int(values["motion.source"].partition(":")[2]) < 9
        )
        summary["u_max_m"] = 0.01

    said = _said(tmp_path, fall, dt=(0.02, 1e-3, 5e-4), alpha=(0,), pulses=range(40))
    assert "differs" not in said and "2 of 3 by integration.dt_s" in said
    # sqrt(ln 120 / 40) = 0.35; ln 120 / 0.225^2 = 95
    assert (
        "With 40 motions a KS distance below 0.35 cannot be told from 0 among 3 "
        "comparisons but by the pairing of motions: the claim of a difference of "
        "0.23 needs about N = 95."
    ) in said.replace("0.22 needs", "0.23 needs")


def test_motions_that_are_enough_bring_no_warning(tmp_path):
    def twice(values, summary):
        summary["u_max_m"] *= 1 if values["integration.dt_s"] == 0.02 else 20

    assert "With 12 motions" not in _said(tmp_path, twice, alpha=(0,), pulses=range(12))


@pytest.mark.parametrize(
    "case, said",
    [("", True), ('[contact]\nimpact = "none"\n[integration]\nengine = "full"\n', False)],
)
def test_an_effect_of_alpha_is_stated_with_what_the_scheme_builds_in(tmp_path, case, said):
    (tmp_path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n{case}')
    assert (
        "alpha is kept from contact"
        in _said(tmp_path, dt=(1e-3,), pulses=range(8), case=tmp_path / "case.toml")
    ) == said
    assert "alpha is kept" not in _said(
        tmp_path, alpha=(0,), pulses=range(8), case=tmp_path / "case.toml"
    )


@pytest.mark.parametrize(
    "case, word",
    [
        ("", "rolling"),
        ('[integration]\nsubsteps = "impacts"\n', "impacts"),
        ('[integration]\nsubsteps = "none"\n', ""),
    ],
)
def test_a_sweep_of_the_step_says_that_steps_were_made_in_parts(tmp_path, case, word):
    def counted(values, summary):
        coarse = values["integration.dt_s"] == 0.02
        summary |= dict(
            steps=500 if coarse else 10000, parts=0 if not word else 900 if coarse else 40
        )

    (tmp_path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n{case}')
    for pulses in (2, 12):
        said = _said(
            tmp_path, counted, alpha=(0,), pulses=range(pulses), case=tmp_path / "case.toml"
        )
        assert (
            "900 beside 500 steps at dt_s = 0.02, 40 beside 10000 steps at dt_s = 0.001" in said
        ) == bool(word)
        assert (f'integration.substeps = "{word}"' in said) == bool(word)
    assert "beside" not in _said(
        tmp_path, counted, dt=(0.02,), pulses=range(12), case=tmp_path / "case.toml"
    )


def test_literal_steps_beside_those_in_parts_are_not_counted_among_them(tmp_path):
    def counted(values, summary):
        summary |= dict(steps=500, parts=900 if values["integration.substeps"] == "rolling" else 0)

    (tmp_path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n')
    said = _said(
        tmp_path,
        counted,
        alpha=(0,),
        pulses=range(6),
        case=tmp_path / "case.toml",
        extra='"integration.substeps" = ["none", "rolling"]\n',
    )
    assert (
        said.count("is made in parts") == 1
        and "900 beside 500 steps at dt_s = 0.02, 900 beside 500" in said
    )
