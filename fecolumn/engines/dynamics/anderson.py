"""Acceleration of an iteration that contracts slowly (Anderson 1965)."""

from __future__ import annotations

import numpy as np


class Anderson:
    """Places from which an iteration g(x) comes nearer to its rest, from those it has been at.

    The combination of the last ones, of which the changes g(x) - x add up to the least in the sense
    of least squares (Walker and Ni 2011, eq. 3.1):

        x = g_k - dG c,    min |f_k - dF c|,    f = g(x) - x

    Of a linear iteration in n unknowns it finds the rest in n + 1 steps, as GMRES does.

    Parameters
    ----------
    memory
        differences that are kept, at most.
    """

    def __init__(self, memory: int):
        self._memory = memory
        self.forget()

    def forget(self) -> None:
        """Begin anew: what comes is of another iteration."""
        self._changes: list[np.ndarray] = []
        self._places: list[np.ndarray] = []

    def note(self, place: np.ndarray, change: np.ndarray) -> None:
        """Take down g (n,) to which the iteration came by a change f (n,)."""
        self._places.append(place)
        self._changes.append(change)
        del self._places[: -self._memory - 1], self._changes[: -self._memory - 1]

    def place(self) -> np.ndarray | None:
        """Place x (n,) to go on from; None before two are known."""
        if len(self._changes) < 2:
            return None
        changes, places = np.diff(self._changes, axis=0).T, np.diff(self._places, axis=0).T
        # the later ones are smaller by powers of ten
        sizes = np.linalg.norm(changes, axis=0)
        if not sizes.all():
            return None
        shares = np.linalg.lstsq(changes / sizes, self._changes[-1], rcond=1e-12)[0]
        return self._places[-1] - places @ (shares / sizes)
