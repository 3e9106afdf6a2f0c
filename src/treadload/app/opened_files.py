"""Files that a page opens: what each kind of page can show of them."""

from __future__ import annotations

from collections.abc import Mapping

from treadload.app import map_figures
from treadload.app.basin_points import about_basins, basins_of
from treadload.app.study_points import about_study, study_of
from treadload.composing import BaseResult


def check_opened(kind: str, parts: Mapping[str, BaseResult]) -> None:
    """Raise InputError for results that a page cannot show. kind: "study", "basins", or "result" of one case."""
    if kind == "study":
        about_study(study_of(parts))
    elif kind == "basins":
        about_basins(basins_of(parts))
    else:
        map_figures.maps(dict(parts), theme="light")
