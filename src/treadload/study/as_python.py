"""A case as the Python that gives the same result."""

from __future__ import annotations

import dataclasses
import pprint
from collections.abc import Callable
from pathlib import Path
from typing import Any

from treadload import catalogue, contact, materials, pavement, tire
from treadload.case import Case, LifeCase
from treadload.case.choices import TIRE_MATERIAL
from treadload.case.file import FilePart
from treadload.case.response import WheelPart
from treadload.case.road import PavementPart
from treadload.case.tire import EXAMPLE, TirePart
from treadload.contact import friction
from treadload.errors import InputError
from treadload.pavement import BONDED, FRICTIONLESS, Layer
from treadload.response import MATERIAL_LENGTH

# Where a class can be reached from `import treadload as tl`, the shortest way first.
_TOP = ("Elastic", "Orthotropic", "TransverselyIsotropic", "ElastoPlastic", "Bond", "Layer", "Rolling")
_ROOMS = {"materials": materials, "pavement": pavement, "friction": friction, "contact": contact, "tire": tire}
_LINE = 110


class _NoWordsError(Exception):
    """A thing has no call that a reader would write."""


def case_as_python(case: FilePart) -> str:
    """Python that computes what a case asks for, with the verbs of the package: the same numbers to the last digit.

    case: a `Case`, or a `LifeCase`. A wheel on a road becomes Tire, Pavement, Rolling and the verbs from contact to
    verdict, and leaves the results in `contact`, `response` and `verdict`; what else a case can ask for becomes
    `Case.from_dict` and the verb that runs it, with the result in `result`. Relative paths of files start from
    the folder of the case. Returns the text of a script. Raises InputError for another kind of case.
    """
    head = [f'"""{_doc(case.title)}"""', ""] if case.title else []
    if isinstance(case, LifeCase):
        body = [*_whole(case, "LifeCase"), "result = tl.run_life(case)", "print(result.summary())"]
    elif not isinstance(case, Case):
        raise InputError(f"only the case of a wheel or of a life is told in Python, got {type(case).__name__}")
    elif _is_plain(case):
        body = _verbs(case)
    else:
        runs = "tl.study.run_dents(case)" if case.dents else "tl.run_case(case)"
        body = [*_whole(case, "Case"), f"result = {runs}", "print(result.summary())"]
    return "\n".join([*head, "import treadload as tl", "", *body, ""])


def _is_plain(case: Case) -> bool:
    """One wheel that is computed, and read at depths."""
    more = (
        case.footprint, case.passes, case.aggregates, case.texture, case.crossing, case.indentation, case.drum,
    )  # fmt: skip
    estimate = case.damage is not None and case.damage.error_estimate
    return all(one is None for one in more) and not estimate and case.response.wheels == (WheelPart(),)


def _whole(case: FilePart, kind: str) -> list[str]:
    table = pprint.pformat(case.given(), width=_LINE - 4, sort_dicts=False)
    folder = "" if case.folder == Path(".") else f", folder={str(case.folder)!r}"
    return [f"# Numbers are SI.\ncase = tl.{kind}.from_dict(\n{_indented(table)}{folder}\n)"]


def _verbs(case: Case) -> list[str]:
    assert case.tire is not None
    road, rolling = case.build_road(), case.build_rolling()
    lines = ["# Numbers are SI: m, N, Pa, rad."]
    part = case.tire
    parts: dict[str, Callable[[], str]] = {
        "tire": lambda: _tire(part, case.folder),
        "road": lambda: _road(case.pavement),
        "wheel": lambda: _code(rolling),
    }
    told = {}
    for name, write in parts.items():
        try:
            told[name] = write()
        except _NoWordsError:
            told[name] = f"case.build_{'rolling' if name == 'wheel' else name}()"
    if any("case." in words for words in told.values()):
        lines += _whole(case, "Case")
    lines += [f"{name} = {words}" for name, words in told.items()]
    asked: dict[str, Any] = {"spacing": case.spacing}
    if case.tolerance != 1e-6:
        asked["tolerance"] = case.tolerance
    if case.road_compliance != "half_space":
        asked["road_compliance"] = case.road_compliance
    lines += ["", _call("contact = tl.solve_contact", ["tire", "road", "wheel", *_keywords(asked)])]
    reads: dict[str, Any] = {"depths": list(case.response.depths)}
    if case.response.side != "above":
        reads["side"] = case.response.side
    if road.is_viscoelastic:
        reads["speed"] = case.speed
    where = []
    if not road.is_homogeneous:
        lines += [
            "# On layers also 0.1 m beside the contact: stiff ones spread the load.",
            "points = tl.study.map_grid([tl.GridLoad.from_dataset(contact)], road)",
        ]
        where = ["x=points.x", "y=points.y"]
    lines += [_call("response = tl.solve_response", ["contact", "road", *_keywords(reads), *where])]
    said = ["contact", "response"]
    if case.damage is not None:
        damage = case.damage
        law = damage.fatigue.build()
        try:
            line = _code(law)
        except _NoWordsError as error:
            raise InputError(f"the law {law} has no words in Python; keep the case as TOML") from error
        how: dict[str, Any] = {"strain": damage.strain, "depth": damage.depth}
        if damage.depth is None and damage.mean_over != MATERIAL_LENGTH:
            how["mean_over"] = damage.mean_over
        besides = []
        if damage.depth is None and damage.lattices != 1 and part.height_map is None:
            again = ["tire", "road", "wheel", *_keywords(asked), "offset=(0.5, 0.5)"]
            lines += [
                "# Another on cells half a cell beside: the verdict must not depend on where cells lie.",
                _call("shifted = tl.solve_contact", again),
            ]
            besides = ["shifted=shifted"]
        lines += [_call("verdict = tl.assess", ["response", line, *besides, *_keywords(how)])]
        said.append("verdict")
    lines += ["", *(f"print({name}.summary())" for name in said)]
    return lines


