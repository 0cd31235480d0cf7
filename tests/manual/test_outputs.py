"""The manual lists what is really written: datasets, entries and columns, with their units, all of
them and no others.
"""

import csv
import io
import json
import re
import sys
from pathlib import Path

import h5py
import pytest
from documents import PAGES, ROOT, header, listed

from fecolumn.cli import main

sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("study", "report", "structures")]

from rocking_block import ENTRY  # noqa: E402
from small_structures import block, structure  # noqa: E402
from study_files import write_study  # noqa: E402
from synthetic_study import write_synthetic  # noqa: E402
from test_podium_section import study as study_of_laws  # noqa: E402

from fecolumn.engines.dynamics.record import Record  # noqa: E402
from fecolumn.engines.step_times import STEP_TIMES_FILE, StepTimes  # noqa: E402
from fecolumn.pictures.figures.structure_figures import figure_names  # noqa: E402
from fecolumn.simulation import chosen_step, run  # noqa: E402
from fecolumn.study.device_peaks import BOND_COLUMNS, LINK_COLUMNS  # noqa: E402
from fecolumn.study.plan import read_plan  # noqa: E402
from fecolumn.study.report.page import write_report  # noqa: E402
from fecolumn.study.run import complete_study  # noqa: E402
from fecolumn.study.table import write_tables  # noqa: E402
from fecolumn.verification import suite  # noqa: E402
from fecolumn.verification.result import Row  # noqa: E402
from fecolumn.verification.suite import Finding  # noqa: E402

BLOCK = """
[column]
shape = "block"
length_m = 0.4
width_m = 0.4
height_m = 1.2
[mesh]
fine_size_m = 0.1
coarse_size_m = 0.2
base_size_m = 0.2
[initial]
tilt_rad = 0.01
[integration]
engine = "rigid"
duration_s = 0.01
"""


@pytest.fixture(scope="module")
def analysis(tmp_path_factory):
    folder = tmp_path_factory.mktemp("analysis")
    (folder / "case.toml").write_text(BLOCK)
    assert main(["run", str(folder / "case.toml"), "-o", str(folder / "out"), "-q"]) == 0
    return folder / "out"


def test_every_dataset_of_a_history_with_its_unit(analysis):
    """Those of the analysis, and of its bodies and joints."""
    found = {}
    with h5py.File(analysis / "history.h5") as file:
        file.visititems(
            lambda name, item: (
                found.update({name: item.attrs["unit"]}) if isinstance(item, h5py.Dataset) else None
            )
        )
        attributes = set(file.attrs)
    told = PAGES["outputs"].read_text().partition("The file has the attributes ")[2]
    assert attributes == set(re.findall(r"`(\w+)`", told.partition(", as in")[0]))
    of_all = {name: unit for name, unit in found.items() if name.count("/") < 2}
    assert listed("outputs", "history.h5") == of_all
    assert {name.partition("/")[0] for name in found if name not in of_all} == {
        "body",
        "interface",
        "mark",
    }


def test_every_dataset_of_the_states_with_its_unit(analysis):
    with h5py.File(analysis / "states.h5") as file:
        assert listed("outputs", "states.h5") | listed("outputs", "states.h5 of a structure") == {
            name: file[name].attrs["unit"] for name in file
        }


