"""From a bowl to a service life with its reliability, and to the thickness of an overlay, in one case each."""

import numpy as np
import pytest

import treadload as tl
from treadload.case import Case
from treadload.roads import Basins, backcalculate
from treadload.steps import design_case

OFFSETS = np.array([0, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2, 1.5, 1.8])
CASE = """
spacing = "12 mm"
tire = { profile = "315/80R22.5" }
pavement = { from = "moduli.nc#km 1.2" }
climate = { months = [15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15] }

[traffic]
passes_per_year = 1e5
years = 20

[[traffic.classes]]
name = "standard"
share = 1.0
axle_load = "65 kN"
inflation_pressure = "8 bar"

[[criteria]]
name = "base of the asphalt"
law = "fatigue-line"
layer = 1
place = "bottom"
epsilon_6 = 100e-6
slope = -0.2

[reliability]
thickness = 0.0
fatigue = 0.25
"""


def moduli(folder):
    layers = [("asphalt", 4e9, 0.35, 0.15), ("base", 3e8, 0.35, 0.3), ("soil", 7e7, 0.4, None)]
    road = tl.Pavement([tl.Layer(tl.Elastic(e, v), h, name=name) for name, e, v, h in layers])
    load = tl.UniformDisc(0.15, 50e3 / (np.pi * 0.15**2))
    deep = tl.Pavement([*road.layers[:2], tl.Layer(tl.Elastic(7e7, 0.4), 9.55, name="soil")], rigid_base=True)
    down = tl.solve_response([load], deep, depths=[0.0], x=OFFSETS, y=[0.0]).dataset["displacement_z"].values.ravel()
    noise = 1 + 0.02 * np.random.default_rng(6).standard_normal(len(OFFSETS))
    result = backcalculate(Basins([down * noise], OFFSETS, 50e3, 0.15, station=("km 1.2",)), road, error="2 %")
    tl.save_results(result, folder / "moduli.nc")
    return result


OVERLAY = """
pavement.from = "moduli.nc#km 1.2"
pavement.overlay = { material = { kind = "elastic", modulus = "6000 MPa", poisson = 0.35 }, thickness = "60 mm" }
"""


@pytest.mark.slow
def test_a_bowl_becomes_years_with_a_probability_and_an_overlay(tmp_path):
    fitted = moduli(tmp_path)
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    case = Case.from_toml(tmp_path / "case.toml")
    road = case.pavement.build()
    assert [layer.material.modulus for layer in road.layers] == pytest.approx(
        [layer.material.modulus for layer in fitted.road(0).layers]
    )
    bare = tl.run(case)
    assert "fails" in bare.summary() or "%" in bare.summary()
    line = 'pavement = { from = "moduli.nc#km 1.2" }'
    overlaid = CASE.replace(line, OVERLAY).replace("layer = 1", "layer = 2")
    (tmp_path / "overlay.toml").write_text(overlaid, encoding="utf-8")
    question = Case.from_toml(tmp_path / "overlay.toml")
    assert question.pavement.build().layers[0].name == "overlay"
    years = 5.0
    designed = design_case(question, "overlay", years=years, risk=0.1, between=(0.02, 0.4))
    thicker = design_case(question, "overlay", years=4 * years, risk=0.1, between=(0.02, 0.4))
    # A longer life asks for a thicker overlay, and both lie within what was searched.
    assert 0.02 <= designed.thickness < thicker.thickness <= 0.4
