"""Equations of motion of the wobbling column and frame, derived with sympy, beside the functions
that are compiled.

    ./containers/run python -m benchmarks.wobbling_equations

Prints the largest difference of each function of fecolumn/engines/rocking/wobbling_equations.py.

A rigid column of round foot rolls on its
rim, which does not slip, and does not turn about its axis: turned by the tilt theta about the
tangent at the rim's point phi, which stays where it stood. So the path of contact on the ground is
the circle that the foot stood on, as long as the rim rolled. The derivation asks of positions and
rotations alone:

- the rim's point on the ground and, in a frame, that below the slab move with ground and slab
    (nothing slips);
- the slab, carried by equal columns, keeps its direction: it translates;
- T and V of one column with its share of the slab give Lagrange's equations, in the form that
    Hamilton gave them.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from fecolumn.engines.rocking import wobbling_equations as compiled
from fecolumn.foundation._compiled import interpreted

tilt, azimuth, tilt_rate, azimuth_rate, spin = sp.symbols(
    "tilt azimuth tilt_rate azimuth_rate spin"
)
ground_x, ground_y, ground_z = sp.symbols("ground_x ground_y ground_z")
push, across_push = sp.symbols("push across_push")
#: Parameters of the compiled functions, in this order.
BODY = sp.symbols(
    "radius centre height mass slab across along stiffness pull gravity", positive=True
)
radius, centre, height, mass, slab, across, along, stiffness, pull, gravity = BODY


def turned(angle, axis: str):
    """Rotation matrix about y or z, in half angles: 1 - cos, written as 2 sin^2 of half the angle,
    does not cancel where the angle is small.
    """
    c, s = 1 - 2 * sp.sin(angle / 2) ** 2, 2 * sp.sin(angle / 2) * sp.cos(angle / 2)
    return sp.Matrix(
        [[c, 0, s], [0, 1, 0], [-s, 0, c]] if axis == "y" else [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    )


def rate(expression):
    """Time derivative of an expression of tilt and azimuth, where the azimuth is 0: ground and
    column look alike from every side.
    """
    return (
        sp.diff(expression, tilt) * tilt_rate + sp.diff(expression, azimuth) * azimuth_rate
    ).subs(azimuth, 0)


def reduced(expression):
    """An expression without azimuth as a polynomial in sin(tilt/2), cos(tilt/2) to the first power
    at most: zero if and only if it vanishes.
    """
    sine, cosine = sp.symbols("sine cosine")
    found = sp.expand(expression.subs({sp.sin(tilt / 2): sine, sp.cos(tilt / 2): cosine}))
    found = sp.expand(sp.rem(found, cosine**2 - 1 + sine**2, cosine))
    return found.subs({sine: sp.sin(tilt / 2), cosine: sp.cos(tilt / 2)})


def zero(expression) -> bool:
    """Whether an expression, or each entry of a matrix, vanishes identically."""
    return all(reduced(one) == 0 for one in sp.Matrix([expression]))


def derive() -> dict[str, sp.Expr]:
    """Inertias of tilt and azimuth, potential and levers of one column with its share of the
    slab.
    """
    rotation = turned(azimuth, "z") * turned(tilt, "y") * turned(-azimuth, "z")
    towards = turned(azimuth, "z") * sp.Matrix([1, 0, 0])

    def place(point):
        """Where a point of the column is whose place upright is given."""
        return radius * towards + rotation * (point - radius * towards)

    def here(vector):
        """A vector where the azimuth is 0: components towards the azimuth, across it and up."""
        return vector.subs(azimuth, 0).applyfunc(reduced)

    up = sp.Matrix([0, 0, 1])
    w = rate(rotation) * rotation.T.subs(azimuth, 0)
    angular = sp.Matrix([w[2, 1], w[0, 2], w[1, 0]]).applyfunc(reduced)
    ground = radius * towards
    below_slab = -radius * towards + height * up
    slab_shift = place(below_slab) - below_slab

    def velocity(point, at):
        """Of the column's material at a place."""
        return rate(place(point)) + angular.cross(here(at - place(point)))

    assert zero(velocity(0 * up, ground)), "the rim slips on the ground"
    assert zero(velocity(0 * up, place(below_slab)) - rate(slab_shift)), (
        "the rim slips below the slab"
    )

    axis = here(rotation * up)
    centre_velocity = rate(place(centre * up))
    spin_rate = angular.dot(axis)
    kinetic = (
        mass * centre_velocity.dot(centre_velocity)
        + slab * rate(slab_shift).dot(rate(slab_shift))
        + across * (angular.dot(angular) - spin_rate**2)
        + along * spin_rate**2
    ) / 2
    opening, lift = here(place(height * up) - slab_shift - height * up), here(place(0 * up))
    assert zero(opening.dot(opening) - lift.dot(lift)), (
        "a tendon to the ground stretches otherwise than one to the slab"
    )
    assert zero(opening.dot(opening) - (2 * radius * sp.sin(tilt / 2)) ** 2), (
        "a tendon stretches otherwise than by 2 radius sin(tilt / 2)"
    )

    rates = (tilt_rate, azimuth_rate)
    inertia = sp.hessian(sp.expand(kinetic), rates)
    inertia = inertia.applyfunc(reduced)
    assert inertia[0, 1] == 0 and not inertia[0, 0].has(tilt), "tilt and azimuth do not part"
    shift = here(mass * place(centre * up) + slab * slab_shift)
    assert shift[1] == 0, "the centre of mass leaves the plane of its tilt"
    stretch = 2 * radius * sp.sin(tilt / 2)
    return {
        "tilt_inertia": inertia[0, 0],
        "azimuth_inertia": inertia[1, 1],
        "lever": shift[0],
        "rise": shift[2] - mass * centre,
        "tendon": pull * stretch + stiffness * stretch**2 / 2,
    }


