"""A tread on an inflated belt: its operator against closed forms, and what a tire on it does."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import k0

import treadload as tl
from treadload.catalogue import belts
from treadload.contact.bodies import HalfSpaces, Influence, Offsets, surface_of
from treadload.contact.bodies.belt import belt_surface
from treadload.contact.cautions import of_tire
from treadload.errors import InputError
from treadload.kernels.belt import Sheet, coefficients, string
from treadload.tire import LateralBelt, ProfileSurface, TreadProfile
from treadload.tire.crown import arc_radius

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
SMOOTH = TreadProfile(rolling_radius=0.5, crown_radius=0.9, width=0.24)
LATERAL = LateralBelt(0.3e6, 0.65)
BELT = tl.tire.Belt(lateral=LATERAL)


def inflated(belt, pressure=800e3, radius=0.5, crown=0.9):
    return belt.inflated(pressure, radius, crown)


def test_a_membrane_deflects_as_the_bessel_function_says():
    sheet = Sheet(3.5e5, 3.5e5, (0.0, 0.0, 0.0), 4e6, 0.0, 3.4)
    cell, decay = 3e-3, math.sqrt(3.5e5 / 4e6)
    found = coefficients(sheet, 60, 60, cell, cell)[0]
    y, x = np.indices(found.shape) * cell
    distance = np.hypot(x, y)
    expected = cell**2 * k0(np.where(distance > 0, distance, 1.0) / decay) / (2 * np.pi * 3.5e5)
    far = distance >= 10 * cell
    # The images round the ring and the period across add 1e-4, the cell's own size 1e-3 at ten cells.
    np.testing.assert_allclose(found[far], expected[far], rtol=2e-3)


def test_kernels_are_derivatives_of_the_deflection():
    sheet = Sheet(3.5e5, 8e4, (80.0, 150.0, 100.0), 4e6, 0.02, 3.4)
    step, here = 1e-4, 7e-3

    def at(number, x):
        return coefficients(sheet, 4, 3, 3e-3, 3e-3, x)[number]

    ahead, behind = (at(0, here + side * step) for side in (1, -1))
    slope, bend = (ahead - behind) / (2 * step), (ahead - 2 * at(0, here) + behind) / step**2
    twist = (at(5, here + step) - at(5, here - step)) / (2 * step)
    # u_n = C (p - a ∇·q) and u_t = a ∇ u_n; central differences of a tenth of a millimetre err by 1e-4.
    for found, expected in ((at(4, here), -0.02 * slope), (at(1, here), -0.0004 * bend), (at(3, here), 0.02 * twist)):
        np.testing.assert_allclose(found, expected, rtol=0, atol=3e-4 * np.abs(expected).max())


def test_across_and_along_change_places():
    one = Sheet(3e5, 2e5, (80.0, 150.0, 100.0), 4e6, 0.02, 3.4)
    other = replace(one, tension_x=2e5, tension_y=3e5, bending=(100.0, 150.0, 80.0))
    found, turned = coefficients(one, 6, 6, 4e-3, 4e-3), coefficients(other, 6, 6, 4e-3, 4e-3).transpose(0, 2, 1)
    # The ring and the period across differ: their images are 2e-4 of the deflection.
    for row, twin in ((0, 0), (1, 2), (3, 3), (4, 5)):
        np.testing.assert_allclose(found[row], turned[twin], rtol=0, atol=5e-4 * np.abs(found[row]).max())


def test_the_string_holds_a_uniform_load_by_its_foundation():
    x = 2e-3 * np.arange(-6000, 6001)
    moved = string(0.3e6, 0.65, x, 2e-3, 3e-3)
    # Equilibrium of the whole string: Σ k u dx is the force on the cell.
    assert moved.sum() * 2e-3 * 0.3e6 == pytest.approx(2e-3 * 3e-3, rel=1e-6)
    assert moved[6000] == pytest.approx(2e-3 * 3e-3 / (2 * 0.3e6 * 0.65), rel=2e-3)
    np.testing.assert_allclose(moved, moved[::-1], rtol=1e-12)
    assert moved[6000 + 325] / moved[6000] == pytest.approx(math.exp(-1), rel=2e-3)


@pytest.mark.parametrize(
    "belt",
    [pytest.param(BELT, marks=pytest.mark.slow), tl.tire.Belt(tread=tl.Elastic(5e6, 0.5), arm=0.0)],
    ids=["whole", "no arm"],
)
@pytest.mark.slow
def test_the_operator_is_symmetric_and_positive(belt):
    n, cell = 16, 8e-3
    influence = Influence((n, n), cell, cell, belt_surface(inflated(belt)))
    matrix = np.empty((3 * n * n, 3 * n * n))
    for column in range(3 * n * n):
        load = np.zeros(3 * n * n)
        load[column] = 1.0
        p, qx, qy = load.reshape(3, n, n)
        along, across, opening = influence.displacement(p, np.array([qx, qy]))
        matrix[:, column] = np.concatenate([opening.ravel(), along.ravel(), across.ravel()])
    largest = np.abs(matrix).max()
    assert np.abs(matrix - matrix.T).max() < 1e-12 * largest
    values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
    assert values[0] > 1e-3 * values[-1]


def test_a_tread_layer_of_a_metre_is_a_half_space():
    tread = tl.Elastic(5e6, 0.47)
    deep = tl.tire.Belt(tread=tread, tread_thickness=1.0, arm=0.0, sidewall_stiffness=1e16)
    at = Offsets(5, 5, 4e-3, 4e-3)
    found, expected = belt_surface(inflated(deep)), HalfSpaces.of(tread, None)
    for name in ("normal", "tangential", "coupling"):
        one, other = getattr(found, name)(at), getattr(expected, name)(at)
        # A rigid base at 1 m takes about (1 - ν²) a/(π h) of the own cell's displacement: 0.2 %.
        np.testing.assert_allclose(one, other, rtol=0, atol=5e-3 * np.abs(expected.normal(at)).max())


def test_preconditioners_are_near_the_inverse():
    influence = Influence((48, 48), 4e-3, 4e-3, belt_surface(inflated(BELT)))
    y, x = np.indices((48, 48))
    load = np.cos(2 * np.pi * 5 * x / 48) * np.cos(2 * np.pi * 3 * y / 48)
    symbol = influence.normal_stiffness
    back = np.fft.irfft2(symbol * np.fft.rfft2(influence.normal(load)), s=load.shape)
    middle = slice(12, 36)
    assert np.abs(back - load)[middle, middle].max() < 0.2


def test_a_string_on_a_foundation_under_a_cylinder():
    # Closed form: λ = √(k/T), δ = a²/2R + a/(R λ), load per width 2 [T a/R + k (a³/3R + a²/(R λ))].
    tension, foundation, radius, half, cell = 4e5, 3e6, 0.5, 0.0605, 1e-3
    rate = math.sqrt(foundation / tension)
    approach = half**2 / (2 * radius) + half / (radius * rate)
    load = 2 * (tension * half / radius + foundation * (half**3 / (3 * radius) + half**2 / (radius * rate)))
    x = cell * (np.arange(161) - 80)
    # A cell as wide as the period across, 2 m, loads every row alike.
    kernel = coefficients(Sheet(tension, 1.0, (0.0, 0.0, 0.0), foundation, 0.0, 12.0), 1, 161, cell, 2.0)[0, 0]
    matrix = kernel[np.abs(np.subtract.outer(np.arange(161), np.arange(161)))]
    gap = x**2 / (2 * radius)
    inside = np.abs(x) < half
    pressure = np.zeros(161)
    pressure[inside] = np.linalg.solve(matrix[np.ix_(inside, inside)], approach - gap[inside])
    assert pressure.sum() * cell == pytest.approx(load, rel=1e-4)
    assert pressure[80] == pytest.approx(tension / radius + foundation * approach, rel=1e-3)
    # The touching cells are those of the closed form: one more would be pulled, the next outside lies clear.
    lifted = gap + matrix @ pressure - approach
    assert pressure[inside].min() > 0
    assert lifted[~inside].min() > -1e-9


@pytest.fixture(scope="module")
def smooth():
    belt = tl.tire.Belt(tread_thickness=2e-3, bending=(0.0, 0.0, 0.0), arm=0.0)
    tire = tl.Tire(ProfileSurface(SMOOTH), inflation_pressure=800e3, belt=belt)
    return tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=25e3, friction=0.0), spacing=6e-3)


def test_the_plateau_of_a_smooth_tread_is_the_inflation_and_its_foundation(smooth):
    data = smooth.dataset
    middle = float(data.pressure.sel(x=0, y=0, method="nearest"))
    # Two millimetres of tread give way by 0.05 mm: the belt deflects by the approach.
    assert middle == pytest.approx(800e3 * (1 + 3.6 * float(data.approach)), rel=0.01)


def test_inflation_gives_the_tensions_of_laplace():
    carcass = inflated(tl.tire.Belt(), 820e3, 0.54, 1.2)
    sheet = carcass.sheet
    assert sheet.tension_y == pytest.approx(0.098 * 820e3)
    assert sheet.tension_x / 0.54 + sheet.tension_y / 1.2 == pytest.approx(820e3)
    assert sheet.foundation == pytest.approx(3.6 * 820e3)
    assert inflated(tl.tire.Belt(), 820e3, 0.54, math.inf).sheet.tension_x == pytest.approx(0.54 * 820e3)
    assert inflated(tl.tire.Belt(crown_radius=2.0), 820e3, 0.54, 1.2).crown_radius == 2.0


@pytest.fixture(scope="module")
def ribbed():
    return tl.Tire.from_profile(
        "315/80R22.5", inflation_pressure=820e3, belt=tl.tire.Belt.from_library("315/80R22.5")
    )


def shoulder_over_centre(contact):
    rows = contact.dataset.pressure.sum("x")
    y = np.abs(rows.y)
    return float(rows.where(y > 0.09).sum() / 2 / rows.where(y < 0.028).sum())


def test_shoulders_rise_with_the_load(ribbed):
    ratios = []
    for load in (15e3, 25e3, 35e3):
        contact = tl.solve_contact(ribbed, ROAD, tl.Rolling(normal_load=load, friction=0.0), spacing=6e-3)
        ratios.append(shoulder_over_centre(contact))
    assert ratios[0] < 1 < ratios[2]
    assert ratios == sorted(ratios)


def test_free_rolling_shears_the_road_and_carries_no_force(ribbed):
    contact = tl.solve_contact(ribbed, ROAD, tl.Rolling(normal_load=30e3, friction=0.7), spacing=6e-3, tolerance=1e-6)
    data = contact.dataset
    total = 0.7 * float(data.normal_load)
    assert abs(float(data.tractive_force)) < 1e-9 * total
    assert abs(float(data.lateral_force)) < 1e-9 * total
    # A tread that is its own mirror image: q_y odd and q_x even across, within the tolerance of slip.
    across, along = data.traction_y.values, data.traction_x.values
    largest = np.abs(across).max()
    assert np.abs(across + across[::-1]).max() < 1e-3 * largest
    assert np.abs(along - along[::-1]).max() < 1e-3 * largest
    # Rubber that is pressed bulges, and the belt that flattens carries the ribs along: the road feels both.
    assert largest > 0.02 * float(data.pressure.max())
    # The wheel rolls on a radius that is a little less than its own.
    assert -0.03 < float(data.creepage_x) < -0.005


def test_rows_of_smaller_radius_drag(ribbed):
    round_belt = replace(ribbed, belt=replace(ribbed.belt, belt_radius=0.8))
    grid = tl.response.Grid.centred(0.1, 0.28, 0.01)
    slip = round_belt.row_slip(grid)
    assert slip.shape == (grid.ny, 1)
    assert slip[0, 0] == pytest.approx(grid.y[0] ** 2 / (2 * 0.8 * 0.538))
    assert not ribbed.row_slip(grid).any()
    wheel = tl.Rolling(normal_load=30e3, friction=0.7)
    plain, rounded = (tl.solve_contact(tire, ROAD, wheel, spacing=8e-3).dataset for tire in (ribbed, round_belt))
    shoulder, middle = np.abs(plain.y.values) > 0.09, np.abs(plain.y.values) < 0.028
    # A dragging row is braked: the road pushes it back, and it pushes the road forward, along +x.
    change = (rounded.traction_x - plain.traction_x).sum("x").values
    assert change[shoulder].sum() > 0 > change[middle].sum()


SOLID = tl.materials.Prony.standard_linear_solid(6e6, 4e6, 5e-3, 0.47)


@pytest.mark.slow
def test_a_tread_that_remembers_lies_between_its_limits():
    at, carcass = Offsets(3, 8, 8e-3, 8e-3, -5 * 8e-3), inflated(tl.tire.Belt(tread=SOLID))
    fast, slow = (belt_surface(inflated(tl.tire.Belt(tread=limit))) for limit in (SOLID.glassy, SOLID.rubbery))
    between = belt_surface(carcass, 10.0).normal(at)
    assert fast.normal(at)[0, 5] < between[0, 5] < slow.normal(at)[0, 5]
    # Behind the load, at x < 0, material is still giving way; ahead it has not begun.
    assert between[0, 4] > between[0, 6]
    for speed, limit in ((1e5, fast), (1e-5, slow)):
        for name in ("normal", "tangential", "coupling"):
            found, expected = (getattr(body, name)(at) for body in (belt_surface(carcass, speed), limit))
            # Of the memory's rules over a cell, 1e-7, and of the 5e-4 m over which it still fades at this speed.
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-4 * np.abs(limit.normal(at)).max())
    rest = belt_surface(carcass, 10.0).at_rest
    np.testing.assert_allclose(rest.normal(at), slow.normal(at), rtol=1e-12)


def test_a_tread_that_remembers_needs_a_speed_and_steady_rolling():
    tire = tl.Tire(ProfileSurface(SMOOTH), inflation_pressure=800e3, belt=tl.tire.Belt(tread=SOLID))
    wheel = tl.Rolling(normal_load=10e3, friction=0.0)
    with pytest.raises(InputError, match="give the rolling speed"):
        tl.solve_contact(tire, ROAD, wheel)
    with pytest.raises(InputError, match="elastic tires only"):
        tl.contact.solve_transient(tire, ROAD, wheel, distances=[0.0])


@pytest.mark.slow
def test_a_tread_that_remembers_presses_harder_on_the_way_in():
    profile = replace(SMOOTH, width=0.12)
    tire = tl.Tire(ProfileSurface(profile), inflation_pressure=800e3, belt=tl.tire.Belt(tread=SOLID))
    wheel = tl.Rolling(normal_load=10e3, friction=0.0, speed=10.0)
    found = tl.solve_contact(tire, ROAD, wheel, spacing=8e-3).dataset
    limits = [
        float(
            tl.solve_contact(
                replace(tire, belt=tl.tire.Belt(tread=limit)), ROAD, replace(wheel, speed=None), spacing=8e-3
            ).dataset.approach
        )
        for limit in (SOLID.glassy, SOLID.rubbery)
    ]
    assert limits[0] < float(found.approach) < limits[1]
    assert float(found.pressure_centre_x) > 1e-5


@pytest.mark.slow
def test_a_history_ends_in_steady_rolling(ribbed):
    tire = replace(ribbed, belt=replace(ribbed.belt, belt_radius=0.8))
    wheel = tl.Rolling(normal_load=6e3, friction=0.5, tractive_force=1e3)
    steady = tl.solve_contact(tire, ROAD, wheel, spacing=8e-3, tolerance=1e-7).dataset
    history = tl.contact.solve_transient(
        tire, ROAD, wheel, distances=8e-3 * np.arange(1, 25), spacing=8e-3, tolerance=1e-7
    )
    end = history.contact.dataset
    largest = float(abs(steady.traction_x).max())
    # After twice the length of contact what is left of the start fades by the solver's tolerance.
    np.testing.assert_allclose(end.traction_x, steady.traction_x, rtol=0, atol=1e-2 * largest)
    assert float(end.creepage_x) == pytest.approx(float(steady.creepage_x), rel=1e-2)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"arm": 0.03}, "the arm of 30 mm is longer than the tread is thick, 20 mm"),
        ({"meridional": 0.0, "bending": (80.0, 0.0, 0.0), "arm": 0.0}, "neither tension nor bending across"),
        ({"bending": (0.0, 0.0, 0.0)}, "with an arm it needs bending stiffness"),
        ({"foundation": 0.0}, "nothing holds it"),
        ({"foundation": -1.0}, "foundation must be a number of 1/m and not negative, got -1"),
        ({"tread_thickness": 20.0}, "lengths are in metres"),
        ({"bending": (1.0, 2.0)}, "three stiffnesses"),
        ({"tread": "rubber"}, "must be an Elastic or a Prony"),
        ({"crown_radius": 0.0}, "crown_radius of the belt must be a positive number of m"),
    ],
)
def test_a_belt_that_cannot_be_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        tl.tire.Belt(**given)


def test_what_a_tire_on_a_belt_needs():
    surface = ProfileSurface(SMOOTH)
    with pytest.raises(InputError, match="either material, of a half-space, or belt"):
        tl.Tire(surface, tl.Elastic(3e6, 0.5), 800e3, belt=tl.tire.Belt())
    with pytest.raises(InputError, match="give inflation_pressure in Pa"):
        tl.Tire(surface, belt=tl.tire.Belt()).carcass  # noqa: B018
    with pytest.raises(InputError, match="inflation_pressure must be a positive number of Pa"):
        tl.Tire(surface, inflation_pressure=-8e5, belt=tl.tire.Belt())
    with pytest.raises(InputError, match="belt must be a Belt"):
        tl.Tire(surface, inflation_pressure=8e5, belt="315/80R22.5")
    with pytest.raises(InputError, match="leaves none along"):
        inflated(tl.tire.Belt(), crown=0.09)
    with pytest.raises(InputError, match="does not bend along travel"):
        tl.Tire.from_height_map(np.zeros((9, 9)), 0.01, inflation_pressure=8e5, belt=tl.tire.Belt()).carcass  # noqa: B018
    with pytest.raises(InputError, match="give crown_radius to Belt"):
        tl.tire.Belt().inflated(8e5, 0.5, None)
    with pytest.raises(InputError, match="an inflated belt is a tire"):
        surface_of(inflated(tl.tire.Belt()), is_tire=False)


def test_the_arc_of_a_tread_is_found_between_its_grooves():
    profile = tl.catalogue.tires["315/80R22.5"]
    grid = tl.response.Grid.centred(0.3, 0.3, 2e-3)
    tire = tl.Tire.from_height_map(profile.gap(grid.x, grid.y), 2e-3)
    # A parabola for a circle: (y/2r)² = 0.5 % at the shoulders.
    assert tire.crown_arc_radius == pytest.approx(profile.crown_radius, rel=0.01)
    assert tl.Tire.from_profile(profile).crown_arc_radius == profile.crown_radius
    assert arc_radius(grid.y, np.zeros(grid.ny)) == math.inf
    assert arc_radius(grid.y, np.full(grid.ny, np.nan)) is None


def test_belts_of_the_catalogue_are_those_of_the_defaults():
    known = tl.tire.Belt.from_library("315/80 R22.5")
    assert known is belts["315/80R22.5"]
    assert replace(known, lateral=None, ribs_poisson=None, name="", source="", caveats=()) == tl.tire.Belt()
    assert known.caveats
    assert "Project Chrono" in known.source


def test_a_case_names_its_belt(tmp_path):
    text = """
    spacing = "8 mm"
    [tire]
    profile = "315/80R22.5"
    inflation_pressure = "8.2 bar"
    {belt}
    [[pavement.layers]]
    material = {{ kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }}
    [rolling]
    normal_load = "10 kN"
    friction = 0.5
    [response]
    depths = ["20 mm"]
    """
    named = tl.Case.from_text(text.format(belt='belt = "315/80R22.5"')).build_tire()
    assert named.belt == belts["315/80R22.5"]
    table = 'belt = { tread = { kind = "elastic", modulus = "4 MPa", poisson = 0.48 }, foundation = "4 1/m" }'
    assert tl.Case.from_text(text.format(belt=table)).build_tire().belt == tl.tire.Belt(
        tread=tl.Elastic(4e6, 0.48), foundation=4.0
    )
    both = 'belt = "315/80R22.5"\nmaterial = { kind = "elastic", modulus = "3 MPa", poisson = 0.5 }'
    with pytest.raises(InputError, match="give either material, of a half-space, or belt"):
        tl.Case.from_text(text.format(belt=both))
    with pytest.raises(InputError, match="a belt carries by its inflation"):
        tl.Case.from_text(text.format(belt='belt = "315/80R22.5"').replace('inflation_pressure = "8.2 bar"', ""))


@pytest.mark.parametrize("name", [name for name in belts if belts[name].ribs_poisson is not None])
def test_ribs_on_a_belt_of_the_catalogue_are_of_rubber_and_a_layer_is_not(name):
    profile = f"{name} tread" if name == "335/65R22.5" else name
    layer = tl.Tire.from_profile(profile, inflation_pressure=8e5, belt=belts[name])
    ribs = replace(layer, tread="ribs")
    assert layer.belt.tread.poisson == belts[name].tread.poisson < 0.48
    assert ribs.belt.tread.poisson == 0.495
    assert not [text for text in of_tire(ribs) if "Poisson" in text]
    assert any("Poisson" in text for text in of_tire(replace(ribs, belt=replace(belts[name], ribs_poisson=None))))
    # Rubber that is given keeps its modulus, and its Poisson's ratio if that is of rubber.
    for given, taken in ((tl.Elastic(7e6, 0.46), (7e6, 0.495)), (tl.Elastic(7e6, 0.499), (7e6, 0.499))):
        tread = replace(ribs, belt=replace(belts[name], tread=given)).belt.tread
        assert (tread.modulus, tread.poisson) == taken


def test_a_poisson_ratio_of_ribs_is_that_of_rubber():
    with pytest.raises(InputError, match=r"ribs_poisson must be at least 0.49 and below 0.5, .* got 0.3"):
        tl.tire.Belt(ribs_poisson=0.3)
