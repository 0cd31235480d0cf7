"""A foot of one body on a flat base as the contact core takes it, steps of it, and problems of
which the answer is known.
"""

import numpy as np
from plain import no_pads, poses_on_base
from two_blocks import Blocks, compliance

from fecolumn.contact.bodies import one_body
from fecolumn.contact.compliance import assemble
from fecolumn.contact.forces import find_forces, find_residual, solve_linear
from fecolumn.contact.interface import interface_of, rims_at_rest
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.problem import N_COUNTS, OK, begin_problem, list_near_points, room
from fecolumn.contact.projection import base_of
from fecolumn.contact.stick import no_stick
from fecolumn.contact.tolerances import ITERATIONS
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted

# a point gives way by this [m/N], sunk into the base by this it presses with 1000 N
GIVES, DEEP = 1e-9, 1e-6


def flat(compliance=None):
    """A base of one facet, 4 m wide; compliance: (12, 12) [m/N] of its corners, rigid unless
    given.
    """
    side = np.array([-2.0, 2.0])
    return base_of(
        side,
        side,
        np.array([[0, 2], [1, 3]]),
        np.arange(4),
        np.zeros((12, 12)) if compliance is None else compliance,
    )


class Foot:
    """Points at the nodes of one body, 1 m wide where tolerances are concerned, on a flat base.

    Parameters
    ----------
    arms
        (n, 3) [m].
    static, elastic
        (3 n, 3 n) [m/N] what follows forces at once and within the step, in the body's frame.
    mass, inertia
        of a body whose rigid motion is given so, as in the reduced engine; None: it is in
        `elastic`, as in full order.
    half
        dt^2 / 2 of the step [s2].
    own
        (n, 3) [m/N] of the points alone.
    """

    def __init__(
        self,
        arms,
        static,
        elastic,
        mu,
        mass=None,
        inertia=None,
        half=0.0,
        own=0.0,
        base=None,
        rotation=None,
    ):
        n = len(arms)
        self.rigid, self.n = half if mass else 0.0, n
        self.bodies = (
            one_body(arms, static, elastic, mass, inertia)
            if mass
            else one_body(arms, static, elastic)
        )
        self.dynamic, self.base = static + elastic, base or flat()
        self.points, self.interface = (
            node_points(arms, mu),
            interface_of(np.array([[0.0, 0, 0], [1.0, 0, 0]])),
        )
        self.springs = no_pads(np.full((n, 3), own))
        self.poses, self.rims = (
            poses_on_base(np.eye(3)[None] if rotation is None else rotation[None]),
            rims_at_rest(),
        )
        self.problem, self.counts = room(self.points), np.zeros(N_COUNTS, np.int64)

    def solve(self, positions, forces=None, anchors=None, stick=None):
        """Points (n,) of CONTACT after a step that brings them to `positions` (n, 3) [m] with the
        forces with which they began, none unless given.

        stick: where to find the stick operator, which is left out unless given.
        """
        positions, before = np.array(positions, float), np.zeros(self.n, CONTACT)
        before["force"], before["anchor"] = (
            0.0 if forces is None else forces,
            0.0 if anchors is None else anchors,
        )
        after, worth, stick = before.copy(), stick is not None, stick or no_stick(0)
        begin_problem(self.problem, False, worth)
        if not self.rigid:
            answer, residual = solve_linear(
                self.problem,
                self.bodies,
                self.base,
                self.points,
                self.interface,
                self.springs,
                self.dynamic,
                self.bodies.mobility,
                stick,
                self.rims,
                self.poses,
                positions,
                ITERATIONS,
                before,
                after,
                self.counts,
            )
        else:
            answer, residual = self._iterate(positions, before, after, stick)
        assert answer == OK and residual <= 1.0
        return after

    def _iterate(self, positions, before, after, stick):
        """As the reduced engine does: the motion under the forces is found outside."""
        response, everyone = np.empty((3 * self.n, 3 * self.n)), np.arange(self.n)
        interpreted(assemble)(
            self.bodies,
            self.base,
            self.points,
            self.points["arm"].copy(),
            everyone,
            self.poses,
            self.rigid,
            self.bodies.mobility,
            0.0,
            self.springs.own,
            response,
        )
        start, began = positions.copy(), after["force"].copy()
        for iteration in range(ITERATIONS):
            positions = start + (response @ (after["force"] - began).ravel()).reshape(-1, 3)
            interpreted(list_near_points)(
                self.problem, everyone, self.points, self.interface, positions, before, after
            )
            answer, residual = interpreted(find_residual)(
                self.problem,
                self.bodies,
                self.base,
                self.points,
                self.interface,
                self.springs,
                self.dynamic,
                self.rigid,
                stick,
                self.rims,
                self.poses,
                positions,
                iteration == 0,
                before,
                after,
                self.counts,
            )
            if answer != OK or residual <= 1.0:
                break
            assert (
                interpreted(find_forces)(
                    self.problem, self.points, self.interface, stick, after, False, self.counts
                )
                == OK
            )
        return answer, residual


def many(kind, n, seed):
    """A turned body with a random foot on an elastic base, its compliance by whole matrices, and
    the places (n, 3) of its points.
    """
    rng, half, mass = np.random.default_rng(seed), 2e-9, 3.0
    arms = np.column_stack([rng.uniform(-0.5, 0.5, (n, 2)), np.full(n, -0.3)])
    inertia, R = np.diag([0.2, 0.3, 0.4]), rotation_matrix(np.array([2e-3, -1e-3, 0.7]))
    static, elastic, below = (
        compliance(rng, n, 1e-10),
        compliance(rng, n, 2e-10),
        compliance(rng, 4, 1e-10),
    )
    rigid = half * Blocks.rigid(mass, inertia, arms)
    options = dict(base=flat(below), rotation=R, own=3e-11)
    foot = (
        Foot(arms, static, elastic + rigid, 0.3, **options)
        if kind == "nodal"
        else Foot(arms, static, elastic, 0.3, mass, inertia, half, **options)
    )
    places = arms @ R.T
    s, t = (places[:, 0] + 2) / 4, (places[:, 1] + 2) / 4
    shares = np.kron(
        np.column_stack([(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t]), np.eye(3)
    )
    turn = np.kron(np.eye(n), R)
    W = (
        turn @ (static + elastic + rigid) @ turn.T
        + shares @ below @ shares.T
        + 3e-11 * np.eye(3 * n)
    )
    return foot, W, places


def answer(n, slips, opens, seed, mu=0.3):
    """Forces and slacks (n, 3) that obey the laws: the first points slip against their friction,
    the last ones are open, the others stick.
    """
    rng = np.random.default_rng(seed)
    forces, slack = np.zeros((n, 3)), np.zeros((n, 3))
    forces[:, 2] = rng.uniform(500, 1500, n)
    forces[:, :2] = 0.5 * mu * forces[:, 2:] * rng.uniform(-1, 1, (n, 2))
    angles = rng.uniform(0, 2 * np.pi, slips)
    way = np.column_stack([np.cos(angles), np.sin(angles)])
    forces[:slips, :2], slack[:slips, :2] = (
        -mu * forces[:slips, 2:] * way,
        0.1 * DEEP * rng.uniform(0.5, 1, (slips, 1)) * way,
    )
    forces[n - opens :], slack[n - opens :] = (
        0.0,
        np.column_stack(
            [np.full((opens, 2), 0.05 * DEEP), 0.1 * DEEP * rng.uniform(0.5, 1, opens)]
        ),
    )
    return forces, slack
