"""fecolumn screen: what a list becomes, its ranking, and lists that cannot be used."""

import csv

import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.study.questions.objects import read_objects

HEADER = "name,width_m,depth_m,height_m,mass_kg,friction\n"
LIST = HEADER + "low,0.6,5,1,100,0.9\nslender,0.2,5,1,9,0.6\ntwin,0.2,5,1,9,0.6\n"
G = 9.80665


@pytest.fixture(scope="module")
def pulses(tmp_path_factory):
    file = tmp_path_factory.mktemp("screen") / "p.h5"
    amplitudes = [f"{one:g}" for one in np.linspace(1, 8, 8)]
    arguments = ["--amplitudes", *amplitudes, "--periods", "0.5", "-o", str(file)]
    assert main(["motions", "make", "pulses", "symmetric_ricker", *arguments]) == 0
    return f"{file}#*"


def screen(folder, text, motions, *more):
    (folder / "list.csv").write_text(text)
    options = ["--motions", motions, "-o", str(folder / "out"), "-j", "1", *more]
    return main(["screen", str(folder / "list.csv"), *options])


def rows(file):
    with open(file) as text:
        return list(csv.DictReader(text))


def test_a_further_limit_that_happens_is_told_where_the_first_does_not(tmp_path, pulses, capsys):
    """Blocks tilt, none overturns."""
    limits = ("--event", "overturn", "--event", "tilt > 1e-9 rad")
    text = HEADER + "low,0.6,5,1,100,0.9\nslender,0.5,5,1,9,0.6\n"
    assert screen(tmp_path, text, pulses, "--engine", "housner", *limits) == 0
    said = capsys.readouterr().out
    assert "overturn happens to none of 2 in any of 8 motions" in said
    assert "tilt > 1e-09 rad happens most often to 'slender': in " in said


@pytest.mark.long
@pytest.mark.parametrize("engine", ["housner", "rigid"])
def test_shares_are_those_of_the_closed_form_and_rank_the_list(tmp_path, pulses, engine, capsys):
    """A block lifts where the peak of the ground exceeds g width / height."""
    limit = ("--event", "tilt > 1e-7 rad", "--event", "overturn")
    assert screen(tmp_path, LIST, pulses, "--engine", engine, *limit) == 0
    table = rows(tmp_path / "out" / "screen.csv")
    assert [row["event"] for row in table] == ["tilt > 1e-07 rad", "overturn"] * 3
    found = table[::2]
    assert [row["name"] for row in found] == ["slender", "twin", "low"]
    peaks = np.linspace(1, 8, 8)
    for row in found:
        exact = (peaks > G * float(row["width_m"]) / float(row["height_m"])).sum()
        assert row["n"] == "8" and int(row["reached"]) == exact
        assert float(row["probability"]) == pytest.approx(exact / 8)
    assert len(list((tmp_path / "out" / "analyses").iterdir())) == 16  # twins are run once
    page = (tmp_path / "out" / "screen.html").read_text()
    assert "slender" in page and page.count("<tr>") == 4 and len(page) < 2e6
    assert "Most endangered of 3 is 'slender'" in capsys.readouterr().out
    # again: nothing is run, the same table
    before = (tmp_path / "out" / "screen.csv").read_bytes()
    assert screen(tmp_path, LIST, pulses, "--engine", engine, *limit) == 0
    assert (tmp_path / "out" / "screen.csv").read_bytes() == before


def test_units_of_the_header_are_turned_into_si(tmp_path):
    (tmp_path / "list.csv").write_text(
        "number,mass_g,friction,height_mm,name,depth_cm,width_m\n7,2500,0.3,420,vase,11,0.12\n"
    )
    (vase,) = read_objects(tmp_path / "list.csv")
    assert (vase.name, *vase.values) == ("vase", 0.12, 0.11, 0.42, 2.5, 0.3)


