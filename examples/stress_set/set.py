"""An open set of contact stresses: pressure and shear of two truck tires with ribs on a belt, in one Zarr store.

Tire, load, inflation pressure, slip, slip angle, friction and wear vary together over a Sobol sequence. The study is
resumed after an interruption, and `publish` writes it as one store with CF names that `xarray.open_zarr` opens.

    python examples/stress_set/set.py set FOLDER --cases 512 --jobs 2      the set, FOLDER/stress_set.zarr
    python examples/stress_set/set.py lines FOLDER                         small multiples, FOLDER/stress_set.png
    python examples/stress_set/set.py between FOLDER --cases 200 --jobs 2  footprints between cases, and their error
"""

import argparse
import itertools
import json
import math
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.stats import qmc

import treadload as tl
from treadload.plots import new_figure
from treadload.plots.kit.style import styled
from treadload.sweeps.design import listed

CASE = Path(__file__).parent / "set.toml"
FIELDS = ("pressure", "traction_x", "traction_y")
# Tread and belt of each tire; another one is a line here.
TIRES = (
    ("315/80R22.5", {"name": "315/80R22.5", "tread": {"kind": "elastic", "modulus": "5.5 MPa", "poisson": 0.495}}),
    ("335/65R22.5 tread", "335/65R22.5"),
)
# Worn off the tread, m. Each makes cross-sections of ribs of its own, which cases share. From 9 mm on, all ribs form
# one section, whose table takes minutes, once.
WEARS = (0.0, 3e-3, 6e-3)
LOADS, PRESSURES, FRICTIONS = (15e3, 40e3), (6e5, 10e5), (0.3, 0.9)
# Slip about free rolling and the largest slip angle, both denser towards zero; treads are symmetric, so that cases to
# the left are the mirror images of those to the right.
FREE, MOST_SLIP, MOST_ANGLE = -0.012, 0.06, math.radians(8)
# Of the set between whose cases footprints are interpolated.
RANGES = {"normal_load": (20e3, 45e3), "inflation_pressure": (6e5, 10e5), "creepage_x": (-0.05, 0.03)}
HELD_BACK, SEED = 50, 2026
CARD = {
    "Conventions": "CF-1.11",
    "summary": (
        "Contact pressure and shear of truck tires with ribs on an inflated belt, rolling steadily on asphalt; "
        "computed, not measured. Sobol sample of tire, load, inflation pressure, slip, slip angle, friction and wear."
    ),
    "license": "CC-BY-4.0",
    "references": "treadload, docs/howto/stress_set.md; README.md of examples/stress_set is the data card",
    "creepage_origin": "creepage_x counts from the radius of the unloaded tread; free rolling is near -0.012",
}


def wide_design(case: tl.Case, count: int, seed: int = 0) -> tl.sweeps.Design:
    """`count` cases of a scrambled Sobol sequence over all inputs, sorted so that neighbours share their ribs."""
    unit = qmc.Sobol(7, rng=seed).random(count)
    rows = []
    for tire, load, pressure, slip, angle, friction, wear in unit.tolist():
        profile, belt = TIRES[int(tire * len(TIRES))]
        away = 2 * slip - 1
        rows.append(
            {
                "profile": profile,
                "belt": belt,
                "wear": WEARS[int(wear * len(WEARS))],
                "normal_load": LOADS[0] + load * (LOADS[1] - LOADS[0]),
                "inflation_pressure": PRESSURES[0] + pressure * (PRESSURES[1] - PRESSURES[0]),
                "creepage_x": FREE + MOST_SLIP * away * abs(away),
                "creepage_y": math.tan(MOST_ANGLE * angle**2),
                "friction": FRICTIONS[0] + friction * (FRICTIONS[1] - FRICTIONS[0]),
            }
        )
    return listed(case, sorted(rows, key=lambda row: (row["profile"], row["wear"])))


def solve(case: tl.Case, design: tl.sweeps.Design, store: Path, jobs: int) -> tl.sweeps.Sweep:
    """The study in its store, solved where it is not, with its rate."""
    began = time.perf_counter()
    before = tl.sweeps.open_sweep(store).stats["solved"] if (store / "study.json").exists() else 0
    study = tl.sweep(case, design, fields=FIELDS, store=store, jobs=jobs, progress=print_progress)
    passed, stats = time.perf_counter() - began, study.stats
    print(
        f"{store.name}: {stats['solved'] - before} cases in {passed:.0f} s ({stats['solved']} solved, "
        f"{stats['failed']} failed), {stats['seconds'] / max(1, stats['solved']):.2f} s of solving a case"
    )
    return study


def print_progress(done: int, total: int, what: str) -> None:
    if done == total or done % 50 == 0:
        print(f"{done} of {total} {what}s", flush=True)


