"""Cases that a script makes of classes: arguments that nobody meant, of the rocking models above
all.
"""

from __future__ import annotations

import dataclasses
import datetime
import decimal
import fractions
import pathlib
import tempfile
import tomllib

import numpy as np

import fecolumn

_MODELS = {
    "BlockModel": dict(width_m=0.3, height_m=1.2, restitution=0.9),
    "FrameModel": dict(width_m=0.3, height_m=1.8, column_mass_kg=400.0, beam_mass_kg=900.0),
    "WobblingModel": dict(outer_diameter_m=0.4, height_m=1.6),
    "WobblingFrameModel": dict(
        outer_diameter_m=0.4, height_m=1.6, column_mass_kg=500.0, slab_mass_kg=2000.0
    ),
    "PodiumModel": dict(width_m=0.8, height_m=4.0, column_mass_kg=6000.0, floor_mass_kg=4e4),
}
_MODEL_SECTIONS = {
    "integration": ("Integration", dict(dt_s=0.005, duration_s=0.2)),
    "initial": ("Initial", dict(tilt_rad=0.01)),
    "overturn": ("Overturn", {}),
    "output": ("Output", {}),
}
_BODIES = {
    "Block": dict(length_m=0.4, width_m=0.4, height_m=1.0),
    "Cylinder": dict(outer_diameter_m=0.4, height_m=1.2),
    "Tube": dict(outer_diameter_m=0.3, wall_m=0.02, height_m=1.5),
    "Cone": dict(bottom_diameter_m=0.5, top_diameter_m=0.3, height_m=1.0),
    "Plate": dict(length_m=1.0, width_m=1.0, thickness_m=0.2),
    "Prism": dict(corners_m=((0, 0), (0.4, 0), (0.4, 0.3), (0, 0.3)), height_m=0.8),
}
_SECTIONS = {
    "joints": ("Joint", dict(between=("one", "ground"), friction_coefficient=0.6)),
    "links": ("Tendon", dict(body="one", to_point_m=(0, 0, 3), stiffness_n_m=1e5)),
    "materials": ("Material", dict(youngs_modulus_pa=30e9, density_kg_m3=2500.0)),
    "grounds": ("Ground", dict(kind="pad", stiffness_n_m3=1e8)),
    "initial": ("Initial", dict(tilt_rad=0.02)),
    "contact": ("Contact", dict(interior_points=4)),
    "integration": ("Integration", dict(engine="rigid", dt_s=1e-3, duration_s=0.1)),
    "output": ("Output", dict(history_every_s=0.01)),
    "mesh": ("MeshLimits", {}),
}
_NAMED = {"joints": "foot", "links": "wire", "materials": "stone", "grounds": "ground"}
_ALONE = ("contact", "integration", "output", "mesh")


class _Odd:
    """An object of no use."""


def _values() -> list:
    return [
        *(None, True, False, 0, 1, -1, 2, 0.5, -0.5, 1e-9, 1e5, 1e308, 5e-324, -0.0),
        *(float("nan"), float("inf"), -float("inf"), 10**400, 2**63, 1j),
        *("", "text", "1", "0.5", "a\nb", "x" * 5000, "\x00", "\ud800", b"1"),
        *([], [1.0], [[]], (), (0.1, 0.2), (0, 0, 0), (0, 0, float("nan")), {}, {"x": 1}, {1, 2}),
        *(np.float64(0.4), np.float32(0.4), np.int64(3), np.nan, np.array(0.4)),
        *(np.array([0.1, 0.2]), np.zeros((2, 2)), np.array([]), np.bool_(True), np.str_("a")),
        *(decimal.Decimal("0.4"), fractions.Fraction(2, 5), datetime.date(2020, 1, 1)),
        *(pathlib.Path("x"), _Odd(), _Odd, len, range(3), iter([1, 2]), Ellipsis),
        *(fecolumn.BlockModel(width_m=0.3, height_m=1.0), fecolumn.Contact(), fecolumn.BlockModel),
    ]


def prepare(folder) -> None:
    """Nothing: a script has no files."""


def sound(folder):
    """A rocking block."""
    return "BlockModel", _MODELS["BlockModel"], _made(_MODEL_SECTIONS), {}


def _made(sections: dict) -> dict:
    return {name: (kind, dict(keys)) for name, (kind, keys) in sections.items()}


def mutate(rng, folder):
    """A model or a body of a class, with one to three arguments changed, left out or put in."""
    models = rng.random() < 0.6
    names = _MODELS if models else _BODIES
    name = str(rng.choice(list(names)))
    keys, more = dict(names[name]), {}
    sections = _made(_MODEL_SECTIONS if models else _SECTIONS)
    for key in list(sections):
        if key not in ("integration", "joints") and rng.random() < 0.5:
            del sections[key]
    for _ in range(int(rng.integers(1, 4))):
        values = _values()
        value = values[int(rng.integers(len(values)))]
        if rng.random() < 0.15:
            more[str(rng.choice(["title", "motion", "observed", *sections, "x"]))] = value
            continue
        place = str(rng.choice(list(sections)))
        kind, table = (name, keys) if rng.random() < 0.6 else sections[place]
        known = [field.name for field in dataclasses.fields(getattr(fecolumn, kind))]
        key = str(rng.choice([*known, *table, *table, "nothing"]))
        if rng.random() < 0.15:
            table.pop(key, None)
        elif rng.random() < 0.5 and isinstance(table.get(key), float):
            table[key] *= float(rng.choice([-1.0, 0.1, 0.5, 0.9, 1e-3, 1e3, 2.0, 10.0]))
        elif rng.random() < 0.3:
            table[key] = float(f"{10 ** rng.uniform(-4, 4):.3g}")
        else:
            table[key] = value
    return name, keys, sections, more


def use(mutant) -> None:
    """Make the case, write and read it again; a rocking model is analysed, too."""
    name, keys, sections, more = mutant
    body = getattr(fecolumn, name)(**keys)
    parts = {key: getattr(fecolumn, kind)(**table) for key, (kind, table) in sections.items()}
    if name in _MODELS:
        known = {key: value for key, value in more.items() if key != "observed" and key != "x"}
        case = fecolumn.Case.of_model(body, **{**parts, **known})
    else:
        tables = {
            key: one if key in _ALONE else {_NAMED.get(key, "one"): one}
            for key, one in parts.items()
        }
        known = {key: value for key, value in more.items() if key != "x"}
        case = fecolumn.Case(**{"bodies": {"one": body}, **tables, **known})
    assert len(case.id) == 12 and repr(case)
    text = case.to_toml()
    tomllib.loads(text)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "case.toml"
        file.write_text(text)
        again = fecolumn.load_case(file)
        assert again.id == case.id and again == case
        if name in _MODELS:
            _analysed(case, pathlib.Path(folder))


def _analysed(case, folder) -> None:
    """Analyse where it takes no time; whatever it reaches is a number."""
    plan = case.integration
    if plan.duration_s > 1 or not isinstance(plan.dt_s, float) or plan.dt_s < 1e-4:
        return
    try:
        summary = fecolumn.run(case, folder / "run", quiet=True)
    except fecolumn.AnalysisFailed as error:
        assert "\n" not in str(error)
        return
    for key, value in summary.items():
        assert not isinstance(value, float) or np.isfinite(value), (key, value)
