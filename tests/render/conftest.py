import pytest
import rocking_structures
from rocking_analyses import BLOCK, DRUM, analysed


@pytest.fixture(scope="session")
def drum(tmp_path_factory):
    return analysed(DRUM, tmp_path_factory.mktemp("drum") / "run")


@pytest.fixture(scope="session")
def block(tmp_path_factory):
    return analysed(BLOCK, tmp_path_factory.mktemp("block") / "run")


@pytest.fixture(scope="session")
def gate(tmp_path_factory):
    """Two columns that rock below a lintel."""
    return rocking_structures.analysed(
        tmp_path_factory.mktemp("gate") / "run", rocking_structures.GATE, rocking_structures.TILTED
    )


@pytest.fixture(scope="session")
def building(tmp_path_factory):
    return rocking_structures.analysed(
        tmp_path_factory.mktemp("building") / "run", rocking_structures.BUILDING
    )


@pytest.fixture(scope="session")
def arch(tmp_path_factory):
    """An arch that a push opens into four hinges, from rest."""
    return rocking_structures.pushed_arch(tmp_path_factory.mktemp("arch") / "run")
