"""Weather above a road, and how warm the road is below it."""

from datetime import datetime, timedelta

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.pavement.heating import Heat, bells, road_temperatures
from treadload.pavement.weather import Weather, read_weather

MONTHS = [1, 2, 6, 10, 14, 17, 19, 19, 15, 10, 5, 2]


def _table(path, rows):
    lines = ["time, air_temperature (°C), radiation (W/m²), wind (m/s)"]
    lines += [f"{time:%Y-%m-%d %H:%M}, {air}, {sun}, {wind}" for time, air, sun, wind in rows]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def _rows(count):
    start = datetime(2023, 3, 1)
    return [(start + timedelta(hours=k), 10.0 + k % 24 / 4, 100.0 * (6 < k % 24 < 18), 2.0) for k in range(count)]


def test_a_table_of_hours_is_read(tmp_path):
    weather = read_weather(_table(tmp_path / "w.csv", _rows(72)))
    assert weather.step == 1.0
    assert weather.hours == 72
    assert weather.air_temperature[25] == 10.25
    assert weather.radiation[12] == 100.0
    assert weather.wind[0] == 2.0
    assert weather.humidity is None
    assert set(weather.months) == {3}
    assert weather.hour_of_day[26] == 2.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda rows: rows[:30] + rows[33:], "hole: 2023-03-02 06:00 is missing, the first of 3 row"),
        (lambda rows: rows[:30] + rows[29:], "must increase by 1 h, got 2023-03-02 05:00 after 2023-03-02 05:00"),
        (
            lambda rows: [*rows[:5], (rows[5][0], "NaN", 0, 1), *rows[6:]],
            "air_temperature is missing at 2023-03-01 05",
        ),
        (lambda rows: [*rows[:5], (rows[5][0], 300, 0, 1), *rows[6:]], "air_temperature is 300 °C at 2023-03-01 05"),
        (lambda rows: rows[:12], "a day of hours at least"),
    ],
)
def test_a_climate_with_a_hole_is_refused_by_its_first_hour(tmp_path, change, said):
    with pytest.raises(InputError, match=said) as told:
        read_weather(_table(tmp_path / "w.csv", change(_rows(72))))
    assert str(told.value).count(". ") == 0


def test_a_table_without_what_warms_the_road_is_refused(tmp_path):
    path = tmp_path / "w.csv"
    path.write_text("time,air_temperature\n" + "\n".join(f"{t:%Y-%m-%d %H:%M},{a}" for t, a, *_ in _rows(30)))
    with pytest.raises(InputError, match="neither radiation nor surface_temperature"):
        read_weather(path)


def test_an_epw_file_is_read_in_its_places(tmp_path):
    head = ["LOCATION,Nowhere,-,-,-,0,47.0,8.0,1.0,400"] + ["X,0"] * 7
    rows = []
    for k in range(48):
        row = ["1999" if k < 24 else "2003", "1", str(k // 24 + 1), str(k % 24 + 1), "60", "?"] + ["0"] * 29
        row[6], row[8], row[12], row[13], row[21] = str(k / 2), "80", "300", str(10 * k), "3.5"
        rows.append(",".join(row))
    path = tmp_path / "typical.epw"
    path.write_text("\n".join(head + rows))
    weather = read_weather(path)
    assert weather.start == datetime(2001, 1, 1, 0, 30)
    assert weather.air_temperature[30] == 15
    assert weather.radiation[30] == 300
    assert (weather.sky == 300).all()
    assert (weather.wind == 3.5).all()
    assert (weather.humidity == 80).all()
    for huge in ("1e400", "99999999999", "nan"):
        path.write_text("\n".join([*head, *rows[:5], rows[5].replace(",1,1,", f",{huge},1,", 1), *rows[6:]]))
        with pytest.raises(InputError, match=r"line 14: not an hour of an EPW file .* month, day and hour"):
            read_weather(path)
    del rows[30]
    path.write_text("\n".join(head + rows))
    with pytest.raises(InputError, match="hole: 2001-01-02 06:30 is missing"):
        read_weather(path)


@pytest.fixture(scope="module")
def year():
    road = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    weather = Weather.of_months(MONTHS)
    return weather, road_temperatures(road, weather, [0.0, 0.05, 0.1, 0.2])


def test_a_road_in_the_sun_is_warmer_than_the_air_and_slower_below(year):
    weather, found = year
    july = found.months == 7
    surface, deep = found.temperatures[july, 0], found.temperatures[july, 3]
    # Of a July of 19 °C: LTPP sites of such a climate have 45 to 55 °C on sunny days; these days are average ones.
    assert 35 < surface.max() < 55
    assert surface.mean() > weather.air_temperature[weather.months == 7].mean() + 3
    assert np.ptp(deep) < 0.5 * np.ptp(surface)
    hour = found.hour_of_day[july]
    assert 12 <= hour[surface.argmax()] <= 15
    lag = (hour[deep.argmax()] - hour[surface.argmax()]) % 24
    assert 3 <= lag <= 9
    # The year closes: the last hour goes on into the first, within the warming of an hour.
    assert np.abs(found.temperatures[-1] - found.temperatures[0]).max() < 1.5
    assert any("no wind" in text for text in found.assumed)


def test_what_the_sun_gives_leaves_by_the_air_and_the_sky():
    # The balance of a year, and no other number: a black road under no sun and a sky as warm as the air has its mean.
    road = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    n = 24 * 40
    air = np.full(n, 12.0)
    sky = np.full(n, 5.670374419e-8 * (12.0 + 273.15) ** 4)
    still = Weather(datetime(2001, 1, 1), 1.0, air, np.zeros(n), sky=sky)
    assert np.abs(road_temperatures(road, still, [0.05]).temperatures - 12.0).max() < 1e-6
    sunny = Weather(datetime(2001, 1, 1), 1.0, air, np.full(n, 200.0), np.full(n, 2.0), sky=sky)
    half = road_temperatures(road, sunny, [0.05], Heat(absorptivity=0.425)).temperatures[-1, 0]
    whole = road_temperatures(road, sunny, [0.05]).temperatures[-1, 0]
    # Nearly twice as warm above the air: the film grows a little with the difference.
    assert 1.8 < (whole - 12) / (half - 12) < 2.0


def test_bells_is_the_printed_formula_and_near_to_conduction_on_a_summer_day(year):
    # FHWA-RD-98-085, BELLS2 by hand at 14 h, 50 mm: log 50 - 1.25 = 0.44897; both sines from their clocks.
    late, early = np.sin(2 * np.pi * (14 - 15.5) / 18), np.sin(2 * np.pi * (14 - 13.5) / 18)
    by_hand = 2.78 + 0.912 * 40 + 0.44897 * (-0.428 * 40 + 0.553 * 20 + 2.63 * late) + 0.027 * 40 * early
    assert bells(40.0, 0.05, 14.0, 20.0, shaded=True) == pytest.approx(by_hand, abs=1e-3)
    # In the hours that the formulas rest both sines are -1.
    assert bells(20.0, 0.05, 7.0, 20.0) == bells(20.0, 0.05, 8.5, 20.0)
    _, found = year
    day = (found.months == 7) & (found.hour_of_day >= 8) & (found.hour_of_day <= 18)
    for column, depth in ((1, 0.05), (2, 0.1)):
        formula = bells(found.temperatures[day, 0], depth, found.hour_of_day[day], 19.0)
        # BELLS3 itself scatters by 1.9 K (its source's standard error); the layers of its roads vary.
        assert np.sqrt(np.mean((formula - found.temperatures[day, column]) ** 2)) < 4.0
