"""A tread with blocks over one pitch: periodic, mirrored, sticking, sliding; against steady ribs; in a case."""

import math
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.cli import app
from treadload.contact import Rolling, solve_contact, solve_pitch
from treadload.contact.bodies import block_tables
from treadload.contact.bodies.block_tables import block_table
from treadload.contact.bodies.blocks import belt_alone, block_influence, on_blocks
from treadload.contact.bodies.choose import Pair, road_surface
from treadload.contact.bodies.influence import Influence
from treadload.contact.contact_grid import place
from treadload.contact.solvers.marching import Stage, march
from treadload.damage.pitch import respond_to_pitch
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.sections import Block, FaceCells, block_compliance
from treadload.tire import Tire
from treadload.tire.belt import Belt
from treadload.tire.blocks import blocks_of
from treadload.tire.grooves import Groove, LateralGrooves
from treadload.tire.tread import TreadProfile

# A light tire, so that a contact has a few hundred cells: two blocks of 34 x 39 mm a pitch, one element a cell.
PITCH = 0.04
LUGS = TreadProfile(
    rolling_radius=0.3, crown_radius=0.8, width=0.088, grooves=(Groove(0.0, 0.01, 0.016),),
    lateral=(LateralGrooves(PITCH, 0.006, 0.016),),
)  # fmt: skip
BELT = Belt(tread=tl.Elastic(4e6, 0.49), tread_thickness=0.024, arm=0.024)
TIRE = Tire.from_profile(LUGS, inflation_pressure=300e3, belt=BELT)
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
FREE = Rolling(normal_load=2500.0, friction=0.7)
CELL = 8e-3


@pytest.fixture(scope="module")
def free():
    """Free rolling, solved once."""
    return solve_pitch(TIRE, ROAD, FREE, spacing=CELL, positions=6)


@pytest.fixture(scope="module")
def body():
    """Operators of the blocks of a window, its cells."""
    pattern = blocks_of(LUGS, BELT.tread_thickness)
    grid = Grid(30, 13, CELL, CELL, -14.5 * CELL, -6 * CELL)
    blocks = pattern.between(grid.x0 - CELL / 2, grid.x0 + 29.5 * CELL)
    pair = belt_alone(TIRE.carcass, road_surface(ROAD))
    return grid, block_influence(grid, pair, blocks, BELT.tread)


def test_the_operator_of_blocks_is_symmetric_and_its_preconditioner_near_its_inverse(body):
    grid, influence = body
    on = np.flatnonzero(on_blocks(grid, influence))
    rng = np.random.default_rng(1)

    def normal(values):
        pressure = np.zeros(grid.shape)
        pressure.flat[on] = values
        return influence.normal(pressure).flat[on]

    matrix = np.array([normal(unit) for unit in np.eye(on.size)])
    assert np.abs(matrix - matrix.T).max() <= 1e-12 * np.abs(matrix).max()
    assert np.linalg.eigvalsh(matrix)[0] > 0
    inverse = influence.strip_inverse((2,))

    def undone(values):
        field = np.zeros((1, *grid.shape))
        field[0].flat[on] = values
        return inverse(field)[0].flat[on]

    product = matrix @ np.array([undone(unit) for unit in np.eye(on.size)]).T
    values = np.linalg.eigvals(product).real
    # Without the blocks' inverse it is some hundreds, without the correction for the belt some tens.
    assert values.min() > 0
    assert values.max() / values.min() < 5
    # All three components: loads work on each other's displacements alike.
    first, second = (np.zeros((3, *grid.shape)) for _ in range(2))
    for fields in (first, second):
        fields.reshape(3, -1)[:, on] = rng.normal(size=(3, on.size))
    works = [
        (influence.displacement(one[2], one[:2]) * other * np.array([1.0, 1.0, -1.0])[:, None, None]).sum()
        for one, other in ((first, second * [[[1]], [[1]], [[-1]]]), (second, first * [[[1]], [[1]], [[-1]]]))
    ]
    assert works[0] == pytest.approx(works[1], rel=1e-9)


