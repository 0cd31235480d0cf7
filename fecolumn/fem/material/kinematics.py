"""Strain measures in UFL."""

from __future__ import annotations

from typing import Any

import ufl


def linear_strain(u: Any) -> Any:
    """Small strain, sym(grad u)."""
    return ufl.sym(ufl.grad(u))


def green_lagrange_strain(u: Any) -> Any:
    """Green-Lagrange strain, (F^T F - I) / 2 with F = I + grad u."""
    gradient = ufl.grad(u)
    return (gradient + gradient.T + gradient.T * gradient) / 2
