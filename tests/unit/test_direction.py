"""The worst instant of a passage and the rose of the traces, on fields whose cracks are known."""

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload import variables
from treadload.damage import FatigueLine, assess, crack_rose, envelope
from treadload.damage.cracks import ORIENTATIONS
from treadload.errors import InputError
from treadload.response.fields import response_dataset

LINE = FatigueLine(120e-6, -0.2)


def passage(strain, x=None, y=None):
    """Response at depth 0 with the strain (6, ny, nx)."""
    strain = np.asarray(strain)[:, None]
    _, _, ny, nx = strain.shape
    x = 0.1 * np.arange(nx) if x is None else x
    y = 0.2 * np.arange(ny) if y is None else y
    return SimpleNamespace(dataset=response_dataset(1e9 * strain, strain, np.array([0.0]), y, x))


def uniaxial(values, azimuths):
    """Strain (6, ...) of extensions along azimuths from travel to the right, degrees."""
    values, angle = np.asarray(values, dtype=float), np.radians(azimuths)
    c, s = np.cos(angle), np.sin(angle)
    zero = np.zeros_like(values * c)
    return values * np.stack([c * c, s * s, zero, c * s, zero, zero])


def cracks(traces, strains=None, dips=90.0, y=None):
    """Cracks over y with traces and dips in degrees."""
    traces = np.asarray(traces, dtype=float)
    strains = np.full(traces.shape, 1e-4) if strains is None else np.asarray(strains, dtype=float)
    fields = {
        "extension_strain": (("y",), strains),
        "crack_angle": (("y",), np.radians(traces)),
        "crack_dip": (("y",), np.radians(np.broadcast_to(np.asarray(dips, dtype=float), traces.shape))),
    }
    return variables.dataset(fields, {"y": np.arange(len(traces)) if y is None else y})


def shares(found):
    return dict(zip(ORIENTATIONS[1:], found["orientation_share"].to_numpy(), strict=True))


def test_the_worst_instant_of_two_histories():
    # The first point extends most along travel before the wheel, the second across travel behind it.
    strain = uniaxial([[1e-5, 3e-5, 2e-5, 1e-5], [0.0, 1e-5, 5e-5, 4e-5]], [[0, 0, 90, 90], [0, 0, 90, 45]])
    seen = envelope(passage(strain))
    # Round-off of an eigenvalue.
    np.testing.assert_allclose(seen["extension_strain"], [[3e-5, 5e-5]], rtol=1e-12)
    np.testing.assert_allclose(seen["instant_x"], [[0.1, 0.2]], rtol=1e-15)
    np.testing.assert_allclose(np.degrees(seen["crack_angle"]), [[90, 0]], atol=1e-9)
    np.testing.assert_allclose(np.degrees(seen["crack_dip"]), 90, atol=1e-9)
    np.testing.assert_array_equal(seen["crack_orientation"], [[2, 1]])
    np.testing.assert_allclose(np.abs(seen["extension_direction"][0]), [[1, 0, 0], [0, 1, 0]], atol=1e-12)
    assert set(seen.data_vars) <= set(variables.VARIABLES)
    assert json.loads(seen.attrs["warnings"]) == []


def test_a_passage_that_is_cut_is_said():
    seen = envelope(passage(uniaxial([[3e-5, 2e-5, 1e-5], [1e-5, 2e-5, 1e-5]], np.zeros((2, 3)))))
    (said,) = json.loads(seen.attrs["warnings"])
    assert "1 of 2 points" in said
    assert "solve it further out" in said


def test_nothing_extends_no_crack():
    seen = envelope(
        passage(-uniaxial([[3e-5, 2e-5, 1e-5]], np.zeros((1, 3))) - 1e-6 * np.eye(6)[:3].sum(0)[:, None, None])
    )
    assert np.isnan(seen["crack_angle"]).all()
    assert np.isnan(seen["crack_dip"]).all()
    assert (seen["crack_orientation"] == 0).all()
    found = crack_rose(seen.sel(depth=0))
    assert found["orientation_share"].sum() == 0
    assert found.attrs["weight_total"] == 0


@pytest.mark.parametrize("strain", ["principal", "in-plane"])
def test_a_point_that_stays_while_the_wheel_moves_sees_the_envelope(strain):
    """Independent: the wheel is solved at each of its places and the road looked at in one point."""
    road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    places = np.linspace(-0.25, 0.25, 41)
    y, depths = np.array([0.0, 0.07, 0.1301]), [0.0, 0.02]

    def wheel(x):
        return tl.UniformRectangle(0.2, 0.25, 8e5, x=x, traction_x=-2e5, traction_y=1e5)

    seen = envelope(tl.solve_response(wheel(0.0), road, depths=depths, x=places, y=y), strain=strain)
    name = "principal_strain_1" if strain == "principal" else "in_plane_strain_1"
    history = np.stack(
        [
            tl.solve_response(wheel(place), road, depths=depths, x=[0.0], y=y).dataset[name].to_numpy()[..., 0]
            for place in places
        ]
    )
    # The same closed form at shifted coordinates: round-off of logarithms near the edges.
    np.testing.assert_allclose(seen["extension_strain"], history.max(axis=0), rtol=1e-9)
    # The wheel stands at X when the point stands at -X of its frame.
    np.testing.assert_allclose(seen["instant_x"], -places[history.argmax(axis=0)], atol=1e-12)


