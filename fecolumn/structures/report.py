"""`fecolumn mesh` of a structure: picture, and the table of bodies, interfaces and links."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.structures.keys import Ground
from fecolumn.structures.layout import layout_of
from fecolumn.structures.model import GROUND
from fecolumn.structures.picture import structure_picture
from fecolumn.structures.place import touching
from fecolumn.structures.store import kept_body
from fecolumn.structures.structure import assembled, keep_models, standing_of

#: Files that the report writes.
FILES = "structure.png", "table.txt"


def structure_report(case, file, folder, say=lambda text: None) -> str:
    """Write picture and table of a structure into `folder`; returns the table."""
    folder = Path(folder)
    layout = layout_of(case, file)
    say(
        f"{sum(len(one.shape.mesh.cells) for one in layout.drawings.values() if one.shape):,} "
        f"elements in {len(layout.drawings)} different bodies"
    )
    kept = keep_models(case, layout, file, say)
    models = {name: kept_body(key) for name, key in kept["models"].items()}
    structure = assembled(case, models, kept, file)
    copies = [(name, number) for name in case.bodies for number in range(len(case.names_of(name)))]
    folder.mkdir(parents=True, exist_ok=True)
    structure_picture(layout, structure, copies, folder / "structure.png")
    text = "\n".join(
        [
            *_bodies(case, layout, models),
            "",
            *_interfaces(case, structure),
            *_grounds(case, structure),
            *_links(case, structure),
        ]
    )
    (folder / "table.txt").write_text(text + "\n")
    return text


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
