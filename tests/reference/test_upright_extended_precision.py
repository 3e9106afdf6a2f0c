"""Layers with an upright grain against the matrix exponential in 120 digits: random moduli, thin and thick."""

import mpmath as mp
import numpy as np
import pytest

import treadload as tl
from treadload.kernels.layers.layered import transfer
from treadload.pavement.stack import plane_of, stack_of, upright_of


def drawn(rng):
    """A material whose moduli lie up to thirty times apart, and up to four orders from the next one's."""
    while True:
        young, ratio, part = 10 ** rng.uniform(6, 10.5), 10 ** rng.uniform(-1.5, 1.5), 10 ** rng.uniform(-2, 0.3)
        across, down = rng.uniform(-0.3, 0.6), rng.uniform(-0.2, 0.49) * min(1, np.sqrt(ratio))
        try:
            return tl.materials.TransverselyIsotropic(
                young, young * ratio, young * np.sqrt(ratio) * part / 2.6, across, down
            )
        except tl.InputError:
            continue


def generator(material):
    """M of (u, f)' = M (u, f), over k z."""
    (shear, poisson), own = plane_of(material), upright_of(material)
    plate, along, lift = 2 * mp.mpf(shear) / (1 - mp.mpf(poisson)), mp.mpf(own.along), mp.mpf(own.across) / own.along
    return mp.matrix(
        [[0, 1, -1 / mp.mpf(own.shear), 0], [-lift, 0, 0, -1 / along], [-plate, 0, 0, lift], [0, 0, -1, 0]]
    )


@pytest.mark.parametrize("seed", range(6))
def test_random_layers_on_rock_keep_their_digits(seed):
    rng = np.random.default_rng(seed)
    materials, thickness = [drawn(rng) for _ in range(3)], 10 ** rng.uniform(-3, 0, size=3)
    layers = [tl.Layer(one, float(h)) for one, h in zip(materials, thickness, strict=True)]
    stack = stack_of(tl.Pavement(layers, rigid_base=True))
    for k in (1e-4, 0.3, float(10 / thickness.sum())):
        found = transfer([k], stack, [0.0], [False]).plane[0, :2, :, 0]
        with mp.workdps(120):
            # From the rock up, where nothing moves: what moves the top, over what is pushed there.
            state = mp.matrix([[0, 0], [0, 0], [1, 0], [0, 1]])
            for material, h in list(zip(materials, thickness, strict=True))[::-1]:
                state = mp.expm(-generator(material) * mp.mpf(k) * mp.mpf(float(h)), method="taylor") * state
            exact = np.array((state[0:2, :] * state[2:4, :] ** -1).tolist(), dtype=float)
        # Each entry over the geometric mean of its diagonals; 1.2e-13 was the worst of 120.
        size = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
        assert np.abs((found - exact) / size).max() < 1e-12
