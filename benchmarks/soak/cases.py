"""The analyses: for each a specimen, a start, a motion, an interface and an integration, drawn by a
Latin hypercube a block.
"""

from __future__ import annotations

import functools
import math
from pathlib import Path

from benchmarks.soak.hypercube import Draw, hypercube
from benchmarks.soak.motions import sampling_and_peak, write_motions
from benchmarks.soak.specimens import Specimen, specimens
from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.study.plan import Plan, PlannedAnalysis

# Analyses of a block: its study is drawn, resumed and reported as one; its workers start once
BLOCK = 10_000
FILE = "benchmarks.soak"
KEYS = ("number", "specimen", "motion.source", "integration.dt_s", "integration.alpha_hht")
NAMES = (
    "specimen",
    "engine",
    "modes",
    "law",
    "penalty",
    "friction",
    "restitution",
    "rolling",
    "damping",
    "dt",
    "alpha",
    "duration",
    "steps",
    "family",
    "member",
    "peak",
    "time_scale",
    "rotation",
    "begin",
    "delay",
    "vertical",
    "resample",
    "start",
    "tilt",
    "direction",
    "speed",
    "spin",
    "pad",
    "pad_shear",
    "pad_damping",
    "cap",
)
_FAMILIES = {
    "none": 2,
    "lick": 3,
    "records": 2,
    "near-fault": 2,
    "three components": 1,
    "pulses": 2,
}
_LAWS = {"augmented_lagrange": 4, "penalty": 1}
_COARSEST, _FINEST = 0.03, 2e-4  # steps [s]
# steps of an analysis: what fails does so where contacts come and go, of which each has many
_FEWEST, _MOST = (
    10,
    80,
)
_MODES = (1, 3, 10, 30, 100)
_DEEPEST = 0.02  # settlement of a pad over the width of the foot
# width squared over settlement and height: a pad holds a thin tube upright above 4, a solid
# cylinder above 8
_UPRIGHT = 24.0


def block(
    number: int, count: int, sources: dict[str, list[str]], seed: int, columns: list[Specimen]
) -> Plan:
    """The first `count` analyses of a block; the same for a seed, however many are asked for."""
    analyses = [
        _analysis(number * BLOCK + place, draw, sources, columns)
        for place, draw in enumerate(_draws(number, seed)[:count])
    ]
    axes = dict(zip(KEYS, zip(*(analysis.levels for analysis in analyses))))
    return Plan(
        Path(FILE),
        f"soak {number}",
        {key: tuple(dict.fromkeys(values)) for key, values in axes.items()},
        tuple(analyses),
        {},
    )


@functools.lru_cache(maxsize=2)
def _draws(number: int, seed: int) -> list[Draw]:
    """Samples of a block."""
    return hypercube(NAMES, BLOCK, [seed, number])


def _analysis(
    number: int, draw: Draw, sources: dict[str, list[str]], columns: list[Specimen]
) -> PlannedAnalysis:
    which = draw.place("specimen", len(columns))
    case = case_from_tables(
        tables_of(draw, columns[which], sources) | {"title": f"soak {number}"}, FILE
    )
    source = case.motion.source if case.motion else ""
    return PlannedAnalysis(
        case,
        case.id,
        KEYS,
        (number, which, source, case.integration.dt_s, case.integration.alpha_hht),
    )


def blocks(total: int) -> list[tuple[int, int]]:
    """Number and count of each block of so many analyses in all."""
    return [
        (number, min(BLOCK, total - number * BLOCK)) for number in range(math.ceil(total / BLOCK))
    ]


def tables_of(draw: Draw, specimen: Specimen, sources: dict[str, list[str]]) -> dict[str, dict]:
    """Tables of a case."""
    families = {
        name: weight for name, weight in _FAMILIES.items() if name == "none" or name in sources
    }
    family = draw.one_of("family", families)
    tables = {name: dict(table) for name, table in specimen.tables.items()}
    tables["integration"] = _integration(draw, specimen)
    tables["contact"] |= _contact(draw, specimen)
    tables["initial"] = _initial(draw, specimen, at_rest=family != "none")
    if damping := draw.rarely("damping", 0.3, lambda one: one.log("damping", 1e-3, 0.5)):
        tables["material"]["damping_ratio"] = damping
    if specimen.base == "pad":
        tables["base"] |= _pad(draw, specimen, tables["integration"])
    if share := draw.rarely("cap", 0.3, lambda one: one.even("cap", 0.2, 1.0)):
        tables["overturn"] = {"displacement_m": share * specimen.width_m}
    if family != "none":
        source = sources[family][draw.place("member", len(sources[family]))]
        tables["motion"] = _motion(draw, specimen, family, source, tables["integration"]["dt_s"])
    return tables | {"output": {"history_every_s": 0.005, "states_every_s": 0}}


def _integration(draw: Draw, specimen: Specimen) -> dict:
    engine = draw.one_of("engine", {"reduced": 3, "rigid": 1})
    dt = draw.log("dt", _FINEST, _COARSEST)
    if specimen.base == "pad":  # whose vibration takes ten steps at least
        dt = min(dt, float(f"{_period(_deepest(specimen)) / 10:.3g}"))
    alpha = draw.one_of("alpha", {0.0: 1, None: 6, -1 / 3: 1})
    modes = (
        {"n_modes": draw.one_of("modes", dict.fromkeys(_MODES, 1))} if engine == "reduced" else {}
    )
    steps = round(draw.log("steps", _FEWEST, _MOST))
    return {
        "engine": engine,
        "dt_s": dt,
        "alpha_hht": draw.even("alpha", -1 / 3, 0) if alpha is None else alpha,
        "duration_s": min(draw.even("duration", 0.5, 1.5), round(steps * dt, 6)),
        **modes,
    }


