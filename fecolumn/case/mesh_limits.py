"""Keys of [mesh] of a case of bodies."""

from __future__ import annotations

from typing import ClassVar

from fecolumn.foundation.schema import Section, parameter
from fecolumn.foundation.section_class import section_class


@section_class()
class MeshLimits(Section):
    """Limit on the size of a structure's meshes; element sizes are keys of the bodies."""

    SECTION: ClassVar[str] = "mesh"  # its table

    limit_dofs: int = parameter(
        500_000,
        doc="number of degrees of freedom, of all different bodies together, above which their "
        'meshes are refused before they are built; with engine = "full" of all copies',
        low=100,
        high=10**9,
        counts=False,
        since="0.7",
    )
