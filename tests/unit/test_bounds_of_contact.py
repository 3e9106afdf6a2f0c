"""Contact: moments and histories against closed forms and symmetry; what is refused and told at its bound."""

import math

import numpy as np
import pytest

from treadload.contact import Rolling, solve_contact, solve_transient, turn_on_the_spot
from treadload.contact.friction.heat import FlashHeating, Heat
from treadload.contact.friction.laws import Anisotropic, Coulomb, Exponential
from treadload.contact.friction.map import FrictionMap
from treadload.errors import InputError, TreadloadError
from treadload.materials import Elastic
from treadload.pavement import FRICTIONLESS, Layer, Pavement
from treadload.tire import Tire

LOAD, MU, RADIUS = 2e3, 0.5, 0.4
RUBBER = Elastic(2e6, 0.5)
ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))


def bowl(n=32, spacing=6e-3, material=RUBBER):
    x = spacing * (np.arange(n) - (n - 1) / 2)
    return Tire.from_height_map((x[None] ** 2 + x[:, None] ** 2) / (2 * RADIUS), spacing, material=material)


def wheel(**given):
    return Rolling(normal_load=LOAD, friction=MU, **given)


def hertz():
    """Radius of the patch: a³ = 3 P R / (4 E*), E* of the tire on a road two thousand times as stiff."""
    modulus = 1 / ((1 - 0.25) / 2e6 + (1 - 0.35**2) / 5.4e9)
    return (3 * LOAD * RADIUS / (4 * modulus)) ** (1 / 3)


def test_a_sliding_turn_takes_the_moment_of_a_hertzian_patch():
    """Everything slides about the middle: M = μ ∫ p r dA = (3π/16) μ P a, and no net force."""
    found = turn_on_the_spot(bowl(), ROAD, wheel(), angles=[0.5, 1.5])
    limit = 3 * math.pi / 16 * MU * LOAD * hertz()
    data = found.contact.dataset
    # Eleven cells to the radius: the square of a cell over the radius, 1 %.
    assert abs(float(data.aligning_moment)) == pytest.approx(limit, rel=0.02)
    # The road turns the tire back: turning to the right is resisted to the left.
    assert float(data.aligning_moment) < 0
    assert abs(float(data.tractive_force)) + abs(float(data.lateral_force)) < 1e-3 * MU * LOAD
    # Its work over the last radian.
    assert float(found.dataset.friction_energy[-1]) == pytest.approx(limit, rel=0.03)


def test_pivots_ahead_and_aside_are_alike_for_a_round_patch():
    """A quarter of a turn of the frame takes the one pivot to the other."""
    ahead, aside = (
        turn_on_the_spot(bowl(), ROAD, wheel(), angles=[0.05, 0.15], pivot=pivot).dataset
        for pivot in ((0.05, 0.0), (0.0, 0.05))
    )
    np.testing.assert_allclose(ahead.steering_torque, aside.steering_torque, atol=1e-6 * LOAD * RADIUS)
    # Sliding about a point far outside is being pushed: torque is force times arm, more than about the middle.
    centre = turn_on_the_spot(bowl(), ROAD, wheel(), angles=[0.05, 0.15]).dataset
    assert float(ahead.steering_torque[-1]) > 1.05 * float(centre.steering_torque[-1]) > 0
    np.testing.assert_allclose(ahead.pole_x[1:], 0.05, atol=1e-12)
    np.testing.assert_allclose(ahead.pole_y[1:], 0.0, atol=1e-12)


def test_every_step_of_a_history_has_its_own_creepage_and_spin():
    given = [wheel(creepage_x=-0.01 * k, spin=0.1 * k) for k in (1, 2, 3)]
    found = solve_transient(bowl(24, 8e-3), ROAD, given, distances=[0.01, 0.02, 0.03])
    np.testing.assert_allclose(found.dataset.creepage_x[1:], [-0.01, -0.02, -0.03])
    np.testing.assert_allclose(found.dataset.spin[1:], [0.1, 0.2, 0.3])
    assert float(found.contact.dataset.creepage_x) == -0.03
    assert float(found.contact.dataset.spin) == pytest.approx(0.3)


