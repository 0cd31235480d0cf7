"""One analysis of a structure with the full-order engine."""

from __future__ import annotations

import numpy as np

from fecolumn.case import GRAVITY
from fecolumn.dynamics.analysis import FullAnalysis
from fecolumn.schema import InputError
from fecolumn.structures.analysis import OfStructure
from fecolumn.structures.engine import leans, upright
from fecolumn.structures.pads import warn_of_grounds


class FullStructureAnalysis(OfStructure, FullAnalysis):
    """A running analysis of a structure of many bodies with all their degrees of freedom."""

    def built(self, file):
        from fecolumn.dynamics.hht import HHT
        from fecolumn.dynamics.structure import kinematics_of, structure_system
        from fecolumn.structures.elements import structure_of_elements
        from fecolumn.structures.lost import limits_of
        from fecolumn.structures.observer import StructureObserver
        from fecolumn.structures.structure import standing_of

        case, plan = self.case, self.case.integration
        self.structure, self.meshed = structure_of_elements(case, self.comm, file)
        #: The structure before any body leans or moves: gravity energy and displacements are
        #: measured from there.
        self.standing = upright(case, self.structure)
        damped = [case.modes_of(name) for name in case.bodies for _ in case.names_of(name)]
        plastic = case.contact.impact == "plastic"
        if not plastic and any(joint.pad for joint in self.structure.joints):
            raise InputError(
                file,
                "contact.impact",
                case.contact.impact,
                "must be plastic where a joint has a pad, whose springs take the place of impacts",
            )
        try:
            system = structure_system(
                self.standing,
                [one.body for one in self.meshed],
                HHT(plan.dt_s, plan.alpha_hht),
                np.array([0.0, 0.0, -GRAVITY]),
                filtered=plastic,
                nodes=[one.nodes for one in self.meshed],
                damped=damped,
                kinematics=kinematics_of(plan.kinematics),
            )
        except ValueError as error:
            name, _, told = str(error).partition(": ")
            raise InputError(file, name, None, told) from None
        limits = limits_of(self.standing, standing_of(case, self.standing))
        return system, StructureObserver(
            system, self.meshed, self.standing, limits, case.overturn.displacement_m
        )

    @property
    def leans(self) -> bool:
        return leans(self.structure)

    def released(self, standing):
        from fecolumn.dynamics.structure import released

        return released(self.system, self.structure.parts, None if self.leans else standing)

    def drawn(self):
        from fecolumn.post.structure_scene import scene_of
        from fecolumn.structures.fields import StructureFields

        scene = scene_of(self.case, self.standing, self.folder / "case.json")
        points = self.system.interface.points
        return StructureFields(scene, self.system.bodies, self.meshed, self.standing, points)

    def warn_of_grounds(self, file) -> None:
        warn_of_grounds(self.case, self.structure, file)

    def off_base(self, failure):
        def foot(joint, _, nodes):
            return self.foot(joint.slave, self.meshed[joint.slave].nodes[nodes])

        return self.off_ground(failure, self.system.bases, self.state.grounds, foot)
