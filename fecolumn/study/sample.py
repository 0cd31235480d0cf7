"""The sample of peak displacements that a user names: the folder of a study, with a choice of its
settings, or a CSV file.
"""

from __future__ import annotations

import collections
import json
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.engines.ending import cut_short, lost
from fecolumn.foundation.paths import names_record
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.experiment import read_maxima
from fecolumn.statistics.sample import Sample
from fecolumn.study.plan import ENSEMBLE_AXES, record_of
from fecolumn.study.store import DONE, read_study

# Commas between choices: one within a list or a text has no axis behind it, whose name may have
# hyphens and blanks
_BETWEEN = re.compile(r",(?=\s*[^,=\[\]{}\"']+=)")
# Axes whose files the ledger has digests of, in its order
_SOURCES = "motion.source", "motion.source_y", "motion.source_z"
# Of a digest, which tell motions of one name apart
_DIGITS = 8


def read_sample(text: str) -> Sample:
    """Sample of "results/study", "results/study@integration.dt_s=1e-3,integration.alpha_hht=-0.2"
    or "experiment.csv".

    Raises
    ------
    InputError
        neither study nor CSV, an axis or value the study does not have, settings that are not told
        apart, nothing done yet.
    """
    place, mark, choice = text.rpartition("@")
    if not mark or "=" not in choice:
        place, choice = text, ""
    if Path(place).is_dir():
        parts = _BETWEEN.split(choice)
        return _of_study(place, dict(_chosen(text, part) for part in parts if part.strip()))
    if choice:
        raise InputError(place, "", None, "no such folder; @axis=value chooses settings of a study")
    maxima = read_maxima(place)
    return Sample(
        place,
        Path(place).stem,
        {},
        maxima.motions,
        maxima.u_max,
        maxima.overturned,
        np.zeros(len(maxima.motions), bool),
    )


def _chosen(text: str, part: str) -> tuple[str, object]:
    """Key and value of "key=value"; a value that is no JSON is text."""
    key, mark, value = part.partition("=")
    if not (mark and key.strip() and value.strip()):
        raise InputError(
            text, "", None, f"{part!r}: a choice is written axis=value, several with commas between"
        )
    try:
        return key.strip(), json.loads(value)
    except ValueError:
        return key.strip(), value.strip()


def _of_study(folder: str, choice: dict[str, Any]) -> Sample:
    study = read_study(folder)
    rows = study.rows
    if not rows:
        raise InputError(
            folder,
            "",
            None,
            "its ledger holds no analysis, or is of an earlier version; run fecolumn "
            "study on this folder again",
        )
    for key, value in choice.items():
        if key not in study.axes:
            raise InputError(
                folder, key, value, f"is no axis of this study; its axes: {', '.join(study.axes)}"
            )
        rows = [row for row in rows if same_value(row["axes"][key], value)]
        if not rows:
            raise InputError(
                folder,
                key,
                value,
                f"not run with the other settings chosen; the axis has {_listed(study.axes[key])}",
            )
    for key, values in study.axes.items():
        if key not in ENSEMBLE_AXES and any(
            row["axes"][key] != rows[0]["axes"][key] for row in rows
        ):
            raise InputError(
                folder,
                key,
                None,
                f"has several values, {_listed(values)}: choose one, "
                f"{folder}@{key}={json.dumps(values[0])}",
            )
    done = [row for row in rows if row["state"] == DONE]
    if not done:
        raise InputError(folder, "", None, f"none of the {len(rows)} analyses chosen is done")
    contents = [_content_of(row) for row in done]
    motions = _told_apart([_motion_name(row["axes"]) for row in done], contents)
    summaries, shown = (
        [row["summary"] for row in done],
        {key: rows[0]["axes"][key] for key in choice},
    )
    beyond, off = (
        np.array([bool(value) for value in values])
        for values in zip(*((lost(one), one.get("slid_off")) for one in summaries))
    )
    u_max = np.where(beyond, np.nan, np.array([one["u_max_m"] for one in summaries], float))
    return Sample(
        folder,
        study.title,
        shown,
        motions,
        u_max,
        beyond,
        off,
        len(rows) - len(done),
        cut_short(summaries),
        tuple(record_of(row["axes"]) for row in done),
        tuple(contents),
    )


def _content_of(row: dict[str, Any]) -> str:
    """What the sources that are axes hold, of a row of the ledger: those that the case states are
    the same in all runs of a study, and may be others in another one that shares its motions. All
    where the first source is no axis.
    """
    contents, chosen = str(row["motion"] or "").split(), [key in row["axes"] for key in _SOURCES]
    # the ledger has the digests of all stated sources in this order, and which are is not known
    if chosen[0] and "motion" not in row["axes"] and chosen == sorted(chosen, reverse=True):
        contents = contents[: sum(chosen)]
    return " ".join(contents)


def _told_apart(names: list[str], contents: list[str]) -> tuple[str, ...]:
    """Names of motions, with the begin of the digest of what they hold where several have one."""
    counts = collections.Counter(names)
    return tuple(
        f"{name} [{content[:_DIGITS]}]" if counts[name] > 1 else name
        for name, content in zip(names, contents)
    )


def _motion_name(axes: dict[str, Any]) -> str:
    """Name of a run's motion that does not depend on where files lie: their last part, and what
    else makes the ensemble.
    """
    values = [axes[key] for key in ENSEMBLE_AXES if key in axes]
    texts = [
        value if isinstance(value, str) else json.dumps(value, sort_keys=True) for value in values
    ]
    return " ".join(
        text if names_record(text) else text.replace("\\", "/").rpartition("/")[2] for text in texts
    )


def same_value(found: Any, wanted: Any) -> bool:
    """Whether a value of an axis is the one asked for; numbers up to rounding."""
    numbers = all(
        isinstance(value, (int, float)) and not isinstance(value, bool) for value in (found, wanted)
    )
    return math.isclose(found, wanted, rel_tol=1e-9) if numbers else bool(found == wanted)


def _listed(values: Sequence[object]) -> str:
    return ", ".join(map(str, values[:8])) + (", ..." if len(values) > 8 else "")
