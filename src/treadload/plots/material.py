"""Figures of viscoelastic materials: Black, Cole-Cole, master curve, shift factors.

Models are lines, tests are points.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.kernels.arrays import Array, ComplexArray
from treadload.materials import FrequencySweep, MasterCurve, RelaxationTest, Viscoelastic
from treadload.materials.temperature import ShiftLaw
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.style import CASES, INK, MUTED, RULE, figure_of, headline, plain, styled

Shown = Viscoelastic | FrequencySweep | RelaxationTest | MasterCurve
Curve = TypeVar("Curve")
"""What can be drawn: a model, a test at one temperature, or isotherms shifted to one."""

_MPA = 1e-6
_LINE = 241
# Without data a model is drawn where its modulus lies within these shares of its way from slow to fast, in log.
_WAY = (0.02, 0.98)
_SEARCH = np.logspace(-20, 20, 401)


@styled
def black_diagram(
    curves: Shown | Sequence[Shown],
    labels: Sequence[str] | None = None,
    *,
    frequencies: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Norm of the complex modulus against its phase: no frequency in it, so that one curve holds all temperatures.

    curves: models as lines, sweeps and master curves of sweeps as points. labels: a name each.
    frequencies: (lowest, highest), Hz, over which models are drawn; those of the data, or where the modulus changes,
    if left out. ax: axes to draw into. Returns the figure. Raises InputError.

    >>> mix = tl.materials.Prony(20e9, ((0.6, 0.1), (0.39, 10.0)), 0.35)
    >>> figure = tl.plots.black_diagram(mix, ["mix"], frequencies=(0.01, 100.0))
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('phase angle (°)', '|E*| (MPa)')
    """
    figure, ax = figure_and_axes(ax, 6.6, 4.7)
    for curve in _in_frequency(curves, labels, frequencies):
        curve.draw(ax, np.degrees(np.angle(curve.modulus)), np.abs(curve.modulus) * _MPA)
    ax.set_yscale("log")
    ax.set_xlim(left=0)
    ax.set_xlabel("phase angle (°)")
    ax.set_ylabel("|E*| (MPa)")
    headline(ax, "Black diagram", "norm of the complex modulus against its phase")
    return _finish(figure, ax)


