"""Figures for a browser: what they show is what the result holds, in the units of the house."""

import ast
import os
import re
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.plots import interactive
from treadload.plots.interactive.cut import sampled
from treadload.plots.interactive.section_rows import SectionRows
from treadload.plots.kit.layers import Layers

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


@pytest.fixture(scope="module")
def contact() -> tl.contact.Contact:
    x = 5e-3 * (np.arange(24) - 11.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / 0.8
    gap[10:12] += 0.02
    tire = tl.Tire.from_height_map(gap, 5e-3, material=tl.Elastic(3e6, 0.5))
    return tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=400.0, friction=0.7, tractive_force=100.0))


@pytest.fixture(scope="module")
def response(contact) -> tl.response.Response:
    return tl.solve_response(contact, ROAD, depths=[0.0, 0.01, 0.03])


def traces(figure, kind):
    return [one for one in figure.data if one.type == kind]


def test_a_map_of_the_pressure_holds_the_cells_of_the_contact(contact):
    figure = interactive.linked_maps([interactive.pressure_field(contact), interactive.shear_field(contact)])
    pressure, shear = traces(figure, "heatmap")
    held = contact.dataset.pressure.to_numpy() / 1e3
    # Single precision is what a browser gets.
    np.testing.assert_allclose(np.nan_to_num(pressure.z), held, rtol=1e-6)
    assert np.isnan(pressure.z[held == 0]).all()
    q = np.hypot(contact.dataset.traction_x, contact.dataset.traction_y).to_numpy() / 1e3
    np.testing.assert_allclose(np.nan_to_num(shear.z), q, rtol=1e-6, atol=1e-9)
    # Edges of cells, mm.
    assert pressure.x[0] == pytest.approx(-60)
    assert np.diff(pressure.y) == pytest.approx(5)
    assert pressure.colorbar.title.text == "contact pressure (kPa)"


def test_linked_maps_share_axes_and_scale_and_are_seen_from_above(contact):
    layout = interactive.linked_maps([interactive.pressure_field(contact), interactive.zones_field(contact)]).layout
    assert (layout.xaxis2.matches, layout.yaxis2.matches) == ("x", "y")
    assert (layout.yaxis.scaleanchor, layout.yaxis.scaleratio) == ("x", 1)
    # y, to the right of travel, points down the page.
    assert layout.yaxis.range[0] > layout.yaxis.range[1]


def test_maps_are_laid_out_at_any_width(contact):
    """At 1100 pixels round-off set an axis 2e-16 outside of the page, which plotly refused."""
    fields = [interactive.pressure_field(contact), interactive.shear_field(contact)]
    for width in (320, 560, 733.3, *range(1060, 1140, 7), 1100, 1531.7):
        made = interactive.linked_maps(fields, width=width)
        assert 0 <= made.layout.yaxis.domain[0] < made.layout.yaxis.domain[1] <= 1


def test_arrows_point_as_the_shear_on_the_road(contact):
    field = interactive.shear_field(contact)
    assert len(field.arrows) > 10
    # Driving: the tire pushes the road backwards.
    assert field.arrows[:, 2].mean() < 0
    for x, y, half_x, half_y in field.arrows[:5]:
        here = contact.dataset.sel(x=x / 1e3, y=y / 1e3, method="nearest")
        cross = half_x * float(here.traction_y) - half_y * float(here.traction_x)
        assert abs(cross) < 1e-9 * np.hypot(half_x, half_y) * np.hypot(here.traction_x, here.traction_y)
        assert half_x * float(here.traction_x) + half_y * float(here.traction_y) > 0


def test_strokes_lie_along_the_largest_extension(response):
    field = interactive.extension_field(response, depth=0.01, strain="in-plane")
    plane = response.dataset.sel(depth=0.01)
    assert len(field.strokes)
    for x, y, half_x, half_y in field.strokes[:8]:
        angle = float(plane.in_plane_angle_1.sel(x=x / 1e3, y=y / 1e3, method="nearest"))
        assert abs(half_x * np.sin(angle) - half_y * np.cos(angle)) < 1e-9
    np.testing.assert_allclose(field.values, plane.in_plane_strain_1 * 1e6)


