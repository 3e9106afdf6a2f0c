"""Figures that examples lean on: panels of value and direction, creep curves, one style for all."""

from __future__ import annotations

import ast
import math
from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.errors import InputError
from treadload.plots import creep_curves, png
from treadload.plots.kit.style import house_style
from treadload.plots.panels import direction_class, strain_panels

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").rglob("*.py"))
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


@pytest.fixture(scope="module")
def response() -> tl.response.Response:
    x = 5e-3 * (np.arange(24) - 11.5)
    tire = tl.Tire.from_height_map((x[None, :] ** 2 + x[:, None] ** 2) / 0.8, 5e-3, material=tl.Elastic(3e6, 0.5))
    contact = tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=400.0, friction=0.7, tractive_force=150.0))
    return tl.solve_response(contact, ROAD, depths=[0.0, 0.01])


@pytest.mark.parametrize("strain", ["principal", "in-plane"])
def test_panels_show_the_value_above_and_the_direction_below(response, strain):
    figure = strain_panels(response, 0.0, strain)
    upper, lower, *_ = figure.axes
    name = "principal_strain_1" if strain == "principal" else "in_plane_strain_1"
    values = response.dataset[name].sel(depth=0.0).to_numpy() * 1e6
    mesh = upper.collections[0]
    np.testing.assert_allclose(np.ma.filled(mesh.get_array(), np.nan).ravel(), values.ravel())
    assert not [one for one in upper.collections if one.get_gid() == "strokes"]
    (lines,) = [one for one in lower.collections if one.get_gid() == "strokes"]
    assert len(lines.get_segments()) > 100
    for ax in (upper, lower):
        assert ax.get_aspect() == 1
        assert ax.get_xlim() == upper.get_xlim()
        # The right of travel lies below, as in every map.
        assert ax.get_ylim()[0] > ax.get_ylim()[1]
    assert png(figure)


def test_strokes_of_the_panel_lie_along_the_extension():
    # Extension across travel on the left half of a road, along it on the right one.
    x, y = np.linspace(-0.05, 0.05, 20), np.linspace(-0.05, 0.05, 20)
    angle = np.where(x > 0, 0.0, math.pi / 2)[None, :] * np.ones((20, 1))
    data = xr.Dataset(
        {"in_plane_strain_1": (("y", "x"), np.full((20, 20), 1e-4)), "in_plane_angle_1": (("y", "x"), angle)},
        coords={"x": x, "y": y},
    )
    figure = strain_panels(data, strain="in-plane")
    (lines,) = [one for one in figure.axes[1].collections if one.get_gid() == "strokes"]
    segments = np.array(lines.get_segments())
    along = np.abs(np.diff(segments, axis=1)[:, 0])
    right = segments.mean(axis=1)[:, 0] > 0
    assert (along[right, 1] < 1e-9).all()
    assert (along[~right, 0] < 1e-9).all()
    names = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert names == ["along travel", "across travel"]


def test_ways_of_directions():
    angles = np.radians([0, 10, 45, 80, 90, 180])
    assert direction_class(np.cos(angles), np.sin(angles)).tolist() == [0, 0, 1, 2, 2, 0]
    assert direction_class(np.array([0.1]), np.array([0.1])).tolist() == [3]


def test_panels_without_extension_say_so(response):
    pressed = response.dataset.assign(principal_strain_1=-abs(response.dataset.principal_strain_1) - 1e-9)
    assert png(strain_panels(pressed))
    with pytest.raises(InputError, match="no depth"):
        strain_panels(response, depth=0.5)


def _curve(slope: float) -> xr.Dataset:
    creepage = np.array([-0.1, -0.06, -0.03, -0.015, 0.0, 0.015, 0.03, 0.06, 0.1])
    return xr.Dataset(
        {
            "lateral_force": ("creepage", -slope * creepage),
            "tractive_force": ("creepage", -slope * creepage),
            "aligning_moment": ("creepage", slope * creepage),
            "slip_fraction": ("creepage", abs(creepage)),
        },
        coords={"creepage": creepage, "friction": 0.7, "normal_load": 3e4},
    )


@pytest.mark.parametrize("along", ["x", "y"])
def test_ticks_of_creepage_stand_clear_of_each_other(along):
    figure = creep_curves([_curve(1e5)], ["a"], along=along)
    # As it is saved: matplotlib chooses ticks by the settings of the moment.
    with house_style():
        figure.draw_without_rendering()
        for ax in figure.axes:
            low, high = ax.get_xlim()
            labels = zip(ax.get_xticklabels(), ax.get_xticks(), strict=True)
            boxes = [label.get_window_extent() for label, at in labels if low <= at <= high]
            assert len(boxes) >= 3
            for left, right in pairwise(boxes):
                # A letter's width between two.
                assert left.x1 + 6 < right.x0


def test_equal_creep_curves_are_both_seen():
    figure = creep_curves([_curve(1e5), _curve(2e5), _curve(1e5)], ["a", "b", "c"])
    for ax in figure.axes:
        curves = [line for line in ax.lines if len(line.get_xdata()) > 2]
        widths = [line.get_linewidth() for line in curves]
        # The later on top and thinner, the last one broken: what lies under it shows on both sides and between.
        assert widths == sorted(widths, reverse=True)
        assert widths[0] > 2 * widths[-1]
        assert curves[-1].is_dashed()
        assert curves[-1].get_zorder() > curves[0].get_zorder()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_draw_in_the_style_of_the_house(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imported = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    # pyplot would draw with the reader's own settings, and keep every figure open.
    assert "matplotlib.pyplot" not in imported
    calls = {
        node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
    }
    assert "Figure" not in calls
    if "new_figure" in calls:
        drawing = [
            node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and "new_figure" in ast.unparse(node)
        ]
        assert all("styled" in map(ast.unparse, node.decorator_list) for node in drawing)
    assert plt.get_fignums() == []


def test_no_truck_rolls_at_the_speed_of_a_jet():
    import runpy

    found = runpy.run_path(str(next(path for path in EXAMPLES if path.stem == "rolling_resistance")))
    assert max(found["SPEEDS"]) * 3.6 <= 150
