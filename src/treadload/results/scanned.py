"""What a scan shows, as a dataset that its figure is drawn from."""

from __future__ import annotations

import math

import numpy as np

from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.results.dataset import height_map
from treadload.results.tree import to_tree
from treadload.tire import Tire
from treadload.tire.scan.surface import ScanSurface
from treadload.tire.scan.wear import STEP, unroll, wear
from treadload.tire.wear import Wear


def scan_wear(new: Tire, earlier: Tire) -> Wear:
    """What is gone of a scanned tire since an earlier scan of it; see `tire.scan.wear`. Raises InputError."""
    return wear(_surface(new), _surface(earlier))


def scan_map(tire: Tire, earlier: Tire | None = None, *, spacing: float = 3e-3) -> xr.Dataset | xr.DataTree:
    """What `treadload scan -o` writes: the gap over the road (y, x) and how the scan was read; beside it the wear.

    tire, earlier, spacing: as in `scan_fields`. With an earlier scan a tree: the gap at its root, so that the file is
    a height map all the same, and `Wear` in the group /wear. The attribute `scan` is what is printed of the scan.
    Raises InputError.
    """
    data = height_map(tire, spacing).assign_attrs(scan=str(_surface(tire).report))
    if earlier is None:
        return data
    tree = to_tree(scan_wear(tire, earlier), title=f"{tire.name or 'tire'}: tread wear")
    tree.dataset = data.assign_attrs(tree.attrs | data.attrs | {"earlier": str(earlier)})
    return tree


def scan_fields(tire: Tire, earlier: Tire | None = None, *, spacing: float = 3e-3) -> xr.Dataset:
    """Depth below the crown unrolled (across, turn), m, median, tops, gap over the road (y, x) and what was filled.

    tire: of a scan. earlier: an earlier scan of it, from which `worn` (across, turn) and `earlier` (across) follow.
    spacing: of the cells over the road, m. Raises InputError for a tire that was not scanned.
    """
    surface = _surface(tire)
    quality = surface.report
    crown = quality.crown_radius
    theta = np.arange(-math.pi, math.pi, STEP) + 0.3 * STEP
    across = surface.across[:: max(1, len(surface.across) // 400)]
    depth = crown - unroll(surface, theta, across)
    grid = Grid.on_lattice(*surface.extent, spacing)
    tread = np.interp(across, surface.across, surface.envelope) > crown - 0.03
    tops = np.full(len(theta), np.nan)
    seen = np.isfinite(depth[tread]).any(axis=0)
    tops[seen] = np.nanquantile(depth[tread][:, seen], 0.1, axis=0)
    fields = {
        "unrolled_depth": (("across", "turn"), depth),
        "meridian": (("across",), crown - np.interp(across, surface.across, surface.meridian)),
        "envelope": (("across",), crown - np.interp(across, surface.across, surface.envelope)),
        "tops": (("turn",), tops),
        "initial_gap": (("y", "x"), surface.height_map(grid)),
        "filled": (("y", "x"), surface.filled(grid)),
    }
    if earlier is not None:
        old = _surface(earlier)
        gone = wear(surface, old).dataset
        rows = np.clip(np.searchsorted(gone.across.to_numpy(), across), 0, gone.sizes["across"] - 1)
        worn, before = gone.tread_wear.to_numpy()[rows], gone.earlier_tread_height.to_numpy()
        then = np.interp(across, gone.across, before, left=np.nan, right=np.nan)
        fields |= {"worn": (("across", "turn"), worn), "earlier": (("across",), -then)}
    noise = "noise unknown" if math.isnan(quality.noise) else f"noise {quality.noise * 1e3:.2f} mm"
    about = {
        "said": f"crown {crown * 1e3:.1f} mm, tread on {seen.mean() * 360:.0f}°, {noise}",
        "grooves": [value for g in quality.grooves for value in (g.centre, g.width, g.depth)],
        "warnings": list(quality.warnings),
    }
    return xr.Dataset(fields, {"across": across, "turn": theta, "x": grid.x, "y": grid.y}, about)


def _surface(tire: Tire) -> ScanSurface:
    if not isinstance(tire.surface, ScanSurface):
        raise InputError(f"{tire.name or 'this tire'} is no scan; read one with Tire.from_scan")
    return tire.surface
