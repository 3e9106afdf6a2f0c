"""Stress-dependent layers: laws, weight, the moduli that loads settle, and what stands in a response."""

import math
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.catalogue import mixes
from treadload.errors import ConvergenceError, InputError
from treadload.life.seasons import roads_of
from treadload.life.solve import solve_life
from treadload.life.stiffer import stiffer
from treadload.materials import (
    AtStress,
    Bilinear,
    Boyce,
    Elastic,
    KTheta,
    Prony,
    StressDependent,
    Universal,
    Uzan,
)
from treadload.pavement import Layer, Pavement
from treadload.pavement.stress_sublayers import StressSublayers
from treadload.response import GridLoad, UniformDisc, UniformRectangle, settle, solve_response
from treadload.response.basin import SHORTEST, basin_reach
from treadload.response.settle import ROUNDS, SETTLED
from treadload.steps.design import design_of
from treadload.units import PSI

INCH = 0.0254
# What the Florida Department of Transportation printed: moduli, psi, at bulk stresses of 9, 11, 18 and 40 psi.
PRINTED = {
    "FDOT limerock": (11657, 13083, 17365, 27482),
    "FDOT stabilised subgrade": (12901, 14332, 18553, 28197),
    "FDOT embankment": (11539, 12806, 16538, 25035),
}
# GT-PAVE's printed run: moduli of the base, psi, so many inches below its top at r = 0.7 in; inches; strain.
BELOW_TOP, BASE = (0.65, 1.95, 3.25, 4.55, 5.85), (46848.88, 39686.29, 33941.29, 29339.13, 25751.39)
SETTLEMENT, STRAIN = 0.0178, 325.08e-6
PLATE = UniformDisc(4.55 * INCH, 100 * PSI)


def gt_pave(**base):
    """The road of that run. The bilinear law of its soil, (5900, 2.5, 11640), is read so that the settlement fits."""
    uzan = Uzan(7446.494 * PSI, 0.417, 0.122, PSI)
    granular = StressDependent(uzan, 0.08, 0.6, 0.0804 * PSI / INCH, **base)
    soil = StressDependent(
        Bilinear(11640 * PSI, 2.5 * PSI, 5900, 0, largest=40e3 * PSI), 0.40, 0.82, 0.0607 * PSI / INCH
    )
    layers = [
        Layer(Elastic(250e3 * PSI, 0.35), 3.5 * INCH, name="asphalt"),
        Layer(granular, 8 * INCH, name="base"),
        Layer(soil, 50 * INCH, name="soil"),
    ]
    return Pavement(layers, rigid_base=True)


def thin_road(law=None, **more):
    base = StressDependent(law or KTheta(60e6, 0.5), **more)
    return Pavement(
        [
            Layer(Elastic(3e9, 0.35), 0.08, name="asphalt"),
            Layer(base, 0.25, name="base"),
            Layer(mixes["FDOT embankment"], name="soil"),
        ]
    )


@pytest.mark.parametrize("name", PRINTED)
def test_materials_of_the_catalogue_are_as_printed(name):
    stress = np.array([9, 11, 18, 40]) * PSI
    assert mixes[name].moduli(stress, 0)[0] / PSI == pytest.approx(PRINTED[name], rel=2e-3)
    assert mixes[name].source.startswith("Florida Department of Transportation")


def test_laws_by_hand():
    assert KTheta(80e6, 0.5, 1e5).modulus(4e5, 0) == pytest.approx(160e6)
    assert Uzan(80e6, 0.5, -0.5, 1e5).modulus(4e5, 4e5) == pytest.approx(80e6)
    shear = 3 / math.sqrt(2) * 1e5
    assert Universal(1000, 1, -1, 1e5).modulus(2e5, shear) == pytest.approx(1000 * 1e5 * 2 / 2)
    soil = Bilinear(50e6, 40e3, 1000, 200, least=20e6, largest=70e6)
    assert soil.modulus(0, [0, 30e3, 40e3, 90e3, 1e6]) == pytest.approx([70e6, 60e6, 50e6, 40e6, 20e6])


