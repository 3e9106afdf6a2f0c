"""The grid that a contact is solved on: how much it holds, when it grows, when that of a start serves again."""

import os
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from treadload.contact import Rolling, contact_grid, memory_bound, solve_contact
from treadload.contact.bodies.choose import Pair
from treadload.contact.contact_grid import BorderError
from treadload.contact.solvers import tangential
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.materials import Elastic, Prony
from treadload.pavement import Pavement
from treadload.tire import Belt, Groove, Tire, TreadProfile

ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))
RUBBER = Elastic(3e6, 0.5)
PROFILE = TreadProfile(0.3, 0.4, 0.12, 0.01, grooves=(Groove(-0.025, 0.008, 0.006), Groove(0.025, 0.008, 0.006)))
TIRE = Tire.from_profile(PROFILE, material=RUBBER)
MAP = Tire.from_height_map(np.add.outer(np.linspace(-1, 1, 30) ** 2, np.linspace(-1, 1, 30) ** 2) * 0.01, 4e-3)
CELL = 6e-3
# What `place` leaves beside the patch, as the two sentences of its docstring and of the margin say.
MARGIN = 0.024


def wheel(load=1e3, **given):
    return Rolling(normal_load=load, friction=0.6, **given)


def placed(rolling, spacing=CELL, tire=TIRE):
    return contact_grid.place(tire, rolling, Pair.of(tire, ROAD).both, spacing)


@pytest.mark.parametrize("load", [50.0, 400.0, 1e3])
def test_beside_the_patch_lies_the_margin_and_little_more(load):
    grid, gap = placed(wheel(load))
    assert gap.shape == grid.shape
    touching = solve_contact(TIRE, ROAD, wheel(load), spacing=CELL).dataset.pressure.to_numpy() > 0
    # Where the contact lies is looked for on cells of a sixty-fourth of the tread, or those asked for.
    coarse = max(CELL, max(TIRE.extent) / 64)
    for axis, (count, size) in enumerate([(grid.ny, TIRE.extent[1] + 2 * MARGIN), (grid.nx, TIRE.extent[0])]):
        outermost = np.flatnonzero(touching.any(1 - axis))[[0, -1]]
        beside = min(outermost[0], count - 1 - outermost[1]) * CELL
        # One coarse cell is added, and the patch of the coarse cells may be one larger or smaller.
        assert MARGIN - CELL <= beside <= MARGIN + 2 * coarse + 2 * CELL, axis
        assert count * CELL <= size + 2 * CELL


@pytest.mark.parametrize("along", [True, False])
@pytest.mark.parametrize("across", [True, False])
def test_a_grid_grows_where_it_cut_and_only_there(along, across):
    small = Grid.on_lattice(0.1, 0.08, CELL)
    length, width = TIRE.extent
    grown = contact_grid.widened(TIRE, small, BorderError("cut", along=along, across=across))
    if not (along or across):
        assert (grown.nx, grown.ny) == (small.nx, small.ny)
        return
    # To the whole tread, and a lattice may add a cell.
    assert (grown.dx, grown.dy) == (CELL, CELL)
    wanted = length + CELL if along else small.nx * CELL, width + 2 * MARGIN + CELL if across else small.ny * CELL
    assert (grown.nx * CELL, grown.ny * CELL) == pytest.approx(wanted, abs=1.001 * CELL)
    assert (grown.nx > small.nx) == along
    assert (grown.ny > small.ny) == across


@pytest.mark.parametrize(
    ("size", "along", "across"),
    [
        ((1.0, 1.0), True, True),
        ((1.0, 1.0), True, False),
        ((1.0, 1.0), False, True),
        # What could still grow would not help.
        ((1.0, 0.08), True, False),
        ((0.1, 1.0), False, True),
        ((1.0, 0.08), True, True),
        ((0.1, 1.0), True, True),
    ],
)
def test_a_grid_of_the_whole_tread_does_not_grow(size, along, across):
    whole = Grid.on_lattice(min(size[0], TIRE.extent[0]), min(size[1], TIRE.extent[1] + 2 * MARGIN), CELL)
    assert contact_grid.widened(TIRE, whole, BorderError("cut", along=along, across=across)) is None


def test_a_height_map_never_grows():
    cut = BorderError("cut", along=True, across=True)
    assert contact_grid.widened(MAP, Grid.on_lattice(0.01, 0.01, 4e-3), cut) is None


@pytest.fixture(scope="module")
def light():
    return solve_contact(TIRE, ROAD, wheel(100.0), spacing=CELL)


def grid_for(start, rolling, spacing=None, tire=TIRE):
    return contact_grid.same_place(tire, rolling, Pair.of(tire, ROAD).both, start, spacing)[0]


def grid_of(contact):
    data = contact.dataset
    return Grid(data.sizes["x"], data.sizes["y"], CELL, CELL, float(data.x[0]), float(data.y[0]))


