"""The jobs of the manual at full size: what each takes to type, and to run.

    ./containers/run python -m benchmarks.jobs [DIR]

Runs the blocks of `fecolumn/case/manual/jobs.md` in their order in DIR (default: a new folder) and
prints the answers, then a table. Lines of input are those of TOML files and Python that hold a key
or a statement; scans, records and measured tests are data. Minutes are of the processor, of all
processes together; kernels are compiled beforehand, and reduced models that the machine has of
earlier runs are taken again.
"""

from __future__ import annotations

import resource
import sys

from benchmarks.beside import markdown
from benchmarks.page import Block, folder_given, follow, sections

#: What came of each job with version 0.6.6, tried by its README and manual alone
BEFORE = {
    "statue": ("half: no surfaces, millimetres not known", "-"),
    "records": ("half: no decimal commas, no K-NET, drift not told", "-"),
    "exhibit": ("half: wires without their forces, pads 20 ms a step", "-"),
    "bridge bent": ("half: no soil, tendons not drawn", "-"),
    "cabinet": ("half: 132 runs by hand, no inverse question", "40 with finite elements"),
    "calibrate": ("no", "-"),
    "cost": ("not told before the run", "4.4"),
    "Python": ("mostly: tables of keys, no types", "-"),
}


def main() -> int:
    """Run all jobs and print the table."""
    folder, rows = folder_given(), []
    for name, blocks in zip(BEFORE, sections("jobs").values()):
        lines, spent = 0, _spent_s()
        for block in blocks:
            follow(block, folder)
            lines += lines_of_input(block)
        rows.append((name, *BEFORE[name], str(lines), _minutes(_spent_s() - spent)))
    head = ("job", "in 0.6.6", "in 0.6.6 [min]", "lines of input", "now [min]")
    print("\n" + markdown(head, rows))
    return 0


def lines_of_input(block: Block) -> int:
    """Lines of a block that a user types: of TOML files and Python, but for pictures."""
    code = [line for line in block.text.splitlines() if line.strip() and line.strip()[0] != "#"]
    drawn = block.language == "python" and "pyvista" in block.text
    return len(code) if block.language in ("toml", "python") and not drawn else 0


def _minutes(seconds: float) -> str:
    return f"{seconds / 60:.1f}" if seconds >= 3 else "< 0.1"


def _spent_s() -> float:
    """Time of the processor in processes that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    sys.exit(main())
