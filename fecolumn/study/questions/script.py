"""The questions of the command line from a script or a notebook: the same names, the same folders,
the answer as an object.
"""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fecolumn.case.case import Case
from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.deprecated import renamed
from fecolumn.foundation.schema import InputError
from fecolumn.study.questions.answer import Answer, asked
from fecolumn.study.results.script import case_file, path_beside


def design(
    case: Case | str | Path,
    folder: str | Path,
    *,
    vary: tuple[str, float, float] | Mapping[str, tuple[float, float]],
    motions: str | Sequence[str],
    limit: str,
    steps: int = 64,
    jobs: int | None = None,
    retry_failed: bool = False,
) -> Answer:
    """The least or largest value of a key for which a limit state holds, as `fecolumn design`.

    Parameters
    ----------
    case
        or its file; its own motion is left out.
    folder
        of the runs and the answer; an unfinished one is gone on with.
    vary
        one key and its range in its own unit, {"bodies.cabinet.length_m": (0.3, 0.8)}, or
        ("bodies.cabinet.length_m", 0.3, 0.8).
    motions
        that every value gets, such as "lick:1-40", or several files.
    limit
        such as "P(overturn) < 0.1" or "P(top > 50 mm) < 0.1".
    steps
        of the range between which the answer lies.
    jobs
        analyses at a time, each in a process of its own; left out: one a core.
    retry_failed
        whether analyses that failed before are run again.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of each value looked at, in the key's unit:
        key, value, n (runs that ended), reached (runs beyond the limit), probability, wilson_low
        and wilson_high (its 95 % interval, over none and all of the failed analyses beyond the
        limit), failed. Its `failed` counts the analyses that failed; a size that depends on what
        they would have been is not decided, and the text says so.

    Raises
    ------
    InputError
        case, key, range, motions, limit or folder cannot be used.
    StudyError
        there is no answer: workers cannot start, the disk is full, or all analyses at a value
        failed.
    """
    from fecolumn.study.questions import design_command

    key, ends = _varied(vary)
    words = [case_file(case, folder, "fecolumn design"), "--vary", key, _range(ends)]
    words += ["--limit", limit, "--motions", *_several(motions), "--steps", str(steps)]
    words += [*_jobs(jobs), *["--retry-failed"] * retry_failed]
    return asked(design_command, words, folder, ("design.csv", "design.png"))


@renamed(limit="event")
def risk(
    source: str | Path,
    folder: str | Path,
    *,
    hazard: str | Path,
    event: str = "overturn",
    years: float = 50.0,
    site: int = 1,
) -> Answer:
    """How often a limit state is reached at a site, as `fecolumn risk`.

    Parameters
    ----------
    source
        folder of a study or of a design, a table of runs, or fragility.csv.
    folder
        for tables and figures.
    hazard
        CSV file of intensity, in the unit of the fragility's, and annual frequency of exceedance
        [1/year], or OpenQuake's export.
    event
        of a study: "overturn", "lost", "top > 50 mm" ...
    years
        time of exposure [years].
    site
        line of OpenQuake's file.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of mean annual frequency [1/year] and
        probability in `years`, with their intervals.

    Raises
    ------
    InputError
        hazard, runs or fragility cannot be used.
    """
    from fecolumn.study.questions import risk_command

    words = [str(source), "--hazard", str(hazard), "--event", event]
    words += ["--years", repr(float(years)), "--site", str(site)]
    return asked(risk_command, words, folder, ("risk.csv", "risk.png"), source)


