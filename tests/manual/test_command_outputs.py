"""The manual lists the files and columns that commands beside `run` and `study` write."""

import json
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from documents import PAGES, header, listed

from fecolumn.cli import main


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


@pytest.mark.long
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


@pytest.mark.long
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
        direction = 0 if engine == "podium" else 30  # a podium rocks along x
        text = (
            f"{table}\ninitial = {{tilt_rad = 0.01, direction_deg = {direction}}}\n"
            f"integration = {{engine = '{engine}', dt_s = 0.005, duration_s = 0.5}}\n"
        )
        (pulses / f"{engine}.toml").write_text(text)
        folder = asked("run", pulses / f"{engine}.toml", "-q", pulses / engine)
        with h5py.File(folder / "history.h5") as file:
            own = file["model"]
            units |= {f"model/{name}": own[name].attrs["unit"] for name in own}
        told = json.loads((folder / "case.json").read_text())
        # of a step that is stated
        assert set(listed("outputs", "case.json")) - {"dt_chosen"} == set(told)
        assert told["case_id"] == told["id"]
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


@pytest.mark.long
def test_every_file_and_column_of_a_design(pulses):
    words = ["--vary", "block.width_m", "0.2:0.6", "--limit", "P(overturn) < 0.5", "--steps", "2"]
    motions = ["--motions", f"{pulses / 'p.h5'}#*", "-j", "1"]
    out = asked("design", pulses / "block.toml", *words, *motions, pulses / "design")
    assert files(out) <= told_files("Folder of `fecolumn design`")
    assert header(out / "design.csv") == list(listed("outputs", "design.csv"))
    assert list(json.loads((out / "design.json").read_text())) == list(
        listed("outputs", "design.json")
    )


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
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
    with h5py.File(scaled) as file:
        first = file["motions/0001"]
        names = {
            *file.attrs,
            *(f"{name}/NUMBER" if name == "motions" else f"{name}/NAME" for name in file),
        }
        assert names == set(listed("outputs", "ENSEMBLE.h5"))
        assert set(first.attrs) == set(listed("outputs", "Motions of ENSEMBLE.h5"))
        assert first.attrs["units"] == listed("outputs", "ENSEMBLE.h5")["motions/NUMBER"]
    own = set(header(scaled.with_suffix(".csv"))) - set(listed("outputs", "ENSEMBLE.csv"))
    part = PAGES["outputs"].read_text().partition("### ENSEMBLE.csv")[2]
    assert own == set(re.findall(r"`(parameter_[a-z]\w+)`", part))


def test_what_info_prints_of_a_record_of_ones_own(tmp_path, monkeypatch, capsys):
    """The job "Records of one's own": every line is that of its record."""
    page = PAGES["jobs"].read_text(encoding="utf-8")
    record = page.partition("# record.csv\n")[2].partition("```")[0]
    told = page.partition("warns of errors in the record:\n\n")[2].partition("\n\n")[0]
    (tmp_path / "record.csv").write_text(record)
    monkeypatch.chdir(tmp_path)
    assert main(["motions", "info", "record.csv"]) == 0
    said = [line.strip() for line in "".join(capsys.readouterr()).splitlines()]
    missing = [line.strip() for line in told.splitlines() if line.strip() not in said]
    assert len(told.splitlines()) == 8 and not missing, (missing, said)


def test_peak_that_band_limited_sampling_raises_as_the_manual_says(tmp_path, capsys):
    """The ramp of the page on motions."""
    file = tmp_path / "ramp.csv"
    file.write_text("t_s,ax_g\n0,0\n3,0.2935\n6,0.2935\n")
    main(["motions", "info", str(file)])
    said = "".join(capsys.readouterr())
    (peak,) = re.findall(r"ax peaks at ([\d.]+) g between its rows", said)
    assert f"0.2935 g: {peak} g between them" in PAGES["motions"].read_text(encoding="utf-8")
