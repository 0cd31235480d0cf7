"""Structures to draw, made in seconds: a gate of elastic blocks with a tendon, and a building that
sways on its slab.
"""

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import run

STONE = dict(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
GATE = dict(
    bodies=dict(
        column=dict(
            kind="block",
            length_m=0.2,
            width_m=0.4,
            height_m=0.8,
            element_size_m=0.2,
            copies_m=[[-0.45, 0, 0], [0.45, 0, 0]],
        )
        | STONE,
        lintel=dict(
            kind="plate",
            length_m=1.3,
            width_m=0.44,
            thickness_m=0.2,
            element_size_m=0.2,
            element_order=1,
            at_m=[0, 0, 0.8],
        )
        | STONE,
    ),
    joints=dict(feet=dict(between=["column", "ground"]), heads=dict(between=["column", "lintel"])),
    links=dict(
        tendon=dict(
            kind="tendon",
            body="column 1",
            to="lintel",
            to_point_m=[0, 0, 0.8],
            stiffness_n_m=1e5,
            prestress_n=100.0,
        )
    ),
    contact=dict(friction_coefficient=0.7, interior_points=0),
    integration=dict(duration_s=0.1, dt_s=1e-3, n_modes=6),
    output=dict(states_every_s=0.02, checkpoint_every_s=1e5),
)
TILTED = dict(initial=dict(column=dict(tilt_rad=0.1)))
# Floors of 1 t on a slab of 20 t that is pushed along the ground
BUILDING = dict(
    bodies=dict(
        building=dict(
            kind="storeys",
            length_m=4.0,
            width_m=4.0,
            thickness_m=0.5,
            mass_kg=2e4,
            floors=2,
            floor_masses_kg=[1e4],
            storey_heights_m=[3.0],
            period_s=0.2,
            element_size_m=2.0,
            youngs_modulus_pa=30e9,
        )
    ),
    joints=dict(foot=dict(between=["building", "ground"])),
    initial=dict(building=dict(velocity_m_s=[0.5, 0.2, 0.0])),
    contact=dict(friction_coefficient=0.7, interior_points=0),
    integration=dict(duration_s=0.1, dt_s=1e-3),
    output=dict(states_every_s=0.02),
)


def case_of(*tables):
    """Case of tables, later ones over earlier ones."""
    merged = {}
    for one in tables:
        merged = merge(merged, one)
    return case_from_tables(merged, "small.toml")


def analysed(folder, *tables):
    """Result folder of a case."""
    run(case_of(*tables), folder, quiet=True)
    return folder


# Semicircular arch of 0.15 R, which becomes a mechanism at 0.159858 g
ARCH = dict(
    bodies=dict(
        arch=dict(
            kind="arch",
            mean_radius_m=1.0,
            thickness_m=0.15,
            width_m=0.5,
            voussoirs=11,
            density_kg_m3=2400.0,
            element_size_m=1.0,
        )
    ),
    joints=dict(ring=dict(between=["arch", "arch"]), feet=dict(between=["arch", "ground"])),
    contact=dict(friction_coefficient=0.7, interior_points=0),
    integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.0, start="rest"),
    output=dict(states_every_s=0.04),
)
# Share of its mechanism's acceleration that pushes the arch, from 0.1 s on
PUSH = 1.3


def pushed_arch(folder):
    """Result folder of an arch at rest that is pushed until four hinges open."""
    push = folder.with_suffix(".csv")
    times = [0.05 * k for k in range(21)]
    rows = [f"{time:.2f},{PUSH * 0.159858 * min(time / 0.1, 1):.6f}" for time in times]
    push.write_text("\n".join(["time [s],ax [g]", *rows]) + "\n")
    return analysed(folder, ARCH, dict(motion=dict(source=str(push))))
