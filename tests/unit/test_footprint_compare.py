"""A contact beside a footprint: what a known sensor did is found again, and what differs is told."""

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

import treadload as tl
from footprints import ribbed, sensed, tekscan
from treadload.cli import app
from treadload.describing import verdict_of
from treadload.footprint import Footprint, register
from treadload.footprint.registration import seen
from treadload.grid import Grid
from treadload.kernels.gridding.overlap import means_over_cells
from treadload.response import GridLoad
from treadload.steps.footprint import FootprintStep

LOAD = ribbed()
PITCH = 8e-3
# Nothing but a known pose in the way.
POSE = {"shift": (0.0123, -0.0077), "angle": math.radians(3.3)}


@pytest.fixture(scope="module")
def noisy():
    """A comparison with a print of 3 % of noise, askew and cut off."""
    return tl.compare(LOAD, sensed(LOAD, **POSE, noise=0.03, threshold=10e3, saturation=1.3e6))


@pytest.mark.parametrize("angle", [0.0, 1e-6, 1e-5, 1e-3, 0.05, 0.5, 1.2, math.pi / 2, 3.0])
def test_means_over_sensels_keep_the_load(angle):
    """A sensor that reaches beyond the contact, at any angle: the load to round-off, no mean beyond the largest."""
    grid = Grid(90, 90, 4.7e-3, 4.7e-3, -44.5 * 4.7e-3 + 1.3e-3, -44.5 * 4.7e-3 - 0.7e-3)
    means = seen(LOAD, grid, angle)
    assert means.sum() * grid.cell_area == pytest.approx(LOAD.normal_load, rel=1e-12)
    assert means.min() >= 0
    assert means.max() <= LOAD.pressure.max() * (1 + 1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0])
def test_means_of_a_uniform_field_are_that_field(angle):
    at = np.linspace(-1, 1, 41)
    small = np.linspace(-0.4, 0.4, 14)
    means = means_over_cells(np.full((40, 40), 7.0), at, at, small, small, angle)
    np.testing.assert_allclose(means, 7.0, rtol=1e-12)


def test_a_cell_is_shared_by_area():
    """A cell of 2 x 1 over four sensels of one, and a square turned by 45° over a larger one: by hand."""
    means = means_over_cells(
        np.ones((1, 1)), np.array([0.5, 2.5]), np.array([0.25, 1.25]), np.arange(4.0), np.arange(3.0)
    )
    np.testing.assert_allclose(means, [[0.375, 0.75, 0.375], [0.125, 0.25, 0.125]])
    # The corner of the field at the origin lies in the middle of an edge of the square that is turned.
    half = np.array([-0.5, 0.5])
    means = means_over_cells(np.ones((1, 1)), np.array([0.0, 9.0]), np.array([-9.0, 9.0]), half, half, math.pi / 4)
    np.testing.assert_allclose(means, 0.5)
    quarter = means_over_cells(np.ones((1, 1)), np.array([0.0, 9.0]), np.array([0.0, 9.0]), half, half, math.pi / 4)
    np.testing.assert_allclose(quarter, 0.25)


def test_a_pose_is_found_to_a_hundred_thousandth_of_a_sensel():
    """Without noise least squares end where the residual is nothing; 1e-5 leaves room for its stopping rule."""
    found = register(LOAD, sensed(LOAD, **POSE))
    assert (found.quarter_turns, found.mirrored) == (0, False)
    assert found.shift_x == pytest.approx(POSE["shift"][0], abs=1e-5 * PITCH)
    assert found.shift_y == pytest.approx(POSE["shift"][1], abs=1e-5 * PITCH)
    assert found.angle == pytest.approx(POSE["angle"], abs=1e-7)
    assert found.overlap > 0.99999


