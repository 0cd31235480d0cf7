"""Sections of a report as one HTML page that needs nothing beside it."""

from __future__ import annotations

from pathlib import Path

from fecolumn.study.report.document import PageSection, numbered, referenced
from fecolumn.study.report.notation import typeset


def page_html(title: str, byline: str, abstract: str, sections: list[PageSection]) -> str:
    """The page: its title, a line below it, a paragraph that says what was found, and sections,
    whose figures and tables are linked in figures/ and tables/ beside it.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    pages = Environment(
        loader=PackageLoader("fecolumn.study.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
    )
    labels = numbered(sections)

    def files(*names: str) -> Markup:
        return Markup("\n".join((Path(__file__).parent / name).read_text() for name in names))

    return pages.get_template("page.html").render(
        title=title,
        byline=byline,
        abstract=abstract,
        sections=sections,
        labels=labels,
        style=files("page.css", "explorer.css"),
        script=files("chart.js", "explorer.js"),
        plain=lambda words: referenced(words, labels),
        text=lambda words: typeset(referenced(words, labels)),
    )
