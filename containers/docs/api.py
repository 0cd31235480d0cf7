"""The page of the public names of `fecolumn`, from their docstrings by mkdocstrings."""

from __future__ import annotations

import fecolumn

INTRODUCTION = """# API: the public names

Each name is imported from `fecolumn`. [Python](python.md) shows how they are used. Keys of the
classes are those of a [case](cases.md); the [table of keys](keys.md) has the same words.
"""
#: headings with their names, in the order of the page; a name that is new has to be put below one
GROUPS = {
    "Cases and analyses": (
        "Case case_from_tables load_case run load AnalysisResult AnalysisPlots Picture Parting "
        "QuantityPair read_history"
    ).split(),
    "Studies and questions": (
        "run_study StudyResult StudyPlots design risk screen calibrate Answer ecdf Ecdf percentile "
        "proportion_interval outcomes"
    ).split(),
    "Bodies": (
        "Block Cylinder Tube Cone Plate Prism Arch MeshBody Storeys Matrices Flange Cap".split()
    ),
    "Joints, grounds, materials": "Joint Ground Material Initial".split(),
    "Links": ("Link Tendon Spring Restrainer Strut GapStop Dashpot FrictionDamper".split()),
    "Other sections of a case": ("Motion Contact Integration Overturn Output MeshLimits".split()),
    "A column in the short form": "ShortForm Column Base MeshSizes".split(),
    "Models of rigid bodies": (
        "BlockModel FrameModel PodiumModel WobblingModel WobblingFrameModel".split()
    ),
    "Motions": "motion_file load_motion GroundMotion AliasingWarning".split(),
    "Errors": "InputError AnalysisFailed StudyError".split(),
}


def page() -> str:
    """Markdown of the page.

    Raises
    ------
    ValueError
        a public name stands below no heading, or one that is none does.
    """
    told = [name for names in GROUPS.values() for name in names]
    if odd := set(told) ^ set(fecolumn.__all__):
        raise ValueError(f"containers/docs/api.py: GROUPS: {', '.join(sorted(odd))}")
    parts = [INTRODUCTION]
    for heading, names in GROUPS.items():
        parts.append(f"## {heading}\n")
        parts += [f"::: fecolumn.{name}\n" for name in names]
    return "\n".join(parts)
