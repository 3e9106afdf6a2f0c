"""Tie bars in the grooves of a tread: numbers of a profile, ribs that they join, wear, and their contact."""

import itertools
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import treadload as tl
from treadload.contact import cautions, solve_pitch
from treadload.errors import InputError
from treadload.kernels.sections import Section, face_compliance
from treadload.steps import case_as_python
from treadload.tire import Belt, Groove, LateralGrooves, TreadProfile, equal_ribs
from treadload.tire.lugs import lugged_tread
from treadload.tire.ribs import ribs_between, section_of
from treadload.validation.one_rib import strips

HEIGHT, POISSON = 0.020, 0.495
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
BELT = Belt(tread=tl.Elastic(5.5e6, POISSON), bending=(80, 100, 150))
ROLLING = tl.Rolling(normal_load=5.5e3, friction=0.7)


def profile(bar=0.0, depth=0.015, **change):
    """Three ribs of 30 mm."""
    grooves = tuple(Groove(place, 0.01, depth, tie_bar=bar) for place in (-0.02, 0.02))
    return replace(TreadProfile(0.5, 0.8, 0.12, grooves=grooves, shoulder_radius=0.005), **change)


def tire(tread, **keys):
    return tl.Tire.from_profile(tread, inflation_pressure=820e3, belt=BELT, tread="ribs", **keys)


def rolled(bar, depth=0.015):
    """Contact of two ribs of 30 mm on both sides of a groove."""
    tread = profile(width=0.07, grooves=(Groove(0.0, 0.01, depth, tie_bar=bar),))
    return tl.solve_contact(tire(tread), ROAD, ROLLING, spacing=5e-3)


def at_the_groove(contact):
    """Shear of the thirds beside the groove towards it, over the mean pressure of the ribs."""
    data = contact.dataset
    y, dy = data.y.values, float(data.attrs["dy"])

    def total(field, low, high):
        covered = np.clip(np.minimum(y + dy / 2, high) - np.maximum(y - dy / 2, low), 0, None) / dy
        return float((covered[:, None] * field.values).sum())

    towards = total(data.traction_y, -0.015, -0.005) - total(data.traction_y, 0.005, 0.015)
    return towards / 2 / (total(data.pressure, -0.035, 0.035) / 6)


def test_the_ground_stands_above_the_bar_and_not_above_the_floor():
    tied = TreadProfile(0.5, 0.8, 0.12, grooves=(Groove(0.01, 0.012, 0.015, math.radians(10), 0.001, 0.004),))
    bare = replace(tied, grooves=(replace(tied.grooves[0], tie_bar=0.0),))
    y = np.linspace(-0.05, 0.05, 2001)
    # Walls and edges are those of the groove without a bar, down to the top of the bar, 11 mm below the tread.
    smooth = replace(tied, grooves=()).drop(y)
    assert tied.drop(y) - smooth == pytest.approx(np.minimum(bare.drop(y) - smooth, 0.011), abs=1e-15)
    assert tied.grooves[0].clear_depth == pytest.approx(0.011)
    assert "1 grooves, 1 with tie bars" in str(tied)
    assert "tie" not in str(bare)


@pytest.mark.parametrize("bar", [-1e-3, 0.015, 0.016])
def test_a_bar_lies_in_its_groove(bar):
    with pytest.raises(InputError, match=r"tie_bar must be at least 0 and less than .*0\.015 m, got") as caught:
        Groove(0.0, 0.01, 0.015, tie_bar=bar)
    assert f"{bar:g} m" in str(caught.value)
    assert "leave out a groove" in str(caught.value)


@pytest.mark.parametrize("bar", [math.nan, math.inf, True])
def test_a_bar_is_a_number(bar):
    with pytest.raises(InputError, match="tie_bar must be a finite number"):
        Groove(0.0, 0.01, 0.015, tie_bar=bar)


