"""The parts of a case's result, each solved when something of it is first asked for."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property

import numpy as np
import xarray as xr

from treadload.case import Case, LifeCase
from treadload.composing import BaseResult
from treadload.contact import Contact, Crossing
from treadload.damage import Verdict
from treadload.response import MATERIAL_LENGTH, Response
from treadload.study.loaded import Loaded, Touch, contact_of, judge, load_case, on_two_grids
from treadload.study.run import crossing_of, read_loaded
from treadload.study.run_life import run_life
from treadload.study.sweeps.record import Values
from treadload.study.uniform import READINGS

CASE_PARTS = ("contact", "response", "damage", "slice_along", "slice_across", "bowl", "crossing")
LIFE_PARTS = ("life", "sensitivity")
# Where a name without a part is looked for, in this order.
_SEARCHED = ("contact", "response", "damage")
# Of a crossing, the largest over its positions.
_PEAKS = ("largest_pressure", "edge_pressure")


def quiet(text: str) -> None:
    """Progress of a study is counted in cases."""


class Parts(ABC):
    """Results of one case. searched: parts in which a name without one is looked for."""

    searched: tuple[str, ...]

    @abstractmethod
    def dataset(self, part: str) -> xr.Dataset | None:
        """The fields of a part; None where the case has none."""

    @abstractmethod
    def numbers(self) -> Mapping[str, Values]:
        """What is kept of every case."""

    @abstractmethod
    def coordinates(self) -> Mapping[str, np.ndarray]:
        """Coordinates of the numbers."""

    @property
    @abstractmethod
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of the parts that were solved, each once."""


def _of_dataset(data: xr.Dataset, also: tuple[str, ...] = ()) -> dict[str, Values]:
    """Numbers of a dataset: those without dimensions, and those over a single one of `also`."""
    kept = ((), *((dim,) for dim in also))
    return {
        str(name): (tuple(map(str, one.dims)), one.to_numpy())
        for name, one in data.data_vars.items()
        if one.dims in kept and one.dtype.kind in "fiub"
    }


class CaseParts(Parts):
    """Parts of a case of a wheel. contact: of it, where it is known already. touch: solves what else it asks for."""

    searched = _SEARCHED

    def __init__(self, case: Case, *, contact: Contact | None = None, touch: Touch = contact_of) -> None:
        self.case = case
        self._known, self._touch = contact, touch
        self._solved: dict[str, BaseResult] = {}

    @cached_property
    def load(self) -> Loaded:
        """The road and its wheels."""
        return load_case(self.case, quiet, contact=self._known, touch=self._touch)

    @cached_property
    def mean(self) -> Response:
        """The response as surface criteria read it: means over a length of road near the surface."""
        case, load = self.case, self.load
        own = None if case.damage is None or case.damage.depth is not None else case.damage.mean_over
        return load.solve(case.response.depths, mean_over=own or MATERIAL_LENGTH, loads=load.read_wheels)

    @cached_property
    def points(self) -> Response:
        """The response at points, as `run_case` keeps it."""
        points = self.load.solve(self.case.response.depths)
        self._solved["response"] = points
        return points

    @cached_property
    def verdict(self) -> Verdict | None:
        """The verdict of the case."""
        damage = self.case.damage
        if damage is None:
            return None
        # A verdict at a depth reads points; one of a mean reads it as it is.
        verdict = judge(self.load, self.points if damage.depth is not None else self.mean)
        if damage.error_estimate:
            verdict = on_two_grids(self.load, verdict)
        self._solved["damage"] = verdict
        return verdict

    @cached_property
    def crossing(self) -> Crossing | None:
        """The way over the obstacle of the case."""
        if self.case.crossing is None:
            return None
        way = crossing_of(self.case, self.load)
        self._solved["crossing"] = way
        return way

    @cached_property
    def _sections(self) -> Mapping[str, BaseResult]:
        return read_loaded(self.load).parts

    def dataset(self, part: str) -> xr.Dataset | None:
        """The fields of a part; None where the case has none."""
        if part == "contact":
            result: BaseResult | None = self.load.contact or self.load.footprint
        elif part == "response":
            result = self.points
        elif part == "damage":
            result = self.verdict
        elif part == "crossing":
            result = self.crossing
        else:
            result = self._sections.get(part)
        return None if result is None else result.dataset

    def numbers(self) -> dict[str, Values]:
        """Numbers of contact, verdict and crossing; the largest strains and stress of the plane at every depth."""
        contact = self.load.contact
        told: dict[str, Values] = {}
        if contact is not None:
            data = contact.dataset
            told |= _of_dataset(data)
            shear = np.hypot(data["traction_x"].to_numpy(), data["traction_y"].to_numpy())
            area = contact.area
            measures = {
                "net_area": area,
                "mean_pressure": float(data["normal_load"]) / area if area else math.nan,
                "largest_pressure": float(data["pressure"].max()),
                "largest_traction": float(shear.max()),
                "slip_fraction": contact.slip_fraction,
            }
            told |= {name: ((), np.array(value)) for name, value in measures.items()}
        mean = self.mean.dataset
        told |= {name: (("depth",), quantity.values(mean).max(axis=(1, 2))) for name, quantity in READINGS.items()}
        verdict, way = self.dataset("damage"), self.dataset("crossing")
        if verdict is not None:
            told |= _of_dataset(verdict)
        if way is not None:
            told |= _of_dataset(way) | {f"max_{name}": ((), np.array(float(way[name].max()))) for name in _PEAKS}
        return told

    def coordinates(self) -> dict[str, np.ndarray]:
        """The depths."""
        return {"depth": self.mean.dataset["depth"].to_numpy()}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of the parts that were solved, each once."""
        contact = [] if self.load.contact is None else list(self.load.contact.warnings)
        said = [*contact, *self.mean.warnings, *(text for one in self._solved.values() for text in one.warnings)]
        return tuple(dict.fromkeys(said))


class LifeParts(Parts):
    """Parts of a design case. sensitivity: True if something of it is asked for."""

    searched = LIFE_PARTS

    def __init__(self, case: LifeCase, *, sensitivity: bool = False) -> None:
        self._result = run_life(case, sensitivity=sensitivity, workers=1)

    def dataset(self, part: str) -> xr.Dataset | None:
        """The fields of a part; None where the case has none."""
        result = self._result.parts.get(part)
        return None if result is None else result.dataset

    def numbers(self) -> dict[str, Values]:
        """Numbers of every criterion, and which fails first."""
        life = self._result.life
        return _of_dataset(life.dataset, ("criterion",)) | {
            "governing": ((), np.array(life.governing)),
            "governing_years": ((), np.array(life.years(life.governing))),
        }

    def coordinates(self) -> dict[str, np.ndarray]:
        """The criteria."""
        return {"criterion": self._result.life.dataset["criterion"].to_numpy()}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, each once."""
        return self._result.warnings
