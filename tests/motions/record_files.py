"""Small record files in the dialects met in the wild."""

from hashlib import sha256
from pathlib import Path

import numpy as np

ACCELERATION = np.array([0.001, -0.002, 0.25, -0.1234, 0.03, 0.004, -1.0, 0.5])


def write_at2(
    path: Path,
    values=ACCELERATION,
    *,
    dt=0.01,
    points=None,
    npts_line=None,
    units="ACCELERATION TIME SERIES IN UNITS OF G",
    end="\n",
) -> Path:
    """AT2 file as PEER writes it: no digit before the point, five values a row."""
    words = [_fortran(value) for value in values]
    rows = [" ".join(words[i : i + 5]) for i in range(0, len(words), 5)]
    line = npts_line or f"NPTS={points or len(values):7d}, DT= {dt:.4f} SEC"
    header = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        "Somewhere, 1/2/1990, Station 1, 90",
        units,
        line,
    ]
    path.write_bytes((end.join(header + rows) + end).encode("latin-1"))
    return path


def _fortran(value: float) -> str:
    """Mantissa below 1 without its zero: -.1234000E+00."""
    exponent = int(np.floor(np.log10(abs(value)))) + 1 if value else 0
    return f"{value / 10.0**exponent:.7f}".replace("0.", ".", 1) + f"E{exponent:+03d}"


def write_text(path: Path, text: str) -> Path:
    path.write_bytes(text.encode())
    return path


def motion_hash(motion):
    """SHA-256 of samples and step; name and source do not count."""
    return sha256(np.float64(motion.dt).tobytes() + motion.acceleration.tobytes()).hexdigest()
