"""`fecolumn screen`: a list of objects to one table of probabilities, the most endangered first."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import Any

from fecolumn.foundation.cores import usable_cores
from fecolumn.foundation.interrupt import termination_as_interrupt
from fecolumn.foundation.older_option import OlderOption
from fecolumn.study.questions.design_command import (
    add_motions_and_jobs,
    check_jobs,
    tell_failed,
)

_COMMAND = "fecolumn screen"
_EVENTS = {"rigid": ("overturn", "slide > 10 mm"), "housner": ("overturn", "top > 10 mm")}
_SHOWN = 40  # objects of the figure


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn screen`."""
    parser.add_argument(
        "list",
        metavar="LIST.csv",
        help="table of objects with columns name,width_m,depth_m,height_m,mass_kg,friction; or "
        "width_cm, mass_g ...",
    )
    add_motions_and_jobs(parser)
    parser.add_argument(
        "--event",
        action="append",
        metavar="EVENT",
        help="limit state: overturn, lost, top > 50 mm, slide > 5 mm ...; may be repeated, "
        "objects are ranked by the first (default: overturn and slide > 10 mm, with "
        "--engine housner overturn and top > 10 mm)",
    )
    parser.add_argument("--limit", dest="event", action=OlderOption, newer="--event", several=True)
    parser.add_argument(
        "--scale",
        metavar="F",
        type=float,
        default=1.0,
        help="factor on the acceleration of the motions (default: 1)",
    )
    parser.add_argument(
        "--time-scale",
        metavar="F",
        type=float,
        default=1.0,
        help="factor on their time (default: 1; 2 brings lick: motions to full scale)",
    )
    parser.add_argument(
        "--engine",
        choices=["rigid", "housner"],
        default="rigid",
        help="rigid: blocks that rock, slide and turn; housner: blocks that only rock, forty "
        "times faster (default: rigid)",
    )


@termination_as_interrupt()
def main(args: argparse.Namespace) -> int:
    """Run what is missing and rank; 0 when all is done, 1 when analyses failed or the disk is full,
    130 after Ctrl-C.

    Raises
    ------
    InputError
        list, motions, events or folder cannot be used.
    """
    from fecolumn.foundation.schema import InputError
    from fecolumn.study.plan import plan_of
    from fecolumn.study.questions.given import motion_sources
    from fecolumn.study.questions.limit import read_event
    from fecolumn.study.questions.objects import read_objects, tables_of_objects
    from fecolumn.study.run import StudyError, check_motions, complete_study, stop_code

    check_jobs(args.jobs, _COMMAND)
    if not 0 < abs(args.scale) <= 1000:
        raise InputError(_COMMAND, "--scale", args.scale, "must lie in [-1000, 1000], not be 0")
    if not 1e-3 <= args.time_scale <= 1e3:
        raise InputError(_COMMAND, "--time-scale", args.time_scale, "must lie in [0.001, 1000]")
    limits = [
        read_event(text, _COMMAND, args.engine) for text in args.event or _EVENTS[args.engine]
    ]
    objects = read_objects(args.list)
    sources = motion_sources(args.motions, _COMMAND)
    motion = {"scale": args.scale, "time_scale": args.time_scale}
    plan = plan_of(tables_of_objects(objects, sources, args.engine, motion), Path(args.list))
    check_motions(plan)
    jobs = args.jobs or usable_cores()
    try:
        rows = complete_study(
            plan,
            args.output,
            workers=jobs,
            retry_failed=args.retry_failed,
            stream=None if args.quiet else sys.stderr,
        )
    except (KeyboardInterrupt, StudyError) as error:
        return stop_code(error)
    return _tell(objects, plan, rows, limits, Path(args.output))


