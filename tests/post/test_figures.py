import dataclasses
import struct
from functools import partial

import numpy as np
import pytest
from synthetic_history import write_history

from fecolumn.foundation.schema import InputError
from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.cdf_figure import (
    CdfPanel,
    axis_end,
    cdf_figure,
    common,
    overturn_text,
)
from fecolumn.pictures.figures.energy_figure import energy_figure
from fecolumn.pictures.figures.history_curves import EndingMark, HistoryCurves
from fecolumn.pictures.figures.history_figures import history_figures
from fecolumn.pictures.figures.specimen_figure import specimen_figure
from fecolumn.pictures.figures.specimen_outline import specimen_outline
from fecolumn.pictures.figures.style import BLUE, PURPLE, VERMILION
from fecolumn.pictures.figures.top_figure import top_figure
from fecolumn.statistics.ecdf import ecdf


def _panel(title, n, seed):
    rng = np.random.default_rng(seed)
    samples = [rng.lognormal(-2.5, 1, n) for _ in range(5)]
    return CdfPanel(title, tuple((f"line {k}", ecdf(u, u > 0.25)) for k, u in enumerate(samples)))


def _picture(file):
    """Pixels of a PNG, (height, width, 4)."""
    from matplotlib.image import imread

    return imread(file)


@pytest.mark.long
@pytest.mark.parametrize("n, titles", [(2, ["a"]), (115, ["a", "b", "c", "d"])])
def test_cdf_figure_shows_lines_and_bands(tmp_path, n, titles):
    png, pdf = cdf_figure(
        [_panel(title, n, seed) for seed, title in enumerate(titles)], tmp_path / "cdf"
    )
    colours = np.unique(_picture(png)[..., :3].reshape(-1, 3).round(1), axis=0)
    assert len(colours) > 20 and pdf.read_bytes().startswith(b"%PDF")
    width, height = struct.unpack(">II", png.read_bytes()[16:24])
    assert width in (864, 1440) and height > 400


def _share(picture, colour, opacity=1.0) -> float:
    """Share of the picture's pixels in a colour laid on white."""
    from matplotlib.colors import to_rgb

    seen = 1 - opacity * (1 - np.array(to_rgb(colour)))
    return float(np.mean(np.abs(picture[..., :3] - seen).max(axis=2) < 0.02))


def test_band_is_as_large_as_the_distribution_says(tmp_path):
    # 1000 runs, half of them overturned, one of the others at 250 mm and all else at 10: from 10 to
    # 250 mm the band reaches 0.5 +- 0.031
    u = np.where(np.arange(1000) < 999, 0.01, 0.25)
    picture = _picture(
        cdf_figure([CdfPanel("a", (("line", ecdf(u, np.arange(1000) < 500)),))], tmp_path / "cdf")[
            0
        ]
    )
    rows, columns = np.nonzero(
        np.abs(picture[..., :3] - (1 - 0.2 * (1 - np.array([0, 0x72, 0xB2]) / 255))).max(axis=2)
        < 0.02
    )
    frame = np.nonzero((picture[..., :3] < 0.6).all(axis=2).sum(axis=1) > 300)[0]
    assert np.ptp(rows) / np.ptp(frame) == pytest.approx(0.062 / 1.02, abs=0.006)
    assert np.ptp(columns) > 0.7 * picture.shape[1]


def test_axis_of_displacements_follows_the_data_not_a_cap():
    assert (
        axis_end([0.01, 0.03]) == pytest.approx(0.0324) and axis_end([]) == axis_end([0.0]) == 1.0
    )


def test_one_peak_far_beyond_the_others_does_not_squeeze_them():
    near = list(np.linspace(0.01, 0.06, 40))
    assert common([*near, 0.78]) == near
    assert common(near) == near and common([]) == [] and common([0.0]) == [0.0]


@pytest.mark.long
def test_same_data_same_bytes(tmp_path):
    files = [cdf_figure([_panel("a", 20, 1)], tmp_path / name) for name in "pq"]
    assert all(first.read_bytes() == second.read_bytes() for first, second in zip(*files))


def test_combination_in_which_all_overturn_is_drawn(tmp_path):
    png, _ = cdf_figure(
        [CdfPanel("all", (("line", ecdf([1.0, 1.0], [True, True])),))], tmp_path / "cdf"
    )
    assert png.stat().st_size > 5000


def test_overturn_text_gives_wilsons_interval():
    assert overturn_text(ecdf(np.ones(115), np.arange(115) < 50)) == "43.5 % [34.8, 52.6]"


def test_axis_text_carries_the_unit():
    assert axis_text("integration.dt_s", 1e-3) == r"$\Delta t$ = 0.001 s"
    assert axis_text("integration.alpha_hht", -0.05) == "$\\alpha$ = \N{MINUS SIGN}0.05"
    assert axis_text("initial.tilt_rad", 0.02) == "tilt = 0.02 rad"
    assert axis_text("contact.law", "penalty") == "law = penalty"


@pytest.mark.long
@pytest.mark.parametrize("overturned", [False, True])
def test_figures_of_one_analysis(tmp_path, overturned):
    write_history(tmp_path, overturned=overturned)
    files = history_figures(tmp_path)
    assert [file.name for file in files] == [
        "u_top.png",
        "u_top.pdf",
        "path.png",
        "path.pdf",
        "energy.png",
        "energy.pdf",
    ]
    for png in files[::2]:
        assert np.mean(_picture(png)[..., :3].min(axis=2) < 0.9) > 0.01
    assert _share(_picture(tmp_path / "u_top.png"), BLUE) > 0.002
    assert (
        min(
            _share(_picture(tmp_path / "energy.png"), colour)
            for colour in (VERMILION, BLUE, PURPLE)
        )
        > 0.0005
    )


