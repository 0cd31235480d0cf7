"""What keys of wax, putty or mortar in a joint say together."""

from __future__ import annotations

from fecolumn.case.checked import Refuse
from fecolumn.case.joint import Joint

# Less than any wax: 0.3 MPa written as 0.3
_LEAST_PA = 100.0
_OTHERS = (
    "bond_cohesion_pa",
    "bond_fracture_energy_j_m2",
    "bond_stiffness_n_m3",
    "bond_shear_stiffness_n_m3",
)
# Shear stiffness of a layer over that across it, unless told: 1 / (2 (1 + nu)) at nu = 0.25
_SHEAR = 0.4


def cohesion_of(joint: Joint) -> float:
    """Shear strength [Pa] without pressure of a glued joint of these keys."""
    return joint.bond_cohesion_pa or joint.bond_tension_pa


def shear_stiffness_of(joint: Joint) -> float:
    """Shear stiffness [N/m3] of the layer of a glued joint of these keys."""
    return joint.bond_shear_stiffness_n_m3 or _SHEAR * joint.bond_stiffness_n_m3


def check_bond(key: str, joint: Joint, friction: float, refuse: Refuse) -> None:
    """Refuse a glued joint without what it needs, and numbers that make no sense together.

    friction: Coulomb's coefficient of the joint.
    """
    tension = joint.bond_tension_pa
    if not tension:
        for name in _OTHERS:
            if value := getattr(joint, name):
                refuse(f"{key}.{name}", value, "says nothing without bond_tension_pa")
        return
    cohesion = cohesion_of(joint)
    for name in ("bond_tension_pa", "bond_cohesion_pa"):
        value = getattr(joint, name)
        if value and value < _LEAST_PA:
            told = f"must be at least {_LEAST_PA:g} Pa: wax holds 1e4 to 1e5 Pa, mortar 1e5 to 1e6"
            refuse(f"{key}.{name}", value, f"{told}; 0.3 MPa is 3e5")
    if not (normal := joint.bond_stiffness_n_m3):
        told = (
            "must be greater than 0 N/m3 with bond_tension_pa: modulus over thickness of the layer"
        )
        refuse(f"{key}.bond_stiffness_n_m3", normal, f"{told}, 5e8 of putty of 1 MPa and 2 mm")
    if tension * friction > cohesion * (1 + 1e-12):
        refuse(
            f"{key}.bond_tension_pa",
            tension,
            "must be at most bond_cohesion_pa / friction_coefficient = "
            f"{cohesion / friction:.4g} Pa: tension takes from the shear strength, which is gone "
            "before",
        )
    if energy := joint.bond_fracture_energy_j_m2:
        shear = cohesion**2 / (2 * shear_stiffness_of(joint))
        stored = max(tension**2 / (2 * normal), shear)
        if energy <= stored:
            refuse(
                f"{key}.bond_fracture_energy_j_m2",
                energy,
                f"must be more than {stored:.4g} J/m2, which the layer stores when it begins to "
                "fail, or 0 of one that fails at once",
            )
