"""A structure that does not come to rest is told by the body that moves most, with keys to look
at.
"""

import pytest
from small_structures import stack, structure

from fecolumn.engines.dynamics import gravity
from fecolumn.engines.no_rest import no_rest
from fecolumn.simulation import AnalysisFailed, run


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
