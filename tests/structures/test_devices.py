"""Devices that restrain a rocking block, from case to results: hardening bars, friction and viscous
dampers, struts, stops, ropes that break one after another; their energy, extremes, refusals.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from small_structures import block, stack, structure

from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.pictures.mesh_report import mesh_report
from fecolumn.simulation import run
from fecolumn.structures.structure import structure_model

TOP = dict(body="block", point_m=[0, 0, 1.0])
LEFT, RIGHT = TOP | dict(to_point_m=[-1, 0, 1.0]), TOP | dict(to_point_m=[1, 0, 1.0])
BAR = LEFT | dict(kind="spring", stiffness_n_m=1e5, yield_n=500.0)
DEVICES = dict(
    bar=BAR | dict(hardening=0.1),
    curved=BAR | dict(hardening=0.05, yield_exponent=3.0, yield_n=300.0),
    brake=LEFT | dict(kind="friction", stiffness_n_m=2e5, slip_n=250.0),
    damper=LEFT
    | dict(kind="dashpot", damping_n_s_m=300.0, damping_exponent=0.4, linear_below_m_s=0.01),
    strut=RIGHT | dict(kind="strut", stiffness_n_m=2e4, prestress_n=50.0),
    stop=RIGHT | dict(kind="stop", stiffness_n_m=3e5, gap_m=0.02),
)
ROCKING = merge(
    block(element_size_m=0.2, coarse_size_m=0.4),
    dict(
        links=DEVICES,
        initial=dict(block=dict(spin_rad_s=[0, 0.9, 0])),
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(dt_s=5e-4, duration_s=0.6, engine="rigid"),
    ),
)


@pytest.fixture(scope="module", params=["rigid", "reduced"])
def rocking(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param) / "run"
    tables = merge(ROCKING, dict(integration=dict(engine=request.param)))
    return run(structure(**tables), folder, quiet=True), read_history(folder / "history.h5")


def test_energy_of_devices_closes_and_is_theirs(rocking):
    summary, rows = rocking
    works = sum(rows[f"link/{name}/work"] for name in DEVICES)
    np.testing.assert_allclose(-rows["energy/links"], works, rtol=1e-12, atol=1e-12)
    assert summary["energy_closure_rel"] < 1e-12
    for name in ("bar", "curved", "brake", "damper"):
        assert summary["links"][name]["work_j"] > 1.0, name
        assert (np.diff(rows[f"link/{name}/work"]) >= -1e-15).all(), name
    assert not rows["link/strut/work"].any() and not rows["link/stop/work"].any()


def test_columns_follow_the_law_of_each_device(rocking):
    _, rows = rocking
    tension, way, flowed = (
        {name: rows[f"link/{name}/{what}"] for name in DEVICES}
        for what in ("tension", "elongation", "yielded")
    )
    for name in ("bar", "curved", "brake"):
        stiffness = DEVICES[name]["stiffness_n_m"]
        np.testing.assert_allclose(tension[name], stiffness * (way[name] - flowed[name]), atol=1e-6)
    # within lines of the hardened stiffness, and on the upper one where it yields
    over = tension["bar"] - 1e4 * way["bar"]
    assert over.max() == pytest.approx(450.0) and over.min() == pytest.approx(-450.0)
    over = tension["curved"] - 5e3 * way["curved"]
    assert 280 < over.max() < 285.0 + 1e-9 and over.min() >= -285.0 - 1e-9
    assert np.abs(tension["brake"]).max() == pytest.approx(250.0)
    rates = np.diff(way["damper"]) / 5e-4
    expected = np.where(
        np.abs(rates) < 0.01, 0.01**-0.6 * rates, np.abs(rates) ** 0.4 * np.sign(rates)
    )
    np.testing.assert_allclose(tension["damper"][1:], 300 * expected, rtol=1e-6, atol=1e-6)
    assert tension["strut"][0] == pytest.approx(-50.0, rel=0.02)
    np.testing.assert_allclose(tension["strut"], np.minimum(2e4 * way["strut"], 0), atol=1e-6)
    np.testing.assert_allclose(
        tension["stop"], np.minimum(3e5 * (way["stop"] + 0.02), 0), atol=1e-6
    )
    assert tension["stop"].min() < -100.0


def test_summary_tells_peak_forces_of_either_sense_and_when(rocking):
    summary, rows = rocking
    links = summary["links"]
    for name, link in links.items():
        assert link["compression_max_n"] == max(0.0, -rows[f"link/{name}/tension"].min())
        assert link["shortening_max_m"] == max(0.0, -rows[f"link/{name}/elongation"].min())
    assert links["stop"]["tension_max_n"] == 0.0 and links["stop"]["slack_at_s"] is not None
    assert links["brake"]["yielded_at_s"] is not None and links["stop"]["yielded_at_s"] is None
    # along a curve some of it yields from the start: what counts is 0.9 of its yield force
    tension, way = rows["link/curved/tension"], rows["link/curved/elongation"]
    z = np.abs(tension - 5e3 * way) / 285.0
    assert links["curved"]["yielded_at_s"] == rows["time"][np.argmax(z >= 0.9)] > 0.001


def test_full_order_has_the_same_devices(tmp_path):
    found = {}
    for engine, modes in (("full", 30), ("reduced", 1000)):
        tables = merge(
            ROCKING, dict(integration=dict(engine=engine, duration_s=0.1, n_modes=modes))
        )
        summary = run(structure(**tables), tmp_path / engine, quiet=True)
        found[engine] = read_history(tmp_path / engine / "history.h5")
        assert summary["energy_closure_rel"] < 1e-9
    for name in DEVICES:
        for what in ("tension", "elongation", "yielded", "work"):
            one, other = (rows[f"link/{name}/{what}"] for rows in found.values())
            largest = max(np.abs(other).max(), 1e-6)
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-4 * largest, err_msg=name)


def slab(density_kg_m3=1000.0, *, integration, initial=None, **links):
    """A flat slab of 0.1 m3 without friction, its middle held along x by links; rigid."""
    place = dict(body="block", point_m=[0, 0, 0.05], to_point_m=[-5, 0, 0.05])
    held = dict(
        links={name: place | link for name, link in links.items()},
        contact=dict(friction_coefficient=0.0, interior_points=0),
        initial=initial or {},
        integration=dict(engine="rigid") | integration,
    )
    flat = block(density_kg_m3=density_kg_m3, length_m=1.0, width_m=1.0, height_m=0.1)
    return structure(**merge(flat, held))


@pytest.mark.parametrize("rounding", np.arange(8) * 1e-14)
def test_a_flat_slab_that_nothing_holds_is_at_rest_whatever_is_rounded(rounding, tmp_path):
    case = slab(
        1000 * (1 + rounding),
        damper=dict(kind="dashpot", damping_n_s_m=80.0),
        integration=dict(dt_s=1e-3, duration_s=2e-3),
    )
    summary = run(case, tmp_path / "run", quiet=True)
    assert summary["residual_slide_m"] == pytest.approx(0, abs=1e-9)


def test_a_block_on_a_viscous_damper_of_a_power_slows_by_its_closed_form(tmp_path):
    """Sliding without friction: m v' = -c v^a, v^(1-a) = v0^(1-a) - (1-a) c t / m."""
    mass, c, a, v0 = 100.0, 80.0, 0.5, 0.5
    damper = dict(kind="dashpot", damping_n_s_m=c, damping_exponent=a, linear_below_m_s=1e-4)
    case = slab(
        10 * mass,
        damper=damper,
        initial=dict(block=dict(velocity_m_s=[v0, 0, 0])),
        integration=dict(dt_s=1e-3, duration_s=1.0),
    )
    summary = run(case, tmp_path / "run", quiet=True)
    way = read_history(tmp_path / "run" / "history.h5")["link/damper/elongation"]
    last = v0**0.5 - 0.5 * c / mass
    # the integral of (v0^(1/2) - c t / (2 m))^2
    assert way[-1] - way[0] == pytest.approx((v0**1.5 - last**3) / (1.5 * c / mass), rel=1e-5)
    taken = mass / 2 * (v0**2 - last**4)
    assert summary["links"]["damper"]["work_j"] == pytest.approx(taken, rel=1e-4)
    assert summary["energy_closure_rel"] < 1e-12


