"""The coarse specimen in both engines from the same finite-element operators."""

from dataclasses import replace

import numpy as np

from fecolumn.case.sections import Initial
from fecolumn.engines.dynamics import gravity
from fecolumn.engines.reduced import start
from fecolumn.engines.reduced.observe import COLUMNS
from fecolumn.engines.reduced_engine import engine_on
from fecolumn.structures.place import placed
from fecolumn.structures.reduction import with_elasticity
from fecolumn.structures.standing import Standing
from fecolumn.verification.models import column_system
from fecolumn.verification.trial import Trial

PLACES = dict(zip([name for name, _ in COLUMNS], np.cumsum([0] + [width for _, width in COLUMNS])))


def top_nodes(body):
    height = body.all_X[:, 2]
    nodes = np.flatnonzero(height > height.max() - 1e-9)
    return nodes, np.full(len(nodes), 1 / len(nodes))


def with_modes(system, n_modes):
    """The StructureModel of a column in full order, its body reduced."""
    (part,), nodes = system.model.parts, system.interface.foot.nodes[0]
    model, _ = with_elasticity(part.model, system.body, nodes, n_modes, top_nodes(system.body))
    return replace(system.model, parts=(replace(part, model=model),))


def reduced(system, n_modes=30, begin=start.gravity_equilibrium, overturn=0.25):
    """The reduced engine of a full-order system."""
    return engine_on(with_modes(system, n_modes), system.hht, begin, cap=overturn)


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
