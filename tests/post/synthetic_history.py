"""A history with known peak and known ledger: a damped elliptic wobble, as the solver would write
it.
"""

import json

import h5py
import numpy as np

TERMS = (
    "kinetic",
    "strain",
    "gravity",
    "base_work",
    "friction",
    "impact",
    "contact",
    "algorithmic",
    "closure",
)


def write_history(folder, n: int = 2001, overturned: bool = False) -> None:
    time = np.linspace(0.0, 4.0, n)
    growth = np.exp(1.1 * (time - 2)) if overturned else 1 - np.exp(-2 * time)
    size = 0.03 * growth * (1 if overturned else np.exp(-0.6 * time))
    u_top = np.stack([size * np.cos(7 * time), 0.6 * size * np.sin(9 * time), -5 * size**2], axis=1)
    base_work = 1.2 * (1 - np.exp(-2 * time))
    losses = {
        "impact": -0.8 * (1 - np.exp(-time)),
        "friction": -0.05 * (1 - np.exp(-time)),
        "algorithmic": -0.02 * (1 - np.exp(-time)),
    }
    stored = base_work + sum(losses.values())
    share = np.sin(8 * time) ** 2
    energy = {
        "kinetic": stored * share,
        "strain": 1e-3 * np.abs(stored),
        "gravity": stored * (1 - share),
        "base_work": base_work,
        **losses,
        "contact": np.zeros(n),
        "closure": 1e-6 * np.sin(3 * time),
    }
    data = {
        "time": (time, "s"),
        "u_top": (u_top, "m"),
        "tilt": (np.hypot(*u_top[:, :2].T) / 1.01, "rad"),
        "twist": (0.1 * size, "rad"),
        "slide": (0.01 * u_top[:, :2], "m"),
        "ground": (np.stack([2 * np.sin(9 * time), np.cos(5 * time), 0 * time], axis=1), "m/s2"),
        "contact_force": (np.tile([0.0, 0.0, 135.0], (n, 1)), "N"),
        "active_nodes": (np.full(n, 4), "-"),
        "iterations": (np.full(n, 2), "-"),
        **{f"energy/{term}": (energy[term], "J") for term in TERMS},
    }
    folder.mkdir(parents=True, exist_ok=True)
    with h5py.File(folder / "history.h5", "w") as file:
        for name, (values, unit) in data.items():
            file.create_dataset(name, data=values).attrs["unit"] = unit
    (folder / "summary.json").write_text(
        json.dumps(
            {
                "overturned": overturned,
                "case_id": "0",
                "u_critical_m": 0.0762,
                "outcome": "overturned" if overturned else "at rest",
            }
            | dict.fromkeys(("u_max_m", "residual_slide_m", "steps", "wall_s", "s_per_step"), 1.0)
            | {"energy_closure_rel": 0.0}
        )
    )
    (folder / "case.json").write_text(
        json.dumps(
            {
                "id": "0",
                "case": {"column": {"outer_diameter_m": 0.0761, "wall_m": 0.005, "height_m": 1.5}},
            }
        )
    )
