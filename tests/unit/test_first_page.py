"""Where a road would crack first, by whom: the page, its figure, and where words of cracks may stand."""

import json
import re

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload import variables
from treadload.damage import (
    Climate,
    Criterion,
    FatigueLine,
    FrenchSubgrade,
    Limit,
    MazarsStrain,
    OctahedralRatio,
    miner,
)
from treadload.damage.cracks import ORIENTATIONS, in_a_cell, opens_down
from treadload.damage.quantity import IN_THE_PLANE, STRESS, in_tension
from treadload.damage.traffic import AxleClass, Traffic
from treadload.plots import cracks, first_places
from treadload.plots.first import failing_order
from treadload.reporting import write_report
from treadload.reporting.first import first_of_life, first_of_response
from treadload.reporting.reading import ReportCase
from treadload.reporting.typesetting import typeset
from treadload.results import to_tree
from treadload.rows import row
from treadload.variables import Display

LINE = FatigueLine(120e-6, -0.2)
Y = np.linspace(-0.2, 0.2, 21)
# What may be said of cracks where none opens.
DENIED = re.compile(r"no crack|predicts no crack|none runs down|cracks? side|would crack")


def a_life(dips=(90.0, 90.0, np.nan, np.nan), years=20.0):
    """Four criteria by their dips, degrees: an extension, Mazars, a limit, a soil."""
    criteria = (
        Criterion("top-down", LINE, 0, "top"),
        Criterion("by Mazars", FatigueLine(150e-6, -0.2, MazarsStrain()), 0, "top"),
        Criterion("shoving", Limit(OctahedralRatio(2e5, 0.7), 1.0), 0, "top"),
        Criterion("soil", FrenchSubgrade(), -1, "top"),
    )
    shape = np.exp(-0.5 * (Y / 0.05) ** 2)
    peaks = np.array([[100e-6, 60e-6], [140e-6, 90e-6], [0.6, 0.3], [300e-6, 200e-6]])
    values = peaks[:, :, None, None] * shape
    dip = np.radians(np.array(dips))[:, None, None, None] * np.ones(values.shape)
    angle = np.where(np.isnan(dip), np.nan, 0.0)
    classes = (AxleClass("heavy", 0.5, 35e3, 8e5), AxleClass("light", 0.5, 20e3, 7e5))
    traffic = Traffic(classes, 1e5, years=years)
    life = miner(values, criteria, traffic, Climate.constant(15.0), y=Y, cracks=(angle, dip))
    depth = ("criterion", [0.0, 0.0, 0.0, 0.21], variables.attributes("read_depth"))
    return tl.damage.Life(
        life.dataset.assign(read_depth=depth), life.criteria, life.traffic, life.climate, life.readings, life.laws
    )


def test_a_small_reading_is_told_by_a_power_of_ten():
    mean, extension = (tl.damage.known_quantities()[name] for name in ("mean_stress", "extension_strain"))
    for quantity, value, text in (
        (mean, 16.9, "1.69×10⁻⁵ MPa"),
        (mean, 0.782e6, "0.782 MPa"),
        (extension, 223e-6, "223 microstrain"),
    ):
        assert typeset(row("largest_reading", value, display=Display("", "", quantity.in_words))) == text


