"""A window of mortar with stones below a load: stress in both, bonds, percentiles, files, refusals."""

import numpy as np
import pytest

import treadload as tl
from treadload.response.heterogeneous.bonds import faces

MORTAR, STONE = tl.Elastic(3e9, 0.35), tl.Elastic(60e9, 0.2)
PLACE = {"window": (14e-3, 12e-3), "depth": 12e-3, "spacing": 1e-3}
EDGE = tl.response.GridLoad(
    tl.response.Grid(30, 12, 1e-3, 1e-3, -14.5e-3, -11.5e-3), np.full((12, 30), 0.8e6), np.full((12, 30), 0.4e6)
)
ONE = tl.materials.Aggregates.from_centres(0.0, 0.0, 5.5e-3, 4e-3, STONE)


@pytest.fixture(scope="module")
def one():
    return tl.response.compute_heterogeneous(EDGE, MORTAR, ONE, **PLACE)


def test_stones_of_mortar_change_nothing_and_soft_ones_carry_less(one):
    data = one.dataset
    same = tl.response.compute_heterogeneous(
        EDGE, MORTAR, tl.materials.Aggregates.from_centres(0, 0, 5.5e-3, 4e-3, MORTAR), **PLACE
    )
    np.testing.assert_allclose(same.dataset.tension_without_stones, same.dataset.principal_stress_1, atol=1e-3)
    soft = tl.response.compute_heterogeneous(
        EDGE, MORTAR, tl.materials.Aggregates.from_centres(0, 0, 5.5e-3, 4e-3, tl.Elastic(0.3e9, 0.35)), **PLACE
    )
    assert float(data.stone_over_mastic) > 1.3 > 0.7 > float(soft.dataset.stone_over_mastic) > 0
    assert float(data.stone_fraction) == pytest.approx(4 / 3 * np.pi * 4**3 / (14 * 12 * 12), rel=0.05)


def test_every_cell_keeps_the_law_of_its_material(one):
    data = one.dataset
    for material, phase in ((MORTAR, 0), (STONE, 1)):
        cells = data.phase.to_numpy() == phase
        stress, strain = (
            {c: data[f"{kind}_{c}"].to_numpy()[cells] for c in ("xx", "yy", "zz", "xz")}
            for kind in ("stress", "strain")
        )
        trace = stress["xx"] + stress["yy"] + stress["zz"]
        for c in ("xx", "xz"):
            hydrostatic = trace if c == "xx" else 0
            expected = ((1 + material.poisson) * stress[c] - material.poisson * hydrostatic) / material.modulus
            # The equations are solved to 1e-6 of their right side.
            assert np.abs(strain[c] - expected).max() < 1e-5 * np.abs(data[f"strain_{c}"]).max()


def test_borders_by_share_keep_volumes_and_laws():
    soft = tl.materials.Aggregates.from_centres(-4e-3, -3e-3, 3e-3, 2e-3, tl.Elastic(0.5e9, 0.35))
    stones = [tl.materials.Aggregates.from_centres(3e-3, 1e-3, 5.5e-3, 3.5e-3, STONE), soft]
    data = tl.response.compute_heterogeneous(EDGE, MORTAR, stones, **PLACE, borders="shares").dataset
    for number, (radius, material) in enumerate(((3.5, STONE), (2.0, tl.Elastic(0.5e9, 0.35))), start=1):
        cells = data.stone.to_numpy() == number
        assert abs(cells.sum() - 4 / 3 * np.pi * radius**3) <= 0.5
        assert (data.phase.to_numpy()[cells] == number).all()
        stress, strain = (data[f"{kind}_xz"].to_numpy()[cells] for kind in ("stress", "strain"))
        np.testing.assert_allclose(
            strain, stress * (1 + material.poisson) / material.modulus, atol=1e-5 * np.abs(data.strain_xz).max()
        )
    mastic = data.phase.to_numpy() == 0
    expected = data.stress_xz.to_numpy()[mastic] * 1.35 / MORTAR.modulus
    np.testing.assert_allclose(data.strain_xz.to_numpy()[mastic], expected, atol=1e-5 * np.abs(data.strain_xz).max())
    with pytest.raises(tl.InputError, match='borders must be "steps" or "shares", got \'half\''):
        tl.response.compute_heterogeneous(EDGE, MORTAR, stones, **PLACE, borders="half")


