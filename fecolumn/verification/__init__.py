"""Cases with an exact answer, beside what the engines compute.

One module a case: run(engine, long) returns its Result.
"""

#: Engines of the suite: the two kinematics of the full order, the reduced engine with and without
#: modes, and rocking models of rigid bodies.
FULL, REDUCED, _MODELS = ("corotated", "total_lagrangian"), ("reduced", "rigid"), ("models",)
ELEMENTS = FULL + REDUCED
ALL_ENGINES = ELEMENTS + _MODELS
#: Modules of this package that hold a case, in the order of the table, with the engines it applies
#: to; the manual (theory) says why.
CASES = {
    "patch": FULL,
    "hertz": FULL,
    "bar_impact": (*FULL, "reduced"),
    "hht_scheme": (*FULL, "reduced"),
    "elastodynamics": FULL,
    "sliding": ELEMENTS,
    "rocking": ELEMENTS,
    "wobbling": ELEMENTS,
    "frames": (*FULL, "reduced"),
    "scaling": (*FULL, "reduced"),
    "invariance": (*FULL, "reduced"),
    "ledger": (*FULL, "reduced"),
    "several_bodies": ("rigid",),
    "joints": ("corotated", *REDUCED),
    "any_joint": REDUCED,
    "structures": ("reduced",),
    "structures_feet": REDUCED,
    "devices": REDUCED,
    "full_structures": ("corotated",),
    "rocking_models": _MODELS,
    "rocking_tables": _MODELS,
    "wobbling_models": _MODELS,
    "podium": _MODELS,
    "masonry": _MODELS,
}
