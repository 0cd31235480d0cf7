"""Impact of a podium: the rocking storey's columns change edge under an elastic building (Bachmann
et al. 2017; Bantilas et al. 2021).

All impulses act at the new edges, so that their virtual work is zero in the motion after the
impact: rotation of the columns about these edges, the beam's translation by 2 R (cos alpha, -sin
alpha) per angle, and the building's vertical motion with the beam. What the building's floors do
horizontally is not determined by rigid bodies; the law says it:

    CRV  they keep their velocity relative to the beam: the floors jump with it, and their momentum
        enters the balance;
    CAV  they keep their absolute velocity: no horizontal impulse reaches them.

Per N m_c R^2, with I = I_O/(m_c R^2), gamma = m_b/(N m_c), eta = M/m_b and s = sin alpha:

    before  theta' times I - 2 s^2 + 4 gamma (1 - 2 s^2) - 4 gamma eta s^2  [+ B],
    after   theta' times I + 4 gamma + 4 gamma eta s^2                      [+ B],

with B = 4 gamma eta (1 - s^2) for CRV alone.
"""

from __future__ import annotations

import math

from fecolumn.case.model_sections import CRV, LAWS


def podium_restitution(
    law: str, slenderness: float, gamma: float, eta: float, inertia: float = 4 / 3
) -> float:
    """Angular velocity of the columns after over before the impact.

    Parameters
    ----------
    law
        CRV, constant relative velocity of the floors, or CAV, constant absolute velocity.
    slenderness
        alpha of the columns [rad].
    gamma
        mass of the beam over that of all columns.
    eta
        mass of the building over that of the beam.
    inertia
        of a column about its edge, over m_c R^2; 4/3 of a rectangular one.

    Raises
    ------
    ValueError
        another law.
    """
    if law not in LAWS:
        raise ValueError(f"law = {law!r} must be one of {', '.join(LAWS)}")
    squared = math.sin(slenderness) ** 2
    carried = 4 * gamma * eta * (1.0 if law == CRV else squared)
    return 1 - 2 * squared * (1 + 4 * gamma * (1 + eta)) / (inertia + 4 * gamma + carried)


def kinetic_energy_kept(
    law: str, slenderness: float, gamma: float, eta: float, inertia: float = 4 / 3
) -> float:
    """Kinetic energy after over before the impact of a building that moves with the beam."""
    kept, squared = (
        podium_restitution(law, slenderness, gamma, eta, inertia),
        math.sin(slenderness) ** 2,
    )
    rocking, along = (
        inertia + 4 * gamma + 4 * gamma * eta * squared,
        4 * gamma * eta * (1 - squared),
    )
    after = (rocking + along) * kept**2 if law == CRV else rocking * kept**2 + along
    return after / (rocking + along)
