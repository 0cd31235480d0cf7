"""`fecolumn compare` of two analyses: what differs, when their motions part, where their energy
went.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.study.results.analysis import AnalysisResult
from fecolumn.study.results.parting import (
    QUANTITIES,
    TOLERANCE,
    Parting,
    QuantityPair,
    parting,
    quantity_of,
)

FIGURE = "comparison"


def compare_analyses(folders: tuple[str, str], tolerance: float | None, output: str | None) -> None:
    """Print the comparison of two folders of `fecolumn run`, and write it where a folder is given.

    Raises
    ------
    InputError
        a folder cannot be read, or they have no time in common.
    """
    from fecolumn.foundation.folder import written

    a, b = (AnalysisResult(folder) for folder in folders)
    found = parting(a, b, TOLERANCE if tolerance is None else tolerance)
    for line in _text(a, b, found):
        print(line)
    if output:
        with written(output, "compare") as draft:
            files = _write(draft, a, b, found)
        for file in files:
            print(f"wrote {Path(output) / file.name}")


def _text(a: AnalysisResult, b: AnalysisResult, found: Parting) -> Iterator[str]:
    """Lines for a reader."""
    for letter, one in (("A", a), ("B", b)):
        yield f"{letter}  {one.folder}: {_told(one)}"
    yield ""
    if found.keys:
        rows = [
            ["key of the case", "A", "B", "unit"],
            *([key, _shown(of_a), _shown(of_b), _unit(key)] for key, of_a, of_b in found.keys),
        ]
        yield _columns(rows)
    else:
        yield "The cases have the same values for every key."
    codes = [(one.summary.get("version", "?"), one.summary.get("sources", "?")) for one in (a, b)]
    if all(one.finished for one in (a, b)) and codes[0] != codes[1]:
        yield (
            f"They are of other code: A of {codes[0][0]} ({codes[0][1]}), B of "
            f"{codes[1][0]} ({codes[1][1]})."
        )
    yield ""
    rows = [
        [
            f"from {found.time[0]:g} to {found.time[-1]:g} s",
            "peak of A",
            "peak of B",
            "largest difference",
            "over the larger peak",
            "parted at [s]",
        ]
    ]
    for name, pair in found.quantities.items():
        quantity = quantity_of(name, pair)
        rows.append(
            [
                quantity.label,
                *(f"{peak / quantity.scale:.4g}" for peak in pair.peaks),
                f"{pair.difference.max() / quantity.scale:.3g}",
                _share(pair),
                _parted(found, pair),
            ]
        )
    yield _columns(rows)
    yield (
        f"Parted: the first time at which A and B differ by more than {found.tolerance:g} "
        "of the larger of both peaks (--tolerance)."
    )
    if not found.quantities["uplift"].judged:
        yield (
            "Neither lifts off its base: tilt and uplift are elastic deformation alone, "
            "and are not judged."
        )
    first = found.first
    yield (
        f"They part at {first[1]:.4f} s, first in {QUANTITIES[first[0]][0]}."
        if first
        else f"They do not part within the {found.time[-1] - found.time[0]:g} s that both analysed."
    )
    yield ""
    rows = [[f"energy [J] at {found.time[-1]:g} s", "A", "B", "A - B", "largest difference"]]
    for term, pair in found.energy.items():
        if pair.peak > 0:
            of_a, of_b = pair.a[-1, 0], pair.b[-1, 0]
            rows.append(
                [
                    term,
                    f"{of_a:.5g}",
                    f"{of_b:.5g}",
                    f"{of_a - of_b:.3g}",
                    f"{pair.difference.max():.3g}",
                ]
            )
    yield _columns(rows)


def _told(one: AnalysisResult) -> str:
    from fecolumn.engines.ending import ending_text, peak_text

    plan = one.case.integration
    title = f"{one.case.title}; " if one.case.title else ""
    ending = (
        f"{peak_text(one.summary)}, {ending_text(one.summary)}"
        if one.finished
        else f"not finished, at {one.time[-1]:g} s"
    )
    return f"{title}{plan.engine}, dt {plan.dt_s:g} s; {ending}"


def _parted(found: Parting, pair: QuantityPair) -> str:
    return (
        "not judged"
        if not pair.judged
        else "never"
        if pair.parted is None
        else f"{found.time[pair.parted]:.4f}"
    )


def _share(pair: QuantityPair) -> str:
    return f"{pair.difference.max() / pair.peak:.3g}" if pair.peak else "-"


def _unit(key: str) -> str:
    from fecolumn.pictures.figures.axis_text import axis_unit

    unit = axis_unit(key) if "." in key else "-"
    return "" if unit == "-" else unit


def _shown(value: object) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.8g}"
    return ", ".join(map(_shown, value)) if isinstance(value, (list, tuple)) else str(value) or '""'


def _columns(rows: list[list[str]]) -> str:
    """The first column to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if k else cell.ljust(width)
            for k, (cell, width) in enumerate(zip(row, widths))
        ).rstrip()
        for row in rows
    )