@pytest.mark.parametrize(
    "text",
    [
        "name;width_cm;depth_cm;height_cm;mass_kg;friction\nKrug, blau;12,5;11;42;2,1;0,25\n"
        ";;;;;\n",
        "Name\tWidth_cm\tdepth_cm\theight_cm\tmass_kg\tfriction\n"
        "Krug, blau\t12,5\t11\t42\t2,1\t0,25\n",
        '"name","width_cm","depth_cm","height_cm","mass_kg","friction"\n'
        '"Krug, blau","12,5","11","42","2,1","0,25"\n',
    ],
    ids=["semicolons", "tabs", "quotes"],
)
def test_a_list_is_read_as_spreadsheets_write_it(tmp_path, text):
    (tmp_path / "list.csv").write_text(text)
    (found,) = read_objects(tmp_path / "list.csv")
    assert (found.name, *found.values) == ("Krug, blau", 0.125, 0.11, 0.42, 2.1, 0.25)


@pytest.mark.parametrize(
    "text, said",
    [
        (None, "list.csv: no such file"),
        ("", "holds no line below its header"),
        (HEADER.replace("width_m", "width_ft") + "a,1,1,1,1,1\n", "'width_ft': must have one col"),
        (HEADER.replace(",friction", "") + "a,1,1,1,1\n", "must have one column friction"),
        (HEADER.replace("depth_m", "width_cm") + "a,1,1,1,1,1\n", "must have one column width_m"),
        (HEADER + "a,1,1,1,1\n", "line 2: has 5 columns where the header has 6"),
        (HEADER + "a,-1,1,1,1,0.3\n", "line 2, width_m = '-1': must be a number greater than 0"),
        (HEADER + "a,1,1,1_0,1,0.3\n", "line 2, height_m = '1_0': must be a number"),
        (HEADER + "a,1,1,nan,1,0.3\n", "line 2, height_m = 'nan': must be a number"),
        (HEADER + "a,400,1,1,1,0.3\n", "at most 100 [m]"),
        (HEADER + "a,1,1,1,1,30\n", "friction = '30': must be a number of at least 0 and at mo"),
        (HEADER + "a,1,1,1,0.9,1\n", "line 2, mass_kg = '0.9': is 0.9 kg/m3 of its width, depth"),
        (HEADER + "a,1,1,1,3e4,1\n", "must lie in [1, 25000] kg/m3: is a unit another?"),
        (HEADER + "a,1,1,1,1,1\na,1,1,1,2,1\n", "line 3, name = 'a': stands twice"),
        (HEADER + ",1,1,1,1,1\n", "line 2, name = '': must not be empty"),
    ],
)
def test_list_that_cannot_be_used_is_refused_in_a_line(tmp_path, text, said):
    if text is not None:
        (tmp_path / "list.csv").write_text(text)
    with pytest.raises(InputError) as error:
        read_objects(tmp_path / "list.csv")
    assert said in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    "options, said",
    [
        (["--scale", "0"], "--scale = 0.0: must lie in"),
        (["--event", "slide > 5 mm", "--engine", "housner"], "rocking models have no joints"),
        (["--event", "slide > 5"], "slide has no unit here"),
        (["-j", "-3"], "-j = -3: must be at least 1"),
    ],
)
def test_options_that_cannot_be_used_are_refused_in_a_line(tmp_path, pulses, capsys, options, said):
    assert screen(tmp_path, LIST, pulses, *options) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_an_object_without_friction_is_taken(tmp_path):
    (tmp_path / "list.csv").write_text(HEADER + "a,1,1,1,2000,0\n")
    assert read_objects(tmp_path / "list.csv")[0].friction == 0.0


@pytest.mark.long
def test_time_of_the_motions_is_scaled_as_the_key_does(tmp_path, pulses):
    """A pulse twice as long overturns what the short one does not."""
    found = {}
    for factor in ("1", "4"):
        folder = tmp_path / factor
        folder.mkdir()
        options = ["--engine", "housner", "--event", "overturn", "--time-scale", factor]
        text = HEADER + "slender,0.2,0.2,1.6,100,0.7\n"
        assert screen(folder, text, pulses, *options) == 0
        (row,) = rows(folder / "out" / "screen.csv")
        found[factor] = int(row["reached"])
    assert found["4"] > found["1"]


def test_a_factor_on_time_out_of_range_is_refused(tmp_path, pulses, capsys):
    assert screen(tmp_path, LIST, pulses, "--time-scale", "0") == 2
    assert "--time-scale = 0.0: must lie in [0.001, 1000]" in capsys.readouterr().err
