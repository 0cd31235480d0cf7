"""The friction problem of one step: impulses p and velocities u = W p + q of n contacts, components
across (n) and along (t).

    0 <= u_n, 0 <= p_n, u_n p_n = 0                                                (Signorini)
    |p_t| <= mu p_n, and p_t = -mu p_n sign(u_t) where u_t is not 0                (Coulomb)

Solved exactly by the states open, stick, slip of the contacts: with these given the problem is
linear (a Newton method on the equations of Alart and Curnier 1991). Where states cycle, sweeps of
non-linear Gauss-Seidel (Jourdan, Alart and Jean 1998) give new ones. p in N s, u in m/s, W in 1/kg.
"""

from __future__ import annotations

import numpy as np
from numba import njit

OPEN, STICK, SLIP_BACK, SLIP_ON = 0, 1, 2, 3  # SLIP_BACK: friction along +t, SLIP_ON: along -t
#: Largest error of a solution in velocities [m/s]
TOLERANCE = 1e-7
#: Added to the diagonal of W over it: tells apart impulses that no motion tells apart, those of two
#: corners of one rigid face
_SPREAD = 1e-10
_NEWTON, _SWEEPS, _ROUNDS = 12, 50, 200


@njit(cache=True)
def side(state):
    """Friction over mu p_n of a contact that slips."""
    return 1.0 if state == SLIP_BACK else -1.0


@njit(cache=True)
def alone(nn, nt, tt, qn, qt, mu):
    """p_n, p_t and state of one contact whose W is [[nn, nt], [nt, tt]] and whose velocity without
    it is (qn, qt).
    """
    if qn >= 0.0:
        return 0.0, 0.0, OPEN
    det = nn * tt - nt * nt
    pn, pt = (nt * qt - tt * qn) / det, (nt * qn - nn * qt) / det
    if abs(pt) <= mu * pn:
        return pn, pt, STICK
    for state in (SLIP_BACK, SLIP_ON):
        share = side(state) * mu
        if nn + share * nt > 0.0:
            pn = -qn / (nn + share * nt)
            if side(state) * (qt + (nt + tt * share) * pn) <= 0.0:
                return pn, share * pn, state
    return -qn / nn, 0.0, STICK


@njit(cache=True)
def sweep(W, q, mu, p, state):
    """One sweep of Gauss-Seidel over all contacts; W: (2 n, 2 n), q, p: (2 n,), component n of
    contact i at 2 i.
    """
    for i in range(len(mu)):
        n, t = 2 * i, 2 * i + 1
        un, ut = q[n], q[t]
        for j in range(len(q)):
            un += W[n, j] * p[j]
            ut += W[t, j] * p[j]
        un -= W[n, n] * p[n] + W[n, t] * p[t]
        ut -= W[t, n] * p[n] + W[t, t] * p[t]
        p[n], p[t], state[i] = alone(W[n, n], W[n, t], W[t, t], un, ut, mu[i])


@njit(cache=True)
def with_states(W, q, mu, state, p):
    """Put into p the impulses with which closed contacts do not part and sticking ones do not
    slide.
    """
    n, size = len(mu), 0
    unknown = np.empty(2 * n, np.int64)
    for i in range(n):
        for a in range(0 if state[i] == OPEN else 2 if state[i] == STICK else 1):
            unknown[size] = 2 * i + a
            size += 1
    p[:] = 0.0
    if size == 0:
        return
    A, b = np.empty((size, size)), np.empty(size)
    for k in range(size):
        row = unknown[k]
        b[k] = -q[row]
        for m in range(size):
            column = unknown[m]
            j = column // 2
            A[k, m] = W[row, column]
            if column % 2 == 0 and state[j] != STICK:
                A[k, m] += side(state[j]) * mu[j] * W[row, column + 1]
        A[k, k] += _SPREAD * W[row, row]
    b = np.linalg.solve(A, b)
    for k in range(size):
        row = unknown[k]
        p[row] = b[k]
        if row % 2 == 0 and state[row // 2] != STICK:
            p[row + 1] = side(state[row // 2]) * mu[row // 2] * b[k]


@njit(cache=True)
def judge(W, q, mu, p, state):
    """Error of p in velocities [m/s], and whether `state`, which gets the state that p and its
    velocities ask for, has changed.
    """
    worst, changed = 0.0, False
    for i in range(len(mu)):
        n, t = 2 * i, 2 * i + 1
        un, ut = q[n], q[t]
        for j in range(len(q)):
            un += W[n, j] * p[j]
            ut += W[t, j] * p[j]
        across, along, bound = p[n] - un / W[n, n], p[t] - ut / W[t, t], mu[i] * max(p[n], 0.0)
        worst = max(
            worst,
            W[n, n] * abs(p[n] - max(across, 0.0)),
            W[t, t] * abs(p[t] - min(max(along, -bound), bound)),
        )
        if across <= 0.0:
            asked = OPEN
        elif abs(along) <= bound:
            asked = STICK
        else:
            asked = SLIP_BACK if along > 0.0 else SLIP_ON
        changed |= asked != state[i]
        state[i] = asked
    return worst, changed


@njit(cache=True)
def solve(W, q, mu, p, state):
    """Solve from the impulses and states given, into p (2 n,) and state (n,): the error that is
    left [m/s].
    """
    best, least = p.copy(), judge(W, q, mu, p, state.copy())[0]
    for _ in range(_ROUNDS):
        for _ in range(_NEWTON):
            with_states(W, q, mu, state, p)
            error, changed = judge(W, q, mu, p, state)
            if error <= TOLERANCE:
                return error
            if error < least:
                least = error
                best[:] = p
            if not changed:
                break
        p[:] = best
        for _ in range(_SWEEPS):
            sweep(W, q, mu, p, state)
        best[:] = p
        least = judge(W, q, mu, p, state.copy())[0]
        if least <= TOLERANCE:
            return least
    return least
