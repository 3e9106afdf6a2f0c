"""Checks of roads that are another along the vertical: other ways to the same surface, stress and layers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from treadload.contact.bodies.upright import UprightHalfSpace
from treadload.grid import Grid
from treadload.kernels.anisotropy.interior import Modes
from treadload.kernels.anisotropy.interior import fields_on_grid as by_directions
from treadload.kernels.anisotropy.symbol import surface_symbol
from treadload.kernels.half_space.interior import fields_on_grid
from treadload.kernels.layers.images import fit_images
from treadload.materials import Elastic, Solid, TransverselyIsotropic
from treadload.pavement import BONDED, Bond, Layer, Pavement
from treadload.pavement.stack import medium_of, plane_of, stack_of
from treadload.response import GridLoad, Response, solve_response
from treadload.validation.check import Check, absolute, relative

_ASPHALT = TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25)
# Its waves decay by a complex pair, those of asphalt by two real numbers.
_STONE = TransverselyIsotropic(150e6, 300e6, 120e6, 0.35, 0.3)
_SOIL = Elastic(60e6, 0.4)
_GROUP = "upright grain"


def upright_checks() -> Iterator[Check]:
    """The surface, the inside and layers of transversely isotropic roads."""
    for name, material in (("asphalt", _ASPHALT), ("stone", _STONE)):
        body = UprightHalfSpace.of(stack_of(Pavement.half_space(material)))
        modulus = 2 / float(surface_symbol(material.stiffness)(np.zeros(1))[0, 2, 2].real)
        what = f"{name}: contact modulus, MPa"
        source = "Barnett & Lothe's averages; closed form of Turner (1980)"
        yield relative(_GROUP, what, body.contact_modulus / 1e6, modulus / 1e6, 1e-12, source)
        yield absolute(_GROUP, f"{name}: stress of a cell, error over the load", _inside(material), 0, 1e-9,
                       "integral over directions")  # fmt: skip
        equal = _apart(_solved([(material, 0.06), (material, 0.1), (material, None)], Bond(1e25)),
                       _solved([(material, None)]))  # fmt: skip
        yield absolute(_GROUP, f"{name}: three equal layers, error over the largest value", equal, 0, 1e-8,
                       "the half-space in closed form")  # fmt: skip
    plain = [(Elastic(7e9, 0.35), 0.08), (Elastic(3e8, 0.35), 0.3), (_SOIL, None)]
    split = [(_split(material), thickness) for material, thickness in plain]
    yield absolute(_GROUP, "moduli split by 1e-6, difference over the largest value",
                   _apart(_solved(split), _solved(plain)), 0, 1e-5, "isotropic layers")  # fmt: skip
    layers = Pavement([Layer(_ASPHALT, 0.06), Layer(_STONE, 0.3), Layer(_SOIL)])
    residual = fit_images(stack_of(layers)).residual
    yield absolute(_GROUP, "compliance of layers in contact, fit", residual, 0, 1e-6, "the recursion over layers")


def _inside(material: TransverselyIsotropic) -> float:
    """Largest difference of stress below a cell of 30 by 20 mm, under each load."""
    x, y = np.array([0.0, 0.011, 0.04, -0.07]), np.array([0.003, 0.025, -0.06])
    load, cell = np.eye(3)[:, :, None, None], (0.03, 0.02)
    depths, modes = np.array([0.0, 0.012, 0.04]), Modes.of(material.stiffness)
    worst = 0.0
    for loads in load.swapaxes(0, 1):
        fields = fields_on_grid(loads, *cell, depths, plane_of(material)[0], medium_of(material), x, y)[0]
        expected = by_directions(loads, *cell, depths, 1.0, modes, x, y)[0]
        worst = max(worst, float(np.abs(fields - expected).max()))
    return worst


def _split(material: Elastic) -> TransverselyIsotropic:
    young, shear, nu = material.modulus, material.shear_modulus, material.poisson
    return TransverselyIsotropic(young * (1 + 1e-6), young, shear * (1 - 1e-6), nu, nu * (1 + 1e-6))


def _solved(layers: Sequence[tuple[Solid, float | None]], bond: Bond = BONDED) -> Response:
    """Under pressure and shear on a few cells; a stiff bond keeps equal layers apart."""
    *upper, last = layers
    road = Pavement([*(Layer(material, thickness, bond=bond) for material, thickness in upper), Layer(last[0])])
    grid = Grid.centred(0.1, 0.08, 0.02)
    pressed, along, across = np.random.default_rng(7).random((3, *grid.shape)) * 1e6
    load = GridLoad(grid, pressed, along - 5e5, across - 5e5)
    x, y = np.linspace(-0.2, 0.21, 7), np.linspace(-0.15, 0.16, 5)
    return solve_response(load, road, depths=[0.0, 0.02, 0.07, 0.3], x=x, y=y)


def _apart(response: Response, reference: Response) -> float:
    """Largest difference of stress, strain and displacement, over the largest of its kind."""
    worst = 0.0
    for kind in ("stress_", "strain_", "displacement_"):
        names = [name for name in reference.dataset if str(name).startswith(kind)]
        values, exact = (
            np.stack([solved.dataset[name].to_numpy() for name in names]) for solved in (response, reference)
        )
        worst = max(worst, float(np.abs(values - exact).max() / np.abs(exact).max()))
    return worst