def test_boyce_is_linear_with_n_of_one_and_softens_in_volume_with_confinement():
    linear = Boyce(200e6, 100e6, 1.0)
    elastic = Elastic(float(linear.modulus(1e5, 5e4)), float(linear.poisson_ratio(1e5, 5e4)))
    assert elastic.shear_modulus == pytest.approx(100e6)
    assert elastic.modulus / (3 * (1 - 2 * elastic.poisson)) == pytest.approx(200e6)
    law = Boyce(200e6, 100e6, 0.4, 1e5)
    # Without shear both moduli rise with the power 1 - n of the mean stress.
    assert law.modulus(3 * 2e5, 0) / law.modulus(3 * 1e5, 0) == pytest.approx(2**0.6)
    # Shear makes it dilate: Poisson's ratio rises to its bound.
    ratios = law.poisson_ratio(3e5, [0, 1e5, 2e5, 4e5])
    assert (np.diff(ratios) >= 0).all()
    assert ratios[-1] == pytest.approx(0.49)


def test_tension_counts_by_its_share():
    stress = [100e3, 40e3, -20e3]
    assert StressDependent(KTheta(60e6, 0.5), tension=0).invariants(stress)[0] == pytest.approx(140e3)
    assert StressDependent(KTheta(60e6, 0.5), tension=1).invariants(stress)[0] == pytest.approx(120e3)
    # The deviator stress of a triaxial cell.
    assert StressDependent(KTheta(60e6, 0.5)).invariants([90e3, 30e3, 30e3])[1] == pytest.approx(60e3)


def test_weight_of_the_road():
    parts = StressSublayers.of(thin_road(unit_weight=21e3, earth_pressure=0.5))
    z = parts.depths[0]
    assert parts.vertical[0] == pytest.approx(0.08 * 23e3 + (z - 0.08) * 21e3)
    assert parts.horizontal[0] == pytest.approx(0.5 * parts.vertical[0])
    assert parts.owner[:2] == (0, 1)
    assert parts.owner[-1] == 2
    thicknesses = [layer.thickness for layer, whose in zip(parts.road.layers, parts.owner, strict=True) if whose == 1]
    assert sum(thicknesses) == pytest.approx(0.25)


def test_a_linear_law_is_a_linear_layer():
    law, linear = StressDependent(KTheta(150e6, 0.0), 0.3), Elastic(150e6, 0.3)
    roads = [
        Pavement([Layer(Elastic(3e9, 0.35), 0.1), Layer(material, 0.3), Layer(Elastic(60e6, 0.4))])
        for material in (law, linear)
    ]
    at = {"depths": [0.0, 0.1, 0.25, 0.5], "points": [[0, 0], [0.1, 0.05], [0.6, 0]]}
    by_law, by_hand = (solve_response(UniformDisc(0.15, 700e3), road, **at).dataset for road in roads)
    for name in ("stress_xx", "stress_xz", "strain_zz", "displacement_z"):
        largest = float(np.abs(by_hand[name]).max())
        assert by_law[name].to_numpy() == pytest.approx(by_hand[name].to_numpy(), rel=1e-10, abs=1e-10 * largest)


def test_halved_sublayers_hardly_move_the_deflection():
    deflections = []
    for sublayer in (0.05, 0.025):
        soil = StressDependent(KTheta(40e6, 0.5), sublayer=0.4 * sublayer / 0.05)
        base = StressDependent(KTheta(60e6, 0.5), sublayer=sublayer)
        road = Pavement([Layer(Elastic(3e9, 0.35), 0.08), Layer(base, 0.25), Layer(soil)])
        data = solve_response(UniformDisc(0.15, 700e3), road, depths=[0.0], points=[[0, 0], [0.9, 0]]).dataset
        deflections.append(data["displacement_z"].to_numpy()[0])
    assert deflections[1] == pytest.approx(deflections[0], rel=0.01)
    usual = thin_road()
    finer = thin_road(sublayer=0.015)
    coarse, fine = (
        solve_response(UniformDisc(0.15, 700e3), road, depths=[0.0], points=[[0, 0]]).dataset["displacement_z"].item()
        for road in (usual, finer)
    )
    assert fine == pytest.approx(coarse, rel=0.01)


