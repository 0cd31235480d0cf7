"""Bodies from surfaces, CAD bodies and scripts of Gmsh: elements that weigh what was drawn."""

import math
import warnings

import gmsh
import numpy as np
import pytest
import pyvista
from drawn_shapes import box, figure, saved

from fecolumn.foundation.schema import InputError
from fecolumn.mesh.closed_surface import closed_surface
from fecolumn.mesh.filled import _other_size
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.mass import enclosed, mass_properties
from fecolumn.mesh.mesh_file import MeshFile, UnusableShape


def triangles(surface):
    return np.asarray(surface.points, float)[surface.faces.reshape(-1, 4)[:, 1:]]


def refusal(path, **how):
    with pytest.raises(InputError) as caught:
        own_mesh(MeshFile(str(path), **how))
    assert "\n" not in str(caught.value) and path.name in str(caught.value)
    return str(caught.value)


def test_a_surface_encloses_what_formulas_say():
    found = enclosed(triangles(box((0.4, 0.3, 1.2))) + [5.0, -3.0, 2.0])
    assert found.volume == pytest.approx(0.144, rel=1e-6)
    assert found.centre == pytest.approx([5.0, -3.0, 2.6], rel=1e-6)
    exact = 0.144 / 12 * np.array([0.3**2 + 1.2**2, 0.4**2 + 1.2**2, 0.4**2 + 0.3**2])
    assert found.inertia == pytest.approx(np.diag(exact), rel=1e-6, abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("ending", ["stl", "ply", "obj"])
def test_a_box_is_filled_with_tetrahedra(tmp_path, ending):
    own = own_mesh(MeshFile(str(saved(box(), tmp_path / f"box.{ending}"))))
    found = mass_properties(own.mesh, 1.0)
    assert own.is_tetrahedral and own.has_foot
    assert own.foot == pytest.approx((0.4, 0.3), rel=1e-6)
    assert found.volume == pytest.approx(0.144, rel=1e-6)
    assert found.mass == pytest.approx(0.144, rel=1e-6)


def test_elements_that_are_smaller_than_their_surface_are_told_of():
    corners = np.array([[x, y, z] for x in (0, 0.6) for y in (0, 0.4) for z in (0, 1.5)])
    assert _other_size(0.996 * corners, corners) == []
    (told,) = _other_size(corners * [0.98, 1.0, 0.99], corners)
    assert "are 1.485 m high on a foot of 0.588 x 0.4 m, where the surface is 1.5 m high" in told


@pytest.mark.long
def test_a_scan_weighs_and_turns_as_its_surface(tmp_path):
    """Mass, centre and inertia within 0.1 % of the surface's integrals, though chords cut off some
    of its volume."""
    surface = figure(noise=2e-4)
    path = saved(surface, tmp_path / "scan.stl")
    drawn = enclosed(closed_surface(path, 1.0, 0.05).corners)
    own = own_mesh(MeshFile(str(path), cut_foot=0.05))
    found = mass_properties(own.mesh, 2700.0)
    assert found.volume == pytest.approx(drawn.volume, rel=0.05)
    assert found.mass == pytest.approx(2700 * drawn.volume, rel=1e-9)
    assert found.centre + own.drawn_at == pytest.approx(drawn.centre, abs=1e-9)
    assert found.inertia == pytest.approx(2700 * drawn.inertia, rel=1e-8, abs=1e-7)
    assert own.has_foot and own.drawn_at[2] == pytest.approx(
        surface.points[:, 2].min() + 0.05, abs=1e-4
    )
    # what was made is kept: the second time takes no time, and nothing is told again
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = own_mesh(MeshFile(str(saved(surface, tmp_path / "copy.stl")), cut_foot=0.05))
    assert np.array_equal(again.mesh.points, own.mesh.points)


@pytest.mark.long
def test_units_are_taken_and_missed(tmp_path):
    path = saved(box((400, 300, 1200)), tmp_path / "box.stl")
    assert own_mesh(MeshFile(str(path), "mm")).height == pytest.approx(1.2, rel=1e-6)
    assert 'mesh_unit = "mm" makes it 1.2 m' in refusal(path)
    small = saved(box(), tmp_path / "small.stl")
    assert 'mesh_unit = "m" makes it 1.2 m' in refusal(small, unit="mm")


@pytest.mark.long
def test_an_open_surface_names_its_holes(tmp_path):
    whole = box()
    open_foot = whole.extract_cells(np.flatnonzero(triangles(whole)[:, :, 2].max(axis=1) > 0))
    path = saved(open_foot.extract_surface(algorithm="dataset_surface"), tmp_path / "open.stl")
    said = refusal(path)
    assert "1 hole" in said and "0.4 m wide" in said and "cut_foot_m = " in said
    own = own_mesh(MeshFile(str(path), cut_foot=0.01))
    assert own.height == pytest.approx(1.19, rel=1e-6) and own.has_foot
    top = whole.extract_cells(np.flatnonzero(triangles(whole)[:, :, 2].min(axis=1) < 1.2))
    path = saved(top.extract_surface(algorithm="dataset_surface"), tmp_path / "top.stl")
    assert "close them in the program" in refusal(path)


def test_inverted_triangles_are_turned_and_told(tmp_path):
    faces = box().faces.reshape(-1, 4).copy()
    faces[:3] = faces[:3][:, [0, 3, 2, 1]]
    inverted = pyvista.PolyData(box().points, faces.ravel())
    found = closed_surface(saved(inverted, tmp_path / "a.ply"), 1.0, None)
    assert enclosed(found.corners).volume == pytest.approx(0.144, rel=1e-6)
    assert found.notes == ("3 of 12 triangles looked inwards, and were turned",)


@pytest.mark.long
def test_a_cavity_a_second_body_and_a_damaged_file_are_refused(tmp_path):
    two = box() + box((0.2, 0.2, 0.2)).translate((0, 0, 0.3))
    assert "2 pieces" in refusal(
        saved(two.extract_surface(algorithm="dataset_surface"), tmp_path / "two.stl")
    )
    whole = saved(box(), tmp_path / "whole.stl").read_bytes()
    (tmp_path / "cut.stl").write_bytes(whole[:-60])
    assert "must hold the 12" in refusal(tmp_path / "cut.stl")
    (tmp_path / "none.stl").write_bytes(b"")
    assert "empty" in refusal(tmp_path / "none.stl")
    (tmp_path / "text.ply").write_text("good morning\n")
    assert "head of a PLY" in refusal(tmp_path / "text.ply")


@pytest.mark.long
def test_a_foot_is_cut_flat_in_the_upper_half_only(tmp_path):
    path = saved(figure(), tmp_path / "a.stl")
    assert "less than half of the height" in refusal(path, cut_foot=0.9)


def test_too_many_elements_are_refused_before_they_are_made(tmp_path):
    assert "at most 3e+06" in refusal(saved(box(), tmp_path / "a.stl"), size=1e-3)


@pytest.fixture(scope="module")
def cad(tmp_path_factory):
    """A STEP file in millimetres: a plinth with a drum on it."""
    path = tmp_path_factory.mktemp("cad") / "drum.step"
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.occ.addBox(-300, -200, 0, 600, 400, 200)
    gmsh.model.occ.addCylinder(0, 0, 200, 0, 0, 900, 150)
    gmsh.model.occ.synchronize()
    gmsh.write(str(path))
    gmsh.finalize()
    return path


def test_a_step_file_is_of_the_size_it_says(cad):
    own = own_mesh(MeshFile(str(cad)))
    plinth, drum = 0.6 * 0.4 * 0.2, np.pi * 0.15**2 * 0.9
    found = mass_properties(own.mesh, 1.0)
    assert own.height == pytest.approx(1.1, rel=1e-9) and own.foot == pytest.approx((0.6, 0.4))
    assert found.mass == pytest.approx(plinth + drum, rel=1e-9)
    assert found.centre[2] == pytest.approx(
        (0.1 * plinth + 0.65 * drum) / (plinth + drum), rel=1e-9
    )
    turning = plinth * (0.6**2 + 0.4**2) / 12 + drum * 0.15**2 / 2
    assert found.inertia[2, 2] == pytest.approx(turning, rel=1e-9)


@pytest.mark.long
def test_a_script_of_gmsh_may_make_bricks(tmp_path):
    (tmp_path / "a.geo").write_text(
        "h=100; Point(1)={-200,-200,0,h}; Point(2)={200,-200,0,h}; Point(3)={200,200,0,h};"
        "Point(4)={-200,200,0,h}; Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};"
        "Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1}; Transfinite Surface{1};"
        "Recombine Surface{1}; Extrude{0,0,1200}{Surface{1};Layers{12};Recombine;}\n"
    )
    own = own_mesh(MeshFile(str(tmp_path / "a.geo"), "mm"))
    assert not own.is_tetrahedral and len(own.mesh.cells) == 12 * 16
    assert mass_properties(own.mesh, 1.0).mass == pytest.approx(0.192, rel=1e-12)
    (tmp_path / "b.geo").write_text('SystemCall "touch there";')
    assert "other programs" in refusal(tmp_path / "b.geo")
    (tmp_path / "c.geo").write_text("Point(1) = {0,")
    assert "must define a Volume" in refusal(tmp_path / "c.geo")
    (tmp_path / "d.step").write_text("ISO-10303-21; HEADER; nothing")
    refusal(tmp_path / "d.step")


@pytest.mark.timeout(60)
@pytest.mark.parametrize("ending", ["stl", "ply", "obj"])
def test_mutants_of_surfaces_are_refused_or_closed(tmp_path, ending):
    """Bytes changed, put in and left out anywhere: what is taken encloses a volume."""
    whole = saved(figure(12), tmp_path / f"whole.{ending}").read_bytes()
    drawn = enclosed(closed_surface(tmp_path / f"whole.{ending}", 1.0, None).corners)
    random, path, taken = np.random.default_rng(36), tmp_path / f"mutant.{ending}", 0
    for _ in range(70):
        content = bytearray(whole)
        start, kind = int(random.integers(len(content))), int(random.integers(4))
        if kind == 0:
            del content[start:]
        elif kind == 1:
            del content[start : start + int(random.integers(1, 200))]
        elif kind == 2:
            content[start] = int(random.integers(256))
        else:
            content[start:start] = bytes(random.integers(32, 127, 20, dtype=np.uint8))
        path.write_bytes(content)
        try:
            found = enclosed(closed_surface(path, 1.0, None).corners)
        except UnusableShape as error:
            assert "\n" not in str(error)
            continue
        taken += 1
        assert found.volume > 0 and np.isfinite(found.inertia).all()
        if kind == 0:
            assert found.volume == pytest.approx(drawn.volume, rel=1e-9)
    assert taken < 70


STATUE = """SetFactory("OpenCASCADE");
Box(1) = {-0.2, -0.2, 0, 0.4, 0.4, 0.3};
Cylinder(2) = {0, 0, 0.3, 0, 0, 0.9, 0.15};
BooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Delete; }
"""
DRUM = """lc = 100;
Point(1) = {0, 0, 0, lc}; Point(2) = {150, 0, 0, lc}; Point(3) = {0, 150, 0, lc};
Point(4) = {-150, 0, 0, lc}; Point(5) = {0, -150, 0, lc};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Extrude {0, 0, 900} { Surface{1}; }
"""
# volume of a cylinder of 0.3 x 0.9 m and of a square slab
CYLINDER, SQUARE = math.pi * 0.15**2 * 0.9, 0.4**2 * 0.3


@pytest.mark.parametrize(
    "script, unit, volume, inertia, within",
    [
        (STATUE, "m", CYLINDER + SQUARE, CYLINDER * 0.15**2 / 2 + SQUARE * 0.4**2 / 6, 1e-6),
        (DRUM, "mm", CYLINDER, CYLINDER * 0.15**2 / 2, 1e-3),
    ],
    ids=["OpenCASCADE", "built-in kernel"],
)
def test_a_script_weighs_what_its_curved_faces_enclose(
    tmp_path, script, unit, volume, inertia, within
):
    (tmp_path / "drawn.geo").write_text(script)
    with pytest.warns(UserWarning, match=r"lack 4\.\d% of the volume"):
        own = own_mesh(MeshFile(str(tmp_path / "drawn.geo"), unit))
    assert own.exact.volume == pytest.approx(volume, rel=within)
    weighed = mass_properties(own.mesh, 1.0)
    assert weighed.mass == pytest.approx(volume, rel=within)
    assert weighed.inertia[2, 2] == pytest.approx(inertia, rel=within)
