"""Daily thermal stress in Miner's sum: the restrained slab in closed form, cycles of a road, years with them."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.catalogue import mixes
from treadload.damage import AxleClass, Climate, FatigueLine, FrenchBituminous, Traffic, Wander
from treadload.damage.climate import MONTHS, Season, TypicalDays
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import PowerLine
from treadload.damage.miner import miner
from treadload.damage.quantities import TENSION
from treadload.damage.thermal import DAYS, DailyCycles, Thermal, passes_until, years_until
from treadload.errors import InputError
from treadload.kernels.thermal import periodic_stress, restrained_stress
from treadload.life import sensitivity
from treadload.life.sensitivity import _slopes
from treadload.life.thermal import daily_cycles, daily_stress, day_tension
from treadload.materials import Arrhenius, Prony, Thermorheological
from treadload.materials.relaxing import relaxation_of
from treadload.pavement import TemperatureProfile

ALPHA, NU = 2e-5, 0.3
HOURS = np.arange(24.0)
DEPTHS = np.array([0.0, 0.05, 0.2])
LINE = FatigueLine(100e-6, -0.2)
# Nearly elastic: nothing relaxes within years.
FROZEN = Thermorheological(Prony(1e10, ((0.5, 1e13),), NU), Arrhenius(1e-6, 10.0))


def day(mean, swing, hours=HOURS):
    return mean + swing * np.cos(2 * math.pi * (hours - 15) / 24)


def test_an_elastic_slab_bears_what_it_cannot_shorten():
    """σ = -E α (T - mean)/(1 - ν): in tension when colder than its mean, no matter which times never pass."""
    found = daily_stress(FROZEN, ALPHA, HOURS, day(5.0, 8.0))
    exact = -1e10 * ALPHA * (day(5.0, 8.0) - 5.0) / (1 - NU)
    # A series in the place of the material, asked for within 1 %, is the material itself here.
    assert found == pytest.approx(exact, abs=1e-5 * np.abs(exact).max())
    assert found.argmax() == 3


def test_a_maxwell_slab_that_cools_evenly_and_is_warmed_at_once():
    """A saw: cooling at a rate c over the cycle, then back. σ = η α c + A e^(-t/τ), the same at both ends of it."""
    count, tau, modulus, cycle = 400, 3000.0, 8e9, 20000.0
    # The last step, in no time, takes the strain back.
    steps = np.append(np.full(count, cycle / count), 1e-9)
    strain = ALPHA * np.linspace(0.0, 30.0, count + 1)
    found = periodic_stress(strain, steps, np.array([modulus]), np.array([tau]), 0.0)
    rate = strain[-1] / cycle
    # The jump by -E ε at the end joins it to the start: A = -E ε / (1 - e^(-T/τ)).
    start = -modulus * strain[-1] / -math.expm1(-cycle / tau)
    at = np.linspace(0.0, cycle, count + 1)
    exact = modulus * tau * rate + start * np.exp(-at / tau)
    # Linear strain over a step is exact; what is left is round-off and the jump's 1e-9 s.
    assert found == pytest.approx(exact, abs=1e-9 * np.abs(exact).max())


def test_a_sine_of_temperature_meets_the_complex_modulus():
    count, omega = 2000, 2 * math.pi / 86400
    at = np.arange(count) * 86400 / count
    moduli, times, rest = np.array([6e9, 3e9]), np.array([2000.0, 40000.0]), 1e9
    strain = 1e-4 * np.cos(omega * at)
    found = periodic_stress(strain, np.full(count, 86400 / count), moduli, times, rest)
    complex_modulus = rest + sum(
        e * 1j * omega * t / (1 + 1j * omega * t) for e, t in zip(moduli, times, strict=True)
    )
    exact = (complex_modulus * 1e-4 * np.exp(1j * omega * at)).real
    # Strain linear between 2000 points of a sine: an error of (2π/2000)²/12.
    assert found == pytest.approx(exact, abs=3e-6 * np.abs(exact).max())


def test_the_steady_state_is_where_many_days_lead():
    rng = np.random.default_rng(3)
    strain, steps = 1e-4 * rng.normal(size=(12, 2)), rng.uniform(100, 9000, size=(12, 2))
    moduli, times = np.array([5e9, 2e9]), np.array([700.0, 60000.0])
    steady = periodic_stress(strain, steps, moduli, times, 0.0)
    rises = np.tile(np.roll(strain, -1, axis=0) - strain, (40, 1))
    long = restrained_stress(rises, np.tile(steps, (40, 1)), moduli, times, 0.0)
    # The slowest term has passed forty cycles of about its own time.
    assert long[-13:-1] == pytest.approx(steady, abs=1e-9 * np.abs(steady).max())


def test_times_on_both_sides_of_never_agree():
    """Where the cycle is a millionth of the time of relaxation the closed limit takes over, without a step."""
    strain, steps = 1e-4 * np.sin(np.arange(8.0)), np.linspace(1.0, 2.0, 8)
    slow, never = (
        periodic_stress(strain, steps, np.array([1e9]), np.array([steps.sum() / whole]), 0.0)
        for whole in (1.01e-6, 0.99e-6)
    )
    assert slow == pytest.approx(never, abs=2e-6 * np.abs(never).max())
    assert never == pytest.approx(periodic_stress(strain, steps, np.zeros(0), np.zeros(0), 1e9), rel=1e-12)


@pytest.mark.parametrize(("name", "misfit"), [("EB-GB3", 0.04), ("EB-EME2", 0.04), ("EB-BBSG3", 0.11)])
def test_a_mix_relaxes_as_its_table_says(name, misfit):
    """Bounds of the measured rms, 3.1, 3.2 and 9.5 %; and the energy, which the table shows without a model too."""
    mix = mixes[name]
    found = relaxation_of(mix)
    assert found.misfit < misfit
    model = found.material
    for frequency in mix.frequencies:
        for temperature, tabulated in zip(
            mix.temperatures, mix.moduli[mix.frequencies.index(frequency)], strict=True
        ):
            omega = 2 * math.pi * frequency * float(model.shift.factor(temperature))
            # The largest single miss is at the flat ends of the tables, twice the mean.
            assert abs(math.log(abs(model.material.complex_modulus(omega)) / tabulated)) < 3 * misfit
    # ln E falls with temperature as with -ln aT: at 10 °C by the slopes of the table alone.
    ten, row = mix.temperatures.index(10.0), mix.frequencies.index(10.0)
    by_degree = math.log(mix.moduli[row][ten + 1] / mix.moduli[row][ten - 1]) / 20
    by_log = math.log(mix.moduli[-1][ten] / mix.moduli[0][ten]) / math.log(mix.frequencies[-1] / mix.frequencies[0])
    energy = -by_degree / by_log * 8.314 * 283.15**2
    assert model.shift.activation_energy == pytest.approx(energy, rel=0.15)


def road(material=None):
    return tl.Pavement(
        [
            tl.Layer(mixes["EB-BBSG3"] if material is None else material, 0.06, name="wearing"),
            tl.Layer(mixes["EB-GB3"], 0.14),
            tl.Layer(mixes["PF3"]),
        ]
    )


def climate(thermal, swing=8.0, mean=5.0):
    over = np.exp(-DEPTHS / 0.1)
    temperatures = np.broadcast_to(mean + (day(0.0, swing)[:, None] * over), (12, 24, 3))
    days = TypicalDays(HOURS, DEPTHS, temperatures)
    profile = TemperatureProfile(DEPTHS.tolist(), [mean] * 3)
    return Climate((Season("all year", 1.0, profile),), days=days, thermal=thermal)


TRAFFIC = Traffic((AxleClass("truck", 1.0, 30e3, 0.8e6),), 1e5, 0.03, wander=Wander.none(), years=20)
TOP = Criterion("top", LINE, 0, "top")


def test_cycles_of_a_road_are_the_closed_form_under_the_law():
    """An elastic slab: the tension of the coldest hour at 5 mm, the strain of a wheel with it, a cycle a day."""
    found = daily_cycles(road(FROZEN), climate(Thermal(ALPHA)), [TOP], TRAFFIC)
    # At the middle of the cube of 10 mm, linear between the depths of the days, and at the coldest hour.
    swing = 8.0 * (1 + 0.1 * (math.exp(-0.5) - 1))
    stress = 1e10 * ALPHA * swing / (1 - NU)
    assert found.stress[0] == pytest.approx([stress] * 12, rel=1e-4)
    # The wheel reads the modulus at 10 Hz, all of it, so that the strain is α ΔT.
    assert found.readings[0] == pytest.approx([ALPHA * swing] * 12, rel=1e-4)
    assert found.yearly[0] == pytest.approx(365 / LINE.allowable_passes(ALPHA * swing), rel=1e-3)
    # Months do by their days.
    assert found.damage[0] / found.damage[0].sum() == pytest.approx(np.array(DAYS) / 365, rel=1e-9)
    assert found.utilisation[0] == pytest.approx(ALPHA * swing / LINE.allowable_strain(20 * 365), rel=1e-4)
    # Twice the expansion, twice the stress.
    twice = daily_cycles(road(FROZEN), climate(Thermal(2 * ALPHA)), [TOP], TRAFFIC)
    assert twice.stress == pytest.approx(2 * found.stress, rel=1e-9)


def test_a_law_of_stress_reads_the_stress():
    criterion = Criterion("tension", PowerLine(TENSION, 2e6, -0.1), 0, "top", length=None)
    found = daily_cycles(road(FROZEN), climate(Thermal(ALPHA)), [criterion], TRAFFIC)
    assert found.readings[0] == pytest.approx(found.stress[0], rel=1e-12)


def test_a_colder_day_and_less_depth_are_worse_and_a_mix_relaxes():
    cold, mild = (daily_cycles(road(), climate(Thermal(), mean=t), [TOP], TRAFFIC) for t in (-10.0, 15.0))
    assert cold.stress[0, 0] > 5 * mild.stress[0, 0] > 0
    over = day_tension(road(), climate(Thermal()))[0]
    assert (np.diff(over[:2]) < 0).all()
    elastic = daily_stress(FROZEN, 2.5e-5, HOURS, day(5.0, 8.0)).max() / 1e10 * mixes["EB-BBSG3"].modulus(0.0)
    assert over[0] < 0.5 * elastic


def test_expansions_by_mix():
    by_mix = Thermal(1e-5, {"EB-BBSG3": 3e-5})
    found = daily_cycles(road(), climate(by_mix), [TOP, Criterion("base", LINE, 1, "bottom")], TRAFFIC)
    alike = daily_cycles(road(), climate(Thermal(1e-5)), [TOP, Criterion("base", LINE, 1, "bottom")], TRAFFIC)
    assert found.stress[0] == pytest.approx(3 * alike.stress[0], rel=1e-9)
    assert found.stress[1] == pytest.approx(alike.stress[1], rel=1e-12)


def test_what_has_weather_in_it_is_left_out_with_a_sentence():
    french = Criterion("french", FrenchBituminous(100e-6, -0.2, 0.25, 0.2, 0.05, 1.3), 1)
    soil = Criterion("soil", tl.damage.FrenchSubgrade(), -1)
    found = daily_cycles(road(), climate(Thermal()), [french, soil, TOP], TRAFFIC)
    assert found.yearly[:2].tolist() == [0.0, 0.0]
    assert found.yearly[2] > 0
    assert np.isnan(found.stress[:2]).all()
    told = " ".join(found.about)
    assert "french: daily thermal stress is left out: its law was fitted to roads" in told
    assert "soil: daily thermal stress is left out: its layer is not bituminous" in told
    assert daily_cycles(road(), climate(None), [TOP], TRAFFIC) is None


def test_a_mix_of_one_frequency_is_left_out_with_a_warning():
    """Nothing says how it relaxes: other criteria keep their cycles, and a named relaxation gives it cycles."""
    mix = mixes["EB-BBSG3"]
    tenth = mix.frequencies.index(10.0)
    single = replace(mix, frequencies=(10.0,), moduli=(mix.moduli[tenth],))
    base = Criterion("base", LINE, 1, "bottom")
    found = daily_cycles(road(single), climate(Thermal()), [TOP, base], TRAFFIC)
    assert found.yearly[0] == 0.0
    assert found.yearly[1] > 0
    assert any("top: daily thermal stress is left out" in text and "ViscoRoute" in text for text in found.warnings)
    assert np.isnan(day_tension(road(single), climate(Thermal()))[:, 0]).all()
    named = daily_cycles(road(single), climate(Thermal(relaxation="ViscoRoute")), [TOP, base], TRAFFIC)
    assert named.yearly[0] > 0
    assert not named.warnings


def test_a_weather_has_daily_thermal_stress_unless_a_case_says_no():
    """`thermal` left out counts with its defaults; false is none; a table sets the numbers."""
    given = next(line for line in CASE.splitlines(keepends=True) if line.startswith("thermal"))
    built = {}
    for text in ("", "thermal = true\n", "thermal = {}\n", "thermal = false\n", given):
        case = tl.Case.from_text(CASE.replace(given, text))
        built[text] = case.build_climate().thermal
    assert built[""] == built["thermal = true\n"] == built["thermal = {}\n"] == Thermal()
    assert built["thermal = false\n"] is None
    assert built[given] == Thermal(3e-5, relaxation="ViscoRoute")


def summed(weather, reading=100e-6, traffic=TRAFFIC):
    values = np.zeros((1, 1, 1, 3))
    values[0, 0, 0] = 0.0, reading, 0.0
    seasons = Climate((Season("all year", 1.0, 10.0),))
    one = np.zeros(12)
    one[0] = weather
    cycles = DailyCycles(np.full((1, 12), 1e6), np.full((1, 12), 5e-5), one[None], np.array([0.3]))
    return miner(values, [TOP], traffic, seasons, y=np.array([-0.1, 0.0, 0.1]), weather=cycles if weather else None)


def test_miners_sum_of_passes_and_days():
    """d = 0.1 in the first year, growing by 3 %, and w = 0.02 every year: 0.1 (1.03^t - 1)/0.03 + 0.02 t = 1."""
    life = summed(0.02)
    years = float(life.dataset["life_years"][0])
    assert 0.1 * (1.03**years - 1) / 0.03 + 0.02 * years == pytest.approx(1.0, rel=1e-10)
    assert years < float(summed(0.0).dataset["life_years"][0])
    # A share of the first year, at the worst place, and the whole width bears it.
    assert float(life.dataset["weather_share"].sum()) == pytest.approx(0.02 / 0.12, rel=1e-12)
    assert float(life.dataset["damage_share"].sum()) == pytest.approx(0.1 / 0.12, rel=1e-12)
    assert life.dataset["damage_per_year"].to_numpy()[0] == pytest.approx([0.02, 0.12, 0.02], rel=1e-12)
    assert float(life.dataset["life_passes"][0]) == pytest.approx(TRAFFIC.passes(years), rel=1e-12)
    grown = 0.1 * (1.03**20 - 1) / 0.03 + 20 * 0.02
    assert float(life.dataset["design_damage"][0]) == pytest.approx(grown, rel=1e-12)
    assert life.weather_damage(0) == pytest.approx(0.02, rel=1e-12)
    assert "by the weather alone 17 %, most in January, 1 MPa" in life.summary()
    # Without it nothing changes.
    assert "weather_share" not in summed(0.0).dataset


def test_the_weather_ends_a_road_without_harm_by_its_traffic():
    life = summed(0.05, reading=0.0)
    assert float(life.dataset["life_years"][0]) == pytest.approx(20.0, rel=1e-12)
    assert float(life.dataset["weather_share"].sum()) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(("growth", "kind"), [(0.0, "geometric"), (0.05, "arithmetic"), (-0.2, "geometric")])
def test_years_of_both_damages(growth, kind):
    traffic = Traffic(TRAFFIC.classes, 1e5, growth, kind)
    for damage, weather in ((0.1, 0.02), (1e-6, 0.3), (0.4, 1e-7), (0.0, 0.1)):
        years = years_until(traffic, damage, weather)
        assert damage * traffic.passes(years) / 1e5 + weather * years == pytest.approx(1.0, rel=1e-9)
    assert years_until(traffic, 0.0, 0.0) == math.inf
    both = passes_until(traffic, np.array([0.1, 0.0]), 0.02)
    assert both == pytest.approx([traffic.passes(years_until(traffic, d, 0.02)) for d in (0.1, 0.0)])


def test_elasticities_of_the_years_to_both():
    """Without growth t = 1/(d + w): each counts by its share; with growth both together do more than nothing less."""
    even = Traffic(TRAFFIC.classes, 1e5)
    # Central differences of 5 % of a reciprocal: an error of some 0.05²/3 of it.
    assert _slopes(even, 0.03, 0.01) == pytest.approx((0.75, 0.25), rel=2e-3)
    by_traffic, by_weather = _slopes(TRAFFIC, 0.03, 0.01)
    assert by_traffic + by_weather < 1


class Still:
    """In the place of what solves changed questions: the traffic's damage does not change."""

    solved = responses = 0

    def __init__(self, *_):
        pass

    def damages(self, questions, _):
        return [1.0] * len(questions)


