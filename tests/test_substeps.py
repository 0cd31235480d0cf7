"""integration.substeps: the step that is asked for is the step that is taken, or is made in parts
for what is said, in every engine.
"""

from pathlib import Path

import numpy as np
import pytest

from fecolumn import simulation
from fecolumn.case.case import case_from_tables, load_case
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import InputError

# a thick tube, and the same as a body of a structure
TUBE = dict(
    column=dict(outer_diameter_m=0.2, wall_m=0.03, height_m=0.8, fine_height_m=0.03),
    material=dict(youngs_modulus_pa=50e9, density_kg_m3=2700.0),
    base=dict(kind="unbounded"),
    mesh=dict(fine_size_m=0.03, coarse_size_m=0.05, base_size_m=0.2),
    contact=dict(friction_coefficient=0.7, interior_points=0),
)
DRUM = dict(
    bodies=dict(
        drum=dict(
            kind="cylinder",
            outer_diameter_m=0.2,
            height_m=0.8,
            element_size_m=0.05,
            youngs_modulus_pa=50e9,
            density_kg_m3=2700.0,
        )
    ),
    joints=dict(foot=dict(between=["drum", "ground"])),
    contact=dict(friction_coefficient=0.7, interior_points=0),
)
BODIES = {"column": TUBE, "structure": DRUM}
# it turns on its rim beside upright; it rocks over in a plane, once in 0.06 s
ROLLS, LANDS = dict(tilt_rad=0.006, spin_rad_s=[0.05, 0.0, 0.0]), dict(tilt_rad=0.004)


def case_of(body, engine, substeps, start, duration_s=0.06, dt_s=5e-3):
    keys = (
        dict(dt_s=dt_s, duration_s=duration_s, engine=engine)
        | (dict(substeps=substeps) if substeps else {})
        | ({} if engine == "full" else dict(n_modes=10))
    )
    return case_from_tables(
        BODIES[body]
        | dict(integration=keys, initial=dict(drum=start) if body == "structure" else start),
        "substeps",
    )


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("engine", ["reduced", "full"])
def test_a_rim_that_rolls_fast_is_followed_in_parts_unless_the_step_is_literal(
    body, engine, tmp_path
):
    made = {
        word: simulation.run(
            case_of(body, engine, word, ROLLS), tmp_path / (word or "default"), quiet=True
        )
        for word in ("", "rolling", "none")
    }
    assert made["none"]["parts"] == made["none"]["cuts"] == 0 and made["rolling"]["parts"] > 0
    assert {summary["steps"] for summary in made.values()} == {12}
    for key in ("parts", "u_max_m", "energy_j", "case_id"):
        assert made[""][key] == made["rolling"][key]
    assert (
        made["none"]["case_id"] != made["rolling"]["case_id"]
        and made["none"]["energy_j"] != made["rolling"]["energy_j"]
    )
    assert max(summary["energy_closure_rel"] for summary in made.values()) < 1e-9


@pytest.mark.long
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("engine", ["reduced", "full"])
def test_a_landing_is_found_in_its_step(body, engine, tmp_path):
    """A step in which a point lands has seven parts at least: the smallest, in which it lands, and
    what the halves leave before and after it.
    """
    made = {
        word: simulation.run(case_of(body, engine, word, LANDS), tmp_path / word, quiet=True)
        for word in ("rolling", "none", "impacts")
    }
    rows = {word: read_history(tmp_path / word / "history.h5") for word in made}
    assert made["none"]["impacts"] > 0 and made["none"]["parts"] == made["rolling"]["parts"] == 0
    assert all(np.array_equal(rows["none"][name], rows["rolling"][name]) for name in rows["none"])
    assert made["impacts"]["impacts"] > 0 and made["impacts"]["parts"] >= 7
    np.testing.assert_allclose(rows["impacts"]["time"], 5e-3 * np.arange(13), rtol=0, atol=1e-12)
    first = int(np.argmax(rows["none"]["energy/impact"] < 0))
    assert (
        np.array_equal(rows["impacts"]["u_top"][:first], rows["none"]["u_top"][:first])
        and rows["impacts"]["energy/impact"][first] < 0
    )
    assert rows["impacts"]["energy/impact"][first] != rows["none"]["energy/impact"][first]
    assert max(summary["energy_closure_rel"] for summary in made.values()) < 1e-9


