"""The command line: fecolumn new | mesh | run | resume | cost | study | compare | report |
fragility | design | risk | screen | calibrate | render | rocking | motions | keys | help | verify |
prepare | doctor | completion.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import sys
import traceback
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, TextIO, cast

if TYPE_CHECKING:
    from fecolumn.case.case import Case

# What a command says that was stopped: one that keeps nothing on its way, one that does
_AGAIN = "stopped; run the same command again"
_ON = "stopped; what is done is kept, the same command does the rest"
_FROM_CHECKPOINT = "stopped; the same command goes on from the last checkpoint"
# Warnings that this command has told
_WARNED: set[str] = set()


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; returns 0, 1 where an analysis failed, 2 where the input is refused, 130 after
    Ctrl-C or SIGTERM.
    """
    from fecolumn.foundation.interrupt import forget_interrupt, termination_as_interrupt

    arguments = list(sys.argv[1:] if argv is None else argv)
    with termination_as_interrupt():
        try:
            if arguments[:1] == ["doctor"]:  # stands alone: no library may be loaded here
                from fecolumn import doctor

                return doctor.main(arguments[1:])
            return _answer(_parser().parse_args(arguments))
        except KeyboardInterrupt:  # outside of what a command does
            print(f"fecolumn: {_AGAIN}", file=sys.stderr)
            return 130
        finally:
            forget_interrupt()


def _answer(args: argparse.Namespace) -> int:
    """Run the command of `args`, and tell in a line what ends it; the exit code."""
    from fecolumn.foundation.atomic import disk_full
    from fecolumn.foundation.debian import missing_text
    from fecolumn.foundation.deprecated import TOLD
    from fecolumn.foundation.older_option import tell_older_options
    from fecolumn.foundation.schema import InputError

    # a terminal that cannot write a folder's name must not end what is at work there
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(AttributeError):
            cast(io.TextIOWrapper, stream).reconfigure(errors="backslashreplace")
    warnings.showwarning = _show_warning
    _WARNED.clear()
    # Python hides what is told of older names, which is for those who write files
    warnings.filterwarnings("default", f".*{TOLD}", DeprecationWarning)
    tell_older_options(args)
    try:
        code: int = args.command(args)
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader, such as head, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except InputError as error:
        return _refuse(error, 2)
    except KeyboardInterrupt:
        return _refuse(args.stopped, 130)
    except Exception as error:
        code = 1
        if _is_failure(error):  # on every rank alike
            return _refuse(error, code)
        if isinstance(error, ModuleNotFoundError) and (told := missing_text(error)):
            return _refuse(told, code)
        if disk_full(error):
            print(
                "fecolumn: the disk is full; free room and run the same command again",
                file=sys.stderr,
            )
        elif (
            isinstance(error, OSError) and error.filename is not None and error.strerror
        ):  # of a file or folder the user named
            code = 2
            print(
                f"fecolumn: {error.filename}: cannot be read or written ({error.strerror})",
                file=sys.stderr,
            )
        else:
            traceback.print_exc()
        _abandon_other_ranks(code)
        return code


def _is_failure(error: Exception) -> bool:
    """Whether an analysis could not go on, which is no fault of the program."""
    engines = sys.modules.get("fecolumn.engines.analysis")  # loaded where it is raised
    return engines is not None and isinstance(error, engines.AnalysisFailed)


def _abandon_other_ranks(code: int) -> None:
    """End the other ranks of this command too: they would wait for this one for ever."""
    from fecolumn.foundation.debian import rank_and_size

    if rank_and_size()[1] > 1:
        from mpi4py import MPI

        sys.stderr.flush()
        MPI.COMM_WORLD.Abort(code)


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """One line, from one rank; what was told once is not told again."""
    if str(message) not in _WARNED:
        _WARNED.add(str(message))
        _refuse(f"warning: {message}", 0)


def _refuse(message: object, code: int) -> int:
    from fecolumn.foundation.debian import rank_and_size

    if rank_and_size()[0] == 0:
        print(f"fecolumn: {message}", file=sys.stderr)
    return code


