"""Catalogued structures under the French reference load, against numbers computed outside this package."""

import json
from pathlib import Path

import pytest

import treadload as tl

TABLES = json.loads((Path(__file__).parents[1] / "data" / "layered" / "french_catalogue.json").read_text())
# Twin wheels of the reference axle: 2 x 32.5 kN.
TWIN = [tl.UniformDisc(0.125, 0.662e6, x, 0.0) for x in (0.0, 0.375)]


@pytest.mark.parametrize("row", TABLES["worked_structures"], ids=lambda row: f"{row['structure']} x={row['x']}")
def test_worked_structures(row):
    name = row["structure"]
    road = tl.Pavement.from_catalogue(name, temperature=15)
    base = float(road.interfaces[-1])
    above, below = (
        tl.solve_response(TWIN, road, depths=[base], x=[row["x"]], y=[0.0], side=side).dataset.isel(depth=0, x=0, y=0)
        for side in ("above", "below")
    )
    extension = float(above["in_plane_strain_1"]) * 1e6
    compression = -float(below["strain_zz"]) * 1e6
    # Twelve digits are printed; the quadrature of both leaves 1e-9.
    assert extension == pytest.approx(row["eps_t_base_microstrain"], rel=1e-9)
    assert compression == pytest.approx(row["eps_z_subgrade_microstrain"], rel=1e-9)


def test_the_semi_rigid_structure_gives_the_printed_stresses():
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GC-T3 / 15 GC-T3 / PF3", temperature=15)
    data = tl.solve_response(TWIN, road, depths=[0.21, 0.36], x=[0.1875], y=[0.0]).dataset
    # Table I.5, to half a unit of its last digit.
    assert data["stress_yy"].to_numpy().ravel() / 1e6 == pytest.approx([0.612, 0.815], abs=0.0005)


def test_a_hot_road_bends_more():
    # A profile of a summer afternoon: every bituminous layer at its own middle.
    hot = tl.pavement.TemperatureProfile([0.0, 0.21], [45.0, 30.0])
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    moduli = [layer.elastic.modulus for layer in road.at_temperature(hot, extrapolate=True).layers[:2]]
    expected = [
        tl.catalogue.mixes[name].modulus(45 - 15 * middle / 0.21, extrapolate=True)
        for name, middle in (("EB-BBSG3", 0.03), ("EB-GB3", 0.135))
    ]
    assert moduli == pytest.approx(expected, rel=1e-12)
    strains = [
        float(tl.solve_response(TWIN, one, depths=[0.21], x=[0.1875], y=[0.0]).dataset["in_plane_strain_1"].squeeze())
        for one in (road.at_temperature(15), road.at_temperature(hot, extrapolate=True))
    ]
    assert strains[1] > 2 * strains[0]
