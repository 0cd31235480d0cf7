"""An answer does not depend on what failed analyses would have been: what it says is decided holds
for all that they might have been.
"""

import csv
import itertools
import json
import sqlite3
from types import SimpleNamespace

import numpy as np
import pytest

import fecolumn
from fecolumn.cli import main
from fecolumn.engines.dynamics.cuts import Stop
from fecolumn.study.questions.design import DesignQuestion
from fecolumn.study.questions.design_words import design_answer, design_notes
from fecolumn.study.questions.limit import read_event, read_limit
from fecolumn.study.questions.objects import ListedObject
from fecolumn.study.questions.screening import answer_of, screened, screening_table

KEY = "joints.vase.friction_coefficient"
LEFT = (
    f"AnalysisFailed: t = 0.99 s: {Stop.OFF_PATCH.value}: vase: vase on plinth; "
    "joints.vase.allowance_m (left out: 0.04 m) must be larger than the slide, 0 to 1000 m: more "
    "of the face is then prepared; state saved in out/checkpoint.npz"
)


def looked(counts, share=0.2):
    """A design question of which all is known; counts: by value, of runs beyond the limit, others
    that are done, and failed ones.
    """
    analyses, rows = [], []
    for value, (k, within, failed) in counts.items():
        outcomes = [True] * k + [False] * within + [None] * failed
        for number, beyond in enumerate(outcomes):
            name = f"{value} {number}"
            values = {KEY: value, "motion.source": f"lick:{number + 1}"}
            analyses.append(SimpleNamespace(id=name, values=values))
            state = "failed" if beyond is None else "done"
            summary = dict(overturned=beyond, slid_off=False)
            rows.append(dict(id=name, state=state, reason=LEFT, summary=summary, axes=values))
    plan = SimpleNamespace(axes={KEY: list(counts)}, analyses=analyses)
    question = DesignQuestion(plan, KEY, read_limit(f"P(overturn) < {share}", "fecolumn design"))
    places = [0, len(question.grid) - 1]
    while places:
        question.take(places, rows)
        places = question.wanted()
    return question


VASE = {0.12: (0, 2, 14), 0.18: (2, 3, 11), 0.24: (3, 6, 7), 0.3: (3, 9, 4)}


def test_vase_whose_runs_fail_by_sliding_is_not_decided():
    """With a larger allowance 14 of 16 are beyond the limit at 0.12 and 7 of 16 at 0.3."""
    question = looked(VASE)
    said = design_answer(question)
    assert not question.decided and question.place() is None
    assert "is not decided along joints.vase.friction_coefficient = 0.12:0.3" in said
    assert "0 of 2 with 14 more failed at 0.12, 3 of 12 with 4 more failed at 0.3" in said
    assert "between 0.0 and 87.5 %" in said and "between 18.8 and 43.8 %" in said
    assert "needs" not in said and Stop.OFF_PATCH.value in said
    assert "give joints.vase.allowance_m a value larger" in said
    assert not any("motions cannot tell" in note for note in design_notes(question))


def test_size_that_failed_analyses_cannot_move_is_told():
    question = looked({1.0: (0, 39, 1), 2.0: (1, 39, 0), 3.0: (30, 8, 2), 4.0: (40, 0, 0)})
    said = design_answer(question)
    assert question.decided and question.grid[question.place().kept] == 2.0
    assert "of at most 2," in said and "the answer holds whatever they would have been" in said
    assert "3 of 160 analyses failed" in said


def test_size_between_those_of_no_failed_one_and_of_all_is_told():
    question = looked({1.0: (0, 40, 0), 2.0: (3, 27, 10), 3.0: (30, 10, 0), 4.0: (40, 0, 0)})
    said = design_answer(question)
    assert not question.decided and "needs at most a value between 1 and 2" in said


@pytest.mark.parametrize("word, counts", [("kept", (0, 35, 5)), ("broken", (20, 15, 5))])
def test_ends_that_failed_analyses_cannot_change_are_told(word, counts):
    question = looked({1.0: counts, 2.0: counts})
    assert f"is {word} at both ends" in design_answer(question) and question.decided


@pytest.mark.parametrize("seed", range(6))
def test_decided_place_is_that_of_every_outcome_of_the_failed(seed):
    rng, decided = np.random.default_rng(seed), 0
    for _ in range(20):
        counts = {}
        for value, p in zip((1.0, 2.0, 3.0, 4.0), np.sort(rng.random(4))):
            k, failed = int(rng.binomial(20, p)), int(rng.integers(0, 3))
            k = min(k, 20 - failed)
            counts[value] = (k, 20 - failed - k, failed)
        question = looked(counts, 0.4)
        if not question.decided:
            continue
        decided += 1
        place, kept = question.place(), question.kept_at_both_ends()
        for events in itertools.product(*(range(one[2] + 1) for one in counts.values())):
            shares = [(one[0] + more) / 20 for one, more in zip(counts.values(), events)]
            if place:
                assert shares[place.kept] < 0.4 <= shares[place.broken]
            else:
                assert (shares[0] < 0.4) == (shares[-1] < 0.4) == kept
    assert decided


OBJECTS = [ListedObject(name, 0.1, 0.1, 0.5, mass, 0.4) for name, mass in (("a", 1.0), ("b", 2.0))]


