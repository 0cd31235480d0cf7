"""Siconos (Debian python3-siconos), run by the system's Python: a rigid column that rolls on its
rim on a plane that is shaken, Moreau-Jean time stepping in three dimensions.

    /usr/bin/python3 -P siconos.py JOB.npz FOUND.npz

Four points of the rim may touch: the lowest one and, each a quarter of the rim on, three others.
They go round the rim as it rolls, so that it is round. Their gap is written in Python, as Siconos
offers it, and is part of the cost of a step. Settings come with the job, see `programs.py`.
"""

import json
import os
import sys
import time

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn


def frame_of(q):
    """Matrix (3, 3) of a unit quaternion q[3:7]."""
    w, x, y, z = q[3:7]
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


class RimPoint(sk.NewtonEuler3DR):
    """The point a quarter of the rim times `turns` on from the lowest one; centre: (3,) of the rim
    from the centre of mass.
    """

    def __init__(self, radius, centre, turns):
        super().__init__()
        self.radius, self.centre = radius, centre
        self.quarter = (np.cos(turns * np.pi / 2), np.sin(turns * np.pi / 2))

    def computeh(self, time, q, y):
        """Gap y, place and normal of the contact, in place: setpc1 and setnc of this package
        crash.
        """
        frame = frame_of(q)
        # downwards along the foot, in the body's frame; of an upright column any direction
        down = -frame[2, :2]
        length = np.hypot(*down)
        down = down / length if length > 1e-12 else np.array([1.0, 0.0])
        c, s = self.quarter
        arm = self.centre.copy()
        arm[:2] += self.radius * np.array([c * down[0] - s * down[1], s * down[0] + c * down[1]])
        here = np.asarray(q)[:3] + frame @ arm
        y[0] = here[2]
        self.pc1()[:] = here
        self.pc2()[:] = [here[0], here[1], 0.0]
        self.nc()[:] = [0.0, 0.0, 1.0]


def main(job_file, found_file):
    # the package prints lines: a stream that refuses one stays shut
    os.dup2(os.open(os.devnull, os.O_RDONLY), 1)
    job = np.load(job_file)
    settings, ground = json.loads(str(job["settings"])), job["ground"]
    dt, every = float(job["dt"]), int(job["every"])
    (mass,), (inertia,), gravity = job["mass"], job["inertia"], float(job["gravity"])
    (radius, half, _), limit = job["sizes"][0], np.cos(float(job["fallen"]))
    start = [*job["place"][0], *job["turn"][0]]
    body = sk.NewtonEulerDS(start, [0.0] * 6, float(mass), np.diag(inertia))
    force = sk.SiconosVector([0.0, 0.0, -mass * gravity])
    body.setFExtPtr(force)
    system = sk.NonSmoothDynamicalSystem(0.0, dt * (len(ground) + 1))
    system.insertDynamicalSystem(body)
    law, kept = sk.NewtonImpactFrictionNSL(0.0, 0.0, float(job["friction"]), 3), []
    for turns in range(4):
        point = RimPoint(radius, job["middle"][0] - [0.0, 0.0, half], turns)
        contact = sk.Interaction(law, point)
        system.link(contact, body)
        kept.append((point, contact))
    problem = sk.FrictionContact(3, sn.SICONOS_FRICTION_3D_NSGS)
    options = problem.numericsSolverOptions()
    sweeps, tolerance = settings["sweeps"], settings["tolerance"]
    options.iparam[0], options.dparam[0] = sweeps, tolerance
    scheme, times = sk.MoreauJeanOSI(settings["theta"]), sk.TimeDiscretisation(0.0, dt)
    simulation = sk.TimeStepping(system, times, scheme, problem)
    simulation.setNewtonTolerance(settings["newton"])
    simulation.setNewtonMaxIteration(20)
    push = -float(mass) * (ground[1:] + ground[:-1]) / 2
    rows, cpu, unsolved = [np.concatenate([body.q(), body.twist()])], 0.0, 0
    for step, a in enumerate(push, 1):
        force.setValue(0, a[0])
        force.setValue(1, a[1])
        began = time.process_time()
        simulation.computeOneStep()
        solved = options.iparam[1] < sweeps or options.dparam[1] <= tolerance
        unsolved += not (solved and simulation.isNewtonConverge())
        simulation.nextStep()
        cpu += time.process_time() - began
        if step % every == 0:
            rows.append(np.concatenate([body.q(), body.twist()]))
            if 1 - 2 * (rows[-1][4] ** 2 + rows[-1][5] ** 2) < limit:
                break
    rows = np.array(rows)[:, None]
    np.savez(
        found_file,
        place=rows[..., :3],
        turn=rows[..., 3:7],
        velocity=rows[..., 7:10],
        spin=rows[..., 10:],
        cpu_s=cpu,
        steps=step,
        unsolved=unsolved,
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
