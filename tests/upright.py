"""Materials that are another along z, for tests, and their numbers for the kernels."""

import numpy as np

import treadload as tl
from treadload.pavement.stack import medium_of, plane_of, upright_of

# Decays of the waves: a complex pair for compacted asphalt, real ones for the others, far apart and near each other.
MATERIALS = {
    "compacted asphalt": tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25),
    "unbound, E_v = 2 E_h": tl.materials.TransverselyIsotropic(150e6, 300e6, 120e6, 0.35, 0.3),
    "weak in shear": tl.materials.TransverselyIsotropic(9e9, 3e9, 0.4e9, 0.2, 0.1),
    "nearly isotropic": tl.materials.TransverselyIsotropic(5.0e9, 5.01e9, 1.853e9, 0.35, 0.349),
}


def decays(material):
    """s1 and s2, complex."""
    (shear, poisson), own = plane_of(material), upright_of(material)
    total, product, _ = own.roots(shear, poisson)
    half = np.sqrt(complex(total**2 / 4 - product))
    return total / 2 + half, total / 2 - half


def nearly(material, part):
    """An isotropic material whose moduli are split by a part."""
    shear = material.modulus / (2 * (1 + material.poisson))
    return tl.materials.TransverselyIsotropic(
        material.modulus * (1 + part),
        material.modulus * (1 - part),
        shear * (1 + 0.5 * part),
        material.poisson * (1 - part),
        material.poisson * (1 + part),
    )


__all__ = ["MATERIALS", "decays", "medium_of", "nearly", "plane_of", "upright_of"]
