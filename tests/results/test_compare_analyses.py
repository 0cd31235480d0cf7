"""fecolumn compare of two analyses: when they part, by how much, and what of their cases
differs.
"""

import csv
import json
import shutil

import h5py
import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.cli import main
from fecolumn.engines.stored import stored_history, stored_states
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.sealed import sealed
from fecolumn.pictures.figures.history_curves import HistoryCurves
from fecolumn.pictures.figures.history_figures import history_figures
from fecolumn.pictures.render.result import read_rows
from fecolumn.simulation import run
from fecolumn.study.results.analysis import AnalysisResult
from fecolumn.study.results.parting import QuantityPair, differing_keys

BLOCK = {
    "title": "Marble block",
    "column": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 1.2},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700},
    "mesh": {"fine_size_m": 0.1, "coarse_size_m": 0.2, "base_size_m": 0.2},
    "initial": {"tilt_rad": 0.05},
    "output": {"states_every_s": 0.0},
}
ENGINE = {"engine": "rigid", "duration_s": 0.3, "dt_s": 1e-3}


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """The block released from a tilt: at 1e-3 s, at 2e-3 s, and with its modes on a base with more
    friction.
    """
    place = tmp_path_factory.mktemp("analyses")
    cases = {
        "fine": BLOCK | {"integration": ENGINE},
        "coarse": BLOCK | {"integration": ENGINE | {"dt_s": 2e-3}},
        "other": BLOCK
        | {
            "integration": ENGINE | {"engine": "reduced", "duration_s": 0.2},
            "contact": {"friction_coefficient": 0.6},
            "initial": {"tilt_rad": 0.055},
        },
    }
    for name, tables in cases.items():
        run(case_from_tables(tables, name), place / name, quiet=True)
    return place


def _compared(capsys, *arguments) -> str:
    assert main(["compare", *map(str, arguments)]) == 0
    return capsys.readouterr().out


def test_parting_is_the_first_difference_beyond_the_tolerance_of_the_larger_peak():
    time = np.linspace(0, 10, 1001)
    pair = QuantityPair.of(
        np.sin(time), np.sin(time) + 0.01 * time**2, 0.05
    )  # the peak of b is near 1.45
    assert pair.peak == pytest.approx(np.abs(np.sin(time) + 0.01 * time**2).max())
    assert time[pair.parted] == pytest.approx(np.sqrt(5 * pair.peak), abs=0.0101) and time[
        pair.parted
    ] >= np.sqrt(5 * pair.peak)
    assert QuantityPair.of(np.sin(time), np.sin(time) * 1.04, 0.05).parted is None


def test_directions_count_columns_that_lean_to_opposite_sides_have_parted():
    lean = np.column_stack([np.linspace(0, 1, 11), np.zeros(11)])
    assert QuantityPair.of(lean, -lean, 0.05).parted == 1


def test_an_analysis_and_itself_do_not_part(folders, capsys):
    said = _compared(capsys, folders / "fine", folders / "fine")
    assert (
        "the same values for every key" in said
        and said.count("never") == 3
        and "They do not part within the 0.3 s" in said
    )


def test_two_steps_are_compared_at_the_rows_of_the_coarser(folders, tmp_path, capsys):
    said = _compared(
        capsys, folders / "coarse", folders / "fine", "-o", tmp_path / "out", "--tolerance", "1e-5"
    )
    assert (
        "integration.dt_s  0.002  0.001     s" in said and "more than 1e-05 of the larger" in said
    )
    found = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert (
        found["rows"] == 151
        and found["keys"] == {"integration.dt_s": {"a": 0.002, "b": 0.001, "unit": "s"}}
        and found["tolerance"] == 1e-5
    )
    with (
        h5py.File(folders / "coarse" / "history.h5") as coarse,
        h5py.File(folders / "fine" / "history.h5") as fine,
    ):
        apart = np.abs(coarse["tilt"][()] - fine["tilt"][::2])
        peak = max(coarse["tilt"][()].max(), fine["tilt"][()].max())
        assert found["quantities"]["tilt"]["difference_max"] == pytest.approx(apart.max(), rel=1e-6)
        assert found["quantities"]["tilt"]["parted_s"] == pytest.approx(
            coarse["time"][np.argmax(apart > 1e-5 * peak)]
        )
        assert found["energy_j"]["kinetic"]["b"] == pytest.approx(float(fine["energy/kinetic"][-1]))
    rows = list(csv.DictReader((tmp_path / "out" / "histories.csv").open()))
    assert len(rows) == 151 and max(
        float(row["tilt_difference [rad]"]) for row in rows
    ) == pytest.approx(apart.max(), rel=1e-6)
    assert {file.name for file in (tmp_path / "out").glob("[!.]*")} == {
        "comparison.json",
        "histories.csv",
        "comparison.png",
        "comparison.pdf",
    }


