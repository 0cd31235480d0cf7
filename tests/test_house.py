"""Form, types, imports that go down, arguments of functions, names defined once."""

import ast
import collections
import graphlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from imported_modules import imports

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "fecolumn"

#: What is left to mend. These numbers may only shrink.
FOLDERS, MODULES = 12, 4
LONG_CALLS = 0
NAMES_TWICE = 0
#: Arguments of a function, self and cls left out; *args and **kwargs are one each
ARGUMENTS = 8
#: What stands beside the hidden files at the top
TOP = {
    "CITATION.cff",
    "LICENSE",
    "README.md",
    "benchmarks",
    "containers",
    "fecolumn",
    "meshes",
    "pyproject.toml",
    "tests",
}
# Each command has these two functions, each verification case the third
OF_EVERY_COMMAND_OR_CASE = {"add_arguments", "main", "run"}


def _modules():
    """Path, below the package, and syntax tree of each module."""
    for file in sorted(PACKAGE.rglob("*.py")):
        if "tutorials" not in file.parts:
            yield file.relative_to(PACKAGE), ast.parse(file.read_text(encoding="utf-8"))


def _said(*command: str) -> str:
    """What a command of the environment prints; empty where it is content."""
    done = subprocess.run(
        [str(Path(sys.executable).with_name(command[0])), *command[1:]],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    return "" if done.returncode == 0 else done.stdout + done.stderr


@pytest.mark.parametrize(
    "command",
    [
        "ruff format --check --no-cache .",
        "ruff check --no-cache --output-format concise .",
        "lint-imports --no-cache --no-logo",
        "mypy --no-incremental",
    ],
)
def test_house_rules(command):
    """Settings of all of them: pyproject.toml."""
    if command.startswith("mypy") and not np.__version__.startswith("1."):
        pytest.skip("types are checked with the NumPy and Matplotlib of Debian 12")
    if said := _said(*command.split()):
        pytest.fail(f"{command}\n{said}", pytrace=False)


def _arguments(function) -> int:
    given = function.args
    named = [one.arg for one in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    more = [one for one in (given.vararg, given.kwarg) if one]
    return len(named) + len(more) - (named[:1] in (["self"], ["cls"]))


def _is_kernel(function) -> bool:
    return any("njit" in ast.unparse(one) for one in function.decorator_list)


def test_functions_have_few_arguments():
    """Compiled kernels aside, whose arguments are arrays."""
    long = [
        f"{file}:{node.lineno} {node.name}: {_arguments(node)}"
        for file, tree in _modules()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        and _arguments(node) > ARGUMENTS
        and not _is_kernel(node)
    ]
    assert len(long) <= LONG_CALLS, "\n".join(long)


def _constants(node) -> list[str]:
    """Names in capitals that a statement of a module gives a value."""
    if isinstance(node, ast.AnnAssign):
        targets = [node.target] if node.value else []
    else:
        targets = node.targets if isinstance(node, ast.Assign) else []
    found = [one for target in targets for one in getattr(target, "elts", [target])]
    return [one.id for one in found if isinstance(one, ast.Name) and one.id.isupper()]


def test_compiled_functions_have_no_comprehension():
    """With one in a function numba (0.68) drops what it writes into arrays of a record."""
    found = [
        f"{file}:{function.lineno} {function.name}"
        for file, tree in _modules()
        for function in ast.walk(tree)
        if isinstance(function, ast.FunctionDef) and _is_kernel(function)
        for part in ast.walk(function)
        if isinstance(part, ast.ListComp | ast.GeneratorExp | ast.Lambda)
    ]
    assert not found


def test_a_public_name_is_defined_once():
    """Functions, classes, aliases of types and constants of modules, whatever the folder."""
    homes = collections.defaultdict(list)
    for file, tree in _modules():
        for node in tree.body:
            names = _constants(node)
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                names = [node.name]
            elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                name = node.targets[0].id
                names = names or [name] * name[0].isupper()
            for name in names:
                if name[0] != "_":
                    homes[name].append(str(file))
    twice = {
        name: files
        for name, files in homes.items()
        if len(files) > 1 and name not in OF_EVERY_COMMAND_OR_CASE
    }
    text = "\n".join(f"{name}: {', '.join(files)}" for name, files in sorted(twice.items()))
    assert len(twice) <= NAMES_TWICE, text


def test_there_are_few_rooms():
    """Folders and loose modules directly below the package."""
    folders = [one.name for one in PACKAGE.iterdir() if any(one.glob("*.py"))]
    modules = [one.name for one in PACKAGE.glob("*.py") if one.name != "__init__.py"]
    assert len(folders) <= FOLDERS, sorted(folders)
    assert len(modules) <= MODULES, sorted(modules)


def test_files_import_one_another_in_no_circle():
    """Imports in functions and those of types alone count, too."""
    graph = {PACKAGE / file: set(imports(PACKAGE / file, types=True)) for file, _ in _modules()}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        circle = " imports ".join(str(file.relative_to(PACKAGE)) for file in error.args[1][::-1])
        pytest.fail(circle, pytrace=False)


def test_imports_name_the_package():
    """Of relative ones the test of circles would not know."""
    relative = [
        f"{file}:{node.lineno}"
        for file, tree in _modules()
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.level
    ]
    assert relative == []


def test_the_top_level_is_fixed():
    """Of what is in version control."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("no checkout")
    names = {line.partition("/")[0] for line in listed.stdout.splitlines()}
    assert {name for name in names if not name.startswith(".")} == TOP


def test_no_two_test_files_have_one_name():
    """Test files are no packages: pytest imports them by their names alone."""
    names = collections.Counter(file.name for file in (ROOT / "tests").rglob("test_*.py"))
    assert [name for name, times in names.items() if times > 1] == []
