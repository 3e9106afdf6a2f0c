"""The figures of a report with their captions, as pictures inside the page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from treadload.damage.verdict import under
from treadload.plots import (
    ContactPlots,
    ResponsePlots,
    VerdictPlots,
    compare_pressure,
    compare_strain,
    deflection_bowl,
    dissipated_energy,
    fatigue_line,
)
from treadload.plots.kit.plan import at_depth
from treadload.plots.response import NAMES, Strain
from treadload.reporting.pictures import Picture, picture
from treadload.reporting.reading import ReportCase
from treadload.response.fields import layer_in_words

_STROKES = (
    "Strokes lie along the largest extension; where a principal stress is tensile a crack opens across them. A "
    "stroke shortens to a point where the extension turns out of the page. White: no extension."
)


def case_figures(case: ReportCase, *, alone: bool) -> list[tuple[str, list[Picture]]]:
    """The figures of one case under headings. alone: the only case, so that no comparison shows its fatigue line."""
    sections = [
        ("Contact", list(_contact(case))),
        ("Strain in the road", list(_strain(case))),
        ("Deflection and energy", list(_layered(case))),
        ("Fatigue and cracks", list(_verdict(case, alone))),
    ]
    return [(heading, pictures) for heading, pictures in sections if pictures]


def comparison_figures(cases: list[ReportCase]) -> list[Picture]:
    """Figures that hold several cases on one scale; none for a single case."""
    if len(cases) < 2:
        return []
    pictures: list[Picture] = []
    contacts, labels = _with(cases, "contact", "pressure")
    if len(contacts) > 1:
        pictures += picture(
            "Contact pressure, side by side",
            "One colour scale for all cases, seen from above; rings mark the largest pressure.",
            lambda: compare_pressure(contacts, labels),
            wide=True,
        )
    for strain, word in (("principal", "principal_strain_1"), ("in-plane", "in_plane_strain_1")):
        responses, labels = _with(cases, "response", word)
        depths = _common_depths(responses)
        if len(responses) > 1 and depths:
            pictures += _strain_comparison(
                responses, labels, depths[0], "principal" if strain == "principal" else "in-plane"
            )
    verdicts, labels = _with(cases, "damage", "worst_strain")
    if len(verdicts) > 1:
        pictures += picture(
            "Fatigue line, all cases",
            "Each case stands where its worst strain meets its line; below it, the passes that the line allows.",
            lambda: fatigue_line(verdicts, labels),
            wide=True,
        )
    return pictures


def _strain_comparison(responses: list[xr.Dataset], labels: list[str], depth: float, strain: Strain) -> list[Picture]:
    return picture(
        f"Largest extension strain, {NAMES[strain]}, side by side",
        f"Drawn: {_DRAWN[strain]}, {_deep(depth)}, on one colour scale; rings mark the peaks. {_WHAT[strain]}",
        lambda: compare_strain(responses, labels, depth=depth, strain=strain),
        wide=True,
    )


def _contact(case: ReportCase) -> Iterator[Picture]:
    data = case.group("contact")
    if data is None:
        return
    plots = ContactPlots(data)
    yield from picture(
        "Contact pressure",
        "Seen from above, at true scale. The ring marks the largest pressure; pressure rises at the edges of ribs "
        "and blocks, and the more so the finer the grid.",
        plots.pressure,
    )
    # A footprint that was recorded knows no tread and no friction.
    if "initial_gap" in data:
        yield from picture(
            "Tread before loading",
            "Distance of the tread from the road at first contact; the line is the border of the contact under load.",
            plots.height_map,
        )
    if "state" in data:
        yield from picture(
            "Shear, stick and slip",
            "Left: size of the shear in space. Right: the same from above; hatched cells slip, there the shear has "
            "reached friction times pressure. Arrows: shear exerted by the tire on the road.",
            plots.shear,
            wide=True,
        )
    yield from picture(
        "Sections through the largest pressure",
        "Where the shear lies on the dashed line, friction times pressure, the tire slips.",
        plots.profile,
        wide=True,
    )


def _strain(case: ReportCase) -> Iterator[Picture]:
    data, contact = case.group("response"), case.group("contact")
    if case.wheels_placed:
        # The contact lies at the origin; the stress at the surface shows the outlines of all wheels.
        contact = None
    if data is not None:
        plots = ResponsePlots(data)
        for depth in np.atleast_1d(data["depth"].to_numpy()).tolist():
            # Without the tire's shear on it the plane's strain adds little: below the surface one map is enough.
            side = layer_in_words(at_depth(data, depth))
            deep = f"{_deep(depth)}, {side}" if side else _deep(depth)
            for strain in _KINDS if depth == 0 else _KINDS[:1]:
                holds = _HOLDS if depth == 0 and strain == "principal" else ""
                yield from picture(
                    f"Largest extension strain {deep}, {NAMES[strain]}",
                    f"Drawn: {_DRAWN[strain]}{holds}. {_WHAT[strain]}",
                    lambda depth=depth, strain=strain: plots.strain_directions(depth, strain, contact=contact),  # type: ignore[misc]
                )
    for name, words in (("slice_along", "along travel"), ("slice_across", "across travel")):
        section = case.group(name)
        if section is not None:
            yield from picture(
                f"Vertical section {words}",
                f"Drawn: the three-dimensional strain through the worst point {case.depth_in_words}; black bars: the "
                "tire touches. Strokes show the part of the direction that lies in the section.",
                ResponsePlots(section).depth_slice,
            )
    yield from _against_depth(case)


def _against_depth(case: ReportCase) -> Iterator[Picture]:
    data, across = case.group("response"), case.group("slice_across")
    damage = case.group("damage")
    epsilon = float(damage.attrs["epsilon_6"]) if damage is not None and "epsilon_6" in damage.attrs else None
    if len(case.layers) > 1 and across is not None:
        # The section has the stress of the surface, but perhaps not that under the load's centre.
        load = data if data is not None and 0.0 in data["depth"] else across
        yield from picture(
            "Strain against depth",
            "Extension along travel, across it and the largest in space, under places across the tire; strain jumps "
            "where a layer ends.",
            lambda: ResponsePlots(across).strain_profiles(contact=load, epsilon_6=epsilon),
            wide=True,
        )
        return
    deep = case.group("slice_along")
    deep = data if deep is None else deep
    if deep is not None and deep.sizes.get("depth", 1) > 2:
        yield from picture(
            "Strain against depth",
            "Both strains under the worst point of the surface; dashed: the largest anywhere in the section.",
            lambda: ResponsePlots(deep).profile(epsilon_6=epsilon),
        )


def _layered(case: ReportCase) -> Iterator[Picture]:
    bowl, across = case.group("bowl"), case.group("slice_across")
    if bowl is not None:
        yield from picture(
            "Deflection bowl",
            "Deflection of the surface along travel under the wheel. A viscoelastic road is still deflected behind "
            "the wheel: its lowest point lags."
            if case.speed is not None
            else "Deflection of the surface along travel under the wheel.",
            lambda: deflection_bowl([bowl], [case.label], y=float(bowl["y"][0]), load=bowl.attrs.get("load_x")),
            wide=True,
        )
    if across is not None and "dissipated_energy" in across:
        yield from picture(
            "Energy dissipated in one passage",
            "What the wheel leaves in the viscoelastic layers as heat and damage, per unit volume, in a section "
            "across travel; hatched: not computed.",
            lambda: dissipated_energy(across),
            wide=True,
        )


def _verdict(case: ReportCase, alone: bool) -> Iterator[Picture]:
    data = case.group("damage")
    if data is None:
        return
    plots = VerdictPlots(data)
    kind = "in-plane" if data.attrs.get("strain") == "in-plane" else "principal"
    if alone:
        yield from picture(
            "Fatigue line",
            f"The case stands where {_DRAWN[kind]} at its worst meets the line; below it, the passes allowed.",
            plots.fatigue_line,
            wide=True,
        )
    yield from picture(
        "Allowable passes",
        f"From {_DRAWN[kind]}, under {under(data)}. The darkest places bear the fewest passes; white ones a million "
        "times more, or have no extension.",
        plots.passes,
    )
    yield from picture(
        "Cracks to expect",
        f"Traces on the surface of cracks across the largest extension, read from {_DRAWN[kind]}: longitudinal along "
        "travel, transverse across it, oblique between; planes nearer to the horizontal than 45° as points, where "
        "the road splits and no crack runs down. Drawn where a principal stress is tensile and the strain is "
        "significant; the ring marks the largest such strain.",
        plots.cracks,
    )


_KINDS: tuple[Strain, ...] = ("principal", "in-plane")
_HOLDS = ", which at the surface includes the shear of the tire itself"
_DRAWN = {"principal": "the three-dimensional strain", "in-plane": "the strain in the horizontal plane"}
_WHAT = {
    "principal": _STROKES,
    "in-plane": "Strokes lie along the extension; where a principal stress is tensile, vertical cracks open across "
    "them. White: no extension in the plane.",
}


def _with(cases: list[ReportCase], group: str, variable: str) -> tuple[list[xr.Dataset], list[str]]:
    """Datasets of the cases that have a variable in a group, and their labels."""
    labelled = [(case.group(group), case.label) for case in cases]
    kept = [(data, label) for data, label in labelled if data is not None and variable in data]
    return [data for data, _ in kept], [label for _, label in kept]


def _common_depths(responses: list[xr.Dataset]) -> list[float]:
    """Depths, m, that all responses have, the shallowest first."""
    if not responses:
        return []
    shared = {round(float(d), 9) for d in np.atleast_1d(responses[0]["depth"].to_numpy())}
    for data in responses[1:]:
        shared &= {round(float(d), 9) for d in np.atleast_1d(data["depth"].to_numpy())}
    return sorted(shared)


def _deep(depth: float) -> str:
    return "at the surface" if depth == 0 else f"{depth * 1e3:g} mm deep"
