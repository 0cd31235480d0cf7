"""The shake-table benchmark on a small campaign of its own: a box whose outcomes theory tells."""

import csv
import json
import zipfile

import numpy as np
import pytest

from benchmarks.shake_table.__main__ import chosen, main
from benchmarks.shake_table.campaign import (
    BAND_HZ,
    METRES,
    SAMPLING_HZ,
    TableView,
    channels,
    filtered,
    read_campaign,
    table_motion,
)
from benchmarks.shake_table.probability import brier, reliability, told_by
from benchmarks.shake_table.rock import Stone, at_rest, body_of, read_scan, solid
from benchmarks.shake_table.scores import chance, confusion, pairs
from benchmarks.shake_table.uncertain import BOUNDS, settings
from fecolumn.case.sections import GRAVITY

LENGTH, WIDTH, HEIGHT = 0.16, 0.4, 0.8
SLENDERNESS = LENGTH / HEIGHT  # tan(alpha) about the edges of the shaken direction
FREQUENCY = np.sqrt(0.75 * GRAVITY / (np.hypot(LENGTH, HEIGHT) / 2))  # p of a rectangle
# Half a sine overturns above sqrt(1 + (w/p)^2) g tan(alpha) (Housner 1963, linear): 0.5 Hz 1.2, 10
# Hz 15. Below g tan(alpha) nothing uplifts.
PULSES = {1: (0.9, 0.5), 2: (2.5, 0.5), 3: (2.5, 10.0)}
OVERTURNS = {1: False, 2: True, 3: False}
MISSING = 4


