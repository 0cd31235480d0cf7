"""A standing shear wave of a free cube, away from the base: convergence in space and in time.

Requirement: displacements converge with order 2 in the brick size for bricks of degree 1, at least order 3 for degree 2, and
with order 2 in the time step for every alpha.

Derivation. On a cube of side L, with k = pi / L,

    u = A sin(w t) (cos kx sin ky, -sin kx cos ky, 0),    w = sqrt(2) k sqrt(mu / rho),

solves the equations of linear elasticity with all six faces free, for any Poisson's ratio: div u = 0, the shear strain e_xy and
all strains with z vanish, and e_xx = -e_yy = -k sin kx sin ky is nil on the faces x, y = 0, L (Lame's equivoluminal mode; Lamb
1917). Galerkin's error of a mode of wave number k in the L2 norm is C (k h)^(p+1); HHT's is C (w dt)^2.

Source: Lame (1852), Lamb (1917); Hughes, The Finite Element Method (2000), section 9 for the orders.

Tolerances. Orders are measured by least squares over three meshes or steps, where the next term of the expansion, (k h)^2 or
(w dt) relative, is still a few per cent: 0.1 of the order. The frequency of trilinear bricks with consistent mass is too high by
(k h)^2 / 24 for each direction of the wave: error of a sixth of a period below w t (k h)^2 / 24 = 0.043 (k h)^2, twice that allowed.
"""

from __future__ import annotations

import numpy as np

from fecolumn.case import GRAVITY
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.system import State
from fecolumn.verification.models import block_system, box
from fecolumn.verification.result import Result, Row
from fecolumn.verification.trial import Trial

SIDE, AMPLITUDE, LIFT = 0.1, 1e-7, 0.05  # [m]; strains of 3e-6 keep both kinematics linear
SHEAR, DENSITY = 200e9 / 2.6, 7850.0  # steel, models.block_system
WAVE = np.pi / SIDE
FREQUENCY = np.sqrt(2 * SHEAR / DENSITY) * WAVE  # [rad/s]
UNTIL = np.pi / 3 / FREQUENCY  # a sixth of a period, where neither displacement nor velocity is nil


def run(engine: str, long: bool) -> Result:
    meshes = (4, 6, 8, 12) if long else (4, 6, 8)
    spatial = {1: [error(engine, n, 1, 40) for n in meshes], 2: [error(engine, n, 2, 160) for n in (1, 2, 3)]}
    sizes = {1: SIDE / np.array(meshes), 2: SIDE / np.array([1, 2, 3])}
    order = {degree: _slope(sizes[degree], errors) for degree, errors in spatial.items()}
    allowed = 2 * UNTIL * FREQUENCY * (WAVE * sizes[1][-1]) ** 2 / 24
    result = Result([Row(f"displacement / amplitude, {meshes[-1]} bricks a side", 0.0, spatial[1][-1], allowed, order=order[1]),
                     Row("order in h, bricks of degree 1", 2.0, order[1], 0.1),
                     Row("order in h, bricks of degree 2: short of 3", 0.0, max(3.0 - order[2], 0.0), 0.1)])
    counts, temporal = (4, 6, 9), {}
    for alpha in (0.0, -0.1, -0.333):
        reference = displacement(engine, 4, 1, 300, alpha)
        temporal[alpha] = [_norm(displacement(engine, 4, 1, count, alpha) - reference) / _norm(reference) for count in counts]
        result.rows.append(Row(f"order in dt, alpha {alpha:g}", 2.0, _slope(UNTIL / np.array(counts), temporal[alpha]), 0.1))

    def draw(figure):
        left, right = figure.subplots(1, 2)
        for degree, (colour, marker) in {1: ("#0072B2", "o"), 2: ("#D55E00", "s")}.items():
            left.loglog(WAVE * sizes[degree], spatial[degree], marker + "-", color=colour, label=f"degree {degree}, order {order[degree]:.2f}")
        left.set(xlabel="$k h$", ylabel="error / amplitude (L2)")
        left.legend()
        for (alpha, errors), marker in zip(temporal.items(), "os^"):
            right.loglog(FREQUENCY * UNTIL / np.array(counts), errors, marker + "-", label=rf"$\alpha$ = {alpha:g}")
        steps = FREQUENCY * UNTIL / np.array(counts)
        right.set(xlabel=r"$\omega\,\Delta t$", ylabel="error / amplitude (L2)")
        right.set_xticks(steps, [f"{step:.2f}" for step in steps])
        right.minorticks_off()
        right.legend()

    result.draw = draw
    return result


def mode(points: np.ndarray) -> np.ndarray:
    """The mode's shape (n, 3) at points (n, 3) [m]."""
    x, y = WAVE * points[:, 0], WAVE * points[:, 1]
    return np.stack([np.cos(x) * np.sin(y), -np.sin(x) * np.cos(y), np.zeros_like(x)], axis=1)


def released(system, velocity: np.ndarray) -> State:
    """The body released LIFT above the base with a velocity field (n, 3) [m/s]: unstrained, so that only gravity accelerates it."""
    column, interface = system.column, system.interface
    x = column.X + [0.0, 0.0, LIFT]
    rotation, internal, strain = system.kinematics.internal(x)
    relative = interface.dynamic_position(x, rotation)
    return State(time=0.0, x=x, v=velocity, a=np.tile(system.gravity, (len(x), 1)), contact_a=np.zeros_like(x),
                 internal=internal, strain=strain, rotation=rotation, forces=np.zeros((interface.size, 3)),
                 anchors=relative[:, :2].copy(), relative=relative, static=0.0, ground=np.zeros(3))


def displacement(engine: str, bricks: int, degree: int, steps: int, alpha: float, shape=None) -> np.ndarray:
    """Nodal displacements / amplitude (n, 3) after a sixth of a period; `shape` (list) takes system and mode."""
    line = np.linspace(0, SIDE, bricks + 1)
    wide = np.linspace(-SIDE, 2 * SIDE, 3)
    system = block_system(engine, box(line, line, line), box(wide, wide, [-SIDE, 0.0]), HHT(UNTIL / steps, alpha),
                          order=degree)
    trial = Trial(system, lambda system: released(system, AMPLITUDE * FREQUENCY * mode(system.column.X)))
    for _ in range(steps):
        trial.step()
    if shape is not None:
        shape += [system, mode(system.column.X)]
    fallen = [0.0, 0.0, LIFT - GRAVITY * UNTIL**2 / 2]  # HHT is exact for a constant acceleration
    return (trial.state.x - system.column.X - fallen) / AMPLITUDE


def error(engine: str, bricks: int, degree: int, steps: int) -> float:
    """L2 error of the displacement relative to the wave's amplitude [-]."""
    found = []
    wrong = displacement(engine, bricks, degree, steps, 0.0, found)
    system, shape = found
    wrong -= np.sin(FREQUENCY * UNTIL) * shape
    column = system.column
    size = [column.dot(field, column.apply(column.mass, field)) for field in (wrong, shape)]
    return float(np.sqrt(size[0] / size[1]))


def _norm(field: np.ndarray) -> float:
    return float(np.linalg.norm(field))


def _slope(steps, errors) -> float:
    """Order of convergence by least squares."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
