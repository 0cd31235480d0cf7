"""Figures of a structure: a panel for each interface and quantity with its unit, drifts and shears
of storeys.
"""

import numpy as np
import pytest

from fecolumn.pictures.figures.structure_figures import (
    figure_names,
    interface_figure,
    link_figure,
    link_names,
    storey_figure,
    structure_figures,
)

TIME = np.linspace(0, 1, 51)


def _of_links(links: dict[str, int]) -> dict[str, np.ndarray]:
    """Columns of links with so many copies each, 1 for one that stands alone, which pull each k kN
    at k mm more; the second copy breaks at half time.
    """
    columns = {"time": TIME}
    for link, count in links.items():
        for k in range(1, count + 1):
            name, broken = (
                f"link/{link} {k}" if count > 1 else f"link/{link}",
                ((TIME > 0.5) & (k == 2)).astype(int),
            )
            columns |= {
                f"{name}/tension": 1e3 * k * TIME * (broken == 0),
                f"{name}/elongation": np.where(broken == 1, 5.0, 1e-3 * TIME),
                f"{name}/yielded": 0 * TIME,
                f"{name}/work": 0 * TIME,
                f"{name}/broken": broken,
            }
    return columns


def _columns(joints: dict[str, int], storeys: int = 0) -> dict[str, np.ndarray]:
    """Columns of a history of interfaces with so many joints each, and a building of so many
    storeys.
    """
    columns = {"time": TIME}
    for interface, count in joints.items():
        for k in range(1, count + 1):
            name = f"interface/{interface}: column {k} on slab"
            columns |= {
                f"{name}/tilt": 0.02 * k * TIME,
                f"{name}/rise": 3e-3 * TIME,
                f"{name}/slide": np.outer(TIME, [1e-5, 2e-5]),
                f"{name}/force": 4e3 * k + 0 * TIME,
            }
    for k in range(1, storeys + 1):
        columns |= {
            f"storey/house {k}/drift": np.outer(np.sin(9 * TIME), [2e-3 * k, 0.0]),
            f"storey/house {k}/shear": np.outer(np.sin(9 * TIME), [3e5 / k, 0.0]),
        }
    return columns


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Draws a figure without writing it; the figure."""
    from fecolumn.pictures.figures import structure_figures as module

    kept = []

    def keep(figure, path, formats=()):
        figure.draw_without_rendering()
        return kept.append(figure) or []

    monkeypatch.setattr(module, "save", keep)
    return lambda draw, *arguments: draw(*arguments) or kept[-1]


def test_every_interface_has_its_panels_and_every_joint_its_line(drawn):
    figure = drawn(interface_figure, _columns({"feet": 4, "heads": 3}), "", ["feet", "heads"])
    assert len(figure.axes) == 8 and [axes.get_title() for axes in figure.axes[:2]] == [
        "feet",
        "heads",
    ]
    assert [len(axes.lines) for axes in figure.axes] == [4, 3] * 4
    labels = [axes.get_ylabel() for axes in figure.axes[::2]]
    assert [label[label.index("[") :] for label in labels] == ["[mrad]", "[mm]", "[µm]", "[kN]"]
    assert figure.axes[0].lines[3].get_ydata().max() == pytest.approx(80) and figure.axes[6].lines[
        0
    ].get_ydata() == pytest.approx(4.0)
    assert figure.axes[0].get_ylim() == figure.axes[1].get_ylim()  # one scale a row
    assert [text.get_text() for text in figure.axes[7].get_legend().get_texts()] == [
        f"column {k} on slab" for k in (1, 2, 3)
    ]


def test_of_many_joints_the_one_that_moves_most_stands_out(drawn):
    figure = drawn(interface_figure, _columns({"feet": 16}), "", ["feet"])
    assert [text.get_text() for text in figure.axes[-1].get_legend().get_texts()] == [
        "16 joints",
        "column 16 on slab",
    ]
    assert len({line.get_color() for line in figure.axes[0].lines}) == 2


def test_storeys_have_drift_and_shear_along_the_axis_along_which_they_move(drawn):
    figure = drawn(storey_figure, _columns({}, storeys=3), "")
    over_time, peaks = figure.axes[0], figure.axes[3]
    assert (
        len(figure.axes) == 4
        and over_time.get_ylabel().endswith("[mm]")
        and figure.axes[2].get_ylabel().endswith("[kN]")
    )
    assert over_time.lines[2].get_ydata().max() == pytest.approx(6.0, rel=0.01)
    assert list(peaks.lines[0].get_ydata()) == [1, 2, 3] and peaks.lines[0].get_xdata()[
        0
    ] == pytest.approx(300, rel=0.01)


def test_every_link_has_its_tension_over_time_and_over_its_elongation(drawn):
    figure = drawn(link_figure, _of_links({"tendon": 4, "fuse": 1}), "", ["tendon", "fuse"])
    over_time, loops, _, fuse = figure.axes
    assert (
        over_time.get_ylabel() == "tendon\ntension $T$ [kN]"
        and loops.get_xlabel() == "elongation $e$ [mm]"
        and figure.axes[2].get_xlabel() == "time [s]"
    )
    assert [len(axes.lines) for axes in figure.axes] == [
        4,
        4,
        1,
        1,
    ] and over_time.get_ylim() == loops.get_ylim()
    assert loops.lines[3].get_ydata()[-1] == pytest.approx(4.0) and loops.lines[3].get_xdata()[
        -1
    ] == pytest.approx(1.0)
    # a loop ends where the link breaks, its tension over time goes on at nothing
    assert loops.lines[1].get_xdata().max() == pytest.approx(0.5) and len(
        over_time.lines[1].get_ydata()
    ) == len(TIME)
    assert [text.get_text() for text in loops.get_legend().get_texts()] == [
        f"tendon {k}" for k in (1, 2, 3, 4)
    ] and fuse.get_legend() is None


def test_of_many_links_the_one_that_pulls_most_stands_out(drawn):
    figure = drawn(link_figure, _of_links({"tie": 9}), "", ["tie"])
    assert [text.get_text() for text in figure.axes[1].get_legend().get_texts()] == [
        "9 links",
        "tie 9",
    ]


@pytest.mark.long
def test_links_have_files_of_three_each(tmp_path):
    columns = _of_links({"a": 1, "b": 2, "c 4d": 1, "7": 1})
    assert link_names(columns) == ["a", "b", "c 4d", "7"] and figure_names(columns) == [
        "links",
        "links_2",
    ]
    assert [file.stem for file in structure_figures(columns, tmp_path, formats=("png",))] == [
        "links",
        "links_2",
    ]


def test_more_interfaces_than_go_side_by_side_make_more_figures(tmp_path):
    columns = _columns({"a": 1, "b": 1, "c": 1, "d": 1}, storeys=1)
    files = structure_figures(columns, tmp_path, formats=("png",))
    assert (
        [file.stem for file in files]
        == figure_names(columns)
        == ["interfaces", "interfaces_2", "storeys"]
    )
    assert all(file.stat().st_size > 5000 for file in files)
