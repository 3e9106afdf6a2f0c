"""Bounds of damage: what a sentence promises to take is taken, and a bound that it leaves out is refused."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.damage import (
    Criterion,
    Extension,
    FatigueLine,
    FrenchBituminous,
    FrenchHydraulic,
    FrenchSubgrade,
    InterfaceStrength,
    MazarsOnset,
    ShearFatigue,
    assess_bonds,
    miner,
)
from treadload.damage.climate import Climate, Season
from treadload.damage.history import add_thermal_stress, residual_after, thermal_stress
from treadload.damage.interface import interface_fields
from treadload.damage.laws.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
    bottom_up_cracking,
    mix_factor,
)
from treadload.damage.laws.energy_ratio import EnergyRatio
from treadload.damage.laws.equivalence import AGGRESSIVENESS, GROUP_FACTORS, aggressiveness, growth_factor
from treadload.damage.laws.french import RISK, platform_factor, thickness_scatter
from treadload.damage.laws.indian import IrcCementTreated, IrcFatigue, IrcRutting
from treadload.damage.laws.of_layer import OnLayer
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.damage.worst_point import _around
from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.registry import CRITERIA

ROAD = Pavement([Layer(Elastic(5e9, 0.35), 0.1), Layer(Elastic(1e9, 0.35), 0.2), Layer(Elastic(1e8, 0.35))])
WHEEL = tl.UniformRectangle(0.2, 0.2, 8e5, traction_x=2e5)
X = np.array([-0.15, 0.0, 0.15])
ONE = AxleClass("one", 1.0, 3e4, 8e5)
LINE = FatigueLine(120e-6, -0.2)
GLUE = InterfaceStrength(1e6)
CLIMATE = Climate.constant(15.0)
GB = {"epsilon_6": 90e-6, "slope": -0.2, "scatter": 0.3, "thickness": 0.15, "risk": 0.05, "calibration": 1.3}
MIX = {
    "creep_compliance": 1e-10, "slope": 0.5, "strength": 2e6, "fracture_energy": 2500.0, "resilient_modulus": 1e10,
}  # fmt: skip
SOLID = tl.materials.Prony(3e10, ((0.5, 1.0),), 0.35)
HALF = tl.Pavement.half_space(Elastic(5e9, 0.35))
FIELD = tl.solve_response(WHEEL, HALF, depths=[0.0, 0.1], x=np.linspace(-0.5, 0.5, 21), y=[0.0])
JUST = 1e-9


def french(**given):
    return FrenchBituminous(**{**GB, **given})


def ratio(**given):
    return EnergyRatio(**{**MIX, **given})


class _Ten:
    reference = 10.0

    def factor(self, temperature):
        return np.ones(np.shape(temperature))


def cooled(time=(0.0, 1.0), temperature=(1.0, 0.0), expansion=2e-5):
    return thermal_stress(SOLID, _Ten(), time, temperature, expansion=expansion)


def lived(count):
    y = 0.1 * np.arange(count)
    traffic = Traffic((ONE,), 1e5)
    return miner(np.full((1, 1, 1, count), 1e-4), (Criterion("a", LINE),), traffic, CLIMATE, y=y)


# What builds, the last number that it takes, the first that it refuses, a word of the sentence.
BOUNDS = [
    (lambda v: InterfaceStrength(1e6, v), np.nextafter(math.pi / 2, 0), math.pi / 2, "friction_angle"),
    (lambda v: InterfaceStrength(1e6, v), 0.0, -JUST, "friction_angle"),
    (lambda v: InterfaceStrength(v), 0.0, -JUST, "cohesion"),
    (lambda v: InterfaceStrength(1e6, 0.0, v), 0.0, -JUST, "tensile_strength"),
    (lambda v: InterfaceStrength(1e6, math.pi / 4, v), 1e6, 1e6 + 1, "beyond the end of Coulomb"),
    (lambda v: InterfaceStrength.from_leutner(v), 1e-3, 0.0, "force"),
    (lambda v: InterfaceStrength.from_leutner(1e4, v), 1.0, 1 + JUST, "diameter"),
    (lambda v: ShearFatigue(v), -1 + JUST, -1.0, "slope"),
    (lambda v: ShearFatigue(v), -JUST, 0.0, "slope"),
    (lambda v: ShearFatigue(-0.2, v), JUST, 0.0, "single_pass"),
    (lambda v: FatigueLine(120e-6, v), -1 + JUST, -1.0, "slope"),
    (lambda v: FatigueLine(120e-6, v), -JUST, 0.0, "slope"),
    (lambda v: FatigueLine(v, -0.2), JUST, 0.0, "epsilon_6"),
    (lambda v: FatigueLine(v, -0.2), 0.01, 0.0101, "plain strain"),
    (lambda v: french(risk=v), JUST, 0.0, "risk"),
    (lambda v: french(risk=v), 1 - JUST, 1.0, "risk"),
    (lambda v: french(thickness_scatter=v), 0.0, -JUST, "thickness_scatter"),
    (lambda v: french(thickness_scatter=v), 0.5 - JUST, 0.5, "thickness_scatter"),
    (lambda v: FrenchSubgrade(v), 1.0, 1 + JUST, "constant"),
    (lambda v: AsphaltInstitute(v), 1e6, 1e6 - 1, "5400 MPa"),
    (lambda v: AsphaltInstitute(5e9, v, 0.1), 1 - JUST, 1.0, "air_voids"),
    (lambda v: AsphaltInstitute(5e9, 0.05, v), JUST, 0.0, "binder_volume"),
    (lambda v: IrcFatigue(v, 0.035, 0.115), 1e6, 1e6 - 1, "3000 MPa"),
    (lambda v: IrcCementTreated(v), 1e3, 999.0, "1.4 MPa"),
    (lambda v: bottom_up_cracking(v, 0.1), 0.0, -JUST, "damage"),
    (lambda v: growth_factor(10.0, v), -1 + JUST, -1.0, "growth"),
    (lambda v: growth_factor(10.0, v), 10.0, 10 + JUST, "growth"),
    # 20 years that lose a tenth of the first's traffic a year: arithmetic growth leaves none after 21.
    (lambda v: growth_factor(v, -0.1, "arithmetic"), 20.9, 21.0, "leaves no traffic"),
    (lambda v: aggressiveness([(v, 1.0, 1.0)], vehicles=1.0, power=5.0), 1.0, 0.0, "load > 0"),
    (lambda v: aggressiveness([(1e5, v, 1.0)], vehicles=1.0, power=5.0), 0.0, -JUST, "number >= 0"),
    (lambda v: aggressiveness([(1e5, 1.0, v)], vehicles=1.0, power=5.0), JUST, 0.0, "K > 0"),
    (lambda v: replace(ONE, share=v), 0.0, -JUST, "share"),
    (lambda v: replace(ONE, share=v), 1.0, 1 + JUST, "share"),
    (lambda v: replace(ONE, wheel_load=v), JUST, 0.0, "wheel_load"),
    (lambda v: replace(ONE, inflation_pressure=v), JUST, 0.0, "inflation_pressure"),
    (lambda v: replace(ONE, mirrored=(v,)), 0, 1, "none is number 1"),
    (lambda v: Season("s", v, 10.0), 0.0, -JUST, "share"),
    (lambda v: Season("s", v, 10.0), 1.0, 1 + JUST, "share"),
    (lambda v: Wander(v), 0.0, -JUST, "deviation"),
    (lambda v: Wander.measured([0.0, v], [0.5, 0.5]), JUST, 0.0, "increase"),
    (lambda v: Traffic((ONE,), v), 0.0, -JUST, "passes_per_year"),
    (lambda v: Traffic((ONE,), 1.0, years=v), 1.0, 0.0, "design life"),
    (lambda v: Traffic((ONE,), 1.0).years_to(v), 0.0, -JUST, "passes must"),
    (lambda v: MazarsOnset(v), JUST, 0.0, "mazars_onset"),
    (lambda v: MazarsOnset(v), 0.01 - JUST, 0.01, "mazars_onset"),
    (lambda v: ratio(slope=v), JUST, 0.0, "slope"),
    (lambda v: ratio(slope=v), 1 - JUST, 1.0, "slope"),
    (lambda v: ratio(strength=v, fracture_energy=1e5), 6.36e6 - 1, 6.36e6, "6.36"),
    # St² / (2 MR) = 200 J/m³.
    (lambda v: ratio(fracture_energy=v), 200.001, 200.0, "must exceed the elastic energy"),
    (lambda v: residual_after(FIELD, spacing=v, passes=1), 0.1, 0.0, "spacing"),
    (lambda v: residual_after(FIELD, spacing=0.1, passes=v), 1, 0, "passes"),
    (lambda v: cooled(expansion=v), 0.0, -JUST, "expansion"),
    (lambda v: cooled(expansion=v), 0.01 - JUST, 0.01, "expansion"),
    (lambda v: cooled(time=(0.0, v)), JUST, 0.0, "increasing"),
    (lambda v: cooled(time=np.arange(v), temperature=np.zeros(v)), 2, 1, "two increasing"),
    (lambda v: cooled(temperature=(1.0, v)), 0.0, math.nan, "finite"),
    (lambda v: add_thermal_stress(FIELD, [1.0, v]), 0.0, math.nan, "finite"),
    (lambda v: add_thermal_stress(FIELD, np.zeros(v)), 2, 3, "each of 2 depths"),
    (lived, 2, 1, "evenly spaced"),
    (lambda v: Criterion("a", LINE, v).depth(ROAD), 1, 2, "semi-infinite"),
    (lambda v: Criterion("a", LINE, v, "top").depth(ROAD), -3, -4, "reads layer -4"),
    (lambda v: Criterion("a", LINE, v, "top").depth(ROAD), 2, 3, "reads layer 3"),
    (lambda v: Criterion.of_bond("b", InterfaceStrength(1e6), ShearFatigue(-0.2), v).depth(ROAD), 1, 2, "interface"),
    (
        lambda v: Criterion.of_bond("b", InterfaceStrength(1e6), ShearFatigue(-0.2), v).depth(ROAD),
        -2,
        -3,
        "interface",
    ),
]


@pytest.mark.parametrize(
    ("make", "taken", "refused", "words"), BOUNDS, ids=[f"{k}-{b[3]}" for k, b in enumerate(BOUNDS)]
)
def test_a_bound_lies_where_its_sentence_says(make, taken, refused, words):
    make(taken)
    with pytest.raises(InputError, match=words):
        make(refused)


def test_tables_of_the_french_method():
    """As in the sources: twin and triple axles, and what rises with the traffic."""
    assert GROUP_FACTORS == {"bituminous": {1: 1, 2: 0.75, 3: 1.1}, "hydraulic": {1: 1, 2: 12, 3: 113}}
    order = ["T5", "T4", "T3-", "T3+", "T2", "T1", "T0", "motorway"]
    for kind, table in AGGRESSIVENESS.items():
        assert list(table) == order[: len(table)]
        assert (np.diff(list(table.values())) >= 0).all(), kind
        # A motorway's trucks are the heaviest: none is worth more than its 1.3, and none but theirs more than 1.
        assert max([v for k, v in table.items() if k != "motorway"]) <= 1.0
    assert [AGGRESSIVENESS[k]["motorway"] for k in ("bituminous", "hydraulic", "subgrade")] == [0.8, 1.3, 1.0]
    # From T2 up trucks are alike.
    for traffic in ("T2", "T1", "T0"):
        assert [AGGRESSIVENESS[k][traffic] for k in AGGRESSIVENESS] == [0.5, 0.8, 0.8, 1.0]
    for traffic in ("TS", "TEX"):
        assert [RISK[k][traffic] for k in RISK] == [0.01, 0.01]
    for table in RISK.values():
        assert (np.diff(list(table.values())) <= 0).all()
        assert table["T1"] == 0.05


def test_tables_of_the_french_method_row_by_row():
    """By class of traffic, as the method prints them: in per cent the risk, then CAM of each kind of layer."""
    risk = {"T5": (30, 25), "T4": (30, 25), "T3": (25, 12), "T2": (12, 7.5), "T1": (5, 5), "T0": (2, 2.5)}
    for traffic, row in {**risk, "TS": (1, 1), "TEX": (1, 1)}.items():
        assert [100 * RISK[kind][traffic] for kind in ("bituminous", "hydraulic")] == pytest.approx(row), traffic
    cam = {"T5": (0.3, 0.4, 0.4, 0.4), "T4": (0.3, 0.5, 0.5, 0.5), "T3-": (0.4, 0.6, 0.7, 0.6)}
    for traffic, row in {**cam, "T3+": (0.5, 0.6, 0.7, 0.75)}.items():
        kinds = ("bituminous", "hydraulic", "treated soil", "subgrade")
        assert tuple(AGGRESSIVENESS[kind][traffic] for kind in kinds) == row, traffic


def test_a_stiffer_platform_takes_off_the_reduction_in_three_steps():
    bounds = np.array([50e6, 80e6, 120e6])
    below, at = ([platform_factor(v) for v in values] for values in (bounds - 1, bounds))
    assert below == pytest.approx([1 / 1.2, 1 / 1.1, 1 / 1.065])
    assert at == pytest.approx([1 / 1.1, 1 / 1.065, 1.0])
    assert platform_factor(None) == 1.0
    # What nobody tells changes nothing: the ratio of moduli, the platform.
    assert french().at_a_million == french(modulus_ratio=1.0, platform_modulus=200e6).at_a_million
    assert thickness_scatter(0.05) == thickness_scatter(0.10) == 0.01
    assert thickness_scatter(0.4) == 0.025 == pytest.approx(thickness_scatter(0.15))
    assert thickness_scatter(0.125) == pytest.approx(0.0175)


def test_half_as_much_air_lives_longer_by_the_mix_factor():
    """C is 1 where the binder fills 69 % of the voids of the stones, and 10^4.84 times that of none at all."""
    assert mix_factor(0.31, 0.69) == pytest.approx(1.0, rel=1e-12)
    assert mix_factor(1e-12, 0.1) / mix_factor(0.1, 1e-12) == pytest.approx(10**4.84, rel=1e-9)


@pytest.mark.parametrize(("points", "told"), [(2, False), (3, True)])
def test_two_points_have_no_middle_and_three_have_an_edge(points, told):
    x = np.linspace(-0.3, -0.1, points)
    fields = interface_fields(tl.solve_response(WHEEL, ROAD, depths=ROAD.interfaces, x=x, y=[-0.1, 0.0, 0.1]))
    said = assess_bonds(fields, InterfaceStrength(1e6)).warnings
    assert any("edge of the points" in text for text in said) == told


def test_attributes_of_a_life_are_read_by_people():
    """French, Greek and degrees stand as they are in a file, and are JSON still."""
    law = FrenchHydraulic(0.75e6, -1 / 15, 1.0, 0.05, 1.4)
    life = miner(np.ones((1, 1, 1, 2)), (Criterion("a", law),), Traffic((ONE,), 1e5), CLIMATE, y=[0.0, 0.1]).dataset
    assert "σ₆" in life.attrs["laws"]
    for name in ("laws", "sources", "caveats", "ends"):
        assert "\\u" not in life.attrs[name]
        assert json.loads(life.attrs[name])


@pytest.mark.parametrize(
    ("law", "power"),
    [
        (MepdgTopDown(5e9, 0.2, 0.07, 0.11), 3.9492),
        (MepdgBottomUp(5e9, 0.2, 0.07, 0.11), 3.9492),
        (AsphaltInstitute(5e9), 3.291),
        (AsphaltInstituteSubgrade(), 4.477),
        (ShellFatigue(5e9), 5.671),
        (IrcFatigue(3e9, 0.035, 0.115), 3.89),
        (IrcRutting(), 4.5337),
        (FrenchSubgrade(), 1 / 0.222),
    ],
    ids=str,
)
def test_passes_fall_with_the_power_that_the_law_prints(law, power):
    assert law.allowable_passes(1e-4) / law.allowable_passes(1e-3) == pytest.approx(10**power, rel=1e-9)


def test_one_pass_of_the_laws_of_soils():
    """N = 1.365e-9 ε^-4.477 allows one pass at the strain at which it says so; the French A is that strain."""
    assert AsphaltInstituteSubgrade().allowable_passes(1.0) == pytest.approx(1.365e-9, rel=1e-9)
    assert FrenchSubgrade().allowable_passes(0.012) == pytest.approx(1.0, rel=1e-9)


def on_layer(number, law, **given):
    road = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    return CRITERIA.find(law).target(OnLayer("c", road, number), **given)


def test_a_given_scatter_needs_no_asphalt_to_be_added_up():
    """Sh is all that the thickness is for: where it is given, only the layer's own is told."""
    added = on_layer(1, "french-bituminous", risk=0.05)
    own = on_layer(1, "french-bituminous", risk=0.05, thickness_scatter=0.02)
    assert (added(15.0).thickness, own(15.0).thickness) == (pytest.approx(0.21), pytest.approx(0.15))
    assert (added(15.0).spread, own(15.0).spread) == (pytest.approx(0.025), 0.02)