@pytest.mark.parametrize(
    ("turns", "mirrored", "words"),
    [(2, False, "turned by 180°"), (1, False, "turned by 90°"), (0, True, "mirrored left to right"),
     (2, True, "mirrored front to back"), (3, True, "mirrored and turned by 270°")],
)  # fmt: skip
def test_a_print_that_is_mirrored_or_turned_is_found_and_told(turns, mirrored, words):
    made = tl.compare(
        LOAD, sensed(LOAD, shift=(0.01, 0.004), angle=-0.02, noise=0.03, turns=turns, mirrored=mirrored)
    )
    found = made.registration
    assert found.words == words
    # Noise of 3 % left 0.005 of a pitch and 0.013°, rms of six poses and six seeds: six times as much.
    assert (found.shift_x, found.shift_y) == pytest.approx((0.01, 0.004), abs=0.03 * PITCH)
    assert found.angle == pytest.approx(-0.02, abs=math.radians(0.08))
    told = next(text for text in made.warnings if text.startswith(f"the footprint was {words}"))
    assert 'read it with seen_from="below"' in told or not mirrored
    assert "% as it stands" in told


def test_a_symmetric_tread_is_left_as_it_stands():
    """Noise must not choose between images of one another."""
    load = ribbed(tilt=(0.0, 0.0))
    load = GridLoad(load.grid, 0.5 * (load.pressure + load.pressure[::-1]))
    made = tl.compare(load, sensed(load, noise=0.1, mirrored=True, seed=3))
    assert made.registration.words == "as it stands"
    assert not made.warnings


def test_measures_through_the_sensor_are_those_of_the_print(noisy):
    """What is left is the noise: 3 % of a sensel, of 700 loaded ones 0.1 %."""
    for name in ("print_load", "net_area", "mean_pressure"):
        assert noisy.difference(name) == pytest.approx(0, abs=5e-3)
    # One row of sensels of forty.
    for name in ("gross_area", "print_length", "print_width"):
        assert noisy.difference(name) == pytest.approx(0, abs=0.026)
    data = noisy.dataset
    assert float(data.largest_pressure.sel(map="seen")) <= 1.3e6
    assert float(data.largest_pressure.sel(map="computed")) == pytest.approx(LOAD.pressure.max())
    np.testing.assert_allclose(data.rib_share.sel(map="seen"), data.rib_share.sel(map="measured"), atol=2e-3)
    np.testing.assert_allclose(data.rib_share.sum("rib"), 1)
    # A mean of 0.03 sqrt(2/pi) lies between the lesser and the larger of two maps of which one has noise of 3 %, but
    # where both are saturated.
    free = noisy.footprint.pressure[~noisy.footprint.saturated].sum() / noisy.footprint.pressure.sum()
    assert float(data.overlap_of_pressure) == pytest.approx(1 - 0.03 * math.sqrt(2 / math.pi) * free, abs=4e-3)
    assert float(data.correlation) > 0.995
    difference = data.computed_pressure - data.measured_pressure
    np.testing.assert_allclose(data.pressure_difference, difference)


def test_the_summary_judges(noisy):
    text = noisy.summary()
    last = verdict_of(noisy)
    assert last.startswith("the computed contact agrees with the footprint: area ")
    assert " mm² (" in last
    assert " kPa (" in last
    assert "% of the pressure overlaps; of the ribs number" in last
    assert "net contact area" in text
    assert "load by rib" in text
    assert "the footprint lies askew by 3.3°" in text
    assert last[:150] in repr(noisy)


def test_the_sentence_has_the_numbers_of_the_table():
    """Materials 2021, 14, 2117: 58 761 mm² and 1532 kPa measured, 59 553 mm² and 1576 kPa computed.

    Made up of cells of 1 mm² that differ by just that.
    """

    def block(cells, peak):
        pressure = np.zeros(300 * 250)
        pressure[:cells] = 590e3
        pressure[1000] = peak
        return GridLoad.from_arrays(pressure.reshape(300, 250), spacing=1e-3)

    made = tl.compare(block(59553, 1576e3), block(58761, 1532e3), registration="none")
    assert "area 59553 against 58761 mm² (+1.3 %), peak 1576 against 1532 kPa (+2.9 %)" in made.sentence
    assert made.sentence.startswith("the computed contact agrees with the footprint")
    # Loads in the ratio of areas, overlap too.
    assert float(made.dataset.overlap_of_area) == pytest.approx(58761 / 59553)
    other = tl.compare(block(59553, 1576e3), block(40000, 1532e3), registration="none", load_tolerance=1.0)
    assert other.sentence.startswith("the computed contact differs from the footprint")


