"""Which way a crack runs: its plane, the worst instant of a passage, and the rose of the traces."""

from __future__ import annotations

import json
import math
from typing import Literal

import numpy as np

from treadload import variables
from treadload.composing import Source, dataset_of
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.quantities import Extension
from treadload.damage.quantity import Reading
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array

# Values of `crack_orientation`.
ORIENTATIONS = ("none", "longitudinal", "transverse", "oblique", "horizontal")
NONE, LONGITUDINAL, TRANSVERSE, OBLIQUE, HORIZONTAL = range(5)
OBLIQUE_TOLERANCE = math.radians(15)
# A plane nearer to the horizontal than this has no trace to speak of.
_FLAT = math.radians(45)


def opens_down(orientation: str) -> bool:
    """True for an orientation of a crack that runs down from where it begins; not for "none" and "horizontal"."""
    return orientation not in (ORIENTATIONS[NONE], ORIENTATIONS[HORIZONTAL])


def in_a_cell(orientation: str) -> str:
    """An orientation for a table of first cracks: what a plane nearer to the horizontal than 45° does is no crack."""
    if orientation == ORIENTATIONS[NONE]:
        return "none: nothing is tensile"
    return orientation if opens_down(orientation) else "none runs down: it splits parallel to the surface"


def nothing_opens(unread: float) -> str:
    """Why nothing cracks, in a sentence. unread: the largest extension, whatever opens."""
    if unread <= 0:
        return "no tensile strain here; this criterion predicts no cracking."
    return (
        f"the tensile strain reaches {unread * 1e6:.3g} microstrain, but only where no principal stress is tensile; "
        "this criterion predicts no cracking."
    )


def gridded(response: Source) -> xr.Dataset:
    """A response's dataset; InputError for one at a list of points."""
    data = dataset_of(response)
    if "point" in data.dims:
        raise InputError(
            f"this needs a grid, the response is at {data.sizes['point']} points; call solve_response with x and y"
        )
    return data


def crack_plane(direction: Array) -> tuple[Array, Array]:
    """Angle of the trace and dip of the plane perpendicular to a unit vector (..., 3).

    Returns the angle of the trace from travel towards the right, rad, in (-π/2, π/2], and the dip from the
    horizontal, rad, in [0, π/2]. A vertical direction has dip 0 and no trace: its angle is NaN.
    """
    x, y, z = direction[..., 0], direction[..., 1], direction[..., 2]
    flat = np.hypot(x, y)
    # The trace lies along (-y, x); a line has no sense, so the half turn that points backwards is folded.
    angle = np.arctan2(x, -y)
    angle = np.where(angle > np.pi / 2, angle - np.pi, np.where(angle <= -np.pi / 2, angle + np.pi, angle))
    return np.where(flat > 0, angle, np.nan), np.arctan2(flat, np.abs(z))


def orientation(angle: Array, dip: Array, tolerance: float) -> Array:
    """Codes of `ORIENTATIONS` (...) from the angle of the trace and the dip (...), rad; none where dip is NaN.

    A plane nearer to the horizontal than to the vertical is horizontal: it splits the road, no crack runs down from
    it. tolerance: of the trace, rad, see `assess`.
    """
    steep = np.abs(angle)
    code = np.full(np.shape(dip), OBLIQUE, dtype=np.int8)
    code = np.where(steep <= tolerance, LONGITUDINAL, code)
    code = np.where(steep >= math.pi / 2 - tolerance, TRANSVERSE, code)
    code = np.where(dip < _FLAT, HORIZONTAL, code)
    codes: Array = np.where(np.isnan(dip), NONE, code).astype(np.int8)
    return codes


def envelope(
    response: Source, *, strain: Reading = "in-plane", oblique_tolerance: float = OBLIQUE_TOLERANCE
) -> xr.Dataset:
    """The largest extension that every point of the road sees while the wheel rolls by, and its crack.

    In steady rolling a fixed point of the road runs through the field from the front to the back, so that the
    field along x is its history; each (depth, y) has one history, the same for all points along the road.
    A crack opens at the instant of the largest extension, across its direction at that instant.

    response: on x that reach from before the wheel to behind it. strain, oblique_tolerance: see `assess`. Returns a
    dataset over (depth, y): extension_strain; instant_x, where the point stands in the response's x at its worst
    instant; extension_direction (component); crack_angle, crack_dip, crack_orientation, NaN and "none" where there is
    never an extension, or no principal stress is tensile when it is largest. The instant is one of the response's x:
    the strain errs by the square of their distance. Its attribute `warnings` states where the worst instant is the
    first or the last x. Raises InputError for a response of a single x.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> x = [-0.4, -0.2, 0.0, 0.2, 0.4]
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=x, y=[0.0, 0.2, 0.4])
    >>> passage = tl.damage.envelope(response)
    >>> [f"{strain * 1e6:.0f} microstrain" for strain in passage.extension_strain.values.ravel()]
    ['269 microstrain', '194 microstrain', '104 microstrain']
    """
    check_tolerance(oblique_tolerance)
    data = gridded(response)
    if data.sizes["x"] < 3:
        raise InputError(
            f"the passage of a wheel needs the response along x, got {data.sizes['x']} position(s); "
            "solve it with x from before the wheel to behind it"
        )
    quantity = Extension(strain)
    strains, directions = quantity.values(data), quantity.crack(data)
    assert directions is not None
    instant = np.argmax(np.where(np.isnan(strains), -np.inf, strains), axis=-1)
    worst = np.take_along_axis(strains, instant[..., None], axis=-1)[..., 0]
    direction = np.take_along_axis(directions, instant[..., None, None], axis=-2)[..., 0, :]
    opens = (worst > 0) & np.take_along_axis(quantity.opens(data), instant[..., None], axis=-1)[..., 0]
    angle, dip = (np.where(opens, part, np.nan) for part in crack_plane(direction))
    cut = opens & ((instant == 0) | (instant == data.sizes["x"] - 1))
    dims = ("depth", "y")
    fields: dict[str, tuple[tuple[str, ...], Array]] = {
        "extension_strain": (dims, worst),
        "instant_x": (dims, data["x"].to_numpy()[instant]),
        "extension_direction": ((*dims, "component"), direction),
        "crack_angle": (dims, angle),
        "crack_dip": (dims, dip),
        "crack_orientation": (dims, orientation(angle, dip, oblique_tolerance)),
    }
    warnings = [
        f"{cut.sum()} of {cut.size} points have their largest tensile strain at the first or last x of the "
        "response: the passage is cut short; solve it further out"
    ]
    return variables.dataset(
        fields,
        {"depth": data["depth"].to_numpy(), "y": data["y"].to_numpy(), "component": ["x", "y", "z"]},
        strain=strain,
        oblique_tolerance=oblique_tolerance,
        warnings=json.dumps(warnings if cut.any() else [], ensure_ascii=False),
    )


