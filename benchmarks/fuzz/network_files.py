"""Files of strong-motion networks, written by the rules of their formats."""

from __future__ import annotations

import numpy as np

N, DT = 203, 0.02
_T = DT * np.arange(N)
#: East, north and up [cm/s2], rounded to what every format holds.
EAST, NORTH, UP = (
    np.round(peak * np.sin(2 * np.pi * f * _T) * np.exp(-_T), 4)
    for peak, f in ((80.0, 1.3), (-55.0, 0.9), (20.0, 2.1))
)


def rows(values, many, pattern):
    """Lines of `many` numbers."""
    words = [format(value, pattern) for value in values]
    return ["".join(words[i : i + many]) for i in range(0, len(words), many)]


def cosmos(channels, *, unit=4, parameter=1, first="Corrected acceleration", end=True):
    """COSMOS file of (azimuth, values [unit]) channels, Format v01.20."""
    lines = []
    for azimuth, values in channels:
        integers = np.full(100, -999)
        integers[[0, 1, 2, 53]] = 2, parameter, unit, azimuth
        reals = np.full(100, -999.0)
        reals[[61, 62, 63]] = 1000 * DT, DT * len(values), values[np.abs(values).argmax()]
        lines += [f"{first}    (Format v01.20 with 13 text lines) Src: own"]
        lines += [f"text {i}" for i in range(2, 13)]
        lines[-8] = "Statn No: 05- 13921 Code:CE-13921  CGS  Riverside"
        lines += ["Values used when parameter or data value is unknown/unspecified:   -999, -999.0"]
        lines += [" 100 Integer-header values follow on  10 lines, Format= (10I8)"]
        lines += rows(integers, 10, "8d")
        lines += [" 100 Real-header values follow on  20 lines, Format= (5F15.6)"]
        lines += rows(reals, 5, "15.6f")
        lines += ['   2 Comment line(s) follow, each starting with a "|":', "| one", "| two"]
        lines += [
            f"{len(values):8d} acceleration pts, approx 4 secs, units=cm/sec2(04),Format=(8F10.4)"
        ]
        lines += rows(values, 8, "10.4f")
        lines += ["End-of-data for chan  1 acceleration"] * end
    return "\n".join(lines) + "\n"


def csmip(channels, *, points="accel", unit="cm/sec2."):
    """CSMIP V2 of (direction, values) channels, with velocities and displacements."""
    lines = []
    for number, (direction, values) in enumerate(channels, 1):
        peak = values[np.abs(values).argmax()]
        lines += [
            f"Corrected accelerogram   15481673.CI.WLT.--.HN   Chan  {number}: {direction}   from",
            "Uncorrected Accelerogram Data             Processed: 04/30/14, CGS  ciwlt1",
            *[f"text {i}" for i in range(3, 6)],
            "Station Id. WLT     34.009N, 117.951W            s/n 4310",
            "Hacienda Heights                         SCSN   Data: Acceleration",
            f"Chan  {number}: {direction}",
            *[f"text {i}" for i in range(9, 18)],
            f"Peak acceleration = {peak:9.4f}    cm/sec/sec  at   14.840   sec.",
            *[f"text {i}" for i in range(19, 26)],
            *rows(np.full(100, -999), 16, "5d"),
            *rows(np.full(100, -999.0), 8, "10.5f"),
        ]
        for what, of in ((points, unit), ("veloc", "cm/sec. "), ("displ", "cm.     ")):
            lines += [
                f"{len(values):6d} points of {what} data equally spaced at  {DT:.3f} sec, in {of} "
                "(8f10.4)"
            ]
            lines += rows(values, 8, "10.4f")
        lines += [f"/&  ----------  End of data for channel  {number}  ----------"]
    return "\n".join(lines) + "\n"


def csmip_v1(direction, values):
    """CSMIP V1 of one channel [g]."""
    lines = [
        "Uncorrected Accelerogram Data             Processed: 02/13/12, CGS  146be002",
        *[f"text {i}" for i in range(2, 7)],
        f"Chan  1: {direction}",
        *[f"text {i}" for i in range(8, 12)],
        f"Units of uncor data are sec and g .        Max  = {np.abs(values).max():6.3f} g , at  3.",
        "RMS calc for complete record =        .",
        *rows(np.full(100, -999), 16, "5d"),
        *rows(np.full(50, -999.0), 8, "10.5f"),
        f"{len(values):6d} Accelerogram points at {1 / DT:.0f} pts/sec in units of g .      "
        "Format: (8f9.6)",
        *rows(values, 8, "9.6f"),
        "/&  ----------  End of data for channel  1  ----------",
    ]
    return "\n".join(lines) + "\n"


