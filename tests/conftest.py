import pytest

from cases import COARSE_CASE
from treadload.case import Case
from treadload.steps import run


@pytest.fixture(scope="session")
def coarse_result():
    """Result of the coarse case: driving, 12 mm cells."""
    return run(Case.from_text(COARSE_CASE))


@pytest.fixture(scope="session", autouse=True)
def cache_folder(tmp_path_factory):
    """No test reads or fills the cache folder of whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TREADLOAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield
