"""Records as engineers bring them: any header, decimal commas, networks' files, what is odd."""

import importlib.util
import re
import struct
import sys
import types

import numpy as np
import pytest

from fecolumn.case.sections import Motion
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.motions.correction import corrected, end_of
from fecolumn.motions.formats import FORMATS
from fecolumn.motions.load import read_motion, unsampled
from fecolumn.motions.record import GroundMotion

N, DT = 400, 0.01
TIME = DT * np.arange(N)
WAVE = 0.3 * np.sin(2 * np.pi * 2 * TIME) * np.sin(np.pi * TIME / TIME[-1])


def written(folder, text, name="mine.csv"):
    (folder / name).write_text(text)
    return str(folder / name)


def rows(pattern, values=WAVE):
    return "".join(pattern.format(t=t, a=a) for t, a in zip(TIME, values))


COMMA = rows("{t:.2f};{a:.6f}\n").replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        "time_s,acc_g\n" + rows("{t:.2f},{a:.6f}\n"),
        "time_s\tax_g\n" + rows("{t:.2f}\t{a:.6f}\n"),
        "Zeit [s];Beschleunigung [g]\n" + COMMA,
        "Station Lick, Santa Cruz\nt;a_g\n" + COMMA,
        rows("{t:.2f}   {a:.6f}\n").replace(".", ","),
        "Elapsed,Channel 1\n" + rows("{t:.2f},{a:.6f}\n"),
        "time [s],signal [g]\n" + rows("{t:.2f},{a:.6f}\n"),
    ],
    ids=["suffixes", "tabs", "German", "title", "spaces and commas", "any", "half known"],
)
def test_any_header_that_leaves_no_choice_is_read(tmp_path, text):
    units = "" if re.search(r"_g|\[g\]", text) else "g"
    found = read_motion(Motion(written(tmp_path, text), units=units), "case.toml")
    assert found.dt == pytest.approx(DT)
    assert found.acceleration[:, 0] / 9.81 == pytest.approx(WAVE, abs=1e-3)


@pytest.mark.parametrize(
    "text, said",
    [
        ("time,velocity\n" + rows("{t:.2f},{a:.6f}\n"), "'velocity' is not known"),
        ("time [s],a [g]\n0.0,1_000\n0.1,0.2\n0.2,0.3\n", "'1_000' is not a number"),
        ("time [s],a [g]\n" + rows("{t:.2f},{a:.6f}\n")[:-4], "cut off"),
        ("good morning\nto all\n", "formats that are read: PEER AT2"),
        ("Lat. 35.1\n1 2 3 4 5 6 7 8\n1 2 3 4 5 6 7 8\n", "formats that are read: PEER AT2"),
    ],
)
def test_what_is_no_record_is_refused_in_words(tmp_path, text, said):
    with pytest.raises(InputError, match=said):
        read_motion(Motion(written(tmp_path, text), units="g"), "case.toml")


def test_an_at2_cut_inside_its_last_number_is_refused(tmp_path):
    head = "PEER\nLICK\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 400, DT= .01 SEC\n"
    whole = head + "".join(f"{a:15.7E}" + "\n" * (k % 5 == 4) for k, a in enumerate(WAVE, 1))
    read_motion(Motion(written(tmp_path, whole, "a.AT2")), "case.toml")
    with pytest.raises(InputError, match="cut off"):
        read_motion(Motion(written(tmp_path, whole.rstrip()[:-1], "b.AT2")), "case.toml")


def test_info_tells_format_peaks_drift_gaps_and_a_unit_that_does_not_fit(tmp_path, capsys):
    drifting = written(tmp_path, "t [s],a [g]\n" + rows("{t:.2f},{a:.6f}\n", WAVE + 0.02))
    assert main(["motions", "info", drifting]) == 0
    said = capsys.readouterr().out
    assert "columns of text" in said and "PGA 0.3" in said and "drifts" in said
    gal = written(tmp_path, "t [s],a\n" + rows("{t:.2f},{a:.6f}\n", 981 * WAVE))
    assert main(["motions", "info", gal]) == 0
    assert "cm/s2 or mm/s2 would make a ground motion" in capsys.readouterr().out
    assert main(["motions", "info", gal, "--units", "g"]) == 2
    assert "its unit may be another" in capsys.readouterr().err
    still = np.where((TIME > 1) & (TIME < 2), 0.0, WAVE)
    gap = written(tmp_path, "t [s],a [g]\n" + rows("{t:.2f},{a:.6f}\n", still), "gap.csv")
    assert main(["motions", "info", gap]) == 0
    assert "a gap: " in capsys.readouterr().out
    assert main(["motions", "convert", gal, "-o", str(tmp_path / "out")]) == 2
    assert "--units = ''" in capsys.readouterr().err


