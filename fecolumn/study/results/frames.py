"""Libraries that are not needed but where they are installed."""

from __future__ import annotations

import importlib


def installed(name: str, use: str):
    """The module `name`.

    Raises
    ------
    ImportError
        it is not installed; the message tells how it is, and what for.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError(
            f"{use} needs {name}, which is not installed: pip install {name}"
        ) from None
