"""What a model is run with: a case of finite elements, or a file of the model's own table, motion and start."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from fecolumn.case import REST, Motion, case_from_tables, located
from fecolumn.motions.chosen import chosen_motions
from fecolumn.motions.load import load_motion
from fecolumn.motions.record import GroundMotion
from fecolumn.rocking.model import Model, Response, model_class
from fecolumn.schema import InputError, Section, build, parameter, read_toml


@dataclass(frozen=True, slots=True)
class Start(Section):
    """State at t = 0."""

    tilt_rad: float = parameter(0.0, doc="tilt; 0 starts upright", unit="rad", low=0, high=1.5)
    direction_deg: float = parameter(0.0, doc="direction towards which the top leans, from x to y", unit="deg", low=-360, high=360)


@dataclass(frozen=True, slots=True)
class Sampling(Section):
    """Times."""

    dt_s: float = parameter(1e-3, doc="step at which the motion is sampled; between samples it is a straight line", unit="s", above=0, high=0.1)
    duration_s: float = parameter(0.0, doc="time followed; 0 takes the motion and its free vibration, and must not stand where there is no motion", unit="s", low=0, high=1e5)


@dataclass(frozen=True, slots=True)
class ModelCase:
    """A model, its motions and its start.

    Attributes:
        name: of the model. model: it. title: for figures. file: it was read from.
        sources: of the motions, as in motion.source; none for a base at rest. motion: the other keys of [motion], None for a base at rest.
        start, sampling: as their sections say.
    """

    name: str
    model: Model
    title: str
    file: object
    sources: tuple[str, ...]
    motion: Motion | None
    start: Start
    sampling: Sampling

    def response(self, source: str | None = None) -> tuple[GroundMotion, Response]:
        """Ground motion and response, to a motion of `sources`, or on a base at rest.

        Raises:
            InputError: the motion cannot be used.
        """
        dt, duration = self.sampling.dt_s, self.sampling.duration_s
        if source is None:
            ground, free = GroundMotion(np.zeros((2, 3)), dt, "at rest", ""), duration - dt
        else:
            ground = load_motion(dataclasses.replace(self.motion, source=source), dt, self.file)
            free = self.motion.longest_free_vibration_s if self.motion.free_vibration_s != REST else 0.0
            if duration:
                kept = max(2, round(duration / dt) + 1)
                ground, free = GroundMotion(ground.acceleration[:kept], dt, ground.name, ground.source), max(0.0, duration - ground.duration)
        return ground, self.model.respond(ground, free_s=free, tilt=self.start.tilt_rad, direction=math.radians(self.start.direction_deg))


def read_model_case(name: str, path) -> ModelCase:
    """A model by its name, from a file with its table, such as [block], or from a case with [column].

    Raises:
        InputError: unknown key, value out of range, parts that do not fit.
    """
    tables, cls = read_toml(path), model_class(name)
    if "column" in tables and cls.TABLE not in tables:
        motion, sources = _motion(tables, path)
        case = case_from_tables(tables, path)
        return ModelCase(name, cls.of_case(case, path), case.title, path, sources, motion, Start(case.initial.tilt_rad, case.initial.direction_deg),
                         _timed(Sampling(case.integration.dt_s, case.integration.duration_s), motion, path))
    known = {"title": None, cls.TABLE: cls.SECTION, "motion": Motion, "initial": Start, "integration": Sampling}
    for key in tables:
        if key not in known:
            raise InputError(path, key, None, f"unknown key; a case of the model {name} has {', '.join(known)}, or is a case of fecolumn run with [column]")
    if cls.TABLE not in tables:
        raise InputError(path, cls.TABLE, None, f"missing: the model {name} is made from [{cls.TABLE}], or from a case of fecolumn run with [column]")
    if not isinstance(tables.get("title", ""), str):
        raise InputError(path, "title", tables["title"], "must be text in quotes")
    motion, sources = _motion(tables, path)
    section, start, sampling = (build(known[key], tables.get(key, {}), path, f"{key}.") for key in (cls.TABLE, "initial", "integration"))
    return ModelCase(name, cls.of_section(section, path), tables.get("title", ""), path, sources, motion, start, _timed(sampling, motion, path))


def _motion(tables: dict, path) -> tuple[Motion | None, tuple[str, ...]]:
    """The [motion] of a file, and its sources; of the tables only one motion is left, so that they are those of a case."""
    if "motion" not in tables:
        return None, ()
    motion = build(Motion, tables["motion"], path, "motion.")
    found = []
    for source in chosen_motions(motion.source, "motion.source", path):
        found.append(located("motion", dataclasses.replace(motion, source=source), path))
    tables["motion"] = {**tables["motion"], "source": found[0].source}
    return found[0], tuple(one.source for one in found)


def _timed(sampling: Sampling, motion, path) -> Sampling:
    if motion is None and not sampling.duration_s:
        raise InputError(path, "integration.duration_s", 0, "must be greater than 0 s where there is no motion")
    return sampling
