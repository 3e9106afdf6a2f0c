"""A few hundred attacks of each kind; `python -m fuzz` runs as many as you like."""

import pytest

from fuzz.runner import attack_of, run


@pytest.mark.parametrize(
    ("kind", "count"),
    [
        ("cases", 120),
        ("tables", 120),
        ("meshes", 20),
        pytest.param("results", 40, marks=pytest.mark.slow),
        ("footprints", 80),
        ("textures", 100),
        pytest.param("surfaces", 300, marks=pytest.mark.slow),
        pytest.param("clouds", 300, marks=pytest.mark.slow),
        pytest.param("fits", 40, marks=pytest.mark.slow),
        ("laser", 120),
        pytest.param("fringes", 40, marks=pytest.mark.slow),
        ("contacts", 40),
        pytest.param("stores", 30, marks=pytest.mark.slow),
        ("e57", 25),
        ("x3p", 100),
        ("sdf", 100),
        ("xlsx", 8),
        ("pictures", 60),
    ],
)
def test_nothing_breaks(kind, count):
    tally = run(kind, attack_of(kind), seed=1, indices=range(count))
    assert not tally.failures, str(tally)
    # An attack that only ever is refused, or only ever taken, tests little; most damaged stores are made again.
    assert ({"taken"} if kind == "stores" else {"refused", "taken"}) <= set(tally.words)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "count"), [("e57", 100), ("x3p", 400), ("sdf", 400), ("xlsx", 60), ("pictures", 200)]
)
def test_files_of_other_programs_reach_the_reader(kind, count):
    """Seven tenths are right, however they are written, and must be read as they were meant."""
    tally = run(kind, attack_of(kind), seed=2, indices=range(count))
    assert not tally.failures, str(tally)
    assert tally.words["taken"] >= 0.68 * count


@pytest.mark.parametrize("count", [pytest.param(2, id="few"), pytest.param(60, id="some", marks=pytest.mark.slow)])
def test_no_largest_value_of_a_life_lies_on_a_border_unnoticed(count):
    """1000 of the same seed: none, and 0 lives with the warning; the bound is 5 %."""
    tally = run("random_lives", attack_of("random_lives"), seed=1, indices=range(count))
    assert not tally.failures, str(tally)
    assert tally.words["quiet"] >= 0.95 * count


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "count"), [("solved", 40), ("solved_lives", 15)])
def test_what_is_drawn_is_solved_and_right(kind, count):
    tally = run(kind, attack_of(kind), seed=1, indices=range(count))
    assert not tally.failures, str(tally)
    # Drawn to be accepted: what is refused tests no solver.
    assert tally.words["solved"] >= 0.7 * count
