"""Analyses to draw, made in seconds: a drum that wobbles, with fields, and a block that rocks, with
its history alone.
"""

from fecolumn.case.case import case_from_tables
from fecolumn.simulation import run

DRUM = {
    "column": {"shape": "solid", "outer_diameter_m": 0.5, "height_m": 1.6},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700},
    "mesh": {"fine_size_m": 0.1, "coarse_size_m": 0.19, "base_size_m": 0.3},
    "initial": {"tilt_rad": 0.1, "spin_rad_s": [0.0, 0.0, 0.6]},
    "integration": {"engine": "reduced", "duration_s": 0.24, "dt_s": 1e-3},
    "output": {"fields_every_s": 0.04},
}
BLOCK = {
    "column": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 1.2},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700},
    "mesh": {"fine_size_m": 0.1, "coarse_size_m": 0.2, "base_size_m": 0.2},
    "initial": {"tilt_rad": 0.05, "direction_deg": 0.0},
    "integration": {"engine": "rigid", "duration_s": 0.2, "dt_s": 1e-3},
    "output": {"states_every_s": 0.0},
}


def analysed(tables, folder):
    """Result folder of a case."""
    run(case_from_tables(tables, "case"), folder, quiet=True)
    return folder
