"""What is read of stress and strain: ours, and a quantity, a law and a strength of others, each in a file."""

import json
import re
import sys

import numpy as np
import pytest

import treadload as tl
from cases import ONE_AXLE
from packages import build
from treadload import variables
from treadload.case import Case
from treadload.damage import (
    Criterion,
    Extension,
    FatigueLine,
    FrenchSubgrade,
    MazarsStrain,
    MepdgTopDown,
    OctahedralShear,
    PowerLine,
    ShearFatigue,
    compute_quantities,
    known_quantities,
)
from treadload.damage.quantities import EXTENSION, SUBGRADE_COMPRESSION, TENSION
from treadload.damage.quantity import Quantity
from treadload.damage.ratios import OctahedralRatio
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.registry import QUANTITIES
from treadload.reporting import write_report
from treadload.response import UniformRectangle, solve_response
from treadload.response.fields import response_dataset

QUANTITY = '''
"""Shear that a course bears, by Tresca."""
from dataclasses import dataclass

from treadload.damage import Quantity
from treadload.kernels import tensors
from treadload.units import Share


@dataclass(frozen=True)
class LargestShear(Quantity):
    """Largest shear stress, half the difference of the principal stresses.

    counted: share of it that counts.
    """

    counted: Share = 1.0

    name = "largest_shear"
    words = "largest shear stress"
    unit, shown = "Pa", "kPa"
    harm = "shoving, no crack"

    def of(self, stress, strain):
        values = tensors.principal(stress)[0]
        return self.counted * 0.5 * (values[0] - values[2])
'''

LAW = '''
"""Rounds of a wheel tracker."""
from dataclasses import dataclass
from typing import ClassVar

from road_readings.quantity import LargestShear
from treadload.damage import PowerLaw
from treadload.units import Modulus


@dataclass(frozen=True)
class Tracker(PowerLaw):
    """Rounds to a rut of 10 mm. tau_6: shear of a million rounds."""

    tau_6: Modulus

    reads = LargestShear()
    source: ClassVar[str] = "our tracker"
    end_of_life: ClassVar[str] = "a rut of 10 mm"
    exponent = -0.25

    @property
    def at_a_million(self):
        return self.tau_6

    def __str__(self):
        return f"tracker, {self.tau_6 / 1e3:g} kPa"
'''

STRENGTH = '''
"""A bond whose envelope is a parabola."""
from dataclasses import dataclass

import numpy as np

from treadload.damage import BondStrength, BondUtilisation
from treadload.units import Pressure


@dataclass(frozen=True)
class Parabola(BondStrength):
    """Shear c at no pressure, c √(1 + 3 σ/c) under pressure. cohesion: c."""

    cohesion: Pressure

    def utilisation(self, shear, normal):
        pressed = np.maximum(np.asarray(normal), 0.0)
        return np.asarray(shear) / (self.cohesion * np.sqrt(1 + 3 * pressed / self.cohesion))


def parabola(cohesion: Pressure) -> BondUtilisation:
    """How much of a bond with a parabola for its envelope is used up. cohesion: c."""
    return BondUtilisation(Parabola(cohesion))
'''

ENTRY_POINTS = """
[treadload.quantities]
largest_shear = road_readings.quantity:LargestShear
parabola = road_readings.strength:parabola
broken = road_readings.nowhere:Broken

[treadload.criteria]
tracker = road_readings.law:Tracker
"""

DESIGN = (
    'title = "Readings of others"'
    + ONE_AXLE
    + """[[criteria]]
name = "ours, theirs"
law = "power-law"
reads = { quantity = "largest_shear", counted = "50 %" }
reading_6 = "200 kPa"
slope = -0.25
layer = "EB-GB3"
[[criteria]]
name = "theirs"
law = "tracker"
tau_6 = "400 kPa"
layer = "EB-GB3"
[[criteria]]
name = "bond"
law = "shear-fatigue"
reads = { quantity = "parabola", cohesion = "1 MPa" }
slope = -0.2
layer = "EB-BBSG3"
"""
)

ROAD = Pavement([Layer(Elastic(5e9, 0.35), 0.06), Layer(Elastic(9e9, 0.35), 0.15), Layer(Elastic(120e6, 0.35))])
LINE = np.linspace(-0.2, 0.2, 9)


