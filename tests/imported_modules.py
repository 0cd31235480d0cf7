"""What the package's modules import from one another, functions' own imports included, found
without running them.
"""

import ast
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[1] / "fecolumn"


def module_file(name: str) -> Path | None:
    """Source of a module of the package, None where `name` is none."""
    place = ROOT.parent / name.replace(".", "/")
    return next(
        (file for file in (place.with_suffix(".py"), place / "__init__.py") if file.is_file()), None
    )


def _for_types_alone(node: ast.stmt) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def imports(file: Path, functions: bool = True, types: bool = False) -> Iterable[Path]:
    """Sources of the package's modules that a file imports; `types`: and for types alone."""
    tree = ast.parse(file.read_text())
    tree.body = [node for node in tree.body if types or not _for_types_alone(node)]
    for node in ast.walk(tree) if functions else tree.body:
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if module_file(name) else node.module for name in names]
        else:
            continue
        for name in names:
            if name.split(".")[0] == "fecolumn":
                yield module_file(name)


def closure(*names: str, stop: Iterable[str] = ()) -> set[str]:
    """Sources, such as "fem/body.py", that the named ones import, and they themselves; those of
    `stop` are not followed.
    """
    found, left = set(), list(names)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += (
                [str(file.relative_to(ROOT)) for file in imports(ROOT / name)]
                if name not in stop
                else []
            )
    return found
