"""Fragility in the report: intensities of the motions the analyses name, pooled over their
scales.
"""

import csv

import numpy as np
import pytest
from synthetic_study import write_synthetic
from test_page import page_alone

from fecolumn.cli import main
from fecolumn.motions.ensemble_file import read_member
from fecolumn.motions.intensity import peak_values
from fecolumn.statistics.fragility import lognormal
from fecolumn.study.report.observed_shares import observed_shares, share_groups

PEAKS = np.linspace(0.5, 5.0, 30)


@pytest.fixture(scope="module")
def pulses(tmp_path_factory):
    """Thirty pulses of rising peak in one file."""
    file = tmp_path_factory.mktemp("pulses") / "p30.h5"
    assert (
        main(
            [
                "motions",
                "make",
                "pulses",
                "symmetric_ricker",
                "--amplitudes",
                *map(str, PEAKS),
                "--periods",
                "0.5",
                "-o",
                str(file),
            ]
        )
        == 0
    )
    return [f"{file}#{number}" for number in range(1, len(PEAKS) + 1)]


@pytest.mark.parametrize(
    "n, groups", [(4, 1), (9, 1), (10, 2), (20, 4), (29, 5), (30, 6), (500, 6)]
)
def test_shares_are_of_six_groups_at_most_and_five_runs_at_least(n, groups):
    im, happened = np.arange(1.0, n + 1), np.arange(n) >= n // 2
    curve = observed_shares(im, happened)
    assert curve.x.size == share_groups(n) == groups and curve.name.endswith("of equal number")
    assert (np.diff(curve.x) > 0).all() and (
        (curve.bars[0] <= curve.y) & (curve.y <= curve.bars[1])
    ).all()


def rows_of(out):
    with open(out / "report" / "tables" / "fragilities.csv") as file:
        return list(csv.DictReader(file))


@pytest.mark.long
def test_fragility_is_that_of_the_motions_over_all_scales(tmp_path, pulses):
    out = write_synthetic(
        tmp_path,
        {"motion.scale": [0.5, 1.0, 2.0], "contact.friction_coefficient": [0.3, 0.8]},
        0,
        sources=pulses,
        effect=lambda values: values["motion.scale"],
    )
    page = page_alone(out)
    assert "Fragility" in page.text and "at all its scales" in page.text
    rows = rows_of(out)
    assert len(rows) == 2 and all(int(row["n"]) == 90 for row in rows)
    from fecolumn.study.store import read_study

    done = [
        row for row in read_study(out).rows if row["axes"]["contact.friction_coefficient"] == 0.3
    ]
    pgv = [
        row["axes"]["motion.scale"] * peak_values(read_member(row["axes"]["motion.source"]))[1]
        for row in done
    ]
    fit = lognormal(pgv, [row["summary"]["overturned"] for row in done])
    assert float(rows[0]["median_pgv_m_s"]) == pytest.approx(fit.median, rel=1e-6)
    assert float(rows[0]["beta"]) == pytest.approx(fit.beta, rel=1e-6)
    assert all(row["pga_p"] == "" for row in rows), "peaks of pulses of one shape tell the same"


@pytest.mark.long
def test_no_fragility_where_the_motions_are_not_to_be_found(tmp_path):
    page = page_alone(write_synthetic(tmp_path, {"contact.friction_coefficient": [0.3, 0.8]}, 25))
    assert "Fragility" not in page.text
