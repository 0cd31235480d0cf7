"""Every verification case holds in every engine; what the suite says at its end."""

import os
import signal
from dataclasses import replace
from multiprocessing import get_context

import pytest

from fecolumn.cli import main
from fecolumn.verification import suite
from fecolumn.verification.result import Row
from fecolumn.verification.suite import Finding, finding_lines, run_case, tasks, verdict


@pytest.mark.verification
@pytest.mark.parametrize("case, engine", tasks())
def test_case_holds(case, engine):
    finding = run_case(case, engine)
    missed = tuple(row for row in finding.rows if not row.ok)
    assert finding.ok, "\n" + finding_lines(replace(finding, rows=missed))


HOLDS, MISSES, UNKNOWN = (
    Row("period [s]", 2.0, 2.0, 1e-3),
    Row("drift [m]", 0.0, 0.1, 1e-3),
    Row("loss [J]", 1.0, float("nan"), 1e-3),
)


def test_the_suite_ends_with_a_count_and_the_names_of_what_does_not_hold():
    findings = [
        Finding("patch", "corotated", (HOLDS, HOLDS), 1.0),
        Finding("frames", "reduced", (HOLDS, MISSES, UNKNOWN), 1.0),
        Finding("hertz", "corotated", (), 1.0, "RuntimeError: it does not start\nat all"),
        Finding("sliding", "rigid", (), 1.0),
    ]
    assert verdict(findings).splitlines() == [
        "does not hold:",
        "  frames, reduced: drift [m]",
        "  frames, reduced: loss [J]",
        "  hertz, corotated: RuntimeError: it does not start",
        "  sliding, rigid: has no rows",
        "3 of 5 rows hold, 3 of 4 cases do not",
    ]
    assert verdict(findings[:1]) == "2 of 2 rows hold, 0 of 1 cases do not"


@pytest.mark.parametrize("row, code", [(HOLDS, 0), (MISSES, 1)])
def test_fecolumn_verify_ends_with_exit_code_1_where_a_row_does_not_hold(
    row, code, tmp_path, monkeypatch, capfd
):
    def found(pairs, folder, *_, **__):
        (folder / "table.csv").write_text("case\n")
        return [Finding(*pairs[0], (row,), 1.0)]

    monkeypatch.setattr(suite, "verify", found)
    assert main(["verify", "-k", "masonry", "-o", str(tmp_path / "out")]) == code
    assert (
        capfd.readouterr().out.splitlines()[-1]
        == f"{1 - code} of 1 rows hold, {code} of 1 cases do not"
    )


def killed(case, engine, folder, long):
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_case_that_is_killed_leaves_a_table_that_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(suite, "get_context", lambda _: get_context("fork"))
    monkeypatch.setattr(suite, "run_case", killed)
    findings = suite.verify([("patch", "corotated")], tmp_path, show=lambda _: None)
    assert [finding.ok for finding in findings] == [False]
    assert "was the memory full?" in (tmp_path / "table.csv").read_text()