def test_the_instant_errs_by_the_square_of_the_spacing():
    centre = 0.0317

    def largest(n):
        x = np.linspace(-1, 1, n)
        strain = uniaxial(1e-4 * np.exp(-((x - centre) ** 2))[None], np.zeros((1, n)))
        return 1e-4 - float(envelope(passage(strain, x=x))["extension_strain"].squeeze())

    # The error is at most (spacing/2)² times half the curvature of 2e-4.
    for n in (21, 81, 321):
        assert largest(n) <= 1.01e-4 * (1 / (n - 1)) ** 2


def test_shares_of_known_cracks():
    found = crack_rose(cracks([0, 10, -14, 90, -80, 45, -45, 20, 0, 30], dips=[90] * 8 + [10, 90]))
    # Ten equal strips; round-off of their sum.
    assert shares(found) == pytest.approx(
        {"longitudinal": 0.3, "transverse": 0.2, "oblique": 0.4, "horizontal": 0.1}, abs=1e-14
    )
    assert float(found["trace_share"].sum()) == pytest.approx(0.9, abs=1e-14)
    # Classes of 15 degrees around their middles: 0 alone, 10 and 20 in that of 15, -80 in that of -75.
    by = {
        round(math.degrees(a)): s
        for a, s in zip(found["trace_angle"].values, found["trace_share"].values, strict=True)
    }
    known = {0: 0.1, 15: 0.2, -15: 0.1, 90: 0.1, -75: 0.1, 45: 0.1, -45: 0.1, 30: 0.1}
    assert {k: v for k, v in by.items() if v} == pytest.approx(known, abs=1e-14)
    assert found.attrs["weight_total"] == pytest.approx(10, abs=1e-12)


def test_travel_to_the_left_and_to_the_right_of_across_are_one_class():
    found = crack_rose(cracks([89.9, -89.9]))
    assert float(found["trace_share"].sel(trace_angle=math.pi / 2, method="nearest")) == pytest.approx(1)


def test_weights_by_damage_and_threshold():
    laid = cracks([0, 90], strains=[120e-6, 60e-6])
    # Half the strain, a 32nd of the damage.
    found = crack_rose(laid, weight="damage", law=LINE)
    assert shares(found)["transverse"] == pytest.approx(1 / 33, rel=1e-12)
    assert found.attrs["weight_total"] == pytest.approx((1 + 1 / 32) * 1e-6, rel=1e-12)
    assert shares(crack_rose(laid, threshold=100e-6))["longitudinal"] == 1


def test_uneven_strips_count_their_width():
    found = crack_rose(cracks([0, 0, 90], y=[0.0, 1.0, 4.0]))
    # Half the distance to each neighbour, the ends as wide as their interval: 1, 2 and 3.
    assert shares(found)["transverse"] == pytest.approx(3 / np.gradient([0.0, 1.0, 4.0]).sum(), rel=1e-12)


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(-89.9, 90), min_size=2, max_size=20), st.integers(1, 12))
def test_shares_add_up_and_mirror(traces, half):
    found, mirrored = (
        crack_rose(cracks(traces), classes=2 * half),
        crack_rose(cracks(-np.array(traces)), classes=2 * half),
    )
    assert float(found["trace_share"].sum()) == pytest.approx(1, abs=1e-12)
    assert float(found["orientation_share"].sum()) == pytest.approx(1, abs=1e-12)
    np.testing.assert_allclose(found["orientation_share"], mirrored["orientation_share"], atol=1e-12)


def test_a_verdict_has_its_rose():
    road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    at = np.linspace(-0.2, 0.2, 10)
    verdict = assess(
        tl.solve_response(tl.UniformRectangle(0.2, 0.2, 8e5), road, depths=[0.1], x=at, y=at),
        LINE,
        depth=0.1,
    )
    found = crack_rose(verdict.dataset, weight="damage", law=LINE)
    assert float(found["orientation_share"].sum()) == pytest.approx(1, abs=1e-12)
    # A square load, and no point at its centre, where all directions are alike: along and across alike.
    assert shares(found)["longitudinal"] == pytest.approx(shares(found)["transverse"], rel=1e-6)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: envelope(passage(np.zeros((6, 2, 1)))), r"got 1 position\(s\); solve it with x from before"),
        (lambda: envelope(passage(np.zeros((6, 2, 3))), strain="plane"), '"principal" or "in-plane", got \'plane\''),
        (lambda: envelope(passage(np.zeros((6, 2, 3))), oblique_tolerance=2.0), r"\(0, π/4\] rad, got 2.0"),
        (lambda: crack_rose(envelope(passage(np.zeros((6, 2, 3))))), r"over depth, y; select one with .sel\(depth"),
        (lambda: crack_rose(cracks([0, 90]), weight="damage"), "needs a law"),
        (lambda: crack_rose(cracks([0, 90]), weight="mass"), '"area" or "damage", got \'mass\''),
        (lambda: crack_rose(cracks([0, 90]), classes=7), "even number of at least 2, got 7"),
        (lambda: crack_rose(cracks([0, 90]), threshold=-1.0), "threshold must be a strain >= 0, got -1.0"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(InputError, match=message):
        make()