def test_the_grid_of_a_start_serves_again_where_it_is_large_enough(light):
    heavy = solve_contact(TIRE, ROAD, wheel(2e3), spacing=CELL)
    own, larger = grid_of(light), grid_of(heavy)
    assert larger.nx > own.nx
    assert larger.ny > own.ny
    # Other forces, the same load: the same grid; so a lighter load on the larger one.
    assert grid_for(light, wheel(100.0, tractive_force=30.0)) == own
    assert grid_for(heavy, wheel(100.0)) == larger
    assert grid_for(light, wheel(2e3)) == larger
    # Wider alone, or longer alone, is too small as well.
    for size in ((larger.nx, own.ny), (own.nx, larger.ny)):
        cut = heavy.dataset.isel(
            x=slice((larger.nx - size[0]) // 2, (larger.nx + size[0]) // 2),
            y=slice((larger.ny - size[1]) // 2, (larger.ny + size[1]) // 2),
        )
        part = type(heavy)(cut, TIRE, ROAD, wheel(100.0), heavy.stats, ())
        assert grid_for(part, wheel(2e3)) == larger


def test_a_start_keeps_its_cells(light):
    assert grid_for(light, wheel(100.0), spacing=CELL * (1 + 1e-12)) == grid_of(light)
    with pytest.raises(InputError, match=r"the start has cells of 6 mm, got spacing = 5 mm"):
        solve_contact(TIRE, ROAD, wheel(100.0), spacing=5e-3, start=light)


def test_a_start_is_begun_at_and_not_kept(light):
    """The same answer from a start, in fewer steps; from a start on another grid as from none."""
    again = solve_contact(TIRE, ROAD, wheel(100.0), start=light)
    assert again.stats["normal_iterations"] < light.stats["normal_iterations"]
    # To the tolerance of both.
    scale = float(light.dataset.pressure.max())
    np.testing.assert_allclose(again.dataset.pressure, light.dataset.pressure, atol=1e-5 * scale)
    heavy = solve_contact(TIRE, ROAD, wheel(2e3), start=light)
    own = solve_contact(TIRE, ROAD, wheel(2e3), spacing=CELL)
    np.testing.assert_array_equal(heavy.dataset.pressure, own.dataset.pressure)


def test_cells_that_do_not_fit_into_memory_say_estimate_memory_and_remedy(monkeypatch):
    memory = 2e9
    monkeypatch.setattr(memory_bound, "memory_of_machine", lambda: memory)
    with pytest.raises(InputError, match=r"of the 2 GB of memory of this machine; use spacing = ") as caught:
        placed(wheel(), spacing=1e-5)
    told = str(caught.value)
    cells, need = (float(re.search(pattern, told)[1]) for pattern in (r"on (\S+) cells", r"about (\S+) GB"))
    assert need * 1e9 == pytest.approx(memory_bound._SHEAR * cells, rel=0.01)
    # What is offered fits, and takes what is allowed, to its two digits.
    offered = float(re.search(r'spacing = "(\S+) mm"', told)[1]) * 1e-3
    grid, _ = placed(wheel(), spacing=offered)
    taken = memory_bound.estimated_memory(TIRE, wheel(), Pair.of(TIRE, ROAD).both, grid)
    assert 0.75 * 0.8 * memory < taken <= 0.8 * memory
    monkeypatch.setattr(memory_bound, "memory_of_machine", lambda: 1e5)
    with pytest.raises(InputError, match="a height map keeps its cells: give one on larger cells"):
        placed(wheel(), spacing=None, tire=replace(MAP, material=RUBBER))


def test_ribs_and_rubber_with_memory_are_estimated_with_more():
    grid = Grid.centred(0.3, 0.2, 1e-3)
    elastic = Pair.of(TIRE, ROAD).both
    base = memory_bound.estimated_memory(TIRE, wheel(), elastic, grid)
    smooth = memory_bound.estimated_memory(TIRE, Rolling(normal_load=1e3, friction=0.0), elastic, grid)
    assert smooth < base
    fading = replace(TIRE, material=Prony.standard_linear_solid(4e6, 3e6, 0.01, 0.5))
    rolls = Pair.of(fading, ROAD, speed=10.0).both
    assert memory_bound.estimated_memory(fading, wheel(speed=10.0), rolls, grid) > 2 * base
    belt = replace(Belt.from_library("315/80R22.5"), tread=Elastic(5.5e6, 0.495))
    ribs = Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=belt, tread="ribs")
    coarse, fine = (
        memory_bound.estimated_memory(ribs, wheel(), elastic, Grid.centred(0.3, 0.2, size)) for size in (4e-3, 2e-3)
    )
    # Four times the cells, each with twice the rows beside it.
    assert 4 < fine / coarse < 8


def test_the_memory_of_this_machine_is_known():
    assert 1e8 < memory_bound.memory_of_machine() < 1e15


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the peak of a process is read in a file of Linux")
@pytest.mark.parametrize("friction", [0.0, 0.7])
def test_the_estimate_is_the_peak_of_a_process_within_a_third(friction):
    """A ball on 400 x 400 cells of 0.5 mm, a third of them in contact, beside the process before it solves."""
    code = f"""
import re
from pathlib import Path
import numpy as np
import treadload as tl
import treadload.contact.solve
from treadload.contact import memory_bound
from treadload.contact.bodies.choose import Pair

across = (np.arange(400) - 199.5) * 5e-4
gap = (across[None] ** 2 + across[:, None] ** 2) / 0.6
tire = tl.Tire.from_height_map(gap, 5e-4, material=tl.Elastic(3e6, 0.5))
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
rolling = tl.Rolling(normal_load=5500, friction={friction}, tractive_force={900 * (friction > 0)})
# The peak that getrusage counts is that of the process which started this one, where that was larger.
peak = lambda: 1024 * int(re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1])
before = peak()
tl.solve_contact(tire, road, rolling)
print((peak() - before) / memory_bound.estimated_memory(tire, rolling, Pair.of(tire, road).both, tire.fixed_grid))
"""
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert 2 / 3 < float(ran.stdout) < 4 / 3


def test_cells_too_few_say_their_bound():
    length, width = TIRE.extent
    narrow = min(length, width)
    assert placed(wheel(), spacing=narrow / 8 * 0.999)[0].ny >= 8
    with pytest.raises(InputError, match="fewer than 8 cells") as caught:
        placed(wheel(), spacing=narrow / 8 * 1.001)
    assert f"{narrow / 64 * 1e3:.2g} mm or less" in str(caught.value)


def test_a_stalled_newton_step_is_said_and_one_that_goes_on_is_not(monkeypatch):
    given = {"spacing": CELL}
    smooth = solve_contact(TIRE, ROAD, wheel(300.0, tractive_force=90.0), **given)
    assert not any("Newton" in text for text in smooth.warnings)
    real = tangential.coulomb_newton.solve
    monkeypatch.setattr(
        tangential.coulomb_newton, "solve", lambda *args, **given: real(*args, **{**given, "max_iterations": 0})
    )
    # So few cells would be solved directly.
    monkeypatch.setattr(tangential.coulomb_direct, "MOST_CELLS", 0)
    stalled = solve_contact(TIRE, ROAD, wheel(300.0, tractive_force=90.0), **given)
    steps = stalled.stats["splitting_iterations"]
    assert steps > 0
    assert sum("Newton" in text and f" {steps} steps" in text for text in stalled.warnings) == 1


def test_without_friction_no_step_is_counted():
    free = solve_contact(TIRE, ROAD, Rolling(normal_load=300.0, friction=0.0, creepage_x=0.01), spacing=CELL)
    for name in ("newton_iterations", "krylov_iterations", "splitting_iterations"):
        assert free.stats[name] == 0, name
    assert free.warnings == ()
    # Nothing holds the wheel: it slides at the creepage given, and the tread hardly moves aside as it is pressed.
    assert float(free.dataset.creepage_x) == 0.01
    touching = free.dataset.pressure.to_numpy() > 0
    np.testing.assert_allclose(free.dataset.slip_x.to_numpy()[touching], 0.01, rtol=2e-3)


def test_the_clock_runs_forward(light):
    assert 0 < light.stats["seconds"] < 600


def test_an_offset_moves_the_cells_by_parts_of_one():
    plain, moved = (
        solve_contact(TIRE, ROAD, wheel(), spacing=CELL, offset=by).dataset for by in ((0, 0), (0.5, -0.25))
    )
    # x = 0 lies between two cells, y = 0 a quarter of a cell beside a centre.
    assert float(np.abs(moved.x / CELL).min()) == pytest.approx(0.5)
    assert float(moved.y[np.argmin(np.abs(moved.y.to_numpy()))]) == pytest.approx(-0.25 * CELL)
    assert (plain.sizes["x"], plain.sizes["y"]) == (moved.sizes["x"], moved.sizes["y"])
    load = float(moved.pressure.sum()) * CELL**2
    assert load == pytest.approx(1e3)
    # Edges stand elsewhere, by half a cell at most: so does what the wheel sinks in.
    assert float(plain.approach) != float(moved.approach)
    assert float(plain.approach) == pytest.approx(float(moved.approach), rel=0.02)


def test_an_offset_is_refused_where_it_means_nothing():
    start = solve_contact(TIRE, ROAD, wheel(), spacing=CELL)
    for tire, given, words in [
        (TIRE, {"offset": (0.0, 0.7), "spacing": CELL}, "two parts of a cell from -0.5 to 0.5"),
        (replace(MAP, material=RUBBER), {"offset": (0.5, 0.0)}, "keeps its own cells"),
        (TIRE, {"offset": (0.5, 0.0), "start": start}, "leave one of the two out"),
    ]:
        with pytest.raises(InputError, match=words):
            solve_contact(tire, ROAD, wheel(), **given)