def test_a_peak_that_was_never_recorded_is_warned_of(tmp_path):
    path = written(tmp_path, "t [s],a [g]\n" + rows("{t:.2f},{a:.6f}\n", 30 * WAVE))
    with pytest.warns(UserWarning, match="more than was ever recorded"):
        unsampled(Motion(path), "case.toml")


def test_a_corrected_record_ends_at_rest_and_keeps_its_band():
    time = 0.01 * np.arange(4000)
    pulse = np.sin(2 * np.pi * 2 * time) * np.exp(-(((time - 20) / 4) ** 2))
    drifting = np.zeros((4000, 3))
    drifting[:, 0] = pulse + 0.05 + 0.002 * time
    motion = GroundMotion(drifting, 0.01, "a", "a")
    after = corrected(motion, 0.1, 20.0)
    speed, way = end_of(after)
    assert end_of(motion)[1] > 30 and speed < 1e-3 and way < 0.01
    led = (len(after.acceleration) - 4000) // 2
    # a Butterworth filter run twice leaves 1 - (0.1 / 2)^8 of 2 Hz
    assert after.acceleration[led : led + 4000, 0] == pytest.approx(pulse, abs=0.01)
    assert not after.acceleration[:, 1].any()
    for corners in ((0.0, 60.0), (3.0, 2.0), (0.001, 0.0)):
        with pytest.raises(ValueError):
            corrected(motion, *corners)


def test_correct_writes_a_motion_and_a_picture(tmp_path, capsys):
    path = written(tmp_path, "t [s],a [g]\n" + rows("{t:.2f},{a:.6f}\n", WAVE + 0.02))
    command = ["motions", "correct", path, "-o", str(tmp_path / "out"), "--high-pass", "0.5"]
    assert main(command) == 0
    assert {file.suffix for file in (tmp_path / "out").iterdir()} >= {".csv", ".png", ".pdf"}
    assert main([*command[:-1], "1e9"]) == 2
    assert "--high-pass" in capsys.readouterr().err
    for corner in ("60", "50", "0.1"):
        assert main([*command[:-1], corner]) == 2
        told = capsys.readouterr().err
        assert f"--high-pass = {float(corner)}: must be 0 or at least 0.251 Hz" in told
        assert "below 50 Hz, half of the sampling frequency" in told and told.count("\n") == 1
    assert main([*command, "--low-pass", "50"]) == 2
    assert "--low-pass = 50.0: must be below 50 Hz" in capsys.readouterr().err


def test_help_names_every_format_that_a_refusal_names(tmp_path, capsys):
    with pytest.raises(SystemExit):
        main(["motions", "info", "--help"])
    told = " ".join(capsys.readouterr().out.split())
    assert FORMATS in told
    for name in ("COSMOS", "CSMIP", "SMC", "GeoNet", "AFAD", "AT2", "ESM", "HDF5", "K-NET"):
        assert name in FORMATS
    assert main(["motions", "info", written(tmp_path, "good morning\n")]) == 2
    assert FORMATS in capsys.readouterr().err


KNET = """Origin Time       2024/01/01 16:10:00
Lat.              37.5
Long.             137.3
Depth. (km)       16
Mag.              7.6
Station Code      ISK001
Station Lat.      37.5
Station Long.     137.3
Station Height(m) 5
Record Time       2024/01/01 16:10:15
Sampling Freq(Hz) 100Hz
Duration Time(s)  4
Dir.              E-W
Scale Factor      2000(gal)/8388608
Max. Acc. (gal)   294.3
Last Correction   2024/01/01 16:10:00
Memo.
""" + "".join(
    f"{round(981 * a * 8388608 / 2000) + 5000:9d}" + "\n" * (k % 8 == 0)
    for k, a in enumerate(WAVE, 1)
)


def test_a_file_of_a_network_says_how_to_read_it(tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"is a K-NET .* pip install 'obspy>=1.4,<1.6'"):
        read_motion(Motion(written(tmp_path, KNET, "ISK001.EW")), "case.toml")


def test_k_net_is_read_in_its_unit_without_the_recorders_offset(tmp_path):
    pytest.importorskip("obspy")
    path = written(tmp_path, KNET, "ISK001.EW")
    found = read_motion(Motion(path), "case.toml")
    assert found.acceleration[:, 0] == pytest.approx(9.81 * (WAVE - WAVE.mean()), abs=1e-4)
    cut = written(tmp_path, KNET[:-400], "cut.EW")
    with pytest.raises(InputError, match="cut off"):
        read_motion(Motion(cut), "case.toml")


