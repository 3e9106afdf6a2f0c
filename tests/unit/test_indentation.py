"""A sphere pressed into a half-space that yields: beside Kogut and Etsion, and what is refused."""

import math

import numpy as np
import pytest

import treadload as tl
from axisymmetric import Plastic, press
from treadload.contact import indentation, load_steps, yielding
from treadload.errors import ConvergenceError
from treadload.materials import MohrCoulomb, Perzyna, VonMises

MODULUS, YIELD, POISSON, RADIUS = 1000.0, 2.0, 0.3, 100.0
# Kogut & Etsion (2002), J. Appl. Mech. 69, 657-662: first yield of a sphere pressed by a flat.
PEAK = (0.454 + 0.41 * POISSON) * 2.8 * YIELD
DEPTH = (math.pi * PEAK / (2 * MODULUS / (1 - POISSON**2))) ** 2 * RADIUS
LOAD = 2 / 3 * PEAK * math.pi * DEPTH * RADIUS
SOFT = tl.Elastic(MODULUS, POISSON)
ROAD = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, VonMises(YIELD, hardening=MODULUS / 1000)))
VISCOUS = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, Perzyna(MohrCoulomb(1, 0.5), 1.0)))


def pressed(multiples, n=32, layers=14, reach=1.35, road=ROAD, **more):
    """Under multiples of the load of first yield, on cells that hold the elastic contact `reach` times."""
    radius = math.sqrt(DEPTH * RADIUS) * max(multiples) ** (1 / 3)
    dx = 2 * reach * radius / n
    across = (np.arange(n) - (n - 1) / 2) * dx
    gap = (across[None] ** 2 + across[:, None] ** 2) / (2 * RADIUS)
    ball = tl.Tire.from_height_map(gap, dx, material=tl.Elastic(MODULUS * 1e6, 0.3))
    more = {"depth": 2.0 * radius, "layers": layers} | more
    return tl.contact.solve_indentation(ball, road, [one * LOAD for one in multiples], **more)


def kogut_etsion(depth):
    """Load over that of first yield at a depth over that of first yield; read in programs that use it."""
    return 1.03 * depth**1.425 if depth <= 6 else 1.40 * depth**1.263


def test_nothing_yields_below_the_load_of_first_yield_and_something_above():
    # p0 of Hertz goes with the cube root of the load: 1.60 and 1.65 Y.
    below, above = (pressed([(peak * YIELD / PEAK) ** 3], n=24, layers=10) for peak in (1.60, 1.66))
    assert not below.dataset.largest_plastic_strain.any()
    assert float(above.dataset.largest_plastic_strain[0]) > 0


def test_a_rigid_sphere_beside_kogut_and_etsion():
    done = pressed([1.5, 3.0, 5.0, 0.0], n=24, layers=10).dataset
    depth = done.approach.to_numpy()[:3] / DEPTH
    # Theirs are fits of finite elements, good to 2 or 3 %.
    for load, found in zip((1.5, 3.0, 5.0), depth, strict=True):
        assert kogut_etsion(found) == pytest.approx(load, rel=0.04)
    # Lifted, the dent stays, and unloading was elastic.
    assert float(done.pressure[3].max()) == 0
    assert float(done.largest_plastic_strain[3]) == pytest.approx(float(done.largest_plastic_strain[2]), rel=1e-6)
    dent = float(done.residual_displacement_z[3].max())
    assert 0.1 < dent / float(done.approach[2]) < 0.5
    # Equilibrium: the pressure carries the load.
    carried = done.pressure.sum(("y", "x")).to_numpy() * done.attrs["dx"] * done.attrs["dy"]
    np.testing.assert_allclose(carried, done.normal_load, rtol=1e-6, atol=1e-12)


@pytest.mark.slow
def test_a_rigid_sphere_up_to_twelve_times_the_load_and_the_depth_of_first_yield():
    loads = np.array([1.5, 3.0, 5.0, 8.0, 11.0, 12.0, 14.0, 20.0, 31.0])
    done = pressed(loads, n=36, reach=1.9, depth=None).dataset
    depth = done.approach.to_numpy() / DEPTH
    assert depth[-1] > 11.5
    errors = np.array([kogut_etsion(one) / load - 1 for one, load in zip(depth, loads, strict=True)])
    # Up to a depth of 6, 13 times the load, one formula holds; measured: 3 %.
    assert np.abs(errors[loads <= 12]).max() < 0.03
    # There theirs jumps by 1.7 % to the next, which is 4.7 % away just behind it and comes back.
    behind = (depth > 6) & (depth < 6.7)
    assert np.abs(errors[~behind]).max() < 0.04
    assert np.abs(errors[behind]).max() < 0.04 + 0.017