def smc(values):
    """SMC file of one corrected component [cm/s2]."""
    integers, reals = np.full(48, -32768), np.full(50, 1.7e38)
    integers[[15, 16]] = 2, len(values)
    reals[[1, 29, 31]] = 1 / DT, values.max(), values.min()
    lines = [
        "2 CORRECTED ACCELEROGRAM",
        "*",
        "SAF0A",
        "     1989  10  18    0004 Loma Prieta, CA",
        "Moment Mag=      7.1 Ms=      7.1 Ml=      7.0",
        "station = San Francisco, 1295 Shafter, F component=    360",
        "epicentral dist =     89.0       pk     =    104.4",
        "inst type=SMA-1      data source = USGS",
        *["*"] * 3,
        *rows(integers, 8, "10d"),
        *rows(reals, 5, "15.7E"),
        "| one",
        "| two",
        *["".join(_short(v) for v in values[i : i + 8]) for i in range(0, len(values), 8)],
    ]
    return "\n".join(lines) + "\n"


def _short(value):
    """Exponents of one digit, as in -2.2223E+0."""
    mantissa, exponent = f"{value:11.4E}".split("E")
    return f"{mantissa}E{int(exponent):+d}".rjust(10)[-10:]


def geonet(channels, *, raw=False):
    """GeoNet V2A, or V1A where raw, of (component, values [mm/s2]) channels."""
    lines = []
    for told, values in channels:
        head = np.zeros((10, 10))
        head[3, [0, 3]] = (len(values), 0) if raw else (65536, len(values))
        head[3, [4, 5]] = 0 if raw else len(values)
        head[6, 5] = DT
        head[7, 0 if raw else 5] = values[np.abs(values).argmax()]
        kind = "Uncorrected" if raw else "Corrected"
        lines += [
            f"{kind} accelerogram 20161113_110256_WTMC_20 GNS Science",
            "Site WTMC      42 37 10S  173 03 13E     Cusp file:  20161113_110259_WTMC",
            *[f"text {i}" for i in range(3, 13)],
            f"Component {told}  Longitudinal Accelerometer Axis",
            *[f"text {i}" for i in range(14, 17)],
            *["".join(f"{int(v):8d}" for v in row) for row in head[:4]],
            *["".join(f"{v:8.4g}" if abs(v) < 1 else f"{v:8.1f}" for v in row) for row in head[4:]],
        ]
        for _ in range(1 if raw else 3):
            lines += rows(values, 10, "8.1f")
    return "\n".join(lines) + "\n"


def afad(east, north, up):
    """File of AFAD [cm/s2]."""
    lines = [
        "STRONG GROUND MOTION RECORDS OF TURKIYE",
        "PLACE                   : KUTAHYA GEDIZ",
        "EARTHQUAKE DATE         : 2017/07/20 22:31:09 (GMT)",
        "STATION ID              : 4304",
        f"NUMBER OF DATA          : {len(east)}",
        f"SAMPLING INTERVAL (sec) : {DT}",
        "RAW PGA VALUES (gal)    : (N-S) 1.2 (E-W) 1.2 (U-D) 0.6",
        "Copyright EARTHQUAKE DEPARTMENT",
        "       N-S          E-W          U-D",
        *[f"{n:12.6f}{e:14.6f}{u:13.6f}" for e, n, u in zip(east, north, up)],
    ]
    return "\n".join(lines) + "\n"


def all_files():
    """A file of each format by its name, of the same motion."""
    three = (EAST, NORTH, UP)
    return {
        "a.v2c": cosmos(list(zip((90, 360, 400), three))),
        "a.V2": csmip(list(zip(("90 Deg", "360 Deg", "Up"), three))),
        "a.V1": csmip_v1("90 Deg", EAST / 980.665),
        "a.smc": smc(EAST),
        "a.V2A": geonet(list(zip(("N90E", "N00E", "Up"), (10 * values for values in three)))),
        "a.V1A": geonet([("S90E", 10 * EAST)], raw=True),
        "a.nsmn": afad(*three),
    }
