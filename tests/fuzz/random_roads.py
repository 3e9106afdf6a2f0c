"""Random layered roads: what mechanics says of every road, asked of many.

`python -m fuzz.random_roads --seed 0 --count 10000`, in the folder tests. Each road has 1 to 8 layers of 1 mm to
20 m and 1 MPa to 200 GPa, Poisson's ratio 0 to 0.5 with both ends, interfaces bonded, half-bonded, sprung and
frictionless, on a rigid base or a half-space. A road is its seed and its number; `--only` repeats one.

Seed 0 was run from 0 to 10 000, 82 595 checks, in 988 s: two failed, 4396 and 6828, whose layer of ν = 0.5 is pressed
from all sides and strains by round-off alone; that is measured by stress over modulus since.
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import xarray as xr

import treadload as tl
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.layers.layered import Stack, Transfer, transfer
from treadload.pavement import HALF_BONDED
from treadload.pavement.stack import stack_of
from treadload.response import GridLoad

TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")
KINDS = {
    "stress": [f"stress_{part}" for part in TENSOR],
    "strain": [f"strain_{part}" for part in TENSOR],
    "displacement": [f"displacement_{part}" for part in "xyz"],
}

# By the largest value of a kind at its depth.
# One wavenumber: some hundred roundings, through eight layers whose moduli differ by up to 2e5.
WAVE = 1e-9
# The same sum of waves in another order.
ROUND = 1e-8
# Waves cut at e^-33 of what they were, and other panels of wavenumbers.
PANELS = 1e-6
# What a Poisson's ratio 1e-14 below 0.5 changes: (length / thickness)² of it, 1e8 at most here.
NEARLY = 1e-5
# Waves longer than all lengths, and the tail beyond the last ring.
NET, NET_OF_RINGS = 1e-6, 1e-4


@dataclass(frozen=True)
class Case:
    """One road, what loads it and where it is asked. places: x and y, m."""

    road: tl.Pavement
    loads: tuple[GridLoad, GridLoad]
    disc: tl.UniformDisc
    depths: Array
    places: tuple[Array, Array]
    side: str
    seed: tuple[int, int]

    def solve(self, **change: object) -> xr.Dataset:
        """The response of the case, or of what differs."""
        asked = {
            "loads": list(self.loads),
            "road": self.road,
            "depths": self.depths,
            "x": self.places[0],
            "y": self.places[1],
            "side": self.side,
        } | change
        loads, road = asked.pop("loads"), asked.pop("road")
        softest = min(one.modulus for one in _materials(road))
        return tl.solve_response(loads, road, **asked).dataset.assign_attrs(softest=softest)


@dataclass
class Tally:
    """What a run came to. worst: check → largest error over its bound, and the road. slowest: seconds, road."""

    roads: int = 0
    refused: int = 0
    checks: Counter[str] = field(default_factory=Counter)
    worst: dict[str, tuple[float, int]] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    seconds: float = 0.0
    slowest: tuple[float, int] = (0.0, -1)

    def __str__(self) -> str:
        lines = [
            f"{self.roads} roads, {sum(self.checks.values())} checks, {self.refused} refused, "
            f"{len(self.failures)} failures, "
            f"{self.seconds:.0f} s; the slowest road {self.slowest[1]}: {self.slowest[0]:.1f} s"
        ]
        for name, (error, number) in sorted(self.worst.items()):
            lines.append(f"  {name:34s}{self.checks[name]:8d}   worst {error:.1e} of its bound, road {number}")
        return "\n".join(lines + self.failures[:40])


def random_case(seed: int, number: int) -> Case:
    """The road of a seed and a number."""
    rng = np.random.default_rng([seed, number])
    road = random_road(rng)
    ends, top = road.interfaces, float(road.interfaces[0])
    # As wide as waves of the first layer can be followed at the surface without millions of them.
    size = float(np.clip(top * 10 ** rng.uniform(-1.3, 0.3), 2e-3, 1.0))
    cells = Grid.centred(size, 0.75 * size, 0.25 * size)
    other = Grid(2, 2, 0.3 * size, 0.2 * size, 0.6 * size, -0.4 * size)
    loads = tuple(
        GridLoad(grid, rng.uniform(0, 1e6, grid.shape), *rng.uniform(-3e5, 3e5, (2, *grid.shape)))
        for grid in (cells, other)
    )
    bottom = float(ends[-1])
    depths = {
        float(rng.choice([0.0, top * rng.uniform(0.05, 0.95)])),
        float(rng.choice([rng.choice(ends), bottom * rng.uniform(0.2, 1.0 if road.rigid_base else 1.5)])),
    }
    places = np.sort(rng.uniform(-1, 1.5, 3)) * size, np.sort(rng.uniform(-1, 1, 2)) * size
    disc = tl.UniformDisc(float(10 ** rng.uniform(-2, -0.5)), 7e5)
    side = str(rng.choice(["above", "below"]))
    return Case(road, loads, disc, np.array(sorted(depths)), places, side, (seed, number))


def random_road(rng: np.random.Generator) -> tl.Pavement:
    """Layers whose thickness and modulus are uniform in their logarithm."""
    count, rigid = int(rng.integers(1, 9)), bool(rng.random() < 0.5)
    layers = []
    for number in range(count + (not rigid)):
        last = number == count
        poisson = rng.choice(
            [0.5, 0.0, 0.5 - 10 ** rng.uniform(-12, -2), rng.uniform(0, 0.5)], p=[0.3, 0.1, 0.1, 0.5]
        )
        material = tl.Elastic(10 ** rng.uniform(6, math.log10(2e11)), float(poisson))
        bond: object = tl.pavement.BONDED
        if number < count - rigid:
            spring = tl.pavement.Bond(float(10 ** rng.uniform(6, 13)))
            bond = [tl.pavement.BONDED, HALF_BONDED, spring, tl.pavement.FRICTIONLESS][
                rng.choice(4, p=[0.45, 0.1, 0.2, 0.25])
            ]
        layers.append(tl.Layer(material, None if last else float(10 ** rng.uniform(-3, math.log10(20))), bond=bond))
    return tl.Pavement(layers, rigid_base=rigid)


Found = Iterator[tuple[str, float, float]]
"""Name of a check, its error and its bound."""


# Waves: the kernel itself, at a few wavenumbers.


def waves(case: Case) -> Found:
    """Checks of `kernels.layers.layered.transfer`."""
    rng = np.random.default_rng([*case.seed, 1])
    stack = stack_of(case.road.bond_limits[-1])
    ends = stack.interfaces
    k = np.sort(10 ** rng.uniform(math.log10(1e-3 / ends[-1]), math.log10(20 / min(stack.thickness)), 6))
    depths = np.concatenate([[0.0], np.repeat(ends, 2), [ends[-1] * rng.uniform(0.05, 1)]])
    below = [False, *[False, True] * len(ends), False]
    base = transfer(k, stack, depths, below)
    yield "waves: finite", 0.0 if _finite(base) else math.inf, 0.5
    yield "waves: interfaces", _interfaces(stack, base, k), WAVE

    factor = 3.7
    stiffer = replace(stack, shear=[g * factor for g in stack.shear], spring=[s * factor for s in stack.spring])
    scaled = transfer(k, stiffer, depths, below)
    scaled.plane[:, :2] *= factor
    scaled.transverse[:, 0] *= factor
    yield "waves: scaled moduli", _differ(scaled, base), WAVE

    yield "waves: a layer split in two", _differ(transfer(k, _split(stack, rng), depths, below), base), WAVE

    material = int(rng.integers(len(stack.shear)))
    count = len(stack.shear)
    equal = Stack(
        [stack.shear[material]] * count,
        [stack.poisson[material]] * count,
        stack.thickness,
        [math.inf] * (count - 1),
        stack.rigid,
    )
    one = Stack(equal.shear[:1], equal.poisson[:1], [float(ends[-1])], [], stack.rigid)
    found = transfer(k, equal, depths, below)
    # Its top and bottom alone: cut at the other depths it would be the same layers.
    rows = [0, len(depths) - 3]
    alone = transfer(k, one, depths[rows], [False] * 2)
    yield "waves: equal layers", _differ(Transfer(found.plane[rows], found.transverse[rows]), alone), WAVE

    long = transfer([1e-9 / ends[-1]], stack, depths, below)
    yield "waves: the load reaches every plane", float(np.abs(long.plane[:, 3, 1] - 1).max()), NET

    soft = [h for nu, h in zip(stack.poisson, stack.thickness, strict=False) if nu == 0.5]
    if soft:
        # Waves in which the volume that is left does not show: (1 - 2ν) / (k h)².
        short = np.maximum(k, 0.1 / min(soft))
        nearly = replace(stack, poisson=[0.5 - 1e-13 if nu == 0.5 else nu for nu in stack.poisson])
        both = transfer(short, nearly, depths, below), transfer(short, stack, depths, below)
        yield "waves: nearly incompressible", _differ(*both), WAVE


def _finite(found: Transfer) -> bool:
    return bool(np.isfinite(found.plane).all() and np.isfinite(found.transverse).all())


def _interfaces(stack: Stack, found: Transfer, k: Array) -> float:
    """What breaks at interfaces: settlement, and the slide of bonds, springs and frictionless ones, by their sizes.

    found: at the surface, then at both sides of every interface.
    """
    worst = 0.0
    for number, spring in enumerate(stack.spring):
        upper, lower = found.plane[1 + 2 * number], found.plane[2 + 2 * number]
        size = np.maximum(np.abs(upper[:2]), np.abs(lower[:2])).max(axis=0)
        slide = upper[0] - lower[0]
        broken = [upper[1] - lower[1], upper[0] - lower[0] if spring == math.inf else spring * slide - k * upper[2]]
        limits = [size, size if spring == math.inf else np.maximum(spring * size, k * np.abs(upper[2:]).max(axis=0))]
        if spring == 0:
            broken[1], limits[1] = upper[2], np.abs(upper[3])
        for one, limit in zip(broken, limits, strict=True):
            worst = max(worst, float((np.abs(one) / np.maximum(limit, 1e-250)).max()))
    return worst


def _differ(a: Transfer, b: Transfer) -> float:
    """Largest difference by the largest displacement, or force, at a depth under a load in a wave; not fixed ones."""
    worst = 0.0
    for rows in (slice(0, 2), slice(2, 4)):
        one, other = a.plane[:, rows], b.plane[:, rows]
        size = np.abs(other).max(axis=1, keepdims=True)
        worst = max(worst, float((np.abs(one - other) / np.maximum(size, 1e-250)).max()))
    size = np.maximum(np.abs(b.transverse), 1e-250)
    return max(worst, float((np.abs(a.transverse - b.transverse) / size).max()))


def _split(stack: Stack, rng: np.random.Generator) -> Stack:
    """The stack with one layer as two bonded ones."""
    layer = int(rng.integers(len(stack.interfaces)))
    share = rng.uniform(0.02, 0.98)
    thickness = list(stack.thickness)
    whole = float(stack.interfaces[layer]) - (float(stack.interfaces[layer - 1]) if layer else 0.0)
    thickness[layer : layer + 1] = [whole * share, whole * (1 - share)]
    twice = [list(values) for values in (stack.shear, stack.poisson)]
    for values in twice:
        values.insert(layer, values[layer])
    spring = list(stack.spring)
    spring.insert(layer, math.inf)
    return Stack(*twice, thickness, spring, stack.rigid)


# Fields: what a user sees, under gridded loads with shear.


def superposition(case: Case, base: xr.Dataset) -> Found:
    """Two loads one by one."""
    yield from _same("superposition", _sum([case.solve(loads=[one]) for one in case.loads]), base, PANELS)


def mirror(case: Case, base: xr.Dataset) -> Found:
    """Left for right."""
    y = case.places[1]
    across = case.solve(loads=[_turned(one, mirror=True) for one in case.loads], y=-y[::-1])
    yield from _same("mirror", _signs(across.isel(y=slice(None, None, -1)), {"y": -1.0}), base, ROUND)


def rotation(case: Case, base: xr.Dataset) -> Found:
    """A quarter turn."""
    x, y = case.places
    turned = case.solve(loads=[_turned(one) for one in case.loads], x=-y[::-1], y=x)
    yield from _same("rotation", _back(turned), base, ROUND)


def scaled_moduli(case: Case, base: xr.Dataset) -> Found:
    """All moduli and springs times a number."""
    factor = 3.7
    stiffer = _with(
        case.road,
        [replace(one, modulus=one.modulus * factor) for one in _materials(case.road)],
        [
            tl.pavement.Bond(one.stiffness * factor) if isinstance(one, tl.pavement.Bond) else one
            for one in _bonds(case.road)
        ],
    )
    scaled = case.solve(road=stiffer)
    for name in KINDS["strain"] + KINDS["displacement"]:
        scaled[name] = scaled[name] * factor
    yield from _same("scaled moduli", scaled, base, ROUND)


def listed_points(case: Case, base: xr.Dataset) -> Found:
    """The grid's points as a list."""
    x, y = case.places
    listed = case.solve(x=None, y=None, points=[(one, other) for other in y for one in x])
    shape = base["stress_zz"].shape
    again = {
        name: (("depth", "y", "x"), listed[name].to_numpy().reshape(shape))
        for name in itertools.chain(*KINDS.values())
    }
    yield from _same("points against grid", xr.Dataset(again), base, ROUND)


