"""What is saved opens again as the objects that it was, and as nothing less."""

import html
import json
import math
import re
from collections import defaultdict
from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from PIL import Image

import treadload as tl
from cases import BASE_AND_SOIL, COARSE_CASE, ONE_AXLE
from studies import CASE, study_of
from treadload.app.case_schema import label_of
from treadload.app.result_rows import rows_of
from treadload.case import Case
from treadload.composing import BaseResult, dataset_of, result_classes
from treadload.damage import Climate, Traffic, Wander
from treadload.damage.climate import TypicalDays
from treadload.damage.criterion import Criterion
from treadload.damage.field_shift import field_shifts
from treadload.damage.miner import miner
from treadload.damage.pitch import respond_to_pitch
from treadload.damage.scatter import Scatter
from treadload.damage.verdict import with_error
from treadload.life.field.prediction import HARDENING
from treadload.life.layered_climate import climate_fields
from treadload.life.reliability.fields import Fit, reliability_dataset
from treadload.life.reliability.inputs import inputs_of
from treadload.life.reliability.propagation import Quadratic
from treadload.plots.kit.us_figure import texts_of
from treadload.reporting.reading import ReportCase
from treadload.results import Fields, Footprint, as_tree
from treadload.results.holding import check_dataset
from treadload.rows import from_json
from treadload.sweeps.design import listed, product
from treadload.sweeps.network.solve import network_of
from treadload.sweeps.screening import answers
from treadload.tire.grooves import Groove, LateralGrooves
from treadload.us_units import display_units
from treadload.variables import VARIABLES, dataset, display_of, in_order

RUBBER = tl.Elastic(3e6, 0.5)
ROAD = tl.Pavement([tl.Layer(tl.Elastic(5.4e9, 0.35), 0.08, name="asphalt"), tl.Layer(tl.Elastic(2e8, 0.35))])
WHEEL = tl.Rolling(normal_load=300, tractive_force=50, friction=0.7)
LINE = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
CELL = 5e-3
AT = np.linspace(-0.05, 0.05, 9)
ACROSS = (np.arange(24) - 11.5) * CELL
DAYS = TypicalDays(np.array([3.0, 15.0]), np.array([0.0, 0.06]), np.arange(48.0).reshape(12, 2, 2))
PROFILE = tl.pavement.TemperatureProfile((0.0, 0.06), (5.0, 9.0))
OLD = tl.materials.GlobalAging(10.0, 10.0)
TIRE = tl.Tire.from_height_map(ACROSS[None, :] ** 2 + ACROSS[:, None] ** 2, CELL, material=RUBBER, name="a ball")


@cache
def contact(**changed):
    return tl.solve_contact(TIRE, ROAD, replace(WHEEL, **changed))


@cache
def response():
    return tl.solve_response(contact(), ROAD, depths=[0.0, 0.08], x=AT, y=AT)


def on_texture():
    made = {"hurst": 0.8, "shortest": 8e-3, "rms_height": 2e-4}
    return tl.contact.solve_texture(tl.pavement.texture.self_affine(0.05, 0.05 / 32, **made), RUBBER, contact())


def bonds():
    strength = tl.damage.InterfaceStrength(cohesion=3e5, friction_angle=0.6, caveat="made up")
    fields = tl.life.solve_interfaces(contact(), ROAD, x=AT, y=AT)
    return tl.damage.assess_bonds(fields, strength, tl.damage.ShearFatigue(slope=-0.2))


def life():
    y = np.linspace(-0.4, 0.4, 81)
    peaks = np.array([[[150e-6, 80e-6], [100e-6, 60e-6]], [[300e-6, 250e-6], [200e-6, 150e-6]]])
    classes = (tl.damage.AxleClass("light", 0.7, 20e3, 7e5), tl.damage.AxleClass("heavy", 0.3, 35e3, 8e5, tire=TIRE))
    traffic = Traffic(classes, 1e5, 0.02, wander=Wander.normal(0.2), years=20.0)
    criteria = (Criterion("top", LINE, 0, "top"), Criterion("base", tl.damage.ShellFatigue(5e9), 1))
    values = peaks[..., None] * np.exp(-0.5 * (y / 0.1) ** 2)
    climate = replace(Climate.equal_parts([5.0, 25.0], ["cold", "warm"]), days=DAYS)
    made = miner(values, criteria, traffic, climate, y=y)
    # As below a weather: what it tells over depth, of a road whose mix waits for its temperature.
    deep = replace(climate, seasons=[replace(one, temperature=PROFILE, ageing=OLD) for one in climate.seasons])
    told = climate_fields(tl.Pavement.from_catalogue("6 BBSG3 / PF2"), deep)
    return replace(made, dataset=made.dataset.merge(told, combine_attrs="override"))


def bond_comparison():
    before = life()
    dims = ("state", "criterion")
    data = xr.Dataset(
        {
            "largest_reading": (dims, np.full((3, 2), 1e-4)), "life_passes": (dims, [[1e6, 2e6]] * 3),
            "life_years": (dims, [[3.0, math.inf]] * 3), "parting_passes": 1e5, "parting_years": 0.5,
        },
        {"state": ["bonded", "parted", "bonded, then parted"], "criterion": ["top", "base"]},
        {"interface": 0, "between": "asphalt / base", "bond": "frictionless", "parts": "none"},
    )  # fmt: skip
    return tl.life.BondComparison(data, before, life(), 0, tl.pavement.FRICTIONLESS, "top")


def sensitivity():
    data = xr.Dataset(
        {"elasticity": ("input", [3.0, -0.05], {"units": "1"})},
        {"input": ["thickness of base", "temperature (per °C)"]},
        {"criterion": "top", "coverage": 0.9, "contacts": 3, "responses": 4},
    )
    return tl.life.Sensitivity(data, "top", 0.9, 3, 4, ("friction: it has none",))