def test_another_load_is_told_or_refused():
    made = sensed(LOAD)
    told = tl.compare(LOAD, made.scaled_to("30 kN"), registration="none").warnings
    assert told[0].startswith("the footprint carries 30 kN and the contact 35 kN, 14.3 % less")
    with pytest.raises(tl.InputError, match=r"carries 20 kN and the contact 35 kN, 42\.9 % less, and at most 25 %"):
        tl.compare(LOAD, made.scaled_to("20 kN"))
    assert tl.compare(LOAD, made.scaled_to("20 kN"), registration="none", load_tolerance=0.5).warnings
    assert not tl.compare(LOAD, made.scaled_to("34 kN"), registration="none").warnings
    # A calibration that is off does not move it.
    off = sensed(LOAD, **POSE).scaled_to("30 kN")
    assert register(LOAD, off).shift_x == pytest.approx(POSE["shift"][0], abs=1e-3 * PITCH)


@pytest.mark.parametrize(("worth", "words"), [(98066.5, "kgf/cm2 and not kPa"), (6894.757, "psi and not kPa")])
def test_a_unit_that_was_not_told_is_guessed(worth, words):
    made = sensed(LOAD)
    with pytest.raises(tl.InputError, match=f"it would fit if its pressures were in .*{words}"):
        tl.compare(LOAD, made.scaled_to(made.normal_load * 1e3 / worth))


def test_sensels_that_are_missing_count_for_neither():
    made = sensed(LOAD)
    holes = np.zeros(made.grid.shape, dtype=bool)
    holes[13:17, 12:27] = True
    torn = Footprint(GridLoad(made.grid, np.where(holes, 0.0, made.pressure)), missing=holes)
    found = tl.compare(LOAD, torn)
    assert float(found.dataset.overlap_of_pressure) > 0.999
    assert found.difference("net_area") == 0
    assert np.isnan(found.dataset.computed_pressure).sum() == 60


def test_a_sensor_smaller_than_the_contact_says_so():
    made = tl.compare(LOAD, sensed(LOAD, cells=(24, 33)), load_tolerance=0.5, registration="shift")
    assert any("of the computed load lies beyond the sensor's cells" in text for text in made.warnings)
    assert float(made.dataset.overlap_of_pressure) > 0.99


def test_a_print_of_another_tread_differs():
    other = ribbed(tilt=(-2.0, 1.5))
    wide = GridLoad(other.grid, other.pressure * (np.abs(other.grid.y) > 0.03)[:, None])
    wide = replace(wide, pressure=wide.pressure * 35e3 / wide.normal_load)
    made = tl.compare(LOAD, sensed(wide))
    assert made.sentence.startswith("the computed contact differs from")
    assert float(made.dataset.overlap_of_pressure) < 0.8


def test_ribs_and_registration_may_be_given(noisy):
    again = tl.compare(LOAD, sensed(LOAD, **POSE, noise=0.03, threshold=10e3, saturation=1.3e6),
                       registration=noisy.registration, ribs=[-0.2, 0.0, 0.2])  # fmt: skip
    assert again.dataset.sizes["rib"] == 2
    np.testing.assert_allclose(again.dataset.computed_pressure, noisy.dataset.computed_pressure)
    with pytest.raises(tl.InputError, match="ribs must be two or more rising edges"):
        tl.compare(LOAD, LOAD, registration="none", ribs=[0.1, 0.0])


def test_what_is_no_contact_or_no_footprint():
    with pytest.raises(tl.InputError, match="compare takes a contact or a result that has one, got int"):
        tl.compare(3, LOAD)
    with pytest.raises(tl.InputError, match="compare takes a footprint, a GridLoad or the path of a file, got int"):
        tl.compare(LOAD, 3)
    with pytest.raises(tl.InputError, match="does not meet the computed contact anywhere"):
        tl.compare(LOAD, LOAD.moved(5.0), registration="none")
    with pytest.raises(tl.InputError, match="carries no load"):
        tl.compare(GridLoad(LOAD.grid, 0 * LOAD.pressure), LOAD)
    with pytest.raises(tl.InputError, match='registration must be "full"'):
        tl.compare(LOAD, LOAD, registration="half")


