"""Figures of real small cases: what is drawn, in which units, on which scale."""

from __future__ import annotations

import io
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import imread

from treadload.contact import Contact, Rolling, solve_contact
from treadload.damage import FatigueLine, Verdict, assess
from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.plots import (
    compare_pressure,
    compare_strain,
    depth_slice,
    fatigue_line,
    png,
    pressure,
    save,
    stick_slip,
    strain_directions,
)
from treadload.plots.contact import profile
from treadload.plots.kit.plan import Plan, borders, contact_mask, edges, limits, round_up
from treadload.plots.kit.strokes import choose
from treadload.plots.kit.style import power_of_ten, signed
from treadload.plots.verdict import passes
from treadload.response import Response, solve_response
from treadload.tire import Tire

SPACING = 0.012


def _case(force: float) -> tuple[Contact, Response, Verdict]:
    tire = Tire.from_profile("315/80R22.5", material=Elastic(3e6, 0.5))
    road = Pavement.half_space(Elastic(5.4e9, 0.35))
    contact = solve_contact(
        tire, road, Rolling(normal_load=32.5e3, friction=0.7, tractive_force=force), spacing=SPACING
    )
    response = solve_response(contact, road, depths=[0.0, 0.02, 0.05])
    return contact, response, assess(response, FatigueLine(120e-6, -0.2))


@pytest.fixture(scope="module")
def free() -> tuple[Contact, Response, Verdict]:
    return _case(0.0)


@pytest.fixture(scope="module")
def driving() -> tuple[Contact, Response, Verdict]:
    return _case(10e3)


def _mesh(figure: Figure, number: int = 0) -> QuadMesh:
    return next(c for c in figure.axes[number].collections if isinstance(c, QuadMesh))


def _strokes(figure: Figure, number: int = 0) -> np.ndarray:
    lines = next(c for c in figure.axes[number].collections if c.get_gid() == "strokes")
    assert isinstance(lines, LineCollection)
    return np.array(lines.get_segments())


def _texts(figure: Figure) -> str:
    return "\n".join(t.get_text() for t in figure.findobj(mpl.text.Text))


def test_pressure_is_drawn_true_to_scale_in_mm_and_kpa(driving):
    contact = driving[0]
    figure = contact.plot.pressure()
    ax = figure.axes[0]
    assert ax.get_aspect() == 1
    assert ax.get_xlabel() == "x, direction of travel (mm)"
    assert ax.get_ylabel() == "y, right of travel (mm)"
    drawn = np.ma.filled(_mesh(figure).get_array(), 0.0)
    np.testing.assert_allclose(drawn, contact.dataset.pressure.values / 1e3)
    data = contact.dataset
    np.testing.assert_allclose(ax.get_xlim(), [data.x.values[0] * 1e3 - 6, data.x.values[-1] * 1e3 + 6])
    # Seen from above with travel to the right of the page, the right of travel is down the page.
    bottom, top = ax.get_ylim()
    assert bottom == pytest.approx(data.y.values[-1] * 1e3 + 6)
    assert top == pytest.approx(data.y.values[0] * 1e3 - 6)
    texts = _texts(figure)
    assert "contact pressure (kPa)" in texts
    assert "32.5 kN" in texts
    assert f"{float(data.pressure.max()) / 1e3:.0f} kPa" in texts
    assert f"{contact.area * 1e6:,.0f}".replace(",", "\u202f") in texts
    assert "travel" in texts


def test_every_figure_of_a_case_can_be_written(driving, tmp_path):
    contact, response, verdict = driving
    figures = [
        contact.plot.pressure(),
        contact.plot.height_map(),
        contact.plot.stick_slip(),
        contact.plot.shear(),
        contact.plot.profile(),
        response.plot.strain_directions(depth=0.02, contact=contact),
        response.plot.depth_slice(),
        response.plot.depth_slice("across", at=0.0),
        response.plot.profile(epsilon_6=120e-6),
        verdict.plot.fatigue_line(design_passes=4e6),
        verdict.plot.passes(),
        verdict.plot.cracks(),
    ]
    for number, figure in enumerate(figures):
        assert isinstance(figure, Figure)
        path = save(figure, tmp_path / f"{number}.png", dpi=40)
        assert path.read_bytes().startswith(b"\x89PNG")


