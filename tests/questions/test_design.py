"""fecolumn design: the size by bisection, its interval, what it is told that cannot be used."""

import csv
import json
import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import binom

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.crossing import (
    KEPT,
    SURELY_BROKEN,
    SURELY_KEPT,
    GradedValues,
    crossing_place,
    grade,
    runs_needed,
)
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.questions.design import grid_of
from fecolumn.study.questions.given import asked_plan
from fecolumn.study.questions.limit import check_event, read_event, read_limit

G = 9.80665
AMPLITUDES = np.linspace(1.0, 5.0, 40)  # m/s2
HEIGHT_M = 2.0
RIGID = """[bodies.post]
kind = "block"
length_m = 0.3
width_m = 0.3
height_m = 1.0
element_size_m = 0.1
[joints.foot]
between = ["post", "ground"]
[contact]
interior_points = 0
[integration]
engine = "rigid"
dt_s = 1e-3
"""


@pytest.fixture(scope="module")
def pulses(tmp_path_factory):
    """A folder with a block, and pulses whose peaks are known."""
    folder = tmp_path_factory.mktemp("design")
    amplitudes = [f"{one:.6g}" for one in AMPLITUDES]
    arguments = ["--amplitudes", *amplitudes, "--periods", "0.4", "-o", str(folder / "p.h5")]
    assert main(["motions", "make", "pulses", "symmetric_ricker", *arguments]) == 0
    (folder / "block.toml").write_text(
        f"[block]\nwidth_m = 0.5\nheight_m = {HEIGHT_M}\n[integration]\ndt_s = 0.002\n"
    )
    return folder


def design(folder, out, *more, vary=("block.width_m", "0.1:1.1"), limit="P(tilt > 1e-9 rad) < 0.5"):
    return main(
        [
            *("design", str(folder / "block.toml"), "--vary", *vary, "--limit", limit, "-j", "1"),
            *("--motions", f"{folder / 'p.h5'}#*", "-o", str(folder / out), *more),
        ]
    )


@pytest.mark.long
def test_size_and_interval_are_those_of_the_closed_form(pulses, capsys):
    """A block lifts when the peak of the ground exceeds g width / height: its least width for a
    share of motions is a quantile of their peaks.
    """
    assert design(pulses, "closed", "--steps", "32") == 0
    found = json.loads((pulses / "closed" / "design.json").read_text())
    grid = np.linspace(0.1, 1.1, 33)
    lifted = [(AMPLITUDES > G * width / HEIGHT_M).sum() for width in grid]
    n = AMPLITUDES.size
    kept = [k / n < 0.5 for k in lifted]
    intervals = [proportion_interval(k, n) for k in lifted]
    assert found["value"] == found["size"] == pytest.approx(grid[np.argmax(kept)], rel=1e-5)
    with open(pulses / "closed" / "design.csv") as table:
        reached = {round(float(row["value"]), 5): row["reached"] for row in csv.DictReader(table)}
    counts = {round(float(width), 5): str(k) for width, k in zip(grid, lifted)}
    assert reached and all(counts[width] == k for width, k in reached.items())
    least = max(width for width, (low, _) in zip(grid, intervals) if low > 0.5)
    most = min(width for width, (_, high) in zip(grid, intervals) if high < 0.5)
    assert found["interval"] == pytest.approx([least, most], rel=1e-5)
    said = capsys.readouterr().out
    assert "needs block.width_m of at least" in said and f"[{least:g}, {most:g}] m" in said
    assert (pulses / "closed" / "design.png").stat().st_size > 5000


@pytest.mark.long
def test_another_limit_of_the_same_runs_computes_only_new_values(pulses, capsys):
    assert design(pulses, "again", "--steps", "8") == 0
    before = {path.name for path in (pulses / "again" / "analyses").iterdir()}
    assert design(pulses, "again", "--steps", "8", limit="P(tilt > 1e-9 rad) < 50 %") == 0
    assert {path.name for path in (pulses / "again" / "analyses").iterdir()} == before
    assert design(pulses, "again", "--steps", "8", limit="P(overturn) < 0.05") == 0