def test_what_the_weathers_part_of_a_life_depends_on(monkeypatch):
    """Colder days shorten the life, a stronger law lengthens it by the power of both parts, a wheel moves nothing."""
    monkeypatch.setattr(sensitivity, "Solver", Still)
    cold = climate(Thermal(), mean=-10.0)
    found = daily_cycles(road(), cold, [TOP], TRAFFIC)
    values = np.zeros((1, 1, 1, 3))
    values[0, 0, 0, 1] = 60e-6
    life = miner(
        values, [TOP], TRAFFIC, cold, y=np.array([-0.1, 0, 0.1]), layer_temperatures=np.array([[5.0]]), weather=found
    )
    design = tl.Design(None, road(), TRAFFIC, cold, [TOP])
    told = sensitivity.life_sensitivity(design, life).dataset["elasticity"]
    weather = float(found.yearly[0])
    busy = weather * float(life.dataset["damage_share"].sum()) / float(life.dataset["weather_share"].sum())
    by_traffic, by_weather = _slopes(TRAFFIC, busy, weather)
    assert float(told.sel(input="wheel load")) == 0.0
    assert float(told.sel(input=sensitivity.TEMPERATURE)) > 0.01 * by_weather
    # Both parts go with the fifth power of what the law allows.
    assert float(told.sel(input="strength of top")) == pytest.approx(5 * (by_traffic + by_weather), rel=1e-9)


