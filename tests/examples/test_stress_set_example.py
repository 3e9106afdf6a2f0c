"""The open set of contact stresses: its store, its figure, and footprints between its cases, small."""

import runpy
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

SET = Path(__file__).parents[2] / "examples" / "stress_set" / "set.py"


@pytest.fixture
def example():
    return runpy.run_path(str(SET))


def coarse(example):
    """The base case on cells of 12 mm, and a set of one new tire, whose cross-sections travel in the package."""
    example["TIRES"] = example["wide_design"].__globals__["TIRES"] = example["TIRES"][:1]
    example["wide_design"].__globals__["WEARS"] = (0.0,)
    case = example["tl"].Case.from_toml(example["CASE"], changes=['spacing="12 mm"'])
    return case, example["wide_design"](case, 8)


def test_the_set_is_one_store_and_resumes_bit_for_bit(example, tmp_path, capsys):
    case, design = coarse(example)
    tl = example["tl"]

    def interrupted(done, total, what):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tl.sweep(case, design, fields=example["FIELDS"], store=tmp_path / "study.zarr", progress=interrupted)
    assert 0 < tl.sweeps.open_sweep(tmp_path / "study.zarr").stats["solved"] < 8
    study = example["solve"](case, design, tmp_path / "study.zarr", 1)
    whole = tl.sweep(case, design, fields=example["FIELDS"]).dataset
    for name in (*example["FIELDS"], "tractive_force", "lateral_force", "largest_pressure"):
        assert np.array_equal(study.dataset[name].to_numpy(), whole[name].to_numpy(), equal_nan=True)
    example["publish"](study, tmp_path / "stress_set.zarr")
    assert "kB a case" in capsys.readouterr().out
    data = xr.open_zarr(tmp_path / "stress_set.zarr")
    assert data.attrs["Conventions"] == "CF-1.11"
    assert data.attrs["license"] == "CC-BY-4.0"
    assert data.pressure.attrs["units"] == "Pa"
    assert data.pressure.dtype == np.float32
    assert (data.status == 1).all()
    # Slip angles to one side, and friction as a bound of every cell.
    bound = data.friction * data.pressure
    assert bool((np.hypot(data.traction_x, data.traction_y) <= bound * (1 + 1e-5) + 1).where(bound > 0, True).all())
    assert float(data.creepage_y.min()) >= 0
    assert float(np.abs(data.normal_load / data.solved_normal_load - 1).max()) < 1e-5


def test_rows_of_ribs_and_their_outward_shear(example):
    case, _ = coarse(example)
    y = np.arange(-0.15, 0.15, 0.003)
    ribs = [example["rib_rows"](case, y, rib) for rib in range(-2, 3)]
    assert not np.any(np.sum(ribs, axis=0) > 1)
    # Ribs of 48.6 mm and shoulder ribs of 48.6 mm.
    assert all(15 <= rows.sum() <= 17 for rows in ribs)
    here = ribs[2]
    pressure = np.ones((here.sum(), 4))
    across = 0.3 * np.sign(y[here] - y[here].mean())[:, None] * pressure
    assert example["outward"](pressure, across, y[here]) == pytest.approx(0.3, rel=0.1)


@pytest.mark.slow
def test_the_figure_shows_what_the_page_states(example, tmp_path):
    values = example["lines"](tmp_path, spacing="12 mm")
    friction, wear = values["friction, rib 0"], values["wear, rib 0"]
    assert friction[-1] > friction[0]
    assert wear[-1] < wear[0]
    assert (tmp_path / "stress_set.png").stat().st_size > 20_000


@pytest.mark.slow
def test_footprints_between_cases_meet_their_bound(example, tmp_path):
    example["between"].__globals__["HELD_BACK"] = 10
    found = example["between"](tmp_path, 64, spacing="12 mm")
    for name in example["FIELDS"]:
        # 3 % of the mean pressure with 200 cases; 76 on coarse cells.
        assert float((found[f"{name}_error"] ** 2).mean()) ** 0.5 < 0.05
    assert float(np.abs(found.resultant_error.sel(resultant="normal_load")).max()) < 1e-6
