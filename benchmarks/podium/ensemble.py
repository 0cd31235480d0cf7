"""Peak responses of all podiums to the motions of one earthquake scenario, kept in a file each."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

import numpy as np

from fecolumn.case.model_sections import LAWS
from fecolumn.engines.rocking.podium import study_podium
from fecolumn.engines.rocking.storeys import PROFILES
from fecolumn.foundation.atomic import write_bytes
from fecolumn.motions.ensemble_file import write_ensemble
from fecolumn.motions.near_fault import DISTANCES, MAGNITUDES, near_fault_ensemble

STOREYS = (3, 6, 9)
BUILDINGS = tuple((profile, n) for profile in PROFILES for n in STOREYS)
SCENARIOS = tuple((magnitude, distance) for magnitude in MAGNITUDES for distance in DISTANCES)
_BATCH = 10  # motions of a scenario in a file
# R = 1.5 m, tan(alpha) = 0.15, gamma = 10 with four columns, beam as heavy as a floor, T_1 = n/10
# s, damping 5 %
_CASE = f"""title = "Podium of Bantilas, Kavvadias and Vasiliadis"
podium.column_mass_kg = 2500
podium.floor_mass_kg = 1e5
podium.slenderness_rad = {math.atan(0.15):.9g}
podium.half_diagonal_m = 1.5
integration.dt_s = 0.01
"""


def batches(count: int) -> tuple[tuple[int, int], ...]:
    """First and last number of the motions of each batch, so that a study of more motions takes
    over what a smaller one has made.
    """
    return tuple((first, min(first + _BATCH - 1, count)) for first in range(1, count + 1, _BATCH))


def file_of(scenario, batch, seed: int, folder: Path) -> Path:
    """File that a batch of a scenario is kept in."""
    first, last = batch
    return folder / f"M{scenario[0]:g}_R{scenario[1]:g}_seed{seed}_{first}-{last}.json"


def responses(scenario, batch, seed: int) -> list[dict]:
    """Peak tilt over alpha and base shear over V_st of every building under the motions of a batch
    of a scenario, a dict each.
    """
    first, last = batch
    motions = near_fault_ensemble(scenario[:1], scenario[1:], last, seed=seed).motions[first - 1 :]
    rows = []
    for profile, n in BUILDINGS:
        for law in LAWS:
            podium = study_podium(profile, n, law)
            for number, motion in enumerate(motions, first):
                _, _, shears, peak, fallen = podium.shake(motion.acceleration[:, [0, 2]], motion.dt)
                shear = podium.building_mass * shears[0] / podium.static_shear
                rows.append(
                    {
                        "profile": profile,
                        "storeys": n,
                        "law": law,
                        "motion": number,
                        "overturned": bool(fallen),
                        "tilt_over_alpha": float(f"{peak / podium.slenderness:.8g}"),
                        "shear_over_static": float(f"{shear:.8g}"),
                    }
                )
    return rows


def gathered(batches_of_rows) -> dict[tuple[str, int, str], dict[str, np.ndarray]]:
    """By (profile, storeys, law): tilt over alpha, inf where overturned, and shear over V_st,
    (motions,) each, in one order of motions.
    """
    of_buildings: dict = {}
    for row in itertools.chain.from_iterable(batches_of_rows):
        one = of_buildings.setdefault(
            (row["profile"], row["storeys"], row["law"]), {"tilt": [], "shear": []}
        )
        one["tilt"].append(math.inf if row["overturned"] else row["tilt_over_alpha"])
        one["shear"].append(row["shear_over_static"])
    return {
        key: {name: np.array(values) for name, values in one.items()}
        for key, one in of_buildings.items()
    }


def write_study(count: int, seed: int, folder: Path) -> Path:
    """Write motions, podium.toml and study.toml of the same study for `fecolumn study`, whose
    report judges the claims; the study file.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_ensemble(near_fault_ensemble(count=count, seed=seed), folder / "near_fault.h5")
    write_bytes(folder / "podium.toml", _CASE.encode())
    levels = {"podium.impact": LAWS, "podium.storeys": STOREYS, "podium.profile": tuple(PROFILES)}
    axes = "".join(f'"{key}" = {json.dumps(list(values))}\n' for key, values in levels.items())
    write_bytes(
        folder / "study.toml",
        'title = "Two laws of impact of a rocking podium"\ncase = '
        f'"podium.toml"\n\n[axes]\n"motion.source" = ["near_fault.h5#*"]\n{axes}'.encode(),
    )
    return folder / "study.toml"
