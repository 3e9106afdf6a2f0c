"""Public names: read from the stub `__init__.pyi`, and loaded when they are first used."""

from __future__ import annotations

import os
import re
import sys
from importlib import import_module
from types import ModuleType

_PACKAGE = __name__.rpartition(".")[0]
_FOLDER = os.path.dirname(__file__)

with open(os.path.join(_FOLDER, "__init__.pyi"), encoding="utf-8") as _stub:
    _HOMES: dict[str, str] = {
        name: home
        for home, name in re.findall(rf"^from ({_PACKAGE}[\w.]*) import (\w+) as \2$", _stub.read(), re.MULTILINE)
    }

NAMES = sorted(_HOMES)


def names() -> list[str]:
    """The public names, sorted: what `dir(treadload)` shows."""
    return list(NAMES)


def named(name: str) -> object:
    """What has a public name. Raises AttributeError that states where else a name is, or which one was meant."""
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(_unknown(name))
    value = import_module(f"{home}.{name}") if home == _PACKAGE else getattr(import_module(home), name)
    setattr(sys.modules[_PACKAGE], name, value)
    return value


def _unknown(name: str) -> str:
    """The message about a name that is not public."""
    text = f"module {_PACKAGE!r} has no attribute {name!r}"
    # Notebooks ask for names that begin with "_", `from treadload import units` for a module before it imports it.
    if name.startswith("_") or any(os.path.exists(os.path.join(_FOLDER, name + end)) for end in ("", ".py")):
        return text
    modules = {room: module for room in NAMES if isinstance(module := named(room), ModuleType)}
    places = [f"{room}.{name}" for room, module in modules.items() if name in module.__all__]
    if places:
        return f"{_PACKAGE}.{name} is {_PACKAGE}.{places[0]}"
    # Needed for misspelt names only.
    from treadload.errors import meant

    near = meant(name, NAMES)
    return text if near is None else f"{text}; did you mean {near!r}?"
