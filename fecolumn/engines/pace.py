"""How long the steps of an analysis take: told once they are known, with the keys that make them
cheaper, and why where they are slow.
"""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.case.sections import POINTS_OF_SEVERAL, Integration
from fecolumn.foundation.atomic import write_json
from fecolumn.foundation.progress import clock
from fecolumn.foundation.schema import parameter_of

if TYPE_CHECKING:
    from fecolumn.case.case import Case
    from fecolumn.engines.dynamics.record import Record
    from fecolumn.engines.structure_analysis import OfStructure
    from fecolumn.structures.model import StructureModel

# Longest step that may be stated [s]
_LONGEST_S = parameter_of(Integration, "dt_s").metadata["high"]
#: File of a running analysis with its pace, from which a study knows how long it will take
PACE_FILE = "pace.json"
# Wall time of steps [s], and their least number, after which the pace is known; the same between
# two times that it is judged again, as some steps of a motion take much longer than all others
_KNOWN_S, _KNOWN_STEPS, _AGAIN_S = 1.0, 3, 5.0
#: Wall time [s] between two looks, so that Ctrl-C and progress do not wait; steps until the first
LOOK_S, _FIRST_STEPS = 0.25, 5
# A rest of so long [s] is told; of one longer than this, what would shorten it
_TOLD_S, _LONG_S = 3.0, 30.0
#: A step that takes longer [s] is slow
SLOW_S = 0.05
# Slow steps, and the time left, are told again where they are so many times what was told last
_SLOWER = 2.0
# The ground moved little so far where it did by less than this share of what is to come
_QUIET = 0.5


class Pace:
    """Wall time of the steps of an analysis.

    Parameters
    ----------
    analysis
        with `step`, `steps`, `motion_steps`, `until_rest`, `stepping_s` [s], `case`, `structure`,
        `folder`, `history` and `comm`.
    say
        function that takes a line of words.
    record
        Record of the steps before.
    """

    def __init__(self, analysis: OfStructure, say: Callable[[str], None], record: Record) -> None:
        self._analysis, self._say = analysis, say
        # step and wall time at the begin, when steps were last judged, at the last look
        self._began = self._judged = self._looked = analysis.step, analysis.stepping_s
        self._record = dataclasses.replace(record)
        # the time left that was told last [s], None before any
        self._told: float | None = None
        self._slow = SLOW_S
        self._made_in_s = analysis.made_in_s()
        self._s_per_step = 0.0

    def chunk(self, most: int) -> int:
        """Steps until the next look, `most` at most."""
        if self._analysis.step_times:
            return 1
        if not self._s_per_step:
            return min(_FIRST_STEPS, most)
        return max(1, min(most, int(LOOK_S / self._s_per_step)))

    def look(self, record: Record) -> None:
        """Look at the clock after some steps; `record`: Record of all steps so far."""
        now = self._analysis.step, self._analysis.stepping_s
        if now[0] == self._looked[0]:
            return
        self._note_step(record)
        if not self._s_per_step:  # the first steps of a full-order engine compile
            self._s_per_step = _each(self._looked, now)
            self._began = self._judged = self._looked = now
            self._record = dataclasses.replace(record)
            return
        self._s_per_step, self._looked = _each(self._looked, now), now
        # one step alone may have compiled
        if now[1] - self._judged[1] >= LOOK_S and now[0] - self._judged[0] > 1:
            each = _each(self._judged, now)
            if each > self._slow and self._s_per_step > SLOW_S:
                self._slow = _SLOWER * each
                self._say(self._why(record, each))
            self._judged, self._record = now, dataclasses.replace(record)
        enough = _KNOWN_S if self._told is None else _AGAIN_S
        known = now[1] - self._began[1] >= enough and now[0] - self._began[0] >= _KNOWN_STEPS
        if known:
            self._tell()

    def _note_step(self, record: Record) -> None:
        """Note a step where each is timed."""
        analysis = self._analysis
        made_in_s = analysis.made_in_s()
        if analysis.step_times:
            last = analysis.history.last()
            spent = made_in_s - self._made_in_s
            analysis.step_times.note(last["time"], spent, int(last["active_nodes"]), record)
        self._made_in_s = made_in_s

    def end(self) -> None:
        """Remove the file of the pace, and write the times of steps."""
        if self._analysis.step_times and self._analysis.comm.rank == 0:
            self._analysis.step_times.write(self._analysis.folder)
        with contextlib.suppress(OSError):
            (self._analysis.folder / PACE_FILE).unlink(missing_ok=True)

    def _tell(self) -> None:
        """Say how long the rest takes by the steps since the last time, where that is not known or
        much longer than was told; later steps are then judged from here.
        """
        analysis = self._analysis
        made, each = analysis.step - self._began[0], _each(self._began, self._looked)
        first, self._began = self._told is None, self._looked
        surely = analysis.motion_steps if analysis.until_rest else analysis.steps
        left = each * (analysis.steps - analysis.step)
        if not first and left < max(_LONG_S, _SLOWER * (self._told or 0.0)):
            return
        self._told = left
        if left < _TOLD_S:
            return
        cheaper_keys = cheaper_text(analysis.case, analysis.structure)
        if first and analysis.comm.rank == 0:
            with contextlib.suppress(OSError):
                write_json(
                    analysis.folder / PACE_FILE, {"whole_s": each * surely, "cheaper": cheaper_keys}
                )
        which = f"{made:,} steps" if first else f"the last {made:,} steps"
        said = f"{which} took {_written(each)} each: about {clock(left)} for the rest"
        if surely < analysis.steps:
            until = each * max(surely - analysis.step, 0)
            said = (
                f"{which} took {_written(each)} each: about {clock(until)} to the end of "
                f"the motion, {clock(left)} at most until at rest"
            )
        said += self._if_quiet() if first else ", if all take as long"
        if left > _LONG_S:
            said += f"; {cheaper_keys}"
        self._say(said)

    def _if_quiet(self) -> str:
        """What the time left is told of, in words, where the ground has moved little so far."""
        analysis = self._analysis
        if analysis.motion is None or analysis.step >= analysis.motion_steps:
            return ""
        ground = np.abs(analysis.motion.acceleration).max(axis=1)
        before, after = ground[: analysis.step].max(), ground[analysis.step :].max()
        if before >= _QUIET * after:
            return ""
        return (
            f", more when bodies rock: the ground has moved by {before:.2g} m/s2 so far, later by "
            f"{after:.2g}"
        )

    def _why(self, record: Record, each: float) -> str:
        """Why steps take `each` so long [s], in words."""
        analysis = self._analysis
        steps = analysis.step - self._judged[0]
        spent = {
            key: (value - getattr(self._record, key)) / steps
            for key, value in dataclasses.asdict(record).items()
        }
        parts = [
            f"{spent['iterations']:.3g} iterations",
            f"{spent['contact_iterations']:.3g} of contact problems",
        ]
        if spent["impacts"]:
            parts.append(
                f"{spent['impacts']:.3g} impacts with {spent['impact_iterations']:.3g} iterations"
            )
        for key, name in (("cuts", "halvings"), ("parts", "parts while a rim rolls fast")):
            if spent[key]:
                parts.append(f"{spent[key]:.3g} {name}")
        if analysis.case.integration.engine == "full":
            dofs = sum(part.model.dofs for part in analysis.structure.parts)
            parts.insert(0, f"{dofs:,} degrees of freedom")
        last = analysis.history.last()
        return (
            f"steps take {_written(each)} each around t = {last['time']:.3f} s: "
            f"{_busiest(analysis.structure, last)}, {', '.join(parts)} a step"
        )


