"""Shear that a freely rolling tire puts on a road: ribs with free sides against a layer without grooves.

One rib that is pressed; five ribs that roll, against the layer and against what was published, over load, pressure,
friction and wear; what they do to the surface of a road, cold and hot. The figures and the numbers of the tables of
`docs/notes/ribs_evidence.md`: a minute and a half of one processor, and another the first time, for the
sections of worn ribs.

    python examples/ribs/run.py [folder] [--coarse]
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

import treadload as tl
from treadload.contact import Contact
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, INK, MUTED, headline, open_axes, styled
from treadload.response.loads import GridLoad
from treadload.validation.one_rib import PressedRib, outer_third, pressed
from treadload.validation.ribs import shear_of_ribs

NAME, FRICTION, LOAD, INFLATION = "315/80R22.5", 0.7, 35e3, 820e3
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
STRUCTURE = "6 BBSG3 / 15 GB3 / PF3"
RUBBER, LAYER = tl.Elastic(5.5e6, 0.495), tl.Elastic(5.5e6, 0.47)
RIBS = ("middle", "second", "shoulder")
# Of pins: side and pitch, m.
PIN, PITCH = 9.7e-3, 17e-3
# Largest lateral and longitudinal stress over the largest pressure, as commonly quoted, not checked.
PUBLISHED = {
    "de Beer, Fisher and Jooste (1997), pins": (0.36, 0.14),
    "Illinois contact model": (0.40, None),
}
# The outer third of one rib over its mean pressure, by friction: a second program of the same equations.
SECOND_PROGRAM = {
    15: {0.15: 0.139, 0.3: 0.278, 0.5: 0.396, 0.7: 0.408, 0.9: 0.408},
    10: {0.5: 0.353},
    5: {0.5: 0.278},
}
LOADS = (15.0, 20.0, 27.5, 35.0, 42.5, 50.0)
PRESSURES = (600.0, 700.0, 820.0, 900.0)
FRICTIONS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.9)
DEPTHS = (4.0, 8.0, 12.0, 15.0)
TEMPERATURES = (10.0, 15.0, 20.0, 25.0, 32.0, 40.0)
TREADS = ("half-space", "layer", "ribs")


def tire(tread: str = "ribs", *, pressure: float = INFLATION, worn: float = 0.0) -> tl.Tire:
    """315/80R22.5. tread: "ribs", "layer" or "half-space". pressure: of inflation, Pa. worn: off the tread, m."""
    if tread == "half-space":
        return tl.Tire.from_profile(NAME, inflation_pressure=pressure)
    profile = tl.catalogue.tires[NAME]
    belt = replace(tl.tire.Belt.from_library(NAME), tread=RUBBER if tread == "ribs" else LAYER)
    if worn:
        grooves = tuple(replace(groove, depth=groove.depth - worn) for groove in profile.grooves)
        profile = replace(profile, grooves=grooves, rolling_radius=profile.rolling_radius - worn)
        belt = replace(belt, tread_thickness=belt.tread_thickness - worn, arm=belt.arm - worn)
    return tl.Tire.from_profile(profile, inflation_pressure=pressure, belt=belt, tread=tread)


def amplitudes(contact: Contact) -> list[float]:
    """Shear of the outer less the inner third over pressure, halved, of the middle, second and shoulder rib."""
    ribbed = contact if contact.tire.ribs else replace(contact, tire=tire())
    return shear_of_ribs(ribbed)[2:]


def pin_ratios(contact: Contact) -> tuple[float, float]:
    """Largest lateral and longitudinal stress of pins over their largest pressure, wherever the row of pins lies."""
    load, peaks = GridLoad.from_dataset(contact.dataset), np.zeros(3)
    for offset in PITCH * np.arange(8) / 8:
        seen = tl.footprint.sample_pins(load, pin=PIN, pitch=PITCH, offset=float(offset)).load
        fields = (seen.pressure, seen.traction_y, seen.traction_x)
        peaks = np.maximum(peaks, [np.abs(field).max() for field in fields if field is not None])
    return float(peaks[1] / peaks[0]), float(peaks[2] / peaks[0])


def cell_ratios(contact: Contact) -> tuple[float, float]:
    """Largest lateral and longitudinal shear of a cell over the largest pressure of one."""
    peaks = [float(np.abs(contact.dataset[name]).max()) for name in ("pressure", "traction_y", "traction_x")]
    return peaks[1] / peaks[0], peaks[2] / peaks[0]


def sweeps(spacing: float) -> dict[str, tuple[Sequence[float], Callable[[str, float], Contact]]]:
    """By label of the axis: values, and the contact of a tread at a value."""

    def roll(wheel: tl.Tire, load: float = LOAD, friction: float = FRICTION) -> Contact:
        return tl.solve_contact(wheel, ROAD, tl.Rolling(normal_load=load, friction=friction), spacing=spacing)

    return {
        "load (kN)": (LOADS, lambda tread, load: roll(tire(tread), load * 1e3)),
        "inflation pressure (kPa)": (PRESSURES, lambda tread, p: roll(tire(tread, pressure=p * 1e3))),
        "friction coefficient (–)": (FRICTIONS, lambda tread, friction: roll(tire(tread), friction=friction)),
        "groove depth (mm)": (DEPTHS, lambda tread, depth: roll(tire(tread, worn=(15 - depth) * 1e-3))),
    }


def five_ribs(spacing: float) -> dict[str, Any]:
    """Over every sweep the amplitudes by tread (value, rib), and the ratios of pins (value, 2); printed."""
    curves: dict[str, Any] = {}
    for label, (values, contact_at) in sweeps(spacing).items():
        print(f"\n{label:26s}" + "".join(f"{name:>10s}" for name in (*RIBS, "of layer", "pins q_y", "pins q_x")))
        both = {tread: [contact_at(tread, value) for value in values] for tread in ("ribs", "layer")}
        curve = {tread: np.array([amplitudes(contact) for contact in both[tread]]) for tread in both}
        pins = {f"{tread} pins": np.array([pin_ratios(contact) for contact in both[tread]]) for tread in both}
        curves[label] = {"values": values, **curve, **pins}
        for number, value in enumerate(values):
            shown = (*curve["ribs"][number], curve["layer"][number, 0], *pins["ribs pins"][number])
            print(f"{value:<26g}" + "".join(f"{ratio:10.3f}" for ratio in shown))
    return curves


def strains(contact: Contact, road: tl.Pavement) -> tuple[float, float]:
    """Of the plane of the surface, mean over 10 mm, microstrain: the largest strain, and the largest evaluated.

    `assess` evaluates places with a tensile principal stress; 0 where there is none.
    """
    data = tl.solve_response(contact, road, depths=[0.0], mean_over=10e-3).dataset
    along, across, sheared = (data[f"strain_{name}"].to_numpy() for name in ("xx", "yy", "xy"))
    largest = float((0.5 * (along + across) + np.hypot(0.5 * (along - across), sheared)).max())
    response = tl.solve_response(contact, road, depths=[0.0])
    read = float(tl.assess(response, tl.FatigueLine(120e-6, -0.2), strain="in-plane").dataset.worst_strain)
    return 1e6 * largest, 1e6 * max(0.0, read)


def surfaces(spacing: float) -> dict[str, dict[str, Any]]:
    """Strains by tread and force: of 5.4 GPa (2,), and of the French structure by temperature (n, 2); printed."""
    structure = tl.Pavement.from_catalogue(STRUCTURE)
    roads = [ROAD, *(structure.at_temperature(t) for t in TEMPERATURES)]
    print("\nlargest strain in the plane of the surface (evaluated by `assess`), microstrain")
    print(f"{'':22s}{'5.4 GPa':>14s}" + "".join(f"{t:11.0f} °C" for t in TEMPERATURES))
    rows: dict[str, dict[str, Any]] = {"free": {}, "driving": {}}
    for state, force in (("free", 0.0), ("driving", 10e3)):
        for tread in TREADS:
            wheel = tl.Rolling(normal_load=LOAD, friction=FRICTION, tractive_force=force)
            contact = tl.solve_contact(tire(tread), ROAD, wheel, spacing=spacing)
            row = np.array([strains(contact, road) for road in roads])
            rows[state][tread] = {"half_space": row[0], "structure": row[1:]}
            print(f"{state:8s} {tread:12s} " + "".join(f"{a:7.1f} ({b:4.1f})" for a, b in row))
    return rows


@styled
def draw_one_rib(file: Path) -> dict[float, list[float]]:
    """Pressure and shear of one rib that is pressed, and its outer third over friction, by depth of the groove."""
    figure = new_figure(9.2, 3.9)
    across, over = figure.subplots(1, 2)
    for friction, colour in ((0.7, CASES[0]), (0.3, CASES[1])):
        rib = PressedRib(friction=friction)
        pressure, shear = pressed(rib)
        edges = 1e3 * (np.append(rib.places[:, 0], rib.width) - rib.width / 2)
        across.stairs(1e-3 * pressure, edges, baseline=None, color=colour, lw=1.6, label=f"pressure, μ {friction:g}")
        # The road feels the opposite of the rib.
        across.stairs(
            -1e-3 * shear, edges, baseline=None, color=colour, lw=1.6, ls="--", label=f"shear, μ {friction:g}"
        )
    across.axhline(0, color=MUTED, lw=0.8)
    across.set(xlabel="to the right of the rib's middle (mm)", ylabel="on the road (kPa)", ylim=(-900, 1800))
    across.legend(loc="upper center", ncols=2)
    headline(across, "Pressure and lateral shear", "48.6 mm wide, groove 15 mm, mean pressure 800 kPa")
    thirds = {}
    for (depth, reference), colour in zip(SECOND_PROGRAM.items(), CASES, strict=False):
        thirds[depth] = [outer_third(PressedRib(depth=1e-3 * depth, friction=f)) for f in FRICTIONS]
        over.plot(FRICTIONS, thirds[depth], color=colour, label=f"groove {depth} mm")
        over.plot(list(reference), list(reference.values()), ls="", marker="o", ms=5.5, mfc="none", color=colour)
    over.plot([], [], ls="", marker="o", ms=5.5, mfc="none", color=INK, label="second program")
    over.set(xlabel="friction coefficient (–)", ylabel="outer third / mean pressure (–)", ylim=(0, 0.5))
    over.legend(loc="lower right")
    headline(over, "Shear of the outer third", "plane strain, ν 0.495; circles: other elements, same equations")
    open_axes(across, over)
    save(figure, file)
    return thirds


@styled
def draw_across(layer: Contact, ribs: Contact, file: Path) -> None:
    """Pressure and lateral shear across the middle of the contact, layer and ribs."""
    figure = new_figure(9.2, 3.9)
    axes = figure.subplots(1, 2, sharey=True)
    titles = ("A layer without grooves", "Ribs with free sides")
    for ax, contact, title in zip(axes, (layer, ribs), titles, strict=True):
        line, half = contact.dataset.sel(x=0.0, method="nearest"), 0.5 * float(contact.dataset.attrs["dy"])
        edges = 1e3 * np.append(line.y - half, float(line.y[-1]) + half)
        for name, label, colour in (
            ("pressure", "pressure", INK),
            ("traction_y", "lateral shear on the road, positive to the right", CASES[1]),
        ):
            ax.stairs(1e-3 * line[name].to_numpy(), edges, baseline=None, color=colour, lw=1.4, label=label)
        ax.axhline(0, color=MUTED, lw=0.8)
        ax.set(xlabel="to the right of the tire's middle (mm)")
        headline(ax, title, "35 kN, 820 kPa, μ 0.7, free rolling, under the axle")
        open_axes(ax)
    axes[0].set_ylabel("on the road (kPa)")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    save(figure, file)


@styled
def draw_sweeps(curves: dict[str, Any], file: Path) -> None:
    """Amplitudes of three ribs over load, pressure, friction and groove depth, and of the layer."""
    figure = new_figure(9.2, 6.6)
    panels: list[Axes] = list(figure.subplots(2, 2, sharey=True).flat)
    fixed = ("820 kPa, μ 0.7", "35 kN, μ 0.7", "35 kN, 820 kPa", "35 kN, 820 kPa, μ 0.7; 15 mm is new")
    for ax, (label, curve), note in zip(panels, curves.items(), fixed, strict=True):
        for number, rib in enumerate(RIBS):
            words = f"{rib} rib"
            ax.plot(curve["values"], curve["ribs"][:, number], marker="o", ms=4, color=CASES[number], label=words)
            ax.plot(curve["values"], curve["layer"][:, number], ls="--", lw=1.2, color=CASES[number])
        ax.plot([], [], ls="--", lw=1.2, color=MUTED, label="the same of a layer (ν 0.47)")
        ax.set(xlabel=label, ylim=(-0.02, 0.36))
        ax.axhline(0, color=MUTED, lw=0.8)
        headline(ax, f"Over {label.split(' (')[0]}", note)
        open_axes(ax)
    for ax in panels[::2]:
        ax.set_ylabel("outward shear / pressure (–)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    save(figure, file)


@styled
def draw_published(curves: dict[str, Any], cells: tuple[float, float], file: Path) -> None:
    """Largest stress of pins over their largest pressure, computed and published. cells: the same of single cells."""
    load = curves["load (kN)"]
    new = list(load["values"]).index(35)
    rows = {"layer, 35 kN, 820 kPa, μ 0.7": load["layer pins"][new], "ribs, the same": load["ribs pins"][new]}
    rows["ribs, the same, single cells of 3 mm"] = cells
    for label, curve in curves.items():
        what, unit = label[:-1].split(" (")
        for end in (0, -1):
            value = curve["values"][end]
            if not (what == "groove depth" and end == -1):
                rows[f"ribs, {what} {value:g}{'' if unit == '–' else f' {unit}'}"] = curve["ribs pins"][end]
    rows |= {f"{name} *": value for name, value in PUBLISHED.items()}
    figure = new_figure(9.2, 4.9)
    ax = figure.subplots()
    for place, (name, pair) in enumerate(rows.items()):
        for ratio, marker, colour in zip(pair, ("o", "s"), CASES, strict=False):
            face = "none" if name.endswith("*") else colour
            if ratio is not None:
                ax.plot(ratio, place, marker=marker, ms=7, color=colour, mfc=face, ls="")
    for marker, colour, label in (("o", CASES[0], "lateral"), ("s", CASES[1], "longitudinal")):
        ax.plot([], [], marker=marker, ms=7, color=colour, ls="", label=label)
    ax.axhline(len(rows) - len(PUBLISHED) - 0.5, color=MUTED, lw=0.8)
    ax.set_yticks(range(len(rows)), list(rows))
    ax.invert_yaxis()
    ax.set(xlabel="largest shear / largest pressure (–)", xlim=(0, 0.5))
    ax.legend(loc="upper right")
    words = "computed: square pins of 9.7 mm (filled); * published, as commonly quoted, not checked (open)"
    headline(ax, "Free rolling, computed and published", words)
    open_axes(ax)
    save(figure, file)


@styled
def draw_surface(rows: dict[str, dict[str, Any]], file: Path) -> None:
    """Strain of the surface over temperature, free rolling and driving, by tread: largest, and evaluated."""
    figure = new_figure(9.2, 4.4)
    axes = figure.subplots(1, 2)
    titles = {"free": "Free rolling", "driving": "Driving with 10 kN"}
    for ax, (state, treads) in zip(axes, rows.items(), strict=True):
        for tread, colour, marker in zip(TREADS, (MUTED, CASES[1], CASES[0]), "^so", strict=True):
            values, size = treads[tread]["structure"], 8 if tread == "layer" else 4
            ax.plot(TEMPERATURES, values[:, 0], marker=marker, ms=size, color=colour, label=f"{tread}, largest")
            ax.plot(TEMPERATURES, values[:, 1], ls="--", lw=1.3, color=colour, label=f"{tread}, evaluated")
        ax.axhline(0, color=MUTED, lw=0.8)
        ax.set(xlabel="temperature of the road (°C)", ylabel="strain in the plane (microstrain)")
        headline(ax, titles[state], f"{STRUCTURE}, surface, mean over 10 mm")
        open_axes(ax)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    save(figure, file)


def main(folder: Path, spacing: float = 3e-3) -> dict[str, Any]:
    """Solve, print, draw; returns the numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    thirds = draw_one_rib(folder / "ribs_one.png")
    wheel = tl.Rolling(normal_load=LOAD, friction=FRICTION)
    layer, ribs = (tl.solve_contact(tire(tread), ROAD, wheel, spacing=spacing) for tread in ("layer", "ribs"))
    draw_across(layer, ribs, folder / "ribs_across.png")
    curves = five_ribs(spacing)
    draw_sweeps(curves, folder / "ribs_sweeps.png")
    draw_published(curves, cell_ratios(ribs), folder / "ribs_published.png")
    rows = surfaces(spacing)
    draw_surface(rows, folder / "ribs_surface.png")
    return {"thirds": thirds, "cells": cell_ratios(ribs), "curves": curves, "surface": rows}


if __name__ == "__main__":
    where = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    main(Path(where[0]) if where else Path("ribs"), 6e-3 if "--coarse" in sys.argv else 3e-3)
