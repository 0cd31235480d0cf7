"""Settings of a sweep as columns and words of a report."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from fecolumn.pictures.figures.axis_text import axis_text, axis_unit
from fecolumn.study.report.document import PageColumn
from fecolumn.study.report.notation import axis_name, plain_level, setting_text
from fecolumn.study.report.sweep import Sweep

#: Characters of a setting's name in a legend, at most
_LONGEST = 60


def axis_columns(axes: Iterable[str]) -> tuple[PageColumn, ...]:
    """Columns of the levels of axes."""
    return tuple(PageColumn(axis, axis_name(axis) + _unit(axis), plain_level) for axis in axes)


def _unit(axis: str) -> str:
    """Unit of an axis as a head has it, empty of a number without one."""
    unit = axis_unit(axis)
    return "" if unit == "-" else f" [{unit}]"


def setting_words(values: dict[str, Any]) -> str:
    """Values of the other axes, nothing where there are none."""
    return setting_text(values) if values else ""


def setting_labels(sweep: Sweep) -> dict[int, str]:
    """What every setting is called in figures, by its identity: its values, or its number where
    these would be too long.
    """
    texts = [
        setting_in_figure({axis: one.values[axis] for axis in sweep.varied}) or "all analyses"
        for one in sweep.settings
    ]
    if max(map(len, texts)) > _LONGEST:
        texts = [f"setting {number}" for number in range(1, len(texts) + 1)]
    return {id(one): text for one, text in zip(sweep.settings, texts)}


def setting_in_figure(values: dict[str, Any]) -> str:
    """Values of axes as the text of a figure."""
    return ", ".join(axis_text(key, value) for key, value in values.items())
