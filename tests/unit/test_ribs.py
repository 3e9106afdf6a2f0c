"""Ribs with free sides on a belt: what they are, their operator, and how they press, roll and shear a road."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.contact import solve_transient, turn_on_the_spot
from treadload.contact.bodies import Influence, Pair
from treadload.contact.bodies.ahead import Ahead
from treadload.contact.solvers import tangential
from treadload.contact.solvers.coupling import Surfaces, solve_coupled
from treadload.contact.solvers.normal import solve_normal
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.complementarity import coulomb_newton, coulomb_splitting
from treadload.materials import Prony
from treadload.tire import TreadProfile
from treadload.tire.grooves import Groove, LateralGrooves
from treadload.tire.rib_rows import rows_on_faces
from treadload.tire.ribs import ribs_between, section_of

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
BELT = tl.tire.Belt(tread=tl.Elastic(5.5e6, 0.495), bending=(80, 100, 150))
NAME, PRESSURE = "315/80R22.5", 820e3
NARROW = TreadProfile(
    0.5, 0.8, 0.12, grooves=(Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015)), shoulder_radius=0.005
)


def tire_on_ribs(profile=NAME, belt=BELT, tread="ribs"):
    return tl.Tire.from_profile(profile, inflation_pressure=PRESSURE, belt=belt, tread=tread)


@pytest.fixture(scope="module")
def rolled():
    return tl.solve_contact(tire_on_ribs(), ROAD, tl.Rolling(normal_load=35e3, friction=0.7))


def amplitudes(contact):
    """Half of what the outer thirds of every rib shear the road apart, over the rib's mean pressure."""
    data = contact.dataset
    return amplitudes_of(
        contact.tire, data.y.values, float(data.attrs["dy"]), data.pressure.values, data.traction_y.values
    )


def amplitudes_of(tire, y, dy, pressure, traction):
    """The same of fields (ny, nx) on rows at y, m."""

    def total(field, low, high):
        covered = np.clip(np.minimum(y + dy / 2, high) - np.maximum(y - dy / 2, low), 0, None) / dy
        return float((covered[:, None] * field).sum())

    found = []
    for group in tire.ribs:
        ((left, right),) = group.faces
        third = (right - left) / 3
        shear = [total(traction, *end) for end in ((right - third, right), (left, left + third))]
        found.append((shear[0] - shear[1]) / 2 / (total(pressure, left, right) / 3))
    return found


def test_the_ribs_of_a_tread():
    groups = ribs_between(section_of(tire_on_ribs().surface.profile), 0.020)
    assert [len(group.faces) for group in groups] == [1] * 5
    assert groups[0].faces[0][0] == pytest.approx(-0.141)
    assert groups[2].faces[0] == pytest.approx((-0.02428, 0.02428))
    # A shoulder ends where the tread does, and the other one is its image.
    assert groups[0].mirrored != groups[4].mirrored
    assert groups[0].section.height == pytest.approx(0.020)
    assert sorted(groups[0].section.floors) == pytest.approx([0.0, 0.005])
    assert groups[2].section.floors == pytest.approx((0.005, 0.005))


def test_shallow_grooves_join_ribs():
    worn = replace(NARROW, grooves=tuple(replace(groove, depth=0.006) for groove in NARROW.grooves))
    (group,) = ribs_between(section_of(worn), 0.020)
    assert len(group.faces) == 3


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lateral": (LateralGrooves(0.07, 0.01, 0.01),)}, "lateral"),
        ({"grooves": (Groove(0.0, 0.01, 0.021),)}, r"21 mm deep.*20 mm"),
        ({"grooves": (Groove(0.0, 0.003, 0.015, np.arctan(0.1)),)}, r"meet above its floor.*3 mm wide.*wall_angle"),
    ],
)
def test_treads_without_ribs(change, words):
    with pytest.raises(InputError, match=words):
        tire_on_ribs(replace(NARROW, **change))


