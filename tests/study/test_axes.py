"""What is multiplied with what: lists, lists that go together, random samples of ranges."""

import math

import numpy as np
import pytest
from study_files import SPECIMEN

from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import read_plan

ZIP = '[[zip]]\n"column.height_m" = [1.0, 1.5]\n"column.fine_height_m" = [0.01, 0.02]\n'
LATIN = (
    '[latin_hypercube]\nsamples = 20\nseed = 3\n"contact.friction_coefficient" = [0.2, '
    '0.8]\n"material.youngs_modulus_pa" = [1e9, 1e11, "log"]\n'
)


def _plan(tmp_path, text):
    file = tmp_path / "study.toml"
    case = f'[case]\nextends = "{SPECIMEN}"\n[case.integration]\nduration_s = 1.0\n'
    file.write_text(case + text if text.startswith("[") else text + case)
    return read_plan(file)


def test_zipped_lists_go_together_and_multiply_with_the_rest(tmp_path):
    plan = _plan(tmp_path, '[axes]\n"integration.alpha_hht" = [0, -0.1, -0.2]\n' + ZIP)
    assert len(plan.analyses) == 6
    assert {
        (a.case.short.column.height_m, a.case.short.column.fine_height_m) for a in plan.analyses
    } == {
        (1.0, 0.01),
        (1.5, 0.02),
    }
    assert plan.analyses[1].values == {
        "integration.alpha_hht": 0,
        "column.height_m": 1.5,
        "column.fine_height_m": 0.02,
    }
    assert plan.axes["column.height_m"] == (1.0, 1.5)


def test_zipped_values_may_repeat_and_several_zips_multiply(tmp_path):
    other = (
        '[[zip]]\n"contact.friction_coefficient" = [0.3, 0.3, 0.6]\n"integration.n_modes" '
        "= [5, 10, 5]\n"
    )
    assert len(_plan(tmp_path, ZIP + other).analyses) == 6


def test_latin_hypercube_has_one_sample_in_each_slice_of_every_range(tmp_path):
    plan = _plan(tmp_path, LATIN)
    friction = np.array([a.case.contact.friction_coefficient for a in plan.analyses])
    stiffness = np.array(
        [math.log10(a.case.short.material.youngs_modulus_pa) for a in plan.analyses]
    )
    assert sorted(np.floor((friction - 0.2) / 0.6 * 20)) == list(range(20))
    assert sorted(np.floor((stiffness - 9) / 2 * 20)) == list(range(20))
    assert abs(np.corrcoef(friction, stiffness)[0, 1]) < 0.5
    assert plan.axes["contact.friction_coefficient"] == tuple(friction)


def test_latin_hypercube_depends_on_its_seed_alone(tmp_path):
    first = _plan(tmp_path, LATIN)
    assert (
        _plan(tmp_path, LATIN).id
        == first.id
        != _plan(tmp_path, LATIN.replace("seed = 3", "seed = 4")).id
    )


def test_whole_numbers_of_a_range_come_equally_often(tmp_path):
    plan = _plan(
        tmp_path,
        '[latin_hypercube]\nsamples = 30\n"integration.n_modes" = [3, '
        '5]\n"contact.friction_coefficient" = [0.1, 0.9]\n',
    )
    assert np.bincount([a.case.integration.n_modes for a in plan.analyses]).tolist() == [
        0,
        0,
        0,
        10,
        10,
        10,
    ]


def test_a_study_takes_the_reduced_engine_unless_told(tmp_path):
    plan = _plan(tmp_path, ZIP)
    assert {a.case.integration.engine for a in plan.analyses} == {"reduced"} and plan.analyses[
        0
    ].case.output.history_every_s == 0.005
    engines = _plan(tmp_path, '[axes]\n"integration.engine" = ["full", "rigid"]\n')
    assert [a.case.integration.engine for a in engines.analyses] == ["full", "rigid"]
    assert engines.analyses[0].effort > 100 * engines.analyses[1].effort


def test_ids_are_those_of_the_cases(tmp_path):
    for analysis in _plan(tmp_path, ZIP + LATIN).analyses:
        assert analysis.id == analysis.case.id


@pytest.mark.parametrize(
    "text, message",
    [
        (
            '[[zip]]\n"column.height_m" = [1.0, 1.5]\n"column.fine_height_m" = [0.01]',
            r"zip.column.fine_height_m = .*must have as many values as column.height_m, 2, has 1",
        ),
        (
            '[[zip]]\n"column.height" = [1.0]',
            r"zip.column.height: unknown key of a case; did you mean column.height_m\?",
        ),
        (
            '[[zip]]\n"contact.friction_coefficient" = [0.3, -1]',
            r"zip.contact.friction_coefficient = -1: must lie in",
        ),
        (ZIP + '[axes]\n"column.height_m" = [1.0]', "zip.column.height_m: stands in axes already"),
        ("[[zip]]\n", "zip = {}: a table of lists"),
        ("zip = 3\n", "zip = 3: a table of lists"),
        ("zip = []\n", r"zip = \[\]: a table of lists"),
        ("zip = [3, 4]\n", "zip.1 = 3: a table of lists"),
        (
            '[latin_hypercube]\n"contact.friction_coefficient" = [0.2, 0.8]',
            r"latin_hypercube.samples: missing; number of samples",
        ),
        ("[latin_hypercube]\nsamples = 3", "latin_hypercube: needs a range"),
        (
            '[latin_hypercube]\nsamples = 3\n"contact.friction_coefficient" = [0.8, 0.2]',
            "two rising numbers",
        ),
        (
            '[latin_hypercube]\nsamples = 3\n"contact.friction_coefficient" = [0.0, 0.2, "log"]',
            "must be above 0 for a logarithm",
        ),
        (
            '[latin_hypercube]\nsamples = 3\n"contact.friction_coefficient" = [0.1, 0.2, "lin"]',
            r'or \[low, high, "log"\]',
        ),
        (
            '[latin_hypercube]\nsamples = 3\n"contact.friction_coefficient" = [9, 20]',
            "latin_hypercube.contact.friction_coefficient = .*must lie in",
        ),
        ('[latin_hypercube]\nsamples = 3\n"contact.law" = [1, 2]', "only a number has a range"),
    ],
)
def test_mistakes_name_table_key_and_value(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        _plan(tmp_path, text)


def test_a_span_of_the_lick_ensemble_is_its_motions_in_order(tmp_path):
    plan = _plan(tmp_path, '[axes]\n"motion.source" = ["lick:3-6", "lick:1"]\n')
    assert plan.axes["motion.source"] == ("lick:3", "lick:4", "lick:5", "lick:6", "lick:1")


@pytest.mark.parametrize("span", ["lick:0-3", "lick:5-4", "lick:100-116"])
def test_a_span_beyond_the_ensemble_is_refused(tmp_path, span):
    with pytest.raises(
        InputError, match=r"axes.motion.source = .*two rising numbers from 1 to 115"
    ):
        _plan(tmp_path, f'[axes]\n"motion.source" = ["{span}"]\n')
