"""The table [texture] of a case."""

from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.case import Case

SPECTRUM = """
[texture]
rubber = { kind = "elastic", modulus = "6 MPa", poisson = 0.5 }
size = "50 mm"
spacing = "1.5625 mm"
hurst = 0.8
shortest = "8 mm"
roll_off = "20 mm"
rms_height = "0.2 mm"
seed = 3
"""
LASER = Path(__file__).parents[1] / "data" / "texture" / "aylesbury_station_0_cut.dat"
FILE = f"""
[texture]
rubber = {{ kind = "elastic", modulus = "6 MPa", poisson = 0.5 }}
file = "{LASER.as_posix()}"
outliers = 6.0
shortest = "2.4 mm"
thickness = "15 mm"
"""


@pytest.mark.usefixtures("figures_as_dots")
def test_a_case_on_texture_runs_is_saved_and_opens_again(tmp_path):
    case = Case.from_text(COARSE_CASE + SPECTRUM)
    assert Case.from_text(case.to_toml()) == case
    result = tl.run(case)
    assert result.texture is not None
    assert "real contact area" in result.summary()
    path = tl.save_results(result, tmp_path / "r.nc")
    opened = tl.open_results(path)
    np.testing.assert_array_equal(opened["texture"].dataset.pressure, result.texture.dataset.pressure)
    assert opened["texture"].summary() == result.texture.summary()
    page = tl.report(opened, tmp_path / "r.html")
    assert "Rubber on texture" in Path(page).read_text(encoding="utf-8")


def test_a_measured_profile_is_treated_and_touched():
    texture = Case.from_text(COARSE_CASE + FILE).texture.build(None)
    assert texture.dropouts == 0
    assert texture.finest_wave == pytest.approx(2.4e-3)
    assert len(texture.treated) == 4
    # Chip seal: some millimetres between its stones.
    assert 1e-3 < np.ptp(texture.heights) < 15e-3

    assert "case.texture" not in tl.steps.case_as_python(Case.from_text(COARSE_CASE + SPECTRUM))
    assert "'texture'" in tl.steps.case_as_python(Case.from_text(COARSE_CASE + SPECTRUM))


RESOLVED = """
[texture]
resolved = true
size = "144 mm"
spacing = "12 mm"
hurst = 0.8
shortest = "72 mm"
rms_height = "1 mm"
seed = 3
"""


def test_the_whole_tire_rolls_on_a_resolved_texture():
    """As `solve_contact(relief=...)` has it; its load is met, and its peaks stand above those of the plane."""
    case = Case.from_text(COARSE_CASE + RESOLVED)
    assert Case.from_text(case.to_toml()) == case
    result = tl.run(case)
    road, relief = case.build_road(), case.texture.build(None)
    same = tl.solve_contact(case.build_tire(), road, case.build_rolling(), spacing=12e-3, relief=relief)
    np.testing.assert_array_equal(result.contact.dataset.pressure, same.dataset.pressure)
    assert "no plane: " in result.summary()
    assert result.texture is None
    plain = tl.solve_contact(case.build_tire(), road, case.build_rolling(), spacing=12e-3).dataset
    assert float(same.dataset.pressure.max()) > 1.1 * float(plain.pressure.max())
    assert "under the whole tire" in tl.plan(case)


@pytest.mark.slow
def test_the_layers_feel_the_enveloped_pressure(tmp_path):
    case = Case.from_text(COARSE_CASE + RESOLVED + 'enveloping = "60 mm"\n')
    result = tl.run(case)
    spread = tl.contact.envelop(result.contact, 0.06)
    np.testing.assert_array_equal(result.enveloped.dataset.pressure, spread.dataset.pressure)
    # The response is under the spread pressure: straight below the wheel the surface bears it.
    x, y = (float(spread.dataset[name][spread.dataset.sizes[name] // 2]) for name in "xy")
    below = -float(result.response.dataset.stress_zz.sel(depth=0.0, x=x, y=y, method="nearest"))
    assert below == pytest.approx(float(spread.dataset.pressure.sel(x=x, y=y, method="nearest")), rel=1e-3)
    opened = tl.open_results(tl.save_results(result, tmp_path / "r.nc"))
    assert opened.enveloped.summary() == result.enveloped.summary()
    assert opened.enveloped.summary() in opened.summary()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('seed = 3', 'rubber = { modulus = "6 MPa", poisson = 0.5 }', "rubber is of a patch"),
        ('seed = 3', 'thickness = "15 mm"', "thickness is of a patch"),
        ('resolved = true', '', "'rubber' is missing"),
        ('resolved = true', 'rubber = { modulus = 6e6, poisson = 0.5 }\nenveloping = "3 cm"', "give resolved = true"),
        ('seed = 3', 'enveloping = "0 mm"', "enveloping must be a positive number"),
        ('spacing = "12 mm"', 'spacing = "18 mm"', "points every 18 mm, and the cells of the contact are 12 mm"),
    ],
)  # fmt: skip
def test_a_resolved_texture_that_cannot_be_is_refused(old, new, told):
    """A texture whose points lie further apart than the cells of the contact is one of them."""
    assert old in RESOLVED
    with pytest.raises(tl.InputError, match=told):
        Case.from_text(COARSE_CASE + RESOLVED.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('hurst = 0.8', 'hurst = 8', "hurst must lie in"),
        ('size = "50 mm"', '', "'size' is missing"),
        ('seed = 3', 'file = "road.crg"', "is of a spectrum, and file of a measurement"),
        ('seed = 3', 'units = "mm"', "units is of a file"),
        ('seed = 3', 'thickness = "0 mm"', "thickness"),
        ('modulus = "6 MPa"', 'modulus = "-6 MPa"', "modulus"),
        ('kind = "elastic", modulus = "6 MPa"', 'kind = "prony", modulus = "6 MPa", terms = [[0.5, "1 s"]]',
         "give the speed in"),
    ],
)  # fmt: skip
def test_a_table_that_cannot_be_is_refused(old, new, told):
    assert old in SPECTRUM
    with pytest.raises(tl.InputError, match=told):
        Case.from_text(COARSE_CASE + SPECTRUM.replace(old, new))
