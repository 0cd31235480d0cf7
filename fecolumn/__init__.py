"""Rocking and sliding of free-standing structures: finite-element contact dynamics, judged by
statistics.

Units are SI everywhere. z points up, gravity along -z; displacements are relative to the base. A
gap is positive when open, a contact pressure positive in compression.

A case is a file, `load_case(path)`, or is made of parts whose help tells every key:

    import fecolumn

    case = fecolumn.Case(
        bodies={"drum": fecolumn.Cylinder(outer_diameter_m=0.5, height_m=1.6)},
        joints={"foot": fecolumn.Joint(between=("drum", "ground"), friction_coefficient=0.6)},
        motion=fecolumn.Motion("lick:1"),
    )
    fecolumn.run(case, "drum")
    result = fecolumn.load("drum")

`fecolumn help python` has the rest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fecolumn.foundation.version import __version__ as __version__

if TYPE_CHECKING:
    from fecolumn.case.bodies import (
        Arch,
        Block,
        Cone,
        Cylinder,
        Matrices,
        MeshBody,
        Plate,
        Prism,
        Storeys,
        Tube,
    )
    from fecolumn.case.case import Case, case_from_tables, load_case
    from fecolumn.case.column_keys import Base, Column, MeshSizes
    from fecolumn.case.ground import Ground
    from fecolumn.case.joint import Joint
    from fecolumn.case.link import Link
    from fecolumn.case.link_kinds import (
        Dashpot,
        FrictionDamper,
        GapStop,
        Restrainer,
        Spring,
        Strut,
        Tendon,
    )
    from fecolumn.case.mesh_limits import MeshLimits
    from fecolumn.case.model_sections import (
        BlockModel,
        FrameModel,
        PodiumModel,
        WobblingFrameModel,
        WobblingModel,
    )
    from fecolumn.case.sections import (
        Cap,
        Contact,
        Flange,
        Initial,
        Integration,
        Material,
        Motion,
        Output,
        Overturn,
    )
    from fecolumn.case.short_form import ShortForm
    from fecolumn.engines.dynamics.history import read_history
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.array import motion_file
    from fecolumn.motions.load import load_motion
    from fecolumn.motions.processing import AliasingWarning
    from fecolumn.motions.record import GroundMotion
    from fecolumn.simulation import AnalysisFailed, run
    from fecolumn.statistics.ecdf import Ecdf, ecdf, percentile, proportion_interval
    from fecolumn.study.questions.answer import Answer
    from fecolumn.study.questions.script import calibrate, design, risk, screen
    from fecolumn.study.results.analysis import AnalysisResult
    from fecolumn.study.results.analysis_plots import AnalysisPlots
    from fecolumn.study.results.load import load
    from fecolumn.study.results.outcomes import outcomes
    from fecolumn.study.results.parting import Parting, QuantityPair
    from fecolumn.study.results.picture import Picture
    from fecolumn.study.results.script import run_study
    from fecolumn.study.results.study import StudyPlots, StudyResult
    from fecolumn.study.run import StudyError

__all__ = [
    "AliasingWarning",
    "AnalysisFailed",
    "AnalysisPlots",
    "AnalysisResult",
    "Answer",
    "Arch",
    "Base",
    "Block",
    "BlockModel",
    "Cap",
    "Case",
    "Column",
    "Cone",
    "Contact",
    "Cylinder",
    "Dashpot",
    "Ecdf",
    "Flange",
    "FrameModel",
    "FrictionDamper",
    "GapStop",
    "Ground",
    "GroundMotion",
    "Initial",
    "InputError",
    "Integration",
    "Joint",
    "Link",
    "Material",
    "Matrices",
    "MeshBody",
    "MeshLimits",
    "MeshSizes",
    "Motion",
    "Output",
    "Overturn",
    "Parting",
    "Picture",
    "Plate",
    "PodiumModel",
    "Prism",
    "QuantityPair",
    "Restrainer",
    "ShortForm",
    "Spring",
    "Storeys",
    "Strut",
    "StudyError",
    "StudyPlots",
    "StudyResult",
    "Tendon",
    "Tube",
    "WobblingFrameModel",
    "WobblingModel",
    "calibrate",
    "case_from_tables",
    "design",
    "ecdf",
    "load",
    "load_case",
    "load_motion",
    "motion_file",
    "outcomes",
    "percentile",
    "proportion_interval",
    "read_history",
    "risk",
    "run",
    "run_study",
    "screen",
]

# module of each name, as imported above
_HOMES = {
    "Arch": "case.bodies",
    "Block": "case.bodies",
    "Cone": "case.bodies",
    "Cylinder": "case.bodies",
    "Ground": "case.ground",
    "Joint": "case.joint",
    "Link": "case.link",
    "Matrices": "case.bodies",
    "MeshBody": "case.bodies",
    "MeshLimits": "case.mesh_limits",
    "Plate": "case.bodies",
    "Prism": "case.bodies",
    "Storeys": "case.bodies",
    "Tube": "case.bodies",
    "Case": "case.case",
    "case_from_tables": "case.case",
    "load_case": "case.case",
    "Dashpot": "case.link_kinds",
    "FrictionDamper": "case.link_kinds",
    "GapStop": "case.link_kinds",
    "Restrainer": "case.link_kinds",
    "Spring": "case.link_kinds",
    "Strut": "case.link_kinds",
    "Tendon": "case.link_kinds",
    "Cap": "case.sections",
    "Contact": "case.sections",
    "Flange": "case.sections",
    "Initial": "case.sections",
    "Integration": "case.sections",
    "Material": "case.sections",
    "Motion": "case.sections",
    "Output": "case.sections",
    "Overturn": "case.sections",
    "Base": "case.column_keys",
    "Column": "case.column_keys",
    "MeshSizes": "case.column_keys",
    "ShortForm": "case.short_form",
    "read_history": "engines.dynamics.history",
    "BlockModel": "case.model_sections",
    "FrameModel": "case.model_sections",
    "WobblingModel": "case.model_sections",
    "WobblingFrameModel": "case.model_sections",
    "PodiumModel": "case.model_sections",
    "InputError": "foundation.schema",
    "motion_file": "motions.array",
    "load_motion": "motions.load",
    "AliasingWarning": "motions.processing",
    "AnalysisFailed": "simulation",
    "run": "simulation",
    "Ecdf": "statistics.ecdf",
    "proportion_interval": "statistics.ecdf",
    "percentile": "statistics.ecdf",
    "ecdf": "statistics.ecdf",
    "AnalysisPlots": "study.results.analysis_plots",
    "AnalysisResult": "study.results.analysis",
    "load": "study.results.load",
    "outcomes": "study.results.outcomes",
    "run_study": "study.results.script",
    "design": "study.questions.script",
    "risk": "study.questions.script",
    "screen": "study.questions.script",
    "calibrate": "study.questions.script",
    "Answer": "study.questions.answer",
    "GroundMotion": "motions.record",
    "Parting": "study.results.parting",
    "QuantityPair": "study.results.parting",
    "Picture": "study.results.picture",
    "StudyError": "study.run",
    "StudyPlots": "study.results.study",
    "StudyResult": "study.results.study",
}


# names of earlier versions, and those of this one
_OLDER = {"read_case": "load_case"}


def __getattr__(name: str) -> object:
    """Import on first use, so that `fecolumn --help` does not wait for dolfinx."""
    import importlib

    if name in _OLDER:
        from fecolumn.foundation.deprecated import warn_of_older_name

        warn_of_older_name("script", f"fecolumn.{name}", f"fecolumn.{_OLDER[name]}")
        name = _OLDER[name]
    if name not in _HOMES:
        raise AttributeError(f"module fecolumn has no attribute {name!r}")
    return getattr(importlib.import_module(f"fecolumn.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
