"""Moduli of stress-dependent layers under loads: the stress gives the moduli, and these the stress."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from treadload.errors import ConvergenceError
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.synthesis import READING
from treadload.kernels.tensors import principal_values
from treadload.materials import AtStress
from treadload.pavement import Pavement
from treadload.pavement.stress_sublayers import StressSublayers
from treadload.response.layered import View
from treadload.response.loads import GridLoad, Load, PlacedLoad, SurfaceLoad, UniformRectangle, gather
from treadload.response.moving import at_speed
from treadload.response.several import Question, answers
from treadload.response.superposition import merged

ROUNDS, SETTLED = 15, 1e-3
"""Rounds at most, and the relative change of a modulus below which the state is settled."""
# First share of the step to the law's moduli, in ln E; the least, and the largest when the slope is known.
_DAMPING, _LEAST, _MOST = 0.7, 0.1, 1.0
_STRESS = tuple(range(6))


@dataclass(frozen=True, eq=False)
class SettledModuli:
    """A road whose stress-dependent layers have the moduli of their stress under loads.

    road: elastic there, divided over depth; the material of each part is an `AtStress`. sublayers: how it is divided.
    loads, speed: under which it settled. axis: x and y at which the stress was taken, m. changes: largest relative
    difference between the moduli of the law and those of the road by round, falling.

    >>> base = tl.materials.StressDependent(tl.materials.KTheta(60e6, 0.5))
    >>> layers = [tl.Layer(tl.Elastic(3e9, 0.35), 0.08), tl.Layer(base, 0.2), tl.Layer(tl.Elastic(60e6, 0.4))]
    >>> plates = [tl.UniformDisc(0.15, pressure) for pressure in (350e3, 700e3)]
    >>> settled = [tl.response.settle(plate, tl.Pavement(layers)) for plate in plates]
    >>> [f"{state.moduli[0] / 1e6:.0f} MPa" for state in settled]  # the heavier load stiffens the base
    ['71 MPa', '99 MPa']
    """

    road: Pavement
    sublayers: StressSublayers
    loads: tuple[SurfaceLoad, ...]
    speed: float | None
    axis: tuple[float, float]
    changes: tuple[float, ...]

    @property
    def moduli(self) -> Array:
        """Young's modulus of the parts that depend on stress (n,), Pa, from the surface down."""
        layers = self.road.layers
        return np.array([layers[k].resolved.modulus for k in self.sublayers.parts])  # type: ignore[union-attr]

    def at(self, points: ArrayLike) -> Array:
        """Moduli that the law gives at other points (n, points), Pa, under the stress of the settled road.

        points: (points, 2), x and y, m. What differs from `moduli` is what one modulus for all of a sublayer leaves
        out.
        """
        places = np.atleast_2d(np.asarray(points, dtype=float))
        bulk, deviator = _invariants(self.sublayers, self.road, self.loads, self.speed, places)
        pairs = zip(self.sublayers.materials, bulk, deviator, strict=True)
        return np.array([material.moduli(theta, q)[0] for material, theta, q in pairs])


