"""The force of a link over its elongation: elastic beyond its play, yielding with kinematic
hardening, at once or along a curve; over the rate: viscous, linear or a power of it; and how much
of a point of a bond is left.
"""

from __future__ import annotations

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Record

# Part of a step of the curve at most, over its exponent: it closes in on yielding as fast as that
_CURVE_STEP = 0.1
# Halvings of a way within which the end of a curve is found: to rounding
_HALVINGS = 60


@njit
def stretch_of(link: Record, over: float) -> float:
    """Elastic part of an elongation less what has yielded [m]: above 0 it pulls, else pushes."""
    if link.pulls and over > link.play:
        return over - link.play
    if link.pushes and over < -link.play:
        return over + link.play
    return 0.0


@njit
def strain_of(link: Record, stretch: float, flowed: float) -> float:
    """Energy [J] that a link stores: elastic, and what hardening holds back."""
    return link.stiffness * stretch**2 / 2 + link.hardens * flowed**2 / 2


@njit
def follow_elongation(link: Record, tie: Record, length: float) -> tuple[float, float, float]:
    """From the length of a tie [m] to another one: the elastic stretch at its end and the part of
    the way that yields [m]; energy [J] that yielding takes.

    Prager's kinematic hardening: the link yields where the force less `hardens` times what has
    yielded is beyond `yields`, both ways. With a finite exponent `bends` it is Wen's law (1976)
    with beta = gamma = 1/2: that difference, over `yields`, is z; loaded further, the share |z|^n
    of what would yield does so before, and unloading is elastic.
    """
    over = length - link.length
    if link.bends < np.inf:
        return _follow_curve(link, tie, over)
    trial = stretch_of(link, over - tie.flowed)
    flow = _flow_at_once(link, tie.flowed, over, trial)
    if flow == 0.0:
        return trial, 0.0, 0.0
    if link.hardens > 0.0:
        trial = stretch_of(link, over - tie.flowed - flow)
    else:
        trial -= flow
    return trial, flow, link.yields * abs(flow)


@njit
def _flow_at_once(link: Record, flowed: float, over: float, trial: float) -> float:
    """Part [m] of an elongation that yields beyond the yield force; trial: the stretch without."""
    force = link.stiffness * trial - link.hardens * flowed
    if not abs(force) > link.yields:
        return 0.0
    sign = np.sign(force)
    if link.hardens == 0.0:
        return sign * (abs(force) - link.yields) / link.stiffness
    # it yields until it carries nothing, or until what it carries then is at the yield force
    rest = -sign * link.yields / link.hardens
    left = stretch_of(link, over - rest)
    if left != 0.0:
        rest = (link.stiffness * (left + rest) - sign * link.yields) / (
            link.stiffness + link.hardens
        )
    return rest - flowed


@njit
def _follow_curve(link: Record, tie: Record, over: float) -> tuple[float, float, float]:
    """`follow_elongation` where the link yields along a curve."""
    start = tie.length - link.length
    stretch = stretch_of(link, start - tie.flowed)
    flow = _flow_at_once(link, tie.flowed, start, stretch)
    lost = link.yields * abs(flow)
    if flow != 0.0:
        stretch = stretch_of(link, start - tie.flowed - flow)
    left, sign = abs(over - start), 1.0 if over > start else -1.0
    free = np.inf
    if link.pulls and sign > 0.0 or link.pushes and sign < 0.0:
        free = max(0.0, link.play - sign * (start - tie.flowed - flow))
    inward = stretch * sign < 0.0
    for _ in range(2):  # back to no force, and out to the other side
        if not inward and stretch == 0.0:
            if left <= free:
                break
            left -= free
        force = sign * (link.stiffness * stretch - link.hardens * (tie.flowed + flow))
        if force < 0.0:  # unloading
            way = min(left, -force / link.stiffness)
            if inward and way >= abs(stretch):
                way, stretch = abs(stretch), 0.0
            else:
                stretch += sign * way
            left, force = left - way, 0.0
        if left > 0.0 and not (inward and stretch == 0.0):
            z = min(force / link.yields, 1.0)
            way, yielding, taken = _until_unloaded(link, stretch, sign, z, left)
            stretch += sign * (way - yielding)
            if way < left:
                stretch = 0.0
            flow, lost, left = flow + sign * yielding, lost + taken, left - way
        if not inward or stretch != 0.0:
            break
        inward = False
        other = link.pushes if sign < 0.0 else link.pulls
        free = 2 * link.play if other else np.inf
    return stretch, flow, lost


