"""Each figure of README and manual: where it lies and how it is made."""

from __future__ import annotations

import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

from benchmarks.gallery.rolling import rolling
from fecolumn.foundation.toml_file import read_toml

ROOT = Path(__file__).parents[2]
# The stout column in motion 3 of the Lick ensemble, half again as strong, on a mesh coarser than
# its own
ROCKING = {
    "mesh": {"coarse_size_m": 0.02, "cap_size_m": 0.025, "base_size_m": 0.03},
    "motion": {"source": "lick:3", "scale": 1.5},
    "integration": {"engine": "reduced", "duration_s": 6.0},
}
# Colours of a picture's file, the most that PNG's palette has: lines and their soft edges need
# fewer, a stress scale all
_COLOURS = 256


@dataclass(frozen=True, slots=True)
class Work:
    """How the figures are to be made: folder of the analyses, which are kept and gone on with;
    analyses at a time; folder of a finished study to draw, or None.
    """

    folder: Path
    jobs: int = 1
    study: Path | None = None


def rocking(work: Work, target: Path) -> str:
    """The stout column at its largest tilt, coloured by its stress, as `fecolumn render` draws
    it.
    """
    from fecolumn.case.case import case_from_tables
    from fecolumn.engines.dynamics.history import read_history
    from fecolumn.pictures.render.draw import render
    from fecolumn.pictures.render.render_options import RenderOptions
    from fecolumn.simulation import run

    file, folder = ROOT / "meshes" / "stout.toml", work.folder / "rocking"
    tables = read_toml(file)
    for section, keys in ROCKING.items():
        tables[section] = tables.get(section, {}) | keys
    run(case_from_tables(tables, file), folder)
    history = read_history(folder / "history.h5")
    time = float(history["time"][history["tilt"].argmax()])
    still = next(
        path
        for path in render(folder, RenderOptions(only="pictures", instants=(time,)))
        if path.name.startswith("still_")
    )
    shutil.copy(still, target)
    return (
        "motion 3 of the Lick ensemble at 1.5 times its strength: largest tilt "
        f"{1e3 * history['tilt'].max():.0f} mrad at {time:.2f} s"
    )


def cdf(work: Work, target: Path) -> str:
    """The distributions of a study: of benchmarks/quick_study.toml, which is run, or of the one
    that is given.
    """
    from fecolumn.study.plan import read_plan
    from fecolumn.study.results.study import StudyResult
    from fecolumn.study.run import complete_study

    folder = work.study or work.folder / "quick"
    if not work.study:
        complete_study(
            read_plan(ROOT / "benchmarks" / "quick_study.toml"), folder, workers=work.jobs
        )
    result = StudyResult(folder)
    result.plot.cdf().save(target)
    levels = ", ".join(f"{len(values)} of {key}" for key, values in result.axes.items())
    source = f"--study {folder}" if work.study else "benchmarks/quick_study.toml"
    return (
        f"{result.title}: {result.done} of {len(result.rows)} analyses done ({levels}), "
        f"from {source}"
    )


def impact(_: Work, target: Path) -> str:
    """Loss of one impact by time step, from the table that `python -m benchmarks.impact` made in an
    hour.
    """
    from benchmarks.impact.__main__ import read
    from benchmarks.impact.figure import draw

    table = ROOT / "benchmarks" / "impact" / "impact.csv"
    rows = read(table)
    draw(rows, target.with_suffix(""))
    return f"{len(rows)} impacts of {table.relative_to(ROOT)}"


def impact_map(_: Work, target: Path) -> str:
    """Loss of one impact in the limit of short steps, over stiffness and slenderness, from the
    tables that `python -m benchmarks.impact map` made in hours.
    """
    from benchmarks.impact.figure import draw_map
    from benchmarks.impact.kept_map import kept_cells

    cells = kept_cells()
    draw_map(cells, target.with_suffix(""))
    return f"{len(cells)} cells of benchmarks/tables/impact_map.csv"


def rim(_: Work, target: Path) -> str:
    """How the points of a round rim roll in a step; all of it from `contact.rolling`."""
    rolling(target)
    return "from contact.rolling"


def two_sides(_: Work, target: Path) -> str:
    """Rates before and after an impact of a block on an equal one, over its displacement, as
    `fecolumn verify -k joints` draws them.
    """
    from matplotlib.figure import Figure

    from fecolumn.verification.joints import draw_rates

    figure = Figure(figsize=(7.2, 2.8))
    draw_rates("rigid", figure)
    figure.savefig(target, dpi=150)
    return "from verification.joints"


def devices(_: Work, target: Path) -> str:
    """Loops of devices that stop a block, as `fecolumn verify -k devices` draws them."""
    from matplotlib.figure import Figure

    from fecolumn.pictures.figures.style import styled
    from fecolumn.verification.devices import run as holds

    rows = holds("rigid")
    with styled():
        figure = Figure(figsize=rows.size, layout="constrained")
        rows.draw(figure)
        figure.savefig(target, dpi=133)
    return "from verification.devices"


