"""Arrays that compiled code uses while its caller keeps them.

numba counts the references to an array at each function that takes it, with an atomic operation. A
step of the reduced engine hands some fifty arrays down its calls: counting them took as long as all
its arithmetic on a rocking column.
"""

from __future__ import annotations

from typing import Any

import numba
from numba.core import cgutils, types
from numba.extending import intrinsic


def _without_owner(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """A value of a numba type, its arrays without the memory that counts."""
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        array.meminfo = cgutils.get_null_value(array.meminfo.type)
        array.parent = cgutils.get_null_value(array.parent.type)
        return array._getvalue()
    if isinstance(kind, types.BaseTuple):  # type: ignore[attr-defined]
        for place, part in enumerate(kind.types):
            value = builder.insert_value(
                value,
                _without_owner(context, builder, part, builder.extract_value(value, place)),
                place,
            )
    return value


@intrinsic
def _borrowed(typing: Any, whole: Any) -> tuple[Any, Any]:
    def build(context: Any, builder: Any, signature: Any, arguments: tuple[Any]) -> Any:
        return _without_owner(context, builder, signature.args[0], arguments[0])

    return whole(whole), build


def _same(whole: Any) -> Any:
    return whole


#: In compiled code: an array, or a tuple of arrays and others, to which references are not counted.
#: Only for what the caller of the compiled function holds all the time, and not to be returned to
#: Python.
borrowed = _same if numba.config.DISABLE_JIT else _borrowed
