"""Checks of fatigue laws: French designs as others print them, and numbers of our own that must not move.

The latter were worked out from the formulas and parameters of the sources named, by us and outside this package: they
hold the code to its formulas, and are not independent evidence.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from scipy.special import ndtri

from treadload.damage import (
    Criterion,
    FrenchBituminous,
    FrenchHydraulic,
    FrenchSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
)
from treadload.damage.laws.american import bottom_up_cracking, top_down_cracking
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import UniformDisc, dual_wheels, solve_response
from treadload.units import PSI
from treadload.validation.check import Check, absolute, relative

_INCH = 0.0254
# Worked numbers have twelve digits; a life is a strain to the fifth power.
_DIGITS = 1e-11
_GUIDE = "own regression after NF P98-086, kept to detect changes"
_NCHRP = "own regression after NCHRP 1-37A, kept to detect changes"
# ε₆, -; S_N; thickness, m; risk; k_c; E(10 °C)/E(θ); platform, Pa; axles; k_r and ε_adm, microstrain, worked.
_BITUMINOUS = {
    "15 cm GB3, 5 % risk": (90e-6, 0.3, 0.15, 0.05, 1.3, 11880 / 9000, 120e6, 5e6, 0.743931288745, 72.4789096643),
    "12 cm GB3, 12 %": (90e-6, 0.3, 0.12, 0.12, 1.3, 11880 / 9000, 100e6, 1e6, 0.831957034361, 105.008418491),
    "15 cm EME2, 2 %": (130e-6, 0.25, 0.15, 0.02, 1.0, 16940 / 14000, 120e6, 1e7, 0.715777465949, 64.582382029),
    "8 cm GB4, 1 %": (100e-6, 0.3, 0.08, 0.01, 1.3, 14300 / 11000, 120e6, 3e7, 0.712637778876, 53.5007190867),
}
# Strain, modulus in psi, air and bitumen in %, thickness in inches, passes.
_PASSES = {
    "bottom-up": (MepdgBottomUp, ((1e-4, 5e5, 7, 11, 6, 140617765.049), (2e-4, 1e6, 5, 12, 4, 11281353.5978))),
    "top-down": (MepdgTopDown, ((1e-4, 5e5, 7, 11, 6, 60428.916135), (2e-4, 1e6, 5, 12, 10, 3587.44515098))),
}
# Damage, thickness in inches, fatigue cracking from below in %, from above in feet per mile.
_CRACKING = (
    (0.01, 8, 0.691506765003, 9.62070061287),
    (0.1, 4, 5.68044326958, 309.537156734),
    (0.5, 8, 32.1339006427, 2730.1131885),
    (1.0, 4, 50.0, 5280.0),
)


def law_checks() -> Iterator[Check]:
    """French designs as printed; the French allowable strain and stress, the MEPDG's passes and cracking."""
    yield from _printed_designs()
    group = "French fatigue law"
    laws = {}
    for name, (eps, scatter, thick, risk, k_c, ratio, soil, axles, k_r, allowed) in _BITUMINOUS.items():
        law = laws[name] = FrenchBituminous(eps, -0.2, scatter, thick, risk, k_c, ratio, soil)
        yield relative(group, f"{name}: k_r", law.risk_factor, k_r, _DIGITS, _GUIDE)
        computed = 1e6 * law.allowable_strain(axles)
        yield relative(group, f"{name}: ε_adm, microstrain", computed, allowed, _DIGITS, _GUIDE)
    example = laws["15 cm GB3, 5 % risk"]
    yield absolute(group, "15 cm GB3 to three digits: k_r", example.risk_factor, 0.744, 5e-4, _GUIDE)
    computed = 1e6 * example.allowable_strain(5e6)
    yield absolute(group, "15 cm GB3 to three digits: ε_adm, microstrain", computed, 72.5, 0.05, _GUIDE)
    gravel = FrenchHydraulic(0.75e6, -1 / 15, 1.0, 0.05, 1.4, 1.0)
    computed = gravel.allowable_strain(5e6) / 1e6
    yield relative(group, "treated gravel: σ_adm, MPa", computed, 0.671526285231, _DIGITS, _GUIDE)
    computed = FrenchSubgrade().allowable_passes(316.96755424e-6)
    yield relative(group, "subgrade at 316.97 microstrain: axles", computed, 12848659.6587, 5 * _DIGITS, _GUIDE)
    group, source = "MEPDG fatigue", _NCHRP
    for kind, (law_of, rows) in _PASSES.items():
        for strain, modulus, air, bitumen, inches, passes in rows:
            mepdg = law_of(modulus * PSI, inches * _INCH, air / 100, bitumen / 100)
            computed = mepdg.allowable_passes(strain)
            where = f"{kind}, {inches} in, {1e6 * strain:.0f} microstrain: passes"
            yield relative(group, where, computed, passes, _DIGITS, source)
    for damage, inches, below, above in _CRACKING:
        computed = 100 * float(bottom_up_cracking(damage, inches * _INCH))
        yield relative(
            group, f"damage {damage:g}, {inches} in: bottom-up cracking, %", computed, below, _DIGITS, source
        )
        computed = 5280 * float(top_down_cracking(damage))
        yield relative(group, f"damage {damage:g}: top-down cracking, ft/mile", computed, above, _DIGITS, source)