def _write(folder: Path, a: AnalysisResult, b: AnalysisResult, found: Parting) -> list[Path]:
    from fecolumn.foundation.atomic import write_csv, write_json
    from fecolumn.pictures.figures.parting_figure import parting_figure

    files = [folder / "comparison.json", folder / "histories.csv"]
    write_json(files[0], _summary(a, b, found))
    header, columns = ["time [s]"], [found.time]
    for name, pair in found.quantities.items():
        unit, parts = QUANTITIES[name][1], "xy" if pair.a.shape[1] > 1 else " "
        for k, part in enumerate(parts):
            for side in ("a", "b"):
                header.append(f"{name}{'_' + part if part.strip() else ''}_{side} [{unit}]")
                columns.append(getattr(pair, side)[:, k])
        header.append(f"{name}_difference [{unit}]")
        columns.append(pair.difference)
    write_csv(
        files[1], [header, *([f"{value:.9g}" for value in row] for row in np.column_stack(columns))]
    )
    quantities = {name: quantity_of(name, pair) for name, pair in found.quantities.items()}
    quantities["energy"] = Quantity.of(
        "energy", "J", max(np.abs([pair.a[-1], pair.b[-1]]).max() for pair in found.energy.values())
    )
    symbols = {name: symbol for name, (_, _, symbol) in QUANTITIES.items()}
    return files + parting_figure(found, quantities, symbols, _labels(a, b, found), folder / FIGURE)


def _summary(a: AnalysisResult, b: AnalysisResult, found: Parting) -> dict[str, Any]:
    """What comparison.json holds, in SI units."""

    def told(pair: QuantityPair, unit: str) -> dict[str, Any]:
        return dict(
            unit=unit,
            peak_a=pair.peaks[0],
            peak_b=pair.peaks[1],
            difference_max=float(pair.difference.max()),
            parted_s=pair.parted_s,
        )

    first = found.first
    return dict(
        a=str(a.folder),
        b=str(b.folder),
        case_id_a=a.case.id,
        case_id_b=b.case.id,
        start_s=float(found.time[0]),
        end_s=float(found.time[-1]),
        rows=len(found.time),
        tolerance=found.tolerance,
        parted_s=first[1] if first else None,
        parted_first=first[0] if first else None,
        quantities={
            name: told(pair, QUANTITIES[name][1]) for name, pair in found.quantities.items()
        },
        energy_j={
            term: dict(
                a=float(pair.a[-1, 0]),
                b=float(pair.b[-1, 0]),
                difference_max=float(pair.difference.max()),
            )
            for term, pair in found.energy.items()
        },
        keys={key: dict(a=of_a, b=of_b, unit=_unit(key)) for key, of_a, of_b in found.keys},
    )


def _labels(a: AnalysisResult, b: AnalysisResult, found: Parting) -> tuple[str, str]:
    """What tells A from B in a figure: one or two keys where no more differ, else titles, else
    folders.
    """
    from fecolumn.pictures.figures.axis_text import axis_text

    keys = [row for row in found.keys if row[0].partition(".")[0] not in ("output", "mesh")]
    if 1 <= len(keys) <= 2 and all(
        value is not None and not isinstance(value, (list, tuple)) and len(str(value)) < 20
        for _, *values in keys
        for value in values
    ):
        told_a, told_b = (
            ", ".join(axis_text(key, values[place]) for key, *values in keys) for place in (0, 1)
        )
    elif a.case.title != b.case.title:
        told_a, told_b = (one.case.title or one.folder.name for one in (a, b))
    else:
        told_a, told_b = a.folder.name, b.folder.name
    return f"A: {told_a}", f"B: {told_b}"
