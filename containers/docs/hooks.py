"""Pages of the site that are generated, and links as they are on it.

The front page is README.md, the results benchmarks/RESULTS.md; the gallery has every picture that a
page shows, the API the docstrings of the names of `fecolumn`. Tutorials are rendered with what they
printed and showed when tutorials.py ran them (`FECOLUMN_TUTORIALS`: its folder).
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path, PurePosixPath

from mkdocs.structure.files import File

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))

import api  # noqa: E402
import equations  # noqa: E402
import tutorials  # noqa: E402

MANUAL = PurePosixPath("fecolumn/case/manual")
#: pages of the site that are files of the repository elsewhere
PAGES = {"README.md": "index.md", "benchmarks/RESULTS.md": "results.md"}
#: where the theme would load a script from, and where it is on the site
WORKER_ELSEWHERE, WORKER = "https://unpkg.com/iframe-worker/shim", "assets/iframe-worker.js"
LINK = re.compile(
    r"(?P<start>!?\[(?:[^\[\]]|\[[^\]]*\])*\]\()(?P<target>[^)\s#]+)(?P<anchor>#[^)\s]*)?\)"
)

#: a bar that Markdown on GitHub wants marked in the code of a table, and this one does not
PIPE = re.compile(r"(?<=[^\s|])\\\|(?=[^\s|])")


def on_files(files, config):
    """Add pages and files from outside of the manual's folder."""
    for source, place in PAGES.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        files.append(File.generated(config, place, content=relinked(text, source, files, config)))
    for page in [file for file in files if file.src_uri.endswith(".md")]:
        if page.src_uri not in PAGES.values() and page.abs_src_path:
            text = Path(page.abs_src_path).read_text(encoding="utf-8")
            relinked(text, str(MANUAL / page.src_uri), files, config)
    for name in tutorials.names():
        page = File.generated(config, f"tutorials/{name}.md", content=tutorials.page(name))
        files.append(page)
        for place, path in tutorials.pictures(name).items():
            files.append(File.generated(config, place, abs_src_path=str(path)))
    files.append(File.generated(config, "tutorials/index.md", content=tutorials.index()))
    files.append(File.generated(config, "gallery.md", content=gallery()))
    files.append(File.generated(config, "api.md", content=api.page()))
    for name in ("extra.css", "iframe-worker.js"):
        own = str(HERE / name)
        files.append(File.generated(config, f"assets/{name}", abs_src_path=own))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links and equations of a page of the manual."""
    if page.file.src_uri in PAGES.values() or page.file.generated_by:
        return markdown
    text = relinked(markdown, str(MANUAL / page.file.src_uri), files, config)
    return equations.with_equations(text)


def on_page_content(html, page, config, files):
    """What tutorials printed and showed goes in when the Markdown has been read."""
    return tutorials.with_outputs(html)


def relinked(text: str, source: str, files, config) -> str:
    """A text whose links lead to pages of the site, and to copies of the repository's files."""
    here = PurePosixPath(source).parent
    page = PAGES.get(source) or str(PurePosixPath(source).relative_to(MANUAL))

    def link(found) -> str:
        target = found["target"]
        if "://" in target or target.startswith("mailto:"):
            return found[0]
        place = os.path.normpath(here / target)
        there = place_on_site(place, files, config)
        way = os.path.relpath(there, PurePosixPath(page).parent)
        return f"{found['start']}{way}{found['anchor'] or ''})"

    parts = re.split(r"(^```.*?^```$)", text, flags=re.MULTILINE | re.DOTALL)
    parts[::2] = [PIPE.sub(r"|", LINK.sub(link, part)) for part in parts[::2]]
    return "".join(parts)


def place_on_site(place: str, files, config) -> str:
    """Where a file of the repository is on the site; files that are no pages are copied to it."""
    if place in PAGES:
        return PAGES[place]
    if place.startswith(f"{MANUAL}/"):
        inside = str(PurePosixPath(place).relative_to(MANUAL))
        return f"{inside[:-3]}.md" if inside.endswith(".py") else inside
    copy = f"files/{place}"
    if not files.get_file_from_path(copy):
        files.append(File.generated(config, copy, abs_src_path=str(ROOT / place)))
    return copy


def gallery() -> str:
    """Every picture of README and manual with its words and the page that explains it."""
    shown: dict[str, str] = {}
    for path in [*sorted((ROOT / MANUAL).glob("*.md")), ROOT / "README.md"]:
        source = path.relative_to(ROOT).as_posix()
        text = path.read_text(encoding="utf-8")
        page = PAGES.get(source) or path.name
        for words, name in re.findall(r"!\[([^]]*)\]\(([^)\s]+)\)", text):
            place = os.path.normpath(PurePosixPath(source).parent / name)
            inside = place.startswith(f"{MANUAL}/")
            there = str(PurePosixPath(place).relative_to(MANUAL)) if inside else f"files/{place}"
            picture = f"[![{words}]({there})]({page})"
            shown.setdefault(there, f"-   {picture}\n\n    {words}. [{title(text)}]({page})\n")
    return "\n".join(
        [
            "# Gallery\n",
            "Each picture leads to the page that explains it.\n",
            '<div class="grid cards gallery" markdown>\n',
            *shown.values(),
            "</div>\n",
        ]
    )


def title(text: str) -> str:
    """Title of a page."""
    return text.partition("\n")[0].removeprefix("# ").partition(":")[0]


def on_post_page(output, page, config):
    """The script with which a page opened from its file can be searched, from the site itself."""
    return output.replace(WORKER_ELSEWHERE, f"{'../' * page.url.count('/')}{WORKER}")


def on_post_template(output_content, template_name, config):
    """Likewise in the page of an address that is not there."""
    return output_content.replace(WORKER_ELSEWHERE, WORKER)