def test_a_profile_in_a_file_has_bars(tmp_path):
    path = tmp_path / "tread.toml"
    path.write_text(profile(0.004).to_toml())
    assert TreadProfile.from_toml(path) == profile(0.004)
    table = profile().to_dict() | {"grooves": [{"centre": 0, "width": "10 mm", "depth": "15 mm", "tie_bar": "4 mm"}]}
    assert TreadProfile.from_dict(table).grooves[0].tie_bar == pytest.approx(0.004)
    table["grooves"][0]["tie_bar"] = "15 mm"
    with pytest.raises(InputError, match="tie_bar must be at least 0 and less than"):
        TreadProfile.from_dict(table)
    assert {groove.tie_bar for groove in equal_ribs(0.12, 2, 0.01, 0.015, tie_bar=0.003)} == {0.003}


def test_a_bar_is_a_floor_of_the_section():
    slope = math.tan(math.radians(5))
    grooves = tuple(Groove(place, 0.01, 0.015, math.radians(5), tie_bar=0.006) for place in (-0.02, 0.02))
    (group,) = ribs_between(section_of(profile(grooves=grooves)), HEIGHT)
    assert group.section.floors == pytest.approx((0.0, 0.011, 0.011, 0.0))
    # The walls end on the bar.
    assert group.section.feet[0][1] == pytest.approx(group.section.ribs[0][1] + 0.009 * slope)
    # Below 40 % of the height ribs stand apart, on half of the bar each.
    apart = ribs_between(section_of(profile(0.002)), HEIGHT)
    assert [len(group.faces) for group in apart] == [1] * 3
    assert apart[1].section.floors == pytest.approx((0.007, 0.007))


def test_an_undertread_lies_below_the_floor_and_not_below_the_bar():
    tied = tire(profile(0.006), undertread=0.004)
    assert tied.carcass.belt.tread_thickness == pytest.approx(0.019)
    assert tied.ribs[0].section.floors[1] == pytest.approx(0.010)


def test_wear_ends_at_the_bar():
    worn = profile(0.004).worn("6 mm")
    assert [groove.depth for groove in worn.grooves] == [pytest.approx(0.009)] * 2
    assert [groove.tie_bar for groove in worn.grooves] == [0.004] * 2
    # Worn down to the bar, a groove is gone; one without a bar is still there.
    uneven = profile(grooves=(Groove(-0.02, 0.01, 0.015, tie_bar=0.004), Groove(0.02, 0.01, 0.015)))
    assert [groove.centre for groove in uneven.worn(0.011).grooves] == [0.02]
    assert len(uneven.worn(0.0109).grooves) == 2
    with pytest.raises(
        InputError, match=r"less than 11 mm, the depth of the deepest groove above its tie bar, got 11"
    ):
        profile(0.004).worn(0.011)
    # The bar keeps its height above the belt.
    groups = ribs_between(section_of(worn), HEIGHT - 0.006)
    assert groups[0].section.floors[1] == pytest.approx(0.009)
    assert len(groups) == 1


CELLS = np.concatenate([strips(0.03, 10), 0.04 + strips(0.03, 10)])
WAVES = np.array([0.0, 30.0, 90.0, 300.0])


def of_pair(floor):
    """Compliance (waves, 60, 60) of the cells of two ribs with a groove down to this part of their height."""
    section = Section(((0.0, 0.03), (0.04, 0.07)), HEIGHT, (0.0, floor * HEIGHT, 0.0)).for_cells(3e-3)
    return face_compliance(section, POISSON, WAVES).on_cells(CELLS).compliance


@pytest.fixture(scope="module")
def pairs():
    return {floor: of_pair(floor) for floor in (0.25, 0.5, 0.9, 0.99, 0.999)}