def reliability():
    inputs = inputs_of(ROAD, Scatter(thickness=5e-3, traffic=0.15))[0]
    flat = Quadratic(np.log(0.02), np.array([0.8, 0.15, 0.7, 0.1]), np.zeros((4, 4)))
    scatter = Scatter(thickness=5e-3, traffic=0.15)
    data = reliability_dataset(
        life(),
        inputs,
        scatter,
        [Fit(0, 0.3, flat, 5.0, np.array([0.02, 0.01]))],
        (0.05, 0.5),
        tl.life.MonteCarlo(1000, 1),
    )
    data = data.assign(surface_error=("criterion", [0.01]), coverage=("criterion", [0.6]))
    stats = {"contacts": 0, "responses": 5, "points": 5, "held_back": 8, "draws": 1000, "seed": 1, "seconds": 0.1}
    return tl.life.Reliability(data, scatter, stats, ("base: its law has no SN",))


def thickness_design():
    data = xr.Dataset(
        {
            "exact_thickness": 0.152, "design_thickness": 0.16, "asked_years": 20.0,
            "trial_thickness": ("trial", [0.15, 0.152, 0.16]),
            "trial_years": (("trial", "criterion"), [[19.0, 60.0], [20.0, 65.0], [25.0, math.inf]]),
        },
        {"criterion": ["top", "base"]},
        {"layer": "asphalt", "step": 0.01, "lower_bound": 0.04, "at_risk": 0.05},
    )  # fmt: skip
    stats = {"lives": 3, "contacts": 1, "responses": 6}
    return tl.life.ThicknessDesign(data, ROAD, life(), "asphalt", 0.01, 0.05, stats, ("base: its law has no risk",))


def growth():
    depths, solved, y = [0.01, 0.02, 0.06], [0.01, 0.03, 0.057], [-0.1, 0.0, 0.1]
    passes = np.array([[2e6, 1e6, np.inf], [3e6, 1.5e6, np.inf], [4e6, 1.7e6, np.inf]])
    data = dataset(
        {
            "initiation_passes": (("y",), passes[0]),
            "growth_passes": (("crack_depth", "y"), passes),
            "growth_rate": (("solved_depth", "y"), np.full((3, 3), 1e-8)),
            "reach_passes": (("crack_depth",), passes.min(axis=1)),
            "reach_years": (("crack_depth",), [10.0, 15.0, 17.0]),
            "risk_years": (("risk", "crack_depth"), np.array([0.5, 1, 2])[:, None] * [10.0, 15.0, 17.0]),
            "reach_chance": (("crack_depth",), [0.9, 0.8, 0.7]),
            "stress_intensity_range": (("axle_class", "solved_depth", "mode"), np.full((2, 3, 4), 2e5)),
            "crack_offset": (("crack_depth",), np.zeros(3)),
            "worst_y": ((), 0.0),
        },
        {
            "crack_depth": depths, "solved_depth": solved, "risk": [0.05, 0.5, 0.95], "y": y,
            "mode": ["I", "II", "III", "Irwin"], "axle_class": ["light", "heavy"],
        },
        grows="down through asphalt, vertical, trace 0 degrees from travel",
        starts="top, a crack of 10 mm where its damage is 1",
        design_years=20.0,
    )  # fmt: skip
    asked = tl.damage.CrackGrowth("top", law=tl.damage.ParisLaw(1e-4, 4.0))
    return tl.damage.Growth(data, asked, {"responses": 4}, ("crack growth: as commonly quoted",))


def equivalents():
    two, each = ("criterion", "axle_class"), "axle_class"
    data = xr.Dataset(
        {
            "standard_axles": (two, [[0.1, 0.9], [0.2, math.nan]]), "mean_standard_axles": ("criterion", [0.3, 0.2]),
            "equivalent_temperature": ("criterion", [17.0, math.nan]),
            "equivalent_reading": ("criterion", [1e-4, math.nan]),
            "years_at_equivalent": ("criterion", [24.0, math.nan]), "life_years": ("criterion", [24.0, math.inf]),
            "french_axles": (each, [0.05, 0.5]), "single_axle_loads": (each, [0.6, 4.0]),
            "axle_load": (each, [7e4, 1.1e5]), "axles": (each, [1, 1]),
        },
        {"criterion": ["top", "base"], "axle_class": ["light", "heavy"]},
        {
            "governing": "top", "readings": json.dumps(["100 microstrain", ""]), "standard_axle": "80 kN",
            "standard_axle_load": 80e3,
        },
    )  # fmt: skip
    return tl.life.Equivalents(data)


def remedies():
    data = dataset(
        {
            "remedy_years": (("remedy", "criterion"), [[19.0, 60.0], [12.0, math.inf], [9.0, 40.0]]),
            "road_years": (("remedy",), [19.0, 12.0, 9.0]), "years_won": (("remedy",), [7.0, 0.0, -3.0]),
            "solved_anew": (("remedy",), [1, 0, 1]), "life_years": (("criterion",), [12.0, 50.0]),
            "standard_axles": (("criterion", "axle_class"), [[0.1, 0.9], [math.nan, math.nan]]),
            "mean_standard_axles": (("criterion",), [0.3, math.nan]),
        },
        {
            "remedy": ["2 cm more asphalt", "50 mm more wander", "friction 0.1 lower"], "criterion": ["top", "rut"],
            "axle_class": ["light", "heavy"],
        },
        kinds=json.dumps(["thickness", "wander", "friction"]), governing=json.dumps(["top"] * 3),
        standard_axle="80 kN",
    )  # fmt: skip
    stats = {"contacts": 1, "responses": 4, "seconds": 0.2}
    return tl.life.Remedies(data, ("turns of 33 % larger radius: no class turns",), stats, ("asphalt: far",))