@pytest.mark.parametrize("bodies", [("tire", 2e6, 5.4e9, 0.3), ("road", 5.4e9, 2e6, 0.3)])
def test_unlike_bodies_feel_each_other_whichever_is_the_softer(bodies):
    """Shear moves pressure where Dundurs' β is not zero, one way or the other, and only there."""
    _, tire, road, poisson = bodies
    both = []
    for nu in (poisson, 0.5):
        halves = Pavement.half_space(Elastic(road, nu))
        made = bowl(24, 8e-3, Elastic(tire, nu))
        driven = solve_contact(made, halves, wheel(tractive_force=0.8 * MU * LOAD)).dataset.pressure
        both.append(float(abs(driven - driven[:, ::-1].to_numpy()).max() / driven.max()))
    moved, still = both
    assert moved > 0.02
    # ν = 0.5 on a body that does not give: β is next to nothing.
    assert still < 0.1 * moved


def test_what_a_frictionless_interface_refuses_and_takes():
    layers = [Layer(Elastic(5e9, 0.35), 0.05, bond=FRICTIONLESS), Layer(Elastic(1e8, 0.35))]
    tire = bowl(24, 8e-3)
    with pytest.raises(InputError, match="frictionless interface lets the layers"):
        solve_contact(tire, Pavement(layers), wheel(), road_compliance="layers")
    smooth = Rolling(normal_load=LOAD, friction=0.0)
    slid = solve_contact(tire, Pavement(layers), smooth, road_compliance="layers")
    glued = [Layer(Elastic(5e9, 0.35), 0.05), Layer(Elastic(1e8, 0.35))]
    held = solve_contact(tire, Pavement(glued), wheel(), road_compliance="layers")
    # Layers that slide on each other bend more.
    assert float(slid.dataset.displacement_z.max()) > float(held.dataset.displacement_z.max()) > 0


@pytest.mark.parametrize("base", [0.5, None, "cold"])
def test_flash_heating_needs_a_law_that_is_not_itself(base):
    heat = Heat(0.2, 2e6)
    with pytest.raises(InputError, match="another friction law"):
        FlashHeating(base, heat, heat, 50.0, 100.0, 0.3)
    once = FlashHeating(Coulomb(0.5), heat, heat, 50.0, 100.0, 0.3)
    with pytest.raises(InputError, match="another friction law"):
        FlashHeating(once, heat, heat, 50.0, 100.0, 0.3)


def test_laws_of_friction_in_words():
    a_map = FrictionMap(np.array([[0.2, 0.5], [0.9, 0.4]]), spacing=0.1)
    assert str(a_map) == "map 2 x 2, 0.2 to 0.9"
    on_base = FrictionMap(np.array([[0.2, 0.5]]), spacing=0.1, base=Coulomb(0.6))
    assert str(on_base).startswith("(map 2 x 1, 0.2 to 0.5) x ")
    assert " x " not in str(Anisotropic(0.6, 0.4))


def test_a_height_map_keeps_its_cells_and_takes_their_size_again():
    """Round-off of a unit is no other spacing."""
    tire = bowl(24, 8e-3)
    own = solve_contact(tire, ROAD, wheel())
    same = solve_contact(tire, ROAD, wheel(), spacing=8e-3 * (1 + 1e-12))
    np.testing.assert_array_equal(own.dataset.pressure, same.dataset.pressure)
    with pytest.raises(InputError, match="spacing"):
        solve_contact(tire, ROAD, wheel(), spacing=8e-3 * (1 + 1e-6))


def test_friction_that_falls_cannot_carry_what_it_carries_at_rest():
    falling = Exponential(0.6, 0.3, 0.5)
    rolling = Rolling(normal_load=LOAD, friction=falling, tractive_force=0.45 * LOAD, speed=20.0)
    with pytest.raises(TreadloadError, match=r"gross sliding|falls with slip"):
        solve_contact(bowl(24, 8e-3), ROAD, rolling)
