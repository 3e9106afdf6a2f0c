"""Moving loads: what is refused, the elastic limits, kernels and wakes by themselves."""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import quad

import treadload as tl
from treadload.grid import Grid
from treadload.kernels.half_space.wake import Cells, delayed_fields
from treadload.kernels.layers import moving as kernels
from treadload.kernels.layers.wavenumbers import cells_spectrum, quadrature
from treadload.materials import Prony
from treadload.response import GridLoad

SOLID = Prony(8e9, ((0.5, 0.02), (0.4, 0.3)), 0.35)
BASE, SOIL = tl.Elastic(2e8, 0.3), tl.Elastic(5e7, 0.4)
GRID = Grid(9, 7, 0.02, 0.02, -0.08, -0.06)
KINDS = [f"{kind}_{c}" for kind in ("stress", "strain") for c in ("xx", "yy", "zz", "xy", "xz", "yz")]
KINDS += [f"displacement_{c}" for c in "xyz"]
POINTS = {"depths": [0.0, 0.004, 0.07, 0.15], "x": [-0.1, 0.0, 0.013], "y": [0.0, 0.05]}


def load(seed=0):
    rng = np.random.default_rng(seed)
    return GridLoad(GRID, rng.uniform(0, 1e6, GRID.shape), *rng.uniform(-3e5, 3e5, (2, *GRID.shape)))


def road(top=SOLID, bond=tl.pavement.BONDED):
    return tl.Pavement([tl.Layer(top, 0.08, name="asphalt", bond=bond), tl.Layer(BASE, 0.2), tl.Layer(SOIL)])


class Mix:
    """A material that waits for its temperature."""

    def at(self, temperature, *, extrapolate=False):
        return SOLID

    def __str__(self):
        return "mix"


@pytest.mark.parametrize(
    ("pavement", "speed", "message"),
    [
        (road(), None, r"layer 'asphalt' is viscoelastic .*give speed=, .*speed=0 for a load at rest"),
        (road(), -1.0, r"speed must be >= 0 m/s, got -1.0"),
        (road(), math.nan, r"speed must be >= 0 m/s, got nan"),
        (road(SOIL), -1.0, r"speed must be >= 0 m/s, got -1.0"),
        (road(Mix()), 10.0, r"layer 'asphalt' depends on temperature \(mix\).*Pavement.at_temperature"),
        (road(Prony(1e9, ((1.0, 0.1),), 0.3)), 10.0, r"a fluid has no elastic limit of slow loading"),
        (tl.Pavement.half_space(SOLID), None, r"give speed="),
    ],
)
def test_refusals(pavement, speed, message):
    with pytest.raises(tl.InputError, match=message):
        tl.solve_response(load(), pavement, depths=[0.0], speed=speed)


def test_no_depth_below_a_rigid_base():
    on_rock = tl.Pavement([tl.Layer(SOLID, 0.1), tl.Layer(BASE, 0.2)], rigid_base=True)
    with pytest.raises(tl.InputError, match=r"depth 0.4 m lies below the rigid base at 0.3 m"):
        tl.solve_response(load(), on_rock, depths=[0.4], speed=10.0)
    with pytest.raises(tl.InputError, match=r"wavenumbers, more than 2e\+07"):
        tl.solve_response(load(), road(), depths=[0.0], x=[0.0], y=[3000.0], speed=10.0)
    with pytest.raises(tl.InputError, match=r"points as far as 1999.91 m behind a load need .* cells of its wake"):
        tl.solve_response(load(), tl.Pavement.half_space(SOLID), depths=[0.0], x=[-2000.0], y=[0.0], speed=10.0)


@pytest.mark.parametrize(("slow", "limit"), [(1e-9, SOLID.rubbery), (1e9, SOLID.glassy)])
@pytest.mark.parametrize("layered", [True, False])
def test_limits_of_speed_are_elastic(slow, limit, layered):
    build = road if layered else tl.Pavement.half_space
    moved = tl.solve_response(load(), build(SOLID), speed=slow, **POINTS).dataset
    fixed = tl.solve_response(load(), build(limit), **POINTS).dataset
    for name in KINDS:
        largest = np.abs(fixed[name]).max(dim=("y", "x"))
        # The bound of the issue, by the largest value of each field at each depth.
        assert (np.abs(moved[name] - fixed[name]).max(dim=("y", "x")) <= 1e-6 * largest).all(), name