def test_other_cases_and_engines_are_compared_in_their_common_time(folders, capsys):
    said = _compared(capsys, folders / "fine", folders / "other")
    assert all(
        key in said
        for key in (
            "integration.engine",
            "contact.friction_coefficient",
            "initial.tilt_rad",
            "integration.duration_s",
        )
    )
    # 0.05 and 0.055 rad are a tenth apart
    assert "from 0 to 0.2 s" in said and "They part at 0.0000 s, first in top displacement" in said


def test_a_column_that_only_stands_has_no_tilt_to_part(tmp_path, capsys):
    for name, dt in (("a", 1e-3), ("b", 5e-4)):
        tables = BLOCK | {
            "initial": {"velocity_m_s": [0.2, 0, 0]},
            "integration": ENGINE | {"dt_s": dt, "duration_s": 0.05},
            "contact": {"friction_coefficient": 0.05},
        }
        run(case_from_tables(tables, name), tmp_path / name, quiet=True)
    said = _compared(capsys, tmp_path / "a", tmp_path / "b")
    assert "Neither lifts off its base" in said and said.count("not judged") >= 2


def test_keys_of_a_section_that_one_lacks_are_told_but_those_at_their_default():
    a, b = (
        case_from_tables(BLOCK | extra, "case")
        for extra in (
            {"motion": {"source": "lick:1", "scale": 2.0}},
            {"integration": {"duration_s": 1.0}},
        )
    )
    assert [key for key, _, _ in differing_keys(a, b)] == [
        "integration.duration_s",
        "motion.source",
        "motion.scale",
    ]


def test_analyses_are_compared_in_python(folders):
    import fecolumn

    found = fecolumn.load(folders / "fine").compare(
        fecolumn.load(folders / "coarse"), tolerance=1e-5
    )
    assert (
        found.tolerance == 1e-5
        and found.first[1]
        == found.time[
            min(pair.parted for pair in found.quantities.values() if pair.parted is not None)
        ]
    )


def test_unfinished_analysis_is_compared_as_far_as_it_is(folders, tmp_path, capsys):
    shutil.copytree(folders / "fine", tmp_path / "part")
    (tmp_path / "part" / "summary.json").unlink()
    assert "not finished, at 0.3 s" in _compared(capsys, tmp_path / "part", folders / "fine")


@pytest.mark.parametrize(
    "arguments, told",
    [
        (
            ["{fine}", "{study}"],
            "is an analysis, B, {study}, is a study: give two analyses, or two ensembles",
        ),
        (["{fine}", "{csv}"], "is a file"),
        (["{fine}", "{fine}/none"], "is not there"),
        (
            ["{fine}", "{fine}", "--tolerance", "0"],
            "--tolerance = 0.0: must be greater than 0 and at most 1",
        ),
        (["{fine}", "{fine}", "--cap-m", "0.25"], "--cap-m = 0.25: is for ensembles"),
        (["{study}", "{study}", "--tolerance", "0.1"], "--tolerance = 0.1: is for two analyses"),
    ],
)
def test_what_does_not_fit_is_one_line(folders, tmp_path, capsys, arguments, told):
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "study.json").write_text("{}")
    (tmp_path / "peaks.csv").write_text("motion,u_max_mm\n1,2\n")
    places = dict(fine=folders / "fine", study=tmp_path / "study", csv=tmp_path / "peaks.csv")
    assert main(["compare", *(word.format(**places) for word in arguments)]) == 2
    error = capsys.readouterr().err
    assert told.format(**places) in error and error.count("\n") == 1


@pytest.mark.long
def test_two_analyses_of_a_structure_are_compared_by_what_they_observe(tmp_path, capsys):
    block = dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.8)
    tables = dict(
        title="Two blocks",
        bodies=dict(lower=block, upper=block | dict(at_m=[0.0, 0.0, 0.8])),
        joints=dict(foot=dict(between=["lower", "ground"]), joint=dict(between=["upper", "lower"])),
        initial=dict(upper=dict(tilt_rad=0.03)),
    )
    for name, dt in (("coarse", 2e-3), ("fine", 1e-3)):
        run(
            case_from_tables(tables | dict(integration=ENGINE | dict(dt_s=dt)), name),
            tmp_path / name,
            quiet=True,
        )
    said = _compared(capsys, tmp_path / "coarse", tmp_path / "fine")
    assert "integration.dt_s  0.002  0.001     s" in said and "uplift" in said