def test_all_criteria_stand_side_by_side_in_the_order_in_which_they_fail():
    life = a_life()
    page = first_of_life(to_tree(life)["life"].to_dataset())
    years = [life.years(line[0]) for line in page.rows]
    assert years == sorted(years)
    by_name = {line[0]: dict(zip(page.columns, line, strict=True)) for line in page.rows}
    assert page.rows[0][0] in page.sentence
    # Who, what, where, which way, by which class in which season, how much of what is allowed, after how long.
    top = by_name["top-down"]
    assert top["author"] == "Materials 2021, 14, 2117"
    assert top["largest evaluated value"] == "100 microstrain"
    assert (top["depth, mm"], top["y, mm"]) == ("0", "0")
    assert top["first crack"].startswith("longitudinal (100 % of the damage)")
    assert top["most damage by"] == "heavy, all year (93 %)"
    allowed = LINE.allowable_strain(1e5 * 20.0)
    assert float(top["utilisation in 20 years"]) == pytest.approx(100e-6 / allowed, rel=0.05)  # two digits
    assert by_name["by Mazars"]["author"] == "Mazars (1986)"
    assert by_name["soil"]["author"] == "NF P98-086 (2019)"
    assert by_name["soil"]["depth, mm"] == "210, top of a layer"
    assert by_name["soil"]["first crack"] == "ruts, no crack"
    shoving = by_name["shoving"]
    assert (shoving["most damage by"], shoving["damage in 20 years"], shoving["service life"]) == (
        "no damage", "0", "never",
    )  # fmt: skip
    assert shoving["utilisation in 20 years"] == "0.6"
    figure = first_places(life)
    bars = sorted((bar for bar in figure.axes[1].patches), key=lambda bar: -bar.get_y())
    used = life.dataset.design_utilisation.to_numpy()
    np.testing.assert_allclose([bar.get_width() for bar in bars], used[failing_order(life.dataset)], rtol=1e-12)


@pytest.mark.usefixtures("figures_as_dots")
def test_a_page_without_a_crack_does_not_speak_of_one(tmp_path):
    """All planes nearer to the horizontal than 45°, or none: no orientation, no "crack" but where it is denied."""
    life = a_life((44.0, 20.0, np.nan, np.nan))
    page = first_of_life(to_tree(life)["life"].to_dataset())
    assert page.heading == "Predicted failure by criterion"
    said = " ".join([page.heading, page.sentence, *(cell for row in page.rows for cell in row)])
    assert not re.search("crack|longitudinal|transverse|oblique", DENIED.sub("", said))
    assert "parallel to the surface (100 % of the damage)" in said
    steep = first_of_life(to_tree(a_life((46.0, 20.0, np.nan, np.nan)))["life"].to_dataset())
    assert steep.heading == "Predicted cracking by criterion"
    html = write_report({"a": to_tree(life)}, tmp_path / "r.html").read_text()
    assert "Predicted failure by criterion" in html
    assert "Where would it crack first" not in html


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_words_of_a_crack_stand_only_where_one_runs_down(orientation):
    told = in_a_cell(orientation)
    if opens_down(orientation):
        assert told == orientation
    else:
        assert not re.search("crack|longitudinal|transverse|oblique", told)


def verdict_of(stress, strain):
    """A verdict of one point of uniform stress and strain tensors, as xx, yy, zz, and its report."""
    zero = np.zeros((1, 3, 3))
    fields = {f"{kind}_{name}": zero for kind in ("stress", "strain") for name in ("xy", "xz", "yz")}
    for kind, values in (("stress", stress), ("strain", strain)):
        fields |= {f"{kind}_{name}": zero + value for name, value in zip(("xx", "yy", "zz"), values, strict=True)}
    largest = int(np.argmax(strain))
    fields |= {
        "principal_strain_1": zero + max(strain), "in_plane_strain_1": zero + max(strain[:2]),
        "in_plane_angle_1": zero + (0.0 if strain[0] >= strain[1] else np.pi / 2),
    }  # fmt: skip
    at = {"depth": [0.0], "y": [-0.01, 0.0, 0.01], "x": [-0.01, 0.0, 0.01]}
    data = xr.Dataset({name: (("depth", "y", "x"), value) for name, value in fields.items()}, at)
    direction = np.zeros((1, 3, 3, 3))
    direction[..., largest] = 1.0
    data["principal_direction_1"] = (("depth", "y", "x", "component"), direction)
    return tl.assess(data, LINE, depth=0.0, strain="principal")


PRESSED = verdict_of((-1.1e6, -0.71e6, -0.11e6), (-1e-4, 2e-5, 8e-5))
SPLIT = verdict_of((-1.1e6, -0.7e6, 0.2e6), (-1e-4, 2e-5, 8e-5))
TORN = verdict_of((1.1e6, 0.7e6, 0.0), (1e-4, 2e-5, -8e-5))


