"""Siconos (Debian python3-siconos), run by the system's Python: a rigid column that rolls on its
rim on a plane that is shaken, Moreau-Jean time stepping in three dimensions.

    /usr/bin/python3 -P siconos.py JOB.npz FOUND.npz

Four points of the rim may touch: the lowest one and, each a quarter of the rim on, three others.
They go round the rim as it rolls, so that it is round. Their gap is written in Python, as Siconos
offers it, and is part of the cost of a step. Settings come with the job, see `programs.py`.
"""

import json
import math
import os
import sys
import time

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn


class RimPoint(sk.NewtonEuler3DR):
    """The point a quarter of the rim times `turns` on from the lowest one; below: height of the
    centre of mass above the rim's plane [m]. Plain numbers: arrays of three cost more than sums.
    """

    def __init__(self, radius, below, turns):
        super().__init__()
        self.radius, self.below = radius, below
        self.quarter = ((1, 0), (0, 1), (-1, 0), (0, -1))[turns]

    def computeh(self, time, q, y):
        """Gap y, place and normal of the contact, in place: setpc1 and setnc of this package
        crash.
        """
        x, y0, z0, w, a, b, c = q.tolist()
        # third row of the body's frame: the foot falls most along minus its first two
        up_x, up_y = 2 * (a * c - w * b), 2 * (b * c + w * a)
        length = math.hypot(up_x, up_y)
        down_x, down_y = (-up_x / length, -up_y / length) if length > 1e-12 else (1.0, 0.0)
        cosine, sine = self.quarter
        arm_x = self.radius * (cosine * down_x - sine * down_y)
        arm_y = self.radius * (sine * down_x + cosine * down_y)
        arm_z = -self.below
        x += (
            (1 - 2 * (b * b + c * c)) * arm_x
            + 2 * (a * b - w * c) * arm_y
            + 2 * (a * c + w * b) * arm_z
        )
        y0 += (
            2 * (a * b + w * c) * arm_x
            + (1 - 2 * (a * a + c * c)) * arm_y
            + 2 * (b * c - w * a) * arm_z
        )
        z0 += up_x * arm_x + up_y * arm_y + (1 - 2 * (a * a + b * b)) * arm_z
        y[0] = z0
        for point, height in ((self.pc1(), z0), (self.pc2(), 0.0)):
            point[0], point[1], point[2] = x, y0, height
        normal = self.nc()
        normal[0], normal[1], normal[2] = 0.0, 0.0, 1.0


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
        point = RimPoint(float(radius), float(half - job["middle"][0][2]), turns)
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
