"""Isotropic elasticity in UFL."""

from __future__ import annotations

from typing import Any

import ufl


def lame(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """First Lame parameter and shear modulus [Pa]."""
    shear = youngs_modulus / (2 * (1 + poissons_ratio))
    return 2 * shear * poissons_ratio / (1 - 2 * poissons_ratio), shear


def isotropic_stress(strain: Any, youngs_modulus: float, poissons_ratio: float) -> Any:
    """Stress of Hooke's law for a strain tensor (3, 3).

    With the Green-Lagrange strain this is the second Piola-Kirchhoff stress of the St.
    Venant-Kirchhoff material.
    """
    first, shear = lame(youngs_modulus, poissons_ratio)
    return first * ufl.tr(strain) * ufl.Identity(3) + 2 * shear * strain


def von_mises(stress: Any) -> Any:
    """Von Mises equivalent stress of a stress tensor (3, 3)."""
    deviator = stress - ufl.tr(stress) / 3 * ufl.Identity(3)
    return ufl.sqrt(1.5 * ufl.inner(deviator, deviator))
