"""What a number of motions can show, and how many a finding needs."""

from __future__ import annotations

from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.statistics.equivalence import SMALL, detectable_distance, motions_needed
from fecolumn.study.report.document import Paragraph
from fecolumn.study.report.notation import count, fixed, percent
from fecolumn.study.report.sweep import Sweep, common_motions


def power(sweep: Sweep, wanted: float = SMALL, why: str = "") -> Paragraph:
    """What the motions of a study can tell of a difference between two settings; a warning where it
    is not a difference of `wanted`.

    Parameters
    ----------
    sweep
        the study, with at least one finished run.
    wanted
        distance of two CDFs that is to be seen.
    why
        what needs it, as words after a number of motions.
    """
    n, needed = (
        len(common_motions(sweep.done)) or min(len(setting.runs) for setting in sweep.done),
        motions_needed(wanted),
    )
    overturned = int(sweep.reference.column("overturned").sum())
    low, high = proportion_interval(overturned, len(sweep.reference.runs))
    text = (
        f"{count(n, 'motion')}: a difference of two CDFs below "
        f"{fixed(detectable_distance(n))} cannot be seen (Kolmogorov-Smirnov, 5 %; the "
        "same motions in both "
        f"settings show somewhat less); {fixed(wanted)} would need about "
        f"{count(needed, 'motion')}{why}. One P(overturn) is known to about "
        f"±{percent((high - low) / 2)} only"
    )
    return Paragraph(
        f"{text}. A difference that is not significant here is not shown to be nil, and "
        "one that is may shrink with more motions.",
        n < needed,
    )
