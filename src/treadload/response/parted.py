"""Response of a road one of whose interfaces has parted: pressed it rubs, pulled it opens.

The road as if the face held comes from where all responses come from; this is what sliding and opening add. The face
is solved on a periodic grid around the loads, wide enough that nothing slides near its rim.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

from treadload.errors import ConvergenceError, InputError
from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.complementarity.parted import FaceStiffness, PartedFace, solve_parted
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.jumps import Jump, jump
from treadload.kernels.layers.layered import Stack
from treadload.kernels.layers.synthesis import READING
from treadload.pavement import Parted, Pavement
from treadload.pavement.stack import stack_of
from treadload.response.half_space import EvaluationGrid, half_space_response
from treadload.response.layered import View, layered_responses
from treadload.response.layout import Site
from treadload.response.loads import SurfaceLoad

# Cells are so many to the depth of the face, and at most so large, m. First they are this much larger, which tells
# how far the face slides, and where to begin.
_PER_DEPTH, _COARSE, _LARGER = 3, 0.02, 2.0
# The grid reaches so many times the length over which the layers bend, and at least so far, m, beyond the loads.
_BENT, _LEAST = 3.0, 0.5
# It is widened by this, so many times, where the face slides or opens within this part of its rim by more than this
# part of the largest jump.
_WIDER, _WIDENED, _RIM, _STILL = 1.5, 4, 0.05, 1e-2
# Error of its traction, as a part of the largest.
_TOLERANCE = 1e-4
# Of what friction bears on all of the grid a net shear force is at most this part: nothing would hold beyond.
_BORNE = 0.8
# Cells of a face, some minutes.
_MOST_CELLS = 2_000_000


@dataclass(frozen=True, eq=False)
class Face:
    """A parted face under loads.

    x, y: cells of its grid, m, evenly spaced. depth: m. state: jump and traction there, see `PartedFace`. stack: the
    road with the face bonded. wide: False if it slides or opens up to the rim of the grid.
    """

    x: Array
    y: Array
    depth: float
    state: PartedFace
    stack: Stack
    wide: bool

    def fields(self, depths: Array, below: bool) -> Array:
        """What the jump adds at depths: stress xx, yy, zz, xy, xz, yz and displacement (nz, 9, ny, nx)."""
        waves = _Waves.of(self.x, self.y)
        x, y, z = fft.rfft2(self.state.jump)
        c, s, k = waves.along, waves.across, waves.k
        plane = 1j * k * (c * x + s * y), k * z
        turned = k * (c * y - s * x)
        sides = [below] * len(depths)
        jumps = waves.jump(self.stack, self.depth, depths, sides)
        result = np.empty((len(depths), 9, len(self.y), len(self.x)))
        for row, depth in enumerate(self.stack.snapped(depths)):
            layer = self.stack.layer_at(float(depth), below)
            u, w, f, g = (
                jumps.plane[row, part, 0] * plane[0] + jumps.plane[row, part, 1] * plane[1] for part in range(4)
            )
            swayed, sheared = jumps.transverse[row, 0] * turned, jumps.transverse[row, 1] * turned
            moved: list[ComplexArray] = _stress(waves, self.stack, layer, (u, f, g, swayed, sheared))
            with np.errstate(divide="ignore", invalid="ignore"):
                ahead, across = -1j * u / k, swayed / k
                moved += [c * ahead - s * across, s * ahead + c * across, w / k]
            for part, wave in enumerate(moved):
                wave[0, 0] = 0.0
                # A jump that is the same everywhere moves what lies above the face.
                above = depth < self.depth or (depth == self.depth and not below)
                if part >= 6 and above:
                    wave[0, 0] = (x, y, z)[part - 6][0, 0]
                result[row, part] = fft.irfft2(wave, s=result.shape[2:])
        return result


def parted_fields(
    loads: Sequence[SurfaceLoad],
    road: Pavement,
    depths: Array,
    x: Array,
    y: Array,
    *,
    below: bool,
    at: Points | None = None,
) -> tuple[Array, Array, Array, tuple[str, ...]]:
    """What the sliding and opening of a parted face adds to the response of the road as if it held.

    Arguments as in `layered_response`. Returns stress (6, nz, my, mx), Pa, strain likewise, displacement
    (3, nz, my, mx), m, and sentences for the user. Raises InputError for layers that are not elastic, and
    ConvergenceError.
    """
    face = solve_face(tuple(loads), road)
    added = face.fields(depths, below)
    here = np.zeros((9, len(depths), *((len(y), len(x)) if at is None else at.shape)))
    inside_x = (x >= face.x[0]) & (x <= face.x[-1])
    inside_y = (y >= face.y[0]) & (y <= face.y[-1])
    for row in range(len(depths)):
        for part in range(9):
            curve = scipy.interpolate.RectBivariateSpline(face.y, face.x, added[row, part])
            if at is None:
                here[part, row] = np.where(inside_y[:, None] & inside_x, curve(y, x, grid=True), 0.0)
            else:
                within = inside_y[at.rows] & inside_x[at.columns]
                here[part, row] = np.where(within, curve(y[at.rows], x[at.columns], grid=False), 0.0)
    stress = here[:6]
    strain = np.empty_like(stress)
    layers = road.distinct_layers
    for row, depth in enumerate(face.stack.snapped(depths)):
        strain[:, row] = layers[face.stack.layer_at(float(depth), below)].elastic.strain(stress[:, row])
    return stress, strain, here[6:], _cautions(face, road)


@lru_cache(maxsize=8)
def solve_face(loads: tuple[SurfaceLoad, ...], road: Pavement) -> Face:
    """The parted face of a road under superposed loads, jump and traction.

    Raises InputError for a road without such a face or with layers that are not elastic, ConvergenceError.
    """
    number = road.parted
    if number is None:
        raise InputError("no interface of this road is parted with friction; give a layer bond=Parted(...)")
    bond = road.layers[number].bond
    assert isinstance(bond, Parted)
    depth = float(road.interfaces[number])
    stack = stack_of(road, sticking=True)
    stiffest, softest = max(stack.moduli), min(stack.moduli)
    bent = float(stack.interfaces[-1]) * (stiffest / softest) ** (1 / 3)
    beyond, step = max(_LEAST, _BENT * bent), min(depth / _PER_DEPTH, _COARSE)

    def solve(cell: float, start: tuple[Array, Array, PartedFace] | None) -> tuple[Array, Array, PartedFace]:
        x, y = (_cells(loads, axis, beyond, cell) for axis in "xy")
        if len(x) * len(y) > _MOST_CELLS:
            raise InputError(
                f"the face at {depth:g} m slides over {np.ptp(x):.3g} by {np.ptp(y):.3g} m, {len(x)} x {len(y)} "
                f"cells, more than {_MOST_CELLS:g}; take friction on a deeper face, or a FRICTIONLESS one"
            )
        traction = _closed_traction(loads, road.sticking, depth, x, y)
        traction[2] += bond.unit_weight * depth
        shear, bound = np.linalg.norm(traction[:2].sum(axis=(1, 2))), bond.friction * float(traction[2].sum())
        if shear > _BORNE * bound and bound > 0:
            raise InputError(
                f"the load's shear force is {shear / bound:.3g} times what friction of {bond.friction:g} carries on "
                f"the face at {depth:g} m: the layers above slide off as a whole; take more friction, or a "
                "FRICTIONLESS face"
            )
        begin = None if start is None else _onto(x, y, start)
        state = solve_parted(
            traction, _Waves.of(x, y).stiffness(stack, depth), bond.friction, tolerance=_TOLERANCE, start=begin
        )
        if state.residual > _TOLERANCE:
            raise ConvergenceError(
                f"the parted face at {depth:g} m did not converge in {state.iterations} steps: its traction is off "
                f"by {state.residual:.1g} of the largest, more than {_TOLERANCE:g}; take less friction than "
                f"{bond.friction:g}"
            )
        return x, y, state

    for _ in range(_WIDENED + 1):
        rough = solve(_LARGER * step, None)
        if _still(rough[2]):
            break
        beyond *= _WIDER
    x, y, state = solve(step, rough)
    return Face(x, y, depth, state, stack, _still(state))


def _onto(x: Array, y: Array, face: tuple[Array, Array, PartedFace]) -> tuple[Array, Array]:
    """Jump and traction of a face on other cells."""
    face_x, face_y, state = face
    jump, traction = (
        np.stack([scipy.interpolate.RectBivariateSpline(face_y, face_x, sheet, kx=1, ky=1)(y, x) for sheet in field])
        for field in (state.jump, state.traction)
    )
    return jump, traction


def _closed_traction(loads: Sequence[SurfaceLoad], road: Pavement, depth: float, x: Array, y: Array) -> Array:
    """Traction (3, ny, nx) of the face as if it held, x, y and pressure, Pa."""
    if road.is_homogeneous:
        stress = half_space_response(loads, road.surface_material, EvaluationGrid(np.array([depth]), x, y))[0]
    else:
        view = View(x, y, components=(2, 4, 5), accuracy=READING)
        site = Site(road, np.array([depth]))
        stress = next(layered_responses([loads], [site], [(0, 0)], view, below=False))[0]
    traction: Array = -stress[[4, 5, 2], 0]
    return traction


def _cells(loads: Sequence[SurfaceLoad], axis: str, beyond: float, step: float) -> Array:
    """Centres of cells along an axis, m."""
    extents = [load.extent_x if axis == "x" else load.extent_y for load in loads]
    low, high = min(low for low, _ in extents) - beyond, max(high for _, high in extents) + beyond
    count = fft.next_fast_len(math.ceil((high - low) / step), real=True)
    cells: Array = 0.5 * (low + high) + step * (np.arange(count) - 0.5 * (count - 1))
    return cells


def _still(state: PartedFace) -> bool:
    """Whether nothing slides or opens near the rim."""
    size = np.sqrt((state.jump**2).sum(axis=0))
    rim = np.ones(size.shape, dtype=bool)
    ny, nx = (max(1, int(_RIM * count)) for count in size.shape)
    rim[ny:-ny, nx:-nx] = False
    return bool(size[rim].max() <= _STILL * size.max(initial=0.0))


@dataclass(frozen=True, eq=False)
class _Waves:
    """Wavenumbers of a grid (ny, nx // 2 + 1), 1/m: their size and the cosine and sine of their direction."""

    k: Array
    along: Array
    across: Array

    @classmethod
    def of(cls, x: Array, y: Array) -> _Waves:
        kx = 2 * math.pi * fft.rfftfreq(len(x), x[1] - x[0])
        ky = 2 * math.pi * fft.fftfreq(len(y), y[1] - y[0])[:, None]
        k = np.hypot(kx, ky)
        with np.errstate(invalid="ignore"):
            along, across = kx / k, ky / k
        along[0, 0] = across[0, 0] = 0.0
        return cls(k, along, across)

    def jump(self, stack: Stack, face: float, depths: Sequence[float] | Array, below: Sequence[bool]) -> Jump:
        """Of unit jumps at all wavenumbers but 0, where all is 0: (..., ny, nkx)."""
        unique, back = np.unique(np.round(self.k.ravel()[1:], 9), return_inverse=True)
        jumps = jump(unique, stack, face, [float(z) for z in depths], below)

        def spread(values: Array) -> Array:
            every: Array = np.zeros((*values.shape[:-1], self.k.size))
            every[..., 1:] = values[..., back]
            return every.reshape(*values.shape[:-1], *self.k.shape)

        return Jump(
            *(
                spread(spectrum)
                for spectrum in (jumps.plane, jumps.transverse, jumps.stiffness, jumps.stiffness_transverse)
            )
        )

    def stiffness(self, stack: Stack, face: float) -> FaceStiffness:
        """Of the face."""
        jumps = self.jump(stack, face, [], [])
        (kk, kz), (_, zz) = self.k * jumps.stiffness
        return FaceStiffness(self.along, self.across, kk, zz, kz, self.k * jumps.stiffness_transverse)


def _stress(waves: _Waves, stack: Stack, layer: int, moved: tuple[ComplexArray, ...]) -> list[ComplexArray]:
    """Stress xx, yy, zz, xy, xz, yz from k·i u_k, i f_k, f_z, k·u_t and f_t."""
    u, f, g, swayed, sheared = moved
    c, s = waves.along, waves.across
    double, nu, lift = 2 * stack.shear[layer], stack.poisson[layer], stack.lift_of(layer)
    ahead = double * u / (1 - nu) - lift * g
    beside = double * nu * u / (1 - nu) - lift * g
    turned = 0.5j * double * swayed
    across = 2 * c * s * turned
    return [
        c * c * ahead + s * s * beside - across,
        s * s * ahead + c * c * beside + across,
        -g,
        c * s * (ahead - beside) + (c * c - s * s) * turned,
        1j * c * f + s * sheared,
        1j * s * f - c * sheared,
    ]


def _cautions(face: Face, road: Pavement) -> tuple[str, ...]:
    """Sentences for the user."""
    number = road.parted
    assert number is not None
    name = road.layers[number].name or f"layer {number + 1}"
    warnings = [
        f"the face below {name} is {road.layers[number].bond} and takes this load once, from rest; what wheels "
        "before it left slid is not followed"
    ]
    if not face.wide:
        warnings.append(
            f"the face below {name} slides up to the rim of the {np.ptp(face.x):.3g} by {np.ptp(face.y):.3g} m that "
            "were followed; what lies far from the load is not to be read"
        )
    return tuple(warnings)
