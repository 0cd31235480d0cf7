"""MuJoCo (PyPI), run in an environment of its own: the column as a rigid cylinder with the bricks'
mass and inertia.

    PYTHON -P mujoco.py JOB.npz FOLDER DT

Settings, by MuJoCo's documentation for accurate contact: elliptic friction cones, Newton solver to
1e-12, friction as stiff as the normal contact (impratio), Runge-Kutta is no help across impacts, so
implicitfast; solref at its shortest stable time constant of two steps and critical damping, which
makes impacts plastic; solimp close to rigid from the surface on. Contact stays soft by design.
"""

import sys
import time

import mujoco
import numpy as np

MODEL = """
<mujoco>
  <option timestep="{dt}" gravity="0 0 -{gravity}" cone="elliptic" solver="Newton"
          tolerance="1e-12" iterations="200" ls_iterations="100" ls_tolerance="1e-4"
          impratio="{ratio}" integrator="implicitfast"/>
  <default>
    <geom solref="{stiff} 1" solimp="0.99 0.9999 1e-6 0.5 2" condim="3" friction="{friction} 0 0"/>
  </default>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <body name="column">
      <freejoint/>
      <inertial pos="{centre}" mass="{mass}" fullinertia="{inertia}"/>
      <geom type="cylinder" size="{radius} {half}" pos="0 0 {half}"/>
    </body>
  </worldbody>
</mujoco>"""


def main(job_file, folder, dt):
    job, dt = np.load(job_file), float(dt)
    tensor, words = job["inertia"], lambda values: " ".join(f"{value:.15g}" for value in values)
    text = MODEL.format(
        dt=dt,
        gravity=float(job["gravity"]),
        friction=float(job["friction"]),
        ratio=1000,
        stiff=2 * dt,
        centre=words(job["centre"]),
        mass=float(job["mass"]),
        radius=float(job["radius"]),
        half=float(job["height"]) / 2,
        inertia=words([tensor[0, 0], tensor[1, 1], tensor[2, 2], 0, 0, 0]),
    )
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    data = mujoco.MjData(model)
    radius, tilt = float(job["radius"]), float(job["tilt"])
    data.qpos[:] = [
        radius - radius * np.cos(tilt),
        0,
        radius * np.sin(tilt),
        np.cos(tilt / 2),
        0,
        np.sin(tilt / 2),
        0,
    ]
    mujoco.mj_forward(model, data)
    body, every = model.body("column").id, max(1, round(float(job["dt"]) / dt))
    # of standing
    ground = float(job["mass"]) * float(job["gravity"]) * float(job["centre"][2])
    steps, cpu, rows = round(int(job["steps"]) * float(job["dt"]) / dt), 0.0, []
    for step in range(0, steps + 1, every):
        iterations = 0
        if step:
            began = time.process_time()
            for _ in range(every):
                mujoco.mj_step(model, data)
                iterations += data.solver_niter[0]
            cpu += time.process_time() - began
        # the state after the step; forward quantities (xmat, energy) are of the step before
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_energyPos(model, data), mujoco.mj_energyVel(model, data)
        turn, place = data.xmat[body].reshape(3, 3), data.xpos[body]
        toes = [place[0] + sign * radius * turn[0, 0] - sign * radius for sign in (1, -1)]
        rows.append(
            (
                data.time,
                np.arctan2(turn[0, 2], turn[2, 2]),
                *toes,
                sum(data.energy) - ground,
                cpu,
                iterations / every,
                1,
            )
        )
    with open(f"{folder}/track.csv", "w") as track:
        track.writelines(",".join(f"{value:.12g}" for value in row) + "\n" for row in rows)


if __name__ == "__main__":
    main(*sys.argv[1:])