def split_layer(case: Case, base: xr.Dataset) -> Found:
    """A layer as two bonded ones."""
    layer = int(np.random.default_rng([*case.seed, 2]).integers(len(case.road.interfaces)))
    yield from _same("a layer split in two", case.solve(road=_halved(case.road, layer)), base, ROUND)


def farther_point(case: Case, base: xr.Dataset) -> Found:
    """Other panels of wavenumbers, which a point far away asks for."""
    x = case.places[0]
    far = case.solve(x=np.append(x, 12 * np.ptp(x)))
    yield from _same("a farther point", far.isel(x=slice(None, -1)), base, PANELS)


def nearly_incompressible(case: Case, base: xr.Dataset) -> Found:
    """Poisson's ratio a little below 0.5."""
    nearly = [replace(one, poisson=0.5 - 1e-14) if one.poisson == 0.5 else one for one in _materials(case.road)]
    if nearly != _materials(case.road):
        found = case.solve(road=_with(case.road, nearly, _bonds(case.road)))
        yield from _same("nearly incompressible", found, base, NEARLY)


def equal_layers(case: Case, base: xr.Dataset) -> Found:
    """Layers of one material are one layer, or a half-space, which has a closed form."""
    count, material = len(case.road.layers), case.road.layers[-1].elastic
    # Slides by 1e-9 of what moves at most, yet layers stay apart.
    equal = _with(case.road, [material] * count, [*[tl.pavement.Bond(1e25)] * (count - 1), tl.pavement.BONDED])
    one = _with(case.road, [material] * count, [tl.pavement.BONDED] * count)
    yield from _same("equal layers", case.solve(road=equal), case.solve(road=one), PANELS)


