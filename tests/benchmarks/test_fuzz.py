"""A hundred damaged files of every kind, each used or refused in one line; two thousand are `python
-m benchmarks.fuzz`.
"""

import collections

import pytest

from benchmarks.fuzz import SUBJECTS, watch


@pytest.mark.long
@pytest.mark.parametrize("subject", SUBJECTS)
def test_damaged_files_are_used_or_refused_in_one_line(subject):
    ends = list(watch.watched(subject, list(range(20)), seed=12))
    assert len(ends) == 20 and not [end for end in ends if end.verdict in watch.BAD]
    assert collections.Counter(end.verdict for end in ends)["refused"] >= 3


@pytest.mark.slow
@pytest.mark.parametrize("subject", ["calibrations", "classes"])
def test_three_hundred_mutants_of_calibrations_and_of_classes(subject):
    ends = list(watch.watched(subject, list(range(320)), seed=36))
    assert len(ends) == 320 and not [end for end in ends if end.verdict in watch.BAD]
    verdicts = collections.Counter(end.verdict for end in ends)
    assert verdicts["refused"] >= 100 and verdicts["used"] >= 10


@pytest.mark.long
@pytest.mark.parametrize(
    "code, verdict", [("import os; os.abort()", "death"), ("import time; time.sleep(100)", "hang")]
)
def test_deaths_and_hangs_are_seen_and_the_rest_is_done(monkeypatch, code, verdict):
    real, calls = watch.subprocess.Popen, []

    def popen(command, **more):
        calls.append(command)
        return real(["python3", "-c", code] if len(calls) == 1 else command, **more)

    monkeypatch.setattr(watch.subprocess, "Popen", popen)
    patience = 60.0 if verdict == "death" else 3.0
    first = next(watch.watched("cases", [0, 1], 12, patience))
    assert (first.number, first.verdict) == (0, verdict)
