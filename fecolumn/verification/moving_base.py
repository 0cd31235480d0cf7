"""An analysis in the inertial frame: absolute motion on a base that moves;
`fecolumn.verification.frames` derives what it must give.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.engines.dynamics.booking import StepMade
from fecolumn.engines.dynamics.energy import Ledger
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.interface import ContactInterface
from fecolumn.engines.dynamics.stepper import Stepper
from fecolumn.engines.dynamics.system import State, System
from fecolumn.verification.models import AMPLITUDES, TONES
from fecolumn.verification.trial import Trial


class MovingInterface(ContactInterface):
    """Contact with a base that moves: the column's motion is absolute, contact sees it relative to
    the base.

    Attributes
    ----------
    position
        (3,) of the base at the end of the step [m].
    first
        (3,) of the base at the start of the step [m].
    known_velocities
        pairs of the column's velocity array and the base's velocity (3,) at the same time [m/s];
        the last one is the end of the step.
    """

    def __init__(self, still: ContactInterface) -> None:
        super().__init__(still.composite, still.foot, still.bases, still.joints)
        self.position, self.first = np.zeros(3), np.zeros(3)
        self.known_velocities: list = []

    def begin_step(self, *args: Any) -> Any:
        """Begin a step with the base where it was at the start of it."""
        end, self.position = self.position, self.first
        try:
            return super().begin_step(*args)
        finally:
            self.position = end

    def positions(self, x: np.ndarray, *args: Any) -> np.ndarray:
        """Positions [m] of the contact points relative to the moving base."""
        return super().positions(x, *args) - self.position

    def velocities(self, v: np.ndarray, *args: Any) -> np.ndarray:
        """Velocities [m/s] of the contact points relative to the moving base."""
        base = next(
            (base for known, base in self.known_velocities if known is v),
            self.known_velocities[-1][1],
        )
        return super().velocities(v, *args) - base


class MovingStepper(Stepper):
    """Stepper on a base that moves along a path; contact is judged by its work relative to the
    base.

    Attributes
    ----------
    base
        Base at the end of the last step, or of the part of one that a fast rolling rim makes by
        itself.
    work
        of the base so far [J].
    """

    def __init__(self, system: System, ledger: Ledger, path: BasePath) -> None:
        super().__init__(system, ledger)
        self.path, self.base, self.work, self._moved = (
            path,
            BaseMotion(*np.zeros((4, 3))),
            0.0,
            np.zeros(3),
        )

    def _part(self, state: State, ground: np.ndarray, hht: HHT) -> State:
        interface: Any = self.system.interface
        first = self.base
        last = self.path(hht, first, ground, state.time + hht.dt)
        self._moved = last.position - first.position
        interface.position, interface.first, interface.known_velocities = (
            last.position,
            first.position,
            [(state.v, first.velocity), (None, last.velocity)],
        )
        after = super()._part(replace(state, ground=np.zeros(3)), np.zeros(3), hht)
        if self.record.cuts:
            raise RuntimeError(
                f"t = {state.time:g} s: the step was cut, and the base's place within "
                "it is not known"
            )
        # contact forces work on the base's displacement, the impulses of an impact on its velocity
        free = state.v + hht.dt * (
            (1 - hht.gamma) * state.a + hht.gamma * after.a + after.contact_a
        )
        impulse = np.einsum("cna,na->c", self.system.body.unit_loads, after.v - free)
        self.work += float(after.forces.sum(axis=0) @ self._moved + last.velocity @ impulse)
        self.base, after.ground = last, np.array(ground, float)
        return after

    def _book(self, made: StepMade) -> float:
        return super()._book(made) - float(made.after.forces.sum(axis=0) @ self._moved)


class InertialTrial:
    """An analysis in the inertial frame on a base that moves along a path, a function of
    `MovingStepper`: `by_hht` or `on_exact_path`.

    Attributes
    ----------
    trial
        Trial of the absolute motion; its ledger has no base work.
    """

    def __init__(self, system: System, start: Callable[[System], State], path: BasePath) -> None:
        moving = copy.copy(system)
        moving.interface = MovingInterface(system.interface)
        self.trial = Trial(moving, start)
        self._stepper = MovingStepper(moving, self.trial.ledger, path)
        self.trial.stepper = self._stepper

    @property
    def work(self) -> float:
        """Of the base so far [J]."""
        return self._stepper.work

    def shake(self, accelerations: np.ndarray) -> np.ndarray:
        """Displacements (n, 2, 3) [m] of top and foot relative to the base, which `accelerations`
        (n, 3) [m/s2] shake from rest at 0.
        """
        return np.array(
            [
                self.trial.shake([ground])[0] - self._stepper.base.position
                for ground in accelerations
            ]
        )


class BaseMotion(NamedTuple):
    """Position [m], velocity [m/s] and acceleration [m/s2] of the base, and `blended` [m/s2], that
    which HHT remembers; each (3,).
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    blended: np.ndarray


#: The base a step later: of HHT, the base at the start of the step, its acceleration (3,) [m/s2]
#: and the time [s] at the end.
BasePath = Callable[[HHT, BaseMotion, np.ndarray, float], BaseMotion]


def by_hht(hht: HHT, base: BaseMotion, acceleration: np.ndarray, time: float) -> BaseMotion:
    """The base a step of `hht` later, under `acceleration` (3,) [m/s2] then, by the formulas of
    HHT.
    """
    blended = (1 + hht.alpha) * acceleration - hht.alpha * base.acceleration
    return BaseMotion(
        base.position
        + hht.dt * base.velocity
        + hht.dt**2 * ((0.5 - hht.beta) * base.blended + hht.beta * blended),
        base.velocity + hht.dt * ((1 - hht.gamma) * base.blended + hht.gamma * blended),
        np.array(acceleration, float),
        blended,
    )


def on_exact_path(hht: HHT, base: BaseMotion, acceleration: np.ndarray, time: float) -> BaseMotion:
    """The base of `shaking` at `time` [s]."""
    position, velocity = exact_path([time])
    return BaseMotion(position[0], velocity[0], np.array(acceleration, float), base.blended)


def hht_path(hht: HHT, accelerations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities (n, 3) of the base under accelerations (n, 3) at whole steps, from
    rest, by the formulas of HHT.
    """
    bases = list(
        accumulate(
            accelerations,
            lambda base, ground: by_hht(hht, base, ground, 0.0),
            initial=BaseMotion(*np.zeros((4, 3))),
        )
    )[1:]
    return np.array([base.position for base in bases]), np.array([base.velocity for base in bases])


def exact_path(times: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities (n, 3) of the base in `shaking`, from rest."""
    times = np.asarray(times)[:, None]
    return (
        sum(sign * AMPLITUDES / tone**2 * (1 - np.cos(tone * times)) for sign, tone in TONES),
        sum(sign * AMPLITUDES / tone * np.sin(tone * times) for sign, tone in TONES),
    )
