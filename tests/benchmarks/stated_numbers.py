"""Numbers of README that no table of measurements has to hold, by the words around them."""

#: What is given: systems, settings of a study or a figure, bodies, names
GIVEN = (
    "a study: 40 ground motions at two time steps",
    "You need Debian 12 or 13, and root",
    "through 40 ground motions, each at the time steps 0.02 s and 1e-3 s",
    "the Loma Prieta earthquake (1989)",
    "| 3DEC, UDEC |",
    "shaken by 1.5 times the acceleration",
    "with friction solved to 1e-10",
    "Number of motions, of 115, that overturn each of four structures",
    "has another time integration than fecolumn and steps of 1e-4 s",
    "it is fecolumn at steps of 2e-5 s. *Best*",
    "MuJoCo: defaults (2e-3 s), best (1e-4 s) | Siconos: defaults (5e-4 s), best (1e-4 s)",
    "fecolumn (1e-3 s): rigid, reduced, full",
    "significantly (p < 0.05)",
    "A real test: 490 shake-table tests",
    "With 16 random sets of values for each test",
    "a steel tube 1.5 m high",
    "The reference column in 115 motions at each of five values",
    "With substeps and alpha 0 and -0.2",
    "from 0 (equal) to 1",
    "The figure has alpha -0.2",
    "of the steps 0.02, 1e-3 and 1e-4 s",
    "is released from 0.3 of its critical tilt",
    "From 0.05 of the critical tilt",
    "The figure has 1.03 times",
    "by +a for 0.1 s, then by -a/2 for 0.2 s",
    "The figure has 0.34 s and 0.5 g",
    "Licence: [LGPL-3.0-or-later]",
)
#: What `fecolumn verify` computes again, beside a closed form, with what others published
VERIFIED = (
    "at a constant base acceleration of 0.1599 g",
    "at 0.99 times that and falls at 1.01 times",
    "They stand at 4.0 g and fall at 4.4 g",
    "HybriDFEM 4.16, LMGC90 4.3, UDEC 3.6 g",
    "at 0.34 s a stronger push does not always topple it",
)
#: What `tests/benchmarks/test_results_steps.py` computes from several cells
DERIVED = (
    "640 to 1,000 motions exclude",
    "differ by more than D = 0.1",
    "At alpha -0.333 the two steps differ even with substeps (31 and 48 fall, p < 0.001)",
    "103 fewer of the 575 columns fall at 0.02 s than at 1e-3 s (p < 0.001)",
    "then 42 fewer fall (p 0.064). The two ways differ significantly (p 0.011)",
)
