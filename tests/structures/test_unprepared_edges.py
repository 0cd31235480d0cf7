"""Bodies that slide to an edge of the face below them on which their joint has no contact points:
what lies across it ends the analysis, and nothing else does.
"""

import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.engines.analysis import AnalysisFailed
from fecolumn.engines.dynamics.history import read_history
from fecolumn.simulation import run


def _on_a_plinth(folder, engine="rigid", tables=None, duration_s=0.6, **joint):
    """A block pushed over the edge of a plinth of one brick, beyond what its joint allows for."""
    plinth = dict(kind="block", length_m=1.0, width_m=1.0, height_m=0.2, element_size_m=1.0)
    block = dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.3, element_size_m=0.2)
    case = structure(
        bodies=dict(plinth=plinth | STONE, block=block | dict(at_m=[0.0, 0.0, 0.2]) | STONE),
        joints=dict(
            feet=dict(between=["plinth", "ground"], friction_coefficient=1.0),
            top=dict(between=["block", "plinth"], friction_coefficient=0.1, **joint),
        ),
        initial=dict(block=dict(velocity_m_s=[2.0, 0.0, 0.0])),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=duration_s),
        **(tables or {}),
    )
    return run(case, folder, quiet=True)


@pytest.mark.parametrize("engine", ["rigid", pytest.param("full", marks=pytest.mark.long)])
def test_an_edge_that_is_not_prepared_ends_the_analysis(tmp_path, engine):
    """A point of the block would carry it beyond the edge; with an allowance the edge does."""
    with pytest.raises(AnalysisFailed, match=r"slid over an edge .*joints.top.allowance_m"):
        _on_a_plinth(tmp_path / "over", engine)


def test_an_edge_that_is_prepared_carries_what_slides_over_it(tmp_path):
    summary = _on_a_plinth(tmp_path / "edge", allowance_m=1.0)
    assert summary["outcome"] in ("slid off", "overturned")
    rows = read_history(tmp_path / "edge" / "history.h5")
    tips = np.argmax(rows["body/block/tilt"] > 1e-3)
    # the friction of a tenth of the weight acts 0.15 m below its centre: it tips from 0.485 m on
    assert 0.485 < rows["body/block/displacement"][tips, 0] < 0.56


@pytest.mark.parametrize("states_every_s", [None, 0.013])
def test_an_edge_is_passed_when_the_block_has_come_to_it(tmp_path, states_every_s):
    """Bodies are looked at as often as their way to the edge asks, whatever is written."""
    output = {} if states_every_s is None else dict(states_every_s=states_every_s)
    with pytest.raises(AnalysisFailed) as failed:
        _on_a_plinth(tmp_path / "over", tables=dict(output=output))
    # 0.3 m at 2 m/s, less what friction of a tenth of the weight takes
    assert 0.150 < float(str(failed.value).split("=")[1].split()[0]) < 0.158


def test_found_contact_needs_no_edges(tmp_path):
    found = dict(contact=dict(between="all", friction_coefficient=0.3))
    summary = _on_a_plinth(tmp_path / "found", tables=found, duration_s=1.0)
    assert '"block"' in summary["ended_by"] and summary["energy_closure_rel"] < 1e-10


def _pushed(folder, below, above, velocity, engine="rigid", **joint):
    """A body that slides on another one and comes to rest."""
    case = structure(
        bodies=dict(below=below | STONE, above=above | STONE),
        joints=dict(
            feet=dict(between=["below", "ground"], friction_coefficient=1.0),
            top=dict(between=["above", "below"], friction_coefficient=0.3) | joint,
        ),
        initial=dict(above=dict(velocity_m_s=[*velocity, 0.0])),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=0.5),
    )
    return run(case, folder, quiet=True)


def test_a_hole_below_a_body_is_no_edge(tmp_path):
    tube = dict(kind="tube", outer_diameter_m=1.6, wall_m=0.6, height_m=0.3, element_size_m=0.2)
    block = dict(kind="block", length_m=0.6, width_m=0.6, height_m=0.3, element_size_m=0.1)
    summary = _pushed(tmp_path / "hole", tube, block | dict(at_m=[0.0, 0.0, 0.3]), [0.3, 0.0])
    assert summary["outcome"] == "at rest"
    assert summary["residual_slide_m"] == pytest.approx(0.3**2 / (2 * 0.3 * 9.81), rel=0.02)


@pytest.mark.parametrize("way", [(1, 1), (-1, 1), (1, -1), (-1, -1)])
def test_where_the_prepared_part_ends_there_is_no_edge(tmp_path, way):
    """However the elements of the plinth are halved into triangles."""
    plinth = dict(kind="block", length_m=1.14, width_m=1.14, height_m=0.2, element_size_m=0.57)
    block = dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.3, element_size_m=0.1)
    block |= dict(at_m=[0.0, 0.0, 0.2])
    summary = _pushed(tmp_path / "diagonal", plinth, block, 0.62 * np.array(way))
    # 2 (0.62 m/s)^2 / (2 mu g), less the first row of the step
    assert summary["residual_slide_m"] == pytest.approx(0.1307, abs=1e-4)


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
@pytest.mark.parametrize("side", [0.4, 0.41])
def test_what_lies_on_a_pad_may_slide_over_its_edge(tmp_path, engine, side):
    """A pad has no other side: beyond the edge it carries nothing."""
    block = dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.2, element_size_m=0.1)
    below, above = block | dict(length_m=side, width_m=side), block | dict(at_m=[0.0, 0.0, 0.2])
    summary = _pushed(tmp_path / "pad", below, above, [0.5, 0.0], engine, stiffness_n_m3=1e8)
    assert summary["outcome"] == "at rest" and summary["energy_closure_rel"] < 1e-10
    assert summary["residual_slide_m"] == pytest.approx(0.0425, rel=0.03)