@pytest.mark.long
def test_largest_value_where_the_limit_holds_at_small_ones(pulses, capsys):
    vary = ("motion.scale", "0.1:2.1")
    assert design(pulses, "scale", "--steps", "16", vary=vary) == 0
    found = json.loads((pulses / "scale" / "design.json").read_text())
    grid = np.linspace(0.1, 2.1, 17)
    kept = [(scale * AMPLITUDES > G * 0.25).sum() / AMPLITUDES.size < 0.5 for scale in grid]
    assert found["size"] == pytest.approx(max(grid[kept]), rel=1e-5)
    assert found["interval"][0] <= found["size"] <= found["interval"][1]
    assert "of at most" in capsys.readouterr().out


@pytest.mark.long
def test_range_that_holds_no_size_is_said(pulses, capsys):
    assert design(pulses, "wide", "--steps", "4", vary=("block.width_m", "1.5:2")) == 0
    assert "kept at both ends" in capsys.readouterr().out


@pytest.mark.long
def test_what_was_killed_goes_on_to_the_same_answer(pulses):
    command = [
        *(sys.executable, "-m", "fecolumn.cli", "design", str(pulses / "block.toml"), "--vary"),
        *("block.width_m", "0.1:1.1", "--limit", "P(tilt > 1e-9 rad) < 0.5", "-j", "1"),
        *("--motions", f"{pulses / 'p.h5'}#*", "-o", str(pulses / "killed"), "--steps", "16"),
    ]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
        for line in run.stderr:
            if "beyond" in line:
                os.kill(run.pid, signal.SIGKILL)
                break
    assert not (pulses / "killed" / "design.json").exists()
    assert subprocess.run(command, capture_output=True).returncode == 0
    assert design(pulses, "whole", "--steps", "16") == 0
    answers = [(pulses / name / "design.csv").read_bytes() for name in ("killed", "whole")]
    assert answers[0] == answers[1]


@pytest.mark.long
def test_of_two_values_neither_is_looked_at_twice(pulses, capsys):
    assert grid_of(2, 3, int, 64) == [2, 3] and grid_of(0.5, 0.500001, float, 8) == [0.5, 0.500001]
    assert design(pulses, "two", "--steps", "8", vary=("block.width_m", "0.5:0.500001")) == 0
    told = capsys.readouterr().err
    assert told.count("beyond tilt") == 2 and told.count("= 0.500001 m: ") == 1


@pytest.mark.long
def test_folder_of_another_question_is_refused(pulses, capsys):
    assert design(pulses, "taken", "--steps", "2") == 0
    capsys.readouterr()
    assert design(pulses, "taken", "--steps", "4") == 2
    told = capsys.readouterr().err
    assert "holds another study" in told and told.count("\n") == 1


@pytest.mark.long
def test_motions_that_tell_nothing_of_the_size_are_said_to(pulses, capsys):
    """Of six motions two more or less are chance."""
    motions = ("--motions", f"{pulses / 'p.h5'}#17-22")
    vary = ("block.width_m", "0.55:0.63")
    assert design(pulses, "few", "--steps", "4", *motions, vary=vary) == 0
    said = capsys.readouterr().out
    assert "every value of the range may be the size" in said


def bisected(k, n, share):
    """The place and its interval from counts at every place of a grid."""
    values = GradedValues(len(k), {})
    while wanted := values.wanted():
        for place in wanted:
            values.grades[place] = grade(k[place], n, share)
    return values, crossing_place(values)


def test_interval_of_the_place_holds_the_true_one_as_often_as_it_says():
    """Critical sizes of motions are uniform: the share beyond the limit at x is 1 - x."""
    rng, grid, share, n, inside = np.random.default_rng(1), np.linspace(0, 1, 65), 0.3, 60, 0
    for _ in range(400):
        critical = rng.random(n)
        _, found = bisected([(critical > x).sum() for x in grid], n, share)
        least = -1.0 if found.least is None else grid[found.least]
        most = 2.0 if found.most is None else grid[found.most]
        inside += least <= 1 - share <= most
    assert inside >= binom.ppf(0.001, 400, 0.95)  # ends are on the safe side by a step of the grid
    assert inside < 400


