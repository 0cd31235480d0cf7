"""The report says how many analyses failed at each setting, and what follows from that."""

from synthetic_study import DT, write_synthetic

from fecolumn.study.report.audit import failed_note
from fecolumn.study.report.sweep import read_sweep


def test_failed_analyses_are_told_by_their_setting(tmp_path):
    folder = write_synthetic(tmp_path / "some", {DT: [0.02, 0.001]}, 8, fails=(0, 1, 2, 15))
    note = failed_note(read_sweep(folder))
    assert "3 of 8 analyses at" in note and "1 of 8 analyses at" in note
    assert "may be biased" in note and "add --retry-failed" in note
    whole = write_synthetic(tmp_path / "none", {DT: [0.02, 0.001]}, 8)
    assert failed_note(read_sweep(whole)) == ""
