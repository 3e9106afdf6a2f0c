"""Rubber on texture as a result, its effective friction, and the enveloped pressure of a contact."""

import numpy as np
import pytest

import treadload as tl
from treadload.contact import envelop, solve_texture
from treadload.contact.rough import _touching
from treadload.errors import InputError
from treadload.pavement import texture as tx

RUBBER = tl.Elastic(6e6, 0.5)
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
PATCH = tx.self_affine(0.05, 0.05 / 64, hurst=0.8, shortest=4e-3, roll_off=0.0125, rms_height=2e-4, seed=1)
LOADS = [5e4, 2e5, 8e5]


def bumps():
    """A ball on bumps of 12 mm."""
    at = 2e-3 * (np.arange(81) - 40)
    ball = tl.Tire.from_height_map((at[None] ** 2 + at[:, None] ** 2) / 0.4, 2e-3, material=tl.Elastic(3e6, 0.5))
    wave = tx.Texture(
        3e-4 * np.cos(2 * np.pi * np.arange(24) / 12)[None] * np.cos(2 * np.pi * np.arange(24) / 12)[:, None],
        1e-3, 1e-3, periodic=True, shortest=12e-3,
    )  # fmt: skip
    return tl.solve_contact(ball, ROAD, tl.Rolling(normal_load=400, tractive_force=60, friction=0.7), relief=wave)


@pytest.fixture(scope="module")
def rough():
    return solve_texture(PATCH, RUBBER, LOADS)


@pytest.fixture(scope="module")
def contact():
    return bumps()


def test_pressure_carries_the_mean(rough):
    data = rough.dataset
    assert float(data.pressure.mean()) == pytest.approx(float(data.reference_pressure), rel=1e-9)
    assert float(data.reference_pressure) == 2e5
    assert (np.diff(data.real_area_ratio) > 0).all()
    assert (np.diff(data.mean_gap) < 0).all()


def test_shares_of_load_and_area(rough):
    data = rough.dataset
    # All of the load lies above zero, and nothing above the largest of all.
    np.testing.assert_allclose(data.load_share_above[:, 0], 1.0)
    assert float(data.load_share_above[-1, -1]) == 0
    assert (np.diff(data.load_share_above, axis=1) <= 0).all()
    half = data.isel(mean_pressure=1)
    p = data.pressure.to_numpy()
    level = float(data.local_pressure[30])
    assert float(half.load_share_above[30]) == pytest.approx(p[p > level].sum() / p.sum())
    assert float(half.area_share_above[30]) == pytest.approx((p > level).mean())


def test_the_rim_of_a_contact_counts_as_in_tamaas():
    # tamaas 2.9.0: Statistics2D.contact(tractions, perimeter=40) of 10 x 10 cells in 64 x 64.
    touches = np.zeros((64, 64), dtype=bool)
    touches[10:20, 10:20] = True
    assert _touching(touches, mirrored=False) == pytest.approx(0.023260603908630478, rel=1e-14)


def test_area_ratio_is_read_along_the_curve(rough):
    ratio = rough.dataset.real_area_ratio.to_numpy()
    np.testing.assert_allclose(rough.area_ratio([0.0, 2.5e4, 5e4, 8e5]), [0.0, ratio[0] / 2, ratio[0], ratio[2]])
    with pytest.raises(InputError, match="solved up to 800 kPa, and 900 kPa is asked for"):
        rough.area_ratio([9e5])


def test_friction_law_is_strength_on_the_real_area(rough):
    law = rough.friction_law(1.5e6)
    p = np.array(LOADS)
    exact = 1.5e6 * rough.dataset.real_area_ratio.to_numpy() / p
    fitted = np.minimum(law.reference * (p / law.reference_pressure) ** -law.exponent, law.upper)
    # A power law through three points of a curve that bends down.
    np.testing.assert_allclose(fitted, exact, rtol=0.1)
    wheel = tl.Rolling(normal_load=300, friction=law)
    assert wheel.law is law


def test_rubber_is_read_at_its_frequency():
    soft = tl.materials.Prony(60e6, [(0.9, 1e-4)], 0.5)
    slow, fast = (solve_texture(PATCH, soft, [2e5], speed=v, wave=0.01) for v in (1e-4, 1e3))
    assert slow.dataset.attrs["modulus"] == pytest.approx(6e6, rel=1e-3)
    assert fast.dataset.attrs["modulus"] == pytest.approx(60e6, rel=1e-3)
    elastic = solve_texture(PATCH, RUBBER, [2e5])
    np.testing.assert_allclose(slow.dataset.real_area_ratio, elastic.dataset.real_area_ratio, rtol=1e-2)
    assert "at 0.01 Hz" in slow.dataset.attrs["rubber"]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"texture": tx.Texture([[0.0, np.nan]], 1e-3, 1e-3)}, "1 of 2 are not known"),
        ({"texture": tx.Texture([[1e-3] * 4], 1e-3, 1e-3)}, "the texture is flat"),
        ({"pressures": [0.0]}, "numbers of Pa above 0"),
        ({"pressures": [1e5], "reference": 2e5}, "reference must be one of the pressures"),
        ({"rubber": tl.materials.Prony(6e6, [(0.5, 1.0)], 0.5)}, "needs speed in m/s"),
        ({"rubber": 6e6}, "rubber must be an Elastic or a Prony"),
        ({"thickness": 0.0}, "thickness of the tread"),
        ({"tolerance": 1.0}, "tolerance must lie in"),
    ],
)
def test_questions_are_checked(change, told):
    asked = {"texture": PATCH, "rubber": RUBBER, "pressures": LOADS, **change}
    with pytest.raises(InputError, match=told):
        solve_texture(asked.pop("texture"), asked.pop("rubber"), asked.pop("pressures"), **asked)