def footprint():
    pressure = np.zeros((4, 5))
    pressure[1:3, 1:4] = 7e5
    return Footprint(tl.response.GridLoad.from_arrays(pressure, 0.1 * pressure, spacing=0.02), ROAD)


def footprint_comparison():
    small = tl.response.GridLoad.from_arrays(np.outer([0, 2, 3, 2, 0], [0, 5e5, 7e5, 0, 0]), spacing=0.02)
    return tl.compare(small, Footprint(small, threshold=1e3, saturation=2e6), registration="shift")


def viscoelastic_tire():
    rubber = tl.materials.Prony.standard_linear_solid(4e6, 3e6, 0.01, 0.5)
    tire = replace(TIRE, material=rubber)
    rolling = tl.Rolling(normal_load=300, friction=0.7, speed=10.0)
    return tl.contact.rolling_resistance(
        tl.solve_contact(tire, tl.Pavement.half_space(tl.Elastic(5e9, 0.35)), rolling), 0.5
    )


def heterogeneous():
    stones = tl.materials.Aggregates.from_centres(0, 0, 3e-3, 2e-3, tl.Elastic(60e9, 0.2))
    return tl.response.compute_heterogeneous(
        contact(), tl.Elastic(3e9, 0.35), stones, window=(8e-3, 7e-3), depth=6e-3, spacing=1e-3
    )


def calibration():
    rows = [tl.footprint.Measured(load=load, deflection=depth) for load, depth in ((200, 2.9e-3), (300, 3.8e-3))]
    return tl.calibrate(TIRE, ["modulus"], rows, road=ROAD, tolerance=1e-6)


def backcalculated():
    bowl = np.array([[6.0e-4, 4.1e-4, 3.3e-4, 1.9e-4, 1.2e-4], [6.2e-4, 4.0e-4, 3.4e-4, 1.8e-4, 1.3e-4]])
    basins = tl.roads.Basins(
        bowl, np.array([0, 0.2, 0.3, 0.6, 0.9]), 5e4, 0.15, temperature=15.0, position=[0.0, 10.0]
    )
    return tl.backcalculate(basins, ROAD)


def network():
    case = tl.Case.from_text(ONE_AXLE + BASE_AND_SOIL)
    rows = [{"passes_per_year": passes, "climate.temperature": 15.0} for passes in (1e4, 1e6, -1.0)]
    places, ages = np.array([0.0, 500.0, 1000.0]), np.array([3.0, 30.0, 0.0])
    design = listed(case, rows, labels={"section": ["A", "B", "C"]})
    return network_of(tl.sweep(case, design), tl.sweeps.Sections(design, ("A", "B", "C"), places, ages))


def dented():
    across = (np.arange(12) - 5.5) * 1e-3
    ball = tl.Tire.from_height_map(
        (across[None] ** 2 + across[:, None] ** 2) / 0.2, 1e-3, material=tl.Elastic(2e14, 0.3), name="a ball"
    )
    soft = tl.materials.ElastoPlastic(tl.Elastic(1e9, 0.3), tl.materials.VonMises(1e7, hardening=1e7))
    return tl.contact.solve_indentation(ball, tl.Pavement.half_space(soft), [60.0, 0.0], layers=5)


def passes():
    soft = tl.materials.ElastoPlastic(tl.Elastic(6e8, 0.35), tl.materials.VonMises(4e5, kinematic=6e7))
    disc = tl.UniformDisc(0.1, 8e5)
    return tl.response.roll_passes(disc, tl.Pavement.half_space(soft), passes=2, spacing=0.04, layers=4)


def screened(verb, **more):
    """What matters, of a function in the place of the solver."""
    with pytest.MonkeyPatch.context() as patch:
        solve = lambda friction, normal_load: {"worst_strain": friction + normal_load / 3e4}  # noqa: E731
        patch.setattr(answers, "sweep", lambda case, design, **_: study_of(design, solve, case))
        return verb(CASE, {"friction": (0.3, 0.9), "normal_load": (2e4, 4e4)}, "worst_strain", **more)


def worn():
    """Wear of two bare surfaces, a millimetre between them and a groove."""
    across, angle = np.linspace(-0.1, 0.1, 21), np.linspace(-3.1, 3.1, 12)
    gone = np.where(np.abs(across) > 0.02, 1e-3, np.nan)
    flat = np.where(np.abs(across) > 0.02, 0.0, -8e-3)
    fields = {
        "tread_wear": (("across", "wheel_angle"), np.tile(gone[:, None], 12)),
        "median_tread_wear": (("across",), gone),
        "tread_height": (("across",), flat),
        "earlier_tread_height": (("across",), flat + 1e-3 * (flat == 0)),
        "groove_depth": (("groove",), [8e-3]),
        "earlier_groove_depth": (("groove",), [9e-3]),
    }
    places = {"across": across, "wheel_angle": angle, "groove": [0.0]}
    return tl.tire.Wear(dataset(fields, places, datum=0.0, shift=1e-4))


@cache
def pitch_passage():
    """Blocks of 34 x 39 mm on a light tire, rolled through one pitch of 40 mm, a pitch as good as the next."""
    lugs = tl.tire.TreadProfile(
        rolling_radius=0.3, crown_radius=0.8, width=0.088, grooves=(Groove(0.0, 0.01, 0.016),),
        lateral=(LateralGrooves(0.04, 0.006, 0.016),),
    )  # fmt: skip
    belt = tl.tire.Belt(tread=tl.Elastic(4e6, 0.49), tread_thickness=0.024, arm=0.024)
    tire = tl.Tire.from_profile(lugs, inflation_pressure=300e3, belt=belt)
    wheel = tl.Rolling(normal_load=2500.0, friction=0.7)
    return tl.contact.solve_pitch(tire, ROAD, wheel, spacing=8e-3, positions=4, periodic=0.5)