FIELDS: tuple[Callable[[Case, xr.Dataset], Found], ...] = (
    superposition,
    mirror,
    rotation,
    scaled_moduli,
    listed_points,
    split_layer,
    farther_point,
    nearly_incompressible,
    equal_layers,
)


def under_a_disc(case: Case) -> Found:
    """Equilibrium below a disc of a real wheel's size, where the rings are few, and superposition of two."""
    bottom, moduli = float(case.road.interfaces[-1]), [one.modulus for one in _materials(case.road)]
    length = bottom * (max(moduli) / min(moduli)) ** (1 / 3) + case.disc.radius
    discs = [case.disc, tl.UniformDisc(case.disc.radius, 4e5, x=2.5 * case.disc.radius)]
    rows = {"x": np.array([0.0, 1.0, 3.0]) * case.disc.radius, "y": np.zeros(1)}
    together = case.solve(loads=discs, **rows)
    yield from _same("discs add up", _sum([case.solve(loads=[one], **rows) for one in discs]), together, PANELS)
    if any(bond != tl.pavement.BONDED for bond in _bonds(case.road)) or 100 * length / bottom > 300:
        return
    # Rings up to where σ_zz, which falls like r^-5, holds 1e-6 of the load.
    edges = np.concatenate(
        [[0.0], np.geomspace(0.3 * bottom, 100 * length, math.ceil(8 * math.log10(340 * length / bottom)))]
    )
    points, weights = np.polynomial.legendre.leggauss(8)
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    r = (middle[:, None] + half[:, None] * points).ravel()
    w = (half[:, None] * weights).ravel()
    stress = case.solve(loads=case.disc, depths=[bottom], x=r, y=[0.0])["stress_zz"].to_numpy().ravel()
    carried = -float((stress * 2 * np.pi * r * w).sum())
    weight = case.disc.pressure * np.pi * case.disc.radius**2
    yield "rings carry the disc", abs(carried / weight - 1), NET_OF_RINGS


