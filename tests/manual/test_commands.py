"""Every command in README and manual is understood, and those of a walk through a page run, at
small size, in its order.
"""

import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import tomllib

import pytest
from documents import PAGES, ROOT, blocks

from fecolumn.cli import _parser, main
from fecolumn.foundation.toml_file import merge, read_toml

SHELLS = ("sh", "slurm")
COMMANDS = [
    (page, command)
    for page in PAGES
    for block in blocks(page)
    if block.language in SHELLS
    for command in block.commands
]
RUNNING = [
    page
    for page in PAGES
    if any(block.language in ("sh", "python") and not block.mark for block in blocks(page))
]
# What stands for a number in a job array
VARIABLES = {"$SLURM_ARRAY_TASK_ID": "7"}
# Pages of a minute and more, at small size
LONG = ("examples", "jobs", "quick-start")
# Programs outside of this package whose commands are read by the shell alone
FOREIGN = ("alias", "dask", "docker", "docs", "apptainer", "pytest")


def words(command: str) -> list[str]:
    """A command as its program gets it, without what only starts it."""
    for name, value in VARIABLES.items():
        command = command.replace(name, value)
    found = shlex.split(command)
    if found[0] == "mpirun":
        found = found[3:]
    return found[1:] if found[0] == "./containers/run" else found


@pytest.mark.parametrize("page", PAGES)
def test_shell_blocks_are_correct_shell(page):
    for block in blocks(page):
        if block.language in SHELLS:
            subprocess.run(["bash", "-n"], input=block.text, text=True, check=True)


@pytest.mark.parametrize("page, command", COMMANDS)
def test_every_command_is_one_of_the_program(page, command):
    program, *arguments = words(command)
    if program == "fecolumn":
        if arguments[0] != "doctor":
            _parser().parse_args(arguments)
    elif program == "python":
        assert arguments[0] == "-m" and importlib.util.find_spec(arguments[1]), command
    else:
        assert program in FOREIGN, f"{page}: {command}"


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)\)", PAGES[page].read_text(encoding="utf-8")):
        if "://" not in target:
            # a file, as the site cannot show a folder
            assert (PAGES[page].parent / target).is_file(), f"{page}: {target}"


def test_every_fenced_block_has_a_language_that_is_tested():
    for page in PAGES:
        fences = re.findall(r"^```(.*)$", PAGES[page].read_text(encoding="utf-8"), re.MULTILINE)
        assert set(fences[::2]) <= {*SHELLS, "toml", "python", "csv"}, page
        assert not any(fences[1::2]), page


# the examples are seven analyses and two studies, a minute and a half; the jobs are a minute; the
# first steps are a minute, and most of them are the README's, too
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=pytest.mark.slow)
        if page in ("examples", "jobs", "quick-start")
        else page
        for page in RUNNING
    ],
)
def test_a_page_runs_from_top_to_bottom_at_small_size(page, tmp_path, monkeypatch):
    walk(page, tmp_path, monkeypatch, small=True)


@pytest.mark.manual
@pytest.mark.parametrize("page", RUNNING)
def test_a_page_runs_from_top_to_bottom(page, tmp_path, monkeypatch):
    walk(page, tmp_path, monkeypatch, small=False)


def walk(page, folder, monkeypatch, small):
    """Write the files of a page and run its commands in `folder`."""
    asked = [command for block in blocks(page) if not block.mark for command in block.commands]
    for part in ("meshes", "benchmarks"):
        (folder / part).mkdir()
        for file in (ROOT / part).glob("*.toml"):
            shutil.copy(file, folder / part / file.name)
            if small and any(f"{part}/{file.name}" in command for command in asked):
                shrink(folder / part / file.name)
    monkeypatch.chdir(folder)
    names = {"__name__": "__main__"}
    for block in blocks(page):
        if block.mark:
            continue
        if block.language in ("toml", "csv"):
            assert block.name, f"{page}: the first line of a file says its name:\n{block.text}"
            (folder / block.name).write_text(block.text)
            if small and block.language == "toml":
                shrink(folder / block.name)
        elif block.language == "python":
            exec(compile(block.text, page, "exec"), names)  # noqa: S102  a page of this repository
        elif block.language == "sh":
            for command in block.commands:
                run(command, small)


def run(command, small):
    """Run one command of the program; others are only read."""
    program, *arguments = words(command)
    if program != "fecolumn":
        return
    for option, least in (("-j", "1"), ("-n", "2")):
        if small and option in arguments:
            arguments[arguments.index(option) + 1] = least
    assert main(arguments) == 0, command
    if small and arguments[0] == "new":
        for name in ("case.toml", "study.toml"):
            shrink(os.path.join(arguments[-1], name))


def shrink(path):
    """Make a case or a study small: two motions, a fiftieth of a second, coarse bricks; its own
    text stays beside it and is extended.
    """
    text = open(path).read()
    tables = tomllib.loads(text)
    folder, name = os.path.split(path)
    own = os.path.join(folder, f"whole-{name}")
    os.replace(path, own)
    study = "axes" in tables
    if study:
        text = re.sub(r'"lick:1-\d+"', '"lick:1-2"', text).replace("samples = 20", "samples = 2")
        with open(own, "w") as file:
            file.write(text)
        case = tables["case"]
        change = (
            ""
            if isinstance(case, str)
            else "[case.integration]\nduration_s = "
            f"0.02\n{coarse(whole(case, folder), 'case.mesh')}"
        )
    else:
        # rocking models have none
        modes = "n_modes = 3\n" if "column" in tables or "extends" in tables else ""
        change = f"[integration]\nduration_s = 0.02\n{modes}{coarse(whole(tables, folder), 'mesh')}"
    with open(path, "w") as file:
        file.write(f'extends = "whole-{name}"\n{change}')


def whole(tables, folder) -> dict:
    """Tables of a case with those of the file that it extends."""
    return (
        merge(read_toml(os.path.join(folder, tables["extends"])), tables)
        if "extends" in tables
        else tables
    )


def coarse(tables, section) -> str:
    """Sizes of bricks of a case of one column, unless it brings its mesh."""
    column = tables.get("column", {})
    if column.get("mesh_file") or not column:
        return ""
    if column.get("shape", "tube") == "tube":
        fine, around = (
            column["wall_m"],
            3.1416 * (column["outer_diameter_m"] - column["wall_m"]) / 8.1,
        )
        return (
            f"[{section}]\nfine_size_m = {fine}\ncoarse_size_m = {around}\ncap_size_m = "
            f"{around}\nbase_size_m = {around}\n"
        )
    side = column.get("outer_diameter_m") or column["width_m"]
    return (
        f"[{section}]\nfine_size_m = {side / 6}\ncoarse_size_m = {side / 4}\nbase_size_m = "
        f"{side / 4}\n"
    )
