"""Structures and motions of the comparison, and each motion's history in a file, so that what was
computed is not computed again.

Motions are x of the Lick ensemble, three times as long as stored, their strong part, 2 s of rest
after it. A file belongs to the sources that made it: other sources make it anew.
"""

from __future__ import annotations

import hashlib
import io
from pathlib import Path

import numpy as np

from benchmarks.planar import package, peer, structures, theory
from benchmarks.planar.advance import advance
from benchmarks.planar.bodies import GRAVITY
from benchmarks.planar.shaken import EVERY, Response, Shaken
from fecolumn.foundation.atomic import write_bytes

PLANAR, PACKAGE, SICONOS, BLOCK = "planar", "fecolumn", "Siconos", "equivalent block"
#: Rest after a motion [s]
REST = 2.0
_MOTION = dict(strong_part=(0.05, 0.95), time_scale=3.0, resample_s=0.01)
_OWN = (
    "bodies.py",
    "contact.py",
    "nsgs.py",
    "advance.py",
    "structures.py",
    "theory.py",
    "shaken.py",
    "ensembles.py",
)


def _slope(width: float, height: float) -> float:
    return GRAVITY * width / height


def shaken() -> dict[str, Shaken]:
    """By name."""
    column, beam = structures.FRAME["column"], structures.FRAME["beam"]
    gamma = beam[0] * beam[1] / (2 * column[0] * column[1])
    (width, height), (drum, tall), (course, thick) = (
        structures.BLOCK,
        structures.DRUM,
        structures.COURSE,
    )
    return {
        "two blocks": Shaken(structures.two_blocks(), _slope(width, 2 * height), 3.5, 2),
        "five drums": Shaken(structures.drums(), _slope(drum, 5 * tall), 5.0, 5),
        "trilith": Shaken(
            structures.frame(**structures.TRILITH), _slope(*structures.TRILITH["column"]), 2.75, 3
        ),
        "frame": Shaken(
            structures.frame(**structures.FRAME),
            _slope(*column),
            3.5,
            3,
            closed=theory.equivalent_block(column, gamma),
        ),
        "pair with a gap": Shaken(
            structures.beside(**structures.PAIR), _slope(*structures.PAIR["first"]), 2.0, 1
        ),
        "four blocks": Shaken(structures.courses(), _slope(course, 4 * thick), 2.0, 4, motions=20),
    }


def motion(case: Shaken, number: int, dt: float) -> np.ndarray:
    """Accelerations (n,) [m/s2] at steps of dt [s]."""
    from fecolumn.case.sections import Motion
    from fecolumn.motions.load import load_motion

    a = load_motion(
        Motion(source=f"lick:{number}", **_MOTION), dt, "benchmarks.planar"
    ).acceleration[:, 0]
    return np.concatenate(
        [a * (case.factor * case.uplift / np.abs(a).max()), np.zeros(round(REST / dt))]
    )


def planar(case: Shaken, ground: np.ndarray, dt: float) -> Response:
    """By the planar program."""
    found = advance(case.structure, ground, dt, every=round(EVERY / dt))
    moving = [number for number, body in enumerate(case.structure.bodies) if not body.fixed]
    return Response(
        found.time,
        found.top(case.observed),
        np.abs(found.tilt[:, moving]),
        found.fallen,
        unsolved=found.unsolved,
    )


def block(case: Shaken, ground: np.ndarray, dt: float) -> Response:
    """By the closed form of the equivalent block; its top is that of a beam: two half diagonals
    move it.
    """
    every = case.closed.shaken(ground, dt)
    tilt = every[:: round(EVERY / dt)]
    alpha, (width, height) = case.closed.alpha[0], structures.FRAME["column"]
    top = np.hypot(width, height) * np.sign(tilt) * (np.sin(alpha) - np.sin(alpha - np.abs(tilt)))
    return Response(
        EVERY * np.arange(len(tilt)),
        top,
        np.abs(tilt)[:, None],
        bool(np.abs(every).max() > np.pi / 4),
    )


def response(
    name: str, program: str, number: int, dt: float, folder: Path, until: float = np.inf
) -> Response:
    """What `program` says of the structure of that name in a motion, from the file of an earlier
    run where there is one.

    Parameters
    ----------
    dt
        step [s].
    until
        time [s] after which it need not go on.
    """
    from fecolumn.foundation.sources import DECIDING, digest_of, files_of

    further = {PACKAGE: [*files_of(DECIDING), Path(package.__file__)], SICONOS: peer.SOURCES}
    made_by = digest_of(
        [*(Path(__file__).with_name(own) for own in _OWN), *further.get(program, ())]
    )
    key = hashlib.sha256(f"{made_by} {until:.3f}".encode()).hexdigest()[:12]
    file = folder / "runs" / f"{name}-{program}-{dt:g}s-{number}-{key}.npz".replace(" ", "_")
    if file.exists():
        with np.load(file) as kept:
            return Response(
                kept["time"],
                kept["top"],
                kept["tilt"],
                bool(kept["fallen"]),
                str(kept["failed"]),
                int(kept["unsolved"]),
            )
    case = shaken()[name]
    ground = motion(case, number, dt)
    if np.isfinite(until):
        ground = ground[: round(until / dt) + 1]
    found = {PLANAR: planar, PACKAGE: package.respond, SICONOS: peer.respond, BLOCK: block}[
        program
    ](case, ground, dt)
    content = io.BytesIO()
    np.savez_compressed(
        content,
        time=found.time,
        top=found.top,
        tilt=found.tilt,
        fallen=found.fallen,
        failed=found.failed,
        unsolved=found.unsolved,
    )
    file.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(file, content.getvalue())
    return found
