"""The specimen on its own mesh in both engines."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.case.case import Case, case_from_tables
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.observe import COLUMNS
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.structures.structure import structure_model

SPECIMEN = Path(__file__).parents[2] / "meshes" / "specimen.toml"
# a base wide enough to slide on
WIDE = {"base": {"length_m": 0.4, "width_m": 0.4}, "integration": {"engine": "reduced"}}
_PLACES = dict(zip((name for name, _ in COLUMNS), np.cumsum([0, *(width for _, width in COLUMNS)])))


def case_of(**tables) -> Case:
    """Case of the specimen in the reduced engine."""
    return case_from_tables(merge(merge(read_toml(SPECIMEN), WIDE), tables), SPECIMEN)


def engine(case: Case) -> Engine:
    """Reduced engine of a case at its start, from the model on disk."""
    return engine_of(case, structure_model(case), "specimen.toml")


def column(rows: np.ndarray, name: str) -> np.ndarray:
    """A column of the reduced engine's rows by its name in the history file."""
    place, width = _PLACES[name], dict(COLUMNS)[name]
    return rows[:, place] if width == 1 else rows[:, place : place + width]
