"""The states that the analysis of a structure kept, and what expands them to fields."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.reduced.states import modes_of, read_states, signature, state_at
from fecolumn.render.field_frames import FrameSeries
from fecolumn.render.state_frames import same_modes
from fecolumn.render.structure_fields import StructureFields
from fecolumn.render.structure_solid import StructureSolid
from fecolumn.schema import InputError


class StructureStates(FrameSeries):
    """Instants at which the bodies of a structure are known.

    Attributes
    ----------
    time
        (n,) [s]. center: (n, nb, 3) [m] of mass; rotation: (n, nb, 3, 3).

    Parameters
    ----------
    file
        of `reduced.states`.
    solid
        StructureSolid.
    shapes
        as of `StructureFields`.

    Raises
    ------
    InputError
        the file is damaged, or of other bodies.
    """

    def __init__(self, file: Path, solid: StructureSolid, shapes):
        try:
            self._arrays = read_states(file)
        except (OSError, KeyError) as error:
            raise InputError(
                file,
                "",
                None,
                f"not the states of an analysis ({error}); run the case into a new folder",
            ) from None
        names = [part.name for part in solid.structure.parts]
        if self._arrays["bodies"].tolist() != names:
            raise InputError(
                file,
                "",
                None,
                "has the states of "
                f"{', '.join(self._arrays['bodies']) or 'a single column'}, not of "
                f"{', '.join(names)}; run the case into a new folder",
            )
        super().__init__(self._arrays["time"])
        if not len(self.time):
            raise InputError(file, "", None, "has no states; run the case into a new folder")
        self._file, self._solid, self._shapes, self._fields = file, solid, shapes, None
        self.center, self.rotation = self._arrays["center"], self._arrays["rotation"]

    def state(self, k: int):
        """`reduced.states.State` number k."""
        return state_at(self._arrays, k)

    @property
    def has_stress(self) -> bool:
        """Whether any body deforms as a continuum."""
        return self.drawn.has_stress

    def local(self, k: int, stress: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of state k as of `StructureFields.local`."""
        return self.drawn.local(self.state(k), stress)

    def pressures(self, k: int) -> tuple[list[np.ndarray], np.ndarray]:
        """Of state k as of `StructureFields.pressures`."""
        return self.drawn.pressures(self.state(k))

    def broken(self, k: int) -> np.ndarray:
        """Whether links (nl,) are broken at state k."""
        return self.state(k).broken

    @property
    def drawn(self) -> StructureFields:
        """What expands states; made when it is first asked for.

        Raises
        ------
        InputError
            the modes of a body, made anew, are others than those of the analysis.
        """
        if self._fields is None:
            self._check()
            self._fields = StructureFields(self._solid, self._shapes)
        return self._fields

    def values(self, k: int) -> dict[str, np.ndarray]:
        """Fields of state k by the names of `StructureFields.values`."""
        return self.drawn.values(self.state(k))

    def _check(self) -> None:
        parts = self._solid.structure.parts
        for name, made in (
            ("frequencies", [part.model.frequencies for part in parts]),
            ("signature", [signature(part.model) for part in parts]),
        ):
            old, new = self._arrays[name], modes_of(made)
            for part, kept, one in zip(parts, old, new):
                if not same_modes(kept, one):
                    raise InputError(
                        self._file,
                        "",
                        None,
                        f'is of other modes of "{part.name}" than those made of it now; '
                        "the case run into a new folder has them again",
                    )
