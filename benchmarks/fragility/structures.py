"""Columns of one to eight drums of one height, a trilith and a frame on such columns."""

from __future__ import annotations

from benchmarks.structures.frames_and_stacks import frame_case, stack_case
from fecolumn.case.case import Case

#: Diameter and height of the columns of drums [m]
COLUMN = (1.0, 6.0)
DRUMS = (1, 2, 3, 4, 5, 6, 7, 8)
#: Contact points around a face; friction is that of `frames_and_stacks`, 0.7.
AROUND = 12
_FRAMES = {"trilith": 2, "frame": 4}
#: How far a drum, or a slab's column, may slide or walk from its place on another body [m]: till a
#: drum is half off, or a column's rim at the slab's edge. Beyond it is lost: slid off.
SLIDES = 0.5
ELASTIC = "elastic "


def _stack(drums: int) -> str:
    return "monolith" if drums == 1 else f"{drums} drums"


#: Structures of rigid bodies, and those of them of elastic marble and concrete
RIGID = (*map(_stack, DRUMS), *_FRAMES)
NAMES = (*RIGID, *(ELASTIC + name for name in ("monolith", "4 drums", "trilith")))


def case_of(name: str, tables: dict) -> Case:
    """Case of the structure of a name, with the further tables."""
    engine = "reduced" if name.startswith(ELASTIC) else "rigid"
    kind = name.removeprefix(ELASTIC)
    joint = "heads" if kind in _FRAMES else "joints"
    if kind != "monolith":
        tables = tables | dict(joints={joint: dict(allowance_m=SLIDES)})
    if kind in _FRAMES:
        return frame_case(_FRAMES[kind], False, engine, AROUND, tables, COLUMN)
    drums = 1 if kind == "monolith" else int(kind.split()[0])
    return stack_case(drums, False, engine, AROUND, tables, drum=(COLUMN[0], COLUMN[1] / drums))
