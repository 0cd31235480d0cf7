"""fecolumn rocking: models from files, one motion or many."""

import csv
import json
import math
import subprocess
import sys

import pytest

from fecolumn.cli import main

BLOCK = """title = "marble"
block.width_m = 0.4
block.height_m = 1.2
block.density_kg_m3 = 2700
"""
FRAME = """frame.width_m = 1.6
frame.height_m = 9.6
frame.column_mass_kg = 48e3
frame.beam_mass_kg = 384e3
initial.tilt_rad = 0.05
integration.duration_s = 2.0
"""


@pytest.fixture
def ensemble(tmp_path):
    """Four one-sine pulses of 0.3 to 1.2 g in an ensemble file."""
    assert (
        main(
            [
                "motions",
                "make",
                "pulses",
                "one_sine",
                "--amplitudes",
                "2.9",
                "5",
                "8",
                "14",
                "--periods",
                "0.8",
                "--dt",
                "0.005",
                "-o",
                str(tmp_path / "p.h5"),
            ]
        )
        == 0
    )
    return tmp_path / "p.h5"


def rows(file):
    with open(file) as text:
        return list(csv.DictReader(text))


def test_free_rocking_of_a_frame_writes_table_history_and_figure(tmp_path, capsys):
    (tmp_path / "frame.toml").write_text(FRAME)
    assert (
        main(
            ["rocking", "rocking_frame", str(tmp_path / "frame.toml"), "-o", str(tmp_path / "out")]
        )
        == 0
    )
    assert {"parameters.csv", "responses.csv", "history.csv", "history.png", "history.pdf"} <= {
        path.name for path in (tmp_path / "out").iterdir()
    }
    history = rows(tmp_path / "out" / "history.csv")
    assert float(history[0]["theta_x [rad]"]) == pytest.approx(0.05) and float(
        history[-1]["time [s]"]
    ) == pytest.approx(2.0)
    parameters = {
        row["parameter"]: float(row["value"]) for row in rows(tmp_path / "out" / "parameters.csv")
    }
    assert (
        parameters["frequency parameter p"] == pytest.approx(1.023, abs=1e-3)
        and parameters["mass ratio gamma"] == 4
    )
    assert "mass ratio gamma" in capsys.readouterr().out


@pytest.mark.long
def test_ensemble_counts_what_overturns_as_the_motions_grow(tmp_path, ensemble, capsys):
    (tmp_path / "block.toml").write_text(BLOCK + f'motion.source = "{ensemble}#*"\n')
    assert (
        main(["rocking", "housner", str(tmp_path / "block.toml"), "-o", str(tmp_path / "out")]) == 0
    )
    found = rows(tmp_path / "out" / "responses.csv")
    outcomes = [row["outcome"] for row in found]
    fell = [outcome == "overturned" for outcome in outcomes]
    assert fell[-1] and fell == sorted(fell)
    # what stands is said in the words of fecolumn run, in metres
    text = (tmp_path / "block.toml").read_text().replace("#*", "#1")
    (tmp_path / "one.toml").write_text(text + 'integration.engine = "housner"\n')
    assert main(["run", str(tmp_path / "one.toml"), "-o", str(tmp_path / "run"), "-q"]) == 0
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert outcomes[0] == summary["outcome"] != "overturned"
    assert float(found[0]["u_max_m"]) == pytest.approx(summary["u_max_m"], rel=1e-5)
    # of what overturned no peak is known, as in analyses.csv of a study
    peaks = [(row["u_max_m"] == "", row["u_max_censored"]) for row in found]
    assert peaks == [(over, str(int(over))) for over in fell]
    assert float(found[0]["duration_s"]) == pytest.approx(summary["duration_s"], abs=0.002)
    said = capsys.readouterr().out
    assert f"4 motions: {outcomes.count('overturned')} overturned" in said and "> " in said
    assert (tmp_path / "out" / "cdf.png").exists()


def test_case_of_finite_elements_serves_as_it_is(tmp_path, ensemble, capsys):
    (tmp_path / "drum.toml").write_text(
        'column.shape = "solid"\ncolumn.outer_diameter_m = 0.5\ncolumn.height_m = '
        f'1.6\nmotion.source = "{ensemble}#2"\n'
    )
    assert (
        main(["rocking", "housner", str(tmp_path / "drum.toml"), "-o", str(tmp_path / "out")]) == 0
    )
    assert "slenderness alpha along x" in capsys.readouterr().out


