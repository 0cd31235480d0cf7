"""The axes of a study: what is multiplied with what.

[axes]                                      # full product; keys of the case, values in lists
"integration.dt_s" = [0.02, 1e-3]
# a file, one motion of a set, every motion of an ensemble, some motions of an ensemble
"motion.source" = ["a.AT2", "fema-p695:far_field/13", "ensemble.h5#*", "lick:1-40"]

[[zip]]                # lists of one length whose values go together: one factor of the product
"column.height_m" = [1.0, 1.5, 2.0]
"column.outer_diameter_m" = [0.1, 0.15, 0.2]

# random, evenly spread samples of ranges [low, high]: one factor of the product
[latin_hypercube]
samples = 50
seed = 1
"contact.friction_coefficient" = [0.2, 0.8]
"material.youngs_modulus_pa" = [1e10, 2e11, "log"]   # evenly spread in its logarithm
"""

from __future__ import annotations

import dataclasses
import math
import pickle
import typing
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fecolumn.case.case_tables import keys_beside, type_of
from fecolumn.case.model_sections import SECTIONS
from fecolumn.case.short_form import ShortForm
from fecolumn.foundation.schema import InputError, build, meant
from fecolumn.motions.chosen import chosen_motions
from fecolumn.study.keys import LatinHypercube

# A study's tables that hold axes
_TABLES = ("axes", "zip", "latin_hypercube")
_SAMPLES = tuple(field.name for field in dataclasses.fields(LatinHypercube))


@dataclass(frozen=True, slots=True)
class AxisFactor:
    """One factor of the product: keys that change together.

    Attributes
    ----------
    table
        table of the study file it stands in, for messages.
    keys
        dotted keys of the case.
    levels
        a tuple of values, one a key, for each level.
    """

    table: str
    keys: tuple[str, ...]
    levels: tuple[tuple[Any, ...], ...]


def read_factors(tables: dict[str, Any], path: Path) -> list[AxisFactor]:
    """Factors of a study file in the order axes, zip, latin_hypercube; the last changes fastest.

    Raises
    ------
    InputError
        no axis at all, unknown key, a key twice, a list that is none, lists of several lengths, a
        bad range.
    """
    if not any(name in tables for name in _TABLES):
        raise InputError(
            path,
            "axes",
            None,
            'a table of lists is needed, such as "integration.dt_s" = [0.02, 1e-3]',
        )
    factors = []
    if "axes" in tables:
        factors += [
            AxisFactor("axes", (key,), tuple((value,) for value in values))
            for key, values in _lists(tables["axes"], "axes", path).items()
        ]
        for factor in factors:
            _refuse_twice(factor, path)
    if "zip" in tables:
        zips = tables["zip"]
        if not isinstance(zips, list) or len(zips) < 2:
            factors.append(_zip(zips[0] if isinstance(zips, list) and zips else zips, "zip", path))
        else:
            factors += [_zip(one, f"zip.{number}", path) for number, one in enumerate(zips, 1)]
    if "latin_hypercube" in tables:
        factors.append(_latin_hypercube(tables["latin_hypercube"], path))
    seen: dict[str, str] = {}
    for factor in factors:
        for key in factor.keys:
            if key in seen:
                raise InputError(
                    path, f"{factor.table}.{key}", None, f"stands in {seen[key]} already"
                )
            seen[key] = factor.table
    return factors


def hint(key: str, known: Iterable[str]) -> str:
    """The nearest known key; a bare `dt` finds `integration.dt_s` by its last word."""
    begun = (
        f"; did you mean {one}?"
        for one in known
        if one.split(".")[-1].startswith(key.split(".")[-1])
    )
    return meant(key, known) or next(begun, "")


def _lists(table: dict[str, Any], name: str, path: Path) -> dict[str, tuple[Any, ...]]:
    """Lists of values by dotted key."""
    if not isinstance(table, dict) or not table:
        raise InputError(
            path,
            name,
            table,
            'a table of lists is needed, such as "integration.dt_s" = [0.02, 1e-3]',
        )
    lists = {}
    for key, values in _flat(table):
        _known(key, f"{name}.{key}", path)
        if not isinstance(values, list) or not values:
            raise InputError(path, f"{name}.{key}", values, "must be a list of at least one value")
        if key == "motion.source":
            values = [
                source
                for value in values
                for source in chosen_motions(value, f"{name}.motion.source", path)
            ]
        lists[key] = tuple(values)
    return lists


def _refuse_twice(factor: AxisFactor, path: Path) -> None:
    seen = set()
    for level in factor.levels:
        text = tuple(
            value
            if isinstance(value, (int, float)) and not isinstance(value, bool)
            else pickle.dumps(value)
            for value in level
        )
        if text in seen:
            raise InputError(
                path, f"{factor.table}.{factor.keys[0]}", level[0], "stands twice in the list"
            )
        seen.add(text)


