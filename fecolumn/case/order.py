"""What the order of tables decides: the frame of displacements, and the body that is observed."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from pathlib import PurePath

from fecolumn.case.bodies import Matrices, MeshBody, Prism, Storeys
from fecolumn.case.body_keys import Placed
from fecolumn.case.checked import CheckedCase
from fecolumn.foundation.paths import OF_BODIES as FILES

# Over a height [m]: less tells no two bodies apart
_ALIKE = 1e-9


def chosen_by_order(case: CheckedCase) -> dict[str, str]:
    """Names that a case has only from the order of its tables.

    Returns
    -------
    "first ground": that to which displacements are relative, of several; "first body": of equally
    high bodies, where none is stated, the observed one. Where it is the first by name, too, it is
    left out: so were all in earlier versions.
    """
    grounds = list(case.grounds)
    found = {"first ground": grounds[0]} if grounds and grounds[0] != _by_name(grounds) else {}
    if not case.observed:
        firsts = [one[0] for one in _equally_high(case) if one[0] != _by_name(one)]
        if firsts:
            found["first body"] = ", ".join(firsts)
    return found


def _by_name(names: Iterable[str]) -> str:
    """The first name, "arch 9" before "arch 10"."""
    return min(names, key=lambda name: [one.zfill(9) for one in re.split(r"(\d+)", name)])


def _equally_high(case: CheckedCase) -> list[list[str]]:
    """Names of the highest bodies that move, in the order of the case; of those whose height is in
    a file, the highest of each file.
    """
    moving = [name for name in case.bodies if not case.is_held(name)]
    tops: dict[tuple[str, ...], dict[str, float]] = {}
    for name in moving:
        body = case.bodies[name]
        tops.setdefault(_files(body), {})[name] = _top(body)
    found = []
    for own in tops.values():
        highest = max(own.values())
        found.append(
            [name for name, top in own.items() if math.isclose(top, highest, rel_tol=_ALIKE)]
        )
    return found


def _files(body: Placed) -> tuple[str, ...]:
    """Names of the files that the height of a body is in."""
    if not isinstance(body, (MeshBody, Matrices)):
        return ()
    return tuple(PurePath(getattr(body, key)).name for key in FILES[body.kind])


def _top(body: Placed) -> float:
    """Height [m] of the top of a body before it is tilted, but for what its file says."""
    own = getattr(body, "height_m", None)
    if isinstance(body, Prism):
        own = body.width_m if body.along == "z" else max(corner[1] for corner in body.outline_m)
    elif isinstance(body, Storeys):
        heights = body.storey_heights_m
        own = body.thickness_m + math.fsum(heights) * (body.floors if len(heights) == 1 else 1)
    elif own is None:
        own = getattr(body, "thickness_m", 0.0)
    plates = [getattr(body, name, None) for name in ("flange", "cap")]
    own += sum(plate.thickness_m for plate in plates if plate)
    return float(own + max(place[2] for place in body.places))
