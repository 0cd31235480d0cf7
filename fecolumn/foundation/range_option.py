"""Options whose values may begin with a minus."""

from __future__ import annotations

import argparse
import re


def take_values_below_zero(parser: argparse.ArgumentParser) -> None:
    """Let a parser take words that begin with a minus and a digit, such as the range -0.3:0, for
    values and not for options, as argparse of Python 3.14 does.
    """
    parser._negative_number_matcher = re.compile(r"-\.?\d")