def test_ribs_need_a_belt():
    with pytest.raises(InputError, match="belt"):
        tl.Tire.from_profile(NAME, material=tl.Elastic(3e6, 0.5), tread="ribs")
    with pytest.raises(InputError, match="layer"):
        tire_on_ribs(tread="rubber")


def test_cells_too_wide_for_the_ribs():
    with pytest.raises(InputError, match=r"30 mm.*spacing = \"10 mm\""):
        tl.solve_contact(tire_on_ribs(NARROW), ROAD, tl.Rolling(normal_load=8e3, friction=0.5), spacing=11e-3)


def test_viscoelastic_ribs_need_a_speed():
    prony = Prony(5.5e6, ((0.5, 0.01),), 0.495)
    with pytest.raises(InputError, match="give the rolling speed"):
        tl.solve_contact(
            tire_on_ribs(belt=replace(BELT, tread=prony)), ROAD, tl.Rolling(normal_load=35e3, friction=0.7)
        )


def test_the_operator_is_symmetric_and_positive():
    tire = tire_on_ribs(NARROW)
    pair = Pair.of(tire, ROAD).both
    grid = Grid.on_lattice(0.04, 0.12, 8e-3, 6e-3)
    influence = Influence(grid.shape, grid.dx, grid.dy, pair, grid.y0)
    rows = influence.material
    cells = int(rows.sum()) * grid.nx
    columns = []
    for load in range(3 * cells):
        fields = np.zeros((3, int(rows.sum()), grid.nx))
        fields.ravel()[load] = 1.0
        whole = np.zeros((3, *grid.shape))
        whole[:, rows] = fields
        columns.append(influence.displacement(whole[2], whole[:2])[:, rows].ravel())
    matrix = np.array(columns).T
    assert np.abs(matrix - matrix.T).max() <= 1e-12 * np.abs(matrix).max()
    assert np.linalg.eigvalsh(matrix).min() > 0
    # What the solvers ask for are parts of it.
    shear = np.zeros((2, *grid.shape))
    shear[:, rows] = np.random.default_rng(1).normal(size=(2, int(rows.sum()), grid.nx))
    opening = influence.displacement(np.zeros(grid.shape), shear)[2]
    assert influence.gap_by_shear(shear) == pytest.approx(opening, abs=1e-12 * np.abs(opening).max())
    assert influence.dundurs == pytest.approx(0.6, abs=0.05)


@pytest.mark.parametrize(("load", "approach"), [(20e3, 22.2e-3), (35e3, 34.8e-3), (50e3, 46.6e-3)])
def test_deflection_without_friction(load, approach):
    tire = tire_on_ribs()
    grid = Grid.on_lattice(0.28, 0.30, 6e-3, 3e-3)
    influence = Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, ROAD).both, grid.y0)
    found = solve_normal(influence, tire.height_map(grid), load=load)
    assert found.approach == pytest.approx(approach, rel=0.01)
    assert found.iterations <= 20


def test_five_ribs_roll(rolled):
    data = rolled.dataset
    assert float(data.approach) == pytest.approx(34.6e-3, rel=0.01)
    length = float((data.pressure > 0).any("y").sum()) * data.attrs["dx"]
    assert length == pytest.approx(0.180, abs=6e-3)
    assert rolled.area == pytest.approx(36_200e-6, rel=0.02)
    assert 1 / (1 - float(data.creepage_x)) == pytest.approx(0.9874, abs=1e-3)
    assert amplitudes(rolled) == pytest.approx([0.26, 0.29, 0.29, 0.29, 0.26], rel=0.07)
    largest = [float(np.abs(data[name]).max()) for name in ("pressure", "traction_y", "traction_x")]
    assert 2.5 <= 10 * largest[1] / largest[0] <= 4
    assert rolled.stats["coupling_rounds"] <= 12


