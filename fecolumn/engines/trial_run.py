"""A trial: the first steps of an analysis, of which nothing is kept but what is in memory."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

from fecolumn.engines.analysis import Analysis, AnalysisFailed


def trial(
    begin: Callable[[Path], Analysis],
    enough: Callable[[], bool] = lambda: False,
    until_s: float = float("inf"),
    stop: Callable[[], bool] = lambda: False,
) -> tuple[Analysis, str]:
    """The analysis that `begin` makes in a folder which is removed, after its first steps, and its
    outcome; "" where it was not at its end.

    Parameters
    ----------
    begin
        makes the analysis, of its folder.
    enough
        asked as `stop` of an analysis is: whether the trial ends here.
    until_s
        model time [s] at which it ends.
    stop
        whether to raise KeyboardInterrupt.

    Raises
    ------
    AnalysisFailed
        a step did not converge.
    """
    asked: list[bool] = []

    def over() -> bool:
        asked[:] = [enough()]
        return asked[0] or stop()

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        analysis = begin(Path(folder))
        if until_s < float("inf"):
            dt = float(analysis.case.integration.dt_s)
            analysis.steps = min(analysis.steps, round(until_s / dt))
        try:
            return analysis, analysis.run(over)["outcome"]
        except KeyboardInterrupt:
            if asked != [True]:
                raise
        except AnalysisFailed as error:  # its state goes with the folder
            kept = [one for one in str(error).split("; ") if folder not in one]
            raise AnalysisFailed("; ".join(kept)) from None
    return analysis, ""
