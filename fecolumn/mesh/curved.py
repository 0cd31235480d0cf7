"""Mass properties of what Gmsh has drawn with curved faces, where its kernel tells none."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from fecolumn.mesh.mass import MassProperties, from_moments

# Rule for x_i x_j in elements with quadratic sides
_RULE = "Gauss7"
# Elements above which they are not curved: so many draw a body well with flat faces
_MOST = 200_000


def curved_properties(gmsh: ModuleType) -> MassProperties | None:
    """Mass properties, at a density of 1 and in the script's unit, of the mesh of the current model
    with quadratic elements, whose middle nodes lie on its curved faces; the model's own elements
    are of second order after that. None of very many elements, or where Gmsh makes none.

    A circle in n sides is off by 0.013 % in its area with n = 12, where flat sides are by 4.5 %.
    """
    _, tags, _ = gmsh.model.mesh.getElements(3)
    if sum(map(len, tags)) > _MOST:
        return None
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    try:
        gmsh.model.mesh.setOrder(2)
        for kind in gmsh.model.mesh.getElementTypes(3):
            places, weights = gmsh.model.mesh.getIntegrationPoints(kind, _RULE)
            _, determinants, x = gmsh.model.mesh.getJacobians(kind, places)
            # elements that are turned have negative ones throughout
            share = np.abs(np.reshape(determinants, (-1, len(weights)))) * weights
            x = np.reshape(x, (*share.shape, 3))
            volume += share.sum()
            first += np.einsum("eq,eqi->i", share, x)
            second += np.einsum("eq,eqi,eqj->ij", share, x, x)
    except Exception:  # Gmsh raises plain exceptions
        return None
    return from_moments(volume, first, second, 1.0) if volume > 0 else None