def _zip(table: dict[str, Any], name: str, path: Path) -> AxisFactor:
    lists = _lists(table, name, path)
    first, *others = lists
    for key in others:
        if len(lists[key]) != len(lists[first]):
            raise InputError(
                path,
                f"{name}.{key}",
                list(lists[key]),
                f"must have as many values as {first}, {len(lists[first])}, has {len(lists[key])}",
            )
    return AxisFactor(name, tuple(lists), tuple(zip(*lists.values())))


def _latin_hypercube(table: dict[str, Any], path: Path) -> AxisFactor:
    """Latin hypercube of McKay, Beckman and Conover (1979), values to six digits: the same for a
    seed on any machine.
    """
    from scipy.stats import qmc

    name = "latin_hypercube"
    if not isinstance(table, dict):
        raise InputError(
            path,
            name,
            table,
            "a table is needed: samples, seed and ranges such as "
            '"contact.friction_coefficient" = [0.2, 0.8]',
        )
    build(LatinHypercube, {key: table[key] for key in _SAMPLES if key in table}, path, f"{name}.")
    ranges = {key: values for key, values in _flat(table) if key not in _SAMPLES}
    if not ranges:
        raise InputError(
            path,
            name,
            None,
            "needs a range [low, high] for a key at least, such as "
            '"contact.friction_coefficient" = [0.2, 0.8]',
        )
    kinds = {
        key: kind_of_range(key, values, f"{name}.{key}", path) for key, values in ranges.items()
    }
    draws = qmc.LatinHypercube(len(ranges), seed=table.get("seed", 0)).random(table["samples"])
    columns = [
        [_drawn(share, values, kinds[key]) for share in column]
        for (key, values), column in zip(ranges.items(), draws.T.tolist())
    ]
    return AxisFactor(name, tuple(ranges), tuple(zip(*columns)))


def kind_of_range(key: str, values: Any, told: str, path: Path | str) -> type:
    """Type, int or float, of a dotted key of a case that takes values of a range.

    Parameters
    ----------
    values
        [low, high] or [low, high, "log"].
    told, path
        the key and the file as messages name them.

    Raises
    ------
    InputError
        no such key, one that is no number, or no range.
    """
    _known(key, told, path)
    found = _known_keys().get(key) or type_of(key) or _of_model(key)
    kind = next((one for one in (found, *typing.get_args(found)) if one in (int, float)), None)
    if kind is None:
        raise InputError(
            path, told, values, "only a number has a range; give its values under [axes]"
        )
    _refuse_range(values, told, path)
    return typing.cast(type, kind)


def _refuse_range(values: Any, key: str, path: Path | str) -> None:
    numbers = values[:2] if isinstance(values, list) else []
    fits = (
        len(numbers) == 2
        and values[2:] in ([], ["log"])
        and all(
            isinstance(value, (int, float))
            and not isinstance(value, bool)
            and -1e300 < value < 1e300
            for value in numbers
        )
    )
    if not fits or not numbers[0] < numbers[1]:
        raise InputError(
            path,
            key,
            values,
            'must be a range [low, high] or [low, high, "log"] of two rising numbers',
        )
    if values[2:] and numbers[0] <= 0:
        raise InputError(path, key, values, "must be above 0 for a logarithm")


def _drawn(share: float, values: list[Any], kind: type) -> int | float:
    """Value at `share` in [0, 1) of a range; of whole numbers, each of the range gets the same
    share.
    """
    low, high = float(values[0]), float(values[1] + (1 if kind is int else 0))
    value = low * (high / low) ** share if values[2:] else low + share * (high - low)
    return math.floor(value) if kind is int else float(f"{value:.6g}")


def _flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys and values; `"a.b" = 1`, `a.b = 1` and `[a] b = 1` mean the same."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _known(key: str, told: str, path: Path | str) -> None:
    if key not in (known := _known_keys()) and type_of(key) is None and _of_model(key) is None:
        names = _keys_of_model(key.partition(".")[0]) or keys_beside(key) or tuple(known)
        raise InputError(path, told, None, f"unknown key of a case{hint(key, names)}")


def _of_model(key: str) -> Any:
    """Type of a dotted key of a rocking model's own table, such as podium.storeys, or None."""
    if key.partition(".")[0] not in SECTIONS:
        return None
    from fecolumn.case import model_table

    return model_table.model_key_type(key)


def _keys_of_model(table: str) -> tuple[str, ...]:
    """Dotted keys of a rocking model's own table; none of any other."""
    if table not in SECTIONS:
        return ()
    return tuple(f"{table}.{field.name}" for field in dataclasses.fields(SECTIONS[table]))


def _known_keys(section: Any = ShortForm, prefix: str = "") -> dict[str, type]:
    """Types by dotted keys of a case, whole sections included: an axis of sections takes tables as
    values.
    """
    keys = {}
    for name, kind in typing.get_type_hints(section).items():
        keys[prefix + name] = kind
        for inner in (kind, *typing.get_args(kind)):
            if dataclasses.is_dataclass(inner):
                keys |= _known_keys(inner, f"{prefix}{name}.")
    return keys
