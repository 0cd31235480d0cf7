"""What fecolumn did not write is neither removed nor written over."""

import os

import h5py
import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.foundation.folder import MARK_FILE, written
from fecolumn.foundation.schema import InputError


def _files(folder):
    return sorted(str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file())


def _write(folder, *names, work="report", **more):
    with written(folder, work, **more) as draft:
        for name in names:
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_text(work)


def test_folder_with_things_of_the_user_is_refused_and_left_alone(tmp_path):
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "thesis.png").write_text("mine")
    with pytest.raises(InputError, match="not empty and holds nothing that fecolumn wrote"):
        _write(tmp_path, "figures/cdf.png", alone=True)
    assert _files(tmp_path) == ["figures/thesis.png"]


def test_only_what_was_written_before_is_removed(tmp_path):
    _write(tmp_path, "index.html", "figures/a.png", "figures/b.png", alone=True)
    (tmp_path / "figures" / "thesis.png").write_text("mine")
    _write(tmp_path, "index.html", "tables/a.csv", alone=True)
    assert _files(tmp_path) == [MARK_FILE, "figures/thesis.png", "index.html", "tables/a.csv"]
    _write(tmp_path, "figures/c.png", alone=True)
    assert (
        _files(tmp_path) == [MARK_FILE, "figures/c.png", "figures/thesis.png"]
        and not (tmp_path / "tables").exists()
    )


def test_file_of_the_user_in_the_way_is_not_written_over(tmp_path):
    (tmp_path / "table.txt").write_text("mine")
    for names in ((), ("table.txt",)):  # known only at the end, or beforehand
        with pytest.raises(InputError, match="table.txt that fecolumn did not write"):
            _write(tmp_path, "table.txt", "mesh.png", work="mesh", names=names)
    assert (tmp_path / "table.txt").read_text() == "mine" and not (tmp_path / "mesh.png").exists()


def test_works_in_one_folder_keep_apart(tmp_path):
    _write(tmp_path, "table.txt", work="mesh")
    _write(tmp_path, "comparison.csv", work="compare")
    _write(tmp_path, "other.txt", work="mesh")
    assert _files(tmp_path) == [MARK_FILE, "comparison.csv", "other.txt"]


def test_what_fails_leaves_the_folder_as_it_was(tmp_path):
    _write(tmp_path, "index.html", alone=True)
    with pytest.raises(RuntimeError), written(tmp_path, "report", alone=True) as draft:
        (draft / "index.html").write_text("half")
        raise RuntimeError
    assert (
        _files(tmp_path) == [MARK_FILE, "index.html"]
        and (tmp_path / "index.html").read_text() == "report"
    )


@pytest.mark.parametrize(
    "mark",
    [
        "[]",
        "{",
        '{"written": 3}',
        '{"written": {"report": ["../mine"]}}',
        '{"written": {"report": ["/etc/passwd"]}}',
    ],
)
def test_damaged_or_hostile_mark_is_told(tmp_path, mark):
    (tmp_path / "mine").write_text("mine")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / MARK_FILE).write_text(mark)
    with pytest.raises(InputError, match="damaged"):
        _write(tmp_path / "out", "index.html", alone=True)
    assert (tmp_path / "mine").exists()


@pytest.mark.parametrize(
    "occupy",
    [lambda path: path.write_text("mine"), lambda path: h5py.File(path, "w").close(), os.mkdir],
)
def test_ensemble_is_not_written_over_something_else(tmp_path, capsys, occupy):
    occupy(tmp_path / "mine.h5")
    before = (tmp_path / "mine.h5").stat()
    assert (
        main(
            [
                "motions",
                "make",
                "pulses",
                "one_sine",
                "--amplitudes",
                "2",
                "--periods",
                "0.5",
                "-o",
                str(tmp_path / "mine.h5"),
            ]
        )
        == 2
    )
    assert "no ensemble of motions" in capsys.readouterr().err
    assert (tmp_path / "mine.h5").stat().st_mtime_ns == before.st_mtime_ns


def test_table_of_the_user_beside_an_ensemble_is_not_written_over(tmp_path, capsys):
    (tmp_path / "records.csv").write_text("time,ax\n")
    make = [
        "motions",
        "make",
        "pulses",
        "one_sine",
        "--amplitudes",
        "2",
        "--periods",
        "0.5",
        "-o",
        str(tmp_path / "records.h5"),
    ]
    assert main(make) == 2 and "no table of an ensemble" in capsys.readouterr().err
    assert (tmp_path / "records.csv").read_text() == "time,ax\n" and not (
        tmp_path / "records.h5"
    ).exists()
    # one of an earlier version is its own
    (tmp_path / "records.csv").write_text("name,number,dt_s,length_s,pga_m_s2\n")
    assert main(make) == 0
    assert (tmp_path / "records.csv").read_text().startswith("name,number,dt_s,duration_s,")
    (tmp_path / "records.csv").unlink()
    assert main(make) == main(make) == 0  # its own it may write over


def test_fitted_model_is_not_written_over_a_case(tmp_path, capsys):
    (tmp_path / "case.toml").write_text("title = 'mine'\n")
    rows = "".join(f"{0.01 * i:.2f},{np.sin(i):.4f},{np.cos(i):.4f}\n" for i in range(1500))
    (tmp_path / "r.csv").write_text("time [s],ax [m/s2],ay [m/s2]\n" + rows)
    assert (
        main(
            [
                "motions",
                "fit",
                str(tmp_path / "r.csv"),
                "-n",
                "20",
                "--iterations",
                "1",
                "-o",
                str(tmp_path / "case.toml"),
            ]
        )
        == 2
    )
    assert (
        "no model of motions fit" in capsys.readouterr().err
        and (tmp_path / "case.toml").read_text() == "title = 'mine'\n"
    )


def test_a_command_that_ends_within_another_keeps_its_mark(tmp_path):
    with written(tmp_path, "mesh") as draft:
        (draft / "a.txt").write_text("a")
        with written(tmp_path, "render") as other:
            (other / "b.txt").write_text("b")
    with written(tmp_path, "render") as other:
        (other / "b.txt").write_text("again")
    assert _files(tmp_path) == [MARK_FILE, "a.txt", "b.txt"]