@njit
def _until_unloaded(
    link: Record, stretch: float, sign: float, z: float, left: float
) -> tuple[float, float, float]:
    """Way along the curve from `z` on, at most `left` [m], until the link carries nothing; the part
    of it that yields [m] and the energy that this takes [J].
    """
    yielding, taken = _curve(link, z, left)
    if not stretch * sign < 0.0 or (stretch + sign * (left - yielding)) * sign < 0.0:
        return left, yielding, taken
    low, high = 0.0, left
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        yielding, taken = _curve(link, z, middle)
        if (stretch + sign * (middle - yielding)) * sign < 0.0:
            low = middle
        else:
            high = middle
    yielding, taken = _curve(link, z, high)
    return high, yielding, taken


@njit
def _curve(link: Record, z: float, way: float) -> tuple[float, float]:
    """Part of a way [m] along the curve dz/dw = 1 - z^n that yields, and the energy [J] it takes;
    w: the way over the elongation at which it would yield, z: 0 to 1 at its start.
    """
    n, elastic = link.bends, link.yields / link.stiffness
    w, begin = way / elastic, z
    # no farther than where z is 1 for rounding
    rest = min(w, 1.0 + 40.0 / n)
    count = int(np.ceil(rest * max(n, 2.0) / _CURVE_STEP))
    area, h = 0.0, rest / max(count, 1)
    for _ in range(count):
        k1 = 1.0 - z**n
        z2 = z + h / 2 * k1
        k2 = 1.0 - z2**n
        z3 = z + h / 2 * k2
        k3 = 1.0 - z3**n
        z4 = z + h * k3
        k4 = 1.0 - min(z4, 1.0) ** n
        area += h / 6 * (z + 2 * z2 + 2 * z3 + z4)
        z = min(z + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), 1.0)
    area += (w - rest) * z
    # what yields of it all, were there no hardening
    share = link.stiffness / (link.stiffness + link.hardens)
    yielding = share * elastic * max(w - (z - begin), 0.0)
    taken = share * elastic * link.yields * max(area - (z**2 - begin**2) / 2, 0.0)
    return yielding, taken


@njit
def drag_of(link: Record, rate: float) -> float:
    """Force [N] of a link's dashpot at a rate of elongation [m/s]."""
    if link.power == 1.0:
        return link.damping * rate
    speed = abs(rate)
    if speed < link.slow:
        return link.damping * link.slow ** (link.power - 1.0) * rate
    return link.damping * speed**link.power * np.sign(rate)


@njit
def damage_of(normal: Record, shear: Record, opened: float, slipped: float) -> float:
    """Share of its stiffness, 0 to 1, that a point of a bond has lost which has opened and slipped
    so far [m], by its links along the normal and in shear.

    Coulomb's criterion with a tension cut-off: damage begins at a tension of normal.breaks, or
    where shear and rubs times tension reach the cohesion, the force at shear.breaks; from there on
    the force falls linearly with the way until nothing is left at `fails`, in between by the shares
    of the strain energy along and across the face.
    """
    pulled, sheared = normal.stiffness * opened, shear.stiffness * slipped
    cohesion = shear.stiffness * shear.breaks
    over = max(opened / normal.breaks, (sheared + normal.rubs * pulled) / cohesion)
    if over <= 1.0:
        return 0.0
    across, along = pulled * opened, sheared * slipped
    fails = across * normal.fails / normal.breaks + along * shear.fails / shear.breaks
    fails /= across + along
    if over >= fails:
        return 1.0
    return (1.0 - 1.0 / over) * fails / (fails - 1.0)