def test_every_map_that_is_offered_can_be_drawn_light_and_dark(contact, response):
    verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2))
    for source in (contact, response, verdict):
        names = interactive.choices(source)
        assert names
        for name in names:
            field = interactive.field_of(source, name)
            assert field.values.shape == (24, 24)
            # Decades and codes have no factor; else the unit is one of the house's.
            assert field.unit in ("kPa", "MPa", "mm", "microstrain", "–", "", "°", "of failure"), name
        for theme in ("light", "dark"):
            interactive.linked_maps([interactive.field_of(source, one) for one in list(names)[:3]], theme=theme)
    with pytest.raises(tl.InputError, match="there is no map of 'presure' here; did you mean 'pressure'"):
        interactive.field_of(contact, "presure")
    with pytest.raises(tl.InputError, match="'light' or 'dark', got 'grey'"):
        interactive.linked_maps([interactive.pressure_field(contact)], theme="grey")


def test_signed_stress_is_drawn_about_zero(response):
    field = interactive.field_of(response, "stress_xx", depth=0.01)
    assert field.scale.low == -field.scale.high
    np.testing.assert_allclose(field.values, response.dataset.stress_xx.sel(depth=0.01) / 1e3)


def test_a_profile_along_travel_is_the_row_of_cells(contact):
    y = float(contact.dataset.y[5])
    figure = interactive.profiles(contact, interactive.Cut.along(contact, y=y))
    pressure = next(one for one in figure.data if one.name == "pressure")
    np.testing.assert_allclose(pressure.x, contact.dataset.x * 1e3, rtol=1e-6)
    np.testing.assert_allclose(pressure.y, contact.dataset.pressure[5] / 1e3, rtol=1e-6)
    assert "y = −32.5 mm" in figure.layout.xaxis.title.text


def test_a_profile_along_any_line_reads_what_lies_below_it():
    """Of a plane, between its points, exactly; of cells, the cell's own value."""
    x, y = np.linspace(-0.1, 0.1, 11), np.linspace(-0.2, 0.2, 9)
    plane = 3 * x[None, :] - 2 * y[:, None] + 1
    at_x, at_y = np.linspace(-0.09, 0.07, 40), np.linspace(0.15, -0.19, 40)
    np.testing.assert_allclose(sampled(plane, x, y, at_x, at_y, smooth=True), 3 * at_x - 2 * at_y + 1, atol=1e-12)
    cells = sampled(plane, x, y, at_x, at_y, smooth=False)
    # Off by half a cell at most in each direction.
    assert np.abs(cells - (3 * at_x - 2 * at_y + 1)).max() <= 3 * 0.01 + 2 * 0.025 + 1e-12
    assert np.isnan(sampled(plane, x, y, np.array([0.2]), np.array([0.0]), smooth=True)).all()


def test_a_section_below_a_line_has_depth_down_the_page(response):
    cut = interactive.Cut.across(response, x=float(response.dataset.x[7]))
    figure = interactive.depth_slice(response, cut)
    (cells,) = traces(figure, "heatmap")
    assert figure.layout.yaxis.autorange == "reversed"
    assert (cells.y[0], cells.y[-1]) == pytest.approx((0, 30))
    # As wide as its place: the axes are not tied to each other.
    assert figure.layout.yaxis.scaleanchor is None
    # Between the points of the map and between depths; at those that lie on one it is that one's.
    held = response.dataset.principal_strain_1[:, :, 7].to_numpy() * 1e6
    places = (np.asarray(cells.x)[1:] + np.asarray(cells.x)[:-1]) / 2
    deep = (np.asarray(cells.y)[1:] + np.asarray(cells.y)[:-1]) / 2
    assert len(deep) == 96
    along = np.stack([np.interp(places, response.dataset.y.to_numpy() * 1e3, row) for row in held])
    wanted = np.stack([np.interp(deep, [0.0, 10.0, 30.0], column) for column in along.T]).T
    np.testing.assert_allclose(np.asarray(cells.z), wanted, rtol=1e-5, atol=1e-4)
    with pytest.raises(tl.InputError, match="needs a cut"):
        interactive.depth_slice(response)
    with pytest.raises(tl.InputError, match="two points that differ"):
        interactive.Cut((0.1, 0.2), (0.1, 0.2))


