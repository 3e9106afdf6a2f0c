"""Finite elements of a rib's cross-section: closed numbers, the layer without grooves, a rib that is pressed."""

import numpy as np
import pytest

from treadload.kernels.layers.layered import Stack, transfer
from treadload.kernels.sections import Section, face_compliance
from treadload.validation.one_rib import PressedRib, half_rib, outer_pin, outer_third, strips

WIDTH, HEIGHT, POISSON = 0.04856, 0.020, 0.495
RIB = Section(((0.0, WIDTH),), HEIGHT, (0.005, 0.005), (0.006, 0.006))


@pytest.fixture(scope="module")
def table():
    return face_compliance(RIB, POISSON)


@pytest.mark.parametrize(("poisson", "stiffness"), [(0.45, 2.163), (0.49, 3.159), (0.495, 3.380), (0.4995, 3.615)])
def test_a_block_bonded_on_both_faces(poisson, stiffness):
    width = 2.67 * HEIGHT
    found = face_compliance(Section(((0.0, width),), HEIGHT, (0.0, 0.0)), poisson)
    nodes = found.compliance.shape[1] // 3
    plane = found.compliance[0].reshape(nodes, 3, nodes, 3)[:, 1:, :, 1:].reshape(2 * nodes, 2 * nodes)
    forces = np.linalg.solve(plane, np.tile([0.0, 1.0], nodes))
    # Gent and Lindley give 3.70 at ν = 1/2.
    assert forces[1::2].sum() / width * HEIGHT == pytest.approx(stiffness, rel=3e-3)


@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_loads_work_on_each_other_alike_and_give_way(poisson):
    compliance = face_compliance(RIB, poisson).compliance
    largest = np.abs(compliance).max()
    assert np.abs(compliance - compliance.swapaxes(1, 2)).max() <= 1e-12 * largest
    assert np.linalg.eigvalsh(compliance).min() > 0


def test_a_mirrored_rib_has_a_mirrored_compliance(table):
    cells = table.on_cells(strips(WIDTH, 16)).at(np.array([0.0, 90.0, 700.0]))
    parted = cells.reshape(3, 3, 16, 3, 16)
    sign = np.array([1.0, -1.0, 1.0])
    mirrored = parted[:, :, ::-1, :, ::-1] * sign[:, None, None, None] * sign[:, None]
    assert np.abs(parted - mirrored).max() <= 1e-9 * np.abs(parted).max()


def test_uniform_shear_along_travel(table):
    moved = table.on_cells(np.array([[0.0, WIDTH]])).compliance[0, 0, 0]
    assert moved == pytest.approx(0.985 * HEIGHT * 2 * (1 + POISSON), rel=0.03)


def test_a_rib_without_friction_is_a_third_as_stiff_as_the_layer(table):
    cells = table.on_cells(strips(WIDTH, 24)).compliance[0]
    # 2.1 E without friction; a layer of ν = 0.47 has 6 E.
    assert HEIGHT / cells[48:, 48:].sum(1).mean() == pytest.approx(2.08, rel=0.02)


@pytest.fixture(scope="module")
def slab():
    return face_compliance(Section(((-0.08, 0.08),), HEIGHT, (0.0, 0.0)).for_cells(3e-3), 0.47)


@pytest.mark.parametrize("k", [1.0, 50.0, 200.0])
def test_a_slab_without_grooves_is_the_layer(slab, k):
    poisson, cell = 0.47, 6e-3
    middle = np.array([[-0.5, 0.5], [0.5, 1.5]]) * cell
    found = slab.on_cells(middle).at(np.array([k]))[0].reshape(3, 2, 3, 2)
    across = (np.arange(40_000) + 0.5) * 0.2
    size = np.hypot(k, across)
    layer = transfer(size, Stack([0.5 / (1 + poisson)], [poisson], [HEIGHT], [], rigid=True), [0.0], [False])
    plane, transverse = layer.plane[0, 0, 0] / size, layer.transverse[0, 0] / size
    along = (k / size) ** 2
    symbols = {0: along * plane + (1 - along) * transverse, 1: (1 - along) * plane + along * transverse}
    symbols[2] = layer.plane[0, 1, 1] / size
    weight = np.sinc(across * cell / (2 * np.pi)) ** 2 * cell * 0.2 / np.pi
    for place in (0, 1):
        for component, symbol in symbols.items():
            expected = (weight * symbol * np.cos(across * place * cell)).sum()
            # Far from the load hardly anything is left, against which a part would be large.
            near = (weight * symbol).sum()
            assert found[component, 0, component, place] == pytest.approx(expected, rel=0.01, abs=5e-3 * near)


