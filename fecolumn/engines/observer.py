"""What is watched of a structure in full order: the columns that the reduced engine writes, of the
bodies' mean motion and the tops' nodes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fecolumn.contact.overturning import (
    CAPPED,
    FELL,
    NO_RETURN,
    STANDS,
    cap_only_stance,
    is_past_no_return,
)
from fecolumn.contact.points import GROUND, OVER
from fecolumn.contact.pose import grounds_at, poses_of
from fecolumn.engines.history_columns import of_both_sides
from fecolumn.engines.passing import RigidMotion
from fecolumn.fem.rotation import tilt_angle, twist_angle, vector_product
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.summed import summed_at
from fecolumn.structures.face_motion import FaceMotion

if TYPE_CHECKING:
    from fecolumn.contact.overturning import Limits
    from fecolumn.engines.dynamics.system import State, System
    from fecolumn.engines.elements import MeshedBody
    from fecolumn.structures.model import StructureModel


class Observer:
    """Measures states of a System.

    Parameters
    ----------
    system
        of `dynamics.structure.structure_system`.
    meshed
        `elements.MeshedBody` of each part.
    structure
        StructureModel, as it stands upright: displacements are measured from there.
    limits
        `overturning.Limits` of the parts.
    cap
        horizontal displacement of the observed mark that counts as overturned [m], 0 for none.
    """

    def __init__(
        self,
        system: System,
        meshed: list[MeshedBody],
        structure: StructureModel,
        limits: Limits,
        cap: float,
    ) -> None:
        self._limits = limits
        self.system, self.structure, self._meshed = system, structure, meshed
        self.body, self._mark = structure.observed
        part = structure.parts[self.body]
        self.stance, self.top_arm = (
            cap_only_stance(part.model.inertia, system.weight, cap),
            part.model.marks[self._mark][0],
        )
        self._centers, upright = (
            np.array([getattr(part, name) for part in structure.parts])
            for name in ("center", "rotation")
        )
        reference = poses_of(
            system.interface.interfaces, self._centers, upright, grounds_at(structure.levels)
        )
        self._faces = FaceMotion(structure, reference, system.interface.rows)
        #: First foot of the observed body, if it has one.
        self._surface = next(
            (
                part.model.surfaces[joint.slave_surface]
                for joint in structure.joints
                if joint.slave == self.body
            ),
            None,
        )

    def measure(self, state: State) -> dict[str, Any]:
        """Measures of a state by the names of the history file, in SI units; as
        `history_columns.columns_of` tells them.
        """
        system, structure, interface, R = (
            self.system,
            self.structure,
            self.system.interface,
            state.rotation,
        )
        moved, forces, own = (
            system.bodies.centers(state.x) - self._centers,
            state.forces,
            R[self.body],
        )
        carries, points = forces[:, 2] > 0, interface.points
        over = state.contact["located"] & ~points["idle"] & (points["beyond"] == OVER)
        tops = [self._top(b, state.x) for b in range(len(structure.parts))]
        row = dict(
            time=state.time,
            u_top=tops[self.body],
            tilt=tilt_angle(own),
            twist=twist_angle(own),
            slide=self._slid(state.x, moved)[:2],
            contact_force=forces[carries & (points["master"] == GROUND)].sum(axis=0),
            active_nodes=int(carries.sum()),
            penetration=float(
                (state.contact["raised"] - over * state.relative[:, 2]).max(initial=0.0)
            ),
            ground=state.ground[:3],
        )
        for b, part in enumerate(structure.parts):
            row |= {
                f"body/{part.name}/displacement": moved[b],
                f"body/{part.name}/tilt": tilt_angle(R[b]),
                f"body/{part.name}/rotation": Rotation.from_matrix(R[b]).as_rotvec(),
                f"mark/{part.name}.top/displacement": tops[b],
            }
        poses = interface.poses_at(moved + self._centers, R, state.grounds)
        normal = np.bincount(
            interface.points["interface"], np.maximum(forces[:, 2], 0.0), len(poses)
        )
        turned, rows = poses["frame"], interface.points["interface"]
        along = np.einsum("pac,pc->pa", turned[rows], forces * carries[:, None])
        level = state.relative * [1.0, 1.0, 0.0]
        pressed = np.einsum("pac,pc->pa", turned[rows], level) * np.maximum(forces[:, 2:], 0.0)
        resultants, centers = (summed_at(rows, each, len(poses)) for each in (along, pressed))
        tilts, risen = self._faces.moved(poses, interface.deformation(state.x, R, forces))
        loaded = normal > 0
        centers[loaded] = poses["origin"][loaded] + centers[loaded] / normal[loaded, None]
        for joint, tilt, moved, force, resultant, center in zip(
            structure.joints, tilts.tolist(), risen, normal, resultants, centers
        ):
            row |= {
                f"interface/{joint.name}/{name}": value
                for name, value in dict(
                    tilt=tilt,
                    rise=float(moved[2]),
                    slide=moved[:2],
                    force=float(force),
                    resultant=resultant,
                    center=center,
                ).items()
            }
        for link, held, tie in zip(
            structure.links, system.links.links if system.links else (), state.ties
        ):
            values = dict(
                tension=tie["force"],
                elongation=tie["length"] - held["length"],
                yielded=tie["flowed"],
                work=tie["work"],
            )
            row |= {f"link/{link.name}/{name}": float(value) for name, value in values.items()} | {
                f"link/{link.name}/broken": int(tie["broken"])
            }
        return of_both_sides(row, structure)

    def _slid(self, x: NDArray[Any], moved: NDArray[Any]) -> NDArray[Any]:
        """Displacement (3,) [m] of the middle of the observed body's foot, on the mean over its
        area; of its centre of mass, as `moved` (nb, 3) has it, where it has none.
        """
        if self._surface is None:
            shifted: NDArray[Any] = moved[self.body]
            return shifted
        one, part, rows = (
            self._meshed[self.body],
            self.structure.parts[self.body],
            self.system.bodies.rows[self.body],
        )
        share = self._surface.areas / self._surface.areas.sum()
        places = one.body.gather(one.nodes[self._surface.nodes], x[rows])
        slid: NDArray[Any] = share @ (places - part.center - part.model.arms[self._surface.nodes])
        return slid

    def _top(self, b: int, x: NDArray[Any]) -> NDArray[Any]:
        """Displacement (3,) [m] of the mean of a body's top face."""
        one, part = self._meshed[b], self.structure.parts[b]
        now = one.shares @ one.body.gather(one.top, x[self.system.bodies.rows[b]])
        moved: NDArray[Any] = now - (part.center + part.model.marks["top"][0])
        return moved

    def fallen(self, state: State, measures: dict[str, Any], steepest: float) -> int:
        """As `reduced.observe.outcome_of_row`; on all ranks together."""
        tilts = []
        for center, part in zip(self._centers, self.structure.parts):
            if center[2] + measures[f"body/{part.name}/displacement"][2] < min(
                self.structure.levels
            ):
                return FELL
            tilts.append(measures[f"body/{part.name}/tilt"])
        limits, R = self._limits, state.rotation.copy()
        if (tilts > limits.tilts).any():
            return NO_RETURN
        # a body leans from another by no more than both do from the vertical
        if 2 * max(tilts) > limits.standing["critical"].min():
            spins, force = self._spins(state), measures["contact_force"]
            for b in range(len(tilts)):
                if interpreted(is_past_no_return)(
                    limits.standing, limits.corners, R, spins, b, force, float(steepest)
                ):
                    return NO_RETURN
        return CAPPED if np.hypot(*measures["u_top"][:2]) >= self.stance.cap else STANDS

    def motion(self, state: State) -> RigidMotion:
        """Rigid motion of the bodies; on all ranks together."""
        bodies = self.system.bodies
        frames = dict(
            center=bodies.centers(state.x),
            velocity=bodies.centers(state.v),
            spin=self._spins(state),
        )
        return RigidMotion(state.time, frames, state.rotation)

    def _spins(self, state: State) -> NDArray[Any]:
        """Angular velocities (nb, 3) [rad/s] in the frames of the bodies, of rigid ones with their
        angular momentum.
        """
        column, spins = self.system.bodies, []
        momentum, centers = column.momentum(state.v), column.centers(state.x)
        for part, rows, center, R in zip(
            self.structure.parts, column.rows, centers, state.rotation
        ):
            arms = state.x[rows] - center
            angular = column.sum(vector_product(arms, momentum[rows]).sum(axis=0))
            spins.append(np.linalg.solve(part.model.inertia, R.T @ angular))
        return np.array(spins)