def test_a_block_and_its_image_share_a_table(monkeypatch, tmp_path):
    monkeypatch.setenv("TREADLOAD_CACHE", str(tmp_path))
    block_tables._table.cache_clear()
    block = Block(
        ((-0.011, -0.01), (0.009, -0.01), (0.011, 0.01), (-0.009, 0.01)), 0.014, (0.004, 0.004, 0.0, 0.004),
        (0.004, 0.003, 0.0, 0.003), parts=(2, 2),
    )  # fmt: skip
    x, y = np.meshgrid([-0.006, 0.0, 0.006], [-0.006, 0.0, 0.006])
    centres = np.stack([x.ravel(), y.ravel()], axis=1)
    cells, image = (FaceCells(centres * [1.0, side], 6e-3, 6e-3) for side in (1.0, -1.0))
    one, other = block_table(block, 0.49, cells), block_table(block.mirrored, 0.49, image)
    assert one.compliance is other.compliance
    assert one.is_mirrored != other.is_mirrored
    (file,) = (tmp_path / "blocks").iterdir()
    count = len(centres)
    for table, shape, places in ((one, block, cells), (other, block.mirrored, image)):
        direct = block_compliance(shape, 0.49, places).reshape(3, count, 3, count)
        signs = np.array([1.0, -1.0, 1.0]) if table.is_mirrored else np.ones(3)
        shared = table.compliance.reshape(3, count, 3, count) * signs[:, None, None, None] * signs[:, None]
        # Rounded to 1e-9 m, and the same elements in another order.
        scale = np.abs(direct).max()
        np.testing.assert_allclose(shared, direct[:, table.order][..., table.order], atol=1e-9 * scale)
    # A damaged file is made again, silently.
    content = file.read_bytes()
    file.write_bytes(content[:100])
    block_tables._table.cache_clear()
    np.testing.assert_array_equal(block_table(block, 0.49, cells).compliance, one.compliance)
    assert file.read_bytes() == content
    block_tables._table.cache_clear()


