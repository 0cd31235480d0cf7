"""A list of free-standing objects from a CSV file, such as those of a museum, and their cases."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.csv_table import check_row, number_of, read_csv
from fecolumn.study.questions.limit import METRES_OF

_MASSES = {"kg": 1.0, "g": 1e-3, "t": 1e3}
#: Columns of the list with the units that may end their names; friction has none.
_COLUMNS = {"width": METRES_OF, "depth": METRES_OF, "height": METRES_OF, "mass": _MASSES}
_MOST = {"width": 100.0, "depth": 100.0, "height": 100.0, "mass": 1e9, "friction": 10.0}
# [kg/m3] of the block that an object is taken for: below, it is lighter than air (1.2), and above
# denser than any matter (osmium, 22,600)
_DENSITIES = (1.0, 25_000.0)
_SI = {"width": "m", "depth": "m", "height": "m", "mass": "kg", "friction": "-"}
_NEEDED = "name, width_m, depth_m, height_m, mass_kg and friction"


@dataclass(frozen=True, slots=True)
class ListedObject:
    """A block of the list: width along x, depth along y [m], mass [kg], friction of its foot."""

    name: str
    width: float
    depth: float
    height: float
    mass: float
    friction: float

    @property
    def values(self) -> tuple[float, ...]:
        """All but the name: objects alike are run once."""
        return self.width, self.depth, self.height, self.mass, self.friction


def read_objects(path: Path | str) -> list[ListedObject]:
    """Objects of a CSV file with the columns name, width, depth, height, mass and friction, units
    at the end of their names (width_cm, mass_g), in small or capital letters; further columns are
    passed over.

    Raises
    ------
    InputError
        no such file or column, a value out of range, a name twice.
    """
    path = Path(path)
    header, rows = read_csv(path, _NEEDED)
    places = {"name": _place(path, header, "name", {"": 1.0})}
    places |= {name: _place(path, header, name, units) for name, units in _COLUMNS.items()}
    places["friction"] = _place(path, header, "friction", {"": 1.0})
    found: dict[str, ListedObject] = {}
    for number, row in rows:
        check_row(path, header, number, row)
        name = row[places["name"][0]].strip()
        if not name:
            raise InputError(path, f"line {number}, name", "", "must not be empty")
        if name in found:
            raise InputError(path, f"line {number}, name", name, "stands twice in the list")
        sizes = {
            word: _size(path, number, header[place], row[place], factor, word)
            for word, (place, factor) in places.items()
            if word != "name"
        }
        one = ListedObject(name, **sizes)
        density = one.mass / (one.width * one.depth * one.height)
        if not _DENSITIES[0] <= density <= _DENSITIES[1]:
            place = places["mass"][0]
            raise InputError(
                path,
                f"line {number}, {header[place]}",
                row[place].strip(),
                f"is {density:.4g} kg/m3 of its width, depth and height; must lie in "
                f"[{_DENSITIES[0]:g}, {_DENSITIES[1]:g}] kg/m3: is a unit another?",
            )
        found[name] = one
    return list(found.values())


def _place(path: Path, header: list[str], name: str, units: dict[str, float]) -> tuple[int, float]:
    """Number of a column and the factor of its unit to SI."""
    there = [
        (place, units[unit])
        for place, word in enumerate(header)
        for unit in units
        if word.lower() == (f"{name}_{unit}" if unit else name)
    ]
    if len(there) == 1:
        return there[0]
    near = [word for word in header if word.lower().split("_")[0] == name]
    names = " or ".join(f"{name}_{unit}" if unit else name for unit in units)
    raise InputError(
        path, "header", ", ".join(near or header), f"must have one column {names}, of {_NEEDED}"
    )


def _size(path: Path, number: int, column: str, text: str, factor: float, word: str) -> float:
    value = factor * number_of(text)
    smooth = word == "friction" and value == 0
    if not (0 < value <= _MOST[word] or smooth):
        unit = "" if _SI[word] == "-" else f" [{_SI[word]}]"
        least = "of at least 0" if word == "friction" else "greater than 0"
        raise InputError(
            path,
            f"line {number}, {column}",
            text.strip(),
            f"must be a number {least} and at most {_MOST[word]:g}{unit}",
        )
    return float(f"{value:.12g}")


def tables_of_objects(
    objects: list[ListedObject], sources: list[str], engine: str, motion: dict[str, Any]
) -> dict[str, Any]:
    """Tables of a study of all objects, each different one once, in all motions.

    Parameters
    ----------
    sources
        of the motions.
    engine
        "rigid" or "housner".
    motion
        further keys of [motion].
    """
    columns = [list(column) for column in zip(*dict.fromkeys(one.values for one in objects))]
    width, depth, height, mass, friction = columns
    case: dict[str, Any] = {"motion": {"source": sources[0], **motion}}
    if engine == "housner":
        volumes = [a * b * c for a, b, c in zip(width, depth, height)]
        zipped = {
            "block.width_m": width,
            "block.depth_m": depth,
            "block.height_m": height,
            "block.density_kg_m3": [m / volume for m, volume in zip(mass, volumes)],
            "block.friction_coefficient": friction,
        }
        case |= {"block": {}, "integration": {"dt_s": 0.005}}
    else:
        zipped = {
            "bodies.object.length_m": width,
            "bodies.object.width_m": depth,
            "bodies.object.height_m": height,
            "bodies.object.mass_kg": mass,
            # rigid blocks touch at their corners, whatever the mesh
            "bodies.object.element_size_m": [min(sides) for sides in zip(width, depth, height)],
            "contact.friction_coefficient": friction,
        }
        case |= {
            "bodies": {"object": {"kind": "block"}},
            "joints": {"foot": {"between": ["object", "ground"]}},
            "contact": {"interior_points": 0},
            "integration": {"engine": "rigid", "dt_s": 1e-3},
        }
    return {
        "title": "Screening of a list",
        "case": case,
        "axes": {"motion.source": sources},
        "zip": zipped,
    }
