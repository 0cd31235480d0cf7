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
