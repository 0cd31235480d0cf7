"""From the case's [motion] table to the ground motion its analysis is run with."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.check_motion import check_strong_part
from fecolumn.case.checked import refuse_in
from fecolumn.case.sections import GRAVITY, Motion
from fecolumn.foundation.deprecated import renamed
from fecolumn.foundation.paths import FEMA_PREFIX, LICK_PREFIX
from fecolumn.foundation.schema import InputError
from fecolumn.motions import lick
from fecolumn.motions.afad import looks_like_afad, read_afad
from fecolumn.motions.at2 import looks_like_at2, read_at2
from fecolumn.motions.columns import read_columns
from fecolumn.motions.cosmos import looks_like_cosmos, read_cosmos
from fecolumn.motions.csmip import looks_like_csmip, read_csmip
from fecolumn.motions.ensemble_file import file_and_number, is_hdf5_name, read_member
from fecolumn.motions.esm import looks_like_esm, read_esm
from fecolumn.motions.fema_p695 import read_fema_p695
from fecolumn.motions.formats import FORMATS
from fecolumn.motions.geonet import looks_like_geonet, read_geonet
from fecolumn.motions.hdf5_record import read_hdf5_record
from fecolumn.motions.processing import (
    delay,
    join,
    resample,
    rotate,
    scale,
    scale_time,
    strong_part,
    without_vertical,
)
from fecolumn.motions.record import (
    METRES_PER_S2,
    MOST_SAMPLES,
    GroundMotion,
    Recording,
    UnusableRecord,
    sound,
)
from fecolumn.motions.seismic import read_seismic, seismic_format
from fecolumn.motions.smc import looks_like_smc, read_smc
from fecolumn.motions.spike import spike_in
from fecolumn.motions.text import read_text

AXES = "xyz"
_DT_TOLERANCE = 1e-4
_LENGTH_TOLERANCE = 0.01
# Of networks, by their first lines
_NETWORKS = (
    (looks_like_esm, read_esm),
    (looks_like_cosmos, read_cosmos),
    (looks_like_geonet, read_geonet),
    (looks_like_csmip, read_csmip),
    (looks_like_smc, read_smc),
    (looks_like_afad, read_afad),
)
#: [g]: more was recorded nowhere, and a unit may be wrong
RECORDED_G = 5.0
#: [s]: accelerographs sample ten times as often and more
LONGEST_DT = 0.2
_SOURCES = f"a file of a record, ensemble.h5#NUMBER, lick:NUMBER or {FEMA_PREFIX}SET/INDEX"
# Over a file's peak: sampled band-limited, a motion of few rows may peak higher between them
_HIGHER = 0.02
_LARGEST_RATIO = 20_000  # of steps: the filter between them has 128 times as many terms


@renamed(dt="dt_s")
def load_motion(
    motion: Motion | str, dt_s: float, file: Path | str = "load_motion"
) -> GroundMotion:
    """Ground motion of a case: read, in m/s2, rotated, scaled, compressed, trimmed, resampled,
    joined by lines, delayed, in this order.

    Parameters
    ----------
    motion
        a Motion, such as `case.motion`, or its source alone, such as "lick:1".
    dt_s
        step of the analysis, integration.dt_s [s].
    file
        the case's file, for messages.

    Returns
    -------
    GroundMotion
        acceleration_m_s2: (n, 3) along x, y, z (up), from the step after rest on; dt_s: that of
        the analysis, or motion.resample_s [s].

    Raises
    ------
    InputError
        a file cannot be used, contradicts the case or another component, or is shorter than dt_s.

    Warns
    -----
    AliasingWarning
        dt_s is too coarse for the motion.
    UserWarning
        sampled, its peak is 2 % above that of the file.
    """
    if isinstance(motion, str):
        motion = Motion(motion)
    elif not isinstance(motion, Motion):
        told = 'must be a Motion, or the text of its source, such as "lick:1"'
        raise InputError(file, "motion", motion, told)
    ground = unsampled(motion, file)
    if motion.resample_s and dt_s > motion.resample_s * (1 + _DT_TOLERANCE):
        raise InputError(
            file,
            "integration.dt_s",
            dt_s,
            f"must be at most motion.resample_s = {motion.resample_s:g} s",
        )
    key, step = (
        ("motion.resample_s", motion.resample_s)
        if motion.resample_s
        else ("integration.dt_s", dt_s)
    )
    if step > ground.duration:
        raise InputError(
            file, key, step, f"must be at most the motion's length, {ground.duration:g} s"
        )
    if (least := (ground.duration + motion.delay_s) / MOST_SAMPLES) > dt_s or (
        least := ground.dt / _LARGEST_RATIO
    ) > dt_s:
        raise InputError(
            file,
            "integration.dt_s",
            dt_s,
            f"must be at least {least:.3g} s for a motion of {ground.duration:g} s "
            f"sampled at {ground.dt:g} s",
        )
    if step > _LARGEST_RATIO * ground.dt:
        raise InputError(
            file,
            key,
            step,
            f"must be at most {_LARGEST_RATIO * ground.dt:.3g} s for a motion sampled "
            f"at {ground.dt:g} s",
        )
    try:
        sampled = resample(ground, step)
        if told := higher_between_rows(ground, sampled):
            warnings.warn(f"{file}: motion: {told}", stacklevel=3)
        return delay(join(sampled, dt_s), motion.delay_s)
    except ValueError as error:
        raise InputError(file, key, step, str(error)) from None


def higher_between_rows(ground: GroundMotion, sampled: GroundMotion) -> str:
    """What is to be said of a motion whose peak, sampled anew, is more than 2 % above that of its
    rows, with the way out; "" of others.
    """
    peaks = ground.pga, sampled.pga
    axis = int(np.argmax(peaks[1] - (1 + _HIGHER) * peaks[0]))
    own, found = (float(one[axis]) / GRAVITY for one in peaks)
    if found <= (1 + _HIGHER) * own:
        return ""
    return (
        f"{ground.name}: a{AXES[axis]} peaks at {found:.4g} g between its rows, {ground.dt:g} s "
        f"apart, where these peak at {own:.4g} g: it is sampled band-limited; "
        f"motion.resample_s = {ground.dt:g} joins the rows by straight lines, and so do rows as "
        "close as the lines bend"
    )


def unsampled(motion: Motion, file: Path | str) -> GroundMotion:
    """As load_motion, at the motion's own step and without delay."""
    check_strong_part(motion, "motion", refuse_in(file))
    ground = rotate(read_motion(motion, file), motion.rotation_deg)
    if not motion.vertical:
        if ground.acceleration[:, 2].any() and not ground.acceleration[:, :2].any():
            raise InputError(
                file,
                "motion.vertical",
                False,
                f"{motion.source} has a vertical component alone; true applies it",
            )
        ground = without_vertical(ground)
    elif not ground.acceleration[:, 2].any():
        raise InputError(
            file,
            "motion.vertical",
            True,
            f"{motion.source} has no vertical component; name its file as "
            "motion.source_z, or leave this key out",
        )
    begin, end = motion.strong_part
    try:
        scaled = sound(scale(ground, motion.scale))
    except ValueError as error:
        raise InputError(file, "motion.scale", motion.scale, str(error)) from None
    return strong_part(scale_time(scaled, motion.time_scale), (begin, end))


