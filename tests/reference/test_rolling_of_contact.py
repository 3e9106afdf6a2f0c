"""Rolling contact, cell by cell, against the open-source program CONTACT (revision 2707) on the same grids.

Its forces act on the upper body, which is our tire; units there are mm, N and MPa.
"""

from functools import cache

import numpy as np
import pytest

from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.dissimilar import aluminium_on_steel, rubber_on_asphalt
from treadload.validation.patches import paraboloid
from treadload.validation.shearing import creep_curve

# Rolling disc: a = 6 mm, G = 80 GPa, ν = 0.25, P = 48.25 kN, μ = 0.3.
RADIUS, LOAD, MU = 1 / (2 * 0.785398163397), 48254.8631591, 0.3
# The program iterates to 1e-6 of its own norm of shear.
SAME_CELLS = 1e-5

# Creepage, cells across, Q_x/μP, cells in contact, cells in slip.
CREEPAGES = [
    (-0.000122003598, 25, 0.0994962902, 497, 25),
    (-0.000122003598, 50, 0.0982324151, 1984, 104),
    (-0.000305008995, 25, 0.237577396, 497, 62),
    (-0.000305008995, 50, 0.234466511, 1984, 254),
    (-0.000610017991, 25, 0.436939995, 497, 131),
    (-0.000610017991, 50, 0.432887294, 1984, 510),
    (-0.000915026986, 25, 0.601927761, 497, 191),
    (-0.000915026986, 50, 0.596959844, 1984, 756),
    (-0.00122003598, 25, 0.734840696, 497, 250),
    (-0.00122003598, 50, 0.72840323, 1984, 994),
    (-0.00183005397, 25, 0.911182625, 497, 361),
    (-0.00183005397, 50, 0.904230771, 1984, 1432),
    (-0.00244007196, 25, 0.987822788, 497, 454),
    (-0.00244007196, 50, 0.984468402, 1984, 1792),
    (-0.00366010795, 25, 0.99956809, 497, 497),
    (-0.00366010795, 50, 0.999558314, 1984, 1984),
    (-0.00610017991, 25, 0.999848896, 497, 497),
    (-0.00610017991, 50, 0.999847202, 1984, 1984),
]

# Forces over μP, cells across: creepages x and y, slip cells, largest shear in MPa.
FORCES = [
    ((0.3, None), 25, (-0.000394841740858, 0.0), 85, 125.148685918),
    ((0.5, None), 25, (-0.000719547044161, 0.0), 152, 159.130993199),
    ((0.4, 0.4), 25, (-0.00059872499688, -0.000667071785776), 175, 168.489444568),
    ((0.7, None), 50, (-0.00114765378623, 0.0), 944, 185.367052183),
]

# Rubber (ν = 0.45) on asphalt, 12 mm cells. Given; creepages x and y; forces x and y in N, moment in N m;
# peak pressure and largest shear in kPa, cells in contact, cells in slip.
DRIVE, TURN, STRAIGHT = {"tractive_force": 10e3}, {"lateral_force": 5e3}, {"creepage_y": 0.0}
RUBBER = [
    (
        DRIVE | STRAIGHT,
        (-0.0444511762764, 0.0),
        (10e3, 0.0, 0.0),
        (516.86645939, 257.092961777, 712, 166),
    ),
    (
        STRAIGHT,
        (-0.00798529089052, 0.0),
        (0.0, 0.0, 0.0),
        (521.332597157, 41.0360298961, 708, 10),
    ),
    (
        TURN,
        (-0.00795167181155, -0.0253963861659),
        (0.0, 5e3, -252.029627879),
        (521.480959203, 195.345560768, 707, 82),
    ),
    (
        DRIVE | TURN,
        (-0.0453690099645, -0.0272324641267),
        (10e3, 5e3, -185.317367499),
        (516.700158987, 280.381964357, 715, 193),
    ),
    (
        {"tractive_force": -10e3} | STRAIGHT,
        (0.0301577221978, 0.0),
        (-10e3, 0.0, 0.0),
        (526.399978018, 292.963177916, 704, 186),
    ),
    (
        {"creepage_x": -0.01} | STRAIGHT,
        (-0.01, 0.0),
        (613.397331099, 0.0, 0.0),
        (521.122971812, 40.4242801743, 710, 18),
    ),
    (
        {"creepage_x": -0.05} | STRAIGHT,
        (-0.05, 0.0),
        (11295.3428776, 0.0, 0.0),
        (516.096098156, 279.766721261, 712, 192),
    ),
    (
        {"creepage_x": -0.2} | STRAIGHT,
        (-0.2, 0.0),
        (24406.2387121, 0.0, 0.0),
        (521.684251607, 365.178976125, 714, 714),
    ),
    (
        {"creepage_x": 0.0, "creepage_y": -0.05},
        (0.0, -0.05),
        (-2080.08561008, 9161.0495384, -401.089061514),
        (522.596210882, 270.555477248, 708, 167),
    ),
    (
        {"creepage_x": 0.0} | STRAIGHT,
        (0.0, 0.0),
        (-2368.32710458, 0.0, 0.0),
        (522.248434888, 142.373287709, 704, 46),
    ),
]


