"""The layout of a case and the reduced models of its bodies, made once and kept on disk."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

from scipy.spatial import ConvexHull

from fecolumn.case.bodies import Storeys
from fecolumn.case.body_keys import WithMaterial
from fecolumn.case.case import Case, identity
from fecolumn.case.check_bodies import material_of
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.check import (
    check_layout,
    check_links,
    check_points,
)
from fecolumn.structures.layout import Layout, layout_of
from fecolumn.structures.model import HullOutline
from fecolumn.structures.patches import Patch
from fecolumn.structures.size import size_of
from fecolumn.structures.store import (
    KEPT_MODES,
    KeptLayout,
    MadeBody,
    keep_body,
    keep_layout,
    kept_layout,
    key_of,
)

# Keys of a body that no operator has
_LOOSE = ("at_m", "copies_m", "modes", "damping_ratio", "material")


def layout_on_disk(
    case: Case, file: Path | str, say: Callable[[str], None], fields: bool = False
) -> KeptLayout:
    """The layout as `store.keep_layout` keeps it, made if it is not on disk; fields as of
    `store.kept_layout`.
    """
    key = key_of(_geometry(case))
    found = kept_layout(key, fields)
    if found is None:
        say(f"meshing {len(case.bodies)} different bodies, at least {size_of(case, file).counts}")
        found = keep_models(case, layout_of(case, file), file, say)
        keep_layout(key, found)
    return found


def kept_keys(case: Case, file: Path | str = "case") -> dict[str, str]:
    """Key of each body's reduced model in `store`, on disk with the modes all over it."""
    return layout_on_disk(case, file, lambda text: None, fields=True)["models"]


def _geometry(case: Case) -> dict[str, Any]:
    """What of a case decides its layout and the reduced bodies."""
    bodies = {
        name: _made_of(case, name) | {"places": body.places} for name, body in case.bodies.items()
    }
    keys = ("slave", "on", "open", "interior_points", "allowance_m")
    return {
        "bodies": bodies,
        "levels": {name: ground.level_m for name, ground in case.grounds.items()},
        "joints": {
            name: [getattr(one, key) for key in keys] + [one.stiffness_n_m3 is not None]
            for name, one in case.joints.items()
        },
        "interior": case.interior_points,
    } | ({"found": sorted({name for name, _ in case.found})} if case.found else {})


def _made_of(case: Case, name: str) -> dict[str, Any]:
    """What of a body's keys decides its reduced model."""
    body = case.bodies[name]
    table = {
        key: value
        for key, value in identity(body).items()
        if key not in _LOOSE or isinstance(body, Storeys) and key == "damping_ratio"
    }
    if isinstance(body, WithMaterial):
        material = dataclasses.asdict(material_of(body, case.materials))
        if not isinstance(body, Storeys):
            del material["damping_ratio"]
        table["material"] = material
    if body.as_drawn:
        table["as_drawn"] = True
    return table | {"modes": max(case.modes_of(name), KEPT_MODES)}


def keep_models(
    case: Case, layout: Layout, file: Path | str, say: Callable[[str], None]
) -> KeptLayout:
    """Check a layout and have its bodies on disk; what `store.keep_layout` keeps of it."""
    check_drawings(case, layout, file)
    keys = {}
    for name, one in layout.drawings.items():
        patches = layout.patches[name]
        said = {
            surface: [patch.positions.tolist(), patch.axes.tolist(), len(patch.triangles)]
            for surface, patch in patches.items()
        }
        keys[name] = key_of([_made_of(case, name), said])
        count = max(case.modes_of(name), KEPT_MODES)

        def make(
            name: str = name,
            one: Drawing = one,
            patches: dict[str, Patch] = patches,
            count: int = count,
        ) -> MadeBody:
            say(f'making the reduced model of "{name}" (once)')
            return one.model(patches, count)

        keep_body(keys[name], make)
    return {"models": keys, **said_of(layout)}


def check_drawings(case: Case, layout: Layout, file: Path | str) -> None:
    """Refuse bodies that overlap or stand on nothing, those with too many contact points, and links
    to nowhere.
    """
    check_layout(case, layout, file)
    check_links(case, _extents(layout), file)
    for name in layout.drawings:
        check_points(name, layout.patches[name], file)


def said_of(layout: Layout) -> KeptLayout:
    """What `assembled` takes of a layout."""
    sizes = {name: one.shape.size for name, one in layout.drawings.items() if one.shape}
    return {
        "sizes": sizes,
        "extents": _extents(layout),
        "outlines": {name: _outline(one) for name, one in layout.drawings.items()},
        "contacts": [dataclasses.asdict(contact) for contact in layout.contacts],
    }


def _outline(drawing: Drawing) -> HullOutline | None:
    """Corners (n, 3) [m] of the convex hull of a drawing, and its volume [m3]."""
    if drawing.shape is None:
        return None
    points = drawing.shape.mesh.points
    corners = points[ConvexHull(points).vertices]
    return {
        "points": corners.tolist(),
        "volume": float(mass_properties(drawing.shape.mesh, 1.0).volume),
    }


def _extents(layout: Layout) -> dict[str, list[list[float]]]:
    """Lowest and highest place (3,) [m] of each body by name, as it is drawn."""
    return {
        name: [one.points.min(axis=0).tolist(), one.points.max(axis=0).tolist()]
        for name, one in layout.drawings.items()
    }
