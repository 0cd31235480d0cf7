"""A column in free flight."""

import numpy as np
import pytest
from pair import column, reduced, system_of

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced import start


@pytest.mark.long
@pytest.mark.parametrize("density, dt", [(7850.0, 2.5e-5), (78.5, 1e-6)])
def test_a_column_that_leaves_a_stiff_base_flies_free_of_force(density, dt):
    """From its rest upwards at 0.1 m/s on a base of 1e15 Pa, which the weight of the light one
    indents by less than a length that softer contacts are solved to: nothing holds it, contact
    gives it nothing, and it comes as high as thrown.
    """
    steps, speed = 400, 0.1
    stiff = {"youngs_modulus_pa": 1e15}
    system = system_of(
        integration={"dt_s": dt},
        material=stiff | {"density_kg_m3": density},
        base=stiff,
        contact={"friction_coefficient": 0.8},
    )

    def thrown(engine):
        motion = start.gravity_equilibrium(engine)
        motion.frames["velocity"][0, 2] = speed
        return motion

    engine = reduced(system, 0, begin=thrown)
    rows, _ = engine.advance(np.zeros((steps, 3)))
    time = column(rows, "time")
    assert not column(rows, "active_nodes").any() and not column(rows, "contact_force", 3).any()
    # lifted off by the strain of its foot, far less than a micrometre
    assert column(rows, "u_top", 3)[:, 2] == pytest.approx(
        speed * time - GRAVITY * time**2 / 2, abs=1e-8
    )
    thrown_up = system.body.total_mass * speed**2 / 2
    assert column(rows, "energy/contact")[-1] < 1e-9 * thrown_up
