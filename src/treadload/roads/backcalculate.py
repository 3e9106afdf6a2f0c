"""Moduli of a road's layers from deflection basins."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Collection, Mapping

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials import TemperatureDependent
from treadload.pavement import Pavement
from treadload.roads.basins import Basins, Measured
from treadload.roads.by_drop import by_drop
from treadload.roads.drop_histories import DropHistories
from treadload.roads.moving_basins import MovingBasins
from treadload.roads.parts import Progress, solve_in_parts
from treadload.roads.solution import Backcalculation, solution
from treadload.roads.station_loads import StationLoads
from treadload.roads.uncertainty import SensorError, Stated
from treadload.roads.unknowns import STIFF_LAYER, Unknowns, layer_names, modulus_at, pose


def backcalculate(
    basins: Basins | MovingBasins | DropHistories,
    structure: Pavement,
    *,
    fixed: Collection[str] = (),
    bounds: Mapping[str, tuple[float | str, float | str]] | None = None,
    priors: Mapping[str, float | str | tuple[float | str, float | str]] | None = None,
    stiff_layer: float | str | tuple[float | str, float | str] | None = STIFF_LAYER,
    error: Stated | None = None,
    reference_temperature: float = 15.0,
    jobs: int = 1,
    state: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Backcalculation:
    """Moduli of a road's layers from deflection basins: weighted least squares on the layered solver.

    basins: drops of a falling weight, `Basins`, or slopes ahead of rolling wheels, `MovingBasins`; `read_basins`
    reads both; a thickness that they give for a layer is taken in place of the structure's. structure: layers with
    their Poisson's ratios, thicknesses and bonds. Its moduli are those of the fixed layers and the centres of priors;
    no start is needed. A layer of a mix is corrected for temperature. Under rolling wheels and over time layers may
    be viscoelastic: E*(ω) keeps its shape, and |E*| at 10 Hz and the basin's temperature is sought. fixed: names of
    layers whose modulus is known. bounds: by name, (low, high), Pa or texts; 1 MPa to 100 GPa if left out. priors: by
    name, a coefficient of variation about the structure's modulus, or (modulus, it): lognormal. stiff_layer: depth of
    the top of a rigid layer below the surface, m or text, 10 m if left out; two depths to seek it between them; None
    for the half-space of the structure. A rigid base of the structure stays. error: of the sensors, one standard
    deviation: "2 %", "2 µm" ("10 µm/m" of slopes), or both; left out, 2 % and 0.5 µm (10 µm/m) weigh the sensors and
    the misfit of each basin determines the size. reference_temperature: of mixes, °C. jobs: processes. state: folder
    that keeps what is solved, so that a run goes on where it stopped. progress: called with (done, total, what).

    A stress-dependent layer of a structure under a falling weight keeps its law, and the size of it is sought, stated
    as the modulus at the nominal stress (θ = 150 kPa, q = 75 kPa): the drops of a station, section and thicknesses
    are fitted together, each with the moduli that its load settles. Loads of two heights or more distinguish a law
    from a linear layer. A falling weight is static, wheels in steady motion: inertia is not modelled.
    Returns moduli with error bars, correlation, misfit, and in words what is flagged, refused and undecided. Raises
    InputError for a question without an answer. Source: as `kernels.layers.settlement` and `kernels.layers.tracks`,
    states of stress as `response.settle`; Marquardt (1963) for the search.

    >>> asphalt = tl.Layer(tl.Elastic(5e9, 0.35), 0.15, name="asphalt")
    >>> road = tl.Pavement([asphalt, tl.Layer(tl.Elastic(80e6, 0.4), name="soil")])
    >>> drop = tl.roads.Basins([[587e-6, 453e-6, 306e-6, 148e-6, 92e-6]], [0, 0.3, 0.6, 1.2, 1.8], [49.5e3], 0.15)
    >>> result = tl.backcalculate(drop, road, stiff_layer=None)
    >>> f"soil: {result.dataset.fitted_modulus.sel(layer_name='soil').item() / 1e6:.0f} MPa"
    'soil: 80 MPa'
    """
    began = time.perf_counter()
    if not isinstance(basins, Basins | MovingBasins | DropHistories):
        raise InputError(
            f"basins must be Basins, MovingBasins or DropHistories, got {type(basins).__name__}; read_basins reads "
            "a file"
        )
    moving = isinstance(basins, MovingBasins)
    if isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1:
        raise InputError(f"jobs must be a whole number of processes from 1, got {jobs!r}")
    unknowns = pose(
        structure,
        fixed=fixed,
        bounds=bounds,
        priors=priors,
        stiff_layer=stiff_layer,
        memory=not isinstance(basins, Basins),
    )
    names = layer_names(unknowns.road)
    stray = next((name for name in basins.thickness if name not in names[:-1]), None)
    if stray is not None:
        raise InputError(
            f"the basins give a thickness of {stray!r}, and the structure has {', '.join(names[:-1]) or 'no layers'} "
            "above its last layer; name its layers so"
        )
    together = StationLoads.of(basins) if isinstance(basins, Basins) and structure.depends_on_stress else None
    measured: Measured = basins if together is None else together
    _check_count(measured, unknowns)
    sensors = SensorError.of(error, slopes=moving)
    fits, before = solve_in_parts(measured, unknowns, sensors, jobs=jobs, state=state, progress=progress)
    if together is not None:
        fits = by_drop(fits, together)
    factors = temperature_factors(structure, basins, reference_temperature)
    stats = {"basins": len(basins), "from_state": before, "seconds": time.perf_counter() - began}
    return solution(basins, unknowns, sensors, fits, factors, reference_temperature, stats)


def temperature_factors(structure: Pavement, basins: Measured, reference: float) -> Array:
    """Modulus at a reference temperature, °C, over that at each drop's (n, L); 1 of layers without temperature.

    NaN where the temperature is not known or outside the data of the mix.
    """
    factors = np.ones((len(basins), len(structure.layers)))
    for number, layer in enumerate(structure.layers):
        mix = layer.material
        if not isinstance(mix, TemperatureDependent):
            continue
        base = _modulus(mix, reference)
        factors[:, number] = math.nan
        if basins.temperature is None:
            continue
        for drop, temperature in enumerate(basins.temperature):
            if math.isfinite(temperature):
                try:
                    factors[drop, number] = base / _modulus(mix, float(temperature))
                except InputError:
                    continue
    return factors


def _modulus(mix: TemperatureDependent, temperature: float) -> float:
    return modulus_at(mix.at(temperature))


def _check_count(basins: Measured, unknowns: Unknowns) -> None:
    """Refuse more unknowns than any basin has sensors."""
    most = int(np.isfinite(basins.readings).sum(axis=1).max(initial=0))
    bare = [name for name, prior in zip(unknowns.names, unknowns.priors, strict=False) if prior is None]
    bare += [unknowns.names[-1]] * unknowns.seeks_depth
    if len(bare) > most > 0 and not basins.thickness:
        raise InputError(
            f"{most} sensors cannot decide {len(bare)} numbers ({', '.join(bare)}); fix a layer, give priors, or "
            "seek "
            f"at most {most}"
        )
