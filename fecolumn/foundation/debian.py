"""DOLFINx and what comes with it: packages of Debian, which pip does not install."""

from __future__ import annotations

#: By the names of their modules
PACKAGES = ("basix", "dolfinx", "gmsh", "h5py", "mpi4py", "petsc4py", "ufl")


def missing_text(error: ModuleNotFoundError) -> str:
    """What to do where a package of Debian is missing; "" of another module."""
    name = (error.name or "").partition(".")[0]
    if name not in PACKAGES:
        return ""
    return (
        f"needs {name}, which pip does not install with fecolumn: ./containers/run of a clone "
        "installs it on Debian, and images have it (fecolumn help clusters)"
    )


def rank_and_size() -> tuple[int, int]:
    """Number of this process among those of MPI, and how many they are; (0, 1) without mpi4py."""
    try:
        from mpi4py import MPI
    except ModuleNotFoundError:
        return 0, 1
    return MPI.COMM_WORLD.rank, MPI.COMM_WORLD.size
