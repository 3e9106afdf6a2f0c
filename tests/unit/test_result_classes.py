"""Classes of results that another package defines: annotations of any kind, and names that are taken."""

from dataclasses import dataclass
from typing import Any, TypedDict

import pytest
import xarray as xr

import treadload as tl
from treadload import composing
from treadload.composing import BaseResult
from treadload.errors import InputError
from treadload.registry import RESULTS
from treadload.results.holding import result_of
from treadload.rows import Row


class Line(TypedDict):
    name: str


@pytest.fixture
def classes(monkeypatch):
    """Classes that are defined here are forgotten behind the test."""
    composing.result_classes()
    monkeypatch.setattr(RESULTS, "_built_in", dict(RESULTS._built_in))


def test_a_field_of_anything_is_read_back(classes, tmp_path):
    @dataclass(frozen=True, eq=False)
    class Loose(BaseResult, group="loose"):
        dataset: xr.Dataset
        note: Any

        def rows(self):
            return (Row("a", "loose", 1.0),)

    tl.save_results(Loose(xr.Dataset({"a": 1.0}), {"k": [1, 2]}), tmp_path / "loose.nc")
    assert tl.open_results(tmp_path / "loose.nc").loose.note == {"k": [1, 2]}


def test_an_annotation_that_no_value_can_be_compared_with_is_named(classes):
    @dataclass(frozen=True, eq=False)
    class Tied(BaseResult, group="tied"):
        dataset: xr.Dataset
        row: Line

        def rows(self):
            return (Row("a", "tied", 1.0),)

    with pytest.raises(InputError, match=r"field row of Tied is annotated .*Line.*with a class, or with Any"):
        result_of(Tied, {"dataset": xr.Dataset(), "row": {"name": "x"}}, "a file")


def test_two_classes_of_results_of_one_name_are_refused_by_both_names(classes):
    with pytest.raises(InputError, match=r"'Contact' is treadload\.contact.*Contact already.*give it another name"):

        class Contact(BaseResult, group="mine"):
            def rows(self):
                return (Row("a", "mine", 1.0),)

    assert composing.result_classes()["Contact"] is tl.contact.Contact

    def again():
        class Mine(BaseResult, group="mine"):
            def rows(self):
                return (Row("a", "mine", 1.0),)

        return Mine

    # A cell of a notebook that is run once more.
    again()
    newest = again()
    assert composing.result_classes()["Mine"] is newest
