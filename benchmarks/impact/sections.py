"""Bodies of the map of impacts, on a flat that does not give, and what an impact depends on.

A body of width B and height H, of density rho, modulus E and Poisson's ratio nu, with friction mu,
let go at a share s of its critical tilt, has lengths B and H, the time sqrt(H / g) of rocking and
the time H / c of a wave, c^2 = E / rho. Its material is linear and its ground gives nowhere, so
that no other scale is left:

    loss over Housner's = f(B / H, S, s, mu, nu, shape),    S = E / (rho g H) = (wave / rocking)^2,

with S the inverse of the strain by its own weight. Products of S with powers of the slenderness B/H
have names:

    S (B/H)     E B / (rho g H^2): critical tilt over the rotation of the elastic foot
    S (B/H)^2   (bending frequency / rocking frequency)^2
    S (B/H)^4   (stress rho c v of the landing edge over that of the weight)^2, v ~ B / H sqrt(g B^2
                / H)

The map takes the first as its axis. No power makes all slendernesses fall onto one curve
(benchmarks/RESULTS.md). nu is 0.2 and the tilt of release 0.3 of the critical one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.impact.rocker import ReducedRocker
from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.structures.structure import structure_model
from fecolumn.verification.trial import RigidRocking

#: Height [m] and density [kg/m3] of all bodies: only the groups matter.
HEIGHT, DENSITY, POISSON = 1.5, 2700.0, 0.2
#: Width along y over that along x of a block, wall over the diameter of a tube.
DEEP, WALL = 0.5, 0.1
SHAPES = ("block", "solid", "tube")


@dataclass(frozen=True)
class Body:
    """A body of the map.

    Attributes
    ----------
    shape
        of SHAPES.
    ratio
        H / B.
    group
        E B / (rho g H^2).
    friction
        coefficient.
    elements
        over the width B at the foot.
    modes
        elastic, of the reduced engine.
    """

    shape: str
    ratio: float
    group: float
    friction: float = 0.8
    elements: int = 8
    modes: int = 100

    @property
    def width(self) -> float:
        """B [m]."""
        return HEIGHT / self.ratio

    @property
    def modulus(self) -> float:
        """E [Pa]."""
        return self.group * DENSITY * GRAVITY * HEIGHT * self.ratio

    @property
    def crossing(self) -> float:
        """Time B / c in which a wave crosses the width [s]."""
        return self.width * float(np.sqrt(DENSITY / self.modulus))

    def case(self, dt: float, tilt: float = 0.0) -> Case:
        """Its case, let go at a tilt [rad], with steps of dt [s] at the impact."""
        size = self.width / self.elements
        body = dict(
            height_m=HEIGHT,
            density_kg_m3=DENSITY,
            youngs_modulus_pa=self.modulus,
            poissons_ratio=POISSON,
            element_size_m=1.001 * size,
            coarse_size_m=2.5 * size,
        )
        if self.shape == "block":
            body |= dict(kind="block", length_m=self.width, width_m=DEEP * self.width)
        else:
            # as many around as make the sides of a polygon as long as an element
            body |= dict(outer_diameter_m=self.width, element_size_m=np.pi * size / 2)
            body |= (
                dict(kind="cylinder")
                if self.shape == "solid"
                else dict(kind="tube", wall_m=WALL * self.width)
            )
        return case_from_tables(
            dict(
                bodies=dict(body=body),
                joints=dict(foot=dict(between=["body", "ground"])),
                contact=dict(friction_coefficient=self.friction),
                initial=dict(body=dict(tilt_rad=tilt)) if tilt else {},
                integration=dict(
                    engine="reduced", n_modes=self.modes, dt_s=dt, alpha_hht=0.0, duration_s=1.0
                ),
            ),
            "benchmarks.impact.map",
        )


def rigid_block(body: Body) -> tuple[RigidRocking, float]:
    """Housner's block of a body, and the lowest frequency of the free body [Hz]."""
    model = structure_model(body.case(body.crossing)).parts[0].model
    return RigidRocking.of_body(model), float(model.frequencies[0] / (2 * np.pi))


def releases(block: RigidRocking, frequency: float, share: float, count: int) -> list[float]:
    """Shares of the critical tilt from `share` on, beside each other: falls from them end at so
    many equally spaced phases of one vibration of `frequency` [Hz].

    A slender block falls from a share s in acosh(1 / (1 - s)) / p (Housner 1963).
    """
    first = np.arccosh(1 / (1 - share))
    later = first + block.p * np.arange(count) / (count * frequency)
    return [float(one) for one in 1 - 1 / np.cosh(later)]


def let_go(body: Body, block: RigidRocking, share: float, dt: float) -> ReducedRocker:
    """A body let go at a share of its critical tilt."""
    return ReducedRocker(body.case(dt, share * block.slenderness))
