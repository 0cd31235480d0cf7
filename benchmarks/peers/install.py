"""Installs the peers: Debian's packages as root, MuJoCo into an environment of its own.

Nothing goes into the project's environment.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

PACKAGES = ("python3-getfem", "calculix-ccx", "python3-siconos")
SYSTEM_PYTHON = "/usr/bin/python3"


def mujoco_python() -> Path:
    """Python of MuJoCo's environment, in the user's cache."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "fecolumn" / "peers" / "mujoco" / "bin" / "python"


def install() -> None:
    """Install what is missing; a peer that cannot be had is said and left out, so that the others
    still run.
    """
    as_root = [] if os.geteuid() == 0 else ["sudo"]
    apt = [
        *as_root,
        "flock",
        "/var/lib/apt",
        "apt-get",
        "-qq",
        "-o",
        "DPkg::Lock::Timeout=1800",
        "-o",
        "Dpkg::Use-Pty=0",
    ]
    _try([*apt, "update"])
    for package in PACKAGES:
        _try([*apt, "install", "--no-install-recommends", "--yes", package])
    python = mujoco_python()
    if not python.exists():
        _try([SYSTEM_PYTHON, "-I", "-m", "venv", str(python.parents[1])])
    _try([str(python), "-m", "pip", "install", "--quiet", "mujoco"])


def _try(command) -> None:
    environment = {
        key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV")
    }
    try:
        done = subprocess.run(
            command,
            env=environment | {"DEBIAN_FRONTEND": "noninteractive"},
            capture_output=True,
            text=True,
        )
        failure = (
            done.stderr.strip().splitlines()[-1:] or ["no reason given"]
            if done.returncode
            else None
        )
    except OSError as error:
        failure = [str(error)]
    if failure:
        print(f"peers: failed: {' '.join(command)}: {failure[0]}", file=sys.stderr)
