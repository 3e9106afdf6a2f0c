"""What a road, a load or a speed must not be: one clear sentence each."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.errors import ConvergenceError

ASPHALT, SOIL = tl.Elastic(5e9, 0.35), tl.Elastic(1e8, 0.35)
ROAD = tl.Pavement([tl.Layer(ASPHALT, 0.1), tl.Layer(SOIL)])
DISC = tl.UniformDisc(0.1, 7e5)


def solve(**change):
    return tl.solve_response(**{"loads": DISC, "road": ROAD, "depths": [0.0], "x": [0.0], "y": [0.0], **change})


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: tl.Layer(ASPHALT, -0.1), r"thickness must be a positive number of metres, got -0.1"),
        (lambda: tl.Layer(ASPHALT, 0), r"thickness must be a positive number of metres, got 0; leave it out"),
        (lambda: tl.Layer(ASPHALT, "infinite"), r"thickness must be .* got 'infinite'; leave it out for the last"),
        (lambda: tl.Layer(ASPHALT, True), r"thickness must be .* got True"),
        (lambda: tl.Pavement([tl.Layer(ASPHALT, 0.1)]), r"must have no thickness, got 0.1 m; add the soil below"),
        (lambda: tl.Pavement([tl.Layer(ASPHALT), tl.Layer(SOIL)]), r"layer 1 .* has no thickness; only the last"),
        (lambda: tl.Pavement(tl.Layer(ASPHALT)), r"layers must be a list of Layer, got Layer"),
        (lambda: tl.Elastic(0.0, 0.3), r"modulus must be a positive number of Pa, got 0"),
        (lambda: tl.Elastic("5 GPa", 0.3), r"modulus must be a positive number of Pa, got '5 GPa'"),
        (lambda: tl.Elastic(5e9, 0.6), r"poisson must lie in \(-1, 0.5\], got 0.6"),
        (lambda: tl.Elastic(5e9, "0.3"), r"poisson must lie in \(-1, 0.5\], got '0.3'"),
        (
            lambda: tl.Pavement([tl.Layer(ASPHALT, 0.1), tl.Layer(SOIL, bond=tl.pavement.FRICTIONLESS)]),
            r"the last layer .* has no layer below it to be bonded to, got the bond frictionless",
        ),
        (lambda: tl.pavement.Bond(-1.0), r"stiffness of a bond must be >= 0 Pa/m, got -1"),
        (lambda: tl.pavement.Bond(None), r"stiffness of a bond must be >= 0 Pa/m, got None"),
        (lambda: solve(speed=-1.0), r"speed must be >= 0 m/s, got -1"),
        (lambda: solve(speed="10"), r"speed must be >= 0 m/s, got '10'"),
        (lambda: solve(depths=[-0.01]), r"depths must not be negative, got -0.01 m; depth counts downwards"),
        (lambda: solve(x=[1e5]), r"points up to 100000 m from the load needs .* wavenumbers, more than"),
        (
            lambda: solve(loads=tl.UniformRectangle(0.2, 0.2, 1e5), x=[5e3], y=[5e3]),
            r"points up to 5000.1 m from the load needs .* wavenumbers, more than",
        ),
    ],
)
def test_refusals(ask, message):
    with pytest.raises(tl.InputError, match=message):
        ask()


@pytest.mark.parametrize("poisson", [0.5, 0.49999])
def test_an_incompressible_layer_on_rock_is_solved(poisson):
    """No long wave breaks it: vertical equilibrium over the base, and the same as almost incompressible."""
    road = tl.Pavement([tl.Layer(ASPHALT, 0.1), tl.Layer(tl.Elastic(3e8, poisson), 0.5)], rigid_base=True)
    near = tl.Pavement([tl.Layer(ASPHALT, 0.1), tl.Layer(tl.Elastic(3e8, 0.4999), 0.5)], rigid_base=True)
    points = {"depths": [0.0, 0.1, 0.35, 0.6], "x": [0.0, 0.2], "y": [0.0]}
    for load in (DISC, tl.UniformRectangle(0.2, 0.2, 7e5, traction_x=1e5)):
        one, other = (tl.solve_response(load, each, **points).dataset for each in (road, near))
        for name in ("stress_zz", "stress_xx", "displacement_z"):
            a, b = one[name].to_numpy(), other[name].to_numpy()
            # 1e-4 of Poisson's ratio, which the volume feels a few times over.
            assert np.abs(a - b).max() <= 2e-3 * np.abs(b).max(), name
    assert math.isfinite(float(one["strain_zz"].sum()))


@pytest.mark.parametrize("top", [ASPHALT, tl.materials.Prony(5e9, ((1e-9, 1e-3),), 0.35)], ids=["elastic", "moving"])
def test_a_loose_course_over_an_incompressible_one_on_rock(top):
    """Waves of kilometres press 15 m that keep their volume through 5 mm: stress is that of almost the same road."""

    def stress(middle):
        layers = [
            tl.Layer(top, 0.1),
            tl.Layer(tl.Elastic(5e7, middle), 15.0, bond=tl.pavement.FRICTIONLESS),
            tl.Layer(tl.Elastic(2e8, 0.3), 0.005),
        ]
        road = tl.Pavement(layers, rigid_base=True)
        points = {"depths": [0.05, 1.0, 15.0], "x": [0.0, 0.3], "y": [0.0]}
        loads = tl.UniformRectangle(0.2, 0.2, 6.62e5, traction_x=2e5)
        speed = None if isinstance(top, tl.Elastic) else 20.0
        return tl.solve_response(loads, road, speed=speed, **points).dataset

    found, near = stress(0.5), stress(0.49999)
    for name in ("stress_zz", "stress_xx"):
        a, b = found[name].to_numpy(), near[name].to_numpy()
        size = np.abs(b).max(axis=(1, 2))
        # 1e-5 of Poisson's ratio, which horizontal stress feels ten times over; waves that lose digits err by 16.
        assert (np.abs(a - b).max(axis=(1, 2)) <= 3e-4 * size).all(), name


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_no_number_is_never_returned(monkeypatch, value):
    def broken(loads, sites, pairs, view, **more):
        stress = np.zeros((6, len(sites[0].depths), *view.shape))
        strain = stress.copy()
        strain[2, 1] = value
        yield stress, strain, stress[:3], "layered"

    monkeypatch.setattr("treadload.response.several.layered_responses", broken)
    with pytest.raises(ConvergenceError, match=r"strain at 0\.02 m is not a number: .* check their units"):
        solve(depths=[0.0, 0.02])
