"""Shares, times and ratios in the manual that no cell of a table has to hold, by the words around
them, page by page.
"""

#: What is given: defaults, limits, definitions, systems, what others published
DEFINED = {
    "algorithm": (
        "on it gives alone: RIGID_GIVE dt²/2 times the mean of ⅓",
        "iteration whose residual exceeds 1000 times the first one",
        "by rounding (2e-16 |Θ|), at most 50 times; a change below",
        "along the face of k_s A. Each is 2000 times as long as the",
        "violation that is always small enough | 400 times the rounding of",
    ),
    "cases": (
        "smaller side thick, which reaches 1.5 times the foot's larger",
        "largest tilt after them, by less than 5 %. `fecolumn run`",
        "largest tilt after differ by less than 5 %, and the standard",
        "all. Where a step takes more than 50 ms, `run` prints",
    ),
    "motions": ("warns if the peak rises by more than 2 %. To join the rows",),
    "outputs": (
        "between them is wrong by more than 1 %. - Impacts lost",
        "more than 1.25 times what rigid bodies",
        "step, nor where nothing rocks by 2 % of its critical",
        "two at least, that is nearest to 10 ms: 10 ms of steps",
        "of 1 ms or shorter that",
        "divide 5 ms, 8 ms of 2 or",
        "4 ms, 20 ms of 10 ms.",
        "`tension_84_n` | N | value that 84 % of the analyses",
        "`tension_84_pa` | Pa | value that 84 % of the analyses",
        "`ds5_75_s` | s | time between 5 and 75 % of the Arias intensity",
        "| `ds5_95_s` | s | between 5 and 95 % | | `cav_m_s`",
        "`ds5_75_s` | s | time between 5 and 75 % of it |",
    ),
    "pictures": (
        "pushes upwards. They are means over 40 ms, or four rows",
        "between two pictures (of stills over 10 ms), at least over",
        "edge, they must also have turned by 5 % of the largest",
        "the centre of pressure is within 0.4 % of the face's",
        "fields if their interval is at most 1.5 times that between two",
        "`auto` the largest is drawn as about 5 % of the height.",
    ),
    "questions": (
        "where the observed share falls below 10 %. That the limit",
        "is satisfied is shown, at 5 %, only from the",
        '< SHARE"`, the share as 0.1 or `10 %`; `<=` is taken,',
        "body's centre of mass in space, over 10 ms ([outputs]",
        "size: the values that a test at 5 % does not reject.",
        "than 3.84 (1 - p)/p motions (35 for p = 0.1) none can show",
        "`beyond_curve_most`, and printed where it is above 1 %. A warning says",
        "times at most. As many trials within 0.5 % of the range about",
    ),
    "rocking-structures": ("T_1 = n/10 s; Rayleigh damping of 5 % in modes 1 and",),
    "rocking": ("have no growing part, θ − α + θ'/p = 0. - **Spectra.**",),
    "statistics": ("error, so the error (`--error`, 5 %) is divided among",),
    "structures": (
        "base acceleration rises in 3 s to 1.03 times 0.159858 g, the",
        "are turned, specks of less than 0.1 % of the area are",
        "out, and a foot uneven by less than 0.2 % of the height",
        "although flat elements miss up to 5 % of its volume",
        "faces of the elements miss more than 1 % of that volume,",
    ),
    "studies": (
        "writes a row of `history.h5` every 5 ms unless its case",
        "that fell: for u84 where more than 16 % fell, for u50",
        "more than half, for u16 more than 84 %. - `closure`:",
        "much a line may miss a row at most (0.2 % of the largest",
        "which is then below 15 MB. Where 2 % does not do either,",
    ),
    "theory": ("(0.37) | | | | reduced, modal damping 2 % | 0.9969 | 1.39",),
}
#: What tests of the code or `fecolumn verify` hold, beside a closed form or known values
TESTED = {
    "pictures": ("as a rule leaves out no more than 1 %. *deformation",),
    "questions": (
        "holds the true frequency in about 95 of 100. For `fragility.csv`",
        "intervals, which are narrower than 5 % of them, in a",
        "mrad; a pad of 4e8 N/m3 is found to 1 % in one of 1.2",
    ),
    "rocking": (
        "more closely; bands narrower than 0.33 % are missed. -",
        "the one-sine overturns 6, 9 and 8 % below it at ω_p/p",
        "overturning (of 424: those wider than 1 %, with w_p/p of",
        "both hold the true value in about 95 of 100, those that",
    ),
    "structures": (
        "reduced and the rigid engine up to 45,000 times the width of the",
        "thirty-two stones were shaken by 1.5 times the acceleration",
        "frames says, to 1e-2 (caps of 0.1 to 20 times the piers). The",
    ),
    "theory": (
        "inertia about the edge), within 1 % from dt = 2e-3",
        "steps below 1e-3 s. Modal damping of 2 % takes most of",
    ),
}
#: What `test_manual_derived.py` computes from several cells
DERIVED = {
    "rocking-structures": ("each bin. Model and bodies agree on 93 of 98 outcomes; the",),
    "theory": (
        "with 100 modes lose the same within 1 % at 1e-4 s. In",
        "100 modes a sixth more, 300 modes 5 % more. With fewer",
        "slenderness, from 0.2 of Housner's to 8 times](impact-map.png)",
        "Housner's loss, some of H/B 3 up to 1.1 times. The losses of",
    ),
}