def read_motion(motion: Motion, file: Path | str) -> GroundMotion:
    """Ground motion as recorded, in m/s2, along the axes of the record.

    Components in files of their own must have one step. A component up to 1 % shorter than the
    longest is followed by zeros: processed records end at rest, and PEER's often differ by a few
    samples.

    Raises
    ------
    InputError
        as load_motion.
    """
    keys = [key for key in ("source", "source_y", "source_z") if getattr(motion, key)]
    if not keys:
        raise InputError(file, "motion.source", motion.source, f"must be {_SOURCES}")
    columns: dict[str, NDArray[Any]] = {}
    names, sources, dt = [], [], 0.0
    for key in keys:
        recording = recording_of(motion, key, file)
        step = _step(motion, key, recording, file)
        if dt and not math.isclose(step, dt, rel_tol=_DT_TOLERANCE):
            raise InputError(
                file,
                f"motion.{key}",
                getattr(motion, key),
                f"is sampled at {step:g} s but motion.source at {dt:g} s",
            )
        dt = dt or step
        in_metres = recording.values * METRES_PER_S2[_units(motion, key, recording, file)]
        columns.update(zip(_axes(motion, key, recording, len(keys) > 1, file), in_metres.T))
        names.append(recording.name)
        sources.append(recording.source)
    longest = max(map(len, columns.values()))
    acceleration = np.zeros((longest, 3))
    for axis, column in columns.items():
        if len(column) < (1 - _LENGTH_TOLERANCE) * longest:
            key = "source" if axis == "x" else f"source_{axis}"
            raise InputError(
                file,
                f"motion.{key}",
                getattr(motion, key),
                f"has {len(column)} samples where another component has {longest}; they "
                "may differ by 1 %",
            )
        acceleration[: len(column), AXES.index(axis)] = column
    try:
        ground = sound(
            GroundMotion(acceleration, dt, " + ".join(names), " | ".join(dict.fromkeys(sources)))
        )
        if (peak := ground.pga.max()) > RECORDED_G * GRAVITY:
            warnings.warn(
                f"{ground.name} peaks at {peak / GRAVITY:.3g} g, more than was ever recorded: is "
                "its unit right?",
                stacklevel=2,
            )
        if dt > LONGEST_DT and not motion.resample_s:  # of lines between rows it is stated
            warnings.warn(
                f"{ground.name} has a sample every {dt:g} s only: is its time in milliseconds?",
                stacklevel=2,
            )
        for axis, column in columns.items():
            if (place := spike_in(column)) is not None:
                warnings.warn(
                    f"{ground.name}: a{axis or 'x'} has a spike of {column[place]:.3g} m/s2 at "
                    f"t = {place * dt:g} s, one sample alone: is the file damaged?",
                    stacklevel=2,
                )
        return ground
    except ValueError as error:
        raise InputError(file, "motion.source", motion.source, str(error)) from None


