"""Study folders whose files are damaged or displaced: one line says so, or what is damaged is made
anew, and no false figure comes out.
"""

import io
import json
import os
import shutil
import sqlite3
import subprocess
import sys

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.study.outcome import finished_outcome
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.store import Store, read_study


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A study that is done: its file, its folder, its rows."""
    folder = tmp_path_factory.mktemp("done")
    file = write_study(folder, dt=[0.02], alpha=[0, -0.2], pulses=range(3))
    return (
        file,
        folder / "out",
        complete_study(read_plan(file), folder / "out", entry=ENTRY, stream=io.StringIO()),
    )


@pytest.fixture
def study(done, tmp_path):
    """Its plan, a copy of its folder, its rows."""
    shutil.copytree(done[1], tmp_path / "out")
    return read_plan(done[0]), tmp_path / "out", done[2]


def _reopened(plan, folder):
    with Store(folder, plan, ENTRY) as store:
        return store.rows(), {analysis.id for analysis in store.missing()}


@pytest.mark.filterwarnings("ignore:.*was damaged and is made anew")
@pytest.mark.parametrize("page", [0, 1, 2, 3])
@pytest.mark.parametrize("damage", ["zeroed", "flipped"])
def test_ledger_with_a_bad_page_tells_what_the_results_tell(study, page, damage):
    plan, folder, before = study
    ledger = folder / "study.sqlite"
    data = bytearray(ledger.read_bytes())
    place = page * 4096
    if place >= len(data):
        pytest.skip("the ledger has fewer pages")
    if damage == "zeroed":
        data[place : place + 4096] = bytes(len(data[place : place + 4096]))
    else:
        for byte in range(place, min(place + 4096, len(data)), 97):
            data[byte] ^= 0x10
    ledger.write_bytes(data)
    rows, missing = _reopened(plan, folder)
    assert not missing and [row["summary"] for row in rows] == [row["summary"] for row in before]


def test_figure_of_the_ledger_that_is_not_the_results_is_put_right(study):
    plan, folder, before = study
    with sqlite3.connect(folder / "study.sqlite") as ledger:
        ledger.execute(
            "UPDATE analysis SET summary = replace(summary, '\"u_max_m\": 0', "
            "'\"u_max_m\": 9'), axes = '{}', place = 7"
        )
    assert [(row["axes"], row["summary"]) for row in _reopened(plan, folder)[0]] == [
        (row["axes"], row["summary"]) for row in before
    ]


@pytest.mark.timeout(30)
@pytest.mark.parametrize(
    "make",
    [
        os.mkfifo,
        os.mkdir,
        lambda path: os.symlink("/dev/zero", path),
        lambda path: os.symlink(path.name, path),
    ],
)
def test_what_is_in_the_place_of_the_ledger_is_put_aside(study, make):
    plan, folder, before = study
    (folder / "study.sqlite").unlink()
    make(folder / "study.sqlite")
    with pytest.raises(InputError, match="run fecolumn study on this folder again"):
        read_study(folder)
    with pytest.warns(UserWarning, match="made anew from the results"):
        rows, missing = _reopened(plan, folder)
    assert not missing and [row["summary"] for row in rows] == [row["summary"] for row in before]
    assert os.path.lexists(folder / "study.sqlite.damaged")


@pytest.mark.parametrize(
    "wrong",
    [
        "",
        "[]",
        "7",
        "null",
        "{}",
        "[" * 100_000,
        {"u_max_m": -0.01},
        {"u_max_m": None},
        {"u_max_m": "0.1"},
        {"u_max_m": True},
        '{"u_max_m": NaN}',
        {"u_max_m": 10**400},
        {"overturned": 1},
        {"case_id": "000000000000"},
        {"wall_s": []},
        {"energy_closure_rel": -1},
        {"steps": 1e999},
        {"energy_j": 3},
        {"s_per_step": {}},
        {"residual_slide_m": False},
    ],
)
def test_summary_that_is_none_is_made_again(study, wrong):
    plan, folder, before = study
    file = folder / "analyses" / before[0]["id"] / "summary.json"
    summary = json.loads(file.read_text())
    text = (
        wrong
        if isinstance(wrong, str) and wrong != '{"u_max_m": NaN}'
        else file.read_text().replace(repr(summary["u_max_m"]), "NaN")
        if isinstance(wrong, str)
        else json.dumps(summary | wrong)
    )
    file.write_text(text)
    assert finished_outcome(before[0]["id"], file.parent) is None
    rows, missing = _reopened(plan, folder)
    assert missing == {before[0]["id"]} and rows[0]["state"] == "planned"


@pytest.mark.parametrize(
    "content",
    [
        "",
        "[]",
        "7",
        "null",
        '"text"',
        "{}",
        "[" * 100_000,
        '{"study": 1, "title": 2}',
        '{"study": NaN}',
    ],
)
def test_identity_that_is_none_is_told(study, content):
    plan, folder, _ = study
    (folder / "study.json").write_text(content)
    for use in (lambda: read_study(folder), lambda: Store(folder, plan, ENTRY)):
        with pytest.raises(InputError, match="study.json: is damaged"):
            use()


@pytest.mark.timeout(30)
@pytest.mark.parametrize("name", ["study.json", "study.lock", "analyses", "logs"])
@pytest.mark.parametrize(
    "make",
    [os.mkfifo, lambda path: path.write_text("x"), lambda path: os.symlink("absent/absent", path)],
)
def test_other_things_in_the_place_of_files_and_folders_are_told(study, name, make):
    plan, folder, _ = study
    shutil.rmtree(folder / name) if (folder / name).is_dir() else (folder / name).unlink()
    make(folder / name)
    try:
        Store(folder, plan, ENTRY).close()
    except InputError as error:
        assert str(folder) in str(error) and "\n" not in str(error)
    else:
        assert name == "study.lock"  # a file, whatever was in it


def test_only_ledgers_of_drivers_are_taken_in_and_removed(study):
    plan, folder, _ = study
    shutil.copy(folder / "study.sqlite", folder / "study-0-of-2.sqlite")
    shutil.copy(folder / "study.sqlite", folder / "study-before-the-change.sqlite")
    _reopened(plan, folder)
    assert (folder / "study-before-the-change.sqlite").exists() and not (
        folder / "study-0-of-2.sqlite"
    ).exists()


def _study(study, out, *more, **environment):
    command = [
        sys.executable,
        "-m",
        "fecolumn.cli",
        "study",
        str(study),
        "-o",
        str(out),
        "-j",
        "1",
        "--entry",
        ENTRY,
        *more,
    ]
    path = os.pathsep.join(
        [*filter(None, [os.environ.get("PYTHONPATH")]), os.getcwd(), os.path.dirname(__file__)]
    )
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"PYTHONPATH": path} | environment,
    )


@pytest.mark.long
def test_folder_that_this_locale_cannot_write_is_told_in_escapes(tmp_path):
    file = write_study(tmp_path, dt=[0.02], alpha=[0], pulses=[1])
    ended = _study(file, tmp_path / "säule", LC_ALL="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0")
    assert (
        ended.returncode == 0
        and "Traceback" not in ended.stderr
        and "1 of 1 analyses done" in ended.stdout
    )
    assert (tmp_path / "säule" / "table.csv").exists()


def test_folder_name_too_long_for_the_file_system_is_told(tmp_path, capsys):
    file = write_study(tmp_path, dt=[0.02], alpha=[0], pulses=[1])
    assert main(["study", str(file), "-o", str(tmp_path / ("x" * 300)), "--entry", ENTRY]) == 2
    message = capsys.readouterr().err
    assert "File name too long" in message and message.count("\n") == 1


@pytest.fixture
def small_disk(tmp_path):
    """A file system of its own, of one megabyte."""
    (tmp_path / "disk").mkdir()
    if subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=1m", "fecolumn-test", str(tmp_path / "disk")],
        capture_output=True,
    ).returncode:
        pytest.skip("no right to mount")
    yield tmp_path / "disk"
    subprocess.run(["umount", "-l", str(tmp_path / "disk")], check=True)


def test_full_and_read_only_file_systems_are_told_and_cost_nothing(
    small_disk, tmp_path, capsys, monkeypatch
):
    file = write_study(tmp_path, dt=[0.02], alpha=[0], pulses=range(4))
    (small_disk / "filler").write_bytes(bytes(800_000))
    complete_study(read_plan(file), small_disk / "out", entry=ENTRY, stream=io.StringIO())
    before = {row["id"]: row["summary"] for row in read_study(small_disk / "out").rows}
    with open(small_disk / "filler", "ab", buffering=0) as filler, pytest.raises(OSError):
        while True:
            filler.write(bytes(4096))
    for command in (
        ["study", str(file), "-o", str(small_disk / "out"), "--entry", ENTRY, "-j", "1"],
        ["report", str(small_disk / "out")],
    ):
        assert main(command) == 1
        assert "the disk is full" in capsys.readouterr().err.splitlines()[-1]
    subprocess.run(["mount", "-o", "remount,ro", str(small_disk)], check=True)
    for command in (
        ["study", str(file), "-o", str(small_disk / "out"), "--entry", ENTRY, "-j", "1"],
        ["report", str(small_disk / "out")],
    ):
        assert main(command) == 2
        message = capsys.readouterr().err
        assert "Read-only file system" in message and message.count("\n") == 1
    assert {row["id"]: row["summary"] for row in read_study(small_disk / "out").rows} == before
