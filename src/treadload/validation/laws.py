"""Checks of fatigue laws against worked numbers, and of lives under the French axle."""

from __future__ import annotations

from collections.abc import Iterator

from treadload.damage import FrenchBituminous, FrenchHydraulic, FrenchSubgrade, MepdgBottomUp, MepdgTopDown
from treadload.damage.american import bottom_up_cracking, top_down_cracking
from treadload.validation.check import Check, absolute, relative

_PSI, _INCH = 6894.757293168361, 0.0254
# Worked numbers have twelve digits; a life is a strain to the fifth power.
_DIGITS = 1e-11
_GUIDE = "NF P98-086, parameters by a secondary source"
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
    """The French allowable strain and stress, the MEPDG's passes and cracking, lives of a strain."""
    group = "French fatigue law"
    laws = {}
    for name, (eps, scatter, thick, risk, k_c, ratio, soil, axles, k_r, allowed) in _BITUMINOUS.items():
        law = laws[name] = FrenchBituminous(eps, -0.2, scatter, thick, risk, k_c, ratio, soil)
        yield relative(group, f"{name}: k_r", law.risk_factor, k_r, _DIGITS, _GUIDE)
        found = 1e6 * law.allowable_strain(axles)
        yield relative(group, f"{name}: ε_adm, microstrain", found, allowed, _DIGITS, _GUIDE)
    example = laws["15 cm GB3, 5 % risk"]
    yield absolute(group, "the guide's example: k_r as printed", example.risk_factor, 0.744, 5e-4, _GUIDE)
    found = 1e6 * example.allowable_strain(5e6)
    yield absolute(group, "the guide's example: ε_adm as printed", found, 72.5, 0.05, _GUIDE)
    gravel = FrenchHydraulic(0.75e6, -1 / 15, 1.0, 0.05, 1.4, 1.0)
    found = gravel.allowable_strain(5e6) / 1e6
    yield relative(group, "treated gravel: σ_adm, MPa", found, 0.671526285231, _DIGITS, _GUIDE)
    found = FrenchSubgrade().allowable_passes(316.96755424e-6)
    yield relative(group, "subgrade at 316.97 microstrain: axles", found, 12848659.6587, 5 * _DIGITS, _GUIDE)
    group, source = "MEPDG fatigue", "NCHRP 1-37A, appendix II"
    for kind, (law_of, rows) in _PASSES.items():
        for strain, modulus, air, bitumen, inches, passes in rows:
            mepdg = law_of(modulus * _PSI, inches * _INCH, air / 100, bitumen / 100)
            found = mepdg.allowable_passes(strain)
            where = f"{kind}, {inches} in, {1e6 * strain:.0f} microstrain: passes"
            yield relative(group, where, found, passes, _DIGITS, source)
    for damage, inches, below, above in _CRACKING:
        found = 100 * float(bottom_up_cracking(damage, inches * _INCH))
        yield relative(group, f"damage {damage:g}, {inches} in: cracked from below, %", found, below, _DIGITS, source)
        found = 5280 * float(top_down_cracking(damage))
        yield relative(group, f"damage {damage:g}: cracked from above, ft/mile", found, above, _DIGITS, source)
