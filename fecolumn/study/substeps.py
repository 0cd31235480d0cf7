"""What a step is where it is made in parts, which every statement on the effect of integration.dt_s
needs beside it.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

_STEP, _SUBSTEPS = "integration.dt_s", "integration.substeps"
_ROLLING = "rolling"  # a case's default
_CAUSES = {_ROLLING: "in which a round rim rolls fast", "impacts": "in which a point lands"}

#: Axis values of a setting, and the summary of each of its analyses by motion
SettingTables = tuple[dict[str, Any], dict[tuple[str, ...], dict[str, Any]]]


def substeps_note(tables: dict[str, Any], settings: Iterable[SettingTables]) -> str:
    """That the step is not always the one that is asked for, where settings of several
    integration.dt_s made parts of steps; else "".

    Parameters
    ----------
    tables
        of a case that the analyses share, by section; what it leaves open is at its default.
    settings
        as of `conclusion.settings_of`.
    """
    integration = tables.get("integration")
    default = integration.get("substeps", _ROLLING) if isinstance(integration, dict) else _ROLLING
    counted: dict[Any, dict[Any, list[Any]]] = {}
    for values, runs in settings:
        counts = counted.setdefault(values.get(_SUBSTEPS, default), {}).setdefault(
            values.get(_STEP), []
        )
        counts += [(run.get("parts", 0), run["steps"]) for run in runs.values() if "steps" in run]
    said = []
    for word, of_steps in counted.items():
        means = {dt: np.mean(counts, axis=0) for dt, counts in of_steps.items() if counts}
        if word not in _CAUSES or len(means) < 2 or not any(parts for parts, _ in means.values()):
            continue
        told = ", ".join(
            f"{parts:.0f} beside {steps:.0f} steps at dt_s = {dt}"
            for dt, (parts, steps) in means.items()
        )
        said.append(
            f"dt_s is not always the step that was taken: a step {_CAUSES[word]} is "
            f"made in parts, a motion has {told} "
            f'(integration.substeps = "{word}"; "none" takes the step that is asked for).'
        )
    return " ".join(said)