def test_bad_input():
    with pytest.raises(InputError, match=r"daily thermal stress needs the course of the day .* file or air"):
        Climate((Season("all year", 1.0, 10.0),), thermal=Thermal())
    with pytest.raises(InputError, match=r"expansion must be a number of 1/K in \[0, 0.001\], got 25"):
        Thermal(25.0)
    with pytest.raises(InputError, match=r"no viscoelastic material 'ViscoRout' relaxes; .*ViscoRoute"):
        Thermal(relaxation="ViscoRout")
    with pytest.raises(InputError, match="'ELLVA1' has no shift"):
        Thermal(relaxation="ELLVA1")
    with pytest.raises(
        InputError, match="mix 'BBM' is tabulated at 10 Hz only, which does not define how it relaxes"
    ):
        relaxation_of(mixes["BBM"])


CASE = """
spacing = "24 mm"
[tire]
profile = "315/80R22.5"
[pavement]
structure = "6 BBSG3 / 15 GB3 / PF3"
[climate]
air = { months = [-15, -12, -4, 4, 12, 17, 20, 18, 12, 5, -4, -12], daily_range = "14 K" }
parts_of_day = 1
thermal = { expansion = "3e-5 1/K", relaxation = "ViscoRoute" }
[traffic]
passes_per_year = 1000
growth = 0.02
years = 20
[[traffic.classes]]
name = "truck"
share = 1.0
wheel_load = "20 kN"
inflation_pressure = "8 bar"
[[criteria]]
name = "surface"
law = "fatigue-line"
layer = "EB-BBSG3"
place = "top"
"""


