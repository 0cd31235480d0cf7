"""`fecolumn mesh`: meshes, picture and the table that says whether to trust them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from fecolumn.mesh.bending import free_free_bending_frequency, rectangle_bending_frequency
from fecolumn.mesh.bricks import PART_NAMES
from fecolumn.mesh.estimate import estimate
from fecolumn.mesh.export import write_meshes
from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.mesh.picture import picture
from fecolumn.mesh.quality import quality_table
from fecolumn.mesh.specimen import specimen_mesh
from fecolumn.short_form import ShortForm
from fecolumn.sizes import is_solid

# Below so many widths high Timoshenko's beam is too short to compare with
_STUBBY = 2.0


def mesh_report(case: ShortForm, folder, say=lambda text: None) -> str:
    """Write .msh, .xdmf, picture and table of a case's meshes into `folder`; returns the table.

    `say` is told the estimate first.
    """
    folder = Path(folder)
    expected = estimate(case)
    say(str(expected))
    specimen = specimen_mesh(case)
    folder.mkdir(parents=True, exist_ok=True)
    write_meshes(specimen, folder)
    picture(specimen, folder / "mesh.png")
    lines = [
        str(expected),
        ", ".join(
            f"{key} = {getattr(case.mesh, key):g} m"
            for key in ("fine_size_m", "coarse_size_m", "cap_size_m", "base_size_m")
        ),
        "",
        f"{'part':<16}{'nodes':>8}{'elements':>10}{'dofs':>9}{'smallest scaled Jacobian':>27}",
    ]
    for mesh in (specimen.body, specimen.base):
        jacobian = scaled_jacobian(mesh)
        for part in sorted(set(mesh.part.tolist())):
            nodes = len(mesh.part_nodes(part))
            inside = mesh.part == part
            lines.append(
                f"{PART_NAMES[part]:<16}{nodes:>8}{inside.sum():>10}{expected.dofs[part]:>9}{jacobian[inside].min():>27.3f}"
            )
    lines += ["", f"{'quantity':<66}{'unit':<8}{'mesh':>14}{'closed form':>14}{'difference':>12}"]
    for row in quality_table(case, specimen):
        exact = f"{row.exact:>14.6g}{100 * row.difference:>11.3f}%" if row.exact is not None else ""
        lines.append(f"{row.name:<66}{row.unit:<8}{row.mesh:>14.6g}{exact}")
    found, theory, name = _bending(case, specimen)
    exact = f"{theory:>14.6g}{100 * (found / theory - 1):>11.3f}%" if theory else ""
    lines.append(f"{'first free-free bending, ' + name:<66}{'Hz':<8}{found:>14.6g}{exact}")
    text = "\n".join(lines)
    (folder / "table.txt").write_text(text + "\n")
    return text


def bending_theory(case: ShortForm) -> float | None:
    """First free-free bending frequency [Hz] of the bare column as a Timoshenko beam; None of a
    user's mesh and of a stubby column.
    """
    column, material = case.column, case.material
    if column.mesh_file:
        return None
    elastic = material.youngs_modulus_pa, material.poissons_ratio, material.density_kg_m3
    if column.shape == "block":
        sides = sorted((column.length_m, column.width_m))
        return (
            rectangle_bending_frequency(*sides, column.height_m, *elastic)
            if column.height_m > _STUBBY * sides[0]
            else None
        )
    outer = column.outer_diameter_m / 2
    inner = 0.0 if is_solid(case.column) else outer - column.wall_m
    return (
        free_free_bending_frequency(outer, inner, column.height_m, *elastic)
        if column.height_m > _STUBBY * 2 * outer
        else None
    )


def _bending(case: ShortForm, specimen) -> tuple[float, float | None, str]:
    """First bending frequency [Hz] of the bare column's finite elements and ties, its closed form,
    and of what it is.

    Of the lowest modes it is the one that moves most like a bent beam: a stubby column may twist or
    stretch at a lower frequency.
    """
    from mpi4py import MPI

    from fecolumn.dynamics.assembly import column_body
    from fecolumn.fem.modes import free_modes

    if case.column.mesh_file:
        bare, mesh, name = case, specimen, "mesh of the file" + (" with cap" if case.cap else "")
    else:
        bare = dataclasses.replace(case, cap=None, flange=None)
        mesh, name = specimen_mesh(bare), f"{case.column.shape} alone"
    body = column_body(bare, mesh, MPI.COMM_SELF)
    modes = free_modes(body, 14)
    height = np.ptp(body.X[:, 2])
    along = (body.X[:, 2] - body.center[2]) / height
    # a bow that neither shifts nor turns a uniform bar
    bow = body.node_mass * (along**2 - 1 / 12)
    bent = [np.hypot(*(bow @ shape[:, :2])) for shape in modes.shapes[6:]]
    return float(modes.frequencies[6 + int(np.argmax(bent))]), bending_theory(case), name
