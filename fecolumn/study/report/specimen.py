"""Section at the top: the specimen, one of its ground motions, and what all analyses have in
common.
"""

from __future__ import annotations

import numpy as np

from fecolumn.motions.record import GroundMotion
from fecolumn.pictures.figures.specimen_figure import specimen_figure
from fecolumn.pictures.figures.specimen_outline import specimen_outline
from fecolumn.study.report.document import PageSection, Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.intensity import NOT_FOUND, Intensities
from fecolumn.study.report.notation import count, fixed, sentence, setting_text
from fecolumn.study.report.sweep import Sweep


def specimen(sweep: Sweep, gallery: Gallery, intensities: Intensities) -> PageSection | None:
    """The section; None where neither the specimen's shape nor a motion is to be found."""
    varied = {axis.partition(".")[0] for axis in sweep.varied} & {"column", "cap", "flange", "base"}
    outline = specimen_outline(sweep.case) if sweep.case else None
    motion, motion_text = _middle(sweep, intensities)
    if outline is None and motion is None:
        return None
    tilt = next((run.get("critical_tilt_rad") for run in sweep.reference.runs.values()), None)
    same = {axis: levels[0] for axis, levels in sweep.axes.items() if len(levels) == 1}
    text = (
        "[[specimen]] shows "
        f"{'one of the ground motions' if outline is None else 'what was analysed'}. "
    )
    if outline is not None:
        text += (
            "Specimen: "
            f"{outline.words}{' in the first setting; others vary it' if varied else ''}. "
        )
    text += motion_text + (f"In all analyses {setting_text(same)}." if same else "")
    shown = [
        words
        for words, there in (
            ("the specimen to scale and its foot, enlarged", outline is not None),
            ("the motion of median PGV in the setting of reference", motion is not None),
        )
        if there
    ]
    return PageSection(
        "Specimen and motions",
        [
            Paragraph(text),
            gallery.draw(
                "specimen",
                f"{sentence(', and '.join(shown))}.",
                specimen_figure,
                outline,
                tilt,
                motion,
            ),
        ],
    )


def _middle(sweep: Sweep, intensities: Intensities) -> tuple[GroundMotion | None, str]:
    """The motion of median PGV of the reference setting, None where it is not to be found, and what
    is said of all.
    """
    runs = list(sweep.reference.runs.values())
    try:
        pgv = np.array([intensities.peaks(run)[0] for run in runs])
        motion = intensities.motion(runs[int(np.argsort(pgv, kind="stable")[len(runs) // 2])])
    except NOT_FOUND:
        return None, ""
    low, high = pgv.min(), pgv.max()
    reach = f"{fixed(low)} m/s" if np.isclose(low, high) else f"{fixed(low)} to {fixed(high)} m/s"
    return (
        motion,
        f"{sentence(sweep.at(sweep.reference.values))} the {count(len(runs), 'motion')} "
        f"have peak ground velocities of {reach} (RotD50). ",
    )
