"""Rocking models of rigid bodies from the case of a structure: its bodies and where they stand."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from fecolumn.case.bodies import Block, Cylinder, Storeys, Tube
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.case.check_way import check_way
from fecolumn.case.checked import Refuse, refuse_in
from fecolumn.case.ground import GROUND_NAME
from fecolumn.case.joint import Joint, own_contact
from fecolumn.case.model_keys import UNKNOWN_KEYS
from fecolumn.case.model_table import Start
from fecolumn.case.sections import Initial
from fecolumn.engines.rocking.block import RockingBlock
from fecolumn.engines.rocking.column import RigidColumn, rigid_body
from fecolumn.engines.rocking.frame import RockingFrame
from fecolumn.engines.rocking.model import Model
from fecolumn.engines.rocking.models import ROCKING_MODELS
from fecolumn.engines.rocking.podium import Podium
from fecolumn.engines.rocking.soft_ground import tell_of_soft_ground
from fecolumn.engines.rocking.storeys import shear_building
from fecolumn.engines.rocking.wobbling import Wobbling, cylinder_body
from fecolumn.engines.rocking.wobbling_frame import WobblingFrame
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.schema import InputError, Section
from fecolumn.structures.storeys import building_of

# Gap between two bodies, over the height of the lower one, up to which one stands on the other:
# chosen, far above the rounding of places that are typed
_TOUCHES = 1e-3
#: Models of a frame that rocks in the plane of x
ALONG_X = ("rocking_frame", "podium")


def model_of(case: Case, file: Path | str) -> Model:
    """The model that integration.engine of a case names, of its own table or of its bodies.

    housner, wobbling: one body on the ground. rocking_frame, wobbling_frame: equal columns on the
    ground and a body on all of them. podium: the same, a body of storeys on them.

    Raises
    ------
    InputError
        the bodies are not those of the model; it says what they lack.
    """
    sections = list(case.own.values())
    model: Model = (
        ROCKING_MODELS[case.integration.engine].of_section(sections[0], file)
        if sections
        else _Reader(case, file).model()
    )
    # a top that leans by the critical tilt has gone its height times the sine of that, nearly
    if model.critical_tilt > 0:
        height = model.critical_displacement / math.sin(model.critical_tilt)
        check_way(case.overturn, height, refuse_in(file))
    return model


def start_of(case: Case, file: Path | str) -> Start:
    """Tilt and direction at the start of the body that rocks, or of all columns alike.

    Raises
    ------
    InputError
        columns that start unlike, or what a model cannot start with.
    """
    for name, section in case.own.items():
        start = case.initial[name]
        in_plane = name == "block" and not getattr(section, "depth_m", None)
        if start.tilt_rad and (in_plane or case.integration.engine in ALONG_X):
            _check_direction(name, section, start.direction_deg, refuse_in(file))
        return Start(tilt_rad=start.tilt_rad, direction_deg=start.direction_deg)
    return _Reader(case, file).start()


def _check_direction(name: str, section: Section, direction: float, refuse: Refuse) -> None:
    """Refuse a start [deg] across the plane x, z of a model's own table, or into the wall behind
    it.
    """
    key = "initial.direction_deg"
    if direction % 180.0:
        refuse(key, direction, f"must be 0 or 180 deg: [{name}] rocks in the plane of x")
    if getattr(section, "sides", 2) == 1 and direction % 360.0:
        told = "must be 0 deg where block.sides = 1: a wall stands on the other side"
        refuse(key, direction, told)


def rocking_bodies(case: Case, file: Path | str) -> tuple[str, str]:
    """The body that rocks, all its copies alike, and that on all of them, "" where there is none.

    Raises
    ------
    InputError
        the bodies are not those of the model; it says what they lack.
    """
    reader = _Reader(case, file)
    return (reader.alone(), "") if reader.is_of_one else reader.columns()


class _Reader:
    """Reads a Case for a model, which it refuses by name."""

    def __init__(self, case: Case, file: Path | str) -> None:
        self.case, self.file, self.engine = case, file, case.integration.engine

    @property
    def is_of_one(self) -> bool:
        """Whether the model is of one body."""
        return self.engine in ("housner", "wobbling")

    def model(self) -> Model:
        """As `model_of`."""
        self._refuse_laws()
        if self.is_of_one:
            name = self.alone()
            body, friction = rigid_body(self.case, name, self.file), self._friction(name)
            self._check_standing(name, body)
            tell_of_soft_ground(self.case, body, body.mass, self.file)
            kind = RockingBlock if self.engine == "housner" else Wobbling
            return kind.of_body(body, friction, self.file)
        name, slab = self.columns()
        count, friction = len(self.case.bodies[name].places), self._friction(name)
        body = rigid_body(self.case, name, self.file)
        self._check_standing(name, body, slab)
        carried = body.mass + self._mass(slab) / count
        tell_of_soft_ground(self.case, body, carried, self.file)
        if self.engine == "wobbling_frame":
            return self._wobbling_frame(name, body, slab, count, friction)
        half, height = self._upright_block(name)
        alpha, diagonal = math.atan2(half, height / 2), math.hypot(half, height / 2)
        if self.engine == "rocking_frame":
            return RockingFrame.of(
                count, alpha, diagonal, body.mass, self._mass(slab), friction=friction
            )
        return self._podium(name, slab, alpha, diagonal, count * body.mass)

    def start(self) -> Start:
        """As `start_of`."""
        name, slab = rocking_bodies(self.case, self.file)
        found: dict[int, Initial] = {}
        for key in sorted(self.case.initial, key=lambda one: one not in self.case.bodies):
            one = self.case.initial[key]
            if one.moves:
                moving = "velocity_m_s" if any(one.velocity_m_s) else "spin_rad_s"
                self._refuse(
                    f"initial.{key}.{moving}",
                    list(getattr(one, moving)),
                    f"must be 0 where integration.engine = {self.engine!r}; it starts from "
                    "tilt_rad",
                )
            copies = self.case.copies_of(key)
            if any(body == slab for body, _ in copies) and one.tilt_rad:
                self._lacks(f'starts upright, and "{key}" is what stands on the columns')
            found |= {number: one for body, number in copies if body == name}
        starts = {(one.tilt_rad, one.direction_deg) for one in found.values()}
        if found and len(found) < len(self.case.bodies[name].places):
            starts.add((0.0, 0.0))
        if len(starts) > 1:
            self._lacks(f'needs one start for all of "{name}", which lean alike')
        tilt, direction = starts.pop() if starts else (0.0, 0.0)
        start = Start(tilt_rad=tilt, direction_deg=direction)
        if self.engine in ALONG_X and start.tilt_rad:
            if start.direction_deg % 180.0:
                self._lacks(
                    f"rocks along x: direction_deg = {start.direction_deg:g} must be 0 or 180"
                )
        return start

    def _refuse(self, key: str, value: object, allowed: str) -> NoReturn:
        raise InputError(self.file, key, value, allowed)

    def _lacks(self, needs: str) -> NoReturn:
        """Refuse the model; `needs` says what it needs."""
        self._refuse("integration.engine", self.engine, needs)

    def _refuse_laws(self) -> None:
        """Refuse keys of which the model knows nothing."""
        stated: dict[str, Any] = {
            f"{section}.{key}": getattr(getattr(self.case, section), key)
            for section, key in UNKNOWN_KEYS
        }
        for name, interface in self.case.joints.items():
            stated[f"joints.{name}.restitution"] = interface.restitution
            stated[f"joints.{name}.rolling_resistance"] = interface.rolling_resistance
            stated[f"joints.{name}.bond_tension_pa"] = interface.bond_tension_pa
        for name, body in self.case.bodies.items():
            # a model of one body takes where that is weighed; frames know the mass alone
            weighed = () if self.is_of_one else ("centre_m", "inertia_kg_m2")
            for key in ("foot_radius_m", "edge_radius_m", "turned_deg", *weighed):
                stated[f"bodies.{name}.{key}"] = getattr(body, key, None)
        for key, value in stated.items():
            if value:
                self._refuse(
                    key,
                    value,
                    f"must be left out where integration.engine = {self.engine!r}: a rigid model "
                    "with an impact law of its own, on flat feet along x and y",
                )
        for name, body in self.case.bodies.items():
            if getattr(body, "fixed", False):
                told = (
                    f"must be false where integration.engine = {self.engine!r}, whose bodies move"
                )
                self._refuse(f"bodies.{name}.fixed", True, told)
        self._refuse_grounds()
        if self.case.links:
            self._lacks("knows no links: leave them out, or choose the reduced or rigid engine")

    def _refuse_grounds(self) -> None:
        """Refuse pads and grounds with a motion of their own."""
        engine = f"where integration.engine = {self.engine!r}"
        for name, ground in self.case.grounds.items():
            if ground.kind == "pad":
                allowed = f"must be rigid, plate or unbounded {engine}: it stands on rigid ground"
                self._refuse(f"grounds.{name}.kind", ground.kind, allowed)
            if ground.motion is not None:
                allowed = f"must be left out {engine}, which knows one motion, that of [motion]"
                self._refuse(f"grounds.{name}.motion.source", ground.motion.source, allowed)
        for name, joint in self.case.joints.items():
            if joint.stiffness_n_m3 is not None:
                allowed = f"must be left out {engine}, which knows no pads"
                self._refuse(f"joints.{name}.stiffness_n_m3", joint.stiffness_n_m3, allowed)

    def _joints(self) -> set[tuple[str, str]]:
        """Pairs of bodies, or a body and the ground, between which there are joints; a ground of
        any name is GROUND_NAME.
        """
        pairs = set()
        for joint in self.case.joints.values():
            own, others = self._sides(joint)
            pairs |= {pair for a in own for b in others for pair in ((a, b), (b, a))}
        return pairs

    def _sides(self, joint: Joint) -> tuple[set[str], set[str]]:
        """Bodies on both sides of a joint, or GROUND_NAME."""
        one, other = (
            {GROUND_NAME}
            if name in self.case.grounds
            else {body for body, _ in self.case.copies_of(name)}
            for name in (joint.slave, joint.on)
        )
        return one, other

    def alone(self) -> str:
        """The one body, which stands on the ground."""
        (name, body), *more = self.case.bodies.items()
        if more or len(body.places) > 1:
            count = sum(len(one.places) for one in self.case.bodies.values())
            self._lacks(f"is of one body on the ground; there are {count}")
        if (name, GROUND_NAME) not in self._joints():
            self._lacks(f'needs an interface between "{name}" and the ground')
        return name

    def columns(self) -> tuple[str, str]:
        """The body whose copies are the columns, and that on them."""
        joints = self._joints()
        below = [name for name in self.case.bodies if (name, GROUND_NAME) in joints]
        if len(self.case.bodies) != 2 or len(below) != 1:
            self._lacks(
                "is of equal columns on the ground, one body with copies_m, and of one body on "
                f"them; there are {len(self.case.bodies)} different bodies, {len(below)} of them "
                "on the ground"
            )
        (slab,) = set(self.case.bodies) - set(below)
        if (slab, below[0]) not in joints or len(self.case.bodies[slab].places) > 1:
            self._lacks(f'needs one "{slab}" that has an interface with "{below[0]}"')
        return below[0], slab

    def _check_standing(self, name: str, own: RigidColumn, slab: str = "") -> None:
        """Refuse a body, all its copies or a slab on them that do not stand where they are drawn on
        what is below them; own: of the body.
        """
        places = self.case.bodies[name].places
        levels = {
            self.case.grounds[ground].level_m
            for joint in self.case.joints.values()
            for ground in (joint.slave, joint.on)
            if {name, GROUND_NAME} <= set().union(*self._sides(joint))
            and ground in self.case.grounds
        } or {0.0}
        for place in places:
            if min(abs(place[2] - level) for level in levels) > _TOUCHES * own.top:
                self._lacks(
                    f'is of what stands on the ground: "{name}" is drawn at z = {place[2]:g} m, '
                    f"the ground is at {', '.join(f'{one:g}' for one in sorted(levels))} m"
                )
        if not slab:
            return
        on, beam = self.case.bodies[slab].places[0], rigid_body(self.case, slab, self.file)
        half = beam.half_foot
        for place in places:
            if abs(place[2] + own.top - on[2]) > _TOUCHES * own.top:
                self._lacks(
                    f'is of a body that lies on all columns: "{slab}" is drawn at z = {on[2]:g} m, '
                    f'the top of a "{name}" is at {place[2] + own.top:g} m'
                )
            if any(abs(place[a] - on[a]) > half[a] for a in range(2)):
                self._lacks(
                    f'is of a body that lies on all columns: the "{name}" at '
                    f'({place[0]:g}, {place[1]:g}) m is beside "{slab}"'
                )
        self._check_level(np.array(places)[:, :2], np.add(on[:2], beam.offset))

    def _check_level(self, places: Array, middle: Array) -> None:
        """Refuse columns at places (n, 2) [m] that do not keep what lies on them level, with its
        centre of mass at `middle` (2,) [m].
        """
        if self.engine in ALONG_X:
            low, high = places[:, 0].min(), places[:, 0].max()
            if not low < middle[0] < high:
                self._lacks(
                    "is of columns on both sides of what they carry, which stays level: its centre "
                    f"of mass is at x = {middle[0]:g} m, the columns are at x = {low:g} to "
                    f"{high:g} m"
                )
            return
        ways = places - places.mean(axis=0)
        if len(places) < 3 or np.linalg.matrix_rank(ways, tol=_TOUCHES * np.ptp(places)) < 2:
            self._lacks(
                "is of three columns or more that are not in a line, so that what they carry stays "
                f"level; there are {len(places)}"
            )
        from scipy.spatial import ConvexHull

        if (ConvexHull(places).equations @ [*middle, 1.0]).max() > 0:
            self._lacks(
                "is of columns around what they carry, which stays level: its centre of mass is at "
                f"({middle[0]:g}, {middle[1]:g}) m, outside of where the columns are"
            )

    def _upright_block(self, name: str) -> tuple[float, float]:
        """Half width along x and height [m] of columns that rock along x."""
        body = self.case.bodies[name]
        if body.kind != "block" or not isinstance(body, Block):
            self._lacks(
                f'needs columns of kind = "block"; "{name}" is a {body.kind}'
                + ("" if self.engine == "podium" else ": wobbling_frame is the model of round ones")
            )
        for key in ("flange", "cap"):
            if plate := getattr(body, key):
                self._refuse(
                    f"bodies.{name}.{key}.thickness_m",
                    plate.thickness_m,
                    f"must be left out where integration.engine = {self.engine!r}, whose columns "
                    "are plain blocks",
                )
        if body.length_m > body.width_m:
            self._lacks(
                f'rocks along x, where "{name}" must be no longer than wide: '
                f"length_m = {body.length_m:g} m, width_m = {body.width_m:g} m"
            )
        return body.length_m / 2, body.height_m

    def _wobbling_frame(
        self, name: str, column: RigidColumn, slab: str, count: int, friction: float
    ) -> WobblingFrame:
        body = self.case.bodies[name]
        is_round = body.kind in ("tube", "cylinder")
        if not is_round or not isinstance(body, (Tube, Cylinder)) or body.flange or body.cap:
            self._lacks(f'needs round columns without flange and cap; "{name}" is a {body.kind}')
        radius = body.outer_diameter_m / 2
        inner = radius - body.wall_m if isinstance(body, Tube) else 0.0
        share = self._mass(slab) / count
        own = cylinder_body(radius, inner, body.height_m, column.mass, share)
        return WobblingFrame(own, count, friction=friction)

    def _podium(
        self, name: str, slab: str, alpha: float, diagonal: float, columns_mass: float
    ) -> Podium:
        body = self.case.bodies[slab]
        if body.kind != "storeys" or not isinstance(body, Storeys):
            self._lacks(f'needs storeys on the columns; "{slab}" is a {body.kind}')
        building = building_of(body)
        found = Podium(
            alpha,
            diagonal,
            columns_mass,
            self._mass(slab),
            shear_building(
                building.masses,
                building.stiffness[:, 0],
                material_of(body, self.case.materials).damping_ratio,
                body.rayleigh_modes if body.damping == "rayleigh" else (),
            ),
        )
        if not found.restitution > 0:
            self._lacks(f'throws columns as stout as "{name}" back: its impact law has no answer')
        return found

    def _friction(self, name: str) -> float:
        """Coefficient of friction between a body and the ground."""
        for joint in self.case.joints.values():
            if {name, GROUND_NAME} <= set().union(*self._sides(joint)):
                return own_contact(joint, self.case.contact).friction_coefficient
        return self.case.contact.friction_coefficient

    def _mass(self, name: str) -> float:
        """Mass [kg] of a body; of storeys that of the slab alone."""
        return rigid_body(self.case, name, self.file).mass