def test_drawing_leaves_no_global_state(driving):
    before = dict(mpl.rcParams)
    png(driving[0].plot.pressure(), dpi=40)
    png(compare_strain([driving[1]], ["a"]), dpi=40)
    assert dict(mpl.rcParams) == before
    if "matplotlib.pyplot" in sys.modules:
        assert sys.modules["matplotlib.pyplot"].get_fignums() == []


def test_plots_never_import_pyplot():
    import subprocess

    code = (
        "import sys, treadload.plots; assert 'matplotlib.pyplot' not in sys.modules;"
        "[sys.modules.pop(m) for m in list(sys.modules) if m.startswith(('treadload', 'matplotlib'))];"
        "import treadload, treadload.contact, treadload.response, treadload.damage;"
        "assert 'matplotlib' not in sys.modules, 'the solvers must not need matplotlib'"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_stick_slip_draws_the_zones_and_the_shear(driving):
    contact = driving[0]
    figure = contact.plot.stick_slip()
    data = contact.dataset
    shear = np.hypot(data.traction_x, data.traction_y).values / 1e3
    drawn = _mesh(figure).get_array()
    np.testing.assert_allclose(np.ma.filled(drawn, 0.0), shear * (data.state.values > 0))
    assert {"stick", "slip"} <= {t.get_text() for t in figure.axes[0].get_legend().get_texts()}
    arrows = next(c for c in figure.axes[0].collections if type(c).__name__ == "Quiver")
    # The tire pushes the road backwards.
    assert len(arrows.U) > 10
    assert np.mean(arrows.U) < 0


def test_shear_in_space_stands_beside_its_plan(driving):
    figure = driving[0].plot.shear()
    solid, flat = figure.axes[:2]
    assert solid.name == "3d"
    assert solid.get_zlabel() == "shear (kPa)"
    assert flat.get_aspect() == 1
    data = driving[0].dataset
    assert solid.get_zlim()[1] == pytest.approx(float(np.hypot(data.traction_x, data.traction_y).max()) / 1e3)


def test_profile_of_contact_shows_shear_within_friction(driving):
    contact = driving[0]
    figure = contact.plot.profile()
    lines = {line.get_label(): line for line in figure.axes[0].lines}
    pressure, bound = lines["pressure"].get_ydata(), lines["friction × pressure"].get_ydata()
    np.testing.assert_allclose(bound, 0.7 * pressure)
    assert (lines["shear, where it sticks"].get_ydata() <= bound * (1 + 1e-4) + 1e-6).all()
    assert pressure.max() == pytest.approx(float(contact.dataset.pressure.max()) / 1e3)


@pytest.mark.parametrize("strain", ["principal", "in-plane"])
def test_strokes_follow_the_direction_of_extension(driving, strain):
    response = driving[1]
    figure = response.plot.strain_directions(strain=strain)
    segments = _strokes(figure)
    assert len(segments) > 30
    plane = response.dataset.isel(depth=0)
    middles = segments.mean(axis=1) * 1e-3
    across = segments[:, 1] - segments[:, 0]
    longest = np.hypot(*across.T).max()
    for middle, stroke in zip(middles, across, strict=True):
        here = plane.sel(x=middle[0], y=middle[1], method="nearest")
        if strain == "principal":
            wanted = here.principal_direction_1.values[:2]
        else:
            angle = float(here.in_plane_angle_1)
            wanted = np.array([np.cos(angle), np.sin(angle)])
        assert stroke[0] * wanted[1] - stroke[1] * wanted[0] == pytest.approx(0, abs=1e-9 * longest)
        # The length is the horizontal share of the direction.
        assert np.hypot(*stroke) <= np.hypot(*wanted) * longest * 1.6
    assert "microstrain" in _texts(figure)


def test_short_strokes_stand_for_steep_directions(driving):
    response = driving[1]
    segments = _strokes(response.plot.strain_directions(depth=0.02))
    plane = response.dataset.sel(depth=0.02)
    length = np.hypot(*(segments[:, 1] - segments[:, 0]).T)
    share = []
    for middle in segments.mean(axis=1) * 1e-3:
        direction = plane.sel(x=middle[0], y=middle[1], method="nearest").principal_direction_1.values
        share.append(np.hypot(direction[0], direction[1]))
    np.testing.assert_allclose(length / length.max(), np.array(share) / max(share), atol=1e-9)


def test_colours_and_mark_tell_the_peak_strain(driving):
    response = driving[1]
    figure = response.plot.strain_directions()
    mesh = _mesh(figure)
    values = response.dataset.principal_strain_1.isel(depth=0).values * 1e6
    np.testing.assert_allclose(mesh.get_array(), values)
    low, high = mesh.get_clim()
    assert low == 0
    assert 0 < high <= values.max() * (1 + 1e-12)
    assert f"{values.max():.1f} microstrain" in _texts(figure)


def test_clipped_colours_say_so():
    values = np.concatenate([np.linspace(1, 10, 999), [100.0]])
    scale = limits(values)
    assert scale.clipped
    assert scale.high == 10
    assert scale.extend == "max"
    whole = limits(values, robust=False)
    assert (whole.high, whole.clipped, whole.extend) == (100.0, False, "neither")
    assert limits(np.zeros(4)) == limits(np.full(4, np.nan))


def test_comparison_has_one_scale_and_one_bar(free, driving):
    responses = [free[1], driving[1]]
    figure = compare_strain([r.dataset for r in responses], ["Free", "Driving"])
    first, second = (_mesh(figure, k) for k in (0, 1))
    assert first.get_clim() == second.get_clim()
    assert first.get_clim()[1] > float(free[1].dataset.principal_strain_1.isel(depth=0).max()) * 1e6
    assert _texts(figure).count("microstrain)") == 1
    assert figure.axes[0].get_title(loc="left") == "Free"
    assert len(_strokes(figure, 0)) > 10
    figure = compare_pressure([free[0], driving[0]], ["a", "b"])
    assert _mesh(figure, 0).get_clim() == _mesh(figure, 1).get_clim()
    assert figure.axes[0].get_xlim() == figure.axes[1].get_xlim()


def test_comparison_needs_a_label_for_each_case(free):
    with pytest.raises(InputError, match="1 labels for 2 cases"):
        compare_strain([free[1], free[1]], ["only one"])


def test_words_beside_a_colour_bar_are_no_longer_than_the_bar(free, driving):
    """They pressed the maps together in a report: the longest are those of the strain in the horizontal plane."""
    figure = compare_strain([free[1], driving[1]], ["Free", "Driving"], strain="in-plane")
    agg = FigureCanvasAgg(figure)
    agg.draw()
    labels = [(ax, ax.yaxis.label) for ax in figure.findobj(Axes) if "horizontal plane" in ax.get_ylabel()]
    assert labels
    for ax, label in labels:
        assert label.get_window_extent().height <= ax.get_window_extent().height


def test_section_runs_downwards_at_true_scale(driving):
    response = driving[1]
    figure = response.plot.depth_slice("travel")
    ax = figure.axes[0]
    assert ax.get_aspect() == 1
    assert ax.get_ylim() == (pytest.approx(50), pytest.approx(0))
    assert ax.get_ylabel() == "depth (mm)"
    values = response.dataset.principal_strain_1
    row = int(values.isel(depth=0).argmax(...)["y"])
    np.testing.assert_allclose(_mesh(figure).get_array(), values.isel(y=row).values * 1e6)
    assert len(_strokes(figure)) > 10


def test_section_of_a_single_row_or_column(driving):
    data = driving[1].dataset
    along = depth_slice(data.isel(y=[5]))
    assert along.axes[0].get_xlabel().startswith("x,")
    across = depth_slice(data.isel(x=[5]))
    assert across.axes[0].get_xlabel().startswith("y,")
    with pytest.raises(InputError, match="two depths"):
        depth_slice(data.isel(depth=[0]))
    with pytest.raises(InputError, match='"travel" or "across"'):
        depth_slice(data, "sideways")


def test_strain_against_depth_reads_the_worst_point(driving):
    response = driving[1]
    figure = response.plot.profile()
    strain = response.dataset.principal_strain_1
    here = strain.isel(depth=0).argmax(...)
    line = next(l for l in figure.axes[0].lines if l.get_label() == "three-dimensional, under the point")
    np.testing.assert_allclose(line.get_xdata(), strain.isel(x=int(here["x"]), y=int(here["y"])).values * 1e6)
    bottom, top = figure.axes[0].get_ylim()
    assert bottom > top


def test_fatigue_line_passes_through_epsilon_6_and_the_cases(free, driving):
    verdicts = [free[2], driving[2]]
    figure = fatigue_line(verdicts, ["free", "driving"], design_passes=4e6)
    ax = figure.axes[0]
    assert ax.get_xscale() == ax.get_yscale() == "log"
    points = {(float(l.get_xdata()[0]), float(l.get_ydata()[0])) for l in ax.lines if len(l.get_xdata()) == 1}
    assert (1e6, pytest.approx(120.0)) in [(x, y) for x, y in points]
    for verdict in verdicts:
        passes, strain = float(verdict.dataset.worst_passes), float(verdict.dataset.worst_strain)
        assert any(x == pytest.approx(passes) and y == pytest.approx(strain * 1e6) for x, y in points)
        assert ax.get_xlim()[0] < passes < ax.get_xlim()[1]
    line = ax.lines[0]
    slope = np.diff(np.log(line.get_ydata())) / np.diff(np.log(line.get_xdata()))
    assert slope == pytest.approx(-0.2)
    assert "driving: " in _texts(figure)


def test_fatigue_line_lists_crowded_cases(driving):
    figure = fatigue_line([driving[2]] * 3, ["_a", "$b", "c"])
    listed = [t.get_text() for t in figure.axes[0].get_legend().get_texts()]
    assert len(listed) == 3
    png(figure, dpi=40)


def test_passes_are_logarithmic_and_keep_the_fewest(driving):
    verdict = driving[2]
    figure = verdict.plot.passes()
    mesh = _mesh(figure)
    assert isinstance(mesh.norm, LogNorm)
    fewest = float(verdict.dataset.worst_passes)
    assert mesh.norm.vmin <= fewest <= mesh.norm.vmax
    # The worst point lies between the points of the map.
    assert np.min(mesh.get_array()) >= fewest
    assert power_of_ten(fewest) in _texts(figure)


def test_cracks_lie_across_the_extension(driving):
    response = driving[1]
    verdict = assess(response, FatigueLine(120e-6, -0.2), depth=0.0, strain="principal")
    segments = _strokes(verdict.plot.cracks())
    assert len(segments) > 30
    plane = response.dataset.isel(depth=0)
    for segment in segments:
        x, y = segment.mean(axis=0) * 1e-3
        direction = plane.sel(x=x, y=y, method="nearest").principal_direction_1.values[:2]
        assert float(np.dot(segment[1] - segment[0], direction)) == pytest.approx(0, abs=1e-6)
    legend = [t.get_text() for t in verdict.plot.cracks().axes[0].get_legend().get_texts()]
    assert set(legend) <= {"longitudinal", "transverse", "oblique", "horizontal"}


def test_nothing_to_see_is_said(driving):
    contact, response, verdict = (part.dataset.copy() for part in driving)
    contact["pressure"] = contact.pressure * 0
    assert "no contact" in _texts(pressure(contact))
    response["principal_strain_1"] = response.principal_strain_1 * 0 - 1e-6
    assert "no tensile strain here" in _texts(strain_directions(response))
    verdict["allowable_passes"] = verdict.allowable_passes * np.inf
    assert "no limit" in _texts(passes(verdict))
    verdict["worst_strain"], verdict["worst_passes"] = -1e-6, np.inf
    assert "no tensile strain" in _texts(fatigue_line(verdict))


def test_a_measured_footprint_needs_only_its_pressure(driving):
    data = driving[0].dataset[["pressure"]]
    pressure(data)
    profile(data)
    with pytest.raises(InputError, match="traction_x"):
        stick_slip(data)


def test_unknown_depth_and_strain_are_refused(driving):
    with pytest.raises(InputError, match=r"no depth 0\.03 m, it has 0, 0\.02, 0\.05 m"):
        driving[1].plot.strain_directions(depth=0.03)
    with pytest.raises(InputError, match='"principal" or "in-plane"'):
        driving[1].plot.strain_directions(strain="main")


def test_axes_given_are_drawn_into(driving):
    figure = Figure()
    ax = figure.add_subplot()
    assert driving[0].plot.pressure(ax=ax) is figure
    assert ax.collections


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_save_writes_by_suffix_and_leaves_nothing_else(driving, tmp_path, suffix):
    path = save(driving[2].plot.fatigue_line(), tmp_path / f"figure{suffix}", dpi=40)
    assert path.stat().st_size > 1000
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_save_refuses_what_it_cannot_write(driving, tmp_path):
    figure = driving[2].plot.fatigue_line()
    with pytest.raises(InputError, match=r"\.png, \.svg, \.pdf"):
        save(figure, tmp_path / "figure.bmp")
    with pytest.raises(InputError, match="cannot write"):
        save(figure, tmp_path / "missing" / "figure.png")
    assert list(tmp_path.iterdir()) == []


def test_contact_outline_from_surface_stress_matches_the_pressure(driving):
    contact, response, _ = driving
    found = contact_mask(response.dataset)
    pressed = contact.dataset.pressure.values > 5e-3 * float(contact.dataset.pressure.max())
    np.testing.assert_array_equal(found, pressed)
    assert contact_mask(response.dataset.isel(depth=[1])) is None


def test_borders_enclose_a_cell():
    plan = Plan(np.array([0.0, 1.0]), np.array([0.0, 1.0, 2.0]), np.arange(3) - 0.5, np.arange(4) - 0.5)
    mask = np.zeros((3, 2), dtype=bool)
    mask[1, 0] = True
    segments = borders(mask, plan)
    assert segments.shape == (4, 2, 2)
    assert np.hypot(*(segments[:, 1] - segments[:, 0]).T).sum() == pytest.approx(4)
    assert {tuple(p) for p in segments.reshape(-1, 2)} == {(-0.5, 0.5), (0.5, 0.5), (-0.5, 1.5), (0.5, 1.5)}


def test_strokes_are_chosen_as_by_looking_at_all_pairs():
    """The largest first, each unless one that was chosen before is near: whatever the grid, NaN and equal weights."""
    rng = np.random.default_rng(5)
    for ny, nx, apart in ((1, 30, 2.0), (23, 17, 3.5), (20, 25, 7.0)):
        weight = np.round(rng.random((ny, nx)), 1)
        weight[rng.random((ny, nx)) < 0.1] = np.nan
        x, y = np.cumsum(rng.uniform(0.1, 1.5, nx)), np.cumsum(rng.uniform(0.1, 1.5, ny))
        told = [(r, c) for r in range(ny) for c in range(nx) if weight[r, c] >= 0.2]
        chosen: list[tuple[int, int]] = []
        for r, c in sorted(told, key=lambda at: -weight[at]):
            if all((x[c] - x[k]) ** 2 + (y[r] - y[j]) ** 2 >= apart**2 for j, k in chosen):
                chosen.append((r, c))
        assert choose(weight, x, y, 0.2, apart).tolist() == [list(one) for one in chosen]


def test_chosen_strokes_keep_their_distance():
    weight = np.random.default_rng(1).random((40, 50))
    x, y = np.arange(50.0), np.arange(40.0)
    index = choose(weight, x, y, 0.3, 4.0)
    points = np.stack([x[index[:, 1]], y[index[:, 0]]], axis=-1)
    apart = np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1))
    assert apart[apart > 0].min() >= 4.0
    assert tuple(index[0]) == np.unravel_index(weight.argmax(), weight.shape)
    assert (weight[tuple(index.T)] >= 0.3).all()
    assert choose(weight, x, y, 2.0, 4.0).shape == (0, 2)


