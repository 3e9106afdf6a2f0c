"""Checks of the quantities of a tensor: worked tensors, and turned axes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from treadload.damage.fields import known_quantities
from treadload.damage.quantity import STRAIN, STRESS
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.validation.check import Check, absolute

# MPa; E = 5400 MPa, ν = 0.35.
_MODULUS, _POISSON = 5.4e9, 0.35
_NAMES = {
    "extension_strain": 1.0,
    "mazars_strain": 1.0,
    "octahedral_shear_stress": 1e6,
    "mean_stress": 1e6,
    "von_mises_strain": 1.0,
    "distortion_energy": 1e6,
}
# Stress xx, yy, zz, xy, xz, yz, MPa; the quantities of _NAMES, strains as such, stress and energy in MPa.
_WORKED = (
    (
        (2.04091912139, -0.45264929211, -0.865213076275, -1.56171731872, -0.800943641211, -0.223764770367),
        (0.000677696520013, 0.000677696520013, 1.9326708892, 0.241018917667, 0.00102495351867, 0.00140070628724),
    ),
    (
        (3.32299951664, -0.668046346109, -0.238553606573, -0.0277504024617, -0.371715885788, -0.286602581349),
        (0.000683727097935, 0.000683727097935, 1.82951343522, 0.805466521321, 0.000970246017235, 0.00125516977861),
    ),
    (
        (0.95775870296, 0.545105522688, 1.9350880341, 0.673009361073, -0.0792897047605, 0.0176481980704),
        (0.000262892663211, 0.000297638386706, 0.803792824906, 1.14598408658, 0.00042627551787, 0.000242281089514),
    ),
    (
        (-0.269620327342, -0.29172023244, 0.670104354828, -0.56500931112, 0.791331808733, 0.487027835369),
        (0.000277612450017, 0.000282700896455, 0.99468048551, 0.0362545983489, 0.000527508987314, 0.000371020975596),
    ),
)
# What changes with the axes: these know the vertical.
_VERTICAL = ("vertical_shear_strain", "horizontal_tension", "in_plane_extension", "vertical_compression")
# Another in other units.
_SAME = ("mazars_onset_ratio",)
_SOURCE = "formulas of Lytton, Mazars, Sousa and Kunst, worked outside the package"


def _quantities(stress: Array) -> dict[str, Array]:
    strain = tensors.strain_from_stress(stress, _MODULUS, _POISSON)
    quantities = {
        name: quantity for name, quantity in known_quantities().items() if set(quantity.needs) <= {*STRESS, *STRAIN}
    }
    return {name: np.asarray(quantity.of(stress, strain)) for name, quantity in quantities.items()}


def criteria_checks() -> Iterator[Check]:
    """Four worked tensors, and 200 tensors in turned axes, worst of each."""
    group = "criteria"
    stress = 1e6 * np.array([tensor for tensor, _ in _WORKED]).T
    exact = np.array([values for _, values in _WORKED]).T
    quantities = _quantities(stress)
    for (name, scale), values in zip(_NAMES.items(), exact, strict=True):
        worst = float(np.abs(quantities[name] / scale / values - 1).max())
        # Twelve digits of stress, of which differences lose one.
        yield absolute(group, f"{name}, worst of 4 tensors, relative", worst, 0, 3e-11, _SOURCE)
    random = np.random.default_rng(5)
    stress = random.uniform(-1e6, 1e6, (6, 200))
    turns = np.linalg.qr(random.normal(size=(200, 3, 3)))[0]
    turned = np.einsum("nij,njk,nlk->nil", turns, tensors.matrices(stress), turns)
    rows, columns = [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]
    before, after = _quantities(stress), _quantities(turned[:, rows, columns].T)
    for name in before:
        if name not in (*_VERTICAL, *_SAME):
            worst = float(np.abs(after[name] - before[name]).max() / np.abs(before[name]).max())
            what = f"{name}, change in turned axes over the largest value"
            yield absolute(group, what, worst, 0, 1e-12, "invariance under rotation")