def test_every_dataset_and_entry_of_a_structure_beside_those_of_a_column(tmp_path):
    """Of bodies, joints, marks, storeys, links and glued joints the name is left out."""
    building = dict(
        kind="storeys",
        length_m=0.6,
        width_m=0.6,
        thickness_m=0.1,
        mass_kg=500.0,
        floors=1,
        floor_masses_kg=[100.0],
        storey_heights_m=[1.0],
        period_s=0.2,
        at_m=[0, 0, 0.4],
    )
    block = dict(kind="block", length_m=0.6, width_m=0.6, height_m=0.4, element_size_m=0.3)
    tie = dict(kind="spring", body="lower", to_point_m=[1, 0, 0], stiffness_n_m=1e3)
    wax = dict(bond_tension_pa=1e5, bond_stiffness_n_m3=1e7)
    case = structure(
        bodies=dict(lower=block, upper=building),
        joints=dict(
            foot=dict(between=["lower", "ground"]) | wax, joint=dict(between=["upper", "lower"])
        ),
        links=dict(tie=tie),
        integration=dict(duration_s=0.01),
    )
    summary, found = run(case, tmp_path / "out", quiet=True), {}

    def take(name, item):
        kind, _, rest = name.partition("/")
        if isinstance(item, h5py.Dataset):
            found[
                f"{kind}/NAME/{rest.rpartition('/')[2]}"
                if kind in ("body", "interface", "mark", "storey", "link", "bond")
                else name
            ] = item.attrs["unit"]

    with h5py.File(tmp_path / "out" / "history.h5") as file:
        file.visititems(take)
    assert listed("outputs", "history.h5") | listed("outputs", "history.h5 of a structure") == found
    entries = {
        name: next(iter(parts.values()))
        for name, parts in summary.items()
        if name in ("bodies", "interfaces", "storeys", "links", "bonds")
    }
    assert set(listed("outputs", "summary.json")) | set(entries) == set(summary)
    assert set(listed("outputs", "summary.json of a structure")) == set(entries) | {
        f"{name}.{entry}"
        for name, entry in ((name, entry) for name in entries for entry in entries[name])
    }


@pytest.mark.long
def test_every_entry_of_a_comparison_of_two_analyses(analysis, tmp_path):
    shaken = tmp_path / "shaken"  # a key differs
    (tmp_path / "shaken.toml").write_text(
        BLOCK.replace("0.01\n[integration]", "0.02\n[integration]")
    )
    assert main(["run", str(tmp_path / "shaken.toml"), "-o", str(shaken), "-q"]) == 0
    assert main(["compare", str(analysis), str(shaken), "-o", str(tmp_path / "out")]) == 0
    found = json.loads((tmp_path / "out" / "comparison.json").read_text())
    inner = {
        f"{name}.{entry}"
        for name in ("quantities", "energy_j", "keys")
        for entry in next(iter(found[name].values()))
    }
    assert set(listed("outputs", "comparison.json")) == set(found) | inner
    told, columns = listed("outputs", "histories.csv"), header(tmp_path / "out" / "histories.csv")
    assert list(told) == columns
    assert all(name.endswith(f" [{unit}]") for name, unit in told.items())


def test_every_entry_of_a_summary(analysis):
    of_parts = {"bodies", "interfaces", "links", "storeys"}
    assert set(listed("outputs", "summary.json")) | of_parts == set(
        json.loads((analysis / "summary.json").read_text())
    )


def test_every_entry_of_a_step_that_was_chosen():
    _, chosen = chosen_step(
        structure(**block(), integration={"engine": "rigid", "duration_s": 0.01, "dt_s": "auto"}),
        "case",
        say=lambda words: None,
    )
    assert set(listed("outputs", "dt_chosen of summary.json")) == set(chosen)


def test_every_column_of_a_studys_tables(tmp_path):
    plan = read_plan(write_study(tmp_path, pulses=range(2)))
    write_tables(
        plan,
        complete_study(plan, tmp_path / "out", workers=1, entry=ENTRY, stream=io.StringIO()),
        tmp_path / "out",
    )
    for name in ("table.csv", "analyses.csv", "timing.csv"):
        columns = [column for column in header(tmp_path / "out" / name) if column not in plan.axes]
        assert list(listed("outputs", name)) == columns, name
    identity = json.loads((tmp_path / "out" / "study.json").read_text())
    assert list(listed("outputs", "study.json")) == list(identity)


@pytest.mark.parametrize("name, columns", [("links", LINK_COLUMNS), ("bonds", BOND_COLUMNS)])
def test_every_column_of_the_peaks_of_links_and_bonds(name, columns):
    told = listed("outputs", f"{name}.csv")
    assert tuple(told) == columns
    units = {"n": "N", "m": "m", "pa": "Pa", "j": "J"}
    ends = [column.rpartition("_")[2] if "_" in column else "" for column in columns]
    assert list(told.values()) == [units.get(end, "-") for end in ends]


def test_every_column_of_the_table_of_outcomes():
    """Name and unit as its own data dictionary has them."""
    import fecolumn

    about = fecolumn.outcomes().attrs["columns"]
    told = listed("outputs", "Table of `fecolumn.outcomes()`")
    assert list(told.items()) == [(name, one["unit"]) for name, one in about.items()]


