"""Movies, stills and the sequence figure: whole files of the length asked for, that show the
motion; and what is refused.
"""

import resource
import shutil

import numpy as np
import pytest
from rocking_analyses import BLOCK, analysed

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render import camera, command, movie
from fecolumn.pictures.render.draw import digits_of, render
from fecolumn.pictures.render.instants import chosen_instants
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result

SMALL = dict(size=(360, 240), fps=10.0)


def _pictures(file):
    import av

    with av.open(str(file)) as container:
        return [
            frame.to_ndarray(format="rgb24").astype(float) for frame in container.decode(video=0)
        ]


def test_movie_of_a_history_has_a_picture_for_each_instant_and_moves(block):
    (file,) = render(block, RenderOptions(only="movie", **SMALL), quiet=True)
    pictures = _pictures(file)
    assert (
        file == block / "render" / "motion.mp4"
        and len(pictures) == 3
        and pictures[0].shape == (240, 360, 3)
    )
    scene = [picture[20:210, :140] for picture in pictures]  # column and base alone
    assert all(np.abs(one - other).mean() > 0.5 for one, other in zip(scene, scene[1:]))
    assert np.ptp(scene[0]) > 100


def test_movie_of_fields_is_as_slow_as_asked_and_comes_as_gif(drum):
    (file,) = render(
        drum,
        RenderOptions(
            only="movie",
            gif=True,
            exaggerate="auto",
            view="foot",
            start=0.08,
            end=0.24,
            size=(360, 240),
            fps=12.5,
        ),
        quiet=True,
    )
    assert (
        file.name == "motion.gif"
        and file.read_bytes().startswith(b"GIF89a")
        and len(_pictures(file)) == 3
    )
    (file,) = render(
        drum, RenderOptions(only="movie", start=0.0, end=0.2, speed=0.5, **SMALL), quiet=True
    )
    assert len(_pictures(file)) == 5


@pytest.mark.parametrize(
    "options, pictures",
    [
        (dict(fps=30.0), 7),  # fields are every 0.04 s
        (dict(fps=25.0, speed=0.7), 8),
    ],
)
def test_a_movie_lasts_as_long_as_its_motion_whatever_the_fields_interval(drum, options, pictures):
    (file,) = render(
        drum,
        RenderOptions(only="movie", start=0.0, end=0.2, size=(320, 200), **options),
        quiet=True,
    )
    assert len(_pictures(file)) == pictures


@pytest.mark.long
def test_stills_and_sequence_of_the_instants_asked_for(drum):
    files = render(drum, RenderOptions(only="pictures", instants=(0.0, 0.11)), quiet=True)
    # the fields' instants
    assert [file.name for file in files] == [
        "sequence.pdf",
        "sequence.png",
        "still_0.000s.png",
        "still_0.120s.png",
    ]
    assert files[0].read_bytes().startswith(b"%PDF") and all(
        file.stat().st_size > 10_000 for file in files
    )


def test_names_of_stills_tell_instants_apart():
    assert digits_of([0.0, 0.0104, 0.0101]) == 4 and digits_of([0.1, 0.1, 2.0]) == 3
    assert digits_of([1e-9, 2e-9]) == 9


def test_every_view_looks_elsewhere_and_shows_the_column(block):
    result = read_result(block)
    seen = {
        view: camera.camera(result, view, result.poses[0].time, 1.5) for view in command.VIEW_NAMES
    }
    assert tuple(camera.VIEWS) == command.VIEW_NAMES
    assert seen["plan"].toward == pytest.approx([0, 0, 1]) and seen["plan"].right == pytest.approx(
        [1, 0, 0]
    )
    assert abs(seen["lean"].toward[0]) < 1e-6  # it leans towards x
    points = result.poses[0].move(result.scene.pieces[0].upright, slice(None)).reshape(-1, 3)
    for view in set(command.VIEW_NAMES) - {"foot"}:
        there = points - seen[view].focus
        assert (
            np.abs(there @ seen[view].up).max() < seen[view].half_height
            and np.abs(there @ seen[view].right).max() < 1.5 * seen[view].half_height
        )


def test_instants_are_chosen_at_peaks_within_the_time_shown(block):
    times = chosen_instants(read_result(block), 0.0, 0.2)
    # released from its largest tilt
    assert 0 < len(times) <= 5 and (np.diff(times) > 0).all() and times[0] == 0.0


