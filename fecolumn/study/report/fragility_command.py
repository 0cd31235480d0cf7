"""`fecolumn fragility`: probability of overturning over one or two intensity measures, of a study
or of a user's own runs.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fecolumn.statistics.fragility import Fragility, LogitFragility
    from fecolumn.statistics.intensity_table import IntensityTable
    from fecolumn.study.report.failed_fragility import CurveEnds

# What is asked of the summary of a run
Happened = Callable[[dict[str, Any]], bool]
_CURVES = 7  # of the figure


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn fragility`."""
    parser.add_argument(
        "source",
        metavar="DIR|FILE.csv",
        help="folder of a study; or a table with a column overturned and columns of intensity "
        "measures, such as responses.csv of fecolumn rocking",
    )
    parser.add_argument(
        "--im",
        action="append",
        metavar="NAME",
        default=None,
        help="intensity measure, --im twice for two measures: a column of the table; with a "
        "study pgv_m_s (default), pga_m_s2, pgd_m, arias_m_s, ds5_75_s, ds5_95_s, cav_m_s "
        "or housner_m",
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", required=True, help="folder for table and figure"
    )


def main(args: argparse.Namespace) -> int:
    """Fit, print and draw; 0, or 1 where analyses of the study failed.

    Raises
    ------
    InputError
        the source cannot be used, or its runs bound no curve.
    """
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError

    wanted = tuple(args.im or ())
    if len(wanted) > 2 or len(set(wanted)) < len(wanted):
        raise InputError(
            "fecolumn fragility",
            "--im",
            ", ".join(wanted),
            "must be one measure, or two different ones",
        )
    sets = runs_by_setting(args.source, wanted)
    with written(args.output, "fragility", names=("fragility.csv",)) as draft:
        _write(sets, draft, args.source)
    print(f"wrote {args.output}")
    return 1 if any(table.failed for table in sets.values()) else 0


def runs_by_setting(
    source: str, wanted: tuple[str, ...], happened: Happened | None = None
) -> dict[str, IntensityTable]:
    """Runs with their intensities and outcomes, an `IntensityTable` by the name of each setting, of
    a study's folder or a table.

    Parameters
    ----------
    wanted
        names of the intensity measures; none: as `fecolumn fragility` chooses.
    happened
        of a study, what is asked of each summary; overturning unless given.

    Raises
    ------
    InputError
        the source cannot be used.
    """
    from fecolumn.foundation.schema import InputError

    if Path(source).is_dir():
        return _of_study(source, wanted or ("pgv_m_s",), happened)
    if happened is not None:
        raise InputError(
            source, "", None, "is a table, which tells of overturning alone; give a study's folder"
        )
    return _of_file(source, wanted)


def _of_file(source: str, wanted: tuple[str, ...]) -> dict[str, IntensityTable]:
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.intensity_table import read_intensity_table

    table = read_intensity_table(source, wanted)
    if len(table.measures) > 2:
        raise InputError(source, "--im", None, f"choose one or two of {', '.join(table.measures)}")
    return {"": table}