def first_yield(ratio, poisson, hardening):
    """Half-space of yield stress 1, and the load of its first yield under a sphere of `RADIUS`."""
    peak = (0.454 + 0.41 * poisson) * 2.8
    depth = (math.pi * peak * (1 - poisson**2) / (2 * ratio)) ** 2 * RADIUS
    law = VonMises(1.0, hardening=hardening * ratio)
    road = tl.Pavement.half_space(tl.materials.ElastoPlastic(tl.Elastic(ratio, poisson), law))
    return road, 2 / 3 * peak * math.pi * depth * RADIUS, math.sqrt(depth * RADIUS)


# Peak pressure over yield stress under multiples of the load of first yield, by finite elements of `axisymmetric`:
# 40 elements on 1.35 elastic radii, 30 and 60 load steps in geometric progression, extrapolated, as the error halves
# with the steps (2.2240 and 2.2179 in the first row); 20 elements instead of 40 change 0.1 %. Elements of others, of
# unknown steps, gave 2.418 and 2.169 in the two last rows.
ELEMENTS = [
    (7.35, (150.0, 0.40, 1 / 50), 2.2118),
    (7.35, (1000.0, 0.25, 0.0), 1.9870),
    (18.8, (150.0, 0.40, 1 / 50), 2.3960),
    (18.8, (1000.0, 0.25, 0.0), 2.1542),
]


def beside_elements(multiple, material, n, layers):
    road, load, radius = first_yield(*material)
    dx = 3.0 * radius * multiple ** (1 / 3) / n
    across = (np.arange(n) - (n - 1) / 2) * dx
    gap = (across[None] ** 2 + across[:, None] ** 2) / (2 * RADIUS)
    ball = tl.Tire.from_height_map(gap, dx, material=tl.Elastic(material[0] * 1e6, 0.3))
    return tl.contact.solve_indentation(ball, road, [multiple * load, 0.0], layers=layers)


def test_the_peak_pressure_of_one_load_needs_no_steps():
    multiple, material, peak = ELEMENTS[0]
    done = beside_elements(multiple, material, 24, 10)
    # In one jump it was 7.9 % too high. 1.2 % are measured, 0.4 % on 32 x 32 cells in 14 rows.
    assert float(done.dataset.peak_pressure[0]) == pytest.approx(peak, rel=0.02)
    error = done.dataset.peak_pressure_error.to_numpy() / float(done.dataset.peak_pressure[0])
    assert 0.001 < error[0] <= load_steps.STEP_ERROR
    # Lifted without yielding again: nothing is left to settle.
    assert error[1] == 0
    assert done.dataset.largest_plastic_strain_error.to_numpy().max() < 0.015 * 0.0088
    assert not done.warnings
    assert f"{100 * error[0]:.1f} % at most" in done.summary()


@pytest.mark.slow
@pytest.mark.parametrize(("multiple", "material", "peak"), ELEMENTS)
def test_peak_pressures_beside_finite_elements(multiple, material, peak):
    done = beside_elements(multiple, material, 32, 12).dataset
    assert float(done.peak_pressure[0]) == pytest.approx(peak, rel=0.02)
    if multiple > 10:
        # The peak is a ring, not the middle.
        row = done.pressure[0].to_numpy()[16]
        assert row.max() > 1.02 * row[16]


@pytest.mark.slow
def test_the_finite_elements_beside_hertz_and_on_fewer_steps():
    _, load, radius = first_yield(*ELEMENTS[0][1])
    soft = Plastic(150.0, 0.40, 1.0, 3.0)
    fine = 1.35 * radius * 7.35 ** (1 / 3)
    peaks = []
    for steps in (12, 24):
        loads = load * np.concatenate([[0.85], np.geomspace(0.85, 7.35, steps + 1)[1:]])
        results, _, _ = press(loads, RADIUS, soft, fine, 20, 0.9 * fine)
        peaks.append(results[-1].pressure.max())
    # Elastic at first: Hertz, whose peak and radius go with the cube root of the load; six elements.
    first, part = results[0].pressure, 0.85 ** (1 / 3)
    hertz = (0.454 + 0.41 * 0.40) * 2.8 * part * math.sqrt(1 - (fine / 20 / (part * radius)) ** 2)
    assert first[1] == pytest.approx(hertz, rel=0.02)
    assert not results[0].hardening.any()
    # The mean over the contact is the load.
    assert (first * results[0].areas).sum() == pytest.approx(loads[0], rel=1e-6)
    # Extrapolated from fewer steps on fewer elements: the rest of the extrapolation, 0.5 %.
    assert 2 * peaks[1] - peaks[0] == pytest.approx(ELEMENTS[0][2], rel=0.007)


