"""Versions of all that fecolumn uses on this machine, and known problems of this machine.

Stands alone: it needs neither the rest of the package nor any library it looks for. The libraries
are looked at in a child process, in the order an analysis loads them, so that one that crashes is a
line in the table and not the end of it.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

_INSTALL = "run through ./containers/run, which installs it"


@dataclass(frozen=True)
class LibraryFinding:
    """One line of the table; `warning` names a trap and its remedy, `fit` is False if no analysis
    can run.
    """

    component: str
    version: str
    note: str = ""
    warning: str = ""
    fit: bool = True


def origin(name: str) -> str:
    """Debian, or the folder of a wheel; without importing the module."""
    found = importlib.util.find_spec(name)
    if found is None or found.origin is None:
        raise ModuleNotFoundError(f"No module named {name!r}")
    folder = str(Path(found.origin).parent.parent)
    return "Debian" if folder.startswith("/usr/lib/") else folder


def loaded_libraries(pattern: str) -> list[str]:
    """Shared libraries of this process whose file name begins like this, those of wheels left
    out.
    """
    files = {
        line.split()[-1]
        for line in Path("/proc/self/maps").read_text().splitlines()
        if ".so" in line
    }
    return sorted(
        file for file in files if re.match(pattern, Path(file).name) and "site-packages" not in file
    )


OS_RELEASE = Path("/etc/os-release")


def look_at_machine() -> list[LibraryFinding]:
    """System, Python, compiler, cores, memory and environment variables."""
    try:
        text = OS_RELEASE.read_text(encoding="utf-8", errors="replace")
    except OSError:  # not every system has one
        text = ""
    release = dict(re.findall(r'^(\w+)="?(.*?)"?$', text, re.MULTILINE))
    known = release.get("VERSION_CODENAME") in ("bookworm", "trixie")
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    threads = os.environ.get("OMP_NUM_THREADS")
    untried = "tried on Debian 12 and 13 only: use a container of one of them"
    foreign = "not the Python that Debian's dolfinx was built for: run through ./containers/run"
    crowded = "analyses side by side would fight for the cores: export OMP_NUM_THREADS=1"
    findings = [
        LibraryFinding(
            "system",
            release.get("PRETTY_NAME", "unknown"),
            platform.machine(),
            "" if known else untried,
        ),
        LibraryFinding(
            "Python",
            platform.python_version(),
            sys.prefix,
            "" if sys.base_prefix == "/usr" else foreign,
        ),
        LibraryFinding("cores", str(len(os.sched_getaffinity(0))), f"of {os.cpu_count()}"),
        LibraryFinding("memory", f"{memory:.1f} GiB"),
        LibraryFinding(
            "OMP_NUM_THREADS", threads or "unset", "", "" if threads == "1" else crowded
        ),
    ]
    if not (shutil.which("mpicc") or shutil.which("cc")):
        findings.append(
            LibraryFinding(
                "C compiler",
                "missing",
                "",
                f"dolfinx compiles forms with it: {_INSTALL}",
                fit=False,
            )
        )
    if os.geteuid() == 0 and not os.environ.get("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"):
        remedy = (
            "Open MPI refuses root: export OMPI_ALLOW_RUN_AS_ROOT=1 "
            "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"
        )
        findings.append(LibraryFinding("mpirun", "as root", "", remedy))
    if importlib.util.find_spec("netCDF4") and origin("netCDF4") != "Debian":
        findings.append(
            LibraryFinding("netCDF4", "wheel", "", "crashes beside dolfinx: pip uninstall netCDF4")
        )
    return findings


# ---- the libraries: each function returns (version, note, warning) and may raise
# ---------------------------------------


def look_at_numpy() -> tuple[str, str, str]:
    """Version and origin; advice where it is not Debian's, for which petsc4py was built."""
    import numpy

    debian = origin("numpy") == "Debian"
    return (
        numpy.__version__,
        origin("numpy"),
        "" if debian else "petsc4py was built for Debian's numpy: pip uninstall numpy",
    )


def look_at_scipy() -> tuple[str, str, str]:
    """Version and origin, and whether it has stats.ecdf (scipy 1.11)."""
    import scipy.stats

    return (
        scipy.__version__,
        origin("scipy") + ("" if hasattr(scipy.stats, "ecdf") else ", without stats.ecdf"),
        "",
    )


