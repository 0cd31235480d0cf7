"""Rocking models against whole tables, number by number: half-sine pulses, spectra of overturning,
restitution of podiums.

Requirement: the tables in `tables`, which were computed by other programs, come out again:
restitutions of the podium paper's figure from its equations 5 and 6; psi and amplitude of the
half-sine pulse from equation 25 of Makris (2014); bands of amplitude that overturn a block of alpha
= 10 degrees, with the impacts before, of four pulses at w_p/p from 0.25 to 14 (his Fig. 7), by
steps of 0.25.

Tolerances. Half of the last digit of a table. A boundary of overturning holds within 0.5 %: so a
band that is wider than 1 % is found 0.5 % within both of its ends. That is asked of bands with one
impact or none at w_p/p from 1 on, without impact where the table says so. Below, and after more
impacts, bands follow each other more closely than the amplitudes of the table, which takes several
for one and misses gaps between them.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.model_sections import LAWS
from fecolumn.engines.rocking.overturning import (
    half_sine_overturning,
    half_sine_phase,
    pulse_outcomes,
)
from fecolumn.engines.rocking.podium_impact import podium_restitution
from fecolumn.verification.result import CaseRows, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_TABLES = Path(__file__).with_name("tables")
_GAMMA = 10.0  # of the podium's table
_TEN = math.radians(10)
_WITHIN = 0.005
_FROM, _MOST = 1.0, 1  # w_p/p, impacts


def run(engine: str, long: bool = False) -> CaseRows:
    """All rows."""
    bands = read("overturning_bands")
    return CaseRows(
        [*_restitutions(), *_half_sines(), *_bands(bands)],
        lambda figure: _draw(figure, bands),
        (7.2, 3.1),
    )


def read(name: str) -> list[dict[str, str]]:
    """Rows of a table."""
    with (_TABLES / f"{name}.csv").open(newline="") as text:
        return list(csv.DictReader(text))


def _restitutions() -> Iterator[Row]:
    rows = read("podium_restitution")
    for law in LAWS:
        off = max(
            abs(
                podium_restitution(law, float(row["alpha_rad"]), _GAMMA, float(row["eta"]))
                - float(row[f"COR_{law}"])
            )
            for row in rows
        )
        yield Row(
            f"podium, {law}: {len(rows)} restitutions, largest difference [-]", 0.0, off, 5.1e-6
        )


def _half_sines() -> Iterator[Row]:
    rows = read("half_sine")
    ratios = [float(row["omega_p_over_p"]) for row in rows]
    for words, key, found, digit in (
        ("psi [rad]", "psi_rad", half_sine_phase, 5.1e-6),
        ("a_p/(g tan alpha), relative", "a_p_over_g_tan_alpha", half_sine_overturning, 5.1e-5),
    ):
        exact = np.array([float(row[key]) for row in rows])
        off = np.abs(np.array([found(ratio) for ratio in ratios]) - exact) / (
            1 if key == "psi_rad" else exact
        )
        yield Row(
            f"half-sine, {len(rows)} pulses: {words}, largest difference",
            0.0,
            float(off.max()),
            digit,
        )


def _bands(rows: list[dict[str, str]]) -> Iterator[Row]:
    for shape in dict.fromkeys(row["pulse"] for row in rows):
        missed, count = lost_bands(shape, rows)
        yield Row(
            f"{shape}: bands of overturning of {count} that are not found [-]", 0, missed, 0.0
        )


def lost_bands(shape: str, rows: list[dict[str, str]]) -> tuple[int, int]:
    """Bands of a pulse that are not found within both of their ends, and all that are looked
    for.
    """
    missed = count = 0
    for ratio in dict.fromkeys(
        float(row["omega_p_over_p"]) for row in rows if row["pulse"] == shape
    ):
        bands = [
            (
                float(row["a_over_gtanalpha_from"]),
                float(row["to"]),
                int(row["impacts_before_overturning"]),
            )
            for row in rows
            if row["pulse"] == shape and float(row["omega_p_over_p"]) == ratio
        ]
        bands = [
            (low, min(high, 14.0), impacts)
            for low, high, impacts in bands
            if high > low * (1 + 2 * _WITHIN) and ratio >= _FROM and impacts <= _MOST
        ]
        if bands:
            ends = np.array([(low * (1 + _WITHIN), high * (1 - _WITHIN)) for low, high, _ in bands])
            found = pulse_outcomes(shape, ratio, ends.ravel(), _TEN).reshape(ends.shape)
            wanted = np.array([[impacts] for _, _, impacts in bands])
            missed += int(((found < 0) | (wanted == 0) & (found != 0)).any(axis=1).sum())
            count += len(bands)
    return missed, count


def _draw(figure: Figure, rows: list[dict[str, str]]) -> None:
    shapes = list(dict.fromkeys(row["pulse"] for row in rows))
    for axes, shape in zip(figure.subplots(1, len(shapes), sharey=True), shapes):
        for row in rows:
            if row["pulse"] == shape:
                high, impacts = min(float(row["to"]), 14.0), int(row["impacts_before_overturning"])
                axes.plot(
                    [float(row["omega_p_over_p"])] * 2,
                    [float(row["a_over_gtanalpha_from"]), high],
                    color=("#0072B2", "#D55E00")[impacts] if impacts < 2 else "#009E73",
                    linewidth=1.6,
                )
        axes.set(xlabel=r"$\omega_p/p$", title=shape.replace("_", " "))
    figure.axes[0].set_ylabel(r"$a_p/(g\tan\alpha)$ that overturn")