def test_ribs_under_a_bar_as_high_as_the_groove_are_a_slab(pairs):
    whole = Section(((0.0, 0.07),), HEIGHT, (0.0, 0.0)).for_cells(3e-3)
    slab = face_compliance(whole, POISSON, WAVES).on_cells(CELLS).compliance
    off = [np.abs(found - slab).max() / np.abs(slab).max() for found in pairs.values()]
    # The groove between them is loaded nowhere. 0.2 % is left of it at 0.001 of the height: the elements of ribs are
    # finer at walls, which a slab does not have.
    assert off == sorted(off, reverse=True)
    assert off[0] > 0.5
    assert off[-2] < 0.02
    assert off[-1] < 3e-3


def test_higher_bars_make_every_load_stiffer(pairs):
    """A bar is rubber more: no load on the faces moves them further than without it, so that a continuous bar bounds
    an interrupted one. Meshes differ, which leaves 4e-4 of the largest compliance."""
    found = list(pairs.values())
    for lower, higher in itertools.pairwise(found):
        change = lower - higher
        least = np.linalg.eigvalsh(0.5 * (change + change.swapaxes(1, 2)))[:, 0]
        assert (least > -1e-3 * np.linalg.eigvalsh(lower)[:, -1]).all()


@pytest.fixture(scope="module")
def contacts():
    return {bar: rolled(bar) for bar in (0.0, 0.003, 0.0075, 0.012)}


def test_shear_at_the_groove_falls_with_the_height_of_the_bar(contacts):
    shear = [at_the_groove(contact) for contact in contacts.values()]
    assert shear == sorted(shear, reverse=True)
    assert shear[0] > 0.25
    assert shear[-1] < 0.3 * shear[0]


def test_a_tied_contact_is_solved(contacts):
    tied = contacts[0.0075]
    data = tied.dataset
    size = np.hypot(data.traction_x, data.traction_y)
    assert float((size - 0.7 * data.pressure).max()) <= 1e-6 * float(data.pressure.max())
    assert float(data.pressure.sum()) * float(data.attrs["dx"]) * float(data.attrs["dy"]) == pytest.approx(5.5e3)
    # It presses the ribs of a stiffer tread: less approach.
    assert float(data.approach) < float(contacts[0.0].dataset.approach)
    # The tread is its own mirror image.
    assert float(data.traction_y.sum()) == pytest.approx(0, abs=1e-7 * float(np.abs(data.traction_y).sum()))


def test_a_bar_and_a_groove_that_is_shallower_by_it_give_the_same_digits(contacts):
    tied, shallow = contacts[0.0075].dataset, rolled(0.0, depth=0.0075).dataset
    for name in ("pressure", "traction_x", "traction_y"):
        np.testing.assert_array_equal(tied[name], shallow[name])


def test_a_height_of_0_is_no_bar():
    assert profile(0.0) == profile()
    assert tire(profile(0.0)).ribs == tire(profile()).ribs
    y = np.linspace(-0.06, 0.06, 999)
    np.testing.assert_array_equal(profile(0.0).drop(y), profile().drop(y))


def test_the_result_states_that_bars_are_continuous_along_travel(contacts):
    (caveat,) = [words for words in contacts[0.0075].warnings if "tie bar" in words]
    assert "7.5 mm in 1 of 1 grooves" in caveat
    assert "continuous along travel: an upper bound of the stiffness" in caveat
    assert not [words for words in contacts[0.0].warnings if "tie bar" in words]


def test_a_groove_that_may_close_is_warned_of(contacts):
    assert not [words for words in contacts[0.012].warnings if "may close" in words]
    (words,) = [words for words in cautions.of_tire(tire(profile(0.0136))) if "may close" in words]
    assert "1.4 mm deep down to its tie bar" in words
    assert "carries no pressure" in words