@cache
def disc(across):
    bodies = CombinedElasticity.of(80e9, 0.25, 80e9, 0.25)
    cells = across + 6
    spacing = 12e-3 / across
    return paraboloid(bodies, (RADIUS, RADIUS), LOAD, (cells, cells), (spacing, spacing))


@pytest.mark.parametrize(
    ("across", "approach", "peak"), [(25, 0.0565297123355, 640.135927822), (50, 0.056543715499, 639.77476949)]
)
def test_normal_contact_of_the_disc(across, approach, peak):
    normal = disc(across).normal
    assert normal.approach * 1e3 == pytest.approx(approach, rel=1e-7)
    assert normal.pressure.max() / 1e6 == pytest.approx(peak, rel=1e-7)


@pytest.mark.parametrize(("creepage", "across", "force", "contact", "slip"), CREEPAGES)
def test_disc_by_creepage(creepage, across, force, contact, slip):
    patch = disc(across)
    found = patch.roll(MU, (creepage, 0.0))
    assert patch.force(found.shear)[0] / (MU * LOAD) == pytest.approx(force, abs=SAME_CELLS)
    assert patch.contact.sum() == contact
    assert (patch.contact & ~found.stick).sum() == slip


@pytest.mark.parametrize(("forces", "across", "creepages", "slip", "largest"), FORCES)
def test_disc_by_force(forces, across, creepages, slip, largest):
    patch = disc(across)
    found = patch.roll(MU, forces=tuple(None if f is None else f * MU * LOAD for f in forces))
    assert found.rigid == pytest.approx(creepages, rel=SAME_CELLS)
    assert (patch.contact & ~found.stick).sum() == slip
    assert np.hypot(*found.shear).max() / 1e6 == pytest.approx(largest, rel=SAME_CELLS)


def test_moment_of_the_disc():
    patch = disc(25)
    found = patch.roll(MU, forces=(0.4 * MU * LOAD, 0.4 * MU * LOAD))
    assert patch.moment(found.shear) == pytest.approx(-7.569186026, rel=SAME_CELLS)


@pytest.mark.parametrize("row", RUBBER, ids=lambda row: ", ".join(f"{k} = {v:g}" for k, v in row[0].items()))
def test_unlike_bodies(row):
    given, (xi, eta), (along, across, moment), (peak, largest, contact, slip) = row
    data = rubber_on_asphalt(**given).dataset
    assert float(data.creepage_x) == pytest.approx(xi, rel=SAME_CELLS, abs=1e-9)
    assert float(data.creepage_y) == pytest.approx(eta, rel=SAME_CELLS, abs=1e-9)
    # 1e-6 of μP = 24.5 kN.
    assert float(data.tractive_force) == pytest.approx(along, abs=0.025)
    assert float(data.lateral_force) == pytest.approx(across, abs=0.025)
    # The same over an arm of 0.2 m.
    assert float(data.aligning_moment) == pytest.approx(moment, abs=0.005)
    assert float(data.pressure.max()) / 1e3 == pytest.approx(peak, rel=SAME_CELLS)
    shear = np.hypot(data.traction_x, data.traction_y)
    # Where little slips the largest shear stands in one cell at the edge: 2e-5.
    assert float(shear.max()) / 1e3 == pytest.approx(largest, rel=5e-5)
    assert int((data.state > 0).sum()) == contact
    assert int((data.state == 2).sum()) == slip


def test_approach_of_unlike_bodies():
    # Our map starts at its lowest cell, 6 mm from the middle both ways: 0.048 mm lower than the formula.
    approach = float(rubber_on_asphalt(**DRIVE, **STRAIGHT).dataset.approach)
    assert (approach + 0.006**2 * (1 + 1 / 3)) * 1e3 == pytest.approx(37.7377761087, rel=1e-6)


# μ, Q_x/μP; creepage in CONTACT, which rolls the other way, so that force and creepage change sign; peak
# pressure in MPa. Four digits are printed.
BENTALL = [
    (0.05, 0.0, 4.294e-4, 103.6),
    (0.05, 0.75, 5.392e-4, None),
    (0.05, -0.75, 2.108e-4, None),
    (10.0, 0.0, 3.591e-4, 103.8),
]


@pytest.mark.parametrize(("friction", "fraction", "creepage", "peak"), BENTALL)
def test_strip_of_unlike_bodies(friction, fraction, creepage, peak):
    data = aluminium_on_steel(friction, tractive_force=fraction * friction * 16201.9).dataset
    # Half a unit of the last digit printed is 2.4e-4 of the smallest.
    assert float(data.creepage_x) == pytest.approx(-creepage, rel=2.5e-4)
    if peak is not None:
        assert float(data.pressure.max()) / 1e6 == pytest.approx(peak, rel=5e-4)


def test_creep_curve_of_an_ellipse():
    for creepage, found, printed in creep_curve():
        # The example gives one curvature and a/b; our axes are rounded to four digits: 1.3e-4.
        assert found == pytest.approx(printed, abs=2e-4), creepage
