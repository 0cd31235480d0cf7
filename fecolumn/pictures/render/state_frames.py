"""Fields made from the states that a reduced or rigid analysis kept, frame by frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.engines.reduced.states import Snapshot, modes_of, signature, state_at
from fecolumn.engines.scene.scene import Scene, SceneFields
from fecolumn.engines.stored import stored_states
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.field_frames import FrameSeries
from fecolumn.pictures.render.frame import Fields

if TYPE_CHECKING:
    from fecolumn.structures.model import BodyModel


#: Modes of a model made anew are those of the analysis when frequencies and signatures agree to
#: this share: states are kept in single precision
_SAME = 1e-5


def same_modes(old: np.ndarray, new: np.ndarray) -> bool:
    """Whether frequencies or signatures made anew are those that a file has."""
    return old.shape == new.shape and np.allclose(
        old, new, rtol=0, atol=_SAME * max(float(np.abs(old).max(initial=0.0)), 1e-300)
    )


class StateFrames(FrameSeries):
    """The states in a file of `reduced.states`; the models of the bodies, and what expands them to
    fields, are made when the first frame is read.

    Attributes
    ----------
    time
        (n,) [s] of each.

    Raises
    ------
    InputError
        the file is damaged, or of other bodies than those of the scene.
    """

    def __init__(self, file: Path, scene: Scene) -> None:
        self._arrays = stored_states(file)
        names = [piece.name for piece in scene.bodies]
        # those of a single column are without its name
        kept = self._arrays["bodies"].tolist() or names[:1]
        if kept != names:
            raise InputError(
                file,
                "",
                None,
                f"has the states of {', '.join(kept)}, not of {', '.join(names)}; run the case "
                "into a new folder",
            )
        self._file, self._scene = file, scene
        self._expand: SceneFields | None = None
        super().__init__(self._arrays["time"])

    def state(self, k: int) -> Snapshot:
        """Snapshot number k."""
        return state_at(self._arrays, k)

    def read(self, k: int) -> Fields:
        """Frame `k`.

        Raises
        ------
        InputError
            the modes of a body, made anew, are others than those of the analysis.
        """
        values, (_, centres) = self.values(k), self.drawn.pressures(self.state(k))
        return Fields(values["displacement"], values["von_mises"], values["pressure"], centres)

    def values(self, k: int) -> dict[str, np.ndarray]:
        """Fields of frame `k` by the names of `StateFields.values`."""
        return self.drawn.values(self.state(k))

    @property
    def drawn(self) -> SceneFields:
        """What expands states, and what `engines.scene.fields.FieldWriter` takes."""
        if self._expand is None:
            expand = self._scene.fields()
            self._check(expand.models)
            self._expand = expand
        return self._expand

    def _check(self, models: Sequence[BodyModel]) -> None:
        for name, made in (
            ("frequencies", [model.frequencies for model in models]),
            ("signature", [signature(model) for model in models]),
        ):
            new = modes_of(made)
            old = self._arrays[name].reshape(len(models), -1)
            for piece, kept, one in zip(self._scene.bodies, old, new):
                if not same_modes(kept, one):
                    raise InputError(
                        self._file,
                        "",
                        None,
                        f'is of other modes of "{piece.name}" than those made of it now: '
                        "deformation, stress and pressure cannot be made from it; "
                        "--colour displacement draws the history, and the case run into a new "
                        "folder has them again",
                    )


def write_fields(
    frames: StateFrames, folder: Path, tell: Callable[[int], object] = lambda done: None
) -> None:
    """Write the fields of all states into a folder, as `engines.scene.fields.FieldWriter` does."""
    from fecolumn.engines.scene.fields import FieldWriter

    apart = float(np.diff(frames.time).min()) if len(frames.time) > 1 else 1.0
    writer = FieldWriter(folder, frames.drawn, apart)
    for k, time in enumerate(frames.time):
        writer.add(time, frames.values(k))
        tell(k + 1)