class _Parser(argparse.ArgumentParser):
    """A parser of whole names of options: beside an abbreviation another option might come to be
    called alike.

    Attributes
    ----------
    in_any_order
        whether options may stand between words of which one may be left out.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options | {"allow_abbrev": False})
        self.in_any_order = False

    def parse_known_args(  # type: ignore[override]  # of two overloads
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """As argparse does, options first where they may stand in any order."""
        if not self.in_any_order:
            return super().parse_known_args(args, namespace)
        self.in_any_order = False  # as argparse asks for this function again
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self.in_any_order = True


def _describe(parser: argparse.ArgumentParser) -> None:
    """Give each command and action what is told of it in the list of all as its description."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            words = {one.dest: one.help or "" for one in action._choices_actions}
            for name, below in action.choices.items():
                if below.description is None:
                    below.description = f"{words[name][:1].upper()}{words[name][1:]}."
                _describe(below)


def _parser() -> argparse.ArgumentParser:
    """Of all commands; nothing here may load a library, so that --help is quick."""
    from fecolumn.case import completion, manual, show, templates
    from fecolumn.foundation.version import __version__
    from fecolumn.pictures import mesh_command as mesh
    from fecolumn.pictures.render import command as render
    from fecolumn.study import command as study
    from fecolumn.study import compare_command as compare
    from fecolumn.study import cost_command as cost
    from fecolumn.study import key_tables as keys
    from fecolumn.study import motions_command as motions
    from fecolumn.study import rocking_command as rocking
    from fecolumn.study.questions import calibrate_command as calibrate
    from fecolumn.study.questions import design_command as design
    from fecolumn.study.questions import risk_command as risk
    from fecolumn.study.questions import screen_command as screen
    from fecolumn.study.report import command as report
    from fecolumn.study.report import fragility_command as fragility
    from fecolumn.verification import command as verify

    parser = _Parser(
        prog="fecolumn",
        description="Rocking and sliding of free-standing structures: finite-element contact "
        "dynamics, judged by statistics.",
        epilog="First steps: fecolumn new DIR, or fecolumn help quick-start. Every option of "
        "a command: fecolumn COMMAND --help.",
    )
    parser.add_argument("--version", action="version", version=f"fecolumn {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(
        name: str,
        words: str,
        module: ModuleType | None = None,
        main: Callable[[argparse.Namespace], int] | None = None,
        stopped: str = _AGAIN,
    ) -> _Parser:
        command = commands.add_parser(name, help=words)
        if module:
            module.add_arguments(command)
        command.set_defaults(stopped=stopped)
        if main := main or getattr(module, "main", None):
            command.set_defaults(command=main)
        return command

    new = add("new", "write a commented case and a study of it to start from", templates)
    add("mesh", "build and check the meshes of a case", mesh)
    run = add("run", "run one analysis, or continue it", main=_run, stopped=_FROM_CHECKPOINT)
    run.add_argument("case", metavar="CASE.toml", help="case file to analyse")
    run.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="DIR",
        help="result folder; each case needs its own",
    )
    resume = add(
        "resume",
        "continue an analysis from its last checkpoint",
        main=_resume,
        stopped=_FROM_CHECKPOINT,
    )
    resume.add_argument("output", metavar="DIR", help="result folder of fecolumn run")
    for one in (run, resume):
        one.add_argument("-q", "--quiet", action="store_true", help="no progress line")
        one.add_argument(
            "--profile",
            action="store_true",
            help="time each step; prints a table and draws a histogram of where the time goes",
        )
    add(
        "cost",
        "measure how long an analysis takes, and how much faster it is with other keys",
        cost,
    )
    add("study", "run a sweep of analyses and compare their CDFs", study, stopped=_ON)
    add(
        "compare",
        "compare two analyses, or two ensembles: settings, studies, or computation and experiment",
        compare,
    )
    add("report", "write the report of a study: one HTML page, figures and tables", report)
    add(
        "fragility",
        "fit the probability of overturning over one or two intensity measures, from a study or "
        "your own table",
        fragility,
    )
    add(
        "design",
        "find the least or largest value of a key for which a limit state holds",
        design,
        stopped=_ON,
    )
    add(
        "risk",
        "compute how often a limit state is reached, from a fragility and the hazard "
        "curve of a site",
        risk,
    )
    add(
        "screen", "rank a list of objects by how likely they overturn or slide", screen, stopped=_ON
    )
    add("calibrate", "fit keys of a case to a measured free-rocking test", calibrate, stopped=_ON)
    add(
        "render",
        "draw an analysis: movie, stills, sequence figure, HTML page, script for ParaView",
        render,
    )
    model = add(
        "rocking",
        "run a rocking model of rigid bodies in a motion or an ensemble; compute overturning "
        "spectra",
        rocking,
    )
    new.in_any_order = model.in_any_order = True
    add("motions", "make, fit, look at and convert ground motions", motions)
    add("show", "print the full form of a case: bodies, grounds, joints", show)
    add("keys", "print every key of a case and of a study: meaning, unit, range, default", keys)
    add("help", "print the manual, topic by topic", manual)
    add("verify", "check the engines against exact solutions", verify)
    add(
        "prepare",
        "compile all that has to be compiled once on each machine; the set-up calls it",
        main=_prepare,
    )
    add("doctor", "print versions and known problems of this machine")
    add(
        "completion",
        "print the script by which the Tab key completes commands and options",
        completion,
        _completion,
    )
    _describe(parser)
    return parser


