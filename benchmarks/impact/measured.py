"""Measured restitutions of rocking blocks in the literature, beside the map."""

from __future__ import annotations

from dataclasses import dataclass

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.impact import rectangular_restitution

#: Moduli [Pa] and densities [kg/m3] usual for the materials; heights [m] such tests have. The
#: sources of the numbers here do not tell them: the stiffness group is an order of magnitude.
_STEEL, _GRANITE, _MASONRY, _CONCRETE = (2e11, 7850), (5e10, 2670), (2e9, 1700), (3e10, 2400)


@dataclass(frozen=True)
class Measured:
    """Tests of rectangular blocks of one slenderness H / B.

    Attributes
    ----------
    source
        author, year, what was tested.
    ratio
        H / B.
    least, most
        restitution of the angular velocity over Housner's.
    group
        E B / (rho g H^2), an order of magnitude.
    """

    source: str
    ratio: float
    least: float
    most: float
    group: float

    @property
    def losses(self) -> tuple[float, float]:
        """Energy lost over Housner's, least and most: (1 - e^2) / (1 - e_H^2)."""
        housner = rectangular_restitution(self.ratio)
        low, high = (
            (1 - (share * housner) ** 2) / (1 - housner**2) for share in (self.most, self.least)
        )
        return low, high


def _group(material, height: float, ratio: float) -> float:
    modulus, density = material
    return modulus / (density * GRAVITY * height * ratio)


#: Casapulla, Giresini and Lourenco (2017, section 2.2) quote the first three: 0.88 to 0.93 over
#: steel blocks of H/B 1, 2, 4 and 8, not block by block; granite slightly below theory. ElGawady,
#: Butterworth and Ingham (2006) is quoted from its abstract.
MEASURED = (
    Measured(
        "Lipscombe and Pellegrino 1993, steel",
        4.0,
        0.88 / rectangular_restitution(4.0),
        0.93 / rectangular_restitution(4.0),
        _group(_STEEL, 0.2, 4.0),
    ),
    Measured("Pena and others 2007, granite", 4.0, 0.95, 1.0, _group(_GRANITE, 1.0, 4.0)),
    Measured("Pena and others 2007, granite", 8.0, 0.95, 1.0, _group(_GRANITE, 1.0, 8.0)),
    Measured(
        "Sorrentino and others 2011, brick and tuff", 6.5, 0.95, 0.95, _group(_MASONRY, 1.0, 6.5)
    ),
    Measured(
        "Sorrentino and others 2011, brick and tuff", 14.6, 0.95, 0.95, _group(_MASONRY, 1.0, 14.6)
    ),
    Measured("ElGawady and others 2006, on concrete", 3.0, 0.97, 0.97, _group(_CONCRETE, 0.6, 3.0)),
    Measured("ElGawady and others 2006, on concrete", 5.0, 0.95, 0.95, _group(_CONCRETE, 1.0, 5.0)),
)
