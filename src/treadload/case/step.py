"""What a case can ask for: a step is a table of the case that becomes a result.

A step is a class with a name, which is its table in a case; it states after which results it comes, and solves,
plans, cites and writes itself as Python. Defining the class registers it; a package declares the module as an entry
point of the group `treadload.steps`, whose name is that of the step.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, Self, Unpack

from pydantic import ConfigDict, ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

from treadload.case.description import Description
from treadload.citations import SOLVED_WHOLE
from treadload.composing import BaseResult
from treadload.damage.climate import Season
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.pavement import Pavement, methods_of
from treadload.read import Table
from treadload.registry import OURS, STEPS

Results = Mapping[str, BaseResult]
"""What a step makes: results by their groups in a file."""


_ANY_TEMPERATURE = 15.0


class Step(Table):
    """Base of all steps; the fields of a class are the keys of its table.

    name: of the table. after: groups of the results that it takes. also: groups that it takes where they are solved,
    too. makes: groups of its results; left out, its name. has_table: False for a step that follows from others and
    has no key of its own. is_quiet: True where the result is left out of summaries. swept: True where a study keeps
    its numbers for every case without being asked for them. shapes_contact: True where the contact of a wheel depends
    on the table. heading: of its keys in a report; left out, its name.

    >>> tl.steps.GrowthStep.name, tl.steps.GrowthStep.after  # solved after the service life
    ('growth', ('life',))
    """

    name: ClassVar[str] = ""
    after: ClassVar[tuple[str, ...]] = ("contact",)
    also: ClassVar[tuple[str, ...]] = ()
    makes: ClassVar[tuple[str, ...]] = ()
    has_table: ClassVar[bool] = True
    is_quiet: ClassVar[bool] = False
    swept: ClassVar[bool] = False
    shapes_contact: ClassVar[bool] = False
    heading: ClassVar[str] = ""

    def __init_subclass__(cls, *, name: str = "", **more: Unpack[ConfigDict]) -> None:
        super().__init_subclass__(**more)
        if name:
            cls.name = name
            cls.makes = cls.__dict__.get("makes") or (name,)
            STEPS.register(name)(cls)

    @classmethod
    def default(cls) -> Self | None:
        """The table of a case that does not give it; None for none."""
        return None

    @classmethod
    def wanted(cls, case: Description) -> Self | None:
        """The step of a case; None where the case does not ask for it."""
        step: Self | None = getattr(case, cls.name, None) if cls.has_table else cls()
        return step

    def check(self, case: Description) -> None:
        """Refuse what does not fit the rest of the case. Raises ValueError with the number, bound and remedy."""

    def solve(self, scene: Any) -> BaseResult | Results | None:
        """The result of the step, several by their groups, or None. scene: `treadload.steps.Scene`."""
        raise NotImplementedError(f"the step {self.name!r} has no solve")

    def plan(self, outline: Any) -> None:
        """Add lines and the cost to an outline, `treadload.steps.Outline`."""

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods that the step will use: keys of `treadload.citations.CITATIONS`, or whole references."""
        return ()

    def python(self, script: Any) -> list[str] | None:
        """Lines of the equivalent script, `treadload.steps.Script`; None where no verb takes what the step does."""
        return None

    @property
    def is_quick(self) -> bool:
        """True where a page solves the step at once; else it names the step beside the result."""
        return False

    def numbers(self, scene: Any) -> xr.Dataset:
        """What a study keeps of every case where the step is `swept`: the numbers among the rows of its results."""
        numbers: dict[str, float] = {}
        for group in self.makes:
            result = scene.result(group)
            rows = () if result is None else result.rows()
            numbers |= {row.key: row.value for row in rows if not isinstance(row.value, str) and not row.group}
        return xr.Dataset(numbers)

    def names_key(self, key: str) -> bool:
        """True if the table gives this key."""
        return key in self.model_fields_set


def numbers_of(data: xr.Dataset, also: tuple[str, ...] = ()) -> xr.Dataset:
    """Numbers of a dataset: those without dimensions, and those over a single dimension of `also`."""
    kept = ((), *((dim,) for dim in also))
    names = [name for name, field in data.data_vars.items() if field.dims in kept and field.dtype.kind in "fiub"]
    return data[names].drop_attrs(deep=False)


