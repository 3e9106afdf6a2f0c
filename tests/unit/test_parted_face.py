"""A face that has parted: what a jump across it does, where it slides and opens, and what roads with it do."""

import json
import math

import numpy as np
import pytest

import treadload as tl
from treadload.case.choices import BOND
from treadload.damage import delaminate
from treadload.errors import InputError
from treadload.kernels.complementarity.parted import FaceStiffness, solve_parted
from treadload.kernels.layers.jumps import jump
from treadload.kernels.layers.layered import Stack, transfer
from treadload.pavement import FRICTIONLESS, Parted
from treadload.response.parted import solve_face

K = np.geomspace(0.1, 300, 9)
LAYERS = ((2e9, 3e9, 1e8, 5e7), (0.35, 0.3, 0.4, 0.45), (0.06, 0.1, 0.2, math.inf))
ROAD = tl.Pavement(
    [
        tl.Layer(tl.Elastic(5e9, 0.35), 0.06, name="wearing course"),
        tl.Layer(tl.Elastic(8e9, 0.35), 0.15, name="base"),
        tl.Layer(tl.Elastic(2e9, 0.35), name="rock"),
    ]
)
WHEEL = tl.response.GridLoad.from_arrays(np.full((8, 8), 7e5), np.full((8, 8), -2.8e5), None, spacing=0.025)


@pytest.mark.parametrize("below", [False, True])
@pytest.mark.parametrize("spring", [1e10, 0.0, math.inf])
def test_a_jump_turns_a_bonded_road_into_one_without_friction(spring: float, below: bool) -> None:
    # Two independent ways to one field; both are sums of products, round-off 1e-13 of the largest.
    depths, face = [0.0, 0.03, 0.06, 0.1, 0.16, 0.2, 0.36, 0.5], 0.16
    bonded, free = (Stack(*LAYERS, (spring, middle, 1e9)) for middle in (math.inf, 0.0))
    held, loose = (transfer(K, one, depths, [below] * 8) for one in (bonded, free))
    over, under = (transfer(K, free, [face], [side]) for side in (False, True))
    found = jump(K, bonded, face, depths, [below] * 8)
    plane = held.plane + np.einsum("zabk,bck->zack", found.plane, (over.plane - under.plane)[0, :2])
    turned = held.transverse + found.transverse * (over.transverse - under.transverse)[0, 0]
    assert np.abs(plane - loose.plane).max() < 1e-12 * np.abs(loose.plane).max()
    assert np.abs(turned - loose.transverse).max() < 1e-12 * np.abs(loose.transverse).max()


def test_deep_in_one_material_a_jump_meets_the_stiffness_of_a_dislocation() -> None:
    # G k / 2 across, G k / 2 (1 - ν) in the plane, no coupling; the free surface is e^-500 away.
    shear, nu = 1e9, 0.3
    found = jump(np.array([10.0]), Stack((shear, shear), (nu, nu), (50.0, math.inf), (math.inf,)), 50.0, [], [])
    np.testing.assert_allclose(found.stiffness_transverse, shear / 2, rtol=1e-12)
    np.testing.assert_allclose(found.stiffness[:, :, 0], np.eye(2) * shear / (2 * (1 - nu)), rtol=1e-12, atol=1e-3)


def _row(count: int, length: float, plane: float, across: float) -> tuple[np.ndarray, FaceStiffness]:
    k = 2 * math.pi * np.fft.rfftfreq(count, length / count)[None]
    along = (k > 0).astype(float)
    x = (np.arange(count) + 0.5) * length / count - length / 2
    return x, FaceStiffness(along, 0 * k, plane * k, plane * k, 0 * k, across * k)


