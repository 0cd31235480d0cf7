"""Work trees of the table over versions."""

import subprocess

import pytest

from benchmarks import versions


def test_a_commit_is_checked_out_and_goes():
    with versions.checked_out("HEAD") as tree:
        assert (tree / "meshes" / "specimen.toml").exists()
    assert not tree.exists()
    listed = ["git", "-C", str(versions.ROOT), "worktree", "list"]
    shown = subprocess.run(listed, capture_output=True, text=True, check=True).stdout
    assert str(tree) not in shown


def test_an_unknown_commit_is_named_and_the_table_printed(capfd):
    with pytest.raises(SystemExit, match="1 of 1 commits"):
        versions.main(["no-such-commit"])
    printed, told = capfd.readouterr()
    assert "no-such-commit is left out" in told
    assert printed.startswith("| version | commit |")
