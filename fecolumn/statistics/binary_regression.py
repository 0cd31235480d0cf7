"""Maximum likelihood of yes-no data by statsmodels: P(yes) = link(X c); data whose likelihood has
no maximum are refused.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_MAX_ITERATIONS, _TOLERANCE = 100, 1e-10
#: What a yes is unless a caller says something else.
OVERTURN = "overturn"


#: Of parameters c (p,): ln L, its gradient (p,) and minus its Hessian (p, p)
Likelihood = Callable[[NDArray[Any]], tuple[float, NDArray[Any], NDArray[Any]]]


class DegenerateData(ValueError):
    """No curve can be fitted, as the likelihood has no maximum; the message says why."""


def fit_binary(
    x: NDArray[Any],
    yes: NDArray[Any],
    link: str,
    groups: ArrayLike | None = None,
    event: str = OVERTURN,
) -> tuple[Any, NDArray[Any], int | None]:
    """Fit c of P(yes) = link(x c) by Newton's method.

    With `groups` the covariance of c is that of runs that hang together within a group: H^-1 (sum
    of g g^T over the groups) H^-1 G / (G - 1), with the score g of each of G groups (Liang & Zeger
    1986, Biometrika 73).

    Parameters
    ----------
    x
        (n, p) with a column of ones first.
    yes
        (n,) bool.
    link
        "probit" or "logit"; both likelihoods are concave.
    groups
        (n,) label of each run; None takes all runs as independent.
    event
        what a yes is, for messages: OVERTURN, or another limit state, such as "top > 50 mm".

    Returns
    -------
    The result of statsmodels (`params`, `llf`, `get_influence()`, ...), covariance (p, p) of c,
        number of groups or None.

    Raises
    ------
    DegenerateData
        all or none yes; a column that repeats others; a plane that parts yes from no (Albert &
        Anderson 1984, Biometrika 71); one group only.
    """
    from statsmodels.discrete.discrete_model import Logit, Probit

    refuse_degenerate(x, yes, event)
    options: dict[str, Any] = {}
    count, factor = None, 1.0
    if groups is not None:
        labels, group = np.unique(np.asarray(groups), return_inverse=True)
        if group.shape != yes.shape:
            raise ValueError(f"groups {group.shape} and {yes.shape} runs: must have one length")
        if (count := labels.size) < 2:
            raise DegenerateData("all runs are of one motion: nothing is known of others")
        options, factor = (
            dict(cov_type="cluster", cov_kwds={"groups": group, "use_correction": False}),
            count / (count - 1),
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of data that all but part: told below
        fit = {"probit": Probit, "logit": Logit}[link](yes.astype(float), x).fit(
            method="newton", maxiter=_MAX_ITERATIONS, tol=_TOLERANCE, disp=False, **options
        )
    if not fit.mle_retvals["converged"]:
        raise DegenerateData(
            "the likelihood rises without end: the data all but part into yes and no"
        )
    return fit, factor * fit.cov_params(), count


def maximize(
    function: Likelihood,
    start: NDArray[Any],
    inside: Callable[[NDArray[Any]], bool] = lambda c: True,
) -> tuple[NDArray[Any], NDArray[Any], float]:
    """Maximum of a concave function by damped Newton steps: (c, inverse of -Hessian, value).

    Parameters
    ----------
    function
        c -> (value, gradient (p,), minus Hessian (p, p)).
    start
        (p,).
    inside
        c -> whether c is allowed.
    """
    c, (value, gradient, information) = start, function(start)
    for _ in range(_MAX_ITERATIONS):
        step = np.linalg.solve(information, gradient)
        decrement, size = float(gradient @ step), 1.0
        if decrement < _TOLERANCE:
            return c, np.linalg.inv(information), float(value)
        while (
            not inside(c + size * step)
            or function(c + size * step)[0] < value + 0.1 * size * decrement
        ):
            size /= 2
            if size < 1e-10:
                raise DegenerateData("the likelihood has no maximum that Newton's method finds")
        c = c + size * step
        value, gradient, information = function(c)
    raise DegenerateData("the likelihood rises without end: the data all but part into yes and no")


def refuse_degenerate(x: NDArray[Any], yes: NDArray[Any], event: str = OVERTURN) -> None:
    """Raise DegenerateData where the likelihood has no finite maximum; event: as of
    `fit_binary`.
    """
    k, n = int(yes.sum()), yes.size
    if k in (0, n):
        happened = "overturned" if event == OVERTURN else "are beyond the limit"
        raise DegenerateData(
            f"{'none' if k == 0 else 'all'} of {n} runs {happened}: that bounds "
            f"P({event}), but no curve"
        )
    # columns alike but for one part in 1e5, such as peaks of pulses of one shape, leave the
    # information singular to rounding
    spread = x[:, 1:] - x[:, 1:].mean(axis=0)
    size = np.maximum(np.abs(spread).max(axis=0), 1e-9 * np.abs(x[:, 1:]).max(axis=0) + 1e-300)
    if np.linalg.matrix_rank(spread / size, tol=1e-5 * np.sqrt(len(x))) < spread.shape[1]:
        raise DegenerateData(
            "the intensity measures do not vary, or not independently of each other"
        )
    if _separated(x, yes):
        parts = ("beyond the limit", "within it")
        if event == OVERTURN:
            parts = ("that overturned", "that stood")
        raise DegenerateData(
            f"the intensity parts all runs {parts[0]} from all {parts[1]}: the "
            "slope of the fragility is unbounded"
        )


def _separated(x: NDArray[Any], yes: NDArray[Any]) -> bool:
    """Whether some c has x c >= 0 for all yes and <= 0 for all no, not all of them 0 (Konis 2007,
    linear programme).
    """
    if x.shape[1] == 2:
        low, high = x[~yes, 1], x[yes, 1]
        return bool(low.max() <= high.min() or high.max() <= low.min())
    from scipy.optimize import linprog

    signed = np.where(yes, 1.0, -1.0)[:, None] * (x / np.abs(x).max(axis=0))
    found = linprog(
        -signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(yes.size), bounds=(-1, 1), method="highs"
    )
    return bool(-found.fun > 1e-7)
