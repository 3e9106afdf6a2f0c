"""Tread blocks in three dimensions: patch test, published moduli, the rib amid a long block, convergence."""

from dataclasses import replace

import numpy as np
import pytest

from treadload.kernels.sections import Block, FaceCells, Section, block_compliance, block_mesh, face_compliance
from treadload.kernels.sections.hexahedra import stiffness


def rectangle(length, width):
    a, b = 0.5 * length, 0.5 * width
    return (-a, -b), (a, -b), (a, b), (-a, b)


def cells_of(length, width, along, across):
    """Cells that fill the face of a rectangular block."""
    dx, dy = length / along, width / across
    x, y = np.meshgrid((np.arange(along) - 0.5 * (along - 1)) * dx, (np.arange(across) - 0.5 * (across - 1)) * dy)
    return FaceCells(np.stack([x.ravel(), y.ravel()], axis=1), dx, dy)


def compressed(side, height, poisson, count):
    """Apparent modulus over E of a square block bonded on both faces, and the mean stress of its cells over E."""
    cells = cells_of(side, side, count, count)
    block = Block(rectangle(side, side), height, parts=(count, count))
    compliance = block_compliance(block, poisson, cells)
    # No cell moves along the face, and all by the same out of it.
    wanted = np.repeat([0.0, 0.0, height], count * count)
    stress = np.linalg.solve(compliance, wanted).reshape(3, count, count)[2]
    return float(stress.mean()), stress


@pytest.mark.parametrize("poisson", [0.3, 0.495, 0.4999])
def test_distorted_elements_take_uniform_strain_exactly(poisson):
    """Patch test: under an affine displacement the inner node is free of force, the energy is that of the strain."""
    line = np.array([-1.0, 0.0, 1.0])
    nodes = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(27, 3)
    bend = 1.0 + 0.15 * nodes[:, [1, 2, 0]] + 0.1 * nodes[:, [2, 0, 1]]
    nodes = nodes * bend * np.array([0.003, 0.004, 0.002])
    gradient = np.array([[1.0, 0.4, -0.2], [0.3, -0.7, 0.1], [0.2, 0.5, 0.9]]) * 1e-3
    shear, lame = 0.5 / (1 + poisson), poisson / ((1 + poisson) * (1 - 2 * poisson))
    (matrix,) = stiffness(nodes[None], shear, lame)
    assert np.abs(matrix - matrix.T).max() == 0
    moved = (nodes @ gradient.T).ravel()
    force = (matrix @ moved).reshape(27, 3)
    # The only node inside is the 14th; pressures of the element carry the volume's part to round-off.
    assert np.abs(force[13]).max() < 1e-10 * np.abs(force).max()
    strain = 0.5 * (gradient + gradient.T)
    density = 0.5 * (2 * shear * (strain**2).sum() + lame * np.trace(strain) ** 2)
    unit = np.repeat([[1.0, 0.0, 0.0]], 27, axis=0) * nodes
    # The volume, by the work of a uniform stress: at λ = 0 and G = ½ that of a stretch along x is ½ V.
    (soft,) = stiffness(nodes[None], 0.5, 0.0)
    volume = unit.ravel() @ soft @ unit.ravel()
    assert 0.5 * moved @ matrix @ moved == pytest.approx(density * volume, rel=1e-9)
    # Six rigid motions and no more cost nothing.
    values = np.linalg.eigvalsh(matrix)
    assert np.abs(values[:6]).max() < 1e-9 * values[-1]
    assert values[6] > 1e-7 * values[-1]


def test_compliance_is_symmetric_and_positive():
    block = Block(
        ((-0.012, -0.01), (0.01, -0.01), (0.013, 0.01), (-0.009, 0.01)), 0.015, (0.003, 0.004, 0.003, 0.0),
        (0.004, 0.003, 0.0, 0.0), (0.05, 0.0, 0.1, 0.02),
    )  # fmt: skip
    x, y = np.meshgrid(np.arange(-0.0075, 0.008, 0.005), np.arange(-0.0075, 0.008, 0.005))
    cells = FaceCells(np.stack([x.ravel(), y.ravel()], axis=1), 0.005, 0.005)
    table = block_compliance(replace(block, parts=(3, 3)), 0.4999, cells)
    assert np.abs(table - table.T).max() <= 1e-12 * np.abs(table).max()
    values = np.linalg.eigvalsh(table)
    assert values[0] > 1e-3 * values[-1]


