"""Quantities as fields of one response, where they peak, and the tension behind a wheel."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence

import numpy as np

from treadload import variables
from treadload.composing import Source
from treadload.damage.cracks import gridded
from treadload.damage.quantity import ANYWHERE, STRESS, Quantity, part
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.largest import index_of_largest
from treadload.registry import QUANTITIES


def known_quantities() -> dict[str, Quantity]:
    """Quantities by their names that a response gives anywhere in the road, without anything else being given.

    Ours, and what this session registered; those of other packages are looked up by name.

    >>> "mazars_strain" in tl.damage.known_quantities()
    True
    """
    makers = (QUANTITIES.find(name).target for name in QUANTITIES.built_in())
    instances = [make() for make in makers if not _needs_more(make)]
    return {quantity.name: quantity for quantity in instances if quantity.where == ANYWHERE and not quantity.lacks}


def compute_quantities(response: Source, quantities: Sequence[str | Quantity] | None = None) -> xr.Dataset:
    """Quantities as fields.

    response: with stress and strain over (depth, y, x). quantities: names, or quantities with
    their details, `MazarsOnset(80e-6)`; left out, all of `known_quantities` whose fields the response has.
    Returns a dataset of one variable each over (depth, y, x): strains, Pa, J/m³; "dissipated_energy" over (depth, y)
    is that of one passage and belongs to responses of moving wheels on viscoelastic roads.
    Raises InputError for an unknown name, and for a quantity whose fields the response lacks.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> at = [-0.05, 0.0, 0.05]
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=at, y=at)
    >>> fields = tl.damage.compute_quantities(response)
    >>> f"{float(fields.in_plane_extension.max()) * 1e6:.0f} microstrain"
    '269 microstrain'
    """
    data = gridded(response)
    if quantities is None:
        chosen = [quantity for quantity in known_quantities().values() if not quantity.missing(data)]
    else:
        chosen = [_named(quantity) if isinstance(quantity, str) else quantity for quantity in quantities]
    return xr.Dataset({quantity.name: quantity.field(data) for quantity in chosen})


def _named(name: str) -> Quantity:
    make = QUANTITIES.find(name).target
    if _needs_more(make):
        raise InputError(f"the quantity {name!r} needs more than its name; give it as an object, with its numbers")
    quantity: Quantity = make()
    return quantity


def _needs_more(make: Callable[..., Quantity]) -> bool:
    return any(parameter.default is parameter.empty for parameter in inspect.signature(make).parameters.values())


def peak(fields: xr.Dataset, name: str, *, deepest: float | None = None) -> dict[str, float]:
    """Largest value of a quantity and its place: {"value": ..., "depth": ..., "y": ..., "x": ...}, m.

    deepest: m; depths below it do not count: 0.05 for the shear strain at the edge of a tire.
    Raises InputError where the quantity or all of its depths are missing.

    >>> road = tl.Pavement.half_space(tl.Elastic(1e9, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.1, 8e5), road, depths=[0.02, 0.05], x=[0.0, 0.1], y=[0.0])
    >>> place = tl.damage.peak(tl.damage.compute_quantities(response), "vertical_shear_strain")
    >>> f"{place['value'] * 1e6:.0f} microstrain below the edge of the load, {place['depth'] * 1e3:.0f} mm deep"
    '658 microstrain below the edge of the load, 20 mm deep'
    """
    if name not in fields:
        raise InputError(f"the fields hold {', '.join(map(str, fields.data_vars))}, got {name!r}")
    values = fields[name]
    if deepest is not None:
        values = values.where(values["depth"] <= deepest, drop=True)
    if not values.size or bool(values.isnull().all()):
        raise InputError(f"{name} has no value at depths up to {deepest} m; solve the response there")
    at = index_of_largest(values.to_numpy(), horizontal=len({"x", "y"} & set(values.dims)))
    place = {str(dim): float(values[dim][int(number)]) for dim, number in zip(values.dims, at, strict=True)}
    return {"value": float(values.to_numpy()[at]), **place}


def tension_behind(response: Source) -> xr.Dataset:
    """Largest horizontal tension of the surface behind the load, over y: what opens cracks behind a rolling wheel.

    Behind are the points of a row that come after the last one under pressure, which is read from
    stress_zz = -pressure at the surface; rows that the load misses count behind the load's rear as a whole.
    response: with depth 0, and x that reach behind the load. Returns tension_behind, Pa, and tension_behind_x, m.
    An elastic road shows some too; what viscoelasticity adds is the difference to the road's elastic limits.
    Raises InputError without the surface, a load on it, or points behind it.
    Source: the mechanism is Tamagny's, as cited by the paper of this method; the definition is this package's.

    >>> road = tl.Pavement.half_space(tl.Elastic(1e9, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.1, 8e5), road, depths=[0.0], x=[-0.15, 0.0, 0.15], y=[0.0])
    >>> behind = tl.damage.tension_behind(response)
    >>> f"{behind.tension_behind.item() / 1e3:.0f} kPa at x = {behind.tension_behind_x.item():.2f} m"
    '53 kPa at x = -0.15 m'
    """
    data = gridded(response)
    if not (data["depth"] == 0).any():
        raise InputError("the tension behind the load is one of the surface; solve the response with depth 0")
    surface = data.sel(depth=[0.0])
    stress = np.stack([part(surface, name) for name in STRESS])[:, 0]
    x = data["x"].to_numpy()
    order = np.argsort(x)
    stress, x = stress[..., order], x[order]
    # Round-off of a free surface beside the pressure.
    loaded = stress[2] < -1e-6 * np.abs(stress[2]).max()
    if not loaded.any():
        raise InputError("no pressure acts on the surface of this response; take x and y that meet the load")
    rear = np.where(loaded.any(axis=1), np.argmax(loaded, axis=1), np.argmax(loaded.any(axis=0)))
    if not rear.all():
        raise InputError(f"the load reaches the first x of the response, {x[0]:g} m; let x reach behind it")
    tension = tensors.in_plane_principal(stress)[0]
    tension = np.where(np.arange(len(x)) < rear[:, None], tension, -np.inf)
    at = tension.argmax(axis=1)
    fields = {
        "tension_behind": (("y",), np.take_along_axis(tension, at[:, None], axis=1)[:, 0]),
        "tension_behind_x": (("y",), x[at]),
    }
    return variables.dataset(fields, {"y": data["y"].to_numpy()})
