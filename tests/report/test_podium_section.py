"""The two laws of impact of a podium in the report: tables, figures, and the claims of their paper judged."""

import csv
import math
import random

from synthetic_study import write_synthetic

from fecolumn.report.page import write_report
from test_models_section import rows_of

PODIUM = """podium.column_mass_kg = 2500
podium.floor_mass_kg = 1e5
podium.slenderness_rad = 0.14889
podium.half_diagonal_m = 1.5
"""
AXES = {"podium.impact": ["CRV", "CAV"], "podium.storeys": [3, 9]}


def peaks(values, summary):
    """Same tilts under both laws; shears a third larger under CAV for three storeys, and more dispersed."""
    common = random.Random(str(values["motion.source"]))
    tilt, shear, own = common.uniform(0.01, 0.9), common.lognormvariate(0, 0.3), random.Random(str(values))
    larger = {3: 1.33, 9: 1.1}[values["podium.storeys"]] if values.get("podium.impact") == "CAV" else 1.0
    scatter = {3: 0.1, 9: 0.01}[values["podium.storeys"]]
    return {"engine": "podium", "overturned": False, "u_max_m": tilt, "peaks": {"tilt over alpha [-]": tilt, "base shear over V_st [-]": shear * larger * math.exp(own.gauss(0, scatter))}}


def table(page, name):
    with open(page.parent / "tables" / f"{name}.csv") as file:
        return list(csv.DictReader(file))


def study(tmp_path, axes, motions):
    tmp_path.mkdir(exist_ok=True)
    (tmp_path / "podium.toml").write_text(PODIUM)
    return write_synthetic(tmp_path / "study", axes, motions, also=peaks, case=tmp_path / "podium.toml")


def test_claims_of_the_podium_paper_are_judged(tmp_path):
    page = write_report(study(tmp_path, AXES, 60), files=())
    text = page.read_text()
    assert "Two laws of impact" in text and "run through a building on a rocking storey" in text and "findings of Bantilas, Kavvadias and Vasiliadis put to it" in text
    told = {row["key"]: row["verdict"] for row in table(page, "claims")}
    assert told == dict(p1="undecided", p2="supported", p3="supported", p5="undecided", p6="undecided", p7="supported", p8="not supported")
    rows = table(page, "laws")
    assert [row["storeys"] for row in rows] == ["3", "9"] and 1.25 < float(rows[0]["median_ratio"]) < 1.45 and float(rows[0]["distance_tilt"]) == 0
    assert (page.parent / "figures" / "tilts.svg").exists() and (page.parent / "figures" / "shears.svg").exists()


def test_a_study_of_one_law_or_of_more_than_the_building_has_no_such_section(tmp_path):
    for number, axes in enumerate(({"podium.storeys": [3, 9]}, AXES | {"integration.dt_s": [0.01, 0.005]})):
        page = write_report(study(tmp_path / str(number), axes, 5), files=())
        assert "Two laws of impact" not in page.read_text()


def test_engines_are_compared_for_each_ensemble_file(tmp_path):
    for name in ("near", "far"):
        (tmp_path / f"{name}.h5").write_text(name)
    sources = [f"{tmp_path}/{name}.h5#{number}" for name in ("near", "far") for number in range(1, 11)]
    out = write_synthetic(tmp_path / "study", {"integration.engine": ["rigid", "housner"]}, 20, sources=sources,
                          also=lambda values, summary: {"engine": values["integration.engine"]})
    rows = rows_of(write_report(out, files=()))
    assert [(row["ensemble"], row["engine"], row["n"]) for row in rows] == [(name, engine, n) for name, n in (("all", "20"), ("near", "10"), ("far", "10")) for engine in ("rigid", "housner")]
