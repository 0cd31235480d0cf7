"""The jobs of the manual at full size: what each takes to type, and to run.

    ./containers/run python -m benchmarks.jobs [DIR]

Runs the blocks of `fecolumn/case/manual/jobs.md` in their order in DIR (default: a new folder) and
prints two tables: the answers that the page quotes, and what each job takes. Lines of input are
those of TOML files and Python that hold a key or a statement; scans, records and measured tests are
data. Minutes are of the processor, of all processes together; kernels are compiled beforehand, and
reduced models that the machine has of earlier runs are taken again.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path

from benchmarks.beside import markdown
from benchmarks.examples import first
from benchmarks.page import Block, folder_given, follow, sections

JOBS = ("statue", "records", "exhibit", "bridge bent", "cabinet", "calibrate", "cost", "Python")
#: Lines that the page quotes of a job's answers: a name for each, and how it begins
LINES = {
    "statue": {"statue": "statue: u_max "},
    "records": {"records": "ax: PGA "},
    "cabinet": {"cabinet": "P(lost) < "},
    "calibrate": {
        "calibrate": "block.restitution = ",
        "calibrate, tilt": "initial.tilt_rad = ",
        "calibrate, trade": "block.restitution and initial.tilt_rad trade",
        "calibrate, fit": "The fit leaves ",
    },
    "cost": {
        "cost": "as it is ",
        "cost, modes": "integration.n_modes = ",
        "cost, rigid": "integration.engine = ",
        "cost, step": "integration.dt_s = ",
    },
}


def main() -> int:
    """Run all jobs and print the tables."""
    folder, answers, rows = folder_given(), [], []
    for name, blocks in zip(JOBS, sections("jobs").values()):
        lines, spent, printed = 0, _spent_s(), ""
        for block in blocks:
            printed += follow(block, folder)
            lines += lines_of_input(block)
        rows.append((name, str(lines), _minutes(_spent_s() - spent)))
        for quoted, begin in LINES.get(name, {}).items():
            answers.append((quoted, first(printed.splitlines(), begin)))
        if name in SENTENCES:
            answers.append((name, SENTENCES[name](folder)))
    print("\n" + markdown(("job", "says"), answers))
    print("\n" + markdown(("job", "lines of input", "minutes"), rows))
    return 0


def exhibit(folder: Path) -> str:
    """What summary.json says of the exhibit with wires, as a sentence."""
    found = json.loads((folder / "exhibit" / "summary.json").read_text())
    amphora = next(one for name, one in found["interfaces"].items() if name.startswith("amphora"))
    wires = sorted(wire["tension_max_n"] for wire in found["links"].values())
    return (
        f"The amphora slides by {1e3 * amphora['slide_max_m']:.0f} mm on the showcase and tilts by "
        f"{amphora['tilt_max_rad']:.2f} rad on it at most; the wires carry up to "
        f"{wires[0]:.0f} to {wires[-1]:.0f} N"
    )


def bent(folder: Path) -> str:
    """What summary.json says of the bridge bent, as a sentence."""
    found = json.loads((folder / "bent" / "summary.json").read_text())
    bars = [one for name, one in found["links"].items() if name.startswith("bar")]
    tension = max(one["tension_max_n"] for name, one in found["links"].items() if "bar" not in name)
    work = " and ".join(f"{1e-3 * bar['work_j']:.1f}" for bar in bars)
    return (
        f"The top moves by {1e3 * found['u_max_m']:.0f} mm at most, the tendons carry up to "
        f"{1e-3 * tension:.0f} kN, and the bars yield at "
        f"{min(bar['yielded_at_s'] for bar in bars):.1f} s and take {work} kJ"
    )


#: Sentences of jobs whose answers stand in their folders
SENTENCES = {"exhibit": exhibit, "bridge bent": bent}


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
