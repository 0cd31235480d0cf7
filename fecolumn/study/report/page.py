"""The report of a study: its sections put together and written as one HTML page with figures and
tables beside it.
"""

from __future__ import annotations

import datetime
from collections.abc import Iterable
from pathlib import Path

from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.folder import written
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.records import run_count
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.all_motions import all_motions
from fecolumn.study.report.audit import audit, failed_note
from fecolumn.study.report.claim import MARGIN, SUPPORTED, Claim, ClaimList
from fecolumn.study.report.cost import cost_claims
from fecolumn.study.report.distribution_claims import distribution_claims
from fecolumn.study.report.distributions import distributions
from fecolumn.study.report.document import (
    PageColumn,
    PageSection,
    PageTable,
    Paragraph,
)
from fecolumn.study.report.explorer import explorer
from fecolumn.study.report.fragility import fragility
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.histories import read_histories
from fecolumn.study.report.html import page_html
from fecolumn.study.report.incremental import incremental
from fecolumn.study.report.individual import individual
from fecolumn.study.report.individual_claims import individual_claims
from fecolumn.study.report.intensity import Intensities
from fecolumn.study.report.link_section import bond_section, link_section
from fecolumn.study.report.models import models
from fecolumn.study.report.notation import axis_name, count, percent
from fecolumn.study.report.overturning_table import TARGET_NOTE
from fecolumn.study.report.pair import ComparedPair, read_pairs
from fecolumn.study.report.podium import podium
from fecolumn.study.report.power import power
from fecolumn.study.report.provenance import provenance
from fecolumn.study.report.sensitivity import sensitivity_section
from fecolumn.study.report.specimen import specimen
from fecolumn.study.report.sweep import DT_KEY, Sweep, read_sweep
from fecolumn.study.report.timing import timing
from fecolumn.study.store import DONE, FAILED


def write_report(
    folder: Path | str, output: Path | str | None = None, files: Iterable[str] = ("pdf", "png")
) -> Path:
    """Write index.html, its figures and its tables into `output`, or folder/report; returns the
    page.

    Parameters
    ----------
    files
        formats in which every figure lies beside the page, besides the SVG that the page shows;
        none for the words and tables alone, in half the time.

    Raises
    ------
    InputError
        the folder holds no study, or none of its analyses is done; `output` is neither new nor
        empty nor of an earlier report.
    """
    sweep = read_sweep(folder)
    if not sweep.done:
        raise InputError(
            folder,
            "",
            None,
            f"none of its {sweep.analyses} analyses is done; nothing to report yet",
        )
    target = Path(output) if output else Path(folder) / "report"
    with written(target, "report", alone=True) as draft:
        for part in ("figures", "tables"):
            (draft / part).mkdir()
        sections = _sections(sweep, Gallery(draft / "figures", has_claims(sweep), tuple(files)))
        for section in sections:
            for block in section.blocks:
                if isinstance(block, (PageTable, ClaimList)):
                    block.write_csv(draft / "tables")
        html = page_html(sweep.title, _byline(sweep), _abstract(sweep, sections), sections)
        write_bytes(draft / "index.html", html.encode())
    return target / "index.html"


def has_claims(sweep: Sweep) -> bool:
    """Whether the paper's claims can be put to the study: it varies the time step and alpha_HHT."""
    return DT_KEY in sweep.varied and ALPHA_KEY in sweep.varied


def claims_of(sweep: Sweep, pairs: list[ComparedPair]) -> list[Claim]:
    """The paper's claims (a) to (d) put to the study."""
    return [
        *individual_claims(sweep, (DT_KEY, ALPHA_KEY)),
        *distribution_claims(pairs, sweep.alpha_note),
        *cost_claims(sweep),
    ]


def _sections(sweep: Sweep, gallery: Gallery) -> list[PageSection]:
    pairs = read_pairs(sweep)
    claims = claims_of(sweep, pairs) if gallery.paper else []
    intensities, histories = Intensities(sweep.folder), read_histories(sweep)
    parts = [
        specimen(sweep, gallery, intensities),
        _claims_section(sweep, claims) if claims else None,
        distributions(sweep, pairs, gallery),
        models(sweep, gallery),
        podium(sweep, gallery),
        all_motions(sweep, histories, gallery),
        explorer(sweep, histories),
        individual(sweep, gallery),
        link_section(sweep),
        bond_section(sweep),
        sensitivity_section(sweep, gallery),
        incremental(sweep, gallery, intensities),
        fragility(sweep, gallery, intensities),
        timing(sweep, gallery),
        audit(sweep, gallery),
        provenance(sweep),
    ]
    return [part for part in parts if part]


