"""Figures of layered roads: lines at the interfaces, names beside them, jumps of strain, places under the tire."""

from __future__ import annotations

import json
from itertools import pairwise

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import FRICTIONLESS, Layer, Pavement
from treadload.plots import both_sides, depth_slice, places_under, png, strain_profiles
from treadload.plots.kit.layers import Layers, _apart
from treadload.response import Response, UniformDisc, solve_response
from treadload.results import open_results, save_results, to_tree

DEPTHS = [0.0, 0.02, 0.04, 0.06, 0.1, 0.15, 0.21, 0.3]
X = np.linspace(-0.2, 0.2, 9)


def _road(bond=FRICTIONLESS) -> Pavement:
    return Pavement(
        [
            Layer(Elastic(7e9, 0.35), 0.06, name="wearing course", bond=bond),
            Layer(Elastic(9e9, 0.35), 0.15, name="base"),
            Layer(Elastic(120e6, 0.35), name="subgrade"),
        ]
    )


def _slice(side="above", **points) -> xr.Dataset:
    disc = UniformDisc(radius=0.1, pressure=0.8e6)
    points = points or {"x": X, "y": [0.0]}
    return solve_response([disc], _road(), depths=DEPTHS, side=side, **points).dataset


@pytest.fixture(scope="module")
def above() -> xr.Dataset:
    return _slice()


@pytest.fixture(scope="module")
def below() -> xr.Dataset:
    return _slice("below")


def _interfaces(ax) -> list[float]:
    return [float(line.get_ydata()[0]) for line in ax.lines if line.get_gid() == "interface"]


def _names(ax) -> list[str]:
    return [t.get_text() for t in ax.texts if t.get_gid() == "layer"]


def _meshes(ax) -> list[QuadMesh]:
    return [c for c in ax.collections if isinstance(c, QuadMesh)]


@pytest.mark.parametrize("along", ["travel", "across"])
def test_section_has_a_line_at_each_interface_and_the_layers_names(above, along):
    if along == "across":
        above = _slice(x=[0.0], y=X)
    figure = depth_slice(above, along)
    ax = figure.axes[0]
    assert _interfaces(ax) == [pytest.approx(60), pytest.approx(210)]
    assert _names(ax) == ["wearing course\n60 mm", "base\n150 mm", "subgrade"]
    assert ax.get_ylim() == (pytest.approx(300), pytest.approx(0))
    assert ax.get_aspect() == 1


def test_section_shows_only_the_layers_that_it_reaches(above):
    figure = depth_slice(above.sel(depth=slice(0, 0.1)))
    assert _interfaces(figure.axes[0]) == [pytest.approx(60)]
    assert len(_names(figure.axes[0])) == 2


def test_half_space_has_neither_lines_nor_names():
    road = Pavement.half_space(Elastic(5e9, 0.35))
    response = solve_response([UniformDisc(radius=0.1, pressure=1e6)], road, depths=[0, 0.1], x=X, y=[0.0])
    ax = response.plot.depth_slice().axes[0]
    assert _interfaces(ax) == _names(ax) == []


def test_colours_never_run_across_an_interface(above):
    meshes = _meshes(depth_slice(above).axes[0])
    reach = [(float(m.get_coordinates()[0, 0, 1]), float(m.get_coordinates()[-1, 0, 1])) for m in meshes]
    assert reach == [(0, pytest.approx(60)), (pytest.approx(60), pytest.approx(210)), (pytest.approx(210), 300)]
    # The base begins with its own first depth, 100 mm, not with the wearing course's last.
    base = np.reshape(meshes[1].get_array(), (-1, len(X)))
    np.testing.assert_allclose(base[0], above.principal_strain_1.sel(depth=0.1).values[0] * 1e6)


def test_strokes_stay_in_their_layer(above, below):
    figure = depth_slice(both_sides(above, below))
    lines = next(c for c in figure.axes[0].collections if c.get_gid() == "strokes")
    assert isinstance(lines, LineCollection)
    ends = np.array(lines.get_segments())[..., 1]
    assert len(ends)
    for depth in (60.0, 210.0):
        assert not ((ends.min(axis=1) < depth - 1e-9) & (ends.max(axis=1) > depth + 1e-9)).any()


def test_layer_without_a_depth_is_hatched_instead_of_painted(above):
    figure = depth_slice(above.sel(depth=[0.0, 0.02, 0.3]))
    hatched = [p for p in figure.axes[0].patches if p.get_gid() == "unknown"]
    assert [p.get_y() for p in hatched] == [pytest.approx(60)]
    assert [p.get_height() for p in hatched] == [pytest.approx(150)]


