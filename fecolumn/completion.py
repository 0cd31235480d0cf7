"""`fecolumn completion bash`: commands, options and choices completed by the Tab key, as the parser declares them."""

from __future__ import annotations

import argparse

_SCRIPT = """\
# Completion of fecolumn for bash; in ~/.bashrc: eval "$(fecolumn completion bash)"
_fecolumn() {{
    local path="" word words
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        case "$path $word" in
            {paths}) path+=" $word" ;;
        esac
    done
    case "$path" in
{cases}
    esac
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "${{COMP_WORDS[COMP_CWORD]}}")
}}
complete -o default -F _fecolumn fecolumn
"""


def add_arguments(parser) -> None:
    """Arguments of `fecolumn completion`."""
    parser.add_argument("shell", choices=("bash",), metavar="bash", help="prints the script that bash reads")


def script(parser: argparse.ArgumentParser) -> str:
    """The script for bash of a parser; names of files are completed where no word fits."""
    words = dict(_words(parser, ""))
    paths = " | ".join(f'"{path}"' for path in words if path)
    cases = "\n".join(f'        "{path}") words="{" ".join(found)}" ;;' for path, found in words.items())
    return _SCRIPT.format(paths=paths, cases=cases)


def _words(parser, path: str):
    """(path of commands, words that may follow) of a parser and of all below it."""
    options, choices, below = [], [], []
    for action in parser._actions:
        options += [option for option in action.option_strings if option.startswith("--")]
        if isinstance(action, argparse._SubParsersAction):
            below = list(action.choices.items())
            choices += [name for name, _ in below]
        elif action.choices and not action.option_strings:
            choices += action.choices
    yield path, choices + options
    for name, inner in below:
        yield from _words(inner, f"{path} {name}")
