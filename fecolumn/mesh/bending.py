"""Bending vibration of the free column: the reference for the tied mesh's first elastic mode."""

from __future__ import annotations

import cmath
import math

from scipy.optimize import brentq

_EULER_BERNOULLI = 4.730040744862704**2  # first root of cos cosh = 1, squared (free-free)


def cowper_coefficient(inner_radius: float, outer_radius: float, poissons_ratio: float) -> float:
    """Shear coefficient of a hollow or solid circular section.

    G. R. Cowper, "The shear coefficient in Timoshenko's beam theory", J. Appl. Mech. 33 (1966),
    335-340.

    Parameters
    ----------
    inner_radius, outer_radius
        [m]; inner 0 for a solid section.
    poissons_ratio
        [-].
    """
    nu, m2 = poissons_ratio, (inner_radius / outer_radius) ** 2
    return 6 * (1 + nu) * (1 + m2) ** 2 / ((7 + 6 * nu) * (1 + m2) ** 2 + (20 + 12 * nu) * m2)


def free_free_bending_frequency(
    outer_radius: float,
    inner_radius: float,
    length: float,
    youngs_modulus: float,
    poissons_ratio: float,
    density: float,
) -> float:
    """First bending frequency of a free Timoshenko beam of circular section [Hz]; see
    `free_free_frequency`.

    Parameters
    ----------
    outer_radius, inner_radius
        [m]; inner 0 for a solid section.
    length
        [m].
    youngs_modulus
        [Pa]
    poissons_ratio
        [-]
    density
        [kg/m3].
    """
    area = math.pi * (outer_radius**2 - inner_radius**2)
    second_moment = math.pi / 4 * (outer_radius**4 - inner_radius**4)
    return free_free_frequency(
        area,
        second_moment,
        cowper_coefficient(inner_radius, outer_radius, poissons_ratio),
        length,
        youngs_modulus,
        poissons_ratio,
        density,
    )


def rectangle_bending_frequency(
    across: float,
    along: float,
    length: float,
    youngs_modulus: float,
    poissons_ratio: float,
    density: float,
) -> float:
    """First bending frequency of a free Timoshenko beam of rectangular section, bent in the plane
    of its side `across` [m], in Hz.

    Shear coefficient of Cowper (1966): 10 (1 + nu) / (12 + 11 nu).
    """
    shear = 10 * (1 + poissons_ratio) / (12 + 11 * poissons_ratio)
    return free_free_frequency(
        across * along,
        along * across**3 / 12,
        shear,
        length,
        youngs_modulus,
        poissons_ratio,
        density,
    )


def free_free_frequency(
    area: float,
    second_moment: float,
    shear_coefficient: float,
    length: float,
    youngs_modulus: float,
    poissons_ratio: float,
    density: float,
) -> float:
    """First bending frequency of a free Timoshenko beam [Hz].

    With r^2 = I / (A L^2), s^2 = E I / (k A G L^2) and b^2 = rho A L^4 omega^2 / (E I), the
    frequencies are the roots of

        2 - 2 cosh(b alpha) cos(b beta)
          + b / sqrt(1 - b^2 r^2 s^2) [b^2 r^2 (r^2 - s^2)^2 + 3 r^2 - s^2] sinh(b alpha) sin(b
              beta) = 0,
        alpha, beta = sqrt(-+(r^2 + s^2) + sqrt((r^2 - s^2)^2 + 4 / b^2)) / sqrt(2);

    T. C. Huang, "The effect of rotatory inertia and of shear deformation on the frequency and
    normal mode equations of uniform beams with simple end conditions", J. Appl. Mech. 28 (1961),
    579-584, case free-free. Rotatory inertia and shear only lower the first root, so it lies below
    that of Euler and Bernoulli.

    Parameters
    ----------
    area
        [m2]
    second_moment
        of the area [m4]
    shear_coefficient
        k [-].
    length
        [m].
    youngs_modulus
        [Pa]
    poissons_ratio
        [-]
    density
        [kg/m3].
    """
    shear = shear_coefficient * youngs_modulus / (2 * (1 + poissons_ratio))
    r2 = second_moment / (area * length**2)
    s2 = youngs_modulus * second_moment / (shear * area * length**2)

    def huang(b: float) -> float:
        split = math.sqrt((r2 - s2) ** 2 + 4 / b**2)
        # Above the shear cut-off alpha turns imaginary, and the equation stays real.
        alpha, beta = cmath.sqrt((split - r2 - s2) / 2), math.sqrt((split + r2 + s2) / 2)
        coupling = b / cmath.sqrt(1 - b * b * r2 * s2) * (b * b * r2 * (r2 - s2) ** 2 + 3 * r2 - s2)
        value = (
            2
            - 2 * cmath.cosh(b * alpha) * math.cos(b * beta)
            + coupling * cmath.sinh(b * alpha) * math.sin(b * beta)
        )
        return value.real

    # The rigid modes are a multiple root at b = 0: the scan starts well above it and takes the
    # first change of sign.
    steps = 2000
    grid = [_EULER_BERNOULLI * (0.01 + 0.991 * i / steps) for i in range(steps + 1)]
    low, high = next((a, b) for a, b in zip(grid, grid[1:]) if huang(a) * huang(b) <= 0)
    b = brentq(huang, low, high, xtol=1e-13, rtol=1e-14)
    return (
        b / (2 * math.pi * length**2) * math.sqrt(youngs_modulus * second_moment / (density * area))
    )
