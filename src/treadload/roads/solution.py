"""The result of a backcalculation: moduli with their error bars, and what is flagged, refused and undecided."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.scatter import Scatter
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.identifiability import LEVEL, quantile
from treadload.kernels.arrays import Array, IntArray
from treadload.materials import Elastic, StressDependent, TemperatureDependent
from treadload.pavement import Pavement
from treadload.roads.basins import Basins, Measured
from treadload.roads.drop_histories import DropHistories
from treadload.roads.laws import LAWS, law_factors, laws_as_json
from treadload.roads.moving_basins import MovingBasins
from treadload.roads.scatter import scatter_of
from treadload.roads.solve import FITTED, FLAGGED, REFUSED, Fits
from treadload.roads.summary import depth_row, deviation_in_words, load_classes, reason_rows, undecided_rows
from treadload.roads.uncertainty import SensorError
from treadload.roads.unknowns import Unknowns, layer_names, modulus_of, poisson_of
from treadload.rows import Row, row
from treadload.variables import modulus_in_words

# Moduli that change by more than this part from the least load to the largest are named.
_CHANGES = 0.15


@dataclass(frozen=True, eq=False)
class Backcalculation(BaseResult, group="backcalculation"):
    """Moduli of a road's layers at every drop, with their error bars.

    dataset: over `basin`, `layer_name`, `unknown` and `sensor`; see `treadload.variables`. structure: that was asked.
    stats: how it was solved. warnings: sentences for the user.

    >>> layers = [tl.Layer(tl.Elastic(5e9, 0.35), 0.15, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), None, "soil")]
    >>> deflections = [905e-6, 740e-6, 560e-6, 415e-6, 255e-6]
    >>> basins = tl.roads.Basins([deflections], [0.0, 0.3, 0.6, 0.9, 1.5], [50e3], 0.15)
    >>> result = tl.backcalculate(basins, tl.Pavement(layers), stiff_layer=None)
    >>> "asphalt of {:.1f} to {:.1f} GPa".format(*(modulus / 1e9 for modulus in result.interval(0, "asphalt")))
    'asphalt of 5.3 to 7.9 GPa'
    """

    title: ClassVar[str] = "Backcalculated layer moduli"
    subject: ClassVar[str] = "Moduli of a road from measured deflections"
    holds: ClassVar[Holds] = Holds(
        {
            "fitted_modulus modulus_low modulus_high modulus_deviation modulus_at_reference": "basin layer_name",
            "layer_thickness": "basin layer_name",
            "layer_poisson bond_stiffness": "layer_name",
            "unknown_at_bound": "basin unknown",
            "unknown_correlation": "basin unknown other",
            "basin_misfit error_scatter basin_freedom basin_status plate_load": "basin",
            "drop_position asphalt_temperature": "basin",
            "stiff_depth stiff_depth_deviation": "basin",
            "sensor": "sensor",
        },
        maybe={
            "measured_deflection fitted_deflection measured_slope fitted_slope": "basin sensor",
            "basin_speed": "basin",
            "law_factor": "basin layer_name",
            "measured_history fitted_history": "basin sensor history_time",
        },
        with_it={"measured_deflection": "fitted_deflection", "measured_slope": "fitted_slope",
            "measured_history": "fitted_history"},
        labels={
            "station": "basin", "section": "basin", "reason": "basin", "undecided": "basin",
            "layer_name": "layer_name",
            "unknown": "unknown", "other": "other",
        },
        numbers="errors_given reference_temperature",
        maybe_numbers="plate_radius",
        texts="plate sensor_error source",
        json={LAWS: dict},
    )  # fmt: skip

    dataset: xr.Dataset
    structure: Pavement
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def drop(self, drop: int | str) -> int:
        """Number of a drop, from 0: itself, or the first drop of a station. Raises InputError."""
        count = self.dataset.sizes["basin"]
        if isinstance(drop, int) and not isinstance(drop, bool):
            if -count <= drop < count:
                return drop % count
            raise InputError(f"drop must lie between 0 and {count - 1}, got {drop}")
        stations = [str(name) for name in self.dataset["station"].to_numpy()]
        if drop not in stations:
            raise InputError(f"there is no station {drop!r}; {nearest(str(drop), dict.fromkeys(stations))}")
        return stations.index(str(drop))

    def interval(self, drop: int | str, layer: str, level: float = LEVEL) -> tuple[float, float]:
        """Between what the modulus of a layer lies with a probability, Pa: lognormal, NaN where it is not decided.

        Normal where the errors were given, else Student's with the degrees of freedom left. Raises InputError.
        """
        if not 0 < level < 1:
            raise InputError(f"level must lie in (0, 1), got {level:g}; {LEVEL:g} is the default")
        names = [str(name) for name in self.dataset["layer_name"].to_numpy()]
        if layer not in names:
            raise InputError(f"there is no layer {layer!r}; {nearest(layer, names)}")
        data = self.dataset.isel(basin=self.drop(drop), layer_name=names.index(layer))
        freedom = float(data["basin_freedom"])
        # Without a reading to spare the errors are those that weigh the sensors.
        stated = self._stated(float(data["error_scatter"])) or not freedom > 0
        # Both ends move away from the fit as those of a normal, or of Student, do.
        part = quantile(level, freedom, stated=stated) / quantile(LEVEL, freedom, stated=stated)
        middle = float(data["fitted_modulus"])
        low, high = (middle * (float(data[f"modulus_{end}"]) / middle) ** part for end in ("low", "high"))
        return low, high

    def road(self, drop: int | str) -> Pavement:
        """The road at a drop: its fitted moduli, thicknesses, and the stiff layer; elastic, a viscoelastic layer with
        its modulus at 10 Hz, a stress-dependent one with its law and the fitted factor. Raises InputError if refused.
        """
        number = self.drop(drop)
        data = self.dataset.isel(basin=number)
        if int(data["basin_status"]) == REFUSED:
            raise InputError(f"station {data['station'].item()} was refused: {data['reason'].item()}")
        layers = []
        thickness, moduli = data["layer_thickness"].to_numpy(), data["fitted_modulus"].to_numpy()
        for layer, name, deep, modulus in zip(
            self.structure.layers, data["layer_name"].to_numpy(), thickness, moduli, strict=True
        ):
            if deep > 0:
                # Of a viscoelastic layer, the elastic one of its modulus at the reference frequency.
                material: Elastic | StressDependent = Elastic(float(modulus), poisson_of(layer))
                if isinstance(layer.material, StressDependent):
                    factor = float(modulus) / replace(layer.material, factor=1.0).nominal.modulus
                    material = replace(layer.material, factor=factor)
                size = None if math.isinf(deep) else float(deep)
                layers.append(replace(layer, material=material, thickness=size, name=str(name)))
        return Pavement(layers, rigid_base=layers[-1].thickness is not None)

    def scatter(self, station: int | str) -> Scatter:
        """How the fitted moduli of a station scatter, with their correlation: for `life.life_reliability`.

        Raises InputError for a refused station and a modulus that the basin leaves undecided.
        """
        number = self.drop(station)
        self.road(number)
        return scatter_of(self.dataset.isel(basin=number))

    def _stated(self, scatter: float) -> bool:
        # A scatter of exactly 1 is that of errors that count as stated.
        return bool(self.dataset.attrs["errors_given"]) or scatter == 1.0

    @property
    def heading(self) -> str:
        """How many basins, and of what."""
        data = self.dataset
        return f"{data.sizes['basin']} basins of {data.sizes['sensor']} sensors, {data.sizes['unknown']} unknowns"

    def rows(self) -> tuple[Row, ...]:
        """How many were fitted, moduli by load, their error bars, the misfit, what is flagged, refused, undecided."""
        data = self.dataset
        status = data["basin_status"].to_numpy()
        counts = {name: int((status == code).sum()) for name, code in _STATUS.items()}
        rows = [row("basin_status", ", ".join(f"{count} {name}" for name, count in counts.items()))]
        good = status != REFUSED
        if good.any():
            if "law_factor" in data:
                rows += self._rows_at(None, np.flatnonzero(good))
            else:
                for load, drops in load_classes(data["plate_load"].to_numpy(), good):
                    rows += self._rows_at(load, drops)
            misfit = data["basin_misfit"].to_numpy()[good]
            rows.append(row("basin_misfit", float(np.median(misfit)), note=f"largest {100 * misfit.max():.2g} %"))
        rows.append(row("sensor_error", str(data.attrs["sensor_error"])))
        rows.append(depth_row(data, good))
        rows += reason_rows(data, status == FLAGGED, "flagged")
        rows += reason_rows(data, status == REFUSED, "refused")
        rows += undecided_rows(data)
        if self.stats:
            rows.append(row("solved", "{basins} basins in {seconds:.1f} s".format(**self.stats)))
        return tuple(rows)

    def _rows_at(self, load: float | None, drops: IntArray | Array) -> list[Row]:
        """Moduli of drops under a load, N; None where the drops of a station share them."""
        rows = []
        for number, name in enumerate(map(str, self.dataset["layer_name"].to_numpy())):
            at = self.dataset.isel(basin=drops, layer_name=number)
            moduli = at["fitted_modulus"].to_numpy()
            deviations = at["modulus_deviation"].to_numpy()
            if not np.isfinite(moduli).any():
                continue
            low, middle, high = np.nanquantile(moduli, [0.25, 0.5, 0.75])
            notes = []
            if np.isfinite(deviations).any():
                notes.append(f"{deviation_in_words(float(np.nanmedian(deviations)))} (one standard deviation)")
            if len(drops) > 1:
                notes.append(f"half of {len(drops)} from {modulus_in_words(low)} to {modulus_in_words(high)}")
            label = f"modulus of {name}" + ("" if load is None else f" at {load / 1e3:.3g} kN")
            if load is None and np.isfinite(at["law_factor"].to_numpy()).any():
                label += " at θ = 150 kPa, q = 75 kPa"
                notes.insert(0, f"{float(np.nanmedian(at['law_factor'].to_numpy())):.3g} times its law")
            rows.append(row("fitted_modulus", middle, label=label, note=", ".join(notes)))
        return rows


_STATUS = {"fitted": FITTED, "flagged": FLAGGED, "refused": REFUSED}


def solution(
    basins: Basins | MovingBasins | DropHistories,
    unknowns: Unknowns,
    error: SensorError,
    fits: Fits,
    factors: Array,
    reference: float,
    stats: Mapping[str, float],
) -> Backcalculation:
    """The result of fits. factors: of the moduli to the reference temperature (n, L)."""
    road, names = unknowns.road, layer_names(unknowns.road)
    count, size = len(basins), len(names)
    good = fits.status != REFUSED
    moduli, deviation, low, high = np.full((4, count, size), math.nan)
    for number in range(size):
        if number in unknowns.moduli:
            place = unknowns.moduli.index(number)
            moduli[:, number], deviation[:, number] = np.exp(fits.x[:, place]), fits.deviation[:, place]
            with np.errstate(over="ignore"):
                low[:, number], high[:, number] = np.exp(fits.low[:, place]), np.exp(fits.high[:, place])
        else:
            moduli[good, number] = modulus_of(road.layers[number])
    thickness = _thickness(basins, unknowns, names, fits)
    moduli[~(thickness > 0)] = math.nan
    depth = thickness.sum(axis=1)
    depth_deviation = fits.deviation[:, -1] * depth if unknowns.seeks_depth else np.full(count, math.nan)
    nothing = np.full(count, math.nan)
    position = getattr(basins, "position", None)
    over = ("basin", "layer_name")
    dataset = variables.dataset(
        {
            "fitted_modulus": (over, moduli),
            "modulus_low": (over, low),
            "modulus_high": (over, high),
            "modulus_deviation": (over, deviation),
            "modulus_at_reference": (over, moduli * factors),
            **({"law_factor": (over, law_factors(road, moduli))} if road.depends_on_stress else {}),
            "layer_thickness": (over, thickness),
            "layer_poisson": (("layer_name",), [poisson_of(layer) for layer in road.layers]),
            "bond_stiffness": (("layer_name",), [layer.bond.stiffness for layer in road.layers]),
            "unknown_at_bound": (("basin", "unknown"), fits.at_bound),
            "unknown_correlation": (("basin", "unknown", "other"), fits.correlation),
            **_readings(basins, fits),
            "basin_misfit": (("basin",), fits.misfit),
            "error_scatter": (("basin",), fits.scatter),
            "basin_freedom": (("basin",), fits.freedom),
            "basin_status": (("basin",), fits.status),
            "plate_load": (("basin",), basins.load),
            "drop_position": (("basin",), nothing if position is None else position),
            "asphalt_temperature": (("basin",), nothing if basins.temperature is None else basins.temperature),
            "stiff_depth": (("basin",), np.where(np.isfinite(depth), depth, math.nan)),
            "stiff_depth_deviation": (("basin",), depth_deviation),
        },
        {
            "station": ("basin", list(basins.station)),
            "section": ("basin", list(getattr(basins, "section", ())) or [""] * count),
            "reason": ("basin", [str(text) for text in fits.reason]),
            "undecided": ("basin", [str(text) for text in fits.undecided]),
            "layer_name": list(names),
            "unknown": list(unknowns.names),
            "other": list(unknowns.names),
            "sensor": basins.offsets,
            **({"history_time": basins.time[basins.fitted_times]} if isinstance(basins, DropHistories) else {}),
        },
        **_loading(basins),
        sensor_error=f"{error}, as given" if error.stated else f"{error} by default; their size from each misfit",
        errors_given=int(error.stated),
        reference_temperature=reference,
        source=basins.source,
        **({LAWS: laws_as_json(road)} if road.depends_on_stress else {}),
    )
    return Backcalculation(dataset, road, dict(stats), _warnings(basins, unknowns, dataset))


def _readings(basins: Basins | MovingBasins | DropHistories, fits: Fits) -> dict[str, tuple[tuple[str, ...], Array]]:
    over: tuple[str, ...] = ("basin", "sensor")
    if isinstance(basins, MovingBasins):
        return {
            "measured_slope": (over, basins.slope),
            "fitted_slope": (over, fits.deflection),
            "basin_speed": (("basin",), basins.speed),
        }
    if isinstance(basins, DropHistories):
        shape = len(basins), len(basins.offsets), len(basins.fitted_times)
        over = ("basin", "sensor", "history_time")
        return {
            "measured_history": (over, basins.readings.reshape(shape)),
            "fitted_history": (over, fits.deflection.reshape(shape)),
        }
    return {"measured_deflection": (over, basins.deflection), "fitted_deflection": (over, fits.deflection)}


def _loading(basins: Basins | MovingBasins | DropHistories) -> dict[str, float | str]:
    if isinstance(basins, MovingBasins):
        return {"plate": "wheels"}
    return {"plate_radius": basins.plate_radius, "plate": basins.plate}


def _thickness(basins: Measured, unknowns: Unknowns, names: tuple[str, ...], fits: Fits) -> Array:
    from treadload.roads.model import thicknesses

    table = thicknesses(basins, unknowns, names)
    if unknowns.seeks_depth:
        table[:, -1] = np.exp(fits.x[:, -1]) - table[:, :-1].sum(axis=1)
    return table


def _warnings(basins: Basins | MovingBasins | DropHistories, unknowns: Unknowns, data: xr.Dataset) -> tuple[str, ...]:
    texts = list(basins.warnings)
    status = data["basin_status"].to_numpy()
    good = status != REFUSED
    if not good.any():
        return (*texts, "no basin could be fitted: see the reasons of the drops")
    classes = load_classes(data["plate_load"].to_numpy(), good)
    if len(classes) > 1 and not unknowns.road.depends_on_stress:
        (least, first), (most, last) = classes[0], classes[-1]
        changes = []
        for number in unknowns.moduli:
            moduli = data["fitted_modulus"].to_numpy()[:, number]
            ratio = float(np.nanmedian(moduli[last]) / np.nanmedian(moduli[first]))
            if abs(ratio - 1) > _CHANGES:
                changes.append(f"{data['layer_name'].to_numpy()[number]} by {100 * (ratio - 1):+.0f} %")
        if changes:
            texts.append(
                f"moduli change with the load, from {least / 1e3:.3g} to {most / 1e3:.3g} kN in the median: "
                f"{', '.join(changes)}; one set of linear moduli does not fit all loads"
            )
    waits = any(isinstance(layer.material, TemperatureDependent) for layer in unknowns.road.layers)
    missing = int(np.isnan(data["asphalt_temperature"].to_numpy()[good]).sum())
    if waits and missing:
        texts.append(f"{missing} drops have no asphalt temperature: their moduli are not corrected for it")
    return tuple(texts)
