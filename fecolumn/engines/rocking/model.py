"""What a rocking model is: parameters, and its response to a motion.

Any ensemble runs through any model.

A model is a frozen dataclass with the methods of `Model`. Its name is a word of
`models.ROCKING_MODELS`: of `fecolumn rocking NAME CASE`, and of integration.engine where it can be
made from a column's case.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.engines.ending import AT_REST, OVERTURNED, REST_SHARE, STILL_ROCKING
from fecolumn.foundation.arrays import Array
from fecolumn.motions.record import GroundMotion

#: Terms of the energy that are of a state, not added up over time.
STATE_TERMS = ("kinetic", "strain", "gravity")
# Times the free motion that is followed is doubled for a fall that is bound to come
_PATIENCE = 8


def free_times(free_s: float, frequency: float) -> Iterator[float]:
    """Free motions [s] to try, one after the other, until a fall that is bound to come has come;
    the first is `free_s`, the others are longer by 2, 4, ... over the frequency parameter [rad/s].
    """
    yield free_s
    for doubled in range(1, _PATIENCE):
        yield free_s + 2.0**doubled / frequency


@dataclass(frozen=True, slots=True, eq=False)
class ModelResponse:
    """How a model moved in one motion, relative to its base.

    Attributes
    ----------
    time
        (n,) rising [s].
    coordinates
        the model's own coordinates, name without blanks to (n,).
    units
        name of each coordinate to its unit, such as "rad".
    tilt
        (n,) angle of the (first) column's axis to the vertical, at least 0 [rad].
    u_top
        (n, 3) displacement of the top's centre along x, y and z (up) [m].
    overturned
        whether it fell; the rows end there.
    impact_times
        (k,) of all impacts, rising [s].
    energy
        term to (n,) [J]; names as in dynamics.energy.TERMS, zero terms may be left out. State
        terms: kinetic, strain (of springs and tendons), gravity (0 upright); added up from the
        start, losses negative: base_work, impact, damping; closure is what is left over of kinetic
        + strain + gravity = start + base_work + impact + damping + closure.
    notes
        sentences a user must read, such as when the friction demanded exceeds the friction there
        is.
    peaks
        further peak values, their names with the unit as in summary.json: "friction_demanded",
        "base_shear_n".
    floors
        (n, k) displacement along x of each floor of a building, from below [m]; (0, 0) without one.
    base_force
        (n, 3) force of the ground on all columns along x, y and up [N], between impacts; (0, 3)
        where the model does not tell it.
    """

    time: Array
    coordinates: dict[str, Array]
    units: dict[str, str]
    tilt: Array
    u_top: Array
    overturned: bool
    impact_times: Array
    energy: dict[str, Array]
    notes: tuple[str, ...] = ()
    peaks: dict[str, float] = field(default_factory=dict)
    floors: Array = field(default_factory=lambda: np.zeros((0, 0)))
    base_force: Array = field(default_factory=lambda: np.zeros((0, 3)))

    def outcome(self, energy_to_overturn: float) -> str:
        """How it ended: AT_REST, STILL_ROCKING or OVERTURNED, as a summary of `fecolumn run` says.

        Parameters
        ----------
        energy_to_overturn
            of the model [J].
        """
        if self.overturned:
            return OVERTURNED
        left = sum(float(self.energy[name][-1]) for name in STATE_TERMS)
        return AT_REST if left <= REST_SHARE * energy_to_overturn else STILL_ROCKING

    def first(self, rows: int) -> ModelResponse:
        """The response up to a row; peaks are those of the whole one."""
        end = float(self.time[rows - 1])
        return replace(
            self,
            time=self.time[:rows],
            coordinates={name: one[:rows] for name, one in self.coordinates.items()},
            tilt=self.tilt[:rows],
            u_top=self.u_top[:rows],
            impact_times=self.impact_times[self.impact_times <= end],
            energy={name: one[:rows] for name, one in self.energy.items()},
            floors=self.floors[:rows],
            base_force=self.base_force[:rows],
        )

    @property
    def u_max(self) -> float:
        """Largest horizontal displacement of the top [m]; where the rows end if it overturned."""
        return float((self.u_top[:, 0] ** 2 + self.u_top[:, 1] ** 2).max() ** 0.5)


class Model(Protocol):
    """A rocking model with its parameters.

    Attributes
    ----------
    TABLE
        name of its own table in a model's case file, such as "block".
    """

    TABLE: ClassVar[str]

    @property
    def critical_tilt(self) -> float:
        """Tilt at which it is lost without help [rad]."""

    @property
    def critical_displacement(self) -> float:
        """Displacement of the top at the critical tilt [m]."""

    @property
    def energy_to_overturn(self) -> float:
        """Energy that takes it from upright to the critical tilt [J]."""

    @classmethod
    def of_section(cls, section: Any, file: Path | str) -> Model:
        """Model of its own table; InputError(file, "block.height_m", value, allowed) where keys do
        not fit.
        """

    def respond(
        self,
        motion: GroundMotion,
        *,
        free_s: float = 0.0,
        tilt: float = 0.0,
        tilt_rate: float = 0.0,
        direction: float = 0.0,
    ) -> ModelResponse:
        """Response to a motion, all of its components, from rest or from a tilt.

        Parameters
        ----------
        free_s
            time followed after the motion's end [s]; there is a row for every sample.
        tilt, tilt_rate
            at the start [rad, rad/s], towards `direction`, from x to y [rad].
        """

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters for a table: name to (value, unit), such as {"frequency parameter p":
        (2.1, "rad/s")}.
        """


