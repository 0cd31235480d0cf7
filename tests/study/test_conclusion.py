"""The two sentences below a study's table say what its numbers do, and no more."""

import io

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.study.conclusion import conclusion
from fecolumn.study.plan import read_plan
from fecolumn.study.run import run_study


def _said(tmp_path, change=None, **axes):
    plan = read_plan(write_study(tmp_path, **axes))
    rows = [dict(id=analysis.id, state="done", summary=dict(u_max_m=0.01 * (1 + number % 12), overturned=False)) for number, analysis in enumerate(plan.analyses)]
    for analysis, row in zip(plan.analyses, rows):
        if change:
            change(analysis.values, row["summary"])
    return conclusion(plan, rows)


def test_settings_with_other_peaks_are_said_to_part(tmp_path):
    def twice(values, summary):
        summary["u_max_m"] *= 1 if values["integration.dt_s"] == 0.02 else 20

    said = _said(tmp_path, twice, alpha=(0,), pulses=range(12))
    assert "0.0 % [0.0, 24.2]" in said and "part, by more than chance explains: 1.00 apart for dt_s = 0.02 and dt_s = 0.001" in said and "p < 0.001" in said


def test_equal_settings_are_not_said_to_be_equal(tmp_path):
    said = _said(tmp_path, alpha=(0,), pulses=range(12))
    assert "cannot be told from chance" in said and "p = 1.000" in said and "12 motions a distance up to 0." in said


def test_of_two_axes_the_one_that_matters_is_named(tmp_path):
    def fall(values, summary):
        summary["overturned"] = values["integration.alpha_hht"] == 0

    said = _said(tmp_path, fall, pulses=range(12))
    assert "0 of 2 by integration.dt_s, 2 of 2 by integration.alpha_hht" in said and "corrected for 4 pairs" in said
    assert "between 0.0 % [0.0, 24.2] at dt_s = 0.02, alpha_hht = -0.2 (0 of 12) and 100.0 % [75.8, 100.0]" in said


@pytest.mark.parametrize("pulses, sentences", [(4, 0), (5, 1)])
def test_few_motions_give_no_verdict(tmp_path, pulses, sentences):
    assert _said(tmp_path, dt=(1e-3,), alpha=(0,), pulses=range(pulses)).count("P(overturn)") == sentences


def test_a_real_study_is_concluded(tmp_path):
    plan = read_plan(write_study(tmp_path, alpha=(0,), pulses=range(8)))
    rows = run_study(plan, tmp_path / "out", workers=1, entry=ENTRY, stream=io.StringIO())
    assert "P(overturn) is the same at every setting, such as" in conclusion(plan, rows)
