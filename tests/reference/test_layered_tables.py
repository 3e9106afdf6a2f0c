"""Layered roads against published tables: AMADEUS (BISAR), ELLEA1, and table I.5 of the French method."""

import json
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from treadload.pavement import HALF_BONDED

FOLDER = Path(__file__).parents[1] / "data" / "layered"
AMADEUS, ELLEA, FRENCH = (
    json.loads((FOLDER / name).read_text())
    for name in ("amadeus_brrc2000.json", "ellea1.json", "nf_p98_086_table_I5.json")
)
BONDS = {"bonded": tl.pavement.BONDED, "frictionless": tl.pavement.FRICTIONLESS}
# Of the finely computed values, in their own unit, by the largest of its kind: the aim of the quadrature.
CLOSE = 1e-9


def road(thickness, moduli, poissons, bonds):
    layers = zip(moduli, poissons, [*thickness, None], [*bonds, tl.pavement.BONDED], strict=True)
    return tl.Pavement([tl.Layer(tl.Elastic(e * 1e6, nu), h, bond=bond) for e, nu, h, bond in layers])


def discs(loads, unit="mm", scale=1e-3):
    return [
        tl.UniformDisc(
            load[f"a_{unit}"] * scale, load["p_MPa"] * 1e6, load[f"x_{unit}"] * scale, load[f"y_{unit}"] * scale
        )
        for load in loads
    ]


def values(data, name):
    """A field in MPa, microstrain or mm by the name of the tables, such as sxx, exz or uz."""
    kind, factor = {"s": ("stress", 1e-6), "e": ("strain", 1e6), "u": ("displacement", 1e3)}[name[0]]
    return data[f"{kind}_{name[1:]}"] * factor


@pytest.mark.parametrize("case", AMADEUS["cases"], ids=lambda case: case["id"])
def test_amadeus(case):
    structure = AMADEUS["structure"]
    bonds = [BONDS[bond] for bond in case["interfaces"]]
    built = road([h / 1e3 for h in structure["h_mm"]], structure["E_MPa"], structure["nu"], bonds)
    points = case["high_accuracy_full_tension_positive"]
    solved = {
        side: tl.solve_response(
            discs(case["loads"]),
            built,
            depths=sorted({p["z_mm"] / 1e3 for p in points}),
            x=sorted({p["x_mm"] / 1e3 for p in points}),
            y=[0.0],
            side=side,
        ).dataset
        for side in ("above", "below")
    }
    largest = {"s": 0.7, "e": 250.0, "u": 0.4}
    for point in points:
        data = solved[point["side"]].sel(depth=point["z_mm"] / 1e3, x=point["x_mm"] / 1e3, y=0.0)
        for key, exact in point.items():
            name = key.removesuffix("_mm")
            if key[0] in largest and key != "side":
                assert abs(float(values(data, name)) - exact) <= CLOSE * largest[key[0]], (point, key)

    # The eight key responses as printed, compression positive, to half a unit of the last digit.
    wheel, other = points[0]["x_mm"] / 1e3, points[4]["x_mm"] / 1e3
    across = "strain_yy" if "dual" in case["id"] else "strain_xx"
    rows = [
        -float(solved[side][name].sel(depth=depth, x=x, y=0.0)) * scale
        for x in (wheel, other)
        for side, name, depth, scale in (
            ("above", "stress_zz", 0.0, 1e-6),
            ("above", across, 0.26, 1e6),
            ("below", "strain_zz", 0.26, 1e6),
            ("below", "strain_zz", 0.76, 1e6),
        )
    ]
    printed = case["published"]["BISAR"]
    for row, (mine, theirs) in enumerate(zip(rows, printed, strict=True), start=1):
        # Where the print differs from the fine computations, two independent ones: 185.0 for 185.13, 217 for
        # 216.47, 182 for 183.24 (there the table's other programs agree with these), and +9 for -9.4.
        if theirs is None or (case["id"], row) in {
            ("amadeus_single_bonded", 4),
            ("amadeus_single_slip1", 4),
            ("amadeus_dual_slip1", 3),
            ("amadeus_dual_bonded", 7),
        }:
            continue
        decimals = len(str(theirs).partition(".")[2])
        assert abs(mine - theirs) <= 0.5 * 10.0**-decimals + 1e-6, (row, mine, theirs)


@pytest.mark.parametrize("case", ELLEA["cases"], ids=lambda case: case["id"])
def test_ellea(case):
    structure = case["structure"]
    built = road([h / 1e3 for h in structure["h_mm"]], structure["E_MPa"], structure["nu"], [tl.pavement.BONDED] * 2)
    x, y, z = (np.array(case["points_mm"]).T / 1e3).round(9)
    data = tl.solve_response(
        discs(case["loads"]), built, depths=np.unique(z), x=np.unique(x), y=np.unique(y), side="above"
    ).dataset
    at = np.searchsorted(np.unique(z), z), np.searchsorted(np.unique(y), y), np.searchsorted(np.unique(x), x)
    for name, printed in case["published"].items():
        mine, fine = values(data, name).to_numpy()[at], np.array(case["high_accuracy_same_signs"][name])
        if name[0] in "se":
            mine = -mine
        largest = {"s": 1.1, "e": 1000.0, "u": 1.0}[name[0]]
        assert np.abs(mine - fine).max() <= CLOSE * largest, name
        # What the print differs by itself: its own quadrature near the surface, four decimals elsewhere.
        apart = case["max_abs_difference_published_minus_high_accuracy"][name]
        assert np.abs(mine - np.array(printed)).max() <= apart + CLOSE * largest, name


def test_french_table():
    structure = FRENCH["structure"]
    loads = discs(FRENCH["loads"], "m", 1.0)
    arguments = {"depths": [0.21, 0.36], "x": [0.0, 0.1875], "y": [0.0]}
    solved = {}
    for name, bond in BONDS.items():
        built = road(
            structure["h_m"], structure["E_MPa"], structure["nu"], [tl.pavement.BONDED, bond, tl.pavement.BONDED]
        )
        solved[name] = {
            side: tl.solve_response(loads, built, side=side, **arguments).dataset for side in ("above", "below")
        }
        for (x, _, z, side), fine in zip(
            FRENCH["high_accuracy"]["points"], FRENCH["high_accuracy"][name], strict=True
        ):
            point = solved[name][side].sel(x=x, depth=z, y=0.0)
            for key, exact in fine.items():
                largest = 1.0 if key[0] == "s" else 100.0
                assert abs(float(values(point, key)) - exact) <= CLOSE * largest, (name, key)
    built = road(
        structure["h_m"], structure["E_MPa"], structure["nu"], [tl.pavement.BONDED, HALF_BONDED, tl.pavement.BONDED]
    )
    half = {side: tl.solve_response(loads, built, side=side, **arguments).dataset for side in ("above", "below")}
    table = FRENCH["high_accuracy"]
    for (x, _, z, side), fine in zip(table["points"], table["semi_bonded_mean"], strict=True):
        point = half[side].sel(x=x, depth=z, y=0.0)
        for key, exact in fine.items():
            largest = 1.0 if key[0] == "s" else 100.0
            assert abs(float(values(point, key)) - exact) <= CLOSE * largest, key
    # As printed, to half a unit of the last digit.
    for depth, printed in ((0.21, 0.612), (0.36, 0.815)):
        found = float(half["above"]["stress_yy"].sel(depth=depth, x=0.1875, y=0.0))
        assert found * 1e-6 == pytest.approx(printed, abs=0.0005)