def _same(name: str, found: xr.Dataset, wanted: xr.Dataset, bound: float) -> Found:
    """Differences by the largest value of each kind at each depth; a value that is NaN in one only is infinite."""
    pressed = 0.0
    for kind, names in KINDS.items():
        a, b = (np.stack([data[one].to_numpy() for one in names]) for data in (found, wanted))
        if (np.isnan(a) != np.isnan(b)).any() or np.isinf(a).any() or np.isinf(b).any():
            yield f"{name}: {kind}", math.inf, bound
            continue
        size = np.nanmax(np.abs(np.concatenate([a, b])), axis=(0, 2, 3), initial=0.0)
        # A rigid base does not move.
        size = np.maximum(size, {"displacement": 1e-9, "strain": 1e-8, "stress": 0.0}[kind] * size.max())
        if kind == "strain":
            # A layer of ν = 0.5 that is pressed from all sides does not strain: what is left of it is the round-off
            # of stress over modulus, 2e-16 of that, and less than 1e-8 of this.
            size = np.maximum(size, 1e-7 * pressed / wanted.attrs["softest"])
        elif kind == "stress":
            pressed = size
        error = np.nanmax(np.abs(a - b), axis=(0, 2, 3), initial=0.0) / np.maximum(size, 1e-250)
        yield f"{name}: {kind}", float(error.max()), bound