def test_every_column_of_the_times_of_steps(tmp_path):
    StepTimes(Record()).write(tmp_path)
    assert list(listed("outputs", "step_times.csv")) == header(tmp_path / STEP_TIMES_FILE)


def test_every_column_of_the_table_of_verification(tmp_path):
    row = Row("period [s]", 2.0, 2.0, 1e-3)
    (tmp_path / "table.csv").write_text(suite._csv([Finding("patch", "full", (row,), 1.0)]))
    told = listed("outputs", "table.csv of `fecolumn verify`")
    assert list(told) == header(tmp_path / "table.csv")


def test_figures_of_many_interfaces_are_told():
    names = {f"interface/joint {n}: a on ground/tilt" for n in range(30)}
    told = PAGES["outputs"].read_text().partition("### case.json")[0]
    found = figure_names(sorted(names))
    assert found[:3] == ["interfaces", "interfaces_2", "interfaces_3"]
    assert all(f"`{name}`" in told for name in found[:3])


def test_every_quantity_of_a_comparison(tmp_path):
    for name, factor in (("a", 1.0), ("b", 1.1)):
        rows = "".join(
            f"{number},{factor * (5 + number)},{int(number == 7)}\n" for number in range(8)
        )
        (tmp_path / f"{name}.csv").write_text("motion,u_max_mm,overturned\n" + rows)
    assert (
        main(
            [
                "compare",
                str(tmp_path / "a.csv"),
                str(tmp_path / "b.csv"),
                "-o",
                str(tmp_path / "out"),
            ]
        )
        == 0
    )
    with open(tmp_path / "out" / "comparison.csv", newline="") as file:
        assert list(listed("outputs", "comparison.csv")) == [row[0] for row in csv.reader(file)][1:]
    assert list(listed("outputs", "pairs.csv")) == header(tmp_path / "out" / "pairs.csv")


def test_every_column_of_an_ensemble(tmp_path):
    assert main(["motions", "make", "seeded", "-n", "2", "-o", str(tmp_path / "two.h5")]) == 0
    columns = [
        column for column in header(tmp_path / "two.csv") if not column.startswith("parameter_")
    ]
    assert list(listed("outputs", "ENSEMBLE.csv")) == columns


@pytest.mark.long
def test_every_column_of_a_reports_tables(tmp_path):
    axes = {"integration.dt_s": [0.02, 1e-3], "integration.alpha_hht": [0, -0.2]}
    sources = [f"lick:{number}" for number in range(1, 13)]
    check_tables(write_synthetic(tmp_path, axes, 12, fails=(3,), sources=sources), axes)


@pytest.mark.long
def test_every_column_of_tables_of_engines_and_of_a_podiums_laws(tmp_path):
    axes = {"integration.engine": ["housner", "reduced", "full"]}
    check_tables(
        write_synthetic(
            tmp_path / "engines",
            axes,
            40,
            also=lambda values, summary: {"engine": values["integration.engine"]},
            scatter=0.2,
            unfinished=range(80 + 12, 120),
        ),
        axes,
        "engines.csv",
    )
    axes = {"podium.impact": ["CRV", "CAV"]}
    check_tables(study_of_laws(tmp_path / "laws", axes, 6), axes, "laws.csv")


def check_tables(study, axes, needed="audit.csv") -> None:
    """Each column of each table of the study's report is in the manual."""
    page = write_report(study, files=())
    assert (page.parent / "tables" / needed).exists()
    told = dict(
        re.findall(
            r"^\| `(\w+)\.csv` \| (.*) \|$",
            PAGES["outputs"].read_text().partition("### tables")[2],
            re.MULTILINE,
        )
    )
    for table in sorted(Path(page.parent / "tables").glob("*.csv")):
        assert table.stem in told, f"{table.name} is not in the manual"
        for column in set(header(table)) - set(axes) - {"motion.source"}:
            borrowed = table.stem == "p_overturn" and column in listed("outputs", "table.csv")
            assert borrowed or re.search(rf"\b{column}\b", told[table.stem]), (
                f"{table.name}: {column}"
            )