def _contact(draw: Draw, specimen: Specimen) -> dict:
    table = {"friction_coefficient": draw.log("friction", 0.03, 2.0)}
    if draw.one_of("law", _LAWS) == "penalty":
        table |= {"law": "penalty", "penalty_factor": draw.log("penalty", 1, 1e4)}
    if specimen.base != "pad":
        table["restitution"] = draw.rarely(
            "restitution", 0.35, lambda one: one.even("restitution", 0, 1)
        )
        if specimen.shape != "block":
            table["rolling_resistance"] = draw.rarely(
                "rolling", 0.3, lambda one: one.log("rolling", 1e-5, 0.1)
            )
    return table


def _initial(draw: Draw, specimen: Specimen, at_rest: bool) -> dict:
    start = draw.one_of(
        "start", {"rest": 4, "tilt": 3, "moving": 2} if at_rest else {"tilt": 2, "moving": 1}
    )
    if start == "rest":
        return {}
    turn = math.radians(direction := draw.even("direction", 0, 360))
    if start == "tilt":
        return {
            "tilt_rad": draw.even("tilt", 0.02, 1.1) * specimen.slenderness_rad,
            "direction_deg": direction,
        }
    speed = draw.even("speed", 0, 0.3) * math.sqrt(GRAVITY * specimen.width_m)
    spin = (
        draw.even("spin", 0, 1)
        * specimen.slenderness_rad
        * math.sqrt(1.5 * GRAVITY / math.hypot(specimen.width_m, specimen.height_m))
    )
    return {
        "velocity_m_s": [speed * math.cos(turn), speed * math.sin(turn), 0.0],
        "spin_rad_s": [-spin * math.sin(2 * turn), spin * math.cos(2 * turn), spin],
    }


def _period(settlement: float) -> float:
    """Of the vertical vibration of what settles so much under its own weight."""
    return 2 * math.pi * math.sqrt(settlement / GRAVITY)


def _deepest(specimen: Specimen) -> float:
    """Settlement [m] on the softest pad."""
    return specimen.width_m * min(_DEEPEST, specimen.width_m / (_UPRIGHT * specimen.height_m))


def _pad(draw: Draw, specimen: Specimen, integration: dict) -> dict:
    """A pad on which the column's vertical vibration takes ten steps or more and which it does not
    press in deeply.
    """
    least = GRAVITY * (10 * integration["dt_s"] / (2 * math.pi)) ** 2
    settlement = draw.log("pad", least, max(1.01 * least, _deepest(specimen)))
    stiffness = (
        specimen.density_kg_m3 * specimen.tables["column"]["height_m"] * GRAVITY / settlement
    )
    shear = draw.rarely("pad_shear", 0.5, lambda one: one.even("pad_shear", 0.1, 1.5))
    return {
        "stiffness_n_m3": min(stiffness, 1e15),
        "shear_stiffness_n_m3": shear * stiffness,
        "damping_ratio": draw.even("pad_damping", 0, 1),
    }


def _motion(draw: Draw, specimen: Specimen, family: str, source: str, dt: float) -> dict:
    """A motion whose peak is half to six times what uplifts a rigid block, from a share of its
    energy on.
    """
    sampling, peak = sampling_and_peak(source)
    table = {
        "source": source,
        "scale": draw.log("peak", 0.5, 6) * math.tan(specimen.slenderness_rad) * GRAVITY / peak,
        "time_scale": _simple_ratio(draw.log("time_scale", 0.3, 3) * sampling / dt) * dt / sampling,
        "rotation_deg": draw.even("rotation", 0, 360),
    }
    if family != "pulses":
        table["strong_part"] = [draw.even("begin", 0.01, 0.5), 1.0]
    if delay := draw.rarely("delay", 0.05, lambda one: one.even("delay", 0, 0.02)):
        table["delay_s"] = delay
    if family == "three components":
        table["vertical"] = draw.one_of("vertical", {True: 3, False: 1})
    if coarser := draw.rarely("resample", 0.15, lambda one: 2 + one.place("resample", 3)):
        table["resample_s"] = coarser * dt
    return table


def is_hard(number: int, seed: int, columns: list[Specimen]) -> bool:
    """Whether the points of an analysis are not meant to sink in: neither a pad nor a penalty."""
    draw = _draws(number // BLOCK, seed)[number % BLOCK]
    return (
        columns[draw.place("specimen", len(columns))].base != "pad"
        and draw.one_of("law", _LAWS) != "penalty"
    )


def _simple_ratio(ratio: float) -> float:
    """The nearest whole number, or one over it: a filter between odd sampling rates would take
    longer than the analysis.
    """
    return float(round(ratio)) if ratio >= 1 else 1 / round(1 / ratio)


def case_of(number: int, folder: Path, seed: int, count: int) -> Case:
    """The case of an analysis by its number; folder, seed and count as of the soak it belongs
    to.
    """
    return _analysis(
        number,
        _draws(number // BLOCK, seed)[number % BLOCK],
        write_motions(folder / "motions"),
        specimens(count),
    ).case