def test_numbers_that_nobody_gives_are_the_laws_own():
    plain = FrenchHydraulic(0.75e6, -1 / 15, 1.0, 0.05, 1.4)
    given = {"sigma_6": 0.75e6, "slope": -1 / 15, "scatter": 1.0, "risk": 0.05, "calibration": 1.4}
    built = CRITERIA.find("french-hydraulic").target(OnLayer("c", ROAD, 1), **given)
    assert built == plain


def test_tension_is_the_largest_of_the_plane_in_every_direction():
    """A pull of 3e5 Pa across which 1e5 Pa press, turned by any angle, is a pull of 3e5 Pa."""
    criterion = Criterion("gravel", FrenchHydraulic(0.75e6, -1 / 15, 1.0, 0.05, 1.4), 0)
    for angle in (0.0, 0.4, math.pi / 2):
        c, s = math.cos(angle), math.sin(angle)
        xx, yy, xy = 3e5 * c * c - 1e5 * s * s, 3e5 * s * s - 1e5 * c * c, 4e5 * s * c
        parts = {"xx": xx, "yy": yy, "xy": xy, "xz": 0.0, "yz": 0.0, "zz": -7e5}
        plane = xr.Dataset({f"stress_{k}": (("y", "x"), np.full((1, 1), v)) for k, v in parts.items()})
        assert criterion.read(plane).item() == pytest.approx(3e5)


