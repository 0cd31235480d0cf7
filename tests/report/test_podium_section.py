"""The two laws of impact of a podium in the report: tables, figures, and the claims of their paper
judged.
"""

import math
import random

import pytest
from synthetic_study import write_synthetic

from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.models import models
from fecolumn.study.report.page import write_report
from fecolumn.study.report.podium import podium
from fecolumn.study.report.sweep import read_sweep

PODIUM = """podium.column_mass_kg = 2500
podium.floor_mass_kg = 1e5
podium.slenderness_rad = 0.14889
podium.half_diagonal_m = 1.5
"""
AXES = {"podium.impact": ["CRV", "CAV"], "podium.storeys": [3, 9]}


def peaks(values, summary):
    """Same tilts under both laws; shears a third larger under CAV for three storeys, and more
    dispersed.
    """
    common = random.Random(str(values["motion.source"]))
    tilt, shear, own = (
        common.uniform(0.01, 0.9),
        common.lognormvariate(0, 0.3),
        random.Random(str(values)),
    )
    larger = (
        {3: 1.33, 9: 1.1}[values.get("podium.storeys", 3)]
        if values.get("podium.impact") == "CAV"
        else 1.0
    )
    storeys = values.get("podium.storeys", 3)
    scatter = {3: 0.1, 9: 0.01}[storeys]
    return {
        "engine": "podium",
        "iterations": None,
        "contact_iterations": None,
        "overturned": False,
        "u_max_m": tilt,
        "peaks": {
            "tilt_over_alpha": tilt,
            "base_shear_over_v_st": shear * larger * math.exp(own.gauss(0, scatter)),
        },
    }


def study(tmp_path, axes, motions, also=None):
    tmp_path.mkdir(exist_ok=True)
    (tmp_path / "podium.toml").write_text(PODIUM)
    return write_synthetic(
        tmp_path / "study", axes, motions, also=also or peaks, case=tmp_path / "podium.toml"
    )


def before_0_11(values, summary):
    """The same peaks by the names that they had."""
    found = peaks(values, summary)
    tilt, shear = found["peaks"].values()
    return found | {"peaks": {"tilt over alpha [-]": tilt, "base shear over V_st [-]": shear}}


def test_studies_before_version_0_11_are_read(tmp_path):
    axes, found = {"podium.impact": ["CRV", "CAV"]}, []
    for name, also in (("new", peaks), ("old", before_0_11)):
        sweep = read_sweep(study(tmp_path / name, axes, 6, also))
        section = podium(sweep, Gallery(tmp_path / name, False, ()))
        (laws,) = [one for one in section.blocks if getattr(one, "name", "") == "laws"]
        found.append(laws.rows)
    assert found[0] == found[1] and found[0]


@pytest.mark.long
def test_claims_of_the_podium_paper_are_judged(tmp_path):
    section = podium(read_sweep(study(tmp_path, AXES, 60)), Gallery(tmp_path, False, ()))
    blocks = {
        block.name if hasattr(block, "name") else block.kind: block for block in section.blocks
    }
    assert {claim.key: claim.verdict for claim in blocks["claims"].claims} == dict(
        p1="undecided",
        p2="supported",
        p3="supported",
        p5="undecided",
        p6="undecided",
        p7="supported",
        p8="not supported",
    )
    rows = [
        dict(zip([name for column in blocks["laws"].columns for name in column.names], row))
        for row in blocks["laws"].rows
    ]
    assert (
        [row["storeys"] for row in rows] == [3, 9]
        and 1.25 < rows[0]["median_ratio"] < 1.45
        and rows[0]["distance_tilt"] == 0
    )
    assert (tmp_path / "tilts.svg").exists() and (tmp_path / "shears.svg").exists()


@pytest.mark.long
def test_page_of_two_laws_names_what_was_analysed_and_whose_claims_are_judged(tmp_path):
    page = write_report(study(tmp_path, {"podium.impact": ["CRV", "CAV"]}, 6), files=())
    text = page.read_text()
    assert (
        "Two laws of impact" in text
        and "run through a building on a rocking storey" in text
        and "findings of Bantilas, Kavvadias and Vasiliadis put to it" in text
    )
    assert (page.parent / "tables" / "laws.csv").exists() and (
        page.parent / "tables" / "claims.csv"
    ).exists()
    assert (
        "the largest displacement of the roof of the building" in text
        and "of the column" not in text
    )
    assert (
        sum(
            run["iterations"] is None
            for setting in read_sweep(tmp_path / "study" / "out").done
            for run in setting.runs.values()
        )
        == 12
    )
    assert "itera\N{SOFT HYPHEN}tions a step" not in text  # a model in closed form has none


def test_a_study_of_one_law_or_of_more_than_the_building_has_no_such_section(tmp_path):
    for number, axes in enumerate(
        ({"podium.storeys": [3, 9]}, AXES | {"integration.dt_s": [0.01, 0.005]})
    ):
        assert podium(read_sweep(study(tmp_path / str(number), axes, 5)), None) is None


def test_engines_are_compared_for_each_ensemble_file(tmp_path):
    for name in ("near", "far"):
        (tmp_path / f"{name}.h5").write_text(name)
    sources = [
        f"{tmp_path}/{name}.h5#{number}" for name in ("near", "far") for number in range(1, 11)
    ]
    out = write_synthetic(
        tmp_path / "study",
        {"integration.engine": ["rigid", "housner"]},
        20,
        sources=sources,
        also=lambda values, summary: {"engine": values["integration.engine"]},
    )
    table = next(
        block
        for block in models(read_sweep(out), Gallery(tmp_path, False, ())).blocks
        if block.kind == "table"
    )
    assert [row[:3] for row in table.rows] == [
        (name, engine, n)
        for name, n in (("all", 20), ("near", 10), ("far", 10))
        for engine in ("rigid", "housner")
    ]
