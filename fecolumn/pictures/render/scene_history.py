"""Motion of the bodies of a scene, and of the top that is followed, from the history of an
analysis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.engines.scene.scene import Scene
from fecolumn.foundation.schema import InputError, meant
from fecolumn.pictures.render.pose import Poses

if TYPE_CHECKING:
    from fecolumn.case.case import Case
    from fecolumn.structures.model import StructureModel


@dataclass(frozen=True, slots=True)
class SceneHistory:
    """A scene and its history.

    Attributes
    ----------
    poses
        of each body at the rows of the history.
    u_top
        displacement (n, 3) [m] of the top that is followed.
    top
        (3,) [m] its place at rest.
    title
        of its plan view.
    body
        number of the body to which it belongs.
    floors
        by body: displacement (n, 1 + k, 3) [m] of a building's slab and of its k floors beyond that
        of its pose.
    """

    scene: Scene
    poses: tuple[Poses, ...]
    u_top: np.ndarray
    top: np.ndarray
    title: str
    body: int
    floors: dict[int, np.ndarray] = field(default_factory=dict)


def read_scene_history(
    case: Case, folder: Path, history: dict[str, np.ndarray], body: str
) -> SceneHistory:
    """Motion of a scene from the history of an analysis.

    Raises
    ------
    InputError
        its files are gone, it has no such body, or the history is of another structure.
    """
    from scipy.spatial.transform import Rotation

    from fecolumn.engines.reduced_engine import upright
    from fecolumn.engines.scene.structure_scene import scene_of
    from fecolumn.structures.structure import structure_model

    file = folder / "case.json"
    structure = upright(case, structure_model(case, file))
    followed, observed = _place(structure, body), structure.observed
    mark = observed[1] if followed == observed[0] else "top"
    part = structure.parts[followed]
    column = f"mark/{part.name}.{mark}/displacement"
    moved = "displacement", "rotation"
    for name in [f"body/{one.name}/{what}" for one in structure.parts for what in moved]:
        if name not in history:
            raise InputError(
                folder / "history.h5",
                "",
                None,
                f'has no column "{name}": it is of another structure than that of case.json, '
                "or of a version before 0.7; run the case into a new folder",
            )
    moves = []
    for one in structure.parts:
        matrices = Rotation.from_rotvec(history[f"body/{one.name}/rotation"]).as_matrix()
        there = one.center + history[f"body/{one.name}/displacement"]
        moves.append(Poses(history["time"], matrices, there, one.center))
    scene, top = scene_of(case, structure, file), part.center + part.model.marks[mark][0]
    # a rocking model writes the tops alone: other places of a rigid body move as it does
    u_top = moves[followed].move(top[None], slice(None))[:, 0] - top
    return SceneHistory(
        scene,
        tuple(moves),
        history.get(column, u_top),
        top,
        f"{mark} of {part.name}",
        followed,
        _floors(scene, structure, history, moves),
    )


def _place(structure: StructureModel, body: str) -> int:
    if not body:
        return structure.observed[0]
    names = [part.name for part in structure.parts]
    if body not in names:
        raise InputError(
            "fecolumn render",
            "--body",
            body,
            f"no such body{meant(body, names)}; there are {', '.join(names)}",
        )
    return names.index(body)


def _floors(
    scene: Scene, structure: StructureModel, history: dict, moves: Sequence[Poses]
) -> dict[int, np.ndarray]:
    """As of `SceneHistory`: from the marks of the floors, and the drift of the lowest from the
    slab.
    """
    found = {}
    for k, (piece, part, pose) in enumerate(zip(scene.bodies, structure.parts, moves)):
        shifts = []
        for number in range(1, piece.carried // 8 + 1):
            at = part.center + part.model.marks[f"floor {number}"][0]
            moved = history[f"mark/{part.name}.floor {number}/displacement"]
            shifts.append(at + moved - pose.move(at[None], slice(None))[:, 0])
        if shifts:
            drift = np.pad(history[f"storey/{part.name} 1/drift"], [(0, 0), (0, 1)])
            found[k] = np.stack([shifts[0] - drift, *shifts], axis=1)
    return found
