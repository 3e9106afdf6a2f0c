"""Checks of cracks: stress intensity beside handbooks, and growth beside its closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.damage.growth import Crossing, ParisLaw, grown
from treadload.damage.growth.intensity import Way, faces_along, modes, section_of
from treadload.damage.growth.options import POINTS
from treadload.kernels.fracture.closure import stress_intensity
from treadload.kernels.fracture.crack import crack_faces, straight
from treadload.kernels.fracture.dislocations import Section
from treadload.kernels.fracture.interface import interface_singularity
from treadload.kernels.fracture.layers import Strip
from treadload.life.crossings import distances_to
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import UniformRectangle, solve_response
from treadload.validation.check import Check, absolute, relative

_HALF = Section((Strip(1.0, 0.3, math.inf),))
# A layer on next to nothing.
_STRIP = Section((Strip(1.0, 0.3, 1.0), Strip(1e-16, 0.3, math.inf)))
_DOWN = straight((0.0, 1.0))
_HANDBOOK = "Tada, Paris and Irwin (2000)"
_KAYA = "Kaya and Erdogan (1987), Int. J. Fract. 34"
# Part of a free strip: K_I / σ√(πa) in tension and in bending, five digits.
_EXACT = {0.2: (1.3673, 1.0553), 0.5: (2.8246, 1.4972), 0.6: (4.0332, 1.9140)}
# Of the handbook's formulas, which its authors give for parts of the strip: 0.5 % each.
_BOUNDS = {0.5: 0.01, 0.7: 0.01, 0.8: 0.02, 0.9: 0.03}


def crack_checks() -> Iterator[Check]:
    """Edge cracks in a half-plane and in a free strip, upright and leaning, as lives solve them; one that grows."""
    faces = crack_faces(_HALF, _DOWN, 0.04, POINTS)
    root, n = math.sqrt(math.pi * 0.04), len(faces.z)
    for what, power, exact in (("uniform stress", 0, 1.1215), ("stress rising from 0", 1, 0.6829)):
        load = (faces.z / 0.04) ** power
        ratio = float(faces.plane[0, :n] @ load) / root
        yield relative("edge crack", f"K_I / σ√(πa) under {what}", ratio, exact, 0.001, _HANDBOOK)
    ratio = float(faces.antiplane.sum()) / root
    yield relative("edge crack", "K_III / τ√(πa)", ratio, 1.0, 0.001, "closed form")
    lean = math.sqrt(0.5)
    lens = crack_faces(_HALF, straight((lean, lean)), 0.04, POINTS)
    load = np.concatenate([lens.normal[0] ** 2, lens.normal[0] * lens.tangent[0]])
    for mode, exact in enumerate((0.705, 0.364)):
        ratio = abs(float(lens.plane[mode] @ load)) / root
        name = f"K_{'I' * (mode + 1)} / σ√(πa) of one that leans by 45°"
        yield relative("edge crack", name, ratio, exact, 0.005, "Murakami (1987)")
    for part, exacts in _EXACT.items():
        for kind, ratio, exact in zip(("tension", "bending"), of_strip(part), exacts, strict=True):
            yield relative(
                "crack in a layer", f"K_I / σ√(πa), {part:g} of a free strip in {kind}", ratio, exact, 0.001, _KAYA
            )
    for part, bound in _BOUNDS.items():
        for kind, ratio, exact in zip(("tension", "bending"), of_strip(part), handbook(part), strict=True):
            yield relative(
                "crack in a layer",
                f"K_I / σ√(πa), {part:g} of a free strip in {kind}",
                ratio,
                exact,
                bound,
                _HANDBOOK,
            )
    # Towards an interface K goes as a power of the distance.
    for ahead, name in ((10.0, "ten times as stiff"), (0.1, "a tenth as stiff")):
        strips = Strip(1.0, 0.3, 1.0), Strip(ahead, 0.35, math.inf)
        near, far = (
            float(crack_faces(Section(strips), _DOWN, 1 - d, 64).plane[0, :64].sum()) for d in (0.0025, 0.01)
        )
        yield absolute(
            "crack at an interface", f"power of the distance in K_I towards a layer {name}",
            math.log(near / far) / math.log(0.25), 0.5 - interface_singularity(*strips), 0.01,
            "Zak and Williams (1963)",
        )  # fmt: skip
    yield from _four_times_the_points()
    # Friction of 0.2 under a pressure of 2 holds 0.4 of a shear of 0.5.
    ones = np.ones(n)
    factors, _ = stress_intensity(faces, np.stack([-2 * ones, 0.5 * ones, 0 * ones]), 0.2)
    slid = float(factors[1]) / root
    yield relative(
        "closed crack", "K_II / √(πa) of a shear of 0.5, of which 0.4 rub", slid, 0.11215, 0.005, _HANDBOOK
    )
    lengths, law = np.geomspace(0.01, 0.06, 8), ParisLaw(3e-4, 4.2)
    rates = law.growth(1.1215 * 0.7e6 * np.sqrt(math.pi * lengths))[:, None]
    passes = float(grown(lengths, rates, np.array([0.06]))[0, 0])
    slope = 1 - 4.2 / 2
    exact = (0.06**slope - 0.01**slope) / slope / (3e-4 * (1.1215 * 0.7 * math.sqrt(math.pi)) ** 4.2)
    yield relative("Paris' law", "passes from 10 to 60 mm under constant stress", passes, exact, 1e-6, "closed form")


def of_strip(part: float, points: int = POINTS) -> tuple[float, float]:
    """K_I / σ√(πa) of an edge crack over a part of a free strip, in tension and in bending."""
    faces = crack_faces(_STRIP, _DOWN, part, points)
    weight = faces.plane[0, :points] / math.sqrt(math.pi * part)
    return float(weight.sum()), float(weight @ (1 - 2 * faces.z))


def handbook(part: float) -> tuple[float, float]:
    """The same by formulas of the handbook of Tada, Paris and Irwin, sections 2.10 and 2.13.

    Up to 0.6 the polynomials of Gross and Brown, above it Tada's: his for bending is 1.5 % below Kaya and Erdogan at
    0.5, where Brown's is 0.2 % below.
    """
    if part <= 0.6:
        return (
            float(np.polyval([30.382, -21.710, 10.550, -0.231, 1.122], part)),
            float(np.polyval([14.0, -13.08, 7.33, -1.40, 1.122], part)),
        )
    half = 0.5 * math.pi * part
    rise, sine = math.sqrt(math.tan(half) / half) / math.cos(half), 1 - math.sin(half)
    return rise * (0.752 + 2.02 * part + 0.37 * sine**3), rise * (0.923 + 0.199 * sine**4)


def _four_times_the_points() -> Iterator[Check]:
    """Roads below a wheel with shear: K of faces that touch in part, as in lives and with four times the points."""
    load = UniformRectangle(0.2, 0.2, 0.8e6, traction_x=0.2e6)
    x = np.arange(-0.6, 0.601, 0.04)
    for name, layers, part in (
        ("6 cm bonded to a stiffer base, 0.85 of it", ((5.4e9, 0.06), (9e9, 0.12), (80e6, None)), 0.85),
        ("21 cm on 50 MPa, 0.95 of it", ((7e9, 0.21), (50e6, None)), 0.95),
    ):
        road = Pavement([Layer(Elastic(modulus, 0.35), thick) for modulus, thick in layers])
        height = float(road.interfaces[0])
        distances = distances_to(height)
        data = solve_response(load, road, depths=distances, x=x, y=[0.0, 0.05], side="above").dataset
        stress = np.stack([data[f"stress_{of}"].to_numpy() for of in ("xx", "yy", "zz", "xy", "xz", "yz")])
        section, poisson = section_of(road, 0.0, height)
        crossing = Crossing(stress, distances, np.array([0.0, 0.05]), x, section, False, poisson, 1)
        way = Way(np.array([0.0, height]), np.zeros(2))
        lives, many, shallow = (
            modes(crossing, faces_along(section, way, depth * height, upwards=False, points=n), 0.5 * math.pi, 0.5)[0]
            for depth, n in ((part, POINTS), (part, 4 * POINTS), (0.5, POINTS))
        )
        largest = max(np.abs(many).max(), np.abs(shallow).max())
        apart = float(np.abs(lives - many).max() / largest)
        yield absolute(
            "crack below a wheel", f"{name}: K of any mode, change over the largest", apart, 0.0, 0.03,
            "four times the points",
        )  # fmt: skip