def look_at_mpi() -> tuple[str, str, str]:
    """The MPI library and mpi4py's version."""
    import mpi4py
    from mpi4py import MPI

    trap = "mpi4py.futures needs petsc4py.init(comm=MPI.COMM_SELF) before dolfinx, or it hangs"
    return (
        re.split(r"[,\n]", MPI.Get_library_version())[0].strip(),
        f"mpi4py {mpi4py.__version__}; {trap}",
        "",
    )


def look_at_petsc() -> tuple[str, str, str]:
    """Versions of PETSc and petsc4py; complex scalars are an error."""
    import petsc4py
    from petsc4py import PETSc

    scalar = PETSc.ScalarType().dtype
    if scalar.kind != "f":
        raise RuntimeError(
            "complex scalars: apt install python3-dolfinx-real, and unset PETSC_DIR and PETSC_ARCH"
        )
    return (
        ".".join(map(str, PETSc.Sys.getVersion())),
        f"petsc4py {petsc4py.__version__}, scalars real ({scalar})",
        "",
    )


def look_at_mumps() -> tuple[str, str, str]:
    """Factor a matrix by MUMPS and name the library that did it."""
    from petsc4py import PETSc

    _factor(PETSc, "lu", "mumps")
    return "yes", ", ".join(loaded_libraries("libdmumps")), ""


def look_at_cholmod() -> tuple[str, str, str]:
    """Factor a matrix by CHOLMOD, which PETSc may lack."""
    from petsc4py import PETSc

    try:
        _factor(PETSc, "cholesky", "cholmod")
    except PETSc.Error:
        return (
            "no",
            "MUMPS factors in its place",
            "a step in full order on one rank takes half as long again: a PETSc with SuiteSparse",
        )
    return "yes", ", ".join(loaded_libraries("libcholmod")), ""