@pytest.mark.parametrize("bends", [None, 2.0])
def test_a_mass_on_a_bar_that_hardens_swings_as_its_equation_says(bends, tmp_path):
    """Sliding without friction, beside the ODE integrated to 1e-10: m v' = -N, N = h k e + (1 - h)
    F z; z' = k v / F (1 - |z|^n) where z v > 0, of a corner until |z| = 1.
    """
    mass, k, force, h, v0, dt = 100.0, 1e5, 500.0, 0.1, 0.5, 5e-4
    bar = dict(kind="spring", stiffness_n_m=k, yield_n=force, hardening=h)
    case = slab(
        10 * mass,
        bar=bar if bends is None else bar | dict(yield_exponent=bends),
        initial=dict(block=dict(velocity_m_s=[v0, 0, 0])),
        integration=dict(dt_s=dt, duration_s=1.0, alpha_hht=0.0),
    )
    summary = run(case, tmp_path / "run", quiet=True)
    rows = read_history(tmp_path / "run" / "history.h5")

    def rates(_, state):
        e, v, z = state
        share = 0.0 if z * v <= 0 else (abs(z) >= 1.0) if bends is None else abs(z) ** bends
        return v, -(h * k * e + (1 - h) * force * z) / mass, k / force * v * (1 - share)

    exact = solve_ivp(
        rates, (0, 1.0), (0, v0, 0), t_eval=rows["time"], rtol=1e-9, atol=1e-12, max_step=1e-4
    )
    way = rows["link/bar/elongation"]
    np.testing.assert_allclose(way, exact.y[0], atol=2e-3 * np.abs(way).max())
    assert way.max() == pytest.approx(exact.y[0].max(), rel=1e-4)
    assert summary["energy_closure_rel"] < 1e-12
    # what it had is in the bar, or still moves
    energy = rows["energy/kinetic"] + rows["energy/strain"] - rows["energy/links"]
    np.testing.assert_allclose(energy + rows["energy/gravity"], mass * v0**2 / 2, rtol=1e-8)


