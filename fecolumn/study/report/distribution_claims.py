"""Claims (b) and (c): the distribution does not depend on the time step once it is small, and alpha
is then marginal.
"""

from __future__ import annotations

from fecolumn.statistics.equivalence import difference_shortfall, equality_shortfall
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.claim import MARGIN, NOT_SUPPORTED, SUPPORTED, UNDECIDED, Claim
from fecolumn.study.report.notation import count, fixed, level_text, p_clause, percent, setting_text
from fecolumn.study.report.pair import FINE_STEPS, WITH_COARSE_STEP, ComparedPair
from fecolumn.study.report.sweep import DT_KEY

_SAME = (
    "supported: no paired p below 0.05 (Holm over the family) and a distance beyond "
    f"{MARGIN:.2f} excluded at 95 % in every pair, the "
    "distance at which a two-sample KS test of two times 115 motions rejects; not "
    "supported: a p below 0.05; else undecided"
)
_DIFFERENT = (
    "supported: a paired p below 0.05 (Holm over the family); not supported: none, and "
    f"a distance beyond {MARGIN:.2f} excluded at "
    "95 % in every pair; else undecided"
)
_COARSE_STEP = (
    "A coarse step does three things, it samples the motion coarsely, finds impacts "
    "late, and lets a rim strike where it should roll; motion.resample_s and "
    "integration.substeps part them (benchmarks/substeps, where it was the rolling)."
)


def distribution_claims(pairs: list[ComparedPair], alpha_note: str = "") -> list[Claim]:
    """Time step, small time step, and alpha at small time steps; alpha_note: what of alpha's
    effect, or its lack, is built in.
    """

    def family(axis: str, kind: str) -> list[ComparedPair]:
        return [pair for pair in pairs if pair.family == f"{axis}, {kind}"]

    return [
        _different(
            "b1",
            "The CDF depends moderately on Δt where steps above 1 ms take part.",
            family(DT_KEY, WITH_COARSE_STEP),
            _COARSE_STEP,
        ),
        _same(
            "b2",
            "The CDF does not depend significantly on Δt once Δt ≤ 1 ms.",
            family(DT_KEY, FINE_STEPS),
            "two time steps of 1 ms or below",
        ),
        _same(
            "c",
            "Once Δt ≤ 1 ms, the influence of α on the CDF is marginal and practically "
            "insignificant.",
            family(ALPHA_KEY, FINE_STEPS),
            "two values of α at a time step of 1 ms or below",
            alpha_note,
        ),
    ]


def _different(key: str, paper: str, pairs: list[ComparedPair], note: str) -> Claim:
    if not pairs:
        return Claim(
            key,
            paper,
            "The study has no finished pair of a step above 1 ms with another one.",
            _DIFFERENT,
            UNDECIDED,
        )
    clear, widest = (
        [pair for pair in pairs if pair.p_holm < 0.05],
        max(pairs, key=lambda pair: pair.distance),
    )
    excluded = max(pair.bound for pair in pairs)
    parts = [f"{len(clear)} of {count(len(pairs), 'pair')} differ significantly; {_widest(widest)}"]
    parts.append(_why(widest) if clear else _open(excluded))
    parts += [
        part
        for part in [
            _few(clear)
            if clear
            else equality_shortfall(
                min(pair.comparison.records_a for pair in pairs), MARGIN, excluded
            )
        ]
        if part
    ]
    parts.append(note)
    return Claim(
        key,
        paper,
        " ".join(parts),
        _DIFFERENT,
        SUPPORTED if clear else NOT_SUPPORTED if excluded <= MARGIN else UNDECIDED,
    )


def _same(key: str, paper: str, pairs: list[ComparedPair], needed: str, note: str = "") -> Claim:
    if not pairs:
        return Claim(
            key,
            paper,
            f"Not to be judged: the study has no finished pair of {needed}. {note}".rstrip(),
            _SAME,
            UNDECIDED,
        )
    clear, widest = (
        [pair for pair in pairs if pair.p_holm < 0.05],
        max(pairs, key=lambda pair: pair.distance),
    )
    excluded = max(pair.bound for pair in pairs)
    if clear:
        worst = min(clear, key=lambda pair: (pair.p_holm, -pair.distance))
        parts = [
            f"Here ours disagrees: {len(clear)} of {count(len(pairs), 'pair')} differ "
            f"significantly; {_widest(worst)}",
            _why(worst),
        ]
    else:
        independent = min(pair.comparison.ks_p for pair in pairs)
        parts = [
            f"Of {count(len(pairs), 'pair')} not one differs significantly (smallest Holm "
            f"{p_clause(min(pair.p_holm for pair in pairs))}; as independent samples, "
            f"uncorrected, {p_clause(independent)}); "
            f"{_widest(widest)}",
            _open(excluded),
            equality_shortfall(min(pair.comparison.records_a for pair in pairs), MARGIN, excluded),
        ]
    parts = [part for part in (*parts, _few(clear), note) if part]
    return Claim(
        key,
        paper,
        " ".join(parts),
        _SAME,
        NOT_SUPPORTED if clear else SUPPORTED if excluded <= MARGIN else UNDECIDED,
    )


def _few(clear: list[ComparedPair]) -> str:
    """Warning where the motions are few for the claim that the clearest pair differs; "" where they
    are not, or none differs.
    """
    if not clear:
        return ""
    widest = max(clear, key=lambda pair: pair.distance)
    return difference_shortfall(widest.comparison.records_a, widest.distance, widest.comparisons)


def _widest(pair: ComparedPair) -> str:
    return (
        f"the largest distance is {fixed(pair.distance)}, {_names(pair)} (Holm "
        f"{p_clause(pair.p_holm)}, n = {pair.comparison.n_a})."
    )


def _names(pair: ComparedPair) -> str:
    levels = f"{setting_text({pair.axis: pair.low})} against {level_text(pair.axis, pair.high)}"
    return levels + (f" at {setting_text(pair.others)}" if pair.others else "")


def _open(bound: float) -> str:
    text = (
        "Not significant is not equal: the largest difference of two CDFs that the data "
        f"cannot exclude at 95 % is {fixed(bound, 3)}"
    )
    return text + (f", below {MARGIN:.3f}." if bound <= MARGIN else f", more than {MARGIN:.3f}.")


def _why(pair: ComparedPair) -> str:
    """Which way the distribution moves, and what tells it: overturns or peaks."""
    it = pair.comparison
    change = it.p_lost_b - it.p_lost_a
    low, high = (setting_text({pair.axis: value}) for value in (pair.low, pair.high))
    text = (
        f"From {low} to {high}, {pair.p_lost} goes from {percent(it.p_lost_a)} to "
        f"{percent(it.p_lost_b)}"
    )
    return text + (
        ", which makes most of the distance."
        if abs(change) > 0.5 * pair.distance
        else ": the distance is in the peaks of runs that stand more than in those that are lost."
    )
