"""Keys of a joint."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from fecolumn.case.sections import Contact
from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.foundation.schema import InputError, Section, parameter, required
from fecolumn.foundation.section_class import section_class


@section_class()
class Joint(Section):
    """A joint: faces of two bodies, or of a body and a ground, that touch at the start or lie
    opposite each other across a gap. Of bodies with copies, every copy of one is joined with every
    copy of the other that it touches. The order of the two does not matter.
    """

    between: tuple[str, ...] = required(
        doc='names of the two bodies that touch, or of a body and a ground, such as ["drum", '
        '"ground"]; the same name twice where copies stand on one another or voussoirs of an '
        "arch touch",
    )
    friction_coefficient: float | None = parameter(
        None, doc="Coulomb friction coefficient; left out: that of [contact]", low=0, high=10
    )
    law: str | None = parameter(
        None,
        doc="contact formulation; left out: that of [contact]",
        choices=("augmented_lagrange", "penalty"),
    )
    penalty_factor: float | None = parameter(
        None,
        doc="penalty stiffness per area, divided by E / element size of the body with the "
        "smaller face; left out: that of [contact]",
        above=0,
        high=1e9,
    )
    restitution: float | None = parameter(
        None,
        doc="ratio of the normal velocity after an impact to that before it; left out: that of "
        "[contact], on a pad 0",
        low=0,
        high=1,
    )
    rolling_resistance: float | None = parameter(
        None,
        doc="energy that a rolling rim loses per length rolled, divided by the contact force; "
        "left out: that of [contact], on a pad 0",
        low=0,
        high=0.1,
        since="0.7",
    )
    stiffness_n_m3: float | None = parameter(
        None,
        doc="stiffness per area, across the contact, of a pad between the two; left out: that of "
        "the ground if it is a pad, otherwise there is no pad",
        unit="N/m3",
        above=0,
        high=1e15,
        since="0.7",
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of the pad per area along the contact (shear); 0: 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.7",
    )
    damping_ratio: float = parameter(
        0.0,
        doc="damping ratio, by the dashpots of the pad, of the vertical vibration of what the "
        "pad carries",
        low=0,
        high=10,
        since="0.7",
    )
    yield_pa: float | None = parameter(
        None,
        doc="pressure at which the pad yields and settles permanently; left out: it never yields",
        unit="Pa",
        above=0,
        high=1e12,
        since="0.7",
    )
    bond_tension_pa: float = parameter(
        0.0,
        doc="tensile strength of a bond (wax, putty or mortar) between the faces; it acts at "
        "each contact point until it fails there; 0: no bond",
        unit="Pa",
        low=0,
        high=1e9,
        since="0.11",
    )
    bond_cohesion_pa: float | None = parameter(
        None,
        doc="shear strength of the bond at zero pressure, to which friction is added; left out: "
        "bond_tension_pa",
        unit="Pa",
        above=0,
        high=1e9,
        since="0.11",
    )
    bond_fracture_energy_j_m2: float = parameter(
        0.0,
        doc="fracture energy of the bond per area; after its strength the stress falls linearly; "
        "0: the bond fails at once",
        unit="J/m2",
        low=0,
        high=1e7,
        since="0.11",
    )
    bond_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of the bond per area, across the faces: modulus over thickness of its "
        "layer; needed with bond_tension_pa",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.11",
    )
    bond_shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of the bond per area, along the faces; 0: 0.4 of bond_stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.11",
    )
    interior_points: int | None = parameter(
        None,
        doc="number of contact points inside the outline of the smaller face; left out: that of "
        "[contact]",
        low=0,
        high=10**6,
    )
    open: bool | None = parameter(
        None,
        doc="true: faces that lie opposite each other across a gap belong to the joint as well, "
        "and may come into contact; left out: true only where no faces of the two touch at "
        "the start",
        since="0.9",
    )
    allowance_m: float | None = parameter(
        None,
        doc="how far the body with the smaller face may slide before it leaves the part of the "
        "other body whose compliance is known; left out: a quarter of the smaller side of "
        "the smaller face, across a gap its larger side",
        unit="m",
        low=0,
        high=1000,
    )

    @property
    def slave(self) -> str:
        """The first of the two that touch: a body."""
        return self.between[0]

    @property
    def on(self) -> str:
        """The second of the two: a body or a ground."""
        return self.between[1]

    @classmethod
    def _by_newer_names(cls, keys: dict[str, Any], file: Path | str, prefix: str) -> dict[str, Any]:
        """Keys of a joint by their names in this version: `between` for `slave` and `on`.

        Raises
        ------
        InputError
            one of the two older keys is missing, or stands beside `between`.
        """
        older = [key for key in ("slave", "on") if key in keys]
        if not older:
            return keys
        if keys.get("between"):
            told = "must be left out beside between, which names both bodies"
            raise InputError(file, prefix + older[0], keys[older[0]], told)
        if len(older) == 1:
            (missing,) = {"slave", "on"} - set(older)
            told = f'missing; or give {prefix}between = ["one body", "other body"] instead'
            raise InputError(file, prefix + missing, None, f"{told} of slave and on")
        if Path(file).name != "case.json":  # of a result, which nobody writes by hand
            warn_of_older_name(str(file), "slave with on", "between")
        others = {key: value for key, value in keys.items() if key not in (*older, "between")}
        return {"between": (keys["slave"], keys["on"]), **others}


# Keys of [contact] that a joint may have of its own
_OF_CONTACT = {one.name for one in dataclasses.fields(Contact)} & {
    one.name for one in dataclasses.fields(Joint)
} - {"between"}


def own_contact(joint: Joint, contact: Contact) -> Contact:
    """The [contact] of a case with the keys that a joint has of its own, in their place."""
    own = {key: getattr(joint, key) for key in _OF_CONTACT}
    return dataclasses.replace(
        contact, **{key: value for key, value in own.items() if value is not None}
    )
