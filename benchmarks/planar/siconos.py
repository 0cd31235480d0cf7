"""Siconos 4.4 (Debian python3-siconos), run by the system's Python: a planar structure,
Moreau-Jean.

    /usr/bin/python3 -P siconos.py JOB.npz FOUND.npz FOLDER

Lagrangian systems (x, z, angle), Newton's law with e = 0 and Coulomb's friction, NSGS in the plane,
Newton's loop about it; theta, tolerances and sweeps come with the job. A corner and a face that it
may touch are a relation in C, compiled into FOLDER: relations of this kind in Python crash this
package.
A corner acts once its gap is predicted to close within half a step, Siconos's own rule; what it
then sinks in, stays.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn


def library(shapes, folder) -> Path:
    """Relations of shapes (nc, 9), compiled; the path without its ending, as Siconos wants it."""
    source = Path(folder) / "corners.c"
    code = Path(__file__).with_name("siconos_corner.c").read_text()
    for number, shape in enumerate(shapes):
        code += f"CORNER({number}, {', '.join(format(value, '.17g') for value in shape)})\n"
    source.write_text(code)
    path = source.resolve().with_suffix("")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", source, "-o", f"{path}.so", "-lm"], check=True)
    return path


def main(job_file, found_file, folder):
    # the package prints a line for each relation and step: a stream that refuses one stays shut
    os.dup2(os.open(os.devnull, os.O_RDONLY), 1)
    job = np.load(job_file)
    settings = json.loads(str(job["settings"]))
    sweeps, tolerance = settings["sweeps"], settings["tolerance"]
    dt, ground, every, mass = float(job["dt"]), job["ground"], int(job["every"]), job["mass"]
    bodies, forces = [], []
    for m, inertia, place, velocity in zip(mass, job["inertia"], job["place"], job["velocity"]):
        bodies.append(sk.LagrangianLinearTIDS(place, velocity, np.diag([m, m, inertia])))
        # a pointer to this is kept, of an array only a copy
        forces.append(sk.SiconosVector([0.0, -m * float(job["gravity"]), 0.0]))
        bodies[-1].setFExtPtr(forces[-1])
    system = sk.NonSmoothDynamicalSystem(0.0, dt * (len(ground) + 1))
    for body in bodies:
        system.insertDynamicalSystem(body)
    path, kept = library(job["shape"], folder), []
    for number, (pair, friction) in enumerate(zip(job["pairs"], job["friction"])):
        relation = sk.LagrangianScleronomousR(f"{path}:h{number}", f"{path}:G{number}")
        law = sk.NewtonImpactFrictionNSL(0.0, 0.0, float(friction), 2)
        contact = sk.Interaction(law, relation)
        system.link(contact, *(bodies[one] for one in pair if one >= 0))
        kept.append((relation, contact))
    problem = sk.FrictionContact(2, sn.SICONOS_FRICTION_2D_NSGS)
    options = problem.numericsSolverOptions()
    options.iparam[0], options.dparam[0] = sweeps, tolerance
    times = sk.TimeDiscretisation(0.0, dt)
    simulation = sk.TimeStepping(system, times, sk.MoreauJeanOSI(settings["theta"]), problem)
    simulation.setNewtonTolerance(settings["newton"])
    simulation.setNewtonMaxIteration(20)

    def row():
        return [(np.array(body.q()), np.array(body.velocity())) for body in bodies]

    rows, unsolved, fallen, cpu = [row()], 0, False, 0.0
    for step in range(len(ground) - 1):
        shaken = (ground[step] + ground[step + 1]) / 2
        for m, force in zip(mass, forces):
            force.setValue(0, -m * shaken)
        began = time.process_time()
        simulation.computeOneStep()
        solved = options.iparam[1] < sweeps or options.dparam[1] <= tolerance
        unsolved += not (solved and simulation.isNewtonConverge())
        simulation.nextStep()
        cpu += time.process_time() - began
        if (step + 1) % every == 0:
            rows.append(row())
            if max(abs(q[2]) for q, _ in rows[-1]) > float(job["fallen"]):
                fallen = True
                break
    place, velocity = np.moveaxis(np.array(rows), 2, 0)
    found = dict(place=place, velocity=velocity, fallen=fallen, unsolved=unsolved, cpu_s=cpu)
    np.savez(found_file, **found, steps=step + 1)


if __name__ == "__main__":
    main(*sys.argv[1:])
