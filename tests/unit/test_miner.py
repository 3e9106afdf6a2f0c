"""Miner's sum: parts add up, damage is linear in passes, wander and growth follow their closed forms."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.damage import FatigueLine, FrenchBituminous, FrenchSubgrade
from treadload.damage.climate import Climate, Season
from treadload.damage.criterion import Criterion
from treadload.damage.cycles import harm_of
from treadload.damage.miner import damage_of, miner
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement

LINE = FatigueLine(100e-6, -0.2)
CRITERIA = (
    Criterion("top", LINE, place="top", strain="principal"),
    Criterion("soil", FrenchSubgrade(), -1, "top"),
)
Y = np.arange(-30, 31) * 0.02


def classes(*shares):
    return tuple(AxleClass(f"class {k}", share, 30e3 + k, 8e5) for k, share in enumerate(shares))


def readings(count, seasons, seed=0):
    peaks = np.random.default_rng(seed).uniform(50e-6, 200e-6, (2, count, seasons, 1))
    return peaks * np.exp(-0.5 * (Y / 0.1) ** 2)


def test_a_mixed_traffic_is_the_sum_of_its_parts():
    shares, climate = (0.5, 0.3, 0.2), Climate.equal_parts([0.0, 15.0, 30.0])
    values = readings(3, 3)
    traffic = Traffic(classes(*shares), 1e5, wander=Wander.normal(0.2))
    whole = miner(values, CRITERIA, traffic, climate, y=Y).dataset["damage_per_year"].to_numpy()
    parts = 0.0
    for k, share in enumerate(shares):
        for s, season in enumerate(climate.seasons):
            alone = replace(traffic, classes=classes(1.0), passes_per_year=1e5 * share * season.share)
            one = miner(values[:, k : k + 1, s : s + 1], CRITERIA, alone, Climate.constant(15.0), y=Y)
            parts = parts + one.dataset["damage_per_year"].to_numpy()
    assert np.abs(whole - parts).max() <= 1e-12 * whole.max()


@settings(deadline=None, max_examples=25)
@given(st.floats(1.0, 1e7), st.floats(0.1, 50))
def test_damage_is_linear_in_passes(passes, factor):
    values = readings(1, 1)
    climate = Climate.constant(15.0)
    one, more = (
        miner(values, CRITERIA, Traffic(classes(1.0), n), climate, y=Y).dataset["damage_per_year"].to_numpy()
        for n in (passes, passes * factor)
    )
    assert more == pytest.approx(factor * one, rel=1e-12)


@settings(deadline=None, max_examples=25)
@given(st.floats(1.0, 3.0))
def test_more_strain_never_lives_longer(factor):
    values = readings(1, 1)
    traffic, climate = Traffic(classes(1.0), 1e5), Climate.constant(15.0)
    less, more = (miner(v, CRITERIA, traffic, climate, y=Y) for v in (values, values * factor))
    assert (more.dataset["life_years"] <= less.dataset["life_years"] * (1 + 1e-12)).all()


def test_one_strain_lives_as_long_as_its_line_says():
    values = np.full((1, 1, 1, len(Y)), 120e-6)
    traffic = Traffic(classes(1.0), 1e5, growth=0.02)
    life = miner(values, CRITERIA[:1], traffic, Climate.constant(15.0), y=Y)
    assert life.dataset["life_passes"].item() == pytest.approx(LINE.allowable_passes(120e-6), rel=1e-12)
    assert traffic.passes(life.years("top")) == pytest.approx(LINE.allowable_passes(120e-6), rel=1e-9)
    assert life.governing == "top"
    assert "Governing criterion: top. " in life.summary()


def test_shares_of_the_worst_place_add_up_to_one():
    life = miner(readings(3, 2), CRITERIA, Traffic(classes(0.2, 0.3, 0.5), 1e5), Climate.equal_parts([5, 25]), y=Y)
    assert life.dataset["damage_share"].sum(("axle_class", "season")).to_numpy() == pytest.approx([1, 1], rel=1e-12)


def test_a_law_of_its_temperature_is_asked_at_the_layers():
    asked = []

    def law(temperature):
        asked.append(temperature)
        return FatigueLine((100 + temperature) * 1e-6, -0.2)

    criteria = (Criterion("warm", law, place="top"),)
    climate = Climate((Season("w", 0.5, (1.0, 2.0)), Season("s", 0.5, (31.0, 22.0))))
    values = np.full((1, 1, 2, len(Y)), 120e-6)
    with pytest.raises(InputError, match="layer_temperatures"):
        miner(values, criteria, Traffic(classes(1.0), 1e5), climate, y=Y)
    layers = np.array([[1.0, 31.0]])
    life = miner(values, criteria, Traffic(classes(1.0), 1e5), climate, y=Y, layer_temperatures=layers)
    expected = sum(0.5e5 / FatigueLine((100 + t) * 1e-6, -0.2).allowable_passes(120e-6) for t in (1.0, 31.0))
    assert life.dataset["damage_per_year"].max().item() == pytest.approx(expected, rel=1e-12)
    assert {1.0, 31.0} <= set(asked)


def test_no_strain_lives_for_ever():
    life = miner(np.zeros((2, 1, 1, len(Y))), CRITERIA, Traffic(classes(1.0), 1e5), Climate.constant(15.0), y=Y)
    assert math.isinf(life.years("soil"))
    assert "no criterion fails" in life.summary()


def test_extrapolation_is_told():
    values = np.full((1, 1, 1, len(Y)), 1e-6)
    life = miner(values, CRITERIA[:1], Traffic(classes(1.0), 1e5), Climate.constant(15.0), y=Y)
    assert any("extrapolated" in text for text in life.warnings)


ROAD = Pavement([Layer(Elastic(5e9, 0.35), 0.1), Layer(Elastic(1e8, 0.35))])


def test_a_criterion_knows_its_depth_and_side():
    assert Criterion("a", LINE, 0, "top").depth(ROAD) == 0
    assert Criterion("a", LINE, 0, "bottom").depth(ROAD) == pytest.approx(0.1)
    assert Criterion("a", LINE, -1, "top").depth(ROAD) == pytest.approx(0.1)
    assert (Criterion("a", LINE, 0, "bottom").side, Criterion("a", LINE, -1, "top").side) == (
        "above",
        "below",
    )


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Criterion("a", LINE, place="middle"), '"top" or "bottom"'),
        (lambda: Criterion("a", LINE, strain="shear"), "principal"),
        (lambda: Criterion("a", LINE, -1).depth(ROAD), "semi-infinite"),
        (lambda: Criterion("a", LINE, 5).depth(ROAD), "reads layer 5"),
        (
            lambda: miner(np.zeros((1, 1, 1, 5)), CRITERIA, Traffic(classes(1.0), 1), Climate.constant(1.0), y=Y),
            "readings must be",
        ),
        (
            lambda: miner(
                np.zeros((2, 1, 1, 3)),
                CRITERIA,
                Traffic(classes(1.0), 1),
                Climate.constant(1.0),
                y=np.array([0, 1, 5]),
            ),
            "evenly spaced",
        ),
    ],
)
def test_bad_input_is_named(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_every_axle_of_a_group_is_a_cycle_less_the_valley_between():
    """Σ 1/N(peak) - Σ 1/N(valley): apart two cycles, merged one, and the rise alone between."""
    climate, traffic = Climate.constant(15.0), Traffic(classes(1.0), 1e5)

    def damage(valley, peaks=(120e-6, 100e-6)):
        turns = np.array([peaks[0], valley, peaks[1]])[:, None] * np.ones(len(Y))
        life = miner(turns[None, None, None], CRITERIA[:1], traffic, climate, y=Y)
        return life.dataset["damage_per_year"].to_numpy().max() / 1e5

    passes = LINE.allowable_passes
    assert damage(0.0) == pytest.approx(1 / passes(120e-6) + 1 / passes(100e-6), rel=1e-12)
    assert damage(100e-6) == pytest.approx(1 / passes(120e-6), rel=1e-12)
    assert damage(60e-6) == pytest.approx(1 / passes(120e-6) + 1 / passes(100e-6) - 1 / passes(60e-6), rel=1e-12)


class OfAmplitude(FatigueLine):
    def allowable_cycles(self, amplitude, mean):
        return self.allowable_passes(amplitude)


@pytest.mark.parametrize("filled", range(6))
@pytest.mark.parametrize("law", [LINE, OfAmplitude(100e-6, -0.2)])
def test_turns_in_which_nothing_is_read_do_nothing(law, filled):
    """However many turns are read, also where the last of them is a valley."""
    turns = np.zeros((1, 1, 2, 7, len(Y)))
    turns[..., :filled, :] = np.random.default_rng(filled).uniform(50e-6, 200e-6, (1, 1, 2, filled, len(Y)))
    climate = Climate((Season("a", 0.25, 5.0), Season("b", 0.75, 20.0)))
    damage = damage_of(turns, [[[law, law]]], Traffic(classes(1.0), 1e6), climate)
    for season, share in enumerate((0.25, 0.75)):
        expected = 1e6 * share * harm_of(law, turns[0, 0, season])
        # Round-off of a sum of seven terms.
        np.testing.assert_allclose(damage[0, 0, season], expected, rtol=1e-12, atol=1e-12 * expected.max(initial=0.0))


def test_damage_at_the_end_of_the_design_life():
    values = np.full((1, 1, 1, len(Y)), 120e-6)
    traffic = Traffic(classes(1.0), 1e5, growth=0.03, years=20)
    life = miner(values, CRITERIA[:1], traffic, Climate.constant(15.0), y=Y)
    assert life.dataset["design_damage"].item() == pytest.approx(traffic.passes(20) / LINE.allowable_passes(120e-6))
    with pytest.raises(InputError, match="design life"):
        Traffic(classes(1.0), 1e5, years=0)


def test_orientations_share_the_damage_of_the_worst_place():
    """Two classes in the same track, one cracking along travel and one across it: shares are those of the damage."""
    values = np.stack([np.full(len(Y), 120e-6), np.full(len(Y), 90e-6)])[None, :, None]
    angle = np.stack([np.zeros(len(Y)), np.full(len(Y), np.pi / 2)])[None, :, None]
    traffic = Traffic(classes(0.5, 0.5), 1e5, wander=Wander.normal(0.2))
    cracks = (angle, np.full_like(angle, np.pi / 2))
    data = miner(values, CRITERIA[:1], traffic, Climate.constant(15.0), y=Y, cracks=cracks).dataset
    share = data["damage_share"].to_numpy()[0, :, 0]
    along, across = (data["orientation_damage"].sel(orientation=o).item() for o in ("longitudinal", "transverse"))
    assert (along, across) == pytest.approx(tuple(share), rel=1e-12)
    assert data["first_crack_angle"].item() == 0.0


def test_wander_does_not_count_twice_for_laws_that_hold_it():
    """The French law reads one track, the line the spread of its damage; both lives are told for both."""
    values = readings(1, 1)
    climate = Climate.constant(15.0)
    wide = miner(values, CRITERIA, Traffic(classes(1.0), 1e5, wander=Wander.normal(0.2)), climate, y=Y)
    still = miner(values, CRITERIA, Traffic(classes(1.0), 1e5), climate, y=Y)
    assert wide.years("soil") == pytest.approx(still.years("soil"), rel=1e-12)
    assert wide.years("top") > 1.2 * still.years("top")
    for name in ("top", "soil"):
        row = wide.dataset.sel(criterion=name)
        assert row["life_years_without_wander"].item() == pytest.approx(still.years(name), rel=1e-12)
        assert row["life_years_with_wander"].item() > 1.2 * still.years(name)
    spread = Wander.normal(0.2).spread(still.dataset["damage_per_year"].to_numpy(), 0.02).max(axis=-1)
    assert wide.dataset["life_years_with_wander"].to_numpy() == pytest.approx(1 / spread, rel=1e-9)
    (said,) = [text for text in wide.warnings if "wander" in text]
    assert said.startswith("soil: its law was calibrated on roads on which wheels wander")
    longer = wide.dataset["life_years_with_wander"] / wide.dataset["life_years"]
    assert f"{longer.sel(criterion='soil').item():.3g} times as long" in said
    assert said in wide.summary()
    assert not any("wander" in text for text in still.warnings)
    assert "life_years_with_wander" not in still.dataset
    # On the same y, damage that wanders and damage that does not.
    assert wide.dataset["damage_per_year"].sel(criterion="soil").sum().item() == pytest.approx(
        still.dataset["damage_per_year"].sel(criterion="soil").sum().item(), rel=1e-12
    )


def test_orientations_of_a_law_that_holds_wander_are_those_of_one_track():
    values = np.stack([np.full(len(Y), 420e-6), np.full(len(Y), 300e-6)])[None, :, None]
    angle = np.stack([np.zeros(len(Y)), np.full(len(Y), np.pi / 2)])[None, :, None]
    law = FrenchBituminous(100e-6, -0.2, 0.25, 0.2, 0.5, 1.0)
    traffic = Traffic(classes(0.5, 0.5), 1e5, wander=Wander.normal(0.2))
    data = miner(
        values, (Criterion("base", law),), traffic, Climate.constant(15.0), y=Y,
        cracks=(angle, np.full_like(angle, np.pi / 2)),
    ).dataset  # fmt: skip
    share = data["damage_share"].to_numpy()[0, :, 0]
    along, across = (data["orientation_damage"].sel(orientation=o).item() for o in ("longitudinal", "transverse"))
    assert (along, across) == pytest.approx(tuple(share), rel=1e-12)


def test_the_summary_says_what_the_end_is():
    said = miner(readings(1, 1), CRITERIA, Traffic(classes(1.0), 1e5), Climate.constant(15.0), y=Y)
    assert "damage 1 means the rut that the method accepts" in said.summary()
    assert json.loads(said.dataset.attrs["ends"])[0] == LINE.end_of_life
