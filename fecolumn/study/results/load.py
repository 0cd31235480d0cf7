"""What a folder holds, as an object."""

from __future__ import annotations

from pathlib import Path

from fecolumn.foundation.schema import InputError
from fecolumn.study.results.analysis import AnalysisResult
from fecolumn.study.results.study import StudyResult


def load(folder: str | Path) -> AnalysisResult | StudyResult:
    """The analysis or the study in a result folder, finished or not.

    Raises
    ------
    InputError
        no such folder, or one that holds neither.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(folder, "", None, "no such folder")
    if (folder / "study.json").exists():
        return StudyResult(folder)
    if (folder / "case.json").exists():
        return AnalysisResult(folder)
    raise InputError(
        folder, "", None, "holds neither an analysis (case.json) nor a study (study.json)"
    )
