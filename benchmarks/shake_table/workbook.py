"""First sheet of an .xlsx workbook as rows of cells; numbers and texts only, which is all that a
table of tests needs.
"""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

_SPACE = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"


def first_sheet(path: Path) -> list[dict[str, str]]:
    """Rows of the first sheet, each a dict of column letter to text; empty cells and empty rows are
    left out.

    Raises
    ------
    ValueError
        not an .xlsx workbook.
    """
    try:
        with zipfile.ZipFile(path) as book:
            shared = _shared(book)
            sheet = ElementTree.fromstring(book.read("xl/worksheets/sheet1.xml"))
    except (zipfile.BadZipFile, KeyError, ElementTree.ParseError) as error:
        raise ValueError(f"{path}: not an .xlsx workbook ({error})") from None
    rows = []
    for line in sheet.iter(_SPACE + "row"):
        cells = {
            re.match("[A-Z]+", cell.get("r"))[0]: _text(cell, shared)
            for cell in line.iter(_SPACE + "c")
        }
        if cells := {column: text.strip() for column, text in cells.items() if text.strip()}:
            rows.append(cells)
    return rows


def _shared(book: zipfile.ZipFile) -> list[str]:
    if "xl/sharedStrings.xml" not in book.namelist():
        return []
    return [
        _joined(entry)
        for entry in ElementTree.fromstring(book.read("xl/sharedStrings.xml")).iter(_SPACE + "si")
    ]


def _joined(entry) -> str:
    return "".join(part.text or "" for part in entry.iter(_SPACE + "t"))


def _text(cell, shared: list[str]) -> str:
    if cell.get("t") == "inlineStr":
        return _joined(cell)
    value = cell.find(_SPACE + "v")
    if value is None:
        return ""
    return shared[int(value.text)] if cell.get("t") == "s" else value.text