def _sum(parts: list[xr.Dataset]) -> xr.Dataset:
    total = parts[0].copy()
    for name in itertools.chain(*KINDS.values()):
        total[name] = sum(part[name] for part in parts)
    return total


def _turned(load: GridLoad, *, mirror: bool = False) -> GridLoad:
    """The load mirrored in y, or turned by a quarter from x towards y."""
    grid, (pressure, along, across) = load.grid, load.array
    if mirror:
        flipped = Grid(grid.nx, grid.ny, grid.dx, grid.dy, grid.x0, -grid.y[-1])
        return GridLoad(flipped, pressure[::-1], along[::-1], -across[::-1])
    quarter = Grid(grid.ny, grid.nx, grid.dy, grid.dx, -grid.y[-1], grid.x0)
    return GridLoad(quarter, pressure.T[:, ::-1], -across.T[:, ::-1], along.T[:, ::-1])


def _signs(data: xr.Dataset, turned: dict[str, float]) -> xr.Dataset:
    data = data.copy()
    for name in itertools.chain(*KINDS.values()):
        for axis in name.split("_")[1]:
            data[name] = data[name] * turned.get(axis, 1.0)
    return data


def _back(data: xr.Dataset) -> xr.Dataset:
    """Fields of the turned road in the axes of the first: what was along x is along y, what was along y along -x."""
    result = data.transpose("depth", "x", "y", ...).isel(x=slice(None, None, -1))
    moved = {}
    for kind, names in KINDS.items():
        for name in names:
            axes = name.split("_")[1]
            other = "".join(sorted({"x": "y", "y": "x", "z": "z"}[axis] for axis in axes))
            sign = math.prod(-1.0 if axis == "y" else 1.0 for axis in axes)
            moved[name] = sign * result[f"{kind}_{other}"].to_numpy()
    return xr.Dataset({name: (("depth", "a", "b"), values) for name, values in moved.items()})


def _materials(road: tl.Pavement) -> list[tl.Elastic]:
    return [layer.elastic for layer in road.layers]


