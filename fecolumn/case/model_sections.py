"""Tables of the rocking models: [block], [frame], [wobbling], [wobbling_frame], [podium]."""

from __future__ import annotations

from typing import Any

from fecolumn.case.outline_keys import RectangleKeys, RockingKeys, RollingKeys
from fecolumn.foundation.schema import parameter
from fecolumn.foundation.section_class import section_class

#: Impact laws of a podium: floors keep their velocity relative to the beam, or their absolute one.
CRV, CAV = LAWS = ("CRV", "CAV")


@section_class()
class BlockModel(RockingKeys):
    """Rectangular rigid block that rocks along x about the edges of its foot (Housner 1963); with
    depth_m also along y, the two directions independent of each other.
    """

    depth_m: float | None = parameter(
        None,
        doc="depth along y; left out: 1 m of a wall, which rocks along x only",
        unit="m",
        above=0,
        high=1000,
    )
    density_kg_m3: float = parameter(
        2000.0,
        doc="density; of a free block it changes only forces and energies",
        unit="kg/m3",
        above=0,
        high=1e5,
    )
    sides: int = parameter(
        2,
        doc="2: the block leans to both sides; 1: to +x only, with a wall behind it",
        low=1,
        high=2,
    )
    spring_n_m: float = parameter(
        0.0,
        doc="stiffness of a horizontal spring on the block's axis",
        unit="N/m",
        low=0,
        high=1e12,
    )
    spring_height_m: float | None = parameter(
        None, doc="height of that spring; left out: at the top", unit="m", above=0, high=1000
    )
    bed_n_m2: float = parameter(
        0.0,
        doc="stiffness per height of horizontal springs distributed along the block's axis",
        unit="N/m2",
        low=0,
        high=1e12,
    )
    bed_from_m: float = parameter(
        0.0, doc="lower end of these distributed springs", unit="m", low=0, high=1000
    )
    bed_to_m: float | None = parameter(
        None,
        doc="upper end of these distributed springs; left out: the top",
        unit="m",
        above=0,
        high=1000,
    )
    roof_mass_kg: float = parameter(
        0.0, doc="point mass on the top, which moves with the block", unit="kg", low=0, high=1e9
    )
    roof_eccentricity_m: float = parameter(
        0.0,
        doc="distance of that mass from the block's axis, towards +x",
        unit="m",
        low=-1000,
        high=1000,
    )
    roof_thrust_n: float = parameter(
        0.0,
        doc="constant horizontal force of the roof at the top, towards +x",
        unit="N",
        low=-1e9,
        high=1e9,
    )


@section_class()
class FrameModel(RockingKeys):
    """Equal rectangular columns that carry a beam and rock along x."""

    column_mass_kg: float = parameter(doc="mass of one column", unit="kg", above=0, high=1e9)
    beam_mass_kg: float = parameter(doc="mass of the beam", unit="kg", low=0, high=1e9)
    columns: int = parameter(2, doc="number of columns", low=1, high=10_000)
    tendon_joints: int = parameter(
        1,
        doc="number of joints that a tendon crosses; 1: it is anchored in the column; 2: it runs "
        "from foundation to beam",
        low=1,
        high=2,
    )


@section_class()
class WobblingModel(RollingKeys):
    """Round rigid column that rolls on the rim of its foot without sliding (Vassiliou 2018)."""

    density_kg_m3: float = parameter(
        2000.0,
        doc="density; of a free column it changes only forces and energies",
        unit="kg/m3",
        above=0,
        high=1e5,
    )


@section_class()
class WobblingFrameModel(RollingKeys):
    """Slab on equal round columns that roll on their rims; each tendon is anchored in its column
    and in the slab.
    """

    column_mass_kg: float = parameter(doc="mass of one column", unit="kg", above=0, high=1e9)
    slab_mass_kg: float = parameter(doc="mass of the slab", unit="kg", above=0, high=1e9)
    columns: int = parameter(4, doc="number of columns", low=1, high=10_000)


@section_class()
class PodiumModel(RectangleKeys):
    """Building of equal storeys on a beam on rocking rectangular columns, along x (Bantilas,
    Kavvadias and Vasiliadis 2021).
    """

    column_mass_kg: float = parameter(doc="mass of one column", unit="kg", above=0, high=1e9)
    floor_mass_kg: float = parameter(doc="mass of each floor", unit="kg", above=0, high=1e9)
    columns: int = parameter(4, doc="number of columns", low=1, high=10_000)
    beam_mass_kg: float | None = parameter(
        None,
        doc="mass of the beam on the columns; left out: that of a floor",
        unit="kg",
        above=0,
        high=1e9,
    )
    storeys: int = parameter(3, doc="number of storeys", low=1, high=200)
    period_s: float | None = parameter(
        None,
        doc="period of the building's first mode on a fixed base; left out: 0.1 s per storey",
        unit="s",
        above=0,
        high=100,
    )
    damping_ratio: float = parameter(
        0.05, doc="damping ratio of modes 1 and 2 (Rayleigh damping)", low=0, high=0.5
    )
    profile: str = parameter(
        "shear",
        doc="shape of the first mode over the relative height x: flexural 1 - cos(pi x/2), shear "
        "sin(pi x/2), triangular x",
        choices=("flexural", "shear", "triangular"),
    )
    impact: str = parameter(
        CRV,
        doc="at an impact floors keep their velocity relative to the beam (CRV) or their "
        "absolute velocity (CAV)",
        choices=LAWS,
    )


#: Keys of each model's own table, by its name.
SECTIONS: dict[str, Any] = {
    "block": BlockModel,
    "frame": FrameModel,
    "wobbling": WobblingModel,
    "wobbling_frame": WobblingFrameModel,
    "podium": PodiumModel,
}
