"""What earlier versions called otherwise or took by position is read until 2.0, and a script is
told in the line where it stands.
"""

import inspect
import os
import subprocess
import sys
from pathlib import Path

import pytest

from fecolumn.foundation.deprecated import by_name, renamed, warn_of_older_name

CASE = """
[bodies.block]
kind = "block"
length_m = 0.3
width_m = 0.3
height_m = 1.2
[{table}.foot]
between = ["block", "ground"]
"""


def said_by(script: Path) -> str:
    """What a script says on stderr with Python's own filters."""
    plain = {key: value for key, value in os.environ.items() if key != "PYTHONWARNINGS"}
    done = subprocess.run(
        [sys.executable, script], env=plain, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return done.stderr


def test_a_script_is_told_of_interfaces_in_its_own_line(tmp_path):
    (tmp_path / "old.toml").write_text(CASE.format(table="interfaces"))
    (tmp_path / "new.toml").write_text(CASE.format(table="joints"))
    script = tmp_path / "script.py"
    script.write_text(
        "import fecolumn\n"
        f"fecolumn.load_case({str(tmp_path / 'old.toml')!r})\n"
        f"case = fecolumn.load_case({str(tmp_path / 'new.toml')!r})\n"
        'case.replace({"interfaces.foot.friction_coefficient": 0.4})\n'
        "fecolumn.read_case\n"
    )
    told = said_by(script)
    for line, newer in ((2, "[joints]"), (4, "joints.foot.friction"), (5, "fecolumn.load_case")):
        assert f"{script}:{line}: DeprecationWarning: " in told
        assert f"write {newer}" in told


def test_a_package_that_uses_an_older_name_is_not_told_of_to_its_users(tmp_path):
    (tmp_path / "other.py").write_text("import fecolumn\nfecolumn.read_case\n")
    (tmp_path / "script.py").write_text("import other\n")
    assert "DeprecationWarning" not in said_by(tmp_path / "script.py")


@by_name("width", "height")
def area(length, *, width=1.0, height=1.0):
    return length * width * height


def test_arguments_by_position_are_taken_and_told_of_by_their_names():
    with pytest.warns(DeprecationWarning, match="of area .* write (width|height)=") as told:
        assert area(2.0, 3.0, 4.0) == 24.0
    assert [Path(one.filename) for one in told] == [Path(__file__)] * 2
    assert area(2.0, width=3.0) == 6.0
    for wrong in (lambda: area(1, 2, 3, 4), lambda: area(1, 2, width=2)):
        with pytest.raises(TypeError, match="positional"):
            wrong()


@renamed(wide="width")
@by_name("width")
def width_of(*, width=1.0):
    return width


def test_arguments_by_their_older_names_are_taken():
    with pytest.warns(DeprecationWarning, match="wide of width_of .* write width") as told:
        assert width_of(wide=3.0) == 3.0
    assert [Path(one.filename) for one in told] == [Path(__file__)]
    assert str(inspect.signature(width_of)) == "(*, width=1.0)"
    with pytest.raises(TypeError, match="got width and its older name wide"):
        width_of(wide=3.0, width=2.0)


def test_a_name_is_told_of_once_and_where_it_stands():
    with pytest.warns(DeprecationWarning) as told:
        for _ in range(2):
            warn_of_older_name("a test", "older", "newer")
    assert [Path(one.filename) for one in told] == [Path(__file__)]