def test_bisection_looks_at_few_values_and_keeps_its_brackets():
    k = [max(0, 40 - place) for place in range(65)]
    values, found = bisected(k, 60, 0.3)
    assert len(values.grades) < 20
    assert (k[found.broken], k[found.kept]) == (18, 17)
    assert values.grades[found.least] == SURELY_BROKEN and values.grades[found.most] == SURELY_KEPT
    falling, other = bisected(k[::-1], 60, 0.3)
    assert not falling.rising and falling.grades[other.kept] == KEPT
    assert (64 - other.most, 64 - other.least) == (found.least, found.most)


def test_runs_needed_are_the_least_that_tell():
    for share in (0.3, 0.1, 0.02):
        n = runs_needed(share)
        assert proportion_interval(0, n)[1] < share <= proportion_interval(0, n - 1)[1]


@pytest.mark.parametrize(
    "text, threshold, part",
    [
        ("top > 50 mm", 0.05, ""),
        ("tilt > 2 deg", np.pi / 90, ""),
        ("tension[tendon] > 20 kN", 2e4, "tendon"),
        ("residual_slide > 1cm".replace("1cm", "1 cm"), 0.01, ""),
    ],
)
def test_events_have_thresholds_in_si(text, threshold, part):
    event = read_event(text, "fecolumn design")
    assert event.threshold == pytest.approx(threshold) and event.part == part


def test_what_is_lost_is_beyond_every_limit():
    summary = {
        "overturned": True,
        "slid_off": False,
        "u_max_m": 0.001,
        "engine": "rigid",
        "interfaces": {"foot: a on ground": {"slide_max_m": 0.004}},
    }
    assert read_event("top > 5 mm", "").happened(summary)
    assert read_event("lost", "").happened(summary)
    summary["overturned"] = False
    assert not read_event("top > 5 mm", "").happened(summary)
    assert read_event("slide[foot] > 3 mm", "").happened(summary)
    assert not read_event("slide > 5 mm", "").happened(summary)
    with pytest.raises(InputError, match=r"no slide\[head\].*foot: a on ground"):
        read_event("slide[head] > 3 mm", "").happened(summary)


@pytest.mark.parametrize(
    "limit, said",
    [
        ("P(overturn) < 1.5", "between 0 and 1"),
        ("P(overturn) < -0.1", "between 0 and 1"),
        ("P(overturn) < nan", "between 0 and 1"),
        ("overturn", 'must be "P(EVENT) < SHARE"'),
        ("P(overtun) < 0.1", "did you mean overturn"),
        ("P(top > 50 kg) < 0.1", "'kg' is no unit of top; must be one of m, cm, mm"),
        ("P(top > 50) < 0.1", "top has no unit here"),
        ("P(top > -5 mm) < 0.1", "must be a number greater than 0 [mm]"),
        ("P(top > 1_0 mm) < 0.1", "must be a number greater than 0 [mm]"),
        ("P(slide > 2 mm) < 0.1", "rocking models have no joints"),
        ("P(overturn) < 0,1", "'0,1' needs a decimal point: 0.1"),
        ("P(top > 2,5 mm) < 0.1", "'2,5' needs a decimal point: 2.5"),
    ],
)
def test_limit_that_cannot_be_used_is_refused_in_a_line(limit, said):
    with pytest.raises(InputError) as error:
        read_limit(limit, "fecolumn design", "housner")
    assert said in str(error.value) and "\n" not in str(error.value)
    assert "--limit" in str(error.value)


