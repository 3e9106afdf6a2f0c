"""Weather above a road, hour by hour: read from a table or from a weather file of buildings (EPW)."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.tables import finite_list, read_table

# Column → what it is called in a table, unit, least and most.
_COLUMNS: Mapping[str, tuple[tuple[str, ...], str, float, float]] = {
    "air_temperature": (("air_temperature", "air", "temperature", "dry_bulb"), "°C", -60.0, 60.0),
    "radiation": (("radiation", "solar", "global_radiation", "ghi"), "W/m²", 0.0, 1500.0),
    "wind": (("wind", "wind_speed"), "m/s", 0.0, 80.0),
    "humidity": (("humidity", "relative_humidity"), "%", 0.0, 110.0),
    "sky": (("sky", "sky_radiation", "longwave"), "W/m²", 50.0, 700.0),
    "surface_temperature": (("surface_temperature", "surface"), "°C", -60.0, 90.0),
}
# Places of the columns in a line of an EPW file, and from which number on one says that there is none.
_EPW = {"air_temperature": (6, 99.9), "humidity": (8, 999.0), "sky": (12, 9999.0), "radiation": (13, 9999.0),
        "wind": (21, 999.0)}  # fmt: skip
_EPW_HEAD = 8
# Radiation of the sun above the air, W/m².
_SUN = 1361.0
# Hours between two rows at most: a day has its course.
_LONGEST = 3.0
_STAMPS = ("%Y-%m-%d %H:%M:%S", "%Y-%m-%d %H:%M", "%d.%m.%Y %H:%M", "%d/%m/%Y %H:%M")


@dataclass(frozen=True, eq=False)
class Weather:
    """Weather above a road at even times, without a hole.

    start: of the first row, local time. step: hours from row to row. air_temperature: (n,), °C. radiation: (n,),
    short-wave on the horizontal, W/m²; None where the temperature of the surface is known. wind: (n,), m/s. humidity:
    (n,), relative, %. sky: (n,), long-wave from the sky, W/m². surface_temperature: (n,), °C, measured. The last four
    may be None. source: file. Raises InputError for too few rows, other lengths, and values that no weather has.

    >>> from datetime import datetime
    >>> tl.pavement.Weather(datetime(2023, 7, 1), 1.0, [95.0] * 24, radiation=[0.0] * 24)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: the climate has a hole: air_temperature is 95 °C at 2023-07-01 00:00; it must
    lie in [-60, 60] °C at every hour
    """

    start: datetime
    step: float
    air_temperature: Array
    radiation: Array | None = None
    wind: Array | None = None
    humidity: Array | None = None
    sky: Array | None = None
    surface_temperature: Array | None = None
    source: str = field(default="", repr=False)

    def __post_init__(self) -> None:
        if not 0 < self.step <= _LONGEST:
            raise InputError(f"rows of a climate must be at most {_LONGEST:g} hours apart, got {self.step:g}")
        for name in _COLUMNS:
            series = getattr(self, name)
            if series is not None:
                object.__setattr__(self, name, np.asarray(series, dtype=float))
        count = len(self.air_temperature)
        if count * self.step < 24:
            raise InputError(f"a climate needs a day of hours at least, got {count} rows {self.step:g} h apart")
        for name, (_, unit, low, high) in _COLUMNS.items():
            column = getattr(self, name)
            if column is None:
                continue
            if len(column) != count:
                raise InputError(f"{name} has {len(column)} rows, air_temperature {count}")
            bad = ~((column >= low) & (column <= high))
            if bad.any():
                at = int(np.argmax(bad))
                what = "is missing" if np.isnan(column[at]) else f"is {column[at]:g} {unit}"
                raise InputError(
                    f"the climate has a hole: {name} {what} at {self.time(at):%Y-%m-%d %H:%M}; it must lie in "
                    f"[{low:g}, {high:g}] {unit} at every hour"
                )
        if self.radiation is None and self.surface_temperature is None:
            raise InputError(
                "the climate has neither radiation nor surface_temperature: without one of them nothing determines "
                "how much warmer than the air the road is; add the column, W/m² or °C"
            )

    @classmethod
    def of_months(
        cls, air: Sequence[float], *, daily_range: float = 10.0, latitude: float = 47.0, clearness: float = 0.45
    ) -> Weather:
        """A year of equal days in each month, for a place of which no hours are known.

        air: mean temperatures of the months, °C, January first. daily_range: from the coldest hour, at 3, to the
        warmest, at 15, K. latitude: degrees, north positive. clearness: radiation on the ground over that above the
        air, both horizontal. Wind and sky are left open. The course of the sun is that of the middle of the month
        (Cooper, 1969, Solar Energy 12, for the declination).
        Raises InputError.
        """
        months = finite_list(air, "air", "°C")
        if len(months) != 12:
            raise InputError(f"air needs 12 temperatures in °C, January first, got {len(months)}")
        if not -70 <= latitude <= 70:
            raise InputError(f"latitude must lie in [-70, 70] degrees, got {latitude}")
        if not 0 < clearness <= 1:
            raise InputError(f"clearness must lie in (0, 1], got {clearness}; 0.45 is usual")
        start = datetime(2001, 1, 1)
        days = [start + timedelta(days=k) for k in range(365)]
        number = np.array([day.timetuple().tm_yday for day in days])
        # Months join without a jump: linear between their middles.
        middles = np.array([15 + 30.4 * k for k in range(-1, 13)])
        mean = np.interp(number, middles, months[[11, *range(12), 0]])
        hour = np.arange(24)
        temperature = mean[:, None] + 0.5 * daily_range * np.cos(2 * np.pi * (hour - 15) / 24)
        tilt, place = np.radians(23.45) * np.sin(2 * np.pi * (284 + number) / 365), np.radians(latitude)
        height = np.sin(place) * np.sin(tilt)[:, None] + (np.cos(place) * np.cos(tilt))[:, None] * np.cos(
            2 * np.pi * (hour - 12) / 24
        )
        sun = _SUN * (1 + 0.033 * np.cos(2 * np.pi * number / 365))[:, None] * np.maximum(height, 0.0)
        return cls(start, 1.0, temperature.ravel(), clearness * sun.ravel(), source="months")

    def time(self, row: int) -> datetime:
        """Local time of a row."""
        return self.start + timedelta(hours=row * self.step)

    @property
    def hours(self) -> float:
        """Hours from the first row to the one after the last."""
        return len(self.air_temperature) * self.step

    @property
    def months(self) -> np.ndarray:
        """Month of each row (n,), 1 to 12."""
        return np.array([self.time(row).month for row in range(len(self.air_temperature))])

    @property
    def hour_of_day(self) -> Array:
        """Hour of each row (n,), in [0, 24)."""
        first = self.start.hour + self.start.minute / 60
        hour: Array = np.mod(first + self.step * np.arange(len(self.air_temperature)), 24.0)
        return hour


def read_weather(path: str | os.PathLike[str]) -> Weather:
    """The weather of a file: a table (CSV) of hours, or an EPW file.

    A table has a line of headings: time ("2023-07-01 14:00", "2023-07-01T14:00" or "01.07.2023 14:00", local,
    standard time without a summer hour), air_temperature (°C), radiation (W/m², short-wave, horizontal), wind (m/s),
    humidity (%), sky (W/m², long-wave) and surface_temperature (°C); of the last six one of radiation and
    surface_temperature is needed. An EPW file holds a typical year of hours: each stands for the middle of its hour.
    Raises InputError that names the first hour that is missing.

    >>> _ = (folder / "day.csv").write_text('''time,air_temperature,radiation
    ... 2023-07-01 00:00,16,0
    ... 2023-07-01 03:00,14,0
    ... 2023-07-01 06:00,15,120
    ... 2023-07-01 09:00,20,520
    ... 2023-07-01 12:00,25,850
    ... 2023-07-01 15:00,27,700
    ... 2023-07-01 18:00,24,260
    ... 2023-07-01 21:00,19,0''')
    >>> weather = tl.pavement.read_weather(folder / "day.csv")
    >>> f"{weather.air_temperature.mean():.0f} °C, every {weather.step:.0f} hours"
    '20 °C, every 3 hours'
    """
    file = Path(path)
    return _read_epw(file) if file.suffix.lower() == ".epw" else _read_table(file)


def _read_table(path: Path) -> Weather:
    table = read_table(path)
    if not table.has_header:
        raise InputError(f"{path}: the first line must name the columns: time, air_temperature, radiation, wind, ...")
    names = [cell.split("(")[0].split("[")[0].strip().lower().replace(" ", "_") for cell in table.rows[0]]
    places = {
        column: next((names.index(word) for word in words if word in names), None)
        for column, (words, *_) in _COLUMNS.items()
    }
    if "time" not in names or places["air_temperature"] is None:
        missing = "time" if "time" not in names else "air_temperature"
        raise InputError(f"{path}: no column {missing!r}; it has {', '.join(names)}")
    if len(table.rows) < 3:
        raise InputError(f"{path}: {len(table.rows) - 1} rows are no climate; it needs a day of hours at least")
    columns = {column: at for column, at in places.items() if at is not None}
    clock = names.index("time")
    times = [_stamp(path, line, row[clock]) for line, row in zip(table.lines[1:], table.rows[1:], strict=True)]
    step = _step(path, times)
    values, _ = table.values(list(columns.values()), first=1, name=lambda column: names[column])
    return _weather_of(path, times[0], step, dict(zip(columns, values.T, strict=True)))


def _read_epw(path: Path) -> Weather:
    table = _lines(path)
    rows = table[_EPW_HEAD:]
    leap = any(row[1:3] == ["2", "29"] for row in rows)
    times, values = [], []
    for number, row in enumerate(rows, start=_EPW_HEAD + 1):
        try:
            month, day, hour = (int(float(cell)) for cell in row[1:4])
            # Months of a typical year come from different years; the hour that ends at 1 is the first.
            times.append(datetime(2000 if leap else 2001, month, day) + timedelta(hours=hour - 0.5))
            numbers = [float(row[at]) for at, _ in _EPW.values()]
        except (ValueError, IndexError, OverflowError) as error:
            raise InputError(
                f"{path}, line {number}: not an hour of an EPW file ({error}); its second to fourth number are "
                "month, day and hour"
            ) from error
        values.append(
            [np.nan if number >= none else number for number, (_, none) in zip(numbers, _EPW.values(), strict=True)]
        )
    if len(rows) < 24:
        raise InputError(f"{path}: an EPW file has {_EPW_HEAD} lines and then 8760 hours, got {len(rows)}")
    step = _step(path, times)
    columns = dict(zip(_EPW, np.array(values).T, strict=True))
    # What a road can do without is left out where an hour lacks it.
    optional = ("humidity", "sky", "wind")
    return _weather_of(
        path, times[0], step, {k: v for k, v in columns.items() if k not in optional or not np.isnan(v).any()}
    )


def _lines(path: Path) -> list[list[str]]:
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from error
    return [line.split(",") for line in text.splitlines() if line.strip()]


def _weather_of(path: Path, start: datetime, step: float, columns: Mapping[str, Array]) -> Weather:
    try:
        return Weather(start, step, **columns, source=path.name)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _stamp(path: Path, line: int, text: str) -> datetime:
    bare = text.strip().replace("T", " ").removesuffix("Z")
    for form in _STAMPS:
        try:
            return datetime.strptime(bare, form)
        except ValueError:
            continue
    raise InputError(f"{path}, line {line}: {text!r} is no time such as 2023-07-01 14:00")


def _step(path: Path, times: Sequence[datetime]) -> float:
    """Hours between rows. Raises InputError that names the first time that is missing or stands twice."""
    steps = np.diff([time.timestamp() if time.tzinfo else _seconds(time) for time in times])
    usual = float(np.median(steps))
    if not usual > 0:
        raise InputError(
            f"{path}: times must increase, got {times[1]:%Y-%m-%d %H:%M} after {times[0]:%Y-%m-%d %H:%M}"
        )
    odd = np.abs(steps - usual) > 1.0
    if odd.any():
        at = int(np.argmax(odd))
        if steps[at] < usual:
            raise InputError(
                f"{path}: times must increase by {usual / 3600:g} h, got {times[at + 1]:%Y-%m-%d %H:%M} after "
                f"{times[at]:%Y-%m-%d %H:%M}; give standard time, without a summer hour"
            )
        missing = times[at] + timedelta(seconds=usual)
        count = round(steps[at] / usual) - 1
        raise InputError(
            f"{path}: the climate has a hole: {missing:%Y-%m-%d %H:%M} is missing, the first of {count} row(s) "
            f"before {times[at + 1]:%Y-%m-%d %H:%M}; fill it, or give another file"
        )
    return usual / 3600


def _seconds(time: datetime) -> float:
    return (time - datetime(1970, 1, 1)).total_seconds()