def test_the_image_of_a_block_has_the_image_of_its_compliance():
    block = Block(
        ((-0.012, -0.01), (0.01, -0.01), (0.013, 0.01), (-0.009, 0.01)), 0.015, (0.003, 0.004, 0.006, 0.0),
        (0.004, 0.003, 0.002, 0.0), (0.05, 0.0, 0.1, 0.02), parts=(2, 2),
    )  # fmt: skip
    x, y = np.meshgrid(np.arange(-0.008, 0.009, 0.008), np.arange(-0.008, 0.009, 0.008))
    centres = np.stack([x.ravel(), y.ravel()], axis=1)
    table = block_compliance(block, 0.49, FaceCells(centres, 0.008, 0.008))
    image = block_compliance(block.mirrored, 0.49, FaceCells(centres * [1.0, -1.0], 0.008, 0.008))
    turned = np.repeat([1.0, -1.0, 1.0], len(centres))
    # The same elements in another order.
    np.testing.assert_allclose(image, turned[:, None] * table * turned, atol=1e-11 * np.abs(table).max())


@pytest.mark.parametrize(("slenderness", "published"), [(2.0, 1.5), (4.0, 3.0)])
def test_square_blocks_bonded_on_both_faces(slenderness, published):
    """Gent and Lindley (1959), Proc. Inst. Mech. Eng. 173, 111-122: E_c = E (1 + 2 S²), S = a/4h, ν = ½.

    Their bulge is a parabola and their pressure that of a disc of the same S: 10 % below finite elements. The
    pressure of a thin square itself is Poisson's equation, as in torsion: 1 + 2.249 S² (6.748 G, 12 x 0.03514 x 16),
    of which what the free sides lack, a layer as thick as the block, is still 6 % at S = ½ and 2 % at S = 1.
    """
    modulus, _ = compressed(slenderness * 0.02, 0.02, 0.4999, 6)
    shape = slenderness / 4
    assert published == 1 + 2 * shape**2
    assert modulus == pytest.approx(published, rel=0.12)
    assert modulus > published
    assert modulus == pytest.approx(1 + 2.249 * shape**2, rel=0.065 if shape < 1 else 0.02)


def test_a_long_block_is_a_rib_in_its_middle():
    """Under loads that do not vary along travel: the section's displacement.

    The ends lie 4.3 heights away, and what they do falls by exp(-π x/2h), the quarter wave of shear: 0.1 %.
    """
    height, length, width, across, along = 0.015, 0.13, 0.02, 4, 9
    section = Section(((-0.5 * width, 0.5 * width),), height, (0.0, 0.0))
    y = (np.arange(across + 1) / across - 0.5) * width
    rib = face_compliance(section.for_cells(0.003), 0.49).on_cells(np.stack([y[:-1], y[1:]], axis=1)).at(np.zeros(1))
    block = Block(rectangle(length, width), height, parts=(along, across))
    table = block_compliance(block, 0.49, cells_of(length, width, along, across))
    table = table.reshape(3, across, along, 3, across, along)
    # A strip across the middle by rows that are loaded from end to end.
    middle = table[:, :, along // 2].sum(-1).reshape(3, across, 3, across)
    rib = rib[0].reshape(3, across, 3, across)
    # Elements of 1.7 mm at the walls against 0.25 mm: 1 % of the largest. A wave of length zero has no part along x.
    for of, by in ((0, 0), (1, 1), (2, 2), (1, 2), (2, 1)):
        np.testing.assert_allclose(middle[of, :, by], rib[of, :, by], atol=0.01 * np.abs(rib[of, :, by]).max())
    assert np.abs(middle[0, :, 1:]).max() < 1e-9 * np.abs(middle).max()


def test_finer_elements_converge(monkeypatch):
    """Bonded edges of rubber are singular: displacements r^0.6, energy by about the 1.2th power of the elements."""
    # Halves, so that each mesh holds the one before, and the energy under a load can only grow.
    monkeypatch.setattr(block_mesh, "_AT_WALL", 0.5)
    side, height = 0.012, 0.012
    cells = cells_of(side, side, 1, 1)
    energies = [
        block_compliance(Block(rectangle(side, side), height, parts=(parts, parts)), 0.4999, cells)[2, 2]
        for parts in (1, 2, 4)
    ]
    first, second = np.diff(energies)
    assert 0 < second < first
    assert np.log2(first / second) > 1.1


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"floors": (0.02, 0.0, 0.0, 0.0)}, "floors must lie from 0 m to below the height"),
        ({"draft": (-0.1, 0.0, 0.0, 0.0)}, "must not be negative"),
        ({"corners": ((0.0, 0.0), (0.0, 0.01), (0.01, 0.01), (0.01, 0.0))}, "convex"),
    ],
)
def test_shapes_that_are_no_blocks(change, text):
    with pytest.raises(ValueError, match=text):
        Block(**({"corners": rectangle(0.02, 0.02), "height": 0.02} | change))


def test_what_has_no_compliance():
    block = Block(rectangle(0.02, 0.02), 0.02)
    with pytest.raises(ValueError, match=r"below 0\.5"):
        block_compliance(block, 0.5, cells_of(0.02, 0.02, 2, 2))
    with pytest.raises(ValueError, match="no part of the face"):
        block_compliance(block, 0.49, FaceCells(np.array([[0.0, 0.0], [0.1, 0.0]]), 0.01, 0.01))
