"""The verdict on hand-made strain fields whose cracks are known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from treadload import variables
from treadload.damage import FatigueLine, FrenchBituminous, FrenchSubgrade, assess
from treadload.damage.cracks import ORIENTATIONS, crack_plane
from treadload.damage.laws.validity import warnings_of
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response
from treadload.response.fields import response_dataset

LINE = FatigueLine(120e-6, -0.2)


def unit(azimuth, tilt=0.0):
    """Direction at an azimuth from travel to the right and a tilt from the horizontal, degrees."""
    a, t = math.radians(azimuth), math.radians(tilt)
    return np.array([math.cos(a) * math.cos(t), math.sin(a) * math.cos(t), math.sin(t)])


def field(directions, strains):
    """Response, one row of points, each extended along one direction by one strain; depths 0 and 0.02."""
    pairs = zip(directions, strains, strict=True)
    full = [e * np.outer(v, v) - 0.1 * abs(e) * (np.eye(3) - np.outer(v, v)) for v, e in pairs]
    strain = np.array([[m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]] for m in full]).T[:, None, None, :]
    strain = np.concatenate([strain, 0.5 * strain], axis=1)
    x = 0.01 * np.arange(len(strains))
    dataset = response_dataset(1e9 * strain, strain, np.array([0.0, 0.02]), np.array([0.3]), x)
    return SimpleNamespace(dataset=dataset)


def local(response, line=LINE, *, depth=0.0, strain="principal", **more):
    """The points of a response as they are, in space."""
    return assess(response, line, depth=depth, strain=strain, **more)


CRACKS = [
    # azimuth and tilt of the extension, then trace and dip of the crack in degrees, and its word
    (0, 0, 90, 90, "transverse"),
    (10, 0, -80, 90, "transverse"),
    (90, 0, 0, 90, "longitudinal"),
    (-80, 0, 10, 90, "longitudinal"),
    (45, 0, -45, 90, "oblique"),
    (-45, 0, 45, 90, "oblique"),
    (30, 40, -60, 50, "oblique"),
    (90, 44, 0, 46, "longitudinal"),
    # Nearer to the horizontal than to the vertical: no crack runs down.
    (90, 46, None, 44, "horizontal"),
    (90, 60, None, 30, "horizontal"),
    (20, 80, None, 10, "horizontal"),
    (0, 90, None, 0, "horizontal"),
]


@pytest.mark.parametrize(("azimuth", "tilt", "trace", "dip", "word"), CRACKS)
def test_orientation_of_a_known_crack(azimuth, tilt, trace, dip, word):
    verdict = local(field([unit(azimuth, tilt)], [1e-4]), LINE)
    data = verdict.dataset
    assert verdict.orientation == word
    assert ORIENTATIONS[int(data["crack_orientation"].squeeze())] == word
    # Round-off of a principal direction.
    assert math.degrees(data["worst_crack_dip"]) == pytest.approx(dip, abs=1e-6)
    if trace is not None:
        assert math.degrees(data["worst_crack_angle"]) == pytest.approx(trace, abs=1e-6)
    assert word in verdict.summary()


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1))
def test_a_crack_is_perpendicular_to_the_extension(x, y, z):
    assume(math.hypot(x, y) > 1e-3)
    direction = np.array([x, y, z]) / math.hypot(x, y, z)
    angle, dip = crack_plane(direction)
    trace = np.array([math.cos(angle), math.sin(angle), 0])
    # Round-off of unit vectors.
    assert abs(trace @ direction) < 1e-14
    assert math.cos(dip) == pytest.approx(abs(direction[2]), abs=1e-14)
    assert -math.pi / 2 < angle <= math.pi / 2
    again, _ = crack_plane(-direction)
    assert abs(math.sin(angle - again)) < 1e-14


def test_the_worst_point_and_its_passes():
    response = field([unit(0), unit(90), unit(45)], [50e-6, 240e-6, 60e-6])
    verdict = local(response, LINE)
    data = verdict.dataset
    assert float(data["worst_x"]) == 0.01
    assert float(data["worst_y"]) == 0.3
    # Round-off of an eigenvalue, to the fifth power.
    assert float(data["worst_strain"]) == pytest.approx(240e-6, rel=1e-12)
    assert float(data["worst_passes"]) == pytest.approx(1e6 / 32, rel=1e-11)
    np.testing.assert_allclose(data["allowable_passes"][0], 1e6 * (np.array([50, 240, 60]) / 120) ** -5.0, rtol=1e-11)
    np.testing.assert_array_equal(data["crack_orientation"][0], [2, 1, 3])


def test_every_variable_has_its_name_and_unit():
    data = local(field([unit(0)], [1e-4]), LINE).dataset
    assert set(data.data_vars) <= set(variables.VARIABLES)
    assert len(data.data_vars) == 14
    for name in data.data_vars:
        assert data[name].attrs == variables.attributes(name)
        dims = {"extension_by_depth": ("depth",)}.get(name, () if name.startswith("worst") else ("y", "x"))
        assert data[name].dims == dims


def test_another_depth():
    response = field([unit(0)], [100e-6])
    assert float(local(response, LINE, depth=0.02).dataset["worst_strain"]) == pytest.approx(50e-6, rel=1e-12)
    with pytest.raises(InputError, match=r"no depth 0.01 m, it has 0, 0.02 m"):
        local(response, LINE, depth=0.01)


def test_in_plane_reads_the_plane_and_says_both():
    tilted = field([unit(45, 45)], [100e-6])
    space, plane = local(tilted, LINE), local(tilted, LINE, strain="in-plane")
    expected = float(tilted.dataset["in_plane_strain_1"][0, 0, 0])
    assert float(plane.dataset["worst_strain"]) == expected
    # e (cos² 45° - 0.1 sin² 45°)
    assert expected == pytest.approx(45e-6, rel=1e-12)
    assert math.degrees(plane.dataset["worst_crack_dip"]) == pytest.approx(90, abs=1e-9)
    assert math.degrees(space.dataset["worst_crack_dip"]) == pytest.approx(45, abs=1e-6)
    for verdict in (space, plane):
        rows = {row.key: row for row in verdict.rows()}
        assert rows["largest_principal_strain"].text == "100.0 microstrain"
        assert rows["largest_in_plane_strain"].text == "45.0 microstrain"
    assert str({row.key: row.value for row in plane.rows()}["evaluation"]).startswith("in-plane strain")


def test_nothing_extends_nothing_cracks():
    data = field([unit(0), unit(90)], [-1e-4, 1e-4])
    mixed = local(data, LINE).dataset
    np.testing.assert_array_equal(mixed["crack_orientation"][0], [0, 1])
    assert np.isnan(mixed["crack_angle"][0, 0])
    assert np.isinf(mixed["allowable_passes"][0, 0])
    squeezed = SimpleNamespace(
        dataset=response_dataset(
            np.zeros((6, 1, 1, 1)),
            -1e-4 * np.array([1.0, 2, 3, 0, 0, 0])[:, None, None, None],
            np.zeros(1),
            np.zeros(1),
            np.zeros(1),
        )
    )
    verdict = local(squeezed, LINE)
    assert verdict.orientation == "none"
    assert "predicts no cracking" in verdict.summary()


def test_the_tolerance_moves_the_border():
    response = field([unit(60)], [1e-4])
    assert local(response, LINE).orientation == "oblique"
    assert local(response, LINE, oblique_tolerance=math.radians(31)).orientation == "longitudinal"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"strain": "largest"}, "strain must be"),
        ({"oblique_tolerance": 0.0}, "oblique_tolerance"),
        ({"oblique_tolerance": 15.0}, "oblique_tolerance"),
        ({"depth": math.nan}, "no depth"),
    ],
)
def test_refusals(changes, message):
    with pytest.raises(InputError, match=message):
        local(field([unit(0)], [1e-4]), LINE, **changes)


def test_ahead_of_a_driving_footprint_the_road_is_torn_across():
    # Uniform shear to the back pulls the road ahead of the footprint: extension along x, a transverse crack.
    grid = Grid.centred(0.3, 0.3, 0.01)
    x, y = np.meshgrid(grid.x, grid.y)
    inside = (np.abs(x) < 0.1) & (np.abs(y) < 0.1)
    load = GridLoad(grid, 7e5 * inside, -4e5 * inside)
    response = solve_response(load, Pavement.half_space(Elastic(5.4e9, 0.35)), depths=[0.0])
    verdict = assess(response, LINE)
    assert verdict.orientation == "transverse"
    # At the leading edge, inside or outside it by half a cell.
    assert float(verdict.dataset["worst_x"]) == pytest.approx(0.1, abs=0.0051)


def test_a_law_in_place_of_a_line():
    law = FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3)
    verdict = local(field([unit(0)], [1e-4]), law)
    # Round-off of an eigenvalue, to the fifth power.
    assert float(verdict.dataset["worst_passes"]) == pytest.approx(law.allowable_passes(1e-4), rel=1e-11)
    assert verdict.dataset.attrs["epsilon_6"] == law.at_a_million
    assert verdict.warnings == warnings_of(law, 1e-4)
    assert f"Allowable load repetitions: {law.allowable_passes(1e-4):.3g}. " in verdict.summary()


def test_extrapolation_stands_in_the_summary():
    verdict = local(field([unit(0)], [1e-2]), LINE)
    assert any(line.startswith("warning: ") and "extrapolated" in line for line in verdict.summary().splitlines())


def test_a_law_that_reads_no_extension_is_refused():
    with pytest.raises(InputError, match="is for the vertical strain on the subgrade"):
        local(field([unit(0)], [1e-4]), FrenchSubgrade())
