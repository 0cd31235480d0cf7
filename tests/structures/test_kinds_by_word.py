"""A kind of body that comes from the class of another one has its keys and checks, not its mesh,
its closed forms or its rocking model.
"""

import pytest

import fecolumn
from fecolumn.case.bodies import Block
from fecolumn.engines.rocking.column import rigid_body
from fecolumn.foundation.schema import InputError, parameter
from fecolumn.foundation.section_class import section_class
from fecolumn.pictures.mesh_report import closed_form_rows
from fecolumn.structures.bodies import Drawing, drawing
from fecolumn.structures.shapes import shape_of


@section_class(kw_only=True)
class Wedge(Block):
    """kind = "wedge": half a block."""

    kind: str = parameter("wedge", doc="what the body is", choices=("wedge",))


SIDES = dict(length_m=0.4, width_m=0.3, height_m=0.6)


def case_of(body, engine):
    return fecolumn.Case(
        bodies={"body": body},
        joints={"foot": fecolumn.Joint(between=("body", "ground"))},
        integration=fecolumn.Integration(engine=engine, duration_s=1.0),
    )


@pytest.mark.parametrize("more", [{}, {"fine_height_m": 0.1}])
def test_a_wedge_from_a_block_has_no_mesh_of_a_block(more):
    assert len(shape_of("bodies.body", Block(**SIDES, **more), "case").mesh.cells)
    with pytest.raises(ValueError, match="'wedge'"):
        shape_of("bodies.body", Wedge(**SIDES, **more), "case")


def test_a_wedge_from_a_block_has_no_closed_form_and_no_rocking_model_of_a_block():
    block, wedge = (case_of(kind(**SIDES), "housner") for kind in (Block, Wedge))
    drawn = drawing(block, "body", "case")
    assert closed_form_rows(drawn)
    assert not closed_form_rows(
        Drawing(drawn.key, wedge.bodies["body"], drawn.shape, None, drawn.faces, drawn.material, "")
    )
    assert rigid_body(block, "body", "case").mass > 0
    with pytest.raises(InputError, match="body.kind = .*wedge.*is no body of a model"):
        rigid_body(wedge, "body", "case")
