"""Basins from files: recognised by their content."""

from __future__ import annotations

import os
from pathlib import Path
from typing import overload

from treadload.errors import InputError
from treadload.files import text_of
from treadload.roads.basins import Basins
from treadload.roads.f25 import FIRST, read_f25
from treadload.roads.layout import BasinLayout, read_csv
from treadload.roads.moving_basins import MovingBasins
from treadload.roads.moving_layout import MovingLayout, read_moving_csv
from treadload.roads.pddx import TITLE, read_pddx


@overload
def read_basins(path: str | os.PathLike[str], layout: BasinLayout | None = None) -> Basins: ...
@overload
def read_basins(path: str | os.PathLike[str], layout: MovingLayout) -> MovingBasins: ...
def read_basins(
    path: str | os.PathLike[str], layout: BasinLayout | MovingLayout | None = None
) -> Basins | MovingBasins:
    """Basins of a file: a table of text, the exchange format PDDX of AASHTO, or a file F25 of Dynatest.

    Moving basins are read of a table with a `MovingLayout`, which states the wheels. layout: which columns of a table
    hold what; left out, columns are found by their names: station, position [m], load [kN], D0 [µm], D300 [µm] and so
    on with the offset in mm, temperature [°C], thickness base [mm]. Raises InputError for what cannot be read, and a
    layout for a format that has its own.

    >>> _ = (folder / "drops.csv").write_text('''load [kN],D0 [um],D300 [um],D900 [um]
    ... 50,400,300,120''')
    >>> basins = tl.roads.read_basins(folder / "drops.csv")
    >>> f"{basins.compliance[0] * 1e9:.0f} µm per kN below the plate"
    '8 µm per kN below the plate'
    """
    file = Path(path)
    if isinstance(layout, MovingLayout):
        return read_moving_csv(file, layout)
    start = text_of(file, "a file of deflection basins")
    kind = "pddx" if TITLE.lower() in start[:2000].lower() else "f25" if start.lstrip().startswith(FIRST) else ""
    if not kind:
        return read_csv(file, layout)
    if layout is not None and layout != BasinLayout():
        raise InputError(f"{path} is a file {kind.upper()} and states its own layout; leave out the layout")
    return read_pddx(file, start) if kind == "pddx" else read_f25(file, start)