def test_a_comparison_is_saved_opened_and_reported(noisy, tmp_path):
    results = tl.open_results(tl.save_results(noisy, tmp_path / "c.nc"))
    back = results.comparison
    assert back.summary() == noisy.summary()
    assert back.registration == noisy.registration
    assert back.warnings == noisy.warnings
    np.testing.assert_array_equal(back.footprint.pressure, noisy.footprint.pressure)
    page = tl.report(results, tmp_path / "c.html").read_text("utf-8")
    for text in ("Computed and measured footprint", "agrees with the footprint", "their difference", "Ribs"):
        assert text in page
    assert "could not be drawn" not in page


def test_figures(noisy):
    maps = noisy.plot.maps()
    axes = [ax for ax in maps.axes if ax.get_xlabel()]
    assert [ax.get_title(loc="left") for ax in axes] == ["Computed, through the sensor", "Measured", "Difference"]
    assert all(ax.get_aspect() == 1 for ax in axes)
    assert {"contact pressure (kPa)", "computed less measured (kPa)"} <= {
        ax.get_ylabel() for one in axes for ax in one.child_axes
    }
    cuts = noisy.plot.cuts(x=0.0, y=0.05)
    highest = float(noisy.dataset.measured_pressure.max()) / 1e3
    drawn = max(line.get_ydata().max() for ax in cuts.axes for line in ax.get_lines() if len(line.get_ydata()) > 2)
    assert 0 < drawn <= highest * 1.001
    assert all(ax.get_ylim()[1] >= drawn for ax in cuts.axes)
    bars = noisy.plot.ribs().axes[0]
    assert len(bars.patches) == 8
    with pytest.raises(tl.InputError, match="lies beyond the maps"):
        noisy.plot.cuts(x=9.0)
    with pytest.raises(tl.InputError, match="this figure needs rib_left"):
        tl.plots.rib_shares(noisy.dataset.drop_vars("rib_left"))
    with pytest.raises(tl.InputError, match="print_load is not stated of the map 'seen', only of computed"):
        tl.plots.comparison_maps(noisy.dataset.isel(map=[0]))


def test_the_command_line(tmp_path):
    result = tl.save_results(LOAD, tmp_path / "r.nc")
    print_ = tmp_path / "print.asf"
    made = sensed(LOAD, pitch=8e-3, cells=(38, 34))
    print_.write_text(tekscan([made.pressure / 1e3], pitch="8 mm", digits="%.7g"))
    out = tmp_path / "c.nc"
    command = ["compare", str(result), str(print_), "-q", "-o", str(out), "--registration", "shift"]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    assert "the computed contact agrees with the footprint" in done.output
    assert float(tl.open_results(out).comparison.dataset.overlap_of_pressure) > 0.999
    wrong = CliRunner().invoke(app, ["compare", str(result), str(print_), "-q", "--units", "MPa"])
    assert wrong.exit_code == 2
    assert "leave units= out" in wrong.output
    nothing = CliRunner().invoke(app, ["compare", str(result), str(print_), "-q", "--load", "12 kN"])
    assert nothing.exit_code == 2
    assert "the footprint carries 12 kN and the contact 35 kN" in nothing.output


def test_the_page_on_measured_footprints_does_what_it_says(tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs/howto/measured_footprints.md").read_text("utf-8")
    monkeypatch.chdir(tmp_path)
    made = sensed(LOAD, pitch=8e-3, cells=(38, 34))
    # Travel up the page.
    upright = made.pressure.T[::-1] / 1e3
    Path("print.asf").write_text(tekscan([upright], pitch="8 mm", digits="%.7g"))
    Image.new("RGB", (4, 3), (0, 255, 0)).save("print.png")
    names = {}
    for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(code, names)
    np.testing.assert_allclose(names["footprint"].pressure, made.pressure, rtol=1e-6)
    assert names["painted"].peak_pressure == pytest.approx(600e3)
    assert names["comparison"].dataset.sizes["rib"] == 5
    table = tomllib.loads(re.findall(r"```toml\n(.*?)```", page, re.DOTALL)[0])["footprint"]
    assert Footprint(FootprintStep(**table).build(tmp_path)).normal_load == pytest.approx(35e3)
