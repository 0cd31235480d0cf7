"""`fecolumn motions`: files, messages and exit codes."""

import math

import pytest

from fecolumn.cli import main
from fecolumn.motions.ensemble_file import read_ensemble


@pytest.fixture(scope="module")
def lick(tmp_path_factory):
    path = tmp_path_factory.mktemp("lick") / "lick.h5"
    assert main(["motions", "make", "seeded", "-n", "4", "--seed", "2", "-o", str(path)]) == 0
    return path


def refused(capsys, *arguments):
    assert main(["motions", *map(str, arguments)]) == 2
    return capsys.readouterr().err


def test_made_ensemble_states_its_scale_seed_and_version(lick):
    made = read_ensemble(lick)
    assert len(made.motions) == 4 and "time x 0.5" in made.name and made.motions[0].dt == 0.0025
    assert (
        made.provenance["seed"] == 2
        and made.provenance["version"]
        and made.provenance["arguments"]["time_scale"] == 0.5
    )
    head, *rows = lick.with_suffix(".csv").read_text().splitlines()
    assert "time_scale" in head.split(",") and len(rows) == 4


def test_info_tells_medians_beside_the_target(lick, capsys):
    assert main(["motions", "info", str(lick)]) == 0
    said = capsys.readouterr().out
    assert (
        "4 motions" in said
        and "PGV [cm/s]" in said
        and "Sa(0.075 s) [g]" in said
        and "figures within what is allowed" in said
    )


def test_table_and_info_of_one_component_are_those_of_the_component(lick, tmp_path, capsys):
    made = tmp_path / "pulses.h5"
    # a cycle of 3 sin(2 pi t / 0.5 s): PGV 3 T/pi, int |a| dt = 2 * PGV
    assert (
        main(
            [
                "motions",
                "make",
                "pulses",
                "one_sine",
                "--amplitudes",
                "3",
                "--periods",
                "0.5",
                "-o",
                str(made),
            ]
        )
        == 0
    )
    assert "PGA, PGV, PGD and Housner: along x; CAV: along x" in capsys.readouterr().out
    head, row = (line.split(",") for line in made.with_suffix(".csv").read_text().splitlines())
    row = dict(zip(head, row))
    assert row["horizontal_components"] == "1" and float(row["pga_m_s2"]) == pytest.approx(
        3, rel=1e-4
    )
    assert float(row["pgv_m_s"]) == pytest.approx(1.5 / math.pi, rel=1e-4) and float(
        row["cav_m_s"]
    ) == pytest.approx(3 / math.pi, rel=1e-4)

    assert (
        main(["motions", "convert", f"{made}#1", f"{lick}#1", "-o", str(tmp_path / "mixed.h5")])
        == 0
    )
    assert (
        "RotD50, or the only component; CAV: mean of x and y, or the only component"
        in capsys.readouterr().out
    )
    assert main(["motions", "info", str(lick)]) == 0
    assert "PGA, PGV, PGD and Housner: RotD50; CAV: mean of x and y\n" in capsys.readouterr().out


def test_figures_are_written(lick, tmp_path):
    assert main(["motions", "plot", str(lick), "-o", str(tmp_path), "--show", "1", "3"]) == 0
    for name in ("motions", "spectra", "distributions", "rocking"):
        assert (tmp_path / f"{name}.png").stat().st_size > 20000 and (
            tmp_path / f"{name}.pdf"
        ).read_bytes().startswith(b"%PDF")


def test_motions_are_converted_to_text_and_collected_again(lick, tmp_path):
    assert main(["motions", "convert", f"{lick}#*", "-o", str(tmp_path / "text")]) == 0
    files = sorted((tmp_path / "text").glob("0*"))
    assert len(files) == 4
    assert (
        main(
            [
                "motions",
                "convert",
                *map(str, files[:2]),
                f"{lick}#4",
                "-o",
                str(tmp_path / "some.h5"),
            ]
        )
        == 0
    )
    some, made = read_ensemble(tmp_path / "some.h5"), read_ensemble(lick)
    for motion, original in zip(some.motions, (made.motions[0], made.motions[1], made.motions[3])):
        assert motion.acceleration == pytest.approx(
            original.acceleration, abs=1e-7
        ) and motion.dt == pytest.approx(original.dt)


def test_wrong_input_is_refused_in_a_line(lick, capsys, tmp_path):
    assert "must end in .h5" in refused(capsys, "make", "seeded", "-o", tmp_path / "a.txt")
    assert "-n = 0: must be at least 1" in refused(
        capsys, "make", "seeded", "-n", 0, "-o", tmp_path / "a.h5"
    )
    assert "--time-scale" in refused(
        capsys, "make", "seeded", "--time-scale", 0, "-o", tmp_path / "a.h5"
    )
    assert "no such file" in refused(
        capsys, "make", "seeded", tmp_path / "gone.toml", "-o", tmp_path / "a.h5"
    )
    assert "no such file" in refused(capsys, "info", tmp_path / "gone.h5")
    assert "formats that are read" in refused(capsys, "info", lick.with_suffix(".csv"))
    assert "from 1 to 4" in refused(capsys, "plot", lick, "-o", tmp_path, "--show", 5)
    for alpha in (0, 1.6, "nan"):
        assert "--slenderness" in refused(
            capsys, "plot", lick, "-o", tmp_path, "--slenderness", alpha
        )
    assert "from 1 to 4" in refused(capsys, "convert", f"{lick}#9", "-o", tmp_path / "x")
    assert "two horizontal components" in refused(
        capsys, "fit", one_component(tmp_path), "-o", tmp_path / "m.toml"
    )


