"""Passes over a road that yields: steady states, verdicts, what is refused, and what a file keeps."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.describing import verdict_of
from treadload.kernels.eigenstrain.operator import moved_by_endless
from treadload.materials import MohrCoulomb, PassesPowerLaw, Perzyna, VonMises
from treadload.response.passes import verdict
from treadload.response.passes.box import Box, courses, row_edges
from treadload.response.passes.counts import reported_counts
from treadload.response.passes.melan import enclosing
from treadload.response.passes.surface import surface_profile
from treadload.response.passes.verdict import in_words, judged, still_falls

SOFT = tl.Elastic(600e6, 0.35)
YIELDING = tl.materials.ElastoPlastic(SOFT, VonMises(0.4e6, kinematic=60e6))
ROAD = tl.Pavement.half_space(YIELDING)
DISC = tl.UniformDisc(0.1, 0.8e6)
COARSE = {"spacing": 0.025, "layers": 7}


@pytest.fixture(scope="module")
def yielded():
    return tl.response.roll_passes(DISC, ROAD, passes=3, **COARSE)


def test_a_load_below_first_yield_leaves_nothing():
    weak = tl.response.roll_passes(tl.UniformDisc(0.1, 0.3e6), ROAD, passes=5, **COARSE)
    assert weak.verdict == "elastic"
    assert not weak.dataset.equivalent_plastic_strain.any()
    assert not weak.dataset.residual_displacement_z.any()
    assert weak.dataset.attrs["elastic_load_factor"] > 1
    assert verdict_of(weak) == "after 5 pass(es): elastic"


def test_first_yield_is_where_the_elastic_road_says(yielded):
    factor = yielded.dataset.attrs["elastic_load_factor"]
    below, above = (
        tl.response.roll_passes(tl.UniformDisc(0.1, part * factor * 0.8e6), ROAD, passes=1, **COARSE)
        for part in (0.9, 1.1)
    )
    assert below.verdict == "elastic"
    assert above.dataset.plastic_increment[0] > 0


def test_what_a_pass_leaves_is_a_rut_that_earlier_passes_brake(yielded):
    data = yielded.dataset
    # The material sinks under the wheel and keeps its volume, so that it heaves beside it.
    assert float(data.rut_depth[0]) > 0
    rising = data.rut_depth.to_numpy()
    assert (np.diff(rising) > 0).all()
    assert data.plastic_increment[2] < data.plastic_increment[1] < data.plastic_increment[0]
    # Von Mises' flow keeps the volume.
    volume = sum(data[f"plastic_strain_{c}"] for c in ("xx", "yy", "zz"))
    assert np.abs(volume).max() < 1e-12
    # A wheel in the middle leaves what is even in y, and its surface free of traction.
    middle = data.residual_stress_xx[2].to_numpy()
    np.testing.assert_allclose(middle, middle[:, ::-1], atol=2e-3 * np.abs(middle).max())


def test_residual_stress_balances(yielded):
    # Across any vertical plane that holds the track the residual stress σ_yy sums up to nothing: the road pushes
    # itself only. Rows end above where it fades, so that a part of it stays below.
    data = yielded.dataset.isel({"pass": -1})
    thick = np.diff(yielded.dataset.attrs["row_edges"])
    pushed = (data.residual_stress_yy.to_numpy() * thick[:, None]).sum(axis=0)
    size = (np.abs(data.residual_stress_yy.to_numpy()) * thick[:, None]).sum(axis=0).max()
    assert np.abs(pushed).max() < 0.35 * size


def test_the_surface_of_a_half_space_is_that_of_endless_bars():
    box = Box(4, 16, 0.1, 0.1, 0.0, -0.75, np.array([0, 0.1, 0.25, 0.5]))
    strain = np.random.default_rng(1).standard_normal((6, 3, 16))
    bars = moved_by_endless(box.cells, 0.35)(strain[..., None])[2, 0, :, 0]
    layers = tl.Pavement([tl.Layer(SOFT, 0.2), tl.Layer(tl.Elastic(600e6 * (1 + 1e-9), 0.35))])
    for road in (ROAD, layers):
        # Waves of two equal layers are those of their half-space, to round-off of long waves.
        np.testing.assert_allclose(surface_profile(strain, box, road, box.y), bars, atol=1e-7 * np.abs(bars).max())


@pytest.mark.slow
def test_the_rut_on_layers_is_that_of_bettis_long_load():
    box = Box(4, 12, 0.1, 0.1, 0.0, -0.55, np.linspace(0, 0.5, 21))
    shape = np.exp(-((box.y / 0.3) ** 2)) * np.exp(-(((box.depths - 0.2) / 0.15) ** 2))[:, None]
    strain = np.stack([0.3 * shape, 0.7 * shape, -shape, 0 * shape, 0 * shape, 0.2 * shape * box.y])
    road = tl.Pavement([tl.Layer(tl.Elastic(1e9, 0.35), 0.6), tl.Layer(tl.Elastic(3e8, 0.4))])
    offsets = np.arange(-11, 12) * 0.1
    load = tl.UniformRectangle(1000.0, 0.1, 10.0)
    data = tl.solve_response(load, road, depths=box.depths, x=[0.0], y=offsets).dataset
    stress = np.stack([data[f"stress_{c}"].to_numpy()[:, :, 0] for c in ("xx", "yy", "zz", "xy", "xz", "yz")])
    weights = np.array([1, 1, 1, 2, 2, 2])[:, None, None] * np.diff(box.edges)[:, None] * 0.1
    betti = [(weights * strain * stress[:, :, 11 - k : 23 - k]).sum() for k in range(12)]
    found = surface_profile(strain, box, road, box.y)
    # The load ends after 1 km, and stress is read at the middle of rows: 0.7 % with rows of 50 mm, a quarter here.
    np.testing.assert_allclose(found, betti, atol=4e-3 * np.abs(betti).max())


def test_a_slow_pass_of_a_viscous_road_leaves_more():
    law = Perzyna(MohrCoulomb(60e3, math.radians(35), math.radians(5)), fluidity=1e-3, exponent=2.0)
    road = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, law))
    fast, slow = (tl.response.roll_passes(DISC, road, passes=1, speed=v, **COARSE).dataset for v in (10.0, 1.0))
    # Ten times the time, in which the overstress relaxes a little.
    ratio = float(slow.plastic_increment[0] / fast.plastic_increment[0])
    assert 6 < ratio < 10
    with pytest.raises(tl.InputError, match="give the speed, m/s, > 0, got None"):
        tl.response.roll_passes(DISC, road)


def test_a_law_of_passes_counts_them_on_the_same_stress():
    law = PassesPowerLaw(0.8, 0.4791)
    road = tl.Pavement([tl.Layer(tl.materials.ElastoPlastic(SOFT, law), 0.1), tl.Layer(tl.Elastic(2e8, 0.35))])
    done = tl.response.roll_passes(DISC, road, passes=100_000, **COARSE)
    data = done.dataset
    assert list(data["pass"].to_numpy()[:5]) == [1, 2, 5, 10, 20]
    assert float(data["pass"][-1]) == 1e5
    # All of it grows with the power of the passes.
    np.testing.assert_allclose(data.rut_depth / data.rut_depth[0], data["pass"] ** 0.4791, rtol=1e-9)
    # Under the middle of the disc the stress keeps its axes: the vertical strain is the law's, q/E.
    stress = tl.solve_response(DISC, road, depths=[float(data.depth[2])], x=[0.0], y=[0.0]).dataset
    expected = 0.8 * float(stress.von_mises_stress[0, 0, 0]) / 600e6
    middle = data.isel({"pass": 0, "depth": 2}).sel(y=0.0, method="nearest")
    assert 0.5 < float(middle.equivalent_plastic_strain) / expected < 1.3
    assert list(reported_counts(7)) == [1, 2, 5, 7]


def test_wheels_that_wander_spread_the_rut():
    straight = tl.response.roll_passes(DISC, ROAD, passes=2, **COARSE).dataset
    beside = tl.response.roll_passes(DISC, ROAD, passes=2, offsets=[0.0, 0.05], **COARSE).dataset
    assert list(beside.wheel_offset) == pytest.approx([0.0, 0.05])
    # Beside its first line the wheel finds a road that has not hardened.
    assert float(beside.plastic_increment[1]) > 2 * float(straight.plastic_increment[1])

    # The second rut lies to the right.
    def centre(profile):
        part = np.clip(profile.to_numpy(), 0, None)
        return float((part * profile.across.to_numpy()).sum() / part.sum())

    assert centre(beside.residual_displacement_z[1]) > centre(straight.residual_displacement_z[1]) + 0.01
    spread = tl.response.roll_passes(DISC, ROAD, passes=3, wander=0.05, **COARSE).dataset
    assert len(set(spread.wheel_offset.to_numpy().round(6))) == 3


def test_only_layers_that_can_yield_do():
    road = tl.Pavement(
        [tl.Layer(tl.Elastic(2e9, 0.35), 0.05), tl.Layer(YIELDING, 0.1), tl.Layer(tl.Elastic(1e8, 0.35))]
    )
    done = tl.response.roll_passes(DISC, road, passes=1, **COARSE)
    assert float(done.dataset.attrs["row_edges"][0]) == pytest.approx(0.05)
    assert float(done.dataset.attrs["row_edges"][-1]) <= 0.15 + 1e-9
    assert any("half-space of the yielding material" in text for text in done.warnings)


def test_rows_end_at_interfaces():
    road = tl.Pavement([tl.Layer(YIELDING, 0.07), tl.Layer(YIELDING, 0.08), tl.Layer(YIELDING)])
    edges = row_edges(courses(road), 0.01, 0.3, 12)
    assert edges[0] == 0
    assert edges[-1] == pytest.approx(0.3)
    assert {0.07, 0.15} <= set(edges.round(12))
    assert (np.diff(edges) > 0).all()


def test_a_strain_above_five_per_cent_is_told():
    soft = tl.materials.ElastoPlastic(tl.Elastic(3e6, 0.35), VonMises(0.25e6, hardening=1e6))
    done = tl.response.roll_passes(DISC, tl.Pavement.half_space(soft), passes=1, **COARSE)
    assert any("above 5 %: strains are taken as small" in text for text in done.warnings)
    assert any(text in done.summary() for text in done.warnings)


@pytest.mark.slow
def test_a_road_that_does_not_come_to_rest_says_so_with_the_load_that_would(monkeypatch):
    perfect = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, VonMises(0.2e6)))
    # By means over cells every pass of this road settles, on 0.025 and 0.02 m as well: it yields as much each time
    # and is left with less and less.
    assert tl.response.roll_passes(DISC, perfect, passes=3, spacing=0.04, layers=5).verdict == "cyclic"
    with monkeypatch.context() as hasty:
        # Given up after three rounds it does not.
        hasty.setattr("treadload.response.passes.steady._PATIENCE", 3)
        hasty.setattr("treadload.response.passes.steady._FAR", 1e-9)
        done = tl.response.roll_passes(DISC, perfect, passes=3, spacing=0.04, layers=5)
    assert done.verdict == "ratchetting"
    (text,) = [text for text in done.warnings if "no steady state" in text]
    factor = done.dataset.attrs["shakedown_load_factor"]
    assert f"would shake down under {100 * factor:.0f} % of this load" in text
    assert done.dataset.attrs["elastic_load_factor"] <= factor < 1
    rest = tl.response.roll_passes(
        tl.UniformDisc(0.1, 0.8e6 * factor * 0.97), perfect, passes=8, spacing=0.04, layers=5
    )
    assert rest.verdict in ("elastic", "shakedown")


@pytest.mark.parametrize(
    ("added", "left", "verdict"),
    [
        ([0.0, 0.0], [0.0, 0.0], "elastic"),
        ([1e-3, 1e-4, 5e-6], [1e-3, 1e-4, 5e-6], "shakedown"),
        ([1e-3, 1e-3], [1e-3, 5e-5], "cyclic"),
        ([1e-3, 1e-3], [1e-3, 5e-4], "ratchetting"),
    ],
)
def test_the_criterion_of_the_verdict(added, left, verdict):
    assert judged(added, left, 1e-3) == verdict


def test_a_headline_says_that_passes_still_fall():
    """Four passes of a road on its way to rest are no verdict that it ratchets; a steady one is."""
    assert in_words("ratchetting", still_falls([4.0, 2.0, 1.0])) == (
        "ratchetting so far, not yet at rest: the last pass adds 50 % less than the one before"
    )
    assert in_words("ratchetting", still_falls([1.0, 1.0])) == "ratchetting"
    hardens = tl.materials.ElastoPlastic(SOFT, VonMises(0.2e6, hardening=SOFT.modulus / 5))
    done = tl.response.roll_passes(DISC, tl.Pavement.half_space(hardens), passes=2, spacing=0.04, layers=5)
    assert verdict_of(done).startswith("after 2 pass(es): ratchetting so far, not yet at rest: the last pass adds ")
    assert any("more passes may end in shakedown" in text for text in done.warnings)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"passes": 0}, "passes must be a whole number >= 1, got 0"),
        ({"passes": 2.5}, "passes must be a whole number >= 1"),
        ({"spacing": -1.0}, "spacing must be a positive number of metres"),
        ({"layers": 1}, r"layers must be a whole number in \[2, 64\], got 1"),
        ({"tolerance": 1.0}, r"tolerance must lie in \[1e-8, 0.1\]"),
        ({"offsets": [0.0], "wander": 0.1}, "give one of them"),
        ({"offsets": [math.nan]}, "offsets must be finite"),
        ({"depth": 0.06, **COARSE}, "the plastic zone reaches the depth of the box, 0.06 m"),
        ({"spacing": 0.0004}, r"needs \d+\.\d GB, above 1.5 GB; raise spacing"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(asked, words):
    with pytest.raises(tl.InputError, match=words) as caught:
        tl.response.roll_passes(DISC, ROAD, **asked)
    assert len(str(caught.value).splitlines()) == 1


def test_a_road_that_cannot_yield_is_refused():
    with pytest.raises(tl.InputError, match="no layer of this road can yield; give one of them an ElastoPlastic"):
        tl.response.roll_passes(DISC, tl.Pavement.half_space(SOFT))
    glue = tl.materials.Prony.standard_linear_solid(4e9, 3e9, 0.01, 0.35)
    with pytest.raises(tl.InputError, match=r"layer 'base' is .*give it an Elastic"):
        tl.response.roll_passes(DISC, tl.Pavement([tl.Layer(YIELDING, 0.1), tl.Layer(glue, name="base")]))
    both = tl.Pavement([tl.Layer(YIELDING, 0.1), tl.Layer(tl.materials.ElastoPlastic(SOFT, PassesPowerLaw(1, 0.5)))])
    with pytest.raises(tl.InputError, match="need a PassesPowerLaw, or none"):
        tl.response.roll_passes(DISC, both)


def test_a_file_holds_all_of_it(yielded, tmp_path):
    opened = tl.open_results(tl.save_results(yielded, tmp_path / "ruts.nc")).passes
    assert opened.summary() == yielded.summary()
    assert opened.road == ROAD
    again = tl.response.roll_passes(opened.loads[0], opened.road, passes=1, **COARSE)
    assert float(again.dataset.rut_depth[0]) == pytest.approx(float(yielded.dataset.rut_depth[0]), rel=1e-6)


CASE = """
title = "hot"
[[pavement.layers]]
name = "asphalt"
thickness = "80 mm"
material = { modulus = "600 MPa", poisson = 0.35 }
[pavement.layers.plasticity]
kind = "mohr-coulomb"
cohesion = "40 kPa"
friction_angle = "35 deg"
hardening = "20 MPa"
[[pavement.layers]]
material = { modulus = "300 MPa", poisson = 0.35 }
[footprint]
file = "print.csv"
spacing = "20 mm"
[passes]
count = 2
spacing = "25 mm"
layers = 5
"""


@pytest.fixture
def hot(tmp_path):
    pressure = np.zeros((11, 13))
    pressure[2:9, 2:11] = 0.8e6
    np.savetxt(tmp_path / "print.csv", pressure, delimiter=",")
    (tmp_path / "case.toml").write_text(CASE)
    return tl.Case.from_toml(tmp_path / "case.toml")


@pytest.mark.slow
def test_a_case_runs_its_passes_and_reports_them(hot, tmp_path, monkeypatch):
    result = tl.run(hot)
    assert "after 2 pass(es): " in result.summary()
    assert result.passes.dataset.sizes["pass"] == 2
    opened = tl.open_results(tl.save_results(result, tmp_path / "r.nc"))
    assert opened.passes.summary() == result.passes.summary()
    assert any("Dang Van" in text for text in opened.tree.attrs["citations"].split('", "'))
    monkeypatch.setattr("treadload.reporting.pictures.picture", lambda *_, **__: [])
    page = tl.report(opened, tmp_path / "r.html").read_text()
    assert "oad that yields" in page
    assert page.count("could not be drawn") == 0


def test_passes_of_a_case_need_a_layer_that_yields(hot):
    table = hot.as_tables()
    del table["pavement"]["layers"][0]["plasticity"]
    with pytest.raises(tl.InputError, match=r"\[passes\] need a layer that can yield"):
        tl.Case.from_dict(table, folder=hot.folder)
    table = hot.as_tables() | {"passes": {"count": 0}}
    with pytest.raises(tl.InputError, match="count must be >= 1, got 0"):
        tl.Case.from_dict(table, folder=hot.folder)


def test_the_smallest_balls_around_paths():
    # Of two points, and of the corners of a simplex in five dimensions beside points inside it.
    one = np.array([[[0.0, 0.0, 0.0], [1.0, 2.0, 2.0]]])
    assert enclosing(one) == pytest.approx(1.5, rel=1e-5)
    corners = np.eye(6) - 1 / 6
    inner = np.random.default_rng(2).dirichlet(np.ones(6), 30) @ corners
    assert enclosing(np.concatenate([inner, corners])[None]) == pytest.approx((5 / 6) ** 0.5, rel=1e-5)
    # The largest of many counts.
    assert enclosing(np.stack([0.5 * corners, corners, 0.9 * corners])) == pytest.approx((5 / 6) ** 0.5, rel=1e-5)


@pytest.mark.slow
def test_melans_limit_is_where_passes_come_to_rest(monkeypatch):
    load = tl.UniformRectangle(0.2, 0.2, 0.5e6)
    road = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, VonMises(2e5, kinematic=SOFT.modulus / 10)))

    def limit():
        return float(tl.life.shakedown_map(load, road, [0.2], spacing=0.04, layers=5).dataset.shakedown_load[0])

    direct = limit()
    monkeypatch.setattr(verdict, "unbounded", lambda law: False)
    # The search by passes is good to 3 % of what lies between 0.7 and 3 times the load of first yield.
    assert direct == pytest.approx(limit(), abs=0.1)


@pytest.mark.slow
def test_the_map_of_shakedown_falls_with_friction():
    load = tl.UniformRectangle(0.2, 0.2, 0.5e6)
    fields = tl.life.shakedown_map(load, ROAD, (0.0, 0.4), spacing=0.04, layers=5)
    data = fields.dataset
    # Both are over the load of first yield without shear.
    assert float(data.elastic_limit_load[0]) == 1.0
    assert (data.shakedown_load >= data.elastic_limit_load).all()
    assert float(data.shakedown_load[1]) < float(data.shakedown_load[0])
    assert tl.plots.shakedown_map(fields).axes
    with pytest.raises(tl.InputError, match="a disc carries no shear"):
        tl.life.shakedown_map(DISC, ROAD)
    viscous = tl.Pavement.half_space(tl.materials.ElastoPlastic(SOFT, Perzyna(VonMises(1e5), 1.0)))
    with pytest.raises(tl.InputError, match="Perzyna yields under every load"):
        tl.life.shakedown_map(load, viscous)
