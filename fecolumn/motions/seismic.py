"""Files of seismological networks, read by ObsPy, an optional extra of the installation."""

from __future__ import annotations

import importlib.util
import re
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.files import Unreadable, read_bytes
from fecolumn.motions.column_names import MOVED, named_column, no_acceleration
from fecolumn.motions.directions import lengths_differ
from fecolumn.motions.record import Recording, UnusableRecord

#: Formats by the name that ObsPy has for each.
_NAMES = {"KNET": "K-NET or KiK-net", "SAC": "SAC", "MSEED": "miniSEED", "GSE2": "GSE2"}
_INSTALL = "pip install 'obspy>=1.4,<1.6' reads it"
# Axis by the last letter of a channel such as HNE
_AXES = {"E": "x", "N": "y", "Z": "z"}
# What is no acceleration, by the number that the head of SAC has for it, and what is
_SAC_MOVED, _SAC_ACCELERATION = {6: "displacement", 7: "velocity"}, 8


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
    not state it. Components of one file are told by the last letter of their channels, and cut to
    the time that all have.

    Raises
    ------
    UnusableRecord
        ObsPy is missing, cannot read it, it has gaps, channels of velocities, or of different
        times.
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
    for trace in traces:
        _check_quantity(trace, kind)
    values = _common(traces)
    count = len(values)
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


def _check_quantity(trace: Any, kind: str) -> None:
    """Refuse what the head of SAC or, where that says nothing, the name of its channel says is a
    velocity or a displacement: what was differentiated keeps the name.
    """
    quantity = getattr(trace.stats, "sac", {}).get("idep") if kind == "SAC" else None
    if quantity in _SAC_MOVED:
        raise UnusableRecord(
            f"holds no accelerations: its head says {_SAC_MOVED[quantity]} (IDEP = {quantity})"
        )
    column = named_column(trace.stats.channel.lower(), "")
    if column.meaning == MOVED and quantity != _SAC_ACCELERATION:
        raise no_acceleration(column)


def _common(traces: list[Any]) -> NDArray[Any]:
    """Samples (n, channels) of the time in which all channels are recorded.

    Raises
    ------
    UnusableRecord
        channels that begin or end at times too different.
    """
    starts = [float(trace.stats.starttime.timestamp) for trace in traces]
    dt = float(traces[0].stats.delta)
    first = [round((max(starts) - start) / dt) for start in starts]
    count = min(trace.stats.npts - skipped for trace, skipped in zip(traces, first))
    if lengths_differ(max(count, 0), max(trace.stats.npts for trace in traces)):
        told = ", ".join(
            f"{trace.id} from {start - min(starts):g} to "
            f"{start - min(starts) + dt * trace.stats.npts:g} s"
            for trace, start in zip(traces, starts)
        )
        raise UnusableRecord(
            f"has channels of different times ({told}); they may differ by 1 %: cut them alike"
        )
    return np.column_stack(
        [
            np.asarray(trace.data[skipped : skipped + count], float)
            for trace, skipped in zip(traces, first)
        ]
    )