@pytest.mark.parametrize(
    "name, damage, told",
    [
        ("summary.json", lambda text: text[:-40], "summary.json: "),
        ("summary.json", lambda text: b"[]", "not a table of keys"),
        ("summary.json", lambda text: text.replace(b'"u_max_m": ', b'"u_max_m": 1'), "digest"),
        ("summary.json", lambda text: text.replace(b"at rest", b"\xff"), "summary.json: "),
    ],
)
def test_a_damaged_or_edited_summary_is_one_line(folders, tmp_path, capsys, name, damage, told):
    shutil.copytree(folders / "fine", tmp_path / "fine")
    file = tmp_path / "fine" / name
    before = file.read_bytes()
    file.write_bytes(damage(before))
    if file.read_bytes() != before:
        assert main(["compare", str(tmp_path / "fine"), str(folders / "fine")]) == 2
        error = capsys.readouterr().err
        assert told in error and error.count("\n") == 1
        assert "run the case into this folder again" in error


@pytest.mark.parametrize("command", ["compare", "render", "figures"])
def test_a_history_of_another_case_is_one_line(folders, tmp_path, capsys, command):
    shutil.copytree(folders / "fine", tmp_path / "fine")
    shutil.copy(folders / "other" / "history.h5", tmp_path / "fine" / "history.h5")
    if command == "figures":
        with pytest.raises(InputError, match="is of another case: must be"):
            history_figures(tmp_path / "fine")
        return
    more = [str(folders / "fine")] if command == "compare" else []
    assert main([command, str(tmp_path / "fine"), *more]) == 2
    error = capsys.readouterr().err
    assert "history.h5: case_id = " in error and "is of another case: must be" in error
    assert error.count("\n") == 1


def _damaged(whole):
    """Contents of a file of which a byte has changed, or the end is missing."""
    rng = np.random.default_rng(7)
    for place in [2112, *rng.integers(len(whole), size=6)]:
        changed = bytearray(whole)
        changed[place] ^= 0xFF
        yield bytes(changed)
    for length in (0, 1000, len(whole) // 2, len(whole) - 200):
        yield whole[:length]


def test_a_damaged_history_is_refused_in_one_line(folders, tmp_path):
    copy = shutil.copytree(folders / "fine", tmp_path / "copy")
    whole = (copy / "history.h5").read_bytes()
    for number, content in enumerate(_damaged(whole)):
        (copy / "history.h5").write_bytes(content)
        for read in (
            lambda: AnalysisResult(copy).compare(AnalysisResult(folders / "coarse")),
            lambda: HistoryCurves.read(copy / "history.h5"),
            lambda: read_rows(copy / "history.h5"),
        ):
            with pytest.raises(InputError, match="run the analysis again") as caught:
                read()
            assert "history.h5" in str(caught.value) and "\n" not in str(caught.value), number


def test_damaged_states_are_refused_in_one_line(tmp_path):
    copy = tmp_path / "run"
    tables = BLOCK | {"integration": ENGINE, "output": {"states_every_s": 0.05}}
    run(case_from_tables(tables), copy, quiet=True)
    assert len(stored_states(copy / "states.h5")["time"]) > 3
    for content in _damaged((copy / "states.h5").read_bytes()):
        (copy / "states.h5").write_bytes(content)
        with pytest.raises(InputError, match="states.h5: not the states .*run the analysis again"):
            stored_states(copy / "states.h5")


def test_what_h5py_raises_of_a_file_without_checksum_is_one_line(folders, tmp_path, monkeypatch):
    copy = shutil.copytree(folders / "fine", tmp_path / "copy")
    file = copy / "history.h5"
    file.write_bytes(file.read_bytes()[: -len(sealed(b""))])
    assert len(stored_history(file)["time"]) > 100

    def fail(*_):
        raise RuntimeError("Object visitation failed\n(bad heap free list)")

    monkeypatch.setattr("fecolumn.engines.stored.history_columns", fail)
    with pytest.raises(InputError, match=r"history.h5: not a .* \(Object visitation failed \(bad"):
        stored_history(file)
