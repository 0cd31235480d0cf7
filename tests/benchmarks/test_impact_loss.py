"""What one impact takes from rocking, as the benchmark of impacts finds it."""

import csv
import json
from dataclasses import asdict
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.impact.figure import draw
from benchmarks.impact.formula import STIFF, fit
from benchmarks.impact.grid import COLUMNS, by_cell, cell, cells, jobs
from benchmarks.impact.loss import turning_tilts
from benchmarks.impact.map import main as map_main
from benchmarks.impact.measured import MEASURED, Measured
from benchmarks.impact.sections import DENSITY, HEIGHT, Body, releases
from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.atomic import write_json


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


def test_a_body_of_the_map_has_the_groups_that_it_is_named_by():
    body = Body("block", 4.0, 1e5)
    assert body.modulus * body.width / (DENSITY * GRAVITY * HEIGHT**2) == pytest.approx(1e5)
    assert body.crossing == pytest.approx(body.width / np.sqrt(body.modulus / DENSITY))
    softer = Body("block", 4.0, 1e3)
    assert softer.crossing == pytest.approx(10 * body.crossing)


def test_releases_beside_each_other_fall_for_equally_spaced_times():
    block = SimpleNamespace(p=3.0)
    shares = releases(block, 50.0, 0.3, 4)
    times = np.arccosh(1 / (1 - np.array(shares))) / 3.0
    assert shares[0] == pytest.approx(0.3)
    assert np.diff(times) == pytest.approx(1 / (4 * 50.0))


def test_an_elastic_block_loses_less_than_its_rigid_block_and_little_of_it_in_contact(tmp_path):
    """A coarse block of slenderness 4.5, whose shortest step is a quarter of the time in which a
    wave crosses it.
    """
    body = Body("block", 4.5, 1e5, elements=4, modes=20)
    rows = cell("map", body, 0.3, (1 / 4,), 2)
    alpha = np.arctan(1 / 4.5)
    # a rigid rectangle's, but for its lumped mass
    assert rows[0]["housner"] == pytest.approx(1 - 1.5 * np.sin(alpha) ** 2, abs=0.02)
    assert all(0.2 < row["rocking"] < 1.2 and 0 < row["contact"] < 0.5 for row in rows)
    kept = rows[0]["restitution"]
    assert 1 - kept**2 == pytest.approx(rows[0]["rocking"] * (1 - rows[0]["housner"] ** 2))


def test_the_limit_of_a_cell_is_the_mean_at_its_shortest_step():
    own = dict(check="map", shape="tube", ratio=3.0, group=1e5, friction=0.8, contact=0.1)
    rows = [
        own | dict(step=step, rocking=loss, housner=0.9)
        for step, loss in ((0.25, 1.0), (0.25, 1.2), (0.0625, 0.7), (0.0625, 0.9))
    ]
    found = by_cell([*rows, own | dict(step=0.0625, rocking=np.nan, housner=0.9)])
    assert len(found) == 1
    one = found[0]
    assert one["loss"] == pytest.approx(0.8) and one["change"] == pytest.approx(-0.3)
    assert (one["least"], one["most"], one["releases"]) == (0.7, 0.9, 2)
    # t of one degree of freedom times the standard error of 0.1
    assert one["half_width"] == pytest.approx(12.706 * 0.1, rel=1e-3)


def test_the_formula_finds_what_made_the_stiff_cells_and_says_what_their_mean_misses():
    """Stiff cells of a known formula with a little scatter, softer ones of anything."""
    random = np.random.default_rng(1)
    made = []
    for shape, base in (("block", 0.7), ("solid", 0.5)):
        for ratio in (2.0, 3.0, 4.5, 7.0, 10.0):
            for group in 10.0 ** np.arange(3, 9):
                loss = base + 0.5 / ratio + random.normal(0, 0.01)
                loss = loss if group >= STIFF else random.normal(2, 1)
                made.append(dict(shape=shape, ratio=ratio, group=group, loss=loss))
    formula = fit(made)
    assert formula.base == pytest.approx(dict(block=0.7, solid=0.5), abs=0.01)
    assert formula.slope == pytest.approx(0.5, abs=0.02)
    assert formula.loss("block", 4.0) == pytest.approx(0.825, abs=0.01)
    assert formula.error < 0.015 and formula.left_out < 0.02
    stiff = [one["loss"] for one in made if one["group"] >= STIFF]
    assert formula.error_of_mean == pytest.approx(np.std(stiff))
    assert formula.left_out_by_mean > formula.error_of_mean
    with pytest.raises(ValueError, match="3 stiff cells are too few for 2 parameters"):
        fit(made[2:5])


def test_measured_losses_are_over_housner_s():
    one = Measured("a test", 4.0, 0.95, 1.0, "a page")
    housner = (2 * 16 - 1) / (2 * 17)
    assert one.losses[0] == pytest.approx(0.0)
    assert one.losses[1] == pytest.approx((1 - 0.95**2) / (1 - housner**2))


def test_every_measured_slenderness_of_a_source_is_there():
    """One range of restitutions is quoted for four blocks of steel: the stout ones lose less than
    Housner's block, the slender one more.
    """
    steel = [one for one in MEASURED if "steel" in one.source]
    assert [one.ratio for one in steel] == [1, 2, 4, 8]
    assert steel[0].losses[1] < steel[1].losses[1] < 1 < steel[3].losses[0]


def test_map_of_a_few_kept_cells_is_told_and_drawn(tmp_path, capsys):
    random = np.random.default_rng(2)
    wanted = cells((3.0, 7.0), (1e5, 1e6), ("block",))
    for file, (check, body, share, steps, beside) in jobs(tmp_path, wanted).items():
        file.parent.mkdir(exist_ok=True)
        rows = [
            dict.fromkeys(COLUMNS, 0.0)
            | asdict(body)
            | dict(check=check, share=share, step=step, release=share, said="")
            | dict(rocking=0.8 + random.normal(0, 0.1), housner=0.9)
            for step in steps
            for _ in range(beside)
        ]
        write_json(file, rows)
    command = ["--report", "-o", str(tmp_path), "--shape", "block"]
    assert map_main([*command, "--ratio", "3", "7", "--group", "1e5", "1e6"]) == 0
    said = capsys.readouterr().out
    mean = by_cell(json.loads((tmp_path / "cells" / "map-block-3-100000-0.8.json").read_text()))[0]
    assert f"| block, friction 0.8, H/B 3 | {mean['loss']:.2f} ± {mean['half_width']:.2f} |" in said
    assert "| 8 to 12 elements over the width | 2 |" in said
    assert (tmp_path / "map.png").stat().st_size > 10_000
    with (tmp_path / "map.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 8 * (8 * 2) + 2 * 4 * 8