def box_file(path, turn=((1, 0, 0), (0, 1, 0), (0, 0, 1))):
    """A closed .obj of the box, far from the origin as scans are, wound inside out as the
    campaign's is.
    """
    corners = np.array(
        [(x, y, z) for x in (0, LENGTH) for y in (0, WIDTH) for z in (0, HEIGHT)]
    ) @ np.transpose(turn) + [100.0, 50.0, 300.0]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [(a, b, c) for p, q, r, s in quads for a, b, c in ((p, r, q), (p, s, r))]
    lines = ["v {:.9f} {:.9f} {:.9f}".format(*corner) for corner in corners] + [
        "f {} {} {}".format(*(i + 1 for i in triangle)) for triangle in triangles
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")
    return path


def workbook(path, rows):
    """An .xlsx of one sheet; texts are shared strings as Excel writes them."""
    texts, lines = [], []
    for r, row in enumerate(rows, 1):
        cells = ""
        for column, value in zip("ABCDEF", row):
            if isinstance(value, str):
                texts.append(value)
                cells += f'<c r="{column}{r}" t="s"><v>{len(texts) - 1}</v></c>'
            else:
                cells += f'<c r="{column}{r}"><v>{value}</v></c>'
        lines.append(f'<row r="{r}">{cells}</row>')
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    with zipfile.ZipFile(path, "w") as book:
        book.writestr(
            "xl/worksheets/sheet1.xml",
            f"<worksheet {space}><sheetData>{''.join(lines)}</sheetData></worksheet>",
        )
        book.writestr(
            "xl/sharedStrings.xml",
            f"<sst {space}>{''.join(f'<si><t>{text}</t></si>' for text in texts)}</sst>",
        )


def table_file(path, times, frequency):
    """A file of the table: half a sine of acceleration and its opposite, so that the velocity ends
    at 0; the accelerometer points the other way.
    """
    time = np.arange(0, 5, 1 / SAMPLING_HZ)
    phase = frequency * (time - 1.0)
    acceleration = (
        times * SLENDERNESS * np.where((phase > 0) & (phase < 1), np.sin(2 * np.pi * phase), 0.0)
    )
    other = np.zeros_like(time)
    moved = np.cumsum(np.cumsum(acceleration)) * GRAVITY / SAMPLING_HZ**2 / METRES
    rows = np.column_stack([time, 0.015 - acceleration, time, other, time, moved, time, other])
    np.savetxt(
        path,
        rows,
        fmt="%.6g",
        delimiter="\t",
        header="Time [s] - Plot 0\tAmplitude - Plot 0",
        comments="",
    )


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of a repository of four tests, the last without its motion; one of the measured
    outcomes is not what theory says.
    """
    root = tmp_path_factory.mktemp("campaign")
    motions = root / "data" / "Shake_Table_Response"
    box_file(root / "data" / "SP1_PBRmodel" / "SP1.obj")
    motions.mkdir()
    heads = [
        "Test Number",
        "Experimental Results for response-Specimen 1",
        "Specimen 1-Numerical KN=1 KS=1",
    ]
    workbook(
        motions / "Results_Granite.xlsx", [heads, [1, 0, 1], [2, 1, 1], [3, 1, 0], [MISSING, 0, 0]]
    )
    intensities = [
        [n, n, PULSES.get(n, (1, 1))[0] * SLENDERNESS, 1 / (2 * np.pi * PULSES.get(n, (1, 1))[1])]
        for n in (1, 2, 3, MISSING)
    ]
    workbook(
        motions / "PGVA-zchen.xlsx", [["Serial Number", "Test Number", "PGA", "PGVA"], *intensities]
    )
    for n, pulse in PULSES.items():
        table_file(motions / f"Test{n:03d}.txt", *pulse)
    return root


def test_box_overturns_where_theory_says_and_the_benchmark_scores_it(copy, tmp_path, capsys):
    main([str(copy), "-o", str(tmp_path), "-j", "1", "--mu", "1.0"])
    rows = {int(row["test"]): row for row in csv.DictReader((tmp_path / "tests.csv").open())}
    assert {n: row["computed"] == "1" for n, row in rows.items()} == OVERTURNS
    # the third rocks, the first does not
    assert float(rows[1]["peak_tilt_deg"]) < 0.01 and float(rows[3]["peak_tilt_deg"]) > 0.05
    assert all(float(row["closure_rel"]) < 1e-6 for row in rows.values())
    said = capsys.readouterr()
    assert "1 of 4 tests have no file" in said.err
    # the measured outcome of the third is not theory's
    assert (
        "| fecolumn | 0.667 | " in said.out
        and "3 tests" in said.out
        and "| 1 | 1 | 0 | 1 |" in said.out
    )
    assert (tmp_path / "outcomes.png").stat().st_size > 10_000

    kept = tmp_path / "tests" / "002.json"
    marked = json.loads(kept.read_text()) | {"peak_tilt_deg": 77.0}
    kept.write_text(json.dumps(marked))
    (tmp_path / "tests" / "001.json").unlink()
    # what is done is kept, what is missing is done
    main([str(copy), "-o", str(tmp_path), "-j", "1", "--mu", "1.0"])
    again = {int(row["test"]): row for row in csv.DictReader((tmp_path / "tests.csv").open())}
    assert (
        again[2]["peak_tilt_deg"] == "77.0"
        and again[1]["peak_tilt_deg"] == rows[1]["peak_tilt_deg"]
    )
    with pytest.raises(SystemExit, match="holds results with friction 1.0"):
        main([str(copy), "-o", str(tmp_path), "-j", "1", "--mu", "0.5"])


def test_missing_and_broken_files_are_named(copy, tmp_path):
    with pytest.raises(SystemExit, match="Shake_Table_Response: missing; PATH must be a copy"):
        main([str(tmp_path), "-o", str(tmp_path / "out")])
    with pytest.raises(SystemExit, match="--tests 900: none of them has a motion here"):
        main([str(copy), "-o", str(tmp_path / "out"), "--tests", "900"])
    short = tmp_path / "Test001.txt"
    short.write_text("names\n0 1 2\n")
    with pytest.raises(ValueError, match="Test001.txt: 3 columns, must be 8"):
        channels(short)
    table_file(short, 1.0, 1.0)
    np.savetxt(short, np.loadtxt(short, skiprows=1)[::2], header="names", comments="")
    with pytest.raises(ValueError, match="0.0025 s a sample, must be 0.00125 s"):
        channels(short)


def test_table_motion_has_the_sign_of_the_displacement_and_no_offset(copy):
    motion = table_motion(read_campaign(copy).motions / "Test003.txt")
    peak = 2.5 * SLENDERNESS * GRAVITY
    assert motion[:600].std() < 0.02 * peak and abs(motion.mean()) < 1e-3 * peak
    assert motion[int(1.025 * SAMPLING_HZ)] > 0.8 * peak > 0 > motion[int(1.075 * SAMPLING_HZ)]
    time = np.arange(0, 100, 1 / SAMPLING_HZ)
    middle = slice(len(time) // 3, -len(time) // 3)  # its ends ring at 0.1 Hz
    inside, outside = (
        np.abs(filtered(np.sin(2 * np.pi * f * time))[middle]).max() for f in (2.0, 4 * BAND_HZ[1])
    )
    assert inside == pytest.approx(1, abs=0.001) and outside < 0.001
    assert METRES == pytest.approx(1.519e-5, rel=1e-3)


def test_scan_of_a_box_has_its_mass_and_inertia_and_stands_on_its_foot(tmp_path):
    from scipy.spatial.transform import Rotation

    lean = Rotation.from_euler("yx", [3, -2], degrees=True).as_matrix()
    scan = box_file(tmp_path / "box.obj", lean)
    volume, center, _ = solid(*read_scan(scan))
    assert volume == pytest.approx(LENGTH * WIDTH * HEIGHT, rel=1e-6)
    body = body_of(scan, Stone(density=2700.0))
    square = LENGTH**2 + WIDTH**2
    assert body.mass == pytest.approx(2700 * volume)
    assert np.sort(np.linalg.eigvalsh(body.inertia)) == pytest.approx(
        body.mass / 12 * np.sort([square, LENGTH**2 + HEIGHT**2, WIDTH**2 + HEIGHT**2]), rel=1e-5
    )
    assert len(body.arms) == 4 and body.center[2] == pytest.approx(HEIGHT / 2, rel=1e-6)
    assert body.arms[:, 2] == pytest.approx(-HEIGHT / 2, rel=1e-5)
    from scipy.spatial import ConvexHull

    assert at_rest(*(lambda c: (c, center, ConvexHull(c).equations))(read_scan(scan)[0]))[
        1
    ] == pytest.approx(np.arccos(lean[2, 2]), rel=1e-5)
    # the table pushes along the scan's y
    turned = body_of(scan, Stone(density=2700.0, direction=np.pi / 2))
    assert turned.inertia[0, 0] == pytest.approx(body.inertia[1, 1], rel=1e-3)
    assert Stone(mass=100.0).mass == body_of(scan, Stone(mass=100.0)).mass


def test_scan_that_is_not_closed_is_refused(tmp_path):
    scan = box_file(tmp_path / "box.obj")
    scan.write_text("\n".join(scan.read_text().splitlines()[:-1]))
    with pytest.raises(ValueError, match="not closed, 3 of its edges"):
        read_scan(scan)


def test_scores_count_what_was_told():
    counts = confusion([1, 1, 0, 0, 0], [1, 0, 1, 0, 0])
    assert (counts.hit, counts.missed, counts.false, counts.stood) == (
        1,
        1,
        1,
        2,
    ) and counts.accuracy == 0.6
    told, right = [0] * 6, [1] * 6
    assert (
        chance(right, told, right) == pytest.approx(2 / 2**6) and chance(right, right, right) == 1
    )
    assert chosen("3,5-7", [1, 5, 6, 9]) == {5, 6}
    lines = pairs("ours", right, told, {"theirs": right, "others": told}).splitlines()
    assert lines[2:] == ["| theirs | 1.000 | 0 | 6 | 0.031 |", "| others | 0.000 | 0 | 0 | 1 |"]


def test_displacement_tells_the_same_long_period_motion_as_the_accelerometer(copy):
    """The table of the made campaign has no faults: both sensors say the same below a crossover."""
    file = read_campaign(copy).motions / "Test002.txt"
    alone, both = table_motion(file), table_motion(file, TableView(crossover=1.0))
    # the filters ring at the ends of so short a file
    off = np.abs(both - alone)[800:-800].max() / np.abs(alone).max()
    assert 0 < off < 0.04
    time = np.arange(0, 100, 1 / SAMPLING_HZ)
    middle = slice(len(time) // 3, -len(time) // 3)
    sharp = np.sin(2 * np.pi * 2 * BAND_HZ[1] * time)
    kept, lost = (np.abs(filtered(sharp, upper)[middle]).max() for upper in (100.0, BAND_HZ[1]))
    assert kept > 0.95 and lost < 0.05


def test_rounded_edges_move_the_pivot_inwards_and_leave_the_mass(tmp_path):
    scan = box_file(tmp_path / "box.obj")
    sharp, round_ = body_of(scan, Stone()), body_of(scan, Stone(rounding=0.005))
    foot = round_.arms[np.isclose(round_.arms[:, 2], -HEIGHT / 2, atol=1e-6)]
    assert len(foot) == 4
    assert np.abs(foot[:, 0]) == pytest.approx(LENGTH / 2 - 0.005, rel=1e-5)
    assert round_.mass == sharp.mass and round_.inertia == pytest.approx(sharp.inertia)
    with pytest.raises(ValueError, match="is too large for the scan"):
        body_of(scan, Stone(rounding=1.0))


def test_draws_lie_within_their_bounds_and_are_the_same_for_a_seed():
    drawn = settings(Stone(mass=300.0), 16, 1)
    for name in ("friction", "restitution", "youngs", "softer", "rounding"):
        low, high, _ = BOUNDS[name]
        values = [getattr(one.stone, name) for one in drawn]
        assert low <= min(values) < low + (high - low) / 3 and max(values) <= high
    assert all(one.stone.mass == 300.0 for one in drawn) and drawn == settings(
        Stone(mass=300.0), 16, 1
    )


def test_brier_and_reliability_count_what_was_told():
    measured, told = [1, 1, 0, 0], [1.0, 0.5, 0.5, 0.0]
    score = brier(measured, told)
    assert score.score == pytest.approx(0.125) and score.skill == pytest.approx(0.5)
    classes = reliability(measured, told)
    assert [(one.n, one.told, one.share) for one in classes] == [
        (1, 0, 0),
        (2, 0.5, 0.5),
        (1, 1, 1),
    ]
    row = dict(pga_g=0.1, pgv_pga_s=0.1, measured=1, failed="")
    draws = {
        0: [row | dict(test=3, computed=1)],
        1: [row | dict(test=3, computed=0), row | dict(test=4, computed=None, failed="step")],
    }
    assert [(one["test"], one["draws"], one["probability"]) for one in told_by(draws)] == [
        (3, 2, 0.5)
    ]


def test_an_ensemble_of_draws_tells_probabilities_and_goes_on(copy, tmp_path, capsys):
    command = [str(copy), "-o", str(tmp_path), "-j", "1", "--draws", "2", "--tests", "1,2"]
    main(command)
    rows = {int(row["test"]): row for row in csv.DictReader((tmp_path / "tests.csv").open())}
    # no draw of the rest moves these two: far below uplift, far above what overturns
    assert {n: float(row["probability"]) for n, row in rows.items()} == {1: 0.0, 2: 1.0}
    assert "| share of 2 draws | 2 | 0.000 | 1.000 |" in capsys.readouterr().out
    assert (tmp_path / "reliability.png").stat().st_size > 10_000
    kept = tmp_path / "draws" / "001" / "002.json"
    kept.write_text(json.dumps(json.loads(kept.read_text()) | {"computed": 0}))
    main(command)
    assert "| 0.4 to 0.6 | 1 |" in capsys.readouterr().out
    kept.unlink()  # as if it had been stopped
    main([*command, "--report"])
    assert "| share of 1 to 2 draws | 2 |" in capsys.readouterr().out
    with pytest.raises(SystemExit, match="holds results with draws 2"):
        main([*command[:-4], "--draws", "3", "--tests", "1,2"])
