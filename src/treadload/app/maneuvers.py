"""What the wheels of a class of axles do, as fields: one maneuver, or several with their shares."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from treadload.app.fields import Field
from treadload.app.life_form import LifeForm

KINDS: dict[str, str] = {
    "straight": "straight on", "braking": "brakes", "locked": "locked", "uphill": "climbs", "turning": "turns",
}  # fmt: skip
"""Maneuvers that the page offers, and what it calls them."""
# Where a maneuver begins that has numbers: a firm stop, a semi-trailer on a slope, a roundabout.
_FIRST: dict[str, dict[str, Any]] = {
    "braking": {"deceleration": 2.5},
    "uphill": {"grade": 0.05, "driven_share": 0.25},
    "turning": {"radius": "25 m", "speed": "25 km/h"},
}
_FIELDS: dict[str, tuple[Field, ...]] = {
    "braking": (Field("deceleration", "Deceleration", "m/s^2", "m/s^2"),),
    "uphill": (
        Field("grade", "Grade", words="rise over run, 6 % is 0.06"),
        Field("driven_share", "Driven share", words="of the vehicle's weight on its driven axles"),
    ),
    "turning": (
        Field("radius", "Radius", "m", "m", words="of the path; positive to the right, negative to the left"),
        Field("speed", "In the turn", "km/h", "m/s", words="speed in the turn"),
        Field("crossfall", "Crossfall", words="of the road towards the centre of the circle", otherwise="0"),
    ),
}


def kind_of(told: Any) -> str:
    """The kind of a maneuver of a case: a word, a table with one, or none."""
    if isinstance(told, Mapping):
        return str(told.get("kind", "forces"))
    return "straight" if told is None else str(told)


def choices_of(told: Any) -> dict[str, str]:
    """Kinds to choose from; one that only a case can give stays among them."""
    own = kind_of(told)
    return KINDS if own in KINDS else {**KINDS, own: own}


def maneuver_fields(path: str, told: Any) -> Iterator[Field]:
    """Fields of the numbers of a maneuver. path: of its key."""
    for field in _FIELDS.get(kind_of(told), ()) if isinstance(told, Mapping) else ():
        yield Field(f"{path}.{field.path}", field.label, field.unit, field.si, words=field.words,
                    otherwise=field.otherwise)  # fmt: skip
    if isinstance(told, Mapping) and "share" in told:
        yield Field(f"{path}.share", "Share", words="of the class's passes")


def several(row: Any) -> list[Any]:
    """The maneuvers of a class that has more than one."""
    held = row.get("maneuvers") if isinstance(row, Mapping) else None
    return list(held) if isinstance(held, list) else []


def with_kind(form: LifeForm, number: int, kind: str, which: int | None = None) -> LifeForm:
    """The form with a class whose maneuver is of another kind. which: of several; left out, its only one."""
    path = f"traffic.classes.{number}"
    if which is None:
        made: Any = {"kind": kind, **_FIRST[kind]} if kind in _FIRST else kind
        return form.with_values({f"{path}.maneuver": made})
    held = several(form.value(path))
    others = [one for k, one in enumerate(held) if k != which]
    held[which] = {"name": _name(kind, others), "kind": kind, **_FIRST.get(kind, {}), "share": held[which]["share"]}
    return form.with_values({f"{path}.maneuvers": held})


def with_another(form: LifeForm, number: int) -> LifeForm:
    """The form with a class that does one thing more: a tenth of its passes brake, or none where it did several."""
    path = f"traffic.classes.{number}"
    held, only = several(form.value(path)), form.value(f"{path}.maneuver")
    if not held:
        before = dict(only) if isinstance(only, Mapping) else {"kind": kind_of(only)}
        held = [{"name": _name(kind_of(only), []), **before, "share": 0.9}]
    new = {"name": _name("braking", held), "kind": "braking", **_FIRST["braking"]}
    held.append({**new, "share": 0.1 if len(held) == 1 else 0.0})
    return form.with_values({f"{path}.maneuver": None, f"{path}.maneuvers": held})


def without_one(form: LifeForm, number: int, which: int) -> LifeForm:
    """The form with a class that does one thing less; what is left alone is its maneuver."""
    path = f"traffic.classes.{number}"
    held = [one for k, one in enumerate(several(form.value(path))) if k != which]
    if len(held) > 1:
        return form.with_values({f"{path}.maneuvers": held})
    left = {key: value for key, value in held[0].items() if key not in ("share", "name")}
    return form.with_values({f"{path}.maneuvers": None, f"{path}.maneuver": left if len(left) > 1 else left["kind"]})


def _name(kind: str, others: list[Any]) -> str:
    """What a maneuver is called in tables, unlike the others of its class."""
    words, taken = KINDS.get(kind, kind), {one.get("name") for one in others if isinstance(one, Mapping)}
    return words if words not in taken else f"{words}, {len(others) + 1}"