def test_the_usual_stress_itself_needs_no_warning():
    """148 and 230 psi are what the reports put in."""
    assert ratio().warnings(230 * 6894.757293168361) == ()
    assert len(ratio().warnings(231 * 6894.757293168361)) == 1


@pytest.mark.parametrize("coarse", [0.9, 1.1])
def test_an_error_estimate_names_the_fewer_passes_first(coarse):
    response = tl.solve_response(WHEEL, HALF, depths=[0.02], x=np.linspace(-0.2, 0.2, 9), y=[0.0])
    verdict = tl.assess(response, LINE)
    read = float(verdict.dataset["worst_strain"])
    about = {"coarse_strain": coarse * read, "spacing": 0.01, "coarse_spacing": 0.02}
    rows = replace(verdict, dataset=verdict.dataset.assign_attrs(about)).rows()
    (note,) = [row.note for row in rows if row.key == "coarse_strain"]
    fewest, most = (float(number) for number in note.split("load repetitions: ")[1].split(" to "))
    assert fewest < LINE.allowable_passes(read) < most
    # Ten per cent of the strain to the fifth power, printed to two digits.
    assert fewest == pytest.approx(LINE.allowable_passes(1.1 * read), rel=0.05)


def test_neighbours_as_far_as_the_side_of_the_mean_are_near():
    """Between points as far apart as the cube is wide a mean cannot hide; further it can."""
    assert _around(0.25 * np.arange(5), 2, 0.25) is not None
    assert _around(0.25 * np.arange(5), 2, 0.2499) is None