def test_rest_and_infinite_speed_are_the_limits_themselves():
    for speed, limit in ((0, SOLID.rubbery), (math.inf, SOLID.glassy)):
        moved = tl.solve_response(load(), road(), speed=speed, **POINTS).dataset
        fixed = tl.solve_response(load(), road(limit), **POINTS).dataset
        for name in KINDS:
            np.testing.assert_array_equal(moved[name], fixed[name])
        assert moved.attrs["speed"] == speed
        assert (moved["dissipated_energy"] == 0).all()


def test_speed_changes_nothing_on_elastic_layers():
    moved = tl.solve_response(load(), road(BASE), speed=20.0, **POINTS).dataset
    fixed = tl.solve_response(load(), road(BASE), **POINTS).dataset
    for name in KINDS:
        np.testing.assert_array_equal(moved[name], fixed[name])
    assert "dissipated_energy" not in fixed
    assert moved["dissipated_energy"].dims == ("depth", "y")


def test_surface_carries_the_load_exactly():
    surface = tl.solve_response(load(), road(), depths=[0.0], speed=20.0).dataset.isel(depth=0)
    # No ringing at steps: the residue is the quadrature, of waves that the first interface returns.
    np.testing.assert_allclose(surface["stress_zz"], -load().pressure, atol=1e-3)
    np.testing.assert_allclose(surface["stress_xz"], -load().traction_x, atol=1e-3)
    np.testing.assert_allclose(surface["stress_yz"], -load().traction_y, atol=1e-3)


def test_viscoelastic_layer_below_an_elastic_one():
    moved = tl.solve_response(
        load(), tl.Pavement([tl.Layer(BASE, 0.08), tl.Layer(SOLID, 0.2), tl.Layer(SOIL)]), speed=1e9, **POINTS
    ).dataset
    fixed = tl.solve_response(
        load(), tl.Pavement([tl.Layer(BASE, 0.08), tl.Layer(SOLID.glassy, 0.2), tl.Layer(SOIL)]), **POINTS
    ).dataset
    for name in KINDS:
        assert np.abs(moved[name] - fixed[name]).max() <= 1e-6 * np.abs(fixed[name]).max(), name


def test_a_sheet_that_nothing_holds_has_no_place():
    loose = road(bond=tl.pavement.FRICTIONLESS)
    solved = tl.solve_response(load(), loose, depths=[0.0, 0.15], x=[0.0], y=[0.0], speed=20.0)
    assert np.isnan(solved.dataset["displacement_x"][0]).all()
    assert np.isfinite(solved.dataset["displacement_x"][1]).all()
    assert any("nothing holds" in text for text in solved.warnings)


def test_blocks_change_nothing(monkeypatch):
    spectrum = cells_spectrum(load().array, 0.02, 0.02, -0.08, -0.06)
    body = kernels.Body(
        [lambda kx: SOLID.complex_modulus(20 * kx).conj(), 2e8, 5e7],
        [0.35, 0.3, 0.4],
        [0.08, 0.2, np.inf],
        [np.inf] * 2,
    )
    levels = [kernels.Level(0.0, 0, False, split=True), kernels.Level(0.1, 1, False)]
    panels = kernels.Path.of(300.0, (-0.09, 0.09), 1.0), quadrature(300.0, 0.3, 1.0)
    arguments = ([spectrum], body, levels, 300.0, np.array([-0.1, 0.0]), np.array([0.0, 0.05]), *panels)
    whole = kernels.moving_fields(*arguments)
    monkeypatch.setattr(kernels, "_BLOCK", 500)
    parts = kernels.moving_fields(*arguments)
    # Blocks cut the circle of wavenumbers in other steps, where waves have fallen to e^-48 of themselves.
    largest = np.abs(whole).max(axis=(0, 2, 3))
    assert (np.abs(parts - whole).max(axis=(0, 2, 3)) <= 1e-11 * largest).all()


