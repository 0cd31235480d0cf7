"""Packages stand one above the other: none imports from those above it, not even inside a
function.
"""

import pytest
from imported_modules import ROOT, closure, imports

# From the bottom to the top; simulation is the module that chooses an engine
ORDER = (
    "material",
    "mesh",
    "fem",
    "contact",
    "dynamics",
    "reduced",
    "rocking",
    "simulation",
    "render",
    "study",
    "report",
)
# What else a package must not import: data are not judged where they are made, and statistics know
# numbers alone
APART = {
    "statistics": {"study", "report", "post", "reduced", "dynamics", "contact", "fem", "mesh"},
    "post": {"study", "report"},
    "motions": {
        "study",
        "report",
        "statistics",
        "mesh",
        "fem",
        "contact",
        "dynamics",
        "reduced",
        "rocking",
    },
}
FORBIDDEN = {name: set(ORDER[place + 1 :]) for place, name in enumerate(ORDER)} | APART


def _files(package):
    return sorted((ROOT / package).glob("*.py")) or [ROOT / f"{package}.py"]


@pytest.mark.parametrize("package", FORBIDDEN)
def test_package_imports_from_none_above_it(package):
    found = {
        f"{file.relative_to(ROOT)} imports {other.relative_to(ROOT)}"
        for file in _files(package)
        for other in imports(file)
        if other.relative_to(ROOT).parts[0].removesuffix(".py") in FORBIDDEN[package]
    }
    assert not found


def test_engines_do_not_reach_back_to_what_chooses_them():
    engines = [
        str(file.relative_to(ROOT))
        for package in ("dynamics", "reduced")
        for file in _files(package)
    ]
    assert "simulation.py" not in closure(*engines)


def test_imports_inside_functions_are_seen():
    assert ROOT / "reduced" / "analysis.py" in set(imports(ROOT / "simulation.py")) - set(
        imports(ROOT / "simulation.py", functions=False)
    )
