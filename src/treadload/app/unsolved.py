"""What a case asks for and the page does not solve, said beside the result, with the command that solves it."""

from __future__ import annotations

import re
from collections.abc import Mapping

from treadload.case import Case
from treadload.case.file import FilePart
from treadload.read import Table

# What `Engine._solve` takes of a case: whole tables and values, or some keys of a table. What the case learns besides
# is named until it stands here, so that nothing is left out in silence.
_WHOLE = frozenset(
    {"title", "folder", "spacing", "tolerance", "road_compliance", "tire", "pavement", "rolling", "footprint"}
)
_KEYS: Mapping[str, frozenset[str]] = {
    "response": frozenset({"depths", "slice_depth", "wheels", "speed", "side"}),
    "damage": frozenset({"fatigue", "strain", "mean_over", "depth", "lattices"}),
}


def unsolved(case: FilePart) -> list[str]:
    """Tables of a case, "[crossing]", and keys, "damage.error_estimate", that the page does not solve.

    A life is solved whole.
    """
    if not isinstance(case, Case):
        return []
    named = []
    for name in type(case).model_fields:
        value = getattr(case, name, None)
        if name not in case.model_fields_set or name in _WHOLE or value is None:
            continue
        if name in _KEYS and isinstance(value, Table):
            stray = [key for key in type(value).model_fields if key in value.model_fields_set - _KEYS[name]]
            named += [f"{name}.{key}" for key in stray if getattr(value, key) not in (None, False)]
        elif not (name == "texture" and value.resolved):
            # A texture that is resolved lies under the tire of the contact; else it is a patch, solved for itself.
            named.append(f"[{name}]")
    return named


def said_of(case: FilePart | None) -> str:
    """A sentence on what the page did not solve of a case; "" where it solved all."""
    named = [] if case is None else unsolved(case)
    if case is None or not named:
        return ""
    those = f"{', '.join(named[:-1])} and {named[-1]}" if len(named) > 1 else named[0]
    return (
        f"This page did not solve {those}. Take the TOML home and run `{command(case)}`; the NetCDF and the report "
        "below solve the whole case, too, for as long as that takes."
    )


def command(case: FilePart, file: str = "case.toml") -> str:
    """The command that solves a case whole."""
    (found,) = re.findall(r"`(treadload [^`]+)`", case.how_to_run.format(name=file))[:1]
    return str(found)
