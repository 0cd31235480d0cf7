"""Section: where the figures come from."""

from __future__ import annotations

import datetime
import importlib.metadata
import platform
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.study.mixture import codes, listed
from fecolumn.study.plan import ENSEMBLE_AXES
from fecolumn.study.report.document import PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.notation import axis_name, level_text, number
from fecolumn.study.report.sweep import Sweep
from fecolumn.study.store import DONE

_PACKAGES = (
    "numpy",
    "scipy",
    "statsmodels",
    "numba",
    "matplotlib",
    "jinja2",
    "h5py",
    "petsc4py",
    "fenics-dolfinx",
    "gmsh",
)
_RECORDED = {"motion": "Motion files (SHA-256)", "machine": "Machine"}
_DIGEST = re.compile("[0-9a-f]{40,}")
_KNOWN = ("id", "axes", "state", "reason", "wall_s", "version", "summary", "started", "log")


def provenance(sweep: Sweep) -> PageSection:
    """The section: the study, its motions, its case, programs, machine."""
    runs = [run for setting in sweep.done for run in setting.runs.values()]
    rows = [
        ("Study", sweep.title),
        ("Study id", _identity(sweep.folder)),
        *(
            (
                f"Axis {key}",
                ", ".join(level_text(key, level) for level in levels)
                if len(levels) <= 12
                else f"{len(levels)} values, {level_text(key, levels[0])} to "
                f"{level_text(key, levels[-1])}",
            )
            for key, levels in sweep.axes.items()
        ),
        ("Motions", _motions(sweep)),
        *_engines(sweep),
        *_recorded(sweep),
        ("Written by", listed(codes(sweep.rows)) or "not recorded"),
        *_dates(sweep),
        (
            "Wall time of all analyses",
            f"{number(sum(run.get('wall_s') or 0.0 for run in runs) / 3600)} h",
        ),
        ("Reported by", ", ".join(f"{name} {version}" for name, version in _versions())),
        (
            "Reported on",
            f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        ),
    ]
    blocks = [
        PageTable(
            "provenance",
            (PageColumn("what", "what", text=True), PageColumn("value", "value", text=True)),
            rows,
            "Where the figures come from.",
        )
    ]
    if sweep.case:
        blocks.append(
            PageTable(
                "case",
                (PageColumn("key", "key", text=True), PageColumn("value", "value", text=True)),
                list(_flat(sweep)),
                "The case that all analyses share, SI units as the keys say; axes are left out.",
                folded=True,
            )
        )
    return PageSection(
        "Provenance",
        [
            Paragraph(
                "Every table of this page is a CSV file in the folder tables, every "
                "figure a PNG, PDF and SVG "
                "file in the folder figures beside it. Statistics are seeded: the same "
                "study gives the same "
                "numbers."
            ),
            *blocks,
        ],
    )


def _identity(folder: Path) -> str:
    try:
        return str(read_json(folder / "study.json").get("study", "not recorded"))
    except (Unreadable, AttributeError):
        return "not recorded"


def _motions(sweep: Sweep) -> str:
    sources = {
        key: sorted(
            {str(row["axes"][key]) for row in sweep.rows if key in row["axes"]}, key=_natural
        )
        for key in ENSEMBLE_AXES
    }
    named = [
        f"{axis_name(key)}: "
        + ", ".join(_short(one) for one in (values if len(values) < 7 else [values[0], values[-1]]))
        + (f" and {len(values) - 2} between" if len(values) >= 7 else "")
        for key, values in sources.items()
        if values
    ]
    found = sweep.case.get("motion")
    alone = (
        [str(found["source"])]
        if not named and isinstance(found, dict) and found.get("source")
        else []
    )
    return "; ".join(named or [_short(one) for one in alone]) or "not recorded"


def _short(source: str) -> str:
    return source.rsplit("/", 1)[-1] if source.startswith("/") else source


def _natural(text: str) -> list[tuple[int, int, str]]:
    return [
        (0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"(\d+)", text)
    ]


def _engines(sweep: Sweep) -> Iterator[tuple[str, str]]:
    runs = [run for setting in sweep.done for run in setting.runs.values()]
    for key, name in (
        ("engine", "Engine"),
        ("kinematics", "Kinematics"),
        ("dofs", "Degrees of freedom of the mesh"),
        ("ranks", "Ranks an analysis"),
    ):
        found = sorted({run[key] for run in runs if run.get(key) is not None}, key=str)
        if found:
            yield name, ", ".join(str(one) for one in found)


def _recorded(sweep: Sweep) -> Iterator[tuple[str, str]]:
    """What else the ledger records of every analysis that is done: machine, hash of the motion."""
    done = [row for row in sweep.rows if row["state"] == DONE]
    for key in (key for key in (done[0] if done else {}) if key not in _KNOWN):
        found = sorted(
            {
                _digest(row[key]) if key == "motion" else str(row[key])
                for row in done
                if row.get(key) not in (None, "")
            }
        )
        if found:
            yield (
                _RECORDED.get(key, _words(key)),
                ", ".join(found)
                if len(found) < 7
                else f"{found[0]}, {found[1]} and {len(found) - 2} more",
            )


def _digest(motion: str) -> str:
    """The file of a motion by the first twelve digits of its digest, whichever of its motions was
    taken.
    """
    return motion.partition("#")[0][:12] if _DIGEST.match(motion) else motion


def _words(key: str) -> str:
    """Name of a column of the ledger as words."""
    return key.replace("_", " ").capitalize()


def _dates(sweep: Sweep) -> Iterator[tuple[str, str]]:
    started = [row["started"] for row in sweep.rows if row.get("started")]
    if started:
        first, last = (
            datetime.date.fromtimestamp(moment) for moment in (min(started), max(started))
        )
        yield (
            "Analyses begun",
            f"{first:%-d %B %Y}" if first == last else f"{first:%-d %B %Y} to {last:%-d %B %Y}",
        )


def _versions() -> Iterator[tuple[str, str]]:
    for name in _PACKAGES:
        try:
            yield name, importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue


def _flat(
    sweep: Sweep, tables: dict[str, Any] | None = None, prefix: str = ""
) -> Iterator[tuple[str, str]]:
    for key, value in (sweep.case if tables is None else tables).items():
        if isinstance(value, dict):
            yield from _flat(sweep, value, f"{prefix}{key}.")
        elif not (
            prefix + key in sweep.axes
            or prefix + key in ENSEMBLE_AXES
            or value is None
            or value == ""
        ):
            yield prefix + key, _short(f"{value:g}" if isinstance(value, float) else str(value))