@pytest.fixture
def road_readings(tmp_path, monkeypatch):
    """A package as an installer leaves it: three modules, and its metadata beside them."""
    build(tmp_path, "road_readings", ENTRY_POINTS, version="0.1", quantity=QUANTITY, law=LAW, strength=STRENGTH)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield
    for name in [name for name in sys.modules if name.split(".")[0] == "road_readings"]:
        del sys.modules[name]


@pytest.fixture(scope="module")
def response():
    wheel = UniformRectangle(0.2, 0.25, 8e5, traction_x=-2e5)
    return solve_response(wheel, ROAD, depths=[0.0, 0.06, 0.21], x=LINE, y=LINE)


def tensor(data, kind):
    full = np.array([["xx", "xy", "xz"], ["xy", "yy", "yz"], ["xz", "yz", "zz"]])
    return np.stack([np.stack([data[f"{kind}_{name}"].to_numpy() for name in row], -1) for row in full], -1)


def test_what_is_theirs_works_in_python(road_readings, response):
    stress = np.linalg.eigvalsh(tensor(response.dataset, "stress"))
    field = compute_quantities(response, ["largest_shear", "mean_stress"])["largest_shear"]
    wanted = 0.5 * (stress[..., 2] - stress[..., 0])
    # Round-off of eigenvalues, over the largest.
    np.testing.assert_allclose(field, wanted, atol=1e-12 * np.abs(stress).max())
    assert field.attrs == {"units": "Pa", "long_name": "largest shear stress"}
    assert "largest_shear" not in known_quantities()
    from road_readings.law import Tracker
    from road_readings.strength import Parabola

    plane = response.dataset.isel(depth=2)
    np.testing.assert_array_equal(Criterion("a", Tracker(4e5), 1).read(plane), field.isel(depth=2))
    bond = Criterion.of_bond("b", Parabola(1e6), ShearFatigue(-0.2), -1)
    shear, pressed = np.hypot(plane["stress_xz"], plane["stress_yz"]), -plane["stress_zz"]
    used = (shear / 1e6 / np.sqrt(1 + 3e-6 * np.maximum(pressed, 0))).to_numpy()
    np.testing.assert_allclose(bond.read(plane), np.where(used < 1e-6, 0, used), rtol=1e-12)
    fields = tl.damage.interface_fields(response)
    largest = tl.damage.assess_bonds(fields, Parabola(1e6)).dataset["largest_utilisation"][1]
    assert float(largest) == pytest.approx(used.max(), rel=1e-12)


@pytest.mark.usefixtures("figures_as_dots")
def test_what_is_theirs_works_in_a_case_and_its_report(road_readings, tmp_path):
    case = Case.from_text(DESIGN)
    assert Case.from_text(case.to_toml()) == case
    result = tl.run(case, leave_out=("sensitivity",))
    data = result.life.dataset
    half, theirs, bond = data["largest_reading"].to_numpy()
    # Half the shear against half the strength, by the same power.
    assert theirs == pytest.approx(2 * half, rel=1e-12)
    assert data["life_years"][0].item() == pytest.approx(data["life_years"][1].item(), rel=1e-9)
    assert 0.05 < bond < 1
    told = json.loads(data.attrs["reads"])
    assert [one["name"] for one in told] == ["largest_shear", "largest_shear", "utilisation"]
    summary = result.summary()
    # The table is wider than a terminal, so that its criteria are columns.
    read = rf"^largest evaluated value +{half / 1e3:.0f} kPa +{theirs / 1e3:.0f} kPa +{bond:.3g}$"
    assert re.search(read, summary, re.MULTILINE)
    assert "theirs: largest shear stress" in summary
    assert "a rut of 10 mm" in summary
    # The file is read where the package is not.
    page = tmp_path / "report.html"
    write_report({"case": result.to_tree()}, page)
    text = page.read_text(encoding="utf-8")
    assert f"{theirs / 1e3:.3g} kPa" in text
    assert "shoving, no crack" in text
    assert "parallel to the surface" in text
    assert "largest shear stress" in text


