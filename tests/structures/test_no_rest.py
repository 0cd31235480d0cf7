"""A structure that does not come to rest is told by the body that moves most, with keys to look
at.
"""

import pytest
from small_structures import STONE, stack, structure

from fecolumn.engines.dynamics import gravity
from fecolumn.engines.no_rest import no_rest
from fecolumn.simulation import AnalysisFailed, run


@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_no_equilibrium_names_body_joints_and_way_out(engine, tmp_path, monkeypatch):
    monkeypatch.setattr(gravity, "REST_WAY", 0.0)
    monkeypatch.setattr(gravity, "REST_ITERATIONS", 4)
    monkeypatch.setattr(gravity, "REST_PROGRESS", 0.0)
    elastic = dict(rigid=False, element_size_m=0.4, coarse_size_m=0.4)
    tables = stack(integration=dict(engine=engine))
    if engine == "full":
        tables = stack(integration=dict(engine=engine), bodies=dict(lower=elastic, upper=elastic))
    with pytest.raises(AnalysisFailed) as caught:
        run(structure(**tables), tmp_path / "out", file="small.toml", quiet=True)
    told = str(caught.value)
    assert told.startswith("small.toml: gravity equilibrium: still moving by ")
    assert "\n" not in told and 'integration.start = "drawn"' in told
    assert 'most of all "upper", drawn at (0, 0, 0.8) m' in told or 'most of all "lower"' in told
    assert "joints.joint.friction_coefficient = " in told


def test_an_unknown_mover_leaves_the_way_out():
    error = gravity.NoEquilibrium("gravity equilibrium: contact does not converge")
    assert no_rest(structure(**stack()), error) == (
        'gravity equilibrium: contact does not converge; integration.start = "drawn" lets the '
        "bodies go from where they are drawn"
    )


def test_bodies_that_are_far_apart_are_named_and_survey_coordinates_are_no_matter(tmp_path):
    """Of one metre in height, kilometres apart; and beside one another, kilometres from where
    places are measured.
    """
    low = dict(kind="block", length_m=1.0, width_m=0.5, height_m=1.0, element_size_m=0.5) | STONE

    def of(first, second):
        one, other = ([place, 0.0, 0.0] for place in (first, second))
        return structure(
            bodies=dict(one=low | dict(at_m=one), other=low | dict(at_m=other)),
            joints={name: dict(between=[name, "ground"]) for name in ("one", "other")},
            integration=dict(engine="rigid", duration_s=0.01),
        )

    error = gravity.NoEquilibrium("gravity equilibrium: still moving by 3.20e-09 m")
    error.mover = 1
    told = no_rest(of(0.0, 5000.0), error)
    assert '"one" and "other" are 5000 m apart' in told and "\n" not in told
    assert "slide" not in told and 'integration.start = "drawn"' in told
    assert "apart" not in no_rest(of(5000.0, 5002.0), error)
    near = run(of(5000.123, 5002.123), tmp_path / "near", file="small.toml", quiet=True)
    assert near["outcome"] == "at rest"