def _each(before: tuple[int, float], now: tuple[int, float]) -> float:
    """Wall time of a step [s] between two looks (step, wall time [s])."""
    return (now[1] - before[1]) / (now[0] - before[0])


def _written(each: float) -> str:
    """Wall time of a step [s], in words."""
    return f"{1e3 * each:.2g} ms" if each < 0.1 else f"{1e3 * each:,.0f} ms"


def contact_points_of(structure: StructureModel) -> dict[str, int]:
    """Contact points by the name of a joint, those of both its sides together."""
    found: dict[str, int] = {}
    for joint in structure.joints:
        name = structure.joints[joint.pair].name if joint.pair >= 0 else joint.name
        nodes = structure.parts[joint.slave].model.surfaces[joint.slave_surface].nodes
        found[name] = found.get(name, 0) + len(nodes)
    return found


def _busiest(structure: StructureModel, last: dict[str, Any]) -> str:
    """The joint that carries with the most contact points, in words."""
    points = contact_points_of(structure)
    if not points:
        return f"{int(last['active_nodes'])} points carry"
    carrying = [name for name in points if last.get(f"interface/{name}/force", 0.0) > 0]
    name = max(carrying or points, key=lambda one: points[one])
    return (
        f'joint "{name}" has {points[name]} of {sum(points.values())} contact points, '
        f"{int(last['active_nodes'])} carry in all"
    )


def cheaper(case: Case) -> dict[str, dict[str, Any]]:
    """Changes of a case that make it cheaper, by dotted key; each by itself."""
    plan = case.integration
    found: dict[str, dict[str, Any]] = {}
    if plan.engine == "full":
        found["integration.engine"] = {"integration.engine": "reduced"}
    given = {
        "contact.interior_points"
        if one.interior_points is None
        else f"joints.{name}.interior_points": (
            case.interior_points if one.interior_points is None else one.interior_points
        )
        for name, one in case.joints.items()
    }
    many = {key: POINTS_OF_SEVERAL for key, value in given.items() if value > POINTS_OF_SEVERAL}
    if many:
        found["interior_points"] = many
    if plan.engine == "reduced":
        if case.n_modes > 5:
            found["integration.n_modes"] = {"integration.n_modes": 5}
        found["integration.engine"] = {"integration.engine": "rigid"}
    longer = 2 * float(plan.dt_s)
    if longer <= min(_LONGEST_S, plan.duration_s or _LONGEST_S):
        found["integration.dt_s"] = {"integration.dt_s": longer}
    return found


def cheaper_text(case: Case, structure: StructureModel) -> str:
    """The same in words."""
    named = [f"{key} = {value!r}" for one in cheaper(case).values() for key, value in one.items()]
    return (
        f"{sum(contact_points_of(structure).values())} contact points; cheaper may be "
        f"{', '.join(named)}: fecolumn cost measures by how much"
    )
