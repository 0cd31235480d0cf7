"""Equations of motion of the wobbling column and frame.

Written by benchmarks.wobbling_equations with sympy 1.11.1: do not edit.

Of one column with its share of the slab; arguments, in SI units:
    body: (10,) radius of rim, height of the centre of mass, height of column [m]; mass, share of
        the slab [kg]; inertia about the centre of mass across and along the axis [kg m2]; tendon's
        stiffness [N/m] and pull while the column stands [N]; gravity [m/s2].
    tilt, azimuth [rad]: of the axis; the foot's rim touches at the azimuth, to which the column
        leans.
    tilt_rate [rad/s]; spin [kg m2/s]: momentum of the azimuth, inertia[1] times its rate.
    ground_x, ground_y, ground_z: acceleration of the ground [m/s2].
"""

import math

from fecolumn.foundation._compiled import njit


@njit(alone=True)
def rates(body, tilt, azimuth, tilt_rate, spin, ground_x, ground_y, ground_z):
    """Rates of tilt, azimuth, tilt_rate, spin, and of the work that the base does [W]."""
    radius = body[0]
    centre = body[1]
    height = body[2]
    mass = body[3]
    slab = body[4]
    across = body[5]
    along = body[6]
    stiffness = body[7]
    pull = body[8]
    gravity = body[9]
    x0 = (1 / 2) * tilt
    x1 = math.sin(x0)
    x2 = x1**2
    x3 = along * x2
    x4 = across * x2
    x5 = radius**2
    x6 = mass * x5
    x7 = x2 * x6
    x8 = centre**2 * mass
    x9 = x2 * x8
    x10 = height**2 * slab
    x11 = x10 * x2
    x12 = 4 * slab
    x13 = x12 * x5
    x14 = centre * mass
    x15 = math.cos(x0)
    x16 = radius * x15
    x17 = 2 * x1
    x18 = x1 * x12 * x16
    x19 = across + x10 + x8
    x20 = height * x18 - x11 + x13 * x2 + x14 * x16 * x17 + x19 + x3 - x4 + x7 - x9
    x21 = spin / x20
    x22 = mass * radius
    x23 = x15**2
    x24 = 2 * radius
    x25 = slab * x24
    x26 = x14 * x15
    x27 = height * slab
    x28 = x15 * x27
    x29 = x17 * x26 + x17 * x28 + x2 * x22 + x2 * x25 - x22 * x23 - x23 * x25
    x30 = math.cos(azimuth)
    x31 = math.sin(azimuth)
    x32 = ground_x * x30 + ground_y * x31
    x33 = x14 * x23
    x34 = x23 * x27
    x35 = x1 * x22
    x36 = 2 * x15
    x37 = -x14 * x2 + x18 - x2 * x27 + x33 + x34 + x35 * x36
    x38 = x1**3
    x39 = radius * x1
    x40 = (ground_x * x31 - ground_y * x30) * (x1 * x25 + x26 + x28 + x35)
    return (
        tilt_rate,
        (1 / 4) * x21 / x2,
        -(
            -gravity * x29
            - ground_z * x29
            + pull * radius * x15
            - 1
            / 8
            * spin**2
            * (
                across * x15
                - radius * x14 * x38
                + 8 * slab * x15 * x2 * x5
                + x10 * x15
                - x11 * x36
                + x15 * x8
                - x24 * x27 * x38
                + x3 * x36
                + 3 * x33 * x39
                + 6 * x34 * x39
                - x36 * x4
                + x36 * x7
                - x36 * x9
            )
            / (x20**2 * x38)
            + 2 * stiffness * x1 * x15 * x5
            + x32 * x37
        )
        / (x13 + x19 + x6),
        x17 * x40,
        -tilt_rate * (-ground_z * x29 + x32 * x37) + (1 / 2) * x21 * x40 / x1,
    )