@pytest.mark.slow
def test_borders_by_share_need_fewer_cells(one):
    stiff = tl.materials.Aggregates.from_centres(0.0, 0.0, 6e-3, 4e-3, tl.Elastic(36e9, 0.35))
    place = {"window": (12e-3, 12e-3), "depth": 12e-3}

    def carried(spacing, borders):
        data = tl.response.compute_heterogeneous(
            EDGE, MORTAR, stiff, **place, spacing=spacing, borders=borders
        ).dataset
        return float(np.mean(data.stress_zz.to_numpy()[data.phase.to_numpy() == 1]))

    fine = carried(0.5e-3, "shares")
    # Four cells a radius beside eight.
    assert abs(carried(1e-3, "shares") / fine - 1) < 0.7 * abs(carried(1e-3, "steps") / fine - 1)


def test_readings_are_those_of_the_fields(one):
    data = one.dataset
    # Away from the sides and the bottom by the radius, here a quarter of the side at most.
    inner = data.sel(x=slice(-3.6e-3, 3.6e-3), y=slice(-3.1e-3, 3.1e-3), depth=slice(0, 9.1e-3))
    mastic = inner.principal_strain_1.to_numpy()[inner.phase.to_numpy() == 0]
    mean = np.maximum(inner.principal_strain_1.to_numpy(), 0).mean()
    assert float(data.mastic_extension.sel(percentile=100)) == mastic.max()
    assert float(data.mastic_extension.sel(percentile=50)) == pytest.approx(np.median(mastic), rel=0.02)
    assert float(data.mean_extension) == pytest.approx(mean, rel=1e-12)
    assert one.factor(95) == pytest.approx(float(data.mastic_extension.sel(percentile=95)) / mean, rel=1e-12)
    assert float(data.ravelling_index) > 0
    with pytest.raises(tl.InputError, match="percentile must be one of 50, 90, 95, 99, 100, got 42"):
        one.factor(42)
    assert "ravelling index" in one.summary()
    strong = tl.response.compute_heterogeneous(EDGE, MORTAR, ONE, **PLACE, bond_strength=2e6)
    assert float(strong.dataset.ravelling_index) == pytest.approx(float(data.ravelling_index) * 0.8 / 2, rel=1e-9)


def test_bonds_of_a_sphere_have_its_area_and_the_stress_across_its_surface():
    at = np.arange(24) - 11.5
    distance = np.sqrt(at[:, None, None] ** 2 + at[:, None] ** 2 + at**2)
    stones = (distance < 9).astype(int)
    # A tension along x: n·σ·n = x²/r², along the face |x| √(r² - x²)/r².
    stress = np.zeros((6, 24, 24, 24))
    stress[0] = 1.0
    found = faces(stones, stress, at, at, at, np.ones(24))
    assert found.area.sum() == pytest.approx(4 * np.pi * 81, rel=0.03)
    cosine = found.x / np.sqrt(found.x**2 + found.y**2 + found.depth**2)
    # Directions from smoothed steps are some degrees off.
    assert np.abs(found.normal - cosine**2).mean() < 0.05
    assert np.abs(found.shear - np.abs(cosine) * np.sqrt(1 - cosine**2)).mean() < 0.05
    assert np.average(found.normal, weights=found.area) == pytest.approx(1 / 3, rel=0.03)
    squeezed = faces(stones, -stress, at, at, at, np.ones(24))
    np.testing.assert_allclose(squeezed.pull, found.shear)


