"""A second engine for the driver's tests: Housner's rigid block (1963) in the plane, integrated in
a few milliseconds.

Motions are named "pulse:<number>": one sine of an amplitude and a period drawn from that number.
Other names fail: "pulse:diverges" raises, "pulse:killed" dies as from a lack of memory, once;
"pulse:silent" returns without a summary; "pulse:slides" slides off its base; "pulse:full" finds the
disk full until there is a file "room" in the study's folder.
"""

import math
import os
import random
import signal
import time

from fecolumn.foundation.atomic import write_json

ENTRY = "rocking_block:run"


def run(case, folder, *, comm, file, quiet):
    time.sleep(float(os.environ.get("ROCKING_BLOCK_SLEEP_S", 0)))
    assert comm.size == 1
    with open(folder / "calls", "a") as calls:
        calls.write(f"{os.getpid()} {os.environ['OMP_NUM_THREADS']}\n")
    name = case.motion.source.partition(":")[2]
    if name == "diverges":
        raise ArithmeticError("step 17 did not converge\nafter 4 cuts")
    if name == "killed" and not (folder / "killed").exists():
        (folder / "killed").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if name == "full" and not (folder.parents[1] / "room").exists():
        with open("/dev/full", "w") as file:
            file.write("x")
    if name == "silent":
        return {}
    print("rocking", name)
    summary = rock(case, random.Random(name))
    if name.startswith("slides"):
        summary |= {"outcome": "slid off", "slid_off": True, "overturned": False}
    write_json(folder / "summary.json", summary)
    return summary


def rock(case, draw) -> dict:
    """Summary of the block of the column's height and width under one sine pulse."""
    start = time.perf_counter()
    column, g = case.short.column, 9.80665
    b, h = column.outer_diameter_m / 2, column.height_m / 2
    slenderness, p2, restitution = (
        math.atan2(b, h),
        0.75 * g / math.hypot(b, h),
        1 - 1.5 * math.sin(math.atan2(b, h)) ** 2,
    )
    amplitude, period = g * slenderness * draw.lognormvariate(0.6, 0.5), draw.uniform(0.2, 0.9)
    dt, alpha = case.integration.dt_s, case.integration.alpha_hht
    theta = omega = u_max = 0.0
    steps, overturned = round(4.0 / dt), False
    for step in range(steps):
        t = (step + 1 + alpha) * dt  # the load of HHT
        ground = amplitude * math.sin(2 * math.pi * t / period) if t < period else 0.0
        side = math.copysign(1.0, theta if theta else -ground)
        moment = math.sin(side * slenderness - theta) + ground / g * math.cos(
            side * slenderness - theta
        )
        if theta == 0.0 and abs(ground) <= g * math.tan(slenderness):
            continue
        omega -= dt * p2 * moment
        if theta and (theta + dt * omega) * theta <= 0:
            omega *= restitution
        theta += dt * omega
        u_max = max(u_max, 2 * h * math.sin(min(abs(theta), math.pi / 2)))
        if abs(theta) >= math.pi / 2 or 0 < case.overturn.displacement_m <= u_max:
            overturned = True
            break
    wall_s = time.perf_counter() - start
    return {
        "engine": "rocking block",
        "kinematics": "rigid",
        "dofs": 1,
        "steps": step + 1,
        "dt_s": dt,
        "alpha_hht": alpha,
        "duration_s": (step + 1) * dt,
        "u_max_m": u_max,
        "overturned": overturned,
        "residual_slide_m": 0.0,
        "wall_s": wall_s,
        "s_per_step": wall_s / (step + 1),
        "iterations": 0,
        "factorizations": 0,
        "energy_closure_rel": 0.0,
        "version": "0",
        "case_id": case.id,
    }
