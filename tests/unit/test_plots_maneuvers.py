"""Figures of maneuvers: roses of crack traces, bars of orientations, the picture of tearing."""

import math

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.patches import Rectangle

import treadload as tl
from treadload.damage import crack_rose, envelope
from treadload.plots import orientation_shares, png, tearing, trace_rose
from treadload.plots.kit.style import ORIENTATION_COLOURS

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


@pytest.fixture(scope="module")
def turn():
    tire = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5))
    state = tl.contact.Maneuver.turning(12.0, 20 / 3.6).rolling(32.5e3, 0.7)
    contact = tl.solve_contact(tire, ROAD, state, spacing=0.012)
    return contact, tl.solve_response(contact, ROAD, depths=[0.0, 0.01])


def cracks(angles, dips=None, strain=100e-6):
    """Cracks of equal weight at these angles and dips, degrees."""
    dips = [90.0] * len(angles) if dips is None else dips
    return xr.Dataset(
        {
            "extension_strain": ("y", np.full(len(angles), strain)),
            "crack_angle": ("y", np.radians(angles)),
            "crack_dip": ("y", np.radians(dips)),
        },
        {"y": 0.01 * np.arange(len(angles))},
    )


def wedges(figure, number=0):
    """Middle angle, width, area over the square of its angle, colour of the wedges that are not empty."""
    found = []
    for bars in figure.axes[number].containers:
        if all(bar.get_gid() == "wedges" for bar in bars):
            for bar in bars:
                if bar.get_height() > 0:
                    middle = math.degrees(bar.get_x() + bar.get_width() / 2)
                    found.append((round(middle, 6), bar.get_height() ** 2, mpl.colors.to_hex(bar.get_facecolor())))
    return found


def texts(figure):
    return "\n".join(t.get_text() for t in figure.findobj(mpl.text.Text))


def test_the_area_of_a_wedge_is_the_share_of_its_angles():
    figure = trace_rose(crack_rose(cracks([0.0, 0.0, 0.0, 40.0]), classes=18))
    # Bars are drawn twice, half a turn apart, for the class at 90°; half a circle of it is in sight.
    seen = [w for w in wedges(figure) if -90 <= w[0] <= 90]
    assert seen == [
        (0.0, pytest.approx(0.75), ORIENTATION_COLOURS[1]),
        (40.0, pytest.approx(0.25), ORIENTATION_COLOURS[3]),
    ]


def test_a_crack_across_stands_at_both_ends_of_the_half_circle():
    figure = trace_rose(crack_rose(cracks([90.0, 90.0]), classes=18))
    assert sorted(wedges(figure)) == [
        (-90.0, pytest.approx(1.0), ORIENTATION_COLOURS[2]),
        (90.0, pytest.approx(1.0), ORIENTATION_COLOURS[2]),
    ]
    axes = figure.axes[0]
    assert (axes.get_thetamin(), axes.get_thetamax()) == (-90, 90)
    # Right of travel is down the page, as in the maps.
    assert axes.get_theta_direction() == -1
    assert axes.get_theta_offset() == 0


def test_the_rose_says_what_it_shows():
    roses = [
        crack_rose(cracks([10.0, 20.0, 0.0, 0.0], [90.0, 90.0, 5.0, 90.0]), classes=18, threshold=24e-6),
        crack_rose(cracks([0.0], strain=1e-6), classes=18, threshold=24e-6),
    ]
    said = texts(trace_rose(roses, ["some", "none"]))
    assert "and 25 % horizontal" in said
    assert "no crack that far" in said
    assert "share of the road with tensile strain beyond 24 microstrain" in said
    assert "travel" in said
    assert "45° right" in said


def test_a_law_weighs_damage():
    line = tl.FatigueLine(120e-6, -0.2)
    rose = crack_rose(cracks([0.0, 90.0]), weight="damage", law=line)
    assert "share of the damage of a pass" in texts(trace_rose(rose))


