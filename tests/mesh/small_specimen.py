"""A coarse tube with cap and base, the smallest mesh that still has every part and tie."""

import copy

from fecolumn.case.short_form import short_form

TABLES = {
    "column": {"outer_diameter_m": 0.1, "height_m": 0.3, "wall_m": 0.01, "fine_height_m": 0.05},
    "cap": {"length_m": 0.15, "width_m": 0.12, "thickness_m": 0.01},
    "base": {"length_m": 0.3, "width_m": 0.25, "thickness_m": 0.03},
    "mesh": {"fine_size_m": 0.01, "coarse_size_m": 0.03, "cap_size_m": 0.015, "base_size_m": 0.04},
    "integration": {"duration_s": 1.0},
}


def small_case(cap=True, **keys):
    """Case of TABLES; `column_wall_m=0.05` sets the key wall_m of the table column, `cap=False`
    leaves the cap out.
    """
    tables = copy.deepcopy(TABLES)
    for name, value in keys.items():
        table, _, key = name.partition("_")
        tables[table][key] = value
    if not cap:
        del tables["cap"]
    return short_form(tables, "small_specimen.toml")