def _tire(part: TirePart, folder: Path) -> str:
    given = part.model_fields_set
    asked: dict[str, Any] = {"inflation_pressure": part.inflation_pressure}
    more = []
    if part.material is not None:
        more.append(f"material={_code(TIRE_MATERIAL.build(part.material))}")
    if part.belt is not None:
        if not isinstance(part.belt, str):
            raise _NoWordsError
        more.append(f"belt=tl.Belt.from_library({part.belt!r})")
    if part.scan is not None:
        first = "tl.example_mesh()" if part.scan == EXAMPLE else repr(str(folder / part.scan))
        names = ("units", "nominal_diameter", "rotation", "camber", "revolve", "fill_holes", "smooth", "outliers",
                 "roundness")  # fmt: skip
        asked |= {name: getattr(part, name) for name in names if name in given}
        return _call("tl.Tire.from_scan", [first, *_keywords(asked), *more])
    if part.height_map is not None:
        asked |= {"units": part.units, "decimal": part.decimal}
        path = repr(str(folder / part.height_map))
        return _call("tl.Tire.from_height_map", [path, repr(part.cell), *_keywords(asked), *more])
    if not isinstance(part.profile, str):
        raise _NoWordsError
    if part.profile.endswith(".toml"):
        profile = f"tl.tire.TreadProfile.from_toml({str(folder / part.profile)!r})"
    else:
        profile = repr(part.profile)
    return _call("tl.Tire.from_profile", [profile, *_keywords(asked), *more])


def _road(part: PavementPart) -> str:
    if part.structure is not None:
        words = _call("tl.Pavement.from_catalogue", [repr(part.structure), *_keywords({"frequency": part.frequency})])
    else:
        road = part.untempered()
        layers = [_layer(one) for one in road.layers]
        base = ["rigid_base=True"] if road.rigid_base else []
        words = _call("tl.Pavement", [f"[\n{''.join(f'    {one},{chr(10)}' for one in layers)}]", *base])
    if part.temperature is None:
        return words
    how = ["extrapolate=True"] if part.extrapolate else []
    return f"{words}.at_temperature({', '.join([_code(part._temperature()), *how])})"


def _layer(layer: Layer) -> str:
    said = [_code(layer.material)]
    told = {"thickness": layer.thickness, "name": layer.name or None}
    if layer.bond != BONDED:
        said_bond = "tl.FRICTIONLESS" if layer.bond == FRICTIONLESS else _code(layer.bond)
        return f"tl.Layer({', '.join([*said, *_keywords(told), f'bond={said_bond}'])})"
    return f"tl.Layer({', '.join([*said, *_keywords(told)])})"


def _code(value: Any) -> str:
    """A value as Python that makes an equal one. Raises _NoWordsError."""
    if value is None or isinstance(value, bool | int | float | str):
        return repr(value)
    if isinstance(value, tuple | list):
        inner = [_code(one) for one in value]
        return (
            f"[{', '.join(inner)}]" if isinstance(value, list) else f"({', '.join(inner)}{',' * (len(inner) == 1)})"
        )
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        raise _NoWordsError
    mix = next((name for name in catalogue.mixes if catalogue.mixes[name] == value), None)
    if mix is not None:
        return f"tl.catalogue.mixes[{mix!r}]"
    told = {}
    for field in dataclasses.fields(value):
        one = getattr(value, field.name)
        if not field.init:
            continue
        if field.default is not dataclasses.MISSING and one == field.default:
            continue
        told[field.name] = one
    return f"{_name(type(value))}({', '.join(f'{name}={_code(one)}' for name, one in told.items())})"


def _name(kind: type) -> str:
    if kind.__name__ == "FatigueLine":
        return "tl.FatigueLine"
    if kind.__name__ in _TOP:
        return f"tl.{kind.__name__}"
    for room, module in _ROOMS.items():
        if getattr(module, kind.__name__, None) is kind and kind.__name__ in getattr(module, "__all__", ()):
            return f"tl.{room}.{kind.__name__}"
    raise _NoWordsError


def _keywords(values: dict[str, Any]) -> list[str]:
    return [f"{name}={value!r}" for name, value in values.items() if value is not None]


def _call(name: str, arguments: list[str]) -> str:
    line = f"{name}({', '.join(arguments)})"
    if "\n" in line or len(line) <= _LINE:
        return line
    return f"{name}(\n{''.join(f'    {one},{chr(10)}' for one in arguments)})"


def _doc(title: str) -> str:
    plain = " ".join(title.split()).replace("\\", "\\\\").replace('"', "'")
    return plain if plain.endswith(".") else f"{plain}."


def _indented(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())
