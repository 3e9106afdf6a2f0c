"""Field shifts: named, with their data and range, applied where a case asks and nowhere else."""

import math
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.case import Case
from treadload.damage import AxleClass, Traffic
from treadload.damage.field_shift import FieldShift, field_shifts, read_field_shifts
from treadload.errors import InputError
from treadload.life.field import EVENTS, Priors, RoadSection, field_tables, field_years
from treadload.life.field.fit import Model, fit
from treadload.life.field.likelihood import Sections
from treadload.life.field.standard_axles import POWER, STANDARD_LOADS, standard_axles, standard_axles_of

LTPP = field_shifts["LTPP"]
CASE = """
spacing = "12 mm"
[tire]
profile = "315/80R22.5"
[pavement]
structure = "6 BBSG3 / 18 GB3 / PF3"
[climate]
temperature = "15 degC"
[traffic]
passes_per_year = 1e5
years = 20
[[traffic.classes]]
name = "axle"
share = 1.0
axle_load = "70 kN"
inflation_pressure = "8.3 bar"
gear = "single"
[[criteria]]
name = "surface"
law = "fatigue-line"
layer = 1
place = "top"
"""


@pytest.fixture(scope="module")
def solved():
    return tl.run(Case.from_text(CASE + '[field_shift]\nshift = "LTPP"\n'))


def test_the_shift_is_what_its_table_says():
    """Fitted again; three digits of the level, two of the rest are stated."""
    table = field_tables["LTPP"]
    fitted = fit(Sections(table.interval(EVENTS[0]), table.entry, np.zeros(len(table))), Model())
    assert LTPP.sections == len(table)
    assert pytest.approx(fitted.parameters.level, rel=2e-3) == LTPP.level
    assert pytest.approx(fitted.parameters.scatter, rel=5e-3) == LTPP.scatter
    assert pytest.approx(fitted.parameters.lag, rel=5e-3) == LTPP.lag
    assert pytest.approx(fitted.errors["level"], rel=5e-3) == LTPP.level_error
    assert pytest.approx(fitted.errors["scatter"] * fitted.parameters.scatter, rel=1e-2) == LTPP.scatter_error
    np.testing.assert_allclose(LTPP.thickness, np.percentile(table.thickness, [5, 95]), atol=1e-3)
    np.testing.assert_allclose(LTPP.mean_air, np.percentile(table.mean_air, [5, 95]), atol=0.1)
    np.testing.assert_allclose(LTPP.traffic, np.nanpercentile(table.traffic, [5, 95]), rtol=5e-3)
    assert np.isfinite(table.traffic).sum() == 91


def test_its_range_of_temperature_is_that_of_the_surface_below_its_air():
    priors = Priors()
    for air, surface in zip(LTPP.mean_air, LTPP.mean_surface, strict=True):
        assert priors.mean_surface(air) == pytest.approx(surface, abs=0.05)


def aashto_equivalence(kips, axles, structural_number, terminal=2.5):
    """Standard axles of 18 kip of one group of axles, AASHTO Guide 1993, as the University of Toledo prints it."""
    log_loss = math.log10((4.2 - terminal) / (4.2 - 1.5))

    def beta(load, count):
        return 0.40 + 0.081 * (load + count) ** 3.23 / ((structural_number + 1) ** 5.19 * count**3.23)

    passes = 4.79 * math.log10(18 + 1) - 4.79 * math.log10(kips + axles) + 4.33 * math.log10(axles)
    return 10 ** -(passes + log_loss / beta(kips, axles) - log_loss / beta(18, 1))


def test_standard_loads_are_where_the_aashto_equation_is_one_standard_axle():
    # The equation itself: two factors that Pavement Interactive prints from tables D.4 and D.5 of the guide.
    assert aashto_equivalence(30, 1, 3) == pytest.approx(7.9, abs=0.05)
    assert aashto_equivalence(40, 2, 5) == pytest.approx(2.08, abs=0.005)
    for count, (low, high) in {2: (33.0, 33.55), 3: (47.05, 48.25)}.items():
        kips = STANDARD_LOADS[count] / 4448.2
        for number in range(1, 7):
            assert aashto_equivalence(low, count, number) < 1 < aashto_equivalence(high, count, number)
            # By the power of the load over this standard load: within 8 % of the equation for every structure.
            assert aashto_equivalence(kips, count, number) == pytest.approx(1.0, abs=0.08)
    # The truck of the priors: 12 kip and two tandems of 30.
    truck = aashto_equivalence(12, 1, 5) + 2 * aashto_equivalence(30, 2, 5)
    assert truck == pytest.approx(1.5, abs=0.01)
    assert truck == pytest.approx((12 / 18) ** POWER + 2 * (30 / 33.2) ** POWER, rel=0.02)


def test_standard_axles_of_a_traffic():
    """A standard axle is one; the truck of the priors is the 1.5 that they state from the same guide; a tandem's own
    standard load makes one passage one axle."""
    single = AxleClass("single", 1.0, 20e3, 8e5, wheels=((0.0, -0.17), (0.0, 0.17)))
    assert standard_axles(Traffic((single,), 1000.0)) == pytest.approx(1000.0)
    # Both ends of the axle as wheels of one class.
    both = AxleClass("both", 1.0, 40e3, 8e5, wheels=((0.0, -1.0), (0.0, 1.0)))
    assert standard_axles_of(both) == pytest.approx(1.0)
    priors = Priors()
    section = RoadSection("truck", 0.15, "ACUB", 1e5, 12.0)
    assert standard_axles(priors.traffic(section)) == pytest.approx(1e5, rel=0.03)
    # Two axles 4 m apart are two single ones; four in a row a tridem and a single.
    apart = AxleClass("apart", 1.0, 40e3, 8e5, wheels=((0.0, 0.0), (4.0, 0.0)))
    assert standard_axles_of(apart) == pytest.approx(2.0)
    four = AxleClass("four", 1.0, 40e3, 8e5, wheels=tuple((1.3 * k, 0.0) for k in range(4)))
    assert standard_axles_of(four) == pytest.approx((240 / 213.5) ** 4 + 1)