def test_a_broken_quantity_stops_no_one_else(road_readings, response):
    assert "mean_stress" in compute_quantities(response)
    with pytest.raises(InputError, match=r"road-readings 0\.1 brings 'broken'.*cannot be loaded"):
        compute_quantities(response, ["broken"])


def test_ours_are_words_of_a_case_with_the_units_of_their_files():
    for name in QUANTITIES.built_in():
        # These need the numbers of a bond or a mix.
        if name in ("utilisation", "octahedral_shear_ratio", "energy_ratio"):
            continue
        one = QUANTITIES.find(name).target()
        assert isinstance(one, Quantity)
        assert (one.name, str(one)) == (name, one.words)
        if name in variables.VARIABLES:
            assert variables.VARIABLES[name][0] == one.unit
        # A frozen object of its numbers: equal to another like it, and not to one of another kind.
        assert one == QUANTITIES.find(name).target()
        assert one != EXTENSION or name == "in_plane_extension"


@pytest.mark.parametrize("name", [one for one in known_quantities() if one != "dissipated_energy"])
def test_every_quantity_can_be_asked_for_in_a_case(name, response):
    criterion = (
        f'[[criteria]]\nname = "a"\nlaw = "power-law"\nreads = "{name}"\nreading_6 = 1\nslope = -0.2\nlayer = 1\n'
    )
    text = DESIGN[: DESIGN.index("[[criteria]]")] + criterion
    (found,) = Case.from_text(text).build_criteria()
    assert found.quantity == known_quantities()[name]
    field = compute_quantities(response, [name])[name].isel(depth=1)
    np.testing.assert_array_equal(found.read(response.dataset.isel(depth=1)), field)


def test_a_line_of_any_strain_and_a_power_of_anything():
    line = FatigueLine(100e-6, -0.2)
    same = PowerLine(EXTENSION, "100 microstrain", -0.2)
    assert same.allowable_passes(150e-6) == pytest.approx(line.allowable_passes(150e-6), rel=1e-12)
    mazars = FatigueLine(100e-6, -0.2, MazarsStrain())
    assert str(mazars) == "fatigue line of the Mazars equivalent strain, ε₆ = 100 microstrain, slope -0.2"
    assert Criterion("a", mazars).quantity == MazarsStrain()
    assert PowerLine(OctahedralShear(), "0.4 MPa", -0.1).at_a_million == 0.4e6
    assert Criterion("a", FatigueLine(1e-4, -0.2, Extension("principal"))).quantity.strain == "principal"
    assert Criterion("a", line, strain="principal").quantity == Extension("principal")
    # A quantity without a bound at the surface is read as a mean there, others at points.
    assert Criterion("a", mazars).mean_over == 0.01
    assert Criterion("a", FrenchSubgrade(), -1).mean_over is None


def test_tension_at_the_surface_is_read_as_a_mean_that_no_finer_points_change():
    """Where shear of the surface ends, horizontal stress has no bound; points tell how near they are."""
    criterion = Criterion("a", PowerLine(TENSION, "1 MPa", -0.1), 0, place="top")
    load = [UniformRectangle(0.1, 0.1, 7e5, traction_x=3e5)]
    coarse = -0.05 + 1e-3 * (np.arange(-12, 12) + 0.5)
    fine = np.sort(np.concatenate([coarse, -0.05 + 1e-6 * np.array([-100, -10, -1, 1, 10, 100])]))
    read = {}
    for mean_over in (None, criterion.mean_over):
        for x in (coarse, fine):
            response = solve_response(load, ROAD, depths=[0.0], x=x, y=[0.0], mean_over=mean_over)
            read[mean_over, len(x)] = float(criterion.read(response.dataset.isel(depth=0)).max())
    assert read[None, len(fine)] > 1.5 * read[None, len(coarse)]
    # The largest mean lies between points that are a tenth of its length apart.
    assert read[0.01, len(fine)] == pytest.approx(read[0.01, len(coarse)], rel=0.01)


def test_a_criterion_stands_where_its_quantity_is_read():
    assert Criterion("a", FrenchSubgrade(), -1).place == "top"
    assert Criterion("a", FatigueLine(1e-4, -0.2)).place == "bottom"
    bond = Criterion.of_bond("b", tl.damage.InterfaceStrength(1e6), ShearFatigue(-0.2), -1)
    assert (bond.place, bond.number(ROAD), bond.depth(ROAD), bond.side) == ("interface", 1, 0.21, "above")
    assert SUBGRADE_COMPRESSION.where.layer == -1


