"""The page of a report: it stands alone, its numbers run, it says what is missing."""

import base64
import csv
import re
from html.parser import HTMLParser

import pytest
from synthetic_study import ALPHA, DT, SPECIMEN, write_synthetic

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.study.report.notation import fixed, interval, percent, percent_interval
from fecolumn.study.report.page import write_report

VOID = {"meta", "img", "br", "link", "input", "hr", "source"}
FRICTION = "contact.friction_coefficient"


class Page(HTMLParser):
    """Words, addresses, anchors and captions of a page, and whether its elements are closed."""

    def __init__(self, text: str):
        super().__init__()
        self.words, self.addresses, self.ids, self.captions, self.open = [], [], [], [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        assert tag not in ("link", "iframe") and not (tag == "script" and "src" in attributes)
        self.addresses += [value for name, value in attributes.items() if name in ("src", "href")]
        self.ids += [attributes["id"]] if "id" in attributes else []
        if tag in ("figcaption", "summary"):
            self.captions.append("")
        if tag == "img":
            assert attributes["alt"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, text):
        if not {"style", "script"} & set(self.open):
            self.words.append(text)
            if self.open and {"figcaption", "summary"} & set(self.open):
                self.captions[-1] += text

    @property
    def text(self) -> str:
        return " ".join("".join(self.words).split())


def report(folder) -> Page:
    """The whole report by its command."""
    assert main(["report", str(folder)]) == 0
    return Page((folder / "report" / "index.html").read_text())


def page_alone(folder) -> Page:
    """The page and its tables, without a PDF and a PNG of every figure beside it, which take the
    most time.
    """
    return Page(write_report(folder, files=()).read_text())


@pytest.fixture(scope="module")
def unfinished(tmp_path_factory):
    """Two time steps, three alphas, twelve motions: five analyses not run, two failed."""
    folder = tmp_path_factory.mktemp("report") / "study"
    out = write_synthetic(
        folder,
        {DT: [0.02, 1e-3], ALPHA: [0, -0.1, -0.333]},
        12,
        fails=(3, 17),
        unfinished=range(20, 25),
        title="A < B & C",
    )
    return out, report(out)


def test_page_stands_alone_but_for_the_files_beside_it(unfinished):
    _, page = unfinished
    out, _ = unfinished
    files = [
        one for one in page.addresses if not one.startswith(("data:image/svg+xml;base64,", "#"))
    ]
    assert files and all((out / "report" / one).is_file() for one in files)
    assert {one[1:] for one in page.addresses if one.startswith("#")} <= set(page.ids)
    assert len(page.ids) == len(set(page.ids))


def test_figures_and_tables_are_numbered_as_they_come(unfinished):
    _, page = unfinished
    for kind in ("Figure", "Table"):
        numbers = [
            int(found[1])
            for found in (re.match(rf"{kind}\s(\d+)\.", one) for one in page.captions)
            if found
        ]
        assert len(numbers) >= 4 and numbers == list(range(1, len(numbers) + 1))
        referred = {int(n) for n in re.findall(rf"{kind}\s(\d+)", page.text)}
        assert max(referred) == len(numbers)


def test_every_table_leads_to_its_file_and_every_figure_to_its_pictures(unfinished):
    out, page = unfinished
    tables = {path.name for path in (out / "report" / "tables").iterdir()} - {"claims.csv"}
    assert {f"tables/{name}" for name in tables} == {
        one for one in page.addresses if one.startswith("tables/")
    }
    assert {path.stem for path in (out / "report" / "figures").iterdir()} == {
        one[8:-4] for one in page.addresses if one.endswith(".pdf")
    }


def test_every_figure_is_drawn_once_more_for_a_narrow_screen(unfinished):
    """Letters of a figure of a page's width, shrunk to a telephone, are 6 pixels high; the narrow
    one is as wide as the screen.
    """
    out, _ = unfinished
    html = (out / "report" / "index.html").read_text()
    drawn = re.findall(r'srcset="data:image/svg\+xml;base64,([^"]+)"><img', html)
    assert len(drawn) == html.count("<img") >= 5
    widths = [float(re.search(rb'width="([\d.]+)pt"', base64.b64decode(one))[1]) for one in drawn]
    assert max(widths) <= 72 * 3.5 + 0.1


def test_motions_too_few_for_what_the_paper_found_are_warned_of(unfinished):
    _, page = unfinished
    assert re.search(
        r"\d+ motions: a difference of two CDFs below 0\.\d\d cannot be seen "
        r"\(Kolmogorov-Smirnov, 5.%; .*?\); 0.18 would need about 115 motions, those of "
        "the paper",
        page.text,
    )
    assert "0.10 would need about 369 motions" in page.text


def test_an_axis_of_one_value_is_told_once(tmp_path):
    page = page_alone(write_synthetic(tmp_path / "study", {FRICTION: [0.2, 0.4], DT: [1e-3]}, 12))
    assert len(re.findall(r"Δ\s*t\s=\s0.001", page.text)) == 1 and "In all analyses" in page.text
    assert "Δt" not in page.text.partition("In all analyses")[0]


def test_what_rounds_to_nothing_has_no_sign():
    assert interval(-0.0004, 15.0, lambda value: fixed(value, 1)) == "[0.0, 15.0]"
    assert percent_interval(-1e-9, 0.15) == "[0.0, 15.0]" and percent(-1e-9).startswith("0.0")


def test_page_holds_no_number_that_is_none(unfinished):
    _, page = unfinished
    assert not re.search(r"\bnan\b|\bNone\b|\binf\b|\[\[|\]\]|\{|\}", page.text)


def test_title_and_reasons_are_text_and_not_markup(unfinished):
    _, page = unfinished
    assert "A < B & C" in page.text and "StepFailed: <no convergence> at t = 1.2 s" in page.text


def test_what_is_missing_is_said(unfinished):
    _, page = unfinished
    assert "5 of 72 analyses not run yet, 2 failed" in page.text
    assert "65 of 72 analyses are done" in page.text


def test_calibration_target_is_never_shown_as_a_result(unfinished):
    _, page = unfinished
    for place in re.finditer("43.5", page.text):
        assert "calibration target" in page.text[place.start() : place.start() + 60]


def test_every_figure_has_three_files_and_every_table_its_csv(unfinished):
    out, page = unfinished
    names = {path.stem for path in (out / "report" / "figures").iterdir()}
    assert all(
        (out / "report" / "figures" / f"{name}.{kind}").stat().st_size > 1000
        for name in names
        for kind in ("png", "pdf", "svg")
    )
    assert len(names) == sum(one.startswith("data:") for one in page.addresses)
    tables = {path.stem for path in (out / "report" / "tables").iterdir()}
    assert {
        "claims",
        "p_overturn",
        "comparisons",
        "ranking",
        "timing",
        "audit",
        "failures",
        "provenance",
    } <= tables
    assert {f"table-{name}" for name in tables - {"claims"}} <= set(page.ids)


def test_table_of_overturning_agrees_with_the_summaries(unfinished):
    from fecolumn.study.store import read_study

    out, _ = unfinished
    rows = [
        row
        for row in read_study(out).rows
        if row["axes"][DT] == 1e-3 and row["axes"][ALPHA] == -0.333
    ]
    with open(out / "report" / "tables" / "p_overturn.csv") as file:
        found = next(
            row
            for row in csv.DictReader(file)
            if float(row[DT]) == 1e-3 and float(row[ALPHA]) == -0.333
        )
    assert int(found["n"]) == len(rows) == 12
    assert int(found["overturned"]) == sum(row["summary"]["overturned"] for row in rows) > 0
    assert float(found["wilson_low"]) < float(found["p_overturn"]) < float(found["wilson_high"])


@pytest.mark.long
def test_the_same_study_gives_the_same_tables(unfinished, tmp_path):
    out, _ = unfinished
    write_report(out, tmp_path, files=())
    for path in (out / "report" / "tables").iterdir():
        assert (tmp_path / "tables" / path.name).read_bytes() == path.read_bytes()


@pytest.mark.long
@pytest.mark.parametrize(
    "axes, motions",
    [
        ({FRICTION: [0.3]}, 6),
        ({FRICTION: [0.2, 0.4]}, 2),
        ({FRICTION: [0.2, 0.4]}, 1),
        ({FRICTION: [0.2, 0.3, 0.4], "integration.engine": ["reduced", "rigid"]}, 8),
        ({FRICTION: [0.2 + 0.01 * k for k in range(12)]}, 6),
    ],
)
def test_any_study_has_a_report_and_the_claims_only_where_they_can_be_put(tmp_path, axes, motions):
    page = page_alone(write_synthetic(tmp_path / "study", axes, motions))
    assert "Katsamakas" not in page.text and "43.5" not in page.text
    assert (
        "explorer-panel" in page.ids
        and "No histories are at hand." in page.text
        and "figure-fan" not in page.ids
    )
    assert "Provenance" in page.text and not re.search(r"\bnan\b|\bNone\b|\binf\b", page.text)


@pytest.mark.long
def test_sampled_parameters_have_a_ranking(tmp_path):
    """As of a Latin hypercube: every sample has values of its own."""
    import json
    import sqlite3

    out = write_synthetic(
        tmp_path / "study",
        {FRICTION: [0.2 + 0.01 * k for k in range(16)]},
        20,
        effect=lambda v: 0.5 + 10 * (v[FRICTION] - 0.2),
    )
    with sqlite3.connect(out / "study.sqlite") as ledger:
        for case_id, axes in ledger.execute("SELECT id, axes FROM analysis").fetchall():
            values = json.loads(axes)
            values["material.youngs_modulus_pa"] = 2e11 * (
                1 + 0.01 * (round(100 * values[FRICTION]) * 7 % 16)
            )
            ledger.execute(
                "UPDATE analysis SET axes = ? WHERE id = ?", (json.dumps(values), case_id)
            )
    page_alone(out)
    with open(out / "report" / "tables" / "ranking.csv") as file:
        ranks = list(csv.DictReader(file))
    assert [row["axis"] for row in ranks] == [FRICTION, "material.youngs_modulus_pa"]
    assert (
        float(ranks[0]["distance"]) > float(ranks[0]["chance"])
        and float(ranks[0]["change_p_lost"]) > 0.2
    )


def test_nothing_done_and_no_study_are_refused(tmp_path):
    out = write_synthetic(tmp_path / "study", {FRICTION: [0.3]}, 2, unfinished=range(2))
    with pytest.raises(InputError, match="none of its 2 analyses is done"):
        write_report(out)
    assert not (out / "report").exists()
    with pytest.raises(InputError, match="no study"):
        write_report(SPECIMEN.parent)
