"""What all results have in common, so that every verb takes what every verb gives.

A result carries its fields in `.dataset` and its numbers in `.rows()`, which summary, notebook and report render;
`.warnings` is what the user should know, `.stats` how it was solved, and `.plot` its figures. Its class names the
group that it takes in a tree of results; whoever defines a class of results has it written, read back and reported.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeAlias, TypeGuard, runtime_checkable

from treadload.deferred import xarray as xr
from treadload.describing import Described, as_html
from treadload.errors import InputError
from treadload.figure_registry import Plots
from treadload.registry import RESULTS
from treadload.variables import in_order


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
    further ones, "@" of points of the road, "y x" or "point", in any order.
    fields: variables and coordinates of numbers → their dimensions. not_nan: those with a number that is not NaN.
    maybe: as fields, of what may be missing. labels: coordinates of texts → their dimensions. values: coordinate →
    all the names that it has. each: dimension → field of the class with one entry for each of its places; where the
    entries have names, the coordinate has the same. sizes: dimension → fewest and most places.
    numbers, texts, lists, members: attributes that are finite numbers, texts, lists of texts as JSON, lists of texts.
    maybe_numbers: numbers of which some may be missing. together: attributes of which the first needs the others.
    reads: called with the dataset and the other fields of the class where they are known, to try what else is read
    of it; what it raises refuses the file.
    positive: fields and numbers that are above zero. above_zero: fields that are where they are not NaN. finite:
    fields without NaN and infinity. bounded: fields with a number somewhere and infinity nowhere. largest: field →
    largest size. codes: field → how many whole numbers from 0 it holds. with_it: variable → what it is read with.
    json: attributes that hold a list or a table as JSON, where they are there. tree: variables without which a part
    of a file has no meaning; a file is checked part by part as it is opened where the class gives some. agree: called
    with a dataset that is checked so far; what it raises refuses it. with_field: field of the class → what of `maybe`
    is there unless the field is None. stats: entries of `stats` of which the first needs the others, all numbers.
    """

    fields: Mapping[str, str] = field(default_factory=dict)
    not_nan: str = ""
    maybe: Mapping[str, str] = field(default_factory=dict)
    with_field: Mapping[str, str] = field(default_factory=dict)
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
    above_zero: str = ""
    finite: str = ""
    bounded: str = ""
    largest: Mapping[str, float] = field(default_factory=dict)
    codes: Mapping[str, int] = field(default_factory=dict)
    with_it: Mapping[str, str] = field(default_factory=dict)
    json: Mapping[str, type] = field(default_factory=dict)
    tree: str = ""
    agree: Callable[[xr.Dataset], object] | None = None
    sizes: Mapping[str, tuple[int, float]] = field(default_factory=dict)
    reads: Callable[[xr.Dataset, Mapping[str, Any]], object] | None = None


@dataclass(frozen=True)
class Columns:
    """How a report compares results of a class: in tables with a column for each case.

    rows: heading of the table of their numbers; empty where the report has tables for the class alone. stats: heading
    of the table of the solver's statistics; empty for none.
    """

    rows: str = ""
    stats: str = ""


class BaseResult(Described):
    """Base of all results: one question, one dataset, its numbers row by row.

    title: of the class, what it is in words. subject: of a page about results of the class alone. group: of the
    class, its name in a tree of results; `group_name` may distinguish results of one class. sections: names that it
    may give to parts of such a result, whose numbers are those of the whole. also: further names of it in files.
    columns: how a report compares results of several cases; None shows each by itself.
    holds: what a dataset from a file must have before it becomes an object of the class.
    """

    group: ClassVar[str]
    subject: ClassVar[str] = ""
    holds: ClassVar[Holds] = Holds()
    sections: ClassVar[tuple[str, ...]] = ()
    also: ClassVar[tuple[str, ...]] = ()
    columns: ClassVar[Columns | None] = None

    if TYPE_CHECKING:

        @property
        @abstractmethod
        def dataset(self) -> xr.Dataset:
            """Fields by name, with units and long names."""

        @property
        def stats(self) -> Mapping[str, object]:
            """How it was solved: iterations, residuals, seconds."""
            return MappingProxyType({})
    else:
        stats = MappingProxyType({})

    def __init_subclass__(cls, *, group: str | None = None, **more: object) -> None:
        super().__init_subclass__(**more)
        if group is not None:
            cls.group = group
            # Files name results by their class: two of one name are refused.
            RESULTS.register(cls.__name__)(cls)

    @property
    def group_name(self) -> str:
        """Name of this result in a tree, if it is not given another."""
        return self.group

    def cites(self) -> tuple[str, ...]:
        """Methods behind the result: keys of `treadload.citations.CITATIONS`, or whole references."""
        return ()

    @property
    def plot(self) -> Plots:
        """Figures of this result, see `treadload.plots`."""
        return Plots(self)

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return as_html(self.title, [self], self.warnings, self.dataset, small_picture(self))


Source: TypeAlias = "xr.Dataset | HasDataset"
"""What a verb reads fields from."""


def has_fields(value: object) -> TypeGuard[Source]:
    """Whether a value is a dataset, or a result that has one."""
    return isinstance(value, xr.Dataset | HasDataset)


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


def class_of_group(group: str) -> str:
    """Name of the class, the first defined, whose results take this group; empty where none does."""
    names = {name: (kind.group, *kind.sections, *kind.also) for name, kind in result_classes().items()}
    return next((name for name, groups in names.items() if group in groups), "")


def result_class(name: str) -> type[BaseResult] | None:
    """The class of results of this name, ours or another package's; None where no package here brings it.

    Raises InputError for a package that cannot be loaded.
    """
    return RESULTS.find(name).target if name in RESULTS.names() else None  # type: ignore[return-value]


def result_classes() -> dict[str, type[BaseResult]]:
    """All classes of results by name, ours and those that the session defined."""
    return {name: RESULTS.find(name).target for name in RESULTS.built_in()}  # type: ignore[misc]
