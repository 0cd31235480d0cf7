"""A coarse column for the tests of the engine: a hundred-millimetre tube with cap on a small
base.
"""

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.verification.models import system_of

SPECIMEN = "meshes/stout.toml"
# A wall four times as thick, of bricks of its size: a fourth of the nodes in the foot, a third of
# the time
THICK = {"column": {"wall_m": 0.02, "fine_height_m": 0.02}, "mesh": {"fine_size_m": 0.02}}


def coarse_case(**sections):
    tables = merge(
        read_toml(SPECIMEN),
        {
            "column": {"fine_height_m": 0.03},
            "base": {"slide_allowance_m": 0.01, "length_m": 0.2, "width_m": 0.2},
            "mesh": {"coarse_size_m": 0.03, "cap_size_m": 0.05, "base_size_m": 0.05},
            "integration": {"engine": "full"},
        },
    )
    return case_from_tables(merge(tables, sections), SPECIMEN)


def coarse_system(**sections):
    return system_of(coarse_case(**sections))