def test_a_straight_free_rolling_tread_is_its_own_image(rolled):
    data = rolled.dataset
    load = float(data.normal_load)
    assert abs(float(data.lateral_force)) <= 1e-9 * load
    for name, parity in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        field = data[name].values
        assert field == pytest.approx(parity * field[::-1], abs=1e-5 * np.abs(data.pressure.values).max()), name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("load", "friction", "expected"),
    [
        (35e3, 0.3, (0.239, 0.261, 0.260)),
        (20e3, 0.7, (0.253, 0.274, 0.283)),
        (50e3, 0.7, (0.254, 0.301, 0.303)),
    ],
)
def test_other_loads_and_friction(load, friction, expected):
    contact = tl.solve_contact(tire_on_ribs(), ROAD, tl.Rolling(normal_load=load, friction=friction))
    assert amplitudes(contact)[:3] == pytest.approx(expected, rel=0.07)


def rib_measures(tire, y, dy, pressure, traction):
    """(ribs, 3): amplitude as above, and the shear of pins of 9.7 mm at the right and the left edge of every rib."""

    def force(field, low, high):
        covered = np.clip(np.minimum(y + dy / 2, high) - np.maximum(y - dy / 2, low), 0, None)
        return float((covered[:, None] * field).sum())

    pin, beyond, found = 9.7e-3, 4e-3, []
    for group in tire.ribs:
        ((left, right),) = group.faces
        width = right - left
        mean = force(pressure, left - beyond, right + beyond) / width
        third = width / 3
        outer = force(traction, right - third, right + beyond) - force(traction, left - beyond, left + third)
        pins = force(traction, right - pin, right + beyond), force(traction, left - beyond, left + pin)
        found.append([outer / 2 / third / mean, pins[0] / pin / mean, pins[1] / pin / mean])
    return np.array(found)


@pytest.mark.slow
def test_cells_of_3_and_of_1_5_mm_across():
    tire = tire_on_ribs()
    wheel = tl.Rolling(normal_load=35e3, friction=0.7)

    def measured(dy, offset):
        lattice = Grid.on_lattice(0.26, 0.30, 6e-3, dy)
        grid = replace(lattice, y0=lattice.y0 + offset * dy)
        influence = Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, ROAD).both, grid.y0)
        solved = solve_coupled(influence, Surfaces(grid, tire.height_map(grid)), wheel, check=lambda pressure: None)
        shear = -solved.slipping.tangential.shear[1]
        return rib_measures(tire, grid.y, dy, solved.normal.pressure, shear)

    fine = measured(1.5e-3, 0.0)
    for offset in (0.0, 0.25, 0.5):
        coarse = measured(3e-3, offset)
        assert coarse[:, 0] == pytest.approx(fine[:, 0], rel=0.01)
        # Pins in the groove's edges; at a rounded shoulder pressure ends within a row.
        inner = np.ones((5, 2), bool)
        inner[0, 1] = inner[4, 0] = False
        assert coarse[:, 1:][inner] == pytest.approx(fine[:, 1:][inner], rel=0.03)
        assert coarse[:, 1:][~inner] == pytest.approx(fine[:, 1:][~inner], rel=0.05)


def test_rows_cover_a_face_without_gap_or_overlap():
    (rows,) = rows_on_faces(np.arange(-8, 9) * 3e-3, 3e-3, [(-0.0205, -0.0195, 0.0195, 0.0205)])
    assert rows.rows.tolist() == list(range(1, 16))
    # The outermost rows lie on the rounded edges alone.
    assert rows.parts[0].tolist() == [-0.0205, -0.0195]
    assert rows.parts[-1].tolist() == [0.0195, 0.0205]
    assert rows.parts[1:, 0] == pytest.approx(rows.parts[:-1, 1])
    # Fine rows reach over the rounded edges to the walls.
    (fine,) = rows_on_faces(np.arange(-100, 101) * 3e-4, 3e-4, [(-0.0205, -0.0195, 0.0195, 0.0205)])
    assert fine.parts[0, 0] == pytest.approx(-0.0205, abs=6e-5)
    # A row that meets the end of what is pressed leaves its outer part out.
    apart = fine.parts[1:, 0] - fine.parts[:-1, 1]
    assert -1e-12 <= apart.min() <= apart.max() < 3e-4
    assert (apart > 1e-12).sum() == 2


