"""Refusals that are errors of Python's own kind besides, as earlier versions raised them."""

from __future__ import annotations

from fecolumn.foundation.schema import InputError


class UnknownName(InputError, KeyError):
    """A name that is none of those that are there, which the message lists."""

    def __str__(self) -> str:
        """The message as it is; KeyError would put it in quotes."""
        return str(self.args[0])


class UnreadableFile(InputError, OSError):
    """A file that is not there, or that cannot be read as what it should be."""

    def __str__(self) -> str:
        """The message as it is; OSError has one of its own."""
        return str(self.args[0])


class OutOfRange(ValueError):
    """An argument outside its range.

    Attributes
    ----------
    name, value, must
        the argument, what was given, and what it must be, such as "lie in [4, 8]".
    """

    def __init__(
        self, name: str, value: object, must: str, unit: str = "", message: str = ""
    ) -> None:
        said = f"{value:g}" if isinstance(value, (int, float)) else repr(value)
        super().__init__(message or f"{name} = {said}{unit and ' '}{unit} must {must}")
        self.name, self.value, self.must = name, value, must