def field_years():
    """Of a life whose first criterion reads the surface."""
    made = life()
    lines = {
        "life_years_fresh_line": ("criterion", [30.0, math.nan]),
        "life_years_aged_line": ("criterion", [9.0, math.nan]),
    }
    attrs = {"surface_lines": json.dumps({"top": ["fresh", "aged"]})}
    made = replace(made, dataset=made.dataset.assign(lines).assign_attrs(attrs))
    return tl.life.field_years(made, tl.Pavement.from_catalogue("6 BBSG3 / 18 GB3 / PF3"), field_shifts["LTPP"])


@cache
def field_bench():
    table = tl.life.field_tables["LTPP"].at(np.arange(60))
    ages = np.exp(np.random.default_rng(1).normal(6, 1, 60))
    variants = {HARDENING: {0.0: ages, 1.0: ages**0.5}}
    mechanics = tl.life.Predictions(table.sections, ages, 2 * ages, variants=variants, about=("made up",))
    return tl.life.field_bench(table, mechanics)


MADE = {
    "FieldYears": field_years,
    "FieldLook": lambda: tl.life.field_look("LTPP"),
    "FieldBench": field_bench,
    "PitchPassage": pitch_passage,
    "PitchResponse": lambda: respond_to_pitch(pitch_passage(), ROAD, depths=[0.0, 0.02]),
    "Contact": contact,
    "Response": response,
    "Verdict": lambda: with_error(tl.assess(response(), LINE), tl.assess(response(), LINE), CELL),
    "BondVerdict": bonds,
    "Life": life,
    "TransientResult": lambda: tl.contact.solve_transient(
        TIRE,
        ROAD,
        tl.Rolling(normal_load=300, creepage_x=-0.01, friction=0.7),
        distances=[CELL, 2 * CELL],
        fields=True,
    ),
    "Crossing": lambda: tl.contact.cross_obstacle(
        TIRE,
        ROAD,
        tl.Rolling(normal_load=300, friction=0.5),
        tl.pavement.RoadStep(2e-4),
        positions=[-CELL, 0.0, CELL],
    ),
    "TurnResult": lambda: tl.contact.turn_on_the_spot(
        TIRE, ROAD, tl.Rolling(normal_load=300, friction=0.7), angles=[0.005, 0.01], pivot=(0.0, 0.0)
    ),
    "CreepCurve": lambda: tl.contact.creep_curve(
        TIRE, ROAD, tl.Rolling(normal_load=300, friction=0.7), [-0.02, 0.01, -0.01]
    ),
    "BondComparison": bond_comparison,
    "Sensitivity": sensitivity,
    "Reliability": reliability,
    "Equivalents": equivalents,
    "Remedies": remedies,
    "ThicknessDesign": thickness_design,
    "Growth": growth,
    "UniformComparison": lambda: tl.damage.compare_uniform(contact(), ROAD, pressure=7e5, depths=[0.02, 0.08]),
    "RollingResistance": viscoelastic_tire,
    "Footprint": footprint,
    "FootprintComparison": footprint_comparison,
    "TireCard": lambda: tl.footprint.tire_card(TIRE, ROAD, [200, 300], stiffness=False),
    "Calibration": calibration,
    "Backcalculation": backcalculated,
    "Network": network,
    "Sweep": lambda: study_of(product(CASE, {"friction": [0.4, 0.6]}), lambda friction: {"worst_strain": friction}),
    "Tornado": lambda: screened(tl.sweeps.screening.tornado),
    "Sobol": lambda: screened(tl.sweeps.screening.sobol, blocks=4, second_order=True),
    "Morris": lambda: screened(tl.sweeps.screening.morris, trajectories=3),
    "Passes": passes,
    "Indentation": dented,
    "Heterogeneous": heterogeneous,
    "TextureContact": on_texture,
    "Enveloped": lambda: tl.contact.envelop(contact(), 0.03),
    "Wear": worn,
    "Fields": lambda: Fields(tl.damage.compute_quantities(response())),
}
FIGURES = {
    "FieldYears": "years", "FieldLook": "shares", "FieldBench": "shares",
    "Contact": "pressure", "Response": "strain_directions", "Verdict": "passes", "BondVerdict": "utilisation",
    "Life": "years", "TransientResult": "history", "TurnResult": "history", "CreepCurve": "forces",
    "BondComparison": "lives", "Sensitivity": "inputs", "Reliability": "years", "ThicknessDesign": "lives",
    "Growth": "depth", "Equivalents": "axles", "UniformComparison": "strains", "RollingResistance": "losses",
    "Remedies": "tornado",
    "Footprint": "pressure", "Fields": lambda plot: plot.map("horizontal_tension"),
    "FootprintComparison": "maps", "TireCard": "card", "Calibration": "fit",
    "Backcalculation": "basins", "Network": "stations",
    "Passes": "rut", "Indentation": "dent", "Heterogeneous": "section",
    "TextureContact": "patch", "Enveloped": "pressure",
    "Crossing": "history", "Wear": "wear", "PitchPassage": "history", "PitchResponse": "strains",
    "Sweep": lambda plot: plot.curve("worst_strain"), "Tornado": "tornado", "Sobol": "sobol", "Morris": "morris",
}  # fmt: skip


@cache
def made(name):
    """The result of a class."""
    return MADE[name]()


@pytest.fixture(scope="module", params=sorted(MADE))
def saved(request, tmp_path_factory):
    result = made(request.param)
    path = tl.save_results(result, tmp_path_factory.mktemp("results") / "x.nc")
    return result, tl.open_results(path)


