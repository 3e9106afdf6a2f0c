"""Temperature of a road: which layer takes which, and what is refused."""

import math

import pytest

from treadload.errors import InputError
from treadload.materials import WLF, Elastic, Prony, Thermorheological
from treadload.pavement import HALF_BONDED, Layer, Pavement, TemperatureProfile
from treadload.response import UniformDisc, solve_response

SOIL = Elastic(8e7, 0.4)


class Softening:
    """Loses 100 MPa a degree from 10 GPa at 0 °C; known to 50 °C."""

    def at(self, temperature, *, extrapolate=False):
        if not 0 <= temperature <= 50 and not extrapolate:
            raise InputError(f"{temperature:g} °C is outside 0 to 50 °C")
        return Elastic(1e10 - 1e8 * temperature, 0.35)

    def __str__(self):
        return "softening mix"


ROAD = Pavement(
    [
        Layer(Softening(), 0.06, name="wearing", bond=HALF_BONDED),
        Layer(Softening(), 0.14, name="base"),
        Layer(SOIL, name="soil"),
    ]
)
PROFILE = TemperatureProfile([0.0, 0.1, 0.2], [40.0, 30.0, 10.0])


def moduli(road):
    return [layer.material.modulus for layer in road.layers[:2]]


def test_one_temperature_for_all():
    road = ROAD.at_temperature(20.0)
    assert moduli(road) == [8e9, 8e9]
    assert road.layers[2] == ROAD.layers[2]
    assert (road.layers[0].name, road.layers[0].bond) == ("wearing", HALF_BONDED)
    # What is known stays as it is.
    assert road.at_temperature(35) == road


def test_one_temperature_a_layer():
    assert moduli(ROAD.at_temperature([30.0, 10, None])) == [7e9, 9e9]
    first = ROAD.at_temperature([30.0, None, None])
    assert first.layers[1].material is ROAD.layers[1].material
    assert moduli(first.at_temperature(10.0)) == [7e9, 9e9]


def test_a_profile_is_read_at_the_middle_of_the_layer():
    # Middles at 30 and 130 mm: 40 - 3 and 30 - 6 °C.
    assert moduli(ROAD.at_temperature(PROFILE)) == pytest.approx([6.3e9, 7.6e9], rel=1e-12)


def test_a_profile_is_linear_between_its_points_and_holds_beyond_if_told():
    assert [PROFILE.temperature_at(z) for z in (0.0, 0.05, 0.1, 0.15, 0.2)] == pytest.approx([40, 35, 30, 20, 10])
    assert PROFILE.temperature_at(0.5, extrapolate=True) == 10.0
    assert str(TemperatureProfile([0.0, 0.1], [40, 30])) == "40 °C at 0 mm, 30 °C at 100 mm"


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: ROAD.at_temperature(60.0), "layer 'wearing': 60 °C is outside 0 to 50"),
        (lambda: ROAD.at_temperature(293.15), "293.15 °C is hotter than 100 °C.*kelvin, give °C: 20"),
        (lambda: ROAD.at_temperature([20.0, 293.15, None]), "kelvin"),
        (lambda: ROAD.at_temperature(math.nan), "finite number of °C"),
        (lambda: ROAD.at_temperature(-300.0), "above -273.15, got -300"),
        (lambda: ROAD.at_temperature("warm"), "must be a number of °C, got 'warm'"),
        (lambda: ROAD.at_temperature(None), "must be a number of °C, got None"),
        (lambda: ROAD.at_temperature([20.0, 20.0]), "one for each of the 3 layers.*got 2"),
        (
            lambda: ROAD.at_temperature(TemperatureProfile([0.0, 0.1], [30, 20])),
            "layer 'base': depth 0.13 m lies outside .* 0 to 0.1 m.*extrapolate=True",
        ),
        (lambda: Pavement.half_space(Softening(), "block").at_temperature(PROFILE), "'block' is semi-infinite"),
        (lambda: TemperatureProfile([0.0, 0.1, 0.1], [30, 20, 10]), r"increase, got \[0.0, 0.1, 0.1\]"),
        (lambda: TemperatureProfile([-0.1, 0.1], [30, 20]), ">= 0 m and increase"),
        (lambda: TemperatureProfile([0.0, 0.1], [30, 20, 10]), "2 depths and 3 temperatures"),
        (lambda: TemperatureProfile([0.0], [30]), "at least two depths"),
        (lambda: TemperatureProfile([0.0, 0.1], [303, 293]), "kelvin"),
    ],
)
def test_refusals(build, message):
    with pytest.raises(InputError, match=message):
        build()


def test_extrapolation_is_asked_for():
    assert moduli(ROAD.at_temperature(60.0, extrapolate=True)) == [4e9, 4e9]
    assert moduli(ROAD.at_temperature(TemperatureProfile([0.0, 0.1], [30, 20]), extrapolate=True))[1] == 8e9


@pytest.mark.parametrize("ask", [lambda r: r.glassy, lambda r: r.rubbery, lambda r: r.is_viscoelastic])
def test_limits_need_a_temperature(ask):
    with pytest.raises(InputError, match="layer 'wearing' depends on temperature"):
        ask(ROAD)


def test_solving_needs_a_temperature():
    disc, points = UniformDisc(0.1, 7e5), {"depths": [0.0], "x": [0.0], "y": [0.0]}
    with pytest.raises(InputError, match=r"layer 'wearing' depends on temperature \(softening mix\).*at_temperature"):
        solve_response(disc, ROAD, **points)
    with pytest.raises(InputError, match="layer 'base' depends on temperature"):
        solve_response(disc, ROAD.at_temperature([20.0, None, None]), **points)
    assert solve_response(disc, ROAD.at_temperature(20.0), **points).dataset["displacement_z"] > 0


def test_a_viscoelastic_mix_takes_its_temperature_and_stays_viscoelastic():
    solid = Prony(8e9, ((0.5, 0.1), (0.4, 1.0)), 0.35)
    mix = Thermorheological(solid, WLF(10.0, 100.0, 20.0), tested=(0.0, 40.0))
    road = Pavement([Layer(mix, 0.1, "top"), Layer(SOIL, name="soil")])
    warm = road.at_temperature(30.0)
    assert warm.is_viscoelastic
    # log aT = -10 x 10 / 110: all times shorter by that.
    found = warm.layers[0].resolved.complex_modulus(1.0)
    assert found == pytest.approx(solid.complex_modulus(10 ** (-100 / 110)), rel=1e-12)
    assert warm.glassy == Pavement([Layer(Elastic(8e9, 0.35), 0.1, "top"), Layer(SOIL, name="soil")])
    with pytest.raises(InputError, match=r"layer 'top': .*extrapolate=True"):
        road.at_temperature(50.0)
    assert road.at_temperature(50.0, extrapolate=True).is_viscoelastic