@pytest.mark.slow
def test_a_case_with_cold_days_end_to_end(tmp_path):
    """A quiet road in a hard winter: the weather counts, the file keeps it, temperature shortens what the days do."""
    case = tl.Case.from_text(CASE)
    result = tl.run(case, leave_out=("sensitivity",), workers=1)
    life, data = result.life, result.life.dataset
    share = float(data["weather_share"].sum())
    assert 0.001 < share < 1
    assert share + float(data["damage_share"].sum()) == pytest.approx(1.0, rel=1e-9)
    # January is the coldest.
    assert MONTHS[int(data["weather_share"].to_numpy()[0].argmax())] == "January"
    tension = data["day_tension"].to_numpy()
    assert (tension[0, :3] > tension[6, :3]).all()
    assert np.isnan(tension[:, data["profile_depth"].to_numpy() > 0.211]).all()
    assert any("daily thermal stress" in text for text in json.loads(data.attrs["groups"]))
    traffic, worst = life.traffic, float(data["damage_per_year"].max())
    assert life.years("surface") < traffic.years_to(traffic.passes_per_year / (worst * (1 - share)))
    path = tmp_path / "life.nc"
    tl.save_results(result, path)
    again = tl.open_results(path).life
    assert again.climate.thermal == life.climate.thermal
    assert again.summary() == life.summary()
    tl.report(result, tmp_path / "life.html")
    assert "daily thermal stress" in (tmp_path / "life.html").read_text(encoding="utf-8")


def test_thermal_belongs_to_a_climate_of_weather():
    text = CASE[: CASE.index("air = ")] + "temperature = 15\n" + CASE[CASE.index("thermal = ") :]
    with pytest.raises(InputError, match="thermal belongs to a climate of weather"):
        tl.Case.from_text(text)
