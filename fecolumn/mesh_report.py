"""`fecolumn mesh`: meshes, picture and the tables that say whether to trust them."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case import Cap, Flange, Material
from fecolumn.mesh.bending import free_free_bending_frequency, rectangle_bending_frequency
from fecolumn.mesh.bricks import PART_NAMES, BrickMesh
from fecolumn.mesh.export import write_meshes
from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.mesh.picture import picture
from fecolumn.mesh.quality import QualityRow, mass_properties, quality_table
from fecolumn.mesh.specimen import SpecimenMesh
from fecolumn.post.structure_scene import structure_scene
from fecolumn.short_form import Column, Heights
from fecolumn.sizes import is_solid
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.engine import upright
from fecolumn.structures.keys import Ground, Matrices, Meshed, Plate, Storeys
from fecolumn.structures.layout import layout_of
from fecolumn.structures.model import GROUND
from fecolumn.structures.picture import structure_picture
from fecolumn.structures.place import touching
from fecolumn.structures.reduction import body_of
from fecolumn.structures.shapes import shape_of
from fecolumn.structures.size import expected, made_of
from fecolumn.structures.store import kept_body
from fecolumn.structures.structure import assembled, keep_models, standing_of
from fecolumn.structures.tied import built_of

#: Files that the report writes.
FILES = "specimen.msh", "specimen.xdmf", "specimen.h5", "mesh.png", "table.txt"
# Below so many widths high Timoshenko's beam is too short to compare with
_STUBBY = 2.0
_NOTHING = BrickMesh(np.zeros((0, 3)), np.zeros((0, 8), np.int64), np.zeros(0, np.int8))


@dataclass(frozen=True, slots=True)
class Made(Heights):
    """What a body is made of, as the closed forms of its mass and bending take it."""

    column: Column
    flange: Flange | None
    cap: Cap | None
    material: Material


def mesh_report(case, file, folder, say=lambda text: None) -> str:
    """Write .msh, .xdmf, picture and tables of the meshes of a case into `folder`; returns the
    tables.

    `say` is told the estimate first.
    """
    folder = Path(folder)
    say(str(expected(case, file)))
    layout = layout_of(case, file)
    kept = keep_models(case, layout, file, say)
    models = {name: kept_body(key) for name, key in kept["models"].items()}
    structure = assembled(case, models, kept, file)
    scene = structure_scene(case, upright(case, structure), layout.drawings, file)
    folder.mkdir(parents=True, exist_ok=True)
    write_meshes(scene.meshes, folder)
    _draw(scene, structure, folder / "mesh.png")
    found = made_of(case, models, scene)
    text = "\n".join(
        [
            str(found),
            "",
            *_bodies(case, layout, models),
            *_parts(scene),
            "",
            *_interfaces(case, structure),
            *_grounds(case, structure),
            *_links(case, structure),
            *_closed_forms(layout.drawings, scene),
        ]
    )
    (folder / "table.txt").write_text(text + "\n")
    return text


def _draw(scene, structure, path: Path) -> None:
    """A body alone with its foot magnified, several with their names."""
    meshes = scene.meshes
    feet = [contact for contact in scene.contacts if contact.on_ground]
    if len(scene.bodies) > 1 or len(feet) != 1 or not meshes[0].part.all():
        structure_picture(scene, structure, path)
        return
    base = meshes[1] if len(meshes) > 1 else _NOTHING
    picture(SpecimenMesh(meshes[0], base, (), feet[0].points), path)


def _parts(scene):
    """Table of the parts of bodies of several grids, and of elastic grounds."""
    rows = []
    for piece, mesh in {piece.kind: (piece, mesh) for piece, mesh in _each(scene)}.values():
        parts = sorted(set(mesh.part.tolist()))
        if len(parts) < 2 and not piece.held:
            continue
        jacobian = scaled_jacobian(mesh)
        for part in parts:
            inside = mesh.part == part
            rows.append(
                f"{piece.kind + ', ' + PART_NAMES.get(part, 'floors'):<32}"
                f"{len(mesh.part_nodes(part)):>8}{inside.sum():>10}{jacobian[inside].min():>27.3f}"
            )
    if rows:
        yield from ("", f"{'part':<32}{'nodes':>8}{'elements':>10}{'smallest scaled Jacobian':>27}")
        yield from rows


def _each(scene):
    """Pieces and their meshes, last of all copies the first; without those of matrices."""
    pairs = [pair for pair in zip(scene.pieces, scene.meshes) if pair[1].cells.shape[1] > 3]
    return reversed(pairs)


def _closed_forms(drawings: dict[str, Drawing], scene):
    """Masses of bodies and grounds, and the first bending of bodies, beside closed forms."""
    rows = [(name, row) for name, drawing in drawings.items() for row in _rows(drawing)]
    for piece, mesh in _each(scene):
        if piece.held:
            volume = float(np.prod(np.ptp(mesh.points, axis=0)))
            found = mass_properties(mesh, 1.0).volume
            rows.append((piece.name, QualityRow("volume", "m3", found, volume)))
    if rows:
        yield from (
            "",
            f"{'quantity':<74}{'unit':<8}{'mesh':>14}{'closed form':>14}{'difference':>12}",
        )
    for name, row in rows:
        exact = f"{row.exact:>14.6g}{100 * row.difference:>11.3f}%" if row.exact is not None else ""
        what = row.name.removeprefix("column: ").removesuffix(" of the column")
        yield f"{name + ': ' + what:<74}{row.unit:<8}{row.mesh:>14.6g}{exact}"


def _rows(drawing: Drawing) -> list[QualityRow]:
    body = drawing.body
    # of what is turned or has a dome there is no form but the mesh itself
    if isinstance(body, (Matrices, Storeys)) or getattr(body, "foot_radius_m", None):
        return []
    if getattr(body, "turned_deg", 0.0):
        return []
    made, mesh = _made(body, drawing.material), drawing.shape.mesh
    low = mesh.points[:, 2].min()
    foot = np.flatnonzero(mesh.points[:, 2] < low + 1e-6 * np.ptp(mesh.points[:, 2]))
    rows = list(quality_table(made, SpecimenMesh(mesh, _NOTHING, (), foot)))
    if not (body.rigid or isinstance(body, Plate)):
        found, theory, name = _bending(drawing, made)
        rows.append(QualityRow(f"first free-free bending, {name}", "Hz", found, theory))
    return rows


def _made(body, material: Material) -> Made:
    if isinstance(body, Plate):
        column = Column(
            shape="block",
            length_m=body.length_m,
            width_m=body.width_m,
            height_m=body.thickness_m,
        )
        return Made(column, None, None, material)
    built = built_of(body)
    return Made(built.column, built.flange, built.cap, material)


def bending_theory(case: Made) -> float | None:
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


def _bending(drawing: Drawing, made: Made) -> tuple[float, float | None, str]:
    """First bending frequency [Hz] of the finite elements and ties of a body without flange and
    cap, its closed form, and of what it is.

    Of the lowest modes it is the one that moves most like a bent beam: a stubby body may twist or
    stretch at a lower frequency.
    """
    from fecolumn.fem.modes import free_modes

    shape, name = drawing.shape, f"{made.column.shape} alone"
    if isinstance(drawing.body, Meshed):
        name = "mesh of the file" + (" with cap" if made.cap else "")
    elif made.cap or made.flange:
        bare = dataclasses.replace(drawing.body, cap=None, flange=None)
        shape = shape_of(drawing.key, bare, drawing.file)
    body = body_of(shape, drawing.material)
    modes = free_modes(body, 14)
    height = np.ptp(body.X[:, 2])
    along = (body.X[:, 2] - body.center[2]) / height
    # a bow that neither shifts nor turns a uniform bar
    bow = body.node_mass * (along**2 - 1 / 12)
    bent = [np.hypot(*(bow @ shape[:, :2])) for shape in modes.shapes[6:]]
    return float(modes.frequencies[6 + int(np.argmax(bent))]), bending_theory(made), name


def _bodies(case, layout, models):
    yield (
        f"{'body':<16}{'copies':>7}{'mass [kg]':>14}{'centre z [m]':>14}{'inertia x, y, z [kg m2]':>36}{'elements':>10}{'dofs':>9}{'Jacobian':>10}{'points':>8}"
        f"{'modes':>7}{'first frequencies [Hz]':>34}"
    )
    for name, model in models.items():
        shape = layout.drawings[name].shape
        hertz = (
            ", ".join(f"{value:.4g}" for value in model.frequencies[:4] / (2 * np.pi)) or "rigid"
        )
        inertia = ", ".join(f"{value:.5g}" for value in np.diag(model.inertia))
        yield (
            f"{name:<16}{len(case.names_of(name)):>7}{model.mass:>14.6g}{model.center[2]:>14.5g}{inertia:>36}{len(shape.mesh.cells) if shape else 0:>10}"
            f"{model.dofs:>9}{scaled_jacobian(shape.mesh).min() if shape else 1:>10.3f}{len(model.arms):>8}{min(case.modes_of(name), len(model.frequencies)):>7}{hertz:>34}"
        )


def _interfaces(case, structure):
    yield f"{'interface':<50}{'points':>8}{'of them touch':>15}{'area [m2]':>12}{'friction':>10}{'rim':>8}"
    standing = standing_of(case, structure)
    for joint in structure.joints:
        if joint.pair >= 0:
            continue  # the other side of a joint that has its line
        surface = structure.parts[joint.slave].model.surfaces[joint.slave_surface]
        over = touching(standing, joint)
        yield f"{joint.name:<50}{len(surface.nodes):>8}{len(over):>15}{surface.areas[over].sum():>12.5g}{joint.friction:>10.3g}{'dome' if joint.ball and joint.ball.is_dome else 'round' if joint.round else 'edges':>8}"


def _grounds(case, structure):
    """What stands on each ground, and how it gives."""
    if all(ground == Ground() for ground in case.grounds.values()):
        return
    yield from (
        "",
        f"{'ground':<26}{'kind':<12}{'level [m]':>10}{'feet':>6}{'area [m2]':>12}"
        f"{'frequency [Hz]':>16}{'dofs':>9}",
    )
    for place, (name, ground) in enumerate(case.grounds.items()):
        feet = [one for one in structure.joints if one.master == GROUND and one.ground == place]
        area = sum(
            structure.parts[one.slave].model.surfaces[one.slave_surface].areas.sum() for one in feet
        )
        # of a pad that of what stands on it, of a plate or a layer its own
        frequency = min(
            [one.pad.frequency for one in feet if one.pad] or [structure.bases[place].frequency]
        )
        shown = f"{frequency:.4g}" if np.isfinite(frequency) else "-"
        yield (
            f"{name:<26}{ground.kind:<12}{ground.level_m:>10.4g}{len(feet):>6}{area:>12.5g}"
            f"{shown:>16}{structure.bases[place].dofs:>9}"
        )


def _links(case, structure):
    if structure.links:
        yield from (
            "",
            f"{'link':<26}{'between':<40}{'length [m]':>12}{'stiffness [N/m]':>17}{'damping [N s/m]':>17}{'prestress [N]':>15}{'slack [m]':>11}{'yields [N]':>12}{'at [m]':>11}"
            f"{'breaks [N]':>12}{'at [m]':>11}",
        )
    standing, grounds = standing_of(case, structure), list(case.grounds)
    for link in structure.links:
        ends = (
            f"{structure.parts[link.a].name} - "
            f"{grounds[link.ground] if link.b == GROUND else structure.parts[link.b].name}"
        )
        other = link.arm_b if link.b == GROUND else standing[link.b].center + link.arm_b
        length = np.linalg.norm(other - standing[link.a].center - link.arm_a)
        # elongations from the unstressed length
        limits = "".join(
            f"{force:>12.5g}{link.slack + force / link.stiffness:>11.4g}"
            if np.isfinite(force)
            else f"{'-':>12}{'-':>11}"
            for force in (link.yield_n, link.breaking_n)
        )
        yield (
            f"{link.kind + ' ' + link.name:<26}{ends:<40}{length:>12.5g}{link.stiffness:>17.5g}{link.damping:>17.5g}{link.prestress:>15.5g}{link.slack:>11.4g}{limits}"
        )
