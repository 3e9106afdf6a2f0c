"""Every tire of the catalogue at its usual load and inflation pressure: balance, mean pressure, footprint."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

import treadload as tl
from treadload.catalogue import belts, tires
from treadload.tire import Belt, Tire, TreadProfile

STIFF_ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
HOT_ROAD = tl.Pavement.half_space(tl.Elastic(500e6, 0.35))
RUBBER = tl.Elastic(6e6, 0.49)
STEEL = tl.Elastic(210e9, 0.3)


@dataclass(frozen=True)
class Usual:
    """Load, N, inflation pressure, Pa, and what the footprint may be.

    net_mean: bounds of load over contact area and inflation pressure. length: bounds of the footprint's, m.
    deflection: m. spacing: of the cells, m.
    """

    load: float
    pressure: float
    net_mean: tuple[float, float]
    length: tuple[float, float]
    deflection: float
    spacing: float = 6e-3


# Net mean over inflation pressure: 1.0 to 1.3 at the rated load with grooves of 15 to 20 % of the width, as
# commonly quoted (0.8 to 1.0 with grooves counted); more where the belt's caveats say that its footprint is small,
# and for 11R22.5, the narrowest of the trucks' for its deflection. Lengths: estimated, 0.15 to 0.25 m for
# trucks, 0.10 to 0.13 for cars; of the aircraft between half and all of the ellipse of load over pressure
# (0.51 m), of the bicycle up to the chord at its deflection (118 mm). Deflections: those that the belts were
# fitted to, or, of the two older ones, what their caveats state.
USUAL = {
    "11R22.5": Usual(27.5e3, 724e3, (1.0, 1.4), (0.16, 0.25), 0.034),
    "205/60R15": Usual(4e3, 220e3, (1.0, 1.7), (0.095, 0.13), 0.026),
    "275/70R22.5": Usual(30.9e3, 900e3, (1.0, 1.3), (0.15, 0.25), 0.032),
    "315/80R22.5": Usual(35e3, 800e3, (1.0, 1.3), (0.16, 0.25), 0.035),
    "385/65R22.5": Usual(44.1e3, 900e3, (1.0, 1.3), (0.16, 0.25), 0.037),
    "445/50R22.5": Usual(45.4e3, 830e3, (1.0, 1.3), (0.16, 0.25), 0.037),
    "H44.5x16.5-21": Usual(182e3, 1410e3, (1.0, 1.6), (0.26, 0.51), 0.082),
    "37-622": Usual(450.0, 400e3, (0.9, 1.2), (0.08, 0.118), 0.005, 1e-3),
}


def solved(tire, road, load, spacing):
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=load, friction=0.0), spacing=spacing)
    pressure = contact.dataset["pressure"].to_numpy()
    x = contact.dataset["x"].to_numpy()
    length = np.ptp(x[(pressure > 0).any(axis=0)]) + x[1] - x[0]
    assert pressure.sum() * contact.cell_area == pytest.approx(load, rel=1e-6)
    return contact, pressure, length


def belted(name, tread="layer", pressure=None):
    pressure = USUAL[name].pressure if pressure is None else pressure
    return Tire.from_profile(name, inflation_pressure=pressure, belt=Belt.from_library(name), tread=tread)


def test_every_profile_with_a_belt_is_tried():
    both = {name for name, tire in tires.items() if isinstance(tire, TreadProfile) and name in belts}
    assert both == set(USUAL)
    # Those without a belt: below, and the tread of the mesh, whose belt has the name of the size alone.
    without = {name for name, tire in tires.items() if isinstance(tire, TreadProfile)} - both
    assert without == {"7.00-12 solid", "203 x 47 steel", "335/65R22.5 tread"}
    assert all(tire.vehicle for tire in tires.values() if isinstance(tire, TreadProfile))


@pytest.mark.parametrize("name", USUAL)
def test_the_footprint_at_the_usual_load(name):
    usual = USUAL[name]
    contact, pressure, length = solved(belted(name), STIFF_ROAD, usual.load, usual.spacing)
    low, high = usual.net_mean
    assert low <= usual.load / contact.area / usual.pressure <= high
    assert usual.length[0] <= length <= usual.length[1]
    # 3 % where the belt's foundation has three digits and cells differ from those of the fit; the car's is rounded.
    assert float(contact.dataset["approach"]) == pytest.approx(usual.deflection, rel=0.03)
    # A standing tire on a stiff half-space is its own mirror image.
    np.testing.assert_allclose(pressure, pressure[:, ::-1], atol=1e-4 * pressure.max())
    np.testing.assert_allclose(pressure, pressure[::-1], atol=1e-4 * pressure.max())


@pytest.mark.parametrize("name", [name for name in USUAL if tires[name].grooves])
def test_shoulder_ribs_carry_about_as_much_as_middle_ones(name):
    # The crown radius was chosen so; 315/80R22.5's was fitted as a half-space, as its caveat states.
    profile, usual = tires[name], USUAL[name]
    contact, pressure, _ = solved(belted(name), STIFF_ROAD, usual.load, 3e-3)
    y, rows = contact.dataset["y"].to_numpy(), pressure.sum(axis=1)
    edges = [-np.inf, *(groove.centre for groove in profile.grooves), np.inf]
    loads = [rows[(y > low) & (y < high)].sum() for low, high in pairwise(edges)]
    share = loads[0] / loads[len(loads) // 2]
    assert 0.7 < share < (1.8 if name == "315/80R22.5" else 1.2)


def test_a_softer_tire_has_a_longer_footprint():
    lengths = [solved(belted("385/65R22.5", pressure=p), STIFF_ROAD, 44.1e3, 6e-3)[2] for p in (700e3, 900e3)]
    assert lengths[0] > lengths[1] * 1.05


def test_the_solid_tire_as_a_half_space():
    tire = Tire.from_profile("7.00-12 solid", material=RUBBER)
    contact, _, length = solved(tire, STIFF_ROAD, 25e3, 4e-3)
    # As commonly quoted: 0.7 to 1.3 MPa below solid tires of fork-lift trucks.
    assert 0.7e6 < 25e3 / contact.area < 1.3e6
    # An endless roller of this width on the rubber, a = √(4 w R / (π E*)): rounded shoulders take 15 % of the width
    # away, which makes the middle longer, and both ends carry more than their share, which makes it shorter.
    modulus = 1 / ((1 - 0.49**2) / 6e6 + (1 - 0.35**2) / 5.4e9)
    cylinder = 2 * np.sqrt(4 * 25e3 / 0.160 * 0.334 / (np.pi * modulus))
    assert 0.85 * cylinder < length < 1.2 * cylinder


def test_the_steel_wheel_is_a_cylinder_on_the_road():
    tire = Tire.from_profile("203 x 47 steel", material=STEEL)
    contact, pressure, _ = solved(tire, HOT_ROAD, 705.0, 2.5e-4)
    modulus = 1 / ((1 - 0.35**2) / 500e6 + (1 - 0.3**2) / 210e9)
    half = np.sqrt(4 * 705.0 / 0.047 * 0.1018 / (np.pi * modulus))
    peak = 2 * 705.0 / 0.047 / (np.pi * half)
    # Both ends of a wheel with sharp edges carry more than their share, so that the middle has up to 10 % less.
    middle = pressure[pressure.shape[0] // 2]
    assert 0.90 * peak < middle.max() < peak
    dx = float(np.diff(contact.dataset["x"].to_numpy()[:2])[0])
    assert np.count_nonzero(middle) * dx == pytest.approx(2 * half, abs=2 * dx)