def test_both_engines_find_the_same_landing(tmp_path):
    made = {
        engine: simulation.run(
            case_of("column", engine, "impacts", LANDS), tmp_path / engine, quiet=True
        )
        for engine in ("reduced", "full")
    }
    assert made["reduced"]["parts"] == made["full"]["parts"]
    assert made["reduced"]["energy_j"]["impact"] == pytest.approx(
        made["full"]["energy_j"]["impact"], rel=0.05
    )


def test_an_impact_that_is_found_in_a_coarse_step_loses_what_it_does_in_short_steps(tmp_path):
    """From 0.05 rad in steps of 0.01 s: the loss is nearer to that of literal steps of a 64th than
    to that of the literal step.
    """

    def loss(word, dt):
        case = case_of("column", "rigid", word, dict(tilt_rad=0.05), 0.3, dt)
        return sum(
            simulation.run(case, tmp_path / f"{word} {dt}", quiet=True)["energy_j"][name]
            for name in ("impact", "friction", "contact")
        )

    coarse, short, found = loss("none", 0.01), loss("none", 0.01 / 64), loss("impacts", 0.01)
    assert short < 0 and abs(found - short) < abs(found - coarse)


def test_an_interrupted_analysis_goes_on_with_its_parts_to_the_last_digit(tmp_path):
    for word, start in dict(none=ROLLS, rolling=ROLLS, impacts=dict(tilt_rad=0.05)).items():
        case, asked = case_of("column", "reduced", word, start, 0.4), iter([False] * 4 + [True])
        with pytest.raises(KeyboardInterrupt):
            simulation.run(case, tmp_path / word, quiet=True, stop=asked.__next__)
        two, one = (
            simulation.run(case, tmp_path / word, quiet=True),
            simulation.run(case, tmp_path / f"{word} at once", quiet=True),
        )
        assert (two["parts"], two["impacts"]) == (one["parts"], one["impacts"]) and bool(
            one["parts"]
        ) == (word != "none")
        rows, others = (
            read_history(tmp_path / word / "history.h5"),
            read_history(tmp_path / f"{word} at once" / "history.h5"),
        )
        assert all(np.array_equal(rows[name], others[name]) for name in rows)


@pytest.mark.parametrize(
    "lines, words",
    [
        (
            '[integration]\nsubsteps = "all"',
            ["integration.substeps = 'all'", "one of rolling, impacts, none"],
        ),
        ("[integration]\nsubsteps = 4", ["integration.substeps = 4"]),
        (
            '[integration]\nsubsteps = "none"\nengine = "housner"',
            ["integration.substeps = 'none'", "has no effect", "'housner'"],
        ),
        (
            '[integration]\nengine = "full"\nsubsteps = "impacts"\n[contact]\nimpact = "none"',
            ["integration.substeps = 'impacts'", "contact.impact = 'none'"],
        ),
        (
            '[integration]\nsubsteps = "impacts"\n[base]\nkind = "pad"\nstiffness_n_m3 = 1e9',
            ["integration.substeps = 'impacts'", "pad"],
        ),
    ],
)
def test_what_would_say_nothing_is_refused(tmp_path, lines, words):
    (tmp_path / "case.toml").write_text(
        f'extends = "{Path("meshes/stout.toml").resolve()}"\n{lines}\n'
    )
    with pytest.raises(InputError) as refusal:
        load_case(tmp_path / "case.toml")
    assert all(word in str(refusal.value) for word in words)


@pytest.mark.long
@pytest.mark.parametrize("name", ["paper_study", "quick_study"])
def test_the_studies_of_the_front_page_take_the_literal_step(name):
    from fecolumn.study.plan import read_plan

    assert {
        analysis.case.integration.substeps
        for analysis in read_plan(f"benchmarks/{name}.toml").analyses
    } == {"none"}