def test_the_table_is_smooth_between_its_waves(table, monkeypatch):
    between = np.array([0.0, 30.0, 170.0, 900.0])
    monkeypatch.setattr("treadload.kernels.sections.compliance._WAVES", between * HEIGHT)
    exact = face_compliance(RIB, POISSON).on_cells(strips(WIDTH, 8)).compliance
    assert np.abs(table.on_cells(strips(WIDTH, 8)).at(between) - exact).max(axis=(1, 2)) == pytest.approx(
        0, abs=1e-3 * np.abs(exact).max()
    )


@pytest.mark.parametrize(
    ("friction", "shear"), [(0.15, 0.139), (0.3, 0.278), (0.5, 0.396), (0.7, 0.408), (0.9, 0.408)]
)
def test_one_rib_pressed_shears_outward(friction, shear):
    assert outer_third(PressedRib(friction=friction)) == pytest.approx(shear, rel=0.03)


@pytest.mark.parametrize(
    ("rib", "shear"),
    [
        ({"depth": 0.010}, 0.353),
        ({"depth": 0.005}, 0.278),
        ({"width": 0.02}, 0.336),
        ({"width": 0.03}, 0.391),
        ({"width": 0.06}, 0.373),
    ],
)
def test_worn_narrow_and_wide_ribs(rib, shear):
    assert outer_third(PressedRib(friction=0.5, **rib)) == pytest.approx(shear, rel=0.03)


@pytest.mark.parametrize(("poisson", "shear"), [(0.47, 0.288), (0.49, 0.284), (0.495, 0.283), (0.4995, 0.282)])
def test_the_sides_and_not_poissons_ratio_make_the_shear(poisson, shear):
    assert outer_third(PressedRib(width=0.045, poisson=poisson, friction=0.3, edge=1e-6)) == pytest.approx(
        shear, rel=0.03
    )


def test_cells_of_3_and_of_1_5_mm_agree():
    of_cells = {}
    for cells in (16, 32):
        rib = PressedRib(cells=cells)
        of_cells[cells] = [measure(rib) for measure in (outer_third, outer_pin, half_rib)]
    assert of_cells[16] == pytest.approx(of_cells[32], rel=0.03)


def test_a_strip_at_a_wall_carries_the_force_of_its_cell(table):
    edges = np.array([[0.0, 0.004], [0.004, 0.007]])
    plain, forced = table.on_cells(edges).compliance[0], table.on_cells(edges, 0.003).compliance[0]
    assert forced == pytest.approx(forced.T, rel=1e-12)
    assert forced[4, 4] == pytest.approx(plain[4, 4] * 0.75)


@pytest.mark.slow
def test_a_tie_bar_joins_ribs_and_draft_stiffens_them():
    def sideways(**change):
        section = {"floors": (0.005, 0.005, 0.005), "ends": (0.006, 0.006)} | change
        both = Section(((0.0, 0.03), (0.04, 0.07)), HEIGHT, **section)
        # Of the right rib by the left one, and by itself.
        return face_compliance(both, POISSON).on_cells(np.array([[0.0, 0.03], [0.04, 0.07]])).compliance[0][2:4, 2:4]

    plain, tied, drafted = sideways(), sideways(floors=(0.005, 0.014, 0.005)), sideways(draft=0.15)
    assert abs(plain[0, 1]) < 0.02 * plain[0, 0]
    assert tied[0, 1] > 5 * abs(plain[0, 1])
    assert drafted[0, 0] < 0.9 * plain[0, 0]


def test_ribs_without_undertread_do_not_feel_each_other():
    both = Section(((0.0, 0.03), (0.04, 0.07)), HEIGHT, (0.0, 0.0, 0.0))
    alone = face_compliance(Section(((0.0, 0.03),), HEIGHT, (0.0, 0.0)), POISSON)
    pair = face_compliance(both, POISSON).on_cells(np.array([[0.0, 0.03], [0.04, 0.07]])).compliance
    assert pair[:, 0, 1] == pytest.approx(0)
    assert pair[:, ::2, ::2] == pytest.approx(alone.on_cells(np.array([[0.0, 0.03]])).compliance)


@pytest.mark.parametrize(
    "wrong",
    [
        {"ribs": ((0.03, 0.03),)},
        {"floors": (0.005,)},
        {"floors": (0.005, 0.020)},
        {"floors": (-0.001, 0.005)},
        {"ends": (-0.001, 0.0)},
        {"ribs": ((0.0, 0.03), (0.035, 0.07)), "floors": (0.005, 0.005, 0.005), "draft": 0.2},
    ],
)
def test_sections_that_cannot_be(wrong):
    sound = {"ribs": ((0.0, 0.03),), "height": HEIGHT, "floors": (0.005, 0.005)}
    with pytest.raises(ValueError, match=r"must|need|meet"):
        _ = Section(**(sound | wrong))


@pytest.mark.parametrize("poisson", [0.5, -1.0, np.nan])
def test_poissons_ratio_below_one_half(poisson):
    with pytest.raises(ValueError, match=r"0\.5"):
        face_compliance(RIB, poisson)