def test_years_of_roads():
    """5 and 95 % are 1.645 deviations of ln age from the median."""
    low, high = LTPP.range
    assert low == pytest.approx(5.153 * math.exp(-1.6449 * 0.748), rel=1e-4)
    assert high / low == pytest.approx(math.exp(2 * 1.6449 * 0.748), rel=1e-4)
    assert "after 1.5 to 18 years (90 %, LTPP)" in LTPP.roads_show
    # A road that the mechanics take for the mean of the table's has the table's median.
    for line in ("fresh", "aged"):
        assert LTPP.shifted(LTPP.predicted(line), 0.5, line) == pytest.approx(LTPP.level)
    assert LTPP.shifted(100.0, 0.95) / LTPP.shifted(100.0) == pytest.approx(high / LTPP.level)


def test_a_case_turns_it_on_by_name(solved):
    years, life = solved.parts["field_shift"], solved.parts["life"]
    mechanics = float(life.dataset["life_years_fresh_line"][0])
    given = years.dataset["field_years"].sel(criterion="surface").to_numpy()
    np.testing.assert_allclose(given, [LTPP.shifted(mechanics, share) for share in (0.05, 0.5, 0.95)])
    text = years.summary()
    for words in (
        "mechanics alone",
        "years of roads at 5 %",
        "LTPP, 2026-11-27",
        "these data do not support",
        "scatter 0.75",
    ):
        assert words in text


def test_never_silently(solved):
    """Without the table no result has shifted years; the life states what roads show, whoever asks."""
    plain = tl.run(Case.from_text(CASE))
    assert "field_shift" not in plain.parts
    rows = {row.key: row for row in plain.parts["life"].rows()}
    assert "after 1.5 to 18 years (90 %, LTPP)" in rows["roads_show"].value
    assert "late by a factor of" in rows["roads_show"].value
    assert "no forecast" in rows["verdict"].value
    np.testing.assert_array_equal(
        plain.parts["life"].dataset["life_years"], solved.parts["life"].dataset["life_years"]
    )


def test_outside_its_range_the_mechanics_stand_alone(solved):
    life = solved.parts["life"]
    narrow = replace(LTPP, thickness=(0.03, 0.1))
    road = tl.Pavement.from_catalogue("6 BBSG3 / 18 GB3 / PF3")
    years = field_years(life, road, narrow)
    assert np.isnan(years.dataset["field_years"]).all()
    assert "asphalt of 240 mm, outside 30 to 100 mm" in years.outside
    assert "outside the range" in years.warnings[0]
    assert "the mechanics alone" in years.summary()
    assert "years of roads" not in years.summary()
    cold = field_years(life, road, replace(LTPP, mean_surface=(0.0, 10.0)))
    assert "mean surface temperature of 15 °C, outside 0 to 10 °C" in cold.outside
    busy = field_years(life, road, replace(LTPP, traffic=(1e3, 5e4)))
    assert "traffic of 58.6 thousand standard axles a year, outside 1 to 50" in busy.outside
    assert "the mechanics alone" in busy.summary()
    assert field_years(life, road, LTPP).outside == ""


def test_what_cannot_be_shifted_is_refused(tmp_path):
    text = CASE.replace('layer = 1\nplace = "top"', 'layer = 1\nplace = "bottom"')
    with pytest.raises(InputError, match="needs a criterion that reads tensile strain at the surface"):
        Case.from_text(text + "[field_shift]\n")
    with pytest.raises(InputError, match=r"did you mean .LTPP."):
        Case.from_text(CASE + '[field_shift]\nshift = "LTP"\n')
    with pytest.raises(InputError, match="between 0 and 1, got 1"):
        LTPP.years(1.0)
    with pytest.raises(InputError, match="line must be one of fresh, aged, got 'old'"):
        LTPP.factor("old")
    with pytest.raises(InputError, match="level of the field shift 'LTPP' must be a positive number, got 0"):
        replace(LTPP, level=0.0)
    with pytest.raises(InputError, match=r"range \[low, high\], got \[0.3, 0.1\]"):
        replace(LTPP, thickness=(0.3, 0.1))


def test_a_shift_of_a_file(tmp_path):
    lines = [f"{name} = {value!r}" for name, value in vars(LTPP).items() if not isinstance(value, tuple)]
    lines += [
        "thickness = [0.1, 0.3]",
        "mean_air = [0.0, 20.0]",
        "mean_surface = [1.0, 24.0]",
        "traffic = [1e4, 1e6]",
    ]
    (tmp_path / "ours.toml").write_text("\n".join(lines))
    (shift,) = read_field_shifts(tmp_path / "ours.toml")
    assert isinstance(shift, FieldShift)
    assert shift.level == LTPP.level
    assert shift.thickness == (0.1, 0.3)
    (tmp_path / "case.toml").write_text(CASE + '[field_shift]\nshift = "ours.toml"\n')
    assert Case.from_toml(tmp_path / "case.toml").field_shift.shift == "ours.toml"
