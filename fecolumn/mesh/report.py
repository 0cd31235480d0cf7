"""`fecolumn mesh`: meshes, picture and the table that says whether to trust them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from fecolumn.case import Case
from fecolumn.mesh.bending import free_free_bending_frequency
from fecolumn.mesh.bricks import PART_NAMES
from fecolumn.mesh.export import write_meshes
from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.mesh.picture import picture
from fecolumn.mesh.quality import quality_table
from fecolumn.mesh.specimen import specimen_mesh


def mesh_report(case: Case, folder) -> str:
    """Write .msh, .xdmf, picture and table of a case's meshes into `folder`; returns the table."""
    folder = Path(folder)
    specimen = specimen_mesh(case)
    folder.mkdir(parents=True, exist_ok=True)
    write_meshes(specimen, folder)
    picture(specimen, folder / "mesh.png")
    lines = [f"{'part':<16}{'nodes':>8}{'elements':>10}{'dofs':>9}{'smallest scaled Jacobian':>27}"]
    for mesh in (specimen.body, specimen.base):
        jacobian = scaled_jacobian(mesh)
        for part in sorted(set(mesh.part.tolist())):
            nodes = len(mesh.part_nodes(part))
            inside = mesh.part == part
            lines.append(f"{PART_NAMES[part]:<16}{nodes:>8}{inside.sum():>10}{3 * nodes:>9}{jacobian[inside].min():>27.3f}")
    lines += ["", f"{'quantity':<53}{'unit':<8}{'mesh':>14}{'closed form':>14}{'difference':>12}"]
    for row in quality_table(case, specimen):
        exact = f"{row.exact:>14.6g}{100 * row.difference:>11.3f}%" if row.exact is not None else ""
        lines.append(f"{row.name:<53}{row.unit:<8}{row.mesh:>14.6g}{exact}")
    column, material = case.column, case.material
    outer = column.outer_diameter_m / 2
    theory = free_free_bending_frequency(outer, outer - column.wall_m, column.height_m, material.youngs_modulus_pa,
                                         material.poissons_ratio, material.density_kg_m3)
    found = _bare_tube_frequency(case)
    lines.append(f"{'first free-free bending, tube without cap':<53}{'Hz':<8}{found:>14.6g}{theory:>14.6g}{100 * (found / theory - 1):>11.3f}%")
    text = "\n".join(lines)
    (folder / "table.txt").write_text(text + "\n")
    return text


def _bare_tube_frequency(case: Case) -> float:
    """First bending frequency of the column's finite elements and ties without the cap [Hz]."""
    from mpi4py import MPI

    from fecolumn.dynamics.assembly import column_body
    from fecolumn.dynamics.modes import free_modes

    tube = dataclasses.replace(case, cap=None)
    return float(free_modes(column_body(tube, specimen_mesh(tube), MPI.COMM_SELF), 8).frequencies[6])
