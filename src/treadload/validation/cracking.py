"""Checks of cracks: stress intensity beside handbooks, and growth beside its closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.damage.growth import ParisLaw, grown
from treadload.kernels.fracture.closure import stress_intensity
from treadload.kernels.fracture.crack import crack_faces, straight
from treadload.kernels.fracture.dislocations import Section
from treadload.kernels.fracture.layers import Strip
from treadload.validation.check import Check, relative

_HALF = Section((Strip(1.0, 0.3, math.inf),))
_DOWN = straight((0.0, 1.0))
_HANDBOOK = "Tada, Paris and Irwin (2000)"


def crack_checks() -> Iterator[Check]:
    """Edge cracks in a half-plane and in a free strip, upright and leaning, and a crack that grows."""
    faces = crack_faces(_HALF, _DOWN, 0.04)
    root, n = math.sqrt(math.pi * 0.04), len(faces.z)
    for what, power, exact in (("uniform stress", 0, 1.1215), ("stress rising from 0", 1, 0.6829)):
        load = (faces.z / 0.04) ** power
        ratio = float(faces.plane[0, :n] @ load) / root
        yield relative("edge crack", f"K_I / σ√(πa) under {what}", ratio, exact, 0.005, _HANDBOOK)
    ratio = float(faces.antiplane.sum()) / root
    yield relative("edge crack", "K_III / τ√(πa)", ratio, 1.0, 0.005, "closed form")
    lean = math.sqrt(0.5)
    lens = crack_faces(_HALF, straight((lean, lean)), 0.04)
    load = np.concatenate([lens.normal[0] ** 2, lens.normal[0] * lens.tangent[0]])
    for mode, exact in enumerate((0.705, 0.364)):
        ratio = abs(float(lens.plane[mode] @ load)) / root
        name = f"K_{'I' * (mode + 1)} / σ√(πa) of one that leans by 45°"
        yield relative("edge crack", name, ratio, exact, 0.005, "Murakami (1987)")
    for part, exact in ((0.2, 1.3673), (0.5, 2.8246)):
        strip = crack_faces(Section((Strip(1.0, 0.3, 1.0), Strip(1e-10, 0.3, math.inf))), _DOWN, part)
        ratio = float(strip.plane[0, :n].sum()) / math.sqrt(math.pi * part)
        yield relative(
            "crack in a layer", f"K_I / σ√(πa), {part:g} of a free strip", ratio, exact, 0.005, "Kaya and Erdogan"
        )
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