@styled
def cole_cole(
    curves: Shown | Sequence[Shown],
    labels: Sequence[str] | None = None,
    *,
    frequencies: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Loss against storage modulus, both linear: what a model does to the stiff side.

    The arguments are those of black_diagram. Returns the figure. Raises InputError.

    >>> mix = tl.materials.Prony(20e9, ((0.6, 0.1), (0.39, 10.0)), 0.35)
    >>> storage = tl.plots.cole_cole(mix, ["mix"], frequencies=(1e-6, 1e6)).axes[0].lines[0].get_xdata()
    >>> f"from {storage.min():.1f} to {storage.max():.0f} GPa"
    'from 0.2 to 20 GPa'
    """
    figure, ax = figure_and_axes(ax, 6.6, 4.2)
    for curve in _in_frequency(curves, labels, frequencies):
        curve.draw(ax, curve.modulus.real * _MPA * 1e-3, curve.modulus.imag * _MPA * 1e-3)
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("storage modulus E′ (GPa)")
    ax.set_ylabel("loss modulus E″ (GPa)")
    headline(ax, "Cole-Cole diagram", "loss against storage modulus")
    return _finish(figure, ax)


@styled
def master_curve(
    curves: Shown | Sequence[Shown],
    labels: Sequence[str] | None = None,
    *,
    frequencies: tuple[float, float] | None = None,
) -> Figure:
    """Modulus, and its phase, over reduced frequency; of relaxation tests the modulus over reduced time.

    curves, labels, frequencies: as for black_diagram; all at one temperature. A MasterCurve shows its isotherms in
    the colour of their temperature, and in grey where they were measured.
    Returns the figure. Raises InputError, also for sweeps and relaxation tests in one figure.

    >>> rubber = tl.materials.Prony(3e6, ((0.5, 0.1),), 0.49)
    >>> figure = tl.plots.master_curve(rubber, frequencies=(0.01, 100.0))
    >>> [f"{modulus:.1f} MPa" for modulus in figure.axes[0].lines[0].get_ydata()[[0, -1]]]
    ['1.5 MPa', '3.0 MPa']
    """
    curves_drawn: list[Shown] = _listed(curves)
    if any(isinstance(_data(curve), RelaxationTest) for curve in curves_drawn):
        return _relaxation(curves_drawn, labels)
    figure = new_figure(7.6, 6.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    for curve in _in_frequency(curves_drawn, labels, frequencies):
        for ax, value in ((upper, _norm), (lower, _phase)):
            if curve.unshifted is not None:
                ax.plot(curve.unshifted[0], value(curve.unshifted[1]), ".", ms=3, color=RULE, zorder=1)
            curve.draw(ax, curve.frequency, value(curve.modulus))
    upper.set_xscale("log")
    upper.set_yscale("log")
    upper.set_ylabel("|E*| (MPa)")
    lower.set_ylabel("phase angle (°)")
    lower.set_ylim(bottom=0)
    lower.set_xlabel(_reduced("frequency", "$f\\,a_T$ (Hz)", curves_drawn))
    headline(upper, "Master curve", _reference(curves_drawn))
    lower.grid(True)
    lower.spines[["top", "right"]].set_visible(False)
    return _finish(figure, upper)


@styled
def shift_factors(
    curves: MasterCurve | ShiftLaw | Sequence[MasterCurve | ShiftLaw],
    labels: Sequence[str] | None = None,
    *,
    temperatures: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Shift factors over temperature: of master curves as points, of laws as lines.

    curves: master curves and laws. labels: a name each. temperatures: (lowest, highest), °C, over which laws are
    drawn, as far as they hold; those of the data if left out. ax: axes to draw into. Returns the figure.
    Raises InputError.

    >>> figure = tl.plots.shift_factors(tl.materials.WLF(19.0, 150.0, 15.0), temperatures=(0.0, 40.0))
    >>> [f"{decades:.1f}" for decades in figure.axes[0].lines[0].get_ydata()[[0, -1]]]  # log10 aT at 0 and 40 °C
    ['2.1', '-2.7']
    """
    listed: list[MasterCurve | ShiftLaw] = _listed(curves)
    names = _names(listed, labels)
    measured = [t for curve in listed if isinstance(curve, MasterCurve) for t in curve.temperatures]
    if temperatures is None and not measured:
        raise InputError("without measured shift factors give temperatures, °C, over which to draw the laws")
    low, high = temperatures or (min(measured), max(measured))
    figure, ax = figure_and_axes(ax, 6.6, 4.4)
    for number, (curve, name) in enumerate(zip(listed, names, strict=True)):
        colour = CASES[number % len(CASES)]
        if isinstance(curve, MasterCurve):
            ax.plot(curve.temperatures, curve.log_factors, "o", ms=4, color=colour, label=name, zorder=3)
        else:
            t = np.linspace(low, high, _LINE)
            ax.plot(t, [_log_factor(curve, here) for here in t], color=colour, label=name)
    ax.axhline(0, color=MUTED, lw=0.7)
    ax.set_xlabel("temperature (°C)")
    ax.set_ylabel("$\\log_{10} a_T$")
    headline(ax, "Shift factors", "decades by which times are longer than at the reference temperature")
    return _finish(figure, ax)


@dataclass(frozen=True)
class _Curve:
    """One curve of a diagram in frequency. points: True for a test; temperatures: of the points of isotherms, °C."""

    frequency: Array
    modulus: ComplexArray
    label: str
    colour: str
    points: bool
    temperatures: Array | None = None
    unshifted: tuple[Array, ComplexArray] | None = None

    def draw(self, ax: Axes, x: Array, y: Array) -> None:
        if not self.points:
            ax.plot(x, y, color=self.colour, label=self.label, zorder=2)
        elif self.temperatures is None:
            ax.plot(x, y, "o", ms=3.5, color=self.colour, mfc="none", mew=0.9, label=self.label, zorder=3)
        else:
            _isotherms(ax, x, y, self.temperatures, self.label)


def _in_frequency(
    curves: Shown | Sequence[Shown], labels: Sequence[str] | None, frequencies: tuple[float, float] | None
) -> Iterator[_Curve]:
    drawable = _drawable(curves)
    names = _names(drawable, labels)
    if any(isinstance(_data(curve), RelaxationTest) for curve in drawable):
        raise InputError("a relaxation test has no complex modulus; draw it with master_curve, or fit a model to it")
    if frequencies is not None and not 0 < frequencies[0] < frequencies[1] < math.inf:
        raise InputError(f"frequencies must be (lowest, highest), Hz, > 0, got {frequencies}")
    sweeps = [data.omega for data in map(_data, drawable) if isinstance(data, FrequencySweep)]
    ends = (min(w[0] for w in sweeps), max(w[-1] for w in sweeps)) if sweeps else None
    inks = iter(CASES * len(drawable))
    for curve, name in zip(drawable, names, strict=True):
        data = _data(curve)
        if isinstance(data, FrequencySweep):
            temperatures, unshifted = None, None
            if isinstance(curve, MasterCurve):
                temperatures, unshifted = _of_isotherms(curve)
            colour = INK if temperatures is not None else next(inks)
            yield _Curve(data.omega / math.tau, data.modulus, name, colour, True, temperatures, unshifted)
        elif isinstance(curve, Viscoelastic):
            low, high = (math.tau * f for f in frequencies) if frequencies else ends or _range(curve)
            omega = np.geomspace(low, high, _LINE)
            yield _Curve(omega / math.tau, curve.complex_modulus(omega), name, next(inks), False)


def _relaxation(curves: Sequence[Shown], labels: Sequence[str] | None) -> Figure:
    tests = [data for data in map(_data, curves) if isinstance(data, RelaxationTest)]
    if any(isinstance(_data(curve), FrequencySweep) for curve in curves):
        raise InputError("sweeps of frequency and relaxation tests have no common axis; draw them in two figures")
    figure, ax = figure_and_axes(None, 7.6, 4.4)
    first, last = min(t.time[0] for t in tests), max(t.time[-1] for t in tests)
    inks = iter(CASES * len(curves))
    for curve, name in zip(curves, _names(curves, labels), strict=True):
        if isinstance(curve, MasterCurve):
            parts = [part for part in curve.isotherms if isinstance(part, RelaxationTest)]
            for part in parts:
                ax.plot(part.time, part.modulus * _MPA, ".", ms=3, color=RULE, zorder=1)
            time = np.concatenate([part.time / 10**log for part, log in zip(parts, curve.log_factors, strict=True)])
            modulus = np.concatenate([part.modulus for part in parts])
            _isotherms(ax, time, modulus * _MPA, _temperatures(curve), name)
        elif isinstance(curve, RelaxationTest):
            ax.plot(curve.time, curve.modulus * _MPA, "o", ms=3.5, color=next(inks), mfc="none", mew=0.9, label=name)
        else:
            relaxation: Any = getattr(curve, "relaxation_modulus", None)
            if relaxation is None:
                raise InputError(f"{curve} does not give its relaxation modulus; use as_prony on it first")
            time = np.geomspace(first, last, _LINE)
            ax.plot(time, relaxation(time) * _MPA, color=next(inks), label=name)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel(_reduced("time", "$t/a_T$ (s)", curves))
    ax.set_ylabel("relaxation modulus (MPa)")
    headline(ax, "Master curve", _reference(curves))
    return _finish(figure, ax)


def _of_isotherms(curve: MasterCurve) -> tuple[Array, tuple[Array, ComplexArray]]:
    """Temperature of every point of the master curve's data, in their order, and the points as measured, over Hz."""
    parts = [part for part in curve.isotherms if isinstance(part, FrequencySweep)]
    reduced = np.concatenate([part.omega * 10**log for part, log in zip(parts, curve.log_factors, strict=True)])
    order = np.argsort(reduced, kind="stable")
    unshifted = np.concatenate([part.omega for part in parts]) / math.tau, np.concatenate([p.modulus for p in parts])
    return _temperatures(curve)[order], unshifted


def _temperatures(curve: MasterCurve) -> Array:
    sizes = [part.modulus.size for part in curve.isotherms]
    return np.repeat(np.asarray(curve.temperatures), sizes)


def _isotherms(ax: Axes, x: Array, y: Array, temperatures: Array, label: str) -> None:
    """Points in the colour of their temperature, with a bar of temperatures beside the figure's first axes."""
    norm = Normalize(float(temperatures.min()), float(temperatures.max()))
    ax.scatter(x, y, s=13, c=temperatures, cmap=_warmth(), norm=norm, linewidths=0, label=label, zorder=3)
    figure = figure_of(ax)
    if not any(axes.get_label() == "<colorbar>" for axes in figure.axes):
        beside = [axes for axes in figure.axes if axes.get_subplotspec() is not None]
        bar = figure.colorbar(ScalarMappable(norm, _warmth()), ax=beside or [ax], pad=0.02, aspect=30)
        bar.set_label("temperature of the test (°C)")
        bar.outline.set_visible(False)


def _warmth() -> Colormap:
    """From cold to warm, without the yellow that vanishes on paper."""
    return ListedColormap(mpl.colormaps["plasma"](np.linspace(0.0, 0.86, 256)), name="treadload_warmth")


def _range(material: Viscoelastic) -> tuple[float, float]:
    """Angular frequencies over which most of the change of a modulus takes place, rad/s."""
    height = np.log(np.abs(material.complex_modulus(_SEARCH)))
    way = (height - height.min()) / max(float(np.ptp(height)), 1e-12)
    inside = np.flatnonzero((way >= _WAY[0]) & (way <= _WAY[1]))
    if inside.size < 2:
        return 1e-3, 1e3
    return float(_SEARCH[inside[0]]), float(_SEARCH[inside[-1]])


def _log_factor(law: ShiftLaw, temperature: float) -> float:
    """log₁₀ aT, NaN where the law does not hold."""
    try:
        return float(np.log10(law.factor(temperature)))
    except InputError:
        return math.nan


def _norm(modulus: ComplexArray) -> Array:
    return np.abs(modulus) * _MPA


def _phase(modulus: ComplexArray) -> Array:
    return np.asarray(np.degrees(np.angle(modulus)))


def _data(curve: object) -> object:
    """What was measured, of a master curve or a test."""
    return curve.data if isinstance(curve, MasterCurve) else curve


def _reference(curves: Sequence[Shown]) -> str:
    at = {curve.reference for curve in curves if isinstance(curve, MasterCurve)}
    if len(at) > 1:
        temperatures = " and ".join(f"{t:g}" for t in sorted(at))
        raise InputError(f"master curves at {temperatures} °C share no axis; shift them to one reference")
    return f"reduced to {at.pop():g} °C; grey: where it was measured" if at else "each curve at one temperature"


def _reduced(name: str, symbol: str, curves: Sequence[Shown]) -> str:
    plain_symbol = {"frequency": "frequency (Hz)", "time": "time (s)"}[name]
    return f"reduced {name} {symbol}" if any(isinstance(c, MasterCurve) for c in curves) else plain_symbol


def _listed(curves: Curve | Sequence[Curve]) -> list[Curve]:
    return list(curves) if isinstance(curves, Sequence) else [curves]


def _drawable(curves: Shown | Sequence[Shown]) -> list[Shown]:
    listed: list[Shown] = _listed(curves)
    for curve in listed:
        # An empty figure would say nothing of it.
        if not isinstance(curve, Viscoelastic | FrequencySweep | RelaxationTest | MasterCurve):
            remedy = "take it at a temperature: .at(15)" if hasattr(curve, "at") else "draw a viscoelastic material"
            raise InputError(f"{curve} has no modulus over frequency by itself; {remedy}")
    return listed


def _names(curves: Sequence[object], labels: Sequence[str] | None) -> list[str]:
    if not curves or (labels is not None and len(labels) != len(curves)):
        raise InputError(f"give a label for each curve: got {len(labels or ())} labels for {len(curves)} curves")
    return [plain(label) for label in labels] if labels is not None else [""] * len(curves)


def _finish(figure: Figure, ax: Axes) -> Figure:
    ax.grid(True)
    ax.spines[["top", "right"]].set_visible(False)
    if any(text for text in ax.get_legend_handles_labels()[1]):
        ax.legend()
    return figure