@pytest.mark.slow
def test_a_scan_is_as_good_as_centres_and_voids_stand_beside_stones(one):
    numbers = one.dataset.stone.to_numpy()
    scan = tl.response.compute_heterogeneous(EDGE, MORTAR, tl.materials.Aggregates.from_voxels(numbers, 1e-3, STONE))
    for name in ("stress_xx", "strain_xz"):
        size = np.abs(one.dataset[name]).max()
        assert np.abs(scan.dataset[name].to_numpy() - one.dataset[name].to_numpy()).max() < 1e-5 * size
    void = tl.materials.Aggregates.from_centres(4.6e-3, 3.5e-3, 3e-3, 1.6e-3, None)
    both = tl.response.compute_heterogeneous(EDGE, MORTAR, [ONE, void], **PLACE)
    assert both.stats["method"] == "MINRES"
    assert set(np.unique(both.dataset.phase)) == {0, 1, 2}
    empty = both.dataset.phase.to_numpy() == 2
    assert np.abs(both.dataset.von_mises_stress if "von_mises_stress" in both.dataset else
                  both.dataset.stress_zz.to_numpy()[empty]).max() < 1e-3 * 0.8e6  # fmt: skip
    # Nothing is bonded to a void.
    assert not np.isin(both.dataset.face_stone, np.unique(both.dataset.stone.to_numpy()[empty])).any()
    assert any("fewer than 4" in text for text in both.warnings)


@pytest.mark.slow
def test_layers_that_are_one_are_the_half_space(one):
    base = tl.Elastic(3e9 * (1 + 1e-9), 0.35)
    road = tl.Pavement((tl.Layer(MORTAR, 30e-3), tl.Layer(base)))
    found = tl.response.compute_heterogeneous(EDGE, road, ONE, **PLACE)
    size = float(np.abs(one.dataset.stress_xx).max())
    assert np.abs(found.dataset.stress_xx - one.dataset.stress_xx).max() < 1e-5 * size


@pytest.mark.slow
def test_a_window_is_written_and_opened_again(one, tmp_path):
    tl.save_results(one, tmp_path / "window.nc")
    back = tl.open_results(tmp_path / "window.nc").heterogeneous
    assert back.summary() == one.summary()
    assert back.stones[0].material == STONE
    np.testing.assert_array_equal(back.stones[0].packing.radius, ONE.packing.radius)
    again = tl.response.compute_heterogeneous(back.loads, back.road, back.stones, **PLACE)
    np.testing.assert_allclose(again.dataset.stress_zz, one.dataset.stress_zz)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mortar": tl.materials.Prony(3e9, ((0.5, 1.0),), 0.35)}, "must be Elastic, got Prony; it relaxes"),
        ({"mortar": tl.Elastic(3e9, 0.5)}, "Poisson's ratio is 0.5, above 0.49"),
        ({"mortar": "mastic"}, "must be Elastic, got str"),
        ({"mortar": tl.Pavement((tl.Layer(MORTAR, 10e-3), tl.Layer(STONE)))}, "12 mm deep and the mortar's layer 10"),
        ({"stones": STONE}, "stones must be Aggregates"),
        ({"window": None}, "stones need a window"),
        ({"window": (14e-3,)}, "window must be a length along x and a width"),
        ({"window": (-14e-3, 12e-3)}, "length of the window must be a positive number"),
        ({"window": (6e-3, 12e-3)}, "diameter 8 mm is larger than the window of 6 x 12 x 12 mm"),
        ({"spacing": 0.7e-3, "window": (14e-3, 14e-3)}, "depth of 12 mm is 17.14 cells of 0.7 mm"),
        ({"spacing": 0.1e-3}, "memory goes with the square of the layers"),
        ({"at": (0.0, float("nan"))}, "middle must be finite numbers of metres, got y"),
        ({"bond_strength": -1.0}, "bond_strength must be a positive number"),
        ({"stones": tl.materials.Aggregates.from_voxels(np.ones((2, 2, 2)), 1e-3, STONE)}, "brings its window"),
        (
            {"stones": [ONE, tl.materials.Aggregates.from_centres(4e-3, 0, 5.5e-3, 2e-3, None)]},
            "stones 1 and 2 by 2 mm",
        ),
        (
            {"stones": tl.materials.Aggregates.from_centres(0, 0, 5e-3, 0.2e-3, STONE)},
            "none of the 1 stones holds the centre",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(change, words):
    asked = {"mortar": MORTAR, "stones": ONE, **PLACE, **change}
    with pytest.raises(tl.InputError) as refused:
        tl.response.compute_heterogeneous(EDGE, **asked)
    assert words in str(refused.value)


def test_a_small_window_says_that_it_is_one(one):
    assert any("less than three diameters of the largest stone wide" in text for text in one.warnings)
    assert "warning: " in one.summary()
