"""Peaks of links over the runs of a study: quantiles, the section of the report, limits of them."""

import sys
from pathlib import Path

import numpy as np
import pytest

from fecolumn.foundation.schema import InputError
from fecolumn.study.device_peaks import LINK_COLUMNS, peaks_of_links
from fecolumn.study.plan import read_plan
from fecolumn.study.questions.limit import read_event
from fecolumn.study.report.link_section import link_section
from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.store import read_study
from fecolumn.study.table import write_tables

sys.path.insert(0, str(Path(__file__).parents[1] / "report"))
from synthetic_study import ALPHA, write_synthetic  # noqa: E402


def link(k, broke=None):
    """Entries of a link that reaches k kN and k mm either way."""
    return dict(
        tension_max_n=1e3 * k,
        compression_max_n=2e3 * k,
        elongation_max_m=1e-3 * k,
        shortening_max_m=2e-3 * k,
        work_j=10.0 * k,
        yielded_at_s=1.0 if k > 2 else None,
        broke_at_s=broke,
    )


def test_quantiles_are_of_all_runs_and_counts_of_those_that_yielded_and_broke():
    runs = [dict(links=dict(bar=link(k), wire=link(1, broke=0.5))) for k in range(1, 6)]
    bar, wire = (dict(zip(LINK_COLUMNS, row, strict=True)) for row in peaks_of_links(runs))
    assert (bar["link"], bar["n"], bar["yielded"], bar["broke"]) == ("bar", 5, 3, 0)
    assert wire["broke"] == 5
    tension = [bar[f"tension_{share}_n"] for share in ("50", "84", "max")]
    assert tension == pytest.approx((3e3, np.quantile(range(1, 6), 0.84) * 1e3, 5e3))
    assert bar["shortening_max_m"] == pytest.approx(0.01) and bar["work_50_j"] == 30.0
    # of a model without links, and of a version that told less, nothing is said
    assert peaks_of_links([dict(u_max_m=1.0), dict(links=dict(old=dict(tension_max_n=1.0)))]) == []


def test_a_study_has_a_table_of_links_and_its_report_a_section(tmp_path):
    out = write_synthetic(
        tmp_path / "study",
        {ALPHA: [0.0, -0.2]},
        4,
        also=lambda values, summary: dict(links=dict(bar=link(1e3 * summary["u_max_m"]))),
    )
    plan, rows = read_plan(tmp_path / "study" / "study.toml"), read_study(out).rows
    write_tables(plan, rows, tmp_path)
    head, *lines = (tmp_path / "links.csv").read_text().splitlines()
    assert head.split(",") == [ALPHA, *LINK_COLUMNS] and len(lines) == 2
    assert lines[0].split(",")[1:3] == ["bar", "4"]
    section = link_section(read_sweep(out))
    table = section.blocks[1]
    assert section.title == "Links" and len(table.rows) == 2
    assert [len(row) for row in table.cells()] == [len(table.columns)] * 2
    assert table.write_csv(tmp_path).name == "links.csv"


def test_without_links_there_is_neither_table_nor_section(tmp_path):
    out = write_synthetic(tmp_path / "study", {ALPHA: [0.0, -0.2]}, 2)
    write_tables(read_plan(tmp_path / "study" / "study.toml"), read_study(out).rows, tmp_path)
    assert not (tmp_path / "links.csv").exists() and link_section(read_sweep(out)) is None


@pytest.mark.parametrize(
    "text, limit",
    [("compression[bar] > 2.5 kN", 1.25), ("elongation > 3 mm", 3.0), ("shortening > 3 mm", 1.5)],
)
def test_limits_of_links_are_judged_by_their_peaks(text, limit):
    event = read_event(text, "fecolumn design")
    for k in (0.9 * limit, 1.1 * limit):
        assert event.happened(dict(links=dict(bar=link(k)), overturned=False, slid_off=False)) == (
            k > limit
        )


def test_a_limit_that_an_older_summary_does_not_tell_is_refused():
    old = dict(links=dict(bar=dict(tension_max_n=1.0)), overturned=False, engine="rigid")
    with pytest.raises(InputError, match="holds no compression"):
        read_event("compression > 1 N", "fecolumn design").happened(old)
