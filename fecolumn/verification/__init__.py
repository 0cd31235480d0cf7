"""Cases with an exact answer, beside what the engines compute. One module a case: run(engine, long) returns its Result."""

#: Engines of the suite, as the key integration.kinematics names them.
ALL_ENGINES = ("corotated", "total_lagrangian")
#: Modules of this package that hold a case, in the order of the table, with the engines it applies to.
CASES = {
    "patch": ALL_ENGINES, "hertz": ALL_ENGINES, "bar_impact": ALL_ENGINES, "hht_scheme": ALL_ENGINES, "elastodynamics": ALL_ENGINES,
    "sliding": ALL_ENGINES, "rocking": ALL_ENGINES, "wobbling": ALL_ENGINES, "frames": ALL_ENGINES, "scaling": ALL_ENGINES,
    "invariance": ALL_ENGINES, "ledger": ALL_ENGINES,
}
