"""What a case can name, ours and what other packages bring: friction laws, materials, criteria, readers of meshes.

Ours are registered where they are defined, `@FRICTION.register("coulomb")`. Another package declares an entry point
of the registry's group, whose name is the name in the case:

    [project.entry-points."treadload.friction"]
    stribeck = "my_laws:Stribeck"

It is loaded when a case names it, not before: a broken package stops no one who does not ask for it.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from importlib import metadata
from typing import Any, ClassVar, TypeVar

from treadload import _public
from treadload.errors import InputError, nearest

Target = TypeVar("Target", bound=Callable[..., Any])

OURS = "treadload"


@dataclass(frozen=True)
class Entry:
    """A thing by its name. target: a class or function that makes it. package: that brings it, with its version."""

    name: str
    target: Callable[..., Any]
    package: str = OURS


class Registry:
    """Makers of one kind of thing by name.

    noun: one of them, in a sentence. group: of entry points. key: that names the thing in a table of a case.
    default: what a table without this key is. number: what a number stands for. words: True if a name alone will do
    where the thing needs nothing else. example: of a table.
    faces: what the makers return, as the annotations of who takes it name it. groups: of all registries.
    """

    groups: ClassVar[list[str]] = []

    def __init__(
        self,
        noun: str,
        group: str,
        *,
        key: str = "kind",
        default: str = "",
        number: str = "",
        words: bool = False,
        example: str = "",
    ) -> None:
        self.noun, self.group, self.key = noun, group, key
        self.groups.append(group)
        self.default, self.number, self.words, self.example = default, number, words, example
        self.faces: tuple[Any, ...] = ()
        self._built_in: dict[str, Entry] = {}
        self._fill: Callable[[], object] | None = None

    def filled_by(self, fill: Callable[[], object]) -> None:
        """Set the function that imports the modules that register ours; it runs once, when a name is first needed."""
        self._fill = fill

    def _filled(self) -> None:
        fill, self._fill = self._fill, None
        if fill is not None:
            fill()

    def makes(self, *faces: object) -> None:
        """Set the types that its makers return, by which `treadload.read` finds the registry."""
        self.faces = faces

    def register(self, *names: str) -> Callable[[Target], Target]:
        """Decorator of a class or function that makes a thing, under one name or several.

        Raises InputError for a name that something else has already.
        """

        def keep(target: Target) -> Target:
            for name in names:
                before = self._built_in.get(name)
                # A notebook cell that is run again defines the same thing again.
                if before is not None and _place(before.target) != _place(target):
                    raise InputError(
                        f"the {self.noun} {name!r} is {_place(before.target)} already, so that {_place(target)} "
                        "cannot be; give it another name"
                    )
                self._built_in[name] = Entry(name, target, package_with(target.__module__))
            return target

        return keep

    def built_in(self) -> tuple[str, ...]:
        """Names of what this program brings or the session registered."""
        self._filled()
        return tuple(self._built_in)

    def names(self) -> tuple[str, ...]:
        """All names, ours first; no package is loaded. Raises InputError for a name that two have."""
        points = self._points()
        return (*self._built_in, *sorted(points))

    def packages(self) -> dict[str, str]:
        """All names and the packages that bring them, "" for ours; nothing is loaded. Raises InputError."""
        self._filled()
        return {
            **dict.fromkeys(self._built_in, ""),
            **{name: package_of(point) for name, point in self._points().items()},
        }

    def find(self, name: str) -> Entry:
        """What has this name. Raises InputError: unknown, brought twice, or its package cannot be loaded."""
        points = self._points()
        if name in self._built_in:
            return self._built_in[name]
        if name not in points:
            raise InputError(self.unknown(name, self.names()))
        return _loaded(points[name], self)

    def unknown(self, name: object, names: Iterable[str]) -> str:
        """The message about an unknown name."""
        what = self.key if self.key != "kind" else self.noun if self.words else f"{self.noun} of the kind"
        what = what or self.noun
        # The order in which rooms were loaded is nobody's business.
        return f"no {what} {name!r}; {nearest(name, sorted(names))}"

    def __iter__(self) -> Iterator[Entry]:
        return (self.find(name) for name in self.names())

    def _points(self) -> dict[str, metadata.EntryPoint]:
        self._filled()
        points: dict[str, metadata.EntryPoint] = {}
        for point in declared_points(self.group, tuple(sys.path)):
            ours = self._built_in.get(point.name)
            # What registers itself as its module is loaded, and is an entry point as well.
            if ours is not None and _place(ours.target) == point.value.replace(":", "."):
                continue
            rival = (
                OURS
                if point.name in self._built_in
                else package_of(points[point.name])
                if point.name in points
                else ""
            )
            # The same distribution may lie on the path twice.
            if rival and not (point.name in points and points[point.name].value == point.value):
                raise InputError(
                    f"the {self.noun} {point.name!r} comes from {rival} and from {package_of(point)}; rename one of "
                    "them, or remove a package"
                )
            points[point.name] = point
        return points


@functools.cache
def declared_points(group: str, path: tuple[str, ...]) -> tuple[metadata.EntryPoint, ...]:
    """Entry points of a group; looking through the metadata on the path takes longer than reading a case."""
    return tuple(metadata.entry_points(group=group))


def package_of(point: metadata.EntryPoint) -> str:
    """The package that brings an entry point, with its version."""
    if point.dist is None:
        return f"the package of {point.value}"
    return f"the package {point.dist.name} {point.dist.version}"


def package_with(module: str) -> str:
    """The package, with its version, that brings a module by an entry point; this program for one of a session."""
    top = module.partition(".")[0]
    return OURS if top == OURS else _packages_by_module(tuple(sys.path)).get(top, OURS)


@functools.cache
def _packages_by_module(path: tuple[str, ...]) -> dict[str, str]:
    """Top module → the package that declares an entry point of ours in it."""
    points = [point for group in Registry.groups for point in declared_points(group, path)]
    return {point.value.partition(":")[0].partition(".")[0]: package_of(point) for point in points}


def load_point(point: metadata.EntryPoint) -> object:
    """What an entry point names. Raises InputError in a sentence that names the package."""
    try:
        return point.load()
    # Whatever a foreign package raises is reported as its failure.
    except Exception as error:
        raise InputError(
            f"{package_of(point)} brings {point.name!r} for {point.group}, but {point.value} cannot be loaded: "
            f"{error!r}; repair that package or remove it"
        ) from error


def _loaded(point: metadata.EntryPoint, registry: Registry) -> Entry:
    target = load_point(point)
    if not callable(target):
        raise InputError(
            f"{package_of(point)} brings the {registry.noun} {point.name!r}, but {point.value} is {target!r}, "
            "neither a class nor a function"
        )
    return Entry(point.name, target, package_of(point))


def _place(target: Callable[..., object]) -> str:
    return f"{target.__module__}.{getattr(target, '__qualname__', target)}"


MATERIALS = Registry("material", "treadload.materials", default="elastic")
SHIFTS = Registry("shift", "treadload.shifts")
PLASTICITY = Registry("plastic law", "treadload.plasticity")
MODULUS_LAWS = Registry("law of the modulus", "treadload.modulus_laws")
BONDS = Registry("bond", "treadload.bonds", default="spring", words=True, example='{ stiffness = "1000 MPa/m" }')
FRICTION = Registry("friction law", "treadload.friction", key="law", number="coulomb")
MANEUVERS = Registry("maneuver", "treadload.maneuvers", words=True, example='{ kind = "braking", deceleration = 3 }')
CRITERIA = Registry("fatigue law", "treadload.criteria", key="law")
GROWTH = Registry("law of crack growth", "treadload.growth", key="law")
QUANTITIES = Registry(
    "quantity", "treadload.quantities", key="quantity", words=True,
    example='{ quantity = "utilisation", cohesion = "0.85 MPa" }',
)  # fmt: skip
READERS = Registry("reader of meshes", "treadload.readers", key="")
FOOTPRINTS = Registry("reader of footprints", "treadload.footprints", key="format")
STEPS = Registry("step", "treadload.steps", key="")
RESULTS = Registry("class of results", "treadload.results", key="")
FIGURES = Registry("figure", "treadload.figures", key="")
COMPARISONS = Registry("comparison", "treadload.comparisons", key="")
COLOUR_MAPS = Registry("source of colour maps", "treadload.colour_maps", key="")
PAGES = Registry("page", "treadload.pages", key="")
ALL = (
    MATERIALS, SHIFTS, PLASTICITY, MODULUS_LAWS, BONDS, FRICTION, MANEUVERS, CRITERIA, GROWTH, QUANTITIES, READERS,
    FOOTPRINTS,
)  # fmt: skip
# Leaves know no room; the public names do.
RESULTS.filled_by(lambda: _public.named("sweeps"))
STEPS.filled_by(lambda: _public.named("steps"))
for _drawn in (FIGURES, COMPARISONS, COLOUR_MAPS):
    _drawn.filled_by(lambda: _public.named("plots"))
