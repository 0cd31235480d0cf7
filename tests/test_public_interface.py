"""The public interface, in public_interface.txt: names of `fecolumn` with their signatures, and
commands with their arguments. Keys are tested by keys.md, files of results by outputs.md.

Where it is meant to change: `python tests/test_public_interface.py` writes the file anew, and the
changelog tells what changed.
"""

import argparse
import inspect
import re
import types
from pathlib import Path

import pytest

import fecolumn
from fecolumn.cli import _parser
from fecolumn.foundation.deprecated import warn_of_older_name

FILE = Path(__file__).with_name("public_interface.txt")
#: Classes that are returned and not made by others: their attributes and methods count
RETURNED = "AnalysisPlots Answer Ecdf GroundMotion Parting Picture QuantityPair StudyPlots".split()
#: Methods and properties of cases and sections that the program has for itself
INTERNAL = set(
    "as_drawn as_stated copies copies_of deforms drawn found interior_points is_held "
    "longest_free_vibration_s mean_radius_m meant_by modes_of moves n_modes names_of of of_several "
    "outer_diameter_m places points_inside row_interval_s seat_m shortest_s state_interval_s "
    "step_is_chosen tables top_m".split()
)


def interface() -> str:
    """One line for each public name, for each attribute, method and property of a class, and for
    each command.
    """
    lines = []
    for name in fecolumn.__all__:
        found = getattr(fecolumn, name)
        call = found.__init__ if inspect.isclass(found) else found
        own = isinstance(call, types.FunctionType)  # not that of Python's exceptions
        lines.append(f"{name}{inspect.signature(found) if own and name not in RETURNED else ''}")
        if inspect.isclass(found):
            lines += [f"    {line}" for line in sorted({*_attributes(found), *_members(found)})]
    lines += [f"$ {line}" for line in _commands(_parser())]
    return re.sub(" at 0x[0-9a-f]+", "", "\n".join(lines)) + "\n"


def _attributes(cls) -> list[str]:
    """Names that a docstring has below Attributes."""
    _, _, told = inspect.cleandoc(cls.__doc__ or "").partition("Attributes\n----------\n")
    told = told.partition("\n\n")[0]
    names = [line for line in told.splitlines() if line and not line.startswith(" ")]
    return [name for line in names for name in line.split(", ")]


def _commands(parser: argparse.ArgumentParser) -> list[str]:
    """Name of a command and its arguments, with what they may be; of one that has some below it,
    theirs.
    """
    words, lines = [parser.prog], []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            lines += [line for one in action.choices.values() for line in _commands(one)]
        elif action.dest != "help":
            one = ", ".join(action.option_strings) or str(action.metavar or action.dest)
            may_be = f" {'|'.join(map(str, action.choices))}" if action.choices else ""
            words.append(f"[{one}{may_be}]" if not action.required else one + may_be)
    return lines or [" ".join(words)]


def _is_public(name: str) -> bool:
    return not name.startswith("_") and name not in INTERNAL


def _members(cls) -> list[str]:
    """Public methods and properties that a class of this package defines."""
    found = {}
    for base in reversed(cls.__mro__):
        if base.__module__.startswith("fecolumn"):
            found |= {name: one for name, one in vars(base).items() if _is_public(name)}
    lines = []
    for name, one in sorted(found.items()):
        if isinstance(one, property) or type(one).__name__ == "cached_property":
            lines.append(name)
        elif isinstance(one, types.FunctionType | classmethod | staticmethod):
            lines.append(f"{name}{inspect.signature(getattr(cls, name))}")
    return lines


def test_public_names_and_signatures_are_those_that_are_written_down():
    written = FILE.read_text(encoding="utf-8").splitlines()
    now = interface().splitlines()
    gone = [line for line in written if line not in now]
    new = [line for line in now if line not in written]
    assert written == now, (
        f"gone: {gone}; new: {new}; see the head of {Path(__file__).name}, and tell it in the "
        "changelog"
    )


def test_the_site_leaves_out_what_the_program_has_for_itself():
    site = FILE.parents[1] / "containers" / "docs" / "mkdocs.yml"
    (left_out,) = re.findall(r'"!\^\((.*?)\)\$"', site.read_text(encoding="utf-8"))
    assert left_out.split("|") == sorted(INTERNAL)


def test_every_public_name_has_a_docstring():
    assert [name for name in fecolumn.__all__ if not getattr(fecolumn, name).__doc__] == []


def test_public_classes_and_functions_have_their_public_names():
    assert [n for n in fecolumn.__all__ if getattr(fecolumn, n).__name__ != n] == []


def test_older_names_are_read_and_say_which_to_write():
    warn_of_older_name.cache_clear()
    with pytest.warns(DeprecationWarning, match="write fecolumn.load_case"):
        assert fecolumn.read_case is fecolumn.load_case
    with pytest.warns(DeprecationWarning, match="write jobs"), pytest.raises(fecolumn.InputError):
        fecolumn.run_study("missing.toml", "missing", workers=2)


if __name__ == "__main__":
    FILE.write_text(interface(), encoding="utf-8")
