"""The table of outcomes: very many analyses as columns, in an HDF5 file that has its data
dictionary in itself.

A column is a dataset below /columns, compressed, with the attributes `meaning`, `unit` and, of
words, `words`, of which it holds the places. The file's attributes tell what made it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.atomic import write_hdf5
from fecolumn.foundation.deprecated import by_name
from fecolumn.foundation.files import is_file
from fecolumn.foundation.schema import InputError

if TYPE_CHECKING:
    import pandas

#: The table that comes with the package.
PACKAGED = Path(__file__).with_name("outcomes.h5")
_COLUMNS, _MAKER = "columns", "python -m benchmarks.outcomes"
#: Bits of the mantissa that are kept: five digits.
_BITS = 16


class TableColumn(NamedTuple):
    """What a column is.

    Attributes
    ----------
    meaning
        in words.
    unit
        "-" where it has none.
    words
        that a column of words takes its values from, in the order of their places.
    """

    meaning: str
    unit: str = "-"
    words: tuple[str, ...] = ()


@by_name("file")
def outcomes(*, file: str | Path | None = None) -> pandas.DataFrame:
    """Outcomes of very many analyses: bodies that slide, rock and fall, one row an analysis.

    A row has geometry, friction, stiffness and the motion's intensity measures, the outcome, the
    peak, and whether it is censored: of what was lost, a peak is a lower bound. `attrs["columns"]`
    of the frame is the data dictionary, name to meaning and unit; `attrs["made"]` tells the
    version, PHYSICS, commit, date, machine and command. The analyses are of four kinds of model,
    told by `model`, which are not to be mixed without thought.

    Parameters
    ----------
    file
        one that `python -m benchmarks.outcomes` of a checkout wrote; left out: the table that
        comes with the package.

    Returns
    -------
    DataFrame; words are categories, what a model does not have is nan.

    Raises
    ------
    InputError
        the file cannot be read or is no table of outcomes.

    Examples
    --------
    A fragility surface over PGV and size, by statsmodels::

        import numpy as np, statsmodels.api as sm, fecolumn

        table = fecolumn.outcomes()
        rigid = table[table.model == "rigid body"]
        x = sm.add_constant(np.log(rigid[["pgv_m_s", "height_m", "slenderness_rad"]]))
        surface = sm.Probit(rigid.outcome == "overturned", x).fit()
        print(surface.summary())
    """
    import h5py
    import pandas

    path = PACKAGED if file is None else Path(file)
    if not is_file(path):
        raise InputError(path, "", None, f"is no file; {_MAKER} of a checkout makes one")
    try:
        with h5py.File(path) as stored:
            if _COLUMNS not in stored:
                raise InputError(
                    path, _COLUMNS, None, f"is missing: no table of outcomes; {_MAKER} makes one"
                )
            made = {name: str(value) for name, value in stored.attrs.items()}
            values, about = {}, {}
            for name in json.loads(made.pop("order")):
                dataset = stored[_COLUMNS][name]
                about[name] = {key: str(dataset.attrs[key]) for key in ("meaning", "unit")}
                values[name] = dataset[:]
                if words := json.loads(dataset.attrs["words"]):
                    values[name] = pandas.Categorical.from_codes(values[name], words)
        frame = pandas.DataFrame(values)
    except InputError:
        raise
    except OSError as error:
        raise InputError(path, "", None, f"is no HDF5 file ({error})") from None
    except (KeyError, ValueError, TypeError):  # other data below the same name
        raise InputError(path, "", None, f"is no table of outcomes; {_MAKER} makes one") from None
    frame.attrs.update(columns=about, made=made)
    return frame


def write_outcomes(
    path: Path,
    rows: Sequence[Mapping[str, Any]],
    columns: Mapping[str, TableColumn],
    made: Mapping[str, Any],
) -> None:
    """Write a table of outcomes.

    Parameters
    ----------
    path
        of the file.
    rows
        one an analysis; what a row lacks is nan, of whole numbers -1.
    columns
        by name, in their order; a column of words takes words or their places.
    made
        what made it, by name.

    Raises
    ------
    ValueError
        a row has what no column tells.
    """
    if odd := {name for row in rows for name in row} - set(columns):
        raise ValueError(f"{', '.join(sorted(odd))}: in no column of the table of outcomes")

    def fill(stored: Any) -> None:
        stored.attrs.update({**made, "order": json.dumps(list(columns))})
        group = stored.create_group(_COLUMNS)
        for name, column in columns.items():
            data = _array([row.get(name) for row in rows], column)
            dataset = group.create_dataset(
                name, data=data, compression="gzip", compression_opts=9, shuffle=True
            )
            dataset.attrs.update(
                meaning=column.meaning, unit=column.unit, words=json.dumps(column.words)
            )

    write_hdf5(path, fill)


def _array(values: list[Any], column: TableColumn) -> NDArray[Any]:
    if column.words:
        places = {word: place for place, word in enumerate(column.words)}
        return np.array([places.get(value, value) for value in values], np.int8)
    if all(isinstance(value, bool) for value in values):
        return np.array(values, bool)
    if all(value is None or isinstance(value, int) for value in values):
        return np.array([-1 if value is None else value for value in values], np.int32)
    numbers = np.array([np.nan if value is None else value for value in values], np.float32)
    return _short(numbers)


def _short(numbers: NDArray[Any]) -> NDArray[Any]:
    """Floats (n,) rounded to _BITS of their mantissa, which compress better."""
    spare = 23 - _BITS
    bits = numbers.view(np.uint32)
    rounded = (bits + np.uint32(1 << (spare - 1))) & np.uint32(0xFFFFFFFF << spare & 0xFFFFFFFF)
    return np.where(np.isfinite(numbers), rounded.view(np.float32), numbers)
