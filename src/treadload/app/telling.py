"""What the page says of a result in words: the rows of the verdict, and where each of them happens."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.damage import Verdict
from treadload.damage.quantity import READINGS
from treadload.damage.verdict import under
from treadload.plots.interactive import places_of
from treadload.study.allowed import Allowed, PassesAllowed
from treadload.units import stress_in_words

# More passes than any road bears.
_COUNTLESS = 1e10

Row = dict[str, Any]
"""label, value with its unit, group; x, y, m, where it happens; note, a sentence for those who ask."""


def rows_of(parts: Mapping[str, BaseResult]) -> list[Row]:
    """The verdict, row by row, in the digits of the summaries."""
    rows: list[Row] = []
    contact, response, verdict = (parts.get(name) for name in ("contact", "response", "damage"))
    if contact is not None:
        rows += contact_rows(contact)
    if isinstance(verdict, Verdict):
        rows += verdict_rows(verdict)
    elif response is not None:
        rows += response_rows(response)
    if contact is not None:
        rows += solver_rows(contact)
    return rows


def contact_rows(contact: Any) -> list[Row]:
    """Of a contact, or of a measured footprint in its place."""
    data = contact.dataset
    pressure = data["pressure"]
    peak = places_of(contact)[0]
    area = float((pressure > 0).sum()) * data.attrs["dx"] * data.attrs["dy"]
    load = float(pressure.sum()) * data.attrs["dx"] * data.attrs["dy"]
    mean = load / area / 1e3 if area else 0.0
    rows = [
        row("load", "Load", f"{load / 1e3:.3f} kN"),
        row("area", "Contact area", f"{area * 1e6:.0f} mm²"),
        row("mean", "Mean pressure", f"{mean:.0f} kPa"),
        row("peak", "Peak pressure", stress_in_words(float(pressure.max())), x=peak.x, y=peak.y),
    ]
    if isinstance(contact, Contact):
        shear = (data["traction_x"] ** 2 + data["traction_y"] ** 2) ** 0.5
        at = shear.argmax(dim=("y", "x"))
        x, y = float(data["x"][at["x"]]), float(data["y"][at["y"]])
        rows += [
            row("shear", "Peak shear", stress_in_words(float(shear.max())), x=x, y=y),
            row("slip", "Slip share", f"{100 * contact.slip_fraction:.1f} %"),
            row("approach", "Approach", f"{float(data['approach']) * 1e3:.2f} mm"),
            row("along", "Force along travel", f"{float(data['tractive_force']):z.1f} N"),
            row("aside", "Force aside", f"{float(data['lateral_force']):z.1f} N"),
            row("creepage_x", "Creepage along", f"{float(data['creepage_x']):z.5f}"),
            row("creepage_y", "Creepage aside", f"{float(data['creepage_y']):z.5f}"),
        ]  # fmt: skip
    return rows


def response_rows(response: BaseResult) -> list[Row]:
    """Of a response without a verdict."""
    return [
        row(f"extension{number}", "Largest extension", place.text.partition(": ")[2], group="road", x=place.x,
             y=place.y, depth=place.depth, note=place.text)
        for number, place in enumerate(places_of(response))
    ]  # fmt: skip


def verdict_rows(verdict: Verdict) -> list[Row]:
    """Of a verdict."""
    data = verdict.dataset
    strain, passes = float(data["worst_strain"]), float(data["worst_passes"])
    sentence = verdict.summary().splitlines()[-1].removeprefix("Verdict: ")
    read = row("reading", "Read as", f"{READINGS[verdict.strain]}, {data.attrs['reading']}", group="road",
               note=f"under {under(data)}; the maps show points, whose readings beside edges of the contact are far "
                    "higher")  # fmt: skip
    if not strain > 0:
        return [row("verdict", "Life", "no cracking predicted", group="road", note=sentence), read]
    x, y, depth = (float(data[f"worst_{name}"]) for name in ("x", "y", "depth"))
    at = {"x": x, "y": y, "depth": depth}
    where = f"x {x * 1e3:.1f}, y {y * 1e3:.1f}, {depth * 1e3:g} mm deep"
    return [
        row("extension", "Largest extension", f"{strain * 1e6:.1f} microstrain", group="road", **at),
        read,
        row("place", "Where", where, group="road", **at),
        row("crack", "Crack", verdict.orientation, group="road", note=verdict.summary().splitlines()[4], **at),
        row("passes", "Passes", _counted(passes), group="road", note=f"{verdict.line}. {sentence}", **at),
    ]


def allowed_told(allowed: PassesAllowed) -> dict[str, Any]:
    """Passes by criterion: rows, with "place" and "reading" besides, and sentences on layers without one."""
    return {"rows": [_allowed_row(number, one) for number, one in enumerate(allowed.rows)],
            "said": list(allowed.without)}  # fmt: skip


def _allowed_row(number: int, one: Allowed) -> Row:
    """Of one criterion; readings for which no tests or roads stand are said to be extrapolated."""
    deep = "surface" if one.depth == 0 else f"{one.depth * 1e3:g} mm deep"
    place = ", ".join(part for part in (one.layer, one.place, deep) if part)
    note = ". ".join((str(one.law), *one.warnings))
    if not one.reading > 0:
        return row(f"allowed:{number}", one.name, "no end", group="allowed", place=place, note=note,
                   reading="nothing there does harm")  # fmt: skip
    beyond = ", extrapolated" if one.extrapolated else ""
    return row(f"allowed:{number}", one.name, _counted(one.passes), group="allowed", place=place, note=note,
               reading=f"{one.reads.in_words(one.reading)}{beyond}", x=one.x, y=one.y)  # fmt: skip


def _counted(passes: float) -> str:
    """Passes that a law allows, by number as far as roads bear them."""
    return f"{passes:.3g}" if passes < _COUNTLESS else "over 10¹⁰"


def solver_rows(contact: Any) -> list[Row]:
    """How the contact was solved."""
    stats = contact.stats
    told = []
    if "normal_residual" in stats:
        told.append(row("normal", "Normal contact", f"residual {stats['normal_residual']:.1e}", group="solver",
                         note=f"{stats['normal_iterations']} iterations"))  # fmt: skip
    if "rolling_residual" in stats:
        told.append(row("rolling", "Rolling", f"residual {stats['rolling_residual']:.1e}", group="solver",
                         note=f"{stats['newton_iterations']} Newton steps"))  # fmt: skip
    data = contact.dataset
    size = f"{data.attrs['dx'] * 1e3:g} × {data.attrs['dy'] * 1e3:g} mm"
    return [*told, row("cells", "Cells", f"{data.sizes['x']} × {data.sizes['y']}", group="solver"),
            row("size", "Cell size", size, group="solver")]  # fmt: skip


def row(key: str, label: str, value: str, *, group: str = "contact", **more: Any) -> Row:
    """A row of the verdict."""
    return {"key": key, "label": label, "value": value, "group": group, **more}