def _factor(PETSc: Any, kind: str, package: str) -> None:
    """Factor a matrix by a package of PETSc, of which asking whether it is there is not enough."""
    matrix = PETSc.Mat().createAIJ([1, 1], csr=([0, 1], [0], [2.0]), comm=PETSc.COMM_SELF)
    solver = PETSc.PC().create(PETSc.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType(kind)
    solver.setFactorSolverType(package)
    solver.setUp()


def look_at_blas() -> tuple[str, str, str]:
    """Which BLAS is loaded; advice where it is the slow reference implementation."""
    import numpy.linalg  # noqa: F401  loads BLAS
    from petsc4py import PETSc  # noqa: F401  loads BLAS

    # Debian puts every BLAS behind the name libblas.so.3; the folder tells which it is, "blas"
    # being the reference
    library = Path(loaded_libraries(r"lib(open)?blas|libmkl_rt|libblis|libatlas")[0])
    slow = "the reference BLAS makes MUMPS three times slower: apt install libopenblas0-pthread"
    return library.parent.name, str(library), slow if library.parent.name == "blas" else ""


def look_at_dolfinx() -> tuple[str, str, str]:
    """Version, and whether it writes fields by VTX or by XDMF."""
    import dolfinx.io

    return (
        dolfinx.__version__,
        "with VTXWriter" if hasattr(dolfinx.io, "VTXWriter") else "no VTXWriter: fields go to XDMF",
        "",
    )


def look_at_h5py() -> tuple[str, str, str]:
    """Version and its HDF5 library; a wheel of h5py is an error."""
    if origin("h5py") != "Debian":  # not imported: it may take the process down
        raise RuntimeError(
            f"a wheel in {origin('h5py')}, which crashes beside dolfinx: pip uninstall h5py"
        )
    import h5py

    beside = ", ".join(Path(file).name for file in loaded_libraries("libhdf5_(openmpi|mpich).so"))
    return (
        h5py.__version__,
        f"Debian, HDF5 {h5py.version.hdf5_version}, beside dolfinx's {beside or '(not loaded)'}",
        "",
    )


def look_at_gmsh() -> tuple[str, str, str]:
    """Version and origin of Gmsh."""
    import gmsh

    gmsh.initialize()
    return gmsh.option.getString("General.Version"), origin("gmsh"), ""


def look_at_pyvista() -> tuple[str, str, str]:
    """Draw a sphere off screen; a blank picture is an error."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
    plotter.add_mesh(pyvista.Sphere())
    blank = plotter.screenshot(None, return_img=True).std() == 0
    note = (
        f"VTK {'.'.join(map(str, pyvista.vtk_version_info))}, "
        f"{type(plotter.render_window).__name__}"
    )
    return (
        pyvista.__version__,
        note,
        "draws blank pictures: apt install libegl1 libgl1" if blank else "",
    )


def look_at_other(name: str) -> tuple[str, str, str]:
    """Version and origin of a library that needs no trial."""
    return importlib.import_module(name).__version__, origin(name), ""


# in the order an analysis loads them; h5py after dolfinx, whose HDF5 it must get along with
LIBRARIES = {
    "numpy": look_at_numpy, "scipy": look_at_scipy, "MPI": look_at_mpi, "PETSc": look_at_petsc,
    "MUMPS": look_at_mumps, "CHOLMOD": look_at_cholmod,
    "BLAS": look_at_blas, "dolfinx": look_at_dolfinx, "h5py": look_at_h5py, "Gmsh": look_at_gmsh,
    "numba": lambda: look_at_other("numba"), "meshio": lambda: look_at_other("meshio"),
    "matplotlib": lambda: look_at_other("matplotlib"), "pyvista": look_at_pyvista,
}  # fmt: skip
#: What to import to see why one crashes, where it is not its name
MODULES = {
    "MPI": "mpi4py.MPI", "PETSc": "petsc4py.PETSc", "MUMPS": "petsc4py.PETSc",
    "CHOLMOD": "petsc4py.PETSc", "BLAS": "petsc4py.PETSc", "dolfinx": "dolfinx.io",
    "Gmsh": "gmsh",
}  # fmt: skip
OPTIONAL = {"matplotlib", "pyvista", "CHOLMOD"}


def look_at_library(name: str) -> LibraryFinding:
    """One library's line, whatever its import raises."""
    try:
        return LibraryFinding(name, *LIBRARIES[name]())
    except Exception as error:  # noqa: BLE001  a broken library may raise anything
        state = (
            "missing"
            if isinstance(error, ModuleNotFoundError) or "NoneType" in str(error)
            else "broken"
        )
        reason = " ".join(str(error).split())[:200]
        remedy = reason if re.search("pip |apt ", reason) else f"{reason}: {_INSTALL}"
        return LibraryFinding(name, state, "", remedy, fit=name in OPTIONAL)


def look_at_libraries() -> list[LibraryFinding]:
    """Every library's line, from a child process, and another child after each crash."""
    # a child is no rank of the MPI job that the doctor may be part of
    environment = {
        k: v for k, v in os.environ.items() if not re.match("OMPI_(?!ALLOW)|ORTE|PMI|PRTE", k)
    }
    findings, left = [], list(LIBRARIES)
    while left:
        command = [sys.executable, "-P", __file__, "--child", *left]
        child = subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False
        )
        found = [
            LibraryFinding(**json.loads(line[1:]))
            for line in child.stdout.splitlines()
            if line.startswith("@{")
        ]
        findings += found
        left = left[len(found) :]
        if left:
            name = left.pop(0)
            remedy = (
                f"ends the process with exit code {child.returncode}; to see why: python -c "
                f"'import {MODULES.get(name, name)}'"
            )
            findings.append(LibraryFinding(name, "crashes", "", remedy, fit=name in OPTIONAL))
    return findings


def main(argv: list[str] | None = None) -> int:
    """Print the table and the warnings; 0 if analyses can run here, 1 if something essential is
    missing or broken.
    """
    parser = argparse.ArgumentParser(
        prog="fecolumn doctor", description=" ".join(__doc__.partition("\n\n")[0].split())
    )
    parser.add_argument("--child", nargs="+", help=argparse.SUPPRESS)
    for name in (child := parser.parse_args(argv).child) or []:
        print("@" + json.dumps(asdict(look_at_library(name))), flush=True)
    if child:
        return 0
    findings = look_at_machine() + look_at_libraries()
    wide = [
        max(len(getattr(finding, column)) for finding in findings)
        for column in ("component", "version")
    ]
    for finding in findings:
        print(
            f"{finding.component:{wide[0]}}  {finding.version:{wide[1]}}  {finding.note}".rstrip()
        )
    print()
    for finding in findings:
        if finding.warning:
            print(
                f"{'warning' if finding.fit else 'ERROR'}: {finding.component}: {finding.warning}"
            )
    fit = all(finding.fit for finding in findings)
    print("fit to run" if fit else "NOT fit to run")
    return 0 if fit else 1


if __name__ == "__main__":
    sys.exit(main())