@pytest.mark.parametrize("mode", ["across", "along", "opens"])
def test_the_zone_that_slides_or_opens_is_that_of_the_closed_form(mode: str) -> None:
    """A row of sliding zones in a uniform body under τ = T b² / (s² + b²), s = sin(π x / L), against a bound g.

    The end of the zone, s = S, has no stress intensity: ∫ (τ - g) / √(S² - s²) ds = 0, so that S = b √((T/g)² - 1).
    """
    length, top, b, pressure, friction = 1.0, 1e6, 0.2, 1e6, 0.3
    bound = friction * pressure
    width = 2 * length / math.pi * math.asin(b * math.sqrt((top / bound) ** 2 - 1))
    for count in (64, 256):
        x, stiffness = _row(count, length, 7e8, 5e8)
        peak = top * b**2 / (np.sin(math.pi * x / length) ** 2 + b**2)
        traction = np.zeros((3, 1, count))
        traction[2] = bound - peak if mode == "opens" else pressure
        part = {"along": 0, "across": 1, "opens": 2}[mode]
        if mode != "opens":
            traction[part, 0] = peak
        found = solve_parted(traction, stiffness, friction, tolerance=1e-7)
        moved = np.abs(found.jump[part, 0]) > 0
        # The zone ends within the cell that holds its end, on either side.
        assert abs(moved.sum() / count * length - width) <= 2 * length / count
        if mode == "opens":
            assert (found.traction[2][:, moved] == 0).all()
            assert (found.jump[2] <= 0).all()
        else:
            np.testing.assert_allclose(found.traction[part, 0, moved], bound, rtol=1e-6)
        assert abs(found.traction[part].mean() - traction[part].mean()) < 1e-6 * top


def test_a_face_obeys_coulomb_and_bears_no_more_and_no_less_than_before() -> None:
    face = solve_face((WHEEL,), delaminate(ROAD, 0, Parted(0.6)))
    jump_, traction = face.state.jump, face.state.traction
    size, slid = np.hypot(*traction[:2]), np.hypot(*jump_[:2])
    largest = traction[2].max()
    # The solver stops at 1e-4 of the largest traction.
    assert (traction[2] >= 0).all()
    assert (size <= 0.6 * traction[2] + 2e-4 * largest).all()
    assert (jump_[2] <= 0).all()
    assert (traction[2] * jump_[2] == 0).all()
    sliding = slid > 0
    assert 0 < sliding.mean() < 0.5
    assert face.wide
    drag = (traction[:2] * jump_[:2]).sum(axis=0)[sliding]
    np.testing.assert_allclose(drag, (size * slid)[sliding], rtol=1e-9, atol=1e-20)
    # Where nothing slides the shear is less than friction bears.
    np.testing.assert_allclose(size[sliding], 0.6 * traction[2][sliding], atol=2e-4 * largest)
    cell = (face.x[1] - face.x[0]) ** 2
    weight = 24e3 * face.depth * face.x.size * face.y.size * cell
    # The wheel's 28 kN pass the face, what passes beyond the grid aside.
    assert traction[2].sum() * cell - weight == pytest.approx(28e3, rel=0.02)


@pytest.mark.slow
def test_a_face_passes_the_shear_force_that_it_would_pass_if_it_held() -> None:
    face = solve_face((WHEEL,), delaminate(ROAD, 0, Parted(0.6)))
    traction = face.state.traction
    held = tl.solve_response(WHEEL, ROAD, depths=[0.06], x=face.x, y=face.y).dataset
    for part, name in ((0, "xz"), (1, "yz")):
        before = -held[f"stress_{name}"].to_numpy()[0]
        assert abs((traction[part] - before).sum()) < 1e-3 * np.abs(before).sum()


def _bottom(road: tl.Pavement, load: object, depth: float = 0.06) -> np.ndarray:
    at = np.linspace(-0.2, 0.2, 9)
    data = tl.solve_response(load, road, depths=[depth], x=at, y=at).dataset
    return np.stack([data[f"strain_{name}"].to_numpy()[0] for name in ("xx", "yy", "zz", "xy", "xz", "yz")])


@pytest.mark.slow
def test_friction_lies_between_bonded_and_frictionless() -> None:
    disc = tl.UniformDisc(0.12, 7e5)
    bonded, loose = _bottom(ROAD, disc), _bottom(delaminate(ROAD, 0), disc)
    # Pressed by a great weight nothing slides: the bonded road, but for the round-off of transforms.
    heavy = _bottom(delaminate(ROAD, 0, Parted(0.8, unit_weight=1e9)), disc)
    np.testing.assert_allclose(heavy, bonded, atol=1e-9 * np.abs(bonded).max())
    # Without friction and with a weight that keeps the face shut the frictionless road, but for the grid's cells and
    # its images, both 1 %.
    slippery = _bottom(delaminate(ROAD, 0, Parted(0.0, unit_weight=1e6)), disc)
    assert np.abs(slippery - loose).max() < 0.01 * np.abs(loose).max()
    extension = [one[0].max() for one in (bonded, _bottom(delaminate(ROAD, 0, Parted(0.7)), disc), loose)]
    assert extension[0] < extension[1] < extension[2]