def test_gaps_and_channels_of_a_network_are_told(tmp_path, monkeypatch):
    class Trace:
        idep = 5  # unknown

        def __init__(self, name, start=0.0, samples=4):
            self.id, self.data = name, np.arange(samples) + round(100 * start)
            self.stats = types.SimpleNamespace(
                delta=0.01,
                npts=samples,
                channel=name,
                calib=1.0,
                starttime=types.SimpleNamespace(timestamp=1e9 + start),
                sac=dict(idep=self.idep),
            )

    def reading(*names, path=None, **own):
        traces = [Trace(name) for name in names]
        traces += [Trace(name, *values) for name, values in own.items()]
        obspy = types.SimpleNamespace(read=lambda path, format: traces)
        monkeypatch.setitem(sys.modules, "obspy", obspy)
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: obspy)
        return read_motion(Motion(path or mseed, units="m/s2"), "case.toml")

    mseed = written(tmp_path, "000001D " + "x" * 100, "a.mseed")
    assert reading("HNN", "HNE").acceleration[1] == pytest.approx([1, 1, 0])
    # samples are their own time in hundredths of a second
    found = reading(HNE=(0.0, 400), HNN=(0.02, 398)).acceleration
    assert found[:, 0] == pytest.approx(found[:, 1]) and len(found) == 398 and found[0, 0] == 2
    for late in ((0.1, 390), (0.0, 390), (5.0, 400)):
        with pytest.raises(InputError, match=r"different times \(HNE from 0 to 4 s, HNN from"):
            reading(HNE=(0.0, 400), HNN=late)
    with pytest.raises(InputError, match="second letter H of a channel stands for a velocity"):
        reading("HHN", "HHE")
    # what the head of SAC says has the last word
    sac = tmp_path / "a.sac"
    sac.write_bytes(bytes(304) + struct.pack("<i", 6) + bytes(324))
    for idep, refused in ((8, ""), (7, "its head says velocity"), (5, "second letter H")):
        monkeypatch.setattr(Trace, "idep", idep)
        if refused:
            with pytest.raises(InputError, match=refused):
                reading("HHN", "HHE", path=str(sac))
        else:
            assert len(reading("HHN", "HHE", path=str(sac)).acceleration) == 4
    with pytest.raises(InputError, match="gaps: 2 pieces of HNE"):
        reading("HNE", "HNE")
    with pytest.raises(InputError, match="must end in E, N and Z"):
        reading("HN1", "HN2")


@pytest.mark.filterwarnings("ignore")
def test_mutants_of_records_are_refused_or_near_the_record(tmp_path):
    """Cut anywhere, and characters changed: no traceback, no spike out of a cut number."""
    at2 = "PEER\nLICK\nACCELERATION IN UNITS OF G\nNPTS= 400, DT= .01 SEC\n" + "".join(
        f"{a:15.7E}" + "\n" * (k % 5 == 0) for k, a in enumerate(WAVE, 1)
    )
    csv = "time [s],ax [g]\n" + rows("{t:.2f},{a:.6f}\n")
    random = np.random.default_rng(36)
    for name, whole in (("a.AT2", at2), ("a.csv", csv), ("b.csv", "t [s];a [g]\n" + COMMA)):
        for _ in range(80):
            start = int(random.integers(len(whole)))
            is_cut = random.random() < 0.5
            other = whole[:start]
            if not is_cut:
                other += chr(int(random.integers(33, 127))) + whole[start + 1 :]
            try:
                found = read_motion(Motion(written(tmp_path, other, name)), "case.toml")
            except InputError as error:
                assert "\n" not in str(error)
                continue
            assert np.isfinite(found.acceleration).all()
            if is_cut and len(found.acceleration) > 20:
                assert found.pga[0] < 9.81 * 0.31


@pytest.mark.parametrize("cut", range(1, 18))
def test_a_file_of_numbers_of_any_length_cut_in_its_last_one_ends_in_no_spike(tmp_path, cut):
    """As Python and C write them: 9.1234e-08 becomes 9.1234e-0, or 9.1."""
    values = [float(0.3 * (1 - k / 200) * np.sin(0.05 * k)) for k in range(200)]
    values.append(9.123456789012345e-08)
    whole = "time [s],ax [m/s2]\n" + "\n".join(
        f"{0.01 * k:.2f},{a!r}" for k, a in enumerate(values)
    )
    motion = Motion(written(tmp_path, whole[:-cut], "a.csv"))
    try:
        found = read_motion(motion, "case.toml")
    except InputError as error:
        assert "cut off inside its last number" in str(error) or "is not a number" in str(error)
    else:
        assert found.pga[0] < 0.31