def test_a_row_that_two_ribs_share_is_of_one_of_them():
    y = np.arange(6) * 4e-3
    faces = rows_on_faces(y, 4e-3, [(-0.002, -0.002, 0.0075, 0.0075), (0.0085, 0.0085, 0.022, 0.022)])
    first, second = (face.rows.tolist() for face in faces)
    assert first == [0, 1, 2]
    assert second == [3, 4, 5]
    assert faces[1].parts[0, 0] == 0.0085


def test_the_gap_of_a_row_is_the_mean_over_its_part():
    tire = tire_on_ribs(replace(NARROW, grooves=tuple(replace(g, edge_radius=0.002) for g in NARROW.grooves)))
    grid = Grid.on_lattice(0.02, 0.13, 4e-3, 5e-3)
    gap, profile = tire.height_map(grid), tire.surface.profile
    for face in rows_on_faces(grid.y, grid.dy, [band for group in tire.ribs for band in group.bands]):
        for row, (low, high) in zip(face.rows, face.parts, strict=True):
            exact = profile.gap(np.zeros(1), np.linspace(low, high, 2001)).mean()
            assert gap[row, grid.nx // 2] == pytest.approx(exact, abs=2e-5)
    middle = tire.ribs[1]
    ((left, right),), ((_, low, high, _),) = middle.faces, middle.bands
    # 4 % of 20 mm: how deep a rounding of 2 mm sinks in.
    assert low - left == pytest.approx(2e-3 - np.sqrt(0.8e-3 * 3.2e-3))
    assert right - high == pytest.approx(low - left)


@pytest.mark.parametrize("seed", [pytest.param(1), pytest.param(2, marks=pytest.mark.slow)])
def test_pressure_and_shear_settle_whatever_is_asked(seed):
    draws = np.random.default_rng(seed)
    for _ in range(3 if seed == 1 else 30):
        poisson, load = float(draws.choice([0.47, 0.495, 0.4999])), 10 ** draws.uniform(3, 4.3)
        friction, share = draws.uniform(0.02, 1.2), draws.uniform(-0.8, 0.8)
        motions = [
            {},
            {"creepage_x": draws.uniform(-0.05, 0.05), "creepage_y": draws.uniform(-0.05, 0.05)},
            {"lateral_force": share * friction * load},
            {"tractive_force": share * friction * load},
            {"spin": draws.uniform(-2, 2)},
        ]
        wheel = tl.Rolling(normal_load=load, friction=friction, **motions[int(draws.integers(5))])
        tire = tire_on_ribs(NARROW, replace(BELT, tread=tl.Elastic(5.5e6, poisson)))
        lattice = Grid.on_lattice(0.16, 0.13, 8e-3, 6e-3)
        grid = replace(lattice, y0=lattice.y0 + draws.uniform(0, 1) * lattice.dy)
        influence = Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, ROAD).both, grid.y0)
        solved = solve_coupled(influence, Surfaces(grid, tire.height_map(grid)), wheel, check=lambda pressure: None)
        assert solved.rounds <= 25, wheel
        assert solved.splitting == 0, wheel
        assert solved.normal.pressure.sum() * grid.cell_area == pytest.approx(load, rel=1e-6)


@pytest.mark.slow
def test_a_mirrored_tread_has_mirrored_fields():
    grooves = (Groove(-0.025, 0.012, 0.015, edge_radius=0.002), Groove(0.015, 0.008, 0.012, edge_radius=0.002))
    oblique = replace(NARROW, grooves=grooves)
    image = replace(NARROW, grooves=tuple(replace(groove, centre=-groove.centre) for groove in grooves[::-1]))
    wheel = tl.Rolling(normal_load=8e3, friction=0.5, creepage_x=-0.002, creepage_y=0.003)
    turned = tl.Rolling(normal_load=8e3, friction=0.5, creepage_x=-0.002, creepage_y=-0.003)
    data, mirrored = (
        tl.solve_contact(tire_on_ribs(profile), ROAD, motion, spacing=6e-3, tolerance=1e-7).dataset
        for profile, motion in ((oblique, wheel), (image, turned))
    )
    peak = float(data.pressure.max())
    for name, parity in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        field, other = data[name].values, mirrored[name].values[::-1]
        assert other == pytest.approx(parity * field, abs=1e-6 * peak), name