def test_no_class_of_results_is_missing_here():
    known = result_classes()
    assert set(known) == set(MADE) == set(FIGURES)

    def below(kind):
        return {one for each in kind.__subclasses__() for one in below(each) or {each}}

    # Whatever says that it is a result, and is no base of others, has a name in a tree.
    assert {one.__name__ for one in below(BaseResult) if one.__module__.startswith("treadload")} == set(known)


def test_every_result_opens_as_what_it_was(saved):
    result, opened = saved
    (name,) = opened
    back = opened[name]
    assert name == result.group_name
    assert type(back) is type(result)
    xr.testing.assert_identical(back.dataset, result.dataset)
    assert list(back.dataset.attrs) == list(result.dataset.attrs)
    assert back.warnings == result.warnings
    assert dict(back.stats) == dict(result.stats)
    assert back.summary() == result.summary()
    assert repr(back) == repr(result)
    assert str(back) == result.summary()


def test_every_result_draws_itself_also_from_a_file(saved):
    result, opened = saved
    figure = FIGURES[type(result).__name__]
    for one in (result, next(iter(opened.parts.values()))):
        drawn = figure(one.plot) if callable(figure) else getattr(one.plot, figure)()
        assert drawn.axes
        # The figure that a notebook shows small is this one; none where it asks for a name.
        assert one.plot.main == ("" if callable(figure) else figure)


def test_every_result_shows_itself_in_a_notebook(saved, monkeypatch):
    # The figures themselves are drawn above.
    monkeypatch.setattr("treadload.composing.small_picture", lambda _: None)
    result, _ = saved
    page = result._repr_html_()
    assert "<details><summary>Dataset</summary>" in page
    assert result.title in page


# Numbers over a further dimension, whose label is the place there: a criterion, an input, a risk, a mode.
BY_PLACE = {"standard_axles", "elasticity", "risk_years", "stress_intensity_range"}


def test_a_number_has_one_name_in_all_results():
    """A key has one label, a label one key; both stand in variables.py, but for the fields of any result."""
    labels = defaultdict(set)
    for name in sorted(MADE):
        rows = made(name).rows()
        assert rows, name
        assert all(one.key != "verdict" for one in rows[:-1]), name
        for one in rows:
            if not isinstance(one.value, str):
                assert one.key in VARIABLES, (name, one)
            if one.key in BY_PLACE or name == "Fields":
                continue
            label = display_of(one.key).label
            # A qualifier may follow, such as a risk.
            assert one.label == label or one.label.startswith(f"{label} "), (name, one)
            labels[label].add(one.key)
    assert {label: found for label, found in labels.items() if len(found) > 1} == {}


def test_labels_are_the_same_in_summary_notebook_report_page_and_file(saved, tmp_path, without_figures, monkeypatch):
    """Each renders `rows()`: none has words of its own for a number."""
    monkeypatch.setattr("treadload.composing.small_picture", lambda _: None)
    result, opened = saved
    (name,) = opened
    rows = result.rows()
    # The verdict is a sentence, which a notebook and a report show as their first line.
    labels = [row.label for row in rows if row.label and row.key != "verdict"]
    summary = result.summary()
    assert [label for label in labels if label not in summary] == []
    attrs = opened.tree[name].attrs
    assert [row.label for row in from_json(attrs["rows"])] == [row.label for row in rows]
    shown = rows_of({name: result})[: len(rows)]
    assert [line["label"] for line in shown] == [label_of(row.label) for row in rows]
    assert [line["value"] for line in shown] == [row.text for row in rows]
    notebook = html.unescape(result._repr_html_())
    assert [label for label in labels if label not in notebook] == []
    page = html.unescape(tl.report(result, tmp_path / "x.html").read_text(encoding="utf-8"))
    # The answer of a report states what governs and its years in words of its headline, see `damage/answer.py`.
    answers = isinstance(result, tl.damage.Life)
    answered = {row.label for row in rows if row.key in ("governing", "governing_years")} if answers else set()
    assert [label for label in labels if label not in page and label not in answered] == []
    if answers:
        assert result.answer.headline in page
        assert f"<dd>{result.governing}</dd>" in page


def backwards(data):
    """The dataset with the dimensions of every variable the other way round, as other programs write it."""
    return data.assign({name: field.transpose(*field.dims[::-1]) for name, field in data.variables.items()})


def test_dimensions_in_another_order_are_put_back(saved, tmp_path):
    """The order of the table is that of every class, so that whoever takes values has rows for rows."""
    result, _ = saved
    data = result.dataset
    assert in_order(data) is data
    xr.testing.assert_identical(dataset_of(backwards(data)), data)
    tree = tl.results.to_tree(result)
    groups = {f"/{name}": backwards(node.to_dataset()) for name, node in tree.children.items() if name != "asked"}
    groups["/asked"] = tree["asked"].to_dataset()
    odd = xr.DataTree.from_dict({"/": xr.Dataset(attrs=tree.attrs), **groups})
    opened = tl.open_results(tl.save_results(odd, tmp_path / "x.nc"))
    back = opened[result.group_name]
    xr.testing.assert_identical(back.dataset, data)
    assert back.summary() == result.summary()
    (case, *_) = ReportCase.all_of("x", opened.tree)
    (shown, *_) = [*case.groups.values(), *(other.dataset for other in case.extras)]
    for name, field in shown.variables.items():
        assert field.dims == data[name].dims, name


def test_a_figure_of_shares_has_classes_for_rows_whatever_the_order():
    made = life()
    turned = made.dataset.assign(damage_share=made.dataset["damage_share"].transpose("criterion", "season", ...))
    for drawn in (made, turned):
        axes = tl.plots.life_shares(drawn).axes[0]
        told = np.asarray(axes.collections[0].get_array()).reshape(2, 2)
        np.testing.assert_array_equal(told, 100 * made.dataset["damage_share"].sel(criterion=made.governing))


