"""Random roads obey mechanics; `python -m fuzz.random_roads` asks more of them."""

import pytest

from fuzz import random_roads


@pytest.mark.parametrize(
    ("seed", "count"), [(0, 64), pytest.param(1, 400, marks=pytest.mark.slow)], ids=["some", "many"]
)
def test_random_roads(seed, count):
    tally = random_roads.run(seed, range(count))
    assert not tally.failures, str(tally)
    # Refused are fields that need millions of wavenumbers: thin layers under wide loads.
    assert tally.refused <= 0.02 * count
    assert len({name.split(":")[0] for name in tally.checks}) >= 8


def test_a_wrong_road_is_found(monkeypatch):
    """What the waves of one load say is off by 1e-6 of itself: the run tells."""
    exact = random_roads.transfer

    def wrong(wavenumbers, stack, depths, below):
        found = exact(wavenumbers, stack, depths, below)
        found.plane[:, :, 0] *= 1 + 1e-6 * len(stack.shear)
        return found

    monkeypatch.setattr(random_roads, "transfer", wrong)
    tally = random_roads.run(0, range(8), every=0)
    assert any("split" in text for text in tally.failures)
    assert any("equal layers" in text for text in tally.failures)
