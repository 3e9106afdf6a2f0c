"""The gallery and the validation in pictures: each script runs, draws one figure and gives its number.

A number with a witness is held to it. The others are kept to detect changes, to 1 %: cells are coarse, and another
processor or library moves them by far less.
"""

import runpy
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from treadload.validation.grain import hertz_on_grain

DOCS = Path(__file__).parents[2] / "docs"
KEPT = 0.01
# Script: expression of its names, value, relative tolerance.
NUMBERS = {
    "plot_01_contact": ("contact.area", 0.0596, KEPT),
    "plot_02_driving": ("contact.dataset.creepage_x.item()", -0.0488195, KEPT),
    "plot_03_two_tires": ("contacts[1].area / contacts[0].area", 0.575818, KEPT),
    "plot_04_extension": ("1e6 * float(verdict.dataset.worst_strain)", 53.7124, KEPT),
    "plot_05_layers": ("1e6 * float(responses[35].dataset.in_plane_strain_1.sel(depth=0.21).max())", 293.906, KEPT),
    # Of the published parameters.
    "plot_06_asphalt": ("abs(complex(mix.at(15).complex_modulus(62.8318531)))", 11356e6, 1e-4),
    "plot_07_creep_curve": ("float(curves[0].dataset.tractive_force.sel(creepage=-0.02))", 4502.35, KEPT),
    "plot_08_life": ("result.life.years('bottom of the base')", 43.1326, KEPT),
    "plot_09_uniform": ("float(compared.ratio('largest_in_plane_extension').isel(depth=-1))", 0.925546, KEPT),
    "plot_10_cornering": ("stiffness", 5.21777, KEPT),
    "plot_11_roundabout": ("strains[25]", 137.690, KEPT),
    # All but the last particles slide at 30 degrees.
    "plot_12_turning_on_the_spot": ("share", 0.99904, 1e-3),
    "plot_13_driving_off": ("half", 0.160037, KEPT),
    # Worked outside the package: tests/data/layered/french_catalogue.json.
    "plot_14_interfaces": ("strains['bonded']", 97.0871787131, 1e-9),
    # A half-space alone would give 2.
    "plot_15_deflection_bowl": ("ratio", 2.07223, 1e-4),
    "plot_16_speed": ("slow", 1.81357, 1e-3),
    "plot_17_joint": ("rise", 1.59662, KEPT),
    # Passes come to rest.
    "plot_18_drum": ("left < 0.01", True, 0),
    "plot_19_sphere_pressed": ("dent", 0.0828763, 0.05),
    # IRC over the French law by their formulas.
    "plot_20_fatigue_laws": (
        "spread",
        "at_hundred['IRC:37'] / at_hundred['French, GB3, risk 5 %']",
        1e-12,
    ),
    "plot_21_cross_anisotropic": ("change", -0.0182679, KEPT),
    # The area grows with the pressure, by less than in proportion.
    "plot_22_texture": ("bool(shares[0] < shares[1] < 4 * shares[0])", True, 0),
    "plot_23_rubber_memory": ("largest", 24.5544, KEPT),
    "plot_24_temperature": ("years", 9.50817, KEPT),
    # Put in: 70 MPa. The mean of four bowls with 2 % of noise at each sensor.
    "plot_25_backcalculation": ("subgrade", 70.0, 0.02),
    "plot_26_energy": ("largest", 158.622, 1e-3),
    # Near the slope of each law, 5 and 4.5, as strain grows nearly with the load.
    "plot_27_axle_load": ("4.3 < powers['base'] < 5 and 3.9 < powers['subgrade'] < 4.5", True, 0),
    "plot_28_grid": ("abs(change) < 0.02", True, 0),
    "plot_30_two_wheels": ("largest['dual']", 100.004686068, 0.005),
}
# Validation in pictures: largest size of the deviation, that of the table.
DEVIATIONS = {
    "plot_00_overview": 1.0,
    "plot_01_hertz": 0.005,
    "plot_02_carter": 0.02,
    "plot_03_creep_curve": 2e-4,
    "plot_04_layers": 2.5e-4,
    "plot_05_moving": 0.025,
    "plot_06_viscoelastic_body": 1e-3,
    "plot_07_cracks": 1e-3,
    "plot_08_designs": 0.0075,
    "plot_09_frost": 0.01,
    "plot_10_scan": 1.0,
}


def run(name, folder):
    """Names that a script leaves."""
    names = runpy.run_path(str(DOCS / folder / f"{name}.py"))
    assert any(isinstance(value, Figure) for value in names.values())
    return names


def test_every_script_has_its_number():
    scripts = {path.stem for path in (DOCS / "gallery").glob("plot_*.py")}
    assert scripts == {*NUMBERS, "plot_29_tilted_axes"}
    assert len(scripts) == 30
    assert {path.stem for path in (DOCS / "validation_gallery").glob("plot_*.py")} == set(DEVIATIONS)


@pytest.mark.slow
@pytest.mark.parametrize("name", NUMBERS)
def test_a_script_of_the_gallery_gives_its_number(name):
    names = run(name, "gallery")
    expression, value, tolerance = NUMBERS[name]
    expected = eval(value, names) if isinstance(value, str) else value
    assert eval(expression, names) == pytest.approx(expected, rel=tolerance)


@pytest.mark.slow
def test_the_ellipse_on_tilted_axes_has_the_axes_of_the_closed_form():
    """To 1 % of the ratio: 36 cells, a ball of steel in place of a rigid one."""
    names = run("plot_29_tilted_axes", "gallery")
    turned = names["laminate"].rotated(yaw=np.radians(40), pitch=-np.radians(20))
    exact = hertz_on_grain(turned, np.eye(2) / 0.2, 3e3)
    assert names["ratio"] == pytest.approx(exact.axes[0] / exact.axes[1], rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("name", DEVIATIONS)
def test_a_picture_of_the_validation_keeps_its_bound(name, monkeypatch):
    monkeypatch.chdir(DOCS / "validation_gallery")
    assert abs(run(name, "validation_gallery")["deviation"]) <= DEVIATIONS[name]


def test_a_half_bonded_interface_lies_between():
    """The strain of the half-bonded interface is the mean of the other two, by its definition."""
    strains = runpy.run_path(str(DOCS / "gallery" / "plot_14_interfaces.py"))["strains"]
    assert strains["half-bonded"] == pytest.approx((strains["bonded"] + strains["frictionless"]) / 2, rel=1e-9)


def test_histories_show_all_of_the_slip():
    """Limits of the share that slips were set before its line was drawn, and stayed at 1 %."""
    names = runpy.run_path(str(DOCS / "gallery" / "plot_13_driving_off.py"))
    right = names["figure"].axes[1]
    assert right.get_ylim()[1] >= 100 * float(names["start"].dataset.slip_fraction.max())