def test_a_case_has_tie_bars():
    groove = {"width": "10 mm", "depth": "15 mm", "tie_bar": "6 mm"}
    table = {
        "spacing": "6 mm",
        "tire": {
            "profile": {"rolling_radius": "500 mm", "crown_radius": "800 mm", "width": "120 mm", "grooves": [
                {"centre": "-20 mm"} | groove, {"centre": "20 mm"} | groove,
            ]},
            "inflation_pressure": "8.2 bar", "tread": "ribs",
            "belt": {"tread": {"kind": "elastic", "modulus": "5.5 MPa", "poisson": POISSON}},
        },
        "pavement": {"layers": [{"material": {"kind": "elastic", "modulus": "5.4 GPa", "poisson": 0.35}}]},
        "rolling": {"normal_load": "8 kN", "friction": 0.7},
    }  # fmt: skip
    case = tl.Case.from_dict(table)
    (group,) = case.build_tire().ribs
    assert group.section.floors == pytest.approx((0.0, 0.011, 0.011, 0.0))
    assert tl.Case.from_text(case.to_toml()).build_tire() == case.build_tire()
    assert "'tie_bar'" in case_as_python(case)
    worn = tl.Case.from_dict(table | {"tire": table["tire"] | {"wear": "5 mm"}}).build_tire()
    assert worn.ribs[0].section.height == pytest.approx(0.015)
    assert worn.ribs[0].section.floors[1] == pytest.approx(0.011)
    with pytest.raises(InputError, match=r"wear must be at least 0 and less than 9 mm.*tie bar"):
        tl.Case.from_dict(table | {"tire": table["tire"] | {"wear": "9 mm"}}).build_tire()


def test_blocks_stand_on_bars():
    lugs = profile(0.003, lateral=(LateralGrooves(0.06, 0.006, 0.012),))
    belt = replace(BELT, tread_thickness=0.024)
    pattern = lugged_tread(tl.Tire.from_profile(lugs, inflation_pressure=820e3, belt=belt)).pattern
    # From the left, round: shoulder, lateral groove, bar, lateral groove.
    left = min(pattern.blocks, key=lambda block: block.y)
    assert left.block.floors == pytest.approx((0.0, 0.012, 0.012, 0.012))


@pytest.mark.slow
def test_a_passage_over_blocks_states_that_bars_are_continuous():
    pitch = LateralGrooves(0.04, 0.006, 0.016)
    lugs = TreadProfile(0.3, 0.8, 0.088, grooves=(Groove(0.0, 0.01, 0.016, tie_bar=0.005),), lateral=(pitch,))
    belt = Belt(tread=tl.Elastic(4e6, 0.49), tread_thickness=0.024, arm=0.024)
    wheel = tl.Tire.from_profile(lugs, inflation_pressure=300e3, belt=belt)
    passage = solve_pitch(wheel, ROAD, tl.Rolling(normal_load=2500.0, friction=0.7), spacing=8e-3, positions=6)
    assert any("5 mm in 1 of 1 grooves" in words for words in passage.warnings)
    # 8 + 5 mm of 24 mm: higher than 40 %.
    assert any("a tie bar between blocks" in words for words in passage.warnings)


def test_the_page_draws_the_bar_and_the_floor_below_it(monkeypatch):
    section = pytest.importorskip("treadload.app.tread_section")
    drawn = []
    monkeypatch.setattr(
        section, "Place", lambda *_: SimpleNamespace(draw=lambda text: drawn.append(json.loads(text)))
    )
    for bar in (0.0, 0.006):
        monkeypatch.setattr(section, "profile_of", lambda _, bar=bar: profile(bar))
        section.TreadSection().draw(None)
    depths = [[-min(line["y"]) for line in figure["data"]] for figure in drawn]
    crown = float(profile().drop(np.array([0.02]))[0]) - 0.015
    assert depths[0] == [pytest.approx(15 + 1e3 * crown, abs=0.2)]
    at = int(np.argmin(np.abs(np.array(drawn[1]["data"][0]["x"]) - 20)))
    assert [-line["y"][at] for line in drawn[1]["data"]] == pytest.approx(
        [9 + 1e3 * crown, 15 + 1e3 * crown], abs=0.05
    )
    assert [line["line"]["dash"] for line in drawn[1]["data"]] == ["solid", "dot"]