@pytest.mark.slow
def test_cells_of_3_and_of_1_5_mm_both_ways(rolled):
    fine = tl.solve_contact(tire_on_ribs(), ROAD, tl.Rolling(normal_load=35e3, friction=0.7), spacing=1.5e-3)
    # The step of rolling is of first order along travel.
    assert amplitudes(fine) == pytest.approx(amplitudes(rolled), rel=0.03)
    assert amplitudes(fine) == pytest.approx([0.26, 0.29, 0.29, 0.29, 0.26], rel=0.05)


@pytest.mark.slow
def test_a_tread_without_grooves_is_the_layer():
    smooth = replace(NARROW, grooves=(), shoulder_radius=0.03)
    belt = replace(BELT, tread=tl.Elastic(5.5e6, 0.47))
    wheel = tl.Rolling(normal_load=8e3, friction=0.7)
    ribs, layer = (
        tl.solve_contact(tire_on_ribs(smooth, belt, tread), ROAD, wheel, spacing=4e-3).dataset
        for tread in ("ribs", "layer")
    )
    assert float(ribs.approach) == pytest.approx(float(layer.approach), rel=0.01)
    middle = {"y": slice(-0.02, 0.02), "x": slice(-0.04, 0.04)}
    pressures = [float(data.pressure.sel(middle).mean()) for data in (ribs, layer)]
    assert pressures[0] == pytest.approx(pressures[1], rel=0.01)


def test_driving_and_cornering():
    wheel = tl.Rolling(normal_load=8e3, friction=0.7, tractive_force=2e3, lateral_force=1e3)
    data = tl.solve_contact(tire_on_ribs(NARROW), ROAD, wheel, spacing=5e-3).dataset
    assert float(data.tractive_force) == pytest.approx(2e3, rel=1e-6)
    assert float(data.lateral_force) == pytest.approx(1e3, rel=1e-6)
    size = np.hypot(data.traction_x, data.traction_y)
    assert float((size - 0.7 * data.pressure).max()) <= 1e-6 * float(data.pressure.max())


def test_a_layer_is_what_it_was():
    plain = tl.Tire.from_profile(NARROW, inflation_pressure=PRESSURE, belt=BELT)
    assert plain == tire_on_ribs(NARROW, tread="layer")
    assert plain.ribs == ()
    assert "tread" not in repr(plain).replace("tread=Elastic", "").replace("TreadProfile", "").replace("tread_", "")


def test_a_case_with_ribs():
    text = """
spacing = "5 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
belt = "315/80R22.5"
tread = "ribs"
[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[rolling]
normal_load = "35 kN"
friction = 0.7
"""
    case = tl.Case.from_text(text)
    assert len(case.build_tire().ribs) == 5
    assert "tread='ribs'" in tl.steps.case_as_python(case)
    with pytest.raises(InputError, match="belt"):
        tl.Case.from_text(text.replace('belt = "315/80R22.5"\n', ""))


