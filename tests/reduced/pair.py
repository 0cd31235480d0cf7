"""The coarse specimen in both engines from the same finite-element operators."""

import numpy as np

from fecolumn.case.sections import Initial
from fecolumn.engines.dynamics import gravity
from fecolumn.engines.reduced import start
from fecolumn.engines.reduced.observe import COLUMNS
from fecolumn.structures.place import Standing, placed
from fecolumn.verification.models import column_system
from fecolumn.verification.one_foot import engine_on, foot_model, on_base
from fecolumn.verification.trial import Trial

PLACES = dict(zip([name for name, _ in COLUMNS], np.cumsum([0] + [width for _, width in COLUMNS])))


def top_nodes(body):
    height = body.all_X[:, 2]
    nodes = np.flatnonzero(height > height.max() - 1e-9)
    return nodes, np.full(len(nodes), 1 / len(nodes))


def reduced(system, n_modes=30, begin=start.gravity_equilibrium, overturn=0.25):
    """The reduced engine of a full-order system."""
    foot = system.footprint
    model, _ = foot_model(system.body, foot.nodes, foot.areas, top_nodes(system.body)[0], n_modes)
    ratio = system.damping.each[0].ratio if system.damping else 0.0
    structure = on_base(model, system.base, damping_ratio=ratio, **system.laws)
    return engine_on(structure, system.hht, begin, system.gravity, overturn)


def tops(system, grounds, begin=gravity.standing):
    """Displacement (n, 3) [m] of the top's middle in the full-order engine, and its trial."""
    trial = Trial(system, begin)
    nodes, weights = top_nodes(system.body)
    return np.array(
        [weights @ (trial.step(ground).x[nodes] - system.body.X[nodes]) for ground in grounds]
    ), trial


def tilted_motion(engine, tilt, direction):
    """The motion of the unstrained body turned by `tilt` [rad] about its rim, towards `direction`
    [rad].
    """
    structure, motion = engine.model, engine.motion_at_rest()
    initial = Initial(tilt_rad=tilt, direction_deg=float(np.degrees(direction)))
    parts = [Standing(part.name, part.model, part.center, initial) for part in structure.parts]
    (there,) = placed(parts, list(structure.joints), "")
    motion.frames["center"], motion.rotation[:] = there.center, there.rotation
    return start.unstrained(engine, motion)


def column(rows, name, width=1):
    """A column of the reduced engine's rows."""
    place = PLACES[name]
    return rows[:, place] if width == 1 else rows[:, place : place + width]


def system_of(**tables):
    return column_system("corotated", **tables)
