"""A coarse column for the tests of the engine: a hundred-millimetre tube with cap on a small
base.
"""

from mpi4py import MPI

from fecolumn.case.short_form import short_form
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.verification.one_column import build_system

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
    return short_form(merge(tables, sections), SPECIMEN)


def coarse_system(**sections):
    return build_system(coarse_case(**sections), MPI.COMM_SELF)
