"""Files of seismological networks, read by ObsPy, an optional extra of the installation."""

from __future__ import annotations

import importlib.util
import re
import struct
import warnings
from pathlib import Path

import numpy as np

from fecolumn.foundation.files import Unreadable, read_bytes
from fecolumn.motions.record import Recording, UnusableRecord

#: Formats by the name that ObsPy has for each.
_NAMES = {"KNET": "K-NET or KiK-net", "SAC": "SAC", "MSEED": "miniSEED", "GSE2": "GSE2"}
_INSTALL = "pip install 'fecolumn[records]' (ObsPy) reads it"
# Axis by the last letter of a channel such as HNE
_AXES = {"E": "x", "N": "y", "Z": "z"}


def seismic_format(path: Path | str) -> str | None:
    """ObsPy's name of the format of a file, told by its first bytes; None of any other file."""
    try:
        head = read_bytes(path)[:4096]
    except Unreadable:
        return None
    if head.lstrip()[:11].lower() == b"origin time":
        return "KNET"
    if re.match(rb"\s*(BEGIN GSE2|WID2 )", head):
        return "GSE2"
    if re.match(rb"\d{6}[DRQM][ \0]", head) or head[:3] == b"MS\x03":
        return "MSEED"
    # version of the header, and whether numbers are floats, of SAC in either order of bytes
    for order in "<>":
        if len(head) >= 632 and struct.unpack(f"{order}i", head[304:308])[0] in (6, 7):
            return "SAC"
    return None


def read_seismic(path: Path | str, kind: str) -> Recording:
    """Recording of a file of a network.

    K-NET and KiK-net state their unit; the mean, an offset of the recorder, is taken off. Others do
    not state it. Components of one file are told by the last letter of their channels.

    Raises
    ------
    UnusableRecord
        ObsPy is missing, cannot read it, or it has gaps.
    """
    name = _NAMES[kind]
    if importlib.util.find_spec("obspy") is None:
        raise UnusableRecord(f"is a {name} file: {_INSTALL}")
    import obspy

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stream = obspy.read(str(Path(path).resolve()), format=kind)
    except Exception as error:  # readers raise whatever their parsing meets
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise UnusableRecord(f"cannot be read as {name}: {said}") from None
    traces = list(stream)
    if not traces:
        raise UnusableRecord(f"holds no samples as {name}")
    ids = [trace.id for trace in traces]
    if len(set(ids)) < len(ids):
        twice = next(one for one in ids if ids.count(one) > 1)
        raise UnusableRecord(
            f"has gaps: {ids.count(twice)} pieces of {twice}; samples must be even, without gaps"
        )
    if len(traces) > 3:
        raise UnusableRecord(f"holds {len(traces)} channels ({', '.join(ids)}); at most 3 are read")
    steps = {float(trace.stats.delta) for trace in traces}
    if len(steps) > 1:
        raise UnusableRecord("has channels of different steps: " + ", ".join(map(str, steps)))
    count = min(trace.stats.npts for trace in traces)
    values = np.column_stack([np.asarray(trace.data[:count], float) for trace in traces])
    units = ""
    if kind == "KNET":
        if traces[0].stats.npts < 2:
            raise UnusableRecord("holds too few samples")
        values, units = values * traces[0].stats.calib, "m/s2"
        values = values - values.mean(axis=0)
        told = round(float(traces[0].stats.knet.duration) / steps.copy().pop())
        if abs(told - count) > 1:
            raise UnusableRecord(
                f"its head tells {told} samples but {count} follow: the file is cut off"
            )
    if not np.isfinite(values).all():
        raise UnusableRecord("every value must be finite")
    letters = [trace.stats.channel[-1:] for trace in traces]
    several = len(traces) > 1
    axes = tuple(_AXES.get(letter, "") if several else "" for letter in letters)
    if several and ("" in axes or len(set(axes)) < len(axes)):
        raise UnusableRecord(f"its channels {', '.join(ids)} must end in E, N and Z")
    return Recording(values, axes, steps.pop(), units, Path(path).name, ", ".join(ids), name)
