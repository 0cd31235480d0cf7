"""Links of a built site: each file and each anchor that a page leads to is there."""

from __future__ import annotations

import os
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# links of a page's head that no browser loads
UNLOADED = {("link", "canonical"), ("link", "prev"), ("link", "next"), ("link", "alternate")}


class _Page(HTMLParser):
    """Targets and anchors of one page."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = set()
        self.loaded: list[str] = []

    def handle_starttag(self, tag, attrs) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.targets.append(value)
                if "://" in value[:9] and (
                    tag != "a" and (tag, dict(attrs).get("rel")) not in UNLOADED
                ):
                    self.loaded.append(value)
            elif name in ("id", "name") and value:
                self.anchors.add(value)


def broken_links(site: Path) -> list[str]:
    """Links of the pages below a folder that lead nowhere, and what would be loaded from another
    server: page and target, a line each.
    """
    pages = {}
    for path in sorted(site.rglob("*.html")):
        page = _Page()
        page.feed(path.read_text(encoding="utf-8"))
        pages[path] = page
    broken = []
    for path, page in pages.items():
        if path.name == "404.html":  # its links are meant from the top of a server
            continue
        broken += [f"{path.relative_to(site)}: loads {target}" for target in page.loaded]
        for target in page.targets:
            to = urlsplit(target)
            if to.scheme or to.netloc:
                continue
            there = Path(os.path.normpath(path.parent / unquote(to.path))) if to.path else path
            if there.is_dir():
                there = there / "index.html"
            if not there.is_file() or (
                to.fragment and there in pages and unquote(to.fragment) not in pages[there].anchors
            ):
                broken.append(f"{path.relative_to(site)}: {target}")
    return broken