@pytest.mark.parametrize(
    "change, said",
    [
        ({"--vary": ("block.widht_m", "0.3:0.9")}, "did you mean block.width_m"),
        ({"--vary": ("block.width_m", "0.9:0.3")}, "did you mean 0.3:0.9?"),
        ({"--vary": ("block.width_m", "0.3:0.3")}, "must be a range LO:HI that rises"),
        ({"--vary": ("block.width_m", "0_1:0_3")}, "must be a range LO:HI of two numbers"),
        ({"--vary": ("block.width_m", "0.3")}, "must be a range LO:HI of two numbers"),
        ({"--vary": ("block.width_m", "0:0.3")}, "--vary block.width_m = 0.0: must be greater"),
        ({"--vary": ("integration.engine", "0.1:0.3")}, "only a number has a range"),
        ({"--vary": ("motion.delay_s", "0.1:0.3")}, "must be no key of the motion"),
        ({"--motions": ("none.h5#*",)}, "none.h5"),
        ({"--motions": ("none.AT2",)}, "none.AT2': no such file"),
        ({"--motions": ("lick:1-3",)}, "must be at least 5 motions, is 3"),
        ({"--motions": ("lick:9-900",)}, "--motions = 'lick:9-900': must be two rising numbers"),
        # the engine is not stated: of a block it is a rocking model
        ({"--limit": ("P(tension > 5 kN) < 0.1",)}, "rocking models have no joints, links"),
        (
            {
                "case": ("rigid.toml",),
                "--vary": ("bodies.post.length_m", "0.2:0.4"),
                "--limit": ("P(tension > 5 kN) < 0.1",),
            },
            "is of links: the case has no [links]",
        ),
        ({"--vary": ("block.width_m", "0.5:0.5000001")}, "must hold two values told apart by six"),
        ({"--vary": ("block.width_m", "-1e-1:0.9")}, "--vary block.width_m = -0.1: must"),
        ({"--steps": ("1",)}, "--steps = 1: must lie in [2, 1024]"),
        ({"-j": ("0",)}, "-j = 0: must be at least 1"),
        ({"case": ("absent.toml",)}, "absent.toml: no such file"),
    ],
)
def test_question_that_cannot_be_asked_is_refused_in_a_line(
    pulses, capsys, monkeypatch, change, said
):
    monkeypatch.chdir(pulses)
    (pulses / "rigid.toml").write_text(RIGID)
    options = {
        "case": (str(pulses / "block.toml"),),
        "--vary": ("block.width_m", "0.3:0.9"),
        "--motions": ("lick:1-10",),
        "--limit": ("P(overturn) < 0.1",),
        "-o": (str(pulses / "refused"),),
        **change,
    }
    words = [word for key, values in options.items() for word in (key, *values) if word != "case"]
    assert main(["design", *words]) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1
    assert not (pulses / "refused").exists()


def test_components_of_the_cases_own_motion_are_not_mixed_into_others(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(
        "block.width_m = 0.3\nblock.height_m = 2.0\n"
        '[motion]\nsource = "x.txt"\nsource_y = "y.txt"\nunits = "g"\nscale = 2.0\n'
    )
    axes = {"block.width_m": [0.3, 0.4], "motion.source": ["lick:1", "lick:2"]}
    plan = asked_plan("sizes", str(case), axes, {})
    for analysis in plan.analyses:
        motion = analysis.case.motion
        assert (motion.source_y, motion.source_z, motion.scale) == ("", "", 2.0)


def test_a_part_is_a_whole_name_or_its_first_words():
    """Of "tendon 12" this is "tendon", not "tendon 1"."""
    links = {f"tendon {number}": {"tension_max_n": 1e3 * number} for number in (1, 2, 12)}
    summary = dict(overturned=False, slid_off=False, engine="rigid", links=links)
    assert read_event("tension[tendon 1] > 5 kN", "").peak(summary) == 1e3
    assert read_event("tension[tendon] > 5 kN", "").peak(summary) == 12e3
    with pytest.raises(InputError, match="there are tendon 1, tendon 2, tendon 12"):
        read_event("tension[ten] > 5 kN", "").peak(summary)


def test_one_copy_of_a_link_may_be_asked_for():
    links = dict(tendon=None, bar=None)
    case = SimpleNamespace(links=links, integration=SimpleNamespace(engine="rigid"))
    for part in ("tendon", "tendon 2", "bar"):
        check_event(read_event(f"tension[{part}] > 5 kN", ""), case, "")
    for part in ("ten", "cable"):
        with pytest.raises(InputError, match="is of links: there are tendon, bar"):
            check_event(read_event(f"tension[{part}] > 5 kN", ""), case, "")
