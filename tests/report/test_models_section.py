"""Models beside each other in the report: engines of a study on the same motions."""

import csv

import numpy as np
import pytest
from synthetic_study import write_synthetic

from fecolumn.statistics.two_sample import kolmogorov_smirnov
from fecolumn.study.report.page import write_report


def rows_of(page):
    with open(page.parent / "tables" / "engines.csv") as file:
        return list(csv.DictReader(file))


@pytest.mark.long
def test_engines_are_measured_against_the_finite_elements(tmp_path):
    cpu = {"reduced": 3.0, "rigid": 2.0, "housner": 0.01}
    kept = {}

    def also(values, summary):
        kept.setdefault(values["integration.engine"], []).append(
            np.inf if summary["overturned"] else summary["u_max_m"]
        )
        return {"engine": values["integration.engine"], "cpu_s": cpu[values["integration.engine"]]}

    out = write_synthetic(
        tmp_path,
        {"integration.engine": ["housner", "rigid", "reduced"]},
        40,
        also=also,
        scatter=0.2,
        effect=lambda values: 3.0 if values["integration.engine"] == "housner" else 1.0,
    )
    page = write_report(out, files=())
    assert (
        "Models beside each other" in page.read_text()
        and "finite elements, reduced" in page.read_text()
    )
    rows = {row["engine"]: row for row in rows_of(page)}
    assert set(rows) == set(cpu) and all(int(row["n"]) == 40 for row in rows.values())
    assert rows["reduced"]["distance"] == "" and {
        name: float(row["cpu_s"]) for name, row in rows.items()
    } == pytest.approx(cpu)
    for name in ("housner", "rigid"):
        assert float(rows[name]["distance"]) == pytest.approx(
            kolmogorov_smirnov(kept[name], kept["reduced"]).statistic
        )
        fallen = np.isinf(kept[name])
        assert int(rows[name]["overturned"]) == fallen.sum()
        assert float(rows[name]["same_outcome"]) == pytest.approx(
            (fallen == np.isinf(kept["reduced"])).mean()
        )
    assert float(rows["housner"]["p"]) < 0.01 < float(rows["rigid"]["p"])


def test_a_study_of_one_engine_has_no_such_section(tmp_path):
    page = write_report(
        write_synthetic(tmp_path, {"contact.friction_coefficient": [0.3, 0.8]}, 12), files=()
    )
    assert (
        "Models beside each other" not in page.read_text()
        and not (page.parent / "tables" / "engines.csv").exists()
    )


@pytest.mark.long
def test_an_engine_with_fewer_motions_is_measured_on_those_and_its_number_is_told(tmp_path):
    engines, kept = ["housner", "reduced", "full"], {}

    def also(values, summary):
        kept.setdefault(values["integration.engine"], []).append(
            np.inf if summary["overturned"] else summary["u_max_m"]
        )
        return {"engine": values["integration.engine"]}

    out = write_synthetic(
        tmp_path,
        {"integration.engine": engines},
        40,
        also=also,
        scatter=0.2,
        unfinished=range(80 + 12, 120),
    )
    page = write_report(out, files=())
    words = " ".join(page.read_text().split())
    # in the text, below the figure and in its place
    assert words.count("the same 40 motions (finite elements, full order: 12 of them)") == 3
    rows = {row["engine"]: row for row in rows_of(page)}
    assert {name: int(row["n"]) for name, row in rows.items()} == {
        "housner": 40,
        "reduced": 40,
        "full": 12,
    }
    assert rows["reduced"]["distance"] == "" and float(rows["full"]["distance"]) == pytest.approx(
        kolmogorov_smirnov(kept["full"], kept["reduced"][:12]).statistic
    )
    assert float(rows["full"]["distance"]) <= float(rows["full"]["not_excluded"]) <= 1
    # the sixth of twelve: no interpolation
    medians = [sorted(sample)[5] for sample in (kept["full"], kept["reduced"][:12])]
    assert float(rows["full"]["e50"]) == pytest.approx(abs(medians[0] - medians[1]) / medians[1])
    assert int(rows["full"]["reference_overturned"]) == np.isinf(kept["reduced"][:12]).sum()
    assert float(rows["housner"]["distance"]) == pytest.approx(
        kolmogorov_smirnov(kept["housner"], kept["reduced"]).statistic
    )
