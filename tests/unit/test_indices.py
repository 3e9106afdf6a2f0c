"""Indices of rutting near the surface, ravelling and polishing, beside what is known by hand."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.damage import asphalt_rut, distortion_work, polishing_work, tearing_work
from treadload.damage.indices import depth_factor
from treadload.errors import InputError

ROAD = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=35)
HALF = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


@pytest.fixture(scope="module")
def contact():
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    wheel = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
    return tl.solve_contact(tire, HALF, wheel, spacing=12e-3)


def test_the_work_of_polishing_is_all_that_the_wheel_loses_by_sliding(contact):
    work = polishing_work(contact)
    assert work.attrs["units"] == "J/m^2"
    width = float(work.y[1] - work.y[0])
    assert float(work.sum()) * width == pytest.approx(float(contact.dataset.friction_work_total), rel=1e-12)
    with pytest.raises(InputError, match="needs friction_work, which the contact lacks"):
        polishing_work(SimpleNamespace(dataset=contact.dataset.drop_vars("friction_work")))


def test_the_work_of_tearing_is_that_of_shear_in_a_skin(contact):
    data = contact.dataset
    shear = np.hypot(data.traction_x, data.traction_y).max("x")
    np.testing.assert_allclose(tearing_work(contact, 2e9), shear**2 * 1e-3 / 4e9, rtol=1e-12)
    # Soft mixes take more of it, deep texture too.
    twice = tearing_work(contact, 1e9, texture_depth=2e-3)
    np.testing.assert_allclose(twice, 4 * tearing_work(contact, 2e9), rtol=1e-12)
    with pytest.raises(InputError, match=r"texture_depth must be in m, at most 0\.02, got 1"):
        tearing_work(contact, 2e9, texture_depth=1.0)


def response(depths, strain=2e-4):
    """A uniform state: vertical compression, and a distortion energy of stress and strain alike in size."""
    at = {"depth": depths, "y": [-0.1, 0.0, 0.1], "x": [-0.1, 0.0, 0.1]}
    zero = np.zeros((len(depths), 3, 3))
    fields = {
        f"{kind}_{name}": zero for kind in ("stress", "strain") for name in ("xx", "yy", "zz", "xy", "xz", "yz")
    }
    fields |= {"strain_zz": zero - strain, "stress_xz": zero + 1e5, "strain_xz": zero + 1e-4}
    return SimpleNamespace(dataset=xr.Dataset({k: (("depth", "y", "x"), v) for k, v in fields.items()}, at))


def test_the_energy_of_a_layer_is_its_integral_over_the_depth():
    # ½ s:e of a shear: 1e5 · 1e-4, both of xz and zx; the vertical strain has no stress to work with.
    uniform = distortion_work(response(np.linspace(0.0, 0.21, 22)), ROAD)
    assert uniform.dims == ("layer", "y")
    np.testing.assert_allclose(uniform[0], 10.0 * 0.06, rtol=1e-12)
    np.testing.assert_allclose(uniform[1], 10.0 * 0.14, rtol=1e-12)  # from 70 to 210 mm
    assert np.isnan(uniform[2]).all()


def test_the_rut_of_asphalt_is_the_guides_sum():
    depths = np.linspace(0.0, 0.21, 211)
    found = asphalt_rut(response(depths), ROAD, 35.0, 1e6, thickness=0.21)
    h, z = 0.21 / 0.0254, depths / 0.0254
    k = (-0.1039 * h**2 + 2.4868 * h - 17.342 + (0.0172 * h**2 - 1.7331 * h + 27.428) * z) * 0.328196**z
    ratio = 10**-3.35412 * 95.0**1.5606 * 1e6**0.4791
    np.testing.assert_allclose(found, np.trapezoid(2e-4 * np.maximum(k, 0) * ratio, depths), rtol=1e-12)
    # Some millimetres after a million passes of a truck's wheel on a warm road.
    assert 1e-3 < float(found[0]) < 0.1
    assert float(asphalt_rut(response(depths), ROAD, 35.0, 4e6, thickness=0.21)[0] / found[0]) == pytest.approx(
        4**0.4791, rel=1e-12
    )
    assert "read in a public program, not in a document" in json.loads(found.attrs["warnings"])[0]
    # The factor is largest an inch or two down and fades with depth.
    fine = np.linspace(0.0, 0.21, 400)
    assert 0.01 < fine[int(depth_factor(fine, 0.21).argmax())] < 0.05
    with pytest.raises(InputError, match="needs the response at 3 depths or more in the 210 mm of asphalt, got 2"):
        asphalt_rut(response(np.array([0.0, 0.1, 0.5])), ROAD, 35.0, 1e6, thickness=0.21)
    waiting = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    np.testing.assert_array_equal(asphalt_rut(response(depths), waiting, 35.0, 1e6), found)
    with pytest.raises(InputError, match="passes"):
        asphalt_rut(response(depths), ROAD, 35.0, 0.0, thickness=0.21)
    with pytest.raises(InputError, match=r"temperature must lie in \[5, 65\]"):
        asphalt_rut(response(depths), ROAD, 80.0, 1e6, thickness=0.21)
