"""A case as the Python that gives the same result."""

from __future__ import annotations

import dataclasses
import pprint
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from treadload import catalogue, contact, materials, pavement, tire
from treadload.case import Case
from treadload.case.choices import TIRE_MATERIAL
from treadload.case.road import PavementPart
from treadload.case.tire import EXAMPLE, TirePart
from treadload.contact import friction
from treadload.pavement import BONDED, FRICTIONLESS, Layer

# Where a class can be reached from `import treadload as tl`, the shortest way first.
_TOP = ("Elastic", "Layer", "Rolling")
_ROOMS = {
    "materials": materials,
    "pavement": pavement,
    "contact.friction": friction,
    "contact": contact,
    "tire": tire,
}
_LINE = 110


class NoCallError(Exception):
    """A thing has no call that a reader would write."""


class Script:
    """The Python of a case. case: that it solves. The steps add their lines to it.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> lines = tl.steps.Script(case).lines()
    >>> next(line for line in lines if line.startswith("wheel"))
    'wheel = tl.Rolling(normal_load=32500.0, friction=0.7)'
    """

    def __init__(self, case: Case) -> None:
        self.case = case

    def lines(self) -> list[str] | None:
        """Lines of all steps of the case behind its objects; None where a step has none."""
        if not self.case.steps[0].python(self):
            return None
        parts = [step.python(self) for step in self.case.steps]
        bodies = [part for part in parts if part is not None]
        if len(bodies) < len(parts):
            return None
        lines = [*self._objects(), *(line for body in bodies for line in body)]
        results = [line.split(" = ")[0] for body in bodies for line in body[-1:]]
        return [*lines, "", *(f"print({name}.summary())" for name in results)]

    def _objects(self) -> list[str]:
        """Tire, road and wheel, with the case where one of them has no call of its own."""
        case, calls = self.case, {}
        assert case.tire is not None
        assert case.pavement is not None
        part, road = case.tire, case.pavement
        writers: dict[str, Callable[[], str]] = {
            "tire": lambda: _tire(part, case.folder),
            "road": lambda: _road(road),
            "wheel": lambda: self.code(case.build_rolling()),
        }
        for name, write in writers.items():
            try:
                calls[name] = write()
            except NoCallError:
                calls[name] = f"case.build_{'rolling' if name == 'wheel' else name}()"
        whole = self.whole() if any("case." in call for call in calls.values()) else []
        return ["# Numbers are SI: m, N, Pa, rad.", *whole, *(f"{name} = {call}" for name, call in calls.items())]

    def whole(self) -> list[str]:
        """The case itself, from its tables."""
        table = pprint.pformat(self.case.as_tables(), width=_LINE - 4, sort_dicts=False)
        folder = "" if self.case.folder == Path(".") else f", folder={str(self.case.folder)!r}"
        return [f"# Numbers are SI.\ncase = tl.Case.from_dict(\n{_indented(table)}{folder}\n)"]

    def contact_keywords(self) -> list[str]:
        """Keywords of `tl.solve_contact`."""
        case = self.case
        return self.keywords({
            "spacing": case.spacing,
            "tolerance": case.tolerance if case.tolerance not in (None, 1e-6) else None,
            "road_compliance": case.road_compliance if case.road_compliance != "half_space" else None,
        })  # fmt: skip

    @staticmethod
    def keywords(values: Mapping[str, object]) -> list[str]:
        """Keyword arguments of those that are not None."""
        return _keywords(values)

    @staticmethod
    def call(name: str, arguments: list[str]) -> str:
        """A call on one line, or with a line for each argument."""
        return _call(name, arguments)

    @staticmethod
    def code(value: object) -> str:
        """A value as Python that makes an equal one. Raises NoCallError."""
        return _code(value)


def case_as_python(case: Case) -> str:
    """Python that computes what a case asks for, with the verbs of the package: the same numbers to the last digit.

    A wheel on a road becomes Tire, Pavement, Rolling and the functions from contact to assessment, and leaves the
    results in `contact`, `response` and `verdict`; what else a case can ask for becomes `Case.from_dict` and
    `tl.run`, with the results in `result`. Relative paths of files start from the folder of the case. Returns the
    text of a script.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> print(tl.steps.case_as_python(case).splitlines()[5])
    wheel = tl.Rolling(normal_load=32500.0, friction=0.7)
    """
    script = Script(case)
    head = [f'"""{_doc(case.title)}"""', ""] if case.title else []
    body = script.lines() or [*script.whole(), "result = tl.run(case)", "print(result.summary())"]
    return "\n".join([*head, "import treadload as tl", "", *body, ""])


