"""Stochastic model fitted to a seed motion: its parameter file, and the ensembles it makes."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.schema import InputError, build, parameter
from fecolumn.foundation.toml_file import read_toml
from fecolumn.foundation.version import __version__
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.processing import scale_time
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.stochastic import Component, EnsembleShape, bidirectional
from fecolumn.motions.target import Target
from fecolumn.motions.variability import drawn

TARGETS_FOLDER = Path(__file__).parent
LICK = TARGETS_FOLDER / "lick.toml"
VARIABILITIES = ("fixed", "drawn")


@dataclass(frozen=True, slots=True)
class Components:
    """Parameters of x and y that are not fitted to the median spectrum."""

    source: str = parameter(doc="where the parameters come from")
    arias_ratio: tuple[float, ...] = parameter(
        doc="Arias intensity of x and y over their mean", above=0, high=2
    )
    frequency_hz: tuple[float, ...] = parameter(
        doc="filter frequency of x and y at 45 % of the Arias intensity",
        unit="Hz",
        above=0,
        high=50,
    )
    frequency_slope_hz_s: tuple[float, ...] = parameter(
        doc="change of the filter frequency of x and y", unit="Hz/s", low=-3.4, high=1.5
    )
    damping: tuple[float, ...] = parameter(
        doc="filter damping ratio of x and y", low=0.01, high=0.99
    )
    corner_hz: float = parameter(
        doc="corner frequency of the high-pass", unit="Hz", above=0, high=5
    )
    dt_s: float = parameter(0.005, doc="sampling step", unit="s", above=0, high=0.02)


@dataclass(frozen=True, slots=True)
class Fitted:
    """What is fitted, for one kind of variability."""

    arias_m_s: float = parameter(
        doc="mean of the median Arias intensities of x and y", unit="m/s", above=0, high=1e3
    )
    duration_s: float = parameter(
        doc="median time between 5 % and 95 % of the Arias intensity", unit="s", above=0, high=1e3
    )
    modulation_shape: float = parameter(
        doc="shape of the gamma law of the modulation", above=1, high=500
    )
    ln_gains: tuple[float, ...] = parameter(
        doc="correction of the spectral shape at frequencies_hz, ln of amplitude", low=-20, high=20
    )


@dataclass(frozen=True, slots=True)
class SeededModel:
    """Parameter file of a stochastic model."""

    target: Target
    components: Components
    fixed: Fitted
    drawn: Fitted
    frequencies_hz: tuple[float, ...] = parameter(
        doc="rising frequencies of the correction", unit="Hz", above=0, high=1e3
    )
    made_by: str = parameter("", doc="command and version that fitted the parameters")


def read_model(path: Path | str) -> SeededModel:
    """Model of a parameter file.

    Raises
    ------
    InputError
        missing file, bad TOML, unknown key, value out of range, lists that do not fit.
    """
    model = build(SeededModel, read_toml(path), path)
    check_components(model.components, path)
    check_target(model.target, path)
    if not (np.diff(model.frequencies_hz) > 0).all() or len(model.frequencies_hz) < 2:
        raise InputError(
            path, "frequencies_hz", None, "must be at least two rising frequencies [Hz]"
        )
    for kind in VARIABILITIES:
        if len(getattr(model, kind).ln_gains) != len(model.frequencies_hz):
            raise InputError(
                path,
                f"{kind}.ln_gains",
                None,
                f"must hold one number for each of {len(model.frequencies_hz)} frequencies_hz",
            )
    result: SeededModel = model
    return result


def check_components(components: Components, path: Path | str) -> None:
    """Refuse component tables that lack one value for each of the two directions."""
    for field in ("arias_ratio", "frequency_hz", "frequency_slope_hz_s", "damping"):
        if len(getattr(components, field)) != 2:
            raise InputError(
                path,
                f"components.{field}",
                list(getattr(components, field)),
                "must hold two numbers, of x and of y",
            )


def check_target(target: Target, path: Path | str) -> None:
    """Refuse a target spectrum whose ordinates are not one for each period."""
    if len(target.periods_s) != len(target.sa_g):
        raise InputError(
            path,
            "target.sa_g",
            None,
            f"must hold one number for each of {len(target.periods_s)} periods_s",
        )
    if len(target.periods_s) < 5 or not (np.diff(target.periods_s) > 0).all():
        raise InputError(path, "target.periods_s", None, "must be at least five rising periods [s]")


#: How a parameter file begins
MODEL_HEAD = "# Stochastic model of ground motion fitted to a seed motion"


def write_model(model: SeededModel, path: Path | str) -> None:
    """Write a parameter file that read_model reads."""
    tables = dataclasses.asdict(model)
    lines = [f"{MODEL_HEAD}; see fecolumn/motions/stochastic.py for the equations."]
    lines += [_line(key, value) for key, value in tables.items() if not isinstance(value, dict)]
    for name, table in tables.items():
        if isinstance(table, dict):
            lines += ["", f"[{name}]"] + [_line(key, value) for key, value in table.items()]
    write_bytes(Path(path), ("\n".join(lines) + "\n").encode())


def _line(key: str, value: Any) -> str:
    if isinstance(value, str):
        return f"{key} = {json.dumps(value, ensure_ascii=False)}"
    if not isinstance(value, tuple):
        return f"{key} = {float(value):.6g}"
    words = [f"{item:.6g}" if item != round(item) else f"{item:.1f}" for item in value]
    if len(words) < 5:
        return f"{key} = [{', '.join(words)}]"
    rows = ["    " + ", ".join(words[i : i + 12]) + "," for i in range(0, len(words), 12)]
    return "\n".join([f"{key} = [", *rows, "]"])


def medians(components: Components, fitted: Fitted) -> tuple[Component, Component]:
    """Median parameters of x and y."""
    x, y = (
        Component(ratio * fitted.arias_m_s, fitted.duration_s, frequency, slope, damping)
        for ratio, frequency, slope, damping in zip(
            components.arias_ratio,
            components.frequency_hz,
            components.frequency_slope_hz_s,
            components.damping,
        )
    )
    return x, y


def ensemble_shape(model: SeededModel, variability: str) -> EnsembleShape:
    """What all motions share."""
    fitted = getattr(model, variability)
    return EnsembleShape(
        fitted.modulation_shape,
        model.components.corner_hz,
        np.array(model.frequencies_hz),
        np.array(fitted.ln_gains),
        model.components.dt_s,
    )


def parameters(
    model: SeededModel, variability: str, seed: int, number: int
) -> tuple[Component, Component]:
    """Parameters of motion `number` (from 0): the medians themselves where they are fixed, or drawn
    around them.
    """
    middle = medians(model.components, getattr(model, variability))
    return middle if variability == "fixed" else drawn(middle, seed, number)


def seeded_acceleration(
    model: SeededModel, variability: str, seed: int, number: int
) -> NDArray[Any]:
    """Acceleration (n_steps, 3) [m/s2] of motion `number` (from 0) at full scale; it depends on no
    other motion.
    """
    rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed, spawn_key=(number,))))
    horizontal = bidirectional(
        parameters(model, variability, seed, number), ensemble_shape(model, variability), rng
    )
    return np.column_stack([horizontal, np.zeros(len(horizontal))])


def seeded_ensemble(
    model: SeededModel, n: int, seed: int, variability: str = "fixed", time_scale: float = 1.0
) -> Ensemble:
    """Ensemble of n bidirectional motions, without vertical component.

    Parameters
    ----------
    model
        of read_model.
    n
        number of motions.
    seed
        of the random numbers; the first motions are the same whatever n is.
    variability
        "fixed" (one set of parameters for all) or "drawn" (Dabaghi and Der Kiureghian 2018).
    time_scale
        factor on time at the end; the accelerations stay. The ensemble's parameters are those
        before it.
    """
    if variability not in VARIABILITIES:
        raise ValueError(f"variability = {variability!r} must be one of {', '.join(VARIABILITIES)}")
    scaled = f", time x {time_scale:g}" if time_scale != 1 else ""
    name = f"{model.target.name}, {variability} parameters{scaled}"
    source = f"stochastic, seed {seed}; {model.target.source}"
    motions = tuple(
        scale_time(
            GroundMotion(
                seeded_acceleration(model, variability, seed, number),
                model.components.dt_s,
                f"{model.target.name} {number + 1}",
                source,
            ),
            time_scale,
        )
        for number in range(n)
    )
    chosen = [parameters(model, variability, seed, number) for number in range(n)]
    columns = {
        f"{field.name.removesuffix(unit)}_{axis}{unit}": np.array(
            [getattr(pair[i], field.name) for pair in chosen]
        )
        for field, unit in zip(dataclasses.fields(Component), ("_m_s", "_s", "_hz", "_hz_s", ""))
        for i, axis in enumerate("xy")
    }
    provenance = {
        "model": "evolutionary spectrum after Rezaeian and Der Kiureghian",
        "version": __version__,
        "seed": int(seed),
        "arguments": {"n": int(n), "variability": variability, "time_scale": float(time_scale)},
        "parameters": dataclasses.asdict(getattr(model, variability)),
        "target": dataclasses.asdict(model.target),
    }
    return Ensemble(name, motions, columns, provenance)
