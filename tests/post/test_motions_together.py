"""Fans of all motions, their paths in plan and the rose of directions."""

import struct
from types import SimpleNamespace

import numpy as np
import pytest

from fecolumn.engines.ending import OVERTURNED, SLID_OFF
from fecolumn.pictures.figures.fan_figure import Fan, fan_figure
from fecolumn.pictures.figures.plan_figure import LostDirections, plan_figure
from fecolumn.pictures.figures.style import BLUE, COLUMN_WIDTH_IN, PURPLE, VERMILION


def _trace(size: float, angle: float = 0.0, end: str = ""):
    """A motion that is moved to `size` [m] within a second and stays there two; one that is lost
    goes on growing.
    """
    time = np.linspace(0, 3, 301)
    u = size * np.minimum(time, 1) + (0.2 * np.maximum(time - 1, 0) if end else 0)
    return SimpleNamespace(
        time=time, u_top=np.column_stack([u * np.cos(angle), u * np.sin(angle)]), tilt=u, end=end
    )


def _picture(file):
    from matplotlib.image import imread

    return imread(file)[..., :3]


def _near(picture, colour, tolerance=0.06):
    from matplotlib.colors import to_rgb

    return np.abs(picture - np.array(to_rgb(colour))).max(axis=2) < tolerance


def _on_white(colour, opacity):
    from matplotlib.colors import to_rgb

    return tuple(1 - opacity * (1 - value) for value in to_rgb(colour))


def _frame(picture):
    """First and last row of pixels of the axes' frame."""
    rows = np.flatnonzero((picture < 0.35).all(axis=2).sum(axis=1) > 0.6 * picture.shape[1])
    return rows[0], rows[-1]


def test_a_fan_draws_a_motion_at_its_displacement_and_crosses_what_overturned(tmp_path):
    picture = _picture(
        fan_figure(
            [Fan("", [_trace(0.05), _trace(0.02, end=OVERTURNED)])],
            0.1,
            None,
            1,
            tmp_path / "fan",
            ("png",),
        )[0]
    )
    top, bottom = _frame(picture)
    below = picture.copy()
    below[:top] = 1  # without the legend
    level = np.flatnonzero(
        _near(below, _on_white(BLUE, 0.5), 0.25).sum(axis=1) > 0.3 * picture.shape[1]
    )
    assert (bottom - level.mean()) / (bottom - top) == pytest.approx(0.5, abs=0.01)
    cross = np.argwhere(_near(picture[top - 8 : top + 8], VERMILION))
    # one cross, on the upper edge, where it leaves the axes
    assert len(cross) > 20 and np.ptp(cross[:, 1]) < 40


def test_a_fan_of_motions_that_stood_has_no_colour_of_loss(tmp_path):
    picture = _picture(
        fan_figure(
            [Fan("", [_trace(0.05), _trace(0.03)])], 0.1, 0.08, 1, tmp_path / "fan", ("png",)
        )[0]
    )
    assert not _near(picture, VERMILION).any() and not _near(picture, PURPLE).any()


def test_small_multiples_stand_side_by_side_in_a_page_and_two_by_two_in_a_column(tmp_path):
    fans = [Fan(f"setting {k}", [_trace(0.02 + 0.01 * k)]) for k in range(5)]
    (page,) = fan_figure(fans, 0.1, None, 5, tmp_path / "page", ("png",))
    (column,) = fan_figure(
        fans, 0.1, None, 5, tmp_path / "column", ("png",), width_in=COLUMN_WIDTH_IN
    )
    (wide, low), (narrow, high) = (
        struct.unpack(">II", file.read_bytes()[16:24]) for file in (page, column)
    )
    assert wide == 1440 and narrow == 700 and high > 2 * low


def test_many_lines_are_drawn_as_an_image_and_keep_a_page_small(tmp_path):
    time = np.linspace(0, 10, 2001)
    traces = [
        SimpleNamespace(
            time=time,
            u_top=np.column_stack([0.05 * np.sin(40 * time + k), 0 * time]),
            tilt=time,
            end="",
        )
        for k in range(120)
    ]
    (svg,) = fan_figure([Fan("", traces)], 0.1, None, 1, tmp_path / "fan", ("svg",))
    assert b"data:image/png" in svg.read_bytes() and svg.stat().st_size < 2_000_000


def test_rose_shows_the_share_of_each_sector_and_none_where_nothing_was_lost(tmp_path):
    traces = [_trace(0.03), _trace(0.02, 0.1, OVERTURNED), _trace(0.02, 2.0, SLID_OFF)]
    (lost,) = plan_figure(
        traces,
        LostDirections([0.0, 5.0, -10.0], [0.0, 5.0, -10.0], "lost"),
        None,
        0.05,
        0.1,
        tmp_path / "lost",
        ("png",),
    )
    (stood,) = plan_figure(
        traces[:1], LostDirections([], [], "lost"), None, 0.05, 0.1, tmp_path / "stood", ("png",)
    )
    picture = _picture(lost)
    assert struct.unpack(">II", stood.read_bytes()[16:24])[0] < picture.shape[1] == 1440
    assert _near(picture, VERMILION).any() and _near(picture, PURPLE).any()
    # without the legend below
    sector = np.argwhere(
        _near(picture[: int(0.9 * len(picture))], _on_white(VERMILION, 0.65), 0.03)
    )
    assert len(sector) > 3000
    # the sector's tip is the middle of the rose
    middle = np.array([sector[:, 0].mean(), sector[:, 1].min()])
    angles = np.degrees(np.arctan2(middle[0] - sector[:, 0], sector[:, 1] - middle[1] + 1))
    assert np.abs(angles[sector[:, 1] > middle[1] + 30]).max() < 17
