"""Errors of the reader at the field that they are about, in the name and the unit of that field."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping

from treadload.app.form_field import Field
from treadload.errors import InputError
from treadload.units import quantity

# Units that the reader writes as words.
_WORDS = {"metres": "m", "metre": "m", "newtons": "N", "pascals": "Pa", "seconds": "s", "radians": "rad"}
_NUMBER = re.compile(r"(?<![\w.'\"^/])(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)(?![\w.'\"/]*[\w'\"/])( ?[^\s;,.)]+)?")
_SHARES = re.compile(r"\bshares of (?:a |the )?(\w+).* must sum to 1\b")
_GOT = re.compile(r"got (-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)")


def at_fields(
    wrong: Mapping[str, str], fields: Mapping[str, Field], values: Mapping[str, object]
) -> tuple[dict[str, str], list[str]]:
    """Sentences by the path of their field, in its name and unit, and those that belong to no field.

    wrong: what the reader says, by the path of a key, of a table, or "" of the whole. fields: on the page, by path.
    values: of these fields as the case gives them.
    """
    placed: dict[str, list[str]] = {}
    elsewhere = []
    for key, text in wrong.items():
        shares = _shares_of(text, key, fields)
        path = "" if shares else _nearest(key, fields) or _named_in(text, key, fields, values)
        paths = [path] if path else shares
        for at in paths:
            placed.setdefault(at, []).append(in_words_of(text, fields[at]))
        if not paths:
            elsewhere.append(f"{key}: {text}" if key else text)
    return {path: "; ".join(texts) for path, texts in placed.items()}, elsewhere


def _nearest(key: str, fields: Iterable[str]) -> str:
    """The field of a key, or of the value that holds it."""
    parts = key.split(".")
    ends = (".".join(parts[:count]) for count in range(len(parts), 0, -1))
    return next((path for path in ends if path in fields), "")


def _named_in(text: str, table: str, fields: Mapping[str, Field], values: Mapping[str, object]) -> str:
    """The field below a table that a sentence names by its key; of several, that which holds the number it got."""
    before = f"{table}." if table else ""
    matches = [
        path for path in fields
        if path.startswith(before) and values.get(path) is not None
        and re.search(rf"(?<![\w.]){re.escape(_key(path))}(?!\w)", text)
    ]  # fmt: skip
    number = _GOT.search(text)
    if number is not None:
        with_number = [path for path in matches if _holds(fields[path], values.get(path), float(number[1]))]
        if with_number:
            return with_number[0]
    first = sorted(matches, key=lambda path: (text.index(_key(path)), path.count(".")))
    # Of several fields with one name none is meant more than the others.
    return first[0] if first and len([path for path in matches if _key(path) == _key(first[0])]) == 1 else ""


def _shares_of(text: str, table: str, fields: Iterable[str]) -> list[str]:
    """The fields of the shares whose sum a sentence is about: those of the first list below a table, or none."""
    match = _SHARES.search(text)
    if match is None:
        return []
    below = [
        path for path in fields
        if path.startswith(f"{table}." if table else "") and _key(path) == "share" and match[1] in path.split(".")
    ]  # fmt: skip
    least = min((path.count(".") for path in below), default=0)
    return [path for path in below if path.count(".") == least]


def _key(path: str) -> str:
    return path.rpartition(".")[2]


def _holds(field: Field, value: object, number: float) -> bool:
    try:
        return math.isclose(quantity(value, field.si), number, rel_tol=1e-5, abs_tol=1e-12)
    except (InputError, ValueError, TypeError):
        return False


def in_words_of(text: str, field: Field) -> str:
    """A sentence of the reader with the label of a field for its key, and its numbers in the unit of the field."""
    label = field.label[:1].lower() + field.label[1:]
    key = rf"(^|: |the ){re.escape(_key(field.path))}(?= (?:must|is|of|has)\b)"
    labelled = re.sub(key, lambda match: match[1] + (label if match[1] else field.label), text)
    if not field.unit or not field.si or field.unit == field.si:
        return labelled
    try:
        factor = quantity(f"1 {field.unit}", field.si)
    except (InputError, ValueError):
        return labelled
    units = {field.si, *(word for word, unit in _WORDS.items() if unit == field.si)}
    spelled = "|".join(re.escape(unit) for unit in sorted(units, key=len, reverse=True))
    stated = rf"(?:number of|quantity in|between \S+ and \S+|got \S+|[<>]=? \S+) (?:{spelled})(?![\w/^])"
    if re.search(stated, labelled) is None:
        return labelled
    # "80 km/h is 22.2" explains a number to whoever writes in SI.
    plain = re.sub(rf"(\d {re.escape(field.unit)}) is [\d.e+]*\d", r"\1 is usual", labelled)
    in_field_unit = re.sub(rf"(?<=\d) ?{re.escape(field.unit)}(?![\w/^])", lambda match: f"\0{match[0]}", plain)
    in_unit = re.sub(rf"(?<= )(?:{spelled})(?![\w/^])", field.unit, in_field_unit)
    return "".join(_converted(in_unit, field, factor)).replace("\0", "")


def _converted(text: str, field: Field, factor: float) -> Iterator[str]:
    """The parts of a sentence, its bare numbers divided by a factor; what has another unit stays."""
    end = 0
    for match in _NUMBER.finditer(text):
        unit = (match[2] or "").strip()
        yield text[end : match.start()]
        end = match.end()
        if unit.startswith("\0") or (unit and unit != field.unit and _is_unit(unit, field.si)):
            yield match[0]
        else:
            yield f"{float(match[1]) / factor:.6g}{match[2] or ''}"
    yield text[end:]


def _is_unit(word: str, si: str) -> bool:
    try:
        quantity(f"1 {word}", si)
    except (InputError, ValueError):
        return False
    return True