def _completion(args: argparse.Namespace) -> int:
    from fecolumn.case import completion

    print(completion.script(_parser(), args.shell))
    return 0


def _prepare(args: argparse.Namespace) -> int:
    from fecolumn.prepare import prepare

    prepare(print)
    return 0


def _run(args: argparse.Namespace) -> int:
    from fecolumn.case.case import load_case

    return _analyse(load_case(args.case), args.output, args.case, args.quiet, args.profile)


def _resume(args: argparse.Namespace) -> int:
    from fecolumn.simulation import read_folder_case

    case, file = read_folder_case(args.output)
    return _analyse(case, args.output, file, args.quiet, args.profile)


def _analyse(case: Case, folder: str, file: str, quiet: bool, profile: bool = False) -> int:
    from mpi4py import MPI

    from fecolumn.engines.ending import ending_text, peak_text
    from fecolumn.foundation.interrupt import held_interrupts
    from fecolumn.pictures.figures.history_figures import has_figures, history_figures
    from fecolumn.simulation import run

    with held_interrupts() as stop:
        summary = run(case, folder, file=file, quiet=quiet, profile=profile, stop=stop)
    if MPI.COMM_WORLD.rank == 0:
        if not has_figures(folder):
            history_figures(folder)
        share = summary.get("rigid_loss_share")
        struck = "" if share is None else f"impacts took {share:.3g} of the rigid loss, "
        print(
            f"{folder}: {peak_text(summary)}, {ending_text(summary)}; "
            f"{struck}{summary['steps']} steps, "
            f"{1e3 * summary['s_per_step']:.2g} ms/step, energy closure "
            f"{summary['energy_closure_rel']:.1e}"
        )
        if doubt := summary.get("step_doubt"):
            print(doubt)
        if profile:
            _tell_step_times(Path(folder))
    return 0


def _tell_step_times(folder: Path) -> None:
    """Print what the time of the steps went to, and draw it."""
    from fecolumn.engines.step_times import STEP_TIMES_FILE, read_step_times, step_table
    from fecolumn.pictures.figures.step_times_figure import step_times_figure

    if not (folder / STEP_TIMES_FILE).exists():
        _refuse(f"{folder} was analysed without --profile: a new folder is timed", 0)
        return
    rows = read_step_times(folder / STEP_TIMES_FILE)
    print(f"\n{step_table(rows)}\n")
    print("drawn:", ", ".join(map(str, step_times_figure(rows, folder / "step_times"))))


if __name__ == "__main__":
    sys.exit(main())
