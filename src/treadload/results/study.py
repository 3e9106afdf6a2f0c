"""Several results that answer one question together."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

import xarray as xr

from treadload.composing import BaseResult, small_picture
from treadload.describing import as_html


class Study(ABC):
    """Base of what holds several results by name, as the result of a case and what a file held do."""

    @property
    @abstractmethod
    def parts(self) -> Mapping[str, BaseResult]:
        """Results by their names in a tree."""

    @abstractmethod
    def to_tree(self) -> xr.DataTree:
        """All results in one tree with provenance, ready to be saved."""

    @abstractmethod
    def summary(self) -> str:
        """The results in a screenful."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of all parts, each once."""
        return tuple(dict.fromkeys(text for part in self.parts.values() for text in part.warnings))

    @property
    def stats(self) -> Mapping[str, Mapping[str, Any]]:
        """How every part was solved."""
        return {name: part.stats for name, part in self.parts.items()}

    @property
    def plot(self) -> PlotsOfParts:
        """Figures of the parts: `result.plot.contact.pressure()`."""
        return PlotsOfParts(self)

    def __str__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        """What a notebook shows: with the figure of the first part that has one."""
        pictures = (small_picture(part) for part in self.parts.values())
        picture = next((one for one in pictures if one is not None), None)
        return as_html(type(self).__name__, self.summary(), self.warnings, self.to_tree(), picture)


class PlotsOfParts:
    """Figures of the parts of a study, by their names."""

    def __init__(self, study: Study) -> None:
        self._parts = study.parts

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._parts:
            raise AttributeError(f"no part {name!r} to draw; there are {', '.join(self._parts)}")
        return self._parts[name].plot

    def __dir__(self) -> list[str]:
        return sorted(self._parts)
