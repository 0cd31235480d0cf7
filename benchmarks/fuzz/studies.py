"""Study files."""

from __future__ import annotations

from benchmarks.fuzz import cases
from benchmarks.fuzz.damage import toml
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import write_ensemble
from fecolumn.motions.load import read_motion
from fecolumn.study.plan import read_plan
from fecolumn.study.run import check_motions

_STUDY = """title = "all"
[case]
extends = "case.toml"
[axes]
"integration.dt_s" = [0.02, 1e-3]
"motion.source" = ["motion.csv", "motions.h5#*"]
"cap.length_m" = [0.15, 0.2]
[[zip]]
"column.height_m" = [1.0, 1.5]
"base.length_m" = [0.3, 0.4]
[latin_hypercube]
samples = 3
seed = 1
"contact.friction_coefficient" = [0.2, 0.8]
"material.youngs_modulus_pa" = [1e10, 2e11, "log"]
"""
_MOST_CHECKED = 200  # a plan of more is refused or read, its motions are not


def prepare(folder) -> None:
    """A study with every kind of axis."""
    cases.prepare(folder)
    (folder / "study.toml").write_text(_STUDY)
    motion = read_motion(cases.load_case(folder / "case.toml").motion, "")
    write_ensemble(Ensemble("two", (motion, motion), {}, {}), folder / "motions.h5")


def sound(folder):
    """The study as it is."""
    return folder / "study.toml"


def mutate(rng, folder):
    """The study's file, or now and then its case's."""
    if rng.random() < 0.2:
        cases.mutate(rng, folder)
    else:
        (folder / "study.toml").write_bytes(toml(rng, _STUDY))
    return folder / "study.toml"


def use(path) -> None:
    """What `fecolumn study` does before anything runs."""
    plan = read_plan(path)
    assert plan.id
    if len(plan.analyses) <= _MOST_CHECKED:
        check_motions(plan)