def settle(loads: Load | Sequence[Load], road: Pavement, *, speed: float | None = None) -> SettledModuli:
    """Moduli of the stress-dependent layers of a road under loads.

    loads, road, speed: as `solve_response` takes them; layers have their temperature.
    Stress is that of the loads and of the road's own weight, γz and K₀ γz, at the middle of each sublayer below the
    centre of pressure of the load with the largest force, the first of equal ones: moduli vary with depth and not
    along or across the road, as in KENLAYER; `SettledModuli.at` shows what the law gives elsewhere. Moduli move by a
    damped step in ln E, whose share follows from the last two rounds (Aitken); a round whose difference does not fall
    is taken back and damped further, so that differences fall monotonically.
    Raises ConvergenceError with the layer whose modulus does not settle within 15 rounds, and InputError.
    Sources: Huang (2004), Pavement Analysis and Design, chapter 3; Küttler & Wall (2008), Comput. Mech. 43, 61-72.

    >>> base = tl.materials.StressDependent(tl.materials.KTheta(60e6, 0.5))
    >>> layers = [tl.Layer(tl.Elastic(3e9, 0.35), 0.08), tl.Layer(base, 0.25), tl.Layer(tl.Elastic(60e6, 0.4))]
    >>> settled = tl.response.settle(tl.UniformDisc(0.15, 700e3), tl.Pavement(layers))
    >>> [f"{modulus / 1e6:.0f} MPa" for modulus in settled.moduli]  # of the base from top to bottom
    ['99 MPa', '89 MPa', '81 MPa', '73 MPa', '66 MPa', '61 MPa']
    """
    gathered = gather(loads)
    axis = _axis(gathered)
    cells = tuple(merged([load.cell if isinstance(load, UniformRectangle) else load for load in gathered]))
    sublayers = StressSublayers.of(road)
    place = np.array([axis])

    def states(settled: Pavement) -> list[AtStress]:
        bulk, deviator = _invariants(sublayers, settled, cells, speed, place)
        pairs = zip(sublayers.materials, bulk[:, 0], deviator[:, 0], strict=True)
        return [material.under(theta, q) for material, theta, q in pairs]

    now = [material.nominal for material in sublayers.materials]
    settled = sublayers.with_materials(now)
    wanted = states(settled)
    step = _step(now, wanted)
    changes = [float(np.abs(step).max(initial=0.0))]
    damping = _DAMPING
    while changes[-1] > SETTLED:
        if len(changes) >= ROUNDS:
            worst = int(np.abs(step).max(axis=0).argmax())
            raise ConvergenceError(
                f"layer {sublayers.name(worst)!r} does not settle: after {ROUNDS} rounds its modulus differs from "
                f"that of its stress by {100 * changes[-1]:.2g} % at {sublayers.depths[worst]:.3g} m, more than "
                f"{100 * SETTLED:g} %; count less of the tension (tension=0), or divide the layer less finely "
                "(sublayer=)"
            )
        trial = [_moved(old, new, damping) for old, new in zip(now, wanted, strict=True)]
        settled_trial = sublayers.with_materials(trial)
        wanted_trial = states(settled_trial)
        step_trial = _step(trial, wanted_trial)
        change = float(np.abs(step_trial).max())
        if change >= changes[-1] and damping > _LEAST:
            # Taken back: the same state, damped further.
            changes.append(changes[-1])
            damping = max(_LEAST, 0.4 * damping)
            continue
        turn = step_trial - step
        damping = float(np.clip(-damping * (step * turn).sum() / max((turn * turn).sum(), 1e-300), 2 * _LEAST, _MOST))
        now, settled, wanted, step = trial, settled_trial, wanted_trial, step_trial
        changes.append(change)
    # The stress that the settled moduli give goes with them.
    final = [
        AtStress(old.modulus, old.poisson, bulk=new.bulk, deviator=new.deviator, law=new.law)
        for old, new in zip(now, wanted, strict=True)
    ]
    return SettledModuli(sublayers.with_materials(final), sublayers, cells, speed, axis, tuple(changes))


def _step(now: Sequence[AtStress], wanted: Sequence[AtStress]) -> Array:
    """From the moduli of a road to those of its stress: of ln E, and of Poisson's ratio (2, n)."""
    ratio = np.log([new.modulus / old.modulus for old, new in zip(now, wanted, strict=True)])
    return np.stack([ratio, [new.poisson - old.poisson for old, new in zip(now, wanted, strict=True)]])


def _moved(old: AtStress, new: AtStress, share: float) -> AtStress:
    modulus = old.modulus * (new.modulus / old.modulus) ** share
    poisson = old.poisson + share * (new.poisson - old.poisson)
    return AtStress(modulus, poisson, bulk=new.bulk, deviator=new.deviator, law=new.law)


def _invariants(
    sublayers: StressSublayers, road: Pavement, loads: Sequence[SurfaceLoad], speed: float | None, places: Array
) -> tuple[Array, Array]:
    """Bulk and deviator stress in the laws of the sublayers (n, points), Pa. places: (points, 2), m."""
    at, x, y = Points.of(places[:, 0], places[:, 1])
    view = View(x, y, at, components=_STRESS, accuracy=READING)
    depths = sublayers.depths
    question = Question(loads, at_speed(road, speed), depths)
    (answer,) = answers([question], view, side="below", speed=speed, mean_over=None)
    # (6, n, points); compression is positive in the laws.
    stress = -answer.fields.stress[:6, :, 0]
    stress[:2] += sublayers.horizontal[:, None]
    stress[2] += sublayers.vertical[:, None]
    principal = principal_values(stress)
    rows = [material.invariants(principal[:, number]) for number, material in enumerate(sublayers.materials)]
    return np.array([theta for theta, _ in rows]), np.array([q for _, q in rows])


def _axis(loads: Sequence[PlacedLoad]) -> tuple[float, float]:
    """Centre of pressure of the load with the largest force, the first of equal ones, m."""
    centres = [_centre(load) for load in loads]
    forces = np.array([force for force, _, _ in centres])
    # Contacts of equal wheels differ by round-off.
    first = int(np.flatnonzero(forces >= forces.max() * (1 - 1e-6))[0])
    return centres[first][1], centres[first][2]


def _centre(load: PlacedLoad) -> tuple[float, float, float]:
    """Force of the pressure of a load, N, and its centre, m."""
    if isinstance(load, GridLoad):
        pressure, grid = load.pressure, load.grid
        total = float(pressure.sum())
        if not total > 0:
            return 0.0, float(grid.x.mean()), float(grid.y.mean())
        return (
            total * grid.cell_area,
            float(pressure.sum(axis=0) @ grid.x / total),
            float(pressure.sum(axis=1) @ grid.y / total),
        )
    if isinstance(load, UniformRectangle):
        return load.pressure * load.length * load.width, load.x, load.y
    return float(np.pi) * load.radius**2 * load.pressure, load.x, load.y
