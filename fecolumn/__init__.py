"""Rocking and sliding of free-standing columns: finite-element contact dynamics, judged by statistics.

Units are SI everywhere. z points up, gravity along -z; displacements are relative to the base. A gap is positive when open,
a contact pressure positive in compression.
"""

__version__ = "0.3.0"

_HOMES = {"Case": "case", "read_case": "case", "case_from_tables": "case", "InputError": "schema", "run": "simulation",
          "AnalysisFailed": "simulation", "specimen_mesh": "mesh.specimen", "load_motion": "motions.load",
          "read_history": "dynamics.history", "ecdf": "statistics.ecdf"}
__all__ = list(_HOMES)


def __getattr__(name):
    """Import on first use, so that `fecolumn --help` does not wait for dolfinx."""
    if name not in _HOMES:
        raise AttributeError(f"module fecolumn has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"fecolumn.{_HOMES[name]}"), name)
