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
import numpy as np
import pytest
from documents import PAGES, ROOT, listed

from fecolumn.cli import main

sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("study", "report", "structures")]

from rocking_block import ENTRY  # noqa: E402
from small_structures import block, structure  # noqa: E402
from study_files import write_study  # noqa: E402
from synthetic_study import write_synthetic  # noqa: E402
from test_podium_section import study as study_of_laws  # noqa: E402

from fecolumn.simulation import chosen_step, run  # noqa: E402
from fecolumn.study.plan import read_plan  # noqa: E402
from fecolumn.study.report.page import write_report  # noqa: E402
from fecolumn.study.run import complete_study  # noqa: E402
from fecolumn.study.table import write_tables  # noqa: E402

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


def header(file) -> list[str]:
    with open(file, newline="") as rows:
        return next(csv.reader(rows))


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
            foot=dict(slave="lower", on="ground") | wax, joint=dict(slave="upper", on="lower")
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


def files(folder) -> set[str]:
    """Names of the files that a command has written, but for those of its runs and hidden ones."""
    names = (path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    return {name for name in names if not re.match(r"\.|analyses/|runs/|logs/", name)}


def told_files(heading: str) -> set[str]:
    """Names of files that the part of the page below a heading tells."""
    part = PAGES["outputs"].read_text().partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    headings = re.findall(r"^### (\S+\.\w+)$", part, re.MULTILINE)
    return {*re.findall(r"`([\w./]+\.\w+)`", part.partition("\n### ")[0]), *headings}


def of_measures(columns, *measures) -> list[str]:
    """Columns with IM in the place of an intensity measure, each once."""
    pattern = "|".join(measures)
    return list(
        dict.fromkeys(re.sub(rf"(?<=_)({pattern})|^({pattern})", "IM", one) for one in columns)
    )


@pytest.fixture(scope="module")
def pulses(tmp_path_factory):
    """A folder with eight pulses, a slender block and 60 runs of a made fragility."""
    folder = tmp_path_factory.mktemp("commands")
    amplitudes = [f"{one}" for one in range(1, 9)]
    words = ["symmetric_ricker", "--amplitudes", *amplitudes, "--periods", "2", "--dt", "0.01"]
    assert main(["motions", "make", "pulses", *words, "-o", str(folder / "p.h5")]) == 0
    (folder / "block.toml").write_text("block.width_m = 0.3\nblock.height_m = 2.0\n")
    source = f'motion.source = "{folder / "p.h5"}#'
    for name, which in (("one", "3"), ("many", "*")):
        text = (folder / "block.toml").read_text() + source + which + '"\n'
        (folder / f"{name}.toml").write_text(text)
    made = np.random.default_rng(4)
    pga, pgv = np.exp(made.normal(1.0, 0.6, 60)), np.exp(made.normal(0.0, 0.6, 60))
    fell = pga * pgv**0.5 * np.exp(made.normal(0, 0.4, 60)) > 3
    rows = "".join(f"{a:.6g},{v:.6g},{int(over)}\n" for a, v, over in zip(pga, pgv, fell))
    (folder / "runs.csv").write_text("pga_m_s2,pgv_m_s,overturned\n" + rows)
    return folder


def asked(*words) -> Path:
    """Folder that a command has written."""
    folder = Path(words[-1])
    assert main([str(word) for word in (*words[:-1], "-o", words[-1])]) == 0
    return folder


def test_every_file_and_column_of_rocking_models(pulses):
    one = asked("rocking", "housner", pulses / "one.toml", pulses / "one")
    many = asked("rocking", "housner", pulses / "many.toml", pulses / "many")
    assert files(one) | files(many) <= told_files("Folder of `fecolumn rocking`")
    assert header(one / "parameters.csv") == list(listed("outputs", "parameters.csv"))
    peaks, columns = listed("outputs", "peaks of summary.json"), header(many / "responses.csv")
    assert [name for name in columns if name not in peaks] == list(
        listed("outputs", "responses.csv")
    )
    assert columns[-2] in peaks
    own = listed("outputs", "history.h5 of a rocking model")
    coordinates = {f"{name.removeprefix('model/')} [{unit}]" for name, unit in own.items()}
    left = [name for name in header(one / "history.csv") if name not in coordinates]
    assert left == [name for name in listed("outputs", "history.csv") if name != "damping [J]"]


def test_every_coordinate_and_peak_of_all_rocking_models(pulses):
    """In the history and in the summary, each with its unit."""
    tables = dict(
        housner="block = {width_m = 0.3, depth_m = 0.4, height_m = 2.0, tendon_n_m = 10}",
        wobbling="column = {shape = 'solid', outer_diameter_m = 0.4, height_m = 2.0}",
        podium="podium = {column_mass_kg = 2500, floor_mass_kg = 1e5, slenderness_rad = 0.15, "
        "half_diagonal_m = 1.5}",
    )
    units, peaks = {}, set()
    for engine, table in tables.items():
        text = (
            f"{table}\ninitial = {{tilt_rad = 0.01, direction_deg = 30}}\n"
            f"integration = {{engine = '{engine}', dt_s = 0.005, duration_s = 0.5}}\n"
        )
        (pulses / f"{engine}.toml").write_text(text)
        folder = asked("run", pulses / f"{engine}.toml", "-q", pulses / engine)
        with h5py.File(folder / "history.h5") as file:
            own = file["model"]
            units |= {f"model/{name}": own[name].attrs["unit"] for name in own}
        found = json.loads((folder / "summary.json").read_text())["peaks"]
        peaks |= {re.sub(r"storey_\d", "storey_N", name) for name in found}
    assert listed("outputs", "history.h5 of a rocking model") == units
    assert set(listed("outputs", "peaks of summary.json")) == peaks


def test_every_file_and_column_of_overturning_pulses(tmp_path, monkeypatch, pulses):
    from fecolumn.engines.rocking import spectra_table

    monkeypatch.setattr(spectra_table, "PULSE_SHAPES", ("one_sine",))
    monkeypatch.setattr(spectra_table, "FREQUENCIES", (2.0, 4.0))
    whole = spectra_table.spectra_table
    monkeypatch.setattr(
        spectra_table,
        "spectra_table",
        lambda alpha, restitution, show: whole(alpha, restitution, ("one_sine",), (2.0, 4.0)),
    )
    out = asked("rocking", "spectrum", pulses / "many.toml", tmp_path / "out")
    assert files(out) <= told_files("Folder of `fecolumn rocking`")
    assert header(out / "overturning.csv") == list(listed("outputs", "overturning.csv"))


def test_every_file_and_column_of_fragilities_and_risks(pulses):
    runs = pulses / "runs.csv"
    one = asked("fragility", runs, "--im", "pga_m_s2", pulses / "one-measure")
    two = asked("fragility", runs, pulses / "two-measures")
    assert files(one) | files(two) <= told_files("Folder of `fecolumn fragility`")
    measures = ("pga_m_s2", "pgv_m_s")
    told = list(listed("outputs", "fragility.csv"))
    assert of_measures(header(one / "fragility.csv"), *measures) == told
    assert of_measures(header(two / "fragility.csv"), *measures) == told[:4] + list(
        listed("outputs", "fragility.csv over two measures")
    )
    (pulses / "hazard.csv").write_text(
        "pga_g,annual_frequency\n0.01,0.2\n0.05,0.02\n0.4,0.00025\n3.2,1e-7\n"
    )
    risk = asked("risk", runs, "--hazard", pulses / "hazard.csv", pulses / "risk")
    assert files(risk) <= told_files("Folder of `fecolumn risk`")
    for name in ("risk.csv", "deaggregation.csv"):
        assert of_measures(header(risk / name), *measures) == list(listed("outputs", name)), name


def test_every_file_and_column_of_a_design(pulses):
    words = ["--vary", "block.width_m", "0.2:0.6", "--limit", "P(overturn) < 0.5", "--steps", "2"]
    motions = ["--motions", f"{pulses / 'p.h5'}#*", "-j", "1"]
    out = asked("design", pulses / "block.toml", *words, *motions, pulses / "design")
    assert files(out) <= told_files("Folder of `fecolumn design`")
    assert header(out / "design.csv") == list(listed("outputs", "design.csv"))
    assert list(json.loads((out / "design.json").read_text())) == list(
        listed("outputs", "design.json")
    )


def test_every_file_and_column_of_a_screening(pulses):
    (pulses / "list.csv").write_text(
        "name,width_m,depth_m,height_m,mass_kg,friction\na,0.3,0.3,2,30,0.9\n"
    )
    words = ["--engine", "housner", "-j", "1", "--motions", f"{pulses / 'p.h5'}#*"]
    out = asked("screen", pulses / "list.csv", *words, pulses / "screen")
    assert files(out) <= told_files("Folder of `fecolumn screen`")
    assert header(out / "screen.csv") == list(listed("outputs", "screen.csv"))
    columns = [
        re.sub(r"^(p|low|high)\d$", r"\1K", name) for name in header(out / "tables/screen.csv")
    ]
    assert list(dict.fromkeys(columns)) == list(listed("outputs", "tables/screen.csv"))


def test_every_file_and_column_of_a_calibration(pulses):
    (pulses / "test.csv").write_text(
        "time_s,tilt_rad\n"
        + "".join(f"{t},{0.05 - 0.05 * t * t}\n" for t in np.arange(0, 0.5, 0.02))
    )
    (pulses / "leaning.toml").write_text(
        "block.width_m = 0.3\nblock.height_m = 2.0\ninitial.tilt_rad = 0.05\n"
        "integration.dt_s = 0.01\n"
    )
    words = ["--test", pulses / "test.csv", "--fit", "block.restitution", "0.8:1"]
    out = asked("calibrate", pulses / "leaning.toml", *words, pulses / "calibrate")
    assert files(out) <= told_files("Folder of `fecolumn calibrate`")
    for name in ("calibrate.csv", "profile.csv"):
        assert header(out / name) == list(listed("outputs", name)), name


def test_every_file_and_column_of_motions(pulses):
    told = told_files("Files of `fecolumn motions`")
    motion = f"{pulses / 'p.h5'}#3"
    assert files(asked("motions", "plot", pulses / "p.h5", pulses / "plot")) <= told
    texts = asked("motions", "convert", motion, pulses / "texts")
    peers = asked("motions", "convert", motion, "--format", "at2", pulses / "peers")
    found = asked("motions", "correct", motion, "--high-pass", "0", pulses / "correct")
    named = {
        re.sub(r"^\d{4}_.*?(_[xyz])?\.(csv|AT2)$", r"NUMBER_NAME\1.\2", name)
        for folder in (texts, peers, found)
        for name in files(folder)
    }
    assert named <= told
    (text,) = texts.glob("*.csv")
    assert text.read_text().splitlines()[1].split(",") == list(listed("outputs", "NUMBER_NAME.csv"))
    (pulses / "target.csv").write_text("period_s,sa_g\n0.5,0.5\n1,0.4\n2,0.2\n")
    words = [f"{pulses / 'p.h5'}#*", "--to-spectrum", pulses / "target.csv"]
    scaled = asked("motions", "scale", *words, pulses / "scaled.h5")
    assert {path.suffix for path in pulses.glob("scaled.*")} == {".h5", ".csv", ".png", ".pdf"}
    own = set(header(scaled.with_suffix(".csv"))) - set(listed("outputs", "ENSEMBLE.csv"))
    part = PAGES["outputs"].read_text().partition("### ENSEMBLE.csv")[2]
    assert own == set(re.findall(r"`(parameter_[a-z]\w+)`", part))


def test_every_column_of_a_reports_tables(tmp_path):
    axes = {"integration.dt_s": [0.02, 1e-3], "integration.alpha_hht": [0, -0.2]}
    sources = [f"lick:{number}" for number in range(1, 13)]
    check_tables(write_synthetic(tmp_path, axes, 12, fails=(3,), sources=sources), axes)


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
