"""Siconos 4.4 (Debian python3-siconos), run by the system's Python: the column as a rigid body,
Moreau-Jean time stepping.

    /usr/bin/python3 -P siconos.py JOB.npz FOLDER

Settings. theta = 1/2, which has no numerical damping; Newton's law with e = 0 and Coulomb's
friction, NSGS to 1e-12. Four points of the rim may touch, the toes and those between; their gap is
written in Python, as Siconos offers it, and is part of the cost of a step.
"""

import sys
import time

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn


def turned(q, arm):
    """Vector (3,) of the body's frame in the table's; q: position and unit quaternion (7,)."""
    w, axis = q[3], q[4:7]
    return arm + 2 * np.cross(axis, np.cross(axis, arm) + w * arm)


class RimPoint(sk.NewtonEuler3DR):
    """A point of the body above the plane z = 0, at `arm` (3,) [m] from its centre of mass."""

    def __init__(self, arm):
        super().__init__()
        self.arm = np.asarray(arm, float)

    def computeh(self, time, q, y):
        """Gap y, place and normal of the contact, in place: setpc1 and setnc of this
        package crash.
        """
        here = q[:3] + turned(q, self.arm)
        y[0] = here[2]
        self.pc1()[:] = here
        self.pc2()[:] = [here[0], here[1], 0.0]
        self.nc()[:] = [0.0, 0.0, 1.0]


def main(job_file, folder):
    job = np.load(job_file)
    dt, steps, radius, tilt = (
        float(job["dt"]),
        int(job["steps"]),
        float(job["radius"]),
        float(job["tilt"]),
    )
    mass, weight, centre = (
        float(job["mass"]),
        float(job["mass"]) * float(job["gravity"]),
        job["centre"],
    )
    pivot = np.array([radius, 0.0, 0.0])
    start = [
        *(pivot + job["turn"] @ (centre - pivot)),
        np.cos(tilt / 2),
        0.0,
        np.sin(tilt / 2),
        0.0,
    ]
    body = sk.NewtonEulerDS(start, [0.0] * 6, mass, np.diag(np.diag(job["inertia"])))
    force = np.array([0.0, 0.0, -weight])  # Siconos copies it
    body.setFExtPtr(force)
    system = sk.NonSmoothDynamicalSystem(0.0, dt * (steps + 1))
    system.insertDynamicalSystem(body)
    law, kept = sk.NewtonImpactFrictionNSL(0.0, 0.0, float(job["friction"]), 3), []
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        point = RimPoint(np.array([x * radius, y * radius, 0.0]) - centre)
        contact = sk.Interaction(law, point)
        system.link(contact, body)
        kept.append((point, contact))
    scheme, problem = sk.MoreauJeanOSI(0.5), sk.FrictionContact(3, sn.SICONOS_FRICTION_3D_NSGS)
    options = problem.numericsSolverOptions()
    options.iparam[0], options.dparam[0] = 10000, 1e-12
    simulation = sk.TimeStepping(system, sk.TimeDiscretisation(0.0, dt), scheme, problem)
    simulation.setNewtonTolerance(1e-10)
    simulation.setNewtonMaxIteration(20)

    with open(f"{folder}/track.csv", "w", buffering=1) as track:
        cpu, ok = 0.0, 1
        for step in range(steps + 1):
            if step:
                began = time.process_time()
                simulation.computeOneStep()
                ok = int(options.dparam[1] <= 1e-10 or options.iparam[1] < options.iparam[0])
                simulation.nextStep()
                cpu += time.process_time() - began
            q, v = np.array(body.q()), np.array(body.twist())
            axis = turned(q, np.array([0.0, 0.0, 1.0]))
            toes = [
                q[0] + turned(q, np.array([sign * radius, 0.0, 0.0]) - centre)[0] - sign * radius
                for sign in (1, -1)
            ]
            energy = (
                mass / 2 * v[:3] @ v[:3]
                + v[3:] @ job["inertia"] @ v[3:] / 2
                + weight * (q[2] - centre[2])
            )
            iterations = simulation.getNewtonNbIterations() if step else 0
            row = (step * dt, np.arctan2(axis[0], axis[2]), *toes, energy, cpu, iterations, ok)
            track.write(",".join(f"{value:.12g}" for value in row) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
