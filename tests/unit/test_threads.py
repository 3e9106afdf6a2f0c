"""Threads of a study: one for each core, none besides; the machine is as it was when the last pool is done."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from treadload.life.threads import how_many, let_go, pool_of


def products():
    """Threads on which libraries multiply matrices."""
    assert np.ones((2, 2)) @ np.ones(2) is not None
    return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def _two_threads():
    """As on two cores, set by no thread that still holds on to it."""
    limits = threadpool_limits(2, "blas")
    let_go()
    assert products() == {2}
    yield
    assert products() == {2}
    limits.restore_original_limits()
    let_go()


def test_workers_multiply_alone_until_the_last_pool_is_done():
    with pool_of(2) as outer:
        assert outer.submit(products).result() == {1}
        with pool_of(1):
            assert products() == {1}
        assert products() == {1}


def test_pools_that_overlap_leave_the_limits_as_they_were():
    """The first in is the first out, as with two lives in one process."""
    both, one = Barrier(2), Barrier(2)

    def first():
        with pool_of(1):
            both.wait()
        one.wait()

    def second():
        with pool_of(1):
            both.wait()
            one.wait()
            return products()

    with ThreadPoolExecutor(2) as pool:
        early, late = pool.submit(first), pool.submit(second)
        early.result()
        assert late.result() == {1}


def test_a_failure_inside_gives_the_threads_back():
    with pytest.raises(ValueError, match="inside"), pool_of(None):
        raise ValueError("inside")
    assert products() == {2}
    assert how_many(3) == 3
    assert how_many(None) >= 1
