"""Docstrings as the page of the API needs them.

A class of keys has its whole help, as `help(fecolumn.Block)` prints it. Parameters that share a
description have one each, and a unit in brackets is no link of Markdown.
"""

from __future__ import annotations

import inspect
import re

import griffe

DECORATOR = "section_class"


class HelpTexts(griffe.Extension):
    """Docstrings of classes of keys from the imported class, which adds each key's meaning, unit,
    range and default; brackets in all docstrings as they stand.
    """

    def on_object(self, *, obj: griffe.Object, **kwargs) -> None:
        """Change the docstring of one object."""
        text = obj.docstring.value if obj.docstring else ""
        if obj.is_class and any(DECORATOR in str(one.value) for one in obj.decorators):
            text = inspect.cleandoc(griffe.dynamic_import(obj.path).__doc__ or "")
        if text:
            if not obj.docstring:
                obj.docstring = griffe.Docstring("", parent=obj)
            obj.docstring.value = with_brackets(one_by_one(text))


def one_by_one(text: str) -> str:
    """A docstring whose parameters "a, b" of one description are told apart, each with its type."""

    def apart(found) -> str:
        return "".join(f"{name}\n{found[2]}" for name in found[1].split(", "))

    return re.sub(r"^(\w+(?:, \w+)+)\n((?: {4}.*\n)+)", apart, f"{text}\n", flags=re.MULTILINE)


def with_brackets(text: str) -> str:
    """A docstring whose brackets stay brackets, but for types of parameters and code."""
    lines = []
    for line in text.splitlines():
        if not re.match(r"\w+ : ", line):
            parts = line.split("`")
            parts[::2] = [part.replace("[", r"\[") for part in parts[::2]]
            line = "`".join(parts)
        lines.append(line)
    return "\n".join(lines)
