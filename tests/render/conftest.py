import pytest
from rocking_analyses import BLOCK, DRUM, analysed


@pytest.fixture(scope="session")
def drum(tmp_path_factory):
    return analysed(DRUM, tmp_path_factory.mktemp("drum") / "run")


@pytest.fixture(scope="session")
def block(tmp_path_factory):
    return analysed(BLOCK, tmp_path_factory.mktemp("block") / "run")
