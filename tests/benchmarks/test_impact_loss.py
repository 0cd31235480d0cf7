"""What one impact takes from rocking, as the benchmark of impacts finds it."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.impact.figure import draw
from benchmarks.impact.loss import turning_tilts


def test_turning_tilts_are_those_of_a_rigid_blocks_arcs():
    """Arcs of Housner's slender block that fell from 0.3 and rises to 0.25 of its slenderness, with
    a vibration on them.
    """
    p, alpha = 2.5, 0.05
    time = np.linspace(0.05, 0.25, 400)
    arcs = []
    for tilt in (0.3 * alpha, 0.25 * alpha):
        theta = alpha - (alpha - tilt) * np.cosh(p * time) + 1e-6 * np.sin(900 * time)
        arcs.append(np.column_stack([time, theta]))
    first, second = turning_tilts(
        arcs[0], arcs[1][::-1] * [-1, 1] + [1.0, 0.0], SimpleNamespace(p=p)
    )
    assert first == pytest.approx(0.3 * alpha, rel=1e-3) and second == pytest.approx(
        0.25 * alpha, rel=1e-3
    )


def test_figure_of_a_few_impacts_is_drawn(tmp_path):
    rows = [
        {"series": name, "dt": str(dt), "rocking": str(loss)}
        for name in ("reduced", "share-0.1")
        for dt, loss in ((1e-3, 1.4), (1e-3, 1.5), (1e-5, 0.8))
    ]
    draw(rows, tmp_path / "impact")
    assert (tmp_path / "impact.png").stat().st_size > 10_000