@pytest.mark.parametrize("force", [None, 1.5e3])
def test_the_slower_way_ends_in_the_same_shear(force):
    tire = tire_on_ribs(NARROW)
    grid = Grid.on_lattice(0.14, 0.13, 8e-3, 6e-3)
    influence = Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, ROAD).both, grid.y0)
    pressure = solve_normal(influence, tire.height_map(grid), load=8e3).pressure
    rigid = influence.slip_by_pressure(pressure)
    if force is None:
        rigid[1] += 2e-5
    problem = tangential._problem(influence, 0.7 * pressure, rigid, (0.0, force), True, (1.0, 1.0))
    fast = coulomb_newton.solve(problem, tolerance=1e-8)
    shear, creepages, steps = coulomb_splitting.split(problem, np.zeros_like(rigid), np.zeros(2), tolerance=1e-7)
    assert fast.converged
    assert fast.splitting == 0
    assert steps < 5000
    assert shear == pytest.approx(fast.shear, abs=1e-4 * np.abs(fast.shear).max())
    assert creepages == pytest.approx(fast.xi, abs=1e-4 * np.abs(fast.xi).max() + 1e-9)


def narrow_influence():
    grid = Grid.on_lattice(0.14, 0.13, 8e-3, 6e-3)
    return Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire_on_ribs(NARROW), ROAD).both, grid.y0)


def test_displacement_ahead_of_the_cells():
    influence = narrow_influence()
    rows = influence.material[:, None]
    shear = rows * np.random.default_rng(3).normal(size=(2, *influence.shape))
    pressure = rows * np.random.default_rng(4).random(influence.shape)
    here = influence.displacement(pressure, shear)
    cell = Ahead(influence, influence.dx)
    scale = np.abs(here).max()
    assert cell(shear, pressure)[..., :-1] == pytest.approx(here[:2, :, 1:], abs=1e-6 * scale)
    assert cell.gap(shear)[:, :-1] == pytest.approx(influence.gap_by_shear(shear)[:, 1:], abs=1e-6 * scale)
    # Between the cells a smooth load's displacement lies between theirs.
    smooth = rows * np.exp(-np.square(np.linspace(-3, 3, influence.shape[1])))
    half = Ahead(influence, 0.5 * influence.dx).by_pressure(smooth)[1]
    whole = influence.displacement(smooth, np.zeros_like(shear))[1]
    assert half[:, 4:-4] == pytest.approx(0.5 * (whole[:, 4:-4] + whole[:, 5:-3]), abs=0.03 * np.abs(whole).max())


def test_rolling_from_rest_ends_in_steady_rolling():
    tire, wheel = tire_on_ribs(NARROW), tl.Rolling(normal_load=8e3, friction=0.7)
    steady = tl.solve_contact(tire, ROAD, wheel, spacing=8e-3)
    steps = np.arange(1, 26) * 8e-3
    rolled = solve_transient(tire, ROAD, wheel, distances=steps, spacing=8e-3)
    assert amplitudes(steady) == pytest.approx(amplitudes(rolled.contact), rel=0.02)


def test_turning_on_the_spot():
    turned = turn_on_the_spot(
        tire_on_ribs(NARROW),
        ROAD,
        tl.Rolling(normal_load=8e3, friction=0.7),
        angles=np.radians([1.0, 4.0]),
        spacing=8e-3,
    )
    moment = np.abs(turned.dataset.steering_torque.values)
    assert moment[-1] > moment[0] > 0


def test_a_poissons_ratio_of_a_layer_is_warned_of():
    wheel = tl.Rolling(normal_load=8e3, friction=0.3)
    layered = replace(BELT, tread=tl.Elastic(5.5e6, 0.47))
    warnings = [
        " ".join(tl.solve_contact(tire_on_ribs(NARROW, belt), ROAD, wheel, spacing=8e-3).warnings)
        for belt in (layered, BELT)
    ]
    assert "0.47" in warnings[0]
    assert "0.495" in warnings[0]
    assert "Poisson" not in warnings[1]


def test_peaks_at_walls_are_said_to_depend_on_the_cells():
    wheel = tl.Rolling(normal_load=8e3, friction=0.3)
    for tread, cautioned in (("ribs", True), ("layer", False)):
        rows = tl.solve_contact(tire_on_ribs(NARROW, tread=tread), ROAD, wheel, spacing=8e-3).rows()
        notes = [row.note for row in rows if row.key in ("largest_pressure", "largest_traction")]
        assert [("walls of ribs" in note) for note in notes] == [cautioned] * 2