class Source(Step):
    """A step that the others follow: what a case is about. Exactly one stands in a case.

    uses: keys of the case, beside tables of steps, that it reads. needs: keys that must be given. command: that runs
    the case. waits_for_temperature: True where the road's materials wait for the temperatures of a climate.
    states_road: True where summaries list the layers of the road. hidden: keys of tables, "pavement.temperature",
    that the case takes from elsewhere. tolerances: the smallest, the default and the largest
    that the case may ask for.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> next(step.name for step in tl.Case.from_dict(wheel | road).steps if isinstance(step, tl.steps.Source))
    'contact'
    """

    after: ClassVar[tuple[str, ...]] = ()
    shapes_contact: ClassVar[bool] = True
    uses: ClassVar[tuple[str, ...]] = ("title", "tire", "pavement")
    needs: ClassVar[tuple[str, ...]] = ("tire", "pavement")
    command: ClassVar[str] = "run"
    waits_for_temperature: ClassVar[bool] = False
    states_road: ClassVar[bool] = True
    hidden: ClassVar[tuple[str, ...]] = ()
    # Of the contact, relative.
    tolerances: ClassVar[tuple[float, float, float]] = (1e-12, 1e-6, 1e-2)

    @classmethod
    def stray_text(cls, key: str) -> str:
        """The message about a key that a case with this source does not use."""
        return f"a case with [{cls.name}] has no use for {key!r}; leave it out"

    @classmethod
    def missing_text(cls, key: str) -> str:
        """The message about a missing key."""
        return f"{key!r} is missing"

    def check(self, case: Description) -> None:
        """Refuse a road without the temperature that it needs."""
        if case.pavement is not None:
            try:
                case.pavement.check_temperature()
            except ValueError as error:
                raise at_key("pavement", str(error)) from error

    @classmethod
    def tolerance_of(cls, case: Description) -> float:
        """What the case asks for, or the default."""
        return cls.tolerances[1] if case.tolerance is None else case.tolerance

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of a wheel on the road of the case."""
        road = case.build_road()
        # A road of mixes waits for the temperatures of its seasons; the methods are the same at all of them.
        road = None if road is None else road.at_temperature(_ANY_TEMPERATURE, extrapolate=True)
        return (*SOLVED_WHOLE, *(() if road is None else methods_of(road)))

    def road_of(self, case: Description, results: Results) -> tuple[Pavement | None, Season | None]:
        """The road that a file shows, and the season whose temperatures it has, or None."""
        return case.build_road(), None


def step_class(name: str) -> type[Step]:
    """The class of a step by its name. Raises InputError: unknown, or its package cannot be loaded."""
    if name in Description.model_fields:
        bringer = STEPS.packages().get(name) or "this session"
        raise InputError(f"the step {name!r} of {bringer} has the name of a key of every case; rename it")
    entry = STEPS.find(name)
    target: Any = entry.target
    if not (isinstance(target, type) and issubclass(target, Step)):
        raise InputError(
            f"the step {name!r} of {entry.package} must be a class of treadload.steps.Step, got {target!r}"
        )
    return target


def step_classes(names: Iterable[str] = ()) -> list[type[Step]]:
    """All steps of this package, and those of other packages that are named. Raises InputError."""
    built_in, registered = STEPS.built_in(), STEPS.names()
    return [
        step_class(name)
        for name in (*built_in, *(name for name in names if name not in built_in and name in registered))
    ]


def source_of(case: Description) -> Source:
    """The source of a case: the contact, registered first, where no other is asked for."""
    contact, *further = [kind for kind in step_classes() if issubclass(kind, Source)]
    for kind in (*further, contact):
        source = kind.wanted(case)
        if source is not None:
            return source
    raise InputError("no step is a source: treadload is not installed whole")


def steps_of(case: Description) -> list[Step]:
    """The steps of a case in order of dependence, its source first.

    Raises InputError for a table that does not belong to the source, a step whose input nobody makes, and a circle.
    """
    keys = {key for key in case.model_fields_set - {"folder"} if getattr(case, key) is not None}
    source = source_of(case)
    wanted: list[Step] = [source]
    for kind in step_classes(keys):
        step = None if issubclass(kind, Source) else kind.wanted(case)
        if step is not None:
            wanted.append(step)
    wanted = _with_inputs(wanted, keys, source)
    tables = {step.name for step in wanted if step.has_table}
    stray = sorted(keys - tables - set(source.uses))
    if stray:
        raise at_key(stray[0], source.stray_text(stray[0]))
    for key in source.needs:
        if not getattr(case, key):
            raise at_key("", source.missing_text(key))
    return _in_order(wanted)


def _with_inputs(wanted: list[Step], tables: set[str], source: Source) -> list[Step]:
    """Steps whose inputs are made; those without a table of the case fall away with their inputs."""
    while True:
        groups = {group for step in wanted for group in step.makes}
        without = [step for step in wanted if not groups.issuperset(step.after)]
        if not without:
            return wanted
        for step in without:
            if step.has_table and step.name in tables:
                lacks = next(group for group in step.after if group not in groups)
                if STEPS.find(step.name).package != OURS:
                    raise InputError(
                        f"[{step.name}] of {STEPS.find(step.name).package} comes after {lacks!r}, which no step of "
                        f"this case makes; it has {', '.join(sorted(groups))}"
                    )
                raise at_key(step.name, source.stray_text(step.name))
        wanted = [step for step in wanted if step not in without]


def _in_order(wanted: list[Step]) -> list[Step]:
    """Each step behind those whose results it takes, otherwise as they were registered. Raises InputError."""
    ordered: list[Step] = []
    groups: set[str] = set()
    left = list(wanted)
    coming = {group for step in wanted for group in step.makes}
    while left:
        ready = [step for step in left if groups.issuperset({*step.after, *coming.intersection(step.also)})]
        if not ready:
            names = " and ".join(f"{step.name!r} of {STEPS.find(step.name).package}" for step in left)
            raise InputError(
                f"the steps {names} wait for each other: their `after` is a circle; leave one of them out"
            )
        ordered.append(ready[0])
        groups.update(ready[0].makes)
        left.remove(ready[0])
    return ordered


def at_key(key: str, text: str) -> ValidationError:
    """An error of the table or key of a case, "pavement" or "pavement.temperature"; "" for the whole."""
    kind: Any = PydanticCustomError("value_error", "{text}", {"text": text})
    details: list[InitErrorDetails] = [{"type": kind, "loc": tuple(key.split(".")) if key else (), "input": None}]
    return ValidationError.from_exception_data("Case", details)
