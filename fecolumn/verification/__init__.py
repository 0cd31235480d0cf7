"""Cases with an exact answer, beside what the engines compute. One module a case: run(engine, long) returns its Result."""

#: Engines of the suite: the two kinematics of the full order, and the reduced engine with and without modes.
FULL, REDUCED = ("corotated", "total_lagrangian"), ("reduced", "rigid")
ALL_ENGINES = FULL + REDUCED
#: Modules of this package that hold a case, in the order of the table, with the engines it applies to; the manual (theory) says why.
CASES = {
    "patch": FULL, "hertz": FULL, "bar_impact": (*FULL, "reduced"), "hht_scheme": (*FULL, "reduced"), "elastodynamics": FULL,
    "sliding": ALL_ENGINES, "rocking": ALL_ENGINES, "wobbling": ALL_ENGINES, "frames": (*FULL, "reduced"),
    "scaling": (*FULL, "reduced"), "invariance": (*FULL, "reduced"), "ledger": (*FULL, "reduced"),
}
