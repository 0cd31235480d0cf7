"""The programs: how each is run, its settings and why it has these.

Best settings come from `python -m benchmarks.programs --trial`, which prints what each setting of
`trial.py` errs by; defaults are what a program takes where its user says nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from benchmarks.programs.structures import NAMES
from fecolumn.study.run import ENTRY

PLANE = NAMES[1:]
_STIFF = 'solref="{} 1" solimp="0.99 0.9999 1e-6 0.5 2"'


@dataclass(frozen=True)
class Program:
    """A program with its settings.

    Attributes
    ----------
    name, label
        on the command line, in tables.
    dt
        step [s].
    said, reason
        settings in words, and why these.
    settings
        for a peer's script.
    engine
        of the package; of a peer "rigid", as its bodies are.
    structures
        on which it is run.
    asked
        whether it runs only where it is named: hours.
    """

    name: str
    label: str
    dt: float
    said: str
    reason: str
    settings: dict = field(default_factory=dict)
    engine: str = "rigid"
    structures: tuple[str, ...] = NAMES
    asked: bool = False

    @property
    def ours(self) -> bool:
        """Whether it is an engine of the package."""
        return self.name in ("rigid", "rigid-fine", "reduced", "full")

    @property
    def entry(self) -> str:
        """Function of an analysis."""
        return ENTRY if self.ours else f"benchmarks.programs.analysis:{self.name.replace('-', '_')}"


def mujoco_settings(dt: float, solref: float = 2.0, ratio: float = 100.0, more: str = "") -> dict:
    """Of MuJoCo with stiff contact: solref in steps, impratio, further words of <option>."""
    return dict(
        option=f'cone="elliptic" impratio="{ratio:g}" tolerance="1e-12" iterations="200" '
        f'ls_iterations="100" ls_tolerance="1e-4" integrator="implicitfast" {more}',
        contact=_STIFF.format(f"{solref * dt:.6g}"),
    )


PROGRAMS = (
    Program(
        "housner",
        "Housner's block, exact",
        1e-3,
        "closed form of an impact, Runge and Kutta in four parts of a step",
        "the exact motion of a rigid block that does not slide",
        structures=("block",),
    ),
    Program(
        "judge",
        "planar program",
        1e-4,
        "Moreau's midpoint scheme cut at impacts, friction to 1e-7 m/s",
        "at 2e-5 s outcomes and peaks are the same to 1e-3 (tests/benchmarks/test_planar.py)",
        structures=PLANE,
    ),
    Program(
        "mujoco",
        "MuJoCo, best",
        1e-4,
        "elliptic cones, Newton to 1e-12, impratio 100, solref 2 dt, solimp 0.99 0.9999, "
        "implicitfast",
        "the stiffest contact that its documentation calls stable; a longer solref feeds energy "
        "in, impratio 1000 costs more and creeps no less, CG throws drums about",
        mujoco_settings(1e-4),
    ),
    Program(
        "mujoco-defaults",
        "MuJoCo, defaults",
        2e-3,
        "pyramidal cones, Newton to 1e-8, impratio 1, solref 0.02 s, Euler",
        "what a model file that says nothing has",
        dict(option="", contact=""),
    ),
    Program(
        "siconos",
        "Siconos, best",
        1e-4,
        "in the plane; Moreau-Jean, theta 1/2, NSGS to 1e-10",
        "impacts err by the step, at 1e-3 s too much; theta 1/2 has no damping",
        dict(theta=0.5, tolerance=1e-10, sweeps=20000, newton=1e-9),
        structures=PLANE,
    ),
    Program(
        "siconos-tube",
        "Siconos, best of the tube",
        1e-4,
        "in space; Moreau-Jean, theta 1/2, NSGS to 1e-6",
        "at longer steps rolling feeds in more; NSGS to 1e-10 takes longer while the tube stands, "
        "and it stands as still; points of the rim are a script of this repository",
        dict(theta=0.5, tolerance=1e-6, sweeps=20000, newton=1e-9),
        structures=("tube",),
    ),
    Program(
        "siconos-defaults",
        "Siconos, defaults",
        5e-4,
        "Moreau-Jean, theta 0.50001, NSGS to 1e-4, 1000 sweeps at most; points of the rim are ours",
        "of its driver siconos.io.mechanics_run",
        dict(theta=0.50001, tolerance=1e-4, sweeps=1000, newton=1e-10),
    ),
    Program(
        "rigid",
        "fecolumn, rigid",
        1e-3,
        "as is",
        "defaults",
    ),
    Program(
        "rigid-fine",
        "fecolumn, rigid, short steps",
        2e-5,
        "as is",
        "bodies that land after one another within a step land together: the columns of the "
        "trilith do so 1e-4 s apart when the beam slides, and lose more then; of the "
        "tube the reference, as the planar program has no third dimension",
        structures=("tube", "drums", "trilith"),
    ),
    Program(
        "reduced",
        "fecolumn, reduced",
        1e-3,
        "as is; elastic bodies, 30 modes, of the tube 100",
        "defaults",
        engine="reduced",
    ),
    Program(
        "full",
        "fecolumn, full order",
        1e-3,
        "as is; elastic bodies",
        "defaults",
        engine="full",
        asked=True,
    ),
)
BY_NAME = {program.name: program for program in PROGRAMS}
