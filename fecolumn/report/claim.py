"""A claim of the paper, what the study finds, and the verdict by rule."""

from __future__ import annotations

from dataclasses import dataclass

SUPPORTED, NOT_SUPPORTED, UNDECIDED = "supported", "not supported", "undecided"

#: Katsamakas & Vassiliou's P(overturn). The specimen's free dimensions were chosen to come near it: never a result.
CALIBRATION_TARGET = 50 / 115
#: Distance at which the two-sample Kolmogorov-Smirnov test of two times 115 motions rejects at 5 %: what the paper's own
#: ensemble would show. A difference that is excluded beyond it is called marginal.
MARGIN = 1.3581 * (2 / 115)**0.5


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim.

    Attributes:
        key: "a1" and so on.
        paper: what the paper found.
        ours: what this study finds, in sentences with its numbers.
        rule: what decides.
        verdict: supported, not supported or undecided.
    """

    key: str
    paper: str
    ours: str
    rule: str
    verdict: str
