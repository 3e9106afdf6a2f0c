"""Errors can be caught as what they are and as what they mean to Python."""

import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import treadload
from treadload.errors import (
    ConvergenceError,
    GeometryError,
    InputError,
    TreadloadError,
    how_to_install,
    meant,
    nearest,
    positive,
    reading,
)


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
    # Of an index and of a clone.
    root = Path(treadload.__file__).parent
    said = {path.name for path in root.rglob("*.py") if "pip install" in path.read_text(encoding="utf-8")}
    assert said == {"errors.py"}
    extras = tomllib.loads((root.parents[1] / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    asked = {
        name
        for path in root.rglob("*.py")
        for name in re.findall(r"how_to_install\(['\"](\w+)", path.read_text(encoding="utf-8"))
    }
    assert asked == {"app", "clouds", "cluster", "excel", "fringes", "scan", "study"}
    assert asked <= set(extras)
    assert how_to_install("scan") == "run  pip install 'treadload[scan]'  (in a clone  pip install '.[scan]')"


@pytest.mark.parametrize("value", [1, 5e-324, 1.7e308, np.float32(2.0), np.array(3.0)])
def test_finite_numbers_above_zero_are_positive(value):
    positive("modulus", value, "Pa")


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (0, "0"),
        (-5e9, "-5e+09"),
        (math.nan, "nan"),
        (math.inf, "inf"),
        ("5 GPa", "'5 GPa'"),
        (True, "True"),
        (None, "None"),
        ([0.1], "[0.1]"),
        (2j, "2j"),
    ],
)
def test_what_is_not_positive_is_told_with_the_number_the_bound_and_the_remedy(value, said):
    with pytest.raises(InputError) as refused:
        positive("modulus", value, "Pa", "asphalt is near 5e9")
    assert str(refused.value) == f"modulus must be a positive number of Pa, got {said}; asphalt is near 5e9"
    with pytest.raises(InputError) as refused:
        positive("load_ratio", value)
    assert str(refused.value) == f"load_ratio must be a positive number, got {said}"


def test_what_is_positive_is_said_in_one_place():
    # A second check of the same would come to say it in other words.
    root = Path(treadload.__file__).parent
    once_more = re.compile(r"not \(?(?:math|np)\.isfinite\(([\w.]+)\) and \1 > 0\)?:\s+raise")
    assert not [path for path in root.rglob("*.py") if once_more.search(path.read_text(encoding="utf-8"))]


def test_the_name_that_was_meant_whatever_its_capitals():
    known = ["Elastic", "Prony", "elastic_layer"]
    assert meant("ELASTIC", known) == meant("elastik", known) == "Elastic"
    assert meant("zzz", known) is None
    assert meant("pro", known) is not None
    assert meant("pro", known, cutoff=0.9) is None
    assert nearest("prony", known) == "did you mean 'Prony'?"
    assert nearest("zzz", known, "there are") == "there are Elastic, Prony, elastic_layer"


def test_the_nearest_name_is_sought_in_one_place():
    root = Path(treadload.__file__).parent
    seeking = [path.name for path in root.rglob("*.py") if "difflib" in path.read_text(encoding="utf-8")]
    assert seeking == ["errors.py"]


def broken_file():
    with reading("scan file 'a.ply'", "PLY"):
        raise ValueError("3 bytes are left")


def broken_library():
    with reading("scan file 'a.ply'", "PLY"):
        None.vertices  # noqa: B018


def test_a_name_that_a_library_lacks_is_never_the_fault_of_the_file():
    with pytest.raises(InputError, match=r"ValueError: 3 bytes are left.*truncated"):
        broken_file()
    with pytest.raises(InputError, match=r"AttributeError.*install another version") as caught:
        broken_library()
    assert "truncated" not in str(caught.value)
