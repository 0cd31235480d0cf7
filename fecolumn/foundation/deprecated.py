"""Names and call forms of earlier versions that are still read, each said once."""

from __future__ import annotations

import functools
import inspect
import sys
import typing
import warnings
from collections.abc import Callable
from pathlib import Path

#: what each warning has, by which `fecolumn` shows it although Python hides its category
TOLD = "is an older name"

_PACKAGE = str(Path(__file__).parents[1])
# modules of Python that call in the place of whoever asked, and imports among them
_BETWEEN = "importlib._bootstrap", "functools", "contextlib"
_Parameters = typing.ParamSpec("_Parameters")
_Returned = typing.TypeVar("_Returned")


@functools.cache
def warn_of_older_name(where: str, older: str, newer: str) -> None:
    """Tell once in a process, by a DeprecationWarning, that a name is read until version 2.0 only,
    and which one to write.

    The warning is of the line outside of this package that gave the name: Python shows those of a
    script or a notebook, and hides those of other packages.

    Parameters
    ----------
    where
        file or call in which it stands.
    older, newer
        the two names.
    """
    _warn(f"{where}: {older} {TOLD} of {newer}, read until 2.0; write {newer}")


@functools.cache
def _warn_of_position(function: str, name: str) -> None:
    _warn(f"script: {name} of {function} is read by position until 2.0; write {name}=...")


def by_name(
    *names: str,
) -> Callable[[Callable[_Parameters, _Returned]], Callable[_Parameters, _Returned]]:
    """Decorator of a function whose last arguments are given by name alone: those of `names`, in
    this order, are taken by position as well, as in earlier versions, with a warning.
    """

    def decorated(
        function: Callable[_Parameters, _Returned],
    ) -> Callable[_Parameters, _Returned]:
        n_first = inspect.unwrap(function).__code__.co_argcount

        @functools.wraps(function)
        def called(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Returned:
            older = dict(zip(names, args[n_first:]))
            if len(args) > n_first + len(names) or not older.keys().isdisjoint(kwargs):
                return function(*args, **kwargs)  # Python's own TypeError
            for name in older:
                _warn_of_position(function.__name__, name)
            plain: typing.Any = function  # what type checkers are to know is its signature
            returned: _Returned = plain(*args[:n_first], **older, **kwargs)
            return returned

        return called

    return decorated


def renamed(
    **newer: str,
) -> Callable[[Callable[_Parameters, _Returned]], Callable[_Parameters, _Returned]]:
    """Decorator of a function that takes arguments by their older names as well, with a warning;
    newer: name of this version by the older one.
    """

    def decorated(
        function: Callable[_Parameters, _Returned],
    ) -> Callable[_Parameters, _Returned]:
        @functools.wraps(function)
        def called(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Returned:
            given = dict(kwargs)
            for older in [one for one in kwargs if one in newer]:
                name = newer[older]
                if name in given:
                    raise TypeError(f"{function.__name__}() got {name} and its older name {older}")
                warn_of_older_name("script", f"{older} of {function.__name__}", name)
                given[name] = given.pop(older)
            plain: typing.Any = function
            returned: _Returned = plain(*args, **given)
            return returned

        return called

    return decorated


def _warn(told: str) -> None:
    """A DeprecationWarning of the first line of the calls that is none of this package."""
    frame = sys._getframe(1)
    while frame.f_back and _is_between(frame.f_code.co_filename, frame.f_globals):
        frame = frame.f_back
    module = frame.f_globals.get("__name__", "")
    known = frame.f_globals.setdefault("__warningregistry__", {})
    warnings.warn_explicit(
        told, DeprecationWarning, frame.f_code.co_filename, frame.f_lineno, module, known
    )


def _is_between(file: str, names: dict[str, typing.Any]) -> bool:
    """Whether a frame is one of this package, a method that Python has made for it included, or of
    Python's own between it and who calls.
    """
    module = str(names.get("__name__", ""))
    return (
        module == "fecolumn"
        or module.startswith("fecolumn.")
        or file.startswith(_PACKAGE)
        or module.startswith(_BETWEEN)
    )
