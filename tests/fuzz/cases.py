"""Cases and cases of design: tables changed in their structure, and texts changed in their characters."""

from __future__ import annotations

import copy
import datetime
import functools
import math
import random
import tomllib
import typing
from pathlib import Path
from typing import Any

import tomli_w

from fuzz.corpus import QUESTIONS, TABLES
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from treadload.case import Case

NUMBERS: tuple[Any, ...] = (
    0, 1, -1, 2, 7, 1000, 2**63, -(10**30), 10**400, True, False,
    0.0, -0.0, 0.5, -0.2, 1e-300, 5e-324, 1e300, 1.7e308, math.nan, math.inf, -math.inf,
)  # fmt: skip
TEXTS = (
    "", " ", "5", "5 mm", "-5 mm", "0 mm", "3,5 mm", "1 000 mm", "5 kN", "8 bar", "15 degC", "15 °C", "1e400 m",
    "nan m", "inf", "-inf mm", "5 furlong", "m", "mm 5", "5 mm mm", "5 mm/0", "9**9**9 m", "5 m**9**9**9", "2^3 m",
    "0x10 mm", "1_000 mm", "٣ mm", "５ mm", "5 µm", "5 mm\n", "5\n6 mm", "\x01", "a" * 3000, "∞", "\u200b5 mm", "é",
    "example", "315/80R22.5", "EB-BBSG3", "PF3", "elastic", "prony", "bonded", "straight", "turning", "top",
    "french-subgrade", "coulomb", "map", "footprint.csv", "gap.csv", "wet.npy", "profile.toml", "..", "/",
    "missing.csv", "\x00", "%s", "{0}", "{x!r}", "[[a]]", "None", "__class__", "1e5", "1e400", "--5 mm", "5e mm",
    "()", "5 (mm)", "lambda: 0",
)  # fmt: skip
OTHERS: tuple[Any, ...] = (
    [], [[]], [1], [1, 2], [1, 2, 3], ["a"], [{}], [[1, 2], [3]], [math.nan], ["5 mm", 3], [True], [[1, "5 ms"]],
    {}, {"a": 1}, {"kind": "elastic"}, {"kind": []}, {"law": {}}, {"kind": {}}, {"stiffness": []}, {"law": "coulomb"},
    {"": 1}, {"folder": "/"}, datetime.date(2024, 2, 29), datetime.time(1, 2), datetime.datetime(2024, 1, 1, 1),
)  # fmt: skip


def attack(rng: random.Random, folder: Path) -> str:
    """Change a case, ask for it and all that is cheap to build of it, and read back what it writes."""
    for name, content in TABLES.items():
        (folder / name).write_bytes(content)
    kind, text = rng.choice(_corpus())
    path = folder / "case.toml"
    if rng.random() < 0.7:
        table = tomllib.loads(text)
        for _ in range(rng.choice((1, 1, 1, 2, 3))):
            _change(rng, table)
        path.write_text(tomli_w.dumps(table), encoding="utf-8", errors="surrogatepass")
    else:
        content = text.encode()
        for _ in range(rng.choice((1, 1, 2, 4))):
            content = _smudge(rng, content)
        path.write_bytes(content)
    case = ask(lambda: kind.from_toml(path))
    if isinstance(case, Refusal):
        return REFUSED
    _read_back(case, folder)
    ask(lambda: _build(case))
    return TAKEN


def _read_back(case: Any, folder: Path) -> None:
    """What a case writes is the same case, to the last digit."""
    text = case.to_toml()
    again = ask(lambda: type(case).from_text(text, folder=folder))
    if isinstance(again, Refusal):
        raise WrongAnswer(f"written back, it is refused: {again}")
    if again != case:
        told = [name for name in type(case).model_fields if getattr(again, name) != getattr(case, name)]
        raise WrongAnswer(f"written back, {', '.join(told)} differs: {text}")


def _build(case: Case | Case) -> None:
    """Everything of a case that takes no solve. A scan takes seconds and has attacks of its own."""
    if case.tire is not None and case.tire.scan is None:
        case.build_tire()
    if isinstance(case, Case):
        case.build_road()
        case.build_traffic()
        case.build_climate()
        case.build_criteria()
        return
    case.pavement.build()
    case.pavement.layer_temperatures()
    if case.rolling is not None:
        case.build_rolling()
    if case.footprint is not None:
        case.response.place(case.footprint.build(case.folder))


@functools.cache
def _corpus() -> list[tuple[type[Case], str]]:
    return [(Case, text) for text in QUESTIONS]


@functools.cache
def _keys() -> list[str]:
    """Every key that any table of a case knows."""
    keys: set[str] = set()
    seen: set[Any] = set()

    def visit(kind: Any) -> None:
        if hasattr(kind, "model_fields") and kind not in seen:
            seen.add(kind)
            keys.update(kind.model_fields)
            for field in kind.model_fields.values():
                visit(field.annotation)
        for part in typing.get_args(kind):
            visit(part)

    visit(Case)
    return sorted(keys)


