"""Rocking and sliding of free-standing columns: finite-element contact dynamics, judged by
statistics.

Units are SI everywhere. z points up, gravity along -z; displacements are relative to the base. A
gap is positive when open, a contact pressure positive in compression.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fecolumn.case.case import Case, case_from_tables, read_case
    from fecolumn.case.case import read_case as load_case
    from fecolumn.engines.dynamics.history import read_history
    from fecolumn.foundation.schema import InputError
    from fecolumn.mesh.specimen import specimen_mesh
    from fecolumn.motions.array import motion_file
    from fecolumn.motions.load import load_motion
    from fecolumn.simulation import AnalysisFailed, run
    from fecolumn.statistics.ecdf import ecdf
    from fecolumn.study.results.analysis import AnalysisResult
    from fecolumn.study.results.load import load
    from fecolumn.study.results.script import run_study
    from fecolumn.study.results.study import StudyResult

__version__ = "0.11.0"
__all__ = [
    "AnalysisFailed",
    "AnalysisResult",
    "Case",
    "InputError",
    "StudyResult",
    "case_from_tables",
    "ecdf",
    "load",
    "load_case",
    "load_motion",
    "motion_file",
    "read_case",
    "read_history",
    "run",
    "run_study",
    "specimen_mesh",
]

# module of each name, and the name there where it is another; as imported above
_HOMES = {
    "Case": "case.case:Case",
    "load_case": "case.case:read_case",
    "case_from_tables": "case.case",
    "InputError": "foundation.schema",
    "run": "simulation",
    "AnalysisFailed": "simulation",
    "run_study": "study.results.script",
    "load": "study.results.load",
    "AnalysisResult": "study.results.analysis",
    "StudyResult": "study.results.study",
    "motion_file": "motions.array",
    "specimen_mesh": "mesh.specimen",
    "load_motion": "motions.load",
    "ecdf": "statistics.ecdf",
    # names of earlier versions
    "read_case": "case.case",
    "read_history": "engines.dynamics.history",
}


def __getattr__(name: str) -> object:
    """Import on first use, so that `fecolumn --help` does not wait for dolfinx."""
    if name not in _HOMES:
        raise AttributeError(f"module fecolumn has no attribute {name!r}")
    import importlib

    module, _, there = _HOMES[name].partition(":")
    return getattr(importlib.import_module(f"fecolumn.{module}"), there or name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
