"""Files written by several processes at once, and things made once."""

import os
import resource
import subprocess
import sys

import pytest

from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.lock import alone

_WRITE = """
import sys
from pathlib import Path
from fecolumn.foundation.atomic import write_bytes
for turn in range(200):
    write_bytes(Path(sys.argv[1]), sys.argv[2].encode() * 20_000)
"""
_MAKE = """
import os, sys, time
from pathlib import Path
from fecolumn.foundation.lock import alone
target = Path(sys.argv[1])
with alone(target):
    if not target.exists():
        with open(sys.argv[2], "a") as made:
            made.write("made\\n")
        time.sleep(0.2)
        target.touch()
"""


def _all(code, *arguments):
    processes = [
        subprocess.Popen([sys.executable, "-c", code, *map(str, given)], stderr=subprocess.PIPE)
        for given in zip(*arguments)
    ]
    return [process.communicate(timeout=120)[1].decode() for process in processes]


def test_processes_that_write_one_file_at_once_do_not_hinder_each_other(tmp_path):
    assert _all(_WRITE, [tmp_path / "x"] * 3, "abc") == ["", "", ""]
    content = (tmp_path / "x").read_bytes()
    assert len(content) == 20_000 and len(set(content)) == 1  # of one of them, whole
    assert os.listdir(tmp_path) == ["x"]


def test_failed_write_keeps_the_old_file_and_leaves_nothing_behind(tmp_path):
    write_bytes(tmp_path / "x", b"old")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        with pytest.raises(OSError):
            write_bytes(tmp_path / "x", bytes(5000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert os.listdir(tmp_path) == ["x"] and (tmp_path / "x").read_bytes() == b"old"


def test_file_has_the_rights_of_any_new_file(tmp_path):
    before = os.umask(0o027)
    try:
        write_bytes(tmp_path / "x", b"")
    finally:
        os.umask(before)
    assert (tmp_path / "x").stat().st_mode & 0o777 == 0o640


def test_longest_name_that_the_file_system_takes_can_be_written(tmp_path):
    write_bytes(tmp_path / ("x" * 255), b"y")
    assert (tmp_path / ("x" * 255)).read_bytes() == b"y"


def test_what_is_made_once_is_made_once_whoever_wants_it(tmp_path):
    assert _all(_MAKE, [tmp_path / "thing"] * 4, [tmp_path / "made"] * 4) == [""] * 4
    assert (tmp_path / "made").read_text() == "made\n" and sorted(os.listdir(tmp_path)) == [
        "made",
        "thing",
    ]


@pytest.mark.timeout(10)
def test_pipe_in_the_place_of_a_lock_is_told(tmp_path):
    os.mkfifo(tmp_path / ".thing.lock")
    with pytest.raises(OSError, match="device or a pipe"):
        with alone(tmp_path / "thing"):
            pass