def broken(data):
    """Datasets that lack something, or hold it in another way, with the name of what it is."""
    for name in map(str, data.variables):
        field = data[name]
        yield name, data.drop_vars(name)
        if name not in data.dims:
            yield name, data.assign({name: (field.dims, np.full(field.shape, "odd"), field.attrs)})
            yield name, data.assign({name: (("further", *field.dims), field.to_numpy()[None], field.attrs)})
            yield name, data.assign({name: (field.dims, np.zeros(field.shape), field.attrs)})
    for name in data.attrs:
        others = {key: value for key, value in data.attrs.items() if key != name}
        yield name, data.drop_attrs(deep=False).assign_attrs(others)
        for odd in (np.array([1.0, 2.0]), "[", 1e300):
            yield name, data.assign_attrs({name: odd})
    for dim in data.dims:
        yield dim, data.isel({dim: slice(0, 0)})
        yield dim, data.isel({dim: 0})


def refusal(kind, data, told):
    try:
        check_dataset(kind, data, "x.nc: the part 'a'", told)
    except tl.InputError as error:
        return str(error)
    return ""


@pytest.mark.filterwarnings("error")
def test_a_dataset_that_cannot_be_read_is_refused_before_it_becomes_a_result(saved):
    result, _ = saved
    told = {one.name: getattr(result, one.name) for one in fields(result) if one.init}
    if "dataset" not in told:
        return  # made of its inputs alone
    holds, refused = type(result).holds, set()
    for name, data in broken(result.dataset):
        said = refusal(type(result), data, told)
        if said:
            assert said.startswith("x.nc: the part 'a'")
            assert len(said.splitlines()) == 1
            refused.add(name)
        else:
            assert replace(result, dataset=data).summary()
    needed = {one for names in (*holds.fields, *holds.labels, *holds.values) for one in names.split()}
    assert refused >= needed | set(f"{holds.numbers} {holds.texts} {holds.lists} {holds.members}".split())


