"""Rocking and sliding of free-standing columns: finite-element contact dynamics, judged by
statistics.

Units are SI everywhere. z points up, gravity along -z; displacements are relative to the base. A
gap is positive when open, a contact pressure positive in compression.
"""

__version__ = "0.7.0"

# module, and the name there where it is another
_HOMES = {
    "Case": "case",
    "load_case": "case:read_case",
    "case_from_tables": "case",
    "InputError": "schema",
    "run": "simulation",
    "AnalysisFailed": "simulation",
    "run_study": "results.script",
    "load": "results.load",
    "AnalysisResult": "results.analysis",
    "StudyResult": "results.study",
    "motion_file": "motions.array",
    "specimen_mesh": "mesh.specimen",
    "load_motion": "motions.load",
    "ecdf": "statistics.ecdf",
    # names of earlier versions
    "read_case": "case",
    "read_history": "dynamics.history",
}
__all__ = list(_HOMES)


def __getattr__(name):
    """Import on first use, so that `fecolumn --help` does not wait for dolfinx."""
    if name not in _HOMES:
        raise AttributeError(f"module fecolumn has no attribute {name!r}")
    import importlib

    module, _, there = _HOMES[name].partition(":")
    return getattr(importlib.import_module(f"fecolumn.{module}"), there or name)


def __dir__():
    return sorted([*globals(), *_HOMES])
