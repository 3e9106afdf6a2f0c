"""Places under a tire that a reader asks for: its centre, the middle and the edge of a rib."""

from __future__ import annotations

import numpy as np

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.largest import ALIKE, index_of_largest
from treadload.plots.kit.plan import edges, fields_of, plane

# Share of the largest pressure below which a cell does not count as touched: transforms leave a little stress.
_TOUCHED = 5e-3
# Share of the largest line load that a line across travel needs to stand for the tire: not in a lateral groove.
_LOADED = 0.7


def pressure_of(source: Source) -> xr.Dataset:
    """Dataset with `pressure` (y, x), Pa, of a contact, or of the surface stress of a response.

    Raises InputError if the source has neither, or nothing presses.
    """
    data = fields_of(source)
    if "pressure" not in data:
        if "stress_zz" not in data or not np.isclose(float(data["depth"].min()), 0.0):
            raise InputError("the load is not known: give a contact, or a response that has the depth 0")
        surface = data["stress_zz"]
        if "depth" in surface.dims:
            surface = surface.isel(depth=int(np.argmin(data["depth"].to_numpy())))
        # A slice has lost one of its coordinates' lengths, not the coordinate.
        missing = [name for name in ("y", "x") if name not in surface.dims]
        data = xr.Dataset({"pressure": -surface.expand_dims(missing)})
    pressure = plane(data, "pressure")
    if not (pressure > 0).any():
        raise InputError("nothing presses on this road, so no place under the tire can be named")
    pressure = np.where(pressure >= _TOUCHED * pressure.max(), pressure, 0.0)
    points = {name: np.atleast_1d(data[name].to_numpy()) for name in ("y", "x")}
    return xr.Dataset({"pressure": (("y", "x"), pressure)}, points)


def load_centre(source: Source) -> tuple[float, float]:
    """X and y, m, of the centre of pressure of a contact or of the load on a response's surface."""
    data = pressure_of(source)
    x, y = data["x"].to_numpy(), data["y"].to_numpy()
    load = plane(data, "pressure") * np.outer(np.diff(edges(y)), np.diff(edges(x)))
    return float((load.sum(axis=0) * x).sum() / load.sum()), float((load.sum(axis=1) * y).sum() / load.sum())


def places_under(contact: Source) -> dict[str, tuple[float, float]]:
    """Characteristic places under a tire, x and y in m, from its contact pressure.

    contact: with pressure (y, x), Pa, or a response with the stress at the surface. All places lie on one line
    across travel, the loaded one nearest to the centre of pressure, at centres of cells: "tire's centre";
    "rib's middle" and "rib's edge" of the rib that carries most beside the one over the centre, the edge in its
    last cell away from the centre. A smooth tire has the centre and the edge only.
    Raises InputError if nothing presses.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> [f"{name}: y = {y * 1e3:.0f} mm" for name, (x, y) in tl.plots.places_under(contact).items()]
    ["tire's centre: y = 0 mm", "rib's edge: y = 12 mm"]
    """
    data = pressure_of(contact)
    pressure, x, y = plane(data, "pressure"), data["x"].to_numpy(), data["y"].to_numpy()
    x_centre, y_centre = load_centre(data)
    line_load = pressure.sum(axis=0)
    loaded = np.nonzero(line_load >= _LOADED * line_load.max())[0]
    column = int(loaded[_nearest(x[loaded], x_centre)])
    here = float(x[column])
    line = pressure[:, column]
    middle = _nearest(y, y_centre)
    ribs = _runs(line > 0)
    beside = [rib for rib in ribs if middle not in rib] or ribs
    rib = beside[index_of_largest(np.array([line[rows].sum() for rows in beside]), horizontal=1)[0]]
    ends = np.array([rib[0], rib[-1]])
    outer = int(ends[index_of_largest(np.abs(y[ends] - y_centre), horizontal=1)[0]])
    places = {"tire's centre": (here, float(y[middle]))}
    if middle not in rib:
        places["rib's middle"] = (here, float(y[rib[len(rib) // 2]]))
    places["rib's edge"] = (here, float(y[outer]))
    return places


def _nearest(points: Array, place: float) -> int:
    """Index of the point nearest to a place, of two at the same distance the larger: round-off would choose."""
    distances = np.abs(points - place)
    return int(np.nonzero(distances <= distances.min() + ALIKE * np.ptp(points))[0][-1])


def _runs(mask: BoolArray) -> list[range]:
    """Rows of each unbroken run of a mask (n,)."""
    steps = np.diff(np.concatenate([[0], mask.astype(int), [0]]))
    return [range(int(a), int(b)) for a, b in zip(np.nonzero(steps == 1)[0], np.nonzero(steps == -1)[0], strict=True)]
