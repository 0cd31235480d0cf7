"""Options of commands by their older names, which are read until version 2.0."""

from __future__ import annotations

import argparse
from typing import Any

from fecolumn.foundation.deprecated import warn_of_older_name


class OlderOption(argparse.Action):
    """An option by its older name, which no help lists: its value goes where that of the newer one
    does, and `older_options` of the namespace keeps both names for `tell_older_options`.

    Parameters
    ----------
    newer
        name to write.
    several
        whether the values of several are a list.
    """

    def __init__(
        self,
        option_strings: list[str],
        dest: str,
        *,
        newer: str,
        several: bool = False,
        **options: Any,
    ) -> None:
        options |= {"help": argparse.SUPPRESS, "default": argparse.SUPPRESS}
        super().__init__(option_strings, dest, **options)
        self._newer, self._several = newer, several

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        """Keep the value, and that it was given by this name."""
        before = getattr(namespace, self.dest, None) or []
        setattr(namespace, self.dest, [*before, values] if self._several else values)
        told = (parser.prog, str(option_string), self._newer)
        namespace.older_options = [*getattr(namespace, "older_options", []), told]


def tell_older_options(args: argparse.Namespace) -> None:
    """Warn of what was given by the older name of an option."""
    for where, older, newer in getattr(args, "older_options", []):
        warn_of_older_name(where, older, newer)
