"""A structure that does not come to rest is told by the body that moves most, with keys to look
at.
"""

import warnings

import pytest
from small_structures import stack, structure

from fecolumn.engines.dynamics import gravity
from fecolumn.engines.no_rest import no_rest
from fecolumn.simulation import AnalysisFailed, run
from fecolumn.structures.structure import structure_model


@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_no_equilibrium_names_body_joints_and_way_out(engine, tmp_path, monkeypatch):
    monkeypatch.setattr(gravity, "REST_WAY", 0.0)
    monkeypatch.setattr(gravity, "REST_ITERATIONS", 4)
    monkeypatch.setattr(gravity, "REST_PROGRESS", 0.0)
    elastic = dict(rigid=False, element_size_m=0.4, coarse_size_m=0.4)
    told = dict(integration=dict(engine=engine), output=dict(fields_every_s=0.05))
    tables = stack(**told)
    if engine == "full":
        tables = stack(**told, bodies=dict(lower=elastic, upper=elastic))
    with pytest.raises(AnalysisFailed) as caught:
        run(structure(**tables), tmp_path / "out", file="small.toml", quiet=True)
    assert not (tmp_path / "out").exists()
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


@pytest.mark.parametrize("carried", [False, True])
def test_a_tilt_that_leaves_what_stands_above_level_is_told_of(carried):
    initial = {name: dict(tilt_rad=0.05) for name in ("lower", "upper")[: 1 + carried]}
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        structure_model(structure(**stack(initial=initial)), "small.toml")
    assert any("begins level on its raised edge" in str(one.message) for one in told) != carried


def test_no_rest_is_looked_for_where_no_forces_can_hold(tmp_path, monkeypatch):
    """A body that leans over its edge from the start would be settled for seconds."""
    monkeypatch.setattr(
        "fecolumn.engines.reduced_analysis.upright", lambda *_: pytest.fail("was looked for")
    )
    tables = stack(
        bodies=dict(upper=dict(at_m=[0.35, 0, 0.8])),
        integration=dict(engine="rigid", start="drawn", duration_s=0.05),
    )
    summary = run(structure(**tables), tmp_path, quiet=True)
    assert summary["bodies"]["upper"]["tilt_max_rad"] > 1e-3
