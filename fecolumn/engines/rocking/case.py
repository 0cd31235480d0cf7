"""What a model is run with: a case of finite elements, or a file of the model's own table, motion
and start.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.case.case import case_from_tables, case_of_table
from fecolumn.case.check_case import check_duration
from fecolumn.case.model_table import Start
from fecolumn.case.sections import UNTIL_REST, Motion, located
from fecolumn.engines.rocking.model import Model, ModelResponse
from fecolumn.engines.rocking.models import ROCKING_MODELS
from fecolumn.engines.rocking.of_bodies import model_of, start_of
from fecolumn.foundation.schema import InputError, build
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.motions.chosen import chosen_motions
from fecolumn.motions.load import load_motion
from fecolumn.motions.record import GroundMotion


@dataclass(frozen=True, slots=True)
class ModelCase:
    """A model, its motions and its start.

    Attributes
    ----------
    name
        of the model.
    model
        it.
    title
        for figures.
    file
        it was read from.
    sources
        of the motions, as in motion.source; none for a base at rest.
    motion
        the other keys of [motion], None for a base at rest.
    start
        as `model_table.Start` says.
    dt_s
        step at which motions are sampled; between samples they are straight lines [s].
    duration_s
        time followed; 0: that of the motion and its free vibration [s].
    """

    name: str
    model: Model
    title: str
    file: Path | str
    sources: tuple[str, ...]
    motion: Motion | None
    start: Start
    dt_s: float
    duration_s: float

    def response(self, source: str | None = None) -> tuple[GroundMotion, ModelResponse]:
        """Ground motion and response, to a motion of `sources`, or on a base at rest.

        Raises
        ------
        InputError
            the motion cannot be used.
        """
        dt, duration = self.dt_s, self.duration_s
        if source is None:
            ground, free = GroundMotion(np.zeros((2, 3)), dt, "at rest", ""), duration - dt
        else:
            assert self.motion is not None  # of which `source` is
            ground = load_motion(dataclasses.replace(self.motion, source=source), dt, self.file)
            # as of Analysis: a step after the last sample, in which the ground comes to rest
            free = dt + (
                self.motion.longest_free_vibration_s
                if self.motion.free_vibration_s != UNTIL_REST
                else 0.0
            )
            if duration:
                kept = max(2, round(duration / dt) + 1)
                ground, free = (
                    GroundMotion(ground.acceleration[:kept], dt, ground.name, ground.source),
                    max(0.0, duration - ground.duration),
                )
        return ground, self.model.respond(
            ground,
            free_s=free,
            tilt=self.start.tilt_rad,
            direction=math.radians(self.start.direction_deg),
        )


def read_model_case(name: str, path: Path | str) -> ModelCase:
    """A model by its name, from a file with its table, such as [block], or from a case with
    [column] or [bodies].

    Raises
    ------
    InputError
        unknown key, value out of range, parts that do not fit.
    """
    tables, cls = read_toml(path), ROCKING_MODELS[name]
    if not {"column", "bodies"} & set(tables) and not isinstance(tables.get(cls.TABLE), dict):
        raise InputError(
            path,
            cls.TABLE,
            None,
            f"missing: the model {name} is made from [{cls.TABLE}], or from a case of "
            "fecolumn run with [column] or [bodies]",
        )
    motion, sources = _motion(tables, path)
    if cls.TABLE in tables:
        case = case_of_table(tables, path, name)
    else:
        case = case_from_tables(merge(tables, {"integration": {"engine": name}}), path)
    model, start = model_of(case, path), start_of(case, path)
    check_duration(case, path)
    return ModelCase(
        name,
        model,
        case.title,
        path,
        sources,
        motion,
        start,
        float(case.integration.dt_s),
        case.integration.duration_s,
    )


def _motion(tables: dict[str, Any], path: Path | str) -> tuple[Motion | None, tuple[str, ...]]:
    """The [motion] of a file, and its sources; of the tables only one motion is left, so that they
    are those of a case.
    """
    if "motion" not in tables:
        return None, ()
    motion: Motion = build(Motion, tables["motion"], path, "motion.")
    found = []
    for source in chosen_motions(motion.source, "motion.source", path):
        found.append(located("motion", dataclasses.replace(motion, source=source), path))
    tables["motion"] = {**tables["motion"], "source": found[0].source}
    return found[0], tuple(one.source for one in found)
