"""How large the meshes of a structure will be, told before any is built."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fecolumn.mesh.estimate import refuse_sizes
from fecolumn.schema import InputError
from fecolumn.structures.keys import Block, Matrices, Meshed, Plate, Storeys
from fecolumn.structures.shapes import counts_of, element_size


@dataclass(frozen=True)
class Size:
    """Elements and degrees of freedom of the meshes by body; those of copies count where each has
    its own, with engine = "full".
    """

    elements: dict[str, int]
    dofs: dict[str, int]

    def __str__(self) -> str:
        return (
            f"{sum(self.elements.values()):,} elements, {sum(self.dofs.values()):,} degrees "
            "of freedom"
        )


def size_of(case, file, spots=None, bodies=None) -> Size:
    """Size of the meshes of a case.

    Parameters
    ----------
    spots
        by name of a plate where others meet it, as of `layout_of`; without them plates have no more
        than their own elements.
    bodies
        names; all unless given.
    """
    elements, dofs = {}, {}
    for name in case.bodies if bodies is None else bodies:
        body, times = (
            case.bodies[name],
            len(case.names_of(name)) if case.integration.engine == "full" else 1,
        )
        if not isinstance(body, Matrices):
            count, nodes = counts_of(f"bodies.{name}", body, file, (spots or {}).get(name, ()))
            elements[name], dofs[name] = times * count, 3 * times * nodes
    return Size(elements, dofs)


def refuse_too_large(case, file, spots=None) -> None:
    """Refuse meshes of more degrees of freedom than `mesh.limit_dofs`, naming the body and the size
    that makes them so, and one that would fit.
    """
    found, limit = size_of(case, file, spots), case.mesh.limit_dofs
    if (total := sum(found.dofs.values())) <= limit:
        return
    name = max(found.dofs, key=found.dofs.get)
    body, key = case.bodies[name], f"bodies.{name}"
    too_many = (
        f"the meshes would have {total:,} degrees of freedom "
        f"({sum(found.elements.values()):,} elements, {found.elements[name]:,} of them "
        f'of "{name}"), '
        f"mesh.limit_dofs allows {limit:,}"
    )
    if isinstance(body, Meshed):
        raise InputError(
            file,
            f"{key}.mesh_file",
            body.mesh_file,
            f"{too_many}; take a coarser mesh, or a higher mesh.limit_dofs",
        )
    coarse, high = getattr(body, "coarse_size_m", None), _largest(body)
    # of two that do as well the first is named
    sizes = ({f"{key}.coarse_size_m": (coarse, high)} if coarse else {}) | {
        f"{key}.element_size_m": (element_size(body), high)
    }

    def dofs_with(changed: str, value: float) -> int:
        other = {changed.rpartition(".")[2]: value}
        if coarse:
            other["coarse_size_m"] = max(coarse, value)
        trial = replace(case, bodies=case.bodies | {name: replace(body, **other)})
        return total - found.dofs[name] + size_of(trial, file, spots, [name]).dofs[name]

    refuse_sizes(file, sizes, dofs_with, limit, too_many, "the elements of all bodies")


def _largest(body) -> float:
    """The largest element size [m] that a body takes, as `check_keys.check_body` says."""
    if isinstance(body, Block):
        return min(body.length_m, body.width_m)
    return (
        max(body.length_m, body.width_m)
        if isinstance(body, (Plate, Storeys))
        else math.pi * body.outer_diameter_m / 12
    )