def screening(*counts):
    """Objects a and b, each with runs that overturned, stood, and failed."""
    analyses, rows = [], []
    for one, outcomes in zip(OBJECTS, counts):
        states = [True] * outcomes[0] + [False] * outcomes[1] + [None] * outcomes[2]
        for number, fallen in enumerate(states):
            name = f"{one.name} {number}"
            analyses.append(SimpleNamespace(id=name, combination={"mass": one.mass}))
            summary = dict(overturned=fallen, slid_off=False, u_max_m=0.01)
            state = "failed" if fallen is None else "done"
            rows.append(dict(id=name, state=state, reason=LEFT, summary=summary))
    limits = [read_event("overturn", "")]
    ranked = screened(OBJECTS, SimpleNamespace(analyses=analyses), rows, limits)
    return ranked, answer_of(ranked, limits, rows), screening_table(ranked, limits)


def test_object_that_failed_may_be_the_most_endangered():
    """Of what is done b is the worst; a may be."""
    ranked, said, table = screening((0, 2, 8), (3, 7, 0))
    assert ranked[0].object.name == "a" and "is not decided" in said and "'a', 'b'" in said
    assert "between 0.0 and 80.0 %" in said and "joints.vase.allowance_m" in said
    assert [row[-1] for row in table] == ["failed", 8, 0]


def test_object_that_is_the_most_endangered_whatever_failed_is_told():
    _, said, _ = screening((9, 1, 0), (1, 7, 2))
    assert "Most endangered of 2 is 'a'" in said and "2 of 20 analyses failed" in said


def test_object_of_which_nothing_is_done_is_not_passed_over():
    ranked, said, table = screening((0, 0, 10), (3, 7, 0))
    assert [one.object.name for one in ranked] == ["a", "b"] and "is not decided" in said
    assert table[1][-4:] == ["", "0.000000", "1.000000", 10]


@pytest.fixture(scope="module")
def pulsed(tmp_path_factory):
    """A study of a block that overturns by strong pulses, and a hazard curve."""
    folder = tmp_path_factory.mktemp("pulsed")
    amplitudes = [f"{one:g}" for one in np.linspace(1.5, 9.0, 16)]
    words = ["--amplitudes", *amplitudes, "--periods", "0.5", "1.0", "-o", str(folder / "p.h5")]
    assert main(["motions", "make", "pulses", "symmetric_ricker", *words]) == 0
    (folder / "study.toml").write_text(
        "[case.block]\nwidth_m = 0.4\nheight_m = 2.0\n[case.integration]\ndt_s = 0.005\n"
        f'[axes]\n"motion.source" = ["{folder / "p.h5"}#*"]\n'
    )
    (folder / "hazard.csv").write_text("pga_m_s2,annual_frequency\n0.2,0.1\n2,1e-3\n20,1e-5\n")
    words = ["study", str(folder / "study.toml"), "-o", str(folder / "out"), "-j", "1", "-q"]
    assert main(words) == 0
    return folder


def told(file):
    with open(file) as text:
        (row,) = csv.DictReader(text)
    return {key: float(value) for key, value in row.items() if key not in ("setting",)}


@pytest.mark.long
def test_risk_and_fragility_reach_over_what_failed_analyses_might_have_been(
    pulsed, tmp_path, capsys
):
    study, hazard = str(pulsed / "out"), str(pulsed / "hazard.csv")
    risk = ["risk", study, "--hazard", hazard, "-o"]
    curve = ["fragility", study, "--im", "pga_m_s2", "-o"]
    assert main([*risk, str(tmp_path / "r")]) == 0 and main([*curve, str(tmp_path / "f")]) == 0
    with sqlite3.connect(pulsed / "out" / "study.sqlite") as ledger:
        found = ledger.execute("SELECT id, summary FROM analysis").fetchall()
        fallen = [case for case, summary in found if json.loads(summary)["overturned"]]
        for case in fallen[:6]:  # those that overturned first
            (pulsed / "out" / "analyses" / case / "summary.json").unlink()
            ledger.execute(
                "UPDATE analysis SET state = 'failed', reason = ?, summary = NULL WHERE id = ?",
                (LEFT, case),
            )
    capsys.readouterr()
    assert main([*risk, str(tmp_path / "r2")]) == 1 and main([*curve, str(tmp_path / "f2")]) == 1
    said = capsys.readouterr().err
    assert said.count("6 of 32 analyses failed: the intervals reach from none of them") == 2
    assert said.count("joints.vase.allowance_m") == 2
    whole, partly = told(tmp_path / "r" / "risk.csv"), told(tmp_path / "r2" / "risk.csv")
    assert partly["annual_frequency_low"] <= whole["annual_frequency"]
    assert partly["annual_frequency_high"] >= 0.95 * whole["annual_frequency_high"]
    before = told(tmp_path / "f" / "fragility.csv")
    after = told(tmp_path / "f2" / "fragility.csv")
    assert after["median_low"] <= before["median_low"] * 1.01
    assert after["median_high"] >= after["median_pga_m_s2"] > before["median_pga_m_s2"]
    answer = fecolumn.risk(study, tmp_path / "script", hazard=hazard)
    assert answer.failed == 6
