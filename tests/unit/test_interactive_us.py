"""Interactive figures in US units: every number of a figure is converted, and no text keeps an SI unit."""

import base64
import json
import re

import numpy as np
import pint
import pytest

import treadload as tl
from treadload.plots import interactive
from treadload.plots.interactive import Cut
from treadload.plots.interactive.us_figure import in_display_units
from treadload.us_units import display_units

UNITS = pint.UnitRegistry()
INCH, PSI, KSI = (
    UNITS.Quantity(1.0, big).to(small).magnitude for big, small in (("inch", "mm"), ("psi", "kPa"), ("ksi", "MPa"))
)
# Numbers are sent in single precision.
SINGLE = 1e-6


def both(draw):
    """A figure in SI and in US units."""
    si = draw()
    with display_units("us"):
        return si, draw()


def texts_of(figure):
    """All texts of a figure but names of colours and of keys."""
    found = []

    def walk(part, key=""):
        if isinstance(part, dict):
            for name, inner in part.items():
                if name not in ("template", "colorscale"):
                    walk(inner, name)
        elif isinstance(part, list):
            for inner in part:
                walk(inner, key)
        elif isinstance(part, str) and key in ("text", "name", "hovertemplate", "label", "hovertext", "ticktext"):
            found.append(part)

    walk(json.loads(figure.to_json()))
    return found


@pytest.fixture(scope="module")
def drawn(coarse_result):
    """The figures of the coarse case in both units."""
    contact, response, verdict = (getattr(coarse_result, name) for name in ("contact", "response", "verdict"))
    cut = Cut((-0.05, 0.02), (0.06, -0.03))
    deep = tl.solve_response(coarse_result.contact, coarse_result.contact.road, depths=[0.0, 0.01, 0.03, 0.1])
    return {
        "contact": both(lambda: interactive.contact_view(contact).figures["maps"]),
        "tread": both(lambda: interactive.contact_view(contact).figures["tread"]),
        "profile": both(lambda: interactive.profiles(contact, cut)),
        "response": both(lambda: interactive.response_view(response).figures["maps"]),
        "damage": both(lambda: interactive.verdict_view(verdict).figures["maps"]),
        "section": both(lambda: interactive.depth_slice(deep, cut, "von_mises_stress")),
        "marks": both(lambda: interactive.marked(interactive.places_of(contact), 2)),
    }


@pytest.mark.parametrize("name", ["contact", "tread", "profile", "response", "damage", "section", "marks"])
def test_no_text_keeps_an_si_unit(drawn, name):
    si, us = drawn[name]
    unit = re.compile(r"(?<![\w/])(mm|kPa|MPa|GPa|kN)(?![\w/])")
    assert any(unit.search(text) for text in texts_of(si))
    assert [text for text in texts_of(us) if unit.search(text)] == []


def test_maps_are_in_inches_and_psi(drawn):
    si, us = drawn["contact"]
    for old, new in zip(si.data, us.data, strict=True):
        for key in ("x", "y"):
            np.testing.assert_allclose(new[key], np.asarray(old[key]) / INCH, rtol=SINGLE, atol=1e-6)
    old, new = si.data[0], us.data[0]
    np.testing.assert_allclose(new.z, np.asarray(old.z) / PSI, rtol=SINGLE)
    assert new.zmax == pytest.approx(old.zmax / PSI, rel=SINGLE)
    assert new.colorbar.title.text == "contact pressure (psi)"
    assert new.hovertemplate == "x %{x:.3f} in, y %{y:.3f} in<br>%{z:.4~g} psi<extra></extra>"
    assert us.layout.xaxis2.title.text == "x, direction of travel (in)"
    np.testing.assert_allclose(us.layout.xaxis.range, np.asarray(si.layout.xaxis.range) / INCH)
    np.testing.assert_allclose(us.layout.yaxis2.range, np.asarray(si.layout.yaxis2.range) / INCH)
    line, before = us.layout.shapes[0], si.layout.shapes[0]
    for key in ("x0", "x1", "y0", "y1"):
        assert line[key] == pytest.approx(before[key] / INCH)
    # Where it was on the page: titles stand at parts of it, not at places of the map.
    assert [note.x for note in us.layout.annotations] == [note.x for note in si.layout.annotations]


def test_strain_keeps_its_numbers(drawn):
    si, us = drawn["response"]
    np.testing.assert_array_equal(us.data[0].z, si.data[0].z)
    assert [step.label for step in us.layout.sliders[0].steps] == ["0 in", "0.79 in"]
    notes = us.layout.sliders[0].steps[1].args[1]["annotations"]
    assert "0.79 in" in notes[0]["text"]


