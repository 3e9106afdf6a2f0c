import pytest

from cases import COARSE_CASE
from treadload.case import Case
from treadload.study import run_case


@pytest.fixture(scope="session")
def coarse_result():
    """Result of the coarse case: driving, 12 mm cells."""
    return run_case(Case.from_text(COARSE_CASE))
