"""Names of runs by what differs between their cases."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from treadload.app.case_schema import label_of
from treadload.app.form import leaves_of
from treadload.app.session import Run

# Differences that a name states.
_MOST = 3


def names_of(runs: Sequence[Run], known_as: Callable[[str], str] = str) -> dict[str, str]:
    """Names of runs: the values of the keys in which their cases differ; the title of a run that stands alone.

    runs: the oldest first. known_as: the name of a file as the user knows it. Runs of one case are numbered.
    """
    with_case = [run for run in runs if run.form is not None]
    names = {run.name: run.title for run in runs}
    if len(with_case) < 2:
        return names
    leaves = {run.name: leaves_of(run.form.table) for run in with_case if run.form is not None}
    keys = list(dict.fromkeys(key for table in leaves.values() for key in table))
    differing = [key for key in keys if len({str(table.get(key)) for table in leaves.values()}) > 1]
    for run in with_case:
        assert run.form is not None
        table = leaves[run.name]
        # A table that only some have is one difference, not as many as it has keys.
        parts = list(dict.fromkeys(_words(key, table, run.form.table, known_as) for key in differing))
        more = f" and {len(parts) - _MOST} more" if len(parts) > _MOST else ""
        names[run.name] = f"{', '.join(parts[:_MOST])}{more}" if parts else run.title
    counts: dict[str, int] = {}
    for run in with_case:
        name = names[run.name]
        counts[name] = counts.get(name, 0) + 1
        if counts[name] > 1:
            names[run.name] = f"{name} ({counts[name]})"
    return names


def _words(
    key: str, leaves: Mapping[str, object], table: Mapping[str, object], known_as: Callable[[str], str]
) -> str:
    """A key and its value, "normal load 36 kN", of a row with the name of the row; "without belt" where it lacks."""
    *above, last = key.split(".")
    if key not in leaves:
        # The first table or row of the path that this case does not have, or its key.
        here: object = table
        for part in (*above, last):
            inner = here.get(part) if isinstance(here, Mapping) else _row(here, part)
            if inner is None or not isinstance(inner, Mapping | list):
                return f"without {_label(part)}"
            here = inner
        return f"without {_label(last)}"
    value = leaves[key]
    text = ", ".join(map(str, value)) if isinstance(value, list) else known_as(str(value))
    return f"{name_of_key(key, table)} {text}"


def name_of_key(key: str, table: Mapping[str, object]) -> str:
    """A key of a case in words, with the name of the row that it is in: "wearing course thickness"."""
    *above, last = key.split(".")
    row: object = table
    called = ""
    for part in above:
        row = row.get(part) if isinstance(row, Mapping) else _row(row, part)
        if isinstance(row, Mapping) and part.isdigit() and last != "name":
            called = f"{row.get('name') or row.get('mix') or f'{int(part) + 1}.'} "
    return f"{called}{_label(above[-1] if last in ('kind', 'name') and above and not above[-1].isdigit() else last)}"


def _row(rows: object, part: str) -> object:
    return rows[int(part)] if isinstance(rows, list) and part.isdigit() and int(part) < len(rows) else None


def _label(part: str) -> str:
    return f"row {int(part) + 1}" if part.isdigit() else label_of(part).lower()
