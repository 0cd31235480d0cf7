"""Fields made from the states that a reduced or rigid analysis kept, frame by frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.reduced.states import read_states, signature, state_at
from fecolumn.render.field_frames import Fields, FrameSeries
from fecolumn.schema import InputError
from fecolumn.short_form import ShortForm

#: Modes of a model made anew are those of the analysis when frequencies and signatures agree to
#: this share: states are kept in single precision
SAME = 1e-5


def same_modes(old: np.ndarray, new: np.ndarray) -> bool:
    """Whether frequencies or signatures made anew are those that a file has."""
    return old.shape == new.shape and np.allclose(
        old, new, rtol=0, atol=SAME * max(float(np.abs(old).max(initial=0.0)), 1e-300)
    )


class StateFrames(FrameSeries):
    """The states in a file of `reduced.states`; the model of the column, and what expands it to
    fields, are made when the first frame is read.

    Attributes
    ----------
    time
        (n,) [s] of each.
    """

    def __init__(self, file: Path, case: ShortForm):
        """Raises:
        InputError: the file is damaged.
        """
        try:
            self._arrays = read_states(file)
        except (OSError, KeyError) as error:
            raise InputError(
                file,
                "",
                None,
                f"not the states of an analysis ({error}); remove it to draw what the "
                "history alone gives",
            ) from None
        self._file, self._case, self._expand = file, case, None
        super().__init__(self._arrays["time"])

    def read(self, k: int) -> Fields:
        """Frame `k`.

        Raises
        ------
        InputError
            the column's modes, made anew, are others than those of the analysis.
        """
        values = self.values(k)
        return Fields(values["displacement"], values["von_mises"], values["pressure"])

    def values(self, k: int) -> dict[str, np.ndarray]:
        """Fields of frame `k` by the names of `post.fields.SpecimenFields.values`."""
        return self.expand.values(state_at(self._arrays, k))

    @property
    def drawn(self):
        """What `post.fields.FieldWriter` takes."""
        return self.expand.specimen

    @property
    def expand(self):
        """StateFields of the case."""
        if self._expand is None:
            from fecolumn.reduced.cache import load_model
            from fecolumn.reduced.fields import StateFields

            model, _, folder = load_model(self._case)
            self._check(model)
            self._expand = StateFields(self._case, model, folder)
        return self._expand

    def _check(self, model) -> None:
        if not (
            same_modes(self._arrays["frequencies"], model.frequencies)
            and same_modes(self._arrays["signature"], signature(model))
        ):
            raise InputError(
                self._file,
                "",
                None,
                "is of other modes than those made of this column now: deformation, "
                "stress and pressure cannot be made from it; "
                "--color displacement draws the history, and the case run into a new "
                "folder has them again",
            )


def write_fields(frames, folder: Path, tell=lambda done: None) -> None:
    """Write the fields of all states into a folder, as `post.fields.FieldWriter` does.

    Parameters
    ----------
    frames
        StateFrames or StructureStates.
    """
    from fecolumn.post.fields import FieldWriter

    writer = FieldWriter(folder, frames.drawn)
    for k, time in enumerate(frames.time):
        writer.add(time, frames.values(k))
        tell(k + 1)