def rates_of(found) -> list[sp.Expr]:
    """Rates of tilt, azimuth, tilt_rate, spin and of the work of the base [W], by Lagrange's
    equations.
    """
    along = ground_x * sp.cos(azimuth) + ground_y * sp.sin(azimuth)
    beside = ground_y * sp.cos(azimuth) - ground_x * sp.sin(azimuth)
    kinetic = found["tilt_inertia"] * tilt_rate**2 / 2 + spin**2 / (2 * found["azimuth_inertia"])
    # work of the ground's motion in the table frame: forces -m a on all masses
    potential = gravity * found["rise"] + found["tendon"]
    loaded = potential + ground_z * found["rise"] + along * found["lever"]
    turn = spin / found["azimuth_inertia"]
    fall = -(sp.diff(kinetic, tilt) + sp.diff(loaded, tilt)) / found["tilt_inertia"]
    work = (
        -(along * found["lever"].diff(tilt) + ground_z * found["rise"].diff(tilt)) * tilt_rate
        - beside * found["lever"] * turn
    )
    return [tilt_rate, turn, fall, -beside * found["lever"], work]


def base_force(found) -> list[sp.Expr]:
    """Force of the ground on the column's foot [N] towards the azimuth, across it and up: the rate
    of the momentum of all masses.
    """
    lever, rise, turn = found["lever"], found["rise"], spin / found["azimuth_inertia"]
    fall = rates_of(found)[2].subs(ground_x * sp.cos(azimuth) + ground_y * sp.sin(azimuth), push)
    spun = (-across_push * lever - found["azimuth_inertia"].diff(tilt) * tilt_rate * turn) / found[
        "azimuth_inertia"
    ]
    total = mass + slab
    return [
        lever.diff(tilt, 2) * tilt_rate**2
        + lever.diff(tilt) * fall
        - lever * turn**2
        + total * push,
        2 * lever.diff(tilt) * tilt_rate * turn + lever * spun + total * across_push,
        rise.diff(tilt, 2) * tilt_rate**2 + rise.diff(tilt) * fall + total * (gravity + ground_z),
    ]


def functions() -> dict[str, tuple[tuple, list[sp.Expr]]]:
    """Arguments beside the body, and what is returned, of each compiled function by name."""
    found = derive()
    return {
        "rates": (
            (tilt, azimuth, tilt_rate, spin, ground_x, ground_y, ground_z),
            rates_of(found),
        ),
        "force": ((tilt, tilt_rate, spin, push, across_push, ground_z), base_force(found)),
        "inertia": ((tilt,), [found["tilt_inertia"], found["azimuth_inertia"]]),
        "potential": ((tilt,), [gravity * found["rise"], found["tendon"]]),
        "moments": ((tilt,), [found[name].diff(tilt) for name in ("rise", "lever", "tendon")]),
    }


def differences(samples: int = 200) -> dict[str, float]:
    """Largest difference of each compiled function from what is derived, at random arguments of
    the size of 1, over the largest of what it returns.
    """
    rng, largest = np.random.default_rng(0), {}
    for name, (arguments, expressions) in functions().items():
        derived = sp.lambdify((*BODY, *arguments), expressions, "math", cse=True)
        own = interpreted(getattr(compiled, name))
        errors = []
        for body, state in zip(
            rng.uniform(0.1, 5, (samples, 10)), rng.uniform(0.05, 1, (samples, len(arguments)))
        ):
            exact, kept = np.array(derived(*body, *state)), np.array(own(body, *state))
            errors.append(np.abs(kept - exact).max() / np.abs(exact).max())
        largest[name] = float(max(errors))
    return largest


def main() -> None:
    for name, error in differences().items():
        print(f"{name:<10} {error:.1e}")


if __name__ == "__main__":
    main()
