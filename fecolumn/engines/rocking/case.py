"""What a model is run with: a case of finite elements, or a file of the model's own table, motion
and start.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fecolumn.case.case import case_from_tables, case_of_table
from fecolumn.case.check_case import check_duration
from fecolumn.case.model_table import Start
from fecolumn.case.sections import Motion, located
from fecolumn.engines.ending import REST_SHARE
from fecolumn.engines.followed import ends_at_rest, first_still, followed_s, until
from fecolumn.engines.rocking.model import STATE_TERMS, Model, ModelResponse
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
        """Ground motion and response, to a motion of `sources`, or on a base at rest; as long as
        that of `fecolumn run`, which ends at rest where the motion says so.

        Raises
        ------
        InputError
            the motion cannot be used.
        """
        loaded = keys = None
        if source is not None:
            assert self.motion is not None  # of which `source` is
            keys = dataclasses.replace(self.motion, source=source)
            loaded = load_motion(keys, self.dt_s, self.file)
        steps = round(followed_s(loaded, keys, self.duration_s) / self.dt_s)
        ground, free_s = until(loaded, steps, self.dt_s)
        response = self.model.respond(
            ground,
            free_s=free_s,
            tilt=self.start.tilt_rad,
            direction=math.radians(self.start.direction_deg),
        )
        if response.overturned:
            return ground, response
        rows = min(steps + 1, len(response.time))  # a model may follow it for a step more
        if ends_at_rest(keys, self.duration_s):
            kinetic, strain, gravity = (response.energy[name] for name in STATE_TERMS)
            still_j = REST_SHARE * self.model.energy_to_overturn
            energy = (kinetic + strain + gravity)[:rows]
            still = first_still(energy, still_j, len(ground.acceleration))
            rows = rows if still is None else still + 1
        return ground, response.first(rows)


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