def test_the_uzan_base_of_gt_pave():
    """Tension and the reading of the soil are fitted to this run: these are the numbers that remain."""
    state = settle(PLATE, gt_pave())
    base = [k for k, number in enumerate(state.sublayers.parts) if state.sublayers.owner[number] == 1]
    below_top = state.sublayers.depths[base] / INCH - 3.5
    moduli = np.interp(BELOW_TOP, below_top, state.moduli[base] / PSI)
    assert moduli == pytest.approx(BASE, rel=0.20)
    data = solve_response(PLATE, gt_pave(), depths=[1.65 * INCH, 3.4 * INCH], points=[[0, 0]]).dataset
    assert float(data["displacement_z"][0, 0]) / INCH == pytest.approx(SETTLEMENT, rel=0.10)
    assert float(data["strain_xx"][1, 0]) == pytest.approx(STRAIN, rel=0.15)


@pytest.mark.parametrize("law", [
    KTheta(60e6, 0.6), Uzan(60e6, 0.6, -0.2), Universal(800, 0.7, -0.6), Boyce(60e6, 40e6, 0.35),
    Bilinear(60e6, 40e3, 1000, 180),
])  # fmt: skip
@pytest.mark.parametrize("asphalt", [0.04, 0.15])
@pytest.mark.parametrize("pressure", [100e3, 1000e3])
def test_states_settle_monotonically_in_few_rounds(law, asphalt, pressure):
    road = Pavement(
        [Layer(Elastic(4e9, 0.35), asphalt), Layer(StressDependent(law), 0.3), Layer(mixes["FDOT embankment"])]
    )
    state = settle(UniformDisc(0.15, pressure), road)
    assert len(state.changes) <= ROUNDS
    assert (np.diff(state.changes) <= 0).all()
    assert state.changes[-1] <= SETTLED
    # The moduli are those of the law under the stress of the settled road.
    assert state.at([state.axis])[:, 0] == pytest.approx(state.moduli, rel=2 * SETTLED)
    assert all(isinstance(state.road.layers[k].material, AtStress) for k in state.sublayers.parts)


def test_a_state_that_does_not_settle_names_its_layer():
    # A soil that jumps from stiff to soft over next to nothing has no state between.
    cliff = StressDependent(Bilinear(80e6, 60e3, 1e6, 1e6, least=8e6, largest=800e6))
    road = Pavement([Layer(Elastic(3e9, 0.35), 0.06), Layer(cliff, 0.3, name="cliff"), Layer(Elastic(60e6, 0.4))])
    with pytest.raises(ConvergenceError, match=r"layer 'cliff' does not settle: after 15 rounds .*tension=0"):
        settle(UniformDisc(0.15, 700e3), road)


def test_stress_is_taken_below_the_heaviest_load():
    wheels = [UniformDisc(0.1, 500e3, 0, -1.0), UniformDisc(0.1, 900e3, 0.2, 0.3), UniformDisc(0.1, 900e3, 0.2, 0.6)]
    state = settle(wheels, thin_road())
    assert state.axis == (0.2, 0.3)
    # Far from all loads a k-θ material is softer.
    assert (state.at([[3.0, 0.0]])[:, 0] < state.moduli).all()
    block = settle(UniformRectangle(0.2, 0.2, 600e3, 0.4, 0.1), thin_road())
    assert block.axis == pytest.approx((0.4, 0.1))


def test_a_contact_on_cells_settles_as_its_disc():
    x = np.linspace(-0.18, 0.18, 37)
    pressure = np.where(np.hypot(x, x[:, None]) <= 0.15, 700e3, 0.0)
    load = GridLoad.from_arrays(pressure, spacing=0.01)
    force = pressure.sum() * 1e-4
    disc = UniformDisc(0.15, force / (math.pi * 0.15**2))
    assert settle(load, thin_road()).moduli == pytest.approx(settle(disc, thin_road()).moduli, rel=5e-3)


def test_a_response_states_moduli_and_keeps_them_in_a_file(tmp_path):
    response = solve_response(UniformDisc(0.15, 700e3), thin_road(), depths=[0.0, 0.08], points=[[0, 0]])
    assert "base, stress-dependent" in response.summary()
    moduli = response.dataset["sublayer_modulus"]
    assert moduli.sizes == {"sublayer": len(response.road.layers) - 1}
    # Confinement falls with depth in the base.
    base = moduli.to_numpy()[:5]
    assert (np.diff(base) < 0).all()
    tl.save_results(response, tmp_path / "response.nc")
    opened = tl.open_results(tmp_path / "response.nc")["points"]
    assert opened.road == response.road
    assert opened.dataset["sublayer_modulus"].to_numpy() == pytest.approx(moduli.to_numpy())
    # Asked again on the settled road, the answer is the same.
    again = solve_response(response.loads, opened.road, depths=[0.0, 0.08], points=[[0, 0]])
    assert again.dataset["strain_xx"].to_numpy() == pytest.approx(response.dataset["strain_xx"].to_numpy(), rel=1e-12)


