"""Commands that make the tables of studies: the paper's in both readings, models beside each other,
the wobbling frame's bins, the map, and slenderness to design with.
"""

import pytest

from benchmarks import models, tables
from benchmarks.calibration.__main__ import printed
from benchmarks.rocking import design
from benchmarks.substeps import paper
from benchmarks.tables import from_markdown
from benchmarks.tables.study_rows import keep_rows
from benchmarks.wobbling import beside_bodies
from benchmarks.wobbling.bins import LEVELS
from fecolumn.study.alpha import alpha_note
from fecolumn.study.plan import read_plan
from fecolumn.study.store import DONE


def runs(peaks, fallen):
    return {
        number: dict(u_max_m=peak, overturned=number in fallen, slid_off=False, cpu_s=2.0)
        for number, peak in enumerate(peaks)
    }


@pytest.mark.long
def test_both_readings_have_the_same_settings_and_differ_in_the_step_alone():
    plans = [read_plan(f"benchmarks/{file}.toml") for file in paper.READINGS.values()]
    fixed, rolling = (plan.analyses for plan in plans)
    assert len(fixed) == len(rolling) == 1725
    assert [one.values for one in fixed] == [one.values for one in rolling]
    assert {one.case.integration.substeps for one in fixed} == {"none"}
    assert {one.case.integration.substeps for one in rolling} == {"rolling"}
    step = {"integration.substeps": "none"}
    assert rolling[7].case.replace(step).id == fixed[7].id


def test_paper_tables_have_a_line_for_each_reading_and_step():
    found = {
        ("fixed step", dt, alpha): runs([0.01] * 12, set(range(fallen)))
        for dt, fallen in ((0.02, 1), (1e-3, 9))
        for alpha in paper.ALPHAS
    }
    found["fixed step", 1e-3, 0] = runs([0.01] * 12, set())
    counts, steps, alphas = from_markdown(paper.tables(found))
    assert counts[1][:2] == ["fixed step, 0.02 s", "1 of 12; 8.3 % (1.5 to 35.4)"]
    # of a reading that was not asked for there is no line
    assert counts[3] == ["fixed step, 0.0001 s", *[""] * 5] and len(counts) == len(steps) == 4
    # nine fall of twelve against one: both tails of a binomial of eight, 2 / 2^8
    assert steps[1][2] == "0.67; 0.008; 0.008"
    assert alphas[1][:3] == ["fixed step, 0.02 s", "10", "0.00"]
    assert alphas[2] == ["fixed step, 0.001 s", "10", "0.75", "0.004", "0.004", "0.004"]


def test_models_are_set_beside_full_order_on_the_motions_that_it_has():
    found = dict(
        housner=runs([0.01] * 6, {0}),
        reduced=runs([0.02] * 6, {0, 1}),
        full=runs([0.02] * 4, {1}),
    )
    for run in (found["reduced"][0], *found["full"].values()):  # went on after a stop
        run["cpu_s"] = None
    head, *lines = from_markdown(models.table(found))[0]
    rows = [dict(zip(head, line)) for line in lines]
    assert [row["motions"] for row in rows] == ["6", "6", "4"]
    assert rows[0]["overturn in it alone"] == "1" and rows[0]["in the other alone"] == "1"
    assert rows[0]["same outcome [%]"] == "50" and rows[1]["same outcome [%]"] == "75"
    assert rows[2]["D"] == "-" and [row["CPU of a motion [s]"] for row in rows] == ["2", "2", "-"]


@pytest.mark.long
def test_full_order_is_asked_for_by_itself():
    for study in models.STUDIES:
        plans = [models.plan(study, full) for full in (False, True)]
        engines = [{one.values[models.ENGINE] for one in plan.analyses} for plan in plans]
        assert engines == [{"housner", "wobbling", "rigid", "reduced"}, {"full"}]


@pytest.mark.long
def test_models_go_on_from_rows_that_are_kept(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(tables, "FOLDER", tmp_path / "tables")
    whole = models.plan("own_mesh", True)
    rows = [
        dict(id=one.id, state=DONE, summary=summary)
        for one, summary in zip(whole.analyses, runs([0.01, 0.02, 0.03], {1}).values())
    ]
    keep_rows("models/own_mesh", whole, rows, "made up", models.KEPT)
    assert [file.stem for file in tmp_path.rglob("*.csv")] == ["own_mesh-full"]
    output = tmp_path / "models"
    assert models.main(["--own-mesh", "--full", "--report", "-o", str(output)]) == 0
    head, line = from_markdown(capsys.readouterr().out)[0]
    row = dict(zip(head, line))
    assert (row["motions"], row["overturned"], row["CPU of a motion [s]"]) == ("3", "1", "2")
    assert (output / "own_mesh" / "models.png").is_file()
    assert models.main(["--report", "-o", str(output)]) == 0
    assert "has done an analysis yet" in capsys.readouterr().out


def test_bins_of_the_frame_are_lines_with_those_of_each_level():
    def side(peak, fallen):
        return {
            f"{name} {level} {number}": dict(
                u_max_m=peak, overturned=(level, number) in fallen, slid_off=False
            )
            for name in ("FF", "NF")
            for level in LEVELS
            for number in (1, 2)
        }

    bodies, model = side(0.02, set()), side(0.03, {("high", 2)})
    text = beside_bodies.table(dict(zip(beside_bodies.ENGINES, (bodies, model))))
    head, *lines = from_markdown(text)[0]
    assert [line[0] for line in lines] == [
        "FF low",
        "FF high",
        "NF low",
        "NF high",
        "low, all",
        "high, all",
        "all",
    ]
    row = dict(zip(head, lines[-1]))
    assert (row["motions"], row["overturned, bodies"], row["model"]) == ("8", "0", "2")
    assert row["same outcome [%]"] == "75" and row["model over bodies"] == "1.50"


def test_map_is_printed_a_line_a_height():
    text = printed({(0.0603, 1.0): (6, 10), (0.0761, 1.5): (4, 10)})
    assert from_markdown(text)[0] == [
        ["height [m]", "diameter 60.3 mm: P [%]", "diameter 76.1 mm: P [%]"],
        ["1", "60.0 (31.3 to 83.2), n = 10", ""],
        ["1.5", "", "40.0 (16.8 to 68.7), n = 10"],
    ]


@pytest.mark.long
def test_slenderness_to_design_with_is_a_line_through_what_is_computed():
    """Makris and Roussos (1998): the one-sine pulse overturns at 6 to 9 % less than by their line,
    in alpha of 10 degrees.
    """
    head, *lines = from_markdown(design.table())[0]
    rows = {line[0]: dict(zip(head, line)) for line in lines}
    assert len(rows) == len(design.DURATIONS) and len(head) == 1 + 3 * len(design.PULSES)
    for duration in (2, 4, 8):
        ratio = float(rows[f"{duration}"]["one-sine: formula over computed"])
        assert ratio == pytest.approx(0.925, abs=0.02)


@pytest.mark.parametrize(
    "name", ["paper_claims", "paper_parts_claims", "own_mesh_claims", "own_mesh_fixed_claims"]
)
def test_claims_on_alpha_say_what_the_report_says_of_the_scheme(name):
    table = tables.read(name)
    place = table.columns.index("what was found")
    told = [row[place] for row in table.rows if row[0].endswith((", a2, α", ", c"))]
    assert len(told) == 2 and all(alpha_note({}, {}) in text for text in told)
