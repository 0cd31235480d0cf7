"""What a study says, in a few sentences below its table: how often the column overturns, whether
its settings differ, and how sure that is.
"""

from __future__ import annotations

from typing import Any

from fecolumn.statistics.equivalence import difference_shortfall, equality_shortfall
from fecolumn.statistics.failed_runs import RunCount, interval_of_all
from fecolumn.statistics.holm import holm
from fecolumn.statistics.records import record_count
from fecolumn.study.alpha import ALPHA_KEY, alpha_note
from fecolumn.study.failures import may_be_biased, why_failed
from fecolumn.study.plan import Plan, member_of, record_of
from fecolumn.study.setting_pairs import (
    LEAST_RECORDS,
    MOST_PAIRS,
    MotionRecords,
    SettingPair,
    pair_count,
    pairs_of,
    setting_name,
)
from fecolumn.study.setting_rows import SettingRows, rows_by_setting
from fecolumn.study.substeps import SettingTables, substeps_note

_FEW = 5  # records below which nothing is said of P(overturn)
_LEVEL = 0.05  # of significance, the usual one


def conclusion(plan: Plan, rows: list[dict[str, Any]]) -> str:
    """A few sentences on a study as far as it is done; of fewer than five records no more than that
    steps were made in parts, and what failed.

    How often the column overturns; that runs share records, where they do; whether the settings
    differ; where the motions are few for what is said, how many it needs; what of an effect of
    alpha, or its lack, is built into the scheme; how many parts of steps were made, where the step
    is varied; how many analyses of each setting failed, why, and what to do. p-values are of the
    largest distance of two CDFs, settings swapped within motions, corrected (Holm) for all pairs
    compared.

    Parameters
    ----------
    plan
        the study.
    rows
        its ledger, as `complete_study` returns it.
    """
    settings = settings_of(plan, rows)
    failed = [one for one in rows_by_setting(plan, rows) if one.failed]
    parts_made = " ".join(
        part for part in (substeps_note(plan.case, settings), _failures(failed)) if part
    )
    records = records_of(plan)
    counts = [
        (len(runs), record_count([records[motion] for motion in runs], len(runs)))
        for _, runs in settings
    ]
    if max((count for _, count in counts), default=0) < _FEW:
        return parts_made
    pairs = pairs_of(settings, records, sampled=plan.sampled)
    sampled = len(plan.sampled) > 1 < len(settings) and not pair_count(settings, plan.sampled)
    parts = [_overturns(settings, records, failed), _shared(*max(counts))]
    if pairs:
        parts += [
            _differences(pairs),
            _not_compared(pair_count(settings, plan.sampled), pairs),
            _shortfall(pairs),
        ]
        if any(pair.axis == ALPHA_KEY for pair in pairs):
            parts.append(alpha_note(plan.case, plan.axes))
    if sampled:
        parts.append(
            "Its settings are samples, no two of which differ in one axis alone: fecolumn report "
            "ranks the axes by what they change."
        )
    return " ".join(part for part in (*parts, parts_made) if part)


def settings_of(plan: Plan, rows: list[dict[str, Any]]) -> list[SettingTables]:
    """Axis values and, by motion, the summary of what is done, of each setting with anything
    done.
    """
    motions = {analysis.id: member_of(analysis.values) for analysis in plan.analyses}
    return [
        (one.values, {motions[row["id"]]: row["summary"] for row in one.done})
        for one in rows_by_setting(plan, rows)
        if one.done
    ]


def _failures(failed: list[SettingRows]) -> str:
    """How many analyses of each setting failed, why, and what to do; "" where none did."""
    told = [
        (f"at {setting_name(one.values)}" if one.values else "", len(one.failed), len(one.rows))
        for one in failed
    ]
    why = why_failed([row for one in failed for row in one.failed])
    return f"{may_be_biased(told)} {why}".strip()


def records_of(plan: Plan) -> MotionRecords:
    """Record of each motion of a plan, by `plan.member_of`."""
    return {member_of(analysis.values): record_of(analysis.values) for analysis in plan.analyses}


def _shared(runs: int, records: int) -> str:
    """That the runs of the largest setting share records; "" where they do not."""
    if runs == records:
        return ""
    return (
        f"The {runs} runs are of {records} records: runs of one record are not independent, and "
        "intervals and p-values count them together."
    )


