"""Which tables and figures hold motions that a count of `PHYSICS` has changed."""

from __future__ import annotations

from fnmatch import fnmatchcase

from fecolumn.foundation.sources import PHYSICS

#: By the number that a change brought: patterns of the names of tables and of the places of figures
#: that hold cases which it touches. All others hold the same motions as before, but for rounding.
TOUCHED: dict[int, tuple[str, ...]] = {
    # modes of one frequency are kept together, and none is missed: bodies of which half a pair was
    # kept, or one of a pair not found
    13: (
        "calibration",
        "examples",
        "fragility",
        "fragility_pairs",
        "fragility_periods",
        "fragility_velocities",
        "fragility/elastic-monolith",
        "fragility/elastic-trilith",
        "impact_formula",
        "impact_map",
        "impact_map_checks",
        "jobs_answers",
        "outcomes",
        "outcomes_surface",
        "programs",
        "programs_pairs",
        "programs/trilith-reduced-*",
        "quick_study",
        "quick_study_pair",
        "shaken",
        "benchmarks/cdf.png",
        "benchmarks/fragility.png",
        "fecolumn/case/manual/impact-map.png",
        "meshes/rocking.png",
    ),
}


def holds(name: str, physics: str) -> bool:
    """Whether the motions in a table or figure are today's, by the PHYSICS of the code that made
    it, "none" where no motion of fecolumn enters; of a number not listed all are touched.
    """
    if physics == "none":
        return True
    since = range(int(physics) + 1, PHYSICS + 1)
    return not any(fnmatchcase(name, one) for n in since for one in TOUCHED.get(n, ("*",)))
