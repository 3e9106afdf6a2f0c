"""A road as rows of a table, as results show it."""

from __future__ import annotations

from treadload.case import Case
from treadload.pavement import LayerRow, Pavement, layer_rows


def road_in_rows(road: Pavement, case: Case | None = None) -> str:
    """The layers of a road as a table in text: thickness, modulus, bond, temperature; the speed of the wheels.

    road: at its temperature. case: that gives the temperatures and the speed.

    >>> soil = tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15, name="asphalt"), soil])
    >>> print(tl.results.road_in_rows(road))
    road from the surface down
      1  asphalt    150 mm  E = 5000 MPa, ν = 0.35, bonded to the layer below
      2  soil               E = 60 MPa, ν = 0.4
    """
    rows = rows_of(road, case)
    speed = case.speed if case is not None and road.is_viscoelastic else None
    lines = ["road from the surface down" + ("" if speed is None else f", wheels at {speed * 3.6:g} km/h")]
    wide = max(len(row.name) for row in rows)
    for number, row in enumerate(rows, start=1):
        thickness = "" if row.thickness is None else f"{row.thickness * 1e3:g} mm"
        numbers = [row.material] if row.anisotropic else [f"E = {row.modulus / 1e6:.5g} MPa", f"ν = {row.poisson:g}"]
        if row.frequency is not None:
            numbers[0] = f"|E*| = {row.modulus / 1e6:.4g} MPa at {row.frequency:g} Hz"
        numbers += [f"{row.temperature:g} °C"] if row.temperature is not None else []
        numbers += [f"{row.bond}{' to the layer below' if number < len(rows) else ''}"] if row.bond else []
        lines.append(f"  {number}  {row.name:{wide}}  {thickness:>8}  " + ", ".join(numbers))
    return "\n".join(lines)


def rows_of(road: Pavement | None, case: Case | None) -> tuple[LayerRow, ...]:
    """The layers of a road, at the temperatures that the case gives; empty without a road."""
    if road is None:
        return ()
    has_temperatures = case is not None and case.pavement is not None and not case.source.waits_for_temperature
    return layer_rows(road, case.pavement.layer_temperatures() if has_temperatures and case and case.pavement else ())
