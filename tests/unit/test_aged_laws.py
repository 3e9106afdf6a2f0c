"""Laws of an aged surface: the line of old cores, two slopes, an endurance limit; and lines fitted to tests."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from treadload.case import Case
from treadload.damage import AgedLine, AgedSurface, FatigueLine, TwoSlopeLine, fit_fatigue_line
from treadload.damage.laws.aged import CORE_AGE, CORE_AIR, CORE_EPSILON_6, CORE_SLOPE
from treadload.errors import InputError
from treadload.materials.ageing import GlobalAging

FRESH = FatigueLine(100e-6, -0.2)


def test_the_aged_line_is_that_of_the_cores_at_one_and_of_the_young_mix_at_zero():
    """Single numbers of the cores, as `benchmarks/aged_cores.py` prints them from the table: 123, -0.342, 0.44."""
    old, young = AgedLine(), AgedLine(hardening=0.0)
    assert old.at_a_million == pytest.approx(123e-6, rel=1e-12)
    assert old.exponent == pytest.approx(-0.342, rel=1e-12)
    assert (CORE_EPSILON_6, CORE_SLOPE) == (123e-6, -0.342)
    strains = np.array([5e-6, 20e-6, 100e-6, 400e-6])
    np.testing.assert_allclose(young.allowable_passes(strains), FRESH.allowable_passes(strains), rtol=1e-12)


def test_ten_to_thirty_times_fewer_passes_at_the_strains_of_a_surface():
    """123^2.924 / 100^5 by hand: 27.9 at 15 microstrain, 9.67 at 25."""
    for strain, factor in ((15e-6, 27.9), (25e-6, 9.67)):
        by_hand = (100e-6 / strain) ** 5 / (123e-6 / strain) ** (1 / 0.342)
        assert by_hand == pytest.approx(factor, rel=5e-3)
        assert FRESH.allowable_passes(strain) / AgedLine().allowable_passes(strain) == pytest.approx(by_hand)


def test_log_passes_are_linear_in_the_hardening():
    for strain in (10e-6, 200e-6):
        logs = [math.log(AgedLine(hardening=h).allowable_passes(strain)) for h in (0.0, 0.3, 1.0)]
        assert logs[1] == pytest.approx(0.7 * logs[0] + 0.3 * logs[2], rel=1e-12)


def test_hardening_grows_with_age_and_falls_with_depth():
    at_cores = AgedSurface(GlobalAging(CORE_AGE, CORE_AIR))
    assert at_cores.hardening() == pytest.approx(1.0, rel=1e-12)
    by_age = [AgedSurface(GlobalAging(age, CORE_AIR)).hardening() for age in (0, 2, 5, 10, 20)]
    assert by_age[0] == 0
    assert (np.diff(by_age) > 0).all()
    by_depth = [at_cores.hardening(depth) for depth in (0.0, 0.02, 0.05, 0.1)]
    assert (np.diff(by_depth) < 0).all()
    line = at_cores.line(90e-6, -0.18, depth=0.02)
    assert line == AgedLine(90e-6, -0.18, by_depth[1])
    assert AgedSurface(GlobalAging(10, 25.0)).hardening() > by_age[3]


def test_voids_take_strength_and_stiffness():
    """10.3 MPa exp(-0.13 per % of voids), as fitted to the cores; 5 % of voids hold 5.4 MPa."""
    ageing = GlobalAging(30, 10)
    assert AgedSurface(ageing, 0.05).strength == pytest.approx(10.3e6 * math.exp(-0.65), rel=1e-12)
    assert AgedSurface(ageing, 0.06).stiffness_factor == 1
    assert AgedSurface(ageing, 0.08).stiffness_factor == pytest.approx(math.exp(-5.3 * 0.02), rel=1e-12)
    with pytest.raises(InputError, match=r"voids must lie in \[0, 0.2\], got 6; 6 % is 0.06"):
        AgedSurface(ageing, 6)


def test_two_slopes_meet_at_the_knee():
    law = TwoSlopeLine(100e-6, -0.2, knee=50e-6, slope_below=-0.34)
    above, below = 50e-6 * (1 + 1e-9), 50e-6 * (1 - 1e-9)
    assert law.allowable_passes(below) == pytest.approx(law.allowable_passes(above), rel=1e-7)
    assert law.allowable_passes(200e-6) == FRESH.allowable_passes(200e-6)
    # By hand: 3.2e7 passes at the knee, and a factor of two below it 2^(1/0.34) times as many.
    assert law.allowable_passes(50e-6) == pytest.approx(3.2e7, rel=1e-12)
    assert law.allowable_passes(25e-6) == pytest.approx(3.2e7 * 2 ** (1 / 0.34), rel=1e-12)
    for strain in (10e-6, 50e-6, 300e-6):
        assert law.allowable_strain(law.allowable_passes(strain)) == pytest.approx(strain, rel=1e-12)
    assert np.isinf(law.allowable_passes(np.array([-1e-6, 0.0]))).all()
    assert "-0.34 below 50 microstrain" in str(law)


def test_below_an_endurance_limit_nothing_harms():
    law = TwoSlopeLine(100e-6, -0.2, endurance_limit=60e-6)
    assert law.allowable_passes(59e-6) == math.inf
    assert law.allowable_passes(61e-6) == FRESH.allowable_passes(61e-6)
    assert law.allowable_strain(1e12) == 60e-6
    assert law.validity[0] == 0


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: AgedLine(hardening=3), r"hardening must lie in \[0, 1.5\], got 3"),
        (lambda: AgedLine(epsilon_6=100), "100 microstrain"),
        (lambda: TwoSlopeLine(1e-4, -0.2, knee=5e-5), "both knee and slope_below"),
        (lambda: TwoSlopeLine(1e-4, -0.2, knee=5e-5, slope_below=0.3), r"slope must lie in \(-1, 0\), got 0.3"),
        (lambda: TwoSlopeLine(1e-4, -0.2, 5e-5, -0.3, 6e-5), "60 microstrain, must be below knee, 50"),
        (lambda: fit_fatigue_line([1, 2], [3, 4]), r"needs 5 readings.*got \(2,\)"),
        (lambda: fit_fatigue_line([1] * 6, [2] * 6), "cannot fix 2 numbers"),
        (lambda: fit_fatigue_line(range(1, 7), range(1, 7)), "last longer at larger readings"),
        (lambda: fit_fatigue_line(range(6), range(6)), "must be positive numbers"),
    ],
)
def test_bad_numbers_are_refused(make, text):
    with pytest.raises(InputError, match=text):
        make()


def test_a_fitted_line_finds_the_line_of_its_tests():
    """Exact tests give the line back; scattering ones within three standard errors, each residual unseen by brute."""
    strain = np.geomspace(50e-6, 800e-6, 24)
    exact = fit_fatigue_line(strain, AgedLine().allowable_passes(strain))
    assert exact.at_a_million == pytest.approx(123e-6, rel=1e-9)
    assert exact.slope == pytest.approx(-0.342, rel=1e-9)
    assert exact.scatter < 1e-9
    draws = np.random.default_rng(31)
    voids = draws.uniform(2, 10, 24)
    passes = AgedLine().allowable_passes(strain) * 10 ** (0.4 * draws.standard_normal(24) - 0.1 * voids)
    fitted = fit_fatigue_line(strain, passes, covariates=voids)
    assert abs(fitted.exponent + 1 / 0.342) < 3 * fitted.exponent_error
    assert fitted.scatter == pytest.approx(0.4, rel=0.35)
    design = np.stack([np.ones(24), np.log10(strain), voids], axis=1)
    for number in (0, 11, 23):
        rest = np.arange(24) != number
        found, *_ = np.linalg.lstsq(design[rest], np.log10(passes[rest]), rcond=None)
        unseen = np.log10(passes[number]) - design[number] @ found
        assert fitted.unseen[number] == pytest.approx(unseen, rel=1e-6)
        spread = fit_fatigue_line(strain[rest], passes[rest], covariates=voids[rest]).scatter
        assert fitted.scores[number] == pytest.approx(norm(0, spread).logpdf(unseen), rel=1e-6)
    # Of two lines that of the right slope is the better unseen.
    wrong = fit_fatigue_line(strain, passes, slope=-0.15, covariates=voids)
    assert fitted.gain(wrong) > 0
    nats, error = fitted.score_gain(wrong)
    assert nats == pytest.approx((fitted.scores - wrong.scores).sum())
    assert nats > error > 0
    assert fitted.score_gain(fitted) == (0, 0)


def test_the_aged_line_states_that_its_slope_is_no_gain():
    """1.5 standard errors over -0.2 at a fitted level, by `benchmarks/aged_cores.py`; 2 are a gain."""
    assert "is no gain over -0.2 on cores unseen (1.5 standard errors)" in AgedLine().caveat


CASE = """
spacing = "20 mm"
[tire]
profile = "315/80R22.5"
[[pavement.layers]]
name = "top"
thickness = "6 cm"
mix = "EB-BBSG3"
[[pavement.layers]]
material = { kind = "elastic", modulus = "100 MPa", poisson = 0.35 }
[climate]
temperature = 15
[traffic]
passes_per_year = 1e5
[[traffic.classes]]
name = "axle"
share = 1
axle_load = "100 kN"
inflation_pressure = "8 bar"
[[criteria]]
name = "surface"
place = "top"
layer = "top"
"""


def test_a_case_names_them():
    law = 'law = "aged-line"\nhardening = 0.5\n'
    assert Case.from_text(CASE + law).build_criteria()[0].law == AgedLine(100e-6, -0.2, 0.5)
    aged = Case.from_text(CASE + 'law = "aged-line"\nage = 10\nmean_air = 12\n').build_criteria()[0].law
    assert aged == AgedSurface(GlobalAging(10, 12)).line(100e-6, -0.2)
    two = 'law = "two-slope-line"\nepsilon_6 = "100 microstrain"\nslope = -0.2\n'
    two += 'knee = "50 microstrain"\nslope_below = -0.34\n'
    assert Case.from_text(CASE + two).build_criteria()[0].law == TwoSlopeLine(100e-6, -0.2, 50e-6, -0.34)
    with pytest.raises(InputError, match="give hardening, or age with mean_air"):
        Case.from_text(CASE + 'law = "aged-line"\n').build_criteria()
    with pytest.raises(InputError, match="age needs mean_air"):
        Case.from_text(CASE + 'law = "aged-line"\nage = 10\n').build_criteria()
