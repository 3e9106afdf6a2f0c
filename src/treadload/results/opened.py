"""Results from a file as the objects they were: parts by name, each ready for the next verb."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

from treadload.case import Case
from treadload.composing import BaseResult
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.results.dataset import Fields
from treadload.results.questions import Reader
from treadload.results.study import Study
from treadload.results.tree import QUESTIONS

# Names that people say for a group.
ALIASES = {"verdict": "damage", "bond_verdict": "bonds", "slice": "slice_along", "footprint": "contact"}


class Results(Study):
    """Named results, such as `open_results` reads from a file.

    Each part is the object that a verb returned, by its name: `results.contact`, `results["response_2"]`; `in`, `len`
    and iteration go over the names. A part is created on first access. tree: the tree of xarray that holds
    them. where: the file, for errors.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0, 0.1])
    >>> results = tl.results.Results(tl.results.to_tree({"plate": response}))
    >>> list(results), f"{results.plate.dataset.stress_zz.min().item() / 1e3:.0f} kPa"
    (['plate'], '-453 kPa')
    """

    def __init__(self, tree: xr.DataTree, where: str = "these results") -> None:
        self.tree, self._where = tree, where
        self._results: dict[str, BaseResult] = {}
        self._making: list[str] = []

    @property
    def parts(self) -> Mapping[str, BaseResult]:
        """All parts by name, without those inside others."""
        return MappingProxyType({name: self[name] for name in self})

    def __iter__(self) -> Iterator[str]:
        if self.tree.data_vars:
            yield Fields.group
        for name, node in self.tree.children.items():
            if name != QUESTIONS and not node.attrs.get("part_of") and node.data_vars:
                yield str(name)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return ALIASES.get(str(name), name) in list(self) or name in list(self)

    def __getitem__(self, name: str) -> BaseResult:
        """The part of this name, also one inside another. Raises InputError if there is none or it cannot be made."""
        parts = {**dict.fromkeys(self.tree.children), **dict.fromkeys(self)}
        part = name if name in parts else ALIASES.get(name, name)
        if part not in parts or part == QUESTIONS:
            raise InputError(f"{self._where} has no part {name!r}; it holds {', '.join(self) or 'none'}")
        if part not in self._results:
            if part in self._making:
                raise InputError(f"{self._where}: the part {part!r} is an input of itself")
            self._making.append(part)
            try:
                self._results[part] = self._make(part)
            finally:
                self._making.pop()
        return self._results[part]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            there = name in self or name in self.tree.children
        except RecursionError:  # before __init__ ran, as a copy does
            raise AttributeError(name) from None
        if not there:
            raise AttributeError(f"these results have no part {name!r}; they hold {', '.join(self) or 'none'}")
        return self[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self, *(also for also, name in ALIASES.items() if name in list(self))})

    def _make(self, name: str) -> BaseResult:
        if name == Fields.group and self.tree.data_vars:
            return Fields(self.tree.to_dataset())
        data = self.tree[name].to_dataset()
        questions = self._questions
        if name in questions:
            return self._reader.result(questions[name], data, name)
        version = self.tree.attrs.get("treadload_version", "an unknown version")
        raise InputError(
            f"{self._where} was written by treadload {version}, without the inputs of its part {name!r}; its fields "
            f"are in .tree[{name!r}], and files of this version keep all inputs"
        )

    @functools.cached_property
    def _questions(self) -> Mapping[str, Any]:
        if QUESTIONS not in self.tree.children:
            return {}
        text = self.tree[QUESTIONS].attrs.get("questions", "{}")
        try:
            questions = json.loads(text) if isinstance(text, str) else None
        except (ValueError, RecursionError):
            questions = None
        if not isinstance(questions, dict):
            raise InputError(f"{self._where}: the inputs of its results cannot be read; compute them again")
        return questions

    @functools.cached_property
    def _reader(self) -> Reader:
        stored = self.tree[QUESTIONS].data_vars
        return Reader({str(name): array.to_numpy() for name, array in stored.items()}, self._part, self._where)

    def _part(self, name: Any) -> BaseResult:
        return self[str(name)]

    @property
    def title(self) -> str:
        """Heading of the results; empty if they have none."""
        return str(self.tree.attrs.get("title", ""))

    @property
    def where(self) -> str:
        """The file, for errors."""
        return self._where

    @functools.cached_property
    def case(self) -> Case | None:
        """The case that they answer, whose tire and road can be built again; None without one."""
        text = str(self.tree.attrs.get("case", ""))
        if not text:
            return None
        return Case.from_text(text, name=f"{self._where}: its case")

    @property
    def road(self) -> Pavement:
        """The road at its temperature, of the contact, response or case. Raises InputError if none holds it."""
        for name in self:
            road = getattr(self[name], "road", None)
            if isinstance(road, Pavement):
                return road
        if self.case is None:
            raise InputError(f"{self._where} does not hold its road; give it again, Pavement([...])")
        built: Pavement | None = self.case.build_road()
        if built is None:
            raise InputError(f"{self._where}: its case has no road; give one, Pavement([...])")
        return built

    def to_tree(self) -> xr.DataTree:
        """The tree that they come from."""
        return self.tree

    def text(self) -> str:
        """The results: as the study summed them up, else part by part."""
        whole = self.tree.attrs.get("summary")
        return str(whole) if whole else "\n\n".join(self[name].text() for name in self)

    def __repr__(self) -> str:
        title = f" {self.title!r}:" if self.title else ""
        return f"<Results{title} {', '.join(self) or 'no part'}>"
