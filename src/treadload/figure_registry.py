"""Figures of results, registered where they are drawn: `result.plot`, report, page and reference list them.

A drawing function takes a result, or its dataset, and its decorator states which:

    @figure("Contact", title="Contact pressure", caption="Seen from above.", main=True)
    def pressure(contact, *, ax=None): ...

`contact.plot.pressure()` draws it from then on. In another package the module is loaded with the class of results
that it defines, or an entry point names the function:

    [project.entry-points."treadload.figures"]
    "Contact.hexagons" = "my_figures:hexagons"
"""

from __future__ import annotations

import functools
import inspect
import io
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias, TypeVar

from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.registry import COMPARISONS, FIGURES, RESULTS, Entry, Registry
from treadload.us_units import display_units

Draw = TypeVar("Draw", bound=Callable[..., object])
Words: TypeAlias = "str | Callable[[xr.Dataset], str]"


@dataclass(frozen=True)
class Drawing:
    """A picture of a figure in a report. options: of its function. title, caption: in place of the figure's.

    negligible: why there is nothing to see, a sentence that a report has in place of the picture.
    """

    options: Mapping[str, object] = field(default_factory=dict)
    title: str = ""
    caption: str = ""
    negligible: str = ""


When = Callable[..., bool | Iterable[Drawing]]


