"""Groups of checks as one Markdown table."""

from __future__ import annotations

import sys
import time

# rows without a limit say how it is
_WORDS = {True: "yes", False: "NO", None: ""}


def print_checks(
    title: str, groups: dict, names, computed: str = "computed", width: int = 72
) -> int:
    """Print the checks of the named groups; 1 where one fails, 2 for an unknown name.

    Parameters
    ----------
    title
        of the benchmark, for messages.
    groups
        by name, functions that yield (label, reference, computed, whether it holds or None).
    names
        groups to run, in this order.
    computed
        head of the third column.
    width
        of the first one.
    """
    failed, unknown = 0, set(names) - set(groups)
    if unknown:
        print(
            f"{title}: {', '.join(sorted(unknown))}: must be of {', '.join(groups)}",
            file=sys.stderr,
        )
        return 2
    print(
        f"| {'check':<{width}} | {'reference':>10} | {computed:>10} | ok  "
        f"|\n|{'-' * (width + 2)}|{'-' * 11}:|{'-' * 11}:|-----|"
    )
    for name in names:
        began = time.perf_counter()
        for label, reference, found, ok in groups[name]():
            ok = None if ok is None else bool(ok)
            failed += ok is False
            print(
                f"| {label:<{width}} | {reference:>10.5g} | {found:>10.5g} | {_WORDS[ok]:<3} |",
                flush=True,
            )
        print(f"{name}: {time.perf_counter() - began:.0f} s", file=sys.stderr)
    return int(failed > 0)
