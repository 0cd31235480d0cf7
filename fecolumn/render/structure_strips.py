"""What the history of a structure says over time, as strips beside a picture."""

from __future__ import annotations

import numpy as np

from fecolumn.render.strips import LIFTED, Strip, energy_strip, ground_strip, rows_between, strip_of

# Lines that a strip has at most
_MOST = 4


def structure_strips(result, times: np.ndarray) -> list[Strip]:
    """Acceleration of the ground (displacement of the top where it is at rest), tilt of bodies,
    uplift at interfaces and energy, from the first of `times` [s] to the last.

    Of equal bodies, and of an interface between several, a line is the largest of all at each time.
    Where nothing lifts off, the slide at interfaces stands in place of uplift. Where there are more
    bodies or interfaces than lines, those that move most are drawn.

    Parameters
    ----------
    result
        StructureResult.
    """
    history = result.history
    reach = np.hypot(*result.way[:, :2].T)
    rows = rows_between(history["time"], reach, times)
    tilt = _largest(
        [
            (body, [history[f"body/{name}/tilt"] for name in result.case.names_of(body)])
            for body in result.case.bodies
        ]
    )
    rise, slide = (_of_interfaces(result, what) for what in ("rise", "slide"))
    if max(values.max() for values, _ in rise) > LIFTED * min(
        np.ptp(contact.plan, axis=0).max() for contact in result.solid.contacts
    ):
        moved = strip_of(history, rows, "uplift", "$w$", "m", rise)
    else:
        moved = strip_of(history, rows, "slide", "$s$", "m", slide)
    return [
        ground_strip(history, result.way, rows),
        strip_of(history, rows, "tilt", r"$\theta$", "rad", tilt),
        moved,
        energy_strip(history, rows, reach),
    ]


def _of_interfaces(result, what: str) -> list:
    """Lines of a quantity of the joints of each interface."""
    groups: dict[str, list] = {}
    for joint in result.solid.structure.joints:
        if joint.pair >= 0:
            continue
        values = result.history[f"interface/{joint.name}/{what}"]
        groups.setdefault(joint.name.partition(":")[0], []).append(
            np.maximum(values, 0.0) if values.ndim == 1 else np.hypot(*values.T)
        )
    return _largest(list(groups.items()))


def _largest(groups: list) -> list[tuple[np.ndarray, str]]:
    """(values (n,), name): the largest of each group at each time, of _MOST groups with the largest
    peaks.
    """
    lines = [(np.max(each, axis=0), name) for name, each in groups]
    kept = sorted(sorted(range(len(lines)), key=lambda k: -lines[k][0].max())[:_MOST])
    return [lines[k] for k in kept]