def collapse(_: Work, target: Path) -> str:
    """How the multi-drum column falls, drums computed by the rigid engine."""
    from benchmarks.gallery.collapse import collapse as draw

    return draw(target)


def arch(work: Work, target: Path) -> str:
    """An arch at rest with its thrust line, and how it falls under a push that slowly rises."""
    from benchmarks.gallery.arch import arch as draw

    return draw(work.folder / "arch", ROOT / "meshes" / "arch.toml", target)


def colonnade(work: Work, target: Path) -> str:
    """A colonnade that collapses: contact found wherever stones come to meet."""
    from benchmarks.gallery.colonnade import colonnade as film

    file = ROOT / "meshes" / "colonnade_that_collapses.toml"
    return film(work.folder / "colonnade", file, target)


def steps(_: Work, target: Path) -> str:
    """Distributions at three time steps, fixed and with rolling substeps, from the rows of the
    paper's study that come with the repository.
    """
    from benchmarks.tables.runs import read_runs
    from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
    from fecolumn.statistics.ecdf import ecdf

    panels = []
    for study, title in (
        ("paper_study", "fixed steps"),
        ("paper_parts", "substeps while the foot rolls fast (default)"),
    ):
        lines = []
        for dt in ("0.02", "0.001", "0.0001"):
            runs = read_runs(f"paper/{study}-{dt}--0.2").values()
            peaks, lost = ([run[key] for run in runs] for key in ("u_max_m", "overturned"))
            lines.append((f"dt = {dt} s, n = {len(peaks)}", ecdf(peaks, lost)))
        panels.append(CdfPanel(title, tuple(lines)))
    cdf_figure(panels, target.with_suffix(""), formats=("png",))
    return "rows of benchmarks/tables/paper"


def models(work: Work, target: Path) -> str:
    """Distributions of the models beside full order on the specimen's own mesh, from the rows that
    come with the repository.
    """
    from benchmarks.models import main

    folder = work.folder / "models"
    main(["--own-mesh", "--full", "--report", "-o", str(folder)])
    shutil.copy(folder / "own_mesh" / "models.png", target)
    return "rows of benchmarks/tables/models"


def fragility(work: Work, target: Path) -> str:
    """Fragilities of drums, monolith, trilith and frame, from the rows that come with the
    repository.
    """
    from benchmarks.fragility.__main__ import main

    main(["--report", "-o", str(work.folder / "fragility")])
    shutil.copy(work.folder / "fragility" / "fragility.png", target)
    return "rows of benchmarks/tables/fragility"


def reliability(_: Work, target: Path) -> str:
    """How often the granite rock overturned, by the probability told, from a table."""
    from benchmarks.shake_table.figure import draw_reliability
    from benchmarks.shake_table.kept import kept_classes

    draw_reliability(kept_classes(), target.with_suffix(""))
    return "benchmarks/tables/shake_table_reliability.csv"


#: Figures by name: place in the repository and the function that makes them, of (Work, target),
#: which says from what.
FIGURES = {
    "rocking": ("meshes/rocking.png", rocking),
    "cdf": ("benchmarks/cdf.png", cdf),
    "impact": ("fecolumn/case/manual/impact.png", impact),
    "rolling": ("fecolumn/case/manual/rolling.png", rim),
    "two-sides": ("fecolumn/case/manual/two-sides.png", two_sides),
    "devices": ("fecolumn/case/manual/devices.png", devices),
    "collapse": ("fecolumn/case/manual/collapse.png", collapse),
    "arch": ("fecolumn/case/manual/arch.png", arch),
    "colonnade": ("fecolumn/case/manual/colonnade.gif", colonnade),
    "impact-map": ("fecolumn/case/manual/impact-map.png", impact_map),
    "steps": ("benchmarks/steps.png", steps),
    "models": ("benchmarks/models_own_mesh.png", models),
    "fragility": ("benchmarks/fragility.png", fragility),
    "reliability": ("benchmarks/reliability.png", reliability),
}


def make(name: str, work: Work, root: Path = ROOT) -> str:
    """Make a figure anew in its place below `root`, a picture with few colours; where it lies and
    what it is from, in words.
    """
    from PIL import Image

    place, function = FIGURES[name]
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / Path(place).name
        told = function(work, draft)
        (root / place).parent.mkdir(parents=True, exist_ok=True)
        if draft.suffix == ".gif":
            shutil.copy(draft, root / place)
            return f"{place}: {told}"
        with Image.open(draft) as image:
            image.convert("RGB").quantize(_COLOURS).save(root / place, optimize=True)
    return f"{place}: {told}"
