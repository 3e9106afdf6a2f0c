"""Figures of materials: what is drawn, in which units, over which range."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import treadload as tl
from treadload.errors import InputError
from treadload.materials import (
    WLF,
    FrequencySweep,
    HuetSayegh,
    Prony,
    RelaxationTest,
    Thermorheological,
    master_curve,
)
from treadload.plots import black_diagram, cole_cole, png, shift_factors
from treadload.plots import master_curve as draw_master_curve

MIX = HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, 0.0329, 0.35)
LAW = WLF(20.0, 150.0, 15.0)
OMEGA = 2 * np.pi * np.geomspace(0.1, 25.0, 7)


def isotherms(kind):
    found = []
    for temperature in (5.0, 15.0, 25.0):
        material = Thermorheological(MIX, LAW).at(temperature)
        if kind is FrequencySweep:
            modulus = material.complex_modulus(OMEGA)
            found.append(FrequencySweep(OMEGA, modulus.real, modulus.imag, temperature))
        else:
            found.append(RelaxationTest(1 / OMEGA, material.relaxation_modulus(1 / OMEGA), temperature))
    return master_curve(found, 15.0)


SWEEPS = isotherms(FrequencySweep)
TESTS = isotherms(RelaxationTest)


def test_black_diagram_is_norm_against_phase():
    ax = black_diagram(MIX, frequencies=(1.0, 10.0)).axes[0]
    phase, norm = ax.lines[0].get_data()
    ends = MIX.complex_modulus(2 * np.pi * np.array([1.0, 10.0]))
    assert norm[[0, -1]] == pytest.approx(np.abs(ends) / 1e6)
    assert phase[[0, -1]] == pytest.approx(np.degrees(np.angle(ends)))
    assert "MPa" in ax.get_ylabel()
    assert "°" in ax.get_xlabel()
    assert ax.get_yscale() == "log"


def test_cole_cole_is_loss_against_storage():
    storage, loss = cole_cole([MIX], frequencies=(1.0, 10.0)).axes[0].lines[0].get_data()
    end = MIX.complex_modulus(2 * np.pi * 10.0)
    assert storage[-1] + 1j * loss[-1] == pytest.approx(end / 1e9)


def test_master_curve_of_sweeps_lies_on_its_material():
    figure = draw_master_curve([SWEEPS, MIX], ["isotherms", "Huet-Sayegh"])
    upper, lower = figure.axes[:2]
    points = np.asarray(upper.collections[0].get_offsets())
    exact = np.abs(MIX.complex_modulus(2 * np.pi * points[:, 0])) / 1e6
    # The shifts are found to a thousandth of a decade.
    np.testing.assert_allclose(points[:, 1], exact, rtol=3e-3)
    colours = upper.collections[0].get_array()
    assert set(colours) == {5.0, 15.0, 25.0}
    # Warm points lie at slow reduced frequencies.
    assert points[colours == 25.0, 0].max() < points[colours == 5.0, 0].max()
    grey = upper.lines[0].get_xdata()
    assert (grey.min(), grey.max()) == pytest.approx((0.1, 25.0))
    # The model is drawn over the data's range, the bar of temperatures once.
    line = upper.lines[-1].get_xdata()
    assert (line[0], line[-1]) == pytest.approx((points[:, 0].min(), points[:, 0].max()))
    assert sum(ax.get_label() == "<colorbar>" for ax in figure.axes) == 1
    assert "phase" in lower.get_ylabel()
    assert png(figure).startswith(b"\x89PNG")


def test_master_curve_of_relaxation_tests():
    figure = draw_master_curve([TESTS, MIX, TESTS.isotherms[1]], ["tests", "model", "at 15 °C"])
    points = np.asarray(figure.axes[0].collections[0].get_offsets())
    np.testing.assert_allclose(points[:, 1], MIX.relaxation_modulus(points[:, 0]) / 1e6, rtol=3e-3)
    assert "reduced time" in figure.axes[0].get_xlabel()


def test_a_model_alone_is_drawn_where_its_modulus_changes():
    frequency = draw_master_curve(Prony(1e9, ((0.9, 1.0),), 0.4)).axes[0].lines[0].get_xdata() * 2 * np.pi
    # A single relaxation of 1 s: a decade or two about 1 rad/s, and no more.
    assert 1e-3 < frequency[0] < 0.1
    assert 1.0 < frequency[-1] < 100.0


def test_shift_factors_of_data_and_laws():
    figure = shift_factors([SWEEPS, LAW, SWEEPS.shift], ["isotherms", "WLF", "table"], temperatures=(0.0, 30.0))
    points, law, table = figure.axes[0].lines[:3]
    assert points.get_ydata() == pytest.approx(np.log10(LAW.factor([5.0, 15.0, 25.0])), abs=5e-3)
    assert law.get_ydata()[0] == pytest.approx(float(np.log10(LAW.factor(0.0))))
    # The table ends where it was measured.
    held = table.get_xdata()[np.isfinite(table.get_ydata())]
    assert (held.min(), held.max()) == pytest.approx((5.0, 25.0), abs=0.15)


def test_axes_of_the_caller_are_used():
    figure = Figure()
    ax = figure.add_subplot()
    assert black_diagram(MIX, ax=ax) is figure
    assert len(ax.lines) == 1


@pytest.mark.parametrize(
    ("draw", "word"),
    [
        (lambda: black_diagram([MIX], ["a", "b"]), "2 labels for 1 curves"),
        (lambda: black_diagram([]), "for 0 curves"),
        (lambda: black_diagram(MIX, frequencies=(1.0, 0.1)), "frequencies"),
        (lambda: cole_cole(TESTS), "no complex modulus"),
        (lambda: draw_master_curve([TESTS, SWEEPS]), "no common axis"),
        (lambda: draw_master_curve([SWEEPS, master_curve(SWEEPS.isotherms, 20.0)]), "15 and 20 °C"),
        (lambda: shift_factors(LAW), "give temperatures"),
        # Drawn as an empty figure before.
        (
            lambda: draw_master_curve(tl.catalogue.materials["ViscoRoute"].material),
            r"take it at a temperature: .at\(15\)",
        ),
        (lambda: cole_cole(tl.Elastic(1e9, 0.3)), "draw a viscoelastic material"),
    ],
)
def test_bad_input(draw, word):
    with pytest.raises(InputError, match=word):
        draw()