def _of_study(
    folder: str, wanted: tuple[str, ...], happened: Happened | None = None
) -> dict[str, IntensityTable]:
    """Runs of every setting over all scales of its motions, by its name."""
    import numpy as np

    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.intensity import intensity_measures
    from fecolumn.statistics.intensity_table import IntensityTable
    from fecolumn.study.plan import setting_of
    from fecolumn.study.report.failed_fragility import failed_runs
    from fecolumn.study.report.intensity import NOT_FOUND, SCALE, Intensities, across_scales
    from fecolumn.study.report.sweep import read_sweep
    from fecolumn.study.setting_rows import failed_of

    sweep, motions = read_sweep(folder), Intensities(Path(folder))
    known: dict[tuple[float, bytes], dict[str, float]] = {}
    if not sweep.done:
        raise InputError(folder, "", None, f"none of its {sweep.analyses} analyses is done")

    def measures(run: dict[str, Any]) -> dict[str, float]:
        motion = motions.motion(run)
        key = motion.dt, motion.acceleration.tobytes()
        if key not in known:
            known[key] = intensity_measures(motion)
        return known[key]

    lacking: dict[str, list[dict[str, Any]]] = {}
    for row in failed_of(sweep.rows):
        own = {key: value for key, value in setting_of(row["axes"]).items() if key != SCALE}
        lacking.setdefault(repr(own), []).append(row)
    sets: dict[str, IntensityTable] = {}
    runs_of_all, still = 0, 0
    for values, settings in across_scales(sweep.done):
        runs = [run for setting in settings for run in setting.runs.values()]
        try:
            found = [measures(run) for run in runs]
        except NOT_FOUND as error:
            raise InputError(
                folder, "", None, f"a motion of its analyses is not to be found: {error}"
            ) from None
        records = np.array([record for one in settings for record in one.records_of()])
        for name in wanted:
            if name not in found[0]:
                raise InputError(folder, "--im", name, f"must be one of {', '.join(found[0])}")
        asked = happened or (lambda run: bool(run["overturned"]))
        moved = np.array([all(one[name] > 0 for name in wanted) for one in found])
        runs_of_all, still = runs_of_all + moved.size, still + int((~moved).sum())
        if not moved.any():
            continue
        records = records[moved]
        sets[sweep.words(values)] = IntensityTable(
            {name: np.array([one[name] for one in found])[moved] for name in wanted},
            np.array([asked(run) for run in runs])[moved],
            records if len(set(records)) < len(records) else None,
            failed_runs(lacking.get(repr(values), []), records, wanted, measures),
        )
    _tell_without_intensity(folder, " and ".join(wanted), runs_of_all, still)
    return sets


def _tell_without_intensity(folder: str, measures: str, runs: int, still: int) -> None:
    """Warn of the runs whose motions have no intensity.

    Raises
    ------
    InputError
        none of the motions has one.
    """
    from fecolumn.foundation.schema import InputError

    if still == runs:
        raise InputError(
            folder, "", None, f"none of its {runs} motions has {measures} above 0, as at scale 0"
        )
    if still:
        print(
            f"fecolumn: warning: {still} of {runs} analyses are left out: their motions have no "
            f"{measures} above 0, as at scale 0",
            file=sys.stderr,
        )


def _write(sets: dict[str, IntensityTable], folder: Path, source: str) -> None:
    import numpy as np

    from fecolumn.foundation.atomic import write_csv
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.fragility import DegenerateData, logit, lognormal
    from fecolumn.study.report.failed_fragility import curve_ends, warn_of_failed

    names = list(next(iter(sets.values())).measures)
    curves: dict[str, Fragility] = {}
    surfaces: dict[str, LogitFragility] = {}
    limits: dict[str, CurveEnds] = {}
    refused = {}
    for label, table in sets.items():
        im = np.column_stack(list(table.measures.values()))
        try:
            if len(names) == 1:
                fit = lognormal(im[:, 0], table.overturned, table.records)
                limits[label] = curve_ends(table, names[0], fit)
                curves[label] = fit
            else:
                surfaces[label] = logit(im, table.overturned, table.records)
        except DegenerateData as error:
            refused[label] = str(error)
    for label, table in sets.items():
        warn_of_failed(label, table, bounded=label in curves)
    for label, reason in refused.items():
        print(
            f"{label + ': ' if label else ''}no fragility of "
            f"{sets[label].overturned.size} runs: {reason}"
        )
    if not curves and not surfaces:
        raise InputError(
            source,
            "",
            None,
            "its runs bound no fragility: " + "; ".join(dict.fromkeys(refused.values())),
        )
    rows = (
        _one(names[0], sets, curves, limits, folder)
        if curves
        else _two(names, sets, surfaces, folder)
    )
    write_csv(folder / "fragility.csv", rows)
    for line in rows:
        print("  ".join(f"{value:>14}" for value in line))
    for label, fit in curves.items():
        low, high = limits[label][0]
        print(
            f"{label + ': ' if label else ''}half of all motions reach the limit at {names[0]} = "
            f"{fit.median:.3g}, 95 % interval {low:.3g} to {high:.3g}"
        )


