"""Friction problems from files of others."""

import h5py
import numpy as np
import pytest
from scipy import sparse

from benchmarks.friction.fclib import read_problem

# z, x, y of two points
NORMAL_FIRST = [2, 0, 1, 5, 3, 4]


@pytest.fixture
def given():
    """W, q with the normal first, as files have it; and H, M, f of bodies that give them."""
    random = np.random.default_rng(0)
    H, M, f = (
        random.standard_normal((7, 6)),
        np.diag(random.uniform(1, 2, 7)),
        random.standard_normal(7),
    )
    return H.T @ np.linalg.solve(M, H), H.T @ np.linalg.solve(M, f), H, M, f


def write_matrix(group, matrix, triplets):
    if triplets:
        entries = sparse.coo_array(matrix)
        kept = dict(i=entries.row, p=entries.col, x=entries.data, nz=[entries.nnz])
    else:
        entries = sparse.csc_array(matrix)
        kept = dict(i=entries.indices, p=entries.indptr, x=entries.data, nz=[-1])
    for name, value in (kept | dict(m=[matrix.shape[0]], n=[matrix.shape[1]])).items():
        group[name] = value


def check(problem, W, q, mu):
    assert problem.mu == mu
    assert problem.W[np.ix_(NORMAL_FIRST, NORMAL_FIRST)] == pytest.approx(W, abs=1e-12)
    assert problem.q.ravel()[NORMAL_FIRST] == pytest.approx(q, abs=1e-12)


@pytest.mark.parametrize("local", [True, False], ids=["points", "bodies"])
def test_file_of_the_friction_contact_library_is_read(tmp_path, given, local):
    W, q, H, M, f = given
    path = tmp_path / "Case-i01-2.hdf5"
    with h5py.File(path, "w") as file:
        group = file.create_group("fclib_local" if local else "fclib_global")
        group["spacedim"] = [3]
        group["vectors/mu"] = [0.3, 0.3]
        for name, matrix in {"W": W}.items() if local else {"H": H, "M": M}.items():
            write_matrix(group.create_group(name), matrix, triplets=not local)
        for name, vector in {"q": q}.items() if local else {"f": f, "w": 0 * q}.items():
            group[f"vectors/{name}"] = vector
    check(read_problem(path), W, q, 0.3)


def lines(values):
    return "\n".join(f"{value:.17g}" for value in np.ravel(values))


@pytest.mark.parametrize("form", ["dense", "blocks"])
def test_text_of_siconos_own_tests_is_read(tmp_path, given, form):
    W, q = given[:2]
    if form == "dense":
        matrix = f"0\n6\n6\n6\t6\n{lines(W.T)}"
    else:
        blocks = [W[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] for i in range(2) for j in range(2)]
        numbered = "\n".join(f"{k}\n{lines(block.T)}" for k, block in enumerate(blocks))
        matrix = f"1\n6\n6\n4\n2\n2\n3\t6\n3\t6\n3\n4\n0\t2\t4\n0\t1\t0\t1\n{numbered}"
    path = tmp_path / "Case.dat"
    path.write_text(f"3\n2\n{matrix}\n{lines(q)}\n0.5\n0.5\n1\n")
    check(read_problem(path), W, q, 0.5)


@pytest.mark.parametrize(
    "text, why",
    [
        ("2\n1\n0\n2\n2\n1\n0\n0\n1\n0\n0\n0.3\n", "dimension 2"),
        ("3\n1\n0\n3\n3\n1\n0\n", "ends too early"),
        ("nothing\n", "invalid literal"),
        ("3\n1\n0\n9\n9\n1\n", "9 x 9 for 1 points"),
    ],
)
def test_file_that_is_no_such_problem_is_named_with_the_reason(tmp_path, text, why):
    path = tmp_path / "Case.dat"
    path.write_text(text)
    with pytest.raises(
        ValueError, match=f"Case.dat: no friction problem in three dimensions: .*{why}"
    ):
        read_problem(path)