def moved_about_edge(lean: ArrayLike, height: ArrayLike, inside: ArrayLike) -> tuple[Array, Array]:
    """Displacement (n,) along a lean of at least 0 [rad], and up [m], of a point at a height above
    the edge about which it turns, `inside` [m] of it.
    """
    lean, height, inside = (np.asarray(one, float) for one in (lean, height, inside))
    down = 2 * np.sin(lean / 2) ** 2
    return inside * down + height * np.sin(lean), inside * np.sin(lean) - height * down


def balanced(**terms: NDArray[Any]) -> dict[str, Array]:
    """Terms of the energy (n,) [J] as of ModelResponse, and their closure."""
    kinetic, strain, gravity = (terms[name] for name in STATE_TERMS)
    total = kinetic + strain + gravity
    closure = total - total[0] - terms["base_work"] - terms["impact"]
    return terms | dict(closure=closure - terms["damping"] if "damping" in terms else closure)


def check_friction(
    what: str,
    peak: str,
    along: Array,
    upward: Array,
    time: Array,
    counts: Array,
    available: float,
) -> tuple[list[str], dict[str, float]]:
    """Note where a model that does not slide demands more friction than there is, and the peak.

    Parameters
    ----------
    what, peak
        begin of the note, name of the peak value.
    along, upward
        (n,) force of the ground on the foot, horizontal and vertical [N].
    time
        (n,) [s].
    counts
        (n,) whether a row counts.
    available
        friction coefficient.
    """
    if not counts.any():
        return [], {}
    with np.errstate(divide="ignore", invalid="ignore"):
        demanded = np.where(upward > 0, along / upward, math.inf)[counts]
    most, leaves = float(demanded.max()), bool(np.isinf(demanded.max()))
    # a model that leaves the ground has no finite peak
    peaks = {} if leaves else {peak: most}
    if not most > available:
        return [], peaks
    first = time[counts][int(np.argmax(demanded > available))]
    note = (
        f"{what} demands a friction coefficient of {'more than any' if leaves else f'{most:.3g}'}, "
        f"from {first:.3f} s on for {(demanded > available).mean():.1%} of the time; there is "
        f"{available:g}: it would slide{' or leave the ground' * leaves}"
    )
    return [note], peaks