def test_history_is_read_back(tmp_path):
    write_history(tmp_path, n=11)
    history = HistoryCurves.read(tmp_path / "history.h5")
    assert (
        history.u_top.shape == (11, 3)
        and history.time[-1] == 4.0
        and set(history.energy) >= {"kinetic", "closure"}
    )


def test_folder_without_a_history_is_named(tmp_path):
    with pytest.raises(InputError, match="history.h5"):
        history_figures(tmp_path)


def test_bands_of_many_lines_stand_beside_each_other(tmp_path):
    """Five shades would hide each other and mix their colours; bars are seen in the colour of their
    line, each.
    """
    picture = _picture(cdf_figure([_panel("a", 60, 3)], tmp_path / "cdf")[0])
    from fecolumn.pictures.figures.style import LINES

    for colour, _ in LINES[:5]:
        assert _share(picture, colour, opacity=0.55) > 3e-4
        assert _share(picture, colour, opacity=0.2) < 5e-3


def test_axis_of_a_distribution_ends_a_little_beyond_its_peaks():
    assert axis_end([0.01, 0.05]) == pytest.approx(0.054) and axis_end([]) == 1.0


def _texts(draw):
    """All words of the figures that `draw` makes; they are not saved, which takes seconds."""
    from matplotlib.figure import Figure
    from matplotlib.text import Text

    found = []

    def note(figure, *args, **options):
        found.extend(text.get_text() for text in figure.findobj(Text))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", note)
        draw()
    return "\n".join(found)


def test_displacement_stands_below_the_ground_motion_and_beside_what_is_critical(tmp_path):
    write_history(tmp_path / "a")
    words = _texts(lambda: history_figures(tmp_path / "a"))
    assert (
        "ground" in words
        and "$a_x$" in words
        and "critical, $u_c$ = 76.2 mm" in words
        and "times the peak" in words
    )
    assert (
        "$u_{\\max}$ =" in words and "at rest" in words and "foot" in words and "enlarged" in words
    )
    write_history(tmp_path / "b", overturned=True)
    words = _texts(lambda: history_figures(tmp_path / "b"))
    assert (
        "overturned, stopped at" in words
        and "$u_{\\max}$ =" not in words
        and "times the peak" not in words
    )


def test_the_peak_is_that_of_all_steps_and_what_is_lost_is_marked_where_it_stopped(tmp_path):
    """The history has some of the steps; a body that falls may have been farther out before."""
    time, top = np.linspace(0.0, 4.0, 5), np.zeros((5, 3))
    top[:, 0] = [0.0, 0.01, 0.05, 0.02, 0.03]
    curves = HistoryCurves(time, top, 10 * top[:, 0], np.zeros((5, 3)), {})
    for lost, words in (
        (False, "$u_{\\max}$ = 50.12 mm\n2 s"),
        (True, "overturned, stopped at 30 mm\n4 s"),
    ):
        ending = EndingMark("overturned" if lost else "at rest", lost, None, None, 0.05012)
        assert words in _texts(partial(top_figure, curves, ending, tmp_path / "top"))


def test_the_tilt_in_a_figure_of_several_bodies_is_said_to_be_of_the_top_one(tmp_path):
    curves = HistoryCurves(np.linspace(0, 1, 3), np.ones((3, 3)), np.ones(3), np.zeros((3, 3)), {})
    for several, words in ((True, "tilt of the top body 57°"), (False, "tilt 57°")):
        ending = EndingMark("at rest", False, None, None, 1.0, several)
        assert words in _texts(partial(top_figure, curves, ending, tmp_path / "top"))


def test_every_loss_of_energy_has_a_name_and_strain_an_axis(tmp_path):
    write_history(tmp_path)
    history = HistoryCurves.read(tmp_path / "history.h5")
    more = dict.fromkeys(("damping", "links"), history.energy["impact"])
    history = dataclasses.replace(history, energy=history.energy | more)
    words = _texts(lambda: energy_figure(history, tmp_path / "energy"))
    assert all(
        name in words
        for name in (
            "strain",
            "impacts",
            "sliding friction",
            "numerical damping (HHT)",
            "taken so far by",
            "damping: modes, pads",
            "links and bonds",
        )
    )


@pytest.mark.parametrize(
    "case, words, width",
    [
        (
            {"column": {"outer_diameter_m": 0.5, "wall_m": 0.25, "height_m": 1.6}},
            "solid cylinder 500 mm",
            0.5,
        ),
        (
            {"column": {"outer_diameter_m": 0.02, "wall_m": 0.0015, "height_m": 0.15}},
            "tube 20 × 1.5 mm",
            0.02,
        ),
        (
            {"column": {"shape": "block", "length_m": 0.4, "width_m": 0.3, "height_m": 1.2}},
            "block 400 × 300 mm",
            0.4,
        ),
        (
            {
                "column": {"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 1.0},
                "flange": {"outer_diameter_m": 0.2, "thickness_m": 0.01},
            },
            "foot plate 200 mm",
            0.2,
        ),
    ],
)
def test_outline_of_any_column(tmp_path, case, words, width):
    outline = specimen_outline(case)
    assert words in outline.words and np.ptp(outline.foot[:, 0]) == pytest.approx(width)
    assert (
        specimen_figure(outline, 0.1, None, tmp_path / "specimen", ("svg",), width_in=3.5)[0]
        .stat()
        .st_size
        > 1000
    )


def test_an_own_mesh_has_no_outline():
    assert (
        specimen_outline(
            {"column": {"mesh_file": "own.msh", "outer_diameter_m": 0.5, "height_m": 1.6}}
        )
        is None
    )