@pytest.mark.parametrize("depths", [[1e-300, 1e-300], [-0.2, -0.1], [-0.1, 0.0]])
def test_section_without_an_extent_in_the_road_is_refused(above, depths):
    flat = above.isel(depth=[0, 1]).assign_coords(depth=depths)
    with pytest.raises(InputError, match=f"depths that differ and lie in the road, .* {depths[0]:g} to"):
        depth_slice(flat)


def test_labels_of_thin_layers_do_not_overlap():
    data = _slice()
    ends = np.array([0.002, 0.004, 0.006, 0.1])
    names = ["a very long name of a thin surface dressing", "", "tack coat", "base", "soil"]
    data.attrs |= {"interfaces": ends, "layer_names": json.dumps(names)}
    figure = depth_slice(data)
    # The figure's own resolution, so that the boxes measured are those drawn.
    png(figure, dpi=100)
    found = [t for t in figure.axes[0].texts if t.get_gid() == "layer"]
    assert [t.get_text().split(",")[0] for t in found[1:3]] == ["layer 2", "tack coat"]
    assert all("2 mm" in t.get_text() for t in found[:3])
    boxes = sorted(((b.y0, b.y1) for b in (mpl.text.Text.get_window_extent(t) for t in found)), reverse=True)
    for upper, lower in pairwise(boxes):
        # Half a point of two neighbouring boxes' paper may touch.
        assert upper[0] >= lower[1] - 0.5


def test_labels_move_no_further_than_they_must():
    placed = _apart(np.array([10.0, 12.0, 80.0]), np.array([10.0, 10.0, 10.0]), 100.0)
    np.testing.assert_allclose(placed, [10, 20, 80])
    placed = _apart(np.array([95.0, 97.0]), np.array([10.0, 10.0]), 100.0)
    np.testing.assert_allclose(placed, [85, 95])


def test_depth_on_an_interface_belongs_above_and_its_second_row_below(above, below):
    layers = Layers.of(above)
    down = above.depth.values * 1e3
    assert [down[rows][-1] for rows in layers.pieces(down)] == [pytest.approx(v) for v in (60, 210, 300)]
    joined = both_sides(above, below)
    rows = layers.pieces(joined.depth.values * 1e3)
    np.testing.assert_allclose(joined.depth.values[rows[1]], [0.06, 0.1, 0.15, 0.21])
    np.testing.assert_allclose(joined.strain_xx.values[rows[1]][0], below.strain_xx.sel(depth=0.06).values)
    np.testing.assert_allclose(joined.strain_xx.values[rows[0]][-1], above.strain_xx.sel(depth=0.06).values)
    with pytest.raises(InputError, match="same x and y"):
        both_sides(above, below.isel(x=slice(1, None)))


def test_a_lone_row_on_an_interface_is_drawn_on_the_side_it_was_solved_for(above, below):
    assert [data.attrs["side"] for data in (above, below)] == ["above", "below"]
    down = below.depth.values * 1e3
    assert [down[rows][0] for rows in Layers.of(below).pieces(down)] == [pytest.approx(v) for v in (0, 60, 210)]
    ends = {}
    for data in (above, below):
        meshes = [one for one in depth_slice(data).axes[0].collections if isinstance(one, QuadMesh)]
        base = meshes[1].get_array().reshape(-1, len(X))
        ends[data.attrs["side"]] = base[0], base[-1]
    strain = {side: data.principal_strain_1[:, 0].values * 1e6 for side, data in (("above", above), ("below", below))}
    # The base from 60 to 210 mm: its ends are rows on interfaces where they are its own, else the next row's.
    np.testing.assert_allclose(ends["above"], [strain["above"][4], strain["above"][6]])
    np.testing.assert_allclose(ends["below"], [strain["below"][3], strain["below"][5]])


def test_strain_jumps_at_a_sliding_interface(above, below):
    figure = strain_profiles(both_sides(above, below), {"middle": (0.0, 0.0)}, strains=("xx",))
    ax = figure.axes[0]
    curves = [line for line in ax.lines if line.get_gid() is None and len(line.get_xdata()) > 2]
    upper, base = curves[0], curves[1]
    middle = {"x": 4, "y": 0}
    assert upper.get_xdata()[-1] == pytest.approx(float(above.strain_xx.sel(depth=0.06)[middle]) * 1e6)
    assert base.get_xdata()[0] == pytest.approx(float(below.strain_xx.sel(depth=0.06)[middle]) * 1e6)
    # Without friction the wearing course bends on its own: stretched below, the base squeezed above.
    assert upper.get_xdata()[-1] > 0 > base.get_xdata()[0]
    joints = [line for line in ax.lines if len(line.get_xdata()) == 2 and np.ptp(line.get_ydata()) == 0]
    joint = next(line for line in joints if line.get_gid() is None)
    np.testing.assert_allclose(joint.get_xdata(), [upper.get_xdata()[-1], base.get_xdata()[0]])


