"""The same structures as cases of the package: rigid blocks whose corners alone may touch, shaken
along x.

All are as deep as the narrowest of them is wide: in the plane depth changes nothing, and a narrow
face then has its four corners only.
"""

from __future__ import annotations

import numpy as np

from benchmarks.planar.bodies import BOTTOM, LEFT, RIGHT, TOP, Structure
from benchmarks.planar.shaken import EVERY, Response, Shaken

# Young's modulus by which contact points give [Pa]: nothing
_STIFF = 1e14


def tables(structure: Structure, dt: float) -> dict:
    """Tables of the case file of a structure of rectangles that stand on one another or beside one
    another.

    Raises
    ------
    ValueError
        another outline, or faces that neither stand on one another nor look at one another.
    """
    bodies, joints = {}, {}
    depth = min(float(np.ptp(body.outline[:, 0])) for body in structure.bodies if not body.fixed)
    for body in structure.bodies:
        if body.fixed:
            continue
        (x, z), (right, _), (upper, top), _ = body.outline
        if upper != right:
            raise ValueError(f"{body.name}: the package's blocks are rectangles")
        bodies[name_of(body)] = dict(
            kind="block",
            length_m=right - x,
            width_m=depth,
            height_m=top - z,
            density_kg_m3=body.density,
            at_m=[(x + right) / 2, 0.0, z],
            rigid=True,
            youngs_modulus_pa=_STIFF,
            poissons_ratio=0.2,
            element_size_m=depth,
        )
    for joint in structure.joints:
        one, other = structure.bodies[joint.body], structure.bodies[joint.other]
        if (joint.face, joint.other_face) not in ((BOTTOM, TOP), (RIGHT, LEFT)):
            raise ValueError(
                f"{one.name} and {other.name}: the package's bodies stand on or beside one another"
            )
        if not other.fixed and np.ptp(other.outline[:, 0]) < np.ptp(one.outline[:, 0]):
            one, other = other, one  # the narrower face has the points
        joints[f"{name_of(one)}_{name_of(other)}"] = dict(
            between=[name_of(one), "ground" if other.fixed else name_of(other)],
            friction_coefficient=joint.friction,
        )
    return dict(
        bodies=bodies,
        joints=joints,
        contact=dict(interior_points=0),
        integration=dict(engine="rigid", dt_s=dt, duration_s=600.0),
    )


def name_of(body) -> str:
    """Of a body in a case file."""
    return body.name.replace(" ", "_")


def respond(case: Shaken, ground: np.ndarray, dt: float) -> Response:
    """Response to accelerations (n,) [m/s2] at steps of dt [s], in chunks of a second."""
    from fecolumn.case.case import case_from_tables
    from fecolumn.contact.overturning import steepest_to_come
    from fecolumn.engines.dynamics.cuts import StepFailed
    from fecolumn.engines.history_columns import columns_of
    from fecolumn.engines.reduced_engine import engine_of
    from fecolumn.structures.structure import structure_model

    whole = case_from_tables(tables(case.structure, dt), "benchmarks.planar")
    engine = engine_of(whole, structure_model(whole), "benchmarks.planar")
    shaken, each = np.outer(ground, [1.0, 0.0, 0.0]), round(EVERY / dt)
    steepest, rows, ended, failed = (
        steepest_to_come(engine.structure.gravity, shaken),
        [engine.row()[None]],
        False,
        "",
    )
    chunk = 1000 * each
    for first in range(1, len(ground), chunk):
        try:
            made, ended = engine.advance(
                shaken[first : first + chunk], steepest[first : first + chunk]
            )
        except StepFailed as error:
            made, failed = engine.made, str(error)
        rows.append(made[each - 1 :: each])
        if ended or failed:
            rows.append(made[-1:])
            break
    columns = columns_of(np.concatenate(rows), engine.model)
    names = [name_of(body) for body in case.structure.bodies if not body.fixed]
    tilt = np.column_stack([columns[f"body/{name}/tilt"] for name in names])
    top = columns[f"mark/{name_of(case.structure.bodies[case.observed])}.top/displacement"][:, 0]
    return Response(columns["time"], top, tilt, bool(ended), failed)
