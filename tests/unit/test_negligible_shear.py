"""Shear below 0.1 % of the peak pressure is not drawn: a sentence with its size stands in its place."""

import numpy as np
import pytest

from treadload import variables
from treadload.case import Case
from treadload.plots import contact as figures
from treadload.plots.interactive.field import shear_field
from treadload.plots.kit.plan import fields_of
from treadload.steps import run
from treadload.units import stress_in_words


def rolled(shear: float, pressure: float = 1.237679e9):
    """A contact of a stiff wheel, whose peaks are given in Pa."""
    x = y = 1e-4 * (np.arange(21) - 10)
    inside = np.maximum(1 - (x[None] ** 2 + y[:, None] ** 2) / 0.8e-6, 0)
    dims = ("y", "x")
    fields = {
        "pressure": (dims, pressure * np.sqrt(inside)),
        "traction_x": (dims, shear * np.sqrt(inside)),
        "traction_y": (dims, 0 * inside),
        "state": (dims, np.where(inside > 0, 1 + (x[None] > 0), 0)),
    }
    return variables.dataset(fields, {"y": y, "x": x}, dx=1e-4, dy=1e-4)


def words(figure):
    return " ".join(text.get_text().replace("\n", " ") for ax in figure.axes for text in ax.texts)


# A half-space of rubber, which keeps its volume: what shears it is the road's own strain.
FREE = """
spacing = "3 mm"
[tire]
scan = "example"
revolve = true
inflation_pressure = "8.2 bar"
material = { kind = "elastic", modulus = "3 MPa", poisson = 0.5 }
[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[rolling]
normal_load = "32.5 kN"
friction = 0.7
"""


@pytest.fixture(scope="module")
def free():
    """Free rolling of the example mesh as a half-space, on cells of 6 mm."""
    return free_rolling(0.35)


def free_rolling(poisson, **changes):
    text = FREE.replace('"3 mm"', '"6 mm"').replace("poisson = 0.35", f"poisson = {poisson:g}")
    for old, new in changes.items():
        text = text.replace(old, new)
    return run(Case.from_text(text)).contact.dataset


def largest_shear(data):
    return float(np.hypot(data.traction_x, data.traction_y).max())


@pytest.mark.parametrize("draw", [figures.stick_slip, figures.shear])
@pytest.mark.parametrize("pressure", [1.237679e9, 8e5])
def test_a_figure_says_that_shear_is_too_small_to_draw(draw, pressure):
    told = words(draw(rolled(420.0, pressure)))
    assert (
        f"below 0.1 % of the peak pressure is not drawn: at most 0.42 kPa under {stress_in_words(pressure)}" in told
    )
    assert "not drawn" not in words(draw(rolled(1.1e-3 * pressure, pressure)))


def test_negligible_shear_has_no_scale_of_its_own():
    figure = figures.stick_slip(rolled(420.0))
    # A map and no colour bar beside it.
    assert not figure.axes[0].child_axes
    assert figures.stick_slip(rolled(4e8)).axes[0].child_axes


def test_the_page_draws_none_either():
    field = shear_field(rolled(420.0))
    assert not np.nan_to_num(field.values).any()
    assert "at most 0.42 kPa under 1.24 GPa" in field.title


@pytest.mark.slow
def test_shear_of_a_free_wheel_is_real_and_goes_with_the_road(free):
    """(1 - 2ν)/G of the road, below a tire that keeps its volume: twice as much on half of E, none at ν = 0.5."""
    shear, pressure = largest_shear(free), float(free.pressure.max())
    # 270.7 Pa under 1.52 MPa.
    assert shear == pytest.approx(1.78e-4 * pressure, rel=0.02)
    softer = free_rolling(0.35, **{"5400 MPa": "2700 MPa"})
    assert largest_shear(softer) == pytest.approx(2 * shear, rel=0.01)
    stiffer = free_rolling(0.2)
    # (1 - 2ν)(1 + ν): 0.72 for 0.405.
    assert largest_shear(stiffer) == pytest.approx(0.72 / 0.405 * shear, rel=0.01)
    assert largest_shear(free_rolling(0.5)) < 1e-9 * pressure


def test_free_rolling_of_a_half_space_is_not_drawn(free):
    said = fields_of(free, "traction_x").attrs["negligible_shear"]
    assert stress_in_words(largest_shear(free)) in said
    assert "0.27 kPa" in said