def test_ropes_break_in_sequence_and_the_last_holds(tmp_path):
    """A block pulled away from three ropes of other slack and one that does not break."""
    rope = LEFT | dict(kind="tendon", stiffness_n_m=2e4, breaking_n=200.0)
    ropes = {f"rope{n}": rope | dict(slack_m=0.01 * n) for n in range(3)}
    ropes["last"] = rope | dict(slack_m=0.04, breaking_n=1e6)
    tables = merge(ROCKING, dict(initial=dict(block=dict(spin_rad_s=[0, 0.9, 0]))))
    tables["links"] = ropes
    tables["integration"] = dict(dt_s=2e-4, duration_s=0.5, engine="rigid")
    summary = run(structure(**tables), tmp_path / "run", quiet=True)
    rows, links = read_history(tmp_path / "run" / "history.h5"), summary["links"]
    broke = [links[f"rope{n}"]["broke_at_s"] for n in range(3)]
    assert 0 < broke[0] < broke[1] < broke[2] and links["last"]["broke_at_s"] is None
    assert links["last"]["slack_at_s"] > broke[2] and links["last"]["tension_max_n"] > 0
    for n in range(3):
        assert links[f"rope{n}"]["work_j"] == pytest.approx(200.0**2 / 2 / 2e4, rel=0.05)
        assert links[f"rope{n}"]["elongation_max_m"] == pytest.approx(0.01 * n + 0.01, rel=0.05)
    assert summary["energy_closure_rel"] < 1e-12 and not rows["link/last/work"].any()


def test_wax_below_its_corners_holds_a_block_until_its_moment_is_reached(tmp_path):
    """Four pieces that pull up to S at 0.18 m from the middle of a foot 0.4 m long, under a slowly
    rising acceleration: m a h = m g b + 2 S (0.38 + 0.02^2 / 0.38), about the edge.
    """
    file, strength, top, seconds = tmp_path / "ramp.csv", 150.0, 5.0, 2.0
    times = np.linspace(0, seconds, 201)
    file.write_text("t,x\n" + "".join(f"{t:.3f},{top * t / seconds:.6f}\n" for t in times))
    piece = dict(kind="tendon", body="block", stiffness_n_m=5e6, breaking_n=strength)
    corners = [(x, y) for x in (-0.18, 0.18) for y in (-0.08, 0.08)]
    tables = merge(
        block(element_size_m=0.2, coarse_size_m=0.4),
        dict(
            links={
                f"wax{n}": piece | dict(point_m=[x, y, 0.03], to_point_m=[x, y, 0.0])
                for n, (x, y) in enumerate(corners)
            },
            contact=dict(friction_coefficient=0.9, interior_points=0),
            motion=dict(source=str(file), units="m/s2", free_vibration_s=0.0),
            integration=dict(dt_s=5e-4, engine="rigid", duration_s=seconds),
        ),
    )
    summary = run(structure(**tables), tmp_path / "run", quiet=True)
    mass, arm, height, g = 0.4 * 0.2 * 1.2 * 2700, 0.2, 0.6, 9.81
    held = (mass * g * arm + 2 * strength * (0.38 + 0.02**2 / 0.38)) / (mass * height)
    broke = sorted(link["broke_at_s"] or 9.0 for link in summary["links"].values())
    assert broke[0] * top / seconds == pytest.approx(held, rel=0.01)
    assert held > 1.15 * g * arm / height and broke[1] - broke[0] < 0.02