def test_rows_of_a_section_are_smooth_within_layers_and_end_at_interfaces():
    """A field linear in depth within each layer, with a jump between them, comes back at every row."""
    layers = Layers((60.0,), ("a", "b"))
    depths = np.array([0.0, 20.0, 60.0, 60.0, 100.0])
    field = np.array([1.0, 3.0, 7.0, -5.0, -1.0])
    rows = SectionRows.of(depths, layers)
    assert 60.0 in rows.edges
    middle = (rows.edges[1:] + rows.edges[:-1]) / 2
    wanted = np.where(middle < 60, 1 + middle / 10, -5 + (middle - 60) / 10)
    np.testing.assert_allclose(rows.between(field), wanted, atol=1e-12)
    # No row mixes the layers, also where the interface itself has no depth: the nearest depth of the layer holds.
    rows = SectionRows.of(np.array([0.0, 50.0, 100.0]), layers)
    middle = (rows.edges[1:] + rows.edges[:-1]) / 2
    values = rows.between(np.array([0.0, 5.0, 9.0]))
    np.testing.assert_allclose(values, np.where(middle < 60, np.minimum(middle, 50) / 10, 9.0), atol=1e-12)
    # A browser makes the same rows.
    low, high, share = (np.array(part) for part in zip(*rows.as_lists(), strict=True))
    assert low.dtype == high.dtype == int
    np.testing.assert_allclose(share, rows.share, atol=1e-6)


def test_a_measured_footprint_lies_over_map_and_profile(contact):
    view = interactive.contact_view(contact, measured=contact)
    names = [one.name for one in view.figures["maps"].data]
    assert "outline measured" in names
    assert "measured" in [one.name for one in view.figures["profile"].data]


def test_the_difference_of_two_results_has_one_scale(contact):
    other = tl.solve_contact(contact.tire, ROAD, tl.Rolling(normal_load=300.0, friction=0.7))
    first, second, less = traces(interactive.difference_map(contact, other, labels=("driving", "free")), "heatmap")
    assert (first.zmin, first.zmax) == (second.zmin, second.zmax)
    assert less.zmin == -less.zmax
    wanted = (contact.dataset.pressure - other.dataset.pressure).to_numpy() / 1e3
    np.testing.assert_allclose(np.nan_to_num(less.z), wanted, atol=1e-3)


def test_a_difference_on_other_cells_keeps_the_load(contact):
    x = 3e-3 * (np.arange(40) - 19.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / 0.8
    fine = tl.solve_contact(
        tl.Tire.from_height_map(gap, 3e-3, material=tl.Elastic(3e6, 0.5)),
        ROAD,
        tl.Rolling(normal_load=400.0, friction=0.7),
    )
    _, _, less = traces(interactive.difference_map(contact, fine), "heatmap")
    # Both carry 400 N: the difference carries none.
    assert abs(np.nansum(less.z) * 1e3 * 25e-6) < 1e-3 * 400


def test_places_that_a_verdict_names_are_where_it_says(contact, response):
    verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2))
    (place,) = interactive.places_of(verdict)
    assert (place.x, place.y) == (float(verdict.dataset.worst_x), float(verdict.dataset.worst_y))
    view = place.view(0.1)
    assert view["xaxis.range"] == pytest.approx([1e3 * place.x - 50, 1e3 * place.x + 50])
    assert view["yaxis.range"][0] > view["yaxis.range"][1]
    (peak,) = interactive.places_of(contact)
    assert float(contact.dataset.pressure.sel(x=peak.x, y=peak.y, method="nearest")) == contact.dataset.pressure.max()


def test_the_tread_in_space_carries_the_pressure(contact):
    (surface,) = traces(interactive.tread(contact), "surface")
    assert np.nanmax(surface.surfacecolor) == pytest.approx(float(contact.dataset.pressure.max()) / 1e3, rel=1e-6)
    assert np.nanmax(surface.z) <= 1e-9
    with pytest.raises(tl.InputError, match="initial_gap"):
        interactive.tread(contact.dataset.drop_vars("initial_gap"))