def _overturns(
    settings: list[SettingTables], records: MotionRecords, failed: list[SettingRows]
) -> str:
    """P(overturn) of the setting, or of those in which it is least and most."""
    not_known = {repr(one.values): len(one.failed) for one in failed}

    def counted(setting: SettingTables) -> RunCount:
        values, runs = setting
        k = sum(bool(run["overturned"]) for run in runs.values())
        return RunCount(k, len(runs), not_known.get(repr(values), 0))

    def said(setting: SettingTables) -> str:
        count, (values, runs) = counted(setting), setting
        fallen = [bool(run["overturned"]) for run in runs.values()]
        own = [records[motion] for motion in runs]
        low, high = interval_of_all(fallen, count.failed, own)
        where = f" at {setting_name(values)}" if len(settings) > 1 else ""
        more = f", {count.failed} failed" if count.failed else ""
        return (
            f"{100 * count.share:.1f} % [{100 * low:.1f}, {100 * high:.1f}]{where} ({count.k} "
            f"of {count.n}{more})"
        )

    def share(setting: SettingTables) -> float:
        return counted(setting).share

    ranked = sorted(settings, key=share)
    p = "P(overturn) of the analyses that are done" if failed else "P(overturn)"
    ends = "in brackets the 95 % interval" + (
        " of all, whatever the failed ones would have been." if failed else "."
    )
    if len(settings) == 1:
        return f"{p} is {said(ranked[0])}; {ends}"
    if share(ranked[0]) == share(ranked[-1]):
        return f"{p} is the same at every setting, such as {said(ranked[0])}; {ends}"
    return f"{p} lies between {said(ranked[0])} and {said(ranked[-1])}; {ends}"


def _differences(pairs: list[SettingPair]) -> str:
    """Whether the distributions of the peak displacement differ, and by what."""
    corrected = holm([pair.p for pair in pairs])
    widest = max(
        range(len(pairs)), key=lambda place: (corrected[place] < _LEVEL, pairs[place].distance)
    )
    pair, p = pairs[widest], float(corrected[widest])
    judged = f"p {f'= {p:.3f}' if p >= 0.001 else '< 0.001'}, settings swapped within motions"
    apart = f"{pair.distance:.2f} apart for {pair.names[0]} and {pair.names[1]}"
    if p >= _LEVEL:
        many = (
            f"none of the {len(pairs)} pairs of settings can be told from chance: at most"
            if len(pairs) > 1
            else "the two settings cannot be told from chance:"
        )
        loosest = max(pairs, key=lambda other: other.bound)
        return (
            f"By their CDFs of u_max {many} {apart} ({judged}); with {loosest.records} "
            f"{loosest.unit} "
            f"a distance up to {loosest.bound:.2f} cannot be excluded."
        )
    if len(pairs) == 1:
        return f"The CDFs of u_max part, by more than chance explains: {apart} ({judged})."
    counts = {
        axis: [corrected[place] < _LEVEL for place, other in enumerate(pairs) if other.axis == axis]
        for axis in dict.fromkeys(p.axis for p in pairs)
    }
    told = ", ".join(f"{sum(differ)} of {len(differ)} by {axis}" for axis, differ in counts.items())
    return (
        f"The CDFs of u_max part by more than chance explains in {told}; most {apart} "
        f"({judged}, corrected for {len(pairs)} pairs)."
    )


def _not_compared(count: int, pairs: list[SettingPair]) -> str:
    """That not all pairs, `count`, were compared; "" where they were."""
    if count <= len(pairs):
        return ""
    which = (
        "those of the first and the last level, axes in turn"
        if count > MOST_PAIRS
        else f"the others have fewer than {LEAST_RECORDS} motions in both"
    )
    return f"{len(pairs)} of {count} pairs of settings were compared: {which}."


def _shortfall(pairs: list[SettingPair]) -> str:
    """Warnings where motions are too few for what is said: of the weakest difference that is
    claimed, and of the equality of the rest.
    """
    corrected = holm([pair.p for pair in pairs])
    clear = [pair for pair, p in zip(pairs, corrected) if p < _LEVEL]
    same = [pair for pair, p in zip(pairs, corrected) if p >= _LEVEL]
    told = [
        difference_shortfall(weakest.records, weakest.distance, len(pairs), weakest.unit)
        for weakest in sorted(clear, key=lambda pair: pair.distance)[:1]
    ]
    if same:
        least = min(same, key=lambda pair: pair.records)
        told.append(
            equality_shortfall(
                least.records, bound=max(pair.bound for pair in same), unit=least.unit
            )
        )
    return " ".join(one for one in told if one)
