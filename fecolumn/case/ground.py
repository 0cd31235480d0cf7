"""Keys of a ground."""

from __future__ import annotations

from fecolumn.case.sections import Motion
from fecolumn.foundation.schema import Section, parameter
from fecolumn.foundation.section_class import section_class

#: Name of the ground of a case that states none: a rigid flat at z = 0.
GROUND_NAME = "ground"


@section_class()
class Ground(Section):
    """What bodies stand on, and what the ground motion moves: a rigid plane, an elastic plate fixed
    at its bottom, the same layer without edges, or a pad of springs and dashpots, such as soil.
    """

    kind: str = parameter(
        "rigid",
        doc="rigid: a rigid plane; plate: elastic plate with edges; unbounded: the same layer "
        "without edges; pad: springs and dashpots per area, without edges",
        choices=("rigid", "plate", "unbounded", "pad"),
    )
    level_m: float = parameter(
        0.0, doc="height of the ground's surface", unit="m", low=-1e4, high=1e4
    )
    length_m: float | None = parameter(
        None,
        doc="length of a plate along x, its middle below the middle of all feet on it; left out: "
        "the length over all feet plus three times the larger side of the largest foot",
        unit="m",
        above=0,
        high=1000,
    )
    width_m: float | None = parameter(
        None,
        doc="width of a plate along y, by the same rule as length_m",
        unit="m",
        above=0,
        high=1000,
    )
    thickness_m: float | None = parameter(
        None,
        doc="thickness of a plate or layer; left out: a quarter of the smallest foot's smaller "
        "side",
        unit="m",
        above=0,
        high=100,
    )
    slide_allowance_m: float | None = parameter(
        None,
        doc="finely meshed margin around each foot; of an unbounded ground with several feet: "
        "how far they may slide apart; left out: a quarter of the smallest foot's smaller "
        "side, or less where the stated length and width leave less",
        unit="m",
        low=0,
        high=1000,
    )
    youngs_modulus_pa: float = parameter(
        200e9, doc="Young's modulus of a plate or layer", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float = parameter(
        0.3, doc="Poisson's ratio of a plate or layer", low=0, high=0.49
    )
    density_kg_m3: float = parameter(
        7850.0, doc="density of a plate or layer", unit="kg/m3", above=0, high=1e5
    )
    element_size_m: float | None = parameter(
        None,
        doc="element size of a plate or layer below feet; left out: a twelfth of the side of a "
        "square with the area of the smallest foot",
        unit="m",
        above=0,
        high=10,
    )
    coarse_size_m: float | None = parameter(
        None,
        doc="largest element size of a plate or layer; left out: six times element_size_m",
        unit="m",
        above=0,
        high=10,
    )
    stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of a pad per area across the contact (subgrade modulus); needed for a pad",
        unit="N/m3",
        low=0,
        high=1e15,
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of a pad per area along the contact (shear); 0: 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
    )
    damping_ratio: float = parameter(
        0.0,
        doc="damping ratio, by the dashpots of a pad, of the vertical vibration of all that "
        "stands on it",
        low=0,
        high=10,
    )
    yield_pa: float | None = parameter(
        None,
        doc="pressure at which a pad yields and settles permanently; left out: it never yields",
        unit="Pa",
        above=0,
        high=1e12,
    )
    motion: Motion | None = None