@pytest.fixture(scope="module")
def reported(saved, tmp_path_factory):
    """The report of a result in pictures of few pixels: whether they can be drawn is what is tried."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("treadload.reporting.pictures._DPI", 30.0)
        return tl.report(saved[0], tmp_path_factory.mktemp("report") / "r.html").read_text("utf-8")


def test_every_result_is_reported(saved, reported):
    assert reported.count("<figure") > 0
    assert "could not be drawn" not in reported
    for text in saved[0].warnings:
        assert text.replace("'", "&#39;").replace('"', "&#34;") in reported or text in reported


# SI units that a number, a label or a tick of a report in US units must not have; J/m, W, s, Hz and % stay.
SI_ALONE = {"Pa", "kPa", "MPa", "GPa", "mm", "µm", "kN", "°C", "J/m³", "J/m²", "kJ/m²"}
SI = re.compile(
    r"(?<![\w.^])\d[\d.]*[ \u00a0\u202f]?(?:[kMG]?Pa|[kM]?N(?: m)?|[mcµk]?m[²³]?|°C|km/h|k?J/m[²³])(?![\w°²³√/·%^-])"
    r"|\((?:[kMG]?Pa|k?N(?: k?m)?|[mcµk]?m[²³]?|°C|km/h|k?J/m[²³])\)"
)


def test_every_figure_of_a_report_from_a_file_is_in_us_units(saved, reported, tmp_path, monkeypatch):
    """The file has the same figures as the result that was saved."""
    figures = []

    def kept(figure, dpi):
        figures.append(figure)
        return Image.new("RGB", (1, 1), "white")

    monkeypatch.setattr("treadload.reporting.pictures.raster", kept)
    _, opened = saved
    with display_units("us"):
        page = tl.report(opened, tmp_path / "us.html").read_text("utf-8")
    assert "could not be drawn" not in page
    assert page.count("<figure") == reported.count("<figure") >= len(figures) > 0
    for figure in figures:
        # Texts and ticks are what is read; where they stand is laid out, and drawn, for the report in SI units.
        figure.set_layout_engine("none")
        figure.draw_without_rendering()
        ticks = [
            text for ax in figure.findobj(Axes) for axis in ax._axis_map.values() for text in axis.get_ticklabels()
        ]
        texts = [text.get_text() for text in (*texts_of(figure), *ticks)]
        assert [text for text in texts if SI.search(text) or text in SI_ALONE] == []
    # Captions, headings and numbers beside them, without what a case says of itself and the literature.
    words = re.sub(r"<(style|pre|ol)\b.*?</\1>|<img [^>]*>", "", page, flags=re.DOTALL)
    words = html.unescape(re.sub(r"<[^>]+>", " ", words))
    assert [words[max(0, m.start() - 40) : m.end() + 20] for m in SI.finditer(words)] == []


def test_every_result_is_written_as_tables(saved, tmp_path):
    result, opened = saved
    assert tl.results.write_csv(result, tmp_path / "t.csv")
    for file in tl.results.write_csv(opened, tmp_path / "u.csv"):
        assert "asked" not in file.name
        assert '"questions"' not in file.read_text()


@pytest.mark.usefixtures("figures_as_dots")
def test_what_is_opened_goes_into_every_verb(tmp_path):
    asked = contact()
    first = tl.solve_response(asked, ROAD, depths=[0.0, 0.08], x=AT, y=AT)
    opened = tl.open_results(tl.save_results([asked, first], tmp_path / "x.nc"))
    assert opened.contact.tire == TIRE
    assert opened.contact.road == opened.road == ROAD
    assert opened.contact.rolling == WHEEL
    again = tl.solve_response(opened.contact, opened.road, depths=[0.0, 0.08], x=AT, y=AT)
    xr.testing.assert_identical(again.dataset, first.dataset)
    # Solves the road again: its loads are those of the file.
    assert tl.assess(opened.response, LINE).summary() == tl.assess(first, LINE).summary()
    solved = tl.solve_contact(opened.contact.tire, opened.road, replace(opened.contact.rolling, tractive_force=0))
    np.testing.assert_array_equal(solved.dataset.pressure, contact(tractive_force=0).dataset.pressure)
    assert tl.report([opened.contact, opened.response], tmp_path / "r.html").exists()
    assert opened.contact.plot.pressure().axes


@pytest.mark.usefixtures("figures_as_dots")
def test_several_of_a_kind_have_names(tmp_path):
    one, two = contact(), contact(tractive_force=100)
    assert list(tl.results.to_tree([one, two]).children) == ["contact", "contact_2", "asked"]
    opened = tl.open_results(tl.save_results({"free": one, "braking": two}, tmp_path / "x.nc"))
    assert list(opened) == ["free", "braking"]
    assert float(opened.braking.dataset.tractive_force) == float(two.dataset.tractive_force)
    assert opened["free"].summary() == one.summary()
    page = tl.report(opened, tmp_path / "r.html").read_text()
    assert "Contact pressure, side by side" in page
    assert ">braking<" in page


@pytest.mark.parametrize("name", ["", "a/b", ".", "asked", " x", "x ", 3, "\x00"])
def test_a_name_that_no_file_holds_is_refused(name):
    with pytest.raises(tl.InputError, match="cannot be named"):
        tl.results.to_tree({name: footprint()})


def test_what_is_no_result_is_refused(tmp_path):
    for wrong in ([1], 3.0, "contact", None):
        with pytest.raises(tl.InputError, match="made of results"):
            tl.save_results(wrong, tmp_path / "x.nc")
    assert not list(tmp_path.iterdir())


def test_the_result_of_a_case_opens_whole(coarse_result, tmp_path):
    opened = tl.open_results(tl.save_results(coarse_result, tmp_path / "x.nc"))
    assert opened.summary() == coarse_result.summary()
    assert opened.case == coarse_result.case
    assert opened.warnings == coarse_result.warnings
    assert list(opened) == list(coarse_result.parts)
    for name, part in coarse_result.parts.items():
        xr.testing.assert_identical(opened[name].dataset, part.dataset)
        assert opened[name].summary() == part.summary()
    assert opened.verdict.line == coarse_result.verdict.line
    assert opened.plot.contact.pressure().axes
    assert coarse_result.plot.contact.pressure().axes
    assert "Results" not in repr(coarse_result)
    assert coarse_result.case.title in opened._repr_html_()
    # Its loads are kept once, though four responses were asked with them.
    assert sum(one.nbytes for one in opened.tree["asked"].data_vars.values()) < 4 * sum(
        opened.contact.dataset[name].nbytes for name in ("pressure", "traction_x", "traction_y")
    )


def test_a_scan_says_that_it_is_gone(tmp_path):
    scanned = tl.Tire.from_scan(tl.example_mesh(), material=RUBBER)
    asked = tl.solve_contact(scanned, ROAD, tl.Rolling(normal_load=3e4, friction=0.7), spacing=0.02)
    opened = tl.open_results(tl.save_results(asked, tmp_path / "x.nc"))
    tire = opened.contact.tire
    assert str(tire) == str(scanned)
    assert tire.camber_spin == scanned.camber_spin
    assert tire.quality == scanned.quality
    with pytest.raises(tl.InputError, match=r"not in the result file.*Tire.from_scan"):
        tl.solve_contact(tire, opened.road, opened.contact.rolling)
    # What the sentence offers works.
    map_of = tl.Tire.from_height_map(opened.contact.dataset["initial_gap"], material=RUBBER)
    again = tl.solve_contact(map_of, opened.road, opened.contact.rolling)
    # The solver's tolerance, and another way to it.
    np.testing.assert_allclose(again.dataset.pressure, asked.dataset.pressure, rtol=1e-4, atol=1e2)


def test_a_function_says_that_it_is_gone(tmp_path):
    y = np.linspace(-0.4, 0.4, 21)
    law = lambda degrees: tl.FatigueLine(1e-6 * (100 + degrees), -0.2)  # noqa: E731
    traffic = Traffic((tl.damage.AxleClass("one", 1.0, 20e3, 7e5),), 1e5)
    readings = np.full((1, 1, 1, 21), 1e-4)
    whole = miner(readings, (Criterion("top", law, 0, "top"),), traffic, Climate.constant(17.0), y=y)
    back = tl.open_results(tl.save_results(whole, tmp_path / "x.nc")).life
    assert back.summary() == whole.summary()
    assert back.criteria[0].law_at(17.0) == law(17.0)
    with pytest.raises(tl.InputError, match=r"lambda.* is a function, which was tabulated from"):
        back.criteria[0].law_at(17.5)


def without_questions(tree):
    groups = {f"/{name}": node.to_dataset() for name, node in tree.children.items() if name != "asked"}
    for data in groups.values():
        data.attrs = {key: value for key, value in data.attrs.items() if key not in ("result", "summary")}
    attrs = {key: value for key, value in tree.attrs.items() if key not in ("results_format", "summary")}
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=attrs), **groups})


def test_a_part_whose_inputs_are_not_in_the_file_is_refused_and_its_fields_stay(coarse_result, tmp_path):
    old = without_questions(coarse_result.to_tree())
    opened = tl.open_results(tl.save_results(old, tmp_path / "old.nc"))
    for name in ("contact", "response"):
        words = rf"written by treadload {tl.__version__}, without the inputs of its part '{name}'"
        with pytest.raises(tl.InputError, match=rf"{words}; .* \.tree\['{name}'\]"):
            opened[name]
    kept = opened.tree["contact"].pressure.to_numpy()
    np.testing.assert_array_equal(kept, coarse_result.contact.dataset.pressure)


def test_what_presses_nowhere_and_what_is_nowhere_known_says_so():
    data = contact().dataset
    empty = replace(contact(), dataset=data.assign(pressure=0 * data.pressure))
    assert "mean pressure                     –" in empty.summary()
    deep = response().dataset.copy(deep=True)
    deep["principal_strain_1"][1] = np.nan
    lines = replace(response(), dataset=deep).summary().splitlines()
    assert lines[:4] == response().summary().splitlines()[:4]
    assert lines[5].endswith("–, unknown: it is NaN everywhere")


def test_a_file_of_a_later_format_is_refused(tmp_path):
    tree = tl.results.to_tree([footprint()])
    tree.attrs["results_format"] = 99
    with pytest.raises(tl.InputError, match=r"format 99 of results; this is treadload .* update treadload"):
        tl.open_results(tl.save_results(tree, tmp_path / "x.nc"))


def changed(tree, change):
    asked = tree["asked"].to_dataset()
    questions = json.loads(asked.attrs["questions"])
    asked.attrs["questions"] = json.dumps(change(questions))
    groups = {f"/{name}": node.to_dataset() for name, node in tree.children.items()}
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=tree.attrs), **groups, "/asked": asked})


def into(questions, value, *keys):
    inner = questions
    for key in keys[:-1]:
        inner = inner[key]
    inner[keys[-1]] = value
    return questions


@pytest.mark.parametrize(
    ("value", "keys", "message"),
    [
        ([], (), "cannot be read"),
        (3, ("contact",), "cannot be read"),
        (3, ("contact", "is"), "cannot be read"),
        ({"is": "Popen", "with": {}}, ("contact", "with", "road"), "unknown to this treadload"),
        ({"is": "os:system", "with": {}}, ("contact", "with", "road"), "unknown to this treadload"),
        ({"is": "Elastic", "with": {"modulus": -1, "poisson": 0.3}}, ("contact", "with", "road"), "modulus must be"),
        ({"is": "Elastic", "with": {"colour": 1}}, ("contact", "with", "road"), "no Elastic can be made"),
        ({"array": "array_99"}, ("contact", "with", "road"), "array_99' of its inputs is missing"),
        ({"part": "contact"}, ("contact", "with", "road"), "an input of itself"),
        ({"number": "1e5"}, ("contact", "with", "road"), "is not a number"),
        ({"odd": 1}, ("contact", "with", "road"), "not a possible input of a result"),
        (3, ("contact", "with", "road"), "x.nc: the part 'contact': the road of a Contact cannot be 3"),
        ({"tuple": [3]}, ("contact", "with", "warnings"), r"warnings of a Contact cannot be \(3,\)"),
        ([], ("contact", "attrs"), "the part 'contact' cannot be read"),
        (
            {"table": [["road_share", 0.1], ["layer_share", "a"], ["layers_solved", True]]},
            ("contact", "with", "stats"),
            "the entry layer_share of stats must be a finite number",
        ),
    ],
)
def test_a_question_that_was_tampered_with_is_refused_in_a_sentence(value, keys, message, tmp_path):
    tree = changed(
        tl.results.to_tree([contact()]), lambda questions: into(questions, value, *keys) if keys else value
    )
    opened = tl.open_results(tl.save_results(tree, tmp_path / "x.nc"))
    with pytest.raises(tl.InputError, match=message) as caught:
        opened.contact.summary()
    assert len(str(caught.value).splitlines()) == 1


def test_a_figure_that_fails_leaves_its_reason(coarse_result, tmp_path, monkeypatch):
    def broken(*_, **__):
        raise RuntimeError("the pen\nis dry")

    monkeypatch.setattr("treadload.plots.contact.figure_and_axes", broken)
    page = tl.report(coarse_result.contact, tmp_path / "r.html").read_text()
    assert "This figure could not be drawn: RuntimeError, the pen is dry." in page
    whole = tl.report(coarse_result.verdict, tmp_path / "s.html").read_text()
    assert "could not be drawn" not in whole


def test_text_of_a_result_is_escaped():
    odd = Fields(xr.Dataset({"a": ("x", [1.0])}, attrs={"note": "<script>"}))
    odd.dataset["<b>"] = ("x", [1.0])
    page = odd._repr_html_()
    assert "<b>:" not in page
    assert "&lt;b&gt;" in page
    assert "<script>" not in page


def test_a_case_and_its_text_make_one_report(coarse_result, tmp_path, without_figures):
    other = replace(coarse_result, case=Case.from_text(COARSE_CASE.replace('"coarse"', '"other"')))
    page = tl.report([coarse_result, other], tmp_path / "r.html").read_text()
    assert ">coarse<" in page
    assert ">other<" in page
    assert set(as_tree(coarse_result).children) == {*coarse_result.parts, "asked"}


def test_files_with_a_former_name_of_the_caveats_open(tmp_path):
    tree = as_tree([life(), bonds()])
    for part in tree.subtree:
        former = {"caveats": "doubts"}
        part.attrs = {
            former.get(name, name): re.sub(r'"caveat(s?)"', r'"doubt\1"', text) if isinstance(text, str) else text
            for name, text in part.attrs.items()
        }
    assert '"doubt"' in tree["asked"].attrs["questions"]
    assert "doubts" in tree["life"].attrs
    opened = tl.open_results(tl.save_results(tree, tmp_path / "former.nc"))
    assert opened.bonds.strengths[0].caveat == "made up"
    assert opened.bonds.law.caveat == ""
    assert json.loads(opened.life.dataset.attrs["caveats"]) == json.loads(life().dataset.attrs["caveats"])
    assert opened.life.summary() == life().summary()
