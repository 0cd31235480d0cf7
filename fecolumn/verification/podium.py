"""The podium against the restitutions of its paper, closed limits and its energy.

Requirement: restitution and kinetic energy kept at an impact are those of the printed equations 5
and 6 under both laws; the building on a fixed base has the period, the profile and the damping that
it was made for; a stiff building makes the podium a rocking frame whose beam carries its mass;
between impacts the energy balance closes.

Source: the paper on impact modelling of multi-storey podium structures; [P] printed there, by
section; [D] derived from its equations 1, 5 and 6.

Tolerances. Restitution and energy: half of the digits of the table. Stiff building: its deformation
goes with the square of the period T; what two periods leave when extrapolated to none goes with (T
p)^4, 1e-6. Energy: fourth-order steps of T_n/30 leave 1e-6.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.model_sections import CAV, CRV, LAWS
from fecolumn.engines.rocking.frame import RockingFrame
from fecolumn.engines.rocking.podium import Podium, study_podium
from fecolumn.engines.rocking.podium_impact import kinetic_energy_kept, podium_restitution
from fecolumn.engines.rocking.storeys import PROFILES, storeys
from fecolumn.foundation.gravity import GRAVITY
from fecolumn.motions.directivity_pulse import MEAN_GAMMA, MEAN_PHASE
from fecolumn.motions.near_fault import DISTANCES, MAGNITUDES
from fecolumn.motions.record import GroundMotion
from fecolumn.verification.podium_structure import ALPHA, GAMMA
from fecolumn.verification.result import CaseRows, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


#: eta to restitution CRV, CAV and kinetic energy kept CRV, CAV, of tan alpha = 0.15 and gamma = 10
#: [D]
_KEPT = {
    0: (0.9563, 0.9563, 0.9146, 0.9146),
    3: (0.9561, 0.8389, 0.9141, 0.9192),
    6: (0.9560, 0.7347, 0.9140, 0.9237),
    9: (0.9560, 0.6417, 0.9140, 0.9278),
}
_STIFF = (0.04, 0.02)  # periods [s]


def run(engine: str, long: bool = False) -> CaseRows:
    """All rows."""
    return CaseRows(
        [*_impacts(), *_buildings(), *_sizes(), *_stiff(), *_energies()], _draw, (7.2, 2.8)
    )


def _impacts() -> Iterator[Row]:
    for eta, (*restitution, kept_crv, kept_cav) in _KEPT.items():
        for law, exact, energy in zip(LAWS, restitution, (kept_crv, kept_cav)):
            yield Row(
                f"restitution {law}, eta {eta} [-] (D of Eqs. 5, 6)",
                exact,
                podium_restitution(law, ALPHA, GAMMA, eta),
                6e-5,
                scale=1.0,
            )
            yield Row(
                f"kinetic energy kept {law}, eta {eta} [-] (D)",
                energy,
                kinetic_energy_kept(law, ALPHA, GAMMA, eta),
                6e-5,
                scale=1.0,
            )


def _buildings() -> Iterator[Row]:
    for profile, shape in PROFILES.items():
        building = storeys(profile, 6, 1e5, 0.6)
        first, wanted = building.shapes[:, 0] / building.shapes[-1, 0], shape(np.arange(1, 7) / 6)
        yield Row(
            f"{profile}, 6 storeys: period of mode 1 [s]",
            0.6,
            2 * math.pi / building.omega[0],
            1e-10,
        )
        yield Row(
            f"{profile}, 6 storeys: mode 1 off the profile [-]",
            0.0,
            float(np.abs(first - wanted / wanted[-1]).max()),
            1e-10,
        )
        yield Row(
            f"{profile}, 6 storeys: damping of mode 2 [-]", 0.05, float(building.damping[1]), 1e-12
        )
        yield Row(
            f"{profile}, 6 storeys: effective masses of all modes [-]",
            1.0,
            float(building.effective_mass.sum()),
            1e-12,
        )


def _sizes() -> Iterator[Row]:
    podium = study_podium("shear", 6, CRV)
    yield Row(
        "p of a column [rad/s] (D, g 9.81)",
        2.215,
        podium.describe()["frequency parameter p of a column"][0],
        1e-3,
        scale=1.0,
    )
    yield Row(
        "half width of a column [m] (D)",
        0.2225,
        podium.half_diagonal * math.sin(ALPHA),
        5e-5,
        scale=1.0,
    )
    yield Row(
        "half height of a column [m] (D)",
        1.4834,
        podium.half_diagonal * math.cos(ALPHA),
        5e-4,
        scale=1.0,
    )
    for words, exact, found in (
        ("I_0/(m_c R^2)", 4 / 3, podium.inertia),
        ("gamma", 10.0, podium.gamma),
        ("eta, the number of storeys", 6.0, podium.eta),
        ("period over n/10 s", 1.0, 2 * math.pi / podium.building.omega[0] / 0.6),
        ("damping of mode 1", 0.05, float(podium.building.damping[0])),
    ):
        yield Row(f"building of the study: {words} [-] (P, 5)", exact, found, 1e-9)
    yield Row(
        "motions of the study: magnitudes, distances and 100 of each (P, 4)",
        3500,
        100 * len(MAGNITUDES) * len(DISTANCES),
        0.0,
    )
    yield Row("their pulses: mean phase nu_p [rad] (P, 4)", 1.93, MEAN_PHASE, 1e-12)
    yield Row("their pulses: mean gamma_p [-] (P, 4)", 1.83, MEAN_GAMMA, 1e-12)
    # a steady acceleration of g tan alpha bends the building by its static shear, and lifts
    yield Row(
        "static base shear at uplift over M g tan alpha [-] (D of Eq. 4)",
        1.0,
        steady_shear(podium),
        2e-3,
    )


def steady_shear(podium: Podium) -> float:
    """Base shear over M g tan alpha when a slowly growing acceleration lifts the podium."""
    from fecolumn.engines.rocking.podium_motion import PODIUM_SHEAR, PODIUM_TILT

    time = np.arange(0, 40, 0.01)
    ground = np.column_stack([-0.03 * GRAVITY * np.clip(time / 5.0, 0, 6), 0 * time])
    rows, *_ = podium.shake(ground, 0.01)
    lifted = int(np.argmax(np.abs(rows[:, PODIUM_TILT]) > 0))
    return float(abs(rows[lifted - 1, PODIUM_SHEAR]) * podium.building_mass / podium.static_shear)


def _stiff() -> Iterator[Row]:
    frame, rest = (
        RockingFrame.of(1, ALPHA, 1.5, 1e4, 4e5),
        GroundMotion(np.zeros((401, 3)), 0.01, "at rest", ""),
    )
    exact = frame.respond(rest, tilt=0.5 * ALPHA).impact_times[:2]
    found = [
        Podium(ALPHA, 1.5, 1e4, 1e5, storeys("shear", 3, 1e5, period), CRV)
        .respond(rest, tilt=0.5 * ALPHA)
        .impact_times[:2]
        for period in _STIFF
    ]
    for number, (wanted, soft, stiff) in enumerate(zip(exact, *found), 1):
        order = math.log((soft - wanted) / (stiff - wanted), _STIFF[0] / _STIFF[1])
        yield Row(
            f"building of T to 0: impact {number}, that of a frame which carries its mass [s]",
            wanted,
            stiff + (stiff - soft) / 3,
            1e-6,
            order=order,
        )


def _energies() -> Iterator[Row]:
    rng = np.random.default_rng(7)
    noise = np.convolve(rng.normal(size=1500), np.hanning(25), "same")
    motion = GroundMotion(
        np.column_stack([4.0 * noise / np.abs(noise).max(), 0 * noise, 0 * noise]),
        0.01,
        "noise",
        "",
    )
    for law in LAWS:
        for n in (3, 9):
            podium = study_podium("flexural", n, law)
            response = podium.respond(motion)
            yield Row(
                f"flexural, {n} storeys, {law}, {len(response.impact_times)} impacts: "
                "energy closure over the barrier [-]",
                0.0,
                float(np.abs(response.energy["closure"]).max() / podium.energy_to_overturn),
                1e-5,
            )


def _draw(figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    alphas = np.linspace(0.05, 0.35)
    for eta, dashes in zip((0, 3, 6, 9), ("-", "--", "-.", ":")):
        left.plot(
            alphas,
            [podium_restitution(CAV, alpha, GAMMA, eta) for alpha in alphas],
            dashes,
            color="#D55E00",
            label=f"CAV, $\\eta$ = {eta}",
        )
    left.plot(
        alphas,
        [podium_restitution(CRV, alpha, GAMMA, 9) for alpha in alphas],
        color="#0072B2",
        label="CRV, any $\\eta$",
    )
    left.set(xlabel=r"slenderness $\alpha$ [rad]", ylabel="angular velocity after / before")
    left.legend()
    rest = GroundMotion(np.zeros((1001, 3)), 0.01, "at rest", "")
    for law, colour, dashes in ((CRV, "#0072B2", "-"), (CAV, "#D55E00", "--")):
        response = study_podium("shear", 6, law).respond(rest, tilt=0.9 * ALPHA)
        right.plot(
            response.time, response.coordinates["theta"] / ALPHA, dashes, color=colour, label=law
        )
    right.set(xlabel="time [s]", ylabel=r"$\theta/\alpha$, 6 storeys, shear profile", xlim=(0, 10))
    right.legend()