def test_a_viscoelastic_course_on_a_stress_dependent_base():
    mix = Prony(3e9, [(0.8, 0.05)], 0.35)
    layers = list(thin_road().layers)
    layers[0] = Layer(mix, 0.08, name="asphalt")
    road = Pavement(layers)
    assert road.is_viscoelastic
    slow, fast = (settle(UniformDisc(0.15, 700e3), road, speed=speed) for speed in (0.0, math.inf))
    # Where the course softens, the base below feels more of the load.
    assert slow.moduli[0] > fast.moduli[0]
    with pytest.raises(InputError, match="give speed="):
        settle(UniformDisc(0.15, 700e3), road)


def test_what_needs_a_modulus_says_where_it_comes_from():
    layer = thin_road().layers[1]
    with pytest.raises(InputError, match="follows from the loads: solve_response settles it"):
        _ = layer.resolved
    nominal = thin_road().at_nominal_stress
    assert nominal.layers[1].resolved.modulus == pytest.approx(60e6 * (150e3 / 101325) ** 0.5)
    assert not nominal.depends_on_stress


@pytest.mark.parametrize(("make", "message"), [
    (lambda: KTheta(-1.0, 0.5), "k1 of KTheta must be a positive number of Pa, got -1"),
    (lambda: KTheta(1e8, 3.0), r"k2 of KTheta must lie in \[-2, 2\], got 3"),
    (lambda: Universal(900, 0.5, 0.2), "needs k2 >= 0 and k3 <= 0, got 0.5 and 0.2"),
    (lambda: Boyce(1e8, 1e8, 0.0), r"n of Boyce's law must lie in \(0, 1\]"),
    (lambda: Bilinear(50e6, 40e3, -1, 0), "slope_below of a bilinear law must be >= 0, got -1"),
    (lambda: Bilinear(50e6, 40e3, 1, 0, least=60e6), "must lie between least and largest"),
    (lambda: StressDependent(5e6), "law must be KTheta, Uzan, Universal, Boyce or Bilinear, got 5000000"),
    (lambda: StressDependent(Boyce(1e8, 1e8, 0.3), 0.35), "has its own Poisson's ratio|Poisson's ratio of its own"),
    (lambda: StressDependent(KTheta(1e8, 0.5), unit_weight=20.0), "unit_weight must lie in .* got 20.0; 20 kN/m³"),
    (lambda: StressDependent(KTheta(1e8, 0.5), earth_pressure=-1), r"earth_pressure must lie in \[0, 5\], got -1"),
    (lambda: StressDependent(KTheta(1e8, 0.5), tension=2), r"tension must lie in \[0, 1\], got 2"),
    (lambda: settle(PLATE, thin_road(sublayer=0.002)), "sublayers, at most 80"),
])  # fmt: skip
def test_wrong_values_are_refused_with_the_remedy(make, message):
    with pytest.raises(InputError, match=message):
        make()


LIFE = """
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
climate = { seasons = [
    { name = "cold", share = 0.5, temperature = 5 }, { name = "warm", share = 0.5, temperature = 30 },
] }

[[pavement.layers]]
mix = "EB-BBSG3"
thickness = "80 mm"

[[pavement.layers]]
mix = "FDOT limerock"
thickness = "300 mm"

[[pavement.layers]]
name = "soil"
material = { kind = "stress-dependent", law = { kind = "bilinear", break_modulus = "50 MPa", break_deviator = "43 kPa", slope_below = 1110, slope_above = 178 }, earth_pressure = 0.8 }

[traffic]
passes_per_year = 1e4

[[traffic.classes]]
name = "light"
share = 0.5
axle_load = "40 kN"
inflation_pressure = "8 bar"

[[traffic.classes]]
name = "heavy"
share = 0.5
axle_load = "110 kN"
inflation_pressure = "8 bar"
gear = "dual"

[[criteria]]
name = "base"
law = "fatigue-line"
epsilon_6 = "100 microstrain"
slope = -0.2
layer = 1
place = "bottom"

[[criteria]]
name = "soil"
law = "french-subgrade"
constant = 0.012
"""  # noqa: E501


