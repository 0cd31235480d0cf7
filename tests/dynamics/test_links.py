"""The law of links along prescribed ways, against its closed form: elastic, perfectly plastic, with
slack, both ways or in tension alone; breaking; dashpots.
"""

import numpy as np
import pytest

from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import frames_at, grounds_at
from fecolumn.engines.dynamics.links import (
    LINK,
    TIE,
    Held,
    Linked,
    end_links,
    pull_links,
)
from fecolumn.engines.reduced.follow import UNSETTLED

LENGTH, STIFFNESS, YIELDS, DT = 1.0, 2e6, 4e3, 1e-3
ELASTIC = YIELDS / STIFFNESS  # elongation at which it yields [m]
FAR = 5 * ELASTIC


def walked(
    ways,
    pushes=True,
    play=0.0,
    damping=0.0,
    yields=YIELDS,
    breaks=np.inf,
    stiffness=STIFFNESS,
    hardening=0.0,
    **more,
):
    """A link from a body to the ground whose length goes along elongations (n,) [m]: tensions (n,)
    [N] at the ends of the steps, its tie, the energy kept and taken, and the work done on it [J],
    from the forces within the steps.
    """
    link, ties, frames, pulls = (
        np.zeros(1, LINK),
        np.zeros(1, TIE),
        [frames_at(np.array([[LENGTH + way, 0.0, 0.0]])) for way in (0.0, *ways)],
        np.zeros((1, 3)),
    )
    link["a"], link["b"], link["length"], link["play"], link["stiffness"], link["damping"] = (
        0,
        GROUND,
        LENGTH,
        play,
        stiffness,
        damping,
    )
    link["pulls"], link["pushes"], link["yields"], link["breaks"] = (
        stiffness > 0,
        pushes,
        yields,
        breaks,
    )
    link["hardens"] = stiffness * hardening / (1 - hardening)
    link["bends"], link["power"] = np.inf, 1.0
    for name, value in more.items():
        link[name] = value
    linked, grounds = Linked(link, np.zeros((1, 2, 3, 0))), grounds_at([0.0])
    ties["length"], turn, tensions, taken, done = LENGTH, np.eye(3)[None], [], 0.0, 0.0
    for before, after in zip(frames, frames[1:]):
        later = ties.copy()
        start, end = (
            Held(grounds, place, turn, np.zeros((1, 3, 0)), own)
            for place, own in ((before, ties), (after, later))
        )
        pull_links(linked, start, end, DT, pulls)
        kept, lost = end_links(linked, start, end, DT)
        # the force on the body pulls it towards the ground, at the origin
        done -= pulls[0, 0] * (after["center"][0, 0] - before["center"][0, 0])
        ties, taken = later, taken + lost
        tensions.append(float(later["force"][0]))
    return np.array(tensions), ties[0], kept, taken, done


def half_cycle(steps, peak=FAR):
    return peak * np.sin(np.pi * np.arange(1, steps + 1) / steps)