def test_the_jump_of_a_face_is_what_both_sides_of_a_response_differ_by() -> None:
    road = delaminate(ROAD, 0, Parted(0.6))
    face = solve_face((WHEEL,), road)
    near = np.flatnonzero(np.abs(face.x) < 0.3)[::4]
    fields = tl.life.solve_interfaces(WHEEL, road, x=face.x[near], y=face.y[near])
    own, largest = face.state.jump[0][np.ix_(near, near)], face.state.traction[2].max()
    # The held road's jump is round-off of displacement.
    np.testing.assert_allclose(-fields["jump_x"][0], own, atol=1e-6 * np.abs(face.state.jump).max())
    # Cells of the face obey friction as the solver left them, and the held road's traction twice as it is read.
    rest = fields["interface_shear"][0] - 0.6 * (fields["interface_pressure"][0] + 24e3 * 0.06)
    assert float(rest.max()) < 1e-3 * largest
    assert any("once, from rest" in text for text in json.loads(fields.attrs["warnings"]))


def test_bad_faces_get_one_sentence() -> None:
    with pytest.raises(InputError, match=r"must lie in \[0, 5\], got -0.1; 0.5 to 0.8 is usual"):
        Parted(-0.1)
    with pytest.raises(InputError, match=r"unit_weight.*got 0"):
        Parted(0.5, unit_weight=0)
    twice = delaminate(delaminate(ROAD, 0, Parted(0.6)), 1, Parted(0.6))
    with pytest.raises(InputError, match="interfaces 1 and 2 are both parted"):
        tl.solve_response(WHEEL, twice, depths=[0.06])
    sheared = tl.response.GridLoad.from_arrays(np.full((8, 8), 7e5), np.full((8, 8), -6e5), None, spacing=0.025)
    with pytest.raises(InputError, match="slide off as a whole; take more friction"):
        tl.solve_response(sheared, delaminate(ROAD, 0, Parted(0.01)), depths=[0.06], x=[0], y=[0])
    with pytest.raises(InputError, match=r"holds or slides, place by place; take Pavement\.sticking"):
        _ = Parted(0.6).stiffness
    moving = tl.Pavement(
        [
            tl.Layer(tl.materials.Prony(1e9, ((0.5, 0.1),), 0.35), 0.06, bond=Parted(0.6)),
            tl.Layer(tl.Elastic(1e9, 0.35)),
        ]
    )
    with pytest.raises(InputError, match="followed between elastic layers"):
        tl.solve_response(WHEEL, moving, depths=[0.06], x=[0], y=[0], speed=10)


def test_a_case_names_a_parted_face_and_frictionless_stays_what_it_was() -> None:
    table = BOND.read({"kind": "parted", "friction": 0.6})
    made = BOND.build(table)
    assert made == Parted(0.6)
    assert str(made) == "parted with friction 0.6"
    assert FRICTIONLESS.sticking is FRICTIONLESS
    assert Parted(0.6).sticking == tl.pavement.BONDED


@pytest.mark.slow
def test_the_surface_above_a_parted_face_is_assessed_on_its_whole_basin() -> None:
    road, x = delaminate(ROAD, 0, Parted(0.6)), np.linspace(-0.2, 0.2, 33)
    verdict = tl.assess(tl.solve_response(WHEEL, road, depths=[0.0], x=x, y=x), tl.FatigueLine(100e-6, -0.2))
    data = verdict.dataset
    at = [np.array([float(data[f"worst_{name}"])]) for name in ("x", "y")]
    there = tl.solve_response(WHEEL, road, depths=[0.0], x=at[0], y=at[1], mean_over=0.01).dataset
    # The in-plane strain that the law evaluates, solved at the worst point alone.
    assert float(data["worst_strain"]) == pytest.approx(float(there["in_plane_strain_1"].max()), rel=1e-3)
    assert float(data["worst_strain"]) >= float(data["extension_by_depth"][0]) * (1 - 1e-6)
