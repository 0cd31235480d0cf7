"""GetFEM 5.4.2 (Debian python3-getfem), run by the system's Python: St.

Venant-Kirchhoff, penalised contact, hand-made Newmark.

    /usr/bin/python3 -P getfem.py JOB.npz FOLDER

Settings. Newmark with alpha = -0.05 in gamma = 1/2 - alpha and beta = (1 - alpha)^2 / 4. Contact
with friction on a rigid obstacle by `add_penalized_contact_with_rigid_obstacle_brick` (Renard
2013), penalty E / (10 brick sizes): ten times that takes three times the iterations but moves the
toe less, a tenth of it lets the toe bounce (16 steps of the specimen each); integrated at the
corners of the bricks, where the rim is. Without the line search Newton cycles at the impact. Its
friction is a penalty on the slip of one step, so a stick has no memory. Ties as a reduced
finite-element space, which is exact.
"""

import sys
import time

import getfem as gf
import numpy as np
from scipy.sparse import csr_matrix, kron
from scipy.spatial import cKDTree

ALPHA = -0.05
GAMMA, BETA = 0.5 - ALPHA, (1 - ALPHA) ** 2 / 4
NEWTON = (
    "max_res",
    1e-6,
    "max_iter",
    40,
    "lsearch",
    "simplest",
    "alpha max ratio",
    1.0,
    "alpha mult",
    0.5,
    "alpha min",
    1e-3,
    "lsolver",
    "mumps",
)
CORNERS = [0, 1, 3, 2, 4, 5, 7, 6]  # VTK to GetFEM's tensor order
FOOT = 1
GREEN = "(Grad_u+Grad_u'+Grad_u'*Grad_u)"  # twice Green and Lagrange's strain


def spmat(matrix):
    """GetFEM's sparse matrix of a SciPy one, each entry for the three components of a vector
    field.
    """
    coo, result = (
        kron(matrix, np.eye(3), "coo"),
        gf.Spmat("empty", *(3 * size for size in matrix.shape)),
    )
    for i, j, value in zip(coo.row, coo.col, coo.data):
        if value:
            result.add(int(i), int(j), np.array([[value]]))
    return result


def space(job):
    """Mesh as released; vector space on it without the slaves; matrix from its nodes to those of
    the mesh; mesh node of each of the job's points.
    """
    mesh = gf.Mesh("empty", 3)
    corners = job["start"][job["cells"][:, CORNERS]]
    mesh.add_convex(gf.GeoTrans("GT_QK(3,1)"), np.ascontiguousarray(corners.transpose(2, 1, 0)))
    field = gf.MeshFem(mesh, 3)
    field.set_fem(gf.Fem("FEM_QK(3,1)"))
    places = field.basic_dof_nodes()[:, ::3].T
    # a slave on a corner of its master is that corner
    distance, node = cKDTree(places).query(job["start"])
    assert distance.max() < 1e-9
    slave = np.full(len(places), -1)
    slave[node[job["slaves"]]] = np.arange(len(job["slaves"]))
    slave[node[job["masters"]].ravel()] = -1
    kept = np.flatnonzero(slave < 0)
    number = np.full(len(places), -1)
    number[kept] = np.arange(len(kept))
    rows, columns, values = [kept], [number[kept]], [np.ones(len(kept))]
    held = np.flatnonzero(slave >= 0)
    for k in range(4):
        (
            rows.append(held),
            columns.append(number[node[job["masters"][slave[held], k]]]),
            values.append(job["weights"][slave[held], k]),
        )
    extension = csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
        (len(places), len(kept)),
    )
    identity = csr_matrix((np.ones(len(kept)), (number[kept], kept)), (len(kept), len(places)))
    if len(held):
        field.set("reduction matrices", spmat(identity), spmat(extension))
    return mesh, field, extension, node


