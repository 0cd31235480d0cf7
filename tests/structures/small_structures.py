"""Structures of few elements."""

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.toml_file import merge

STONE = dict(youngs_modulus_pa=50e9, poissons_ratio=0.0, density_kg_m3=2700.0)
BLOCK = dict(kind="block", length_m=0.4, width_m=0.2, height_m=1.2, element_size_m=0.1) | STONE
FOOT = dict(between=["block", "ground"])
RIGID = dict(rigid=True)


def structure(**tables):
    """Case of a structure that nothing shakes."""
    return case_from_tables(
        merge(dict(integration=dict(duration_s=0.1), contact=dict(interior_points=100)), tables),
        "small.toml",
    )


def block(joints=None, **keys):
    """Tables of a marble block on the ground, other keys of the body in their place."""
    return dict(bodies=dict(block=BLOCK | keys), joints=dict(foot=FOOT) | (joints or {}))


def frame(column=None, slab=None, **tables):
    """Four rigid columns below a rigid slab."""
    x, y = 1.0, 0.8
    return merge(
        dict(
            bodies=dict(
                column=dict(
                    kind="cylinder",
                    outer_diameter_m=0.2,
                    height_m=1.5,
                    copies_m=[[x, y, 0], [-x, y, 0], [-x, -y, 0], [x, -y, 0]],
                )
                | STONE
                | RIGID
                | (column or {}),
                slab=dict(kind="slab", length_m=3.0, width_m=2.4, thickness_m=0.3, at_m=[0, 0, 1.5])
                | STONE
                | RIGID
                | (slab or {}),
            ),
            joints=dict(
                feet=dict(between=["column", "ground"]), heads=dict(between=["column", "slab"])
            ),
        ),
        tables,
    )


def stack(**tables):
    """A rigid block on a rigid block."""
    return merge(
        dict(
            bodies=dict(
                lower=dict(kind="block", length_m=0.6, width_m=0.6, height_m=0.8) | STONE | RIGID,
                upper=dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.6, at_m=[0, 0, 0.8])
                | STONE
                | RIGID,
            ),
            joints=dict(
                foot=dict(between=["lower", "ground"]), joint=dict(between=["upper", "lower"])
            ),
        ),
        tables,
    )