def test_profiles_have_a_panel_for_each_strain_and_a_colour_for_each_place(above):
    places = {"centre": (0.0, 0.0), "edge": (0.1, 0.0)}
    figure = strain_profiles(above, places, epsilon_6=90e-6)
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert titles == ["Along travel", "Across travel", "Largest tensile strain"]
    assert {ax.get_xlabel() for ax in figure.axes} == {"microstrain"}
    assert [t.get_text() for t in figure.legends[0].get_texts()] == [
        "centre: x = 0.0, y = 0.0 mm",
        "edge: x = 100.0, y = 0.0 mm",
    ]
    drawn = next(line for line in figure.axes[1].lines if line.get_label() == "edge")
    values = above.strain_yy.isel(y=0).sel(x=0.1, method="nearest").values * 1e6
    np.testing.assert_allclose(drawn.get_xdata(), values[:4])
    assert _interfaces(figure.axes[0]) == [pytest.approx(60), pytest.approx(210)]
    assert len(_names(figure.axes[2])) == 3
    words = [[t.get_text() for t in ax.texts] for ax in figure.axes]
    assert "ε₆ = 90" in words[2]
    assert "ε₆ = 90" not in words[0]


def test_places_of_profiles_come_from_the_load_on_the_surface(above):
    labels = [t.get_text() for t in strain_profiles(above).legends[0].get_texts()]
    # A disc of 100 mm touches the points up to 100 mm from its centre.
    assert labels == ["tire's centre: x = 0.0, y = 0.0 mm", "rib's edge: x = 0.0, y = 0.0 mm"]


def _contact() -> xr.Dataset:
    """Three ribs across travel, the right one loaded most, and a lateral groove over the middle."""
    pressure = np.zeros((11, 7))
    for rows, value in ((slice(0, 3), 4e5), (slice(4, 7), 5e5), (slice(8, 11), 7e5)):
        pressure[rows, 1:6] = value
    pressure[:, 3] *= 0.1
    pressure[:, 5] *= 0.9
    return xr.Dataset(
        {"pressure": (("y", "x"), pressure)}, {"y": np.arange(-5, 6) * 0.01, "x": np.arange(-3, 4) * 0.01}
    )


def test_places_under_the_tire_are_told_by_its_pressure():
    places = places_under(_contact())
    assert list(places) == ["tire's centre", "rib's middle", "rib's edge"]
    # The centre of pressure lies over a lateral groove: the line lies beside it.
    assert [x for x, _ in places.values()] == [pytest.approx(-0.01)] * 3
    assert places["tire's centre"][1] == pytest.approx(0.01)
    assert places["rib's middle"][1] == pytest.approx(0.04)
    assert places["rib's edge"][1] == pytest.approx(0.05)
    with pytest.raises(InputError, match="nothing presses"):
        places_under(_contact() * 0)
    with pytest.raises(InputError, match="depth 0"):
        places_under(_slice().isel(depth=slice(1, None)))


@pytest.mark.parametrize("noise", [0.0, 1e-9, -1e-9])
def test_round_off_does_not_choose_a_place(noise):
    """Of two mirrored ribs the one at positive y is named, whichever is larger by round-off."""
    contact = _contact()
    contact["pressure"] = 0.5 * (contact.pressure + contact.pressure.to_numpy()[::-1])
    contact.pressure[:3] *= 1 + noise
    places = places_under(contact)
    assert [round(1e3 * y) for _, y in places.values()] == [0, 40, 50]


def test_wrong_requests_are_refused(above):
    with pytest.raises(InputError, match="strains must be of xx, yy"):
        strain_profiles(above, {"a": (0, 0)}, strains=("xy",))
    with pytest.raises(InputError, match="at least one place"):
        strain_profiles(above, {})
    with pytest.raises(InputError, match="two depths"):
        strain_profiles(above.isel(depth=[0]), {"a": (0, 0)})


def test_figures_of_a_file_equal_those_of_the_response(above, tmp_path):
    """A file turns one interface into a number; the lines stay."""
    one = above.copy()
    one.attrs["interfaces"] = np.array([0.06])
    one.attrs["layer_names"] = json.dumps(["asphalt", ""])
    save_results(to_tree([Response(one)]), tmp_path / "one.nc")
    read = open_results(tmp_path / "one.nc").slice_along.dataset
    figure = depth_slice(read)
    assert isinstance(figure, Figure)
    assert _interfaces(figure.axes[0]) == [pytest.approx(60)]
    assert _names(figure.axes[0]) == ["asphalt\n60 mm", "layer 2"]
