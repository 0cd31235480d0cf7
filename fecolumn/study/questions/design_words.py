"""The answer of `fecolumn design` in words, and what a reader has to know besides."""

from __future__ import annotations

from fecolumn.statistics.crossing import (
    BROKEN,
    KEPT,
    SURELY_KEPT,
    CrossingPlace,
    crossing_place,
    runs_needed,
)
from fecolumn.study.failures import why_failed
from fecolumn.study.questions.design import DesignQuestion


def design_answer(question: DesignQuestion) -> str:
    """One sentence with the size, its interval and unit, and what it rests on; where analyses
    failed, how many, why, and what to do.
    """
    kept = question.kept_at_both_ends()
    if found := question.place():
        told = _answer_of_size(question, found)
    elif kept is not None:
        told = _answer_of_ends(question, kept)
    else:
        told = _undecided(question)
    return told + _of_failed(question)


def _answer_of_size(question: DesignQuestion, found: CrossingPlace) -> str:
    rising, unit = question.graded(False).rising, question.unit
    count = question.looked[found.kept].count
    resolution = abs(question.grid[found.kept] - question.grid[found.broken])
    open_ends = found.least is None and found.most is None
    nothing = "; every value of the range may be the size" if open_ends else ""
    failed = f", of which {count.failed} failed there" if count.failed else ""
    return (
        f"{question.limit.text} needs {question.key} of at {'least' if rising else 'most'} "
        f"{question.grid[found.kept]:g}{unit}, 95 % interval {_interval(question, found)} "
        f"({count.runs} motions, the same at each value{failed}; values {resolution:.3g}{unit} "
        f"apart; P there {count.text}){nothing}."
    )


def _interval(question: DesignQuestion, found: CrossingPlace) -> str:
    ends = [
        "below the range" if found.least is None else f"{question.grid[found.least]:g}",
        "beyond the range" if found.most is None else f"{question.grid[found.most]:g}",
    ]
    return f"[{ends[0]}, {ends[1]}]{question.unit}"


def _answer_of_ends(question: DesignQuestion, kept: bool) -> str:
    # by what is worst for the statement
    graded = question.graded(failed_beyond=kept)
    pair = graded.bracket(SURELY_KEPT if kept else BROKEN)
    doubt = ""
    if pair:
        sure = question.grid[pair[1] if kept else pair[0]]
        doubt = f", with 95 % confidence {'from' if kept else 'up to'} {sure:g}{question.unit}"
        if not graded.rising:
            doubt = doubt.replace("from", "up to") if kept else doubt.replace("up to", "from")
    elif graded.grades[0] in (BROKEN, KEPT):
        doubt = ", though the motions cannot tell it for sure"
    return (
        f"{question.limit.text} is {'kept' if kept else 'broken'} at both ends of {question.key} = "
        f"{_range(question)}{doubt} ({_counts_of_ends(question)}): the size lies beyond "
        "this range; give --vary another one."
    )


def _range(question: DesignQuestion) -> str:
    return f"{question.grid[0]:g}:{question.grid[-1]:g}{question.unit}"


def _counts_of_ends(question: DesignQuestion) -> str:
    told = []
    for one in (question.looked[0], question.looked[len(question.grid) - 1]):
        count = one.count
        failed = f" with {count.failed} more failed" if count.failed else ""
        told.append(f"{count.k} of {count.n}{failed} at {one.value:g}{question.unit}")
    return ", ".join(told)


def _undecided(question: DesignQuestion) -> str:
    """That the size is not decided, and between which values it lies where that is known."""
    few, many = question.graded(False), question.graded(True)
    places = [crossing_place(few), crossing_place(many)]
    between = ""
    if places[0] and places[1] and few.rising == many.rising:
        ends = sorted([question.grid[places[0].kept], question.grid[places[1].kept]])
        between = (
            f" It needs at {'least' if few.rising else 'most'} a value between {ends[0]:g} and "
            f"{ends[1]:g}{question.unit}, by what they would have been."
        )
    shares = " and ".join(
        f"{one.count.text} at {one.value:g}{question.unit}"
        for one in (question.looked[0], question.looked[len(question.grid) - 1])
    )
    return (
        f"{question.limit.text} is not decided along {question.key} = {_range(question)}, since "
        f"analyses failed: beyond the limit are {_counts_of_ends(question)}, so that P is "
        f"{shares}, by what the failed analyses would have been.{between}"
    )


def _of_failed(question: DesignQuestion) -> str:
    """How many analyses failed, what that means, why, and what to do; "" of none."""
    if not question.failed:
        return ""
    runs = sum(one.count.runs for one in question.looked.values())
    holds = ", and the answer holds whatever they would have been" if question.decided else ""
    return (
        f" {len(question.failed)} of {runs} analyses failed{holds}. {why_failed(question.failed)}"
    )


def design_notes(question: DesignQuestion) -> list[str]:
    """What a reader has to know besides: motions too few, or motions that return."""
    told = []
    n = max((one.count.runs for one in question.looked.values()), default=0)
    needed = runs_needed(question.limit.share)
    if n < needed:
        told.append(
            f"{n} motions cannot tell that {question.limit.text} even where none is beyond it: "
            f"{needed} can, so the interval of the size stays open"
        )
    if question.looked and (again := question.again()):
        told.append(
            f"{again} of {n} motions are beyond the limit at a value that is better for the "
            "rest: single motions are not monotone, and the size is that of the ensemble"
        )
    place = question.place() if question.looked.keys() >= {0, len(question.grid) - 1} else None
    if place and n >= needed and not question.failed and None in (place.least, place.most):
        told.append("the interval of the size ends beyond --vary: give it a wider range")
    return told
