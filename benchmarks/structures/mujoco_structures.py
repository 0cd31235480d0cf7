"""MuJoCo (PyPI) on the structures of `speed`, run in an environment of its own.

    PYTHON -P mujoco_structures.py JOB.json

The job: structure ("frame", "drums" or "cube"), number, dt, seconds, amplitude [m/s2] and rate [Hz]
of the ground's sine, tilt [rad] at which columns or drums begin or velocity [m/s] of the cube,
points a face, settings. Prints a line of JSON.

Bodies are cylinders and a box with their mass and inertia. As in the program beside it, each face
touches at its points: balls of a hundredth of the radius on the rim of one face, which meet the
other body. Settings: "default", MuJoCo's own, soft contact that creeps; "stiff", as of
`peers.mujoco` but for the solver's tolerance, which is MuJoCo's own (1e-8); or option and contact
as words of the model. The ground moves by its acceleration in the frame that moves with it.
"""

import json
import math
import sys
import time

import mujoco
import numpy as np

MODEL = """
<mujoco>
  <option timestep="{dt}" gravity="0 0 -9.80665" {option}/>
  <size memory="200M"/>
  <default>
    <geom contype="0" conaffinity="0"/>
  </default>
  <worldbody>
    <geom name="ground" type="plane" size="50 50 1"/>
    {bodies}
  </worldbody>
  <contact>{pairs}</contact>
</mujoco>"""
#: Of the solver, and of each contact, by settings
OPTIONS = dict(
    default=("", ""),
    stiff=(
        'cone="elliptic" solver="Newton" impratio="1000" integrator="implicitfast"',
        'solref="{} 1" solimp="0.99 0.9999 1e-6 0.5 2"',
    ),
)


def body(name, kind, size, density, place, turn, pins):
    """One body with its middle at `place`; pins: (z, radius, count) of circles of balls."""
    balls = "".join(
        f'<geom name="{name}_{c}_{k}" type="sphere" size="{0.01 * radius}" density="0" '
        f'pos="{radius * math.cos(a)} {radius * math.sin(a)} '
        f'{z - math.copysign(0.01 * radius, z)}"/>'
        for c, (z, radius, count) in enumerate(pins)
        for k, a in enumerate(2 * math.pi * np.arange(count) / count)
    )
    return (
        f'<body name="{name}" pos="{place[0]} {place[1]} {place[2]}" '
        f'euler="0 {math.degrees(turn)} 0"><freejoint/>'
        f'<geom name="{name}" type="{kind}" size="{size}" density="{density}"/>{balls}</body>'
    )


def model_of(job):
    """Text of the model, and the body that is watched."""
    settings = job["settings"]
    option, contact = OPTIONS[settings] if isinstance(settings, str) else settings
    contact = contact.format(2 * job["dt"])
    bodies, touching = MAKERS[job["structure"]](job)
    pairs = [
        f'<pair geom1="{name}_{circle}_{k}" geom2="{other}" condim="3" '
        f'friction="{job["friction"]} {job["friction"]} 0 0 0" {contact}/>'
        for name, circle, other in touching
        for k in range(job["points"])
    ]
    return MODEL.format(
        dt=job["dt"], option=option, bodies="".join(bodies.values()), pairs="".join(pairs)
    ), list(bodies)[-1]


def cube(job):
    """A cube on the ground; as of drums: text of each body by name, and which circle of whose balls
    meets what.
    """
    half = job["size"][0] / 2
    text = body("cube", "box", f"{half} {half} {half}", 2700, [0, 0, half], 0.0, [(-half, half, 8)])
    return {"cube": text}, [("cube", 0, "ground")]


def lean_of(radius, tilt):
    """Where the middle of a face lies that leans about its edge: along x, and up."""
    return radius - radius * math.cos(tilt), radius * math.sin(tilt)


def drums(job):
    """Drums on one another."""
    (diameter, height), tilt, bodies = job["size"], job["tilt"], {}
    radius = diameter / 2
    x, z = lean_of(radius, tilt)
    for i in range(job["number"]):
        middle = height * (i + 0.5)
        bodies[f"b{i}"] = body(
            f"b{i}",
            "cylinder",
            f"{radius} {height / 2}",
            2700,
            [x + middle * math.sin(tilt), 0, z + middle * math.cos(tilt)],
            tilt,
            [(-height / 2, radius, job["points"])],
        )
    below = ["ground", *bodies]
    return bodies, [(name, 0, on) for name, on in zip(bodies, below)]


def frame(job):
    """A slab on columns, in a square or two beside each other."""
    (diameter, height), tilt, bodies, touching = job["size"], job["tilt"], {}, []
    radius, points = diameter / 2, job["points"]
    x, z = lean_of(radius, tilt)
    rows = 2 ** (int(math.log2(job["number"])) // 2)
    many = job["number"] // rows
    top = z + height * math.cos(tilt) + radius * math.sin(tilt)
    for i in range(job["number"]):
        bodies[f"b{i}"] = body(
            f"b{i}",
            "cylinder",
            f"{radius} {height / 2}",
            2500,
            [
                2.0 * (i % many - (many - 1) / 2) + x + height / 2 * math.sin(tilt),
                2.0 * (i // many - (rows - 1) / 2),
                z + height / 2 * math.cos(tilt),
            ],
            tilt,
            [(-height / 2, radius, points), (height / 2, radius, points)],
        )
        touching += [(f"b{i}", 0, "ground"), (f"b{i}", 1, "slab")]
    place = [height * math.sin(tilt), 0, top + 0.2]
    bodies["slab"] = body("slab", "box", f"{many} {rows} 0.2", 2500, place, 0.0, [])
    return bodies, touching


MAKERS = dict(cube=cube, drums=drums, frame=frame)


def main(job_file):
    job = json.load(open(job_file))
    text, watched = model_of(job)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qvel[0] = job.get("velocity", 0.0)
    mujoco.mj_forward(model, data)
    body, steps = model.body(watched).id, round(job["seconds"] / job["dt"])
    start, peak, cpu, first = data.xpos[body].copy(), 0.0, 0.0, 20
    times, iterations = np.empty(steps), 0
    for step in range(steps):
        t = (step + 1) * job["dt"]
        model.opt.gravity[0] = -job["amplitude"] * math.sin(2 * math.pi * job["rate"] * t)
        began = time.process_time()
        mujoco.mj_step(model, data)
        times[step] = time.process_time() - began
        iterations += int(data.solver_niter[0])
        peak = max(peak, float(np.linalg.norm(data.xpos[body][:2] - start[:2])))
    cpu = times[first:]
    print(
        json.dumps(
            dict(
                us=1e6 * cpu.mean(),
                median_us=1e6 * float(np.median(cpu)),
                iterations=iterations / steps,
                moved_m=float(np.linalg.norm(data.xpos[body] - start)),
                peak_m=peak,
            )
        )
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