def _claims_section(sweep: Sweep, claims: list[Claim]) -> PageSection:
    text = (
        "Katsamakas and Vassiliou (COMPDYN) ran 115 bidirectional motions at three "
        "time steps and five values of α, and found (a) that "
        "single peaks depend on both without trend, (b) that the distribution does not "
        "depend on the time step once it is small, (c) "
        "that α is then marginal, (d) what it costs. On their P(overturn): "
        f"{TARGET_NOTE}. What follows judges each finding on this "
        "study by a rule stated beforehand; “supported” says that this study shows the "
        "same, “undecided” that it cannot tell."
    )
    table = PageTable(
        "verdicts",
        (
            PageColumn("claim", "claim", text=True),
            PageColumn("paper", "the paper’s finding", text=True),
            PageColumn(
                "verdict",
                "here",
                lambda verdict: verdict.replace(" ", "\N{NO-BREAK SPACE}"),
                text=True,
            ),
        ),
        [(claim.key, claim.paper, claim.verdict) for claim in claims],
        "The paper’s findings and this study’s verdicts.",
    )
    return PageSection(
        "The paper’s findings",
        [Paragraph(text), power(sweep, MARGIN, ", those of the paper"), table, ClaimList(claims)],
    )


def _byline(sweep: Sweep) -> str:
    return (
        f"fecolumn, {datetime.date.today():%-d %B %Y}. "
        f"{count(sweep.analyses, 'analysis')}: {count(len(sweep.settings), 'setting')} "
        "× "
        f"{run_count(len(sweep.motions), sweep.records, 'motion')}"
    )


def _abstract(sweep: Sweep, sections: list[PageSection]) -> str:
    done, failed, total = (
        sum(row["state"] == DONE for row in sweep.rows),
        sum(row["state"] == FAILED for row in sweep.rows),
        sweep.analyses,
    )
    shares = {id(setting): setting.column("overturned").mean() for setting in sweep.done}
    low, high = min(shares.values()), max(shares.values())
    parts = [
        f"{run_count(len(sweep.motions), sweep.records, 'ground motion')} "
        f"{'was' if len(sweep.motions) == 1 else 'were'} run through "
        f"{sweep.subject.article}"
        + (
            f", varying {_listed([axis_name(axis) for axis in sweep.varied])} in "
            f"{count(len(sweep.settings), 'setting')}."
            if sweep.varied
            else "."
        )
    ]
    if done < total:
        parts.append(
            f"{total - done - failed} of {total} analyses not run yet"
            + (f", {failed} failed." if failed else ".")
            if total - done - failed
            else f"{failed} of {total} analyses failed."
        )
    if failed:
        parts.append(failed_note(sweep))
    if sweep.cut:
        parts.append(f"{sweep.cut}.")
    over = sweep.reference.column("overturned")
    bounds = sweep.reference.overturning()
    if len(sweep.done) > 1:
        parts.append(
            f"P(overturn) lies between {percent(low)} and {percent(high)}; "
            f"{sweep.at(sweep.reference.values)} it is "
            f"{percent(over.mean())} (95 % interval {percent(bounds[0])} to {percent(bounds[1])})."
        )
    else:
        parts.append(
            f"P(overturn) is {percent(over.mean())} (95 % interval {percent(bounds[0])} "
            f"to {percent(bounds[1])})."
        )
    claim_list = next(
        (block for section in sections for block in section.blocks if isinstance(block, ClaimList)),
        None,
    )
    if claim_list:
        claims = claim_list.claims
        tally = {
            verdict: [claim.key for claim in claims if claim.verdict == verdict]
            for verdict in dict.fromkeys(c.verdict for c in claims)
        }
        parts.append(
            f"Of {len(claims)} findings of {claim_list.authors} put to it, "
            + _listed(
                [
                    f"{len(keys)} {'is' if len(keys) == 1 else 'are'} {verdict}"
                    + ("" if verdict == SUPPORTED else f" ({'; '.join(keys)})")
                    for verdict, keys in tally.items()
                ]
            )
            + "."
        )
    return " ".join(parts)


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