def test_small_helpers():
    np.testing.assert_allclose(edges(np.array([0.0, 1.0, 3.0])), [-0.5, 0.5, 2.0, 4.0])
    np.testing.assert_allclose(edges(np.array([2.0]), 3.0), [0.5, 3.5])
    assert round_up(131.0) == pytest.approx(140)
    assert round_up(0.0301) == pytest.approx(0.031)
    assert power_of_ten(1.2e5) == "1.2×10⁵"
    assert power_of_ten(float("inf")) == "∞"
    assert signed(-1.25, 2) == "\u22121.25"


def test_png_is_trimmed_to_its_ink_and_leaves_the_figure_as_it_was(driving):
    figure = driving[0].plot.pressure()
    canvas, resolution = figure.canvas, figure.dpi
    image = imread(io.BytesIO(png(figure, dpi=100)))
    assert (figure.canvas, figure.dpi) == (canvas, resolution)
    ink = (image[..., :3] < 1).any(axis=2)
    # 0.08 inches of paper on each side.
    rows, columns = np.nonzero(ink.any(axis=1))[0], np.nonzero(ink.any(axis=0))[0]
    assert (rows[0], columns[0]) == (8, 8)
    assert (rows[-1], columns[-1]) == (image.shape[0] - 9, image.shape[1] - 9)


def test_png_holds_what_reaches_beyond_the_figure():
    figure = Figure(figsize=(2, 2))
    figure.text(0.9, 0.5, "a text far longer than the figure has room for", color="red")
    image = imread(io.BytesIO(png(figure, dpi=50)))
    assert image.shape[1] > 150