@pytest.mark.parametrize("steps", [6, 10, 1000])
def test_a_spring_pulled_by_a_half_cycle_gives_the_loop_of_the_elastic_perfectly_plastic_law(steps):
    """It yields on the way out and, pushed back to its length, in compression: F_y times the
    plastic way, whatever the step.
    """
    ways = half_cycle(steps)
    tensions, tie, kept, taken, done = walked(ways)
    out = np.minimum(STIFFNESS * ways, YIELDS)
    back = np.maximum(YIELDS - STIFFNESS * (FAR - ways), -YIELDS)
    np.testing.assert_allclose(
        tensions, np.where(np.arange(1, steps + 1) <= steps // 2, out, back), atol=1e-8 * YIELDS
    )
    plastic = (FAR - ELASTIC) + (FAR - 2 * ELASTIC)
    assert taken == pytest.approx(YIELDS * plastic, rel=1e-10) and tie["work"] == pytest.approx(
        taken
    )
    # residual elongation at no force, and the force that is left at the length of the start
    assert tie["flowed"] == pytest.approx(ELASTIC, rel=1e-9) and tensions[-1] == pytest.approx(
        -YIELDS
    )
    assert done == pytest.approx(taken + kept, rel=1e-10) and kept == pytest.approx(
        YIELDS * ELASTIC / 2
    )


@pytest.mark.parametrize("steps", [6, 1000])
def test_a_tendon_yields_in_tension_alone_and_is_slack_below_its_residual_elongation(steps):
    ways = half_cycle(steps)
    tensions, tie, kept, taken, done = walked(ways, pushes=False)
    assert tie["flowed"] == pytest.approx(FAR - ELASTIC, rel=1e-9) and taken == pytest.approx(
        YIELDS * (FAR - ELASTIC), rel=1e-10
    )
    slack = (np.arange(1, steps + 1) > steps // 2) & (ways < FAR - ELASTIC)
    assert slack.any() and not tensions[slack].any() and tensions.min() == 0.0 and kept == 0.0
    assert done == pytest.approx(taken, rel=1e-10)


@pytest.mark.parametrize("steps", [8, 1000])
def test_the_slack_of_a_restrainer_moves_along_with_what_has_yielded(steps):
    play = ELASTIC
    ways = np.concatenate([half_cycle(steps), -half_cycle(steps)])
    tensions, tie, kept, taken, done = walked(ways, play=play)
    assert tensions.max() == pytest.approx(YIELDS) and tensions.min() == pytest.approx(-YIELDS)
    # out to FAR it yields by `there`, to -FAR by as much the other way; back at its length, play +
    # ELASTIC from there, its other side has yielded by the rest
    there = FAR - play - ELASTIC
    rest = there - play - ELASTIC
    assert taken == pytest.approx(YIELDS * (there + 2 * there + rest), rel=1e-10) and tie[
        "flowed"
    ] == pytest.approx(rest - there, rel=1e-9)
    assert done == pytest.approx(taken + kept, rel=1e-9) and kept == pytest.approx(
        YIELDS * ELASTIC / 2
    )


def test_a_restrainer_that_goes_from_one_side_to_the_other_within_a_step_keeps_its_energy():
    *_, kept, taken, done = walked(
        [3 * ELASTIC, -2 * ELASTIC, 2.5 * ELASTIC], play=ELASTIC, yields=np.inf
    )
    assert taken == 0.0 and done == pytest.approx(kept, rel=1e-12)


@pytest.mark.parametrize("steps", [10, 1000])
def test_a_link_breaks_for_good_and_loses_what_it_held(steps):
    breaks = 3 * ELASTIC
    tensions, tie, kept, taken, done = walked(
        half_cycle(steps, 4 * ELASTIC), yields=np.inf, breaks=breaks
    )
    assert (
        tie["broken"]
        and kept == 0.0
        and tensions[-1] == 0.0
        and done == pytest.approx(taken, rel=1e-12)
    )
    if steps == 1000:
        assert taken == pytest.approx(
            STIFFNESS * breaks**2 / 2, rel=0.01
        ) and tensions.max() == pytest.approx(STIFFNESS * breaks, rel=0.01)


@pytest.mark.parametrize("steps", [50, 5000])
def test_a_link_that_yields_breaks_at_the_elongation_of_its_breaking_force_whatever_the_step(steps):
    ways = np.linspace(0, FAR, steps + 1)[1:]
    tensions, tie, _, taken, done = walked(ways, breaks=3 * ELASTIC)
    assert (
        tie["broken"]
        and tensions.max() == pytest.approx(YIELDS)
        and done == pytest.approx(taken, rel=1e-10)
    )
    assert ways[tensions > 0].max() == pytest.approx(3 * ELASTIC, abs=1.01 * FAR / steps)


def test_a_dashpot_takes_its_work_and_tells_its_force():
    """c times the rate, and c w^2 A^2 T / 2 over the half cycle A sin(w t) of length T."""
    steps, damping = 1000, 300.0
    ways = half_cycle(steps)
    tensions, tie, kept, taken, done = walked(ways, stiffness=0.0, damping=damping)
    rate = FAR * np.pi / (steps * DT)
    assert tensions[0] == pytest.approx(damping * rate, rel=1e-4) and tensions[-1] == pytest.approx(
        -tensions[0]
    )
    assert (
        taken == pytest.approx(damping * rate**2 * steps * DT / 2, rel=1e-5)
        and done == pytest.approx(taken, rel=1e-9)
        and kept == 0.0
        and tie["work"] == taken
    )


@pytest.mark.parametrize("place", [0.3, 3.0])
def test_a_change_of_force_by_the_rounding_of_places_counts_little(place):
    """Glue between grains that carries nothing: its force is rounding, and changes by its size."""
    link, ties, pulls = np.zeros(1, LINK), np.zeros(1, TIE), np.zeros((1, 3))
    link["a"], link["b"], link["stiffness"], link["breaks"] = 0, GROUND, 1e10, np.inf
    link["pulls"] = link["pushes"] = True
    link["yields"], link["bends"], link["power"] = np.inf, np.inf, 1.0
    link["arm_b"] = [place, 0.0, 0.0]
    linked, grounds = Linked(link, np.zeros((1, 2, 3, 0))), grounds_at([0.0])

    def change(way):
        places = np.array([[place + way, 0.0, 0.0]])
        held = Held(grounds, frames_at(places), np.eye(3)[None], np.zeros((1, 3, 0)), ties)
        return pull_links(linked, held, held, DT, pulls)

    change(0.0)
    assert 0.0 < change(np.spacing(place)) < UNSETTLED / 10
    # a change that is no rounding counts in full
    assert change(1e-3 * place) > 0.5