@renamed(limit="event")
def screen(
    objects: Any,
    folder: str | Path,
    *,
    motions: str | Sequence[str],
    event: str | Sequence[str] = (),
    scale: float | Sequence[float] = 1.0,
    engine: str = "rigid",
    jobs: int | None = None,
    retry_failed: bool = False,
) -> Answer:
    """A list of objects ranked by how likely they overturn or slide, as `fecolumn screen`.

    Parameters
    ----------
    objects
        CSV file, or DataFrame, of name, width, depth, height (in _m, _cm or _mm), mass (_kg),
        friction.
    folder
        of the runs and the answer.
    motions
        that every object gets, 5 or more.
    event
        one or several, such as ["overturn", "slide > 20 mm"], of which the first ranks; left out:
        overturn and slide > 10 mm, with engine "housner" overturn and top > 10 mm.
    scale
        factor on the acceleration of the motions, or two, on their acceleration and on their time:
        (1, 2) brings motions of "lick:" to full scale.
    engine
        "rigid" or "housner".
    jobs
        analyses at a time, each in a process of its own; left out: one a core.
    retry_failed
        whether analyses that failed before are run again.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of the objects, likeliest to be lost first,
        with the probability of each event, and its interval over none and all of the failed
        analyses beyond the limit. Its `failed` counts the analyses that failed.

    Raises
    ------
    InputError
        list, motions, events or folder cannot be used.
    StudyError
        there is no answer: workers cannot start, the disk is full, or all analyses failed.
    """
    from fecolumn.study.questions import screen_command

    if hasattr(objects, "to_csv"):
        path = path_beside(folder, "-list.csv")
        write_bytes(path, objects.to_csv(index=False).encode())
        objects = path
    of_acceleration, of_time = _scales(scale)
    words = [str(objects), "--motions", *_several(motions), f"--scale={of_acceleration:.17g}"]
    words += [f"--time-scale={of_time:.17g}", "--engine", engine, *_jobs(jobs)]
    words += ["--retry-failed"] * retry_failed
    for one in _several(event):
        words += ["--event", one]
    return asked(screen_command, words, folder, ("screen.csv", "figures/ranking.png"))


def calibrate(
    case: Case | str | Path,
    folder: str | Path,
    *,
    test: str | Path,
    fit: Mapping[str, tuple[float, float]] | None = None,
) -> Answer:
    """Which values of keys fit a measured free-rocking test, as `fecolumn calibrate`.

    Parameters
    ----------
    case
        or its file; its motion is left out.
    folder
        of the runs and the answer.
    test
        CSV file of time_s and tilt_rad (or tilt_deg) from the release on.
    fit
        ranges by key, such as {"block.restitution": (0.85, 1)}; left out: as of the command.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of the keys: value, its 95 % interval, and
        whether the test identifies it.

    Raises
    ------
    InputError
        case, test, keys or folder cannot be used.
    """
    from fecolumn.study.questions import calibrate_command

    words = [case_file(case, folder, "fecolumn calibrate"), "--test", str(test)]
    for key, ends in (fit or {}).items():
        words += ["--fit", key, _range(ends)]
    return asked(calibrate_command, words, folder, ("calibrate.csv", "calibrate.png"))


def _varied(vary: Any) -> tuple[str, Any]:
    """The key that `vary` names, and its range."""
    if isinstance(vary, Mapping) and len(vary) == 1:
        ((key, ends),) = vary.items()
        return str(key), ends
    if isinstance(vary, (tuple, list)) and len(vary) == 3:
        return str(vary[0]), vary[1:]
    told = (
        "must be key, low and high of one key, such as "
        '{"bodies.cabinet.length_m": (0.3, 0.8)} or ("bodies.cabinet.length_m", 0.3, 0.8)'
    )
    raise InputError("fecolumn design", "vary", vary, told)


def _scales(scale: Any) -> tuple[float, float]:
    """Factors on acceleration and time."""
    found = (scale, 1.0) if _is_number(scale) else scale
    if isinstance(found, str) or len(found) != 2 or not all(map(_is_number, found)):
        told = "must be a number, or two: on acceleration and on time, such as (1, 2)"
        raise InputError("fecolumn screen", "scale", scale, told)
    return float(found[0]), float(found[1])


def _jobs(jobs: int | None) -> list[str]:
    return [] if jobs is None else ["-j", str(jobs)]


def _range(ends: Any) -> str:
    """LO:HI of the command line."""
    if isinstance(ends, (tuple, list)) and len(ends) == 2:
        return ":".join(repr(float(one)) if _is_number(one) else str(one) for one in ends)
    return str(ends)


def _is_number(value: Any) -> bool:
    return isinstance(value, numbers.Real)


def _several(texts: str | Sequence[str]) -> list[str]:
    return [texts] if isinstance(texts, str) else [str(one) for one in texts]
