"""Stress intensity of cracks in layers: handbooks, finite elements, faces that touch and rub."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from treadload.damage.growth.options import POINTS
from treadload.kernels.fracture import closure
from treadload.kernels.fracture.closure import bounded, stress_intensity
from treadload.kernels.fracture.crack import crack_faces, straight
from treadload.kernels.fracture.dislocations import (
    Section,
    edge_images,
    edge_in_the_plane,
    edge_layers,
    screw_images,
    screw_in_the_plane,
    screw_layers,
)
from treadload.kernels.fracture.interface import dundurs, interface_singularity
from treadload.kernels.fracture.layers import Strip

FINITE_ELEMENTS = json.loads(
    (Path(__file__).parents[1] / "data" / "cracks" / "edge_crack_fe.json").read_text(encoding="utf-8")
)
HALF_PLANE = Section((Strip(1.0, 0.3, math.inf),))
DOWN = (0.0, 1.0)
# On next to nothing: 1e-10 would hold a strip that is cracked over 0.9 of its height by 4 %.
FREE_STRIP = Section((Strip(1.0, 0.3, 1.0), Strip(1e-16, 0.3, math.inf)))


def intensity(faces, normal, shear=None):
    """K_I, K_II over √(πa) without closure. normal, shear: tractions at the points."""
    shear = np.zeros_like(normal) if shear is None else shear
    return faces.plane @ np.concatenate([normal, shear]) / math.sqrt(math.pi * faces.length)


@pytest.mark.parametrize(
    ("power", "handbook"),
    # Across the edge under σ (z/a)^n: Tada, Paris and Irwin (2000), The Stress Analysis of Cracks Handbook, part 8.
    [(0, 1.1215), (1, 0.6829), (2, 0.5255), (3, 0.4410)],
)
def test_edge_crack_under_powers_of_stress(power, handbook):
    faces = crack_faces(HALF_PLANE, straight(DOWN), 0.04)
    load = (faces.z / 0.04) ** power
    # 0.5 % is asked; the rule is within 0.04 %.
    assert intensity(faces, load)[0] == pytest.approx(handbook, rel=1e-3)
    assert intensity(faces, np.zeros_like(load), load)[1] == pytest.approx(handbook, rel=1e-3)


def test_edge_crack_under_pairs_of_forces():
    # Hartranft and Sih (1973), in Tada, Paris and Irwin, 8.3: K of a pair P at z is F 2 P / √(πa).
    def handbook(v):
        return (1 + (1 - v**2) * np.polyval([0.5094, -0.9942, 0.7685, -0.3912, 0.2945], v**2)) / np.sqrt(1 - v**2)

    a = 0.05
    faces = crack_faces(HALF_PLANE, straight(DOWN), a, 64)
    u = faces.z / a
    node, weight = np.polynomial.legendre.leggauss(400)
    v = 0.5 * (1 + node)
    pair = 2 / math.sqrt(math.pi * a) * handbook(v)
    for place in (0.1, 0.2, 0.4, 0.6, 0.8):
        # A pair is the limit of a narrow bump, whose K is the pair's within the bump.
        expected = 0.5 * a * float((weight * pair * np.exp(-(((v - place) / 0.05) ** 2))).sum())
        assert faces.plane[0, :64] @ np.exp(-(((u - place) / 0.05) ** 2)) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize(
    ("part", "handbook"),
    # Kaya and Erdogan (1987), Int. J. Fract. 34, 33-51: edge crack in a free strip under tension, five digits.
    [(0.1, 1.1892), (0.2, 1.3673), (0.3, 1.6599), (0.4, 2.1114), (0.5, 2.8246), (0.6, 4.0332)],
)
def test_free_strip_is_a_layer_on_next_to_nothing(part, handbook):
    faces = crack_faces(FREE_STRIP, straight(DOWN), part)
    # The last of the five digits.
    assert intensity(faces, np.ones_like(faces.z))[0] == pytest.approx(handbook, rel=1e-4)
    # Out of the plane the closed form is √(tan(πa/2h) 2h/πa) (Tada, Paris and Irwin, 2.28).
    closed = math.sqrt(2 / (math.pi * part) * math.tan(math.pi * part / 2))
    assert faces.antiplane.sum() / math.sqrt(math.pi * part) == pytest.approx(closed, rel=1e-3)


@pytest.mark.parametrize(
    ("part", "tension", "bending", "bound"),
    # Tada, Paris and Irwin (2000), sections 2.10 and 2.13, within the bound asked of each depth. Their formulas are
    # within 0.5 %, so half a per cent is asked beyond that of what this rule has: 0.35 %.
    [(0.7, 6.3755, 2.7163, 0.005), (0.8, 11.9926, 4.6744, 0.005), (0.9, 34.7187, 12.4690, 0.005)],
)
def test_strips_cracked_almost_through(part, tension, bending, bound):
    faces = crack_faces(FREE_STRIP, straight(DOWN), part, POINTS)
    assert intensity(faces, np.ones_like(faces.z))[0] == pytest.approx(tension, rel=bound)
    assert intensity(faces, 1 - 2 * faces.z)[0] == pytest.approx(bending, rel=bound)


def test_deep_crack_in_bending_is_two_half_planes_apart():
    # Two half-planes joined over c: K = 3.975 M / c^1.5 (Tada, Paris and Irwin, 9.2), of a ligament that is small.
    part = 0.97
    faces = crack_faces(FREE_STRIP, straight(DOWN), part, 48)
    found = float(faces.plane[0, :48] @ (1 - 2 * faces.z))
    # M = 1/6 for a stress of 1 at the edge; what is left is the ligament's part of the height.
    assert found == pytest.approx(3.975 / 6 / (1 - part) ** 1.5, rel=0.01)


def test_error_falls_faster_than_any_power_of_the_points():
    part = 0.9
    exact = intensity(crack_faces(FREE_STRIP, straight(DOWN), part, 48), np.ones(48))[0]
    errors = [
        abs(intensity(crack_faces(FREE_STRIP, straight(DOWN), part, n), np.ones(n))[0] / exact - 1)
        for n in (4, 8, 12, 16)
    ]
    # From 8 points each four more take away nine tenths and more; the power -2 of a rule that leaves the mouth
    # unresolved would take away half.
    assert errors[1] < 5e-3
    assert errors[2] < 0.1 * errors[1]
    assert errors[3] < 0.1 * errors[2]


@pytest.mark.parametrize("ahead", [0.1, 0.3, 3.0, 10.0])
def test_towards_an_interface_is_the_singularity_of_zak_and_williams(ahead):
    strips = Strip(1.0, 0.3, 1.0), Strip(ahead, 0.35, math.inf)
    before = np.array([0.01, 0.0025])
    factors = [crack_faces(Section(strips), straight(DOWN), 1 - d, 64).plane[0, :64].sum() for d in before]
    power = math.log(factors[1] / factors[0]) / math.log(before[1] / before[0])
    # K ~ d^(1/2 - λ) up to a part of d itself.
    assert power == pytest.approx(0.5 - interface_singularity(*strips), abs=0.01)


def test_singularity_of_an_interface_has_its_limits():
    layer = Strip(2.0, 0.25, 1.0)
    assert interface_singularity(layer, layer) == pytest.approx(0.5, abs=1e-9)
    # Nothing ahead: a ligament that bends. The table of Cook and Erdogan (1972) runs to these ends as well.
    assert interface_singularity(layer, Strip(1e-12, 0.25, 1.0)) > 0.99
    orders = [interface_singularity(layer, Strip(modulus, 0.25, 1.0)) for modulus in np.geomspace(0.02, 200, 9)]
    assert (np.diff(orders) < 0).all()
    assert dundurs(Strip(1e12, 0.25, 1.0), layer)[0] == pytest.approx(1.0)
    first, second = Strip(3.0, 0.2, 1.0), Strip(1.0, 0.4, 1.0)
    np.testing.assert_allclose(dundurs(first, second), -np.array(dundurs(second, first)))


@pytest.mark.parametrize(
    ("degrees", "first", "second"),
    # From the edge's normal, under tension along the edge: Murakami (1987), Stress Intensity Factors Handbook, 3.4.
    # At 60° the 0.473 and 0.333 that stood here were met by a rule of 32 points only: that rule, whose error falls
    # with the square of the points, goes to 0.4625, and this one has 0.46243 with 24 points and with 96. The finite
    # elements of edge_crack_fe.py have 0.452 and 0.335 there, and 0.697 for 0.705 at 45°.
    [(15, 1.068, 0.174), (30, 0.920, 0.306), (45, 0.705, 0.364), (60, 0.462, 0.336)],
)
def test_leaning_edge_crack(degrees, first, second):
    angle = math.radians(degrees)
    faces = crack_faces(HALF_PLANE, straight((math.sin(angle), math.cos(angle))), 0.03)
    normal, shear = faces.normal[0] ** 2, faces.normal[0] * faces.tangent[0]
    # Three digits are printed.
    np.testing.assert_allclose(np.abs(intensity(faces, normal, shear)), [first, second], rtol=5e-3)


def test_layers_of_one_material_are_a_half_plane():
    whole = crack_faces(HALF_PLANE, straight(DOWN), 0.8)
    strips = (Strip(1.0, 0.3, 1.0), Strip(1.0, 0.3, 0.5), Strip(1.0, 0.3, math.inf))
    cut = crack_faces(Section(strips), straight(DOWN), 0.8)
    np.testing.assert_allclose(cut.plane, whole.plane, rtol=0, atol=2e-6 * np.abs(whole.plane).max())
    np.testing.assert_allclose(cut.antiplane, whole.antiplane, rtol=0, atol=2e-6 * np.abs(whole.antiplane).max())


def test_band_crack_from_below_is_an_edge_crack_upside_down():
    # A layer between next to nothing: from its bottom as from its top.
    nothing = Strip(1e-16, 0.3, 1.0)
    band = Section((nothing, Strip(1.0, 0.3, 1.0), Strip(1e-16, 0.3, math.inf)), layer=1)
    up = crack_faces(band, straight((0.0, -1.0), (0.0, 1.0)), 0.3)
    assert intensity(up, np.ones_like(up.z))[0] == pytest.approx(1.6599, rel=1e-4)
    assert up.antiplane.sum() / math.sqrt(0.3 * math.pi) == pytest.approx(
        math.sqrt(2 / (math.pi * 0.3) * math.tan(math.pi * 0.15)), rel=1e-3
    )


def edge_stress(section, source, point):
    """Of the plane, its images and the layers: what the faces take apart for their quadratures."""
    parts = edge_images(section, source, point), edge_layers(section, source, point)
    return edge_in_the_plane(source, point) + sum(parts)


def screw_stress(section, source, point):
    parts = screw_images(section, source, point), screw_layers(section, source, point)
    return screw_in_the_plane(source, point) + sum(parts)


def test_boundaries_are_free_bonded_or_slide():
    strips = (Strip(3.0, 0.35, 1.0, slip=math.inf), Strip(1.0, 0.3, 0.7), Strip(0.2, 0.4, math.inf))
    x, z = np.array([0.1, 0.4, -0.6]), np.array([0.2, 0.5, 0.9])
    top = edge_stress(Section(strips), (x[:1] * 0, z[1:2]), (x, 0 * z))
    scale = np.abs(edge_stress(Section(strips), (x[:1] * 0, z[1:2]), (x, z))).max()
    assert np.abs(top[1:]).max() < 1e-7 * scale, "no traction on the surface"
    slid = edge_stress(Section(strips), (x[:1] * 0, z[1:2]), (x, 0 * z + 1.0))
    assert np.abs(slid[2]).max() < 1e-5 * scale, "no shear where the interface is frictionless"
    bonded = (Strip(3.0, 0.35, 1.0), *strips[1:])
    there = edge_stress(Section(bonded), (x[:1] * 0, z[1:2]), (x, 0 * z + 1.0))
    assert np.abs(there[2]).max() > 1e-2 * scale
    screw = screw_stress(Section(bonded), (x[:1] * 0, z[1:2]), (x, 0 * z))
    assert np.abs(screw[1]).max() < 1e-7, "no shear out of the plane on the surface"


@pytest.mark.parametrize("row", FINITE_ELEMENTS["layers"], ids=str)
def test_layers_against_finite_elements(row):
    strips = (Strip(1.0, 0.3, row["thickness"]), Strip(row["below"], 0.3, math.inf))
    faces = crack_faces(Section(strips), straight(DOWN), 1.0)
    one, none = np.ones_like(faces.z), np.zeros_like(faces.z)
    normal, shear = {"normal": (one, none), "shear": (none, one), "ramp": (faces.z, none)}[row["load"]]
    found = faces.plane @ np.concatenate([normal, shear])
    np.testing.assert_allclose(found, row["k"], atol=0.02 * np.abs(row["k"]).max())


def of_surface_load(row, points=48):
    """Faces and tractions (3, n) of a case of the finite elements, by line loads of Flamant."""
    angle = math.radians(row["degrees"])
    faces = crack_faces(HALF_PLANE, straight((math.sin(angle), math.cos(angle))), 1 / math.cos(angle), points)
    # Flamant's line loads, integrated over narrow strips of uniform pressure.
    edge = np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 181))
    if row["shape"] == "hertz":
        area = 0.5 * (edge * np.sqrt(1 - edge**2) + np.arcsin(edge))
        pressure = 4 / np.pi * np.diff(area) / np.diff(edge)
    else:
        pressure = np.ones(180)
    u, z = faces.x[:, None] - row["centre"] - row["half"] * edge, faces.z[:, None]
    turn, part, square = np.arctan2(u, z), u * z / (u**2 + z**2), u**2 + z**2
    alike = z**2 / square
    whole = [
        (turn - part + row["shear"] * (np.log(square) + alike)),
        (turn + part - row["shear"] * alike),
        (-alike + row["shear"] * (turn - part)),
    ]
    xx, zz, xz = ((np.diff(one, axis=1) * pressure).sum(axis=1) / np.pi for one in whole)
    n, t = faces.normal, faces.tangent
    normal = xx * n[0] ** 2 + zz * n[1] ** 2 + 2 * xz * n[0] * n[1]
    shear = xx * n[0] * t[0] + zz * n[1] * t[1] + xz * (n[0] * t[1] + n[1] * t[0])
    return faces, np.stack([normal, shear, 0 * shear])


@pytest.mark.parametrize("degrees", [0.0, 30.0])
@pytest.mark.parametrize("shape", ["hertz", "strip"])
def test_moving_load_against_finite_elements(shape, degrees):
    rows = [row for row in FINITE_ELEMENTS["surface"] if (row["shape"], row["degrees"]) == (shape, degrees)]
    found, told = [], []
    for row in rows:
        faces, traction = of_surface_load(row)
        found.append(faces.plane @ traction[:2].ravel())
        told.append(row["k"])
    # 2 % of the largest over the passage.
    for mode in range(2):
        np.testing.assert_allclose(
            np.array(found)[:, mode], np.array(told)[:, mode], atol=0.02 * np.abs(np.array(told)[:, mode]).max()
        )


def test_closed_faces_against_finite_elements():
    found, told = [], []
    for row in FINITE_ELEMENTS["closed"]:
        faces, traction = of_surface_load(row)
        found.append(stress_intensity(faces, traction, row["friction"])[0][:2])
        told.append(row["k"])
    found, told = np.array(found), np.array(told)
    np.testing.assert_allclose(found, told, atol=0.02 * np.abs(told).max())
    # Both where faces touch over a part and where they do all over.
    assert (found[:, 0] == 0).any()
    assert (found[:, 0] > 0).any()


def test_compression_opens_nothing_and_friction_holds():
    faces = crack_faces(HALF_PLANE, straight(DOWN), 0.03, 20)
    one = np.ones_like(faces.z)
    squeezed = np.stack([-2 * one, 0.5 * one, 0.3 * one])
    free, rubbed, stuck = (stress_intensity(faces, squeezed, mu)[0] for mu in (0.0, 0.2, 0.4))
    assert free[0] == rubbed[0] == stuck[0] == 0
    root = math.sqrt(math.pi * 0.03)
    # All of the pressure, 2, rubs: what is left of the shear (0.5, 0.3), 0.583 in size, after 0.4.
    left = 1 - 0.4 / math.hypot(0.5, 0.3)
    np.testing.assert_allclose(free[1:], [1.1201 * 0.5 * root, 0.3 * root], rtol=2e-3)
    np.testing.assert_allclose(rubbed[1:], left * free[1:], rtol=1e-6)
    # 0.8 would hold more than there is.
    np.testing.assert_allclose(stuck[1:], 0.0, atol=1e-9 * root)


def test_partly_closed_faces_do_not_pass_through_each_other():
    faces = crack_faces(HALF_PLANE, straight(DOWN), 0.03, 24)
    n, u = 24, faces.z / 0.03
    traction = np.stack([1 - 3 * u, -0.4 + u, np.cos(7 * u), -np.cos(7 * u)])
    G = faces.opening[:n, :n]
    pressure = -bounded(G, traction, np.full_like(traction, -np.inf), np.zeros_like(traction))
    opening = (traction + pressure) @ G.T
    size = np.abs(opening).max()
    assert (pressure >= 0).all()
    assert opening.min() > -1e-9 * size
    assert np.abs(pressure * opening).max() < 1e-9 * size
    assert ((pressure > 0).any(axis=1) & (opening > 1e-6 * size).any(axis=1)).all(), "partly open, each of them"


def test_closure_within_bounds():
    G = np.array([[2.0, 0.5], [0.5, 1.0]])
    low, high = np.array([[-1.0, -1.0]]), np.array([[1.0, 1.0]])
    np.testing.assert_allclose(bounded(G, np.array([[2.0, -3.0]]), low, high), [[1.0, -1.0]])
    # The first slips, which moves the second until its bound holds it: 0.5 (3 - 1) + 1 (0.2 - f) = 0 would need 1.2.
    np.testing.assert_allclose(bounded(G, np.array([[3.0, 0.2]]), low, high), [[1.0, 1.0]])
    np.testing.assert_allclose(bounded(G, np.array([[1.5, 0.2]]), low, high), [[1.0, 0.45]])


def test_rows_that_go_round_are_finished_one_by_one(monkeypatch):
    faces = crack_faces(HALF_PLANE, straight(DOWN), 0.03, 12)
    G = faces.opening[:12, :12]
    traction = np.random.default_rng(5).normal(size=(6, 12))
    low, high = np.full_like(traction, -0.6), np.full_like(traction, 0.6)
    expected = bounded(G, traction, low, high)
    monkeypatch.setattr(closure, "_STEPS", 0)
    np.testing.assert_allclose(bounded(G, traction, low, high), expected, atol=1e-6)
