"""Figures of studies show what was solved, in people's units, and where cases failed."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb

import treadload as tl
from studies import CASE, product_study, study_of, wheel
from treadload.plots.kit.shown import Shown, shown
from treadload.plots.sweeps.reading import View
from treadload.sweeps import sampled
from treadload.sweeps.design import listed, product

CREEPAGES = [-0.1, -0.01, 0.0, 0.01]


@pytest.fixture(scope="module")
def study():
    return product_study()


@pytest.fixture(scope="module")
def spread():
    return study_of(sampled(CASE, {"friction": (0.2, 0.9), "normal_load": ("20 kN", "40 kN")}, 16), wheel)


def lines(ax):
    return {line.get_label(): line.get_xydata() for line in ax.get_lines() if not line.get_label().startswith("_")}


def crosses(ax):
    return sorted(float(x) for line in ax.get_lines() if line.get_marker() == "x" for x in line.get_xdata())


def words(figure):
    return " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))


def test_a_curve_for_each_load(study):
    (ax,) = study.plot.curve("worst_strain", "friction").axes
    drawn = lines(ax)
    assert list(drawn) == ["20 kN", "30 kN", "40 kN"]
    # Microstrain, as the stand-in says: (40 + 30 μ) P/30 kN; a gap where the case failed.
    np.testing.assert_allclose(drawn["30 kN"][:, 1], [np.nan, 52, 58, 64])
    np.testing.assert_allclose(drawn["30 kN"][:, 0], [0.2, 0.4, 0.6, 0.8])
    assert ax.get_xlabel() == "friction (–)"
    assert ax.get_ylabel() == "evaluated tensile strain (microstrain)"
    assert crosses(ax) == [0.2, 0.2, 0.2]
    assert "3 of 12 cases failed" in words(ax.figure)


def test_a_curve_is_cut_where_it_is_asked(study):
    (ax,) = study.plot.curve("largest_extension", "normal_load", by="", at={"friction": 0.41, "depth": 0.02}).axes
    drawn = ax.get_lines()[0].get_xydata()
    np.testing.assert_allclose(drawn[:, 0], [20, 30, 40])
    np.testing.assert_allclose(drawn[:, 1], [52 * load / 30 for load in (20, 30, 40)])
    assert "friction 0.4, depth 20 mm" in words(ax.figure)
    by_depth = lines(study.plot.curve("largest_extension", "friction", by="depth").axes[0])
    assert list(by_depth) == ["0 mm", "20 mm"]
    np.testing.assert_allclose(by_depth["0 mm"][1:, 1] / by_depth["20 mm"][1:, 1], 1.4)


def test_passes_are_drawn_in_their_logarithms(study):
    assert study.plot.curve("worst_passes").axes[0].get_yscale() == "log"
    assert study.plot.curve("worst_strain").axes[0].get_yscale() == "linear"
    bar = study.plot.map("worst_passes").axes[1]
    assert bar.get_yscale() == "log"


def test_passes_without_end_are_a_gap_that_is_said():
    passes = {0.3: 2e6, 0.5: 1e6, 0.7: np.inf}
    design = product(CASE, {"friction": list(passes)})
    never = study_of(design, lambda friction: {"worst_passes": passes[friction]})
    (ax,) = never.plot.curve("worst_passes").axes
    assert "gaps: without end" in ax.get_ylabel()
    assert np.isnan(ax.get_lines()[0].get_ydata()[-1])


def test_what_is_not_solved_yet_is_counted():
    part = product_study(friction=[0.4, 0.6, 0.9])
    assert "1 not solved yet" in words(part.plot.curve("worst_strain"))
    assert "failed" not in words(part.plot.curve("worst_strain"))


def test_the_slip_curve_is_the_force_over_what_friction_carries():
    study = product_study(**{"rolling.creepage_x": CREEPAGES, "friction": [0.4, 0.8]})
    (ax,) = study.plot.slip_curve().axes
    drawn = lines(ax)
    assert list(drawn) == ["0.4", "0.8"]
    np.testing.assert_allclose(drawn["0.4"][:, 0], CREEPAGES)
    np.testing.assert_allclose(drawn["0.4"][:, 1], -np.tanh(60 * np.array(CREEPAGES) / 0.4))
    assert "whole contact slides" in words(ax.figure)
    with pytest.raises(tl.InputError, match=r"a slip curve needs a study that varies.*friction, normal_load"):
        product_study().plot.slip_curve()


def test_a_map_over_load_and_friction(study):
    figure = study.plot.map("worst_strain", "normal_load", "friction")
    ax, bar = figure.axes
    (mesh,) = ax.collections[:1]
    # Rows are frictions, the lowest of which failed.
    values = mesh.get_array().reshape(4, 3)
    np.testing.assert_allclose(values[1:, 1], [52, 58, 64])
    assert values.mask[0].all()
    assert len(ax.patches) == 3
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("normal load (kN)", "friction (–)")
    assert bar.get_ylabel() == "evaluated tensile strain (microstrain)"
    # The other way round it is the same, turned.
    turned = study.plot.map("worst_strain", "friction", "normal_load").axes[0].collections[0].get_array()
    np.testing.assert_allclose(turned.reshape(3, 4).filled(0), values.filled(0).T)


def light(colour):
    """Relative luminance of WCAG 2."""
    parts = np.array(to_rgb(colour))
    return np.where(parts <= 0.03928, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4) @ (0.2126, 0.7152, 0.0722)


def test_numbers_in_cells_can_be_read(study):
    """Of dark letters and white ones those that are clearer: a contrast of 4 at least, the root of that of both."""
    ax = study.plot.map("worst_strain", "normal_load", "friction").axes[0]
    (mesh,) = ax.collections[:1]
    values, colours = mesh.get_array().ravel(), set()
    texts = [one for one in ax.texts if one.get_va() == "center"]
    assert len(texts) == values.count() == 9
    for text, value in zip(texts, values.compressed(), strict=True):
        both = sorted((light(text.get_color()), light(mesh.cmap(mesh.norm(value)))))
        assert (both[1] + 0.05) / (both[0] + 0.05) > 4
        colours.add(text.get_color())
    assert len(colours) == 2


def test_years_of_a_study_say_what_they_are_until():
    study = study_of(product(CASE, {"friction": [0.3, 0.5]}), lambda friction: {"governing_years": 30 * friction})
    assert study.plot.curve("governing_years").axes[0].get_ylabel() == "service life of the road (years)"


def test_sampled_cases_are_dots(spread):
    failed = int((spread.dataset["status"] == 2).sum())
    solved = spread.stats["solved"]
    ax = spread.plot.curve("worst_strain", "friction").axes[0]
    assert len(ax.collections[0].get_offsets()) == solved
    assert len(crosses(ax)) == failed > 0
    ax = spread.plot.map("worst_strain").axes[0]
    assert len(ax.collections[0].get_offsets()) == solved
    assert spread.plot.curves(["worst_strain", "worst_passes"], "normal_load", by="").axes


def test_names_of_cases_are_ticks():
    study = study_of(
        listed(CASE, [{"friction": mu, "title": name} for mu, name in ((0.4, "wet"), (0.8, "dry"))]),
        lambda friction, title: wheel(friction),
    )
    ax = study.plot.curve("worst_strain", "title").axes[0]
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["wet", "dry"]


def test_fields_as_small_multiples(study):
    figure = study.plot.multiples("pressure")
    maps = [ax for ax in figure.axes if ax.get_aspect() == 1.0]
    assert len(maps) == 12
    assert sum(text.get_text() == "failed" for ax in maps for text in ax.texts) == 3
    scales = {one.get_clim() for ax in maps for one in ax.collections}
    assert len(scales) == 1
    assert "pressure (kPa)" in words(figure)
    few = product_study(friction=[0.4, 0.6])
    deep = few.plot.multiples("principal_strain_1", at={"depth": 0.02})
    assert "depth 20 mm" in words(deep)
    with pytest.raises(tl.InputError, match=r"maps are drawn of a field over y and x, worst_strain is over"):
        study.plot.multiples("worst_strain")


def test_of_many_cases_evenly_some_are_drawn():
    study = product_study(friction=np.linspace(0.3, 0.8, 40).tolist(), normal_load=np.linspace(2e4, 4e4, 30).tolist())
    assert len(lines(study.plot.curve("worst_strain").axes[0])) == 12
    one = product_study(friction=np.linspace(0.3, 0.8, 40).tolist())
    assert len([ax for ax in one.plot.multiples("pressure").axes if ax.get_aspect() == 1.0]) == 5
    # Lines of equal values in place of a thousand numbers.
    assert len(study.plot.map("worst_strain").axes[0].texts) < 30


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda plot: plot.curve("strain"), "the study has no 'strain'"),
        (lambda plot: plot.curve("worst_strain", "speed"), "does not vary 'speed'; it varies friction, normal_load"),
        (lambda plot: plot.curve("worst_strain", "friction", by="friction"), "cannot be distinguished by friction"),
        (lambda plot: plot.curve("worst_strain", at={"speed": 3}), "does not vary 'speed'"),
        (lambda plot: plot.curve("worst_strain", "friction", at={"friction": 0.4}), "is not cut at friction"),
        (lambda plot: plot.curve("largest_extension", at={"depth": "deep"}), "depth is a number in SI units"),
        (lambda plot: plot.curves(["worst_strain"] * 7), "panels show 1 to 6 results, got 7"),
        (lambda plot: plot.map("worst_strain", "friction", "friction"), "two inputs"),
    ],
)
def test_what_cannot_be_drawn_is_refused(study, call, said):
    with pytest.raises(tl.InputError, match=said):
        call(study.plot)


def test_a_study_is_asked_for():
    with pytest.raises(tl.InputError, match="this figure needs a study"):
        tl.plots.study_curve(xr.Dataset({"x": 1.0}), "x")


def test_round_off_is_no_reading(study):
    assert "lateral_force" not in View.of(study).readings()
    assert "worst_strain" in View.of(study).readings()


def test_quantities_are_shown_in_the_units_of_people():
    def told(name, value, units):
        how = shown(xr.DataArray([value], attrs={"units": units}), name)
        return f"{how.words}: {how.number(value)}"

    assert told("rolling.normal_load", 32.5e3, "N") == "normal load: 32.5 kN"
    assert told("tire.inflation_pressure", 8.2e5, "Pa") == "inflation pressure: 820 kPa"
    assert told("pavement.layers.0.thickness", 0.06, "m") == "thickness of layer 1: 60 mm"
    assert told("pavement.layers.1.material.modulus", 9e9, "Pa") == "modulus of layer 2: 9000 MPa"
    assert told("rolling.speed", 20.0, "m/s") == "speed: 72 km/h"
    assert told("pavement.temperature", -5.0, "degC") == "temperature: \u22125 °C"
    assert told("max_principal_strain_1", 1.2e-4, "1") == "tensile strain, three-dimensional: 120 microstrain"
    assert told("slip_fraction", 0.25, "1") == "slip share of the contact: 25 %"
    assert told("friction", 0.7, "1") == "friction: 0.7"
    assert shown(xr.DataArray([1e6], attrs={"units": "1"}), "worst_passes").logarithmic


def test_a_number_with_a_unit_has_no_power_of_ten():
    area = Shown("net contact area", "mm²", 1e6)
    assert area.number(0.028108) == "28110 mm²"
    assert area.number(0.0000281) == "28.1 mm²"
    assert Shown("force", "N", 1.0).number(-12345.6) == "\u221212350 N"
    # Counts keep theirs.
    assert Shown("load repetitions", "–", 1.0).number(1.5e6) == "1.5e+06"