@njit(alone=True)
def force(body, tilt, tilt_rate, spin, push, across_push, ground_z):
    """Force of the ground on the foot [N]: towards the azimuth, across it, up.

    push, across_push: ground's acceleration [m/s2] to the azimuth and across it.
    """
    radius = body[0]
    centre = body[1]
    height = body[2]
    mass = body[3]
    slab = body[4]
    across = body[5]
    along = body[6]
    stiffness = body[7]
    pull = body[8]
    gravity = body[9]
    x0 = mass + slab
    x1 = tilt_rate**2
    x2 = (1 / 2) * tilt
    x3 = math.sin(x2)
    x4 = x3**2
    x5 = mass * radius
    x6 = math.cos(x2)
    x7 = x6**2
    x8 = x5 * x7
    x9 = 2 * radius * slab
    x10 = centre * mass
    x11 = x10 * x6
    x12 = 2 * x3
    x13 = height * slab
    x14 = x13 * x6
    x15 = x11 * x12 + x12 * x14 + x4 * x5 + x4 * x9 - x7 * x9 - x8
    x16 = x3 * x5
    x17 = x11 + x14 + x16 + x3 * x9
    x18 = along * x4
    x19 = radius**2
    x20 = mass * x19
    x21 = x20 * x4
    x22 = centre**2
    x23 = mass * x22
    x24 = height**2
    x25 = slab * x24
    x26 = 4 * slab
    x27 = x19 * x26
    x28 = 2 * x6
    x29 = x16 * x28
    x30 = radius * x6
    x31 = x26 * x3 * x30
    x32 = across + x23 + x25
    x33 = (
        -across * x4
        + centre * x29
        + height * x31
        + x18
        + x21
        - x23 * x4
        - x25 * x4
        + x27 * x4
        + x32
    )
    x34 = x3**3
    x35 = spin**2 / (x33**2 * x34)
    x36 = x13 * x7
    x37 = -x10 * x4 + x10 * x7 - x13 * x4 + x29 + x31 + x36
    x38 = x19 * x6
    x39 = -8 * x15
    x40 = (
        -2 * across * x4 * x6
        + across * x6
        - centre * mass * radius * x34
        + 3 * centre * x3 * x8
        - 2 * height * radius * slab * x34
        - 2 * mass * x22 * x4 * x6
        + 6 * radius * x3 * x36
        - 2 * slab * x24 * x4 * x6
        + 8 * slab * x38 * x4
        + x18 * x28
        + x21 * x28
        + x23 * x6
        + x25 * x6
    )
    x41 = (1 / 8) / (x20 + x27 + x32)
    x42 = 1 / x33
    x43 = spin * tilt_rate
    x44 = x42 / x3
    x45 = 8 * x15
    return (
        push * x0
        - x1 * x15
        - 1 / 8 * x17 * x35
        - x37
        * x41
        * (
            gravity * x39
            + ground_z * x39
            + 8 * pull * x30
            + 8 * push * x37
            + 16 * stiffness * x3 * x38
            - x35 * x40
        ),
        across_push * x0
        - 1 / 2 * x17 * x44 * (across_push * x12 * x17 + x40 * x43 * x44)
        + (1 / 2) * x37 * x42 * x43 / x4,
        x0 * (gravity + ground_z)
        - x1 * x37
        + x15
        * x41
        * (
            -gravity * x45
            - ground_z * x45
            + 8 * pull * radius * x6
            + 8 * push * x37
            + 16 * stiffness * x19 * x3 * x6
            - x35 * x40
        ),
    )


@njit(alone=True)
def inertia(body, tilt):
    """Of tilt and of azimuth [kg m2]."""
    radius = body[0]
    centre = body[1]
    height = body[2]
    mass = body[3]
    slab = body[4]
    across = body[5]
    along = body[6]
    x0 = radius**2
    x1 = mass * x0
    x2 = 4 * slab
    x3 = x0 * x2
    x4 = centre**2 * mass
    x5 = height**2 * slab
    x6 = across + x4 + x5
    x7 = (1 / 2) * tilt
    x8 = math.sin(x7)
    x9 = x8**2
    x10 = radius * x8 * math.cos(x7)
    return x1 + x3 + x6, 4 * x9 * (
        -across * x9
        + along * x9
        + 2 * centre * mass * x10
        + height * x10 * x2
        + x1 * x9
        + x3 * x9
        - x4 * x9
        - x5 * x9
        + x6
    )


@njit(alone=True)
def potential(body, tilt):
    """Of gravity, 0 upright, and of the tendon [J]."""
    radius = body[0]
    centre = body[1]
    height = body[2]
    mass = body[3]
    slab = body[4]
    stiffness = body[7]
    pull = body[8]
    gravity = body[9]
    x0 = (1 / 2) * tilt
    x1 = math.sin(x0)
    x2 = radius * math.cos(x0)
    x3 = radius * x1
    return -2 * gravity * x1 * (
        centre * mass * x1 + height * slab * x1 - mass * x2 - 2 * slab * x2
    ), 2 * x3 * (pull + stiffness * x3)


@njit(alone=True)
def moments(body, tilt):
    """Derivatives by the tilt of mass times height and times lever of the weight [kg m],
    and of the tendon's energy [N m].
    """
    radius = body[0]
    centre = body[1]
    height = body[2]
    mass = body[3]
    slab = body[4]
    stiffness = body[7]
    pull = body[8]
    x0 = (1 / 2) * tilt
    x1 = math.sin(x0)
    x2 = x1**2
    x3 = mass * radius
    x4 = math.cos(x0)
    x5 = x4**2
    x6 = 2 * radius
    x7 = centre * mass
    x8 = 2 * x1 * x4
    x9 = height * slab
    x10 = radius * x4
    return (
        mass * radius * x5 + 2 * radius * slab * x5 - slab * x2 * x6 - x2 * x3 - x7 * x8 - x8 * x9,
        4 * slab * x1 * x10 - x2 * x7 - x2 * x9 + x3 * x8 + x5 * x7 + x5 * x9,
        x10 * (pull + stiffness * x1 * x6),
    )
