"""MuJoCo (PyPI), run in an environment of its own: rigid bodies on a plane that is shaken.

    PYTHON -P mujoco.py JOB.npz FOUND.npz

Bodies are MuJoCo's own boxes and cylinders, which it brings into contact by its own collision: at
the corners of faces, at four points of a rim. The ground's acceleration is added to gravity, its
mean over each step. Settings come with the job, see `programs.py`.
"""

import json
import sys
import time

import mujoco
import numpy as np

MODEL = """
<mujoco>
  <option timestep="{dt}" {option}/>
  <size memory="200M"/>
  <default><geom condim="3" friction="{friction} 0 0" {contact}/></default>
  <worldbody><geom type="plane" size="50 50 1"/>{bodies}</worldbody>
</mujoco>"""
BODY = """
<body pos="{place}" quat="{turn}"><freejoint/>
  <inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia}"/>
  <geom type="{kind}" size="{size}" pos="{middle}"/></body>"""


def words(values):
    return " ".join(f"{value:.15g}" for value in np.atleast_1d(values))


def model_of(job, settings, dt):
    bodies = [
        BODY.format(
            place=words(place),
            turn=words(turn),
            mass=words(mass),
            inertia=words(inertia),
            kind=kind,
            size=words(size if kind == "box" else size[:2]),
            middle=words(middle),
        )
        for place, turn, mass, inertia, kind, size, middle in zip(
            *(job[key] for key in ("place", "turn", "mass", "inertia", "kinds", "sizes", "middle"))
        )
    ]
    text = MODEL.format(
        dt=dt,
        friction=float(job["friction"]),
        option=settings["option"],
        contact=settings["contact"],
        bodies="".join(bodies),
    )
    return mujoco.MjModel.from_xml_string(text)


def main(job_file, found_file):
    job = np.load(job_file)
    dt, every, ground = float(job["dt"]), int(job["every"]), job["ground"]
    model = model_of(job, json.loads(str(job["settings"])), dt)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    count, gravity, limit = len(job["mass"]), float(job["gravity"]), np.cos(float(job["fallen"]))
    push = -(ground[1:] + ground[:-1]) / 2 - [0.0, 0.0, gravity]
    rows, cpu, unsolved, most = [], 0.0, 0, model.opt.iterations

    def keep():
        rows.append(np.concatenate([data.qpos, data.qvel]))

    keep()
    for step, a in enumerate(push, 1):
        model.opt.gravity[:] = a
        began = time.process_time()
        mujoco.mj_step(model, data)
        cpu += time.process_time() - began
        unsolved += int(data.solver_niter[0]) >= most
        if step % every == 0:
            keep()
            # cosine of the tilt of each body, of its quaternion
            turn = data.qpos.reshape(count, 7)[:, 3:]
            if (1 - 2 * (turn[:, 1] ** 2 + turn[:, 2] ** 2)).min() < limit:
                break
    rows = np.array(rows)
    places, speeds = rows[:, : 7 * count], rows[:, 7 * count :]
    places, speeds = places.reshape(-1, count, 7), speeds.reshape(-1, count, 6)
    np.savez(
        found_file,
        place=places[..., :3],
        turn=places[..., 3:],
        velocity=speeds[..., :3],
        spin=speeds[..., 3:],
        cpu_s=cpu,
        steps=step,
        unsolved=unsolved,
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
