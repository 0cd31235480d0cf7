"""Ensembles of motions, with their seal and without."""

from __future__ import annotations

import numpy as np

from benchmarks.fuzz.damage import cut, displaced, flip, noise, zeroed
from fecolumn.case.sections import Motion
from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.sealed import sealed
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import members, read_ensemble, write_ensemble
from fecolumn.motions.load import load_motion
from fecolumn.motions.record import GroundMotion

_FOREIGN = 0.15  # share of mutants without a seal: each takes a process of its own


def prepare(folder) -> None:
    """Three motions."""
    rng = np.random.default_rng(0)
    motions = tuple(
        GroundMotion(rng.standard_normal((300, 3)), 0.01, f"noise {i}", "drawn") for i in range(3)
    )
    write_ensemble(
        Ensemble("noise", motions, {"seed": np.arange(3.0)}, {"model": "noise"}), folder / "e.h5"
    )


def sound(folder):
    """The ensemble as it is."""
    return folder / "e.h5"


def mutate(rng, folder):
    """Bytes changed, in the open or behind the seal's back."""
    path = folder / "e.h5"
    whole = path.read_bytes()
    if rng.random() < 0.1:
        displaced(rng, path)
        return path
    if rng.random() < _FOREIGN:
        content = whole[: -len(sealed(b""))]
        for _ in range(int(rng.integers(1, 3))):
            content = (flip, flip, cut, zeroed)[int(rng.integers(4))](rng, content)
        write_bytes(path, content)
    else:
        write_bytes(path, (flip, flip, cut, zeroed, noise)[int(rng.integers(5))](rng, whole))
    return path


def use(path) -> None:
    """What `motions info` and an analysis do with it."""
    for source in members(f"{path}#*"):
        load_motion(Motion(source), 0.005, "case.toml")
    assert len(read_ensemble(path).motions) >= 1