def test_a_step_that_does_not_settle_is_halved(monkeypatch):
    whole = pressed([3.0], n=16, layers=6)
    reach = load_steps.Pressing._reach

    def restless(pressing, load, begin, count, name):
        if count < 4:
            raise ConvergenceError("it did not settle", 1.0)
        return reach(pressing, load, begin, count, name)

    monkeypatch.setattr(load_steps.Pressing, "_reach", restless)
    halved = pressed([3.0], n=16, layers=6)
    # What did not settle is no witness of an error: four parts need eight beside them.
    assert (whole.stats["substeps"], halved.stats["substeps"]) == (4, 8)
    # The way differs, and with it a little what yields.
    assert float(halved.dataset.approach[0]) == pytest.approx(float(whole.dataset.approach[0]), rel=2e-3)
    assert halved.dataset.normal_load.to_numpy() == pytest.approx([3.0 * LOAD])
    monkeypatch.setattr(load_steps, "_MOST_ROUNDS", 1)
    with pytest.raises(ConvergenceError, match=r"step 1 did not settle at \S+ N in 1 rounds: .*give loads"):
        pressed([3.0], n=16, layers=6)


def test_steps_that_stay_too_long_are_a_warning_with_the_number(monkeypatch):
    monkeypatch.setattr(load_steps, "_MOST_HALVINGS", 1)
    for module in (load_steps, indentation):
        monkeypatch.setattr(module, "STEP_ERROR", 1e-4)
    done = pressed([3.0], n=16, layers=6)
    assert done.stats["substeps"] == 4
    error = 100 * done.stats["step_error"]
    assert error > 0.01
    assert any(f"by {error:.1f} %, above 0.01 %" in text and "give loads between" in text for text in done.warnings)


@pytest.mark.parametrize(
    ("law", "loads"),
    [(VonMises(YIELD, hardening=1.0), [5.0, 0.0]), (MohrCoulomb(0.4, math.radians(35), 0.1), [5.0, 0.0])],
    ids=["von Mises", "Mohr-Coulomb"],
)
def test_what_is_known_of_the_zone_that_yields_does_not_change_what_yields(monkeypatch, law, loads):
    road = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, law))

    def solved(zone):
        monkeypatch.setattr(yielding.Ground, "zone", zone)
        return pressed(loads, n=24, layers=9, reach=1.9, depth=None, road=road)

    guess = yielding.Ground.zone
    all_of_it = solved(lambda ground, pressure: yielding.Zone((0, 0, 0), ground.shape))
    predicted = solved(guess)
    # From a few cells in the middle it grows until nothing yields at its border.
    grown = solved(lambda ground, pressure: yielding.Zone.around(np.zeros(ground.shape, bool)))
    assert predicted.stats["substeps"] == all_of_it.stats["substeps"] == grown.stats["substeps"]
    assert predicted.stats["rounds"] <= 1.1 * all_of_it.stats["rounds"] < 1.1 * grown.stats["rounds"]
    assert max(predicted.stats["memory_mb"], grown.stats["memory_mb"]) < 0.7 * all_of_it.stats["memory_mb"]
    for name in ("pressure", "residual_displacement_z", "equivalent_plastic_strain"):
        whole = all_of_it.dataset[name].to_numpy()
        for part in (predicted, grown):
            # Kernels of single precision, under transforms of other sizes.
            np.testing.assert_allclose(part.dataset[name], whole, rtol=0, atol=1e-5 * np.abs(whole).max())


@pytest.mark.slow
def test_finer_cells_change_the_depth_by_little():
    coarse, fine = (float(pressed([3.0], n=n, layers=rows).dataset.approach[0]) for n, rows in ((32, 14), (48, 18)))
    assert coarse == pytest.approx(fine, rel=0.003)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"multiples": [-1.0]}, "loads must be numbers >= 0 N with one above"),
        ({"multiples": [0.0]}, "loads must be numbers >= 0 N with one above"),
        ({"multiples": [5.0], "depth": 0.6}, "plastic zone reaches the depth of the box"),
        ({"multiples": [3.0], "layers": 1}, r"layers must be a whole number in \[2, 64\]"),
        ({"multiples": [3.0], "tolerance": 1.0}, r"tolerance must lie in \[1e-6, 0.1\]"),
        ({"multiples": [3.0], "road": tl.Pavement.half_space(SOFT)}, "needs a half-space that yields"),
        ({"multiples": [3.0], "road": VISCOUS}, "Perzyna follows time or passes"),
    ],
)
def test_what_cannot_be_pressed_is_refused_in_a_sentence(change, words):
    asked = {"n": 16, "layers": 5} | change
    if max(asked["multiples"]) <= 0:
        ball = tl.Tire.from_height_map(np.ones((9, 9)), 1.0, material=tl.Elastic(1e9, 0.3))
        with pytest.raises(tl.InputError, match=words):
            tl.contact.solve_indentation(ball, ROAD, asked["multiples"])
        return
    with pytest.raises(tl.InputError, match=words) as caught:
        pressed(**asked)
    assert len(str(caught.value).splitlines()) == 1