def test_a_page_needs_no_network_and_shows_itself(contact, response, tmp_path):
    page = contact.plot.interactive().write_html(tmp_path / "contact.html").read_text(encoding="utf-8")
    # What would be fetched: sources and links, in what is not the library itself.
    ours = page.replace(interactive.plotly_script(), "")
    assert not re.search(r"""(src|href)\s*=\s*["']?(https?:)?//""", ours)
    assert "treadloadLink" in ours
    shown = response.plot.interactive(contact=contact)._repr_html_()
    assert shown.startswith("<iframe srcdoc=")
    with pytest.raises(tl.InputError, match=r"\.html"):
        contact.plot.interactive().write_html(tmp_path / "contact.png")


def test_texts_of_a_file_do_not_become_markup(contact):
    view = interactive.LinkedView(
        "<script>alert(1)</script>", {}, interactive.LIGHT, {}, ("</p><script>bad()</script>",)
    )
    assert "<script>alert" not in view.to_html()
    assert "<script>bad" not in view.to_html()


def test_large_maps_are_drawn_as_means_that_keep_the_load():
    n = 900
    x = 1e-3 * np.arange(n)
    pressure = np.random.default_rng(3).random((n, n)) * 1e6
    data = xr.Dataset({"pressure": (("y", "x"), pressure)}, {"x": x, "y": x})
    field = interactive.pressure_field(data)
    assert field.values.size <= 160_000
    assert field.blocks == 3
    assert field.values.mean() == pytest.approx(pressure.mean() / 1e3)


def test_a_map_of_3_mm_is_small_enough_to_be_redrawn_in_a_fifth_of_a_second():
    """130 x 120 cells, pressure and shear, as the page redraws them; on a quiet machine, process time too."""
    rng = np.random.default_rng(1)
    x, y = 3e-3 * (np.arange(130) - 64.5), 3e-3 * (np.arange(120) - 59.5)
    inside = (x[None, :] ** 2 / 0.15**2 + y[:, None] ** 2 / 0.12**2) < 1
    pressure = np.where(inside & (rng.random((120, 130)) > 0.05), 8e5 * rng.random((120, 130)), 0.0)
    data = tl.variables.dataset(
        {
            "pressure": (("y", "x"), pressure),
            "traction_x": (("y", "x"), -0.5 * pressure),
            "traction_y": (("y", "x"), 0.2 * pressure),
            "state": (("y", "x"), np.where(pressure > 0, 1 + (x[None, :] < -0.05), 0)),
        },
        {"y": y, "x": x},
    )

    def draw():
        fields = [interactive.pressure_field(data), interactive.shear_field(data)]
        return interactive.linked_maps(fields, cut=interactive.Cut.along(data)).to_json()

    # Two maps of 15 600 cells in a few digits each.
    assert len(draw()) < 1e6
    start = time.process_time()
    draw()
    seconds = time.process_time() - start
    print(f"two maps of 3 mm: {seconds:.3f} s")
    assert seconds < 0.2 or not os.environ.get("TREADLOAD_QUIET")


def test_without_plotly_the_sentence_names_the_extra(contact, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly.graph_objects", None)
    with pytest.raises(tl.InputError, match=r"not installed; run  pip install 'treadload\[app\]'"):
        interactive.linked_maps([interactive.pressure_field(contact)])


def test_plotly_waits_for_the_first_figure():
    """Whoever draws with matplotlib alone does not need it."""
    for path in Path(interactive.__file__).parent.glob("*.py"):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                assert not re.match(r"(from|import) plotly", ast.unparse(node)), path.name


def test_lines_can_be_dragged_and_labels_know_their_maps():
    """A browser showed both: without these a line needs a click first, and a second map's label has no axes."""
    assert interactive.CONFIG["edits"] == {"shapePosition": True}
    assert "Plotly.Fx.hover(maps, others, subplots)" in interactive.link_script()
