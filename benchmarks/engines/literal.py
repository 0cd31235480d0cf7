"""What a first impact takes in the literal HHT scheme (contact.impact = "none"), over what
Housner's rigid block loses, by alpha and time step.

Of the coarse column of benchmarks/literal_scheme.toml in the full-order engine, mu 0.8; the default
scheme of the reduced engine beside it, which keeps alpha from the contact.
"""

from __future__ import annotations

from pathlib import Path

from benchmarks.engines.impact import BESIDE
from fecolumn.fem.rotation import tilt_angle
from fecolumn.study.plan import read_plan
from fecolumn.verification.models import system_of
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.rocking import leaning_start
from fecolumn.verification.trial import RigidRocking

STUDY = Path(__file__).parents[1] / "literal_scheme.toml"
SHARE = 0.4  # of the critical tilt
# time step [s] and the alphas there: the smaller step costs four times as much
RUNS = ((1e-3, (0.0, -0.05, -0.1, -0.2, -1 / 3)), (2.5e-4, (0.0, -0.2)))


def literal():
    """Loss of the first impact from 0.4 of the critical tilt over Housner's in both schemes, least
    and most of the releases.
    """
    case = read_plan(STUDY).analyses[0].case
    for dt, alphas in RUNS:
        for alpha in alphas:
            for impact, engine in (("plastic", "reduced"), ("none", "corotated")):
                chosen = case.replace(
                    contact={"friction_coefficient": 0.8, "impact": impact},
                    integration={"dt_s": dt, "alpha_hht": alpha, "engine": "full"},
                )
                ratios = losses(
                    system_of(chosen),
                    engine,
                    impact,
                    BESIDE if dt == RUNS[0][0] else BESIDE[:1],
                )
                for word, ratio in (("least", min(ratios)), ("most", max(ratios)))[: len(ratios)]:
                    yield (
                        f"impact = {impact!r}, dt {dt:g} s, alpha_HHT {alpha:.3g}: "
                        f"{word} of {len(ratios)} [-]",
                        1.0,
                        ratio,
                        None,
                    )


def losses(system, engine: str, impact: str, beside) -> list[float]:
    """Loss of the first impact over Housner's of releases at tilts a little apart."""
    rigid, found = RigidRocking(system), []
    for more in beside:
        share = SHARE * more
        tilt = share * rigid.slenderness
        found.append(
            lost(begin_trial(engine, system, leaning_start(share), impact), tilt)
            / (rigid.energy(tilt) * (1 - rigid.restitution**2))
        )
    return found


def lost(trial, tilt: float) -> float:
    """Mechanical energy [J] lost between a third of the tilt of release on one side and a third of
    it on the other, as in `impact`.
    """
    before, lean = None, 1.0
    while lean > 0 or tilt_angle(trial.state.rotation[0]) < tilt / 3:
        trial.step()
        lean = trial.state.rotation[0, 0, 2]
        if lean > 0 and tilt_angle(trial.state.rotation[0]) > tilt / 3:
            before = trial.mechanical()
    return before - trial.mechanical()