def test_a_life_has_one_state_for_each_class_and_season():
    case = tl.Case.from_text(LIFE)
    road, criteria = case.road(), case.build_criteria()
    roads = roads_of(road, criteria, case.build_climate().seasons, case.build_traffic().classes)
    limerock = np.array(
        [[warm.road.layers[1].resolved.modulus for warm in warm_roads] for warm_roads in roads.by_class]
    )
    # Heavier wheels confine the base more, and so do all of them below warm, soft asphalt.
    assert (limerock[1] > 1.1 * limerock[0]).all()
    assert (limerock[:, 1] > 1.1 * limerock[:, 0]).all()
    base, soil = roads.by_class[1][0].criteria
    warm = roads.by_class[1][0].road
    assert base.depth(warm) == pytest.approx(0.08)
    assert soil.depth(warm) == pytest.approx(0.38)
    # The basin is that of asphalt and base on the soil, not that of nine metres of soil on the rest of it.
    assert basin_reach([warm]) == pytest.approx(SHORTEST)


@pytest.mark.slow
def test_lives_on_stress_dependent_layers():
    case = tl.Case.from_text(LIFE)
    design = design_of(case)
    life = solve_life(design, workers=1)
    linear = solve_life(replace(design, road=design.road.at_nominal_stress), workers=1)
    for name in ("base", "soil"):
        assert 0.2 < life.years(name) / linear.years(name) < 5
        assert life.years(name) != pytest.approx(linear.years(name), rel=0.01)
    stiff = stiffer(design.road, 1, 2.0)
    assert solve_life(replace(design, road=stiff), workers=1).years("base") > 1.2 * life.years("base")


CASE = """
spacing = "20 mm"
tire = { profile = "315/80R22.5", inflation_pressure = "8 bar" }
rolling = { normal_load = "40 kN", friction = 0.7 }
response = { depths = ["0 mm", "80 mm"], slice_depth = "200 mm" }
damage = { fatigue = { epsilon_6 = "110 microstrain", slope = -0.2 }, lattices = 1 }

[[pavement.layers]]
name = "asphalt"
thickness = "80 mm"
material = { kind = "elastic", modulus = "3000 MPa", poisson = 0.35 }

[[pavement.layers]]
name = "base"
thickness = "250 mm"
material = { kind = "stress-dependent", law = { kind = "uzan", k1 = "7446.5 psi", k2 = 0.417, k3 = 0.122, reference = "1 psi" }, unit_weight = "21 kN/m^3" }

[[pavement.layers]]
mix = "FDOT embankment"
"""  # noqa: E501


@pytest.mark.slow
def test_a_case_is_run_to_its_verdict(tmp_path):
    case = tl.Case.from_text(CASE)
    assert "stress-dependent" in tl.plan(case)
    result = tl.run(case)
    text = result.text()
    assert "base, stress-dependent" in text
    assert "FDOT embankment, stress-dependent" in text
    assert not [caveat for caveat in result.verdict.warnings if "in tension, with a horizontal strain" in caveat]
    response = result.response
    # The verdict reads the settled road, as a response on it does.
    again = solve_response(response.loads, response.road, depths=[0.08], x=[0.0], y=[0.0]).dataset
    column = response.dataset.sel(depth=0.08).sel(x=0.0, y=0.0, method="nearest")
    assert float(column["strain_xx"]) == pytest.approx(again["strain_xx"].item(), rel=0.02)
    tl.save_results(result, tmp_path / "run.nc")
    assert tl.open_results(tmp_path / "run.nc")["response"].road == response.road
    assert "stress-dependent" in response.cites()
    tl.report(result, tmp_path / "run.html")
    html = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert "kN/m³" in html
    uniform = tl.damage.compare_uniform(result.contact, response.road)
    # Bottoms of layers, not of the parts of those that depend on stress.
    assert uniform.dataset["depth"].to_numpy()[-1] == pytest.approx(0.33)
    assert uniform.dataset.sizes["depth"] < 12