def _printed_designs() -> Iterator[Check]:
    """Table I.1 of the French method, and a design for a hot country that a second program prints."""
    group, source = "French designs as printed", "table I.1 of NF P98-086, quoted by UI_ChausseeNeuve"
    flexible = _road([5500, 600, 50], [0.35, 0.35, 0.35], [0.04, 0.15])
    computed = _largest(Criterion("gravel", FrenchSubgrade(), 1, "top"), flexible)
    yield absolute(group, "table I.1: ε_z on top of the gravel, microstrain", computed, 711.5, 0.05, source)
    source = "a second program's run; its Poisson's ratios are inferred"
    hot = _road([1512, 2588, 200, 50], [0.45, 0.45, 0.35, 0.35], [0.06, 0.10, 0.25])
    law, axles = FrenchBituminous(90e-6, -0.2, 0.3, 0.16, 0.25, 1.3, 11880 / 2588, 200e6), 1_467_315
    computed = _largest(Criterion("base", law, 1), hot)
    yield relative(group, "hot country: ε_t at the base, microstrain", computed, 290.58, 1e-3, source)
    computed = _largest(Criterion("soil", FrenchSubgrade(), 3, "top"), hot)
    yield relative(group, "hot country: ε_z on top of the soil, microstrain", computed, 891.5, 3e-3, source)
    source = "a second program's run"
    # Its quantile of 25 % is rounded to 0.674.
    computed = 1e6 * law.allowable_strain(axles)
    yield relative(group, "hot country: allowable ε_t, microstrain", computed, 205.668, 1e-4, source)
    # With its quantile in the place of ours.
    rounded = 10 ** (
        law.slope * (0.674 + float(ndtri(law.risk))) * math.hypot(law.scatter, 2 * law.spread / law.slope)
    )
    where = "hot country: allowable ε_t by its quantile 0.674, microstrain"
    yield absolute(group, where, computed * rounded, 205.668, 5e-4, source)
    computed = 1e6 * FrenchSubgrade(slope=-1 / 4.5).allowable_strain(axles)
    yield absolute(group, "hot country: allowable ε_z, microstrain", computed, 511.50, 0.005, source)


def _road(moduli: Sequence[float], poissons: Sequence[float], thicknesses: Sequence[float]) -> Pavement:
    """Bonded layers; moduli in MPa."""
    rows = zip(moduli, poissons, [*thicknesses, None], strict=True)
    return Pavement([Layer(Elastic(1e6 * modulus, nu), thickness) for modulus, nu, thickness in rows])


def _largest(criterion: Criterion, road: Pavement) -> float:
    """Largest reading of a criterion under the French axle, microstrain: below a wheel or between the two."""
    wheels, depths = dual_wheels(UniformDisc(0.125, 0.662e6), 0.375), [criterion.depth(road)]
    solved = solve_response(wheels, road, depths=depths, x=[0.0], y=[-0.1875, 0.0], side=criterion.side)
    return 1e6 * float(criterion.read(solved.dataset.isel(depth=0)).max())
