"""Figures in US units: ticks are where their numbers say, labels and texts have no SI unit, data stay in place."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator

import treadload as tl
from treadload.errors import InputError
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.style import styled
from treadload.plots.kit.us_figure import texts_of
from treadload.us_units import US_UNITS, display_units
from treadload.variables import SCALES

# Of the definitions of inch, pound and psi.
INCH, PSI = 25.4, 6.894757293168361


@pytest.fixture(scope="module")
def contact():
    x = 5e-3 * (np.arange(16) - 7.5)
    tire = tl.Tire.from_height_map((x[None, :] ** 2 + x[:, None] ** 2) / 0.8, 5e-3, material=tl.Elastic(3e6, 0.5))
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    return tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.7, tractive_force=30.0))


def ticks(axis):
    """Place in the data and number shown of each tick that is seen."""
    low, high = sorted(axis.get_view_interval())
    pairs = [(at, text.get_text()) for at, text in zip(axis.get_majorticklocs(), axis.get_ticklabels(), strict=True)]
    return [(at, float(text.replace("\u2212", "-"))) for at, text in pairs if low <= at <= high and text]


@styled
def drawn(label, values, *, scale="linear", at=None, texts=None):
    figure = new_figure(4, 3)
    ax = figure.add_subplot()
    ax.plot(values, values)
    ax.set_xscale(scale)
    ax.set_xlabel(label)
    if at is not None:
        ax.set_xticks(at, texts)
    return figure


def axis_of(label, values, **how):
    with display_units("us"):
        figure = drawn(label, values, **how)
    figure.draw_without_rendering()
    return figure.axes[0].xaxis


@pytest.mark.parametrize("unit", sorted(US_UNITS))
def test_ticks_stand_where_their_numbers_say(unit):
    axis = axis_of(f"quantity ({unit})", [3.0, 57.0])
    shown = US_UNITS[unit]
    assert axis.get_label_text() == f"quantity ({shown.symbol})"
    found = ticks(axis)
    assert len(found) >= 3
    offset = axis.get_major_formatter().get_offset().replace("1e", "1e") or "1"
    for at, number in found:
        assert number * float(offset) == pytest.approx(shown.number(at / SCALES[unit]), rel=1e-6, abs=1e-6)
    # Ticks are round in the US unit: equal steps of 1, 2, 2.5 or 5 times a power of ten.
    step = found[1][1] - found[0][1]
    assert step / 10 ** np.floor(np.log10(step) + 1e-9) == pytest.approx(
        min((1, 2, 2.5, 5, 10), key=lambda m: abs(m - step / 10 ** np.floor(np.log10(step) + 1e-9)))
    )


def test_moduli_stresses_and_bare_units():
    assert axis_of("Young's modulus (MPa)", [2.0, 9.0]).get_label_text() == "Young's modulus (ksi)"
    assert axis_of("asphalt\n(MPa)", [200.0, 9000.0]).get_label_text() == "asphalt\n(ksi)"
    assert axis_of("MPa", [0.2, 0.9]).get_label_text() == "psi"
    assert axis_of("range (MPa √m)", [0.2, 0.9]).get_label_text() == "range (ksi√in)"
    # N is not newton here.
    assert axis_of("load repetitions, N", [1.0, 2.0]).get_label_text() == "load repetitions, N"
    assert axis_of("strain (microstrain)", [1.0, 2.0]).get_label_text() == "strain (microstrain)"


def test_a_logarithmic_axis_keeps_whole_decades_in_the_us_unit():
    axis = axis_of("modulus (MPa)", [50.0, 20000.0], scale="log")
    locations = axis.get_majorticklocs()
    psi = locations * 1e3 / PSI / 1e3
    inside = psi[(locations >= 50) & (locations <= 20000)]
    assert len(inside) >= 2
    np.testing.assert_allclose(np.log10(inside), np.round(np.log10(inside)), atol=1e-9)
    assert isinstance(axis.get_major_locator()._locator, LogLocator)


def test_ticks_with_texts():
    axis = axis_of("load (kN)", [10.0, 40.0], at=[10, 20, 40], texts=["10", "20", "40"])
    assert ticks(axis) == [(10, 2.248), (20, 4.496), (40, 8.992)]
    axis = axis_of("", [0.0, 1.0], at=[0, 1], texts=["temperature, +1 °C", "2 cm more"])
    assert [text.get_text() for text in axis.get_ticklabels()] == ["temperature, +1.8 °F", "0.8 in more"]


def test_a_figure_of_a_contact(contact):
    plain, figure = contact.plot.pressure(), contact.plot.pressure(units="us")
    for each in (plain, figure):
        each.draw_without_rendering()
    ax, before = figure.axes[0], plain.axes[0]
    assert (ax.get_xlim(), ax.get_ylim()) == (before.get_xlim(), before.get_ylim())
    np.testing.assert_array_equal(ax.collections[0].get_array(), before.collections[0].get_array())
    assert ax.get_ylabel() == "y, right of travel (in)"
    for at, number in ticks(ax.xaxis):
        assert number * INCH == pytest.approx(at, abs=1e-9)
    (bar,) = [each for each in figure.findobj(Axes) if each.get_ylabel() == "contact pressure (psi)"]
    for at, number in ticks(bar.yaxis):
        assert number * PSI == pytest.approx(at, rel=1e-9, abs=1e-9)
    peak = float(contact.dataset["pressure"].max()) / 1e3 / PSI
    texts = " ".join(text.get_text() for text in texts_of(figure))
    assert f"peak {peak:.0f} psi" in texts or f"peak {peak:.1f} psi" in texts
    assert "kPa" not in texts
    assert "mm" not in texts


def test_a_figure_in_si_is_as_it_was_and_another_word_is_an_error(contact):
    assert contact.plot.pressure(units="si").axes[0].get_xlabel() == "x, direction of travel (mm)"
    with display_units("us"):
        assert contact.plot.pressure(units="si").axes[0].get_xlabel() == "x, direction of travel (mm)"
        assert contact.plot.pressure().axes[0].get_xlabel() == "x, direction of travel (in)"
    with pytest.raises(InputError, match="si or us"):
        contact.plot.pressure(units="imperial")


def test_a_plain_map_has_the_label_and_unit_of_its_variable():
    values = np.linspace(0, 5e-5, 12).reshape(3, 4)
    data = xr.Dataset(
        {"vertical_compression": (("y", "x"), values, {"units": "1"})},
        {"x": np.arange(4) * 1e-2, "y": np.arange(3) * 1e-2},
    )
    figure = tl.plots.plain_map(data, "vertical_compression")
    labels = [ax.get_ylabel() for ax in figure.findobj(Axes)]
    assert "vertical compression (microstrain)" in labels
