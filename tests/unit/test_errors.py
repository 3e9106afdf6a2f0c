"""Errors can be caught as what they are and as what they mean to Python."""

import math
import re
import tomllib
from pathlib import Path

import pytest

import treadload
from treadload.errors import ConvergenceError, GeometryError, InputError, TreadloadError, how_to_install


@pytest.mark.parametrize(
    ("error", "family"), [(InputError, ValueError), (GeometryError, ValueError), (ConvergenceError, RuntimeError)]
)
def test_families(error, family):
    assert issubclass(error, TreadloadError)
    assert issubclass(error, family)


def test_convergence_error_carries_its_residual():
    assert ConvergenceError("stopped", 0.3).residual == 0.3
    assert math.isnan(ConvergenceError("stopped").residual)
    assert str(ConvergenceError("stopped", 0.3)) == "stopped"


def test_what_to_install_is_said_in_one_place_and_names_an_extra_that_there_is():
    # Nothing is released: only `pip install '.[extra]'` in a clone works.
    root = Path(treadload.__file__).parent
    said = {path.name for path in root.rglob("*.py") if "pip install" in path.read_text(encoding="utf-8")}
    assert said == {"errors.py"}
    extras = tomllib.loads((root.parents[1] / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    asked = {
        name
        for path in root.rglob("*.py")
        for name in re.findall(r"how_to_install\(['\"](\w+)", path.read_text(encoding="utf-8"))
    }
    assert asked == {"scan", "excel"}
    assert asked <= set(extras)
    assert how_to_install("scan").endswith("run  pip install '.[scan]'")