def test_what_is_given_stands_before_the_mix():
    own = next(mix for mix in tl.catalogue.mixes.values() if getattr(mix, "joints", None) is not None)
    assert FrenchHydraulic.of(own, risk=0.05, thickness_scatter=0.02).joints == own.joints
    given = FrenchHydraulic.of(own, risk=0.05, joints=0.5 * own.joints, thickness_scatter=0.02)
    assert given.joints == 0.5 * own.joints
    assert given.at_a_million == pytest.approx(
        0.5 * FrenchHydraulic.of(own, risk=0.05, thickness_scatter=0.02).at_a_million, rel=1e-12
    )


def test_a_crack_lies_across_the_extension_that_is_read():
    """An extension of 1e-4 along a direction tilted by 50°: read whole in space, in part in the plane."""
    tilt, turn = math.radians(50), math.radians(20)
    d = np.array([math.cos(tilt) * math.cos(turn), math.cos(tilt) * math.sin(turn), math.sin(tilt)])
    tensor = 1e-4 * np.outer(d, d)
    strain = np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]])
    strain = strain.reshape(6, 1, 1)
    space, plane = Extension("principal"), Extension("in-plane")
    assert space.of(strain, strain).item() == pytest.approx(1e-4)
    assert plane.of(strain, strain).item() == pytest.approx(1e-4 * math.cos(tilt) ** 2)
    for quantity, wanted in ((space, d), (plane, np.array([math.cos(turn), math.sin(turn), 0.0]))):
        normal = np.asarray(quantity.normal(strain, strain)).reshape(3)
        assert abs(normal @ wanted) == pytest.approx(1.0)
