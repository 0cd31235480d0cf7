"""Study files for the tests."""

import json
from pathlib import Path

SPECIMEN = Path(__file__).parents[2] / "meshes" / "stout.toml"


def write_study(
    folder: Path, *, dt=(0.02, 1e-3), alpha=(0, -0.2), pulses=range(4), case=None, extra=""
) -> Path:
    """Study file of rigid blocks under sine pulses."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "study.toml"
    sources = [f"pulse:{pulse}" for pulse in pulses]
    file.write_text(
        f'case = {json.dumps(str(case or SPECIMEN))}\n[axes]\n"integration.dt_s" = {list(dt)}\n'
        f'"integration.alpha_hht" = {list(alpha)}\n"motion.source" = {json.dumps(sources)}\n{extra}'
    )
    return file