def test_free_rolling_repeats_after_a_pitch_and_is_its_own_image(free):
    data = free.dataset
    assert data.attrs["change"] <= 0.01
    assert data.attrs["pitch"] == PITCH
    np.testing.assert_allclose(data.position, PITCH * np.arange(1, 7) / 6)
    np.testing.assert_allclose(data.normal_load, 2500.0, rtol=1e-9)
    for name in ("tractive_force", "lateral_force"):
        assert np.abs(data[name]).max() < 1e-9 * 2500
    # The tolerance of a step is 1e-4 of friction.
    for name, sign in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        field = data[name].transpose("position", "y", "x").to_numpy()
        assert np.abs(field - sign * field[:, ::-1]).max() < 2e-3 * float(data.pressure.max())
    shear, bound = np.hypot(data.traction_x, data.traction_y), 0.7 * data.pressure
    assert float((shear - bound).max()) <= 1e-9 * float(bound.max())
    # Blocks are dragged outwards from their middles: the outer rows of the right one to the right.
    right = (
        data.traction_y.isel(y=slice(data.sizes["y"] // 2, None))
        .transpose("y", "position", "x")
        .to_numpy()
        .sum((1, 2))
    )
    loaded = right[np.abs(right) > 0]
    assert loaded[-1] - loaded[0] > 0.05 * float(data.pressure.sum()) / loaded.size


@pytest.mark.slow
def test_forces_under_given_creepages_repeat_within_a_percent():
    wheel = replace(FREE, creepage_x=-0.02, creepage_y=0.01)
    first = solve_pitch(TIRE, ROAD, wheel, spacing=CELL, positions=4, periodic=0.01)
    later = solve_pitch(TIRE, ROAD, wheel, spacing=CELL, positions=4, periodic=1e-4)
    assert later.stats["pitches"] > first.stats["pitches"]
    for name in ("tractive_force", "lateral_force", "largest_pressure"):
        values, settled = first.dataset[name].to_numpy(), later.dataset[name].to_numpy()
        assert np.abs(values - settled).max() < 0.01 * np.abs(settled).max()
    # Driven, and pushed to the right: the road pushes the tire forwards and to the left.
    assert (later.dataset.tractive_force > 0).all()
    assert (later.dataset.lateral_force < 0).all()


@pytest.mark.slow
def test_large_creepage_slides_everywhere_and_large_friction_sticks():
    # Blocks that spread turn the slip by a little: half a percent of the force.
    slid = solve_pitch(TIRE, ROAD, replace(FREE, creepage_x=0.5), spacing=CELL, positions=4).dataset
    np.testing.assert_allclose(slid.tractive_force, -0.7 * 2500, rtol=5e-3)
    np.testing.assert_allclose(slid.slip_fraction, 1.0)
    stuck = solve_pitch(TIRE, ROAD, replace(FREE, friction=4.0, creepage_x=0.0), spacing=CELL, positions=4).dataset
    # Two cells at the border of the contact.
    assert float(stuck.slip_fraction.max()) < 0.03
    assert float(stuck.friction_energy.sum()) < 0.01 * float(slid.friction_energy.sum())


@pytest.mark.slow
def test_turned_grooves_the_other_way_give_the_image():
    def turned(angle):
        groove = replace(LUGS.lateral[0], angle=angle)
        tire = Tire.from_profile(replace(LUGS, lateral=(groove,)), inflation_pressure=300e3, belt=BELT)
        return solve_pitch(tire, ROAD, replace(FREE, creepage_y=0.0), spacing=CELL, positions=4).dataset

    left, right = turned(-0.3), turned(0.3)
    forces = left.lateral_force.to_numpy()
    # A tread that leans pulls to a side, and its image to the other.
    assert np.abs(forces).max() > 2.0
    np.testing.assert_allclose(right.lateral_force, -forces, atol=1e-3 * 2500)
    np.testing.assert_allclose(
        right.pressure.to_numpy(), left.pressure.to_numpy()[:, ::-1], atol=5e-3 * float(left.pressure.max())
    )


@pytest.mark.slow
def test_ribs_marched_in_the_frame_of_the_tread_come_to_rest_in_steady_rolling():
    """What makes blocks roll, a moving gap on cells that stand on the tread, against `solve_contact` of ribs."""
    ribs = replace(LUGS, lateral=())
    tire = Tire.from_profile(ribs, inflation_pressure=300e3, belt=BELT, tread="ribs")
    pair = Pair.of(tire, ROAD).both
    located, _ = place(tire, FREE, pair, CELL)
    steady = solve_contact(tire, ROAD, FREE, spacing=CELL)
    count = located.nx + 40
    grid = Grid(count, located.ny, CELL, CELL, located.x0, located.y0)
    influence = Influence(grid.shape, CELL, CELL, pair, grid.y0)

    def stage(axle):
        gap = ribs.gap(grid.x - axle, grid.y)
        return Stage(np.zeros((2, 1, 1)), (0.0, 0.0), 0.7, load=2500.0, gap=gap)

    *_, last = march(influence, [stage(number * CELL) for number in range(36)], tolerance=1e-4)
    part = slice(35, 35 + located.nx)
    pressure = steady.dataset.pressure.to_numpy()
    # Friction's bound of a step is that of its end, in steady rolling as well; 3 % is where slip begins, by a cell.
    assert np.linalg.norm(last.pressure[:, part] - pressure) < 0.01 * np.linalg.norm(pressure)
    shear = -np.array([steady.dataset.traction_x, steady.dataset.traction_y])
    assert np.linalg.norm(last.tangential.shear[:, :, part] - shear) < 0.03 * np.linalg.norm(shear)
    assert last.displaced[0] / CELL == pytest.approx(float(steady.dataset.creepage_x), rel=0.02)


def test_every_position_is_a_contact_that_the_road_takes(free):
    contacts = free.contacts
    assert len(contacts) == 6
    number = free.worst
    chosen, data = contacts[number], free.dataset.isel(position=number)
    assert chosen.area == pytest.approx(float(data.contact_area))
    x = (chosen.dataset.pressure.sum("y") * chosen.dataset.x).sum() / chosen.dataset.pressure.sum()
    # In the frame of the wheel: under its axle within a few millimetres.
    assert abs(float(x)) < 5e-3
    response = respond_to_pitch(free, ROAD, depths=[0.0, 0.02])
    values = response.dataset.largest_in_plane_extension.to_numpy()
    assert values.shape == (6, 2)
    alone = tl.solve_response(chosen, ROAD, depths=[0.02])
    in_plane = tl.damage.Extension().values(alone.dataset).max()
    # Means over 10 mm near the surface: 20 mm deep they change little.
    assert values[number, 1] == pytest.approx(in_plane, rel=0.05)
    assert (response.worst("largest_extension") >= response.mean("largest_extension")).all()
    with pytest.raises(InputError, match="at least one depth"):
        respond_to_pitch(free, ROAD, depths=[])
    with pytest.raises(InputError, match="positions 0 to 5, got 6"):
        free.contact(6)


CASE = """
title = "Blocks"
spacing = "8 mm"

[tire]
inflation_pressure = "3 bar"
[tire.belt]
tread = { kind = "elastic", modulus = "4 MPa", poisson = 0.49 }
tread_thickness = "24 mm"
arm = "24 mm"
[tire.profile]
rolling_radius = "300 mm"
crown_radius = "800 mm"
width = "88 mm"
grooves = [{ centre = 0, width = "10 mm", depth = "16 mm" }]
lateral = [{ pitch = "40 mm", width = "6 mm", depth = "16 mm" }]

[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }

[rolling]
normal_load = "2.5 kN"
friction = 0.7

[pitch]
positions = 6
depths = ["20 mm"]
"""


@pytest.mark.slow
def test_a_case_asks_for_a_pitch(tmp_path, free):
    (tmp_path / "case.toml").write_text(CASE)
    done = CliRunner().invoke(app, ["run", str(tmp_path / "case.toml"), "-o", str(tmp_path / "r.nc"), "-q"])
    assert done.exit_code == 0, done.output
    opened = tl.open_results(tmp_path / "r.nc")
    np.testing.assert_array_equal(opened.pitch.dataset.pressure, free.dataset.pressure)
    peak = float(free.dataset.largest_pressure.max())
    rows = {row.key: row for row in opened.pitch.rows() if not row.group}
    assert rows["largest_pressure"].value == peak
    assert f"{peak / 1e3:.0f} kPa" in done.output
    assert rows["pitch"].text == "40.0 mm"
    strain = next(row for row in opened.pitch_response.rows() if row.key == "largest_in_plane_extension")
    assert strain.value == pytest.approx(float(opened.pitch_response.dataset.largest_in_plane_extension.max()))
    history, maps = opened.pitch.plot.history(), opened.pitch.plot.maps()
    assert history.axes[0].lines[0].get_ydata().max() == pytest.approx(peak / 1e3)
    worst = opened.pitch.dataset.isel(position=opened.pitch.worst)
    assert maps.axes[0].collections[0].get_array().max() == pytest.approx(float(worst.pressure.max()) / 1e3)
    assert "pitch of 40 mm" in tl.plan(opened.case)


def altered(**change):
    return replace(LUGS, **change)


LATERAL = LUGS.lateral[0]


@pytest.mark.parametrize(
    ("profile", "text"),
    [
        (altered(lateral=()), 'no lateral grooves; give it lateral grooves, or take tread = "ribs"'),
        (altered(lateral=(replace(LATERAL, width=1e-3),)), "1 mm wide; below 2 mm it is a sipe"),
        (altered(lateral=(replace(LATERAL, depth=0.024),)), "24 mm deep and the tread 24 mm thick"),
        (altered(grooves=(Groove(0.0, 0.01, 0.03),)), "30 mm deep and the tread 24 mm thick"),
        (altered(lateral=(replace(LATERAL, y_range=(-0.05, 0.0)),)), "from 5 to 44 mm has no lateral groove"),
        (altered(lateral=(replace(LATERAL, y_range=(-0.02, 0.05)),)), "ends inside the rib from -44 to -5 mm"),
        (altered(lateral=(LATERAL, replace(LATERAL, pitch=0.03))), "30 mm is not a whole part of the longest, 40 mm"),
        (altered(lateral=(LATERAL, replace(LATERAL, offset=0.003))), "meet within the rib"),
    ],
)
def test_treads_without_blocks_are_refused(profile, text):
    with pytest.raises(InputError, match=text):
        blocks_of(profile, BELT.tread_thickness)


def test_tires_and_wheels_that_have_no_passage():
    with pytest.raises(InputError, match="blocks need a belt"):
        solve_pitch(Tire.from_profile(LUGS, inflation_pressure=3e5), ROAD, FREE, spacing=CELL)
    with pytest.raises(InputError, match=r"positions must lie in \[4, 200\], got 3"):
        solve_pitch(TIRE, ROAD, FREE, positions=3)
    short = Tire.from_profile(altered(lateral=(replace(LATERAL, pitch=0.02),)), inflation_pressure=3e5, belt=BELT)
    with pytest.raises(InputError, match=r'cells of 10 x 10 mm, and needs 9; use spacing = "4\.6 mm" or less'):
        solve_pitch(short, ROAD, FREE, spacing=0.01)
    with pytest.raises(InputError, match="lateral grooves already"):
        solve_pitch(TIRE, ROAD, FREE, lateral=[LATERAL], spacing=CELL)
    viscous = replace(BELT, tread=tl.materials.Prony(4e6, ((0.3, 0.01),), 0.49))
    with pytest.raises(InputError, match="elastic rubber"):
        solve_pitch(replace(TIRE, belt=viscous), ROAD, FREE, spacing=CELL)


def test_pitches_of_several_lengths_make_blocks_of_several_shapes():
    profile = altered(
        lateral=(
            replace(LATERAL, pitch=0.08, y_range=(-0.05, 0.0)),
            replace(LATERAL, y_range=(0.0, 0.05), angle=0.2),
        ),
    )
    pattern = blocks_of(profile, BELT.tread_thickness)
    assert pattern.period == 0.08
    lengths = sorted(round(stop - start, 6) for start, stop in (block.ends for block in pattern.blocks))
    slanted = 0.04 - 0.006 / math.cos(0.2) + 0.039 * math.tan(0.2)
    assert lengths == pytest.approx([slanted, slanted, 0.074], abs=1e-6)
    # Over two periods each stands twice; none is cut.
    assert len(pattern.between(-0.1, 0.14)) >= 6
    assert all(
        start >= -0.1 and stop <= 0.14 for start, stop in (block.ends for block in pattern.between(-0.1, 0.14))
    )
