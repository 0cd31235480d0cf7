"""A sample of peak displacements: of an ensemble, whoever made it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Sample:
    """Peak displacements of an ensemble, and where they come from.

    Attributes
    ----------
    source
        folder or file.
    title
        of the study, or the file's name.
    choice
        value of each axis that was chosen, by its dotted key.
    motions
        (n,) name of each run's motion, all different.
    u_max
        (n,) [m]; nan where the run overturned or slid off its base.
    lost
        (n,) bool, overturned or slid off: either way the peak is beyond what was seen.
    slid_off
        (n,) bool, of these the ones that slid off.
    missing
        analyses of the choice that are not done.
    cut
        what is said of analyses that cut their motion short, see `ending.cut_short`.
    records
        (n,) record of each run's motion; None where each has its own.
    contents
        (n,) what each motion holds, by which motions of one name are told apart; None where that is
        not known.
    """

    source: str
    title: str
    choice: dict[str, Any]
    motions: tuple[str, ...]
    u_max: NDArray[Any]
    lost: NDArray[Any]
    slid_off: NDArray[Any]
    missing: int = 0
    cut: str = ""
    records: tuple[str, ...] | None = None
    contents: tuple[str, ...] | None = None

    def take(self, motions: Iterable[str]) -> Sample:
        """The runs of some motions, in their order."""
        motions = tuple(motions)
        places = [self.motions.index(motion) for motion in motions]
        return Sample(
            self.source,
            self.title,
            self.choice,
            motions,
            self.u_max[places],
            self.lost[places],
            self.slid_off[places],
            self.missing,
            self.cut,
            tuple(self.records[place] for place in places) if self.records else None,
            tuple(self.contents[place] for place in places) if self.contents else None,
        )