@dataclass(frozen=True)
class RegisteredFigure:
    """A drawing function of a class of results, see `figure`. result, name: `result.plot.NAME` draws it."""

    draw: Callable[..., object]
    result: str
    name: str
    title: Words = ""
    caption: Words = ""
    when: When | None = None
    main: bool = False
    wide: bool = False
    order: float = math.inf
    answers: bool = False

    def drawings(self, data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> list[Drawing]:
        """Its pictures in a report. data: of the result. beside: other results of the case by their kind."""
        return [drawing for drawing in self._all(data, beside) if not drawing.negligible]

    def negligible(self, data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> list[Drawing]:
        """Its pictures that show nothing, with the reason of each. data, beside: as of `drawings`."""
        return [drawing for drawing in self._all(data, beside) if drawing.negligible]

    def drawings_of_several(self, datasets: list[xr.Dataset]) -> list[Drawing]:
        """Pictures of a comparison. datasets: of the same class, each of another case."""
        return self._drawings(datasets[0], (datasets,))

    def _all(self, data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> list[Drawing]:
        return self._drawings(data, (data, beside)) if self.title else []

    def _drawings(self, data: xr.Dataset, arguments: tuple[object, ...]) -> list[Drawing]:
        wanted: bool | Iterable[Drawing] = True
        if self.when is not None:
            # Few conditions need the other results of the case.
            wanted = self.when(*arguments[: len(inspect.signature(self.when).parameters)])
        each = ([Drawing()] if wanted else []) if isinstance(wanted, bool) else list(wanted)
        return [
            Drawing(
                drawing.options,
                drawing.title or _text(self.title, data),
                drawing.caption or _text(self.caption, data),
                drawing.negligible,
            )
            for drawing in each
        ]


def figure(
    *results: str,
    name: str = "",
    title: Words = "",
    caption: Words = "",
    when: When | None = None,
    main: bool = False,
    wide: bool = False,
    order: float = math.inf,
    answers: bool = False,
) -> Callable[[Draw], Draw]:
    """Decorator of a function that draws results: its first argument is one of them, or its dataset.

    results: names of their classes. name: of the method of `.plot`; left out, that of the function. title, caption:
    in a report and on a page, texts or functions of the dataset; without a title it is drawn by `.plot` only. when:
    function of the dataset, and of the other results of the case by kind if it takes two arguments: True where the
    figure is shown, or the pictures that are, each a `Drawing`; left out, always. main: the figure that a notebook
    shows small. wide: takes the full width of a page. order: of the figures of a result; left out, as registered.
    answers: the figure that a report begins with; left out, the main one is.
    Raises InputError for a name that another function has already.
    """

    def keep(draw: Draw) -> Draw:
        for result in results:
            called = name or draw.__name__
            kept = RegisteredFigure(draw, result, called, title, caption, when, main, wide, order, answers)
            _keep(FIGURES, f"{result}.{called}", draw, kept)
        return draw

    return keep


def comparison(
    result: str, *, title: str, caption: str, when: When | None = None, wide: bool = True, answers: bool = False
) -> Callable[[Draw], Draw]:
    """Decorator of a function that draws results of several cases: their datasets first, then a label of each.

    result: name of their class. when: function of the list of datasets, as of `figure`. title, caption, wide,
    answers: as there. A function that is a figure as well is not drawn for each case once more. Raises InputError as
    `figure`.
    """

    def keep(draw: Draw) -> Draw:
        kept = RegisteredFigure(draw, result, draw.__name__, title, caption, when, wide=wide, answers=answers)
        _keep(COMPARISONS, f"{result}.{draw.__name__}", draw, kept)
        return draw

    return keep


def figures_of(*classes: str) -> list[RegisteredFigure]:
    """The figures of a class of results in their order; one whose package is broken raises when it is drawn.

    classes: name of the class and of those that it is derived from, see `classes_of`.
    """
    figures = [_load(FIGURES, key) for key in _keys(classes).values()]
    return sorted(figures, key=lambda item: item.order)


def comparisons() -> list[RegisteredFigure]:
    """The figures of results of several cases."""
    return [_load(COMPARISONS, key) for key in COMPARISONS.names()]


def classes_of(name: str) -> tuple[str, ...]:
    """Names of a class of results and of those that it is derived from; the name alone where it is not known."""
    try:
        kind = RESULTS.find(name).target
    except InputError:
        return (name,)
    return tuple(cls.__name__ for cls in inspect.getmro(kind)) if isinstance(kind, type) else (name,)


class Plots:
    """Figures of a result: `result.plot.NAME(...)` draws one, `dir(result.plot)` lists them.

    Each takes `units="us"` besides its own options, for axes, colour bars and texts in US units.
    """

    def __init__(self, result: object) -> None:
        self._result = result

    def __getattr__(self, name: str) -> Callable[..., object]:
        keys = {} if name.startswith("_") else self._keys()
        if name not in keys:
            kind = type(self._result).__name__
            there = f"; {nearest(name, sorted(keys), 'there are')}" if keys else ""
            raise AttributeError(f"{kind} has no figure {name!r}{there}")
        return _bound(_load(FIGURES, keys[name]), self._result)

    def __dir__(self) -> list[str]:
        return sorted([*self._keys(), "main", "thumbnail"])

    def __repr__(self) -> str:
        drawn = figures_of(*self._classes())
        lines = [f"  {item.name}: {(inspect.getdoc(item.draw) or '').partition(chr(10))[0]}" for item in drawn]
        return "\n".join([f"figures of {type(self._result).__name__}", *(lines or ["  none"])])

    @property
    def main(self) -> str:
        """Name of the figure that stands for the result where there is little room; "" for none."""
        return next((item.name for item in figures_of(*self._classes()) if item.main), "")

    def thumbnail(self) -> bytes | None:
        """A small PNG of the main figure; None where no figure is drawn without options."""
        if not self.main:
            return None
        drawn = getattr(self, self.main)()
        if hasattr(drawn, "thumbnail"):
            image: bytes = drawn.thumbnail()
            return image
        stream = io.BytesIO()
        drawn.savefig(stream, format="png")
        return stream.getvalue()

    def _classes(self) -> tuple[str, ...]:
        return tuple(cls.__name__ for cls in type(self._result).__mro__)

    def _keys(self) -> dict[str, str]:
        return _keys(self._classes())


def _keep(registry: Registry, key: str, draw: Callable[..., object], kept: RegisteredFigure) -> None:
    registry.register(key)(draw)
    vars(draw).setdefault(registry.group, {})[key] = kept


def _keys(classes: Iterable[str]) -> dict[str, str]:
    """Name of a figure → its key in the registry, the nearest class first."""
    split = [key.partition(".") for key in FIGURES.names()]
    keys: dict[str, str] = {}
    for kind in classes:
        for owner, _, name in split:
            if owner == kind:
                keys.setdefault(name, f"{owner}.{name}")
    return keys


def _load(registry: Registry, key: str) -> RegisteredFigure:
    """What is registered under a key; where its package is broken, a figure that raises as it is drawn."""
    result, _, name = key.partition(".")
    try:
        return _registered(registry, key, registry.find(key))
    except InputError as error:
        return RegisteredFigure(functools.partial(_refuse, str(error)), result, name, name.replace("_", " "))


def _registered(registry: Registry, key: str, entry: Entry) -> RegisteredFigure:
    registered = getattr(entry.target, "__dict__", {}).get(registry.group, {})
    if key not in registered:
        result, _, name = key.partition(".")
        raise InputError(
            f"{entry.package} brings the {registry.noun} {key!r}, but its function is not decorated with "
            f'@figure("{result}", name="{name}")'
        )
    kept: RegisteredFigure = registered[key]
    return kept


def _refuse(message: str, *_: object, **__: object) -> object:
    raise InputError(message)


def _bound(registered: RegisteredFigure, result: object) -> Callable[..., object]:
    """A drawing function with its result, its docstring, and its signature without the result.

    units of its options: "si" or "us", of display; left out, those of `us_units.display_units`.
    """

    @functools.wraps(registered.draw)
    def draw(*arguments: object, units: str | None = None, **options: object) -> object:
        if units is None:
            return registered.draw(result, *arguments, **options)
        with display_units(units):
            return registered.draw(result, *arguments, **options)

    if isinstance(registered.draw, functools.partial):
        return draw
    signature = inspect.signature(registered.draw)
    vars(draw)["__signature__"] = signature.replace(parameters=list(signature.parameters.values())[1:])
    draw.__name__ = registered.name
    return draw


def _text(words: Words, data: xr.Dataset) -> str:
    return words if isinstance(words, str) else words(data)