def publish(study: tl.sweeps.Sweep, path: Path) -> None:
    """The study as one Zarr store with the attributes of CF, fields in single precision."""
    data = study.dataset.load().assign_attrs(CARD)
    data.attrs["source"] = f"treadload {data.attrs['treadload_version']}"
    data.attrs["history"] = f"{datetime.now(UTC):%Y-%m-%dT%H:%MZ} examples/stress_set/set.py"
    for axis in ("x", "y"):
        data[axis].attrs["axis"] = axis.upper()
    encoding = {
        name: {"dtype": "f4", "chunks": (min(64, data.sizes["case"]), *data[name].shape[1:])} for name in FIELDS
    }
    data.to_zarr(path, mode="w", zarr_format=2, consolidated=True, encoding=encoding)
    size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file())
    print(f"{path.name}: {size / 1e6:.1f} MB, {size / data.sizes['case'] / 1e3:.0f} kB a case")


def rib_rows(case: tl.Case, y: np.ndarray, rib: int) -> np.ndarray:
    """Rows of cells on a rib, counted from the middle one to the right."""
    profile = tl.catalogue.tires[case.tire.profile]
    edges = sorted(side for g in profile.grooves for side in (g.centre - g.width / 2, g.centre + g.width / 2))
    edges = [-profile.width / 2, *edges, profile.width / 2]
    low, high = edges[2 * (len(profile.grooves) // 2 + rib) : 2 * (len(profile.grooves) // 2 + rib) + 2]
    return (y > low) & (y < high)


def outward(pressure: np.ndarray, across: np.ndarray, y: np.ndarray) -> float:
    """Outward shear of a rib over its pressure: half of its right half's lateral shear less that of its left half.

    pressure, across: (rows, nx) of the rib, Pa. y: (rows,). Positive where the rib pushes the road outwards.
    """
    right = (y > y.mean())[:, None]
    return float(((across * right).sum() - (across * ~right).sum()) / pressure.sum())


@styled
def lines(folder: Path, jobs: int = 1, spacing: str = "6 mm") -> dict[str, list[float]]:
    """Lateral shear of ribs over load, pressure, friction and wear in free rolling, each alone: a figure."""
    tables = tl.Case.from_toml(CASE, changes=[f'spacing="{spacing}"']).as_tables()
    # Without its creepage the wheel rolls freely.
    del tables["rolling"]["creepage_x"]
    case = tl.Case.from_dict(tables)
    along = {
        "normal_load": ("load (kN)", 1e-3, np.linspace(15e3, 40e3, 6)),
        "inflation_pressure": ("inflation pressure (bar)", 1e-5, np.linspace(6e5, 10e5, 6)),
        "friction": ("friction (–)", 1.0, np.linspace(0.3, 0.9, 6)),
        "wear": ("wear (mm)", 1e3, np.linspace(0.0, 6e-3, 6)),
    }
    base = {"normal_load": 30e3, "inflation_pressure": 8e5, "friction": 0.7, "wear": 0.0}
    rows = [{**base, name: value} for name, (_, _, values) in along.items() for value in values.tolist()]
    study = tl.sweep(case, rows, fields=FIELDS, store=folder / "lines.zarr", jobs=jobs, progress=print_progress)
    data = study.dataset.load()
    figure = new_figure(11.0, 6.0)
    axes = figure.subplots(2, 4, sharey="row")
    y, found = data["y"].to_numpy(), {}
    for column, (name, (label, scale, values)) in enumerate(along.items()):
        upper, lower = axes[:, column]
        shares: dict[int, list[float]] = {0: [], 1: [], 2: []}
        for k, value in enumerate(values):
            at = data.isel(case=column * 6 + k).fillna(0.0)
            pressure, across = at["pressure"].to_numpy(), at["traction_y"].to_numpy()
            middle = int(np.argmin(np.abs(data["x"].to_numpy())))
            if k in (0, 2, 5):
                upper.plot(
                    1e3 * y, 1e-3 * across[:, middle], color=f"{0.75 - 0.15 * k:.2f}", label=f"{value * scale:g}"
                )
            for rib, members in shares.items():
                here = rib_rows(case, y, rib)
                members.append(outward(pressure[here], across[here], y[here]))
        upper.set(xlabel="across, to the right (mm)", title=label)
        upper.legend(fontsize=7)
        for rib, members in shares.items():
            lower.plot(values * scale, members, marker="o", ms=3, label=("middle rib", "next", "shoulder rib")[rib])
            found[f"{name}, rib {rib}"] = members
        lower.set(xlabel=label)
    axes[1, 0].set_ylim(0, None)
    axes[0, 0].set_ylabel("lateral shear at x = 0 (kPa)")
    axes[1, 0].set_ylabel("outward shear over pressure (–)")
    axes[1, 0].legend(fontsize=7)
    tl.plots.save(figure, folder / "stress_set.png")
    return found


def between(folder: Path, count: int = 200, jobs: int = 1, spacing: str = "6 mm") -> xr.Dataset:
    """A set over load, pressure and slip, and its error in 50 cases that were drawn before it was solved."""
    case = tl.Case.from_toml(CASE, changes=[f'spacing="{spacing}"'])
    low, high = np.array(list(RANGES.values())).T
    drawn = low + np.random.default_rng(SEED).random((HELD_BACK, 3)) * (high - low)
    (folder / "held_back.json").write_text(json.dumps({"inputs": list(RANGES), "points": drawn.tolist()}, indent=1))
    # Corners and the middles of the long edges, without which the ends of the ranges would be extrapolated.
    ends = np.array(list(itertools.product((0.0, 1.0), (0.0, 1.0), (0.0, 0.5, 1.0))))
    inside = np.concatenate([ends, qmc.Sobol(3, rng=1).random_base2(math.ceil(math.log2(count)))[:count]])
    over = tl.sweeps.over_points
    study = solve(case, over(case, list(RANGES), low + inside * (high - low)), folder / "between.zarr", jobs)
    held = solve(case, over(case, list(RANGES), drawn), folder / "held_back.zarr", jobs).dataset.load()
    footprints = tl.footprint.FootprintSet.from_store(study.path)
    errors, seconds, resultants = [], [], []
    for k, (load, pressure, slip) in enumerate(drawn.tolist()):
        began = time.perf_counter()
        made = tl.Footprint.interpolate(footprints, load=load, pressure=pressure, slip=slip)
        seconds.append(time.perf_counter() - began)
        grid, at = made.grid, held[list(FIELDS)].isel(case=k)
        at = at.reindex(x=grid.x, y=grid.y, method="nearest", tolerance=1e-6).fillna(0.0)
        solved = np.stack([at[name].to_numpy() for name in FIELDS])
        errors.append(error_of(made.load.array, solved))
        resultants.append(forces(made.load.array, grid) - forces(solved, grid))
        check(made.load.array, load, grid, friction=0.7)
    found = xr.Dataset(
        {
            **{f"{name}_error": ("case", np.array(errors)[:, i]) for i, name in enumerate(FIELDS)},
            "resultant_error": (("case", "resultant"), np.array(resultants)),
            "seconds": ("case", np.array(seconds)),
        },
        {"resultant": ["normal_load", "moment_y", "moment_x", "force_x", "force_y", "moment_z"]},
    )
    for name in FIELDS:
        error = found[f"{name}_error"]
        print(
            f"{name}: rms {float((error**2).mean()) ** 0.5:.2%} of the mean pressure, worst case "
            f"{float(error.max()):.2%}, cases left out in turn {footprints.errors[f'{name}_error']:.2%}"
        )
    print(f"{1e3 * float(found.seconds.median()):.2f} ms a footprint, {1e3 * float(found.seconds.max()):.1f} at most")
    print(
        "largest differences of resultants, N and N m:", np.abs(found.resultant_error).max("case").to_numpy().round(2)
    )
    return found


def error_of(made: np.ndarray, solved: np.ndarray) -> np.ndarray:
    """(3,) rms of the difference where either pressure is above 0, over the mean pressure of the solved one."""
    inside = (made[0] > 0) | (solved[0] > 0)
    return np.sqrt(np.square((made - solved)[:, inside]).mean(1)) / solved[0][solved[0] > 0].mean()


def forces(stress: np.ndarray, grid: tl.response.Grid) -> np.ndarray:
    """(6,) load, its moments, shear forces and their moment about z, N and N m."""
    (p, qx, qy), x, y = stress * grid.cell_area, grid.x[None], grid.y[:, None]
    return np.array([p.sum(), (x * p).sum(), (y * p).sum(), qx.sum(), qy.sum(), (x * qy - y * qx).sum()])


def check(stress: np.ndarray, load: float, grid: tl.response.Grid, friction: float) -> None:
    """Raise AssertionError unless stress is what a contact can have."""
    assert abs(stress[0].sum() * grid.cell_area / load - 1) < 1e-12
    assert stress[0].min() >= 0
    assert (np.hypot(stress[1], stress[2]) <= friction * stress[0] * (1 + 1e-12)).all()


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("set", "lines", "between"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cases", type=int, default=None)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--spacing", default="6 mm")
    options = parser.parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    if options.what == "set":
        case = tl.Case.from_toml(CASE, changes=[f'spacing="{options.spacing}"'])
        study = solve(case, wide_design(case, options.cases or 512), options.folder / "study.zarr", options.jobs)
        print(study.summary())
        publish(study, options.folder / "stress_set.zarr")
    elif options.what == "lines":
        for name, values in lines(options.folder, options.jobs, options.spacing).items():
            print(f"{name}: " + " ".join(f"{value:.3f}" for value in values))
    else:
        between(options.folder, options.cases or 200, options.jobs, options.spacing)


if __name__ == "__main__":
    main()