@pytest.mark.parametrize(("verdict", "word"), [(PRESSED, "none"), (SPLIT, "horizontal"), (TORN, "transverse")])
def test_every_sentence_of_a_verdict_keeps_to_it(verdict, word):
    """Summary, sentence and table of the report, title and note of the figure."""
    assert verdict.orientation == word
    case = ReportCase.of("a", to_tree(verdict))
    figure = cracks(verdict)
    drawn = [text.get_text() for ax in figure.axes for text in ax.texts] + [figure.axes[0].get_title(loc="left")]
    legend = figure.axes[0].get_legend()
    drawn += [text.get_text() for text in legend.get_texts()] if legend else []
    shown = " ".join(row.sentence for row in case.rows("damage") if row.key != "law")
    said = [verdict.summary(), case.verdict, shown, *drawn]
    if word == "transverse":
        assert all("transverse" in text for text in said[:3])
        return
    left = " ".join(DENIED.sub("", text.replace("No crack to expect", "")) for text in said)
    assert not re.search("crack|longitudinal|transverse|oblique", left), left
    if word == "none":
        assert "only where no principal stress is tensile" in case.verdict
        assert np.isnan(verdict.dataset["crack_dip"]).all()


def test_a_response_names_the_largest_of_every_quantity_and_denies_cracks_where_all_is_pressed():
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    at = np.linspace(-0.06, 0.06, 7)
    pressed = tl.solve_response(tl.UniformDisc(0.15, 8e5), road, depths=[0.0, 0.02], x=at, y=at).dataset
    page = first_of_response(pressed)
    assert page.heading == "Largest values by criterion"
    rows = {row[0]: row for row in page.rows}
    # No two of them are called the same.
    assert len(rows) == len(page.rows)
    assert {"tensile strain, three-dimensional", "tensile strain, in the horizontal plane"} <= set(rows)
    assert rows["octahedral shear stress"][1] == "Lytton, with the mean stress"
    # A table for people has no names of code in it.
    assert not any("_" in cell for row in page.rows for cell in row)
    assert rows["principal tension"][2:5] == ("none", "–", "–")
    assert not any(opens_down(row[4].split(" ")[0]) for row in page.rows if row[4] in ORIENTATIONS)
    drag = tl.UniformRectangle(0.2, 0.2, 8e5, traction_x=-4e5)
    wide = np.linspace(-0.2, 0.2, 9)
    # A half-space: on layers the bending presses the surface.
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    torn = tl.solve_response(drag, road, depths=[0.0], x=wide, y=wide).dataset
    page = first_of_response(torn)
    assert page.heading == "Predicted cracking by criterion"
    tension = next(row for row in page.rows if row[0] == "tensile stress")
    assert tension[4] == "transverse"
    value = float(tl.damage.compute_quantities(torn, ["horizontal_tension"])["horizontal_tension"].max())
    assert tension[2] == f"{value * 1e-6:.3g} MPa"


def test_a_criterion_below_has_no_crack_where_the_plane_is_pressed():
    """The sentence of its direction needs tension as well; what it reads stays the law's."""
    low = Criterion("base", tl.damage.ShellFatigue(5e9), 0)
    assert set(IN_THE_PLANE) <= set(low.needs)
    ones = np.ones((1, 2))
    fields = {"strain_xx": [[2e-5, 2e-5]], "strain_yy": [[0, 0]], "strain_xy": [[0, 0]]}
    fields |= {"stress_xx": [[1e5, -1e5]], "stress_yy": -3e5 * ones, "stress_xy": 0 * ones}
    data = xr.Dataset({name: (("y", "x"), np.asarray(value)) for name, value in fields.items()})
    np.testing.assert_array_equal(low.read(data), 2e-5 * ones)
    angle, dip = low.crack(data)
    np.testing.assert_array_equal(np.isnan(dip), [[False, True]])
    assert angle[0, 0] == pytest.approx(np.pi / 2)
    full = data.assign({name: data["stress_xy"] for name in STRESS if name not in data})
    np.testing.assert_array_equal(in_tension(full, upright=True), [[True, False]])


def test_the_file_says_who_proposed_what_and_how_it_is_calibrated():
    data = to_tree(a_life())["life"].to_dataset()
    assert [one["calibrated"] != "" for one in json.loads(data.attrs["reads"])] == [True] * 4
    assert json.loads(data.attrs["places"]) == ["top"] * 4