@pytest.mark.parametrize("length", [0.004, 0.3, 40.0])
def test_wake_of_one_term_is_its_integral(length):
    """Displacement far to the side, where a row of cells acts as a line of forces behind the load."""
    strength, pressure, a = 3.0, 1e6, 0.1
    cells = Cells(
        np.array([1.0, 0, 0])[:, None, None] * pressure * np.ones((1, 50)), a / 50, 1e-4, -a / 2 + a / 100, 0.0
    )
    x, y = np.array([-0.5, 0.02, 0.3]), np.array([0.4])
    _, moved = delayed_fields(cells, [(strength, length)], np.array([0.0]), 1e9, 0.3, x, y)

    def wake(s):
        start = max(s, -a / 2)
        return strength * (math.exp(-(start - s) / length) - math.exp(-(a / 2 - s) / length)) if s < a / 2 else 0.0

    def expected(at):
        ends = np.unique([-60 * length - 1, *(-np.geomspace(1e-3, 60 * length + 1, 30)), -a / 2, a / 2, at])
        ends = ends[ends <= a / 2]
        parts = [
            quad(lambda s: wake(s) / math.hypot(at - s, 0.4), u, v, epsrel=1e-10)[0]
            for u, v in itertools.pairwise(ends)
        ]
        return 0.7 / (2 * math.pi * 1e9) * pressure * 1e-4 * sum(parts)

    # Fifty cells of the load: second order.
    np.testing.assert_allclose(moved[0, 2, 0], [expected(at) for at in x], rtol=1e-5)


def test_bilinear_loads_and_half_bonded_layers_keep_their_limits():
    soft = GridLoad(GRID, load().pressure, load().traction_x, load().traction_y, interpolation="bilinear")
    half = road(bond=tl.pavement.HALF_BONDED)
    points = {"depths": [0.0, 0.15], "x": [-0.1, 0.013], "y": [0.0]}
    for speed in (1e-9, 1e9):
        moved = tl.solve_response(soft, half, speed=speed, **points).dataset
        fixed = tl.solve_response(soft, half, speed=0 if speed < 1 else math.inf, **points).dataset
        for name in KINDS[:12]:
            assert np.abs(moved[name] - fixed[name]).max() <= 1e-6 * np.abs(fixed[name]).max(), name


def test_bilinear_wake_is_that_of_finer_cells():
    """Half-space, in between the limits: the bilinear load against itself on cells of a sixth."""
    x, y = GRID.x[:, None], GRID.y
    pressure = 1e6 * np.cos(8 * x.T) * np.cos(10 * y[:, None])
    soft = GridLoad(GRID, pressure, 0.2 * pressure, interpolation="bilinear")
    fine = Grid(60, 48, 0.02 / 6, 0.02 / 6, -0.1 + 0.01 / 6, -0.08 + 0.01 / 6)
    hats = [np.maximum(0, 1 - np.abs(f[:, None] - c) / 0.02) for f, c in ((fine.y, GRID.y), (fine.x, GRID.x))]
    parts = [hats[0] @ field @ hats[1].T for field in (soft.pressure, soft.traction_x)]
    points = {"depths": [0.02], "x": [-0.13, -0.05, 0.0], "y": [0.01], "speed": 1.0}
    one = tl.solve_response(soft, tl.Pavement.half_space(SOLID), **points).dataset
    other = tl.solve_response(GridLoad(fine, *parts), tl.Pavement.half_space(SOLID), **points).dataset
    for name in KINDS[6:]:
        # Both stand for the same load to second order in 3 mm over 20 mm of depth.
        assert np.abs(one[name] - other[name]).max() <= 5e-3 * max(
            float(np.abs(other[n]).max()) for n in (KINDS[6:12] if "strain" in name else KINDS[12:])
        ), name


def test_creep_over_a_hair_is_nearly_all_of_it():
    """A wheel so slow that creep ends within a tenth of a millimetre finds the road of slow loads, strain and all."""
    disc, points = tl.UniformDisc(0.15, 8e5), {"depths": [0.05], "x": [-0.2, 0.0, 0.1], "y": [0.0, 0.1]}
    longest = max(time for _, time in SOLID.creep_terms)
    moved = tl.solve_response(disc, tl.Pavement.half_space(SOLID), speed=1e-4 / longest, **points).dataset
    fixed = tl.solve_response(disc, tl.Pavement.half_space(SOLID.rubbery), **points).dataset
    for name in KINDS:
        # Fields move by the hair, 1e-4 of 50 mm of depth, and no more.
        scale = float(np.abs(fixed[name]).max())
        np.testing.assert_allclose(moved[name], fixed[name], atol=0.01 * scale, err_msg=name)