def test_the_energy_ratio_reads_a_quantity(response):
    mix = tl.damage.EnergyRatio(1e-10, 0.5, 2e6, 2500, 1e10)
    np.testing.assert_array_equal(mix.of(response.dataset), mix.ratio(TENSION.field(response.dataset)))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda: FatigueLine(1e-4, -0.2, OctahedralShear()),
            "epsilon_6 is a strain, but the line reads the octahedral",
        ),
        (lambda: PowerLine(OctahedralShear(), "3 mm", -0.2), "3 mm"),
        (
            lambda: PowerLine(OctahedralShear(), 0.0, -0.2),
            "reading_6, of the octahedral shear stress, must be a positive",
        ),
        (
            lambda: ShearFatigue(-0.2, reads=EXTENSION),
            "the fatigue of a bond reads its utilisation, got the tensile strain",
        ),
        (lambda: Criterion("a", ShearFatigue(-0.2), place="interface"), "needs the strength of the bond"),
        (
            lambda: Criterion("a", FrenchSubgrade(), -1, reads=MazarsStrain()),
            "hold for the vertical strain on the sub",
        ),
        (
            lambda: Criterion("a", FatigueLine(1e-4, -0.2), place="interface"),
            "reads an interface.*give place = .bottom",
        ),
        (
            # The class is the same, and the numbers of the law hold for another strength.
            lambda: Criterion("a", PowerLine(OctahedralRatio(2e5, 0.6), 0.5, -0.2), reads=OctahedralRatio(2e5, 0.7)),
            r"friction_angle = 0\.7.*fitted with friction_angle = 0\.6; give friction_angle = 0\.6",
        ),
        (lambda: Extension("sideways"), 'strain must be "principal" or "in-plane"'),
        (lambda: tl.assess(None, FatigueLine(1e-4, -0.2, MazarsStrain())), "evaluates a tensile strain, but"),
    ],
)
def test_a_reading_where_another_is_meant_is_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('reads = { quantity = "largest_shear", counted = "50 %" }', 'reads = "mazars_strein"', "'mazars_strain'"),
        ('reads = { quantity = "largest_shear", counted = "50 %" }', 'reads = "utilisation"', "cohesion"),
        (
            'law = "tracker"\ntau_6 = "400 kPa"',
            'law = "shell"\nreads = "mean_stress"',
            "hold for the tensile strain",
        ),
        ('counted = "50 %"', "count = 1", "did you mean 'counted'"),
        ('reading_6 = "200 kPa"', 'reading_6 = "200 mm"', "200 mm"),
    ],
)
def test_wrong_readings_of_a_case_are_named(road_readings, old, new, words):
    assert old in DESIGN
    with pytest.raises(InputError) as refused:
        Case.from_text(DESIGN.replace(old, new))
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_mazars_reads_nothing_where_all_presses():
    """Squeezed from the sides a body extends upwards, and no crack opens; pulled, one does."""
    stress = np.zeros((6, 1, 1, 2))
    stress[:3, 0, 0] = np.array([[-5e6, -5e6, -1e6], [2e6, 0, 0]]).T
    strain = tensors.strain_from_stress(stress, 5e9, 0.35)
    plane = response_dataset(stress, strain, np.zeros(1), np.zeros(1), np.arange(2.0)).isel(depth=0)
    top, bottom = (Criterion("a", FatigueLine(1e-4, -0.2, MazarsStrain()), 0, place) for place in ("top", "bottom"))
    assert bottom.read(plane)[0] == pytest.approx([(-1e6 + 0.35 * 10e6) / 5e9, 2e6 / 5e9], rel=1e-12)
    assert top.read(plane)[0] == pytest.approx([0, 2e6 / 5e9], rel=1e-12)


def test_a_law_of_the_surface_is_read_there_alone():
    law = MepdgTopDown(5e9, 0.15, 0.06, 0.11)
    assert Criterion("a", law).place == "top"
    with pytest.raises(InputError, match="give layer 0"):
        Criterion("a", law, 1).depth(ROAD)