def _tell(objects: Any, plan: Any, rows: Any, limits: Any, folder: Path) -> int:
    """Table, figure, page and sentence; 1 where analyses failed."""
    from fecolumn.foundation.atomic import write_bytes, write_csv
    from fecolumn.study.questions.screening import answer_of, screened, screening_table
    from fecolumn.study.report.html import page_html
    from fecolumn.study.setting_rows import failed_of

    ranked = screened(objects, plan, rows, limits)
    failed = failed_of(rows)
    if not any(one.n for one in ranked):
        print(f"none of {len(rows)} analyses is done; see {folder / 'logs'}", file=sys.stderr)
        return tell_failed(failed) or 1
    write_csv(folder / "screen.csv", screening_table(ranked, limits))
    answer = answer_of(ranked, limits, rows)
    byline = f"{len(ranked)} objects, {max(one.count(0).runs for one in ranked)} motions"
    sections = _sections(ranked, limits, folder)
    write_bytes(
        folder / "screen.html", page_html("Screening of objects", byline, answer, sections).encode()
    )
    print(f"{'rank':>4}  {'name':<28}" + "".join(f"{limit.text:>28}" for limit in limits))
    for rank, one in enumerate(ranked, 1):
        cells = "".join(f"{_percent(*one.share(place)):>28}" for place in range(len(limits)))
        print(f"{rank:>4}  {one.object.name[:27]:<28}{cells}")
    print(answer)
    slides = sum(bool(row["summary"] and row["summary"].get("notes")) for row in rows)
    if slides:
        print(
            f"fecolumn: warning: in {slides} of {len(rows)} runs rocking demands more friction "
            "than the object has: it would slide, which --engine rigid follows",
            file=sys.stderr,
        )
    print(f"wrote {folder / 'screen.html'}\nwrote {folder / 'screen.csv'}")
    return tell_failed(failed)


def _percent(p: float, low: float, high: float) -> str:
    share = "-" if math.isnan(p) else f"{100 * p:.1f} %"
    return f"{share} [{100 * low:.1f}, {100 * high:.1f}]"


def _short(p: float, low: float, high: float) -> str:
    """The same for a column of a page: two digits."""
    digits = [f"{100 * x:.0f}" if x >= 0.095 else f"{100 * x:.2g}" for x in (p, low, high)]
    share = "-" if math.isnan(p) else f"{digits[0]} %"
    return f"{share} [{digits[1]}, {digits[2]}]"


def _sections(ranked: Any, limits: Any, folder: Path) -> list[Any]:
    """Of the page: its table and its figure, whose files go beside it."""
    from fecolumn.pictures.figures.interval_figure import IntervalRow, Scale, interval_figure
    from fecolumn.study.report.document import PageColumn, PageSection, PageTable, Paragraph
    from fecolumn.study.report.gallery import Gallery

    for part in ("figures", "tables"):
        (folder / part).mkdir(exist_ok=True)
    failed_column = [PageColumn("failed", "failed")] if any(one.failed for one in ranked) else []
    table = PageTable(
        "screen",
        (
            PageColumn("rank", "rank"),
            PageColumn("name", "object", text=True),
            PageColumn("size", "width × depth × height [m]"),
            PageColumn("mass_kg", "mass [kg]", lambda value: f"{value:g}"),
            PageColumn("friction", "friction", lambda value: f"{value:g}"),
            *(
                PageColumn(f"p{place} low{place} high{place}", f"P({limit.text})", _short)
                for place, limit in enumerate(limits, 1)
            ),
            PageColumn("u_max_50_m", "u₅₀ [mm]", _millimetres),
            *failed_column,
        ),
        [
            (
                rank,
                one.object.name,
                " × ".join(f"{side:g}" for side in one.object.values[:3]),
                one.object.mass,
                one.object.friction,
                *(cell for place in range(len(limits)) for cell in one.share(place)),
                one.median_m,
                *([one.failed] if failed_column else []),
            )
            for rank, one in enumerate(ranked, 1)
        ],
        "All objects, the most endangered first; in brackets the 95 % interval (Wilson); u₅₀ the "
        "median of the largest displacement of the top."
        + (" Intervals hold whatever failed analyses would have been." if failed_column else ""),
    )
    table.write_csv(folder / "tables")
    columns = [
        (
            Scale(f"$P$({limit.text})", (-0.02, 1.02)),
            [IntervalRow(one.object.name, *one.share(place)) for one in ranked[:_SHOWN]],
        )
        for place, limit in enumerate(limits[:3])
    ]
    figure = Gallery(folder / "figures", False).draw(
        "ranking",
        f"The first {min(len(ranked), _SHOWN)} objects with the 95 % intervals of their "
        "probabilities.",
        interval_figure,
        columns,
    )
    text = (
        "Each object is a rigid block with its own weight and friction. Intervals are of the "
        "motions alone: sizes and friction are taken as they are listed. Objects whose intervals "
        "overlap are not told apart."
    )
    return [PageSection("Ranking", [Paragraph(text), table, figure])]


def _millimetres(metres: float) -> str:
    if math.isnan(metres):
        return "-"
    return "lost" if math.isinf(metres) else f"{1e3 * metres:.3g}"