def test_caveats_are_said():
    steep = tx.Texture(8 * PATCH.heights[:1], PATCH.dx, PATCH.dy, periodic=True)
    said = " ".join(solve_texture(steep, RUBBER, [5e6]).warnings)
    for told in ("rms slope of", "may not stand for the road" if steep.length < 6 * steep.mean_wave else "profile",
                 "ridges across", "above the modulus of the rubber"):  # fmt: skip
        assert told in said
    assert "lies above" not in " ".join(solve_texture(PATCH, RUBBER, [1e4]).warnings)


def test_a_wheel_tells_how_much_of_it_touches(contact):
    found = solve_texture(PATCH, RUBBER, contact)
    p = contact.dataset.pressure.to_numpy()
    ratio = found.area_ratio(p)
    assert float(found.dataset.real_area) == pytest.approx(float(ratio.sum()) * contact.cell_area)
    assert float(found.dataset.contact_area) == pytest.approx(contact.area)
    assert 0 < float(found.dataset.real_area / found.dataset.contact_area) < 1
    assert "real contact area" in found.summary()


@pytest.mark.parametrize("length", [5e-3, 12e-3, 30e-3])
def test_enveloping_keeps_load_forces_and_middle(contact, length):
    after, before = envelop(contact, length).dataset, contact.dataset
    cells = [float(d.attrs["dx"] * d.attrs["dy"]) for d in (before, after)]
    for name in ("pressure", "traction_x", "traction_y"):
        one, two = (float(d[name].sum()) * cell for d, cell in zip((before, after), cells, strict=True))
        assert two == pytest.approx(one, rel=1e-12, abs=1e-10)
        for axis in ("x", "y"):
            arms = [float((d[name] * d[axis]).sum()) * cell for d, cell in zip((before, after), cells, strict=True)]
            assert arms[1] == pytest.approx(arms[0], abs=1e-9)
    assert float(after.pressure.min()) >= 0
    assert float(after.pressure.max()) < float(before.pressure.max())


def test_enveloping_halves_its_wave_and_leaves_long_ones():
    n, step, length = 400, 1e-3, 20e-3
    x = step * (np.arange(n) - n // 2)
    for wave, left in ((20e-3, 0.5), (100e-3, 0.5 ** (1 / 25))):
        contact = bumps()
        pressure = np.tile(1 + np.cos(2 * np.pi * x / wave), (n, 1))
        data = contact.dataset.isel(x=[0] * n, y=[0] * n).assign_coords(x=x, y=x)
        nothing = {name: 0 * data[name] for name in ("traction_x", "traction_y")}
        data = data.assign(pressure=(("y", "x"), pressure), **nothing)
        found = envelop(
            type(contact)(data.assign_attrs(dx=step, dy=step), contact.tire, ROAD, contact.rolling), length
        )
        line = found.dataset.pressure.sel(y=0, method="nearest")
        middle = line.where(np.abs(line.x) < wave, drop=True)
        amplitude = 0.5 * float(middle.max() - middle.min())
        # Means over cells of an eighth of the length take sinc(1/8 of it) more.
        cells = np.sinc(float(found.dataset.attrs["dx"]) / wave)
        assert amplitude == pytest.approx(left * cells, rel=0.03)


def test_deep_down_the_road_does_not_feel_enveloping(contact):
    deep, at = 24e-3, np.linspace(-0.03, 0.03, 5)
    after = envelop(contact, 12e-3)
    one, two = (
        tl.solve_response(load, ROAD, depths=[deep], x=at, y=[0.0]).dataset.stress_zz.to_numpy()
        for load in (contact, after)
    )
    # Half the depth: its spread adds (σ/z)² = 0.9 % of the curvature, σ = 0.19 of the length.
    assert np.abs(two - one).max() < 0.03 * np.abs(one).max()
    # While near the surface the peaks are gone.
    near = [float(d.pressure.max()) for d in (contact.dataset, after.dataset)]
    assert near[1] < 0.8 * near[0]


def test_enveloping_is_checked(contact):
    with pytest.raises(InputError, match="less than two cells of 2 mm"):
        envelop(contact, 3e-3)


def test_cells_too_coarse_for_the_texture_are_told():
    at = 4e-3 * (np.arange(41) - 20)
    ball = tl.Tire.from_height_map((at[None] ** 2 + at[:, None] ** 2) / 0.4, 4e-3, material=tl.Elastic(3e6, 0.5))
    wheel = tl.Rolling(normal_load=200, friction=0.7)
    said = " ".join(tl.solve_contact(ball, ROAD, wheel, relief=PATCH).warnings)
    assert "has waves down to 4.17 mm and the cells are 4 mm: its peaks are cut off" in said
    coarse = tx.Texture(1e-4 * np.cos(np.arange(40) * np.pi / 4)[None] * np.ones((40, 1)), 10e-3, 10e-3)
    with pytest.raises(InputError, match=r"points every 10 mm, and the cells of the contact are 4 mm: what lies"):
        tl.solve_contact(ball, ROAD, wheel, relief=coarse)
    with pytest.raises(InputError, match=r"points every 10 mm, and the cells of the contact are 4 mm: what lies"):
        tl.contact.cross_obstacle(ball, ROAD, tl.Rolling(normal_load=200, friction=0.0), coarse, positions=[0.0])
    holes = tx.Texture(np.where(np.eye(40) > 0, np.nan, 0.0), 10e-3, 10e-3)
    with pytest.raises(InputError, match="40 of 1600 are not known"):
        tl.solve_contact(ball, ROAD, wheel, relief=holes)
