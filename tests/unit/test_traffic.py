"""Traffic, wander, climate and maneuvers: closed forms and bad input."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadload.contact.maneuver import GRAVITY, Maneuver
from treadload.damage.climate import Climate, Season
from treadload.damage.traffic import GROWS, AxleClass, Traffic, Wander
from treadload.errors import InputError

TRUCK = AxleClass("truck", 1.0, 32.5e3, 820e3)


def test_passes_grow_geometrically_as_the_sum_of_the_years():
    traffic = Traffic((TRUCK,), 1e5, growth=0.03)
    assert traffic.passes(20) == pytest.approx(sum(1e5 * 1.03**k for k in range(20)), rel=1e-12)


def test_passes_grow_arithmetically_as_the_sum_of_the_years():
    traffic = Traffic((TRUCK,), 1e5, growth=0.03, kind="arithmetic")
    assert traffic.passes(20) == pytest.approx(sum(1e5 * (1 + 0.03 * k) for k in range(20)), rel=1e-12)


@given(
    st.floats(-0.05, 0.1),
    st.sampled_from(["geometric", "arithmetic"]),
    st.floats(0.2, 20),
)
def test_years_to_inverts_passes(growth, kind, years):
    traffic = Traffic((TRUCK,), 1e5, growth=growth, kind=kind)
    # With arithmetic decline the passes stop growing after 1/|t| years: 20 stays below that.
    assert traffic.years_to(traffic.passes(years)) == pytest.approx(years, rel=1e-6)


@pytest.mark.parametrize("kind", ["geometric", "arithmetic"])
def test_traffic_grows_for_forty_years_and_stays_as_it_is_then(kind):
    """The sum of the years: year k has (1 + t)^(k-1) or 1 + (k-1) t of the first up to the 40th, then as much."""
    traffic = Traffic((TRUCK,), 1e5, growth=0.03, kind=kind)
    years = np.arange(1, 101)
    grown = np.minimum(years, GROWS) - 1
    each = 1e5 * (1.03**grown if kind == "geometric" else 1 + 0.03 * grown)
    assert traffic.passes(100) == pytest.approx(each.sum(), rel=1e-12)
    assert traffic.passes(GROWS) == pytest.approx(each[:40].sum(), rel=1e-12)
    for many in (30.0, 40.0, 40.5, 500.0):
        assert traffic.years_to(traffic.passes(many)) == pytest.approx(many, rel=1e-9)


def test_how_long_a_traffic_grows_is_that_of_its_design_life_or_given():
    assert Traffic((TRUCK,), 1e5, growth=0.02, years=60).grows_for == 60
    assert Traffic((TRUCK,), 1e5, growth=0.02, growth_years=15).grows_for == 15
    assert Traffic((TRUCK,), 1e5, growth=-0.02).grows_for == math.inf
    short = Traffic((TRUCK,), 1e5, growth=0.02, growth_years=15)
    assert short.passes(16) - short.passes(15) == pytest.approx(1e5 * 1.02**14, rel=1e-12)


def test_a_shrinking_traffic_never_makes_more_than_its_sum():
    traffic = Traffic((TRUCK,), 1e5, growth=-0.1)
    assert traffic.years_to(1e6 * 1.0001) == math.inf
    assert traffic.years_to(0.99e6) < math.inf


def test_normal_wander_of_normal_damage_widens_it_by_the_sum_of_variances():
    dy, own, wander = 5e-3, 0.06, 0.12
    y = np.arange(-200, 201) * dy
    spread = Wander.normal(wander).spread(np.exp(-0.5 * (y / own) ** 2), dy)
    wide = np.arange(len(spread)) * dy
    wide -= wide.mean()
    both = math.hypot(own, wander)
    exact = own / both * np.exp(-0.5 * (wide / both) ** 2)
    # Tracks 5 mm wide widen the law by dy²/12 and 6e-7 of the wheels are cut: 1e-3 of the peak holds both.
    assert np.abs(spread - exact).max() < 1e-3 * exact.max()


@given(st.floats(0.0, 0.4), st.lists(st.floats(0, 1), min_size=3, max_size=30))
def test_wander_moves_damage_and_loses_none(deviation, damage):
    field = np.array(damage)
    spread = Wander.normal(deviation).spread(field, 0.01)
    assert spread.sum() == pytest.approx(field.sum(), rel=1e-12, abs=1e-12)
    assert (spread >= 0).all()
    assert spread.max() <= field.max() * (1 + 1e-12)


def test_measured_wander_keeps_its_mean_between_tracks():
    wander = Wander.measured([-0.105, 0.0, 0.05], [0.3, 0.5, 0.2])
    weights = wander.weights(0.01)
    tracks = (np.arange(len(weights)) - len(weights) // 2) * 0.01
    assert weights.sum() == pytest.approx(1, abs=1e-15)
    assert (weights * tracks).sum() == pytest.approx(-0.105 * 0.3 + 0.05 * 0.2, abs=1e-15)


def test_no_wander_changes_nothing():
    damage = np.array([0.0, 1.0, 3.0])
    assert Wander.none().spread(damage, 0.01) == pytest.approx(damage, abs=0)


def test_twelve_months_have_equal_shares():
    climate = Climate.equal_parts(range(12))
    assert sum(season.share for season in climate.seasons) == pytest.approx(1)
    assert climate.seasons[3].temperature == 3


def test_turning_right_pushes_and_spins_right():
    turn = Maneuver.turning(12.0, 25 / 3.6)
    assert turn.lateral == pytest.approx((25 / 3.6) ** 2 / (GRAVITY * 12))
    assert turn.spin == pytest.approx(1 / 12)
    left = Maneuver.turning(-12.0, 25 / 3.6)
    assert (left.lateral, left.spin) == (-turn.lateral, -turn.spin)


def test_crossfall_of_the_side_force_needs_none():
    speed = math.sqrt(0.05 * GRAVITY * 100)
    assert Maneuver.turning(100, speed, crossfall=0.05).lateral == pytest.approx(0, abs=1e-12)


def test_forces_scale_with_the_load():
    rolling = Maneuver.braking(3.0).rolling(30e3, 0.7)
    assert rolling.forces == pytest.approx((-3.0 / GRAVITY * 30e3, 0.0))
    assert Maneuver.uphill(0.06, 0.25).rolling(30e3, 0.7).forces[0] == pytest.approx(0.24 * 30e3)
    assert Maneuver.braking().rolling(30e3, 0.7).creepages[0] == 1


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Traffic((), 1e5), "at least one class"),
        (lambda: Traffic((AxleClass("a", 0.5, 1e4, 8e5), AxleClass("b", 0.4, 1e4, 8e5)), 1e5), "sum to 1, got 0.9"),
        (lambda: Traffic((AxleClass("a", 0.5, 1e4, 8e5), AxleClass("a", 0.5, 1e4, 8e5)), 1e5), "the name 'a'"),
        (lambda: Traffic((TRUCK,), -1.0), "passes_per_year must be >= 0"),
        (lambda: Traffic((TRUCK,), 1e5, growth=-1.5), "growth must be above -1"),
        (lambda: Traffic((TRUCK,), 1e5).years_to(-1), "passes must be >= 0"),
        (
            lambda: Traffic((TRUCK,), 1e5, growth=0.02, growth_years=0.5),
            "growth_years must be at least 1 year, got 0.5",
        ),
        (lambda: AxleClass("a", 30, 1e4, 8e5), "30 % is 0.3"),
        (lambda: AxleClass("a", 1, 0.0, 8e5), "wheel_load"),
        (lambda: AxleClass("a", 1, 1e4, 8e5, wheels=()), "at least one wheel"),
        (lambda: AxleClass("a", 1, 1e4, 8e5, wheels=(0.1, 0.2)), "pairs"),
        (lambda: Wander.normal(-0.1), "deviation of wander"),
        (lambda: Wander.measured([0, 0.1], [0.5, 0.6]), "sum to 1"),
        (lambda: Wander.measured([0.1, 0.0], [0.5, 0.5]), "must increase"),
        (lambda: Wander.measured([0.1, 0.2], [1.0]), "2 offsets but 1 shares"),
        (lambda: Climate(()), "at least one season"),
        (lambda: Climate((Season("a", 0.5, 20),)), "sum to 1"),
        (lambda: Season("a", 0.5, math.nan), "finite"),
        (lambda: Climate.equal_parts([1, 2], ["one"]), "2 temperatures but 1 names"),
        (lambda: Maneuver.turning(0, 5), "radius"),
        (lambda: Maneuver.uphill(0.05, 0), "driven_share"),
        (lambda: Maneuver.braking(-3), "deceleration"),
        (lambda: Maneuver("x", tractive=math.inf), "finite"),
    ],
)
def test_bad_input_is_named(make, words):
    with pytest.raises(InputError, match=words):
        make()
