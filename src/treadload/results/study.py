"""Several results that answer one question together."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from treadload.composing import BaseResult, small_picture
from treadload.deferred import xarray as xr
from treadload.describing import Described, as_html
from treadload.rows import Row


class Study(Described):
    """Base of what holds several results by name, as the result of a case and what a file held do.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0, 0.1])
    >>> study: tl.results.Study = tl.results.Results(tl.results.to_tree(response))
    >>> [row.label for row in study.rows() if row.unit == "microstrain"]
    ['tensile strain, three-dimensional', 'tensile strain, horizontal plane']
    """

    if TYPE_CHECKING:

        @property
        @abstractmethod
        def parts(self) -> Mapping[str, BaseResult]:
            """Results by their names in a tree."""

    @abstractmethod
    def to_tree(self) -> xr.DataTree:
        """All results in one tree with provenance, ready to be saved."""

    def rows(self) -> tuple[Row, ...]:
        """The rows of all parts, grouped by part."""
        return tuple(
            replace(row, group=f"{part.title}, {row.group}" if row.group else part.title)
            for part in self.parts.values()
            for row in part.rows()
        )

    def text(self) -> str:
        """The results in a screenful, part by part."""
        return "\n\n".join(part.text() for part in self.parts.values())

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

    def _repr_html_(self) -> str:
        """What a notebook shows: with the figure of the first part that has one."""
        pictures = (small_picture(part) for part in self.parts.values())
        picture = next((picture for picture in pictures if picture is not None), None)
        return as_html(
            self.title or type(self).__name__, [*self.parts.values()], self.warnings, self.to_tree(), picture
        )


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