@pytest.mark.parametrize(
    "text, said",
    [
        (
            BLOCK,
            "integration.duration_s = 0: must be greater than 0 s where the case has no motion",
        ),
        (BLOCK + "block.colour = 1\nintegration.duration_s = 1.0\n", "block.colour"),
        (
            BLOCK + "walls = 2\n",
            "walls: unknown key; a case of the model housner has title, block, "
            "integration, initial, overturn, output, motion",
        ),
        ('title = "x"\n', "block: missing: the model housner is made from [block]"),
        (BLOCK + 'motion.source = "lick:3-2"\n', "must be two rising numbers from 1 to 115"),
        (BLOCK + 'motion.source = "none.csv"\n', "no such file"),
    ],
)
def test_what_is_wrong_with_a_model_case_is_told_in_a_line(tmp_path, capsys, text, said):
    (tmp_path / "block.toml").write_text(text)
    assert (
        main(["rocking", "housner", str(tmp_path / "block.toml"), "-o", str(tmp_path / "out")]) == 2
    )
    told = capsys.readouterr().err
    assert said in told and "block.toml" in told and len(told.strip().splitlines()) == 1


def test_spectra_are_of_free_symmetric_blocks_alone(tmp_path, capsys):
    (tmp_path / "block.toml").write_text(
        BLOCK + "block.spring_n_m = 10\nintegration.duration_s = 1.0\n"
    )
    assert (
        main(["rocking", "spectrum", str(tmp_path / "block.toml"), "-o", str(tmp_path / "out")])
        == 2
    )
    assert "must be a free symmetric block" in capsys.readouterr().err


def test_figures_of_overturning_show_bands_and_the_design_chart(tmp_path):
    from fecolumn.engines.rocking.spectra_table import spectra_table
    from fecolumn.pictures.figures.overturning_figure import overturning_figure, slenderness_figure

    found = spectra_table(math.radians(10), 0.95477, ("one_sine",), (2.0, 4.0))
    assert {frequency for _, frequency, _ in found} == {2.0, 4.0} and {
        band.impacts for _, _, band in found
    } >= {0, 1}
    for file in (
        *overturning_figure(found, math.radians(10), tmp_path / "a"),
        *slenderness_figure(tmp_path / "b"),
    ):
        assert file.stat().st_size > 5000


def test_keys_of_the_models_are_listed(capsys):
    assert main(["keys", "block"]) == 0 and main(["keys", "frame.tendon_n_m"]) == 0
    told = capsys.readouterr().out
    assert "half_diagonal_m [m]" in told and "stiffness of a tendon on the axis" in told


def test_help_waits_for_no_library():
    code = (
        "import sys; from fecolumn.cli import _parser; _parser(); sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@pytest.mark.long
@pytest.mark.parametrize(
    "words", ["block.toml -o out", "housner -o out block.toml", "-o out -q housner block.toml"]
)
def test_model_of_the_case_need_not_be_said(tmp_path, monkeypatch, capsys, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "block.toml").write_text(BLOCK + "integration.duration_s = 0.1\n")
    assert main(["rocking", *words.split()]) == 0
    assert "slenderness alpha " in capsys.readouterr().out


@pytest.mark.parametrize(
    "text, said",
    [
        (BLOCK + "podium.column_mass_kg = 1\n", "must be housner or podium, as the case has"),
        (
            'column = {shape = "solid", outer_diameter_m = 0.5, height_m = 1.6}\n',
            "MODEL: must be one of housner, rocking_frame, wobbling, wobbling_frame, podium, "
            "spectrum: case.toml has no table of a model",
        ),
    ],
)
def test_case_that_names_no_model_asks_for_one(tmp_path, monkeypatch, capsys, text, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(text)
    assert main(["rocking", "case.toml", "-o", "out"]) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_quiet_ensemble_tells_no_progress(tmp_path, ensemble, capsys):
    (tmp_path / "block.toml").write_text(BLOCK + f'motion.source = "{ensemble}#*"\n')
    capsys.readouterr()
    assert main(["rocking", str(tmp_path / "block.toml"), "-q", "-o", str(tmp_path / "out")]) == 0
    told = capsys.readouterr()
    assert "4 motions" in told.out
    assert all(line.startswith("fecolumn: warning") for line in told.err.splitlines())