@pytest.mark.parametrize("kind", ["strut", "tendon"])
def test_a_strut_holds_what_would_tip_and_a_tendon_in_its_place_is_refused(kind):
    """A block whose centre of mass is beyond the edge of what it stands on, propped below."""
    prop = dict(kind=kind, body="upper", point_m=[0.1, 0, 0], to_point_m=[0.1, 0, -0.8])
    tables = stack(
        bodies=dict(upper=dict(at_m=[0.35, 0, 0.8])),
        links=dict(prop=prop | dict(stiffness_n_m=1e6)),
    )
    if kind == "tendon":
        with pytest.raises(InputError, match="cannot rest"):
            structure_model(structure(**tables))
    else:
        (link,) = structure_model(structure(**tables)).links
        assert link.pushes and not link.pulls


def test_mesh_lists_hardening_and_exponents(tmp_path):
    table = mesh_report(structure(**ROCKING), "case.toml", tmp_path / "mesh").splitlines()
    head = next(n for n, line in enumerate(table) if line.startswith("link"))
    rows = {line.split()[1]: line.split() for line in table[head + 1 : head + 7]}
    assert table[head].split()[-4:] == ["hardening", "[-]", "exponent", "[-]"]
    assert rows["bar"][-2:] == ["0.1", "-"] and rows["curved"][-2:] == ["0.05", "3"]
    assert rows["damper"][-2:] == ["0", "0.4"] and rows["brake"][-2:] == ["0", "-"]


WRONG = [
    (BAR | dict(hardening=1.0), "hardening = 1.0: must lie in [0, 0.99]"),
    (BAR | dict(yield_exponent=0.5), "yield_exponent = 0.5: must lie in [1, 50]"),
    (DEVICES["strut"] | dict(hardening=0.1), "hardening = 0.1: says nothing without yield_n"),
    (DEVICES["strut"] | dict(yield_exponent=2), "yield_exponent = 2.0: says nothing without"),
    (BAR | dict(slip_n=5.0), "slip_n = 5.0: says nothing of a spring; it may have yield_n"),
    (BAR | dict(gap_m=0.1), "gap_m = 0.1: says nothing of a spring; a stop has a gap"),
    (BAR | dict(slack_m=0.1), "slack_m = 0.1: says nothing of a spring; a restrainer or a tendon"),
    (DEVICES["strut"] | dict(slack_m=0.1), "slack_m = 0.1: says nothing of a strut"),
    (DEVICES["brake"] | dict(slip_n=0.0), "slip_n = 0.0: must be greater than 0"),
    (
        DEVICES["brake"] | dict(yield_n=9.0),
        "yield_n = 9.0: says nothing of a friction damper; a friction damper has slip_n",
    ),
    (DEVICES["brake"] | dict(stiffness_n_m=0.0), "stiffness_n_m = 0.0: must be greater than 0 N/m"),
    (DEVICES["brake"] | dict(prestress_n=300.0), "prestress_n = 300.0: must be at most slip_n"),
    (DEVICES["brake"] | dict(breaking_n=200.0), "breaking_n = 200.0: must be at least"),
    (DEVICES["damper"] | dict(damping_exponent=0.0), "damping_exponent = 0.0: must be greater"),
    (DEVICES["damper"] | dict(damping_exponent=2.5), "damping_exponent = 2.5: must be greater"),
    (DEVICES["damper"] | dict(linear_below_m_s=0), "linear_below_m_s = 0: must be greater than 0"),
    (
        DEVICES["damper"] | dict(damping_exponent=1),
        "linear_below_m_s = 0.01: says nothing without a damping_exponent below 1",
    ),
    (BAR | dict(damping_exponent=0.5), "damping_exponent = 0.5: says nothing without damping_n"),
    (DEVICES["damper"] | dict(slip_n=1.0), "slip_n = 1.0: says nothing of a dashpot"),
    (DEVICES["stop"] | dict(prestress_n=5.0), "prestress_n = 5.0: must be 0 where gap_m is not"),
]


@pytest.mark.parametrize("link, told", WRONG)
def test_what_a_device_cannot_have_is_refused_in_one_line(link, told):
    with pytest.raises(InputError) as refused:
        structure(**merge(block(), dict(links=dict(one=link))))
    assert str(refused.value).splitlines()[0].startswith(f"small.toml: links.one.{told}")


def test_a_friction_damper_without_its_force_is_refused():
    brake = {name: value for name, value in DEVICES["brake"].items() if name != "slip_n"}
    with pytest.raises(InputError, match="links.one.slip_n: must be greater than 0 N of a fric"):
        structure(**merge(block(), dict(links=dict(one=brake))))


def test_a_power_too_steep_for_the_step_is_refused_with_both_ways_out(tmp_path):
    damper = DEVICES["damper"] | dict(damping_n_s_m=1e4, linear_below_m_s=1e-3)
    tables = merge(ROCKING, dict(links=dict(damper=damper)))
    with pytest.raises(InputError, match="needs steps of at most .* s, or linear_below_m_s of"):
        run(structure(**tables), tmp_path / "run", quiet=True)
