"""Stress in a road besides that of the wheel on it: left by earlier wheels, and thermal."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, overload

import numpy as np
import scipy
from numpy.typing import ArrayLike

from treadload import variables
from treadload.composing import Source
from treadload.damage.cracks import gridded
from treadload.damage.quantity import STRESS, part
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.kernels.thermal import reduced_steps, restrained_stress
from treadload.materials import Prony
from treadload.materials.temperature import ShiftLaw
from treadload.response import Response

_DIMS = ("depth", "y", "x")


def residual_after(response: Source, *, spacing: float, passes: int) -> xr.Dataset:
    """Stress that earlier wheels have left when the next one comes, on a road of linear viscoelastic layers.

    Wheels follow each other at one speed and spacing. Superposition holds: the wheel n places ahead leaves at x what
    the steady field of one wheel holds at x - n·spacing, so that N passes leave Σₙ σ(x - n·spacing), n = 1 … N.
    What stays is not permanent. Tractions are given, and where all of a road relaxes alike, stress follows
    them without memory; only layers that relax unlike keep some, and as solids they let it fade. Part of the sum is
    what the wheels ahead still press through the road: at a spacing long against the load it is small.

    response: of a wheel in steady motion, with x that reach passes·spacing behind the places of interest.
    spacing: m, > 0, speed times headway. passes: N ≥ 1. Values between the response's x are splined: O(dx⁴).
    Returns over (depth, y, x), on the x that have all their tails: residual_stress_xx …, residual_tension, the
    largest in the horizontal plane, and total_tension with the wheel's own. Its attribute `last_pass` is the largest
    stress of the earliest pass over that of the sum: where it is not small, more passes would leave more.
    Raises InputError where the response does not reach far enough.
    Source: the mechanism is Wang's, as cited by the paper of this method; the definition is this package's.

    >>> mix = tl.materials.Prony(20e9, ((0.6, 0.1), (0.39, 10.0)), 0.35)
    >>> road = tl.Pavement([tl.Layer(mix, 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x = tl.UniformDisc(0.15, 7e5), [-2.0, -1.0, 0.0, 1.0]
    >>> response = tl.solve_response(plate, road, depths=[0.14], x=x, y=[0.0], speed=20.0)
    >>> left = tl.damage.residual_after(response, spacing=2.0, passes=1)
    >>> same = response.dataset.stress_yy.sel(x=-2.0).item()  # what the wheel ahead has left 2 m behind it
    >>> abs(left.residual_stress_yy.sel(x=0.0).item() - same) < 1e-6 * abs(same)
    True
    """
    positive("spacing", spacing, "metres", "it is speed times headway")
    if passes < 1:
        raise InputError(f"passes must be at least 1, got {passes}")
    data = gridded(response).sortby("x")
    x = data["x"].to_numpy()
    reach = passes * spacing
    kept = x - reach >= x[0] - 1e-9 * reach
    if not kept.any() or len(x) < 4:
        raise InputError(
            f"{passes} passes {spacing:g} m apart need a response that reaches {reach:g} m behind the wheel, "
            f"its x span {np.ptp(x):g} m; let x reach further back or take fewer passes"
        )
    stress = np.stack([part(data, name) for name in STRESS])
    tail = scipy.interpolate.CubicSpline(x, stress, axis=-1)
    places = x[kept]
    left = np.zeros((*stress.shape[:-1], len(places)))
    for number in range(1, passes + 1):
        earliest = tail(np.maximum(places - number * spacing, x[0]))
        left += earliest
    largest = float(np.abs(left).max())
    fields = {f"residual_{name}": (_DIMS, component) for name, component in zip(STRESS, left, strict=True)}
    fields["residual_tension"] = (_DIMS, tensors.in_plane_principal(left)[0])
    fields["total_tension"] = (_DIMS, tensors.in_plane_principal(left + stress[..., kept])[0])
    return variables.dataset(
        fields,
        {"depth": data["depth"].to_numpy(), "y": data["y"].to_numpy(), "x": places},
        spacing=spacing,
        passes=passes,
        last_pass=float(np.abs(earliest).max()) / largest if largest > 0 else 0.0,
    )


def thermal_stress(
    material: Prony,
    shift: ShiftLaw,
    time: ArrayLike,
    temperature: ArrayLike,
    *,
    expansion: float,
    restraint: Literal["plane", "line"] = "plane",
) -> Array:
    """Stress of a restrained material that cools, σ(t) = -k α ∫ E(ξ(t) - ξ(t')) dT, tension positive.

    ξ = ∫ dt / aT is the reduced time. material: its relaxation at the shift's reference temperature; `as_prony` makes
    a series of other models. shift: WLF or another law of time and temperature. time: (nt,), s, increasing; the
    material is free of stress at the first. temperature: °C, (nt,), or (nt, n) of n depths. expansion: α, 1/K, of
    length; mixes are near 2.5e-5. restraint: "plane" holds both horizontal directions, as a wide road is held,
    k = 1/(1 - ν); "line" one of them, k = 1.
    Temperature is linear in time between the given instants. Returns (nt, ...), Pa.
    Method: each term of the series is carried on exactly for strain that is linear in reduced time over a step
    (Taylor, Pister & Goudreau, 1970, Int. J. Numer. Meth. Eng. 2): exact where aT is constant, else O(step²).
    Raises InputError.

    >>> mix, shift = tl.materials.Prony(20e9, ((0.6, 10.0), (0.39, 1e4)), 0.35), tl.materials.WLF(19.0, 150.0, 15.0)
    >>> time, cooling = [0.0, 4 * 3600.0, 8 * 3600.0, 12 * 3600.0], [5.0, 0.0, -5.0, -10.0]
    >>> stress = tl.damage.thermal_stress(mix, shift, time, cooling, expansion=2.5e-5)
    >>> [f"{tension / 1e6:.1f} MPa" for tension in stress]
    ['0.0 MPa', '1.6 MPa', '3.5 MPa', '6.4 MPa']
    """
    if not isinstance(material, Prony):
        raise InputError(
            f"thermal stress needs a Prony series, got {type(material).__name__}; make one with as_prony"
        )
    at, warmth = np.asarray(time, dtype=float), np.asarray(temperature, dtype=float)
    if at.ndim != 1 or len(at) < 2 or not np.isfinite(at).all() or not (np.diff(at) > 0).all():
        raise InputError(f"time must be at least two increasing numbers of s, got {time!r}")
    if warmth.shape[:1] != at.shape or not np.isfinite(warmth).all():
        raise InputError(
            f"temperature must have a finite number of °C for each of {len(at)} times, got shape {warmth.shape}"
        )
    if not (np.isfinite(expansion) and 0 <= expansion < 1e-2):
        raise InputError(f"expansion must be a number of 1/K in [0, 0.01), got {expansion}; mixes are near 2.5e-5")
    if restraint not in ("plane", "line"):
        raise InputError(f'restraint must be "plane" or "line", got {restraint!r}')
    moduli = np.array([material.modulus * share for share, _ in material.terms])
    times = np.array([tau for _, tau in material.terms])
    steps = reduced_steps(at, warmth, shift.factor)
    stress = restrained_stress(-expansion * np.diff(warmth, axis=0), steps, moduli, times, material.long_term_modulus)
    return stress / (1 - material.poisson) if restraint == "plane" else stress


@overload
def add_thermal_stress(response: Response, stress: ArrayLike) -> Response: ...
@overload
def add_thermal_stress(response: xr.Dataset, stress: ArrayLike) -> xr.Dataset: ...
def add_thermal_stress(response: Source, stress: ArrayLike) -> Response | xr.Dataset:
    """A response with a thermal stress added to both horizontal normal stresses.

    response: of `solve_response`, or a dataset like its own. stress: Pa, tension positive, one for all depths or
    (depth,): an instant of `thermal_stress` with restraint "plane". Invariants of the stress follow; the strains
    stay those of the traffic, for a restrained road that cools does not strain. Linear viscoelasticity lets the two
    add up. Returns a Response of a Response, else a dataset. An assessment on it reads tension of both together, also
    where it solves the road again. Raises InputError.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(15e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0], y=[0.0])
    >>> cold = tl.damage.add_thermal_stress(response, 0.5e6)
    >>> [f"{result.dataset.stress_xx.item() / 1e6:.1f} MPa" for result in (response, cold)]
    ['2.6 MPa', '3.1 MPa']
    """
    data = gridded(response)
    stresses = np.asarray(stress, dtype=float)
    if stresses.shape not in ((), (data.sizes["depth"],)) or not np.isfinite(stresses).all():
        raise InputError(
            f"stress must be one finite number of Pa or one for each of {data.sizes['depth']} depths, "
            f"got shape {stresses.shape}"
        )
    each = np.broadcast_to(stresses, data.sizes["depth"])
    added = with_horizontal_stress(data, each)
    if not isinstance(response, Response):
        return added
    before = response.restrained or (0.0,) * len(each)
    together = tuple(float(old + new) for old, new in zip(before, each, strict=True))
    return replace(response, dataset=added, restrained=together)


def with_horizontal_stress(data: xr.Dataset, stress: Array) -> xr.Dataset:
    """Fields over (depth, y, x) with a stress, Pa, (depth,), added to both horizontal normal stresses."""
    total = np.stack([part(data, name) for name in STRESS])
    total[:2] += stress[:, None, None]
    fields = {
        **dict(zip(STRESS, total, strict=True)),
        "von_mises_stress": tensors.von_mises(total),
        "octahedral_shear_stress": tensors.octahedral_shear(total),
        "mean_stress": tensors.mean(total),
    }
    return data.assign({name: (_DIMS, values, variables.attributes(name)) for name, values in fields.items()})
