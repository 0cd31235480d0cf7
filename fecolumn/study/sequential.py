"""A study that goes on until its question is decided: more motions of its ensemble until each pair
of settings is told apart, or told alike.

Motions that are one record, turned, come together, and stages count records.

A look at the results after each stage of motions may end it. Each look is one more chance to be
wrong, so that the error allowed is divided among the looks that are planned (Bonferroni): whatever
the course of the study, a false statement on a pair is as rare as that error. Each gets its share
by its number of motions, since few decide little. For "differ" the p-values are corrected (Holm
1979) for all pairs besides.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.equivalence import SMALL
from fecolumn.statistics.holm import holm
from fecolumn.statistics.records import run_count
from fecolumn.study.conclusion import records_of, settings_of
from fecolumn.study.plan import Plan, record_of
from fecolumn.study.setting_pairs import (
    MOST_PAIRS,
    SettingPair,
    pair_count,
    pairs_of,
    setting_lines,
)
from fecolumn.study.substeps import SettingTables

DIFFER, ALIKE, STILL_OPEN = "differ", "alike", "open"
#: Records of the first stage; each stage has twice as many as the one before.
FIRST = 40


@dataclass(frozen=True, slots=True)
class Rule:
    """When a study is decided: two settings are alike where the data exclude a distance of their
    CDFs beyond `margin`; `error`: allowed for each statement; `most`: records in each setting at
    most.
    """

    margin: float = SMALL
    error: float = 0.05
    most: int = 1000

    def check(self, file: Path | str) -> None:
        """Refuse a rule that cannot be followed.

        Raises
        ------
        InputError
            names the option and its range.
        """
        for option, value, low, high in (
            ("--margin", self.margin, 0.01, 0.5),
            ("--error", self.error, 0.001, 0.2),
        ):
            if not low <= value <= high:
                raise InputError(file, option, value, f"must lie in [{low:g}, {high:g}]")
        if self.most < FIRST:
            raise InputError(
                file, "--most", self.most, f"must be at least {FIRST} motions, the first stage"
            )


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is said of a pair of settings."""

    pair: SettingPair
    word: str

    def judged(self, rule: Rule) -> str:
        """The verdict in words."""
        return {
            DIFFER: "differ",
            ALIKE: f"alike within {rule.margin:g}",
            STILL_OPEN: "not decided",
        }[self.word]

    def text(self, rule: Rule) -> str:
        """One line for a reader."""
        pair = self.pair
        return (
            f"{pair.names[0]} and {pair.names[1]}: {self.judged(rule)}; distance "
            f"{pair.distance:.3f}, at most {pair.bound:.3f}, p = {pair.p:.4f}, N = {pair.n}"
            + (f" of {pair.records} records" if pair.records < pair.n else "")
        )


def stages(plan: Plan, rule: Rule) -> list[int]:
    """Numbers of records after which the results are looked at: of motions, where each is one.

    Raises
    ------
    InputError
        the study has nothing to compare, or fewer records than the first stage.
    """
    of_motions = records_of(plan)
    motions = len(set(of_motions.values()))
    planned = {repr(one.combination): one.combination for one in plan.analyses}
    if len(planned) < 2:
        raise InputError(
            plan.file, "axes", None, "has one setting alone: there is nothing to decide between"
        )
    settings: list[SettingTables] = [(values, {}) for values in planned.values()]
    if (pairs := pair_count(settings, plan.sampled)) > MOST_PAIRS:
        raise InputError(
            plan.file,
            "axes",
            None,
            f"has {pairs} pairs of settings that differ in one axis alone; at most {MOST_PAIRS} "
            "are decided on: take fewer levels",
        )
    if not setting_lines(settings, plan.sampled):
        raise InputError(
            plan.file,
            "axes",
            None,
            "has no two settings that differ in one axis, or one [[zip]], alone: there is nothing "
            "to decide between",
        )
    if motions < FIRST:
        raise InputError(
            plan.file,
            "axes",
            None,
            f"has {run_count(len(of_motions), list(of_motions.values()), 'motion')}; deciding "
            f"begins with {FIRST}{' records' if motions < len(of_motions) else ''}",
        )
    last, found = min(motions, rule.most), [FIRST]
    while found[-1] < last:
        found.append(min(2 * found[-1], last))
    return found


def stage_analyses(plan: Plan, motions: int, verdicts: list[Verdict]) -> set[str]:
    """Ids of the analyses of the first so many records, of the settings that are not decided yet;
    of all before the first look.
    """
    taken = dict.fromkeys(record_of(analysis.values) for analysis in plan.analyses)
    chosen = set(itertools.islice(taken, motions))
    open_settings = {
        repr(values)
        for verdict in verdicts
        if verdict.word == STILL_OPEN
        for values in verdict.pair.settings
    }
    return {
        analysis.id
        for analysis in plan.analyses
        if record_of(analysis.values) in chosen
        and (not verdicts or repr(analysis.combination) in open_settings)
    }


def judge(
    plan: Plan,
    rows: list[dict[str, Any]],
    rule: Rule,
    looks: list[int],
    motions: int,
    before: list[Verdict],
) -> list[Verdict]:
    """Verdict on each pair of settings after a stage; those of `before` that are decided stay.

    Parameters
    ----------
    rows
        of the ledger.
    looks
        records of all stages, as of `stages`
    motions
        those of this one.
    """
    level = rule.error * motions / sum(looks)
    pairs = pairs_of(settings_of(plan, rows), records_of(plan), 1 - level, plan.sampled)
    decided = {verdict.pair.names: verdict for verdict in before if verdict.word != STILL_OPEN}
    corrected = holm([pair.p for pair in pairs])
    found = []
    for pair, p in zip(pairs, corrected):
        word = DIFFER if p < level else ALIKE if pair.bound <= rule.margin else STILL_OPEN
        found.append(decided.get(pair.names) or Verdict(pair, word))
    return found


def until_decided(
    plan: Plan, rule: Rule, work: Callable[[set[str]], list[dict[str, Any]]]
) -> Iterator[tuple[int, list[Verdict], list[dict[str, Any]]]]:
    """Work off a study stage by stage: records, verdicts and the ledger's rows after each. A stage
    is judged by its own records, whatever more is done: a study that was stopped ends as one that
    was not.

    Parameters
    ----------
    work
        function of the ids of the analyses to do that returns the ledger's rows of the plan.
    """
    verdicts: list[Verdict] = []
    looks = stages(plan, rule)
    for motions in looks:
        rows = work(stage_analyses(plan, motions, verdicts))
        seen = stage_analyses(plan, motions, [])
        done = [row for row in rows if row["id"] in seen]
        verdicts = judge(plan, done, rule, looks, motions, verdicts)
        yield motions, verdicts, rows
        if verdicts and not undecided(verdicts):
            break


def undecided(verdicts: list[Verdict]) -> int:
    """Number of pairs on which nothing is said yet."""
    return sum(verdict.word == STILL_OPEN for verdict in verdicts)


def progress_text(motions: int, verdicts: list[Verdict]) -> str:
    """One line for a reader after a stage."""
    decided = len(verdicts) - undecided(verdicts)
    shared = any(verdict.pair.records < verdict.pair.n for verdict in verdicts)
    unit = "records" if shared else "motions"
    return f"{motions} {unit}: {decided} of {len(verdicts)} pairs of settings decided"
