"""What endless bars of plastic strain do to the surface of a layered road, by Betti's theorem.

The work of a line load on the displacement that the strain leaves is the work of its stress on the strain. The stress
of line loads is known by waves across the track. The half-space of the top layer is taken in closed form, with the
sharp edges of the cells; waves add what the layers change of it, which is smooth.
"""

from __future__ import annotations

import math

import numpy as np

from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.eigenstrain.operator import Grid as Cells
from treadload.kernels.eigenstrain.operator import moved_by_endless
from treadload.kernels.layers.layered import Stack, transfer
from treadload.pavement import Pavement
from treadload.pavement.stack import stack_of
from treadload.response.passes.box import Box

# Waves are integrated by so many points a panel: octaves from the longest, then panels of so many radians over the
# width, up to the finest that the cells carry.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_OCTAVES, _RADIANS = 16, 4.0


def surface_profile(strain: Array, box: Box, road: Pavement, across: Array) -> Array:
    """Displacement (..., ny) of the surface, m, down positive, that plastic strain leaves.

    strain: (..., 6, nz, ny), in the rows of the box, the same all along travel. across: (m,), m, where it is read:
    lateral places, on the lattice of the box's cells. Of half-bonded interfaces the mean of both limits.
    """
    places = np.rint((across - box.y0) / box.dy).astype(int)
    profile = _half_space(strain, box, places, stack_of(road.bond_limits[0]).poisson[0])
    return profile if road.is_homogeneous else profile + layers_change(strain, box, road, places)


def layers_change(strain: Array, box: Box, road: Pavement, places: IntArray) -> Array:
    """What layers change of the surface of a half-space of the top one.

    strain: as of `surface_profile`. places: (m,), numbers of cells across, the first of the box 0.
    """
    return np.asarray(np.mean([_change(strain, box, places, stack_of(limit)) for limit in road.bond_limits], axis=0))


def _half_space(strain: Array, box: Box, places: Array, poisson: float) -> Array:
    """On a half-space, in closed form."""
    first, last = min(0, int(places.min())), max(box.ny, int(places.max()) + 1)
    wide = np.zeros((*strain.shape[:-1], last - first))
    wide[..., -first : box.ny - first] = strain
    moved = moved_by_endless(Cells(1, last - first, box.dx, box.dy, box.edges), poisson)
    profiles = [moved(strains[..., None])[2, 0, :, 0] for strains in wide.reshape(-1, *wide.shape[-3:])]
    result: Array = np.reshape(profiles, (*strain.shape[:-3], last - first))[..., places - first]
    return result


def _change(strain: Array, box: Box, places: IntArray, stack: Stack) -> Array:
    """What layers change of the half-space of the top one."""
    reach = box.dy * max(box.ny, int(places.max()) - min(0, int(places.min())) + 1)
    k, dk = _waves(reach, math.pi / box.dy)
    top = Stack(stack.shear[:1], stack.poisson[:1], (math.inf,), ())
    stress = _line_load(k, stack, box.edges) - _line_load(k, top, box.edges)
    # Of cells of uniform strain: impulses at their centres times the transform of a cell.
    waves = strain @ np.exp(-1j * box.dy * np.outer(np.arange(box.ny), k)) * box.dy * np.sinc(k * box.dy / math.tau)
    weights = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])[:, None, None]
    work = (waves * (weights * stress.conj())).sum(axis=(-3, -2)) * dk / math.pi
    moved: Array = (work @ np.exp(1j * box.dy * np.outer(k, places))).real
    return moved


def _waves(width: float, finest: float) -> tuple[Array, Array]:
    """Wavenumbers, 1/m, and their weights in an integral from 0 to the finest; width: of what is looked at, m."""
    first = min(_RADIANS / width, finest)
    octaves = first * 0.5 ** np.arange(_OCTAVES, -1, -1)
    even = np.linspace(first, finest, 1 + math.ceil((finest - first) * width / _RADIANS))
    ends = np.concatenate([[0.0], octaves, even[1:]])
    half, middle = 0.5 * np.diff(ends)[:, None], 0.5 * (ends[1:] + ends[:-1])[:, None]
    return (middle + half * _NODES).ravel(), (half * _WEIGHTS).ravel()


def _line_load(k: Array, stack: Stack, edges: Array) -> Array:
    """Stress (6, nz, nk) of a line load along x of 1 N/m in waves across, integrated over the depth of each row."""
    half, middle = 0.5 * np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
    depths = (middle[:, None] + half[:, None] * _NODES).ravel()
    poisson = np.array([stack.poisson[stack.layer_at(float(z), True)] for z in depths])[:, None]
    shear = np.array([stack.shear[stack.layer_at(float(z), True)] for z in depths])[:, None]
    values = np.zeros((6, len(depths), len(k)), complex)
    across, _, slide, push = np.moveaxis(
        transfer(k, stack, depths.tolist(), [True] * len(depths)).plane[:, :, 1], 1, 0
    )
    down = ((1 - 2 * poisson) * -push / (2 * shear) - poisson * across) / (1 - poisson)
    lame = 2 * shear * poisson / (1 - 2 * poisson)
    values[0] = lame * (across + down)
    values[1] = values[0] + 2 * shear * across
    values[2] = -push
    values[5] = 1j * slide
    nodes = (half[:, None] * _WEIGHTS).reshape(1, -1, 1)
    summed: Array = (values * nodes).reshape(6, len(half), len(_NODES), len(k)).sum(axis=2)
    return summed
