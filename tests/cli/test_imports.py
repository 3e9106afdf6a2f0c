"""Which libraries a command loads before it solves anything: the cost of a cold start."""

import subprocess
import sys

import pytest

HEAVY = {
    "h5py",
    "h5netcdf",
    "matplotlib",
    "numpy",
    "pint",
    "plotly",
    "scipy.optimize",
    "scipy.stats",
    "trimesh",
    "xarray",
}
CASE = ("numpy", "xarray")


@pytest.mark.parametrize(
    ("arguments", "may"),
    [
        (["--help"], set()),
        (["--version"], set()),
        (["init"], set()),
        (["init", "life", "-o", "life.toml"], set()),
        (["catalogue", "mixes"], {*CASE}),
        (["criteria"], {*CASE}),
        (["schema"], {*CASE, "h5py", "h5netcdf"}),
        (["run", "case.toml", "--dry-run"], {*CASE, "h5py", "h5netcdf", "scipy.optimize"}),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_command_loads_what_it_needs(arguments, may, tmp_path):
    code = f"""
import sys
from treadload.cli import main
sys.argv = ["treadload", *{arguments!r}]
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
finally:
    print(*[name for name in {sorted(HEAVY)!r} if name in sys.modules], file=sys.stderr)
"""
    if "case.toml" in arguments:
        subprocess.run([sys.executable, "-m", "treadload", "init"], cwd=tmp_path, check=True, capture_output=True)
    ran = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, encoding="utf-8")
    assert ran.returncode == 0, ran.stderr
    assert set(ran.stderr.splitlines()[-1].split()) <= may