def test_section_profile_and_tread(drawn):
    si, us = drawn["section"]
    np.testing.assert_allclose(us.data[0].y, np.asarray(si.data[0].y) / INCH)
    # Below 100 MPa a stress is in psi, whichever of kPa and MPa it has in SI.
    unit = {"kPa": PSI, "MPa": PSI / 1e3}[si.data[0].colorbar.title.text]
    np.testing.assert_allclose(us.data[0].z, np.asarray(si.data[0].z) / unit, rtol=SINGLE)
    assert us.data[0].colorbar.title.text == "psi"
    assert us.layout.yaxis.title.text.startswith("depth (in)")
    si, us = drawn["profile"]
    assert us.layout.yaxis.title.text == "psi"
    assert us.layout.xaxis.title.text == (
        "from x = \u22121.97, y = 0.79 in to x = 2.36, y = \u22121.18 in, distance (in)"
    )
    np.testing.assert_allclose(us.data[0].y, np.asarray(si.data[0].y) / PSI, rtol=SINGLE)
    si, us = drawn["tread"]
    for key in ("x", "y", "z"):
        np.testing.assert_allclose(us.data[0][key], np.asarray(si.data[0][key]) / INCH, rtol=SINGLE, atol=1e-6)
    np.testing.assert_allclose(us.data[0].customdata, np.asarray(si.data[0].customdata) / PSI, rtol=SINGLE)
    np.testing.assert_allclose(us.data[0].surfacecolor, np.asarray(si.data[0].surfacecolor) / PSI, rtol=SINGLE)


def test_marks_that_are_added_to_a_map_have_its_units(drawn):
    si, us = drawn["marks"]
    assert us.data[0].x == pytest.approx(np.asarray(si.data[0].x) / INCH)
    assert us.data[0].text[0].endswith(" psi")


def test_what_a_browser_holds_is_in_the_units_of_the_figure(coarse_result):
    (si,), (us,) = both(lambda: interactive.profile_held(coarse_result.contact))
    np.testing.assert_allclose(us["x"], np.asarray(si["x"]) / INCH, atol=1e-5)
    assert us["step"] == pytest.approx(si["step"] / INCH)
    before, after = (np.frombuffer(base64.b64decode(grid["fields"][0]), "<f4") for grid in (si, us))
    np.testing.assert_allclose(after, before / PSI, rtol=SINGLE)


def test_moduli_on_a_logarithmic_axis_with_their_bars():
    trace = {"type": "scatter", "x": [1.0, 2.0], "y": np.array([100.0, 6894.757]), "yaxis": "y2",
             "error_y": {"array": np.array([10.0, 0.0]), "arrayminus": np.array([5.0, 0.0])},
             "hovertemplate": "%{text}<br>%{y:.4~g} MPa<extra></extra>"}  # fmt: skip
    layout = {"xaxis": {"title": {"text": "along the road (m)"}},
              "yaxis2": {"title": {"text": "modulus<br>(MPa)"}, "type": "log", "range": [2.0, 4.0]}}  # fmt: skip
    assert in_display_units([trace], layout) == ([trace], layout)
    with display_units("us"):
        (shown,), page = in_display_units([trace], layout)
    np.testing.assert_allclose(shown["y"], trace["y"] / KSI)
    np.testing.assert_allclose(shown["error_y"]["arrayminus"], trace["error_y"]["arrayminus"] / KSI)
    assert shown["x"] == pytest.approx([1 / 0.3048, 2 / 0.3048])
    assert page["yaxis2"]["range"] == pytest.approx([2 - np.log10(KSI), 4 - np.log10(KSI)])
    assert page["yaxis2"]["title"]["text"] == "modulus<br>(ksi)"
    assert page["xaxis"]["title"]["text"] == "along the road (ft)"
    assert shown["hovertemplate"] == "%{text}<br>%{y:.4~g} ksi<extra></extra>"


def test_temperatures_have_another_zero():
    trace = {"x": [0.0, 10.0], "y": [20.0, None]}
    layout = {"xaxis": {"title": {"text": "time (s)"}}, "yaxis": {"title": {"text": "temperature (°C)"}}}
    with display_units("us"):
        (shown,), page = in_display_units([trace], layout)
    assert shown["y"] == [pytest.approx(68.0), None]
    assert shown["x"] == [0.0, 10.0]
    assert page["yaxis"]["title"]["text"] == "temperature (°F)"
