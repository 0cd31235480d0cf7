"""What a number of motions can show, and how many a finding needs."""

from __future__ import annotations

from fecolumn.statistics.equivalence import SMALL, detectable_distance, motions_needed
from fecolumn.statistics.records import record_count, run_count
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
    common, needed = common_motions(sweep.done), motions_needed(wanted)
    least = min(sweep.done, key=lambda setting: len(setting.runs))
    records = least.records_of(common or None)
    n, (low, high) = record_count(records, len(records)), sweep.reference.overturning()
    text = (
        f"{run_count(len(records), records, 'motion')}: a difference of two CDFs below "
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
