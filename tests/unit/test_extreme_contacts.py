"""Numbers far beyond any tire are refused in a sentence: no solver divides by zero or overflows on them."""

import warnings

import numpy as np
import pytest

import treadload as tl
from treadload.catalogue import tires
from treadload.contact.cautions import of_tire
from treadload.contact.friction import Anisotropic, Exponential, PressureDependent
from treadload.errors import ConvergenceError, InputError, TreadloadError

X = np.linspace(-0.05, 0.05, 16)
GAP = (X[None, :] ** 2 + X[:, None] ** 2) / 0.6
EXTREMES = (5e-324, 1e-300, 1e-100, 1e-40, 1e40, 1e252, 1.7e308)


def solve(*, modulus=3e6, road=5.4e9, spacing=X[1] - X[0], height=1.0, distance=None, **wheel):
    tire = tl.Tire.from_height_map(GAP * height, spacing, material=tl.Elastic(modulus, 0.5))
    wheel = {"friction": 0.7, **({} if "approach" in wheel else {"normal_load": 200.0}), **wheel}
    half_space = tl.Pavement.half_space(tl.Elastic(road, 0.35))
    if distance is not None:
        return tl.contact.solve_transient(tire, half_space, tl.Rolling(**wheel), distances=[distance])
    return tl.solve_contact(tire, half_space, tl.Rolling(**wheel))


QUESTIONS = {
    "normal_load": lambda v: solve(normal_load=v),
    "approach": lambda v: solve(approach=v),
    "friction": lambda v: solve(friction=v, creepage_x=0.01),
    "tractive_force": lambda v: solve(tractive_force=v),
    "lateral_force": lambda v: solve(lateral_force=-v),
    "spin": lambda v: solve(spin=v),
    "reference_speed": lambda v: solve(speed=10.0, creepage_x=0.1, friction=Exponential(0.8, 0.5, v)),
    "across": lambda v: solve(creepage_x=0.1, friction=Anisotropic(0.8, v)),
    "reference_pressure": lambda v: solve(creepage_x=0.1, friction=PressureDependent(0.8, v, 0.3)),
    "modulus of the tire": lambda v: solve(modulus=v),
    "modulus of the road": lambda v: solve(road=v),
    "cells": lambda v: solve(spacing=v),
    "height": lambda v: solve(height=v),
    "distances": lambda v: solve(distance=v, creepage_x=0.01),
    "spacing": lambda v: tl.solve_contact(
        tl.Tire.from_profile(tires["315/80R22.5"], inflation_pressure=8e5),
        tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)),
        tl.Rolling(normal_load=3e4, friction=0.7),
        spacing=v,
    ),
}
# What is not refused is solved: a force or a spin that is next to nothing.
NOTHING = {"tractive_force", "lateral_force", "spin"}


@pytest.mark.parametrize("name", QUESTIONS)
@pytest.mark.parametrize("value", EXTREMES)
def test_extremes_are_refused_in_a_sentence(name, value):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        if value < 1 and name in NOTHING:
            QUESTIONS[name](value)
            return
        with pytest.raises((InputError, TreadloadError)) as caught:
            QUESTIONS[name](value)
    assert len(str(caught.value)) < 600
    assert not isinstance(caught.value, ConvergenceError)


def test_the_sentence_has_the_number_the_bound_and_the_remedy():
    with pytest.raises(InputError, match=r"between 1e-15 and 1e\+15 N, got 1e\+252 N; .* 20e3 to 60e3"):
        tl.Rolling(normal_load=1e252, friction=0.7)
    with pytest.raises(InputError, match=r"normal_load must lie between .* got 1e\+14 N; on cells of 6.66667 mm"):
        solve(normal_load=1e14)
    with pytest.raises(InputError, match=r"tire must lie between 1e-09 and 1e\+18 Pa, and it is softer"):
        solve(modulus=1e-20)
    with pytest.raises(InputError, match=r"gross sliding: a force of 1.7e\+308 N .* 140 N"):
        solve(lateral_force=-1.7e308)


@pytest.mark.parametrize("solved", [lambda: solve(friction=3.0), lambda: solve(friction=3.0, distance=1e-3)])
def test_friction_of_three_is_solved_with_a_warning(solved):
    said = [text for text in solved().warnings if "friction" in text]
    assert len(said) == 1
    for part in ("is 3;", "0.05 to 1.5", "lower it"):
        assert part in said[0]


def test_a_truck_belt_on_an_aircraft_tire_is_said():
    belt = tl.tire.Belt.from_library("315/80R22.5")
    fitted = tl.tire.Belt(foundation=5.0, meridional=0.08, bending=(40.0, 60.0, 50.0))

    def told(pressure, belt):
        tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=pressure, belt=belt)
        return [text for text in of_tire(tire) if "of the belt" in text]

    said = told(1.4e6, belt)
    assert len(said) == 1
    for part in ("1.4e+03 kPa", "500 to 1000 kPa", "Belt(foundation=..."):
        assert part in said[0]
    assert not told(820e3, belt)
    assert not told(1.4e6, fitted)
