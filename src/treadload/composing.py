"""What all results have in common, so that every verb takes what every verb gives.

A result carries its fields in `.dataset`, sums itself up in `.summary()` and tells the user in `.warnings` what to
know, how it was solved in `.stats`, and draws itself by `.plot`. Its class names the group that it takes in a tree of
results; whoever defines a class of results has it written, read back and reported.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, runtime_checkable

import xarray as xr

from treadload.accessors import offered, room_of
from treadload.describing import as_html
from treadload.errors import InputError
from treadload.variables import in_order

_CLASSES: dict[str, type[BaseResult]] = {}


@runtime_checkable
class HasDataset(Protocol):
    """A result, or whatever else carries its fields in `.dataset`."""

    @property
    def dataset(self) -> xr.Dataset:
        """Fields by name."""


@dataclass(frozen=True)
class Holds:
    """What the dataset of a class of results must hold so that its methods can read it; a file without is refused.

    Names are words with blanks between, and so are the dimensions behind them: "" of a single number, "..." for any
    further ones, in any order.
    fields: variables and coordinates of numbers → their dimensions. known: those with a number that is not NaN.
    maybe: as fields, of what may be missing. labels: coordinates of texts → their dimensions. values: coordinate →
    all the names that it has. each: dimension → field of the class with one entry for each of its places; where the
    entries have names, the coordinate has the same. sizes: dimension → fewest and most places.
    numbers, texts, lists, members: attributes that are finite numbers, texts, lists of texts as JSON, lists of texts.
    maybe_numbers: numbers of which some may be missing. together: attributes of which the first needs the others.
    reads: called with the dataset and the other fields of the class where they are known, to try what else is read
    of it; what it raises refuses the file.
    positive: fields and numbers that are above zero. asked: field of the class → what of `maybe` is there unless the
    field is None. stats: entries of `stats` of which the first needs the others, all numbers.
    """

    fields: Mapping[str, str] = field(default_factory=dict)
    known: str = ""
    maybe: Mapping[str, str] = field(default_factory=dict)
    asked: Mapping[str, str] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    each: Mapping[str, str] = field(default_factory=dict)
    numbers: str = ""
    texts: str = ""
    lists: str = ""
    members: str = ""
    maybe_numbers: str = ""
    together: tuple[str, ...] = ()
    stats: tuple[str, ...] = ()
    positive: str = ""
    sizes: Mapping[str, tuple[int, float]] = field(default_factory=dict)
    reads: Callable[[xr.Dataset, Mapping[str, Any]], object] | None = None


class BaseResult(ABC):
    """Base of all results: one question, one dataset, one summary.

    group: of the class, its name in a tree of results; `group_name` may tell results of one class apart.
    holds: what a dataset from a file must have before it becomes an object of the class.
    """

    group: ClassVar[str]
    holds: ClassVar[Holds] = Holds()

    if TYPE_CHECKING:

        @property
        @abstractmethod
        def dataset(self) -> xr.Dataset:
            """Fields by name, with units and long names."""

        @property
        def stats(self) -> Mapping[str, Any]:
            """How it was solved: iterations, residuals, seconds."""
            return MappingProxyType({})

        @property
        def warnings(self) -> tuple[str, ...]:
            """Sentences for the user."""
            return ()
    else:
        stats = MappingProxyType({})
        warnings = ()

    def __init_subclass__(cls, *, group: str | None = None, **more: Any) -> None:
        super().__init_subclass__(**more)
        if group is not None:
            cls.group = group
            before = _CLASSES.get(cls.__name__)
            # A notebook cell that is run again defines the same class again.
            if before is not None and (before.__module__, before.__qualname__) != (cls.__module__, cls.__qualname__):
                raise InputError(
                    f"the class of results {cls.__name__!r} is {before.__module__}.{before.__qualname__} already, so "
                    f"that {cls.__module__}.{cls.__qualname__} cannot be: files name results by their class; give it "
                    "another name"
                )
            _CLASSES[cls.__name__] = cls

    @property
    def group_name(self) -> str:
        """Name of this result in a tree, if it is not given another."""
        return self.group

    @property
    def plot(self) -> Any:
        """Figures of this result, see `treadload.plots`."""
        return offered("plot", self)

    @abstractmethod
    def summary(self) -> str:
        """The result in a screenful."""

    def __str__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return as_html(type(self).__name__, self.summary(), self.warnings, self.dataset, small_picture(self))


Source = xr.Dataset | HasDataset
"""What a verb reads fields from."""


def dataset_of(source: Source) -> xr.Dataset:
    """The fields of a result, or of a dataset, their dimensions in order. Raises InputError for anything else."""
    if isinstance(source, xr.Dataset):
        return in_order(source)
    if isinstance(source, HasDataset):
        return in_order(source.dataset)
    raise InputError(
        f"this takes a result of treadload or its dataset, got {type(source).__name__}; give what a verb such as "
        "solve_response returned"
    )


def small_picture(result: BaseResult) -> bytes | None:
    """A small PNG of the figure that stands for a result, for a notebook; None where none can be drawn."""
    try:
        image: bytes | None = result.plot.thumbnail()
    # A figure of whatever kind, ours or another package's, must not hide the numbers beside it.
    except Exception:
        return None
    return image


def result_classes() -> dict[str, type[BaseResult]]:
    """All classes of results by name, those of every room."""
    room_of("result")
    return dict(_CLASSES)
