"""Measured restitutions of rocking blocks in the literature, beside Housner's and the map's."""

from __future__ import annotations

from dataclasses import dataclass

from fecolumn.engines.rocking.impact import rectangular_restitution

# Casapulla, Giresini and Lourenco (2017, section 2.2), who quote it of the first two sources
_QUOTED = "Casapulla and others 2017"


@dataclass(frozen=True)
class Measured:
    """Tests of rectangular blocks of one slenderness H / B.

    Attributes
    ----------
    source
        author, year, what was tested on what.
    ratio
        H / B.
    least, most
        restitution of the angular velocity.
    said
        where it is said.
    """

    source: str
    ratio: float
    least: float
    most: float
    said: str

    @property
    def losses(self) -> tuple[float, float]:
        """Energy lost over Housner's, least and most: (1 - e^2) / (1 - e_H^2)."""
        housner = rectangular_restitution(self.ratio)
        low, high = ((1 - e**2) / (1 - housner**2) for e in (self.most, self.least))
        return low, high


def _over_housner(source: str, ratio: float, share: float, said: str) -> Measured:
    """A restitution that is told as a share of Housner's."""
    e = share * rectangular_restitution(ratio)
    return Measured(source, ratio, e, e, said)


_STEEL, _MASONRY = "Lipscombe and Pellegrino 1993, steel", "Sorrentino and others 2011, brick, tuff"
#: One range is quoted for all four blocks of steel. Other sources tell no number of a slenderness.
MEASURED = (
    *(Measured(_STEEL, ratio, 0.88, 0.93, _QUOTED) for ratio in (1.0, 2.0, 4.0, 8.0)),
    *(_over_housner(_MASONRY, ratio, 0.95, _QUOTED) for ratio in (6.5, 14.6)),
    *(
        _over_housner(f"ElGawady and others 2006, on {base}", ratio, share, "its abstract")
        for base, ratio, share in (("concrete", 3.0, 0.97), ("concrete", 5.0, 0.95))
    ),
    _over_housner("ElGawady and others 2006, on rubber", 5.0, 0.67, "its abstract"),
)