def one_component(tmp_path):
    (tmp_path / "one.csv").write_text(
        "t [s],ax [g]\n" + "".join(f"{i / 100},{i % 7}\n" for i in range(50))
    )
    return tmp_path / "one.csv"


def test_info_tells_of_a_peak_between_few_rows(tmp_path, capsys):
    (tmp_path / "ramp.csv").write_text("time [s],ax [g]\n0,0\n3,0.2935\n6,0.2935\n")
    assert main(["motions", "info", str(tmp_path / "ramp.csv")]) == 0
    assert "g between its rows, 3 s apart, where these peak at 0.2935 g" in capsys.readouterr().out


MAKE = "fecolumn: fecolumn motions make: "
PULSES = "pulses one_sine --amplitudes 1 --periods 1"


@pytest.mark.parametrize(
    "words, said",
    [
        ("pulses one_sine --amplitudes 1 0 --periods 1", "--amplitudes = 0.0: must be finite and"),
        ("pulses one_sine --amplitudes 1 --periods 0", "--periods = 0.0: must be finite and great"),
        (f"{PULSES} --dt 0.5", "--dt = 0.5: must be greater than 0 and at most 0.1 s, a tenth"),
        (f"{PULSES} --cycles 2", "--cycles = 2: must be 1 for one_sine: only type_c has cycles"),
        (f"{PULSES} --cycles 0", "--cycles = 0: must be at least 1"),
        (f"{PULSES} --tail -1", "--tail = -1.0: must be finite and at least 0 s"),
        ("near-fault --count 0", "-n = 0: must be at least 1"),
        ("near-fault --seed -1", "--seed = -1: must be at least 0"),
        ("near-fault --magnitudes 6 20", "--magnitudes = 20.0: must lie in [4, 8]"),
        ("near-fault --distances -1", "--distances = -1.0: must lie in [0, 40] km"),
        ("near-fault --dt 1", "--dt = 1.0: must be greater than 0 and at most 0.02 s"),
        ("records FX", "SET = 'FX': must be one of far_field (FF), "),
        ("records FF --time-scale -1", "--time-scale = -1.0: must be finite and greater than 0"),
        ("records FF --pgv 0", "--pgv = 0.0: must be finite and greater than 0 m/s"),
    ],
)
def test_option_of_make_is_named_with_its_value_and_range(capsys, tmp_path, words, said):
    told = refused(capsys, "make", *words.split(), "-o", tmp_path / "a.h5")
    assert told.startswith(MAKE + said) and told.count("\n") == 1


@pytest.mark.parametrize(
    "words, said",
    [
        ("info b.txt --dt 50", "--dt = 50.0: must lie in [0, 10] [s]"),
        ("correct b.txt --dt 50 -o d", "--dt = 50.0: must lie in [0, 10] [s]"),
        ("info b.txt --units lb", "--units = 'lb': must be one of g, %g, mg, m/s2, cm/s2, mm/s2"),
        ("fit gone.csv -o m.toml", "RECORD = 'gone.csv': no such file"),
        ("fit b.txt --dt 0.01 --source-z gone.csv --units g -o m.toml", "--source-z = 'gone.csv'"),
        ("convert b.txt c.txt --source-y b.txt -o d", "--source-y = 'b.txt': goes with one SOURCE"),
        ("info p.h5 --source-y b.txt", "--source-y = 'b.txt': goes with a file of one component"),
    ],
)
def test_option_of_a_record_is_named_as_it_is_given(capsys, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    for name in ("b.txt", "c.txt"):
        (tmp_path / name).write_text("0\n0.1\n0.2\n0.05\n0\n")
    if "p.h5" in words:
        assert main(["motions", "make", *PULSES.split(), "-o", "p.h5"]) == 0
        capsys.readouterr()
    told = refused(capsys, *words.split())
    assert f": {said}" in told and told.startswith("fecolumn: fecolumn motions")


def test_components_of_three_files_are_one_motion(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, factor in (("x.txt", 1), ("y.txt", 2), ("z.txt", 3)):
        (tmp_path / name).write_text("".join(f"{factor * (i % 3 - 1) / 10}\n" for i in range(30)))
    words = "x.txt --source-y y.txt --source-z z.txt --units m/s2 --dt 0.01".split()
    assert main(["motions", "info", *words]) == 0
    told = capsys.readouterr().out
    assert all(f"{name}.txt: columns of text" in told for name in "xyz") and "az: PGA" in told
    assert main(["motions", "convert", *words, "-o", "all.h5"]) == 0
    (motion,) = read_ensemble(tmp_path / "all.h5").motions
    assert motion.acceleration[0] == pytest.approx([-0.1, -0.2, -0.3])


def test_every_action_tells_what_it_does(capsys):
    for words in (["make"], ["make", "pulses"], ["fit"], ["plot"], ["select"]):
        with pytest.raises(SystemExit):
            main(["motions", *words, "--help"])
        told = capsys.readouterr().out
        assert told.split("\n\n")[1][0].isupper() and told.split("\n\n")[1].endswith(".")