def _tire(part: TirePart, folder: Path) -> str:
    keys = part.model_fields_set
    arguments: dict[str, Any] = {"inflation_pressure": part.inflation_pressure}
    more = []
    if part.material is not None:
        more.append(f"material={_code(TIRE_MATERIAL.build(part.material))}")
    if part.belt is not None:
        if not isinstance(part.belt, str):
            raise NoCallError
        more.append(f"belt=tl.tire.Belt.from_library({part.belt!r})")
    if part.tread != "layer":
        more.append(f"tread={part.tread!r}")
    if part.undertread is not None:
        more.append(f"undertread={part.undertread!r}")
    if part.scan is not None:
        first = "tl.example_mesh()" if part.scan == EXAMPLE else repr(str(folder / part.scan))
        names = ("units", "nominal_diameter", "rotation", "camber", "revolve", "fill_holes", "smooth", "outliers",
                 "roundness")  # fmt: skip
        arguments |= {name: getattr(part, name) for name in names if name in keys}
        return _call("tl.Tire.from_scan", [first, *_keywords(arguments), *more])
    if part.height_map is not None:
        arguments |= {"units": part.units, "decimal": part.decimal}
        path = repr(str(folder / part.height_map))
        return _call("tl.Tire.from_height_map", [path, repr(part.cell), *_keywords(arguments), *more])
    if not isinstance(part.profile, str) or part.wear:
        raise NoCallError
    if part.profile.endswith(".toml"):
        profile = f"tl.tire.TreadProfile.from_toml({str(folder / part.profile)!r})"
    else:
        profile = repr(part.profile)
    return _call("tl.Tire.from_profile", [profile, *_keywords(arguments), *more])


def _road(part: PavementPart) -> str:
    if part.structure is not None:
        words = _call("tl.Pavement.from_catalogue", [repr(part.structure), *_keywords({"frequency": part.frequency})])
    else:
        road = part.untempered()
        layers = [_layer(layer) for layer in road.layers]
        base = ["rigid_base=True"] if road.rigid_base else []
        words = _call("tl.Pavement", [f"[\n{''.join(f'    {layer},{chr(10)}' for layer in layers)}]", *base])
    if part.temperature is None:
        return words
    how = ["extrapolate=True"] if part.extrapolate else []
    return f"{words}.at_temperature({', '.join([_code(part._temperature()), *how])})"


def _layer(layer: Layer) -> str:
    positional = [_code(layer.material)]
    arguments = {"thickness": layer.thickness, "name": layer.name or None}
    if layer.bond != BONDED:
        bond_code = "tl.pavement.FRICTIONLESS" if layer.bond == FRICTIONLESS else _code(layer.bond)
        return f"tl.Layer({', '.join([*positional, *_keywords(arguments), f'bond={bond_code}'])})"
    return f"tl.Layer({', '.join([*positional, *_keywords(arguments)])})"


def _code(value: object) -> str:
    """A value as Python that makes an equal one. Raises NoCallError."""
    if value is None or isinstance(value, bool | int | float | str):
        return repr(value)
    if isinstance(value, tuple | list):
        inner = [_code(item) for item in value]
        return (
            f"[{', '.join(inner)}]" if isinstance(value, list) else f"({', '.join(inner)}{',' * (len(inner) == 1)})"
        )
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        raise NoCallError
    mix = next((name for name in catalogue.mixes if catalogue.mixes[name] == value), None)
    if mix is not None:
        return f"tl.catalogue.mixes[{mix!r}]"
    arguments = {}
    for field in dataclasses.fields(value):
        argument = getattr(value, field.name)
        if not field.init:
            continue
        if field.default is not dataclasses.MISSING and argument == field.default:
            continue
        arguments[field.name] = argument
    return f"{_name(type(value))}({', '.join(f'{name}={_code(argument)}' for name, argument in arguments.items())})"


def _name(kind: type) -> str:
    if kind.__name__ == "FatigueLine":
        return "tl.FatigueLine"
    if kind.__name__ in _TOP:
        return f"tl.{kind.__name__}"
    for room, module in _ROOMS.items():
        if getattr(module, kind.__name__, None) is kind and kind.__name__ in getattr(module, "__all__", ()):
            return f"tl.{room}.{kind.__name__}"
    raise NoCallError


def _keywords(values: Mapping[str, object]) -> list[str]:
    return [f"{name}={value!r}" for name, value in values.items() if value is not None]


def _call(name: str, arguments: list[str]) -> str:
    line = f"{name}({', '.join(arguments)})"
    if "\n" in line or len(line) <= _LINE:
        return line
    return f"{name}(\n{''.join(f'    {argument},{chr(10)}' for argument in arguments)})"


def _doc(title: str) -> str:
    plain = " ".join(title.split()).replace("\\", "\\\\").replace('"', "'")
    return plain if plain.endswith(".") else f"{plain}."


def _indented(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())
