"""What compiled functions take, by name."""

from __future__ import annotations

from typing import Any, TypeAlias

from numpy.typing import NDArray

#: An array; the docstrings tell its shape and unit.
Array: TypeAlias = NDArray[Any]
#: One element of an array of records, whose fields are its attributes.
Record: TypeAlias = Any
