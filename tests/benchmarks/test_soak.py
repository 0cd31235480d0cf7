"""The soak: its draws, its driver and its keeper, on a few real analyses."""

import collections
import tomllib

import pytest

from benchmarks.soak import __main__, cases, watch
from benchmarks.soak.hypercube import Draw, hypercube
from benchmarks.soak.motions import write_motions
from benchmarks.soak.report import growth, histogram, rows_of, toml
from benchmarks.soak.specimens import specimens
from fecolumn.case.case import case_from_tables, load_case


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    return write_motions(tmp_path_factory.mktemp("soak"))


@pytest.fixture(scope="module")
def plan(sources):
    return cases.block(0, 120, sources, 1, specimens())


def test_every_drawn_case_can_be_analysed_and_differs_from_all_others(plan):
    assert len({analysis.id for analysis in plan.analyses}) == 120
    for kind, wanted in (
        ("column.shape", {"tube", "solid", "block"}),
        ("base.kind", {"plate", "unbounded", "pad"}),
        ("integration.engine", {"reduced", "rigid"}),
        ("contact.law", {"augmented_lagrange", "penalty"}),
    ):
        section, key = kind.split(".")
        assert {
            getattr(getattr(analysis.case.short, section), key) for analysis in plan.analyses
        } == wanted


def test_motions_of_all_families_take_part(plan, sources):
    heads = collections.Counter(
        analysis.case.motion.source.partition(":")[0].rpartition("/")[2].partition(".")[0]
        if analysis.case.motion
        else "none"
        for analysis in plan.analyses
    )
    assert {"none", "lick", "near-fault", "pulses", "three-components"} <= set(heads)
    assert ("fema-p695" in heads) == ("records" in sources)


def test_a_block_begins_with_the_same_analyses_however_many_are_wanted(plan, sources):
    few = cases.block(0, 7, sources, 1, specimens())
    assert [analysis.id for analysis in few.analyses] == [
        analysis.id for analysis in plan.analyses[:7]
    ]
    assert cases.blocks(2 * cases.BLOCK + 3) == [(0, cases.BLOCK), (1, cases.BLOCK), (2, 3)]


def test_samples_of_a_hypercube_fill_every_slice_once():
    draws = hypercube(("a", "b"), 20, 1)
    for name in "ab":
        assert sorted(draw.place(name, 20) for draw in draws) == list(range(20))


def test_what_is_rare_is_as_rare_as_said_and_spread_where_it_is_not():
    shares = [
        Draw({"x": k / 100}).rarely("x", 0.2, lambda one: one.even("x", 1, 2)) for k in range(100)
    ]
    assert shares[:20] == pytest.approx([1 + k / 20 for k in range(20)]) and not any(shares[20:])


def test_a_case_is_the_same_from_the_file_that_is_written_for_it(plan, tmp_path):
    for analysis in plan.analyses[:20]:
        text = toml(analysis.case.as_stated())
        assert case_from_tables(tomllib.loads(text), "x").id == analysis.id
    (tmp_path / "one.toml").write_text(text)
    assert load_case(tmp_path / "one.toml").id == analysis.id


def test_growth_is_that_of_the_floor_and_not_of_spikes():
    values = [100 + 0.01 * count + (50 if count % 7 == 0 else 0) for count in range(1000)]
    assert growth(range(1000), values) == pytest.approx(0.01, rel=0.05) and growth(
        range(1000), [5.0] * 1000
    ) == pytest.approx(0)


def test_every_value_is_counted_in_a_histogram():
    assert [
        line.split()[3]
        for line in histogram([0, 1e-13, 5e-13, 2], (0, 1e-14, 1e-12, float("inf"))).splitlines()
    ] == ["1", "2", "1"]


@pytest.mark.slow
def test_analyses_whose_driver_and_workers_are_killed_are_all_done(tmp_path, monkeypatch, capsys):
    kills = iter([3.0, 8.0])
    monkeypatch.setattr(watch, "_interval", lambda *_: next(kills, float("inf")))
    monkeypatch.setattr(watch, "_LOOK_S", 0.5)
    code = __main__.main(["-n", "8", "-j", "2", "-o", str(tmp_path), "--specimens", "1"])
    rows, planned = rows_of(tmp_path)
    said = capsys.readouterr().out
    assert planned == len(rows) == 8 and code == 0, said
    assert "8 planned, 8 in ledgers: 8 done; 0 lost" in said and not list(
        tmp_path.glob("block-*/analyses/*/history.h5")
    )
    assert "killed" in (tmp_path / "driver.csv").read_text() and "killed: none" not in said
    assert all(
        row["state"] == "done" and row["summary"]["process"]["memory_mb"] > 10 for row in rows
    )
    assert len(list((tmp_path / "worst").glob("*.toml"))) == 8