def _one(
    name: str,
    sets: dict[str, IntensityTable],
    fits: dict[str, Fragility],
    limits: dict[str, CurveEnds],
    folder: Path,
) -> list[list[Any]]:
    """Table and figure over one measure; limits: of the intervals of each setting."""
    import numpy as np

    from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
    from fecolumn.study.report.observed_shares import observed_shares

    rows: list[list[Any]] = [
        [
            "setting",
            "n",
            "records",
            "overturned",
            f"median_{name}",
            "median_low",
            "median_high",
            "beta",
            "beta_low",
            "beta_high",
        ]
    ]
    curves = []
    for label, fit in fits.items():
        table = sets[label]
        im = table.measures[name]
        of_median, of_beta = limits[label]
        rows.append(
            [
                label or "all",
                fit.n,
                fit.clusters or fit.n,
                fit.overturned,
                *(
                    f"{value:.5g}"
                    for value in (
                        fit.median,
                        *of_median,
                        fit.beta,
                        *of_beta,
                    )
                ),
            ]
        )
        grid = np.linspace(im.min(), im.max(), 200)
        p = fit.probability(grid)
        curves.append(
            Curve(label or "lognormal, maximum likelihood", grid, p.p, (p.lower, p.upper))
        )
        if len(fits) == 1:
            curves.append(observed_shares(im, table.overturned))
    line_figure(
        [
            CurvePanel(
                words(name),
                r"$P$(overturn)",
                curves[:_CURVES],
                {"ylim": (0, 1), "xlim": (0, None)},
                legend="upper left",
            )
        ],
        folder / "fragility",
    )
    if len(fits) > _CURVES:
        print(f"the figure has {_CURVES} of {len(fits)} settings; fragility.csv has all")
    return rows


def _two(
    names: list[str],
    sets: dict[str, IntensityTable],
    fits: dict[str, LogitFragility],
    folder: Path,
) -> list[list[Any]]:
    """Table and a figure for each setting over two measures."""
    import numpy as np
    from scipy.stats import chi2

    from fecolumn.pictures.figures.fragility_figure import contour_figure
    from fecolumn.statistics.fragility import logit

    rows: list[list[Any]] = [
        [
            "setting",
            "n",
            "records",
            "overturned",
            "c0",
            *(f"c_{name}" for name in names),
            *(f"p_{name}" for name in names),
        ]
    ]
    for number, (label, fit) in enumerate(fits.items(), 1):
        table = sets[label]
        im = np.column_stack(list(table.measures.values()))
        # likelihood ratio of each measure beside the other, runs taken as independent
        alone = [logit(im[:, 1 - place], table.overturned).loglik for place in (0, 1)]
        tests = [float(chi2.sf(max(2 * (fit.loglik - one), 0.0), 1)) for one in alone]
        rows.append(
            [
                label or "all",
                fit.n,
                fit.clusters or fit.n,
                fit.overturned,
                *(f"{value:.5g}" for value in (*fit.coefficients, *tests)),
            ]
        )
        contour_figure(
            [words(name) for name in names],
            im,
            table.overturned,
            fit.probability,
            folder / (f"fragility{number}" if len(fits) > 1 else "fragility"),
        )
    return rows


def words(name: str) -> str:
    """A column's name for an axis: pgv_m_s as "PGV [m/s]", others as they are."""
    known = {
        "pgv_m_s": "PGV [m/s]",
        "pga_m_s2": "PGA [m/s$^2$]",
        "pgd_m": "PGD [m]",
        "arias_m_s": "Arias intensity [m/s]",
        "cav_m_s": "CAV [m/s]",
        "housner_m": "Housner intensity [m]",
        "ds5_75_s": "$D_{5-75}$ [s]",
        "ds5_95_s": "$D_{5-95}$ [s]",
    }
    return known.get(name, name.replace("_", " "))
