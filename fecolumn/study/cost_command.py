"""`fecolumn cost`: what an analysis will take, and by how much keys make it cheaper, measured."""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fecolumn.case.case import Case

_COMMAND = "fecolumn cost"
_SECONDS = 2.0
# Range of the wall time of a setting's steps [s]
_RANGE = 0.1, 3600.0
# Other settings go on until they have come as far, at most so many times as long
_LONGER = 2.0
# Share of a motion's Arias intensity that is over when bodies may rock: from there on steps are
# measured, as those before, which bodies stand through, tell little
_ROCKS_FROM = 0.1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn cost`."""
    parser.add_argument("case", metavar="CASE.toml", help="case file to measure")
    parser.add_argument(
        "--seconds",
        metavar="S",
        type=float,
        default=_SECONDS,
        help="wall time for steps of the case as it is, 0.1 to 3600 [s]; the time before the first "
        f"step is added (default: {_SECONDS:g})",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")


@dataclass(frozen=True, slots=True)
class FirstSteps:
    """The first steps of an analysis: their number and length [s], their wall time [s], and the
    largest displacement of the top [m] in them.
    """

    steps: int
    dt: float
    wall_s: float
    peak_m: float

    @property
    def span(self) -> float:
        """Time analysed [s]."""
        return self.steps * self.dt

    @property
    def step_s(self) -> float:
        """Wall time of a step [s]."""
        return self.wall_s / self.steps

    @property
    def pace(self) -> float:
        """Wall time of a second of motion [s]."""
        return self.wall_s / self.span


def main(args: argparse.Namespace) -> int:
    """Measure, and print the table; 0, or 130 after Ctrl-C.

    Raises
    ------
    InputError
        the case cannot be analysed, or is a model that takes no steps of a mesh.
    AnalysisFailed
        a step of the case as it is did not converge.
    """
    from fecolumn.case.case import load_case
    from fecolumn.case.sections import MODEL_ENGINES
    from fecolumn.engines.pace import cheaper
    from fecolumn.foundation.progress import clock
    from fecolumn.foundation.schema import InputError
    from fecolumn.simulation import chosen_step

    if not _RANGE[0] <= args.seconds <= _RANGE[1]:
        allowed = f"must lie between {_RANGE[0]:g} and {_RANGE[1]:g}"
        raise InputError(_COMMAND, "--seconds", args.seconds, allowed)
    case = load_case(args.case)
    if case.integration.engine in MODEL_ENGINES:
        allowed = "is a model of rigid bodies: its analysis takes seconds, and no key makes it less"
        raise InputError(args.case, "integration.engine", case.integration.engine, allowed)
    tell = _nothing if args.quiet else _tell
    if case.integration.step_is_chosen:
        case = chosen_step(case, args.case, say=tell)[0]
    duration, quiet_s = _duration(case, args.case)
    tell("measuring: as it is")
    own, before = first_steps(case, args.case, args.seconds), 0.0
    quiet = own.span < quiet_s
    if quiet:
        before = own.pace * quiet_s
        print(
            f"a step of the quiet first {quiet_s:.3g} s takes {1e3 * own.step_s:.3g} ms; "
            "then, where the motion is strong:"
        )
        case = _strong(case)
        tell("measuring: as it is, where the motion is strong")
        own = first_steps(case, args.case, args.seconds)
    later_s = duration - quiet_s if quiet else duration
    print(
        f"{'setting':<34} {'ms a step':>9} {'whole analysis':>14} {'times as fast':>13}  "
        f"top in the first {own.span:.3g} s{' of it' if quiet else ''}"
    )

    def row(name: str, trial: FirstSteps) -> None:
        whole = before * trial.pace / own.pace + trial.pace * later_s
        print(
            f"{name:<34} {1e3 * trial.step_s:>9.3g} "
            f"{clock(whole):>14} {own.pace / trial.pace:>13.2g}  "
            f"{1e3 * trial.peak_m:.4g} mm",
            flush=True,
        )

    row("as it is", own)
    for changes in cheaper(case).values():
        name = ", ".join(f"{key} = {value!r}" for key, value in changes.items())
        tell(f"measuring: {name}")
        try:
            row(name, _changed(case, args.case, changes, own, args.seconds))
        except (InputError, RuntimeError) as error:
            print(f"{name:<34} does not run: {str(error).splitlines()[0]}", flush=True)
    return 0


def _tell(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


def _nothing(words: str) -> None:
    """In the place of `_tell` where nobody wants to hear."""


def _duration(case: Case, file: str) -> tuple[float, float]:
    """Time analysed, until rest the longest, and how much of it is quiet at the begin [s]: 0 where
    grounds have motions of their own, which a strong part would no longer fit.
    """
    import numpy as np

    from fecolumn.case.check_case import check
    from fecolumn.motions.load import load_motion
    from fecolumn.motions.processing import arias_intensity
    from fecolumn.simulation import check_analysis

    check(case, file)
    check_analysis(case, file)
    if case.motion is None:
        return case.integration.duration_s, 0.0
    ground = load_motion(case.motion, float(case.integration.dt_s), file)
    duration = case.integration.duration_s or ground.duration + case.motion.longest_free_vibration_s
    intensity = arias_intensity(ground)[:, :2].sum(axis=1)
    begins = ground.dt * int(np.searchsorted(intensity, _ROCKS_FROM * intensity[-1]))
    alone = all(one.motion is None for one in case.grounds.values())
    return duration, begins if alone and begins < duration else 0.0


def _strong(case: Case) -> Case:
    """The case in the motion from where bodies may rock."""
    assert case.motion is not None
    begin, end = case.motion.strong_part
    return case.replace({"motion.strong_part": [begin + _ROCKS_FROM * (end - begin), end]})


def _changed(
    case: Case, file: str, changes: dict[str, Any], own: FirstSteps, seconds: float
) -> FirstSteps:
    """The same time of motion with other values."""
    span = {"integration.duration_s": own.span}
    return first_steps(case.replace({**changes, **span}), file, _LONGER * seconds)


def first_steps(case: Case, file: str, seconds: float) -> FirstSteps:
    """The steps of a case that are made in so much wall time [s], in a folder that is removed.

    Raises
    ------
    AnalysisFailed
        a step did not converge.
    """
    import numpy as np
    from mpi4py import MPI

    from fecolumn.case.check_case import check
    from fecolumn.engines.trial_run import trial
    from fecolumn.simulation import started_analysis

    began: list[float] = []

    def enough() -> bool:
        began.append(time.monotonic())
        return began[-1] - began[0] >= seconds

    check(case, file)
    plain = case.replace({"output.states_every_s": 0.0, "output.fields_every_s": 0.0})
    made, _ = trial(
        lambda folder: started_analysis(plain, folder, MPI.COMM_WORLD, file, quiet=True), enough
    )
    top = np.hypot(*made.history.arrays()["u_top"][:, :2].T)
    return FirstSteps(made.step, float(case.integration.dt_s), made.stepping_s, float(top.max()))
