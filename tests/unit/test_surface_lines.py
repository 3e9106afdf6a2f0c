"""Every surface life states its years by the line of a young mix and by that of old cores."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.case import Case
from treadload.damage import AgedLine, FatigueLine
from treadload.life.surface_lines import surface_lines

CASE = """
spacing = "20 mm"
[tire]
profile = "315/80R22.5"
[[pavement.layers]]
name = "top"
thickness = "12 cm"
mix = "EB-BBSG3"
[[pavement.layers]]
material = { kind = "elastic", modulus = "100 MPa", poisson = 0.35 }
[climate]
months = [2, 3, 6, 9, 14, 17, 19, 18, 15, 11, 6, 3]
[traffic]
passes_per_year = 1e5
growth = 0.02
wander = { deviation = "250 mm" }
[[traffic.classes]]
name = "axle"
share = 1
axle_load = "100 kN"
inflation_pressure = "8 bar"
"""
SURFACE = """
[[criteria]]
name = "{name}"
place = "top"
layer = "top"
law = "fatigue-line"
epsilon_6 = "{epsilon_6} microstrain"
slope = {slope}
"""
AGED = SURFACE.replace('"fatigue-line"', '"aged-line"') + "hardening = 1\n"
BOTTOM = SURFACE.replace('"top"\nlayer', '"bottom"\nlayer')


@pytest.fixture(scope="module")
def life():
    text = (
        SURFACE.format(name="young", epsilon_6=90, slope=-0.2)
        + SURFACE.format(name="other slope", epsilon_6=90, slope=-0.25)
        + AGED.format(name="old", epsilon_6=90, slope=-0.2)
        + BOTTOM.format(name="bottom", epsilon_6=90, slope=-0.2)
    )
    return tl.run(Case.from_text(CASE + text), workers=1).life


def test_the_lines_are_those_that_criteria_of_these_laws_have(life):
    """A criterion by the young line has its years, one by the aged line those, to the last digit."""
    fresh, aged = (life.dataset[f"life_years_{name}_line"] for name in ("fresh", "aged"))
    assert float(fresh.sel(criterion="young")) == pytest.approx(life.years("young"), rel=1e-12)
    assert float(aged.sel(criterion="old")) == pytest.approx(life.years("old"), rel=1e-12)
    for name in ("young", "other slope", "old"):
        assert float(fresh.sel(criterion=name)) == pytest.approx(life.years("young"), rel=1e-12)
        assert float(aged.sel(criterion=name)) == pytest.approx(life.years("old"), rel=1e-12)
    # At the 10 to 40 microstrain of a surface the cores bear fewer.
    assert life.years("old") < life.years("young")
    assert math.isnan(float(fresh.sel(criterion="bottom")))


def test_the_rows_state_both(life):
    rows = {(row.group, row.key): row for row in life.rows()}
    young, old = rows["young", "life_years_fresh_line"], rows["young", "life_years_aged_line"]
    assert (young.label, old.label) == ("by the fresh line", "by the aged line")
    assert "ε₆ = 90 microstrain, slope -0.2" in young.note
    assert "ε₆ = 123 microstrain, slope -0.342" in old.note
    assert ("bottom", "life_years_fresh_line") not in rows


def test_a_file_keeps_them(life, tmp_path):
    tl.save_results(life, tmp_path / "life.nc")
    again = tl.open_results(tmp_path / "life.nc").life
    assert [str(row) for row in again.rows()] == [str(row) for row in life.rows()]


def test_only_a_tensile_strain_of_the_surface_has_lines():
    criteria = Case.from_text(
        CASE
        + SURFACE.format(name="a", epsilon_6=90, slope=-0.2)
        + BOTTOM.format(name="b", epsilon_6=90, slope=-0.2)
        + '[[criteria]]\nname = "c"\nplace = "top"\nlayer = "top"\nlaw = "power-law"\nreads = "horizontal_tension"\n'
        'reading_6 = "1 MPa"\nslope = -0.2\n'
        '[[criteria]]\nname = "d"\nplace = "top"\nlayer = "top"\nlaw = "mepdg-top-down"\nair_voids = 0.06\n'
        "binder_volume = 0.11\n"
    )
    road = criteria.build_road()
    each = [surface_lines(road, criterion) for criterion in criteria.build_criteria()]
    assert [len(lines) for lines in each] == [2, 0, 0, 2]
    # By the mix's own ε₆ where the law has none.
    assert each[3][0].epsilon_6 == 100e-6
    assert isinstance(each[0][0], FatigueLine)
    assert isinstance(each[0][1], AgedLine)


@pytest.mark.slow
def test_daily_thermal_stress_counts_in_both():
    air = "air = { months = [2, 3, 6, 9, 14, 17, 19, 18, 15, 11, 6, 3] }"
    text = CASE.replace(CASE[CASE.index("months = ") : CASE.index("[traffic]")], f"{air}\nparts_of_day = 1\n")
    made = tl.run(Case.from_text(text + SURFACE.format(name="young", epsilon_6=90, slope=-0.2)), workers=1).life
    assert made.weather_damage(0) > 0
    assert float(made.dataset["life_years_fresh_line"][0]) == pytest.approx(made.years("young"), rel=1e-9)
    assert np.isfinite(float(made.dataset["life_years_aged_line"][0]))
