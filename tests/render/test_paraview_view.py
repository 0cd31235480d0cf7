"""ParaView opens the fields as a time series whose names have their units, and the script sets up
the view.
"""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.engines.scene.frame_files import frame_digits, frame_name, time_of_frame

PACKAGES = "apt install --no-install-recommends paraview python3-paraview xvfb xauth"


def test_fields_are_a_time_series_with_units_in_their_names(drum):
    import pyvista

    reader = pyvista.get_reader(str(drum / "fields" / "fields.xdmf"))
    assert reader.time_values == pytest.approx(np.arange(0, 0.25, 0.04))
    reader.set_active_time_value(reader.time_values[-1])
    grid = reader.read()
    assert set(grid.point_data) == {"displacement [m]", "contact pressure [Pa]"} and set(
        grid.cell_data
    ) == {"von Mises stress [Pa]", "part", "body"}
    assert 0.01 < np.linalg.norm(grid.point_data["displacement [m]"], axis=1).max() < 1.6


def test_script_is_of_this_analysis_and_finds_its_fields_from_where_it_is(drum):
    assert main(["render", str(drum), "--paraview"]) == 0
    text = (drum / "render" / "view.py").read_text()
    compile(text, "view.py", "exec")
    assert (
        "@" not in text and str(drum) not in text and 'os.pardir, "fields", "fields.xdmf"' in text
    )
    assert (drum / "render" / ".." / "fields" / "fields.xdmf").is_file()


@pytest.mark.parametrize(
    "options, told",
    [
        (["--instants", "0.1"], "--instants: is not for --paraview"),
        (["--end", "0.1"], "--end: is not for --paraview"),
        (["--forces"], "--forces: is not for --paraview"),
        (["--gif"], "--gif: is not for --paraview"),
    ],
)
def test_what_the_script_does_not_do_is_one_line(drum, capsys, options, told):
    assert main(["render", str(drum), "--paraview", *options]) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1


def test_a_gif_is_no_picture(drum, capsys):
    assert main(["render", str(drum), "--gif", "--only", "pictures"]) == 2
    assert "--gif: is a movie; leave out --only pictures" in capsys.readouterr().err


@pytest.mark.parametrize("interval", [1.0, 0.04, 5e-7, 3e-8])
def test_names_of_frames_keep_their_times(interval):
    digits = frame_digits(interval)
    times = [0.0, interval, 7 * interval, 1234.5]
    names = [frame_name(time, digits) for time in times]
    assert names == sorted(set(names))
    assert [time_of_frame(Path(name)) for name in names] == pytest.approx(times, rel=1e-12)
    assert frame_name(0.04, frame_digits(0.04)) == "frame_000000040000.h5"


@pytest.mark.slow
@pytest.mark.skipif(
    not (shutil.which("pvbatch") and shutil.which("xvfb-run")),
    reason=f"ParaView is not installed: {PACKAGES}",
)
@pytest.mark.parametrize("source", ["files", "states"])
def test_pvbatch_draws_the_instant_asked_for(drum, source, tmp_path):
    """The drum upright in the middle, in colours of its stress, its scale beside it; from the
    fields it wrote, and from those made of its states.
    """
    from PIL import Image

    folder = shutil.copytree(
        drum,
        tmp_path / "run",
        ignore=shutil.ignore_patterns("render", *(["fields"] if source == "states" else [])),
    )
    assert main(["render", str(folder), "--paraview", "-q"]) == 0
    pictures = []
    for time in ("0", "0.2"):
        file = tmp_path / f"{time}.png"
        # a display number of this process' own: two servers that start at once may take the same
        # one
        screen = [
            "xvfb-run",
            "-a",
            "-n",
            str(1000 + os.getpid() % 8000),
            "-s",
            "-screen 0 1280x1024x24",
        ]
        done = subprocess.run(
            [*screen, "pvbatch", folder / "render" / "view.py", file, time],
            capture_output=True,
            text=True,
            timeout=300,
            env=_debians_python(),
        )
        assert done.returncode == 0 and file.is_file(), done.stderr[-2000:]
        pictures.append(np.asarray(Image.open(file).convert("RGB"), float))
    for picture in pictures:
        assert picture.shape == (720, 1280, 3)
        coloured = np.ptp(picture, axis=2) > 40  # neither white nor the grey of edges and words
        # the time stands in a corner
        assert 0.03 < coloured.mean() < 0.6 and np.abs(picture[:40, :200] - 255).max() > 100
        rows, columns = np.nonzero(coloured[:, 300:980])
        assert np.ptp(rows) > 0.6 * 720
    seen = [
        len(np.unique((picture[100:, 300:980] // 16).reshape(-1, 3), axis=0))
        for picture in pictures
    ]
    assert 2 * seen[0] < seen[1]  # released without stress, then in all colours of it
    assert np.abs(pictures[0] - pictures[1]).mean() > 0.5


def _debians_python() -> dict:
    """The environment without this one's Python: pvbatch has Debian's."""
    return {
        name: value
        for name, value in os.environ.items()
        if name not in ("PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV")
    }