def test_bars_are_the_shares_of_orientation():
    rose = crack_rose(cracks([0.0, 0.0, 45.0, 90.0], [90.0, 90.0, 90.0, 2.0]))
    figure = orientation_shares([rose], ["case"], notes=["217 microstrain"])
    bars = [b for b in figure.axes[0].patches if isinstance(b, Rectangle)]
    shares = {mpl.colors.to_hex(b.get_facecolor()): b.get_width() for b in bars}
    assert shares == {
        ORIENTATION_COLOURS[1]: pytest.approx(0.5),
        ORIENTATION_COLOURS[3]: pytest.approx(0.25),
        ORIENTATION_COLOURS[2]: 0.0,
        ORIENTATION_COLOURS[4]: pytest.approx(0.25),
    }
    assert sum(b.get_width() for b in bars) == pytest.approx(1)
    assert "217 microstrain" in texts(figure)


def test_the_rose_of_a_verdict_counts_a_fifth_of_its_largest(turn):
    verdict = tl.assess(turn[1], tl.FatigueLine(120e-6, -0.2))
    figure = verdict.plot.rose()
    by_hand = crack_rose(verdict.dataset, threshold=0.2 * float(verdict.dataset.worst_strain), classes=18)
    drawn = sum(area for angle, area, _ in wedges(figure) if -85 < angle < 85 or angle == 90)
    assert drawn == pytest.approx(float(by_hand.trace_share.sum()))
    png(figure, dpi=40)


def test_work_of_sliding_of_a_strip(turn):
    contact, response = turn
    figure = tearing(contact, response, title="roundabout")
    left = figure.axes[0]
    beside = next(ax for ax in left.child_axes if "J/m²" in ax.get_xlabel())
    strips = next(p for p in beside.patches if isinstance(p, mpl.patches.StepPatch)).get_data()
    d = contact.dataset
    # The work of all strips is that of the whole wheel over a metre, and cells are 12 mm.
    assert strips.values.sum() * 0.012 == pytest.approx(float(d.friction_work_total), rel=1e-9)
    np.testing.assert_allclose(strips.edges, np.append(d.y - 0.006, d.y[-1] + 0.006) * 1e3)
    assert "roundabout" in texts(figure)
    png(figure, dpi=40)


def test_largest_extension_of_a_strip_is_the_envelope(turn):
    contact, response = turn
    figure = tearing(contact, response, depth=0.01)
    beside = next(ax for ax in figure.axes[1].child_axes if ax.get_title(loc="left") == "Largest of each strip")
    strips = next(p for p in beside.patches if isinstance(p, mpl.patches.StepPatch)).get_data()
    expected = envelope(response).extension_strain.sel(depth=0.01) * 1e6
    np.testing.assert_allclose(strips.values, expected)


def test_the_horizontal_plane_is_another_reading(turn):
    contact, response = turn
    figure = tearing(contact, response, strain="in-plane")
    beside = next(ax for ax in figure.axes[1].child_axes if ax.get_title(loc="left") == "Largest of each strip")
    strips = next(p for p in beside.patches if isinstance(p, mpl.patches.StepPatch)).get_data()
    expected = np.maximum(envelope(response, strain="in-plane").extension_strain.sel(depth=0.0), 0.0) * 1e6
    np.testing.assert_allclose(strips.values, expected)
    assert "horizontal" in figure.axes[1].get_title(loc="left")


def test_a_parking_turn_shows_its_shear(turn):
    contact = turn[0]
    standing = tl.Rolling(normal_load=32.5e3, friction=0.7)
    parked = tl.contact.turn_on_the_spot(contact.tire, ROAD, standing, angles=[0.3], spacing=0.012)
    figure = tearing(parked.contact, tl.solve_response(parked.contact, ROAD, depths=[0.0]))
    assert any(ax.get_xlabel() == "kPa" for ax in figure.axes[0].child_axes)


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (lambda c, r: trace_rose([]), "0 labels for 0 roses"),
        (lambda c, r: trace_rose(crack_rose(cracks([0.0])), ["a", "b"]), "2 labels for 1 roses"),
        (lambda c, r: trace_rose(c), "needs trace_share"),
        (lambda c, r: orientation_shares([crack_rose(cracks([0.0]))], ["a"], notes=[]), "0 notes for 1 cases"),
        (lambda c, r: tearing(r, r), "needs pressure"),
        (lambda c, r: tearing(c, r, depth=0.5), "no depth 0.5 m"),
        (lambda c, r: tearing(c, tl.solve_response(c, ROAD, depths=[0.0], y=[0.0])), "other y coordinates"),
    ],
)
def test_bad_input_is_named(turn, draw, words):
    with pytest.raises(tl.InputError, match=words):
        draw(*turn)
