"""Figures that compare roads: bonded and free, cold and hot, moving at several speeds."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgb

from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import BONDED, FRICTIONLESS, Bond, Layer, Pavement
from treadload.plots import compare_roads, compare_temperatures, deflection_bowl, png
from treadload.plots.bowl import Bowl
from treadload.response import UniformDisc, solve_response

# Both sides of the interfaces: a micrometre below is below.
DEPTHS = [0.0, 0.03, 0.06, 0.060001, 0.14, 0.21, 0.210001, 0.3]
X = np.linspace(-0.3, 0.3, 13)


def _solve(asphalt: float, bond: Bond = BONDED) -> xr.Dataset:
    road = Pavement(
        [
            Layer(Elastic(asphalt, 0.35), 0.06, name="wearing course", bond=bond),
            Layer(Elastic(1.3 * asphalt, 0.35), 0.15, name="base"),
            Layer(Elastic(120e6, 0.35), name="subgrade"),
        ]
    )
    return solve_response([UniformDisc(radius=0.12, pressure=0.7e6)], road, depths=DEPTHS, x=X, y=[0.0]).dataset


@pytest.fixture(scope="module")
def bonded() -> xr.Dataset:
    return _solve(7e9)


@pytest.fixture(scope="module")
def free() -> xr.Dataset:
    return _solve(7e9, FRICTIONLESS)


@pytest.fixture(scope="module")
def hot() -> xr.Dataset:
    return _solve(1e9)


def _curves(ax, label) -> np.ndarray:
    """Strains down a profile, the pieces of all layers joined."""
    colour = next(line.get_color() for line in ax.lines if line.get_label() == label)
    pieces = [line for line in ax.lines if line.get_color() == colour and line.get_linewidth() > 1]
    return np.concatenate([line.get_xdata() for line in pieces])


def test_roads_stand_on_one_scale_beside_their_profiles(bonded, free):
    figure = compare_roads([bonded, free], ["Bonded", "Free"])
    left, right, profile = figure.axes[0], figure.axes[1], figure.axes[-1]
    assert [ax.get_title(loc="left") for ax in (left, right)] == ["Bonded", "Free"]
    meshes = [c for ax in (left, right) for c in ax.collections if isinstance(c, QuadMesh)]
    assert len(meshes) == 6
    assert len({mesh.get_clim() for mesh in meshes}) == 1
    assert left.get_xlim() == right.get_xlim()
    for ax in (left, right, profile):
        lines = [float(line.get_ydata()[0]) for line in ax.lines if line.get_gid() == "interface"]
        assert lines == [pytest.approx(60), pytest.approx(210)]
    for data, label in ((bonded, "Bonded"), (free, "Free")):
        wanted = data.strain_xx.sel(x=0, method="nearest").values[:, 0] * 1e6
        np.testing.assert_allclose(_curves(profile, label), wanted)
    assert profile.get_title(loc="left") == "Along travel"
    assert [t.get_text() for t in figure.legends[0].get_texts()] == ["Bonded", "Free"]
    bars = [c.get_ylabel() for ax in figure.axes for c in ax.child_axes]
    assert bars == ["largest tensile strain (microstrain)"]


def test_free_layers_bend_each_on_its_own(bonded, free):
    profile = compare_roads([bonded, free], ["Bonded", "Free"]).axes[-1]
    jump = {label: np.diff(_curves(profile, label)[2:4])[0] for label in ("Bonded", "Free")}
    # Bonded layers stretch alike at their interface; 1e-3 microstrain is the micrometre between the two depths.
    assert jump["Bonded"] == pytest.approx(0, abs=1e-2)
    assert jump["Free"] < -50


def test_roads_across_travel_show_the_strain_across():
    road = Pavement.half_space(Elastic(5e9, 0.35))
    disc = UniformDisc(radius=0.1, pressure=1e6)
    data = solve_response([disc], road, depths=[0.0, 0.1, 0.2], x=[0.0], y=X).dataset
    figure = compare_roads([data], ["one"], place=0.05)
    assert figure.axes[0].get_xlabel().startswith("y,")
    wanted = data.strain_yy.sel(y=0.05, method="nearest").values[:, 0] * 1e6
    np.testing.assert_allclose(_curves(figure.axes[-1], "one"), wanted)
    along = solve_response([disc], road, depths=[0.0, 0.1], x=X, y=[0.0]).dataset
    with pytest.raises(InputError, match="all lie along travel or all across"):
        compare_roads([data, along], ["a", "b"])


@pytest.mark.parametrize("count", [1, 4])
def test_any_number_of_roads_can_be_written(bonded, count):
    figure = compare_roads([bonded] * count, [f"road {k}" for k in range(count)], strain="principal")
    assert sum(ax.get_title(loc="left").startswith("road") for ax in figure.axes) == count
    assert png(figure, dpi=40).startswith(b"\x89PNG")


def test_flat_sections_stand_below_each_other(bonded):
    long = bonded.assign_coords(x=bonded.x * 4)
    first, second = compare_roads([long, long], ["a", "b"]).axes[:2]
    assert first.get_subplotspec().rowspan.start < second.get_subplotspec().rowspan.start


def test_temperatures_are_ordered_from_cold_to_hot(bonded, hot):
    figure = compare_temperatures([hot, bonded], [35, 10.5], strain="xx", place=(0.0, 0.0))
    labels = [t.get_text() for t in figure.legends[0].get_texts()]
    assert labels == ["10.5 °C", "35 °C"]
    profile, bars = figure.axes[:2]
    for data, label in ((bonded, "10.5 °C"), (hot, "35 °C")):
        wanted = data.strain_xx.sel(x=0, method="nearest").values[:, 0] * 1e6
        np.testing.assert_allclose(_curves(profile, label), wanted)
    cold, warm = (next(line.get_color() for line in profile.lines if line.get_label() == t) for t in labels)
    # Sequential: the hotter, the brighter.
    assert sum(to_rgb(warm)) > sum(to_rgb(cold))
    assert bars.get_xlabel() == "microstrain"
    lengths = [[bar.get_width() for bar in group] for group in bars.containers]
    layers = [slice(0, 3), slice(3, 6), slice(6, 8)]
    for data, group in zip((bonded, hot), lengths, strict=True):
        np.testing.assert_allclose(group, [float(data.strain_xx[rows].max()) * 1e6 for rows in layers])
    names = [t.get_text() for t in bars.get_yticklabels()]
    assert [name.split("\n")[0] for name in names] == ["wearing course", "base", "subgrade"]


def test_profile_by_temperature_goes_through_the_hottest_roads_worst_point(bonded, hot):
    profile = compare_temperatures([bonded, hot], [10, 35], strain="xx").axes[0]
    assert _curves(profile, "35 °C").max() == pytest.approx(float(hot.strain_xx[1:].max()) * 1e6)


def test_comparisons_refuse_what_does_not_match(bonded):
    with pytest.raises(InputError, match="1 labels for 2 roads"):
        compare_roads([bonded, bonded], ["one"])
    with pytest.raises(InputError, match="a temperature for each response: got 1 for 2"):
        compare_temperatures([bonded, bonded], [10])
    with pytest.raises(InputError, match="finite numbers of °C"):
        compare_temperatures([bonded], [float("nan")])
    with pytest.raises(InputError, match="strain must be one of xx, yy"):
        compare_roads([bonded], ["one"], strain="xz")
    with pytest.raises(InputError, match="same layers"):
        compare_temperatures([bonded, bonded.isel(depth=slice(0, 3))], [10, 20])


def _moving(lag: float, speed: float | None = 20.0) -> xr.Dataset:
    """A bowl in closed form, w = w0 / (1 + ((x + lag) / a)²), under a disc of stress about x = 0."""
    x = np.arange(-1.0, 1.0001, 0.02)
    down = 0.4e-3 / (1 + ((x + lag) / 0.3) ** 2)
    stress = np.where(np.abs(x) < 0.11, -0.7e6, 0.0)
    fields = {
        name: (("depth", "y", "x"), v[None, None]) for name, v in (("displacement_z", down), ("stress_zz", stress))
    }
    data = xr.Dataset(fields, {"depth": [0.0], "y": [0.0], "x": x})
    return data.assign_attrs({} if speed is None else {"speed": speed})


def test_bowl_finds_its_lag_between_the_points():
    bowl = Bowl.of(_moving(0.034), 0.0, 0.0)
    # The parabola through points 20 mm apart of a bowl 300 mm wide: (20/300)² of 10 mm, half their distance, at most.
    assert bowl.lag == pytest.approx(34, abs=0.04)
    assert bowl.deepest[1] == pytest.approx(0.4, rel=1e-4)
    assert bowl.words == "0.400 mm, 34.0 mm = 1.7 ms behind the load"
    assert Bowl.of(_moving(-0.034, None), 0.0, 0.0).words == "0.400 mm, 34.0 mm ahead of the load"
    assert Bowl.of(_moving(0.0) * 0.1, 0.0, 0.0).words == "40.0 µm, under the load"


def test_bowl_figure_marks_the_load_and_the_lowest_points():
    figure = deflection_bowl([_moving(0.0, None), _moving(0.05)], ["elastic", "20 m/s"])
    ax = figure.axes[0]
    assert ax.get_xlabel() == "x, direction of travel (mm)"
    assert ax.get_ylabel() == "deflection, down (mm)"
    bottom, top = ax.get_ylim()
    assert bottom > 0.4 > 0 > top
    assert [float(line.get_xdata()[0]) for line in ax.lines if line.get_gid() == "load"] == [
        pytest.approx(0, abs=1e-9)
    ]
    lowest = [float(line.get_xdata()[0]) for line in ax.lines if line.get_marker() == "v"]
    # The parabola through points 20 mm apart: see above.
    np.testing.assert_allclose(lowest, [0, -50], atol=0.04)
    words = [t.get_text() for t in figure.legends[0].get_texts()]
    assert words == ["elastic: 0.400 mm, under the load", "20 m/s: 0.400 mm, 50.0 mm = 2.5 ms behind the load"]
    assert "travel" in [t.get_text() for t in ax.texts]


def test_small_bowls_are_told_in_micrometres(bonded):
    figure = deflection_bowl([_moving(0.0) * 0.1], ["stiff"], load=0.0)
    assert figure.axes[0].get_ylabel() == "deflection, down (µm)"
    with pytest.raises(InputError, match="three points along travel"):
        deflection_bowl([bonded.isel(x=slice(5, 7))], ["short"], load=0.0)
    with pytest.raises(InputError, match="load is not known"):
        deflection_bowl([bonded.isel(depth=slice(1, None))], ["deep"])
    with pytest.raises(InputError, match="2 labels for 1 responses"):
        deflection_bowl([bonded], ["a", "b"])
    with pytest.raises(InputError, match="not finite"):
        deflection_bowl([bonded * np.nan], ["nan"], load=0.0)