@pytest.mark.parametrize(
    "options, told",
    [
        (["--instants", "0.1,9"], "--instants = 9.0: must lie between 0 and 0.2 s"),
        (["--instants", "0.1,x"], "--instants = 'x': must be times"),
        (["--start", "0.1", "--end", "0.1"], "--end = 0.1: must be later than the begin, 0.1 s"),
        (["--fps", "500"], "--fps = 500.0: must lie between 1 and 60"),
        (["--size", "1280"], "--size = '1280': must be two numbers"),
        (["--size", "400x400"], "--size = '400x400': must be 1.4 to 3 times as wide"),
        (
            ["--exaggerate", "20"],
            "--exaggerate = 20.0: needs fields or states at least every 0.06 s, and there are none",
        ),
        (["--colour", "stress"], "--colour = 'stress': needs fields or states"),
        (["--exaggerate", "0.1"], "--exaggerate = 0.1: must be auto, or lie between"),
        (["--paraview"], "--paraview: needs fields or states"),
    ],
)
def test_what_cannot_be_drawn_is_one_line_with_what_can(block, capsys, options, told):
    assert main(["render", str(block), *options]) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1


def test_unknown_view_names_the_views(block, capsys):
    with pytest.raises(SystemExit):
        main(["render", str(block), "--view", "below"])
    error = capsys.readouterr().err
    assert all(view in error for view in command.VIEW_NAMES)


def test_folders_that_hold_no_finished_analysis_say_what_they_are(block, tmp_path):
    with pytest.raises(InputError, match="no such folder"):
        render(tmp_path / "none")
    with pytest.raises(InputError, match="not a result folder"):
        render(tmp_path)
    (tmp_path / "study.json").write_text("{}")
    with pytest.raises(InputError, match="folder of a study; give that of one of its analyses"):
        render(tmp_path)
    unfinished = shutil.copytree(block, tmp_path / "unfinished")
    (unfinished / "summary.json").unlink()
    with pytest.raises(InputError, match="has not ended .*fecolumn resume"):
        render(unfinished)


@pytest.mark.long
def test_interrupted_movie_leaves_what_was_there(tmp_path, monkeypatch, capsys):
    folder = analysed(BLOCK, tmp_path / "run")
    render(folder, RenderOptions(only="movie", **SMALL), quiet=True)
    before = (folder / "render" / "motion.mp4").read_bytes()
    add = movie.Movie.add

    def interrupted(self, picture):
        add(self, picture)
        raise KeyboardInterrupt

    monkeypatch.setattr(movie.Movie, "add", interrupted)
    assert main(["render", str(folder), "--only", "movie", "--size", "360x240", "-q"]) == 130
    assert "nothing was written" in capsys.readouterr().err
    assert {file.name for file in (folder / "render").iterdir()} == {".fecolumn.json", "motion.mp4"}
    assert (folder / "render" / "motion.mp4").read_bytes() == before


def test_full_disk_is_told_and_leaves_nothing(tmp_path, capsys):
    from mpi4py import MPI  # noqa: F401  (it starts with files larger than those allowed below)

    folder = analysed(BLOCK, tmp_path / "run")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, limits[1]))
    try:
        assert main(["render", str(folder), "--only", "movie", "--size", "360x240", "-q"]) == 1
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "the disk is full" in capsys.readouterr().err
    assert {file.name for file in (folder / "render").iterdir()} <= {".fecolumn.json"}


def test_displacement_colours_the_points_of_a_tube_that_has_as_many_points_as_faces(tmp_path):
    from fecolumn.pictures.render.canvas import Canvas
    from fecolumn.pictures.render.frames import Frames

    tube = BLOCK | {
        "column": {"outer_diameter_m": 0.2, "wall_m": 0.02, "height_m": 0.6},
        "mesh": {"fine_size_m": 0.02, "coarse_size_m": 0.06, "base_size_m": 0.2},
    }
    result = read_result(
        analysed(tube | {"integration": {"engine": "rigid", "duration_s": 0.02}}, tmp_path / "run")
    )
    surface = result.scene.surface
    # of a torus, what a tube's surface is; both have a value for each
    assert len(surface.nodes) == len(surface.faces)
    frames = Frames(result, np.array([0.0]), 0.04)
    with Canvas(frames, camera.camera(result, "lean", frames.times, 1.0), (128, 128)) as scene:
        assert (
            scene._bodies.point_data["colour"] == pytest.approx(frames.frame(0).colour)
            and "colour" not in scene._bodies.cell_data
        )