def crack_rose(
    cracks: Source,
    *,
    weight: Literal["area", "damage"] = "area",
    law: FatigueLaw | None = None,
    threshold: float = 0.0,
    classes: int = 12,
    oblique_tolerance: float = OBLIQUE_TOLERANCE,
) -> xr.Dataset:
    """How the cracks run: share of each class of trace angles and of each orientation.

    cracks: extension_strain, crack_angle and crack_dip over y, or y and x, at one depth, as `envelope(...)` gives
    them at one depth, or a Verdict. weight: "area" counts the road (its width, for an
    envelope) that extends beyond the threshold, "damage" that road times the damage 1/N of a pass after `law`.
    threshold: strain, ≥ 0. classes: even number of classes of the trace angle; 0 and π/2 are the middle of one,
    so that longitudinal and transverse traces fall into one class each. oblique_tolerance: see `assess`.
    Returns orientation_share over orientation, which adds up to 1, and trace_share over trace_angle, rad, in
    (-π/2, π/2], which adds up to 1 less the horizontal cracks: they have no trace to speak of. All shares are 0
    where there is no extension; the attribute `weight_total` is the area in m² (the width in m), or the damage on it.
    Raises InputError.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> x = [-0.4, -0.2, 0.0, 0.2, 0.4]
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=x, y=[-0.1, 0.0, 0.1])
    >>> rose = tl.damage.crack_rose(tl.damage.envelope(response).isel(depth=0))
    >>> f"{float(rose.orientation_share.sel(orientation='transverse')):.0%} of the width cracks across travel"
    '100% of the width cracks across travel'
    """
    check_tolerance(oblique_tolerance)
    cracks = dataset_of(cracks)
    if not set(cracks["crack_dip"].dims) <= {"y", "x"}:
        dims = ", ".join(map(str, cracks["crack_dip"].dims))
        raise InputError(
            f"crack_rose needs cracks at one depth, got them over {dims}; select one with .sel(depth=...)"
        )
    if classes < 2 or classes % 2:
        raise InputError(f"classes must be an even number of at least 2, got {classes}")
    if not threshold >= 0:
        raise InputError(f"threshold must be a strain >= 0, got {threshold}")
    strain, angle, dip = (cracks[name].to_numpy() for name in ("extension_strain", "crack_angle", "crack_dip"))
    codes = orientation(angle, dip, oblique_tolerance)
    counts = np.where((strain > threshold) & (codes != NONE), _areas(cracks["crack_dip"]), 0.0)
    if weight == "damage":
        if law is None:
            raise InputError('weight="damage" needs a law that gives the passes; give law=')
        counts = counts / np.where(counts > 0, law.allowable_passes(strain), 1.0)
    elif weight != "area":
        raise InputError(f'weight must be "area" or "damage", got {weight!r}')

    total = float(counts.sum())
    shares = counts / total if total > 0 else counts
    width = math.pi / classes
    traced = (codes != NONE) & (codes != HORIZONTAL)
    # Class k holds angles around k width; -π/2 is the line of π/2.
    number = np.rint(angle[traced] / width).astype(int) % classes
    trace = np.bincount(number, weights=shares[traced], minlength=classes)
    middle = width * np.arange(classes)
    middle = np.where(middle > math.pi / 2 + 1e-9, middle - math.pi, middle)
    order = np.argsort(middle)
    named = [shares[codes == code].sum() for code in range(1, len(ORIENTATIONS))]
    return variables.dataset(
        {"trace_share": (("trace_angle",), trace[order]), "orientation_share": (("orientation",), named)},
        {"trace_angle": middle[order], "orientation": list(ORIENTATIONS[1:])},
        weight=weight,
        weight_total=total,
        threshold=threshold,
        oblique_tolerance=oblique_tolerance,
        **({"law": str(law)} if law is not None else {}),
    )


def check_tolerance(oblique_tolerance: float) -> None:
    """Raise InputError unless the tolerance leaves room for oblique cracks."""
    if not 0 < oblique_tolerance <= math.pi / 4:
        raise InputError(f"oblique_tolerance must lie in (0, π/4] rad, got {oblique_tolerance}")


def _areas(field: xr.DataArray) -> Array:
    """Length, width or area of road that each point of a field stands for, m or m²."""
    sizes = np.ones(field.shape)
    for axis, dim in enumerate(field.dims):
        at = field[dim].to_numpy()
        if len(at) > 1:
            shape = [1] * field.ndim
            shape[axis] = -1
            sizes = sizes * np.abs(np.gradient(at)).reshape(shape)
    return sizes
