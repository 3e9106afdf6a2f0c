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


def test_a_case_on_texture_runs_is_saved_and_opens_again(tmp_path):
    case = Case.from_text(COARSE_CASE + SPECTRUM)
    assert Case.from_text(case.to_toml()) == case
    result = tl.run_case(case)
    assert result.texture is not None
    assert "mm² touch" in result.summary()
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