def _bonds(road: tl.Pavement) -> list[object]:
    return [layer.bond for layer in road.layers]


def _with(road: tl.Pavement, materials: list[tl.Elastic], bonds: list[object]) -> tl.Pavement:
    layers = [
        replace(layer, material=material, bond=bond)
        for layer, material, bond in zip(road.layers, materials, bonds, strict=True)
    ]
    return tl.Pavement(layers, rigid_base=road.rigid_base)


def _halved(road: tl.Pavement, number: int) -> tl.Pavement:
    layers = list(road.layers)
    one = layers[number]
    share = one.thickness / 3
    layers[number : number + 1] = [
        replace(one, thickness=share, bond=tl.pavement.BONDED),
        replace(one, thickness=one.thickness - share),
    ]
    return tl.Pavement(layers, rigid_base=road.rigid_base)


def checks(case: Case, every: int) -> Iterator[tuple[str, Callable[[], Found]]]:
    """What a road is asked: waves; one check of fields, drawn, on so many roads once, and as often discs.

    every: 1 for all checks of every road, 0 for waves alone.
    """
    number, whole = case.seed[1], every == 1
    yield "waves", lambda: waves(case)
    if not every:
        return
    if number % every == 0:
        drawn = range(len(FIELDS)) if whole else [int(np.random.default_rng([*case.seed, 3]).integers(len(FIELDS)))]
        kept: list[xr.Dataset] = []

        def base() -> Found:
            kept.append(case.solve())
            yield from ()

        yield "fields", base
        for one in drawn:
            yield FIELDS[one].__name__, lambda one=FIELDS[one]: one(case, kept[0]) if kept else iter(())
    if number % every == every // 2:
        yield "disc", lambda: under_a_disc(case)


def check(case: Case, tally: Tally, every: int = 4) -> None:
    """The checks of one road into the tally."""
    began = time.perf_counter()
    number = case.seed[1]
    for part, found in checks(case, every):
        try:
            for name, error, bound in found():
                tally.checks[name] += 1
                share = error / bound
                if not share <= tally.worst.get(name, (-1.0, 0))[0]:
                    tally.worst[name] = (share, number)
                if not share <= 1:
                    tally.failures.append(f"road {number}: {name} is {error:.2g}, at most {bound:g}")
        except tl.InputError as error:
            # What is refused is not wrong; too many wavenumbers is the one reason.
            tally.refused += 1
            if "wavenumbers" not in str(error):
                tally.failures.append(f"road {number}: {part} refused: {error}")
        except Exception:  # Whatever it is, it is to be found.
            tally.failures.append(f"road {number}: {part}\n{traceback.format_exc(limit=-4)}")
    tally.roads += 1
    seconds = time.perf_counter() - began
    tally.seconds += seconds
    tally.slowest = max(tally.slowest, (seconds, number))


def run(seed: int, numbers: range, every: int = 4, progress: Callable[[Tally], None] | None = None) -> Tally:
    """Check the roads of these numbers. every: see `checks`. progress: called at every hundredth."""
    tally = Tally()
    for number in numbers:
        check(random_case(seed, number), tally, every)
        if progress is not None and tally.roads % 100 == 0:
            progress(tally)
    return tally


def main() -> int:
    """Run; 1 if a road broke a law."""
    parser = argparse.ArgumentParser(prog="python -m fuzz.random_roads", description="Check random layered roads.")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=1000, help="roads")
    parser.add_argument("--start", type=int, default=0, help="first road")
    parser.add_argument("--every", type=int, default=4, help="roads to one whose fields are checked; 1: all, whole")
    parser.add_argument("--only", type=int, help="the one road to repeat, by every check")
    asked = parser.parse_args()
    numbers, every = range(asked.start, asked.start + asked.count), asked.every
    if asked.only is not None:
        numbers, every = range(asked.only, asked.only + 1), 1
        print("\n".join(map(str, random_case(asked.seed, asked.only).road.layers)))
    tally = run(asked.seed, numbers, every, lambda one: print(one, "\n", flush=True))
    print(tally)
    return 1 if tally.failures else 0


if __name__ == "__main__":
    sys.exit(main())
