"""`fecolumn render`: movie, stills, sequence figure, page, and view in ParaView of an analysis."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

VIEW_NAMES = ("lean", "front", "side", "iso", "foot", "plan")


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `fecolumn render`."""
    parser.add_argument(
        "folder", metavar="DIR", help="result folder of fecolumn run; pictures go to DIR/render"
    )
    parser.add_argument(
        "--only",
        choices=("movie", "pictures"),
        help="draw only the movie, or only stills and sequence figure",
    )
    parser.add_argument(
        "--gif",
        action="store_true",
        help="write the movie as GIF instead of MP4: smaller, with fewer pictures per second",
    )
    parser.add_argument(
        "--view",
        choices=VIEW_NAMES,
        help="direction of view (default: lean, with --html iso); lean: across the plane of the "
        "largest lean; front: along y; side: along -x",
    )
    parser.add_argument(
        "--body",
        metavar="NAME",
        default="",
        help="in a structure: body whose top is followed, and whose foot is shown by --view foot "
        "(default: the observed body)",
    )
    parser.add_argument(
        "--instants",
        metavar="T,T,...",
        help="times [s] of stills and sequence, one to ten (default: five, the peaks of the "
        "top's displacement)",
    )
    parser.add_argument(
        "--exaggerate",
        metavar="N",
        default="1",
        help="draw elastic displacements N times as large, or auto; needs states or fields "
        "(default: 1, true scale)",
    )
    parser.add_argument(
        "--colour",
        "--color",
        dest="color",
        choices=("stress", "displacement", "none"),
        default="",
        help="colour by von Mises stress (default where there are states or fields), by "
        "displacement, or not at all: none (default with --forces)",
    )
    parser.add_argument(
        "--forces",
        action="store_true",
        help="draw the forces in the joints over the bodies: resultants as arrows, thrust line "
        "and hinges; the views lean, front and side are then horizontal",
    )
    parser.add_argument(
        "--start",
        metavar="S",
        type=float,
        help="start of the movie or page [s] (default: start of the analysis)",
    )
    parser.add_argument(
        "--end",
        metavar="S",
        type=float,
        help="end of the movie or page [s] (default: end of the analysis)",
    )
    parser.add_argument(
        "--fps",
        metavar="N",
        type=float,
        default=25.0,
        help="pictures per second, 1 to 60 (default: 25)",
    )
    parser.add_argument(
        "--speed",
        metavar="N",
        type=float,
        default=1.0,
        help="seconds of motion per second of the movie, 0.001 to 100; 0.1: ten times slower "
        "(default: 1)",
    )
    parser.add_argument(
        "--size",
        metavar="WxH",
        default="1280x720",
        help="size of the movie [pixels] (default: 1280x720)",
    )
    parser.add_argument(
        "--paraview",
        action="store_true",
        help="write only DIR/render/view.py, a script for ParaView's pvpython and pvbatch",
    )
    parser.add_argument(
        "--html",
        action="store_true",
        help="write only DIR/render/motion.html, a page with the motion in three dimensions and "
        "a time slider, which any browser opens; needs k3d (pip install 'k3d>=2.18,<3')",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress line")


def main(args: Namespace) -> int:
    """Draw; 0 when all is written, 130 after Ctrl-C, which leaves what was there before.

    Raises
    ------
    InputError
        no finished analysis in the folder, or an option that does not fit it.
    """
    from fecolumn.pictures.render.draw import render
    from fecolumn.pictures.render.render_options import RenderOptions

    options = RenderOptions.of(args)
    try:
        files = render(args.folder, options, quiet=args.quiet)
    except KeyboardInterrupt:
        print("fecolumn: stopped; nothing was written", file=sys.stderr)
        return 130
    print("wrote " + ", ".join(str(file) for file in files))
    return 0
