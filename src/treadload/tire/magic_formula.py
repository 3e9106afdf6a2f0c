"""A tire as its Magic Formula: forces and moments from the coefficients of a .tir file."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import ClassVar, Literal, cast

import numpy as np
from numpy.typing import ArrayLike

from treadload.describing import Described
from treadload.errors import InputError, positive
from treadload.files import write_whole
from treadload.kernels.arrays import Array
from treadload.kernels.magic_formula import (
    ALIGNING,
    DEFAULTS,
    LATERAL,
    LONGITUDINAL,
    Forces,
    Formula,
    Wheel,
    evaluate,
    words,
)
from treadload.rows import Row, row
from treadload.tire.free_rolling import FreeRolling, free_rolling
from treadload.tire.tir_file import deflection_of, read_tir, remarks_of
from treadload.tire.tir_writing import check_tir_name, tir_text

Version = Literal["5.2", "6.1"]
Signs = Literal["ISO", "SAE", "adapted SAE"]

_SECTIONS = {
    "LONGITUDINAL_COEFFICIENTS": LONGITUDINAL,
    "LATERAL_COEFFICIENTS": LATERAL,
    "ALIGNING_COEFFICIENTS": ALIGNING,
}
# Coefficients that older files of 5.2, or files of 6.1, leave out; all others must be there, so that a file that was
# cut off is seen.
_OPTIONAL = frozenset(
    words(
        "PDX3 PPX1 PPX2 PPX3 PPX4 RBX3 REX1 REX2 PEY5 PKY4 PKY5 PKY6 PKY7 PHY3 PPY1 PPY2 PPY3 PPY4 PPY5 RBY4 "
        "REY1 REY2 RHY2 QBZ4 QBZ10 QDZ10 QDZ11 PPZ1 PPZ2"
    )
)
# Coefficients that 5.2 does not have: a file with others than zero there means something else by it.
_NEWER = words(
    "PEY5 PKY5 PKY6 PKY7 RBX3 RBY4 QDZ10 QDZ11 QSX4 QSX5 QSX6 QSX7 QSX8 QSX9 QSX10 QSX11 QSX12 QSX13 QSX14 QSY5 QSY6"
)
# What PAC2002 calls the influence of pressure that 6.1 has under another name.
_ALIASES = {"QPZ1": "PPZ1", "QPZ2": "PPZ2", "QPX1": "PPMX1", "LFZ0": "LFZO"}
_PRESSURE_TERMS = [name for name in DEFAULTS if name.startswith("PP")] + ["QSY8"]
# Slip, and slip angle in rad, over which slopes are taken.
_STEP = 1e-5
_AFRESH = "the file may be cut off: copy or export it again, or write what is meant to be zero as 0"


@dataclass(frozen=True)
class TireForces:
    """Forces of the road on a tire and their moments about the contact point, in the signs of treadload.

    tractive_force: N, along travel. lateral_force: N, to the right. aligning_moment: N m, about z (down).
    overturning_moment: N m, about x (ahead); rolling_resistance_moment: N m, positive when it resists; both None
    where the file has no coefficients of them.

    >>> forces = tl.tire.TireForces(tractive_force=3e3, lateral_force=4e3, aligning_moment=50.0)
    >>> f"{(forces.tractive_force**2 + forces.lateral_force**2) ** 0.5 / 10e3:.1f} of a load of 10 kN"
    '0.5 of a load of 10 kN'
    """

    tractive_force: Array
    lateral_force: Array
    aligning_moment: Array
    overturning_moment: Array | None = None
    rolling_resistance_moment: Array | None = None


@dataclass(frozen=True, eq=False, repr=False)
class MagicFormula(Described):
    """A tire described by the coefficients of the Magic Formula, version 5.2 or 6.1.

    version: "5.2" or "6.1". signs: of the coefficients, "ISO", "SAE" or "adapted SAE"; `forces` takes and returns
    numbers in the signs of treadload whatever they are. sections: numbers by section and key of the file, in SI.
    side: of the vehicle where it was measured, "left", "right" or "" if unknown. name: free text. deflection:
    vertical and load, m and N, (2, n); None without a table. notes: of the reader. is_mirrored: True for the same
    tire on the opposite side. Source: Pacejka (2012), Tire and Vehicle Dynamics, 4.3; see `kernels.magic_formula`.

    >>> tl.tire.MagicFormula.from_file("invented_6_1.tir").signs
    'ISO'
    """

    title: ClassVar[str] = "Magic Formula"

    version: Version
    signs: Signs
    sections: Mapping[str, Mapping[str, float]]
    side: str = ""
    name: str = ""
    deflection: Array | None = None
    notes: tuple[str, ...] = ()
    is_mirrored: bool = False
    combines_by_ellipse: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        self._check_terms()
        for section, names in _SECTIONS.items():
            entries = self.sections.get(section)
            if not entries:
                raise InputError(f"{self._words} has no section [{section}]; {_AFRESH}")
            optional = _OPTIONAL if self.version == "6.1" else _OPTIONAL - {"PHY3"}
            absent = [name for name in names if name not in entries and name not in optional]
            if absent:
                raise InputError(
                    f"{self._words}: [{section}] lacks {', '.join(absent[:6])}"
                    f"{f' and {len(absent) - 6} more' if len(absent) > 6 else ''}; {_AFRESH}"
                )
        for key in ("FNOMIN", "UNLOADED_RADIUS"):
            if key not in self._flat:
                raise InputError(f"{self._words} has no {key}; {_AFRESH}")
            positive(key, self._flat[key], "", "it is the nominal load, or the radius of the unloaded tire")
        slope = self.coefficients["PKY1"] * self.coefficients["LKY"]
        if (slope > 0) != (self.signs == "adapted SAE"):
            wanted = "positive" if self.signs == "adapted SAE" else "negative"
            raise InputError(
                f"{self._words}: with {self.signs} signs PKY1 must be {wanted}, got {slope:g}: the tire would push "
                f'to the side that it slips to; give signs="{"ISO" if slope < 0 else "adapted SAE"}" if so'
            )

    def _check_terms(self) -> None:
        """Refuse coefficients of another version. Raises InputError."""
        strange = [name for name in _NEWER if self._flat.get(name, 0) != 0] if self.version == "5.2" else []
        if self._flat.get("LMUV", 0) != 0:
            strange.append("LMUV")
        if strange:
            raise InputError(
                f"{self._words} is of version {self.version}, whose equations have no {', '.join(strange)}; set them "
                "to 0, or export the tire as 6.1 (FITTYP = 61)"
            )
        pressed = [name for name in _PRESSURE_TERMS if self._flat.get(name, 0) != 0]
        if pressed and self.nominal_pressure is None:
            raise InputError(
                f"{self._words} has {', '.join(pressed[:4])} for the inflation pressure and no nominal one; write "
                "NOMPRES (IP_NOM of PAC2002)"
            )

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], *, signs: str | None = None) -> MagicFormula:
        """Read a .tir file of version 5.2 (also PAC2002 of Adams) or 6.1.

        signs: "ISO", "SAE" or "adapted SAE"; left out, what a comment of the file states, such as "ISO" or "W-axis".
        Lengths, forces, times and pressures are converted by the file's [UNITS]; angles must be in radians.
        Raises InputError for a file that is cut off, of another version, in degrees, or does not state its signs.
        """
        text = read_tir(path)
        version = cast("Version", text.version)
        numbers = text.numbers()
        side = (text.text("MODEL", "TYRESIDE") or "").casefold()
        return cls(
            version,
            cast("Signs", text.signs(signs)),
            MappingProxyType({section: MappingProxyType(values) for section, values in numbers.items()}),
            side if side in ("left", "right") else "",
            Path(path).stem,
            deflection_of(text),
            (*text.notes, *remarks_of(text)),
            combines_by_ellipse=(text.text("MODEL", "FE_METHOD") or "").casefold() == "yes",
        )

    def to_file(self, path: str | os.PathLike[str]) -> Path:
        """Write a .tir file of version 6.1 in SI units, whole or not at all; its signs and notes are comments.

        Reading it gives the same forces. Raises InputError for version 5.2, whose terms 6.1 evaluates otherwise, for
        a mirrored tire, which the format cannot state, and for a name that does not end in .tir.
        """
        check_tir_name(path)
        if not self.is_newer or self.is_mirrored:
            what = "is of version 5.2: keep its file" if not self.is_newer else "is mirrored: write the tire itself"
            raise InputError(
                f"cannot write {os.fspath(path)}: {self._words} {what}; written are tires of version 6.1"
            )
        text = tir_text(
            self.sections, signs=self.signs, side=self.side, comments=self.notes, deflection=self.deflection
        )
        return write_whole(path, text)

    @property
    def _words(self) -> str:
        return self.name or "the tire"

    @cached_property
    def _flat(self) -> Mapping[str, float]:
        numbers = {key: value for entries in self.sections.values() for key, value in entries.items()}
        return numbers | {
            name: numbers[key] for key, name in _ALIASES.items() if key in numbers and name not in numbers
        }

    @cached_property
    def coefficients(self) -> Mapping[str, float]:
        """All that the formula reads, with its defaults where the file leaves a coefficient out."""
        return {name: self._flat.get(name, default) for name, default in DEFAULTS.items()}

    @property
    def nominal_load(self) -> float:
        """Load F_z0 to which the coefficients refer, N."""
        return self._flat["FNOMIN"]

    @property
    def unloaded_radius(self) -> float:
        """Radius of the unloaded tire, m."""
        return self._flat["UNLOADED_RADIUS"]

    @property
    def nominal_pressure(self) -> float | None:
        """Inflation pressure to which the coefficients refer, Pa; None where the file states none."""
        pressure = self._flat.get("NOMPRES", self._flat.get("IP_NOM", 0.0))
        return pressure if pressure > 0 else None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Remarks of the reader."""
        return self.notes

    @property
    def heading(self) -> str:
        """Name, version and signs."""
        return f"{self.name or 'a tire'}, version {self.version}, {self.signs} signs"

    def cites(self) -> tuple[str, ...]:
        """Where its equations were published: keys of `treadload.citations.CITATIONS`."""
        return methods(self.version)

    def mirrored(self) -> MagicFormula:
        """The same tire on the opposite side of the vehicle: ply steer and conicity change their side."""
        opposite = {"left": "right", "right": "left"}.get(self.side, "")
        return replace(self, side=opposite, is_mirrored=not self.is_mirrored)

    def forces(
        self,
        normal_load: ArrayLike,
        *,
        slip: ArrayLike = 0.0,
        slip_angle: ArrayLike = 0.0,
        inclination: ArrayLike = 0.0,
        inflation_pressure: ArrayLike | None = None,
        speed: ArrayLike | None = None,
    ) -> TireForces:
        """Forces and moments of rolling forward; all arguments broadcast against each other.

        normal_load: N, > 0. slip: κ = (ωR_e - V)/V, positive when driving; of a freely rolling wheel zero, while
        `creepage_x` = (V - ωR)/V refers to the unloaded radius. slip_angle: rad, within ±π/2, tan = `creepage_y`:
        positive when the wheel moves to the right. inclination: rad, positive when the top leans to the right.
        inflation_pressure: Pa; left out, the nominal one. speed: m/s, of rolling resistance alone; left out, that of
        the file. Nothing is cut at the ranges that a file states. Raises InputError for numbers outside these bounds.
        """
        load, angle = _numbers("normal_load", normal_load), _numbers("slip_angle", slip_angle)
        if not (load > 0).all():
            raise InputError(f"normal_load must be > 0 N, got {load.min():g}; a truck's wheel carries 20e3 to 60e3")
        if not (np.abs(angle) < math.pi / 2).all():
            raise InputError(f"slip_angle must lie within ±1.5708 rad, got {angle.flat[np.abs(angle).argmax()]:g}")
        along = _numbers("slip", slip)
        # Velocities to the right are negative where y points to the left.
        across, lean = (-1.0 if self.signs != "SAE" else 1.0), _numbers("inclination", inclination)
        if self.is_mirrored:
            angle, lean = -angle, -lean
        wheel = Wheel(
            *np.broadcast_arrays(
                load, along, across * angle, lean, self._pressure(inflation_pressure), self._speed(speed)
            )
        )
        if self.combines_by_ellipse and bool(np.any((wheel.slip != 0) & (wheel.slip_angle != 0))):
            raise InputError(
                f"{self._words} combines slip along and across by the friction ellipse of Adams (FE_METHOD = 'YES'), "
                "not by the Magic Formula; give slip or slip_angle alone, or set FE_METHOD = 'NO' in the file"
            )
        out = evaluate(
            self.coefficients,
            wheel,
            nominal_load=self.nominal_load,
            radius=self.unloaded_radius,
            is_newer=self.is_newer,
        )
        return self._turned(out)

    @property
    def is_newer(self) -> bool:
        """True for version 6.1."""
        return self.version == "6.1"

    def _turned(self, out: Forces) -> TireForces:
        """Forces in the signs of treadload."""
        side = -1.0 if self.is_mirrored else 1.0
        # y and z of ISO point to the left and up.
        turn = side * (-1.0 if self.signs == "ISO" else 1.0)
        return TireForces(
            out.longitudinal,
            turn * out.lateral,
            turn * out.aligning,
            side * out.overturning if self.sections.get("OVERTURNING_COEFFICIENTS") else None,
            out.resisting if self.sections.get("ROLLING_COEFFICIENTS") else None,
        )

    def _pressure(self, pressure: ArrayLike | None) -> Array:
        """Inflation pressure over the nominal one."""
        if pressure is None:
            return np.ones(())
        if self.nominal_pressure is None:
            raise InputError(
                f"{self._words} states no nominal inflation pressure; leave inflation_pressure out, or write NOMPRES"
            )
        values = _numbers("inflation_pressure", pressure)
        if not (values > 0).all():
            raise InputError(f"inflation_pressure must be > 0 Pa, got {values.min():g}; 8 bar is 800e3")
        return values / self.nominal_pressure

    def _speed(self, speed: ArrayLike | None) -> Array:
        """Speed over that of the file."""
        if speed is None:
            return np.ones(())
        reference = self._flat.get("LONGVL", 0.0)
        if not reference > 0:
            raise InputError(
                f"{self._words} states no speed LONGVL to which speeds refer; leave speed out, or write it"
            )
        return _numbers("speed", speed) / reference

    def slopes(self, normal_load: float) -> tuple[float, float, float]:
        """Slopes at free rolling under a load: dF_x/dκ, N; -dF_y/dα, N/rad; dM_z/dα, N m/rad.

        The first two are positive; over the load they are what a tire card states. Raises InputError as `forces`.
        """
        steps = np.array([-_STEP, _STEP])
        along = self.forces(normal_load, slip=steps).tractive_force
        turned = self.forces(normal_load, slip_angle=steps)

        def slope(values: Array) -> float:
            return float(values[1] - values[0]) / (2 * _STEP)

        return slope(along), slope(-turned.lateral_force), slope(turned.aligning_moment)

    def friction(self, normal_load: float) -> tuple[float, float]:
        """Peak friction μ along and across under a load, upright and at the nominal pressure."""
        state = [np.array(number) for number in (normal_load, 0.0, 0.0, 0.0, 1.0, 1.0)]
        formula = Formula(self.coefficients, Wheel(*state), self.nominal_load, self.unloaded_radius, self.is_newer)
        return abs(float(formula.along.friction)), abs(float(formula.across.friction))

    def free_rolling(
        self, normal_load: ArrayLike, *, inflation_pressure: ArrayLike | None = None, speed: ArrayLike | None = None
    ) -> FreeRolling:
        """Deflection, loaded and effective radius, and relaxation lengths of the upright tire rolling freely.

        Arguments as in `forces`; speed: m/s, by which the tire grows. The deflection is that of VERTICAL_STIFFNESS
        and Q_FZ2, not of a table. Raises InputError as `forces`, and for a file without VERTICAL_STIFFNESS.
        """
        load = _numbers("normal_load", normal_load)
        if not (load > 0).all():
            raise InputError(f"normal_load must be > 0 N, got {load.min():g}; a truck's wheel carries 20e3 to 60e3")
        none = np.zeros(())
        states = np.broadcast_arrays(load, none, none, none, self._pressure(inflation_pressure), self._speed(speed))
        formula = Formula(self.coefficients, Wheel(*states), self.nominal_load, self.unloaded_radius, self.is_newer)
        return free_rolling(self._flat, formula, self._words)

    def rows(self) -> tuple[Row, ...]:
        """Nominal state, friction and slopes at the nominal load."""
        load = self.nominal_load
        along, across = self.friction(load)
        slip, cornering, aligning = self.slopes(load)
        values = {
            "nominal_load": load,
            "unloaded_radius": self.unloaded_radius,
            "nominal_pressure": self.nominal_pressure,
            "vertical_stiffness": self._flat.get("VERTICAL_STIFFNESS"),
            "peak_friction_x": along,
            "peak_friction_y": across,
            "longitudinal_stiffness_over_load": slip / load,
            "cornering_stiffness_over_load": cornering / load,
            "pneumatic_trail": aligning / cornering,
        }
        return tuple(row(key, value) for key, value in values.items() if value is not None)


def methods(version: str) -> tuple[str, ...]:
    """Where the equations of a version were published: keys of `treadload.citations.CITATIONS`."""
    return ("magic formula", "inflation pressure of tires") if version == "6.1" else ("magic formula",)


def _numbers(name: str, values: ArrayLike) -> Array:
    try:
        array: Array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be numbers, got {values!r}") from None
    if not np.isfinite(array).all():
        raise InputError(f"{name} must be finite, got {array[~np.isfinite(array)].flat[0]}")
    return array
