"""Criteria of cracking that the field asks for, as fields from one response."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from treadload import variables
from treadload.damage.cracks import HasDataset, gridded
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array

_COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
STRESS = tuple(f"stress_{c}" for c in _COMPONENTS)
STRAIN = tuple(f"strain_{c}" for c in _COMPONENTS)
_DIMS = ("depth", "y", "x")
# Onset of damage of asphalt in Mazars' law: 50 to 100 microstrain, recalled.
MAZARS_ONSET = 100e-6
# Largest depth of the shear under the edge of a tire, m.
NEAR_SURFACE = 0.05


@dataclass(frozen=True)
class CriterionField:
    """A field that tells where a road suffers.

    needs: variables of the response. of: stress (6, ...), strain (6, ...), Pa and 1 → field. source: who asks for it.
    """

    needs: tuple[str, ...]
    of: Callable[[Array, Array], Array]
    source: str


CRITERIA: Mapping[str, CriterionField] = {
    "extension_strain": CriterionField(
        STRAIN, lambda _, strain: tensors.principal(strain)[0][0], "largest extension, as in the paper of this method"
    ),
    "mazars_strain": CriterionField(
        STRAIN, lambda _, strain: tensors.mazars(tensors.principal(strain)[0]), "Mazars (1986), Eng. Fract. Mech. 25"
    ),
    "von_mises_strain": CriterionField(
        STRAIN,
        lambda _, strain: tensors.von_mises(strain),
        "Sousa; the strain of a four-point beam test stands for (1 + ν) times itself",
    ),
    "octahedral_shear_stress": CriterionField(
        STRESS, lambda stress, _: tensors.octahedral_shear(stress), "Lytton, with mean_stress"
    ),
    "mean_stress": CriterionField(
        STRESS, lambda stress, _: tensors.mean(stress), "Lytton, with octahedral_shear_stress"
    ),
    "distortion_energy": CriterionField(STRESS + STRAIN, tensors.distortion_energy, "Kunst"),
    "vertical_shear_strain": CriterionField(STRAIN, lambda _, strain: tensors.vertical_shear(strain), "Yoo"),
    "horizontal_tension": CriterionField(
        STRESS, lambda stress, _: tensors.in_plane_principal(stress)[0], "Tamagny at the surface; Roque's input"
    ),
}
"""Criteria by the name of their variable; von Mises strain, octahedral shear and the energies are never negative."""

_ENERGY = "dissipated_energy"
NAMES = ("mazars_onset_ratio", _ENERGY, *CRITERIA)


def compute_criteria(
    response: HasDataset, names: Sequence[str] | None = None, *, mazars_onset: float = MAZARS_ONSET
) -> xr.Dataset:
    """Criteria of cracking as fields.

    response: with stress and strain over (depth, y, x). names: of `NAMES`; left out, all those whose fields the
    response has. mazars_onset: equivalent strain at which damage begins, > 0, recalled, for "mazars_onset_ratio".
    Returns a dataset of one variable each over (depth, y, x): strains, Pa, J/m³; "dissipated_energy" over (depth, y)
    is that of one passage and belongs to responses of moving wheels on viscoelastic roads.
    Raises InputError for an unknown name, and for a criterion whose fields the response lacks.
    """
    if not 0 < mazars_onset < 0.01:
        raise InputError(f"mazars_onset must be a plain strain in (0, 0.01), got {mazars_onset}; 100e-6 is usual")
    data = gridded(response)
    chosen = [name for name in NAMES if not _missing(data, name)] if names is None else list(names)
    for name in chosen:
        if name not in NAMES:
            raise InputError(f"unknown criterion {name!r}; known are {', '.join(sorted(NAMES))}")
        if missing := _missing(data, name):
            remedy = (
                "solve a moving wheel on a viscoelastic road"
                if name == _ENERGY
                else "give a response as solve_response returns it"
            )
            raise InputError(f"the criterion {name} needs {', '.join(missing)}, which the response lacks; {remedy}")
    both = [_stacked(data, STRESS), _stacked(data, STRAIN)]
    fields: dict[str, tuple[tuple[str, ...], Array]] = {}
    for name in chosen:
        if name == _ENERGY:
            continue
        if name == "mazars_onset_ratio":
            fields[name] = (_DIMS, CRITERIA["mazars_strain"].of(*both) / mazars_onset)
        else:
            fields[name] = (_DIMS, CRITERIA[name].of(*both))
    coordinates = {dim: data[dim].to_numpy() for dim in _DIMS}
    found = variables.dataset(fields, coordinates, mazars_onset=mazars_onset)
    return found.assign({_ENERGY: data[_ENERGY]}) if _ENERGY in chosen else found


def peak(criteria: xr.Dataset, name: str, *, deepest: float | None = None) -> dict[str, float]:
    """Largest value of a criterion and its place: {"value": ..., "depth": ..., "y": ..., "x": ...}, m.

    deepest: m; depths below it do not count: `NEAR_SURFACE` for the shear strain at the edge of a tire.
    Raises InputError where the criterion or all of its depths are missing.
    """
    if name not in criteria:
        raise InputError(f"the criteria hold {', '.join(map(str, criteria.data_vars))}, got {name!r}")
    values = criteria[name]
    if deepest is not None:
        values = values.where(values["depth"] <= deepest, drop=True)
    if not values.size or bool(values.isnull().all()):
        raise InputError(f"{name} has no value at depths up to {deepest} m; solve the response there")
    at = np.unravel_index(int(np.nanargmax(values.to_numpy())), values.shape)
    place = {str(dim): float(values[dim][int(number)]) for dim, number in zip(values.dims, at, strict=True)}
    return {"value": float(values.to_numpy()[at]), **place}


def tension_behind(response: HasDataset) -> xr.Dataset:
    """Largest horizontal tension of the surface behind the load, over y: what opens cracks behind a rolling wheel.

    Behind are the points of a row that come after the last one under pressure, which is read from
    stress_zz = -pressure at the surface; rows that the load misses count behind the load's rear as a whole.
    response: with depth 0, and x that reach behind the load. Returns tension_behind, Pa, and tension_behind_x, m.
    An elastic road shows some too; what viscoelasticity adds is the difference to the road's elastic limits.
    Raises InputError without the surface, a load on it, or points behind it.
    Source: the mechanism is Tamagny's, as cited by the paper of this method; the definition is this package's.
    """
    data = gridded(response)
    if not (data["depth"] == 0).any():
        raise InputError("the tension behind the load is one of the surface; solve the response with depth 0")
    surface = data.sel(depth=[0.0])
    stress = np.stack([field(surface, name) for name in STRESS])[:, 0]
    x = data["x"].to_numpy()
    order = np.argsort(x)
    stress, x = stress[..., order], x[order]
    # Round-off of a free surface beside the pressure.
    loaded = stress[2] < -1e-6 * np.abs(stress[2]).max()
    if not loaded.any():
        raise InputError("no pressure stands on the surface of this response; take x and y that meet the load")
    rear = np.where(loaded.any(axis=1), np.argmax(loaded, axis=1), np.argmax(loaded.any(axis=0)))
    if not rear.all():
        raise InputError(f"the load reaches the first x of the response, {x[0]:g} m; let x reach behind it")
    tension = tensors.in_plane_principal(stress)[0]
    tension = np.where(np.arange(len(x)) < rear[:, None], tension, -np.inf)
    at = tension.argmax(axis=1)
    fields = {
        "tension_behind": (("y",), np.take_along_axis(tension, at[:, None], axis=1)[:, 0]),
        "tension_behind_x": (("y",), x[at]),
    }
    return variables.dataset(fields, {"y": data["y"].to_numpy()})


def field(data: xr.Dataset, name: str) -> Array:
    """A variable over (depth, y, x)."""
    values: Array = data[name].transpose(*_DIMS).to_numpy()
    return values


def _stacked(data: xr.Dataset, names: Sequence[str]) -> Array:
    """A tensor (6, ...), or nothing where components are missing."""
    return np.stack([field(data, name) for name in names]) if all(name in data for name in names) else np.empty(0)


def _missing(data: xr.Dataset, name: str) -> list[str]:
    if name not in NAMES:
        return []
    if name == _ENERGY:
        needs: tuple[str, ...] = (_ENERGY,)
    else:
        needs = CRITERIA["mazars_strain" if name == "mazars_onset_ratio" else name].needs
    return [need for need in needs if need not in data]