def recording_of(motion: Motion, key: str, file: Path | str) -> Recording:
    """What the file, or the record, of a key of [motion] says, as it says it.

    Raises
    ------
    InputError
        it cannot be used.
    """
    source = getattr(motion, key)
    try:
        if source.startswith(LICK_PREFIX):
            source = lick.lick_source(source)
        if source.startswith(FEMA_PREFIX):
            recording = read_fema_p695(source)
        elif file_and_number(source):
            member = read_member(source)
            recording = Recording(
                member.acceleration, tuple(AXES), member.dt, "m/s2", member.name, member.source
            )
        elif is_hdf5_name(source):
            recording = read_hdf5_record(source, motion.dt_s)
        elif kind := seismic_format(source):
            recording = read_seismic(source, kind)
        elif read := _network_reader(text := read_text(source)):
            recording = read(source)
        elif looks_like_at2(source, text):
            recording = read_at2(source)
        else:
            recording = _columns_of(source, motion.dt_s)
        if len(recording.values) < 2:
            raise UnusableRecord(f"holds {len(recording.values)} samples; at least 2 are needed")
    except UnusableRecord as error:
        hint = f"; must be {_SOURCES}" if str(error) == "no such file" else ""
        raise InputError(file, f"motion.{key}", getattr(motion, key), f"{error}{hint}") from None
    return recording


def _network_reader(text: str) -> Callable[[str], Recording] | None:
    """The reader of the network whose format a text has, if it has one."""
    return next((read for looks_like, read in _NETWORKS if looks_like(text)), None)


def _columns_of(source: str, dt_s: float) -> Recording:
    """Columns of a file that is of no other format; where they are none, all formats are told."""
    try:
        return read_columns(source, dt_s)
    except UnusableRecord as error:
        if re.search(
            r"not a number|columns need|columns where|holds [01] sample|header names", str(error)
        ):
            raise UnusableRecord(f"{error}; formats that are read: {FORMATS}") from None
        raise


def _step(motion: Motion, key: str, recording: Recording, file: Path | str) -> float:
    if recording.dt is None and motion.dt_s == 0:
        raise InputError(
            file,
            "motion.dt_s",
            motion.dt_s,
            f"must be given: {getattr(motion, key)} does not state its sampling step",
        )
    if (
        recording.dt is not None
        and motion.dt_s
        and not math.isclose(recording.dt, motion.dt_s, rel_tol=_DT_TOLERANCE)
    ):
        raise InputError(
            file,
            "motion.dt_s",
            motion.dt_s,
            f"contradicts {getattr(motion, key)}, which states {recording.dt:g} s",
        )
    return recording.dt or motion.dt_s


def _units(motion: Motion, key: str, recording: Recording, file: Path | str) -> str:
    if not (recording.units or motion.units):
        raise InputError(
            file,
            "motion.units",
            motion.units,
            f"must be one of {', '.join(METRES_PER_S2)}: {getattr(motion, key)} does "
            "not state its units",
        )
    if recording.units and motion.units and recording.units != motion.units:
        raise InputError(
            file,
            "motion.units",
            motion.units,
            f"contradicts {getattr(motion, key)}, which states {recording.units}",
        )
    return recording.units or motion.units


def _axes(
    motion: Motion, key: str, recording: Recording, several_files: bool, file: Path | str
) -> tuple[str, ...]:
    """Axis of each component: the file's own, or that of the key it stands under."""
    axis = {"source": "x", "source_y": "y", "source_z": "z"}[key]
    if not several_files:
        return tuple(own or axis for own in recording.axes)
    if len(recording.axes) > 1 or recording.axes[0] not in ("", axis):
        raise InputError(
            file,
            f"motion.{key}",
            getattr(motion, key),
            f"holds {', '.join('a' + own for own in recording.axes)}; beside other "
            f"files it must hold a{axis} alone",
        )
    return (axis,)