def balance(job, mesh, field, volume):
    """Model of the momentum balance at the end of a step; "guess" is where no acceleration leads
    to, "before" the displacement before.
    """
    dt, young, poisson, density = (
        float(job[key]) for key in ("dt", "youngs_modulus", "poissons_ratio", "density")
    )
    corner = gf.MeshIm(mesh, gf.Integ("IM_NC_PARALLELEPIPED(3,1)"))
    below = cKDTree(mesh.pts().T).query(job["start"][job["foot"]])[1]
    mesh.set_region(FOOT, mesh.faces_from_pid(below))

    level = gf.MeshFem(mesh, 1)
    level.set_fem(gf.Fem("FEM_QK(3,1)"))
    gap = level.basic_dof_nodes()[2].copy()

    model = gf.Model("real")
    model.add_fem_variable("u", field)
    for name in ("guess", "before"):
        model.add_initialized_fem_data(name, field, np.zeros(field.nbdof()))
    lame = [young * poisson / (1 + poisson) / (1 - 2 * poisson), young / 2 / (1 + poisson)]
    model.add_initialized_data("lame", lame)
    model.add_finite_strain_elasticity_brick(volume, "SaintVenant Kirchhoff", "u", "lame")
    model.add_initialized_data("inertia", [density / (BETA * dt**2)])
    model.add_linear_term(volume, "inertia*(u-guess).Test_u")
    model.add_initialized_data("weight", [0.0, 0.0, -density * float(job["gravity"])])
    model.add_source_term_brick(volume, "u", "weight")
    model.add_initialized_fem_data("gap", level, gap)
    for name, value in (
        ("stiffness", 0.1 * young / float(job["brick"])),
        ("friction", float(job["friction"])),
        ("rate", 1.0),
    ):
        model.add_initialized_data(name, [value])
    model.add_penalized_contact_with_rigid_obstacle_brick(
        corner, "u", "gap", "stiffness", "friction", FOOT, 1, "", "rate", "before"
    )
    return model


def main(job_file, folder):
    gf.util_trace_level(0)
    job = np.load(job_file)
    dt, density = float(job["dt"]), float(job["density"])
    mesh, field, extension, node = space(job)
    volume, size = gf.MeshIm(mesh, gf.Integ("IM_HEXAHEDRON(5)")), field.nbdof()
    model = balance(job, mesh, field, volume)
    fall = np.tile([0.0, 0.0, -float(job["gravity"])], size // 3)
    u, v, a = np.zeros(size), np.zeros(size), fall
    mass_matrix = gf.asm_mass_matrix(volume, field)

    def energy():
        kinetic = density / 2 * v @ mass_matrix.mult(v)
        strain = gf.asm_generic(
            volume, 0, f"lame(1)/8*sqr(Trace({GREEN}))+lame(2)/4*Norm_sqr({GREEN})", -1, model
        )
        lift = -(mass_matrix.mult(u) @ fall) * density
        return kinetic + strain + lift

    centre = job["centre"]
    pivot = np.array([float(job["radius"]), 0.0, 0.0])
    raised = (
        float(job["mass"])
        * float(job["gravity"])
        * (((centre - pivot) @ job["turn"].T)[2] - centre[2])
    )
    with open(f"{folder}/track.csv", "w", buffering=1) as track:
        cpu, iterations, ok = 0.0, 0, 1
        for step in range(int(job["steps"]) + 1):
            if step:
                began = time.process_time()
                guess = u + dt * v + dt**2 * (0.5 - BETA) * a
                model.set_variable("guess", guess)
                model.set_variable("before", u)
                model.set_variable("u", u + dt * v)
                iterations, ok = model.solve(*NEWTON)
                u = model.variable("u")
                after = (u - guess) / (BETA * dt**2)
                v = v + dt * ((1 - GAMMA) * a + GAMMA * after)
                a = after
                cpu += time.process_time() - began
            now = job["start"] + (extension @ u.reshape(-1, 3))[node]
            axis = now[job["top"]].mean(0) - now[job["foot"]].mean(0)
            toes = now[job["toes"]] - job["points"][job["toes"]]
            row = (
                step * dt,
                np.arctan2(axis[0], axis[2]),
                toes[0, 0],
                toes[1, 0],
                energy() + raised,
                cpu,
                iterations,
                int(ok),
            )
            track.write(",".join(f"{value:.12g}" for value in row) + "\n")
            if not ok:
                sys.exit(f"Newton has not converged at step {step}")


if __name__ == "__main__":
    main(*sys.argv[1:])