@functools.cache
def _subtrees() -> list[Any]:
    """Tables and lists of all cases, to be put where they do not belong."""
    found: list[Any] = []
    for _, text in _corpus():
        table = tomllib.loads(text)
        found += [owner[key] for owner, key in _places(table) if isinstance(owner[key], dict | list)]
    return found


def _places(table: Any) -> list[tuple[Any, Any]]:
    """(table or list, key or index) of everything in a tree."""
    found: list[tuple[Any, Any]] = []
    keys = list(table) if isinstance(table, dict) else range(len(table))
    for key in keys:
        found.append((table, key))
        if isinstance(table[key], dict | list):
            found += _places(table[key])
    return found


def _anything(rng: random.Random) -> Any:
    which = rng.random()
    if which < 0.3:
        return rng.choice(NUMBERS)
    if which < 0.6:
        return rng.choice(TEXTS)
    if which < 0.85:
        return copy.deepcopy(rng.choice(OTHERS))
    if which < 0.95:
        return copy.deepcopy(rng.choice(_subtrees()))
    deep: Any = rng.choice((1, "x"))
    for _ in range(rng.choice((5, 40))):
        deep = [deep] if rng.random() < 0.5 else {"a": deep}
    return deep


def _change(rng: random.Random, table: dict[str, Any]) -> None:
    """One change of the structure or of a value, in place."""
    places = _places(table)
    if not places:
        table["title"] = _anything(rng)
        return
    owner, key = rng.choice(places)
    which = rng.randrange(12)
    if which <= 3:
        owner[key] = _anything(rng)
    elif which == 4:
        del owner[key]
    elif which == 5:
        owner[key] = rng.choice(([owner[key]], {"a": owner[key]}, [owner[key], copy.deepcopy(owner[key])]))
    elif which == 6:
        other, name = rng.choice(places)
        mine, theirs = copy.deepcopy(owner[key]), copy.deepcopy(other[name])
        owner[key], other[name] = theirs, mine
    elif which == 7 and isinstance(owner, dict):
        owner[rng.choice(_keys())] = _anything(rng)
    elif which == 8 and isinstance(owner, dict):
        owner[rng.choice(_keys())] = owner.pop(key)
    elif which == 9 and isinstance(owner, dict):
        owner[_typo(rng, str(key))] = owner.pop(key)
    elif which == 10 and isinstance(owner, list):
        owner += copy.deepcopy(owner) * rng.choice((1, 30))
    elif isinstance(owner[key], int | float) and not isinstance(owner[key], bool):
        owner[key] = owner[key] * rng.choice((-1, 0, 1e-9, 1e-3, 1e3, 1e9, 1e20)) if abs(owner[key]) < 1e300 else 0
    elif isinstance(owner[key], str):
        owner[key] = _typo(rng, owner[key])
    else:
        owner[key] = _anything(rng)


def _typo(rng: random.Random, text: str) -> str:
    at = rng.randrange(len(text) + 1)
    sign = rng.choice("aZ09 .,;-+*/^%()[]{}'\"\\\té°µ\u00a0\u202f")
    return rng.choice((text[:at] + text[at + 1 :], text[:at] + sign + text[at:], text[:at] + sign + text[at + 1 :]))


def _smudge(rng: random.Random, content: bytes) -> bytes:
    """One change of the characters."""
    at = rng.randrange(len(content) + 1)
    which = rng.randrange(10)
    lines = content.split(b"\n")
    line = rng.randrange(len(lines))
    if which == 0:
        return content[:at]
    if which == 1:
        return content[:at] + bytes([rng.randrange(256)]) + content[at + 1 :]
    if which == 2:
        return (
            content[:at]
            + rng.choice((b"[", b"]", b"{", b"}", b'"', b"=", b"'''", b"#", b"\x00", b"\xff"))
            + content[at:]
        )
    if which == 3:
        return b"\n".join([*lines[:line], *lines[line + 1 :]])
    if which == 4:
        return b"\n".join([*lines[:line], lines[line], *lines[line:]])
    if which == 5:
        other = rng.randrange(len(lines))
        lines[line], lines[other] = lines[other], lines[line]
        return b"\n".join(lines)
    if which == 6:
        many = rng.choice(
            (b"[" * 3000, b"9" * 5000, b"{a=" * 2000, b"a." * 2000, b"\n" * 100, b"[[a]]\n" * 50, b"[a.a]\n")
        )
        return content[:at] + many + content[at:]
    if which == 7:
        return rng.choice((b"\xef\xbb\xbf", b"\xff\xfe", b"\x00", b"")) + content.replace(
            b"\n", rng.choice((b"\r\n", b"\r", b"\n"))
        )
    if which == 8:
        return rng.choice(
            (b"", b"\n", b"a", b"title = 1", b"[[tire]]", b"\xf0\x9f\x9a\x97", b"tire = []\n" + content)
        )
    digits = [place for place, sign in enumerate(content) if sign in b"0123456789."]
    if not digits:
        return content
    place = rng.choice(digits)
    return (
        content[:place]
        + rng.choice((b"", b"-", b"e", b"1e999", b",", b"_", b"0", b"..", b"nan", b"9" * 400))
        + content[place + 1 :]
    )
