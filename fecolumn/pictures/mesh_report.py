"""`fecolumn mesh`: meshes, picture and the tables that say whether to trust them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.bodies import Block, Cylinder, MeshBody, Plate, Tube
from fecolumn.case.column_keys import Column
from fecolumn.case.ground import Ground
from fecolumn.case.sections import Cap, Flange, Material
from fecolumn.contact.points import GROUND
from fecolumn.engines.reduced_engine import upright
from fecolumn.engines.scene.structure_scene import structure_scene
from fecolumn.fem.whole_groups import with_group
from fecolumn.mesh.bending import free_free_bending_frequency, rectangle_bending_frequency
from fecolumn.mesh.bricks import PART_NAMES, BrickMesh
from fecolumn.mesh.export import write_meshes
from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.mesh.mass import mass_properties
from fecolumn.mesh.outline import is_solid
from fecolumn.mesh.quality import QualityRow, quality_table
from fecolumn.mesh.specimen import SpecimenMesh
from fecolumn.mesh.upright import Upright
from fecolumn.pictures.mesh_picture import mesh_picture
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.layout import layout_of
from fecolumn.structures.made_layout import keep_models
from fecolumn.structures.reduction import body_of
from fecolumn.structures.shapes import shape_of
from fecolumn.structures.size import expected, made_of
from fecolumn.structures.standing import touching
from fecolumn.structures.store import kept_body
from fecolumn.structures.structure import assembled, standing_of
from fecolumn.structures.tied import OfGrids, built_of

if TYPE_CHECKING:
    from fecolumn.case.case import Case
    from fecolumn.engines.scene.scene import Piece, Scene
    from fecolumn.structures.layout import Layout
    from fecolumn.structures.model import BodyModel, StructureModel
    from fecolumn.structures.tied import OfGrids


#: Files that the report writes.
FILES = "specimen.msh", "specimen.xdmf", "specimen.h5", "mesh.png", "table.txt"
# Below so many widths high Timoshenko's beam is too short to compare with
_STUBBY = 2.0
# Kinds of bodies with a closed form of volume, mass and inertia, or with a mesh that is its own
_CLOSED_FORMS = ("tube", "cylinder", "block", "plate", "slab", "mesh")
_NOTHING = BrickMesh(np.zeros((0, 3)), np.zeros((0, 8), np.int64), np.zeros(0, np.int8))


@dataclass(frozen=True, slots=True)
class Made(Upright):
    """What a body is made of, as the closed forms of its mass and bending take it."""

    column: Column
    flange: Flange | None
    cap: Cap | None
    material: Material


def mesh_report(
    case: Case,
    file: Path | str,
    folder: Path | str,
    say: Callable[[str], None] = lambda text: None,
) -> str:
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
    mesh_picture(scene, structure, folder / "mesh.png")
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
            *_closed_forms(layout.drawings, scene),
            *_links(case, structure),
        ]
    )
    (folder / "table.txt").write_text(text + "\n")
    return text


def _parts(scene: Scene) -> list[str]:
    """Table of the parts of bodies of several grids, and of elastic grounds."""
    rows = []
    for piece, mesh in {piece.kind: (piece, mesh) for piece, mesh in _each(scene)}.values():
        parts = sorted(set(mesh.part.tolist()))
        if len(parts) < 2 and not piece.held:
            continue
        jacobian = scaled_jacobian(mesh)
        for part in parts:
            inside = mesh.part == part
            name = f"{piece.kind}, {PART_NAMES.get(part, 'floors')}"
            count = len(mesh.part_nodes(part))
            rows.append((name, count, int(inside.sum()), float(jacobian[inside].min())))
    columns = "<32 part; >8 nodes; >10 elements; >27.3f smallest scaled Jacobian"
    return ["", *_table(columns, rows)] if rows else []


def _each(scene: Scene) -> Iterator[tuple[Piece, BrickMesh]]:
    """Pieces and their meshes, last of all copies the first; without those of matrices."""
    pairs = [pair for pair in zip(scene.pieces, scene.meshes) if pair[1].cells.shape[1] > 3]
    return reversed(pairs)


def _closed_forms(drawings: dict[str, Drawing], scene: Scene) -> list[str]:
    """Masses of bodies and grounds, and the first bending of bodies, beside closed forms."""
    rows = [(name, row) for name, drawing in drawings.items() for row in closed_form_rows(drawing)]
    for piece, mesh in _each(scene):
        if piece.held:
            volume = float(np.prod(np.ptp(mesh.points, axis=0)))
            found = mass_properties(mesh, 1.0).volume
            rows.append((piece.name, QualityRow("volume", "m3", found, volume)))
    table = []
    for name, row in rows:
        what = row.name.removeprefix("column: ").removesuffix(" of the column")
        exact = (
            ("", "")
            if row.exact is None or row.difference is None
            else (float(row.exact), f"{100 * row.difference:.3f}%")
        )
        table.append((f"{name}: {what}", row.unit, float(row.mesh), *exact))
    columns = "<74 quantity; <8 unit; >14.6g mesh; >14.6g closed form; >12 difference"
    return ["", *_table(columns, table)] if table else []


def closed_form_rows(drawing: Drawing) -> list[QualityRow]:
    """Volume, mass, inertia and first bending of a body's mesh beside their closed forms; none of
    a kind without closed forms, or where the body is turned or its foot is a dome.
    """
    body = drawing.body
    # of what is turned, has a dome or is none of these there is no form but the mesh itself
    if body.kind not in _CLOSED_FORMS or getattr(body, "foot_radius_m", None):
        return []
    if getattr(body, "turned_deg", 0.0):
        return []
    assert isinstance(body, Plate | OfGrids)
    assert drawing.shape is not None and drawing.material is not None
    made, mesh = _made(body, drawing.material), drawing.shape.mesh
    low = mesh.points[:, 2].min()
    foot = np.flatnonzero(mesh.points[:, 2] < low + 1e-6 * np.ptp(mesh.points[:, 2]))
    rows = list(quality_table(made, SpecimenMesh(mesh, _NOTHING, (), foot)))
    if isinstance(body, MeshBody) and (body.centre_m or body.inertia_kg_m2):
        rows = [dataclasses.replace(row, exact=None) for row in rows]
    if body.deforms and not isinstance(body, Plate):
        found, theory, name = _bending(drawing, made)
        rows.append(QualityRow(f"first free-free bending, {name}", "Hz", found, theory))
    return rows


def _made(body: Plate | OfGrids, material: Material) -> Made:
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


def bending_theory(case: Upright) -> float | None:
    """First free-free bending frequency [Hz] of the bare column as a Timoshenko beam; None of a
    user's mesh and of a stubby column.
    """
    column, material = case.column, case.material
    if column.mesh_file:
        return None
    elastic = material.youngs_modulus_pa, material.poissons_ratio, material.density_kg_m3
    if column.shape == "block":
        thin, wide = sorted((column.length_m, column.width_m))
        return (
            rectangle_bending_frequency(thin, wide, column.height_m, *elastic)
            if column.height_m > _STUBBY * thin
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
    if isinstance(drawing.body, MeshBody):
        name = "mesh of the file" + (" with cap" if made.cap else "")
    elif isinstance(drawing.body, Tube | Cylinder | Block) and (made.cap or made.flange):
        bare = dataclasses.replace(drawing.body, cap=None, flange=None)
        shape = shape_of(drawing.key, bare, drawing.file)
    assert shape is not None
    body = body_of(shape, made.material)
    modes = free_modes(body, 14)
    height = np.ptp(body.X[:, 2])
    along = (body.X[:, 2] - body.center[2]) / height
    # a bow that neither shifts nor turns a uniform bar
    bow = body.node_mass * (along**2 - 1 / 12)
    bent = [np.hypot(*(bow @ shape[:, :2])) for shape in modes.shapes[6:]]
    return float(modes.frequencies[6 + int(np.argmax(bent))]), bending_theory(made), name


def _table(columns: str, rows: Iterable[Sequence[object]]) -> list[str]:
    """Lines of a table, the head and a line each row; columns: format and head of each column, such
    as "<16 body; >14.6g mass [kg]". No lines where there are no rows.
    """
    heads = [column.strip().partition(" ") for column in columns.split(";")]
    plain = ["".join(f"{head:{form.partition('.')[0]}}" for form, _, head in heads)]
    for row in rows:
        line = ""
        for (form, _, _), value in zip(heads, row, strict=True):
            line += f"{value:{form.partition('.')[0] if isinstance(value, str) else form}}"
        plain.append(line)
    return plain if len(plain) > 1 else []


def _bodies(case: Case, layout: Layout, models: Mapping[str, BodyModel]) -> list[str]:
    rows = []
    for name, model in models.items():
        shape, hertz = layout.drawings[name].shape, model.frequencies[:4] / (2 * np.pi)
        rows.append(
            (
                name,
                len(case.names_of(name)),
                float(model.mass),
                float(model.center[2]),
                ", ".join(f"{value:.5g}" for value in np.diag(model.inertia)),
                len(shape.mesh.cells) if shape else 0,
                model.dofs,
                float(scaled_jacobian(shape.mesh).min()) if shape else 1.0,
                len(model.arms),
                with_group(model.frequencies, case.modes_of(name)),
                ", ".join(f"{value:.4g}" for value in hertz) or "rigid",
            )
        )
    columns = (
        "<16 body; >7 copies; >14.6g mass [kg]; >14.5g centre z [m]; >36 inertia x, y, z [kg m2];"
        ">10 elements; >9 dofs; >10.3f Jacobian; >8 points; >7 modes; >34 first frequencies [Hz]"
    )
    return _table(columns, rows)


def _interfaces(case: Case, structure: StructureModel) -> list[str]:
    rows, standing = [], standing_of(case, structure)
    for joint in structure.joints:
        if joint.pair >= 0:
            continue  # the other side of a joint that has its line
        surface = structure.parts[joint.slave].model.surfaces[joint.slave_surface]
        over = touching(standing, joint)
        rim = "round" if joint.round else "edges"
        rows.append(
            (
                joint.name,
                len(surface.nodes),
                len(over),
                float(surface.areas[over].sum()),
                float(joint.friction),
                "dome" if joint.on_dome else rim,
            )
        )
    columns = (
        "<50 interface; >8 points; >15 of them touch; >12.5g area [m2]; >10.3g friction; >8 rim"
    )
    return _table(columns, rows)


def _grounds(case: Case, structure: StructureModel) -> list[str]:
    """What stands on each ground, and how it gives."""
    if all(ground == Ground() for ground in case.grounds.values()):
        return []
    rows = []
    for place, (name, ground) in enumerate(case.grounds.items()):
        feet = [one for one in structure.joints if one.master == GROUND and one.ground == place]
        area = sum(
            structure.parts[one.slave].model.surfaces[one.slave_surface].areas.sum() for one in feet
        )
        # of a pad that of what stands on it, of a plate or a layer its own
        frequency = min(
            [one.pad.frequency for one in feet if one.pad] or [structure.bases[place].frequency]
        )
        rows.append(
            (
                name,
                ground.kind,
                float(ground.level_m),
                len(feet),
                float(area),
                f"{frequency:.4g}" if np.isfinite(frequency) else "-",
                structure.bases[place].dofs,
            )
        )
    columns = (
        "<26 ground; <12 kind; >10.4g level [m]; >6 feet; >12.5g area [m2]; >16 frequency [Hz];"
        ">9 dofs"
    )
    return ["", *_table(columns, rows)]


def _links(case: Case, structure: StructureModel) -> list[str]:
    rows, standing, grounds = [], standing_of(case, structure), list(case.grounds)
    for link in structure.links:
        held = grounds[link.ground] if link.b == GROUND else structure.parts[link.b].name
        other = link.arm_b if link.b == GROUND else standing[link.b].center + link.arm_b
        # elongations from the unstressed length
        limits = [
            (float(force), float(link.slack + force / link.stiffness))
            if np.isfinite(force)
            else ("-", "-")
            for force in (link.yield_n, link.breaking_n)
        ]
        rows.append(
            (
                f"{link.kind} {link.name}",
                f"{structure.parts[link.a].name} - {held}",
                float(np.linalg.norm(other - standing[link.a].center - link.arm_a)),
                float(link.stiffness),
                float(link.damping),
                float(link.prestress),
                float(link.slack),
                *limits[0],
                *limits[1],
                float(link.hardening),
                next((float(e) for e in (link.bends, link.power) if 0 < abs(e - 1) < np.inf), "-"),
            )
        )
    columns = (
        "<26 link; <40 between; >12.5g length [m]; >17.5g stiffness [N/m]; >17.5g damping [N s/m];"
        ">15.5g prestress [N]; >11.4g slack [m]; >12.5g yields [N]; >11.4g at [m];"
        ">12.5g breaks [N]; >11.4g at [m]; >14.4g hardening [-]; >13.4g exponent [-]"
    )
    return ["", *_table(columns, rows)] if rows else []
