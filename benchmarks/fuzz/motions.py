"""Motion files of all formats."""

from __future__ import annotations

import numpy as np

from benchmarks.fuzz.damage import BYTES
from benchmarks.fuzz.network_files import all_files
from fecolumn.case.sections import Motion
from fecolumn.motions.load import load_motion

_N, _DT = 120, 0.01
# Ends of the names of networks' files
_NETWORKS = [name[2:] for name in all_files()]
_WORDS = [
    b"1e12",
    b"-1e12",
    b"1e300",
    b"1e-300",
    b"1e400",
    b"nan",
    b"inf",
    b"9" * 15,
    b"9" * 400,
    b"9" * 5000,
    b"0",
    b"-1",
    b"1e6",
    b"",
    b"****",
    b"1_0",
    b"0x1",
    b"NPTS= 999999999999999",
    b"DT= 1e-30 SEC",
    b"DT= 1e30",
    b"UNITS: parsecs",
    b"time [years]",
    b"\x00",
    b"\xff\xfe",
    b"1,2,3,4",
    b"#",
]


def prepare(folder) -> None:
    """The same motion in every format."""
    values = np.sin(np.arange(_N) * 0.7) * np.exp(-np.arange(_N) / 60)
    words = [f"{value:15.7E}" for value in values]
    at2 = [
        "PEER",
        "station",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {_N}, DT= {_DT} SEC",
    ]
    (folder / "a.AT2").write_text(
        "\n".join(at2 + ["".join(words[i : i + 5]) for i in range(0, _N, 5)]) + "\n"
    )
    (folder / "a.csv").write_text(
        "time [s], ax [g], ay [g]\n"
        + "".join(f"{_DT * i:.2f}, {v:.6e}, {-v:.6e}\n" for i, v in enumerate(values))
    )
    (folder / "a.txt").write_text("".join(f"{_DT * i:.2f} {v:.6e}\n" for i, v in enumerate(values)))
    for name, text in all_files().items():
        (folder / name).write_text(text)
    (folder / "a.asc").write_text(
        f"EVENT_NAME: x\nSAMPLING_INTERVAL_S: {_DT}\nNDATA: {_N}\nUNITS: "
        "cm/s^2\nDATA_TYPE: ACCELERATION\n" + "".join(f"{v:.6e}\n" for v in values)
    )


def sound(folder):
    """One file as it is."""
    return Motion(str(folder / "a.AT2")), 0.005


def mutate(rng, folder):
    """One of the files changed, and keys that go with it or against it."""
    path = folder / f"a.{rng.choice(['AT2', 'csv', 'txt', 'asc', *_NETWORKS])}"
    data = path.read_bytes()
    for _ in range(int(rng.integers(1, 4))):
        data = _changed(rng, data)
    path.write_bytes(data)
    stated = path.name[2:] in _NETWORKS  # at another step than the others
    units, dt = "g" if path.suffix == ".txt" else "", 0.01
    keys = dict(
        rotation_deg=float(rng.choice([0.0, 30.0])),
        vertical=bool(rng.random() < 0.5),
        dt_s=0.0 if stated else float(rng.choice([0.0, _DT])),
        strong_part=(0.0, 1.0) if rng.random() < 0.5 else (0.01, 0.99),
        delay_s=float(rng.choice([0.0, 0.013])),
    )
    if rng.random() < 0.3:
        units, dt = (
            str(rng.choice(["", "g", "cm/s2"])),
            float(rng.choice([0.02, 1e-3, 1e-4, 0.1, 1e-9])),
        )
        keys |= dict(
            dt_s=float(rng.choice([0.0, 1e-3, 10.0])),
            scale=float(rng.choice([1e3, 0.0])),
            time_scale=float(rng.choice([0.5, 1e-3, 1e3])),
            delay_s=float(rng.choice([0.0, 1e3])),
        )
    return Motion(str(path), units=units, **keys), dt


def _changed(rng, data: bytes) -> bytes:
    if rng.random() < 0.5:
        return BYTES[int(rng.integers(len(BYTES)))](rng, data)
    lines = data.split(b"\n")
    place = int(rng.integers(len(lines)))
    if rng.random() < 0.2:  # a time column that is shifted, or has a gap
        shift = float(rng.choice([1e12, -1e12, 1e9, 1e300, 1e-12, 5.0]))
        return b"\n".join(
            _shifted(line, shift) if i >= place else line for i, line in enumerate(lines)
        )
    words = lines[place].split() or [b""]
    words[int(rng.integers(len(words)))] = _WORDS[int(rng.integers(len(_WORDS)))]
    lines[place] = b" ".join(words)
    return b"\n".join(lines)


def _shifted(line: bytes, shift: float) -> bytes:
    first, mark, rest = line.partition(b", " if b"," in line else b" ")
    try:
        return f"{float(first) + shift!r}".encode() + mark + rest
    except ValueError:
        return line


def use(mutant) -> None:
    """What an analysis does with its motion."""
    motion, dt = mutant
    ground = load_motion(motion, dt, "case.toml")
    assert np.isfinite(ground.acceleration).all() and ground.dt == dt
