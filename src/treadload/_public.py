"""Public names: read from the stub `__init__.pyi`, and loaded when they are first used."""

from __future__ import annotations

import os
import re
import sys
from importlib import import_module
from types import ModuleType
from typing import Any

from treadload import accessors

_PACKAGE = __name__.rpartition(".")[0]
_FOLDER = os.path.dirname(__file__)

with open(os.path.join(_FOLDER, "__init__.pyi"), encoding="utf-8") as _stub:
    _HOMES: dict[str, str] = {
        name: home
        for home, name in re.findall(rf"^from ({_PACKAGE}[\w.]*) import (\w+) as \2$", _stub.read(), re.MULTILINE)
    }

NAMES = sorted(_HOMES)

# Former names, and what they are called now.
_RENAMED = {
    "Life": "damage.Life",
    "DesignResult": "LifeResult",
    "run_design": "run_life",
    "DesignCriterion": "damage.Criterion",
    "design_life": "study.solve_life",
    "life_tree": "results.to_tree",
    "load": "open_results",
    "mix": "catalogue.mixes[name]",
    "mixes": "catalogue.mixes",
    "place": "place_load",
    "published_material": "catalogue.materials[name]",
    "published_materials": "catalogue.materials",
    "read_published": "catalogue.read_materials",
    "save": "save_results",
    "structures": "catalogue.structures",
}


def names() -> list[str]:
    """The public names, sorted: what `dir(treadload)` shows."""
    return list(NAMES)


def named(name: str) -> Any:
    """What has a public name. Raises AttributeError that says where else a name is, or which one was meant."""
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(_unknown(name))
    value = import_module(f"{home}.{name}") if home == _PACKAGE else getattr(import_module(home), name)
    setattr(sys.modules[_PACKAGE], name, value)
    return value


def _unknown(name: str) -> str:
    """What to say of a name that is not public."""
    said = f"module {_PACKAGE!r} has no attribute {name!r}"
    # Notebooks ask for names that begin with "_", `from treadload import units` for a module before it imports it.
    if name.startswith("_") or any(os.path.exists(os.path.join(_FOLDER, name + end)) for end in ("", ".py")):
        return said
    rooms = [room for room in NAMES if isinstance(named(room), ModuleType)]
    places = [f"{room}.{name}" for room in rooms if name in named(room).__all__]
    if name in _RENAMED or places:
        return f"{_PACKAGE}.{name} is {_PACKAGE}.{_RENAMED.get(name) or places[0]} now"
    # Needed for misspelt names only.
    from treadload.errors import meant

    near = meant(name, NAMES)
    return said if near is None else f"{said}; did you mean {near!r}?"


# Results offer figures; the figures are loaded when they are first asked for.
accessors.found_in("plot", lambda: named("plots"))
# Colour maps by their names, which pictures of footprints are read with, are there, too.
accessors.found_in("colour_map", lambda: named("plots"))
# So do classes of results that a file names.
accessors.found_in("result", lambda: named("study"))
