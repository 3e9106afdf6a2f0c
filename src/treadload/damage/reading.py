"""What an assessment reads of a response: at which depths, over how much road, and where no crack can open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.composing import Source
from treadload.damage.cracks import crack_plane, gridded
from treadload.damage.history import with_horizontal_stress
from treadload.damage.laws.fatigue import PowerLaw
from treadload.damage.quantity import STRAIN, STRESS, Quantity, cut, part
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.kernels.layers.depths import on_interface, same_depth
from treadload.response import Response, solve_response
from treadload.response.fields import number_of_depth
from treadload.response.loads import PlacedLoad
from treadload.response.means import Means
from treadload.response.superposition import mean_loads

_TENSORS = {*STRESS, *STRAIN}
_PRINCIPAL = "principal_strain_1", "in_plane_strain_1"


@dataclass(frozen=True, eq=False)
class Field:
    """A quantity over (depth, y, x) as an assessment evaluates it. data: stress and strain, see `assess`."""

    data: xr.Dataset
    quantity: Quantity

    @property
    def length(self) -> float:
        """Edge of the cube over which the points are means, m."""
        return float(self.data.attrs["mean_over"])

    @cached_property
    def extension(self) -> Array:
        """Largest extension, whatever opens."""
        return self.quantity.values(self.data)

    @cached_property
    def value(self) -> Array:
        """What is read: the extension, and nothing where no crack can open."""
        return cut(self.extension, self.quantity.opens(self.data))

    @cached_property
    def crack(self) -> tuple[Array, Array]:
        """Angle of the trace and dip, rad; NaN where no crack opens."""
        return self.crack_at(slice(None))

    def crack_at(self, rows: slice) -> tuple[Array, Array]:
        """The same at some of the depths."""
        data = self.data.isel(depth=rows)
        normal, value = self.quantity.crack(data), self.value[rows]
        if normal is None:
            normal = np.full((*value.shape, 3), np.nan)
        angle, dip = crack_plane(normal)
        return np.where(value > 0, angle, np.nan), np.where(value > 0, dip, np.nan)

    @property
    def largest(self) -> dict[str, float]:
        """The largest principal strain in space and in the horizontal plane."""
        if all(name in self.data for name in _PRINCIPAL):
            return {name: float(self.data[name].max()) for name in _PRINCIPAL}
        strain = np.stack([part(self.data, name) for name in STRAIN])
        values = tensors.largest_principal(strain), tensors.in_plane_principal(strain)[0]
        return {name: float(value.max()) for name, value in zip(_PRINCIPAL, values, strict=True)}

    @property
    def most(self) -> float:
        """The largest reading."""
        return float(self.value[self.worst])

    @cached_property
    def worst(self) -> tuple[int, int, int]:
        """Index of the largest reading, see `index_of_largest`."""
        row, j, i = index_of_largest(self.value)
        return row, j, i


def check_law(line: PowerLaw) -> None:
    """Raise InputError for a law that reads no extension."""
    if not line.reads.extends:
        raise InputError(
            f"an assessment evaluates a tensile strain, but {line} is for the {line.reads}; take a law "
            "for a tensile strain"
        )


def local_field(response: Source, line: PowerLaw, depth: float) -> xr.Dataset:
    """The points of a response at one of its depths, m, over (depth, y, x). Raises InputError."""
    data = gridded(response)
    nearest = number_of_depth(data, depth)
    _check_place(data, line, float(data["depth"][nearest]))
    return data.isel(depth=[nearest])


def mean_field(
    response: Source, line: PowerLaw, length: float, solved: Source
) -> tuple[xr.Dataset, list[str], Means | None]:
    """Means over a length, m, at the depths of a response that the law applies to; and sentences about the others.

    solved: the response itself, or that which `under_both` put under more loads. A response that is a mean is taken
    as it is. Returns as well the means anywhere else, None where the road cannot be solved again. Raises InputError
    for a response of points without its road.
    """
    data = gridded(response)
    if line.reads.where.at_bottom:
        raise InputError(
            f"{line} reads the {line.reads}; give depth= of that bottom, an interface of the road, solved from above"
        )
    if "mean_over" in data.attrs:
        depths, caveats = _depths_of(data, line)
        means = None
        if isinstance(response, Response) and response.road is not None:
            means = Means.of(response, float(data.attrs["mean_over"]))
        return data.isel(depth=np.flatnonzero(np.isin(data["depth"], depths)).tolist()), caveats, means
    if not isinstance(response, Response) or response.road is None:
        raise InputError(
            "a mean over the road needs a response of solve_response, whose road can be solved again; give depth= "
            "to read the points of this one as they are"
        )
    depths, caveats = _depths_of(data, line)
    means = Means.of(response, length)
    if set(line.reads.needs) <= _TENSORS and not response.restrained and isinstance(solved, Response):
        return means.at_points_of(solved, depths), caveats, means
    return read_means(means, line.reads, depths, x=data["x"].to_numpy(), y=data["y"].to_numpy()), caveats, means


def under_both(response: Source, shifted: Sequence[PlacedLoad], depth: float | None) -> Response:
    """A response whose question is put under the mean of its own loads and of shifted ones, see `assess`."""
    if depth is not None:
        raise InputError("points at a depth belong to the cells of one contact; leave depth or shifted out")
    if not isinstance(response, Response) or "mean_over" in response.dataset.attrs:
        raise InputError("a shifted contact is read with a response of solve_response at points, whose road it loads")
    if len(shifted) != len(response.loads):
        raise InputError(
            f"the response has {len(response.loads)} load(s), but {len(shifted)} shifted one(s); give one for each"
        )
    return replace(response, loads=tuple(mean_loads([response.loads, shifted])))


def read_means(
    means: Means, quantity: Quantity, depths: Array, *, x: Array, y: Array, rough: bool = False
) -> xr.Dataset:
    """Means at depths, over (depth, y, x), with the thermal stress that was added to the response."""
    response = means.response
    if set(quantity.needs) <= _TENSORS:
        data = means.at(depths, x, y, rough=rough)
    else:
        data = solve_response(
            response.loads, means.road, depths=depths, x=x, y=y, speed=response.speed, side=response.side,
            mean_over=means.length,
        ).dataset  # fmt: skip
    if not response.restrained:
        return data
    levels = np.asarray(response.dataset["depth"].to_numpy())
    stress = [response.restrained[int(np.argmin(np.abs(levels - depth)))] for depth in depths]
    return with_horizontal_stress(data, np.array(stress))


def _depths_of(data: xr.Dataset, line: PowerLaw) -> tuple[Array, list[str]]:
    """Depths that a law applies to: the surface, or the top layer."""
    depths = data["depth"].to_numpy()
    if line.reads.where.at_surface:
        surface = same_depth(depths, 0.0)
        if not surface.any():
            raise InputError(f"{line} reads the {line.reads}; solve the response with depth 0")
        return depths[surface], []
    inner = data["layer"].to_numpy() == 0
    if not inner.any():
        raise InputError(
            "no depth of the response lies in the top layer, to which the law applies; give depth= to read "
            "another layer with its own law"
        )
    if inner.all():
        return depths, []
    left = ", ".join(f"{1e3 * z:g}" for z in depths[~inner])
    return depths[inner], [
        f"the depths {left} mm lie below the top layer, to which the law applies, and are not evaluated; give depth= "
        "for one of them and the law of its layer"
    ]


def _check_place(data: xr.Dataset, line: PowerLaw, depth: float) -> None:
    """Refuse a law at a depth that it does not apply to."""
    if line.reads.where.at_surface and not same_depth(depth, 0.0):
        raise InputError(f"{line} reads the {line.reads}, got depth {depth:g} m; give depth 0")
    if not line.reads.where.at_bottom or "layer" not in data.coords:
        return
    interfaces = np.atleast_1d(data.attrs.get("interfaces", []))
    side = data.attrs.get("side", "above")
    if side != "above" or not on_interface([depth], interfaces)[0]:
        listed = ", ".join(f"{z:g}" for z in interfaces) or "no interface"
        raise InputError(
            f"{line} reads the {line.reads}, got depth {depth:g} m from {side}; the road has {listed} m: give the "
            "depth of the asphalt's bottom, and solve it from above"
        )
