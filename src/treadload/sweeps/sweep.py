"""Sweep: a case with some of its inputs varied, and what comes of it as one dataset."""

from __future__ import annotations

import json
import os
import re
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from treadload.case import Case
from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.errors import InputError, WorkersLost, positive
from treadload.rows import Row, row
from treadload.sweeps.cluster import SchedulerLost, cluster
from treadload.sweeps.description import about
from treadload.sweeps.design import Design, from_dataset, listed, product
from treadload.sweeps.gathered import FAILED, SOLVED, UNSOLVED, gathered, with_fields
from treadload.sweeps.places import Task, check_guard, here, processes, threads
from treadload.sweeps.record import Record
from treadload.sweeps.selection import check_varied, selectors_for
from treadload.sweeps.store import Store, begun, opened
from treadload.sweeps.work import TANGENTIAL, Question
from treadload.variables import SCALES, VARIABLES, Display, display_of

Progress = Callable[[int, int, str], None]
# Fewer neighbours than this do not pay for the contact that they start from.
_FAMILY = 3
# Results that a summary gives with their range: what a reader looks for first, and what was asked for.
_FIRST = (
    "net_area", "largest_pressure", "largest_traction", "slip_fraction", "largest_extension", "worst_strain",
    "worst_passes", "life_years", "governing_years",
)  # fmt: skip
_REDUCED = ("max_", "min_", "mean_of_")
# Causes of failures that are told.
_CAUSES = 6
# Texts of an input that are written out.
_LISTED = 6
_NUMBER = re.compile(r"(?<=cannot read )'[^']*'|-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


@dataclass(frozen=True, eq=False)
class Sweep(BaseResult, group="sweep"):
    """What a study gave.

    dataset: results over the dimensions of the design, its inputs as coordinates; NaN where a case failed or was not
    solved; `status` states which, `seconds` how long each took. Of a store, arrays are read when they are used.
    case: the base case. path: of the store, "" in memory.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"normal_load": ["50 N", "100 N"]})
    >>> [f"{pressure / 1e3:.0f} kPa" for pressure in study.dataset.largest_pressure.values]  # at 50 and 100 N
    ['116 kPa', '148 kPa']
    """

    title: ClassVar[str] = "Study"
    holds: ClassVar[Holds] = Holds(
        {"status seconds": "..."},
        texts="design failures warnings",
        reads=lambda data, document: _tried(data, document),
    )

    dataset: xr.Dataset
    case: Case
    path: str = ""

    def cites(self) -> tuple[str, ...]:
        """Methods of the case."""
        return self.case.cites()

    @cached_property
    def design(self) -> Design:
        """What was varied, over which dimensions."""
        return Design.from_json(json.loads(self.dataset.attrs["design"]), self.case)

    @property
    def failures(self) -> tuple[tuple[int, str], ...]:
        """Cases that failed, by their number in the design, and why."""
        return tuple((int(number), str(reason)) for number, reason in json.loads(self.dataset.attrs["failures"]))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user: of a damaged store, of the cases, each once with how many have it, of failures."""
        warnings = [str(self.dataset.attrs["damage"])] if self.dataset.attrs.get("damage") else []
        for text, numbers in by_cause(json.loads(self.dataset.attrs["warnings"])).items():
            warnings.append(text if self.design.count == 1 else f"{_cases(len(numbers))}: {text}")
        return tuple([*warnings, *self._failed()])

    @property
    def stats(self) -> Mapping[str, object]:
        """How many cases were solved, failed and wait, and the time that they took, s."""
        status = self.dataset["status"].to_numpy()
        names = {"solved": SOLVED, "failed": FAILED, "unsolved": UNSOLVED}
        counts = {name: int((status == code).sum()) for name, code in names.items()}
        return {"cases": status.size, **counts, "seconds": float(np.nansum(self.dataset["seconds"].to_numpy()))}

    @property
    def results(self) -> tuple[str, ...]:
        """Names of what is known of every case: numbers, without status and seconds."""
        bookkeeping = ("status", "seconds")
        return tuple(
            str(name)
            for name, variable in self.dataset.data_vars.items()
            if name not in bookkeeping and _small(variable)
        )

    @property
    def heading(self) -> str:
        """How many cases, and of what."""
        return f"{_cases(self.design.count)}{f', {self.case.title}' if self.case.title else ''}"

    def rows(self) -> tuple[Row, ...]:
        """What was varied, how it went, and the range of the results."""
        stats = self.stats
        solved = str(stats["solved"])
        solved += f", {stats['failed']} failed" if stats["failed"] else ""
        solved += f", {stats['unsolved']} not solved yet" if stats["unsolved"] else ""
        numeric = [name for name in self.results if self.dataset[name].dtype.kind in "fiu"]
        first = [name for name in numeric if name in _FIRST or name.startswith(_REDUCED)]
        more = [name for name in self.results if name not in first]
        return (
            *(row("varied", text) for text in varied(self.design)),
            row("solved", f"{solved}; {stats['seconds']:.3g} s of solving"),
            *(row(name, _range(self.dataset[name], name), label=_label(name)) for name in first),
            row("results", ", ".join(more) or "none"),
        )

    def _failed(self) -> Iterator[str]:
        causes = causes_of(self.failures)
        for text, numbers in list(causes.items())[:_CAUSES]:
            which = f"the first with {self.design.words_of(min(numbers))}"
            if self.design.labels:
                which = ", ".join(map(self.design.named, sorted(numbers)[:_LISTED]))
                which += f" and {len(numbers) - _LISTED} more" if len(numbers) > _LISTED else ""
            yield f"{_cases(len(numbers))} failed, {which}: {text}"
        if len(causes) > _CAUSES:
            yield f"and {len(causes) - _CAUSES} more causes of failures"


def varied(design: Design) -> list[str]:
    """What a design varies, one line for each input."""
    lines = []
    for variable in design.inputs:
        labels = variable.labels.ravel()
        unit = f" {variable.unit}" if variable.unit else ""
        count = len(np.unique(labels[~np.isnan(labels)] if variable.is_number else labels))
        span = (
            f"{np.nanmin(labels):.6g} to {np.nanmax(labels):.6g}{unit}, {count} value{'s' * (count > 1)}"
            if variable.is_number
            else f"{', '.join(map(str, labels[:_LISTED]))}{' …' if labels.size > _LISTED else ''}"
        )
        lines.append(f"{variable.key}: {span}")
    return lines


def sweep(
    case: Case,
    vary: Mapping[str, object] | Sequence[Mapping[str, object]] | xr.Dataset | Design,
    *,
    fields: Sequence[str] = (),
    store: str | os.PathLike[str] | None = None,
    jobs: int = 1,
    in_threads: bool = False,
    scheduler: object = None,
    progress: Progress | None = None,
) -> Sweep:
    """Solve a case for many values of its inputs.

    case: of a wheel or of a service life. vary: key → values, of which every combination is solved, one dimension
    each; or a list of such mappings, key → value, one for each case; or a dataset whose coordinates and variables are
    keys; or a design, see `sweeps.sampled`. A key is a path, "rolling.friction", or its end where that is clear,
    "friction"; numbers are SI, texts carry their unit.
    fields: what is kept besides the numbers of every case: names of fields, "pressure", "slice_along.strain_xx", and
    "max(principal_strain_1)", "min(…)", "mean(…)" over the plane.
    store: folder *.zarr for the results, written as they come; a study that was interrupted goes on in it, and tries
    again what failed. Left out, all is kept in memory, and lost with an interruption.
    jobs: processes, or threads if `in_threads`, of this machine. scheduler: of a Dask cluster instead: its address,
    "local" for `jobs` workers here, or a `distributed.Client`. The results are the same wherever they are solved.
    progress: called with (done, total, "case") after every case.
    Returns the Sweep. A case that fails is kept with its reason, and the others go on. Raises InputError for wrong
    keys, values and fields, for a store of another study and a full disk; SchedulerLost; WorkersLost where processes
    cannot start.

    >>> case = tl.Case.from_text('''
    ... tire = { profile = "315/80R22.5", inflation_pressure = "8.2 bar" }
    ... pavement = { structure = "6 BBSG3 / 15 GB3 / PF3", temperature = 15 }
    ... rolling = { normal_load = "32.5 kN", friction = 0.7 }
    ... ''')
    >>> tl.sweep(case, {"normal_laod": ["20 kN", "30 kN"]})
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: the case has no key 'normal_laod'; did you mean 'normal_load'?
    """
    check_varied(case)
    design = _design(case, vary)
    if jobs != int(jobs) or jobs < 1:
        positive("jobs", jobs, "", "1 solves one case after another")
        raise InputError(f"jobs must be a whole number, got {jobs!r}")
    question = Question(case.as_tables(), case.folder.resolve(), selectors_for(fields, case), _anchor(case, design))
    if (jobs > 1 and not in_threads) or scheduler is not None:
        check_guard()
    tell = progress or (lambda done, total, what: None)
    if store is None:
        records: dict[int, Record] = {}
        for record in _solved(question, design, records, jobs, in_threads, scheduler, tell):
            records[record.number] = record
        finished = [records[number] for number in sorted(records)]
        data = with_fields(gathered(design, finished), design, finished)
        return Sweep(data.assign_attrs(about(case, design, question)), case)
    with begun(store, case, design, question) as keeping:
        done: Collection[int] = range(design.count) if keeping.finished else keeping.records
        try:
            for record in _solved(question, design, done, jobs, in_threads, scheduler, tell):
                keeping.append(record)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(_go_on(keeping)) from None
        except (SchedulerLost, WorkersLost) as error:
            raise type(error)(f"{error}; {_go_on(keeping)}") from error
    stored = open_sweep(store)
    return (
        replace(stored, dataset=stored.dataset.assign_attrs(damage=keeping.repaired)) if keeping.repaired else stored
    )


def open_sweep(path: str | os.PathLike[str]) -> Sweep:
    """The study in a store, whether it has ended, is being solved or was killed. Raises InputError.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> _ = tl.sweep(case, {"normal_load": ["50 N", "100 N"]}, store="loads.zarr")
    >>> study = tl.sweeps.open_sweep("loads.zarr")
    >>> [f"{pressure / 1e3:.0f} kPa" for pressure in study.dataset.largest_pressure.values]
    ['116 kPa', '148 kPa']
    """
    return Sweep(*opened(path))


def _solved(
    question: Question, design: Design, finished: Collection[int], jobs: int, in_threads: bool, scheduler: object,
    tell: Progress,
) -> Iterator[Record]:  # fmt: skip
    """Records of the cases that are not known yet, as they come."""
    tasks: list[Task] = []
    for number in (number for number in range(design.count) if number not in finished):
        if number in design.faults:
            yield Record(number, 0.0, failure=design.faults[number])
        else:
            tasks.append((number, design.at(number)))
    if not tasks:
        return
    # Another study, or this one once more, must not be taken for it by workers that are still there.
    name = f"{os.getpid():x}-{time.time_ns():x}"
    if scheduler is not None:
        place = cluster(question, tasks, scheduler, jobs, name)
    elif jobs > 1:
        place = threads(question, tasks, jobs, name) if in_threads else processes(question, tasks, jobs)
    else:
        place = here(question, tasks)
    done = design.count - len(tasks)
    tell(done, design.count, "case")
    for record in place:
        done += 1
        yield record
        tell(done, design.count, "case")


def _design(case: Case, vary: object) -> Design:
    if isinstance(vary, Design):
        return vary
    if isinstance(vary, xr.Dataset):
        return from_dataset(case, vary)
    if isinstance(vary, Mapping):
        return product(case, vary)
    if isinstance(vary, Sequence) and not isinstance(vary, str | bytes) and all(isinstance(r, Mapping) for r in vary):
        return listed(case, vary)
    raise InputError(
        f"cannot vary {type(vary).__name__}: give a mapping of keys to values, such as {{'rolling.friction': [0.3, "
        "0.6]}, a list of mappings, or a dataset"
    )


def _tried(data: xr.Dataset, document: Mapping[str, object]) -> None:
    """Read the description of a study from a file, as its methods do. Raises InputError and what else goes wrong."""
    for numbers in json.loads(data.attrs["warnings"]).values():
        [int(number) for number in numbers]
    failed = [(int(number), str(reason)) for number, reason in json.loads(data.attrs["failures"])]
    case = document.get("case")
    if isinstance(case, Case):
        design = Design.from_json(json.loads(data.attrs["design"]), case)
        for name in ("status", "seconds"):
            if data[name].dims != design.dims or data[name].shape != design.shape:
                raise InputError(f"{name} is over {data[name].sizes}, the design over {dict(design.sizes)}")
        if any(not 0 <= number < design.count for number, _ in failed):
            raise InputError(f"a case that failed is not among the {design.count} of the design")


def _anchor(case: Case, design: Design) -> dict[str, object]:
    """The contact that neighbours start from: the first values of what only shears it.

    The same for all of them wherever and in whatever order they are solved, so that the results do not depend on it.
    """
    if case.rolling is None:
        return {}
    anchored = {
        variable.key: variable
        for variable in design.inputs
        if variable.key in {f"rolling.{name}" for name in TANGENTIAL}
    }
    elsewhere = {dim for variable in design.inputs if variable.key not in anchored for dim in variable.dims}
    dims = {dim for variable in anchored.values() for dim in variable.dims} - elsewhere
    if np.prod([design.sizes[dim] for dim in dims], initial=1.0) < _FAMILY:
        return {}
    return {key: variable.values.flat[0] for key, variable in anchored.items() if set(variable.dims) <= dims}


def _go_on(store: Store) -> str:
    return f"{store.state_in_words()}; the same command goes on from there"


def causes_of(failures: Iterable[tuple[int, str]]) -> dict[str, list[int]]:
    """Numbers of cases by why they failed, see `by_cause`. failures: number and reason of each.

    >>> tl.sweeps.causes_of([(2, "the tire does not touch the road"), (7, "the tire does not touch the road")])
    {'the tire does not touch the road': [2, 7]}
    """
    by_reason: dict[str, list[int]] = {}
    for number, reason in failures:
        by_reason.setdefault(reason, []).append(number)
    return by_cause(by_reason)


def by_cause(by_text: Mapping[str, Sequence[int]]) -> dict[str, list[int]]:
    """Texts that differ in numbers, or in what cannot be read, become one, the first; the most frequent first."""
    causes: dict[str, tuple[str, list[int]]] = {}
    for text, numbers in by_text.items():
        causes.setdefault(_NUMBER.sub("#", text), (text, []))[1].extend(map(int, numbers))
    return dict(sorted(causes.values(), key=lambda cause: -len(cause[1])))


def _cases(count: int) -> str:
    return "1 case" if count == 1 else f"{count} cases"


def _small(field: xr.DataArray) -> bool:
    return not {"x", "y", "point"} & set(map(str, field.dims))


def _label(name: str) -> str:
    """A result in words; a field that was asked for by its name."""
    return display_of(name).label if name in VARIABLES else name


def _range(field: xr.DataArray, name: str) -> str:
    values = field.to_numpy()
    finite = values[np.isfinite(values)]
    if not finite.size:
        return "no numbers"
    unit = str(field.attrs.get("units", "1"))
    display = display_of(name) if name in VARIABLES else Display(name, unit if unit in SCALES else "")
    low, high = (row(name, value, display=display) for value in (finite.min(), finite.max()))
    return low.text if low.text == high.text else f"{low.number} to {high.text}"
