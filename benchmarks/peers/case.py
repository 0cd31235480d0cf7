"""The two cases of the comparison, and what a peer needs of them as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.peers.theory import Housner, housner
from fecolumn.case.sections import GRAVITY
from fecolumn.case.short_form import ShortForm, short_form
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.mesh.mass import MassProperties, mass_properties
from fecolumn.mesh.specimen import SpecimenMesh, specimen_mesh

SPECIMEN = Path(__file__).parents[2] / "meshes" / "stout.toml"
IMPACTS = 10
# The pipe of the published comparison: no cap; 5 mm bricks up to a tenth of its height, 15 mm above
PIPE = {
    "title": "Pipe",
    "column": {"outer_diameter_m": 0.15, "wall_m": 0.005, "height_m": 1.5, "fine_height_m": 0.15},
}
# This project's columns stand on an elastic plate; 5,000 times as stiff as steel, 5 mm thick and
# one brick deep, it is a rigid floor
FLOOR = {
    "base": {"youngs_modulus_pa": 1e15, "length_m": 0.25, "width_m": 0.25, "thickness_m": 0.005},
    "integration": {"alpha_hht": -0.05},
}


@dataclass(frozen=True, slots=True)
class Release:
    """A column released at rest from a tilt about its rim towards +x.

    Attributes
    ----------
    name
        in table and file names.
    case
        for this project's engines, as long as IMPACTS impacts take.
    mesh
        of it.
    body
        mass properties of the bricks.
    rigid
        theory.
    radius
        of the rim [m].
    """

    name: str
    case: ShortForm
    mesh: SpecimenMesh
    body: MassProperties
    rigid: Housner
    radius: float

    @property
    def tilt(self) -> float:
        """At release [rad]."""
        return self.case.initial.tilt_rad

    @property
    def impacts(self) -> np.ndarray:
        """Times (IMPACTS,) of the impacts by theory [s]."""
        return self.rigid.impact_times(self.tilt, IMPACTS)

    @property
    def steps(self) -> int:
        """Steps until a twentieth of a second after the last impact."""
        return round(self.case.integration.duration_s / self.case.integration.dt_s)

    def write(self, path: Path, steps: int) -> None:
        """Write the bricks, released, their ties and the rigid body for a peer; SI units, +x the
        direction of the tilt.

        points: (n, 3) upright; start: (n, 3) at release; cells: (n_cells, 8) in VTK order; slaves,
        masters, weights: (k,), (k, 4), (k, 4) of the ties; foot, top: point numbers; toes: (2,)
        points at the rim's +x and -x ends; faces: (m, 4) of the foot.
        """
        points, radius = self.mesh.body.points, self.radius
        pivot, turn = np.array([radius, 0.0, 0.0]), rotation_matrix([0.0, self.tilt, 0.0])
        start = (points - pivot) @ turn.T + pivot
        foot, height = self.mesh.foot_nodes, points[:, 2].max()
        toes = [
            foot[np.linalg.norm(points[foot] - sign * pivot, axis=1).argmin()] for sign in (1, -1)
        ]
        slaves, masters, weights = [np.zeros(0, int)], [np.zeros((0, 4), int)], [np.zeros((0, 4))]
        for one in self.mesh.ties:
            nodes, shares, _ = one.masters(points)
            slaves.append(one.slave_nodes), masters.append(nodes), weights.append(shares)
        case, steel = self.case, self.case.material
        np.savez(
            path,
            points=points,
            start=start,
            cells=self.mesh.body.cells,
            foot=foot,
            toes=toes,
            top=np.flatnonzero(points[:, 2] > height * (1 - 1e-9)),
            slaves=np.concatenate(slaves),
            masters=np.concatenate(masters),
            weights=np.concatenate(weights),
            mass=self.body.mass,
            centre=self.body.centre,
            inertia=self.body.inertia,
            radius=radius,
            height=height,
            tilt=self.tilt,
            turn=turn,
            steps=steps,
            dt=case.integration.dt_s,
            friction=case.contact.friction_coefficient,
            gravity=GRAVITY,
            youngs_modulus=steel.youngs_modulus_pa,
            poissons_ratio=steel.poissons_ratio,
            density=steel.density_kg_m3,
            brick=case.mesh.fine_size_m,
        )


def release(name: str) -> Release:
    """One of CASES."""
    tables = merge(read_toml(SPECIMEN), FLOOR)
    if name == "pipe":
        tables = merge(tables, PIPE)
        del tables["cap"]
    case = short_form(tables, SPECIMEN)
    mesh = specimen_mesh(case)
    radius = float(np.linalg.norm(mesh.body.points[mesh.foot_nodes, :2], axis=1).max())
    body = mass_properties(mesh.body, case.material.density_kg_m3)
    rigid = housner(body, radius)
    tilt = 0.02 if name == "pipe" else 0.4 * rigid.slenderness
    duration = round(float(rigid.impact_times(tilt, IMPACTS)[-1]) + 0.05, 3)
    tables = merge(tables, {"integration": {"duration_s": duration}, "initial": {"tilt_rad": tilt}})
    return Release(name, short_form(tables, SPECIMEN), mesh, body, rigid, radius)


CASES = ("pipe", "specimen")
